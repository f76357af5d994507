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
import resource
import shlex
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from copy import deepcopy
from dataclasses import asdict
from itertools import chain
from math import exp, sin
from pathlib import Path
from threading import Event, Thread
from time import monotonic, process_time
from types import FrameType
from typing import Any

import pytest
import tomli_w

from equipoise.cli.worker import ToolCall, reply_to
from equipoise.exchange.formats import FORMATS
from equipoise.web.messages import read
from equipoise.web.replies import packed
from equipoise.web.session import Session
from support import machines_any, machines_strokes
from support.chosen import few
from support.machines import KINDS as KINDS_MADE
from support.machines import Case, make
from surface.registered import functions, line_of, loads
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
OF_A_CHANGE = 3
"""Machines on every change; a release tries all."""
PARTS = 8
"""Into which the machines are divided."""
PROCESS = Path("/proc/self")
SECONDS, BYTES = 30, 2 * 2**30
SILENT = 16.0
"""Seconds on the clock in which a command need not say anything; processors together count more."""
SOON, STOPPED, RARELY = 1.5, 12, 10
"""Seconds after which a command that computes on, and says so, is interrupted: on every change;
where it is looked for longer; and of one machine in so many then a minute.
"""
WAITING = 4
"""So many times that on the clock, after which it is interrupted too: one that waits for others,
such as for processes that it has started, takes no time of its own.
"""
HELD = 10.0
"""Seconds of the processor's time in which another thread has to come to its turn, as that which
says that a command still computes; and in which an interrupt is heard."""

OF_EACH = {
    "linkage": (
        "check",
        "analyze --json --split",
        "analyze --csv a.csv",
        "respond --json --csv r.csv",
        "respond --speed '60 : 400 rpm' --speeds 9 --json",
        "modes --json",
        "simulate '0.2 s' --json",
        "plant --csv p.csv",
        "balance --json",
        "balance --crank-counterweight --objective 'peak shaking_moment' -o new.toml",
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
        "tool --respond '1000 : 9000 rpm' --csv t.csv --plot pictures",
        "tool --exposure --json",
        "tool sensitivities --json",
        "tool design -o better.toml",
        "tool vary 'harness position = 0 mm : 410 mm' --json",
        "plot -o pictures",
        "report -o page.html",
    ),
    "study": ("check", "sweep -o designs.zarr --json", "tolerance --designs 40 --json"),
}
KINDS = {"linkage": EXAMPLES, "tool": TOOLS, "study": STUDIES}
FACTORS = (-1, 0, 1e-30, 1e-9, 1e-3, 0.5, 0.999999, 1.5, 10, 1e3, 1e9, 1e20, 1e30)


