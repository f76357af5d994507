"""Joint forces by brute strength: every link cut free, all equilibria solved at once.

The general form of the nine equations that Lee and Kim write for a four-bar.  With n links there
are 3 n equations (two forces and the moment about the centre of mass of each link).  A pin brings
two unknowns, a sliding joint a force across its line and a couple, a gear pair or a rack the
tangential force at the pitch point, a belt the difference of its strands' tensions, and the drive
its torque.  A linkage with one free motion and no redundant constraint has as many unknowns as
equations.  Where joints hold too much, the forces of least squares are those of the rule that the
package states: couples count as forces at the largest distance of two joints on one body.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, combinations

import numpy as np

from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive, Machine
from equipoise.mechanism.parts.racks import Rack
from support.cams import line_of_force
from support.loads import loads_by_end, on_links, springs_on_links
from support.newton import rack_guide
from support.poses import Array, Poses, cross, drive_pivot, pin_between, pins, quarter, turned
from support.rolling_reference import Rolling
from support.slots import normal_of


@dataclass(frozen=True)
class Contact:
    """Something that passes a load from body `by` to body `on`.

    at : where the force acts, (N, 2).  directions : of the unknown forces, each (N, 2).
    couple : whether a couple is unknown as well.
    """

    name: str
    on: str
    by: str
    at: Array
    directions: tuple[Array, ...] = ()
    couple: bool = False

    @property
    def size(self) -> int:
        return len(self.directions) + self.couple


@dataclass(frozen=True)
class Reaction:
    """Force (N, 2) and couple (N,) on body `on` by body `by`, acting at `at`."""

    on: str
    by: str
    at: Array
    force: Array
    couple: Array


@dataclass(frozen=True)
class FreeBodies:
    """Everything that the free bodies tell, one value a crank angle; `drive` is the torque of the
    drive, or its force.
    """

    joints: Mapping[str, Reaction]
    gears: Mapping[str, Reaction]
    cams: Mapping[str, Reaction]
    racks: Mapping[str, Reaction]
    strands: Mapping[str, tuple[Array, Array]]
    pulls: Mapping[str, Reaction]
    drives: Mapping[str, Array]
    frame_force: Array
    frame_moment: Array


Acting = tuple[str, Array, Array, Array | float]
"""A body, a place, a force and a torque."""


@dataclass
class System:
    """The linear equations of all links at all crank angles."""

    machine: Machine
    poses: Poses
    rows: dict[str, int]
    centers: dict[str, Array]
    known: Array
    columns: list[Array] = field(default_factory=list)

    def press(
        self, column: Array, body: str, at: Array, force: Array, couple: Array | float
    ) -> None:
        """Add a force and a couple on a body to a column of the equations; the frame has none."""
        if body == FRAME:
            return
        row = self.rows[body]
        column[:, row : row + 2] += force
        column[:, row + 2] += cross(at - self.centers[body], force) + couple

    def pair(self, contact: Contact, force: Array, couple: float) -> Array:
        """Return the column of an action on one body and its reaction on the other."""
        column = np.zeros_like(self.known)
        self.press(column, contact.on, contact.at, force, couple)
        self.press(column, contact.by, contact.at, -force, -couple)
        return column


def solve(
    machine: Machine,
    poses: Poses,
    pairs: Mapping[str, tuple[str, str]] | None = None,
    text: Mapping[str, Array] | None = None,
    acting: Sequence[Acting] = (),
) -> FreeBodies:
    """Solve the free bodies of a machine.

    Parameters
    ----------
    pairs : for points that join more than two bodies, "POINT/link" -> (acted on, acting), one
        pair fewer than bodies.  Without it the first body of all holds the others.
    told : forces on driven gears (N, 2) to be tried, where joints share them: their flanks are
        taken, and those that vanish are left out.  What is found has to push on the same flanks.
    acting : what acts on bodies beside: places (N, 2), forces (N, 2) and torques (N,).
    """
    joints = [*pin_contacts(machine, poses, pairs or {}), *slider_contacts(machine, poses)]
    slots = (*machine.circular_slots, *machine.curved_slots)
    joints += [slot_contact(slot, machine, poses) for slot in slots]
    joints += [cam_contact(cam, machine, poses) for cam in machine.cams]
    gears = [gear_contact(gear, machine, poses) for gear in machine.gears]
    racks = [rack_contact(rack, machine, poses) for rack in machine.racks]
    belts = [strand_contacts(belt, machine, poses) for belt in machine.belts]
    system = equations(machine, poses)
    for body, at, force, torque in acting:
        given = np.zeros_like(system.known)
        system.press(given, body, at, force, torque)
        system.known -= given
    passing = [*joints, *gears, *racks, *belts]
    unknowns = solved(system, passing)
    unknown = sum(1 if isinstance(item, tuple) else item.size for item in passing)
    if unknown + len(machine.driven) > system.known.shape[1]:  # least squares weigh whole pushes
        tried = (
            {
                gear.name: np.sum(text[gear.name] * item.directions[0], 1, keepdims=True)
                for gear, item in zip(machine.gears, gears, strict=True)
            }
            if text
            else unknowns
        )
        slanted = [leant(gear, item, machine, poses, tried)
                   for gear, item in zip(machine.gears, gears, strict=True)]  # fmt: skip
        unknowns = solved(system, [*joints, *slanted, *racks, *belts])
        sizes = [np.max(np.abs(unknowns[gear.name])) for gear in machine.gears]
        for gear in machine.gears:
            assert np.all(unknowns[gear.name] * np.sign(tried[gear.name]) >= -1e-9 * max(sizes))
        return gathered(machine, poses, joints, (gears, racks, belts), unknowns)
    for gear, contact in zip(machine.gears, gears, strict=True):
        tangential = unknowns[gear.name][:, 0]
        apart = separating(gear, machine, poses, tangential)
        system.known -= system.pair(contact, apart, 0.0)
    for rack, contact in zip(machine.racks, racks, strict=True):
        apart = off_the_rack(rack, machine, poses, unknowns[rack.name][:, 0])
        system.known -= system.pair(contact, apart, 0.0)
    for belt, (left, right) in zip(machine.belts, belts, strict=True):
        mean = sum(tensions(belt, unknowns[belt.name][:, 0])) / 2
        for strand in (left, right):
            system.known -= mean[:, None] * system.pair(strand, strand.directions[0], 0.0)
    unknowns = solved(system, passing)
    return gathered(machine, poses, joints, (gears, racks, belts), unknowns)


def leant(
    gear: Gear, contact: Contact, machine: Machine, poses: Poses, unknowns: Mapping[str, Array]
) -> Contact:
    """Return teeth whose push per unit of its tangential part has what separates them; nothing
    where they do not push.
    """
    push = unknowns[gear.name][:, 0]
    sense = np.where(np.abs(push) > 1e-12 * np.max(np.abs(push)), np.sign(push), 0.0)
    apart = separating(gear, machine, poses, sense) * sense[:, None]
    return replace(contact, directions=(abs(sense)[:, None] * contact.directions[0] + apart,))


def equations(machine: Machine, poses: Poses) -> System:
    """Set up the side that is known: what inertia asks for, less loads, springs and weight."""
    rows = {name: 3 * number for number, name in enumerate(machine.links)}
    centers = {}
    known = np.zeros((poses.crank_angle.size, 3 * len(rows)))
    for name, link in machine.links.items():
        local = link.center_of_mass or (0.0, 0.0)
        mass, inertia = link.mass or 0.0, link.inertia or 0.0
        centers[name] = poses.place(name, local)
        asked = mass * (poses.change(name, local) - np.array(machine.gravity))
        known[:, rows[name] : rows[name] + 2] = asked
        known[:, rows[name] + 2] = inertia * poses.alpha[name]
    system = System(machine, poses, rows, centers, known)
    for link_name, at, force, torque in chain(
        on_links(machine, poses), springs_on_links(machine, poses)
    ):
        given = np.zeros_like(known)
        system.press(given, link_name, at, force, torque)
        system.known -= given
    return system


Strands = tuple[Contact, Contact]


def solved(system: System, passing: list[Contact | Strands]) -> dict[str, Array]:
    """Solve for all unknowns, (N, how many) for each contact and for each drive, by its link."""
    columns, owners = [], []
    for contact in passing:
        if isinstance(contact, tuple):
            pulls = [system.pair(strand, strand.directions[0], 0.0) for strand in contact]
            columns.append((pulls[0] - pulls[1]) / 2)
            owners.append(contact[0].name)
            continue
        columns += [system.pair(contact, direction, 0.0) for direction in contact.directions]
        if contact.couple:
            columns.append(system.pair(contact, np.zeros_like(contact.at), 1.0))
        owners += [contact.name] * contact.size
    for drive in system.machine.driven:
        columns, owners = [*columns, driving(system, drive)], [*owners, drive]
    matrix = np.stack(columns, -1)
    if matrix.shape[1] == matrix.shape[2]:
        solution = np.linalg.solve(matrix, system.known[..., None])[..., 0]
    else:
        couples = []
        for item in passing:
            size, forces = (1, 1) if isinstance(item, tuple) else (item.size, len(item.directions))
            couples += [k == forces for k in range(size)]
        units = np.where(
            [*couples, *[False] * len(system.machine.driven)], extent(system.machine), 1.0
        )
        pairs = zip(matrix * units, system.known, strict=True)
        solution = units * np.array([np.linalg.lstsq(*pair)[0] for pair in pairs])
    return {name: solution[:, [o == name for o in owners]] for name in dict.fromkeys(owners)}


def driving(system: System, drive: Drive | FurtherDrive) -> Array:
    """Return the column of a drive: a torque on its link, or a force between two bodies."""
    machine = system.machine
    if drive.stroke is not None:
        push = cylinder(machine, drive, system.poses)
        return system.pair(push, push.directions[0], 0.0)
    torque = np.zeros_like(system.known)
    torque[:, system.rows[drive.link] + 2] = 1.0
    return torque


def cylinder(machine: Machine, drive: Drive | FurtherDrive, poses: Poses) -> Contact:
    """Return where a drive that pushes acts, and along which line."""
    if drive.slider:
        first = next(slider for slider in machine.sliders if slider.name == drive.slider)
        at = poses.place(first.link, machine.links[first.link].points[first.point])
        line = (float(np.cos(first.direction)), float(np.sin(first.direction)))
        return Contact("", first.link, first.on, at, (poses.turned(first.on, line),))
    assert drive.between is not None
    bodies = drive.ends(machine.bodies)
    ends = zip(bodies, drive.between, strict=True)
    a, b = (poses.place(body, machine.points_of(body)[point]) for body, point in ends)
    along = (b - a) / np.linalg.norm(b - a, axis=-1, keepdims=True)
    return Contact("", bodies[1], bodies[0], b, (along,))


def extent(machine: Machine) -> float:
    """Return the largest distance of two joints on one body: of its pins, and of what slides."""
    on_several = Counter(point for points in machine.bodies.values() for point in points)
    sliding = {(slider.link, slider.point) for slider in machine.sliders}
    pairs = (
        (points[a], points[b])
        for body, points in machine.bodies.items()
        for a, b in combinations(points, 2)
        if all(on_several[end] > 1 or (body, end) in sliding for end in (a, b))
    )
    return max(float(np.hypot(*np.subtract(*pair))) for pair in pairs)


# -- contacts --------------------------------------------------------------------------------------


def pin_contacts(
    machine: Machine, poses: Poses, pairs: Mapping[str, tuple[str, str]]
) -> list[Contact]:
    """List all pins; which body holds which is a matter of choice where there are more than two."""
    actual = []
    for label, bodies in pins(machine).items():
        chosen = {label: (bodies[1], bodies[0])}
        if len(bodies) > 2:
            names = [name for name in pairs if name.startswith(f"{label}/")]
            chosen = {f"{label}/{body}": (body, bodies[0]) for body in bodies[1:]}
            chosen = {name: pairs[name] for name in names} or chosen
        for name, (on, by) in chosen.items():
            actual.append(pin_contact(name, on, by, label, machine, poses))
    return actual


def pin_contact(name: str, on: str, by: str, label: str, machine: Machine, poses: Poses) -> Contact:
    """Return the pin between two bodies."""
    at = poses.place(on, machine.points_of(on)[label])
    along_x, along_y = (np.broadcast_to(unit, at.shape) for unit in np.eye(2))
    return Contact(name, on, by, at, (along_x, along_y))


def slider_contacts(machine: Machine, poses: Poses) -> list[Contact]:
    """List all sliding joints; the later of the two bodies is the one acted on."""
    order = [FRAME, *machine.links]
    actual = []
    for slider in machine.sliders:
        by, on = sorted((slider.link, slider.on), key=order.index)
        at = poses.place(slider.link, machine.links[slider.link].points[slider.point])
        line = (float(np.cos(slider.direction)), float(np.sin(slider.direction)))
        across = quarter(poses.turned(slider.on, line))
        actual.append(Contact(slider.name, on, by, at, (across,), couple=True))
    return actual


def slot_contact(slot: CircularSlot | CurvedSlot, machine: Machine, poses: Poses) -> Contact:
    """Return the push of a slot on its pin."""
    at = poses.place(slot.link, machine.links[slot.link].points[slot.point])
    return Contact(slot.name, slot.link, slot.on, at, (normal_of(slot, machine, poses),))


def centre_line(gear: Gear, machine: Machine, poses: Poses) -> tuple[Array, Array]:
    """Return pitch point and unit vector from the driver's to the driven gear's axis.

    On the carrier the pitch point, at the part s of the centre distance from the driver's axis,
    has the speed s w of the driver and (s - 1) r w of the driven gear; hence s = r / (r - 1).  Here
    r is the ratio at each crank angle.
    """
    axes = []
    for body in (gear.driver, gear.driven):
        label = pin_between(machine, body, gear.carrier)
        axes.append(poses.place(gear.carrier, machine.points_of(gear.carrier)[label]))
    between = axes[1] - axes[0]
    ratio = np.asarray(gear.speed_ratio)
    if gear.shape is not None:
        ratio = Rolling(gear).ratio(seen_from_carrier(gear, poses))
    part = ratio / (ratio - 1)
    return axes[0] + part[..., None] * between, between / np.linalg.norm(
        between, axis=-1, keepdims=True
    )


def seen_from_carrier(gear: Gear, poses: Poses) -> Array:
    """Return the driver's angle, as one on the carrier sees it."""
    return poses.angle_of(gear.driver) - poses.angle_of(gear.carrier)


