"""What is read of other programs: one declaration a format."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.exchange.reading import dxf, linkage2, mjcf, pmks, svg, urdf
from equipoise.exchange.reading.imported import Imported, Read, finished
from equipoise.exchange.reading.markup import tree_of
from equipoise.exchange.reading.spatial import SpatialOptions as Bodies
from equipoise.exchange.reading.strokes import Marks
from equipoise.i18n import Note
from equipoise.quantities import in_si
from equipoise.schema.files import FileError, printable, read_bytes, read_text

SMALL, LARGE = 2_000_000, 20_000_000
"""Bytes of a text, and of a drawing, that are read at most."""


DRAWING_OPTIONS = ("frame", "guide", "link", "tolerance", "unit")


MODELS = ("frame", "pin")
"""Options of models of bodies in space."""


@dataclass(frozen=True)
class ImportOptions:
    """Options of an import.  unit : m in a unit of the file; `None` for the unit that it states."""

    marks: Marks
    bodies: Bodies
    unit: float | None


@dataclass(frozen=True)
class ImportFormat:
    """One kind of file.

    holds : what is read of it.  endings : of its files.  root : of its XML, where it is XML.
    read : the machine of its content: XML by its root, text, or bytes.
    takes : which options it takes besides `crank` and `speed`.
    """

    name: str
    title: str
    holds: str
    endings: tuple[str, ...]
    read: Callable[[Any, ImportOptions], Read]
    root: str = ""
    takes: tuple[str, ...] = ("unit",)


FORMATS: Mapping[str, ImportFormat] = {
    item.name: item
    for item in (
        ImportFormat(
            "dxf",
            "DXF drawing",
            "lines, polylines, circles, hatchings, blocks",
            (".dxf",),
            lambda data, options: dxf.read(data, options.marks, options.unit),
            takes=DRAWING_OPTIONS,
        ),
        ImportFormat(
            "svg",
            "SVG drawing",
            "lines, paths, polygons, circles, groups",
            (".svg",),
            lambda root, options: svg.read(root, options.marks, options.unit),
            "svg",
            takes=DRAWING_OPTIONS,
        ),
        ImportFormat(
            "mjcf",
            "MuJoCo (MJCF)",
            "bodies, hinges, slides, connect, weld, gears, springs, "
            "masses of bodies and shapes, the drive",
            (".xml", ".mjcf"),
            lambda root, options: mjcf.read(root, options.bodies),
            "mujoco",
            MODELS,
        ),
        ImportFormat(
            "urdf",
            "URDF",
            "links, revolute, continuous, prismatic, planar and fixed joints, mimic, masses",
            (".urdf",),
            lambda root, options: urdf.read(root, options.bodies),
            "robot",
            MODELS,
        ),
        ImportFormat(
            "linkage2",
            "Linkage",
            "connectors, links, anchors, sliders, the input",
            (".linkage2", ".linkage"),
            lambda root, options: linkage2.read(root, options.unit),
            "linkage2",
        ),
        ImportFormat(
            "pmks",
            "PMKS+",
            "joints, links, sliders on the frame, the input",
            (".pmks",),
            lambda text, options: pmks.read(text, options.unit),
        ),
    )
}
"""By name."""


def import_machine(
    path: str | os.PathLike[str],
    *,
    crank: str = "",
    speed: float | str | None = None,
    frame: Iterable[str] = (),
    guide: Iterable[str] = (),
    link: Iterable[str] = (),
    pin: Iterable[str] = (),
    tolerance: float | str = 0.0,
    unit: float | str | None = None,
) -> Imported:
    """Read a machine from a file of another program.

    Parameters
    ----------
    path : of a drawing (DXF, SVG), a model (MJCF, URDF), or a file of Linkage or PMKS+; the
        format is detected from content and extension.
    crank : name of the driven link; by default the file's, or one that turns fully.
    speed : of the crank, rad/s, or a text such as ``"300 rpm"``; other than 0.
    frame : names of layers, colours or groups of a drawing, or of bodies of a model, that stand
        still.
    guide : those of lines on which ends of links slide.
    link : names; what is drawn under each of them is one link.
    pin : two bodies or sites each that a pin joins, as ``A = B``, where a model closes no loops.
    tolerance : distance below which ends of lines meet, m, or a text such as ``"0.1 mm"``; 0 for a
        millionth of the drawing.
    unit : m in a unit of the drawing, or a text such as ``"1 in"``; default: as it states.

    Returns
    -------
    Imported
        The machine, what is missing of it, and what was assumed.

    Raises
    ------
    ModelError, UsageError : one sentence: what of the file cannot be read, or which argument.
    """
    source = printable(path) or "''"
    speed = in_si(speed, "angular speed", "speed")
    tolerance, unit = in_si(tolerance, "length", "tolerance"), in_si(unit, "length", "unit")
    if speed == 0:
        raise UsageError(
            at_place(
                "--speed", Note("a crank that stands still moves nothing; give such as 250 rpm")
            )
        )
    bodies = Bodies(tuple(frame), tuple(pin))
    options = ImportOptions(Marks(tuple(frame), tuple(guide), tuple(link), tolerance), bodies, unit)
    try:
        kind, content = _opened(path)
        _check(kind, options)
        read = kind.read(content, options)
    except FileError as problem:
        raise ModelError("", problem.note, source) from problem
    except ModelError as error:
        raise error.in_file(source) from error
    try:
        return finished(_titled(read, path), crank, speed)
    except ModelError as error:
        raise error.in_file(source) from error


def _titled(read: Read, path: str | os.PathLike[str]) -> Read:
    """With the name of the file as the title where it has none that can be printed."""
    rest = dict(read.outline.rest)
    title = " ".join(str(rest.get("title", "")).split())[:150]
    stem = Path(os.fspath(path)).stem
    rest["title"] = title if title.isprintable() and title else printable(stem) or "imported"
    return replace(read, outline=replace(read.outline, rest=rest))


def _check(kind: ImportFormat, options: ImportOptions) -> None:
    """Refuse what would do nothing."""
    marks = options.marks
    given = {"frame": marks.frame, "guide": marks.guide, "link": marks.link,
             "pin": options.bodies.pins, "tolerance": marks.tolerance,
             "unit": options.unit}  # fmt: skip
    for option, value in given.items():
        if value and option not in kind.takes:
            known = ", ".join(f"--{item}" for item in ("crank", "speed", *kind.takes))
            raise UsageError(
                Note(
                    "--{option} does nothing to {title}; it takes {known}",
                    option=option,
                    title=kind.title,
                    known=known,
                )
            )


def _opened(path: str | os.PathLike[str]) -> tuple[ImportFormat, Any]:
    """The kind of a file by its content and its ending, and what is in it."""
    ending = Path(os.fspath(path)).suffix.casefold()
    by_ending = next((format for format in FORMATS.values() if ending in format.endings), None)
    is_drawing = by_ending in (FORMATS["dxf"], FORMATS["svg"])
    if by_ending is FORMATS["dxf"] and not (data := read_bytes(path, LARGE)).startswith(b"<"):
        return by_ending, data
    text = read_text(path, LARGE if is_drawing else SMALL)
    if by_ending is FORMATS["pmks"] or re.match(r"\s*https?://\S+\?\S+\s*$", text):
        return FORMATS["pmks"], text
    if not by_ending and not text.lstrip().startswith("<"):
        known = ", ".join(ending for kind in FORMATS.values() for ending in kind.endings)
        raise ModelError(
            "", Note("it is of no kind that is read; give one of {known}", known=known)
        )
    root: Element = tree_of(text)
    kind = next((item for item in FORMATS.values() if item.root and item.root == root.tag), None)
    if kind is None:
        known = ", ".join(
            f"<{kind_of_file.root}>" for kind_of_file in FORMATS.values() if kind_of_file.root
        )
        raise ModelError(
            "",
            Note(
                "its XML begins with <{tag}>; what is read begins with {known}",
                tag=root.tag[:40],
                known=known,
            ),
        )
    return kind, root