OF_MACHINES = {
    "check model.toml": 8,
    "analyze model.toml": 6,
    "analyze model.toml --json --split": 4,
    "analyze model.toml --csv a.csv --acceleration '20 rad/s^2'": 3,
    "analyze model.toml --orders 6 --dwell '0.5 mm'": 3,
    "analyze model.toml --angles '30 deg, 77 deg' --json": 3,
    "plot model.toml --only linkage -o pictures": 2,
    "plot model.toml -o pictures": 1,
    "plot map model.toml 'links.LINK.mass = 1 kg : 2 kg' 'drive.speed = 60 rpm : 90 rpm' "
    "'rms shaking_force.y' --points 5 -o pictures": 2,
    "animate model.toml -o moving.svg": 2,
    "animate model.toml -o moving.gif --width 100": 1,
    "animate model.toml -o moving.mp4 --width 100 --turns 1": 1,
    "report model.toml -o page.html": 1,
    "report model.toml -o page.pdf --pdf --language ja": 1,
    "respond model.toml --json": 5,
    "respond model.toml --drive": 3,
    "respond model.toml --speed '60 : 400 rpm' --speeds 5 --csv r.csv": 2,
    "modes model.toml": 3,
    "simulate model.toml '0.2 s' --json": 3,
    "simulate model.toml '0.5 s' --drive": 3,
    "run model.toml --json": 3,
    "run model.toml '0.5 s' --speed '90 rpm' --csv r.csv": 2,
    "run model.toml --fluctuation '2 %' --json": 2,
    "run model.toml --turns 3 --speed '90 rpm' --off-turns 2 --plot pictures": 1,
    "balance model.toml --json": 1,
    "balance model.toml --crank-counterweight --objective 'peak shaking_moment' -o new.toml; "
    "analyze new.toml": 1,
    "balance model.toml --phases --objective shaking_force.y": 1,
    "balance trade-off model.toml shaking_force.y drive_torque --crank-counterweight --points 3": 1,
    "balance arrangements model.toml 3": 1,
    "balance conditions model.toml": 3,
    "balance sensitivities model.toml shaking_force.y --json": 2,
    "plant model.toml": 3,
    "plant model.toml --csv p.csv --plot pictures": 2,
    "plant fit model.toml fit.toml -o better.toml; plant better.toml": 1,
    "export model.toml -o out.xml; import out.xml -o back.toml; check back.toml": 3,
    "export model.toml -o out.urdf; import out.urdf -o back.toml": 3,
    "export model.toml -o out.dxf; import out.dxf -o back.toml": 2,
    "export model.toml -o out.svg; import out.svg -o back.toml": 2,
    "export model.toml -o out.xlsx": 1,
    "export model.toml -o out.py": 1,
    "export model.toml -o out.fmu": 1,
    "export model.toml -o out.mo --balanced": 1,
    "export model.toml -o out.mat; export model.toml -o out.html; export model.toml -o out.pdf": 1,
    "export model.toml -o out.inp; export model.toml -o out.csv --angles 12": 1,
    "serve model.toml": 6,
    "mcp analyze": 1,
    "mcp balance_conditions": 1,
    "check study.toml; sweep study.toml -o a.zarr; best a.zarr -o best.toml; check best.toml": 2,
    "sweep study.toml -o a.zarr; resume a.zarr; export a.zarr -o all.csv; best a.zarr --json": 2,
    "sweep study.toml -o a.zarr; export a.zarr -o all.parquet --kept": 1,
    "tolerance tolerances.toml --designs 256": 2,
    "search search.toml --population 8 --generations 2 -o best.toml; analyze best.toml": 2,
    "exposure signal.csv --duration '2 h' --periodic --json": 1,
    "simulate model.toml '0.3 s' --csv s.csv; exposure s.csv --periodic --duration '1 h'": 1,
    "decay signal.csv --stiffness '2 N/mm' --json": 1,
}
"""Commands for a machine from nothing, each with how often it gets one; those behind a semicolon
go on with what was written.
"""


def trying(name: str) -> bool:
    """Whether a command of this name is among those above."""
    lines = [part.strip() for line in (*OF_MACHINES, *chain(*OF_EACH.values()))
             for part in line.split(";")]  # fmt: skip
    return any(f"{line} ".startswith(f"{name} ") for line in lines)


OF_MACHINES |= {
    shlex.join(line): 1
    for name in functions()
    if not trying(name) and (line := line_of(name, "model.toml"))
}
BESIDE = {
    "study.toml": {
        "vary": [{"path": "drive.speed", "range": ["60 rpm", "120 rpm"], "steps": 3}],
        "sampling": {"method": "grid"},
    },
    "search.toml": {
        "vary": [{"path": "drive.speed", "range": ["60 rpm", "120 rpm"]},
                 {"path": "links.LINK.mass", "range": ["1 kg", "2 kg"]}],
        "sampling": {"method": "sobol", "designs": 16},
    },
    "tolerances.toml": {
        "vary": [{"path": "links.LINK.mass", "normal": {"deviation": "10 g"}},
                 {"path": "drive.speed", "uniform": {"half_width": "1 rpm"}}],
        "sampling": {"method": "monte-carlo", "designs": 16},
    },
}  # fmt: skip
"""Studies beside a machine."""
OUTPUTS = ("shaking_force.rms", "drive_torque.peak", "joints.A.rms", "points.B.y.peak_to_peak")
FIT = """schema = 1
search = { generations = 2, population = 10 }
goals = [{ figure = "curve.height", at_least = "25 cm" }]
"""
WANTED = {
    "modes": "support", "plant": "planting", "respond": "support", "simulate": "support",
    "--drive": "motor", "--phases": "rows", "export": "even", "--fluctuation": "motor",
    "run": "friction",
}  # fmt: skip
"""What a command needs of a machine."""


