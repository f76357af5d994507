"""Every bundled file, changed at random, and machines from nothing, through every command.

It works, or is refused whole: in one sentence, with no file that was not there before.  A Python
warning is an error, and so is a command that takes longer or more memory than a reader would wait
for.

Set EQUIPOISE_FUZZ to a number of files, and of machines, to search longer, and at random.
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from copy import deepcopy
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
import tomli_w

from equipoise.web.messages import read
from equipoise.web.replies import packed
from equipoise.web.session import Session
from support import machines_any
from surface.running import (
    EXAMPLES,
    STUDIES,
    TOOLS,
    Result,
    equipoise,
    example,
    no_constant,
    refused,
)
from surface.test_fuzz import NUMBERS, OF_UNIT, UNITS, WORDS, places

SEARCH = int(os.environ.get("EQUIPOISE_FUZZ", "0"))
FILES, MACHINES = SEARCH or 48, SEARCH or 200
PROCESS = Path("/proc/self")
SECONDS, BYTES = 30, 2 * 2**30
STOPPED = 60
"""Seconds after which a command that computes on, and says so, is interrupted."""

OF_EACH = {
    "linkage": (
        "check",
        "analyze --json --split",
        "analyze --csv a.csv",
        "respond --json --csv r.csv",
        "respond --speed 60:400rpm --speeds 9 --json",
        "modes --json",
        "simulate 0.2/s --json",
        "plant --csv p.csv",
        "balance --json",
        "balance --crank-counterweight --objective peak/shaking_moment -o new.toml",
        "balance --crank-counterweight --objective shaking_force --csv b.csv --plot pictures",
        "balance conditions",
        "balance sensitivities shaking_force --json",
        "plot -o pictures",
        "animate -o moving.svg",
        "report -o page.html",
    ),
    "tool": (
        "check",
        "tool --modes --json",
        "tool --modes --number 4",
        "tool --respond 1000:9000rpm --csv t.csv --plot pictures",
        "tool --exposure --json",
        "tool sensitivities --json",
        "tool design -o better.toml",
        "plot -o pictures",
        "report -o page.html",
    ),
    "study": ("check", "sweep -o designs.zarr --json", "tolerance --designs 40 --json"),
}
"""Commands, with / for a space within a word."""
KINDS = {"linkage": EXAMPLES, "tool": TOOLS, "study": STUDIES}
FACTORS = (-1, 0, 1e-30, 1e-9, 1e-3, 0.5, 0.999999, 1.5, 10, 1e3, 1e9, 1e20, 1e30)


OF_MACHINES = {
    "check": 8,
    "analyze": 6,
    "analyze --json --split": 4,
    "analyze --csv a.csv --acceleration 20/rad/s^2": 3,
    "analyze --orders 6 --dwell 0.5/mm": 3,
    "analyze --angles 30/deg,77/deg --json": 3,
    "plot --only linkage -o pictures": 2,
    "plot -o pictures": 1,
    "animate -o moving.svg": 2,
    "report -o page.html": 1,
    "respond --json": 5,
    "respond --drive": 3,
    "respond --speed 60:400rpm --speeds 5 --csv r.csv": 2,
    "modes": 3,
    "simulate 0.2/s --json": 3,
    "simulate 0.5/s --drive": 3,
    "balance --json": 1,
    "balance --crank-counterweight --objective peak/shaking_moment -o new.toml": 1,
    "balance conditions": 3,
    "balance sensitivities shaking_force.y --json": 2,
    "plant": 1,
    "export -o out.xml": 2,
    "export -o out.urdf": 2,
    "export -o out.dxf": 1,
    "export -o out.svg": 1,
    "export -o out.xlsx": 1,
    "serve": 6,
    "check study.toml": 2,
    "tolerance study.toml --designs 6": 1,
}
"""Commands for a machine from nothing, each with how often it gets one."""
STUDY = """schema = 1
model = "model.toml"
vary = [{ path = "drive.speed", range = ["60 rpm", "120 rpm"], steps = 3 }]
tolerances = [{ path = "links.LINK.mass", range = "1 g" }]
outputs = [{ value = "shaking_force.rms" }]
sampling = { method = "grid" }
"""


def words_of(line: str, file: str) -> list[str]:
    """A command with its file behind the name of the command."""
    words = [word.replace("/", " ") for word in line.split()]
    if "study.toml" in words:
        return words
    plain = next((k for k, word in enumerate(words) if word.startswith("-")), len(words))
    name = 2 if words[0] in {"balance", "tool"} and plain > 1 else 1
    return [*words[:name], file, *words[name:]]


def altered(chance: random.Random, value: Any) -> Any:
    """A quantity of another size, or something else."""
    number, _, unit = str(value).partition(" ")
    try:
        size = float(number) * chance.choice(FACTORS)
    except ValueError:
        size, unit = 1.0, ""
    if chance.random() < 0.25 or (unit not in OF_UNIT and not isinstance(value, int | float)):
        junk = f"{chance.choice(NUMBERS)} {chance.choice(UNITS)}"
        return chance.choice([junk, chance.choice(WORDS), 0, -1, 1e308, True, [], {}])
    return f"{size!r} {unit}" if unit else size


def mutate(chance: random.Random, document: Any) -> None:
    """Lose, change, copy, rename or move one thing."""
    everything = list(places(document))
    table, key = chance.choice(everything)
    other, other_key = chance.choice(everything)
    match chance.choice(("delete", "change", "change", "change", "change", "copy", "rename")):
        case "delete":
            del table[key]
        case "copy":
            table[key] = deepcopy(other[other_key])
        case "rename" if isinstance(table, dict):
            table[chance.choice([*WORDS, str(other_key)])] = table.pop(key)
        case _ if not isinstance(table[key], dict | list):
            table[key] = altered(chance, table[key])
        case _:
            table[key] = chance.choice([[], {}, "x", 1])


@contextmanager
def in_time(stop: bool) -> Iterator[None]:
    """A command that computes for too long is an error, however busy the machine is.

    stop : it is interrupted instead, and has to end with 130.
    """

    def late(_: int, __: FrameType | None) -> None:
        if stop:
            raise KeyboardInterrupt
        raise AssertionError(f"computes for more than {SECONDS} s")

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, STOPPED if stop else SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def tried(seed: int) -> None:
    """One bundled file, changed, through one command."""
    chance = random.Random(seed)
    kind = chance.choices(list(KINDS), (12, 5, 1))[0]
    document = deepcopy(example(chance.choice(KINDS[kind])))
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        mutate(chance, document)
    run_through(seed, {"model.toml": tomli_w.dumps(document)}, chance.choice(OF_EACH[kind]))


def machine_tried(seed: int) -> None:
    """One machine from nothing through one command."""
    found = machines_any.document(seed)
    line = random.Random(seed).choices([*OF_MACHINES], [*OF_MACHINES.values()])[0]
    if not SEARCH and "rows" in found and line.startswith("balance -"):  # takes long
        line = "balance conditions"
    study = STUDY.replace("LINK", next(iter(found["links"])))
    run_through(seed, {"model.toml": tomli_w.dumps(found), "study.toml": study}, line, stop=True)


def open_page(file: str) -> Result:
    """What `serve` does of a file: open it, drag a point, and balance."""
    session = Session()
    opened, *_ = session.receive(read(json.dumps(
        {"type": "open", "name": file, "text": Path(file).read_text(encoding="utf-8")}
    )))  # fmt: skip
    told = str(opened.content.get("message", ""))
    assert "Traceback" not in told
    move = {"move": "B", "to": [0.01, 0.02], "at": 3}
    edit = {"type": "edit", "seq": 2, "edits": [move], "label": "move"}
    for reply in session.receive(read(json.dumps(edit))):
        assert packed(reply)
    return Result(0, "", "")


def run_through(seed: int, files: dict[str, str], line: str, stop: bool = False) -> None:
    """Files through one command, in a folder that has nothing else.

    stop : whether it may take long, as long as it says so and can be stopped.
    """
    folder = Path("fuzz")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    os.chdir(folder)
    words, result = [""], Result(0, "", "")
    PROCESS.joinpath("clear_refs").write_text("5", encoding="ascii")  # other tests took memory too
    before = _memory("VmRSS")
    try:
        for name, text in files.items():
            Path(name).write_text(text, encoding="utf-8")
        words = words_of(line, "model.toml")
        with in_time(stop):
            result = open_page("model.toml") if words[0] == "serve" else equipoise(*words)
        err = re.sub("^still computing.*\n", "", result.err, flags=re.MULTILINE)
        told, result = result.err != err, Result(result.status, result.out, err)
        if result.status == 130:
            assert stop and told, "nothing was said in a minute"
        elif result.status:
            assert len(refused(result)) < 3000
            assert set(os.listdir()) == {*files}, "something was written and the rest refused"
        elif "--json" in words:
            json.loads(result.out, parse_constant=no_constant)
    except BaseException as error:
        raise AssertionError(
            f"seed {seed}: {' '.join(words)}: {error!r}; {result.err[:300]}"
        ) from error
    finally:
        os.chdir("..")
    taken = _memory("VmHWM") - before
    assert taken < BYTES, f"seed {seed}: {taken / 2**20:.0f} MiB"


def _memory(of: str) -> int:
    """Bytes of this process: VmRSS what it holds, VmHWM the most since that was set back."""
    found = re.search(rf"{of}:\s+(\d+) kB", PROCESS.joinpath("status").read_text(encoding="ascii"))
    assert found is not None
    return 1024 * int(found[1])


@pytest.mark.parametrize("part", range(4))
def test_every_command_on_every_kind_of_file(part: int) -> None:
    first = random.randrange(2**40) if SEARCH else 0
    for seed in range(first + part, first + FILES, 4):
        tried(seed)


@pytest.mark.parametrize("part", range(8))
def test_every_command_on_machines_from_nothing(part: int) -> None:
    first = random.randrange(2**40) if SEARCH else 0
    for seed in range(first + part, first + MACHINES, 8):
        machine_tried(seed)
