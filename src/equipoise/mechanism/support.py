"""What carries the linkages: a rigid body on mounts, the gauges on it, and the rows of linkages.

They are part of the model; `equipoise.vibration` computes with them.  Places are in the frame's
axes while the machine stands still: x forward, y up, z to the right of who looks forward.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING, ClassVar

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.frozen import Frozen

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

Place = tuple[float, float, float]
"""x (forward), y (up) and z (to the right), m."""
Direction = float | tuple[float, float, float]
"""Angle from the x axis in the plane of the drawing, rad; or any vector along it."""

PLANAR = ("surge", "heave", "pitch")
FREEDOMS = ("surge", "heave", "sway", "roll", "yaw", "pitch")
"""Along x, y, z and about x, y, z: the order of coordinates in `equipoise.vibration`."""
HELD = ("surge", "heave", "sway")
"""What a pivot takes away."""
AXES = ("roll", "yaw", "pitch")
UP = pi / 2
UNITS = {
    "stiffness": "N/m",
    "damping": "N s/m",
    "torsional_stiffness": "N m/rad",
    "torsional_damping": "N m s/rad",
}
MOST = {"mounts": 200, "gauges": 200, "rows": 200}


def unit_vector(direction: Direction) -> Place:
    """Vector of length 1 along a direction."""
    if isinstance(direction, tuple):
        length = hypot(*direction)
        return (direction[0] / length, direction[1] / length, direction[2] / length)
    x, y = cos(direction), sin(direction)
    # Straight up is straight up: what is left of pi's rounding would couple what is not coupled.
    return (0.0 if abs(x) < 1e-15 else x, 0.0 if abs(y) < 1e-15 else y, 0.0)


@dataclass(frozen=True)
class Mount(Frozen):
    """A spring and damper between support and ground, along a line or about an axis.

    point : of the support, at which it acts; with `stiffness` (N/m) and `damping` (N s/m).
    direction : in which it pushes the support; it stays so when the support moves.
    preload : force (N), about an axis torque (N m), with which it pushes in the drawn position;
        None where the weight settles.
    one_sided : it can push only, like a float on the ground.
    axis : roll, yaw or pitch, about which it turns back; with `torsional_stiffness` (N m/rad) and
        `torsional_damping` (N m s/rad), instead of a point.
    """

    shapes: ClassVar[dict[str, str]] = {
        "point": "place?",
        "direction": "direction",
        **dict.fromkeys(("stiffness", "damping"), "number"),
        "preload": "number?",
        "one_sided": "flag",
        "axis": "text?",
        **dict.fromkeys(("torsional_stiffness", "torsional_damping"), "number"),
    }

    point: Place | None = None
    direction: Direction = UP
    stiffness: float = 0.0
    damping: float = 0.0
    preload: float | None = None
    one_sided: bool = False
    axis: str | None = None
    torsional_stiffness: float = 0.0
    torsional_damping: float = 0.0

    @property
    def spring(self) -> float:
        """Stiffness along its line, N/m, or about its axis, N m/rad."""
        return self.stiffness if self.axis is None else self.torsional_stiffness

    @property
    def damper(self) -> float:
        """Damping coefficient along its line, N s/m, or about its axis, N m s/rad."""
        return self.damping if self.axis is None else self.torsional_damping


@dataclass(frozen=True)
class Gauge(Frozen):
    """Where the support's motion is read: the displacement of a point along a direction, or the
    rotation about an axis (roll, yaw or pitch).
    """

    shapes: ClassVar[dict[str, str]] = {
        "point": "place?",
        "direction": "direction",
        "axis": "text?",
    }

    point: Place | None = None
    direction: Direction = UP
    axis: str | None = None


@dataclass(frozen=True)
class Row(Frozen):
    """One of several equal linkages on the support, all driven by one shaft.

    phase : rad, by which its crank is ahead.  lateral : z of its plane, m.
    offset : (x, y) by which it stands beside the linkage of the file, m.
    """

    shapes: ClassVar[dict[str, str]] = {"phase": "number", "lateral": "number", "offset": "pair"}

    phase: float = 0.0
    lateral: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Support(Frozen):
    """The rigid body that carries the linkages, without their moving links.

    mass : kg, with everything that is fixed to it, motor and flywheel included.
    center_of_mass : of it, m.
    inertia : kg m2, about the centre of mass: one number about the lateral axis, or three about x,
        y and z (roll, yaw and pitch).
    products : integrals of x y, y z and z x over its mass, about the centre of mass, kg m2.
    pivot_inertia : kg m2, about the pivot and the lateral axis, instead of `inertia`.
    pivot : (x, y) of the pin that carries it, m.
    freedoms : how it can move, names from `FREEDOMS`; about the pivot where there is one.  Empty
        for pitch alone with a pivot, and for surge, heave and pitch without.
    """

    shapes: ClassVar[dict[str, str]] = {
        "mass": "number",
        "center_of_mass": "place",
        "inertia": "row",
        "products": "row",
        "pivot_inertia": "number?",
        "pivot": "pair?",
        "freedoms": "names",
        "mounts": "values",
        "gauges": "values",
    }

    mass: float
    center_of_mass: Place
    inertia: tuple[float, ...] = ()
    products: tuple[float, ...] = ()
    pivot_inertia: float | None = None
    pivot: tuple[float, float] | None = None
    freedoms: tuple[str, ...] = ()
    mounts: Mapping[str, Mount] = field(default_factory=dict)
    gauges: Mapping[str, Gauge] = field(default_factory=dict)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """How it can move, in the order of `FREEDOMS`."""
        if self.freedoms:
            return tuple(name for name in FREEDOMS if name in self.freedoms)
        return ("pitch",) if self.pivot is not None else PLANAR

    @property
    def planar(self) -> bool:
        """Whether it moves in the plane of the drawing only."""
        return set(self.coordinates) <= set(PLANAR)

    @property
    def reference(self) -> Place:
        """The point by whose displacement its place is told: the pivot, or the centre of mass."""
        return self.center_of_mass if self.pivot is None else (*self.pivot, 0.0)


def wrong_support(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with the support and the rows of a machine."""
    if len(machine.rows) > MOST["rows"]:
        yield ModelError("rows", f"got {len(machine.rows)}; at most {MOST['rows']} are used")
    support = machine.support
    if support is None:
        return
    yield from _wrong_freedoms(support)
    yield from _wrong_body(support)
    for kind, items in (("mounts", support.mounts), ("gauges", support.gauges)):
        if len(items) > MOST[kind]:
            yield ModelError(
                f"support.{kind}", f"got {len(items)}; at most {MOST[kind]} are computed with"
            )
        for name in items:
            if not name.strip() or not name.isprintable() or len(name) > 200:
                yield ModelError(f"support.{kind}", f"got the name {name[:60]!r}; give another")
    for name, mount in support.mounts.items():
        yield from _wrong_mount(f"support.mounts.{name}", mount)
    for name, gauge in support.gauges.items():
        yield from _wrong_reading(f"support.gauges.{name}", gauge)