def gear_contact(gear: Gear, machine: Machine, poses: Poses) -> Contact:
    """Return the teeth in mesh, with the force of the driver on the driven gear."""
    pitch_point, unit = centre_line(gear, machine, poses)
    return Contact(gear.name, gear.driven, gear.driver, pitch_point, (quarter(unit),))


def separating(gear: Gear, machine: Machine, poses: Poses, tangential: Array) -> Array:
    """Return the radial force on the driven gear.

    A tooth that stands outward is pushed towards its own gear's axis.  Both gears of an external
    pair have such teeth, and of an internal pair the smaller one.
    """
    unit = centre_line(gear, machine, poses)[1]
    if gear.shape is not None:
        return leaning(gear, poses, tangential, unit)
    size = np.abs(tangential) * np.tan(gear.pressure_angle)
    # External: from the pitch point the driven gear's axis lies along +unit.  Internal with a
    # small driven gear: along -unit.  Internal with a small driver: its axis lies along +unit,
    # so it is pushed that way and the driven ring the other way.
    towards = 1.0 if gear.speed_ratio < 0 else -1.0
    return towards * size[:, None] * unit


def rack_contact(rack: Rack, machine: Machine, poses: Poses) -> Contact:
    """Return the teeth of a rack in mesh, with the force on the driven link along the rack."""
    slider = rack_guide(machine, rack)
    label = pin_between(machine, rack.pinion, rack.carrier)
    axis = poses.place(rack.carrier, machine.points_of(rack.carrier)[label])
    line = turned(poses.angle_of(slider.on) + slider.direction, (1.0, 0.0))
    left = 1.0 if rack.side == "left" else -1.0
    pitch_point = axis - left * rack.radius * quarter(line)
    on, by = (rack.rack, rack.pinion) if rack.drives == "pinion" else (rack.pinion, rack.rack)
    return Contact(rack.name, on, by, pitch_point, (line,))


