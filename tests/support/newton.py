"""Motion by brute strength: all constraints of all links at once, followed by Newton's method.

Each link has three coordinates (its origin and its angle).  Pins, sliding joints, gears and the
drive are equations g(q) = 0; velocities and accelerations follow from their Jacobian alone, so
that no dyad, no side and no order of solution enters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive, Machine, Slider, Vector
from equipoise.mechanism.parts.racks import Rack
from support.driving import driven
from support.driving import followed as followed_law
from support.poses import Array, Poses, cross, pins, quarter, turned
from support.rolling_reference import Rolling
from support.slots import on_circle, on_curve


class NotAssembledError(RuntimeError):
    """Newton's method has found no pose."""


@dataclass(frozen=True)
class Row:
    """Two lines or one of the constraints.

    residual : (k,).  jacobian : (k, 3 n).  bend : (k,), minus the second derivative of the
    residual that remains at zero acceleration.
    """

    residual: Array
    jacobian: Array
    bend: Array


@dataclass
class Constraints:
    """Equations that hold a machine together; `gear_constants` are set at crank angle 0."""

    machine: Machine
    gear_constants: dict[str, float] = field(default_factory=dict)

    @cached_property
    def columns(self) -> dict[str, int]:
        """First column of each link's coordinates."""
        return {name: 3 * number for number, name in enumerate(self.machine.links)}

    @cached_property
    def shared(self) -> dict[str, list[str]]:
        """Bodies at each pin."""
        return pins(self.machine)

    def at(self, q: Array, rate: Array, crank_angle: float) -> Row:
        """Evaluate everything at coordinates `q` moving at `rate`."""
        rows = [
            self._pin(q, rate, label, bodies[0], body)
            for label, bodies in self.shared.items()
            for body in bodies[1:]
        ]
        rows += [row for slider in self.machine.sliders for row in self._slider(q, rate, slider)]
        rows += [self._circular(q, rate, slot) for slot in self.machine.circular_slots]
        rows += [self._curved(q, rate, slot) for slot in self.machine.curved_slots]
        rows += [self._gear(q, rate, gear) for gear in self.machine.gears]
        rows += [self._belt(q, belt) for belt in self.machine.belts]
        rows += [self._rack(q, rate, rack) for rack in self.machine.racks]
        rows += [self._driven(q, rate, item, self.commanded(item, crank_angle)[0])
                 for item in self.machine.driven]  # fmt: skip
        return Row(
            np.concatenate([row.residual for row in rows]),
            np.concatenate([row.jacobian for row in rows]),
            np.concatenate([row.bend for row in rows]),
        )

    def commanded(
        self, drive: Drive | FurtherDrive, crank_angle: float
    ) -> tuple[float, float, float]:
        """Return what a drive commands, and its derivatives by crank angle."""
        stroke = getattr(drive, "stroke", None)
        return driven(drive, crank_angle) if stroke is None else followed_law(stroke, crank_angle)

    def _driven(self, q: Array, rate: Array, drive: Drive | FurtherDrive, wanted: float) -> Row:
        """Return the equation of a drive: an angle, or the length that pushes."""
        if drive.stroke is None:
            return self._turn({drive.link: 1.0}, q, -wanted)
        if drive.slider:
            single = next(slider for slider in self.machine.sliders if slider.name == drive.slider)
            way = self._travel(q, rate, single)
            return Row(way.residual - wanted, way.jacobian, way.bend)
        assert drive.between is not None
        ends = zip(drive.ends(self.machine.bodies), drive.between, strict=True)
        a, b = (self._place(q, rate, body, self.machine.points_of(body)[at]) for body, at in ends)
        way, jacobian = b.residual - a.residual, b.jacobian - a.jacobian
        length = float(np.hypot(*way))
        along, drift = way / length, jacobian @ rate
        turning = (drift @ drift - (along @ drift) ** 2) / length
        bend = along @ (b.bend - a.bend) + turning
        return Row(np.array([length - wanted]), (along @ jacobian)[None], np.array([-bend]))

    def _place(self, q: Array, rate: Array, body: str, local: Vector) -> Row:
        """Return position, its Jacobian and centripetal acceleration of a point."""
        jacobian = np.zeros((2, q.size))
        if body == FRAME:
            return Row(np.array(local), jacobian, np.zeros(2))
        k = self.columns[body]
        arm = turned(q[k + 2], local)
        jacobian[:, k : k + 2] = np.eye(2)
        jacobian[:, k + 2] = quarter(arm)
        return Row(q[k : k + 2] + arm, jacobian, -(rate[k + 2] ** 2) * arm)

    def _pin(self, q: Array, rate: Array, label: str, item: str, other: str) -> Row:
        a = self._place(q, rate, item, self.machine.points_of(item)[label])
        b = self._place(q, rate, other, self.machine.points_of(other)[label])
        return Row(b.residual - a.residual, b.jacobian - a.jacobian, a.bend - b.bend)

    def _slider(self, q: Array, rate: Array, slider: Slider) -> list[Row]:
        point = self.machine.links[slider.link].points[slider.point]
        through = self.machine.points_of(slider.on)[slider.through]
        a = self._place(q, rate, slider.on, through)
        b = self._place(q, rate, slider.link, point)
        angle, spin = 0.0, 0.0
        weights = {slider.link: 1.0}
        if slider.on != FRAME:
            k = self.columns[slider.on] + 2
            angle, spin = q[k], rate[k]
            weights[slider.on] = -1.0
        line = turned(angle, (np.cos(slider.direction), np.sin(slider.direction)))
        across, apart = quarter(line), b.residual - a.residual
        jacobian = across @ (b.jacobian - a.jacobian)
        drift = (b.jacobian - a.jacobian) @ rate
        bend = across @ (b.bend - a.bend)
        if slider.on != FRAME:
            jacobian[k] -= line @ apart
            bend += -2 * spin * (line @ drift) - spin**2 * (across @ apart)
        distance = Row(np.array([across @ apart]), jacobian[None], np.array([-bend]))
        return [distance, self._turn(weights, q, -slider.direction - slider.angle)]

    def _circular(self, q: Array, rate: Array, slot: CircularSlot) -> Row:
        ends = (self._place(q, rate, body, self.machine.points_of(body)[point])
                for body, point in slot.points)  # fmt: skip
        residual, jacobian, bend = on_circle(slot, *ends, rate)
        return Row(np.array([residual]), jacobian[None], np.array([bend]))

    def _curved(self, q: Array, rate: Array, slot: CurvedSlot) -> Row:
        ends = (self._place(q, rate, body, self.machine.points_of(body)[point])
                for body, point in slot.points)  # fmt: skip
        k = None if slot.on == FRAME else self.columns[slot.on] + 2
        turning = (0.0, 0.0, None) if k is None else (q[k], rate[k], k)
        residual, jacobian, bend = on_curve(slot, *ends, rate, turning)
        return Row(np.array([residual]), jacobian[None], np.array([bend]))

    def _gear(self, q: Array, rate: Array, gear: Gear) -> Row:
        if gear.name not in self.gear_constants:
            return self._turn({gear.driven: 1.0}, q, -gear.start)
        constant = self.gear_constants[gear.name]
        if gear.shape is not None:
            return self._rolling(q, rate, gear, constant)
        ratio = gear.speed_ratio
        weights = {gear.driven: 1.0, gear.driver: -ratio, gear.carrier: ratio - 1.0}
        return self._turn(weights, q, -constant)

    def _rolling(self, q: Array, rate: Array, gear: Gear, constant: float) -> Row:
        """A pair whose ratio varies with the driver's angle seen from the carrier."""
        pair = Rolling(gear)
        slip = {gear.driver: 1.0, gear.carrier: -1.0}
        seen = self._turn(slip, q, 0.0)
        x, speed = float(seen.residual[0]), float(seen.jacobian[0] @ rate)
        rest = self._turn({gear.driven: 1.0, gear.carrier: -1.0}, q, -constant - pair.angle(x))
        jacobian = rest.jacobian - float(pair.ratio(x)) * seen.jacobian
        return Row(rest.residual, jacobian, np.array([float(pair.bend(x)) * speed**2]))

    def _belt(self, q: Array, belt: Belt) -> Row:
        """As much belt runs onto one pulley as off the other, seen from the carrier."""
        if belt.name not in self.gear_constants:
            return self._turn({belt.driven: 1.0}, q, -belt.start)
        return self._turn(_wound(belt), q, -self.gear_constants[belt.name])

    def _rack(self, q: Array, rate: Array, rack: Rack) -> Row:
        """The rack goes on by as much as the pinion's pitch circle turns on the carrier."""
        slider = rack_guide(self.machine, rack)
        way = self._travel(q, rate, slider)
        if rack.name not in self.gear_constants:
            if rack.drives == "rack":
                return self._turn({rack.pinion: 1.0}, q, -rack.angle)
            return Row(way.residual - rack.travel, way.jacobian, way.bend)
        wound = self._turn(_rolled(rack), q, self.gear_constants[rack.name])
        return Row(
            way.residual - wound.residual, way.jacobian - wound.jacobian, way.bend - wound.bend
        )

    def _travel(self, q: Array, rate: Array, slider: Slider) -> Row:
        """Return how far a link is along its guide."""
        a = self._place(q, rate, slider.on, self.machine.points_of(slider.on)[slider.through])
        b = self._place(q, rate, slider.link, self.machine.links[slider.link].points[slider.point])
        apart, along = b.residual - a.residual, b.jacobian - a.jacobian
        k = None if slider.on == FRAME else self.columns[slider.on] + 2
        angle, spin = (0.0, 0.0) if k is None else (q[k], rate[k])
        line = turned(angle + slider.direction, (1.0, 0.0))
        across = quarter(line)
        jacobian = line @ along
        if k is not None:
            jacobian[k] += across @ apart
        bend = line @ (b.bend - a.bend) + 2 * spin * (across @ (along @ rate))
        return Row(
            np.array([line @ apart]), jacobian[None], np.array([spin**2 * (line @ apart) - bend])
        )

    def _turn(self, weights: dict[str, float], q: Array, constant: float) -> Row:
        """Return an equation of angles alone."""
        jacobian = np.zeros((1, q.size))
        for body, weight in weights.items():
            if body != FRAME:
                jacobian[0, self.columns[body] + 2] = weight
        return Row(jacobian @ q + constant, jacobian, np.zeros(1))

    def mesh(self, q: Array) -> None:
        """Let the gears mesh as they stand at `q`."""
        for gear in self.machine.gears:
            self.gear_constants[gear.name] = 0.0
            row = self._gear(q, np.zeros_like(q), gear)
            self.gear_constants[gear.name] = float(row.residual[0])
        for belt in self.machine.belts:
            self.gear_constants[belt.name] = float(self._turn(_wound(belt), q, 0.0).residual[0])
        for rack in self.machine.racks:
            way = self._travel(q, np.zeros_like(q), rack_guide(self.machine, rack))
            wound = self._turn(_rolled(rack), q, 0.0)
            self.gear_constants[rack.name] = float((way.residual - wound.residual)[0])