def _wrong_freedoms(support: Support) -> Iterator[ModelError]:
    for number, name in enumerate(support.freedoms, 1):
        if name not in FREEDOMS:
            yield ModelError(f"support.freedoms[{number}]", unknown(name, FREEDOMS, "freedom"))
        elif support.pivot is not None and name in HELD:
            yield ModelError(
                f"support.freedoms[{number}]",
                f"the pivot is a pin in the ground, which leaves no {name}; leave out one of them",
            )
        elif name in support.freedoms[: number - 1]:
            yield ModelError(f"support.freedoms[{number}]", f"{name!r} is given twice")


def _wrong_body(support: Support) -> Iterator[ModelError]:
    if support.mass <= 0:
        yield ModelError("support.mass", f"got {support.mass:g} kg; give more than 0")
    if bool(support.inertia) == (support.pivot_inertia is not None):
        yield ModelError("support", "give either inertia or pivot_inertia")
        return
    if support.pivot_inertia is not None:
        if support.products:
            yield ModelError("support.products", "goes with an inertia of three values")
        yield from _wrong_pivot_inertia(support)
        return
    if len(support.inertia) not in {1, 3}:
        yield ModelError("support.inertia", f"got {len(support.inertia)} values; give one or three")
    elif len(support.inertia) == 1 and not support.planar:
        yield ModelError(
            "support.inertia",
            f"got one value, but the support can {_out_of_plane(support)}; give three, about x, y "
            "and z",
        )
    elif min(support.inertia) <= 0:
        yield ModelError(
            "support.inertia", f"got {min(support.inertia):g} kg m^2; give more than 0"
        )
    elif len(support.inertia) == 3:
        yield from _wrong_moments(support)
    if support.products and len(support.inertia) != 3:
        yield ModelError("support.products", "goes with an inertia of three values")
    elif support.products and len(support.products) != 3:
        yield ModelError("support.products", "give three values, of x y, y z and z x")


