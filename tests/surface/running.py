"""Running the command line as a user does, within this process or in one of its own."""

from __future__ import annotations

import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from copy import copy
from dataclasses import dataclass
from importlib.resources import files
from multiprocessing import get_context
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
from cyclopts import App, ArgumentCollection

import equipoise as eq
from equipoise.cli import run

EXAMPLES, TOOLS, STUDIES = (tuple(eq.examples(kind)) for kind in ("linkage", "tool", "study"))
"""Bundled files."""

WIDE = 400
"""Signs in a line of the terminal: values and words are asserted on, not where lines break."""
READY = "ready to be analysed"
"""Last line of `equipoise check`."""


@dataclass(frozen=True)
class Result:
    """What a command left behind."""

    status: int
    out: str
    err: str


def equipoise(*arguments: str | Path) -> Result:
    """Run a command within this process, on a wide terminal; a Python warning is an error here."""
    out, err = io.StringIO(), io.StringIO()
    helps = not arguments or {"--help", "-h"} & set(arguments)
    wide = mock.patch.dict(os.environ, {} if helps else {"COLUMNS": str(WIDE)})
    with wide, _options_read_once(), redirect_stdout(out), redirect_stderr(err):
        status = run([str(argument) for argument in arguments])
    return Result(status, out.getvalue(), err.getvalue())


ASSEMBLE = App.assemble_argument_collection
OPTIONS: dict[int, tuple[App, ArgumentCollection]] = {}
"""Options of the commands that tests have run, by the application of each, which is kept too."""


def _options_read_once() -> Any:
    """Inside, the options of a command are read off its function at its first call alone.

    In a process of its own a command is called once; here, tests call each hundreds of times, and
    reading its options takes as long as most refusals do.
    """

    def assemble(app: App, **options: Any) -> ArgumentCollection:
        if any(options.values()):  # for the help
            return ASSEMBLE(app, **options)
        if id(app) not in OPTIONS:
            OPTIONS[id(app)] = app, ASSEMBLE(app)
        return _without_values(OPTIONS[id(app)][1])

    return mock.patch.object(App, "assemble_argument_collection", assemble)


def _without_values(options: ArgumentCollection) -> ArgumentCollection:
    """A copy of options, to which a command line has given nothing yet."""
    copies = {id(option): copy(option) for option in options}
    for option in copies.values():
        option.tokens = []
        option.children = ArgumentCollection(copies[id(child)] for child in option.children)
    return ArgumentCollection(copies.values())


def command(*arguments: str | Path) -> list[str]:
    """Return the words that run a command in a process of its own."""
    return [sys.executable, "-m", "equipoise", *map(str, arguments)]


def process(*arguments: str | Path, **options: Any) -> Result:
    """Run a command in a process of its own, which does not hang: for five minutes at most."""
    environment = {**os.environ, "COLUMNS": str(WIDE)}
    options = {
        "env": environment,
        "capture_output": True,
        "encoding": "utf-8",
        "timeout": 300,
        **options,
    }
    done = subprocess.run(command(*arguments), check=False, **options)
    return Result(done.returncode, done.stdout or "", done.stderr or "")


SERVER = get_context("forkserver")
"""Forks processes that have imported what takes most of the time of a short command."""
SERVER.set_forkserver_preload(
    ["equipoise.cli.sweep", "equipoise.schema.studies", "numba", "scipy.stats", "zarr"]
)


def forked(*arguments: str | Path) -> ForkServerProcess:
    """Begin a command in a process of its own, here, whose words on stderr go to the file `err`."""
    Path("err").touch()
    given = [*map(str, arguments)], Path.cwd()
    process = SERVER.Process(target=_run_in, args=given)
    process.start()
    return process


def _run_in(arguments: list[str], folder: Path) -> None:
    os.chdir(folder)
    with Path("err").open("w", encoding="utf-8") as err, Path(os.devnull).open("w") as out:
        os.dup2(err.fileno(), 2)
        os.dup2(out.fileno(), 1)
        sys.exit(run(arguments))


def succeeded(result: Result) -> str:
    """Return the output of a command that has to succeed."""
    assert result.status == 0, result.err
    return result.out


