"""What may be changed to quieten a machine, what is to become small, and what must be kept.

They are part of the model; `equipoise.balancing` computes with them.  Places are in the axes of
the link that they belong to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, inf, pi, radians
from typing import ClassVar, Literal

from equipoise.mechanism.frozen import Frozen

Pair = tuple[float, float]
Shape = Literal["any", "point", "disc", "ring", "sector"]
SHAPES: tuple[Shape, ...] = ("any", "point", "disc", "ring", "sector")
CUT = ("disc", "ring", "sector")
"""Shapes cut from a plate, which need a thickness and a density."""
Measure = Literal["rms", "ripple", "peak", "peak_to_peak", "area"]
MEASURES: tuple[Measure, ...] = ("rms", "ripple", "peak", "peak_to_peak", "area")
"""Root of the mean square, the same about the mean, largest size, largest minus smallest value, and
area under the absolute value over one turn of the crank."""

MATERIALS = {
    "steel": 7850.0,
    "cast iron": 7200.0,
    "brass": 8500.0,
    "lead": 11340.0,
    "tungsten alloy": 17500.0,
    "aluminium": 2700.0,
}
"""Densities, kg/m3."""


@dataclass(frozen=True)
class Weight(Frozen):
    """Mass that may be added about a centre, and the room that it has there.

    shape : ``any`` distribution in the room (which comes back as one or two points); one ``point``;
        a round ``disc`` anywhere in the room; a ``ring`` about the centre; a ``sector`` about the
        centre, from the inner radius to the room's edge.
    radius : of the room about the centre, m; infinite where there is no limit.
    inner_radius : of ring and sector, m.
    thickness, density : of what is cut from a plate, m and kg/m3.
    mass : kg, where it is given.  at_most : kg, where it is not.
    """

    shapes: ClassVar[dict[str, str]] = {
        "shape": "text",
        **dict.fromkeys(("radius", "inner_radius"), "number"),
        **dict.fromkeys(("thickness", "density", "mass", "at_most"), "number?"),
    }
    endless = ("radius",)

    shape: Shape = "any"
    radius: float = inf
    inner_radius: float = 0.0
    thickness: float | None = None
    density: float | None = None
    mass: float | None = None
    at_most: float | None = None


@dataclass(frozen=True)
class CenterMove(Frozen):
    """The centre of mass of a link may be moved; its mass, and its inertia about it, are kept.

    x, y : lowest and highest coordinate, m; None without limit.
    center, radius : of a circle that it must not leave, m.
    """

    shapes: ClassVar[dict[str, str]] = {
        "link": "text",
        **dict.fromkeys(("x", "y", "center"), "pair?"),
        "radius": "number?",
    }

    link: str
    x: Pair | None = None
    y: Pair | None = None
    center: Pair | None = None
    radius: float | None = None


@dataclass(frozen=True)
class AddedMass(Frozen):
    """Mass may be added to a link, about its point `at`."""

    shapes: ClassVar[dict[str, str]] = {"link": "text", "at": "text"}
    flat = ("weight",)

    link: str
    at: str
    weight: Weight


@dataclass(frozen=True)
class GearedWeight(Frozen):
    """A counterweight on a shaft of its own, geared to a link that is pinned to the frame.

    driver : that link; it carries one gear about its pin on the frame.
    ratio : least and largest speed of the shaft over that of the driver, sizes: the gears mesh
        from outside, so that the shaft turns against the driver.
    teeth : least and largest number of teeth of either gear, instead of `ratio`; then `module`.
    module : pitch diameter over number of teeth, m.
    pitch_radius : of the driver's gear, m; not with `teeth`.
    axis : (x, y) of the shaft in the frame, m, where it is given; else `direction`.
    direction : from the driver's pin to the shaft, least and largest, rad; None for the line from
        the drive's pivot.
    gear_thickness, gear_density : of both gears, solid discs, m and kg/m3; None for none.
    clear_of : links that the counterweight's radius must stay clear of, in the plane.
    name : of the shaft's link in the new model.
    """

    shapes: ClassVar[dict[str, str]] = {
        "driver": "text",
        **dict.fromkeys(("ratio", "axis", "direction"), "pair?"),
        "teeth": "counts?",
        **dict.fromkeys(("module", "pitch_radius", "gear_thickness", "gear_density"), "number?"),
        "clear_of": "names",
        "name": "text",
    }
    flat = ("weight",)

    driver: str
    weight: Weight
    ratio: Pair | None = None
    teeth: tuple[int, int] | None = None
    module: float | None = None
    pitch_radius: float | None = None
    axis: Pair | None = None
    direction: Pair | None = None
    gear_thickness: float | None = None
    gear_density: float | None = None
    clear_of: tuple[str, ...] = ()
    name: str = "counterweight"


@dataclass(frozen=True)
class BalanceShafts(Frozen):
    """Two shafts that turn against each other at one or two times the crank's speed.

    order : 1 or 2.  axes : (x, y) of the first, which is geared to the drive's link and turns
        against it, and of the second, which is geared to the first; m.
    name : of their links in the new model, which get -1 and -2 behind it.
    """

    shapes: ClassVar[dict[str, str]] = {"order": "count", "axes": "segment", "name": "text"}
    flat = ("weight",)

    order: int
    axes: tuple[Pair, Pair]
    weight: Weight
    name: str = "balance-shaft"


@dataclass(frozen=True)
class SpringChoice(Frozen):
    """A spring may be set between a point of a link and a point of the frame.

    stiffness : the most that it may have, N/m.
    free_length : least and largest, m; None for any.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("link", "point", "to"), "text"),
        "stiffness": "number",
        "free_length": "pair?",
    }

    link: str
    point: str
    to: str
    stiffness: float
    free_length: Pair | None = None


