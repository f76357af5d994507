"""From a machine to the text of its model file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from equipoise.mechanism.balance import LISTS
from equipoise.mechanism.field import Planting, Soil
from equipoise.mechanism.model import (
    FRAME,
    STANDARD_GRAVITY,
    Drive,
    Gear,
    Link,
    Load,
    Machine,
    Position,
    Slider,
    Spring,
    Vector,
)
from equipoise.quantities import Dimension, format_exact
from equipoise.schema import SCHEMA_VERSION
from equipoise.schema.plain import listed, quantities, unless
from equipoise.schema.points import written
from equipoise.schema.writing_balance import balance_table
from equipoise.schema.writing_support import motor_table, row_table, support_table

_PRESSURE_ANGLE = next(field.default for field in fields(Gear) if field.name == "pressure_angle")


def document_of(machine: Machine, tables: Mapping[str, str]) -> dict[str, Any]:
    """Return the content of the model file as plain values; defaults are left out.

    Parameters
    ----------
    machine : what is to be written.
    tables : name of the CSV file for each key that names one, such as ``loads[1].table``.
    """
    support = machine.support
    loads = [
        _load(load, tables.get(f"loads[{number}].table"))
        for number, load in enumerate(machine.loads, 1)
    ]
    planting, balance = machine.planting, machine.balance
    return {
        "schema": SCHEMA_VERSION,
        "title": machine.title,
        **unless(machine.description == "", description=machine.description),
        **unless(
            machine.gravity == STANDARD_GRAVITY, gravity=listed(machine.gravity, "acceleration")
        ),
        "drive": _drive(machine.drive, tables.get("drive.motor.table")),
        "frame": {"points": _points(machine.frame)},
        "links": {name: _link(link) for name, link in machine.links.items()},
        **unless(not machine.assembly, assembly=dict(machine.assembly)),
        **unless(not machine.sliders, sliders=[_slider(slider) for slider in machine.sliders]),
        **unless(not machine.gears, gears=[_gear(gear) for gear in machine.gears]),
        **unless(not loads, loads=loads),
        **unless(not machine.springs, springs=[_spring(spring) for spring in machine.springs]),
        **({} if machine.position is None else {"position": _position(machine.position)}),
        **({} if planting is None else {"planting": _planting(planting, tables)}),
        **({} if support is None else {"support": support_table(support)}),
        **unless(not machine.rows, rows=[row_table(row) for row in machine.rows]),
        **({} if balance is None else {"balance": balance_table(balance, machine)}),
    }


BY_NAME = {"links", "support.mounts", "support.gauges"}
"""Tables that hold nothing but tables with names."""
HEADED = {
    "drive.motor",
    "support.mounts",
    "support.gauges",
    "balance.phases",
    *(f"balance.{key}" for key in LISTS),
    "shaft.segments",
    "shaft.stations",
    "design.variables",
    "design.limits",
}
"""Tables inside of others that are written below a header of their own."""


def toml_text(document: Mapping[str, Any]) -> str:
    """Write a document as TOML, with one line a key and one table a link, joint or mount."""
    plain = {key: value for key, value in document.items() if not _is_tables(value)}
    blocks = ["".join(_lines(plain))]
    for key, value in document.items():
        if isinstance(value, dict):
            blocks += _blocks(key, value)
        elif _is_tables(value):
            blocks += [_block(f"[[{key}]]", item) for item in value]
    return "\n".join(blocks)


def _blocks(name: str, table: Mapping[str, Any]) -> Iterable[str]:
    if name in BY_NAME:
        for key, item in table.items():
            yield _block(f"[{name}.{_key(key)}]", item)
        return
    within = {key: item for key, item in table.items() if f"{name}.{key}" in HEADED}
    yield _block(f"[{name}]", {key: item for key, item in table.items() if key not in within})
    for key, item in within.items():
        if isinstance(item, list):
            yield from (_block(f"[[{name}.{key}]]", table) for table in item)
        else:
            yield from _blocks(f"{name}.{key}", item)


def _is_tables(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and all(isinstance(item, dict) for item in value)
    )


def _block(header: str, table: Mapping[str, Any]) -> str:
    return "".join([header, "\n", *_lines(table)])


def _lines(table: Mapping[str, Any], prefix: str = "") -> Iterable[str]:
    for key, value in table.items():
        if isinstance(value, dict) and not _is_polar(value):
            yield from _lines(value, f"{prefix}{_key(key)}.")
        else:
            yield f"{prefix}{_key(key)} = {_value(value)}\n"


def _is_polar(table: Mapping[str, Any]) -> bool:
    # A table of points may have these names too, but then they stand for points.
    return set(table) == {"distance", "direction"} and isinstance(table["distance"], str)


def _value(value: Any) -> str:
    import tomli_w

    if isinstance(value, list):  # tomli_w spreads lists over several lines
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, dict):
        return (
            f"{{ {', '.join(f'{_key(name)} = {_value(item)}' for name, item in value.items())} }}"
        )
    return tomli_w.dumps({"k": value}).removeprefix("k = ").removesuffix("\n")


def _key(name: str) -> str:
    import tomli_w

    return tomli_w.dumps({name: 0}).removesuffix(" = 0\n")


# -- the parts of a machine ------------------------------------------------------------------------


def _points(points: Mapping[str, Vector]) -> dict[str, Any]:
    return {name: written(point) for name, point in points.items()}


def _drive(drive: Drive, table: str | None) -> dict[str, Any]:
    return {
        "link": drive.link,
        "speed": format_exact(drive.speed, "angular speed"),
        **quantities(drive, {"acceleration": "angular acceleration", "flywheel": "inertia"}),
        **({} if drive.motor is None else {"motor": motor_table(drive.motor, table)}),
    }


def _link(link: Link) -> dict[str, Any]:
    table: dict[str, Any] = {"points": _points(link.points)}
    if link.mass is not None:
        table["mass"] = format_exact(link.mass, "mass")
    if link.center_of_mass is not None:
        table["center_of_mass"] = written(link.center_of_mass)
    if link.inertia is not None:
        table["inertia"] = format_exact(link.inertia, "inertia")
    return table


def _slider(slider: Slider) -> dict[str, Any]:
    return {
        "link": slider.link,
        "point": slider.point,
        "on": slider.on,
        "through": slider.through,
        "direction": format_exact(slider.direction, "angle"),
        **quantities(slider, {"angle": "angle"}),
    }


def _gear(gear: Gear) -> dict[str, Any]:
    if gear.teeth is None:
        sizes: dict[str, Any] = {"ratio": gear.ratio}
    else:
        sizes = {"teeth": list(gear.teeth), "mesh": gear.mesh}
    return {
        "between": [gear.driver, gear.driven],
        **sizes,
        **unless(gear.carrier == FRAME, carrier=gear.carrier),
        **quantities(gear, {"start": "angle"}),
        **unless(
            gear.pressure_angle == _PRESSURE_ANGLE,
            pressure_angle=format_exact(gear.pressure_angle, "angle"),
        ),
    }


def _load(load: Load, table: str | None) -> dict[str, Any]:
    given: dict[str, Any] = {"link": load.link}
    if load.point is not None:
        given["point"] = load.point
    if load.force is not None:
        given["force"] = listed(load.force, "force")
    if load.torque is not None:
        given["torque"] = format_exact(load.torque, "torque")
    if load.table is not None:
        given["table"] = table
    if load.start is not None and load.stop is not None:
        given["from"] = format_exact(load.start, "angle")
        given["to"] = format_exact(load.stop, "angle")
    return given


def _spring(spring: Spring) -> dict[str, Any]:
    return {
        "link": spring.link,
        "point": spring.point,
        "to": spring.to,
        "stiffness": format_exact(spring.stiffness, "stiffness"),
        **quantities(spring, {"free_length": "length"}),
    }


def _position(position: Position) -> dict[str, Any]:
    angles = {name: format_exact(angle, "angle") for name, angle in position.angles.items()}
    return {
        **quantities(position, {"crank_angle": "angle"}),
        **unless(not position.points, points=_points(position.points)),
        **unless(not angles, angles=angles),
    }


def _planting(planting: Planting, tables: Mapping[str, str]) -> dict[str, Any]:
    given = {key: getattr(planting, key) for key in PLANTING}
    table: dict[str, Any] = {"tip": planting.tip}
    table |= {
        key: format_exact(value, PLANTING[key]) for key, value in given.items() if value is not None
    }
    table |= unless(planting.units_per_turn == 1, units_per_turn=planting.units_per_turn)
    table |= unless(planting.travel == "forward", travel=planting.travel)
    table |= unless(planting.finger_from is None, finger_from=planting.finger_from)
    if planting.tray is not None:
        table["tray"] = [written(end) for end in planting.tray]
    if planting.soil is not None:
        table["soil"] = _soil(planting.soil, tables.get("planting.soil.table"))
    return table


PLANTING: dict[str, Dimension] = {
    "forward_speed": "speed",
    "hill_spacing": "length",
    "depth": "length",
    "surface": "length",
    "release": "angle",
    "acceleration_limit": "acceleration",
    "soil_acceleration_limit": "acceleration",
}


def _soil(soil: Soil, table: str | None) -> dict[str, Any]:
    dimensions: dict[str, Dimension] = {
        "resistance": "force",
        "per_depth": "stiffness",
        "per_speed": "damping",
        "per_depth_and_speed": "damping per length",
    }
    return {**quantities(soil, dimensions), **unless(table is None, table=table)}
