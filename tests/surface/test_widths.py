"""What every command prints, on terminals of any width: nothing is too wide, nothing is lost."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import chdir
from functools import cache
from math import cos, exp
from pathlib import Path

import pytest
from rich.cells import cell_len

import equipoise.present.terminal
from equipoise.cli.outputs import Printed
from equipoise.cli.runner import declared_of
from equipoise.present.cells import grid
from equipoise.present.terminal import block_text, plain
from equipoise.results.blocks import Block, FileText, ReportSection, Table, Text
from support.chosen import few
from surface.registered import functions, line_of
from surface.running import equipoise as equipoise_runs
from surface.running import example_text, succeeded
from surface.studies import LENGTHS, TOLERANCES

WIDTHS = (40, 57, 80, 120, 200)
TARGETS = """
schema = 1
[search]
generations = 1
population = 5
[vary]
crank = ["33 mm", "34 mm"]
[[goals]]
figure = "curve.height"
target = "40 cm"
"""
DESIGN = """
[design]
speeds = ["6500 rpm", "8000 rpm"]
[[design.variables]]
station = "belt"
key = "position"
from = "200 mm"
to = "300 mm"
"""
FILES = {"study.toml": LENGTHS, "tolerances.toml": TOLERANCES, "targets.toml": TARGETS}
FILES["four-bar.svg"] = (
    '<svg width="100mm" viewBox="0 0 100 100"><path id="crank" d="M0 0 20 -20"/>'
    '<path id="coupler" d="M20 -20 90 -60 40 -70Z"/><path id="rocker" d="M90 -60 100 0"/>'
    '<path id="frame" d="M0 0 100 0"/></svg>'
)
FILES["tool.toml"] = example_text("pole-saw") + DESIGN
FILES["decay.csv"] = "time [s],displacement [mm]\n" + "".join(
    f"{k / 100},{20 * exp(-k / 150) * cos(k / 8)}\n" for k in range(240)
)
LINES = [
    "analyze slider-crank-engine",
    "analyze yamashita-1 --orders 3",
    "analyze quick-return --output points.E.x --output joints.B --dwell '0.5 mm'",
    "balance balance-shafts",
    "balance balance-spring",
    "balance four-row-transplanter",
    "balance yamashita-1",
    "balance arrangements yamashita-1 4",
    "balance conditions watt-six-bar",
    "balance sensitivities yamashita-1 shaking_force.y",
    "balance trade-off balance-crank shaking_force drive_torque --points 3",
    "decay decay.csv",
    "check brush-cutter",
    "check slider-crank-engine",
    "check study-of-lengths",
    "check riding-transplanter",
    "examples",
    "import four-bar.svg",
    "exposure 'mowing: 4.6 m/s^2 for 2 h' 'sawing: 9 m/s^2 for 2 h'",
    "exposure --idle '3.1 m/s^2' --racing '9 m/s^2' --duration '3 h'",
    "modes riding-transplanter",
    "plant transplanter",
    "plant fit kim-chung-a targets.toml --out fitted.toml",
    "respond yamashita-rig --model exact",
    "respond riding-transplanter --speed '60 rpm : 150 rpm' --speeds 8",
    "run yamashita-rig --turns 3 --full",
    "simulate yamashita-rig '0.3 s'",
    "sweep study.toml --out designs.zarr",
    "resume designs.zarr",
    "best designs.zarr --by vertical --by torque",
    "search study.toml --population 8 --generations 2",
    "tolerance tolerances.toml --designs 352",
    "tool brush-cutter",
    "tool design tool.toml",
    "tool sensitivities tool.toml",
    "tool vary nagamine-irie 'harness position = 0 mm : 400 mm' --number 3",
]
"""Of every command that prints blocks, quick ones with much to tell."""
PRINTING = {
    name
    for name, value in functions().items()
    if any(issubclass(group, Printed) for group in getattr(declared_of(value), "groups", ()))
}
"""Commands whose results are printed."""


def tried() -> set[str]:
    return {name for name in PRINTING for item in LINES if f"{item} ".startswith(f"{name} ")}


LINES += [
    shlex.join(line)
    for name in functions()
    if name in PRINTING - tried() and (line := line_of(name))
]
TRIED = few(
    LINES,
    {*LINES}
    - {
        "balance four-row-transplanter",
        "balance yamashita-1",
        "check study-of-lengths",
        "respond riding-transplanter --speed '60 rpm : 150 rpm' --speeds 8",
    },
)
"""Without the slow ones of commands that others show on every change."""
STAND_OUT = [
    "balance balance-shafts",
    "balance balance-spring",
    "balance four-row-transplanter",
    "exposure 'mowing: 4.6 m/s^2 for 2 h' 'sawing: 9 m/s^2 for 2 h'",
    "exposure --idle '3.1 m/s^2' --racing '9 m/s^2' --duration '3 h'",
    "plant fit kim-chung-a targets.toml --out fitted.toml",
    "plant transplanter",
    "tool brush-cutter",
    "tool design tool.toml",
]
"""Where a limit is broken, or something got worse."""


class Told:
    """What a command tells: as text by width, as cells, and as texts that stand out."""

    def __init__(self, title: str | None, blocks: Iterable[Block | ReportSection]) -> None:
        parts = [*blocks]
        self.by_width = {width: shown(title, parts, width) for width in WIDTHS}
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("FORCE_COLOR", "1")
            self.coloured = shown(title, parts, 80)
        self.whole = [
            line for part in parts if isinstance(part, FileText) for line in lines_of(part)
        ]
        reported = [grid(item) for item in within(parts) if isinstance(item, Table)]
        self.cells = [cell for item in reported for row in item.rows for cell in row]
        texts = [item for item in within(parts) if isinstance(item, Text) and item.emphasis]
        self.marked = len(texts), sum(cell.emphasis is not None for cell in self.cells)


def shown(title: str | None, blocks: Iterable[Block | ReportSection], width: int) -> str:
    return block_text(title, blocks, width)


def lines_of(item: FileText) -> list[str]:
    """Lines to be pasted, which stay whole."""
    return plain(item.text).splitlines()


def within(blocks: Iterable[Block | ReportSection]) -> Iterator[Block | ReportSection]:
    for block in blocks:
        yield from within(block.blocks) if isinstance(block, ReportSection) else [block]


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that commands are given."""
    folder = tmp_path_factory.mktemp("widths")
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@cache
def run(line: str, place: Path) -> list[Told]:
    """What a command line shows, run once for all widths."""
    if line.startswith(("resume", "best")):
        run("sweep study.toml --out designs.zarr", place)
    actual: list[Told] = []

    def keep(title: str | None, blocks: Iterable[Block | ReportSection], **_: int | None) -> str:
        actual.append(Told(title, blocks))
        return ""

    with pytest.MonkeyPatch.context() as patch, chdir(place):
        patch.setattr(equipoise.present.terminal, "block_text", keep)
        succeeded(equipoise_runs(*shlex.split(line)))
    assert actual
    return actual


