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
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

from demonstrations import DEMONSTRATIONS
from sketches import SKETCHES

from equipoise import examples
from equipoise.cli import run

SHOWN = re.compile(r"\]\((/(?:moving|drawn|sketches|demonstrations)/[\w/-]+\.svg)\)")


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
