"""DXF drawings by ezdxf: lines, circles and hatchings of the model space, blocks taken apart."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from io import BytesIO
from itertools import count as count_from
from typing import Any

from equipoise.errors import EquipoiseError, ModelError, needed
from equipoise.exchange.reading.imported import Read
from equipoise.exchange.reading.strokes import (
    WORDS,
    Drawing,
    DrawnLine,
    Marks,
    Ring,
    skeleton,
    within_reach,
)
from equipoise.i18n import Note
from equipoise.limits import check_memory

UNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 8: 2.54e-8, 9: 2.54e-5, 10: 0.9144,
         13: 1e-6, 14: 0.1}  # fmt: skip
"""m in a unit of $INSUNITS."""
MILLIMETRE = 1e-3
COLOURS = {1: "red", 2: "yellow", 3: "green", 4: "cyan", 5: "blue", 6: "magenta", 7: "white"}
DEEPEST, MOST = 6, 20_000
"""Blocks in blocks, and entities in all."""
NONE = Note("this is no DXF drawing that can be read; save it anew")
DAMAGED = "recovered invalid floating"
"""How ezdxf begins a warning that it has read a number otherwise than it is written."""
SKEW = 1e-6
"""How far a line may leave the plane over its distance from the origin: rounding."""
MATRICES = 3
"""Of the size of a spline's points squared, that ezdxf holds at a time."""
CURVES = {"ARC", "ELLIPSE", "SPLINE", "LINE", "LWPOLYLINE", "POLYLINE"}


def read(data: bytes, marks: Marks, unit: float | None) -> Read:
    """The machine of a drawing.

    unit : m in a unit of it, instead of the unit that it states.

    Raises
    ------
    ModelError : it cannot be read, or has no lines.
    """
    recover = needed("ezdxf.recover", "a DXF drawing")
    if b"ENTITIES" not in data:
        raise ModelError("", NONE)
    try:
        with _warnings() as warnings:
            document, _ = recover.read(BytesIO(data))
            drawing = _drawing(document, unit)
    except (EquipoiseError, MemoryError):
        raise
    except Exception as error:  # of many kinds, where a file is damaged
        raise ModelError("", NONE) from error
    if damaged := next((warning for warning in warnings if warning.startswith(DAMAGED)), ""):
        line = damaged.partition(" near line ")[2].partition(" ")[0]
        raise ModelError(
            "", Note("near line {line} of the drawing a number is damaged; save it anew", line=line)
        )
    return skeleton(drawing, marks)


@contextmanager
def _warnings() -> Iterator[list[str]]:
    """Collect warnings of ezdxf, which are not logged."""
    warnings: list[str] = []
    handler = logging.Handler()
    handler.emit = lambda record: warnings.append(record.getMessage())  # type: ignore[method-assign]
    logger = logging.getLogger("ezdxf")
    logger.addHandler(handler)
    propagated, logger.propagate = logger.propagate, False
    try:
        yield warnings
    finally:
        logger.propagate = propagated
        logger.removeHandler(handler)


def _drawing(document: Any, unit: float | None) -> Drawing:
    drawing = Drawing("")
    units = UNITS.get(int(document.header.get("$INSUNITS", 0)))
    if unit is None and units is None:
        drawing.note(Note("the drawing has no unit; millimetres are assumed, --unit gives another"))
    scale = unit or units or MILLIMETRE
    for entity in _entities(document, document.modelspace()):
        _add(drawing, entity, scale)
    return drawing


def _entities(document: Any, entities: Iterable[Any]) -> Iterator[Any]:
    """What is seen, with blocks taken apart."""
    hidden = {layer.dxf.name.casefold() for layer in document.layers
              if layer.is_off() or layer.is_frozen()}  # fmt: skip
    left = deque((entity, 0) for entity in entities)
    for count in count_from(1):
        if not left:
            return
        entity, deep = left.popleft()
        inserted = entity.dxftype() == "INSERT"
        if count > MOST or (inserted and entity.mcount > MOST):
            raise ModelError(
                "", Note("the drawing has more than {most:,} entities; give a skeleton", most=MOST)
            )
        if entity.dxf.layer.casefold() in hidden or entity.dxf.get("invisible", 0):
            continue
        if not inserted:
            yield entity
        elif deep == DEEPEST:
            raise ModelError(
                "",
                Note(
                    "its blocks are nested more than {levels} levels; take them apart",
                    levels=DEEPEST,
                ),
            )
        else:
            single = entity.multi_insert() if entity.mcount > 1 else (entity,)
            parts = [
                (virtual_entity, deep + 1)
                for part in single
                for virtual_entity in part.virtual_entities()
            ]
            left.extendleft(reversed(parts))


def _add(drawing: Drawing, entity: Any, scale: float) -> None:
    from ezdxf.path import from_hatch, make_path

    kind = entity.dxftype()
    colour = COLOURS.get(entity.dxf.get("color", 256), "")
    names = tuple(filter(None, (entity.dxf.layer, colour)))
    if kind == "CIRCLE":
        x, y, _ = entity.ocs().to_wcs(entity.dxf.center)
        drawing.rings.append(Ring(_place(x, y, scale), float(entity.dxf.radius) * scale, names))
    elif kind == "POINT":
        x, y, _ = entity.dxf.location
        drawing.rings.append(Ring(_place(x, y, scale), 0.0, names))
    elif kind == "TEXT" and entity.dxf.layer.casefold() == WORDS:
        word = entity.dxf.text.strip()
        x, y, _ = entity.dxf.insert
        if word and word.isprintable():
            drawing.words.append((_place(x, y, scale), word[:100]))
    elif kind == "HATCH":
        drawing.areas += [DrawnLine(tuple(_corners(path, scale)), names, True)
                          for path in from_hatch(entity) if len(path)]  # fmt: skip
    elif kind in CURVES:
        if kind == "SPLINE":
            _check_size(entity)
        path = make_path(entity)
        if not len(path):
            return
        _check_flat(path, entity.dxf.layer)
        places = [*_corners(path, scale)]
        closed = len(places) > 2 and abs(places[-1] - places[0]) < 1e-12 * scale
        drawing.strokes.append(DrawnLine(tuple(places[:-1] if closed else places), names, closed))


def _check_size(spline: Any) -> None:
    """Pieces of a spline come from equations between all of its points, which ezdxf holds whole."""
    count = max(len(spline.control_points), len(spline.fit_points))
    layer = spline.dxf.layer
    what = Note("a spline of {count} points, of the layer {layer!r}", count=count, layer=layer)
    check_memory(MATRICES * 8.0 * count**2, what)


def _check_flat(path: Any, layer: str) -> None:
    """Links may lie above one another, each at its own height; none may lie askew."""
    heights = [float(control_vertex.z) for control_vertex in path.control_vertices()]
    low, high = min(heights), max(heights)
    if high - low > SKEW * max(map(abs, path.control_vertices())):
        raise ModelError(
            "",
            Note(
                "a line of the layer {layer!r} leaves the plane xy: its z goes from "
                "{low:g} to {high:g}; draw the machine flat, seen along its axes",
                layer=layer,
                low=low,
                high=high,
            ),
        )


def _corners(path: Any, scale: float) -> Iterator[complex]:
    """The start, and the end of every piece."""
    yield _place(path.start.x, path.start.y, scale)
    yield from (_place(command.end.x, command.end.y, scale) for command in path.commands())


def _place(x: float, y: float, scale: float) -> complex:
    return within_reach(complex(x, y) * scale)
