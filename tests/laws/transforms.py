"""Other ways to describe a machine: moved, turned, mirrored, in other units, in another order."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from math import pi
from typing import Any, TypeVar

import numpy as np
import pint

import equipoise as eq
from equipoise.keys import Frozen, KeyTable, Kind, Point, innermost
from equipoise.keys.declaring import declarations
from equipoise.mechanism.parts.balance import Limit, quantity_of
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.field import Planting
from equipoise.mechanism.parts.links import Slider
from equipoise.mechanism.parts.machine import FRAME, FurtherDrive, Vector
from equipoise.mechanism.parts.racks import Rack
from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from equipoise.quantities import SI

Value = TypeVar("Value")
Driven = TypeVar("Driven", eq.Drive, FurtherDrive)
Map = Callable[[complex], complex]


def mapped(points: Mapping[str, Vector], change: Map) -> dict[str, Vector]:
    return {name: vector(change, place) for name, place in points.items()}


def vector(change: Map, place: Vector) -> Vector:
    moved = change(complex(*place))
    return moved.real, moved.imag


def shifted(machine: eq.Machine, shift: complex) -> eq.Machine:
    """Move the frame's points, and the rough position, the soil and the tray with them."""
    position, planting = machine.position, machine.planting
    if position is not None:
        position = replace(position, points=mapped(position.points, lambda z: z + shift))
    if planting is not None:
        level = planting.surface
        planting = replace(
            planting,
            surface=None if level is None else level + shift.imag,
            tray=tray(planting, lambda z: z + shift),
        )
    frame = mapped(machine.frame, lambda z: z + shift)
    return replace(machine, frame=frame, position=position, planting=planting)


def tray(planting: Planting, change: Map) -> tuple[Vector, Vector] | None:
    if planting.tray is None:
        return None
    first, other = planting.tray
    return vector(change, first), vector(change, other)


def turned(machine: eq.Machine, angle: float) -> eq.Machine:
    """Turn the frame and everything given in its axes; crank angles grow by the same angle.

    What is told of planting goes: the soil stays level and is driven over along x.
    """
    turn = complex(np.exp(1j * angle))
    # the start angle of a gear holds at crank angle 0, which is another position now
    start = eq.move(machine, np.array([-angle]))
    return replace(
        machine,
        drive=later_drive(machine.drive, angle, start),
        drives=tuple(later_drive(drive, angle, start) for drive in machine.drives),
        frame=mapped(machine.frame, lambda z: z * turn),
        gravity=vector(lambda z: z * turn, machine.gravity),
        sliders=tuple(
            replace(s, direction=s.direction + angle) if s.on == FRAME else s
            for s in machine.sliders
        ),
        gears=tuple(
            put_off(
                replace(g, start=float(start.links[g.driven].angle[0]) + angle),
                angle * ((g.carrier == FRAME) - (g.driver == FRAME)),
            )
            for g in machine.gears
        ),
        belts=tuple(
            replace(b, start=float(start.links[b.driven].angle[0]) + angle) for b in machine.belts
        ),
        racks=tuple(restarted(start, rack, angle) for rack in machine.racks),
        cams=tuple(
            later(cam, angle * ((cam.carrier == FRAME) - (cam.driver == FRAME)))
            for cam in machine.cams
        ),
        loads=tuple(turned_load(load, angle) for load in machine.loads),
        circular_slots=tuple(
            turned_slot(slot, angle) if slot.on == FRAME else slot
            for slot in machine.circular_slots
        ),
        curved_slots=tuple(
            replace(slot, direction=slot.direction + angle) if slot.on == FRAME else slot
            for slot in machine.curved_slots
        ),
        torsion_springs=tuple(
            turned_torsion(spring, angle) if spring.on == FRAME else spring
            for spring in machine.torsion_springs
        ),
        position=None if machine.position is None else turned_position(machine.position, angle),
        planting=None,
    )


def later_drive(drive: Driven, angle: float, start: Any) -> Driven:
    """Turn a drive as the frame, at crank angles that grow by the same angle.

    start : the motion at the crank angle that is 0 then.
    """
    result = swung(drive, lambda value: value + angle, lambda phase: phase + angle)
    if result.pushes:
        return replace(result, start=float(start.links[drive.link].angle[0]) + angle)
    if isinstance(result, FurtherDrive) and result.motion is None:
        return replace(result, start=result.start + angle * (1 - result.ratio))
    return result


