"""The exact equations of a machine on a planar support, (37) to (45), and followed in time.

Free bodies added up by Lagrange's equations; `vibration.linkages` has the sums S, J, H, E.  With
Z the reference point, phi the support's rotation, theta the crank angle in the support's axes,
s = exp(i phi) S and likewise s', s'', of the linkages and the support together:

    m Z.. + i phi.. s + theta.. s' = F + phi.^2 s - 2 i phi. theta. s' - theta.^2 s''
    s x Z.. + J phi.. + H theta.. = M - J' theta. phi. - H' theta.^2
    s' . Z.. + H phi.. + E theta.. = T + g . s' - E' theta.^2 / 2 + J' phi.^2 / 2

F and M are weight, mounts and loads, T the drive's torque and that of loads and springs.  The
independent variable is the angle that the crank has turned, so that linkages are solved at the
nodes once and never in between.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cached_property
from math import copysign, floor, log10, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.reduced import differentiable_torque
from equipoise.mechanism.kinematics.jumps import jumps_of_rows
from equipoise.mechanism.parts.element_kinds import RatedElement, rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import PER_RPM, number
from equipoise.signals import Array, within_period
from equipoise.vibration.body import PITCH, MountContact, Rest, SupportBody, contacts_of
from equipoise.vibration.collocation import Rates
from equipoise.vibration.linkages import ReducedInertia, sums


class StallError(ResponseError):
    """A motor is too weak to turn the crank on."""

    usual_topic = "the-motor-stalls"


Torque = Callable[[Array, Array], Array]
"""Torque on the crank, N m, at its speed, rad/s, and a shift of the motor's speed, rad/s."""


