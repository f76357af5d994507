"""Every command as it is installed without extras: it works, or says what to install."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from collections import deque
from functools import cache
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path

import pytest

from support.chosen import EXHAUSTIVE
from surface.running import EXAMPLES, STUDIES, TOOLS

SCRIPT = """
import json, shlex, sys
from importlib.machinery import PathFinder

class Bare(PathFinder):
    absent = frozenset(json.loads(sys.argv[1]))

    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name.partition(".")[0] not in cls.absent:
            return super().find_spec(name, path, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Bare
from equipoise.cli import run
for words in json.loads(sys.argv[2]):
    print("status", run(words), shlex.join(words), flush=True)
"""


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def installed_with(name: str) -> set[str]:
    """Distributions that a distribution brings, itself among them, without any of its extras."""
    result: set[str] = set()
    left = deque([normal(name)])
    while left:
        first = left.popleft()
        if first in result:
            continue
        result.add(first)
        try:
            wanted = requires(first) or []
        except PackageNotFoundError:  # of another system or version of Python
            continue
        left += (normal(re.split(r"[^\w.-]", w, maxsplit=1)[0]) for w in wanted if "extra" not in w)
    return result


@cache
def left_out() -> list[str]:
    """Modules that are here, and are not where nothing but the product is installed."""
    there = installed_with("equipoise") | {"pip", "setuptools"}
    return [
        module
        for module, owners in packages_distributions().items()
        if not {normal(owner) for owner in owners} & there and module.isidentifier()
    ]


def bare(folder: Path, commands: list[list[str]]) -> subprocess.CompletedProcess[str]:
    """Commands one after the other, without what extras bring."""
    words = [sys.executable, "-c", SCRIPT, json.dumps(left_out()), json.dumps(commands)]
    done = subprocess.run(words, cwd=folder, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return done


def statuses(done: subprocess.CompletedProcess[str]) -> dict[str, int]:
    """Exit status of each command."""
    matches = re.findall(r"^status (\d+) (.*)$", done.stdout, re.MULTILINE)
    return {command: int(status) for status, command in matches}


def test_what_is_left_out_is_what_extras_bring() -> None:
    assert {"numba", "zarr", "pandas", "pytest", "hypothesis"} <= set(left_out())
    assert not {"numpy", "scipy", "rich", "platformdirs"} & set(left_out())


# Without extras too, commands answer: `test_every_command_answers`.
@pytest.mark.exhaustive
def test_bundled_files_of_every_kind_are_checked(tmp_path: Path) -> None:
    """Of studies it is told that neither compiled loops nor a store are there; tolerances need
    nothing else.
    """
    names = (*EXAMPLES[::12], *TOOLS, *STUDIES)
    done = bare(tmp_path, [["check", name] for name in names])
    assert statuses(done) == {f"check {name}": 0 for name in names}
    printed = done.stdout
    assert printed.count("computed many at once, by NumPy\n") == len(STUDIES)
    assert printed.count("a sweep needs zarr, which is not installed") == len(STUDIES)
    searched = printed.count("a search needs pymoo, which is not installed")
    assert searched == len(STUDIES) - 1
    needed = printed.count('install it with: pip install "equipoise[studies]"')
    assert needed == len(STUDIES) + searched
    assert "ready for: equipoise tolerance study-of-tolerances\n" in printed
    assert printed.count("ready for: equipoise tolerance") == 1


WORKS = [
    "plant transplanter", "balance balance-crank", "tool nagamine-irie", "schema",
    "report yamashita-1 -o r.html", "animate yamashita-1 -o a.svg", "examples",
    "respond yamashita-rig",
]  # fmt: skip
WORK_TOO = [
    "analyze yamashita-1 --csv a.csv", "plot yamashita-1 -o pictures",
    "plot yamashita-1 --only linkage --format png -o png",
    "animate yamashita-1 -o a.gif", "simulate yamashita-rig '1 s'", "tool brush-cutter",
    "balance conditions yamashita-1",
]  # fmt: skip
"""By the same modules as those above."""


@pytest.mark.parametrize("works", [WORKS, pytest.param(WORK_TOO, marks=EXHAUSTIVE)])
def test_every_command_answers(works: list[str], tmp_path: Path) -> None:
    refused = {
        "sweep study-of-lengths -o st": "zarr",
        "animate yamashita-1 -o a.mp4": "equipoise[video]",
        "report yamashita-1 -o r.pdf": "equipoise[report]",
    }
    done = bare(tmp_path, [shlex.split(line) for line in (*works, *refused)])
    assert statuses(done) == dict.fromkeys(works, 0) | dict.fromkeys(refused, 2)
    for name in refused.values():
        assert name in done.stderr
