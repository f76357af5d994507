"""What carries the linkages: a rigid body on mounts, the gauges on it, and the rows.

They are part of the model; `equipoise.vibration` computes with them.  Places are in the frame's
axes while the machine stands still: x forward, y up, z to the right of who looks forward.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import cos, hypot, pi, sin
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of, key_names, to_say
from equipoise.keys import (
    DirectionKind,
    Flag,
    Frozen,
    Key,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    MenuItem,
    Named,
    OneOr,
    Point,
    Quantity,
    TextKind,
    declared,
    key,
)
from equipoise.mechanism.checks import too_many
from equipoise.quantities import Measured

SpaceVector = tuple[float, float, float]
"""x (forward), y (up) and z (to the right), m."""
Direction = float | tuple[float, float, float]
"""Angle from the x axis in the plane of the drawing, rad; or any vector along it."""
AXES = ("roll", "yaw", "pitch")
UP = pi / 2


def unit_vector(direction: Direction) -> SpaceVector:
    """Vector of length 1 along a direction."""
    if isinstance(direction, tuple):
        length = hypot(*direction)
        return (direction[0] / length, direction[1] / length, direction[2] / length)
    x, y = cos(direction), sin(direction)
    # Straight up is straight up: what is left of pi's rounding would couple what is not coupled.
    return (0.0 if abs(x) < 1e-15 else x, 0.0 if abs(y) < 1e-15 else y, 0.0)


OF_POINT = ("direction", "stiffness", "damping", "preload", "one_sided", "exposure")
OF_AXIS = ("torsional_stiffness", "torsional_damping", "torsional_preload")


def _point_or_axis(**conditions: Any) -> dict[str, Any]:
    """JSON Schema of a table that has a point or an axis, with the keys that go with it."""
    branches = [
        {
            "required": [item],
            "properties": dict.fromkeys((*others, other), False),
            **(
                {"anyOf": [{"required": [with_]} for with_ in conditions[item]]}
                if conditions
                else {}
            ),
        }
        for item, other, others in (("point", "axis", OF_AXIS), ("axis", "point", OF_POINT))
    ]
    return {"oneOf": branches}


def _check_company(given: Mapping[str, Any]) -> None:
    """Refuse keys of a point beside an axis, and the other way round."""
    if ("point" in given) == ("axis" in given):
        return  # the checks of the machine refuse this
    others, has = (OF_AXIS, Note("a point")) if "point" in given else (OF_POINT, Note("an axis"))
    for item in others:
        if item in given:
            raise ModelError(item, Note("has no place beside {has}; leave it out", has=has))


@declared
class Mount(Frozen):
    """A spring and damper between support and ground, along a line or about an axis.

    preload : force (N), about an axis torque (N m), with which it pushes in the drawn position;
        None where the weight settles.
    """

    called = to_say("{what} of mount {name}")
    menu_item = MenuItem(to_say("Mount of the support …"), ({"point": "place"},))
    extra_keys: ClassVar[Keys] = {
        "torsional_preload": Key(
            "torsional_preload",
            Quantity("torque"),
            "torque with which it turns the support in the drawn position; as `preload`",
            default=None,
        )
    }
    file_order = ("point", "axis", "direction", "stiffness", "damping", "torsional_stiffness",
             "torsional_damping", "preload", "torsional_preload", "one_sided")  # fmt: skip
    conditions: ClassVar[KeyConditions] = _point_or_axis(
        point=("stiffness", "damping"), axis=OF_AXIS[:2]
    )

    point: SpaceVector | None = key(
        Point(space=True),
        "of the support, at which it acts",
        default=None,
        example=["0 mm", "300 mm"],
    )
    direction: Direction = key(
        DirectionKind(), "in which it pushes the support; it stays fixed in space", default=UP
    )
    stiffness: float = key("stiffness", "along the direction", default=0.0, at_least=0)
    damping: float = key("damping", "along the direction", default=0.0, at_least=0)
    preload: float | None = key(
        "force",
        "force with which it pushes in the drawn position; if left out, the weight rests on the "
        "mounts there",
        default=None,
    )
    one_sided: bool = key(
        Flag(), "it can push only, like a float or a wheel on the ground", default=False
    )
    axis: str | None = key(
        TextKind(AXES), "about which it turns back, instead of `point`", default=None
    )
    torsional_stiffness: float = key(
        "torsional stiffness", "about the axis", default=0.0, at_least=0
    )
    torsional_damping: float = key("torsional damping", "about the axis", default=0.0, at_least=0)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Mount:
        _check_company(given)
        about = given.pop("torsional_preload", None)
        return cls(**given) if about is None else cls(**given, preload=about)

    @classmethod
    def to_table(cls, value: Mount) -> dict[str, Any]:
        table = super().to_table(value)
        if value.axis is not None and "preload" in table:
            table["torsional_preload"] = table.pop("preload")
        return table

    @property
    def spring(self) -> float:
        """Stiffness along its line, N/m, or about its axis, N m/rad."""
        return self.stiffness if self.axis is None else self.torsional_stiffness

    @property
    def damper(self) -> float:
        """Damping coefficient along its line, N s/m, or about its axis, N m s/rad."""
        return self.damping if self.axis is None else self.torsional_damping


@declared
class Gauge(Frozen):
    """Where the support's motion is read: the displacement of a point along a direction, or the
    rotation about an axis.
    """

    called = to_say("{what} of gauge {name}")
    menu_item = MenuItem(to_say("Gauge of the support …"), ({"point": "place"},))
    conditions: ClassVar[KeyConditions] = _point_or_axis()

    point: SpaceVector | None = key(
        Point(space=True),
        "of the support, whose displacement is read",
        default=None,
        example=["0 mm", "1 m"],
    )
    direction: Direction = key(DirectionKind(), "along which it is read", default=UP)
    axis: str | None = key(TextKind(AXES), "about which the rotation is read", default=None)
    exposure: float | None = key(
        "time",
        "time a day for which a hand holds the support at the point: the machine is judged by the "
        "daily exposure A(8) of hand and arm there, in all directions, not by ISO 20816-3",
        default=None,
        example="2 h",
        above=0,
        below=86_400,
        why=Note("give more than 0 and less than 24 h"),
        word=to_say("daily exposure time"),
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Gauge:
        _check_company(given)
        return cls(**given)


# -- checks ----------------------------------------------------------------------------------------


def wrong_mount(where: str, mount: Mount) -> Iterator[ModelError]:
    """Everything that is wrong with a mount."""
    yield from wrong_reading(where, mount)
    along = {key: getattr(mount, key) for key in ("stiffness", "damping")}
    about = {key: getattr(mount, key) for key in ("torsional_stiffness", "torsional_damping")}
    own, other = (along, about) if mount.axis is None else (about, along)
    if not any(own.values()):
        yield ModelError(where, Note("give at least one of {names}", names=all_of([*own])))
    place = Note("a point") if mount.axis is None else Note("an axis")
    for name, value in other.items():
        if value:
            yield ModelError(
                f"{where}.{name}", Note("has no place in a mount with {place}", place=place)
            )
    if mount.one_sided and mount.axis is not None:
        yield ModelError(
            f"{where}.one_sided", Note("only a mount with a point can push on one side")
        )
    if mount.one_sided and mount.preload is not None and not mount.stiffness:
        yield ModelError(f"{where}.one_sided", Note("a contact without stiffness carries nothing"))


def wrong_reading(where: str, item: Mount | Gauge) -> Iterator[ModelError]:
    """Everything that is wrong with where a mount acts, or a gauge reads."""
    if (item.point is None) == (item.axis is None):
        yield ModelError(where, Note("give either point or axis"))
    if item.axis is not None and item.direction != UP:
        yield ModelError(f"{where}.direction", Note("goes with a point, not with an axis"))
    if item.axis is not None and isinstance(item, Gauge) and item.exposure is not None:
        yield ModelError(f"{where}.exposure", Note("goes with a point, not with an axis"))
    if isinstance(item.direction, tuple) and hypot(*item.direction) == 0:
        yield ModelError(f"{where}.direction", Note("got [0, 0, 0]; give a direction"))


__all__ = [
    "AXES",
    "FREEDOMS",
    "PLANAR",
    "TIME_IN_PERIOD",
    "UP",
    "Direction",
    "Gauge",
    "Mount",
    "Row",
    "SpaceVector",
    "Support",
    "idle_parts",
    "unit_vector",
    "wrong_support",
]


EITHER = Note("give either inertia or {pivot_inertia}", **key_names("pivot_inertia"))
PLANAR = ("surge", "heave", "pitch")
FREEDOMS = (
    to_say("surge"),
    to_say("heave"),
    to_say("sway"),
    to_say("roll"),
    to_say("yaw"),
    to_say("pitch"),
)
"""Along x, y, z and about x, y, z: the order of coordinates in `equipoise.vibration`."""
TIME_IN_PERIOD = "time_in_period"
"""Column of time in files of signals that are whole periods of a steady state: its name says so to
a reader of the file."""
PIVOT_CONSTRAINED = ("surge", "heave", "sway")
"""What a pivot takes away."""
MOST = {"mounts": 200, "gauges": 200, "rows": 200}


@declared
class Row(Frozen):
    """One of several equal linkages on the support, all driven by one shaft."""

    called = to_say("{what} of row {number}")

    phase: float = key(
        "angle", "by which its crank angle is larger than that of the drive", default=0.0
    )
    lateral: float = key("length", "z of its plane", default=0.0, word=to_say("place across"))
    offset: tuple[float, float] = key(
        Listing(Quantity("length"), (2,)),
        "x and y by which it stands beside the linkage of the file",
        default=(0.0, 0.0),
    )


@declared
class Support(Frozen):
    """The rigid body that carries the linkages, without their moving links."""

    called = to_say("{what} of the support")
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [
            {"required": ["inertia"], "properties": {"pivot_inertia": False}},
            {
                "required": ["pivot_inertia", "pivot"],
                "properties": {"inertia": False, "products": False},
            },
        ],
        "if": {"required": ["products"]},
        "then": {"properties": {"inertia": {"type": "array"}}},
    }

    mass: float = key(
        "mass",
        "of the support with all that is fixed to it, motor and flywheel too",
        example="60 kg",
        above=0,
    )
    center_of_mass: SpaceVector = key(
        Point(space=True),
        "in the frame's axes",
        example=["0 mm", "300 mm"],
        word=to_say("centre of mass"),
    )
    inertia: tuple[float, ...] = key(
        OneOr(
            Quantity("inertia"),
            3,
            right=Note("one moment of inertia, or a list of three, about x, y and z"),
        ),
        "about the centre of mass and an axis along z; or a list of three, about axes along x, y "
        "and z (roll, yaw, pitch)",
        default=(),
        example="4 kg m^2",
        above=0,
    )
    products: tuple[float, ...] = key(
        Listing(Quantity("inertia"), (3,), Note("a list of three, of x y, y z and z x")),
        "integrals of x y, y z and z x over the mass, about its centre; they go with three moments "
        "of inertia",
        default=(),
    )
    pivot_inertia: float | None = key(
        "inertia", "about the pivot, instead of `inertia`", default=None
    )
    pivot: tuple[float, float] | None = key(
        Point(), "of the pin on the ground that carries the support", default=None
    )
    freedoms: tuple[str, ...] = key(
        Listing(
            TextKind(FREEDOMS),
            right=Note('a list such as ["heave", "pitch"]; leave it out for the usual ones'),
        ),
        "how it can move: along x, y, z or about x, y, z; if left out pitch with a pivot, and "
        "surge, heave and pitch without",
        default=(),
        example=["heave", "pitch"],
    )
    mounts: Mapping[str, Mount] = key(
        Named(KeyTable(Mount)), "springs and dampers by name", factory=dict
    )
    gauges: Mapping[str, Gauge] = key(
        Named(KeyTable(Gauge)), "readings of its motion by name", factory=dict
    )

    @property
    def coordinates(self) -> tuple[str, ...]:
        """How it can move, in the order of `FREEDOMS`."""
        if self.freedoms:
            return tuple(name for name in FREEDOMS if name in self.freedoms)
        return ("pitch",) if self.pivot is not None else PLANAR

    @property
    def readings(self) -> Mapping[str, bool]:
        """What is read of its motion, and whether that is a rotation: its gauges; its coordinates
        where it has none.
        """
        if not self.gauges:
            return {name: name in AXES for name in self.coordinates}
        return {name: gauge.axis is not None for name, gauge in self.gauges.items()}

    @property
    def planar(self) -> bool:
        """Whether it moves in the plane of the drawing only."""
        return set(self.coordinates) <= set(PLANAR)

    @property
    def reference(self) -> SpaceVector:
        """Point whose displacement describes the support's: the pivot, or the centre of mass."""
        return self.center_of_mass if self.pivot is None else (*self.pivot, 0.0)


