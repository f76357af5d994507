"""Racks and pinions, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from math import tan
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError, MotionError
from equipoise.i18n import Note, to_say
from equipoise.keys import TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.outputs.declared import of_mesh
from equipoise.mechanism.parts.couplings import (
    Coupling,
    LineOfAction,
    PathPattern,
    Pushed,
    Relation,
    Seat,
    declare_teeth,
    is_pressure_angle,
    pressure_angle,
)
from equipoise.quantities import format_quantity

HANDS = ("left", "right")
ENDS = ("pinion", "rack")


@declared
class Rack(Coupling):
    """A rack and its pinion, which is pinned to the carrier on which the rack slides."""

    called = to_say("{what} of rack {number}")
    list_name = "racks"
    list_text = "racks with their pinions"
    order = 3

    sign = "equipoise.symbols.straight_pieces:rack_sign"
    page_tool = "equipoise.web.couplings:RACK"
    noun = to_say("rack")
    group = to_say("racks")
    loses = True
    columns: ClassVar[Mapping[PathPattern, Set[str]]] = {(): {"angle", "travel", "pressure_angle"}}
    counted = to_say("{count} racks")

    pinion: str = key(TextKind(of="body"), "link that turns", example="rocker")
    rack: str = key(
        TextKind(of="link"),
        "link that slides on the carrier, by a guide of `[[sliders]]` that is `on` the carrier",
        example="rack",
    )
    radius: float = key("length", "pitch radius of the pinion", example="20 mm", above=0)
    side: Literal["left", "right"] = key(
        TextKind(HANDS),
        "on which the pinion is of the rack, seen along the direction of its guide",
        example="left",
    )
    drives: Literal["pinion", "rack"] = key(
        TextKind(ENDS), "which of both is moved already", default="pinion"
    )
    carrier: str = key(
        TextKind(of="body"),
        "link to which the pinion is pinned, and on which the rack slides",
        default=FRAME,
        example="frame",
    )
    angle: float = key(
        "angle",
        "of a driven pinion in the frame at crank angle 0",
        default=0.0,
        word=to_say("angle at the start"),
    )
    travel: float = key(
        "length",
        "of a driven rack along its guide at crank angle 0",
        default=0.0,
        word=to_say("travel at the start"),
    )
    pressure_angle: float = pressure_angle("the part of the tooth force across the rack")

    @property
    def driver(self) -> str:
        return self.pinion if self.drives == "pinion" else self.rack

    @property
    def driven(self) -> str:
        return self.rack if self.drives == "pinion" else self.pinion

    @property
    def idle_keys(self) -> tuple[str, ...]:
        return ("angle",) if self.drives == "pinion" else ("travel",)

    @property
    def foot(self) -> complex:
        """From the pinion's pin to where both mesh, m, across the direction of the guide."""
        return -1j * self.left * self.radius

    @property
    def switches(self) -> bool:
        """The flank in contact follows from the sense of the force."""
        return True

    @property
    def start(self) -> float:
        """Angle (rad) of a driven pinion, or travel (m) of a driven rack, at crank angle 0."""
        return self.travel if self.drives == "pinion" else self.angle

    def started(self, start: float) -> Rack:
        """The rack with another angle or travel at the start."""
        if self.drives == "pinion":
            return replace(self, travel=start)
        return replace(self, angle=start)

    @property
    def slides(self) -> str:
        return self.rack

    @property
    def left(self) -> int:
        """1 where the pinion is on the left, -1 on the right."""
        return 1 if self.side == "left" else -1

    @property
    def relation(self) -> Relation:
        """Between the pinion's angle and the rack's travel on the carrier."""
        way = self.left * self.radius
        return (kernels.rolled, (way,)) if self.drives == "pinion" else (kernels.wound, (1 / way,))

    @property
    def speed_ratio(self) -> float:
        """0: seen from the carrier, neither turns in the mean."""
        return 0.0

    @property
    def exact_ratio(self) -> Fraction | None:
        """There is none.

        Raises
        ------
        MotionError : the pinion turns on and on, and drives a rack.
        """
        raise MotionError(
            Note(
                "the rack {rack!r} never comes back: its pinion {pinion!r} turns on and on; let a "
                "link drive it that swings to and fro",
                rack=self.rack,
                pinion=self.pinion,
            )
        )

    def unheld(self, driver: int, driven: int) -> Note:
        """Say that the rack has no guide on the carrier, or the pinion no pin."""
        pins, sliders = (driver, driven) if self.drives == "pinion" else (driven, driver)
        return Note(
            "{pinion!r} has {pins} pins and {rack!r} {sliders} guides on the carrier "
            "{carrier!r}; a pinion turns about one point of the carrier, on which the rack "
            "slides by one of [[sliders]]",
            pinion=self.pinion,
            pins=pins,
            rack=self.rack,
            sliders=sliders,
            carrier=self.carrier,
        )

    def line(self, seat: Seat) -> LineOfAction:
        """At the foot of the pinion's radius on the pitch line."""
        import numpy as np

        slope = np.tan(self.pressure_angle)
        lever = self.foot * seat.way
        return LineOfAction(lever, slope if self.drives == "rack" else -self.left * slope)

    def parts(self, at: Pushed) -> Mapping[str, Any]:
        """Along the rack, positive where it moves the driven body ahead, and what pushes both
        apart.
        """
        return {"tangential": at.push, "radial": tan(self.pressure_angle) * at.sense * at.push}

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        declare_teeth(table)
        of_mesh(table)

    def demands(self, distance: Callable[[], Any]) -> Iterator[Any]:
        """A pressure angle that there is."""
        yield is_pressure_angle(self.pressure_angle)

    def sentence(self) -> Note:
        """Bodies of a rack and the radius of its pinion."""
        return Note(
            "Rack: {driver} drives {driven} on {carrier}, pitch radius {radius}",
            driver=self.driver,
            driven=self.driven,
            carrier=Note("frame") if self.carrier == FRAME else self.carrier,
            radius=format_quantity(self.radius, "length"),
        )

    def circles(self, distance: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
        """The pinion."""
        yield self.pinion, self.radius

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with a rack, but for how it is guided."""
        keys = ("pinion", "rack") if self.drives == "pinion" else ("rack", "pinion")
        yield from self.wrong_ends(where, bodies, keys)
        for name, drives in (("angle", "rack"), ("travel", "pinion")):
            if getattr(self, name) and self.drives != drives:
                yield ModelError(
                    f"{where}.{name}",
                    Note(
                        "goes with drives = {drives!r}; the driving part has its own position",
                        drives=drives,
                    ),
                )