def put_off(gear: eq.Gear, later: float) -> eq.Gear:
    """A pair whose driver, seen from the carrier, comes to the same pitch points so much later."""
    shape = gear.shape
    return gear if shape is None else replace(gear, shape=replace(shape, phase=shape.phase + later))


def swung(
    drive: Driven, change: Callable[[float], float], later: Callable[[float], float]
) -> Driven:
    """Change the angles between which a drive swings, and when it begins to swing or to push; all
    runs backwards where `later` does.
    """
    return replace(
        drive,
        motion=None if drive.motion is None else put_law(drive.motion, change, later),
        stroke=None if drive.stroke is None else put_law(drive.stroke, float, later),
    )


def put_law(law: Any, change: Callable[[float], float], later: Callable[[float], float]) -> Any:
    if law.between is not None:
        low, high = map(change, law.between)
        return replace(law, between=(low, high), phase=later(law.phase))
    values = [change(item) for item in (law.start, *(part.to for part in law.segments))]
    parts = list(law.segments)
    if later(1.0) < later(0.0):
        values, parts = values[::-1], parts[::-1]  # each law is its own image in its middle
    ways = tuple(replace(part, to=to) for part, to in zip(parts, values[1:], strict=True))
    return replace(law, start=values[0], segments=ways, phase=later(law.phase))


def turned_position(position: eq.mechanism.Position, angle: float) -> eq.mechanism.Position:
    turn = complex(np.exp(1j * angle))
    return eq.mechanism.Position(
        position.crank_angle + angle,
        mapped(position.points, lambda z: z * turn),
        {link: value + angle for link, value in position.angles.items()},
    )


def turned_load(load: eq.Load, angle: float) -> eq.Load:
    turn = complex(np.exp(1j * angle))
    if load.axes is not None:
        turn = 1.0 + 0j
    force = None if load.force is None else vector(lambda z: z * turn, load.force)
    return replace(
        load,
        force=force,
        start=None if load.start is None else load.start + angle,
        stop=None if load.stop is None else load.stop + angle,
        table=None if load.table is None else table(load.table, lambda z: z * turn, angle),
    )


def in_other_axes(load: eq.Load, change: Map) -> eq.Load:
    """A load whose link gets other axes; change : of a direction in these."""
    given = load.table
    return replace(
        load,
        force=None if load.force is None else vector(change, load.force),
        table=None if given is None else table(given, change),
    )


def table(given: eq.mechanism.LoadTable, change: Map, later: float = 0.0) -> eq.mechanism.LoadTable:
    """Change a table of forces; one of torques is only put off."""
    angles = tuple(a + later for a in given.crank_angle)
    if len(given.values) == 1:
        return replace(given, crank_angle=angles)
    forces = [change(complex(x, y)) for x, y in zip(*given.values, strict=True)]
    values = tuple(z.real for z in forces), tuple(z.imag for z in forces)
    return replace(given, crank_angle=angles, values=values)


def mirrored(machine: eq.Machine) -> eq.Machine:
    """The image in the y axis, soil below; a crank angle and its image make half a turn."""
    image = turned(mirrored_in_x(replace(machine, planting=None)), pi)
    return replace(image, planting=mirrored_planting(machine.planting))


def mirrored_planting(planting: Planting | None) -> Planting | None:
    if planting is None:
        return None
    return replace(
        planting,
        travel={"forward": "backward", "backward": "forward"}[planting.travel],
        release=None if planting.release is None else pi - planting.release,
        arms=tuple(
            replace(arm, release=None if arm.release is None else pi - arm.release)
            for arm in planting.arms
        ),
        tray=tray(planting, lambda z: -z.conjugate()),
    )


def restarted(start: Any, rack: Rack, angle: float) -> Rack:
    """A rack as it stands at the start of a motion, in a frame that is turned."""
    if rack.drives == "rack":
        return replace(rack, angle=float(start.links[rack.pinion].angle[0]) + angle)
    travel = start.sliders[f"{rack.rack} on {rack.carrier}"].travel
    return replace(rack, travel=float(travel[0]))


