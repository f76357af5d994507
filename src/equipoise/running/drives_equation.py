"""The equations of motion of a machine of several drives, of which some follow from forces.

    M q.. + h = Q + T

Angles of drives with a motor, and of those that are free, are the unknowns; all others follow their
motion over the crank angle.  That is the angle of the first drive where it is such an unknown
itself, else it goes on evenly with time.  A drive with a given motion takes its torque T from
outside, as a servo motor that follows the crank would: nothing but its own link feels it.

The force of a one-sided mount bends where it lets go.  So each is taken to touch, or not to, until
its force changes its sign at an instant that is sought, and goes on smoothly in between.

The state has angles and speeds of the unknowns, and currents of motors that lag.  What does not act
back on these, such as the work of everything that acts, is integrated beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, MassError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.collocation import NodeValues
from equipoise.running.drivers import Driver
from equipoise.running.drives_linkage import (
    DriveAngles,
    DrivesPose,
    LinkageRows,
    References,
    pose_of,
    references_at,
)
from equipoise.running.friction import FRICTION, DrivesFriction, JointPressing
from equipoise.running.sources import AppliedSource, SourceInputs, load_factors, plus, sources_of
from equipoise.running.strokes import Strokes
from equipoise.signals import Array
from equipoise.vibration.support_motion import NO_MOUNTS, SpatialMounts, SupportMotion, SupportPlace

SupportReader = Callable[[Array, Array], SupportPlace]
"""Where the support is, by coordinates (C, K) of a machine and their rates."""
AT_CONTACT = 1e-9
"""Share of a mount's usual force within which it is just letting go, or touching."""

NO_FREE_DRIVE = Note(
    "every drive follows a given motion, so that there is nothing to integrate; give one of them a "
    "motor, or `free = true`"
)
STROKES_ALONE = Note(
    "every drive follows a given stroke, so that there is nothing to integrate; "
    "`equipoise analyze` computes its motion and forces"
)

BRAKED = 1e-3
"""Share of the usual speed near which a brake changes its sense."""

BRAKE = "brake"


class MountContacts:
    """The mounts of a support, and which of them touch.

    one_sided : names of mounts that push only, and their places.
    """

    def __init__(self, mounts: SpatialMounts, size: float, read: SupportReader) -> None:
        """size : of usual displacements, m.  read : where the support is."""
        self.read = read
        contacts = mounts.contacts
        self.one_sided = {item.name: k for k, item in enumerate(contacts) if item.one_sided}
        smooth = [replace(contact, one_sided=False) for contact in contacts]
        self._smooth = SpatialMounts(smooth, mounts.at)
        self._sizes = [abs(item.preload) + item.stiffness * size or 1.0 for item in contacts]
        self._touches = [True] * len(contacts)

    def wrench(self, at: SupportPlace) -> Array:
        """Generalized forces (6, K) on a support."""
        return self._smooth.wrench(at, self._touches)

    def left(self, name: str, coordinates: Array, rates: Array) -> Array:
        """How far (K,) a one-sided mount is from letting go, or from touching, as a share of its
        usual force, with coordinates (C, K) and their rates.
        """
        mount = self.one_sided[name]
        share = self._smooth.forces(self.read(coordinates, rates))[mount] / self._sizes[mount]
        return np.asarray(share if self._touches[mount] else -share)

    def observe(self, coordinates: Array, rates: Array) -> None:
        """Set which of them touch in a state (C, 1), but for those that are about to change."""
        for name in self.one_sided:
            if float(self.left(name, coordinates, rates)[0]) < -AT_CONTACT:
                self.switch(name)

    def switch(self, name: str) -> None:
        """A mount lets go, or touches again."""
        self._touches[self.one_sided[name]] ^= True


class DriveState(NamedTuple):
    """What acts in K states.

    pose : of the linkages of all R rows, as all that follows (R K).  where : coordinates of each.
    demands : of each of `DrivesEquation.sources`, what would hold it.
    inertia : (C, C, R K) of links and motors, kg m2.
    forces : of each of `DrivesEquation.acting` (S, C, R K), N m, or N along a support.
    rubbing : friction in joints; None without.
    """

    pose: DrivesPose
    where: DriveAngles
    demands: list[Demands]
    inertia: Array
    forces: Array
    rubbing: JointPressing | None