def refused(result: Result) -> str:
    """Return the one sentence of a command that has to be refused; below may be TOML to paste."""
    assert result.status == 2, result
    assert result.out == ""
    assert result.err.endswith("\n")
    line, *paste = result.err.splitlines()
    if paste and paste[-1].startswith("more: equipoise explain "):
        paste.pop()
    assert not paste or tomllib.loads("\n".join(paste))
    assert line.startswith("equipoise: ")
    assert line.isprintable()
    assert "Traceback" not in line
    return line.removeprefix("equipoise: ")


def no_constant(text: str) -> None:
    raise AssertionError(f"{text} is not JSON")


def read(*words: str | Path) -> dict[str, Any]:
    """Return what a command prints with --json, which is one line and nothing else."""
    result = equipoise(*words, "--json")
    assert result.err == ""
    assert result.out.count("\n") == 1
    return json.loads(succeeded(result), parse_constant=no_constant)  # type: ignore[no-any-return]


def cells(text: str, label: str) -> list[str]:
    """What stands in the first row with this label, behind which a unit may stand."""
    begin = re.compile(rf"{re.escape(label)}(, \S+( \S+)*?)?  +")
    rows = ((begin.match(line), line.rstrip()) for line in text.splitlines())
    row = next(line[label.end() :] for label, line in rows if label)
    return re.split(r"  +", re.sub(r" at +(?=[-0-9])", "  ", row))


# -- files -----------------------------------------------------------------------------------------


def unfolded(text: str) -> str:
    """A text as one line."""
    return " ".join(text.split())


def example_text(name: str) -> str:
    """Return the text of a bundled model file."""
    return files("equipoise").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8")


def example(name: str) -> dict[str, Any]:
    """Return the content of a bundled model file."""
    return tomllib.loads(example_text(name))


def massless(name: str = "yamashita-1") -> str:
    """Return the text of a bundled linkage without masses."""
    return re.sub(r"(?m)^(mass|center_of_mass|inertia) = .*\n", "", example_text(name))


def replaced(text: str, *pairs: tuple[str, str]) -> str:
    """Return a text with pieces of it replaced, each of which has to be there."""
    for old, new in pairs:
        assert old in text, f"{old!r} is not there"
        text = text.replace(old, new)
    return text


def written(text: str, *pairs: tuple[str, str], to: str = "model.toml") -> str:
    """Write a text with pieces of it replaced into a file here, and return the file's name."""
    Path(to).write_text(replaced(text, *pairs), encoding="utf-8")
    return to


def changed(name: str, *pairs: tuple[str, str], to: str = "model.toml") -> str:
    """Write a bundled file with pieces of it replaced, and return the name of the copy."""
    return written(example_text(name), *pairs, to=to)


# -- what is refused -------------------------------------------------------------------------------


def command_lines(table: dict[str, dict[str, str]]) -> pytest.MarkDecorator:
    """Try every command line of a table, begin: {rest: what is said}, in a test of its own."""
    lines = [
        (f"{begin} {rest}", said) for begin, part in table.items() for rest, said in part.items()
    ]
    return pytest.mark.parametrize(("line", "said"), lines, ids=[line[:99] for line, _ in lines])


def refuses(line: str, said: str) -> str:
    """Return the one sentence that a command line is answered with; it writes nothing."""
    before = sorted(Path().iterdir())
    sentence = refused(equipoise(*shlex.split(line)))
    assert said in sentence
    assert sorted(Path().iterdir()) == before
    return sentence


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Fail where something takes more of the processor's time, or ten times that on the clock."""

    def late(*_: object) -> None:
        raise TimeoutError(f"not done within {seconds} s")

    timers = {signal.ITIMER_PROF: signal.SIGPROF, signal.ITIMER_REAL: signal.SIGALRM}
    before = {name: signal.signal(name, late) for name in timers.values()}
    signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_REAL, 10 * seconds)
    try:
        yield
    finally:
        for timer, name in timers.items():
            signal.setitimer(timer, 0)
            signal.signal(name, before[name])


def interrupted(words: list[str], ready: Callable[[], bool] | str) -> Result:
    """Run a process and interrupt it once it is ready: after a line or another sign."""
    pipe = subprocess.PIPE
    with subprocess.Popen(
        words,
        stdout=pipe,
        stderr=pipe,
        encoding="utf-8",
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    ) as child:
        assert child.stdout is not None
        if isinstance(ready, str):
            assert child.stdout.readline() == ready
        else:
            while not ready() and child.poll() is None:
                time.sleep(0.05)
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=300)
    return Result(child.returncode, out, err)


def heed_interrupts() -> None:
    """A shell that runs the tests in the background makes them and their children ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