@dataclass(frozen=True, eq=False)
class Coupled:
    """The equations of a machine on its support, or on solid ground, against the crank's turning.

    The independent variable s is the crank angle of a crank that turns counterclockwise, and its
    negative for one that turns clockwise: it grows with time.  States, in this order: free
    displacements (m, rad), their velocities, and with a motor the crank's speed (rad/s), the time
    (s), and the shift (rad/s) of the motor's curve.

    free : which of surge, heave and pitch.  torque : of the motor; None for a constant speed.
    loaded_at : speed of the crank, rad/s, of which soil and friction are; that above if None.
    """

    machine: Machine
    speed: float
    mass: float
    first: complex
    inertia: float
    reference: complex
    free: tuple[int, ...]
    contacts: tuple[MountContact, ...]
    torque: Torque | None = None
    loaded_at: float | None = None

    @classmethod
    def on_support(
        cls, body: SupportBody, rest: Rest, speed: float, torque: Torque | None = None
    ) -> Coupled:
        """On the support of the model."""
        return cls(body.machine, speed, *body.in_plane, contacts_of(body, rest), torque)

    @classmethod
    def on_ground(cls, machine: Machine, speed: float, torque: Torque) -> Coupled:
        """On a frame that stands still."""
        return cls(machine, speed, 0.0, 0j, 0.0, 0j, (), (), torque)

    @property
    def count(self) -> int:
        """Number of states."""
        return 2 * len(self.free) + (0 if self.torque is None else 3)

    @cached_property
    def jumps(self) -> Array:
        """Turnings (J,) of the crank in a cycle, rising, rad, at which forces in any row jump."""
        linkage = assemble(self.machine)
        period = 2 * pi * linkage.cycle.turns
        return np.sort(within_period(self.sense * jumps_of_rows(linkage), period))

    @cached_property
    def rated(self) -> list[RatedElement]:
        """Force elements whose forces depend on the crank's speed."""
        return [element for *_, element in rated_elements(self.machine)]

    @cached_property
    def gravity(self) -> Array:
        return np.array(self.machine.gravity)

    def rates(self, s: Array) -> Rates:
        """Derivatives of the states by s at s (P,)."""
        table = self.sums(self.sense * s)

        def rates(states: Array) -> Array:
            d = len(self.free)
            speed = self.crank_speed(states)
            accelerations = self.accelerations(table, states)
            parts = [*states[d : 2 * d], *accelerations[:d]]
            if self.torque is not None:
                parts += [accelerations[d], np.ones_like(speed), np.zeros_like(speed)]
            return np.stack([np.asarray(part / (self.sense * speed)) for part in parts])

        return rates

    @property
    def sense(self) -> float:
        """1 for a crank that turns counterclockwise, -1 for clockwise."""
        return copysign(1.0, self.speed)

    def sums(self, theta: Array) -> ReducedInertia:
        """The linkages at crank angles (P,), rad."""
        speed = self.speed if self.loaded_at is None else self.loaded_at
        return sums(self.machine, theta, self.reference, speed)

    def crank_speed(self, states: Array) -> Array:
        """rad/s, of states (n, ...)."""
        if self.torque is None:
            return np.full_like(states[0], self.speed)
        speed: Array = states[2 * len(self.free)]
        return speed

    def place_and_rate(self, states: Array) -> tuple[Array, Array]:
        """Displacements and velocities (3, ...) along surge, heave and pitch."""
        d, free = len(self.free), list(self.free)
        place, rate = np.zeros((2, 3, *states.shape[1:]), states.dtype)
        place[free], rate[free] = states[:d], states[d : 2 * d]
        return place, rate

    def accelerations(self, table: ReducedInertia, states: Array) -> Array:
        """Second derivatives by time of the free coordinates, and with a motor of the crank."""
        matrix, right = self._equations(table, states)
        keep = [*self.free, 3] if self.torque is not None else list(self.free)
        inner = np.moveaxis(matrix[np.ix_(keep, keep)], (0, 1), (-2, -1))
        solved = np.linalg.solve(inner, np.moveaxis(right[keep], 0, -1)[..., None])[..., 0]
        return np.moveaxis(solved, -1, 0)

    def drive_torque(self, table: ReducedInertia, states: Array) -> Array:
        """Torque (...) that the drive exerts on the cranks at states (n, ...), N m."""
        if self.torque is not None:
            d = 2 * len(self.free)
            return self.torque(states[d], states[d + 2])
        matrix, right = self._equations(table, states)
        accelerations = self.accelerations(table, states)
        needed: Array = -right[3]
        for k, place in enumerate(self.free):
            needed = needed + matrix[3, place] * accelerations[k]
        return needed

    def needed_torque(self, table: ReducedInertia, states: Array) -> Array:
        """Torque (...) that weight, loads and motion ask of the drive, N m, at states (n, ...) of a
        crank that neither speeds up nor slows down.
        """
        _, right = self._equations(table, states)
        return np.asarray(self.drive_torque(table, states) - right[3])

    def load_torque(self, table: ReducedInertia, speed: Array) -> Array:
        """Torque (...) of loads and force elements on the crank, N m, at its speed (...)."""
        if not table.ways:
            return np.asarray(table.load_torque + np.zeros_like(speed))
        columns = np.array(table.ways)
        return table.load_torque + differentiable_torque(self.rated, columns, speed)

    def _equations(self, table: ReducedInertia, states: Array) -> tuple[Array, Array]:
        """Matrix (4, 4, ...) and right-hand side (4, ...) for surge, heave, pitch and crank."""
        place, rate = self.place_and_rate(states)
        speed = self.crank_speed(states)
        c, s = np.cos(place[PITCH]), np.sin(place[PITCH])
        first = _turned(table.first + self.first, c, s)
        first_1, first_2 = _turned(table.first_1, c, s), _turned(table.first_2, c, s)
        load = _turned(table.load_force, c, s)
        mass, gx, gy = self.mass + table.mass, *self.gravity
        turning = rate[PITCH]
        zero = np.zeros_like(speed)
        inertia = zero + (table.inertia + self.inertia)
        matrix = np.array(
            [
                [zero + mass, zero, -first[1], first_1[0]],
                [zero, zero + mass, first[0], first_1[1]],
                [-first[1], first[0], inertia, zero + table.spin],
                [first_1[0], first_1[1], zero + table.spin, zero + table.drive],
            ]
        )
        forces = [
            mass * gx + load[0] + turning**2 * first[0] + 2 * turning * speed * first_1[1],
            mass * gy + load[1] + turning**2 * first[1] - 2 * turning * speed * first_1[0],
            first[0] * gy - first[1] * gx + table.load_moment - table.inertia_1 * speed * turning,
        ]
        changes = (*first_2, table.spin_1)
        forces = [force - speed**2 * change for force, change in zip(forces, changes, strict=True)]
        for contact in self.contacts:
            parts = contact.at.wrench(contact.force(place, rate), place)
            forces = [force + part for force, part in zip(forces, parts, strict=True)]
        crank = first_1[0] * gx + first_1[1] * gy + self.load_torque(table, speed)
        crank = crank + (table.inertia_1 * turning**2 - table.drive_1 * speed**2) / 2
        if self.torque is not None:
            d = 2 * len(self.free)
            crank = crank + self.torque(speed, states[d + 2])
        return matrix, np.array([*forces, crank])


