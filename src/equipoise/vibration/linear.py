"""Small motion: response, modes and resonances of a support under what linkages do to it by orders.

(K - (n w)^2 M + i n w C) q_n = W_n for every order n at the crank's speed w.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property, reduce
from math import copysign, pi, sqrt
from operator import add
from typing import ClassVar, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import cond, lstsq, svd
from equipoise.errors import ModelError, ResponseError
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.parts.machine import Drive, Machine
from equipoise.mechanism.parts.support import FREEDOMS
from equipoise.quantities import PER_RPM, Dimension, brief, format_quantity, number
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array, Periodic, highest_at
from equipoise.vibration.body import (
    Rest,
    SupportBody,
    at_rest,
    driven_away,
    gauges_of,
    unbounded_at,
)
from equipoise.vibration.excitation import SupportExcitation, WholeExcitation
from equipoise.vibration.linkages import rows_of
from equipoise.vibration.response import (
    DriveSignals,
    GaugeSignals,
    Mode,
    MountForce,
    Response,
    hand_vibration,
)

STILL = 1e-7
"""Share of the largest frequency below which a motion counts as free, without a spring."""


def find_modes(mass: Array, damping: Array, stiffness: Array) -> tuple[Mode, ...]:
    """Modes of M x'' + C x' + K x = 0, by frequency; overdamped and growing modes count twice.

    mass, damping, stiffness : (D, D).
    """
    count = len(mass)
    system = np.zeros((2 * count, 2 * count))
    system[:count, count:] = np.eye(count)
    system[count:, :count] = -np.linalg.solve(mass, stiffness)
    system[count:, count:] = -np.linalg.solve(mass, damping)
    values, vectors = np.linalg.eig(system)
    least = STILL * float(np.max(np.abs(values), initial=0.0))
    # A double zero eigenvalue, for rest and drift, has a single eigenvector; so free motions are
    # taken from the null space of the stiffness.
    _, sizes, shapes = svd(stiffness)
    free = sizes <= STILL**2 * np.max(sizes, initial=0.0)
    modes = [Mode(0j, _scaled(shape)) for shape in shapes[free].astype(complex)]
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value) > least and value.imag >= -STILL * abs(value):
            swinging = value.imag > STILL * abs(value)
            eigenvalue = complex(value if swinging else value.real)
            modes.append(Mode(eigenvalue, _scaled(vector[:count])))
    return tuple(sorted(modes, key=lambda mode: (mode.natural_frequency, mode.eigenvalue.real)))


def _scaled(shape: Array) -> Array:
    """The shape with its largest part 1."""
    largest = shape[highest_at(np.abs(shape), smooth=False)]
    return np.asarray(shape / largest) if largest else shape


OF_FREEDOMS: tuple[Dimension, ...] = (*("force",) * 3, *("torque",) * 3)
"""What holds the support in each of `FREEDOMS`."""
LEFT_OVER = 1e-3
"""Share of all loads up to which preloads hold the weight: they are rounded in a file."""
SINGULAR = 1e10
"""Condition of an order's equations above which it meets an undamped mode."""


