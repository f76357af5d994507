"""Chains and toothed belts, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.i18n.terms import with_meaning
from equipoise.keys import (
    Flag,
    KeyConditions,
    Listing,
    Quantity,
    Whole,
    declared,
    key,
)
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.outputs.declared import FORCE, of_coupling, of_mesh, part_in_loops
from equipoise.mechanism.parts.couplings import (
    PathPattern,
    Pushed,
    Relation,
    Seat,
    StrandLine,
    Turning,
    as_fraction,
)

if TYPE_CHECKING:
    from equipoise.mechanism.formulas.rolling import Strands

TOUCHING = 1e-9
"""Over the distance of the pins: a strand that comes so near to a pin runs through it."""


@declared
class Belt(Turning):
    """A toothed belt, or a chain, about two links pinned to the same carrier."""

    called = to_say("{what} of belt {number}")
    list_name = "belts"
    list_text = "toothed belts and chains"
    order = 2
    file_order = ("between", "teeth", "pitch", "radii", "crossed", "carrier", "start", "tension")
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": ["teeth"]}, {"required": ["radii"]}],
        "dependentRequired": {"teeth": ["pitch"], "pitch": ["teeth"]},
    }

    sign = "equipoise.symbols.straight_pieces:strand_sign"
    page_tool = "equipoise.web.couplings:BELT"
    noun = to_say("belt")
    group = to_say("belts")
    loses = True
    heading = Note("Belt")
    tables: ClassVar[Mapping[str, str]] = {"joints": "equipoise.results.belt_blocks:belt_blocks"}
    questions = "equipoise.mechanism.kinematics.belt_crossings:crossings"
    curves = (
        ("left", "right"),
        to_say("Tension of the strands of belts"),
        to_say("Tension of the strands of belts over crank angle."),
    )
    pushes = False
    columns: ClassVar[Mapping[PathPattern, Set[str]]] = {(): {"start", "tension"}}
    counted = to_say("{count} belts")

    teeth: tuple[int, int] | None = key(
        Listing(Whole(1), (2,)),
        "of driver and driven; goes with `pitch`",
        default=None,
        example=[20, 40],
        word=to_say("number of teeth"),
    )
    pitch: float | None = key(
        "length", "of the teeth, or of the chain", default=None, example="5 mm", above=0
    )
    radii: tuple[float, float] | None = key(
        Listing(Quantity("length"), (2,)),
        "pitch radii of driver and driven, instead of `teeth` and `pitch`",
        default=None,
        example=["16 mm", "32 mm"],
        above=0,
        word=to_say("pitch radius"),
    )
    crossed: bool = key(
        Flag(), "its strands cross, so that both turn against each other", default=False
    )
    tension: float | None = key(
        "force",
        "of each strand where no torque is passed on; without it a chain, of which one strand "
        "hangs loose",
        default=None,
        example="80 N",
        above=0,
    )

    @property
    def pitch_radii(self) -> tuple[Any, Any]:
        """Of driver and driven pulley, m."""
        if self.teeth is None:
            assert self.radii is not None
            return self.radii
        assert self.pitch is not None
        first, second = (count * self.pitch / (2 * pi) for count in self.teeth)
        return first, second

    @property
    def preload(self) -> Any:
        return 0.0 if self.tension is None else self.tension

    @property
    def switches(self) -> bool:
        """Without tension one strand pulls, which follows from the sense of the torque."""
        return self.tension is None

    @property
    def speed_ratio(self) -> float:
        """Speed of driven over driver relative to the carrier."""
        first, second = self.pitch_radii if self.teeth is None else self.teeth
        return -first / second if self.crossed else first / second

    @property
    def relation(self) -> Relation:
        return kernels.in_ratio, (self.speed_ratio,)

    @property
    def exact_ratio(self) -> Fraction | None:
        """The speed ratio as a fraction, or None if it is no ratio of whole numbers."""
        if self.teeth is None:
            return as_fraction(self.speed_ratio)
        return Fraction(*self.teeth) * (-1 if self.crossed else 1)

    @property
    def one_sided(self) -> Mapping[str, Note]:
        if self.tension is None:
            return {}
        return {
            "left": Note("left strand of belt {name}", name=self.name),
            "right": Note("right strand of belt {name}", name=self.name),
        }

    def strands(self, apart: Any) -> Strands:
        """Where they run; apart : from the driver's pin to the driven link's, complex, m."""
        from equipoise.mechanism.formulas.rolling import Strands  # which needs NumPy

        first, second = self.pitch_radii
        return Strands(apart, first, -second if self.crossed else second)

    def line(self, seat: Seat) -> StrandLine:
        """Force and couple of both strands on the driven pulley about its pin."""
        import numpy as np

        from equipoise.mechanism.formulas.rolling import LEFT, RIGHT

        strands = self.strands(-seat.centres)
        reach = self.pitch_radii[0] + self.pitch_radii[1]
        if np.all(strands.distance <= reach):
            apart = Note(
                "its pulleys overlap: their pitch radii add up to {reach:.6g} mm, and their pins "
                "are {distance:.6g} mm apart; give smaller ones, or set the pins farther apart",
                reach=1e3 * float(np.max(reach)),
                distance=1e3 * float(np.min(strands.distance)),
            )
            raise ModelError(seat.where, apart)
        for pin, place, bodies in seat.others():
            if strands.run_through(place, TOUCHING):
                crossed = Note(
                    "a strand crosses {link!r}, which turns about {pin} on {carrier!r}; move "
                    "{pin}, or change the radii",
                    link=bodies[0],
                    pin=pin,
                    carrier=self.carrier,
                )
                raise ModelError(seat.where, crossed)
        across = 0.5 * (strands.way(RIGHT) - strands.way(LEFT)) * np.sign(strands.other)
        along = -0.5 * strands.toward if self.tension is None else 0.0
        return StrandLine(abs(strands.other), across, along)

    def parts(self, at: Pushed) -> Mapping[str, Any]:
        """What turns the driven link at its pitch radius, positive counterclockwise, and the
        tension of the strands that leave the driver left and right of the way to the driven link,
        below 0 where one would have to push.
        """
        half = 0.5 * at.push
        mean = at.sense * half if self.tension is None else at.preload
        left = -half if self.crossed else half
        return {"pull": at.push, "left": mean + left, "right": mean - left}

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        declare = of_coupling(table)
        pull = with_meaning(
            "effective pull {name}",
            "Difference of the tensions of both strands of a belt, which transmits the torque.",
        )
        left = with_meaning(
            "tension of the left strand {name}",
            "Tension of the strand of a belt on the left, seen from the driving towards the driven "
            "pulley.",
        )
        right = with_meaning(
            "tension of the right strand {name}",
            "Tension of the strand of a belt on the right, seen from the driving towards the "
            "driven pulley.",
        )
        declare(".pull", "force", pull, compared=FORCE, loop=part_in_loops("pull"),
                yardstick="acting")  # fmt: skip
        declare(".left", "force", left, compared=FORCE, loop=part_in_loops("left"))
        declare(".right", "force", right, compared=FORCE, loop=part_in_loops("right"))
        of_mesh(table)

    def preload_rate(self, distance: Any) -> Any:
        """Sum of both tensions along the line of the pins, over their distance, N/m."""
        return self.preload * 2 * self.strands(distance).cosine / distance

    def demands(self, distance: Callable[[], Any]) -> Iterator[Any]:
        """Pulleys that lie apart, and a tension that pulls."""
        yield distance() > sum(self.pitch_radii)
        yield self.tension is None or self.tension > 0

    def circles(self, distance: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
        """Both pulleys."""
        return zip((self.driver, self.driven), self.pitch_radii, strict=True)

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with a belt, but for where its pulleys are."""
        yield from self.wrong_ends(where, bodies)
        if (self.radii is None) == (self.teeth is None):
            yield ModelError(where, Note("give either teeth and pitch, or radii"))
        elif (self.pitch is None) != (self.teeth is None):
            missing = "teeth" if self.teeth is None else "pitch"
            yield ModelError(f"{where}.{missing}", Note("missing; teeth and pitch go together"))
        elif self.teeth is not None and min(self.teeth) < 1:
            yield ModelError(
                f"{where}.teeth",
                Note("got {teeth}; give two positive numbers", teeth=list(self.teeth)),
            )
