"""Bushings, elastic and damped in two axes and about their pin, as frozen values with checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of, localized, say, series, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import KeyConditions, Listing, Quantity, TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies, Vector
from equipoise.mechanism.parts.element_kinds import (
    Action,
    BetweenPoints,
    Placed,
    RatedElement,
    wrong_end_points,
)
from equipoise.quantities import Dimension, format_quantity

LAWS = ("stiffness", "damping", "torsional_stiffness", "torsional_damping")
"""Keys of which a bushing has at least one."""


@declared
class Bushing(BetweenPoints, RatedElement):
    """A bushing without mass between `point` of `link` and the point `to` of `on`: linear springs
    and dampers along two axes of `on` and about the pin.
    """

    called = to_say("{what} of bushing {number}")
    list_name = "bushings"
    list_text = "bushings, elastic in two axes and about their pin"
    order = 5
    file_order = ("link", "point", "to", "on", "direction", "stiffness", "damping", "preload",
                  "torsional_stiffness", "torsional_damping", "angle", "torque")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "anyOf": [{"required": [name]} for name in LAWS],
        "dependentRequired": {"angle": ["torsional_stiffness"]},
    }
    freedoms = 3

    cause = "bushing"
    cause_label = to_say("bushings")
    legend = ("bushing", to_say("bushing"))
    sign = "equipoise.symbols.bushings:bushing_sign"
    title = to_say("Bushings, each with its crank angle; forces and torques on the link")
    group = to_say("bushings")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:bushings",
        "exudyn": "equipoise.exchange.exudyn:bushings",
        "modelica": "equipoise.exchange.modelica:bushings",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "along": (
            "length",
            with_meaning(
                "deflection along bushing {name}",
                "How far a point is from that of its bushing along the direction of this.",
            ),
        ),
        "across": (
            "length",
            with_meaning(
                "deflection across bushing {name}",
                "How far a point is from that of its bushing across the direction of this.",
            ),
        ),
        "force_along": (
            "force",
            with_meaning(
                "force along bushing {name}", "Force of a bushing on its link along its direction."
            ),
        ),
        "force_across": (
            "force",
            with_meaning(
                "force across bushing {name}",
                "Force of a bushing on its link across its direction.",
            ),
        ),
        "torque": (
            "torque",
            with_meaning(
                "torque of bushing {name}", "Torque of a bushing on its link about its pin."
            ),
        ),
        "loss": (
            "power",
            with_meaning("loss of bushing {name}", "Power that a bushing turns into heat."),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "along": (to_say("lowest along"), to_say("highest")),
        "across": (to_say("lowest across"), to_say("highest")),
        "force_along": (to_say("lowest force along"), to_say("highest")),
        "force_across": (to_say("lowest force across"), to_say("highest")),
    }

    link: str = key(TextKind(of="link"), "the link that it holds", example="rocker")
    point: str = key(TextKind(of="point", on="link"), "its point on the link", example="C")
    to: str = key(
        TextKind(of="point", on="on"),
        "its point on the frame, or on `on`, where it is undeflected",
        example="S",
        word=to_say("other point"),
    )
    on: str = key(
        TextKind(of="body"),
        "the body of its other point, with which its axes turn",
        default=FRAME,
        word=to_say("other body"),
    )
    direction: float = key("angle", "of its first axis from the x axis of `on`", default=0.0)
    stiffness: Vector = key(
        Listing(Quantity("stiffness"), (2,)),
        "along its direction and across it",
        default=(0.0, 0.0),
        written_default=["0 N/m", "0 N/m"],
        example=["20 kN/m", "400 kN/m"],
    )
    damping: Vector = key(
        Listing(Quantity("damping"), (2,)),
        "along its direction and across it",
        default=(0.0, 0.0),
        written_default=["0 N s/m", "0 N s/m"],
        example=["50 N s/m", "90 N s/m"],
    )
    preload: Vector = key(
        Listing(Quantity("force"), (2,)),
        "force on the link along its direction and across it, where its points meet",
        default=(0.0, 0.0),
        written_default=["0 N", "0 N"],
        example=["-200 N", "0 N"],
    )
    torsional_stiffness: float | None = key(
        "torsional stiffness",
        "about the pin; the link may then turn by half a turn to either side of `angle`",
        default=None,
        example="30 N m/rad",
        at_least=0,
    )
    torsional_damping: float | None = key(
        "torsional damping", "about the pin", default=None, example="0.2 N m s/rad", at_least=0
    )
    angle: float = key(
        "angle", "of the link from the x axis of `on`, at which it exerts `torque`", default=0.0
    )
    torque: float = key("torque", "preload on the link, positive counterclockwise", default=0.0)

    @property
    def axed(self) -> tuple[str, ...]:
        return (self.on,) if self.torsional_stiffness is None else (self.link, self.on)

    @property
    def linear(self) -> bool:
        return True

    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """The ways along and across its direction, m, with their speeds, m/s, and how far the link
        has turned from `angle`, rad, 0 where that does not matter, with its speed, rad/s.
        """
        turned: Any = 0.0
        if self.torsional_stiffness is not None:
            turned = at.angle(self.link, self.on, self.angle) - self.angle
        turning = turned, at.rate(self.link) - at.rate(self.on)
        return (*self.relative_motion(at, self.direction)[2], turning)

    def _laws(self) -> tuple[tuple[Any, Any, Any], ...]:
        """Preload, stiffness and damping of each way."""
        stiffness, damping = (
            0.0 if number is None else number
            for number in (self.torsional_stiffness, self.torsional_damping)
        )
        pairs = zip(self.preload, self.stiffness, self.damping, strict=True)
        return (*pairs, (self.torque, stiffness, damping))

    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """Forces along and across its direction, N, and torque, N m, on the link."""
        return tuple(
            preload - stiffness * way - damping * speed
            for (preload, stiffness, damping), (way, speed) in zip(self._laws(), ways, strict=True)
        )

    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """Force and torque on the link, and their opposites there on the other body."""
        arm, direction, _ = self.relative_motion(at, self.direction)
        along, across, torque = efforts
        return self.pushed(arm, direction * along + 1j * direction * across, torque)

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Deflections, m, forces, N, and torque, N m, on the link, and power turned to heat, W."""
        ways = self.ways(at)
        along, across, torque = self.efforts(ways)
        lost = [law[2] * speed * speed for law, (_, speed) in zip(self._laws(), ways, strict=True)]
        return {
            "along": ways[0][0],
            "across": ways[1][0],
            "force_along": along,
            "force_across": across,
            "torque": torque,
            "loss": lost[0] + lost[1] + lost[2],
        }

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        itself = Note("{link!r} cannot be held by itself", link=self.link)
        yield from wrong_end_points(where, self, bodies, itself)
        for name in ("stiffness", "damping"):
            if any(number < 0 for number in getattr(self, name)):
                least = Note("a bushing pulls back and takes power away; give numbers of 0 or more")
                yield ModelError(f"{where}.{name}", least)
        if not any(any(getattr(self, name)) for name in LAWS[:2]) and (
            self.torsional_stiffness is None and self.torsional_damping is None
        ):
            wrong = Note(
                "give at least one of stiffness, damping, torsional stiffness and torsional damping"
            )
            yield ModelError(where, wrong)
        if self.angle and self.torsional_stiffness is None:
            wrong = Note("goes with a torsional stiffness; leave it out")
            yield ModelError(f"{where}.angle", wrong)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them."""
        torsional = (self.torsional_stiffness, self.torsional_damping)
        for number in (*self.stiffness, *self.damping, *torsional):
            if number is not None:
                yield number >= 0

    def sentence(self) -> Note:
        """Stiffness of a bushing, or damping where it has none, preload and ends, for a report."""
        ends = {"point": self.point, "link": self.link, "to": self.to, "on": self.on}
        if not any((*self.stiffness, *self.damping)):
            return Note(
                "Bushing: {rate} about {point} of {link}, on {on}", rate=self._turning(), **ends
            )
        laws: tuple[tuple[Vector, Dimension, str], ...] = (
            (self.stiffness, "stiffness", "N/m"),
            (self.damping, "damping", "N s/m"),
        )
        pair, dimension, unit = next(law for law in laws if any(law[0]))
        ends |= {name: format_quantity(number, dimension, unit)
                 for name, number in zip(("along", "across"), pair, strict=True)}  # fmt: skip
        if not any(self.preload):
            return Note(
                "Bushing: {along} along and {across} across, {point} of {link} at {to} of {on}",
                **ends,
            )
        first, second = (format_quantity(number, "force") for number in self.preload)
        return Note(
            "Bushing: {along} along and {across} across, with preloads of {first} and {second}, "
            "{point} of {link} at {to} of {on}",
            first=first,
            second=second,
            **ends,
        )

    def _turning(self) -> str:
        """Its stiffness about the pin, or damping where it has none."""
        if self.torsional_stiffness is not None:
            return format_quantity(self.torsional_stiffness, "torsional stiffness", "N m/rad")
        assert self.torsional_damping is not None
        return format_quantity(self.torsional_damping, "torsional damping", "N m s/rad")

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        parts = [
            say(
                "bushing: {point} of {link} at {to} of {on}",
                point=self.point,
                link=self.link,
                to=self.to,
                on=self.on,
            )
        ]
        pairs: tuple[tuple[Vector, Dimension, str], ...] = (
            (self.stiffness, "stiffness", "N/m"),
            (self.damping, "damping", "N s/m"),
            (self.preload, "force", "N"),
        )
        for pair, dimension, unit in pairs:
            if any(pair):
                parts.append(
                    localized(all_of([format_quantity(number, dimension, unit) for number in pair]))
                )
        if self.torsional_stiffness is not None:
            rate = format_quantity(self.torsional_stiffness, "torsional stiffness", "N m/rad")
            parts.append(
                say("{rate} from {angle}", rate=rate, angle=format_quantity(self.angle, "angle"))
            )
        if self.torsional_damping is not None:
            parts.append(format_quantity(self.torsional_damping, "torsional damping", "N m s/rad"))
        if self.torque:
            parts.append(format_quantity(self.torque, "torque"))
        return localized(series(parts))
