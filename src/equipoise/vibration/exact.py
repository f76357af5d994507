"""Exact response: the periodic solution of all equations, turned into signals.

Signals are sampled at equal steps of time, so that orders mean what they mean where the crank's
speed is constant.

Where mounts let go, a machine may have two steady states at one speed: run up slowly it stays on
one of them, run down on the other.  So a range of speeds is then gone through both ways, each speed
started from its neighbour.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property, partial
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.dynamics.reactions import JointReactions
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import FREEDOMS
from equipoise.results.analysis import analyze
from equipoise.results.result import ProgressCallback
from equipoise.signals import GAUSS_POINTS, Array, JumpSampling, Periodic, mean, smooth_tops
from equipoise.vibration.body import IN_PLANE, PITCH, Reading, SupportBody, gauges_of
from equipoise.vibration.coupled import TO_SETTLE, Coupled, StallError, follow, settled
from equipoise.vibration.linear import Linear, force_amplitudes, mount_force
from equipoise.vibration.linkages import BaseMotion, ReducedInertia, joint_forces, rows_of
from equipoise.vibration.response import (
    NEUTRAL,
    DriveSignals,
    Energy,
    GaugeSignals,
    Joint,
    MountForce,
    Response,
    hand_vibration,
    in_words,
    range_shown,
    swings_in_a_turn,
)
from equipoise.vibration.steady import (
    NO_STEADY_STATE,
    SAMPLES,
    Guess,
    Steady,
    conditions_of,
    equations,
    fastest,
    from_linear,
    motor_setting,
    steady,
    turns_of,
    with_motor,
)

STALLING_TURNS = 10
"""Cycles in which a motor has to stall, from the speed of its mean torque, if it does at all."""
LEANING = 10.0
"""deg: static rotation of the support from the drawn position, from which on a note reports it."""


def solve_exact(
    machine: Machine,
    speed: float,
    drive: bool,
    guess: Guess | None = None,
    patient: bool = True,
) -> ExactSolution:
    """The periodic solution itself.

    guess : states (n, M) against the crank's turning (M,), such as those at another speed, to start
        from; the linear response if None.
    patient : whether to follow the machine from rest where these lead nowhere, which takes seconds.

    Raises
    ------
    ResponseError : none was found, or none is near the drawn position.
    """
    system, linear = equations(machine, speed, drive)
    setting = motor_setting(machine, speed) if drive else None
    guesses: list[Guess] = [] if guess is None else [guess]
    guesses.append(partial(from_linear, system, linear, setting))
    if patient and setting is None:
        guesses.append(partial(settled, system))
    elif patient and linear is not None and setting is not None:
        guesses.append(partial(_at_constant_speed, machine, setting))
    swings = 0.0 if linear is None else swings_in_a_turn(linear.modes, speed)
    try:
        jumps = system.jumps
        result = steady(system, guesses, turns_of(machine), conditions_of(system), swings, jumps)
    except ResponseError as error:
        if setting is not None and patient:
            check_stall(system, setting, error)
        raise
    solution = ExactSolution(system, linear, result)
    if solution.toppled:
        raise ResponseError(NO_STEADY_STATE)
    return solution


def check_stall(system: Coupled, setting: tuple[float, float], error: ResponseError) -> None:
    """Follow a machine with a motor some turns from the speed that it would have in the mean.

    Raises
    ------
    ResponseError : the motor stalls.
    """
    speed, shift = setting
    begin = np.zeros(2 * len(system.free) + 2)
    begin[-2] = speed
    period = 2 * pi * turns_of(system.machine)
    time = np.linspace(0.0, STALLING_TURNS * period / abs(speed), 2)
    try:
        follow(system, time, begin, shift, TO_SETTLE)
    except StallError as stall:
        raise stall from error
    except ResponseError:  # too long to follow, which says nothing of the motor
        return


def _at_constant_speed(machine: Machine, setting: tuple[float, float], s: Array) -> Array:
    """States of a machine with a motor, from those at constant speed."""
    states = solve_exact(machine, setting[0], False).steady.orbit.at(s)
    return with_motor(states, setting, s)


@dataclass(frozen=True, eq=False)
class ExactSolution:
    """A periodic solution of the exact equations, read off at equal steps of time."""

    system: Coupled
    linear: Linear | None
    steady: Steady

    @property
    def machine(self) -> Machine:
        return self.system.machine

    @cached_property
    def turns(self) -> int:
        return turns_of(self.machine)

    @cached_property
    def multipliers(self) -> Array:
        """Of displacements, velocities and the crank's speed; the largest first."""
        count = 2 * len(self.system.free) + (self.system.torque is not None)
        return self.steady.multipliers(count)

    @property
    def lean(self) -> float:
        """Mean rotation of the support from the drawn position, deg."""
        return float(np.degrees(self.mean(self.base_motion.place[PITCH])))

    @property
    def toppled(self) -> bool:
        """Whether this is no state of the machine, but one balanced far from where it stands."""
        unstable = self.multipliers.size and abs(self.multipliers[0]) > 1 + NEUTRAL
        return bool(unstable) and abs(self.lean) > LEANING

    @cached_property
    def sampling(self) -> JumpSampling | None:
        """Instants that resolve what jumps, as angles of the mean speed; None where nothing does.

        Bends of load tables are left to the equal steps: the solution is smooth enough there.
        """
        jumps = self.system.jumps
        if not len(jumps):
            return None
        if self.system.torque is not None:
            orbit, time = self.steady.orbit, self.system.count - 2
            jumps = orbit.at(jumps)[time] * (2 * pi * self.turns / orbit.starts[time, -1])
        # every order counts: curves are drawn by them, and their derivatives taken
        return JumpSampling.of(self._steps, self.turns, jumps, steps=GAUSS_POINTS // 2)

    @property
    def _steps(self) -> Array:
        """Equal steps of time, as angles (M,) of the mean speed, rad."""
        return np.arange(SAMPLES * self.turns) * (2 * pi / SAMPLES)

    def mean(self, values: Array) -> Array:
        """Mean (...) over time of values (..., N) at the instants."""
        return mean(values, None if self.sampling is None else self.sampling.shares)

    @cached_property
    def turned(self) -> Array:
        """Angle (N,) by which the crank has turned at equal steps of time, and at those instants
        that resolve jumps, rad.
        """
        s = self._steps if self.sampling is None else self.sampling.crank_angle
        if self.system.torque is None:
            return s
        time = self.system.count - 2
        orbit = self.steady.orbit
        wanted = s * (orbit.starts[time, -1] / (2 * pi * self.turns))
        s = np.interp(wanted, orbit.starts[time], orbit.points)
        for _ in range(8):
            states = orbit.at(s)
            s = s - (states[time] - wanted) * np.abs(self.system.crank_speed(states))
        return np.asarray(s)

    @property
    def crank_angle(self) -> Array:
        """(N,) at those instants, rad."""
        return self.system.sense * self.turned

    @cached_property
    def states(self) -> Array:
        """(n, N) at those instants."""
        return np.asarray(self.steady.orbit.at(self.turned))

    @cached_property
    def sums(self) -> ReducedInertia:
        return self.system.sums(self.crank_angle)

    @cached_property
    def base_motion(self) -> BaseMotion:
        """Motion of support and crank at those instants."""
        system, states = self.system, self.states
        place, rate = system.place_and_rate(states)
        accelerations = system.accelerations(self.sums, states)
        change = np.zeros_like(place)
        change[list(system.free)] = accelerations[: len(system.free)]
        spin_up = np.zeros(len(self.crank_angle)) if system.torque is None else accelerations[-1]
        speed = system.crank_speed(states)
        return BaseMotion(place, rate, change, self.crank_angle, speed, spin_up, system.reference)

    @cached_property
    def passes(self) -> tuple[JointReactions, ...]:
        """Joint forces of every row, in the support's axes."""
        return tuple(
            joint_forces(self.machine, self.base_motion, row.phase, complex(*row.offset))
            for row in rows_of(self.machine)
        )

    @property
    def speed(self) -> float:
        """Mean speed of the crank, rad/s."""
        if self.system.torque is None:
            return self.system.speed
        period = self.steady.orbit.starts[self.system.count - 2, -1]
        return float(self.system.sense * 2 * pi * self.turns / period)

    def signal(self, samples: Array) -> Periodic:
        """Of samples (..., N) at those instants: by the crank angle of a constant mean speed."""
        backwards = self.system.sense < 0
        if self.sampling is not None:
            periodic = self.sampling.periodic(samples)
            return Periodic(periodic.amplitudes.conj(), self.turns) if backwards else periodic
        samples = np.roll(samples[..., ::-1], 1, axis=-1) if backwards else samples
        return Periodic.of(samples, self.turns)

    def response(self, brief: bool = False) -> Response:
        """The response of this steady state; `brief` leaves out the joint forces."""
        return Response(
            self.machine,
            "exact",
            self.speed,
            self.turns,
            {} if self.linear is None else self._gauges(self.linear.body),
            self._mounts(),
            () if self.linear is None else self.linear.modes,
            self._drive(),
            {} if brief else self._joints(),
            self.steady.residual,
            self.multipliers,
            self.energy(),
            tuple(self._notes()),
            None if self.linear is None else self._motion(),
        )

    def _motion(self) -> Periodic:
        """Of the support, all six coordinates."""
        place = np.zeros((len(FREEDOMS), len(self.crank_angle)))
        place[list(IN_PLANE)] = self.base_motion.place
        return self.signal(place)

    def _notes(self) -> Iterator[Note]:
        """What a reader has to know of the solution."""
        yield from in_words(self.multipliers)
        motor = self.machine.drive.motor
        if self.system.torque is not None and motor is not None:
            shift, own = float(self.states[-1, 0]), fastest(motor)
            if abs(shift) > own:
                template = to_say(
                    "to hold the mean speed, the motor's curve is shifted by {shift} rad/s, more "
                    "than its own {own} rad/s: it is too weak or slow for this machine"
                )
                yield Note(template, shift=f"{shift:.4g}", own=f"{own:.4g}")
        if abs(self.lean) > LEANING:
            template = to_say(
                "the mean position of the support is tilted by {angle} deg from the drawn position"
            )
            yield Note(template, angle=f"{self.lean:.1f}")

    def _gauges(self, body: SupportBody) -> dict[str, GaugeSignals]:
        base = self.base_motion
        gauge_signals = {}
        for name, gauge in gauges_of(body).items():
            at = Reading.of(body, gauge)
            along = tuple(
                self.signal(axis.acceleration(base.place, base.rate, base.change))
                for axis in (() if gauge.exposure is None else map(at.in_direction, (0.0, pi / 2)))
            )
            gauge_signals[name] = GaugeSignals(
                self.signal(at.displacement(base.place)),
                self.signal(at.velocity(base.place, base.rate)),
                self.signal(at.acceleration(base.place, base.rate, base.change)),
                gauge.axis is not None,
                hand_vibration(along, self.speed, gauge.exposure),
            )
        return gauge_signals

    def _mounts(self) -> Mapping[str, MountForce]:
        if self.linear is None:
            return {}
        exciting = force_amplitudes(self.linear, self.speed)
        mount_forces = {}
        for contact in self.system.contacts:
            force = contact.force(self.base_motion.place, self.base_motion.rate)
            hands_on = exciting if contact.at.along is not None else exciting[:0]
            mount = mount_force(self.signal(force), 0.0, hands_on)
            if contact.one_sided:
                mount = replace(mount, lifts_off=float(self.mean(force <= 0)), least=0.0)
            mount_forces[contact.name] = mount
        return mount_forces

    def _drive(self) -> DriveSignals:
        torque = self.signal(self.system.drive_torque(self.sums, self.states))
        if self.system.torque is None:
            return DriveSignals(torque)
        speed = self.signal(self.system.crank_speed(self.states))
        return DriveSignals(torque, speed, float(self.states[-1, 0]))

    def _joints(self) -> dict[str, Joint]:
        """Of the first row, beside the same joints on solid ground at a constant speed."""
        here = self.passes[0]
        ground = analyze(self.machine, speed=self.speed, acceleration=0.0).resolved
        still, figures = ground.forces.solved.contacts, ground.motion.figures
        sizes = np.array([joint.size for joint in here.contacts.values()])
        period = 2 * pi * self.turns
        peaks, _ = (
            smooth_tops(period, sizes) if self.sampling is None else self.sampling.tops(sizes)
        )
        return {
            name: Joint(float(peak), figures(still[name].size).peak)
            for name, peak in zip(here.contacts, peaks, strict=True)
        }

    def energy(self) -> Energy:
        """Work over a period, by the quadrature of the solution itself."""
        system, orbit = self.system, self.steady.orbit
        states = orbit.states.reshape(system.count, -1)
        table = system.sums(system.sense * orbit.nodes.ravel())
        place, rate = system.place_and_rate(states)
        speed = system.crank_speed(states)
        # power of the drive, of loads from outside and of springs, W
        force = table.load_force * np.exp(1j * place[PITCH])
        carried = force.real * rate[0] + force.imag * rate[1] + table.load_moment * rate[PITCH]
        turning = system.load_torque(table, speed)
        fed = system.drive_torque(table, states) * speed + (carried + turning * speed)
        lost = np.zeros_like(speed)
        for contact in system.contacts:
            lost -= contact.force(place, rate) * contact.at.velocity(place, rate)
        powers = (power / np.abs(speed) for power in (fed, lost))
        return Energy(*(orbit.integral(power.reshape(orbit.nodes.shape)) for power in powers))


# -- along a range of speeds -----------------------------------------------------------------------


Responses = list[Response | None]


APPROACHES = ((1.0,), (0.8, 0.84, 0.88, 0.92, 0.96, 1.0), (1.2, 1.16, 1.12, 1.08, 1.04, 1.0))
"""Shares of a speed through which it is come to: at once, from below and from above."""


DIFFERENT = 1e-3
"""Share by which two steady states differ at least at some gauge."""


def follow_speeds(
    machine: Machine, speeds: list[float], drive: bool, progress: ProgressCallback
) -> tuple[Responses, list[str]]:
    """Response at every speed, the louder one where there are two; and what to say of that."""
    count = len(speeds)
    upward = _along(machine, speeds, drive, lambda done: progress(done, count))
    if all(
        answer is not None and not any(mount.lifts_off for mount in answer.mounts.values())
        for answer in upward
    ):
        return upward, []
    downward = _along(machine, speeds[::-1], drive, lambda done: progress(count + done, 2 * count))
    louder: Responses = []
    both: dict[float, float] = {}  # speeds with two states, and how much less one of them shakes
    for speed, up, down in zip(speeds, upward, downward[::-1], strict=True):
        ratio = _ratio(up, down)
        result = down if up is None or (down is not None and ratio > 1) else up
        louder.append(result or _patiently(machine, speed, drive))
        if abs(ratio - 1) > DIFFERENT:
            both[speed] = min(ratio, 1 / ratio)
    if not both:
        return louder, []
    return louder, [
        Note(
            "two steady states at {number} of {count} speeds, {speeds}; the larger one is "
            "reported, the other is down to {share} % of it",
            number=len(both),
            count=count,
            speeds=range_shown([*both]),
            share=f"{100 * min(both.values()):.0f}",
        )
    ]


def respond_exact(machine: Machine, speed: float, drive: bool) -> Response:
    """Response by the exact equations; where mounts let go, the louder of what may be two.

    Raises
    ------
    ResponseError : no steady state was found.
    """
    support = machine.support
    if support is None or not any(mount.one_sided for mount in support.mounts.values()):
        return solve_exact(machine, speed, drive).response()
    responses: list[Response] = []
    for reach in APPROACHES:
        speeds = [speed * share for share in reach]
        last = _along(machine, speeds, drive, lambda done: None, brief=False)[-1]
        if last is not None and all(
            abs(_ratio(last, other) - 1) > DIFFERENT for other in responses
        ):
            responses.append(last)
    if not responses:
        return solve_exact(machine, speed, drive).response()

    def loudness(answer: Response) -> float:
        return sum(float(gauge.displacement.peak_to_peak) for gauge in answer.gauges.values())

    louder = max(responses, key=loudness)
    template = to_say(
        "another steady state exists at this speed, with {share} % of this vibration; which one "
        "occurs depends on the preceding speeds"
    )
    shares = (100 * _ratio(louder, other) for other in responses if other is not louder)
    notes = (Note(template, share=f"{share:.0f}") for share in shares)
    return replace(louder, notes=(*louder.notes, *notes))


def _along(
    machine: Machine,
    speeds: list[float],
    drive: bool,
    progress: Callable[[int], None],
    brief: bool = True,
) -> Responses:
    """Response at every speed, one after the other; None where no steady state was found."""
    answers: Responses = []
    guess = None
    for speed in speeds:
        try:
            exact_solution = solve_exact(machine, speed, drive, guess, patient=False)
        except ResponseError:
            guess = None
            answers.append(None)
        else:
            guess = exact_solution.steady.orbit.at
            answers.append(exact_solution.response(brief))
        progress(len(answers))
    return answers


def _patiently(machine: Machine, speed: float, drive: bool) -> Response | None:
    """Response at a speed at which neither neighbour nor small motion leads to one."""
    try:
        return solve_exact(machine, speed, drive).response(brief=True)
    except ResponseError:
        return None


def _ratio(first: Response | None, second: Response | None) -> float:
    """How much more the second shakes, at the gauge where they differ most."""
    if first is None or second is None:
        return 1.0
    ratios = [1.0]
    for name, gauge in first.gauges.items():
        before = float(gauge.displacement.peak_to_peak)
        after = float(second.gauges[name].displacement.peak_to_peak)
        if before > 0 and after > 0:
            ratios.append(after / before)
    return max(ratios, key=lambda ratio: max(ratio, 1 / ratio))