def wrong_support(support: Support | None, rows: Sequence[Row]) -> Iterator[ModelError]:
    """Everything that is wrong with the support and the rows of a machine."""
    if len(rows) > MOST["rows"]:
        yield ModelError(
            "rows", Note("got {rows}; at most {most} are used", rows=len(rows), most=MOST["rows"])
        )
    if support is None:
        return
    yield from _wrong_freedoms(support)
    yield from _wrong_body(support)
    for kind, items in (("mounts", support.mounts), ("gauges", support.gauges)):
        yield from too_many(f"support.{kind}", items, MOST[kind])
        for name in items:
            if not name.strip() or not name.isprintable() or len(name) > 200:
                yield ModelError(
                    f"support.{kind}", Note("got the name {name!r}; give another", name=name[:60])
                )
    for name, mount in support.mounts.items():
        yield from wrong_mount(f"support.mounts.{name}", mount)
    for name, gauge in support.gauges.items():
        yield from wrong_reading(f"support.gauges.{name}", gauge)


def _wrong_freedoms(support: Support) -> Iterator[ModelError]:
    for number, name in enumerate(support.freedoms, 1):
        if support.pivot is not None and name in PIVOT_CONSTRAINED:
            yield ModelError(
                f"support.freedoms[{number}]",
                Note(
                    "the pivot is a pin in the ground, which leaves no {name}; leave out one "
                    "of them",
                    name=name,
                ),
            )
        elif name in support.freedoms[: number - 1]:
            yield ModelError(
                f"support.freedoms[{number}]", Note("{name!r} is given twice", name=name)
            )


