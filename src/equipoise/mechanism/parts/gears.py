"""Pairs of gears, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import replace
from fractions import Fraction
from math import dist
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    Key,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    Number,
    TextKind,
    Whole,
    declared,
    inside,
    key,
)
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.outputs.declared import of_mesh
from equipoise.mechanism.parts.couplings import (
    Coupling,
    DerivedLaw,
    LineOfAction,
    PathPattern,
    Pushed,
    Relation,
    RollingLine,
    Seat,
    Turning,
    as_fraction,
    coupled,
    declare_teeth,
    is_pressure_angle,
    pressure_angle,
)
from equipoise.mechanism.parts.gear_shapes import GearShape, wrong_shape

MESHES = ("external", "internal")


@declared
class Gear(Turning):
    """A pair of gears, both pinned to the same carrier; either ratio or teeth."""

    called = to_say("{what} of gear {number}")
    list_name = "gears"
    list_text = "pairs of gears"
    order = 1
    extra_keys: ClassVar[Keys] = {
        **Turning.extra_keys,
        "mesh": Key(
            "mesh", TextKind(MESHES), "goes with `teeth`", default=None, written_default="external"
        ),
    }
    file_order = ("between", "ratio", "teeth", "mesh")
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": ["ratio"]}, {"required": ["teeth"]}],
        "dependentRequired": {"mesh": ["teeth"]},
    }

    noun = to_say("pair of gears")
    group = to_say("gears")
    page_tool = "equipoise.web.couplings:GEARS"
    wheels = to_say("pitch circles of gears")
    loses = True
    columns: ClassVar[Mapping[PathPattern, Set[str]]] = {
        (): {"start", "pressure_angle"},
        ("shape",): {"eccentricity", "phase", "cosines", "sines"},
    }
    heading = Note("Gears")
    grows = True
    counted = to_say("{count} gears")

    ratio: float | None = key(
        Number(),
        "speed of driven over driver, both relative to the carrier; negative for an external mesh",
        default=None,
        example=-2,
    )
    teeth: tuple[int, int] | None = key(
        Listing(Whole(1), (2,)),
        "of driver and driven, instead of `ratio`",
        default=None,
        example=[20, 40],
        word=to_say("number of teeth"),
    )
    mesh: Literal["external", "internal"] = inside(TextKind(MESHES), default="external")
    pressure_angle: float = pressure_angle("the radial part of the tooth force")
    shape: GearShape | None = key(
        KeyTable(GearShape, headed=True),
        "pitch curves, where the ratio varies; `ratio` or `teeth` then give its mean",
        default=None,
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Gear:
        if "mesh" in given and "teeth" not in given:
            raise ModelError(
                "mesh",
                Note(
                    "got {given!r} without teeth; leave it out: ratio has the sign, "
                    "negative for external",
                    given=given["mesh"],
                ),
            )
        return super().from_table(given)

    @classmethod
    def to_table(cls, value: Gear) -> dict[str, Any]:
        mesh = {} if value.teeth is None else {"mesh": value.mesh}
        return {**super().to_table(value), **mesh}

    @property
    def switches(self) -> bool:
        """The flank in contact follows from the sense of the torque."""
        return True

    @property
    def speed_ratio(self) -> float:
        """Speed of driven over driver relative to the carrier."""
        if self.teeth is None:
            assert self.ratio is not None
            return self.ratio
        ratio = self.teeth[0] / self.teeth[1]
        return ratio if self.mesh == "internal" else -ratio

    @property
    def relation(self) -> Relation:
        if self.rolling_law is not None:
            return coupled, (self.rolling_law,)
        return kernels.in_ratio, (self.speed_ratio,)

    @property
    def rolling_law(self) -> DerivedLaw | None:
        """The driven gear's angle by the driver's, seen from the carrier, if the ratio varies."""
        if self.shape is None:
            return None
        from equipoise.mechanism.parts.pitch_curves import law_of

        return law_of(self.shape, self.speed_ratio)

    @property
    def ratios(self) -> tuple[float, float]:
        if self.shape is None:
            return super().ratios
        from equipoise.mechanism.parts.pitch_curves import ratios_of

        return ratios_of(self.shape, self.speed_ratio)

    @property
    def unevenness(self) -> float:
        return max(map(abs, self.ratios)) / abs(self.speed_ratio)

    def accepts_columns(self, base: Coupling) -> bool:
        """Whether the shape of its pitch curves has a formula."""
        if self.shape is None:
            return True
        from equipoise.mechanism.parts.pitch_curves import can_vary

        return can_vary(self.shape)

    @property
    def exact_ratio(self) -> Fraction | None:
        """The speed ratio as a fraction, or None if it is no ratio of whole numbers."""
        if self.teeth is not None:
            ratio = Fraction(*self.teeth)
            return ratio if self.mesh == "internal" else -ratio
        return as_fraction(self.speed_ratio)

    def line(self, seat: Seat) -> LineOfAction | RollingLine:
        """At the pitch point, which divides the line of centres so that both gears move alike
        there.
        """
        import numpy as np

        if np.all(seat.centres == 0):
            pin = seat.pins[0]
            raise ModelError(
                seat.where, Note("both gears turn about {pin}; set their centres apart", pin=pin)
            )
        ratio = self.speed_ratio
        ring_driven = 0 < ratio < 1
        radial = np.tan(self.pressure_angle) * (1 if ring_driven else -1)
        if self.rolling_law is not None:
            return RollingLine(self.rolling_law, seat.centres, radial)
        return LineOfAction(seat.centres / (1 - ratio), -radial)

    def parts(self, at: Pushed) -> Mapping[str, Any]:
        """Along the pitch curves, positive where it turns the driven gear counterclockwise, and
        along the line of centres, positive towards the pin of the driven gear.
        """
        radial = -kernels.dot(at.arm, at.force) / abs(at.arm)
        return {"tangential": at.push, "radial": radial}

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        declare_teeth(table)
        of_mesh(table)

    def demands(self, distance: Callable[[], Any]) -> Iterator[Any]:
        """A pressure angle that there is, and pitch curves that roll on each other."""
        yield is_pressure_angle(self.pressure_angle)
        if self.shape is not None and self.shape.varies:
            from equipoise.mechanism.parts.pitch_curves import can_roll

            yield can_roll(self.shape, self)

    @property
    def special(self) -> str:
        return to_say("gears of varying ratio") if self.shape else self.group

    @property
    def in_fixed_ratio(self) -> bool:
        return self.shape is None

    @property
    def has_formula(self) -> bool:
        return self.shape is None

    def circles(self, distance: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
        """Both gears."""
        radius = distance() / abs(1 - self.speed_ratio)
        yield self.driver, radius * abs(self.speed_ratio)
        yield self.driven, radius

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with a pair of gears."""
        yield from self.wrong_ends(where, bodies)
        if (self.ratio is None) == (self.teeth is None):
            yield ModelError(where, Note("give either ratio or teeth"))
            return
        if self.teeth is not None and min(self.teeth) < 1:
            yield ModelError(
                f"{where}.teeth",
                Note("got {teeth}; give two positive numbers", teeth=list(self.teeth)),
            )
        elif self.speed_ratio == 0.0:
            yield ModelError(where, Note("the ratio is 0; no pair of gears has that"))
        elif self.speed_ratio == 1.0:
            yield ModelError(
                where,
                Note(
                    "the ratio is 1; no pair of gears has that, a ring would be as large as what "
                    "turns in it; take a belt, which turns both alike: [[belts]]"
                ),
            )
        elif self.shape is not None:
            yield from _wrong_shape(f"{where}.shape", self.shape, self, bodies)


