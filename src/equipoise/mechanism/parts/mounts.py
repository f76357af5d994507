"""Mounts and gauges of a support: along a line or about an axis, as values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos, hypot, pi, sin
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of, to_say
from equipoise.keys import (
    Conditions,
    Flag,
    Frozen,
    Key,
    Keys,
    Point,
    Quantity,
    TextKind,
    declared,
    key,
)
from equipoise.keys import Direction as DirectionKind

Place = tuple[float, float, float]
"""x (forward), y (up) and z (to the right), m."""
Direction = float | tuple[float, float, float]
"""Angle from the x axis in the plane of the drawing, rad; or any vector along it."""
AXES = ("roll", "yaw", "pitch")
UP = pi / 2


def unit_vector(direction: Direction) -> Place:
    """Vector of length 1 along a direction."""
    if isinstance(direction, tuple):
        length = hypot(*direction)
        return (direction[0] / length, direction[1] / length, direction[2] / length)
    x, y = cos(direction), sin(direction)
    # Straight up is straight up: what is left of pi's rounding would couple what is not coupled.
    return (0.0 if abs(x) < 1e-15 else x, 0.0 if abs(y) < 1e-15 else y, 0.0)


OF_POINT = ("direction", "stiffness", "damping", "preload", "one_sided")
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
        return  # told by the checks of the machine
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
    beside: ClassVar[Keys] = {
        "torsional_preload": Key(
            "torsional_preload",
            Quantity("torque"),
            "torque with which it turns the support in the drawn position; as `preload`",
            default=None,
        )
    }
    file_order = ("point", "axis", "direction", "stiffness", "damping", "torsional_stiffness",
             "torsional_damping", "preload", "torsional_preload", "one_sided")  # fmt: skip
    conditions: ClassVar[Conditions] = _point_or_axis(
        point=("stiffness", "damping"), axis=OF_AXIS[:2]
    )

    point: Place | None = key(
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
    conditions: ClassVar[Conditions] = _point_or_axis()

    point: Place | None = key(
        Point(space=True),
        "of the support, whose displacement is read",
        default=None,
        example=["0 mm", "1 m"],
    )
    direction: Direction = key(DirectionKind(), "along which it is read", default=UP)
    axis: str | None = key(TextKind(AXES), "about which the rotation is read", default=None)

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
    if isinstance(item.direction, tuple) and hypot(*item.direction) == 0:
        yield ModelError(f"{where}.direction", Note("got [0, 0, 0]; give a direction"))
