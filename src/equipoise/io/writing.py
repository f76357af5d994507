"""From a machine to the text of its model file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from equipoise.io import SCHEMA_VERSION
from equipoise.io.points import written
from equipoise.io.units import Dimension, format_exact
from equipoise.mechanism.field import Planting, Soil
from equipoise.mechanism.model import (
    FRAME,
    STANDARD_GRAVITY,
    Gear,
    Link,
    Load,
    Machine,
    Position,
    Slider,
    Vector,
)

_PRESSURE_ANGLE = next(field.default for field in fields(Gear) if field.name == "pressure_angle")


def document_of(machine: Machine, tables: Mapping[str, str]) -> dict[str, Any]:
    """Return the content of the model file as plain values; defaults are left out.

    Parameters
    ----------
    machine : what is to be written.
    tables : name of the CSV file for each key that names one, such as ``loads[1].table``.
    """
    drive = machine.drive
    loads = [
        _load(load, tables.get(f"loads[{number}].table"))
        for number, load in enumerate(machine.loads, 1)
    ]
    planting = machine.planting
    return {
        "schema": SCHEMA_VERSION,
        "title": machine.title,
        **_unless(machine.description == "", description=machine.description),
        **_unless(
            machine.gravity == STANDARD_GRAVITY, gravity=_pair(machine.gravity, "acceleration")
        ),
        "drive": {
            "link": drive.link,
            "speed": format_exact(drive.speed, "angular speed"),
            **_unless(
                drive.acceleration == 0,
                acceleration=format_exact(drive.acceleration, "angular acceleration"),
            ),
        },
        "frame": {"points": _points(machine.frame)},
        "links": {name: _link(link) for name, link in machine.links.items()},
        **_unless(not machine.assembly, assembly=dict(machine.assembly)),
        **_unless(not machine.sliders, sliders=[_slider(slider) for slider in machine.sliders]),
        **_unless(not machine.gears, gears=[_gear(gear) for gear in machine.gears]),
        **_unless(not loads, loads=loads),
        **({} if machine.position is None else {"position": _position(machine.position)}),
        **({} if planting is None else {"planting": _planting(planting, tables)}),
    }


def toml_text(document: Mapping[str, Any]) -> str:
    """Write a document as TOML, with one line a key and one table a link or joint."""
    plain = {key: value for key, value in document.items() if not _is_tables(value)}
    blocks = ["".join(_lines(plain))]
    for key, value in document.items():
        if key == "links":
            blocks += [_block(f"[links.{_key(name)}]", link) for name, link in value.items()]
        elif isinstance(value, dict):
            blocks.append(_block(f"[{key}]", value))
        elif _is_tables(value):
            blocks += [_block(f"[[{key}]]", item) for item in value]
    return "\n".join(blocks)


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


def _unless(default: bool, **items: Any) -> dict[str, Any]:
    return {} if default else items


def _quantities(table: Any, dimensions: Mapping[str, Dimension]) -> dict[str, str]:
    """Write those attributes that are neither None nor 0."""
    return {
        name: format_exact(value, dimension)
        for name, dimension in dimensions.items()
        if (value := getattr(table, name))
    }


def _pair(vector: Vector, dimension: Dimension) -> list[str]:
    return [format_exact(component, dimension) for component in vector]


def _points(points: Mapping[str, Vector]) -> dict[str, Any]:
    return {name: written(point) for name, point in points.items()}


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
        **_quantities(slider, {"angle": "angle"}),
    }


def _gear(gear: Gear) -> dict[str, Any]:
    if gear.teeth is None:
        sizes: dict[str, Any] = {"ratio": gear.ratio}
    else:
        sizes = {"teeth": list(gear.teeth), "mesh": gear.mesh}
    return {
        "between": [gear.driver, gear.driven],
        **sizes,
        **_unless(gear.carrier == FRAME, carrier=gear.carrier),
        **_quantities(gear, {"start": "angle"}),
        **_unless(
            gear.pressure_angle == _PRESSURE_ANGLE,
            pressure_angle=format_exact(gear.pressure_angle, "angle"),
        ),
    }


def _load(load: Load, table: str | None) -> dict[str, Any]:
    given: dict[str, Any] = {"link": load.link}
    if load.point is not None:
        given["point"] = load.point
    if load.force is not None:
        given["force"] = _pair(load.force, "force")
    if load.torque is not None:
        given["torque"] = format_exact(load.torque, "torque")
    if load.table is not None:
        given["table"] = table
    if load.start is not None and load.stop is not None:
        given["from"] = format_exact(load.start, "angle")
        given["to"] = format_exact(load.stop, "angle")
    return given


def _position(position: Position) -> dict[str, Any]:
    angles = {name: format_exact(angle, "angle") for name, angle in position.angles.items()}
    return {
        **_quantities(position, {"crank_angle": "angle"}),
        **_unless(not position.points, points=_points(position.points)),
        **_unless(not angles, angles=angles),
    }


def _planting(planting: Planting, tables: Mapping[str, str]) -> dict[str, Any]:
    given = {key: getattr(planting, key) for key in PLANTING}
    table: dict[str, Any] = {"tip": planting.tip}
    table |= {
        key: format_exact(value, PLANTING[key]) for key, value in given.items() if value is not None
    }
    table |= _unless(planting.units_per_turn == 1, units_per_turn=planting.units_per_turn)
    table |= _unless(planting.travel == "forward", travel=planting.travel)
    table |= _unless(planting.finger_from is None, finger_from=planting.finger_from)
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
    return {**_quantities(soil, dimensions), **_unless(table is None, table=table)}