def _out_of_plane(support: Support) -> str:
    return " and ".join(name for name in support.coordinates if name not in PLANAR)


def _wrong_moments(support: Support) -> Iterator[ModelError]:
    a, b, c = sorted(support.inertia)
    if c > (a + b) * (1 + 1e-9):
        yield ModelError(
            "support.inertia",
            f"got {c:g} kg m^2 beside {a:g} and {b:g}; no body has one moment of inertia above the "
            "sum of the others",
        )
    if len(support.products) == 3:
        (xx, yy, zz), (xy, yz, zx) = support.inertia, support.products
        minors = (xx * yy - xy**2, yy * zz - yz**2, zz * xx - zx**2)
        whole = xx * minors[1] - xy * (xy * zz + yz * zx) - zx * (xy * yz + yy * zx)
        if min(*minors, whole) <= 0:
            yield ModelError(
                "support.products",
                f"got {xy:g}, {yz:g} and {zx:g} kg m^2 beside an inertia of {xx:g}, {yy:g} and "
                f"{zz:g}; no body has that, give smaller ones",
            )


def _wrong_pivot_inertia(support: Support) -> Iterator[ModelError]:
    assert support.pivot_inertia is not None
    where = "support.pivot_inertia"
    if support.pivot is None:
        yield ModelError(where, "there is no pivot; give inertia, about the centre of mass")
        return
    if not support.planar:
        yield ModelError(
            where,
            f"the support can {_out_of_plane(support)} too; give inertia about the centre of mass, "
            "three values",
        )
    x, y = (c - p for c, p in zip(support.center_of_mass[:2], support.pivot, strict=True))
    least = support.mass * (x * x + y * y)
    if support.pivot_inertia <= least:
        yield ModelError(
            where,
            f"got {support.pivot_inertia:g} kg m^2; mass and center_of_mass alone make {least:g}, "
            "give more",
        )


def _wrong_mount(where: str, mount: Mount) -> Iterator[ModelError]:
    yield from _wrong_reading(where, mount)
    along = {key: getattr(mount, key) for key in ("stiffness", "damping")}
    about = {key: getattr(mount, key) for key in ("torsional_stiffness", "torsional_damping")}
    own, other = (along, about) if mount.axis is None else (about, along)
    for key, value in own.items():
        if value < 0:
            yield ModelError(f"{where}.{key}", f"got {value:g} {UNITS[key]}; give 0 or more")
    if not any(own.values()):
        yield ModelError(where, f"give at least one of {' and '.join(own)}")
    place = "a point" if mount.axis is None else "an axis"
    for key, value in other.items():
        if value:
            yield ModelError(f"{where}.{key}", f"has no place in a mount with {place}")
    if mount.one_sided and mount.axis is not None:
        yield ModelError(f"{where}.one_sided", "only a mount with a point can push on one side")
    if mount.one_sided and mount.preload is not None and not mount.stiffness:
        yield ModelError(f"{where}.one_sided", "a contact without stiffness carries nothing")


def _wrong_reading(where: str, item: Mount | Gauge) -> Iterator[ModelError]:
    if (item.point is None) == (item.axis is None):
        yield ModelError(where, "give either point or axis")
    if item.axis is not None and item.axis not in AXES:
        yield ModelError(f"{where}.axis", unknown(item.axis, AXES, "axis"))
    if item.axis is not None and item.direction != UP:
        yield ModelError(f"{where}.direction", "goes with a point, not with an axis")
    if isinstance(item.direction, tuple) and hypot(*item.direction) == 0:
        yield ModelError(f"{where}.direction", "got [0, 0, 0]; give a direction")


def idle_parts(machine: Machine) -> Iterator[str]:
    """Mounts and gauges about axes about which the support does not turn."""
    support = machine.support
    if support is None:
        return
    for kind, items in (("mounts", support.mounts), ("gauges", support.gauges)):
        for name, item in items.items():
            if item.axis is not None and item.axis not in support.coordinates:
                yield f"support.{kind}.{name} does nothing: the support cannot {item.axis}"
