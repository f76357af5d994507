"""Ctrl-C at many moments: a command ends with 130, and its files are all there or none is."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
from pathlib import Path
from types import FrameType

import pytest

from support.chosen import EXHAUSTIVE, few
from surface.running import SERVER, heed_interrupts, replaced
from surface.studies import LENGTHS, TOLERANCES

MOMENTS = int(os.environ.get("EQUIPOISE_INTERRUPTS", "3"))
"""At which each command is interrupted."""
STUDY = Path("study.toml")
LENGTHS_OF_FEW = replaced(LENGTHS, ("designs = 200", "designs = 40"))
COMMANDS = {
    "search": f"search {STUDY} --population 8 --generations 3 --csv out.csv --json",
    "tolerance": f"tolerance {STUDY} --json --plot out",
    "analyze": "analyze yamashita-1 --csv out.csv --json",
}


def run_interrupted(arguments: list[str], folder: str, moment: int) -> None:
    """Run a command that gets SIGINT with the call of this number; its output goes to files."""
    os.chdir(folder)
    for number, name in ((1, "../out"), (2, "../err")):
        descriptor = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(descriptor, number)
    count = 0

    def profile(frame: FrameType, event: str, argument: object) -> None:
        nonlocal count
        count += 1
        if count == moment:
            sys.setprofile(None)
            signal.raise_signal(signal.SIGINT)

    from equipoise.cli import run

    sys.setprofile(profile)
    status = run(arguments)
    sys.setprofile(None)
    Path("../calls").write_text(str(count))
    os._exit(status)


def ended(name: str, moment: int, folder: Path) -> tuple[int | None, dict[str, bytes]]:
    """Status of an interrupted command, and what it has written."""
    folder.mkdir(parents=True)
    (folder / STUDY).write_text(TOLERANCES if name == "tolerance" else LENGTHS_OF_FEW)
    given = (COMMANDS[name].split(), str(folder), moment)
    process = SERVER.Process(target=run_interrupted, args=given)
    process.start()
    process.join(120)
    err = (folder.parent / "err").read_text()
    assert "Traceback" not in err, err
    files = {str(path.relative_to(folder)): path for path in folder.rglob("*") if path.is_file()}
    written = {name: path.read_bytes() for name, path in files.items() if name != str(STUDY)}
    if process.exitcode == 0:
        written["printed"] = (folder.parent / "out").read_bytes()
    return process.exitcode, written


@pytest.mark.parametrize("name", ["search", "tolerance", "analyze"])
def test_all_is_written_or_nothing(name: str, tmp_path: Path) -> None:
    status, whole = ended(name, 0, tmp_path / "whole" / "here")
    assert status == 0 and len(whole) > 1
    calls, moments = int((tmp_path / "whole" / "calls").read_text()), random.Random(MOMENTS)
    statuses = set()
    for _ in range(MOMENTS):
        moment = moments.randrange(1, calls)
        status, written = ended(name, moment, tmp_path / str(moment) / "here")
        statuses.add(status)
        if status == 0:
            assert written == whole, f"interrupted at call {moment} of {calls}"
        else:
            assert status == 130
            assert written in ({}, {item: whole[item] for item in whole if item != "printed"})
    assert 130 in statuses


def heeding(words: list[str]) -> subprocess.CompletedProcess[str]:
    """Run a process that takes interrupts, wherever the tests run."""
    return subprocess.run(
        words, capture_output=True, text=True, check=False, preexec_fn=heed_interrupts
    )


LOADING = """
import signal, sys
import numpy
from equipoise.__main__ import main

load = numpy.load

def interrupted(*given, **options):
    numpy.load = load
    signal.raise_signal(signal.SIGINT)
    return load(*given, **options)

numpy.load = interrupted
main()
"""


# An interrupt that an import swallows fails in `test_an_import_that_lasts_is_interrupted` too.
@EXHAUSTIVE
@pytest.mark.parametrize(
    ("name", "study"),
    [("search", LENGTHS_OF_FEW), pytest.param("tolerance", TOLERANCES, marks=EXHAUSTIVE)],
)
def test_an_interrupt_while_direction_numbers_are_loaded(
    name: str, study: str, folder: Path
) -> None:
    STUDY.write_text(study)
    words = [sys.executable, "-c", LOADING, name, str(STUDY), "--json"]
    done = heeding(words)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr.splitlines()[-1] == "equipoise: interrupted"


IMPORTING = """
import importlib.abc, signal, sys