def _wrong_body(support: Support) -> Iterator[ModelError]:
    if bool(support.inertia) == (support.pivot_inertia is not None):
        yield ModelError("support", EITHER)
        return
    if support.pivot_inertia is not None:
        if support.products:
            yield ModelError("support.products", Note("goes with an inertia of three values"))
        yield from _wrong_pivot_inertia(support)
        return
    if len(support.inertia) not in {1, 3}:
        yield ModelError(
            "support.inertia",
            Note("got {inertia} values; give one or three", inertia=len(support.inertia)),
        )
    elif len(support.inertia) == 1 and not support.planar:
        yield ModelError(
            "support.inertia",
            Note(
                "got one value, but the support can {out_of_plane}; give three, about x, y and z",
                out_of_plane=_out_of_plane(support),
            ),
        )
    elif len(support.inertia) == 3:
        yield from _wrong_moments(support)
    if support.products and len(support.inertia) != 3:
        yield ModelError("support.products", Note("goes with an inertia of three values"))
    elif support.products and len(support.products) != 3:
        yield ModelError("support.products", Note("give three values, of x y, y z and z x"))


def _out_of_plane(support: Support) -> Note | str:
    return all_of([Note(name) for name in support.coordinates if name not in PLANAR])


def _wrong_moments(support: Support) -> Iterator[ModelError]:
    a, b, c = sorted(support.inertia)
    if c > (a + b) * (1 + 1e-9):
        yield ModelError(
            "support.inertia",
            Note(
                "got {c} beside {a} and {b}; no body has one moment of inertia above the sum of "
                "the others",
                a=Measured(a, "inertia"),
                b=Measured(b, "inertia"),
                c=Measured(c, "inertia"),
            ),
        )
    if len(support.products) == 3:
        (xx, yy, zz), (xy, yz, zx) = support.inertia, support.products
        minors = (xx * yy - xy**2, yy * zz - yz**2, zz * xx - zx**2)
        whole = xx * minors[1] - xy * (xy * zz + yz * zx) - zx * (xy * yz + yy * zx)
        if min(*minors, whole) <= 0:
            yield ModelError(
                "support.products",
                Note(
                    "got {xy}, {yz} and {zx} beside an inertia of {xx}, {yy} and {zz}; no body "
                    "has that, give smaller ones",
                    xy=Measured(xy, "inertia"),
                    yz=Measured(yz, "inertia"),
                    zx=Measured(zx, "inertia"),
                    xx=Measured(xx, "inertia"),
                    yy=Measured(yy, "inertia"),
                    zz=Measured(zz, "inertia"),
                ),
            )