def off_the_rack(rack: Rack, machine: Machine, poses: Poses, tangential: Array) -> Array:
    """Return the force across the rack on the driven link: pinion and rack are pushed apart."""
    slider = rack_guide(machine, rack)
    line = turned(poses.angle_of(slider.on) + slider.direction, (1.0, 0.0))
    to_pinion = quarter(line) * (1.0 if rack.side == "left" else -1.0)
    towards = -1.0 if rack.drives == "pinion" else 1.0
    return towards * (np.abs(tangential) * np.tan(rack.pressure_angle))[:, None] * to_pinion


def strand_contacts(belt: Belt, machine: Machine, poses: Poses) -> Strands:
    """Return the left and the right strand, each with its pull on the driven pulley.

    The radius to where a strand touches leans from the line of the axes by the angle whose cosine
    is the sum (crossed), or difference, of both radii over the distance.
    """
    axes = []
    for body in (belt.driver, belt.driven):
        label = pin_between(machine, body, belt.carrier)
        axes.append(poses.place(belt.carrier, machine.points_of(belt.carrier)[label]))
    between = axes[1] - axes[0]
    first, second = belt.pitch_radii
    second = -second if belt.crossed else second
    lean = np.arccos((first - second) / np.linalg.norm(between[0]))
    heading = np.arctan2(between[:, 1], between[:, 0])
    actual = []
    for side in (1.0, -1.0):
        out = turned(heading + side * lean, (1.0, 0.0))
        start, stop = axes[0] + first * out, axes[1] + second * out
        pull = (start - stop) / np.linalg.norm(start - stop, axis=-1, keepdims=True)
        actual.append(Contact(belt.name, belt.driven, belt.driver, stop, (pull,)))
    return actual[0], actual[1]