def words_of(line: str, file: str) -> list[str]:
    """A command with its file behind the name of the command."""
    words = shlex.split(line)
    plain = next((k for k, word in enumerate(words) if word.startswith("-")), len(words))
    parted = words[0] in {"balance", "tool"} and plain > 1
    name = 2 if parted or words[:2] in (["plant", "fit"], ["plot", "map"]) else 1
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
def in_time(stop: float) -> Iterator[None]:
    """A command that computes for too long is an error, however busy the machine is, and so is one
    that lets no other thread come to its turn.

    stop : s after which it is interrupted instead, and has to end with 130; 0 for never.
    """

    def late(_: int, __: FrameType | None) -> None:
        if stop:
            raise KeyboardInterrupt
        raise AssertionError(f"computes for more than {SECONDS} s")

    clocks = {signal.ITIMER_PROF: signal.SIGPROF, signal.ITIMER_REAL: signal.SIGALRM}
    before = {name: signal.signal(name, late) for name in clocks.values()}
    with another_thread():
        signal.setitimer(signal.ITIMER_PROF, stop or SECONDS)
        signal.setitimer(signal.ITIMER_REAL, WAITING * (stop or 10 * SECONDS))
        try:
            yield
        finally:
            for clock, name in clocks.items():
                signal.setitimer(clock, 0)
                signal.signal(name, before[name])


