"""Pins in circular slots, as frozen values with their checks.

The rider of such a joint is a link without mass from the slot's centre to the pin, so that all of
it is solved in closed form, by dyads.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import pi
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, say, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import Listing, Quantity, TextKind, declared, key
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.joint_kinds import BEYOND, JointKind, Rider
from equipoise.quantities import Dimension, Measured, format_quantity


@declared
class CircularSlot(JointKind):
    """A pin at `point` of `link` in a slot of the body `on`, a circle about `center` of that."""

    called = to_say("{what} of circular slot {number}")
    list_name = "circular_slots"
    list_text = "pins in circular slots"
    order = 1
    file_order = ("link", "point", "on", "center", "radius", "arc", "label")

    base = "center"
    legend = ("path", to_say("slot"))
    sign = "equipoise.symbols.slots:circular_sign"
    title = to_say("Circular slots, each with its crank angle; angles in the axes of their bodies")
    group = to_say("circular slots")
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "angle": (
            "angle",
            with_meaning(
                "angle in circular slot {name}", "Angle of the pin about the centre of the slot."
            ),
        ),
        "speed": (
            "speed",
            with_meaning(
                "sliding speed in circular slot {name}", "Speed of the pin along the slot."
            ),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "angle": (to_say("smallest angle"), to_say("largest")),
        "speed": (to_say("smallest sliding speed"), to_say("largest")),
    }

    center: str = key(
        TextKind(of="point", on="on"), "a point of that, the centre of the slot", example="S",
        word=to_say("centre of the slot"),
    )  # fmt: skip
    radius: float = key("length", "of its middle line", example="60 mm", above=0)
    arc: tuple[float, ...] = key(
        Listing(Quantity("angle"), (2,)),
        "angles of both ends of the slot from its centre, counterclockwise, in the axes of `on`, "
        "between which the middle of the pin has to stay; all the way round if left out",
        default=(),
        example=["20 deg", "160 deg"],
    )

    @property
    def axed(self) -> tuple[str, ...]:
        return (self.on,) if self.arc else ()

    def rider(self) -> Rider:
        """A link from the centre to the pin."""
        pin, center = self.name, f"centre of {self.name}"
        points = {center: (0.0, 0.0), pin: (self.radius, 0.0)}
        points_on_bodies = {self.link: {pin: self.point}, self.on: {center: self.center}}
        return Rider(self.link, self.on, points, points_on_bodies, normal=1 + 0j)

    @property
    def middle(self) -> Any:
        """Angle, rad, from which that of the pin is within half a turn."""
        return 0.5 * (self.arc[0] + self.arc[1]) if self.arc else 0.0

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Angle of the pin, rad, and its speed along the slot, m/s, both counterclockwise."""
        angle = at.bearing(at.turn(self.name) * at.turn(self.on).conjugate(), self.middle)
        if self.arc:
            at.within(angle, (self.arc[0], self.arc[1]), BEYOND)
        speed = self.radius * (at.rate(self.name) - at.rate(self.on))
        return {"angle": angle, "speed": speed}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        yield from super().problems(where, bodies)
        if self.arc and not 0 < self.arc[1] - self.arc[0] < 2 * pi:
            first, last = (Measured(end, "angle") for end in self.arc)
            wrong = Note(
                "got {first} to {last}; give the ends counterclockwise, the second less than a "
                "turn beyond the first",
                first=first,
                last=last,
            )
            yield ModelError(f"{where}.arc", wrong)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its radius and its ends, or of columns of them."""
        yield self.radius > 0
        if self.arc:
            wide = self.arc[1] - self.arc[0]
            yield (wide > 0) & (wide < 2 * pi)

    def sentence(self) -> Note:
        """Radius of a circular slot, its pin and its bodies, for a report."""
        radius = format_quantity(self.radius, "length")
        return Note("Circular slot: {point} of {link} at {radius} from {center} of {on}",
                    point=self.point, link=self.link, radius=radius, center=self.center,
                    on=self.on)  # fmt: skip

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        template = to_say(
            "circular slot: {point} of {link} about {center} of {on}, radius {radius}"
        )
        values = {"point": self.point, "link": self.link, "center": self.center, "on": self.on,
                  "radius": format_quantity(self.radius, "length")}  # fmt: skip
        if self.arc:
            template = to_say(
                "circular slot: {point} of {link} about {center} of {on}, radius {radius}, from "
                "{start} to {stop}"
            )
            values |= {
                key: format_quantity(value, "angle")
                for key, value in zip(("start", "stop"), self.arc, strict=True)
            }
        return say(template, **values)
