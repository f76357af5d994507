"""SVG drawings: lines, paths, polygons and circles, with their groups' names; y goes upward."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any
from xml.etree.ElementTree import Element

from equipoise.errors import ModelError, at_place, needed
from equipoise.exchange.reading.imported import Read
from equipoise.exchange.reading.markup import called, number, numbers
from equipoise.exchange.reading.strokes import (
    Drawing,
    DrawnLine,
    Marks,
    Ring,
    skeleton,
    within_reach,
)
from equipoise.i18n import Note

METRES = {"": 0.0254 / 96, "px": 0.0254 / 96, "mm": 1e-3, "cm": 1e-2, "in": 0.0254,
          "pt": 0.0254 / 72, "pc": 0.0254 / 6}  # fmt: skip
"""m in the units of CSS."""
UNSEEN = {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "metadata", "style", "title"}
NUMBERED = re.compile(r"(svg|g|path|line|polyline|polygon|rect|circle|layer|use)[-_]?[0-9.-]*")
"""Names that programs give by themselves."""
LONGEST = 200_000
"""Signs of a path or of corners."""


def read(root: Element, marks: Marks, unit: float | None) -> Read:
    """The machine of a drawing.

    unit : m in a unit of it, instead of the unit that it states.

    Raises
    ------
    ModelError : it cannot be read, or has no lines.
    """
    drawing = Drawing(root.findtext("title", "").strip())
    scale = _scale(root, drawing) if unit is None else unit
    shapes = needed("svgelements", "an SVG drawing")
    _Reader(drawing, shapes, scale).inside(root, shapes.Matrix(), ())
    return skeleton(drawing, marks)


def _scale(root: Element, drawing: Drawing) -> float:
    """m in a unit of the drawing: its size over that of its view box, else 96 units an inch."""
    box = numbers(root, "viewBox", "0 0 0 0", (4,))
    across, up = _side(root, "width", box[2]), _side(root, "height", box[3])
    if across is None:
        drawing.note(
            Note("the drawing has no width with a unit: 96 of its units are assumed to be an inch")
        )
        return METRES[""]
    if up is None or abs(up - across) <= 1e-3 * up:  # programs round sizes
        return across
    aspect = root.get("preserveAspectRatio", "")
    if aspect.strip() == "none":
        raise ModelError(
            "svg",
            Note(
                "it is stretched: width and height over those of its view box are not "
                "the same; give its unit by --unit"
            ),
        )
    return max(across, up) if "slice" in aspect else min(across, up)


def _side(root: Element, key: str, units: float) -> float | None:
    """m in a unit along a side of the drawing; `None` without a length."""
    size = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", root.get(key, ""))
    if size is None or size[2] not in METRES:
        return None
    try:
        length = float(size[1])
    except ValueError:
        raise ModelError(
            "svg", at_place(key, Note("got {size!r}; give a length such as 200mm", size=size[0]))
        ) from None
    if units <= 0:
        return METRES[size[2]]
    if not length > 0:
        raise ModelError("svg", at_place(key, Note("got {size!r}; give more than 0", size=size[0])))
    return METRES[size[2]] * length / units


class _Reader:
    def __init__(self, drawing: Drawing, shapes: Any, scale: float) -> None:
        self.drawing, self.shapes, self.scale = drawing, shapes, scale

    def inside(self, parent: Element, at: Any, names: tuple[str, ...]) -> None:
        """Everything that is drawn in an element."""
        for element in parent:
            if element.tag in UNSEEN or "none" in (
                element.get("display"),
                _style(element, "display"),
            ):
                continue
            if element.tag == "use":
                self.drawing.note(Note("copies by <use> are left out"))
                continue
            inner = at
            if text := element.get("transform"):
                inner = self._library(element, self.shapes.Matrix, text) * at
            own = (*self._names(element), *names)
            if element.tag in ("g", "a", "svg", "switch"):
                self.inside(element, inner, own)
            elif element.tag == "circle":
                self._circle(element, inner, own)
            else:
                self._stroke(element, inner, own)

    def _library(self, element: Element, make: Any, text: str) -> Any:
        if len(text) > LONGEST:
            raise ModelError(
                called(element), Note("it has more than {longest:,} signs", longest=LONGEST)
            )
        try:
            return make(text)
        except Exception as error:  # of many kinds
            raise ModelError(
                called(element), Note("{text!r} cannot be read", text=text[:40])
            ) from error

    def _names(self, element: Element) -> Iterator[str]:
        """Name, layer, classes and colour."""
        given = [element.get(key) for key in ("id", "label", "stroke")]
        for name in (*given, *element.get("class", "").split(), _style(element, "stroke")):
            if name and name != "none" and not NUMBERED.fullmatch(name):
                yield name

    def _place(self, x: float, y: float, at: Any) -> complex:
        place = complex(at.a * x + at.c * y + at.e, -(at.b * x + at.d * y + at.f))
        return within_reach(place * self.scale)

    def _circle(self, element: Element, at: Any, names: tuple[str, ...]) -> None:
        x, y, r = (number(element, key, "0") for key in ("cx", "cy", "r"))
        center = self._place(x, y, at)
        radius = abs(self._place(x + r, y, at) - center)
        self.drawing.rings.append(Ring(center, radius, names))

    def _stroke(self, element: Element, at: Any, names: tuple[str, ...]) -> None:
        for corners, closed in self._corners(element):
            places = [self._place(x, y, at) for x, y in corners]
            if closed and len(places) > 2 and places[0] == places[-1]:
                places.pop()
            if len(places) > 1:
                self.drawing.strokes.append(DrawnLine(tuple(places), names, closed))

    def _corners(self, element: Element) -> Iterator[tuple[list[tuple[float, float]], bool]]:
        """Corners of each line of an element, and whether it comes back."""
        if element.tag == "line":
            x, y, u, v = (number(element, key, "0") for key in ("x1", "y1", "x2", "y2"))
            yield [(x, y), (u, v)], False
        elif element.tag in ("polyline", "polygon"):
            flat = numbers(element, "points", "")
            yield [*zip(flat[::2], flat[1::2], strict=False)], element.tag == "polygon"
        elif element.tag == "rect":
            x, y, w, h = (number(element, key, "0") for key in ("x", "y", "width", "height"))
            yield [(x, y), (x + w, y), (x + w, y + h), (x, y + h)], True
        elif element.tag == "path":
            path = self._library(element, self.shapes.Path, element.get("d", ""))
            for part in path.as_subpaths():
                ends = [(item.end.x, item.end.y) for item in part if item.end is not None]
                yield ends, type(part[-1]).__name__ == "Close"


def _style(element: Element, key: str) -> str:
    """A value of the attribute `style`."""
    match = re.search(rf"(?:^|;)\s*{key}\s*:\s*([^;]+)", element.get("style", ""))
    return match[1].strip() if match else ""