def mirrored_in_x(machine: eq.Machine) -> eq.Machine:
    """The image in the x axis; crank angles change their sign."""
    flip = {"left": "right", "right": "left"}
    position = machine.position
    if position is not None:
        position = eq.mechanism.Position(
            -position.crank_angle,
            mapped(position.points, np.conj),
            {link: -value for link, value in position.angles.items()},
        )
    drive, *drives = (mirrored_drive(item) for item in machine.driven)
    assert isinstance(drive, eq.Drive)
    return replace(
        machine,
        drive=replace(drive, speed=-drive.speed, acceleration=-drive.acceleration),
        drives=tuple(drives),
        frame=mapped(machine.frame, np.conj),
        links={name: mirrored_link(link) for name, link in machine.links.items()},
        assembly={joint: flip.get(side, side) for joint, side in machine.assembly.items()},
        sliders=tuple(
            replace(s, direction=-s.direction, angle=-s.angle) for s in machine.sliders
        ),
        gears=tuple(mirrored_gear(gear) for gear in machine.gears),
        belts=tuple(replace(b, start=-b.start) for b in machine.belts),
        racks=tuple(replace(r, angle=-r.angle, side=flip[r.side]) for r in machine.racks),
        cams=tuple(mirrored_cam(cam) for cam in machine.cams),
        loads=tuple(mirrored_load(load) for load in machine.loads),
        circular_slots=tuple(
            replace(slot, arc=tuple(-end for end in slot.arc[::-1]))
            for slot in machine.circular_slots
        ),
        curved_slots=tuple(mirrored_curve(slot) for slot in machine.curved_slots),
        torsion_springs=tuple(mirrored_torsion(spring) for spring in machine.torsion_springs),
        gravity=vector(np.conj, machine.gravity),
        position=position,
    )  # fmt: skip


def mirrored_drive(drive: Driven) -> Driven:
    start = None if drive.start is None else -drive.start
    return replace(swung(drive, operator.neg, operator.neg), start=start)


def mirrored_gear(gear: eq.Gear) -> eq.Gear:
    shape = gear.shape
    if shape is not None:
        values = {key: getattr(shape, key)[::-1] for key in ("ratio", "radius")}
        sines, angles = tuple(-b for b in shape.sines), tuple(-a for a in shape.angle[::-1])
        shape = replace(shape, phase=-shape.phase, sines=sines, angle=angles, **values)
    return replace(gear, start=-gear.start, shape=shape)


def mirrored_link(link: eq.Link) -> eq.Link:
    center = link.center_of_mass
    return replace(
        link,
        points=mapped(link.points, np.conj),
        center_of_mass=None if center is None else vector(np.conj, center),
    )


def later(cam: Cam, angle: float) -> Cam:
    """Let a cam's law begin at an angle that is larger by so much."""
    return with_law(cam, replace(cam.law, phase=cam.law.phase + angle))


def with_law(cam: Cam, law: Any) -> Cam:
    return replace(cam, **{"lift" if cam.swing is None else "swing": law})


def mirrored_cam(cam: Cam) -> Cam:
    """The image of a cam, which turns the other way; the laws of segments are symmetric."""
    law = cam.law
    ends = [law.start, *(segment.to for segment in law.segments)]
    back = [replace(s, to=a) for s, a in zip(law.segments, ends[:-1], strict=True)][::-1]
    changed = replace(
        law,
        phase=-law.phase,
        segments=tuple(back),
        crank_angles=tuple(-angle for angle in law.crank_angles[::-1]),
        values=law.values[::-1],
    )
    normal = None if cam.normal is None else -cam.normal
    side = {"left": "right", "right": "left"}[cam.side]
    return with_law(replace(cam, normal=normal, side=side), changed)


def mirrored_load(load: eq.Load) -> eq.Load:
    given = load.table
    if given is not None:
        angles = tuple(-a for a in given.crank_angle[::-1])
        signs = (1, -1) if len(given.values) == 2 else (-1,)
        columns = zip(signs, given.values, strict=True)
        values = tuple(tuple(sign * v for v in column[::-1]) for sign, column in columns)
        given = replace(given, crank_angle=angles, values=values)
    return replace(
        load,
        force=None if load.force is None else vector(np.conj, load.force),
        torque=None if load.torque is None else -load.torque,
        start=None if load.stop is None else -load.stop,
        stop=None if load.start is None else -load.start,
        table=given,
    )


