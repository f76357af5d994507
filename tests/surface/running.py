"""Running the command line as a user does, within this process or in one of its own."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tomllib
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any
from unittest import mock

from equipoise.cli import run

EXAMPLES = (
    "balance-coupler",
    "balance-crank",
    "balance-geared-a",
    "balance-geared-b",
    "balance-geared-c",
    "balance-rig",
    "balance-shafts",
    "balance-spring",
    "brush-cutter-engine",
    "class-three",
    "drag-link",
    "exudyn-slider-crank",
    "four-row-transplanter",
    "geared-counterweight",
    "kim-chung-a",
    "kim-chung-b",
    "kim-chung-c",
    "lee-kim-a",
    "lee-kim-b",
    "lee-kim-c",
    "planetary-planting-arm",
    "quick-return",
    "riding-transplanter",
    "scotch-yoke",
    "slider-crank-engine",
    "spring-balanced-crank",
    "stephenson-six-bar",
    "transplanter",
    "walking-transplanter",
    "watt-six-bar",
    "yamashita-1",
    "yamashita-2",
    "yamashita-rig",
    "yamashita-rig-counterweight",
)
TOOLS = ("brush-cutter", "nagamine-irie", "pole-saw")
STUDIES = ("study-of-balance", "study-of-lengths", "study-of-tolerances")
"""Bundled files of tools and studies; those above are of linkages."""

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
    with wide, redirect_stdout(out), redirect_stderr(err):
        status = run([str(argument) for argument in arguments])
    return Result(status, out.getvalue(), err.getvalue())


def command(*arguments: str | Path) -> list[str]:
    """Return the words that run a command in a process of its own."""
    return [sys.executable, "-m", "equipoise", *map(str, arguments)]


def process(*arguments: str | Path, **options: Any) -> Result:
    """Run a command in a process of its own, for a minute at most."""
    environment = {**os.environ, "COLUMNS": str(WIDE)}
    options = {
        "env": environment,
        "capture_output": True,
        "encoding": "utf-8",
        "timeout": 60,
        **options,
    }
    done = subprocess.run(command(*arguments), check=False, **options)
    return Result(done.returncode, done.stdout or "", done.stderr or "")


def told(*arguments: str) -> Result:
    """Run a command that tells its help, on a terminal of 80 signs.

    In a process of its own: within this one help is as wide as the first that was told here.
    """
    return process(*arguments, env={**os.environ, "COLUMNS": "80"})


def succeeded(result: Result) -> str:
    """Return the output of a command that has to succeed."""
    assert result.status == 0, result.err
    return result.out


def refused(result: Result) -> str:
    """Return the one sentence of a command that has to be refused."""
    assert result.status == 2, result
    assert result.out == ""
    assert result.err.endswith("\n")
    (line,) = result.err.splitlines()
    assert line.startswith("equipoise: ")
    assert line.isprintable()
    assert "Traceback" not in line
    return line.removeprefix("equipoise: ")


def example_text(name: str) -> str:
    """Return the text of a bundled model file."""
    return files("equipoise").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8")


def example(name: str) -> dict[str, Any]:
    """Return the content of a bundled model file."""
    return tomllib.loads(example_text(name))


def model(old: str = "", new: str = "", name: str = "model.toml") -> Path:
    """Mechanism A of Kim and Chung as a file here, with one piece of text replaced."""
    text = example_text("kim-chung-a")
    assert old in text
    Path(name).write_text(text.replace(old, new) if old else text, encoding="utf-8")
    return Path(name)