def _wrong_shape(where: str, shape: GearShape, gear: Gear, bodies: Bodies) -> Iterator[ModelError]:
    problems = wrong_shape(shape, gear)
    if not problems:
        from equipoise.mechanism.parts.pitch_curves import wrong_curve

        problems = [*wrong_curve(shape, gear, _distance(gear, bodies))]
    for name, text in problems:
        yield ModelError(f"{where}.{name}".rstrip("."), text)


def closed(gear: Gear, bodies: Bodies) -> Gear:
    """The pair with the table of its shape, if it has one, scaled so that the curves close."""
    if gear.shape is None or not gear.shape.angle:
        return gear
    from equipoise.mechanism.parts.pitch_curves import closed_table

    shape = closed_table(gear.shape, gear.speed_ratio, _distance(gear, bodies))
    return replace(gear, shape=shape)


def _distance(gear: Gear, bodies: Bodies) -> float | None:
    """Between the axes of a pair, m; None where either does not share exactly one point with the
    carrier.
    """
    points = bodies.get(gear.carrier, {})
    pins = [points.keys() & bodies.get(body, {}).keys() for body in (gear.driver, gear.driven)]
    if any(len(shared) != 1 for shared in pins):
        return None
    driver, driven = (points[next(iter(shared))] for shared in pins)
    return dist(driver, driven)