def _turned(vector: Array, c: Array, s: Array) -> tuple[Array, Array]:
    """Components along x and y of a complex vector of the support's axes."""
    x, y = vector.real, vector.imag
    return c * x - s * y, s * x + c * y


KNOTS = 1440
"""Crank angles in a turn between which the linkages' sums are interpolated by cubic splines."""
MOST_EVALUATIONS, TO_SETTLE = 600_000, 60_000
"""Of the equations, in all; and for a guess."""
RELATIVE, ABSOLUTE = 1e-9, 1e-12
"""Tolerances over the states, and over the size of the machine."""
STALLS = to_say(
    "the motor stalls at crank angle {angle:.1f} deg: the crank needs {needed} N m to go "
    "on, and has {given} N m; give a stronger motor, a higher ratio or a larger flywheel"
)
STALLS_AT_LIMIT = to_say(
    "the motor stalls at crank angle {angle:.1f} deg: the crank has {given} N m, which just hold "
    "it there; give a stronger motor, a higher ratio or a larger flywheel"
)
STALLS_STARTING = to_say(
    "the motor stalls while it starts, at crank angle {angle:.1f} deg: the crank needs {needed} "
    "N m to go on, and has {given} N m; give a stronger motor or a higher ratio, or start it "
    "without the load"
)
STALLS_AT_REST = to_say(
    "the motor stalls at rest, at crank angle {angle:.1f} deg: the crank needs {needed} N m to "
    "start, and has {given} N m; give a stronger motor or a higher ratio"
)
STALLS_AT_REST_AT_LIMIT = to_say(
    "the motor stalls at rest, at crank angle {angle:.1f} deg: the crank has {given} N m, which "
    "just hold it there; give a stronger motor or a higher ratio"
)
STALLS_IN_THE_MEAN = to_say(
    "the motor stalls with any flywheel: in the mean the crank needs {needed} N m at {speed} rpm, "
    "and has {given} N m; give a stronger motor or a higher ratio"
)
SMALLEST_PLAIN = 1e-4
"""N m, below which torques are said with an exponent."""
STALL_DIGITS = range(4, 8)
"""Of both torques, the fewest in which they differ; beyond that the motor is at its limit."""
SETTLING_TURNS = 40
"""Turns after which a motion in time is taken to have settled, as far as it ever does."""
STANDSTILL = 1e-6
"""Speed backwards, over that of the file, at which a motor counts as stalled: above rounding."""


class CouplingTable:
    """The linkages' sums at any crank angle, one at a time, by periodic splines."""

    def __init__(self, system: Coupled) -> None:
        from scipy.interpolate import CubicSpline

        turns = assemble(system.machine).cycle.turns
        s = np.linspace(0.0, 2 * pi * turns, KNOTS * turns + 1)
        result = system.sums(s)
        self.mass = result.mass
        columns: list[Array] = []
        self.complex: list[bool] = []
        self.count = len(fields(ReducedInertia)) - 2
        own = (getattr(result, item.name) for item in fields(ReducedInertia)[1:-1])
        for each in (*own, *result.ways):
            values = np.broadcast_to(each, s.shape)
            self.complex.append(np.iscomplexobj(values))
            columns += [values.real, values.imag] if self.complex[-1] else [values]
        table = np.column_stack(columns)
        table[-1] = table[0]
        self._spline = CubicSpline(s, table, bc_type="periodic")

    def at(self, theta: float) -> ReducedInertia:
        values = iter(self._spline(theta).tolist())
        items = [
            np.array(complex(next(values), next(values)) if two else next(values))
            for two in self.complex
        ]
        parts: list[Any] = [*items[: self.count], (*items[self.count :],)]
        return ReducedInertia(self.mass, *parts)


