"""One-sided stops, of a point at a line of another body, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import log
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, localized, say, series, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import Number, TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies
from equipoise.mechanism.formulas.kernels import positive
from equipoise.mechanism.parts.element_kinds import (
    Action,
    BetweenPoints,
    Placed,
    RatedElement,
    wrong_end_points,
)
from equipoise.quantities import Dimension, format_quantity

LEAST_RESTITUTION = 0.01
"""Below which the loss per speed grows beyond all bounds."""
HALVINGS = 80
"""Of an interval, after which it is as narrow as numbers are."""


def loss_factor(restitution: float) -> float:
    """Share a of the elastic force that is added at the speed of approach.

    A body that meets a force k d (1 + a d'/v) with the speed v leaves it with e v, whatever its
    mass and k, where (1 + e) a = ln((1 + a) / (1 - e a)).
    """
    e = restitution
    low, high = 0.0, 1.0 / e
    for _ in range(HALVINGS):
        a = (low + high) / 2
        beyond = 1.0 - e * a <= 0.0 or log((1.0 + a) / (1.0 - e * a)) > (1.0 + e) * a
        low, high = (low, a) if beyond else (a, high)
    return (low + high) / 2


@declared
class Stop(BetweenPoints, RatedElement):
    """A stop without mass: it pushes `point` of `link` back where that is beyond a line through
    `to` of `on`.
    """

    called = to_say("{what} of stop {number}")
    list_name = "stops"
    list_text = "one-sided stops with stiffness and restitution"
    order = 6
    file_order = ("link", "point", "to", "on", "direction", "stiffness", "restitution", "speed")
    still = ("restitution",)
    one_sided = True

    cause = "stop"
    cause_label = to_say("stops")
    legend = ("stop", to_say("stop"))
    sign = "equipoise.symbols.stops:stop_sign"
    title = to_say("Stops, each with its crank angle; a gap below 0 is pressed in")
    group = to_say("stops")
    exports: ClassVar[Mapping[str, str]] = {
        "mjcf": "equipoise.exchange.mjcf:stops",
        "exudyn": "equipoise.exchange.exudyn:stops",
        "modelica": "equipoise.exchange.modelica:stops",
    }
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "force": (
            "force",
            with_meaning("force of stop {name}", "Force with which a stop pushes a point back."),
        ),
        "gap": (
            "length",
            with_meaning(
                "gap of stop {name}",
                "Distance of a point from the line of its stop; below 0 it presses the stop in.",
            ),
        ),
        "loss": (
            "power",
            with_meaning(
                "loss of stop {name}", "Power that a stop turns into heat while it is pressed."
            ),
        ),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "gap": (to_say("smallest gap"), to_say("largest")),
        "force": (to_say("smallest force"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it stops", example="rocker")
    point: str = key(TextKind(of="point", on="link"), "its point that meets the stop", example="C")
    to: str = key(
        TextKind(of="point", on="on"),
        "point of the frame, or of `on`, through which the line of the stop goes",
        example="S",
        word=to_say("other point"),
    )
    stiffness: float = key("stiffness", "more than 0", example="200 kN/m", above=0)
    direction: float = key(
        "angle",
        "from the x axis of `on`, in which the stop pushes; the line is across it",
        default=0.0,
    )
    restitution: float | None = key(
        Number(),
        "speed after a contact over speed before it, at `speed`; it loses nothing if left out",
        default=None,
        example=0.6,
        at_least=LEAST_RESTITUTION,
        below=1,
    )
    speed: float | None = key(
        "speed",
        "of approach, at which `restitution` holds",
        default=None,
        example="0.5 m/s",
        above=0,
    )
    on: str = key(
        TextKind(of="body"), "the body of the stop", default=FRAME, word=to_say("other body")
    )

    @property
    def axed(self) -> tuple[str, ...]:
        return (self.on,)

    @property
    def linear(self) -> bool:
        return False

    def _contact(self, at: Placed) -> tuple[Any, Any, Any, Any]:
        """Way from the line's point, m, unit vector in which it pushes, gap, m, and speed with
        which that grows, m/s.
        """
        arm, normal, ((gap, opening), _) = self.relative_motion(at, self.direction)
        return arm, normal, gap, opening

    @property
    def dissipation(self) -> Any:
        """Coefficient of Hunt and Crossley, s/m, by which approach adds to the elastic force; None
        where nothing is lost.
        """
        if self.speed is None or self.restitution is None:
            return None
        return loss_factor(self.restitution) / self.speed

    def force(self, gap: Any, opening: Any) -> Any:
        """Force, N, at a gap, m, that grows with a speed, m/s: it only ever pushes."""
        elastic, dissipation = self.stiffness * positive(-gap), self.dissipation
        return elastic if dissipation is None else elastic * positive(1.0 - dissipation * opening)

    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """Gap of a stop, m, and the speed with which that grows, m/s."""
        _, _, gap, opening = self._contact(at)
        return ((gap, opening),)

    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """The force, which widens the gap."""
        ((gap, opening),) = ways
        return (self.force(gap, opening),)

    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """Force on the point of the link, N, and its opposite there on the other body."""
        arm, normal, _, _ = self._contact(at)
        return self.pushed(arm, normal * efforts[0])

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Force of a stop, N, its gap, m, and the power that it turns into heat, W."""
        _, _, gap, opening = self._contact(at)
        force = self.force(gap, opening)
        loss = (self.stiffness * positive(-gap) - force) * opening
        return {"force": force, "gap": gap, "loss": loss}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""
        itself = Note("{link!r} cannot stop itself", link=self.link)
        yield from wrong_end_points(where, self, bodies, itself)
        if (self.speed is None) != (self.restitution is None):
            sentence = Note("give restitution and speed together, or none of them")
            yield ModelError(where, sentence)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them."""
        yield self.stiffness > 0
        if self.speed is not None:
            yield self.speed > 0

    def sentence(self) -> Note:
        """Stiffness of a stop and its ends, for a report."""
        return Note(
            "Stop: {stiffness}, {point} of {link} on {to}",
            stiffness=format_quantity(self.stiffness, "stiffness", "N/m"),
            point=self.point,
            link=self.link,
            to=self.to,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        parts = [format_quantity(self.stiffness, "stiffness", "N/m")]
        if self.speed is not None:
            factor, speed = f"{self.restitution:g}", format_quantity(self.speed, "speed")
            parts.append(say("restitution {factor} at {speed}", factor=factor, speed=speed))
        return say(
            "stop: {point} of {link} on {to}, {parts}",
            point=self.point,
            link=self.link,
            to=self.to,
            parts=localized(series(parts)),
        )