# -- forced vibration ------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Linear:
    """The support with its linkages as a linear system; matrices (D, D) of the free coordinates."""

    excitation: SupportExcitation

    @classmethod
    def of(cls, machine: Machine) -> Linear:
        return cls(WholeExcitation(SupportBody(machine)))

    @property
    def body(self) -> SupportBody:
        return self.excitation.body

    @cached_property
    def rest(self) -> Rest:
        """What holds the machine in the drawn position."""
        return at_rest(self.body, self.excitation.weights)

    @cached_property
    def mass(self) -> Array:
        """Of the support and the linkages, kg, kg m and kg m2."""
        return self._free(self.body.mass + self.excitation.mass)

    @cached_property
    def damping(self) -> Array:
        """Of the mounts that carry something."""
        return self._free(self._of_mounts("damper"))

    @cached_property
    def stiffness(self) -> Array:
        """Of the mounts that carry something, of preloads and of weights."""
        return self._free(self._of_mounts("spring") + self.rest.stiffness)

    @property
    def unsettled(self) -> Iterator[Note]:
        """That preloads leave a part of the weight over, where they do."""
        weights = [force for force, _ in self.excitation.weights]
        loads = sum(float(np.linalg.norm(force)) for force in weights)
        loads += sum(map(abs, self.rest.preload.values()))
        reach = max(float(np.linalg.norm(at - self.body.reference)) for at in self._places)
        scale = loads * np.array([1.0, 1.0, 1.0, reach, reach, reach])
        parts = [
            Note(
                to_say("{size} in {coordinate}"),
                coordinate=Note(name),
                size=format_quantity(over, kind),
            )
            for name, over, kind, least in zip(
                FREEDOMS, self.rest.unbalance, OF_FREEDOMS, LEFT_OVER * scale, strict=True
            )
            if name in self.body.support.coordinates and abs(over) > least
        ]
        if parts:
            template = to_say(
                "the preloads do not balance the weight; {parts} remain. Modes and linear models "
                "are linearized about the drawn position, which is no equilibrium"
            )
            yield Note(template, parts=all_of(parts))

    @property
    def _places(self) -> list[Array]:
        """Where weights and mounts act, (3,) each."""
        mounts = self.body.support.mounts.values()
        points = [np.array(mount.point) for mount in mounts if mount.point is not None]
        return [*points, *(at for _, at in self.excitation.weights)]

    def _of_mounts(self, part: Literal["spring", "damper"]) -> Array:
        total = np.zeros((6, 6))
        for name, mount in self.body.support.mounts.items():
            if self.rest.carries(name, mount):
                row = self.body.row(mount)
                total += getattr(mount, part) * np.outer(row, row)
        return total

    def _free(self, matrix: Array) -> Array:
        return np.asarray(matrix[np.ix_(self.body.free, self.body.free)])

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Free vibration, by frequency."""
        return find_modes(self.mass, self.damping, self.stiffness)

    def wrench(self, speed: float) -> Periodic:
        """What excites the free coordinates (D, K + 1) at a speed, rad/s."""
        result = self.excitation.at(speed)
        amplitudes = result.amplitudes[self.body.free].copy()
        amplitudes[:, 0] += self.rest.unbalance[self.body.free]
        return Periodic(amplitudes, result.turns)

    def wrench_at(self, theta: Array, speed: float) -> Array:
        """Wrenches (D, P) at crank angles (P,), rad, not by orders."""
        sample = self.excitation.samples(theta, speed)[self.body.free]
        return np.asarray(sample + self.rest.unbalance[self.body.free, None])

    def motion(self, speed: float) -> Periodic:
        """Displacements of the free coordinates (D, K + 1), m and rad, at a speed, rad/s.

        Raises
        ------
        ModelError : a constant force drives the support away.
        ResponseError : a resonance without damping.
        """
        wrench = self.wrench(speed)
        frequency = wrench.orders * speed
        impedance = self.impedance(frequency)
        loads = wrench.amplitudes.T.copy()
        # A coordinate without a spring has no mean of its own; nothing must push it in the mean.
        mean = self._mean(loads[0].real)
        loads[0], impedance[0] = mean, np.eye(len(mean))
        if self._resonant(impedance, frequency):
            raise ResponseError(unbounded_at(speed))
        moved = np.linalg.solve(impedance, loads[..., None])[..., 0]
        return Periodic(moved.T, wrench.turns)

    def impedance(self, frequency: Array) -> Array:
        """Wrench for a unit of each displacement (F, D, D) at angular frequencies (F,), rad/s."""
        frequency = frequency[:, None, None]
        values: Array = self.stiffness - frequency**2 * self.mass + 1j * frequency * self.damping
        return values

    def _resonant(self, impedance: Array, frequency: Array) -> bool:
        """Whether an order meets an undamped mode, up to rounding."""
        inertia = frequency[:, None] ** 2 * np.diagonal(self.mass)
        size = np.abs(np.diagonal(self.stiffness)) + inertia
        size[0] = 1.0
        scaled = impedance / np.sqrt(size[:, :, None] * size[:, None, :])
        return bool(np.max(cond(scaled)) > SINGULAR)

    def _mean(self, load: Array) -> Array:
        scale = float(np.linalg.norm(self.excitation.weights[0][0])) + float(np.linalg.norm(load))
        mean = lstsq(self.stiffness, load, rcond=1e-12)[0]
        over = np.abs(self.stiffness @ mean - load) > 1e-9 * scale
        if np.any(over):
            raise ModelError("support.mounts", driven_away(self.body, over))
        return mean

    def seen_by(self, row: Array, moved: Periodic) -> Periodic:
        """What a row (6,) of the body reads off displacements (D, K + 1)."""
        return Periodic(row[self.body.free] @ moved.amplitudes, moved.turns)


# -- resonances ------------------------------------------------------------------------------------

QUIET = 1e-3
"""Share of the loudest resonance at every gauge below which a resonance is not listed."""
LOUD = 0.1
"""Share of the loudest resonance from which one matters to whoever chooses a speed."""
LEAST_DAMPING = 1e-4
"""Damping ratio below which modes are compared as if they had it."""
AMPLIFIED = 3.0
"""A speed is to be kept away from where the mode amplifies the order more often than this."""


@dataclass(frozen=True)
class Resonance:
    """One order that meets one mode.

    speed : of the crank, rad/s.  order : events in a turn.  mode : its number, from 1.
    frequency : of the mode, rad/s.
    share : amplitude at the gauge that this resonance shakes most, over the largest there.
    avoid : speeds between which the mode amplifies this order more than three times, the slower one
        first; None where its damping never lets it.
    """

    speed: float
    order: float
    mode: int
    frequency: float
    share: float
    avoid: tuple[float, float] | None

    @property
    def is_loud(self) -> bool:
        """Whether it matters to whoever chooses a speed."""
        return self.share >= LOUD

    declared: ClassVar[Declarations] = {
        "speed": ResultOutput("speed of the crank", "angular speed"),
        "order": ResultOutput("events in a turn"),
        "mode": ResultOutput("number of the mode, from 1"),
        "frequency": ResultOutput("natural frequency of the mode", "angular speed"),
        "share": ResultOutput("amplitude over that of the loudest resonance at a gauge"),
        "avoid": ResultOutput(
            "speeds between which the order is amplified more than three times, or null",
            "angular speed",
            read=lambda item: None if item.avoid is None else list(item.avoid),
        ),
    }


AROUND = (0.2, 2.0)
"""Ends of the range of speeds about one of the crank, over that."""


def around(drive: Drive, speed: float) -> tuple[float, float]:
    """Speeds (rad/s) about one of the crank, among them all at which the machine runs."""
    slow, fast = (share * speed for share in AROUND)
    for end in drive.speeds:
        slow, fast = (
            min(slow, copysign(end, speed), key=abs),
            max(fast, copysign(end, speed), key=abs),
        )
    return slow, fast


def nearest_loud(resonances: Iterable[Resonance], speed: float) -> Resonance:
    """Of the loud ones of some resonances the one whose speed is nearest to a speed, rad/s.

    One that shakes a few per cent of what the loudest does is no reason to change a speed, however
    near it is.
    """
    every = tuple(resonances)
    loud = [item for item in every if item.is_loud] or every
    return min(loud, key=lambda resonance: abs(abs(resonance.speed / speed) - 1))


def resonance_note(resonances: Iterable[Resonance], speed: float) -> Note:
    """The nearest loud resonance (speed in rad/s), and between which speeds it is to be avoided."""
    resonance = nearest_loud(resonances, speed)
    of_one = to_say(
        "the nearest loud resonance is at {speed} rpm, where order {order} meets mode {mode} "
        "({frequency} Hz); no speed about it has to be avoided"
    )
    avoided = to_say(
        "the nearest loud resonance is at {speed} rpm, where order {order} meets mode {mode} "
        "({frequency} Hz); keep away from {low} to {high} rpm"
    )
    low, high = sorted(map(abs, resonance.avoid or (0.0, 0.0)))
    return Note(
        of_one if resonance.avoid is None else avoided,
        speed=brief(abs(resonance.speed) / PER_RPM),
        order=f"{resonance.order:.4g}",
        mode=resonance.mode,
        frequency=brief(resonance.frequency / (2 * pi)),
        low=number(low / PER_RPM),
        high=number(high / PER_RPM),
    )


def within(resonances: Iterable[Resonance], speed: float) -> Iterator[Note]:
    """Which resonances amplify at a speed (rad/s) so much that it is to be kept away from."""
    for item in resonances:
        low, high = sorted(map(abs, item.avoid or (0.0, 0.0)))
        if low <= abs(speed) <= high and item.avoid is not None:
            template = to_say(
                "the crank turns at a speed that is to be avoided: between {low} and {high} rpm "
                "order {order} meets mode {mode} ({frequency} Hz), which amplifies it more than "
                "three times"
            )
            yield Note(
                template,
                low=brief(low / PER_RPM),
                high=brief(high / PER_RPM),
                order=f"{item.order:.4g}",
                mode=item.mode,
                frequency=brief(item.frequency / (2 * pi)),
            )


def warned(linear: Linear, speed: float) -> tuple[Note, ...]:
    """Warning of a resonance of a machine whose crank turns at a speed, rad/s."""
    turns = linear.excitation.motion.turns
    meets = False
    for mode in linear.modes:  # modes alone are tested first, which takes no time
        order = max(1, round(mode.natural_frequency / abs(speed) * turns)) / turns
        low, high = _avoid(mode.natural_frequency / order, mode) or (0.0, 0.0)
        meets = meets or low <= abs(speed) <= high
    if not meets:
        return ()
    drive = linear.body.machine.drive
    return tuple(within(resonances(linear, *around(drive, speed)), speed))


def resonances(linear: Linear, slowest: float, fastest: float) -> list[Resonance]:
    """Resonances between two speeds of the crank of the same sign, rad/s; the fastest first.

    Those whose order the linkages do not excite in that mode are left out.
    """
    parts: list[tuple[float, float, int, Mode]] = []
    low, high = sorted((abs(slowest), abs(fastest)))
    orders = linear.wrench(high).orders[1:]
    for place, mode in enumerate(linear.modes, 1):
        rate = mode.natural_frequency
        # The ends belong to the range, whatever rounding says.
        inside = (rate >= orders * low * (1 - 1e-12)) & (rate <= orders * high * (1 + 1e-12))
        parts += [
            (copysign(rate / order, fastest), order, place, mode)
            for order in map(float, orders[inside & mode.swings])
        ]
    loud = _loudness(linear, parts)
    return sorted(
        (
            Resonance(speed, order, place, mode.natural_frequency, share, _avoid(speed, mode))
            for (speed, order, place, mode), share in zip(parts, loud, strict=True)
            if share >= QUIET
        ),
        key=lambda resonance: -abs(resonance.speed),
    )


def _loudness(linear: Linear, resonances: list[tuple[float, float, int, Mode]]) -> list[float]:
    """Amplitude of each resonance at the gauge where it is loudest beside the others there."""
    rows = np.array([linear.body.row(g)[linear.body.free] for g in gauges_of(linear.body).values()])
    amplitudes = np.zeros((len(resonances), len(rows)))
    speeds, orders = (
        np.array([(speed, order) for speed, order, _, _ in resonances]).reshape(-1, 2).T
    )
    places = np.rint(orders * linear.excitation.motion.turns).astype(int)
    wrenches = linear.excitation.at_orders(speeds, places)[linear.body.free].T
    for k, (wrench, (_, _, _, mode)) in enumerate(zip(wrenches, resonances, strict=True)):
        force = abs(mode.shape @ wrench)
        inertia = abs(mode.shape @ linear.mass @ mode.shape)
        damping = max(abs(mode.damping_ratio), LEAST_DAMPING)
        size = force / (2 * damping * mode.natural_frequency**2 * inertia)
        amplitudes[k] = np.abs(rows @ mode.shape) * size
    largest = np.max(amplitudes, axis=0, initial=0.0)
    shares = np.divide(amplitudes, largest, out=np.zeros_like(amplitudes), where=largest > 0)
    return [float(share) for share in np.max(shares, axis=1, initial=0.0)]


def _avoid(speed: float, mode: Mode) -> tuple[float, float] | None:
    """Where (1 - r^2)^2 + (2 D r)^2 < 1 / amplified^2, with r the frequency over the mode's."""
    damping = mode.damping_ratio
    half = 1 - 2 * damping**2
    inner = half**2 - 1 + 1 / AMPLIFIED**2
    if inner <= 0 or half <= 0:
        return None
    low, high = half - sqrt(inner), half + sqrt(inner)
    return (speed * sqrt(max(low, 0.0)), speed * sqrt(high))