def follow(
    system: Coupled,
    time: Array,
    begin: Array,
    shift: float = 0.0,
    evaluations: int = MOST_EVALUATIONS,
) -> Array:
    """States (D + D + 2, M) at times (M,): displacements, velocities, crank's speed and angle.

    Raises
    ------
    ResponseError : the motor stalls, the motion grows away, or following it takes too long.
    """
    from scipy.integrate import solve_ivp

    table = CouplingTable(system)
    d = len(system.free)
    left = evaluations

    def states(y: Array) -> Array:
        driven = [] if system.torque is None else [y[2 * d], 0.0, shift]
        return np.array([*y[: 2 * d], *driven])

    def goes_on(_: float, y: Array) -> float:
        return float(system.sense * y[2 * d] + STANDSTILL * abs(system.speed))

    goes_on.terminal, goes_on.direction = True, -1.0  # type: ignore[attr-defined]

    def rates(_: float, y: Array) -> Array:
        nonlocal left
        left -= 1
        if left < 0:
            raise ResponseError(
                Note(
                    "the motion over {time:g} s takes more than {evaluations} evaluations to "
                    "follow; give a shorter time, or softer mounts with less damping",
                    time=time[-1],
                    evaluations=evaluations,
                )
            )
        accelerations = system.accelerations(table.at(y[2 * d + 1]), states(y))
        spin_up = 0.0 if system.torque is None else accelerations[d]
        return np.array([*y[d : 2 * d], *accelerations[:d], spin_up, y[2 * d]])

    span = float(time[0]), float(time[-1])
    least = ABSOLUTE * float(size_of_bodies(system.machine))
    limits = {"rtol": RELATIVE, "atol": least, "max_step": 2 * pi / abs(system.speed) / 24}
    events = None if system.torque is None else goes_on
    done = solve_ivp(rates, span, begin, "DOP853", t_eval=time, events=events, **limits)
    if done.status == 1:
        last = done.y_events[0][0]
        raise StallError(_stalled(system, table.at(last[2 * d + 1]), states(last), last[-1]))
    if not done.success or not np.all(np.isfinite(done.y)):
        raise ResponseError(
            Note("the motion cannot be integrated beyond {t:g} s: it diverges", t=done.t[-1])
        )
    return np.asarray(done.y)


def _stalled(system: Coupled, table: ReducedInertia, states: Array, angle: float) -> Note:
    """Say where a motor stalls, and by how much it is too weak there."""
    needed, given = (
        float(system.sense * torque)
        for torque in (system.needed_torque(table, states), system.drive_torque(table, states))
    )
    return stall_note(float(np.degrees(angle) % 360), needed, given)


def stall_note(
    angle: float, needed: float, given: float, at_rest: bool = False, starting: bool = False
) -> Note:
    """Say that a motor stalls at a crank angle, deg, and the torques on the crank there, N m.

    at_rest : whether the crank has not moved before.
    starting : whether it began at rest and has made no turn yet.  What a flywheel gives there, the
        motor has given it before, so that a larger one takes the crank no further.
    """
    lacks, holds = (
        (STALLS_AT_REST, STALLS_AT_REST_AT_LIMIT) if at_rest else (STALLS, STALLS_AT_LIMIT)
    )
    if starting and not at_rest:
        lacks = STALLS_STARTING
    for digits in STALL_DIGITS:
        texts = _to_one_place(needed, given, digits)
        if needed > given and texts[0] != texts[1]:
            return Note(lacks, angle=angle, needed=texts[0], given=texts[1])
    return Note(holds, angle=angle, given=f"{given:.{STALL_DIGITS[0]}g}")


def _to_one_place(first: float, second: float, digits: int) -> tuple[str, str]:
    """Two numbers with as many decimals as give the larger so many digits."""
    largest = max(abs(first), abs(second))
    if not SMALLEST_PLAIN <= largest < 10.0**digits:
        return f"{first:.{digits}g}", f"{second:.{digits}g}"
    decimals = digits - 1 - floor(log10(largest))
    return f"{first:.{decimals}f}", f"{second:.{decimals}f}"


def mean_stall_note(needed: float, given: float, speed: float) -> Note:
    """Say that a motor is too weak in the mean over a cycle: the torques on the crank, N m, at the
    speed of the crank, rad/s, at which they differ least.
    """
    return Note(
        STALLS_IN_THE_MEAN,
        needed=number(needed),
        given=number(given),
        speed=number(speed / PER_RPM),
    )


def settled(system: Coupled, s: Array) -> Array:
    """States at crank angles s (M,) of the last cycle, after many turns from rest."""
    turns = assemble(system.machine).cycle.turns
    cycles = -(-SETTLING_TURNS // turns)
    start = 2 * pi * turns * cycles
    order = np.argsort(s)
    instants = (start + s[order]) / system.speed
    begin = np.zeros(2 * len(system.free) + 2)
    begin[-2] = system.speed
    states = follow(system, np.concatenate([[0.0], np.abs(instants)]), begin, 0.0, TO_SETTLE)
    values = np.empty((2 * len(system.free), len(s)))
    values[:, order] = states[: 2 * len(system.free), 1:]
    return values
