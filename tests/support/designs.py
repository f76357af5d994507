"""Designs of a machine, each built as a machine of its own: the second route to batches of them.

Nothing here knows of columns or loops: every number has a setter on plain nested values, from which
a new `Machine` is made, checks and all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np

import equipoise as eq
from equipoise.errors import ChangePointError, ModelError, MotionError, RangeError
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.machine import Machine

Array = np.ndarray[Any, Any]
Plain = dict[str, Any]
Draw = Callable[[np.random.Generator], float]


@dataclass(frozen=True)
class Number:
    """A number of a machine: its path in the model file, its value, and how to draw another.

    put : writes a value into the plain values of a machine.
    """

    path: str
    value: float
    put: Callable[[Plain, float], None]
    draw: Draw


def plain_of(machine: Machine) -> Plain:
    """What varies of a machine, as lists and dicts."""
    return {
        "frame": {name: list(place) for name, place in machine.frame.items()},
        "links": {
            name: {
                "points": {point: list(place) for point, place in link.points.items()},
                "mass": link.mass,
                "center": None if link.center_of_mass is None else list(link.center_of_mass),
                "inertia": link.inertia,
                "plane": link.plane,
                "planes": dict(link.planes),
            }
            for name, link in machine.links.items()
        },
        "drive": {"speed": machine.drive.speed, "acceleration": machine.drive.acceleration},
        "gravity": list(machine.gravity),
        "sliders": [{"direction": s.direction, "angle": s.angle} for s in machine.sliders],
        "gears": [{"start": g.start, "pressure_angle": g.pressure_angle} for g in machine.gears],
        "shapes": [_shaped(g.shape) for g in machine.gears],
        "belts": [{"start": b.start, "tension": b.tension} for b in machine.belts],
        "racks": [
            {"angle": r.angle, "travel": r.travel, "pressure_angle": r.pressure_angle}
            for r in machine.racks
        ],
        "cams": [
            {"base_radius": c.base_radius, "roller_radius": c.roller_radius, "normal": c.normal}
            for c in machine.cams
        ],
        "circular_slots": [{"radius": slot.radius} for slot in machine.circular_slots],
        "curved_slots": [{"direction": slot.direction} for slot in machine.curved_slots],
        "torsion_springs": [
            {key: getattr(s, key) for key in ("stiffness", "angle", "preload")}
            for s in machine.torsion_springs
        ],
        "springs": [
            {"stiffness": s.stiffness, "free_length": s.free_length} for s in machine.springs
        ],
        "bearings": {name: {"plane": item.plane} for name, item in machine.bearings.items()},
        "polar": {},
    }


def machine_of(base: Machine, plain: Plain) -> Machine:
    """The machine that these values make; raises a `ModelError` where there is none."""
    links = {}
    for name, link in plain["links"].items():
        center = None if link["center"] is None else tuple(link["center"])
        points = {point: tuple(place) for point, place in link["points"].items()}
        links[name] = eq.Link(
            points,
            link["mass"],
            center,
            link["inertia"],
            **{k: link[k] for k in ("plane", "planes")},
        )
    listed = {
        key: tuple(
            replace(value, **changes)
            for value, changes in zip(getattr(base, key), plain[key], strict=True)
        )
        for key in (
            "sliders",
            "gears",
            "belts",
            "racks",
            "cams",
            "springs",
            "torsion_springs",
            "circular_slots",
            "curved_slots",
        )
    }
    listed["gears"] = tuple(
        replace(gear, shape=shaped and replace(gear.shape, **shaped))
        for gear, shaped in zip(listed["gears"], plain["shapes"], strict=True)
    )
    return Machine(
        title=base.title,
        drive=replace(base.drive, **plain["drive"]),
        drives=base.drives,
        frame={name: tuple(place) for name, place in plain["frame"].items()},
        links=links,
        assembly=dict(base.assembly),
        position=base.position,
        loads=base.loads,
        bearings={
            name: replace(item, **plain["bearings"][name]) for name, item in base.bearings.items()
        },
        gravity=tuple(plain["gravity"]),
        **listed,
    )


def _shaped(shape: GearShape | None) -> Plain | None:
    """Numbers of a shape of gears whose laws are formulas of them."""
    if shape is None:
        return None
    content: Plain = {"phase": shape.phase}
    if shape.kind in ("elliptic", "limacon"):
        content["eccentricity"] = shape.eccentricity
    if shape.kind == "ratio":
        content |= {"cosines": [*shape.cosines], "sines": [*shape.sines]}
    return content


def design(base: Machine, numbers: Sequence[Number], values: Sequence[float]) -> Machine:
    """The machine with these numbers in place; raises a `ModelError` where there is none."""
    plain = plain_of(base)
    for number, value in zip(numbers, values, strict=True):
        number.put(plain, float(value))
    return machine_of(base, plain)


def reason_of(base: Machine, numbers: Sequence[Number], values: Sequence[float]) -> int:
    """Why a design cannot be moved through its cycle, as a number of `codegen.figures`."""
    try:
        assemble(design(base, numbers, values)).cycle  # noqa: B018
    except ModelError:
        return 4
    except ChangePointError:
        return 3
    except RangeError as error:
        return 2 if error.ranges else 1
    except MotionError:
        return 6
    return 0


# -- the numbers of a machine ----------------------------------------------------------------------


def numbers_of(machine: Machine, share: float = 0.01, polar: bool = False) -> list[Number]:
    """Every number that may vary.

    share : of the size of the machine, by which points are moved.
    polar : whether points are told by distance and direction.
    """
    return [
        *_places(machine, share, polar),
        *_of_links(machine),
        *(_across(machine) if machine.has_planes else ()),
        *_of_drive(machine),
        *_listed(machine),
        *_of_gears(machine),
    ]


def named(machine: Machine, *paths: str) -> list[Number]:
    """Numbers of a machine by their paths."""
    both = [*numbers_of(machine), *numbers_of(machine, polar=True)]
    known = {number.path: number for number in both}
    return [known[path] for path in paths]


def geometry_of(machine: Machine, share: float) -> list[Number]:
    """The numbers that decide how a machine moves."""
    return [
        number
        for number in numbers_of(machine, share)
        if ".points." in number.path or number.path.endswith("direction")
    ]


def paths_of(numbers: Sequence[Number]) -> list[str]:
    return [number.path for number in numbers]


def size_of(machine: Machine) -> float:
    """Diagonal of the largest body, m; 1 where all are points."""
    bodies = [machine.frame, *(link.points for link in machine.links.values())]
    spans = [np.ptp(np.array(list(points.values())), axis=0) for points in bodies]
    return float(np.max(np.linalg.norm(spans, axis=1))) or 1.0


def drawn(numbers: Sequence[Number], count: int, seed: int) -> Array:
    """Values (P, d) of designs about the base."""
    rng = np.random.default_rng(seed)
    return np.array([[number.draw(rng) for number in numbers] for _ in range(count)])


def _places(machine: Machine, share: float, polar: bool) -> Iterator[Number]:
    reach = share * size_of(machine)
    pairs: list[tuple[str, tuple[str, ...], float]] = [
        (str(KeyPath(("frame", "points", name))), ("frame", name), reach) for name in machine.frame
    ]
    for link, body in machine.links.items():
        pairs += [
            (
                str(KeyPath(("links", link, "points", name))),
                ("links", link, "points", name),
                reach,
            )
            for name in body.points
        ]
        if body.center_of_mass is not None:
            path = str(KeyPath(("links", link, "center_of_mass")))
            pairs.append((path, ("links", link, "center"), 30 * reach))
    pairs.append(("gravity", ("gravity",), hypot(*machine.gravity) or 1.0))
    for path, keys, spread in pairs:
        place = _at(plain_of(machine), keys)
        yield from (_by_polar if polar else _by_coordinates)(path, keys, place, spread)


def _by_coordinates(
    path: str, keys: tuple[str, ...], place: Sequence[float], spread: float
) -> Iterator[Number]:
    for k, part in enumerate("xy"):
        yield Number(f"{path}.{part}", place[k], _putter(*keys, k), _near(place[k], spread))


def _by_polar(
    path: str, keys: tuple[str, ...], place: Sequence[float], spread: float
) -> Iterator[Number]:
    own = {"distance": hypot(*place), "direction": atan2(place[1], place[0])}
    near = _near(own["distance"], spread)
    draws: dict[str, Draw] = {
        "distance": lambda rng: abs(near(rng)),
        "direction": _near(own["direction"], min(1.0, spread / (own["distance"] or 1.0))),
    }

    def putter(part: str) -> Callable[[Plain, float], None]:
        def put(plain: Plain, value: float) -> None:
            now = plain["polar"].setdefault(keys, dict(own))
            now[part] = value
            at = now["distance"] * cos(now["direction"]), now["distance"] * sin(now["direction"])
            _at(plain, keys)[:] = at

        return put

    for part, value in own.items():
        yield Number(f"{path}.{part}", value, putter(part), draws[part])


def _of_links(machine: Machine) -> Iterator[Number]:
    for name, link in machine.links.items():
        for key in ("mass", "inertia"):
            value = getattr(link, key)
            if value is not None:
                put = _putter("links", name, key)
                yield Number(str(KeyPath(("links", name, key))), value, put, _times(value))


def _across(machine: Machine) -> Iterator[Number]:
    spread = size_of(machine)
    for name, link in machine.links.items():
        ways = {("plane",): link.plane, **{("planes", k): z for k, z in link.planes.items()}}
        for keys, z in ways.items():
            path = str(KeyPath(("links", name, *keys)))
            yield Number(path, z, _putter("links", name, *keys), _near(z, spread))
    for name, item in machine.bearings.items():
        put = _putter("bearings", name, "plane")
        yield Number(
            str(KeyPath(("bearings", name, "plane"))),
            item.plane,
            put,
            _near(item.plane, spread / 5),
        )


def _of_drive(machine: Machine) -> Iterator[Number]:
    speed, acceleration = machine.drive.speed, machine.drive.acceleration
    scaled = _times(speed or 10.0)

    def either_way(rng: np.random.Generator) -> float:
        return scaled(rng) * float(rng.choice([-1, 1]))

    yield Number("drive.speed", speed, _putter("drive", "speed"), either_way)
    draw = _near(acceleration, 0.3 * speed**2 or 10.0)
    yield Number("drive.acceleration", acceleration, _putter("drive", "acceleration"), draw)


def _listed(machine: Machine) -> Iterator[Number]:
    def number(name: str, k: int, key: str, draw: Draw) -> Number:
        value = getattr(getattr(machine, name)[k], key)
        return Number(f"{name}[{k + 1}].{key}", value, _putter(name, k, key), draw)

    for k, slider in enumerate(machine.sliders):
        yield number("sliders", k, "direction", _near(slider.direction, 0.02))
        yield number("sliders", k, "angle", _near(slider.angle, 2.0))
    for k, belt in enumerate(machine.belts):
        yield number("belts", k, "start", _near(belt.start, pi))
        if belt.tension is not None:
            yield number("belts", k, "tension", _times(belt.tension))
    for k, rack in enumerate(machine.racks):
        key = "travel" if rack.drives == "pinion" else "angle"
        yield number("racks", k, key, _near(getattr(rack, key), 0.3))
        yield number("racks", k, "pressure_angle", lambda rng: float(rng.uniform(0, 0.5)))
    for k, cam in enumerate(machine.cams):
        yield number("cams", k, "base_radius", _times(cam.base_radius))
        if cam.rides == "roller":
            yield number("cams", k, "roller_radius", _times(cam.roller_radius))
        if cam.normal is not None:
            yield number("cams", k, "normal", _near(cam.normal, 0.1))
    for k, spring in enumerate(machine.springs):
        yield number("springs", k, "stiffness", _times(spring.stiffness))
        yield number("springs", k, "free_length", _times(spring.free_length))
    for k, torsion in enumerate(machine.torsion_springs):
        if torsion.stiffness is not None:
            yield number("torsion_springs", k, "stiffness", _times(torsion.stiffness))
            yield number("torsion_springs", k, "angle", _near(torsion.angle, 0.1))


def _of_gears(machine: Machine) -> Iterator[Number]:
    for k, gear in enumerate(machine.gears):
        draws = {
            "start": _near(gear.start, pi),
            "pressure_angle": lambda rng: float(rng.uniform(0, 0.5)),
        }
        for key, draw in draws.items():
            yield Number(
                f"gears[{k + 1}].{key}", getattr(gear, key), _putter("gears", k, key), draw
            )
        for key, value in (_shaped(gear.shape) or {}).items():
            path = f"gears[{k + 1}].shape.{key}"
            if isinstance(value, list):
                for place, item in enumerate(value):
                    put = _putter("shapes", k, key, place)
                    yield Number(f"{path}[{place + 1}]", item, put, _near(item, abs(item) / 4))
            else:
                spread = pi if key == "phase" else value / 2
                yield Number(path, value, _putter("shapes", k, key), _near(value, spread))


def _at(plain: Plain, keys: Sequence[Any]) -> Any:
    for key in keys:
        plain = plain[key]
    return plain


def _putter(*keys: Any) -> Callable[[Plain, float], None]:
    def put(plain: Plain, value: float) -> None:
        _at(plain, keys[:-1])[keys[-1]] = value

    return put


def _near(value: float, spread: float) -> Draw:
    return lambda rng: value + spread * float(rng.uniform(-1, 1))


def _times(value: float) -> Draw:
    return lambda rng: value * float(rng.uniform(0.5, 2))