def _wrong_pivot_inertia(support: Support) -> Iterator[ModelError]:
    assert support.pivot_inertia is not None
    where = "support.pivot_inertia"
    if support.pivot is None:
        yield ModelError(where, Note("there is no pivot; give inertia, about the centre of mass"))
        return
    if not support.planar:
        yield ModelError(
            where,
            Note(
                "the support can {out_of_plane} too; give inertia about the centre of "
                "mass, three values",
                out_of_plane=_out_of_plane(support),
            ),
        )
    x, y = (c - p for c, p in zip(support.center_of_mass[:2], support.pivot, strict=True))
    least = support.mass * (x * x + y * y)
    if support.pivot_inertia <= least:
        yield ModelError(
            where,
            Note(
                "got {given}; mass and {center_of_mass} alone make {least}, give more",
                **key_names("center_of_mass"),
                given=Measured(support.pivot_inertia, "inertia"),
                least=Measured(least, "inertia"),
            ),
        )


STILL = 1e-9
"""Over the arm, m: a way along a direction that is rounding."""


def idle_parts(support: Support | None) -> Iterator[Note | str]:
    """Mounts and gauges about axes about which the support does not turn, and gauges along
    directions in which it does not move where they are.
    """
    if support is None:
        return
    for kind, items in (("mounts", support.mounts), ("gauges", support.gauges)):
        for name, item in items.items():
            if item.axis is not None and item.axis not in support.coordinates:
                yield Note(
                    "support.{kind}.{name} does nothing: the support cannot {motion}",
                    kind=kind,
                    name=name,
                    motion=item.axis,
                )
    for name, gauge in support.gauges.items():
        if gauge.axis is None and not _moves_along(support, gauge):
            yield Note(
                "support.gauges.{name} reads nothing: the support cannot move along its direction "
                "there",
                name=name,
            )


def _moves_along(support: Support, gauge: Gauge) -> bool:
    """Whether any way in which the support can move has a part along the direction of a gauge."""
    assert gauge.point is not None
    center = support.center_of_mass if support.pivot is None else support.pivot
    x, y, z = (a - b for a, b in zip(_in_space(gauge.point), _in_space(center), strict=True))
    ways = {
        "surge": (1.0, 0.0, 0.0),
        "heave": (0.0, 1.0, 0.0),
        "sway": (0.0, 0.0, 1.0),
        "roll": (0.0, -z, y),
        "yaw": (z, 0.0, -x),
        "pitch": (-y, x, 0.0),
    }
    along, least = unit_vector(gauge.direction), STILL * (1 + max(abs(x), abs(y), abs(z)))
    parts = (
        sum(a * b for a, b in zip(along, ways[name], strict=True)) for name in support.coordinates
    )
    return any(abs(part) > least for part in parts)


def _in_space(point: Sequence[float]) -> tuple[float, float, float]:
    """A place in m with its third coordinate, 0 where it has none."""
    x, y, *rest = point
    return x, y, rest[0] if rest else 0.0