@dataclass(frozen=True, eq=False)
class DrivesEquation:
    """A machine as a function of the angles and speeds of its drives.

    start : crank angle at the start, rad, where it goes on with time.

    Raises
    ------
    MassError : a link has no mass given.
    UsageError : no drive moves freely.
    """

    machine: Machine
    start: float = 0.0

    def __post_init__(self) -> None:
        if missing := massless(self.machine):
            raise MassError(missing)
        if not self.unknowns:
            strokes_alone = all(drive.pushes for drive in self.drives)
            raise UsageError(at_place("drive", STROKES_ALONE if strokes_alone else NO_FREE_DRIVE))

    @cached_property
    def rows(self) -> LinkageRows:
        """The linkages that the drives turn."""
        return LinkageRows(self.machine)

    @property
    def drives(self) -> tuple[Drive | FurtherDrive, ...]:
        """All of them; the first one has the crank angle."""
        return self.machine.driven

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """Places of the drives whose angles follow from forces."""
        return tuple(k for k, drive in enumerate(self.drives) if drive.moves_freely)

    @property
    def free(self) -> list[int]:
        """The same places, for arrays."""
        return [*self.unknowns]

    @cached_property
    def given(self) -> tuple[int, ...]:
        """Places of those that follow their motion."""
        return tuple(k for k in range(len(self.drives)) if k not in self.unknowns)

    @property
    def coordinates(self) -> int:
        """How many coordinates the machine has: its drives come first."""
        return len(self.drives)

    def sizes(self) -> Array:
        """Usual sizes of the unknowns (U,): 1 of a drive's angle, rad."""
        return np.ones(len(self.unknowns))

    @cached_property
    def mounts(self) -> MountContacts:
        """Mounts of the support: none on a fixed frame."""
        return MountContacts(NO_MOUNTS, 1.0, SupportPlace)

    @cached_property
    def strokes(self) -> Strokes | None:
        """Drives that push as a given stroke has it; None without."""
        pushed = [k for k in self.given if self.drives[k].pushes]
        return Strokes(self.linkage, pushed, self.by_crank, self.start) if pushed else None

    @cached_property
    def by_crank(self) -> bool:
        """Whether the crank angle is an unknown, and not a matter of time."""
        return 0 in self.unknowns and self.machine.crank_turns

    @cached_property
    def linkage(self) -> Linkage:
        """The machine in the order in which it is computed."""
        return assemble(self.machine)

    @cached_property
    def sources(self) -> tuple[AppliedSource, ...]:
        """What acts beside the drives and friction in joints."""
        return tuple(sources_of(self.machine))

    @property
    def acting(self) -> tuple[str, ...]:
        """Keys of what acts beside the drives and friction in joints."""
        return tuple(source.key for source in self.sources)

    @cached_property
    def dyads(self) -> Mapping[str, str]:
        """Inner joints of dyads, and the values in a state that are 0 in their dead positions."""
        groups = self.linkage.groups
        return {group.joint: group.margin for group in groups if group.margin and not group.through}

    @cached_property
    def friction(self) -> DrivesFriction | None:
        """Friction in joints, where they have some."""
        if not self.machine.rubs:
            return None
        return DrivesFriction(self.linkage, abs(self.machine.drive.speed) or 1.0, self.rows)

    @cached_property
    def rotors(self) -> tuple[float, ...]:
        """Moment of inertia of each drive's motor, as its link feels it, kg m2."""
        motors = (drive.motor for drive in self.drives)
        return tuple(0.0 if motor is None else motor.reflected_inertia for motor in motors)

    def support_motion(self, coordinates: Array, rates: Array) -> SupportMotion | None:
        """How the support moves, by coordinates (C, K) and their rates; None on a fixed frame."""
        return None

    @property
    def nominal_speeds(self) -> list[float]:
        """Of each drive at crank angle 0, at the speed of the file, rad/s; of one whose motion
        begins at rest that of the crank.
        """
        crank = self.machine.drive.speed
        rates = [float(np.ravel(drive.turned(np.zeros(1))[1])[0]) for drive in self.drives]
        return [rate * crank or crank for rate in rates]

    def drivers(self) -> list[Driver]:
        """Of each drive, what turns it, at its start."""
        brakes = [self.machine.drive.brake, *[0.0] * len(self.machine.drives)]
        each = zip(self.drives, self.nominal_speeds, brakes, strict=True)
        return [Driver(drive.motor, speed, brake) for drive, speed, brake in each]

    def references_at_start(self) -> References:
        """References (..., R, 1) at the crank angle of the start, with all drives as the file has
        them there.

        Raises
        ------
        ResponseError : the links do not get there.
        """
        starts = self.start + self.rows.phases
        each = [references_at(self.linkage, angle) for angle in starts.tolist()]
        references = {
            name: np.concatenate([row[name] for row in each], axis=-1) for name in each[0]
        }
        if self.strokes is not None:
            references |= self.strokes.references_at(starts)
        return self._by_row(references)

    def references(self, state: DriveState) -> References:
        """What references have come to in K states (..., R, K)."""
        references = dict(state.pose.references)
        if self.strokes is not None:
            references |= self.strokes.references(state.where.angles)
        return self._by_row(references)

    def _by_row(self, references: References) -> References:
        """References (..., R, K) of (..., R K)."""
        return {name: self.rows.apart(values) for name, values in references.items()}

    def _of_rows(self, references: References) -> References:
        """References (..., R K) of (..., R, K)."""
        return {name: self.rows.joined(values) for name, values in references.items()}

    def placed(self, time: Array, angles: Array, speeds: Array) -> DriveAngles:
        """All drives at times (K,), s, by the angles and speeds of the unknowns, each (U, K), as
        their shafts turn; those that push are NaN until `in_rows` places them.
        """
        crank_speed = self._crank_speed(time, speeds)
        crank = angles[0] if self.by_crank else self.start + crank_speed * time
        return self._placed(crank, crank_speed, angles, speeds)

    def _placed(
        self, crank: Array, crank_speed: Array, angles: Array, speeds: Array
    ) -> DriveAngles:
        """All drives by the unknowns, each (U, K), of which those that are given follow a crank
        angle (K,), rad, and its speed, rad/s.
        """
        count, free, states = self.coordinates, self.free, len(crank)
        whole = np.zeros((3, count, states))  # angles, speeds and bias of accelerations
        jacobian, virtual = np.zeros((2, count, len(free), states))
        jacobian[free, range(len(free))] = virtual[free, range(len(free))] = 1.0
        whole[0, free], whole[1, free] = angles, speeds
        for k in self.given:
            if self.drives[k].pushes:
                whole[:, k] = np.nan
                continue
            angle, first, second = self.drives[k].turned(crank)
            whole[:, k] = angle, first * crank_speed, second * crank_speed**2
            if self.by_crank:
                jacobian[k, 0] = first
        none = np.zeros((0, states))
        return DriveAngles(
            crank, whole[0], whole[1], jacobian, whole[2], virtual, whole[1], none, none[:, None]
        )

    def in_rows(self, time: Array, where: DriveAngles, references: References) -> DriveAngles:
        """All drives of each row (R K), at times (K,), s, with those that push.

        Shafts that follow from torques turn the links of all rows by the same angles, from where
        the file has each at the start; a given motion is that of the row's own crank angle.

        where : as of `placed`.  references : in these states.

        Raises
        ------
        MotionError : a stroke cannot be as long as it is to be.
        """
        rows, free = self.rows, self.free
        crank_speed = rows.repeated(self._crank_speed(time, where.speeds[free]))
        if not rows.as_in_file:
            shifts = rows.of_each(self._shifts, len(time))
            crank = rows.repeated(where.crank_angle) + rows.of_each(rows.phases, len(time))
            angles, speeds = (rows.repeated(part[free]) for part in (where.angles, where.speeds))
            where = self._placed(crank, crank_speed, angles + shifts, speeds)
        if self.strokes is None:
            return where
        return self.strokes.placed(where, crank_speed, self._of_rows(references))

    @cached_property
    def _shifts(self) -> Array:
        """By which the unknowns of each row are larger (U, R) than those of the shafts."""
        shifts = np.zeros((len(self.unknowns), self.rows.count))
        for row, k in enumerate(self.unknowns):
            if k < len(self.drives):
                turned = self.drives[k].turned
                shifts[row] = turned(self.start + self.rows.phases)[0] - turned(self.start)[0]
        return shifts

    def _crank_speed(self, time: Array, speeds: Array) -> Array:
        """Speed of the crank (K,), rad/s, by those of the unknowns (U, K)."""
        return speeds[0] if self.by_crank else np.full(len(time), self.machine.drive.speed)

    def margins(self, state: DriveState) -> Array:
        """What falls to 0 (D, K) where a dyad, or a stroke, comes to its dead position, in the
        order of `dead_positions`.
        """
        margins = state.pose.margins([*self.dyads.values()])
        if self.strokes is not None:
            margins = np.vstack([margins, self.strokes.margin(state.where.slopes)])
        by_row = self.rows.apart(margins)
        return by_row.reshape(-1, by_row.shape[-1])

    @property
    def dead_positions(self) -> list[tuple[str, str]]:
        """What `margins` belong to: ``dead`` with the inner joint of a dyad, ``lever`` with the
        links that strokes move.
        """
        positions = [("dead", joint) for joint in self.dyads]
        if self.strokes is not None:
            positions.append(("lever", ", ".join(self.strokes.links)))
        return [position for position in positions for _ in self.rows.all]

    def at(
        self, time: Array, since: float, where: DriveAngles, references: References
    ) -> DriveState:
        """What acts in K states.

        where : as of `placed`.
        since : an instant, s, just after which loads over time follow the line that counts.
        references : in these states.

        Raises
        ------
        MotionError, ModelError : the machine cannot be there.
        """
        rows = self.rows
        where = self.in_rows(time, where, references)
        pose = self.pose(where, self._of_rows(references))
        crank_speed = self._crank_speed(rows.repeated(time), where.speeds[self.free])
        factors = load_factors(self.machine, rows.repeated(time), since)
        inputs = SourceInputs(crank_speed, factors, pose.gravity)
        acting = [source.demands(pose.moving, inputs) for source in self.sources]
        forces = np.zeros((len(self.acting), self.coordinates, pose.count))
        for k, (source, demands) in enumerate(zip(self.sources, acting, strict=True)):
            forces[k] = pose.exerted(source, inputs, demands)
        forces[len(acting) :] = self.mount_forces(pose)
        rubbing = None
        if self.friction is not None:
            rubbing = self.friction.of(pose, plus(pose.turning, *acting))
        return DriveState(pose, where, acting, self.with_rotors(pose.inertia), forces, rubbing)

    def mount_forces(self, pose: DrivesPose) -> Array:
        """Generalized forces (0, N, R K) of mounts of the support: none on a fixed frame."""
        return np.zeros((0, self.coordinates, pose.count))

    def pose(self, where: DriveAngles, references: References) -> DrivesPose:
        """The linkages of all rows, at coordinates as of `in_rows`, near references (..., R K)."""
        drives = slice(len(self.drives))
        angles, speeds = where.angles[drives], where.speeds[drives]
        return pose_of(
            self.linkage, where.crank_angle, angles, speeds, references, 1 / self.rows.count
        )

    def with_rotors(self, inertia: Array) -> Array:
        """Inertia (C, C, R K), kg m2, of links with that of motors."""
        whole, drives = np.array(inertia), len(self.drives)
        whole[:drives, :drives] += np.diag(self.rotors)[:, :, None] / self.rows.count
        return whole

    def accelerations(
        self, state: DriveState, torques: Array, settled: Array
    ) -> tuple[Array, Array]:
        """Of all drives of each row (C, R K), rad/s2, with torques (C, K) on the shafts that are
        unknown, N m; and friction (J R, K) in joints, N m or N.

        settled : (J R,), as of `DrivesFriction.senses`.

        Raises
        ------
        LockError : friction locks the machine.
        """
        rows, where, inertia = self.rows, state.where, state.inertia
        demand = np.sum(inertia[:, :, None] * where.jacobian[None], axis=1)
        left = rows.total(np.sum(where.virtual_speeds[:, :, None] * demand[:, None], axis=0))
        acting = state.forces.sum(axis=0) + rows.repeated(torques) / rows.count - state.pose.bias
        acting = acting - np.sum(inertia * where.bias_accelerations, axis=1)
        known = rows.total(np.sum(where.virtual_speeds * acting[:, None], axis=0))
        if state.rubbing is None:
            changes = rows.repeated(_eliminated(left, known[:, None])[:, 0])
            whole = where.bias_accelerations + np.sum(where.jacobian * changes, axis=1)
            return whole, np.zeros((0, torques.shape[1]))
        rubbing = np.einsum("nuk,jnk->ujk", where.virtual_speeds, state.rubbing.ways)
        rubbing = rows.apart(rubbing).reshape(len(left), -1, torques.shape[1])
        both = _eliminated(left, np.concatenate([known[:, None], rubbing], axis=1))
        moved = np.sum(where.jacobian[:, :, None] * rows.repeated(both), axis=1)
        whole, response = where.bias_accelerations + moved[:, 0], moved[:, 1:]
        efforts = state.rubbing.efforts(settled, whole, response)
        return whole + np.sum(response * rows.repeated(efforts), axis=1), efforts

    def given_efforts(self, state: DriveState, accelerations: Array, efforts: Array) -> Array:
        """Torques, N m, and of strokes forces, N, of the drives with a given motion of each row
        (G, R K).
        """
        demand = np.einsum("ijk,jk->ik", state.inertia, accelerations)
        demand = demand + state.pose.bias - state.forces.sum(axis=0)
        if state.rubbing is not None:
            of_rows = efforts.reshape(len(state.rubbing.ways), -1)
            demand = demand - np.einsum("jgk,jk->gk", state.rubbing.ways, of_rows)
        if self.strokes is not None:
            demand = self.strokes.efforts(state.where.slopes, demand)
        return np.asarray(demand[[*self.given]])

    def energy(self, where: DriveAngles, references: References) -> Array:
        """Kinetic energy (K,), J.

        where : as of `in_rows`.  references : there (..., R, K).
        """
        inertia = self.with_rotors(self.pose(where, self._of_rows(references)).inertia)
        doubled = np.einsum("ik,ijk,jk->k", where.speeds, inertia, where.speeds)
        return np.asarray(self.rows.total(doubled) / 2)