# -- what gauges read, and how mounts push ---------------------------------------------------------

GROWTH_ROUNDING = 1e-9
"""Growth of a mode, beside its frequency, up to which it is rounding."""


def respond_linear(linear: Linear, speed: float) -> Response:
    """Response of a linear step, by orders."""
    body = linear.body
    moved = linear.motion(speed)
    moving = moved.derivative() * speed
    mounts, notes = mount_forces(linear, moved, moving, speed)
    notes.extend(linear.unsettled)
    if any(
        mode.eigenvalue.real > GROWTH_ROUNDING * mode.natural_frequency for mode in linear.modes
    ):
        template = to_say("the support is unstable: the drawn position is no stable equilibrium")
        notes.append(Note(template))
    return Response(
        body.machine,
        linear.excitation.model,
        speed,
        moved.turns,
        gauge_signals(linear, (moved, moving, moving.derivative() * speed), speed),
        mounts,
        linear.modes,
        DriveSignals(_torque(linear, speed), grounded=(body.machine, speed)),
        notes=tuple(notes),
        motion=linear.body.whole(moved),
    )


def gauge_signals(
    linear: Linear, motion: tuple[Periodic, Periodic, Periodic], speed: float
) -> dict[str, GaugeSignals]:
    """What gauges read of displacements, velocities and accelerations (D, K + 1), at a speed of
    the crank, rad/s.
    """
    signals, body = {}, linear.body
    for name, gauge in gauges_of(linear.body).items():
        row = linear.body.row(gauge)
        moved, moving, change = (linear.seen_by(row, item) for item in motion)
        along = tuple(
            linear.seen_by(body.wrench(axis, gauge.point), motion[2])
            for axis in (() if gauge.exposure is None else np.eye(3))
        )
        hand = hand_vibration(along, speed, gauge.exposure)
        signals[name] = GaugeSignals(moved, moving, change, gauge.axis is not None, hand)
    return signals