def tensions(belt: Belt, transmitted: Array) -> tuple[Array, Array]:
    """Return the tensions of left and right strand, whose difference is known."""
    if belt.tension is None:  # one hangs loose
        return np.maximum(transmitted, 0.0), np.maximum(-transmitted, 0.0)
    return belt.tension + transmitted / 2, belt.tension - transmitted / 2


def leaning(gear: Gear, poses: Poses, tangential: Array, unit: Array) -> Array:
    """Return the same where the pitch curves lean: the tooth pushes along their tangent, turned by
    the pressure angle towards the driven gear, or away from it where either is a ring.
    """
    tilt = Rolling(gear).tilt(seen_from_carrier(gear, poses))
    way = np.where(tangential < 0, -1.0, 1.0)
    push = way * (unit[:, 0] + 1j * unit[:, 1]) * 1j * np.exp(1j * tilt)
    push *= np.exp(1j * way * np.sign(gear.speed_ratio) * gear.pressure_angle)
    toward = unit[:, 0] - 1j * unit[:, 1]
    along, across = (push * toward).real, (push * toward).imag
    return (along / across * tangential)[:, None] * unit


def cam_contact(cam: Cam, machine: Machine, poses: Poses) -> Contact:
    """Return the place where a cam pushes its follower, along their common normal."""
    at, normal = line_of_force(machine, cam, poses)
    return Contact(cam.name, cam.driven, cam.driver, at, (normal,))