class Interrupts(importlib.abc.MetaPathFinder):
    def find_spec(self, name, *_):
        if name == {name!r}:
            sys.meta_path.remove(self)
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Interrupts())
from equipoise.__main__ import main
main()
"""


@pytest.mark.parametrize(
    "module",
    few(
        ["cyclopts", "equipoise.cli.linkage", "numpy.linalg", "equipoise.signals"],
        {"equipoise.cli.linkage", "numpy.linalg"},
    ),
)
def test_an_interrupt_while_modules_are_imported(module: str, folder: Path) -> None:
    words = [sys.executable, "-c", IMPORTING.format(name=module), "analyze", "yamashita-1"]
    words += ["--csv", "out.csv"]
    done = heeding(words)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "equipoise: interrupted\n"
    assert list(folder.iterdir()) == []


STARTING = """
import json, os, signal, sys

MOMENT, LIST = int(os.environ["MOMENT"]), os.environ["LIST"]
names = []

class Interrupts:
    def find_spec(self, name, *_):
        if names or name == "equipoise_command":
            names.append(name)
            if len(names) == MOMENT:
                signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Interrupts())
if not MOMENT:
    import atexit
    atexit.register(lambda: open(LIST, "w").write(json.dumps(names)))
"""
"""A `sitecustomize` that interrupts a process with its import of a number, counted from the first
of the command's own imports on; or lists them."""
SCRIPT = "import sys; from equipoise_command import main; sys.exit(main())"
WAYS = {"command": ["-c", SCRIPT], "module": ["-m", "equipoise"]}
SHORT = {
    "analyze": "analyze yamashita-1 --csv out.csv",
    "plot": "plot yamashita-1 --only linkage -o out",
    "tolerance": f"tolerance {STUDY} --designs 352 --plot out",
}


def started(way: str, line: str, moment: int, hooks: Path) -> subprocess.CompletedProcess[str]:
    """Run a command that gets SIGINT with its import of this number; 0 for never."""
    environment = os.environ | {
        "PYTHONPATH": str(hooks),
        "MOMENT": str(moment),
        "LIST": str(hooks / "names"),
    }
    return subprocess.run(
        [sys.executable, *WAYS[way], *line.split()],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
        preexec_fn=heed_interrupts,
    )


# At two imports: the test above.
@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(SHORT, ["analyze"]))
@pytest.mark.parametrize("way", few(WAYS, ["command"]))
def test_an_interrupt_at_any_import(way: str, name: str, folder: Path) -> None:
    """Of the first import of the command's own, no traceback and no other error is made."""
    (hooks := folder / "hooks").mkdir()
    (hooks / "sitecustomize.py").write_text(STARTING)
    (work := folder / "work").mkdir()
    os.chdir(work)
    STUDY.write_text(TOLERANCES)
    whole = started(way, SHORT[name], 0, hooks)
    assert whole.returncode == 0, whole.stderr
    names = json.loads((hooks / "names").read_text())
    written = {path for path in work.rglob("*") if path != work / STUDY}
    assert len(names) > 100 and written
    for path in sorted(written, reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    early = range(2, 5)  # the first is of the module that hears the interrupt
    chosen = random.Random(MOMENTS).sample(range(6, len(names)), MOMENTS)
    for moment in (*early, *chosen):
        done = started(way, SHORT[name], moment, hooks)
        at = f"import {moment} of {len(names)}, of {names[moment - 1]}"
        assert done.returncode == 130, (at, done)
        assert (done.stdout, done.stderr.splitlines()[-1:]) == ("", ["equipoise: interrupted"]), at
        assert done.stderr.count("\n") == 1, (at, done.stderr)
        assert {*work.iterdir()} == {work / STUDY}, at


LASTING = """
import signal, sys
signal.raise_signal(signal.SIGINT)
for _ in range(10 ** 9):
    pass
"""


def test_an_import_that_lasts_is_interrupted(folder: Path) -> None:
    (folder / "lasting.py").write_text(LASTING)
    begin = (
        "import equipoise.results.analysis as one; "
        "one.analyze = lambda *_, **__: __import__('lasting')"
    )
    words = [sys.executable, "-c", f"{begin}; {SCRIPT}", "analyze", "yamashita-1"]
    done = heeding(words)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "equipoise: interrupted\n")


SWALLOWING = """
import signal
import numpy
import equipoise.results.analysis as analysis
from equipoise.__main__ import main

whole = analysis.analyze

def analyze(*given, **options):
    try:
        signal.raise_signal(signal.SIGINT)
    except:
        pass
    return whole(*given, **options)

analysis.analyze = analyze
main()
"""


# Interrupts while modules are imported: the tests above.
@pytest.mark.exhaustive
def test_an_interrupt_that_a_library_drops(folder: Path) -> None:
    words = [sys.executable, "-c", SWALLOWING, "analyze", "yamashita-1", "--csv", "out.csv"]
    done = heeding(words)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr.splitlines()[-1] == "equipoise: interrupted"
    assert list(folder.iterdir()) == []
