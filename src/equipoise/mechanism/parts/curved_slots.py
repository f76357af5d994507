"""Pins in curved slots (point-on-curve joints), as frozen values with their checks.

The rider of such a joint is a body without mass at the pin whose x axis goes along the curve; where
it is on the curve is found by Newton's method with the links that hang on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, localized, say, series, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import (
    ROW,
    File,
    Flag,
    KeyConditions,
    Listing,
    Point,
    TextKind,
    declared,
    inside,
    key,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.joint_kinds import BEYOND, JointKind, Rider, Track
from equipoise.quantities import Dimension, format_quantity

if TYPE_CHECKING:
    from equipoise.mechanism.formulas.curves import PlaneCurve

MOST_POINTS = 400
FEWEST, FEWEST_CLOSED = 2, 4
"""Points of an open curve, and of one that is closed."""
COINCIDENT = 1e-6
"""Of the curve's length: points nearer to each other coincide."""


@declared
class CurveTable(CsvTable):
    """Points of a curve, in its axes, m.

    x, y : of the points, in their order.  file : name of the CSV file that they came from.
    """

    sort = "curve"
    forms = (("x", "y"),)
    columns: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "x": ("length", "mm"), "y": ("length", "mm"),
    }  # fmt: skip
    rises = False

    x: tuple[float, ...] = inside(ROW)
    y: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class CurvedSlot(JointKind):
    """A pin at `point` of `link` in a slot of the body `on`, along a curve through points."""

    called = to_say("{what} of curved slot {number}")
    list_name = "curved_slots"
    list_text = "pins in slots along smooth curves"
    order = 2
    file_order = (
        "link",
        "point",
        "on",
        "origin",
        "points",
        "table",
        "closed",
        "direction",
        "label",
    )
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": [name]} for name in ("points", "table")]
    }
    still: ClassVar[tuple[str, ...]] = ("points", "table")

    base = "origin"
    legend = ("path", to_say("slot"))
    sign = "equipoise.symbols.slots:curved_sign"
    title = to_say("Curved slots, each with its crank angle; distances along the curve")
    group = to_say("curved slots")
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "distance": (
            "length",
            with_meaning(
                "distance along curved slot {name}",
                "Distance of the pin along the centre line of a slot from its first point.",
            ),
        ),
        "speed": (
            "speed",
            with_meaning(
                "sliding speed in curved slot {name}",
                "Speed of the pin along the centre line of the slot.",
            ),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "distance": (to_say("smallest distance"), to_say("largest")),
        "speed": (to_say("smallest sliding speed"), to_say("largest")),
    }

    origin: str = key(
        TextKind(of="point", on="on"),
        "a point of that, from which the points of the curve are given",
        example="S",
        word=to_say("origin of the curve"),
    )
    points_given: tuple[tuple[float, float], ...] = key(
        Listing(
            Point(), (), Note('a list of points such as [["0 mm", "0 mm"], ["40 mm", "25 mm"]]')
        ),
        "through which the middle line of the slot goes, in this order, from `origin` in axes "
        "turned by `direction`; a quintic spline",
        name="points",
        word=to_say("points"),
        default=(),
        example=[["0 mm", "0 mm"], ["40 mm", "25 mm"], ["90 mm", "20 mm"]],
    )
    table: CurveTable | None = key(
        File("curve"), "CSV file beside this one, instead of `points`: `x [mm],y [mm]`",
        default=None, example="curve.csv",
    )  # fmt: skip
    closed: bool = key(
        Flag(), "the curve goes on smoothly from its last point to its first", default=False
    )
    direction: float = key("angle", "of the curve's x axis, in the axes of `on`", default=0.0)

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Points of the curve in its axes, m."""
        table = self.table
        return self.points_given if table is None else (*zip(table.x, table.y, strict=True),)

    @property
    def curve(self) -> PlaneCurve:
        """The slot's middle line, in its axes."""
        from equipoise.mechanism.formulas.curves import curve_through

        return curve_through(self.places, self.closed)

    @property
    def axed(self) -> tuple[str, ...]:
        return (self.on,)

    def rider(self) -> Rider:
        """A body at the pin, whose x axis goes along the curve."""
        points_on_bodies = {self.link: {self.name: self.point}}
        track = Track(self.curve, self.origin, self.direction)
        return Rider(self.link, self.on, {self.name: (0.0, 0.0)}, points_on_bodies, track=track)

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Arc length from the first point to the pin, m, and the pin's speed along that, m/s."""
        at.on_track(self.name, BEYOND)
        distance, speed = at.along(self.name)
        return {"distance": distance, "speed": speed}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from super().problems(where, bodies)
        if bool(self.points_given) == (self.table is not None):
            yield ModelError(where, Note("give exactly one of points and table"))
            return
        at = f"{where}.points" if self.table is None else f"{where}.table"
        yield from (ModelError(at, wrong) for wrong in self._wrong_places())

    def _wrong_places(self) -> Iterator[Note]:
        places = [complex(*place) for place in self.places]
        fewest = FEWEST_CLOSED if self.closed else FEWEST
        if not fewest <= len(places) <= MOST_POINTS:
            yield Note("got {count} points; give {fewest} to {most}",
                       count=len(places), fewest=fewest, most=MOST_POINTS)  # fmt: skip
            return
        steps = [abs(b - a) for a, b in pairwise(places)]
        size = sum(steps)
        for number, step in enumerate(steps, 1):
            if not step > COINCIDENT * size:
                yield Note("points {number} and {after} coincide; leave one of them out",
                           number=number, after=number + 1)  # fmt: skip
                return
        if self.closed and not abs(places[-1] - places[0]) > COINCIDENT * size:
            yield Note("the last point is the first again, to which a closed curve goes on by "
                       "itself; leave it out")  # fmt: skip

    def too_sharp(self, radius: float) -> Note | None:
        """Say where the curve bends too sharply for a pin of this radius, m; None where it does
        not.
        """
        least, at = self.curve.sharpest
        if least > radius:
            return None
        return Note(
            "its radius of curvature is {least} at {at} from the first point, and the pin has a "
            "radius of {radius}; give points of a curve that bends less sharply, or a thinner pin",
            least=format_quantity(least, "length"),
            at=format_quantity(at, "length"),
            radius=format_quantity(radius, "length"),
        )

    def sentence(self) -> Note:
        """Length of a curved slot, its pin and its bodies, for a report."""
        return Note("Curved slot: {point} of {link} on a curve of {length} in {on}",
                    point=self.point, link=self.link, on=self.on,
                    length=format_quantity(self.curve.length, "length"))  # fmt: skip

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        template = to_say("curve through {count} points, {length} long")
        if self.closed:
            template = to_say("closed curve through {count} points, {length} long")
        length = format_quantity(self.curve.length, "length")
        parts = [say(template, count=len(self.places), length=length)]
        radius, at = self.curve.sharpest
        if radius < float("inf"):
            parts.append(
                say(
                    "smallest radius of curvature {radius} at {place}",
                    radius=format_quantity(radius, "length"),
                    place=format_quantity(at, "length"),
                )
            )
        return say(
            "curved slot: {point} of {link} in {on}, {parts}",
            point=self.point,
            link=self.link,
            on=self.on,
            parts=localized(series(parts)),
        )