# -- results ---------------------------------------------------------------------------------------


def gathered(
    machine: Machine,
    poses: Poses,
    joints: list[Contact],
    coupled: tuple[list[Contact], list[Contact], list[Strands]],
    unknowns: Mapping[str, Array],
) -> FreeBodies:
    """Turn the unknowns into vectors and add up what the frame bears."""
    gears, racks, belts = coupled
    held = {contact.name: reaction(contact, unknowns[contact.name]) for contact in joints}
    meshed, racked, taut, pulled, both = {}, {}, {}, [], {}
    for gear, contact in zip(machine.gears, gears, strict=True):
        apart = separating(gear, machine, poses, unknowns[contact.name][:, 0])
        meshed[gear.name] = reaction(contact, unknowns[contact.name], apart)
    for rack, contact in zip(machine.racks, racks, strict=True):
        apart = off_the_rack(rack, machine, poses, unknowns[contact.name][:, 0])
        racked[rack.name] = reaction(contact, unknowns[contact.name], apart)
    for belt, strands in zip(machine.belts, belts, strict=True):
        taut[belt.name] = tensions(belt, unknowns[belt.name][:, 0])
        for strand, tension in zip(strands, taut[belt.name], strict=True):
            pulled.append(reaction(strand, tension[:, None]))
        force = pulled[-1].force + pulled[-2].force
        both[belt.name] = replace(pulled[-1], force=force)
    drives = {drive.link: unknowns[drive][:, 0] for drive in machine.driven}
    pulls = [pull_on_frame(*acting) for acting in springs_on_links(machine, poses)]
    # the soil comes behind
    loads = zip(loads_by_end(machine), on_links(machine, poses), strict=False)
    pulls += [pull_on_frame(*acting) for load, acting in loads if load.reaction == FRAME]
    pushing = [drive for drive in machine.driven if drive.stroke is not None]
    pulls += [reaction(cylinder(machine, item, poses), unknowns[item]) for item in pushing]
    torque = sum(drives[item.link] for item in machine.driven if item not in pushing)
    every = [*held.values(), *meshed.values(), *racked.values(), *pulled, *pulls]
    force, moment = on_frame(machine, every)
    pressed = {cam.name: held.pop(cam.name) for cam in machine.cams}
    return FreeBodies(held, meshed, pressed, racked, taut, both, drives, force, moment - torque)


def reaction(contact: Contact, unknowns: Array, more: Array | float = 0.0) -> Reaction:
    """Return force and couple of one contact, whose force has more than what is unknown."""
    force = np.zeros_like(contact.at) + more
    for number, direction in enumerate(contact.directions):
        force = force + unknowns[:, number, None] * direction
    couple = unknowns[:, -1] if contact.couple else np.zeros(len(force))
    return Reaction(contact.on, contact.by, contact.at, force, couple)


def pull_on_frame(link: str, at: Array, force: Array, couple: Array) -> Reaction:
    """Return what a spring or a load does to the frame, of whose line every point is as good."""
    return Reaction(FRAME, link, at, -force, -couple)


def on_frame(machine: Machine, reactions: list[Reaction]) -> tuple[Array, Array]:
    """Add up the contacts' and springs' forces on the frame, with their moment about the pivot."""
    pivot = np.array(machine.frame[drive_pivot(machine)])
    total, moment = np.zeros_like(reactions[0].force), np.zeros(len(reactions[0].force))
    for part in reactions:
        sign = (part.on == FRAME) - (part.by == FRAME) + 0.0
        total += sign * part.force
        moment += sign * (cross(part.at - pivot, part.force) + part.couple)
    return total, moment
