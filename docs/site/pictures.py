"""The pictures that pages show: each is made by the command that its path tells, or is a sketch.

``/moving/NAME.svg`` is a machine that moves, ``/drawn/NAME/PICTURE.svg`` one of `equipoise plot`,
``/sketches/NAME.svg`` one of `sketches.py`, ``/demonstrations/NAME/PICTURE.svg`` one of
`demonstrations.py`.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable
from contextlib import chdir, redirect_stderr, redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

from demonstrations import DEMONSTRATIONS
from sketches import SKETCHES

from equipoise import examples
from equipoise.cli import run
from equipoise.results.result import in_own_words

SHOWN = re.compile(r"\]\((/(?:moving|drawn|sketches|demonstrations)/[\w/-]+\.svg)\)")
PLOT = re.compile(r"^!\[([^\]]*)\]\((/drawn/[\w/-]+\.svg)\)$", re.MULTILINE)
NARROW = "-narrow.svg"
"""How the name of a picture ends that is drawn for a telephone."""


def command_of(path: str) -> str:
    """The command that makes a picture, in the folder of its kind."""
    _, kind, name, *more = path.removesuffix(".svg").split("/")
    if kind == "moving":
        option = "--mode 3" if name in examples("tool") else "--force"
        return f"animate {name} {option} -o {name}.svg"
    return f"plot {name} --only {more[0]} -o {name}"


def draw(pages: Iterable[str], into: Path) -> None:
    """Make every picture that pages show.

    Raises
    ------
    RuntimeError : a command does not make what it should.
    """
    told = StringIO()
    shown = sorted({path for page in pages for path in SHOWN.findall(page)})
    _demonstrate([path for path in shown if path.startswith("/demonstrations/")], into)
    for path in shown:
        kind, name = path.split("/")[1:3]
        if kind == "demonstrations":
            continue
        folder = into / kind
        folder.mkdir(exist_ok=True)
        if kind == "sketches":
            (folder / name).write_text(SKETCHES[name.removesuffix(".svg")]().svg(), "utf-8")
            continue
        with chdir(folder), redirect_stdout(told), redirect_stderr(told):
            if run(command_of(path).split()):
                raise RuntimeError(f"equipoise {command_of(path)}: {told.getvalue()}")


def draw_narrow(pages: Iterable[str], into: Path) -> None:
    """Draw the plots that pages show for narrow screens too, where they are not wide ones."""
    from equipoise.figures import is_wide
    from equipoise.figures.layout import HALF, lay_out
    from equipoise.figures.vector import svg_of
    from equipoise.present.findings import find
    from equipoise.present.pictures import each

    shown = sorted({path for page in pages for path in SHOWN.findall(page)})
    found = cache(find)
    for path in shown:
        _, kind, name, *more = path.removesuffix(".svg").split("/")
        if kind != "drawn":
            continue
        findings = found(name)
        with in_own_words(findings.owner):
            chart = next(one for one in each(findings) if one.name == more[0]).chart
            if not is_wide(chart):
                file = into / f"{path.removesuffix('.svg')}{NARROW}".lstrip("/")
                file.write_text(svg_of(lay_out(chart, HALF)), encoding="utf-8")


def for_both_widths(text: str, source: Path) -> str:
    """A page that shows instead of a plot the one that is drawn for the width of the screen."""

    def both(match: re.Match[str]) -> str:
        narrow = match[2].replace(".svg", NARROW)
        if not (source / narrow.lstrip("/")).exists():
            return match[0]
        pairs = ((match[2], "where-wide"), (narrow, "where-narrow"))
        return "\n\n".join(
            f"```{{image}} {path}\n:alt: {match[1]}\n:class: {width}\n```" for path, width in pairs
        )

    return PLOT.sub(both, text)


def _demonstrate(paths: Iterable[str], into: Path) -> None:
    """Keep of what demonstrations write the pictures that are shown."""
    wanted: dict[str, list[str]] = {}
    for path in paths:
        name, picture = path.split("/")[2:]
        wanted.setdefault(name, []).append(picture)
    for name, pictures in wanted.items():
        target = into / "demonstrations" / name
        target.mkdir(parents=True)
        with TemporaryDirectory() as folder, redirect_stdout(StringIO()):
            DEMONSTRATIONS[name](Path(folder))
            for picture in pictures:
                shutil.copy(Path(folder) / picture, target)