@dataclass(frozen=True)
class Phases(Frozen):
    """The phases of all rows but the first may be changed.

    step : of the grid on which they are looked for before they are polished, rad.
    """

    shapes: ClassVar[dict[str, str]] = {"step": "number"}

    step: float = radians(5)


@dataclass(frozen=True)
class Objective(Frozen):
    """What is to become small: a measure of an output.

    output : such as ``shaking_force.y``, ``shaking_force``, ``shaking_moment``, ``drive_torque``,
        ``joints.B``, ``gauges.NAME``.
    orders : those that count, events in one turn of the crank; all if empty.
    about : point of the frame about which a moment is taken; the drive's pivot if None.
    weight : where there are several objectives, by which each, over its value before, counts.
    speeds : of the crank, rad/s, at which a gauge is read; the loudest counts.  The drive's speed
        if empty.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("output", "measure"), "text"),
        **dict.fromkeys(("orders", "speeds"), "row"),
        "about": "text?",
        "weight": "number",
    }

    output: str
    measure: Measure = "rms"
    orders: tuple[float, ...] = ()
    about: str | None = None
    weight: float = 1.0
    speeds: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """How it is called in results, such as ``rms of shaking_force.y``."""
        words = "area under" if self.measure == "area" else f"{self.measure} of"
        orders = f" (order {', '.join(f'{order:g}' for order in self.orders)})"
        about = f" about {self.about}" if self.about else ""
        if self.speeds:
            about += f" at {', '.join(f'{speed * 30 / pi:.6g}' for speed in self.speeds)} rpm"
        name = f"{words} {self.output}{about}{orders if self.orders else ''}"
        return name.replace("_to_", " to ")


@dataclass(frozen=True)
class Limit(Frozen):
    """What must not become larger: a measure of an output.

    objective : the output and its measure; its weight does not count.
    at_most : in SI units.  ratio : over the value before, instead.
    """

    shapes: ClassVar[dict[str, str]] = {"at_most": "number?", "ratio": "number?"}
    flat = ("objective",)

    objective: Objective
    at_most: float | None = None
    ratio: float | None = None

    @property
    def name(self) -> str:
        return self.objective.name


@dataclass(frozen=True)
class Balance(Frozen):
    """What may be changed, what is to become small, and what must be kept.

    combine : several objectives as their weighted ``sum``, or as the root of the sum of
        ``squares``.
    added_mass : the most that may be added in all, kg.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(
            ("moves", "masses", "geared", "shafts", "springs", "objectives", "limits"), "list"
        ),
        "combine": "text",
        "added_mass": "number?",
    }

    moves: tuple[CenterMove, ...] = ()
    masses: tuple[AddedMass, ...] = ()
    geared: tuple[GearedWeight, ...] = ()
    shafts: tuple[BalanceShafts, ...] = ()
    springs: tuple[SpringChoice, ...] = ()
    phases: Phases | None = None
    objectives: tuple[Objective, ...] = ()
    limits: tuple[Limit, ...] = ()
    combine: Literal["sum", "squares"] = "sum"
    added_mass: float | None = None

    def combined(self, values: Sequence[float]) -> float:
        """Objectives, each over its value before, as one number."""
        found = [one.weight * value for one, value in zip(self.objectives, values, strict=True)]
        return hypot(*found) if self.combine == "squares" else sum(found)

    @property
    def changes_nothing(self) -> bool:
        """Whether nothing is free to change."""
        parts = (self.moves, self.masses, self.geared, self.shafts, self.springs)
        return not any(parts) and self.phases is None


def plate_mass(weight: Weight, area: float) -> float:
    """Mass (kg) of an area (m2) of the plate that a weight is cut from."""
    assert weight.thickness is not None and weight.density is not None
    return weight.thickness * weight.density * area


def largest_mass(weight: Weight) -> float:
    """The most mass (kg) that fits into the room of a weight."""
    if weight.shape not in CUT:
        return inf
    inner = weight.inner_radius if weight.shape != "disc" else 0.0
    return plate_mass(weight, pi * (weight.radius**2 - inner**2))