def _eliminated(left: Array, right: Array) -> Array:
    """Solutions (U, R, K) of few equations (U, U, K) for R right-hand sides (U, R, K) by
    elimination of all states at once, for which an inertia needs no search for pivots.
    """
    left, right = left.copy(), right.copy()
    count = len(left)
    for k in range(count - 1):
        share = left[k + 1 :, k] / left[k, k]
        left[k + 1 :] -= share[:, None] * left[k]
        right[k + 1 :] -= share[:, None] * right[k]
    for k in reversed(range(count)):
        for j in range(k + 1, count):
            right[k] -= left[k, j] * right[j]
        right[k] /= left[k, k]
    return right


class DrivesReadings(NamedTuple):
    """What else is known in K states.

    torques : of all drives (N, K), N m, and forces of strokes, N.  margins : (D, K) as of
    `DrivesEquation.margins`.  joint_rates : (J R, K) of joints with friction, rad/s or m/s.
    accelerations : of all coordinates of each row (C R, K), rad/s2 or m/s2.
    """

    torques: Array
    margins: Array
    joint_rates: Array
    accelerations: Array


class DrivesRates:
    """Rates of the state of a machine's drives.

    works : what has done work, by the order of the quadratures, after supply and heat of circuits.
    since : s, an instant after which loads over time follow the line that counts.
    settled : (J R,) as of `DrivesFriction.senses`.
    failure : why the last states could not be computed; None where they could.
    """

    def __init__(self, equation: DrivesEquation) -> None:
        self.equation, self.drivers = equation, equation.drivers()
        self.usual = abs(equation.machine.drive.speed) or 1.0
        self.circuits = [k for k, item in enumerate(self.drivers) if item.circuit is not None]
        self.lagging = [k for k in self.circuits if self.drivers[k].lags]
        self.rubbing = () if equation.friction is None else equation.friction.names
        self.turned = [
            k for k, drive in enumerate(equation.drives)
            if drive.motor is not None or k in equation.given
        ]  # fmt: skip
        self.braked = bool(self.drivers[0].brake) and 0 in equation.unknowns
        self.works = (
            *equation.acting,
            *(f"{FRICTION}.{name}" for name in self.rubbing),
            *([BRAKE] if self.braked else []),
            *(f"drives.{equation.drives[k].link}" for k in self.turned),
        )
        self.settled = np.zeros(len(self.rubbing) * equation.rows.count)
        self.since = 0.0
        self.failure: EquipoiseError | None = None

    @property
    def count(self) -> int:
        """How many unknowns there are."""
        return len(self.equation.unknowns)

    def where(self, time: Array, states: Array) -> DriveAngles:
        """All drives at times (K,), s, in states (n, K)."""
        count = self.count
        return self.equation.placed(time, states[:count], states[count : 2 * count])

    def current(self, drive: int, states: Array, where: DriveAngles) -> Array:
        """Current (K,) of the circuit of a drive, A."""
        if drive in self.lagging:
            return np.asarray(states[2 * self.count + self.lagging.index(drive)])
        return self.drivers[drive].current(where.speeds[drive])

    def sizes(self, energy: float) -> tuple[Array, Array]:
        """Usual sizes of a state (n,), and of quadratures (Q,), where energies are about so large,
        J.
        """
        rated = []
        for k in self.lagging:
            circuit = self.drivers[k].circuit
            assert circuit is not None
            rated.append(circuit.voltage / circuit.resistance)
        own = self.equation.sizes()
        states = np.array([*own, *own * self.usual, *rated])
        return states, np.full(2 * len(self.circuits) + len(self.works), energy)

    def others(self, rows: Array) -> DrivesReadings:
        """By the rows of `NodeValues.others` (O, K)."""
        drives = len(self.drivers)
        before = drives + len(self.equation.dead_positions)
        rubbing = before + len(self.settled)
        return DrivesReadings(
            rows[:drives], rows[drives:before], rows[before:rubbing], rows[rubbing:]
        )

    def at(self, time: Array, states: Array, references: References) -> NodeValues | None:
        """Rates in K states; None where the machine cannot be, or does not obey the laws."""
        self.failure = None
        with np.errstate(all="ignore"):  # of what is tried
            try:
                values = self._at(time, states, references)
            except EquipoiseError as error:
                self.failure = error
                return None
            except np.linalg.LinAlgError:
                return None
        return values if values is not None and np.all(np.isfinite(values.rates)) else None

    def _at(self, time: Array, states: Array, references: References) -> NodeValues | None:
        equation = self.equation
        where, rows = self.where(time, states), equation.rows
        state = equation.at(time, self.since, where, references)
        margins = equation.margins(state)
        if not np.all(margins >= 0):  # before friction, which would seem to lock such a machine
            return None
        torques = self._driving(time, where, states)
        total = torques.copy()
        if self.braked:
            braking = self._braking(where)
            total[0] += braking
        changes, efforts = equation.accelerations(state, total, self.settled)
        given_powers = self._give(torques, state, changes, efforts)
        rates = [*where.speeds[equation.free], *rows.first(changes[equation.free])]
        electric, works = [], [*np.einsum("snk,nk->sk", state.forces, state.where.speeds)]
        works = [*rows.total(np.array(works).reshape(-1, len(time) * rows.count))]
        for k in self.circuits:
            current = self.current(k, states, where)
            change, supply, heat = self.drivers[k].electric_rates(current, where.speeds[k])
            rates += [change] if k in self.lagging else []
            electric += [supply, heat]
        joint_rates = np.zeros((0, len(time)))
        if state.rubbing is not None:
            joint_rates = state.rubbing.rates
            works += [*np.add.reduceat(efforts * joint_rates, self._first_rows, axis=0)]
        works += [braking * where.speeds[0]] if self.braked else []
        works += [
            given_powers[k] if k in given_powers else torques[k] * where.speeds[k]
            for k in self.turned
        ]
        return NodeValues(
            np.array(np.broadcast_arrays(*rates)),
            np.array([*electric, *works]).reshape(-1, len(time)),
            np.concatenate(
                [
                    torques[: len(self.drivers)],
                    margins,
                    joint_rates,
                    changes.reshape(-1, len(time)),
                ]
            ),
            equation.references(state),
        )

    @property
    def _first_rows(self) -> list[int]:
        """Places of joints of the first row among those of all rows."""
        return [*range(0, len(self.settled), self.equation.rows.count)]

    def _give(
        self, torques: Array, state: DriveState, changes: Array, efforts: Array
    ) -> dict[int, Array]:
        """Set what drives of given motions exert on all rows, in torques (C, K) of all drives;
        the power of each (K,), W.
        """
        rows, given = self.equation.rows, self.equation.given
        if not given:
            return {}
        exerted = self.equation.given_efforts(state, changes, efforts)
        torques[[*given]] = rows.total(exerted)
        powers = rows.total(exerted * state.where.effort_speeds[[*given]])
        return dict(zip(given, powers, strict=True))

    def _driving(self, time: Array, where: DriveAngles, states: Array) -> Array:
        """Torques (N, K) of motors, N m; 0 of drives without one."""
        torques = np.zeros_like(where.speeds)
        for k, driver in enumerate(self.drivers):
            if driver.on:
                current = self.current(k, states, where)
                at = where.speeds[k], current, where.angles[k], time
                torques[k] = driver.driving_torque(*at)
        return torques

    def _braking(self, where: DriveAngles) -> Array:
        """Torque (K,) of the brake on the first drive, N m, which changes its sense smoothly."""
        speed, smoothing_speed = where.speeds[0], BRAKED * self.usual
        return np.asarray(
            -self.drivers[0].holding() * speed / np.sqrt(speed**2 + smoothing_speed**2)
        )