@contextmanager
def another_thread() -> Iterator[None]:
    """Inside, a thread beside comes to its turn again and again, and fails if it has to wait while
    the processor computes for long.
    """
    ended, gaps = Event(), [0.0]

    def turn() -> None:
        last = process_time()
        while not ended.wait(0.2):
            last, before = process_time(), last
            gaps.append(last - before)

    thread = Thread(target=turn, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
    assert max(gaps) < HELD, f"nobody could say or hear anything for {max(gaps):.0f} s"


def tried(seed: int) -> None:
    """One bundled file, changed, through one command."""
    chance = random.Random(seed)
    kind = chance.choices(list(KINDS), (12, 5, 1))[0]
    document = deepcopy(example(chance.choice(KINDS[kind])))
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        mutate(chance, document)
    words = words_of(chance.choice(OF_EACH[kind]), "model.toml")
    run_through(seed, {"model.toml": tomli_w.dumps(document)}, [words])


def machine_of(seed: int) -> tuple[dict[str, str], list[list[str]]]:
    """Files of a machine from nothing, and the commands that it goes through."""
    chance = random.Random(seed)
    line = chance.choices([*OF_MACHINES], [*OF_MACHINES.values()])[0]
    wanted = " ".join(part for word, part in WANTED.items() if word in line.split())
    document, tables = machines_any.files(seed, wanted)
    if not SEARCH and "rows" in document and line.startswith("balance model"):  # takes long
        line = "balance conditions model.toml"
    link = next(iter(document["links"]))
    swing = [30 * exp(-k / 200) * sin(k / 20) for k in range(800)]
    rows = (f"{k / 500:g},{at + chance.gauss(0, 0.3):.6g}" for k, at in enumerate(swing))
    signal = "\n".join([chance.choice(["time [s],x [m/s^2]", "time [s],displacement [mm]"]), *rows])
    output = {"value": chance.choice(OUTPUTS), "make": "smallest"}
    common = {"schema": 1, "model": "model.toml", "outputs": [output]}
    studies = {
        name: tomli_w.dumps(common | study).replace("LINK", link) for name, study in BESIDE.items()
    }
    model = {"model.toml": tomli_w.dumps(document), "signal.csv": signal, "fit.toml": FIT}
    files = model | tables | studies
    return files, [shlex.split(part.replace("LINK", link)) for part in line.split(";")]


def machine_tried(seed: int, longer: bool) -> None:
    """One machine from nothing through one command, or some that go on with what it wrote."""
    long = 60 if seed % RARELY == 0 else STOPPED
    run_through(seed, *machine_of(seed), stop=long if longer else SOON)


def open_page(file: str) -> None:
    """What `serve` does of a file: open it, drag a point, and balance."""
    session = Session()
    opened, *_ = session.receive(read(json.dumps(
        {"type": "open", "name": file, "text": Path(file).read_text(encoding="utf-8")}
    )))  # fmt: skip
    text = str(opened.content.get("message", ""))
    assert "Traceback" not in text
    move = {"move": "B", "to": [0.01, 0.02], "at": 3}
    edit = {"type": "edit", "seq": 2, "edits": [move], "label": "move"}
    for reply in session.receive(read(json.dumps(edit))):
        assert packed(reply)


def as_tool(name: str) -> None:
    """What the agents' server answers."""
    reply = reply_to(ToolCall(name, {"file": "model.toml"}, str(Path.cwd())))
    assert json.dumps(asdict(reply), allow_nan=False)
    assert "Traceback" not in reply.text


def run_through(
    seed: int, files: dict[str, str], commands: list[list[str]], stop: float = 0
) -> None:
    """Files through commands, in a folder that has nothing else, up to the first that is refused.

    stop : s after which each is stopped, which may take long as long as it says so.
    """
    folder = Path("fuzz")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    os.chdir(folder)
    PROCESS.joinpath("clear_refs").write_text("5", encoding="ascii")  # other tests took memory too
    before, words = _memory("VmRSS"), [""]
    try:
        for name, text in files.items():
            Path(name).write_text(text, encoding="utf-8")
        with limited():
            for words in commands:
                if run_one(words, stop) != 0:
                    break
    except BaseException as error:
        raise AssertionError(f"seed {seed}: {shlex.join(words)}: {error!r}") from error
    finally:
        os.chdir("..")
    taken = _memory("VmHWM") - before
    assert taken < BYTES, f"seed {seed}: {shlex.join(words)}: {taken / 2**20:.0f} MiB"


@contextmanager
def limited() -> Iterator[None]:
    """Commands within the memory that a process of their own may take."""
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (_memory("VmData") + BYTES, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


def run_one(words: list[str], stop: float) -> int:
    """One command, here; returns its status."""
    there, result, begun = set(os.listdir()), Result(0, "", ""), monotonic()
    with in_time(stop):
        match words:
            case ["serve", file]:
                with suppress(KeyboardInterrupt):  # a page says itself that it waits
                    open_page(file)
            case ["mcp", name]:
                with suppress(KeyboardInterrupt):  # whoever called cancels
                    as_tool(name)
            case _:
                result = equipoise(*words)
    progress, refusal, sentence = result.err.partition("equipoise: ")
    result = Result(result.status, result.out, refusal + sentence)
    if result.status == 130:
        silent = monotonic() - begun
        assert stop and (progress or silent < SILENT), f"nothing was said in {silent:.0f} s"
    elif result.status:
        assert result.status == 2, result
        assert len(refused(result)) < 3000, result.err[:300]
        assert set(os.listdir()) == there, "something was written and the rest refused"
    elif "--json" in words:
        json.loads(result.out, parse_constant=no_constant)
    return result.status


def _memory(of: str) -> int:
    """Bytes of this process: VmRSS what it holds, VmHWM the most since that was set back, VmData
    what counts towards its limit.
    """
    match = re.search(rf"{of}:\s+(\d+) kB", PROCESS.joinpath("status").read_text(encoding="ascii"))
    assert match is not None
    return 1024 * int(match[1])


@pytest.mark.parametrize("part", range(4))
def test_every_command_on_every_kind_of_file(part: int) -> None:
    first = random.randrange(2**40) if SEARCH else 0
    for seed in range(first + part, first + FILES, 4):
        tried(seed)


@pytest.mark.usefixtures("with_progress")
@pytest.mark.parametrize("part", range(PARTS) if SEARCH else few(range(PARTS), range(OF_A_CHANGE)))
def test_every_command_on_machines_from_nothing(part: int, pytestconfig: pytest.Config) -> None:
    first, longer = random.randrange(2**40) if SEARCH else 0, bool(SEARCH)
    longer = longer or pytestconfig.getoption("--exhaustive")
    for seed in range(first + part, first + (MACHINES if longer else OF_A_CHANGE), PARTS):
        machine_tried(seed, longer)


@pytest.mark.parametrize("kind", [kind for kind in KINDS_MADE if kind.startswith("torsion_")])
def test_a_machine_of_a_kind_brings_its_tables(kind: str) -> None:
    """Torsion springs of a random machine may have a table, which a file alone cannot hold."""
    document, tables = machines_any.with_tables(make(kind, 0).machine)
    model = tomli_w.dumps({"schema": 1, "title": kind} | document)
    for name, text in {"model.toml": model, **tables}.items():
        Path(name).write_text(text, encoding="utf-8")
    assert "table = " in model
    assert equipoise("check", "model.toml").status == 0


def test_machines_from_nothing_have_the_tables_that_they_name() -> None:
    """Of a hundred, some of which name one."""
    made = [machine_of(seed)[0] for seed in range(100)]
    named = [
        {*re.findall(r'"([^"]+\.csv)"', files["model.toml"])} <= {*files}
        for files in made
        if "table = " in files["model.toml"]
    ]
    assert all(named) and len(named) > 5


def joints_of(document: dict[str, Any]) -> list[dict[str, Any]]:
    return [*document.get("joints", ())]


def motor_of(document: dict[str, Any]) -> dict[str, Any]:
    motor: dict[str, Any] = document["drive"].get("motor", {})
    return motor


MADE: dict[str, Callable[[dict[str, Any]], list[dict[str, Any]]]] = {
    "JointProperties": joints_of,
    "RollingBearing": lambda made: [
        item["bearing"] for item in joints_of(made) if "bearing" in item
    ],
    "LinkSection": lambda made: [
        value["section"] for value in made["links"].values() if "section" in value
    ],
    "Motor": lambda made: [motor_of(made)],
    "DcMotor": lambda made: [*filter(None, [motor_of(made).get("dc")])],
    "InductionMotor": lambda made: [*filter(None, [motor_of(made).get("induction")])],
    "ServoMotor": lambda made: [*filter(None, [motor_of(made).get("servo")])],
}
"""Tables below others, as a document of a machine from nothing has them."""


# Fewer machines have the tables that they name: the test above.
@pytest.mark.exhaustive
def test_machines_from_nothing_have_every_table_of_a_model_file() -> None:
    """Among the first 400; a table that is new joins, or says why not."""
    schema = json.loads(equipoise("schema").out)
    wanted = {("", key) for key in {*schema["properties"]} - {"description"}}
    wanted |= {(table, key) for table in MADE for key in schema["$defs"][table]["properties"]}
    missing = {*wanted}
    for seed in range(400):
        document = machines_any.files(seed)[0]
        tables = {table: read(document) for table, read in MADE.items()} | {"": [document]}
        there = {(table, key) for table, entries in tables.items() for key in chain(*entries)}
        assert there <= wanted
        missing -= there
        if not missing:
            break
    assert missing == set()


def test_a_machine_that_cannot_be_pushed_is_followed_by_one_that_can(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As with the first of seed 515272, a rolling planet, which hangs on gears."""
    asked, real = [], machines_strokes.stroked

    def stroked(kind: str, seed: int, by_slider: bool = False) -> Case:
        asked.append(seed)
        if len(asked) < 3:
            raise machines_strokes.CannotBePushed(f"{kind}:{seed}")
        return real("slider_crank", seed, by_slider)

    monkeypatch.setattr(machines_strokes, "stroked", stroked)
    monkeypatch.setattr(machines_strokes, "TOGETHER", {})
    monkeypatch.setattr(machines_any, "STROKED", 1)
    document, _ = machines_any.of_kind(random.Random(3))
    assert "stroke" in document["drive"]
    assert asked == [asked[0], asked[0] + 1, asked[0] + 2]


def test_every_command_is_tried() -> None:
    """A new command of a file joins the fuzz by itself, or by a line where it takes more."""
    assert [name for name in functions() if loads(name) and not trying(name)] == []
    lines = (*OF_MACHINES, *chain(*OF_EACH.values()))
    ends = {value.ending for value in FORMATS.values()}
    assert ends == {f".{end}" for end in re.findall(r"export \S+ -o \w+\.(\w+)", "\n".join(lines))}