def test_no_command_is_left_out() -> None:
    """A new one joins by the example of its file, or by a line."""
    assert tried() == PRINTING


@pytest.mark.parametrize("line", TRIED)
def test_no_line_is_wider_than_the_terminal(line: str, place: Path) -> None:
    """But where a single word is."""
    for reported in run(line, place):
        for width, text in reported.by_width.items():
            lines = (item for item in text.splitlines() if item not in reported.whole)
            wide = [item for item in lines if cell_len(item) > width and len(item.split()) > 1]
            assert wide == [], width


@pytest.mark.parametrize("line", TRIED)
def test_nothing_is_lost_at_any_width(line: str, place: Path) -> None:
    for reported in run(line, place):
        numbers = [cell for cell in reported.cells if cell.number]
        wanted = Counter(
            word for number in numbers for word in f"{number.text} {number.at}".split()
        )
        words = {
            word for item in reported.cells if not item.number for word in plain(item.text).split()
        }
        for text in reported.by_width.values():
            assert wanted - Counter(text.replace(", over the limit", " over").split()) == Counter()
            parts = (part for word in words for part in re.split("(?<=[./-])", word))
            assert [part for part in parts if part not in text] == []


@pytest.mark.parametrize("line", TRIED)
def test_what_stands_out_does_so_with_and_without_colour(line: str, place: Path) -> None:
    for printed in run(line, place):
        sentences, cells = printed.marked
        for text in printed.by_width.values():
            assert len(re.findall("^! ", text, re.MULTILINE)) == sentences
            assert len(re.findall(r"over the limit| worse\b", text)) >= cells
        assert printed.coloured.count("\x1b[1;31m") >= sentences + cells
        assert "\x1b" not in printed.by_width[80]
    if line in STAND_OUT:
        assert any(any(reported.marked) for reported in run(line, place))