def _wound(belt: Belt) -> dict[str, float]:
    first, second = belt.teeth or belt.radii or (0.0, 0.0)
    first = -first if belt.crossed else first
    return {belt.driven: second, belt.driver: -first, belt.carrier: first - second}


def _rolled(rack: Rack) -> dict[str, float]:
    way = rack.radius if rack.side == "left" else -rack.radius
    return {rack.pinion: way, rack.carrier: -way}


def rack_guide(machine: Machine, rack: Rack) -> Slider:
    """Return the sliding joint of a rack with its carrier."""
    ends = (rack.rack, rack.carrier)
    return next(slider for slider in machine.sliders if (slider.link, slider.on) == ends)


def closed(constraints: Constraints, q: Array, crank_angle: float, steps: int = 40) -> Array:
    """Close the linkage by Newton's method from the coordinates `q`."""
    rest, size = np.zeros_like(q), max(reach(constraints.machine), 1e-9)
    scale = np.tile([size, size, 1.0], q.size // 3)
    small = 0
    for _ in range(steps):
        row = constraints.at(q, rest, crank_angle)
        step = solved(row.jacobian, -row.residual)
        q = q + step
        change = float(np.max(np.abs(step / scale)))
        if not change < 1e6:
            break
        small += change < 1e-13
        if change < 1e-15 or small > 1:
            if np.max(np.abs(row.residual)) > 1e-9 * max(size, 1.0):
                break  # the nearest to what joints that hold too much ask for, and no pose
            return q
    raise NotAssembledError(f"no pose at crank angle {crank_angle:g}")


def solved(matrix: Array, right: Array) -> Array:
    """Solve a square system, NaN where it is singular, or more equations that go together."""
    if len(matrix) > matrix.shape[1]:
        scale = np.linalg.norm(matrix, axis=0)
        return np.asarray(np.linalg.lstsq(matrix / scale, right, rcond=1e-13)[0] / scale)
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        return np.full(len(right), np.nan)


def reach(machine: Machine) -> float:
    """Return the largest coordinate of a link's points or between those of the frame."""
    local = [abs(c) for link in machine.links.values() for xy in link.points.values() for c in xy]
    frame = np.array(list(machine.frame.values()))
    return float(max(*local, *np.ptp(frame, axis=0), 0.0))


def assembled(machine: Machine, wanted: Callable[[Poses], bool], rng: np.random.Generator) -> Array:
    """Return coordinates at crank angle 0 in the assembly that is wanted, from random guesses."""
    constraints, size = Constraints(machine), reach(machine)
    near = np.mean(list(machine.frame.values()), axis=0)
    for _ in range(2000):
        q = rng.normal(size=3 * len(machine.links)) * size
        q += np.tile([*near, 0.0], len(machine.links))
        q[2::3] = rng.uniform(-np.pi, np.pi, len(machine.links))
        try:
            q = closed(constraints, q, 0.0)
        except NotAssembledError:
            continue
        if np.max(np.abs(q[2::3])) > 20:
            continue  # many turns away, where angles have lost digits
        if wanted(moving(constraints, [0.0], [q])):
            return q
    raise NotAssembledError("no guess has led to the assembly that is wanted")


def trace(machine: Machine, angles: Array, start: Array) -> Poses:
    """Follow a machine from its pose `start` at crank angle 0 to rising crank angles."""
    constraints = Constraints(machine)
    q = closed(constraints, start, 0.0)
    constraints.mesh(q)
    actual, here = [], 0.0
    for angle in map(float, angles):
        q = followed(constraints, q, here, angle)
        here = angle
        actual.append(q)
    return moving(constraints, angles, actual)


def followed(constraints: Constraints, q: Array, here: float, there: float) -> Array:
    """Follow the machine to another crank angle, in smaller steps where it turns sharply."""
    guess = q + slope(constraints, q, here) * (there - here)
    try:
        end = closed(constraints, guess, there)
    except NotAssembledError:
        end = guess + np.inf
    size = reach(constraints.machine)
    scale = np.tile([size, size, 1.0], q.size // 3)
    apart = np.max(np.abs(end - guess) / scale)
    if apart < 0.01 or (
        apart < 0.1 and side(constraints, q, here) == side(constraints, end, there)
    ):
        return end
    if abs(there - here) < 1e-6:
        raise NotAssembledError(f"no way past crank angle {here:g}")
    middle = (here + there) / 2
    return followed(constraints, followed(constraints, q, here, middle), middle, there)


def side(constraints: Constraints, q: Array, crank_angle: float) -> float:
    """Tell on which side of a dead point the machine is: there the determinant changes its sign."""
    jacobian = constraints.at(q, np.zeros_like(q), crank_angle).jacobian
    return float(np.linalg.det(jacobian) > 0) if len(jacobian) == jacobian.shape[1] else 0.0


def slope(constraints: Constraints, q: Array, crank_angle: float) -> Array:
    """Return the derivative of the coordinates with respect to the crank angle."""
    row = constraints.at(q, np.zeros_like(q), crank_angle)
    drives = constraints.machine.driven
    asked = np.zeros(len(row.jacobian))
    asked[-len(drives) :] = [constraints.commanded(drive, crank_angle)[1] for drive in drives]
    return solved(row.jacobian, asked)


def moving(constraints: Constraints, angles: Array | list[float], result: list[Array]) -> Poses:
    """Return poses with the velocities and accelerations that the drive forces on them."""
    drive = constraints.machine.drive
    drives = constraints.machine.driven
    rates, changes = [], []
    for angle, q in zip(angles, result, strict=True):
        rate = slope(constraints, q, angle) * drive.speed
        row = constraints.at(q, rate, angle)
        rates.append(rate)
        asked = np.zeros(len(row.jacobian))
        for number, item in enumerate(drives, -len(drives)):
            _, first, second = constraints.commanded(item, angle)
            asked[number] = first * drive.acceleration + second * drive.speed**2
        changes.append(solved(row.jacobian, row.bend + asked))
    q, v, a = np.array(result), np.array(rates), np.array(changes)
    columns = constraints.columns.items()
    return Poses(
        np.array(angles, float),
        *({name: part[:, k : k + 2] for name, k in columns} for part in (q, v, a)),
        *({name: part[:, k + 2] for name, k in columns} for part in (q, v, a)),
    )


def coordinates(poses: Poses, number: int) -> Array:
    """Return the coordinates of all links at one of the crank angles."""
    parts = [[*poses.origin[name][number], poses.angle[name][number]] for name in poses.angle]
    return np.array(parts).ravel()


@dataclass(frozen=True)
class Side:
    """What an entry of `assembly` asks for, told from where points are.

    inner, first, second : (body, point); for 'left' and 'right' the inner pin against the line
        from the first to the second.  guide : (body, angle) of a line, instead of `second`; for
        'forward' and 'backward' along it from the first point's foot.
    """

    side: str
    inner: tuple[str, str]
    first: tuple[str, str]
    second: tuple[str, str] | None = None
    guide: tuple[str, float] | None = None

    def holds(self, machine: Machine, poses: Poses) -> bool:
        """Tell whether the machine is on this side at every crank angle."""
        inner, first = (self._point(machine, poses, which) for which in (self.inner, self.first))
        if self.guide is not None:
            body, angle = self.guide
            line = poses.turned(body, (float(np.cos(angle)), float(np.sin(angle))))
            ahead = np.sum((inner - first) * line, -1)
            return bool(np.all(ahead > 0 if self.side == "forward" else ahead < 0))
        assert self.second is not None
        second = self._point(machine, poses, self.second)
        left = cross(second - first, inner - first)
        return bool(np.all(left > 0 if self.side == "left" else left < 0))

    @staticmethod
    def _point(machine: Machine, poses: Poses, which: tuple[str, str]) -> Array:
        body, label = which
        return poses.place(body, machine.points_of(body)[label])
