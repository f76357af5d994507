"""From a support, rows and a motor to their tables in the model file."""

from __future__ import annotations

from typing import Any

from equipoise.mechanism.force_elements import Motor
from equipoise.mechanism.support import UP, Direction, Gauge, Mount, Place, Row, Support
from equipoise.quantities import Dimension, format_exact
from equipoise.schema.plain import listed, quantities, tidy, unless
from equipoise.schema.points import written


def support_table(support: Support) -> dict[str, Any]:
    """Content of [support]; defaults are left out."""
    mounts = {name: _mount(mount) for name, mount in support.mounts.items()}
    gauges = {name: _reading(gauge) for name, gauge in support.gauges.items()}
    return {
        "mass": format_exact(support.mass, "mass"),
        "center_of_mass": _place(support.center_of_mass),
        **unless(not support.inertia, inertia=_inertia(support.inertia)),
        **unless(not support.products, products=listed(support.products, "inertia")),
        **quantities(support, {"pivot_inertia": "inertia"}),
        **({} if support.pivot is None else {"pivot": written(support.pivot)}),
        **unless(not support.freedoms, freedoms=[*support.freedoms]),
        **unless(not mounts, mounts=mounts),
        **unless(not gauges, gauges=gauges),
    }


def row_table(row: Row) -> dict[str, Any]:
    """Content of one of [[rows]]."""
    return {
        **quantities(row, {"phase": "angle", "lateral": "length"}),
        **unless(row.offset == (0, 0), offset=listed(row.offset, "length")),
    }


def motor_table(motor: Motor, table: str | None) -> dict[str, Any]:
    """Content of [drive.motor], with the name of the file of its table."""
    return {
        **quantities(motor, {"no_load_speed": "angular speed", "stall_torque": "torque"}),
        **unless(table is None, table=table),
        **unless(motor.ratio == 1, ratio=motor.ratio),
        **quantities(motor, {"inertia": "inertia"}),
        **unless(motor.mean_speed == "held", mean_speed=motor.mean_speed),
    }


def _inertia(inertia: tuple[float, ...]) -> str | list[str]:
    texts = listed(inertia, "inertia")
    return texts[0] if len(texts) == 1 else texts


def _mount(mount: Mount) -> dict[str, Any]:
    table = _reading(mount) | quantities(mount, RATES)
    if mount.preload is not None:  # none is not the same as 0
        if mount.axis is None:
            table["preload"] = format_exact(mount.preload, "force")
        else:
            table["torsional_preload"] = format_exact(mount.preload, "torque")
    return table | unless(not mount.one_sided, one_sided=True)


RATES: dict[str, Dimension] = {
    "stiffness": "stiffness",
    "damping": "damping",
    "torsional_stiffness": "torsional stiffness",
    "torsional_damping": "torsional damping",
}


def _reading(item: Mount | Gauge) -> dict[str, Any]:
    if item.point is None:
        return {"axis": item.axis}
    table = {"point": _place(item.point)}
    return table | unless(item.direction == UP, direction=_direction(item.direction))


def _place(place: Place) -> list[str] | dict[str, str]:
    return listed(place, "length") if place[2] else written((place[0], place[1]))


def _direction(direction: Direction) -> str | list[float]:
    if isinstance(direction, tuple):
        return [tidy(component) for component in direction]
    return format_exact(direction, "angle")