def mount_forces(
    linear: Linear, moved: Periodic, moving: Periodic, speed: float
) -> tuple[dict[str, MountForce], list[Note]]:
    """Forces of the mounts at small displacements and velocities (D, K + 1); and what to say."""
    exciting = force_amplitudes(linear, speed)
    mounts, notes = {}, []
    for name, mount in linear.body.support.mounts.items():
        row, preload = linear.body.row(mount), linear.rest.preload[name]
        force = linear.seen_by(row, moved) * -mount.spring
        force = force + linear.seen_by(row, moving) * -mount.damper
        template = ""
        if not linear.rest.carries(name, mount):
            force, preload = force * 0.0, 0.0
            template = to_say("{name} has no contact at rest and is ignored")
        elif mount.one_sided and force.extreme(-1)[0] + preload < 0:
            template = to_say(
                "{name} would be in tension, which a one-sided mount cannot transmit; the exact "
                "model includes the loss of contact"
            )
        if template:
            notes.append(Note(template, name=name))
        hands_on = exciting if mount.axis is None else exciting[:0]
        mounts[name] = mount_force(force, preload, hands_on)
    return mounts, notes


def mount_force(varying: Periodic, preload: float, exciting: Array) -> MountForce:
    """A mount's whole force, and what it hands on of the force that excites, (K + 1,).

    exciting : amplitudes of that force; empty for a torsional mount, which hands on none.
    """
    amplitudes = varying.amplitudes.copy()
    amplitudes[0] += preload
    count = min(len(amplitudes), len(exciting))
    ratio = np.full(len(amplitudes), np.nan)
    loud = exciting[:count] > 1e-9 * np.max(exciting, initial=0.0)
    loud[:1] = False
    np.divide(np.abs(amplitudes[:count]), exciting[:count], out=ratio[:count], where=loud)
    whole = float(np.sqrt(np.sum(exciting[1:] ** 2) / 2))
    force = Periodic(amplitudes, varying.turns)
    handed_on = float(force.vibration_rms) / whole if whole else np.nan
    return MountForce(force, ratio, handed_on, torsional=not exciting.size)


def force_amplitudes(linear: Linear, speed: float) -> Array:
    """Amplitude (K + 1,) of the force of all linkages on the frame; 0 where they cancel."""
    signals = (linear.excitation.at(speed), linear.excitation.of_one(speed))
    sizes, single = (np.linalg.norm(signal.amplitudes[:3], axis=0) for signal in signals)
    machine = linear.body.machine
    own = machine.mass * size_of_bodies(machine) * speed**2
    top = max(float(np.max(single[1:], initial=0.0)), own)
    rounding = 1e-10 * len(rows_of(machine)) * top
    return np.where(sizes > rounding, sizes, 0.0)


def _torque(linear: Linear, speed: float) -> Periodic:
    """Torque on all cranks on solid ground."""
    motion = linear.excitation.motion.at(speed)
    periodic = motion.periodic(forces(motion).drive_torque)
    return reduce(add, (periodic.shifted(row.phase) for row in rows_of(linear.body.machine)))