def turned_slot(slot: CircularSlot, angle: float) -> CircularSlot:
    return replace(slot, arc=tuple(end + angle for end in slot.arc))


def mirrored_curve(slot: CurvedSlot) -> CurvedSlot:
    points = tuple((x, -y) for x, y in slot.points_given)
    table = slot.table and replace(slot.table, y=tuple(-y for y in slot.table.y))
    return replace(slot, direction=-slot.direction, points_given=points, table=table)


def turned_torsion(spring: TorsionSpring, angle: float) -> TorsionSpring:
    """A spring on a frame that is turned, or whose link is."""
    rows, given = tuple(item + angle for item in spring.angles), spring.table
    if given is not None:
        given = replace(given, angle=tuple(item + angle for item in given.angle))
    own = spring.angle + angle if spring.stiffness is not None else 0.0
    return replace(spring, angle=own, angles=rows, table=given)


def mirrored_torsion(spring: TorsionSpring) -> TorsionSpring:
    def back(values: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(-value for value in values[::-1])

    given = spring.table
    if given is not None:
        given = replace(given, angle=back(given.angle), torque=back(given.torque))
    own = {"angle": -spring.angle, "preload": -spring.preload, "table": given}
    return replace(spring, angles=back(spring.angles), torques=back(spring.torques), **own)


@dataclass(frozen=True)
class Units:
    """How many of the new units make one of the old, of length, mass and time."""

    length: float
    mass: float
    time: float

    @property
    def force(self) -> float:
        return self.of("N")

    @property
    def moment(self) -> float:
        return self.of("N m")

    def of(self, unit: str) -> float:
        """How many of the new units, with amperes, make one of these, as pint takes it apart."""
        powers = _powers(unit)
        sizes = {
            "[length]": self.length,
            "[mass]": self.mass,
            "[time]": self.time,
            "[current]": 1.0,
        }
        return float(np.prod([sizes[name] ** power for name, power in powers.items()]))


@cache
def _powers(unit: str) -> Mapping[str, float]:
    written = unit.replace(" ", "*").replace("turn", "radian")
    dimensionality = pint.application_registry.Quantity(1, written).dimensionality
    return {name: float(power) for name, power in dimensionality.items()}


COLUMNS = {
    "SoilTable": {"depth": "m", "resistance": "N"},
    "MotorTable": {"speed": "rad/s", "torque": "N m"},
    "TorsionTable": {"angle": "rad", "torque": "N m"},
}
"""SI units of numbers in tables that stand in files of their own."""


def in_units(thing: Any, units: Units, machine: eq.Machine | None = None) -> Any:
    """A machine, or what belongs to one, with every declared quantity in other units."""
    machine = thing if isinstance(thing, eq.Machine) else machine
    kinds = {
        declaration.field: innermost(declaration.kind) for declaration in declarations(type(thing))
    }
    given = {name: getattr(thing, name) for name in kinds}
    factors = {name: units.of(unit) for name, unit in COLUMNS.get(type(thing).__name__, {}).items()}
    if isinstance(thing, eq.mechanism.LoadTable):
        factors["values"] = units.force if len(thing.values) == 2 else units.moment
    if isinstance(thing, Limit) and thing.at_most is not None:
        assert machine is not None
        factor = units.of(SI[quantity_of(thing.objective, machine) or "energy"])
        return replace(thing, **{key: grown(value, factor) for key, value in thing.asks})
    changes = {
        name: grown(value, factors[name])
        if name in factors
        else _in_units(value, kinds[name], units, machine)
        for name, value in given.items()
    }
    return replace(thing, **changes)


def _in_units(value: Any, kind: Kind, units: Units, machine: eq.Machine | None) -> Any:
    if isinstance(value, Frozen):
        return in_units(value, units, machine)
    if isinstance(kind, KeyTable):  # with one key, which the object has without it
        kind = innermost(declarations(kind.type)[0].kind)
    if isinstance(value, Mapping):
        return {name: _in_units(item, kind, units, machine) for name, item in value.items()}
    if isinstance(value, tuple):
        return tuple(_in_units(item, kind, units, machine) for item in value)
    dimension = "length" if isinstance(kind, Point) else getattr(kind, "dimension", None)
    unit = None if isinstance(value, str) or dimension is None else SI[dimension]
    return value if unit is None else grown(value, units.of(unit))


def grown(value: Any, factor: float) -> Any:
    """Numbers, wherever they stand, so many times as large."""
    if isinstance(value, Mapping):
        return {name: grown(item, factor) for name, item in value.items()}
    if isinstance(value, tuple):
        return tuple(grown(item, factor) for item in value)
    return None if value is None else factor * value


def rescaled(thing: Any, factors: Mapping[str, float]) -> Any:
    """With all that bears these names so many times as large, wherever it stands."""

    if isinstance(thing, Mapping):
        return {name: rescaled(item, factors) for name, item in thing.items()}
    if isinstance(thing, tuple):
        return tuple(rescaled(item, factors) for item in thing)
    if not is_dataclass(thing):
        return thing
    values = {field.name: getattr(thing, field.name) for field in fields(thing) if field.init}
    changes = {
        name: grown(value, factors[name]) if name in factors else rescaled(value, factors)
        for name, value in values.items()
    }
    return replace(thing, **changes)  # type: ignore[type-var]


def with_axes(machine: eq.Machine, link: str, angle: float, shift: complex) -> eq.Machine:
    """Give one link other axes: turned by an angle, and with another origin."""

    def change(z: complex) -> complex:
        return complex((z - shift) * np.exp(-1j * angle))

    body = machine.links[link]
    center = body.center_of_mass
    new = replace(
        body,
        points=mapped(body.points, change),
        center_of_mass=None if center is None else vector(change, center),
    )
    position = machine.position
    if position is not None and link in position.angles:
        angles = {**position.angles, link: position.angles[link] + angle}
        position = replace(position, angles=angles)
    return replace(
        machine,
        links={**machine.links, link: new},
        loads=tuple(
            in_other_axes(load, lambda z: z * complex(np.exp(-1j * angle)))
            if load.link == link and load.axes == "link"
            else load
            for load in machine.loads
        ),
        sliders=tuple(
            replace(
                s,
                direction=s.direction - angle * (s.on == link),
                angle=s.angle + angle * (s.link == link),
            )
            for s in machine.sliders
        ),
        gears=tuple(
            put_off(
                replace(g, start=g.start + angle * (g.driven == link)),
                angle * (int(g.driver == link) - (g.carrier == link)),
            )
            for g in machine.gears
        ),
        belts=tuple(replace(b, start=b.start + angle * (b.driven == link)) for b in machine.belts),
        racks=tuple(
            replace(r, angle=r.angle + angle * (r.drives == "rack" and r.pinion == link))
            for r in machine.racks
        ),
        cams=tuple(
            later(
                cam
                if cam.normal is None or cam.driven != link
                else replace(cam, normal=cam.normal - angle),
                angle * ((cam.driver == link) - (cam.carrier == link)),
            )
            for cam in machine.cams
        ),
        circular_slots=tuple(
            turned_slot(slot, -angle) if slot.on == link else slot
            for slot in machine.circular_slots
        ),
        curved_slots=tuple(
            replace(slot, direction=slot.direction - angle) if slot.on == link else slot
            for slot in machine.curved_slots
        ),
        torsion_springs=tuple(
            turned_torsion(s, angle * (int(s.link == link) - (s.on == link)))
            for s in machine.torsion_springs
        ),
        position=position,
    )


def renamed(machine: eq.Machine, names: Callable[[str], str]) -> eq.Machine:
    """Give every link and point another name."""

    def body(name: str) -> str:
        return name if name == FRAME else names(name)

    def keys(given: Mapping[str, Value]) -> dict[str, Value]:
        return {names(key): value for key, value in given.items()}

    def slid(slider: Slider) -> Slider:
        return replace(slider, link=body(slider.link), point=names(slider.point),
                       on=body(slider.on), through=names(slider.through))  # fmt: skip

    own = {slider.name: slid(slider).name for slider in machine.sliders}

    def joint(name: str) -> str:
        """A slider by its bodies, a link's share of a pin by both, others as they are called."""
        point, slash, link = name.partition("/")
        return own.get(name) or names(point) + (slash and f"/{body(link)}")

    def driven(drive: Driven) -> Driven:
        between = drive.between and (names(drive.between[0]), names(drive.between[1]))
        return replace(drive, link=body(drive.link), between=between)

    position, planting = machine.position, machine.planting
    if position is not None:
        position = replace(position, points=keys(position.points), angles=keys(position.angles))
    if planting is not None:
        first, *arms = (
            replace(arm, tip=names(arm.tip), finger_from=arm.finger_from and names(arm.finger_from))
            for arm in planting.every_arm
        )
        changes = {"tip": first.tip, "finger_from": first.finger_from, "arms": tuple(arms)}
        planting = replace(planting, **changes)
    return replace(
        machine,
        drive=driven(machine.drive),
        drives=tuple(map(driven, machine.drives)),
        frame=keys(machine.frame),
        links={
            names(name): replace(link, points=keys(link.points), planes=keys(link.planes))
            for name, link in machine.links.items()
        },
        bearings={
            name: replace(item, link=body(item.link)) for name, item in machine.bearings.items()
        },
        assembly={joint(name): side for name, side in machine.assembly.items()},
        sliders=tuple(map(slid, machine.sliders)),
        gears=tuple(
            replace(g, driver=body(g.driver), driven=body(g.driven), carrier=body(g.carrier))
            for g in machine.gears
        ),
        belts=tuple(
            replace(b, driver=body(b.driver), driven=body(b.driven), carrier=body(b.carrier))
            for b in machine.belts
        ),
        racks=tuple(
            replace(r, pinion=body(r.pinion), rack=body(r.rack), carrier=body(r.carrier))
            for r in machine.racks
        ),
        cams=tuple(
            replace(cam, driver=body(cam.driver), driven=body(cam.driven),
                    carrier=body(cam.carrier), point=names(cam.point))
            for cam in machine.cams
        ),
        loads=tuple(
            replace(load, link=body(load.link),
                    point=None if load.point is None else names(load.point),
                    reaction=None if load.reaction is None else body(load.reaction))
            for load in machine.loads
        ),
        circular_slots=tuple(
            replace(slot, link=names(slot.link), point=names(slot.point), on=body(slot.on),
                    center=names(slot.center), own_name=names(slot.name))
            for slot in machine.circular_slots
        ),
        curved_slots=tuple(
            replace(slot, link=names(slot.link), point=names(slot.point), on=body(slot.on),
                    origin=names(slot.origin), own_name=names(slot.name))
            for slot in machine.curved_slots
        ),
        joints=tuple(
            replace(item, joint=f"joints.{joint(item.joint.removeprefix('joints.'))}")
            for item in machine.joints
        ),
        torsion_springs=tuple(
            replace(spring, link=names(spring.link), on=body(spring.on))
            for spring in machine.torsion_springs
        ),
        springs=tuple(
            replace(spring, link=body(spring.link), point=names(spring.point),
                    to=names(spring.to), on=body(spring.on))
            for spring in machine.springs
        ),
        position=position,
        planting=planting,
    )  # fmt: skip


def reordered(machine: eq.Machine) -> eq.Machine:
    """Write links, points, sliders, gears, loads and springs in the opposite order.

    "left" and "right" are told from the dyad's earlier link to the later one, so they change too;
    but where a slot is one of both, which always is the later.
    """
    slots = {slot.name: {} for slot in machine.circular_slots}
    flip = {"left": "right", "right": "left"}
    return replace(
        machine,
        frame=dict(reversed(machine.frame.items())),
        links={
            name: replace(link, points=dict(reversed(link.points.items())))
            for name, link in reversed(machine.links.items())
        },
        assembly={
            joint: slots.get(joint, flip).get(side, side)
            for joint, side in machine.assembly.items()
        },
        sliders=machine.sliders[::-1],
        gears=machine.gears[::-1],
        belts=machine.belts[::-1],
        racks=machine.racks[::-1],
        loads=machine.loads[::-1],
        springs=machine.springs[::-1],
    )


def swapped_sliders(machine: eq.Machine) -> eq.Machine:
    """Describe each slider between two links from its other link."""
    return replace(
        machine,
        sliders=tuple(
            s if s.on == FRAME or s.link in {rack.rack for rack in machine.racks} else
            eq.Slider(s.on, s.through, s.link, s.point, -s.angle, -s.direction)
            for s in machine.sliders
        ),
    )  # fmt: skip
