"""A machine that is set in motion by its motor, its weight, springs and loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import pairwise
from math import ceil, copysign, inf, pi
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.force_kinds import rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.run_plans import MOST_TURNS, RunPlan
from equipoise.quantities import Dimension, in_si
from equipoise.results.result import Result
from equipoise.running.drive_angles import drives_at
from equipoise.running.drivers import Driver
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.drives_run import DrivesRun, Start, run_drives
from equipoise.running.electric import Electric
from equipoise.running.energy_balance import energy_error, losses_apart
from equipoise.running.equation import CrankEquation
from equipoise.running.flywheel import Flywheel, share_of_mean, size_flywheel
from equipoise.running.integration import Event, Integration, Limits
from equipoise.running.joint_forces import Passage, passage_of_crank
from equipoise.running.piece_motion import ELECTRIC, Instant
from equipoise.running.run_contacts import (
    RunContact,
    contacts_of_couplings,
    contacts_of_elements,
)
from equipoise.running.sources import LOADS
from equipoise.running.support_equation import SupportedEquation
from equipoise.signals import Array
from equipoise.vibration.linkages import rows_of

TURNS = 300
"""Turns after which a run ends where nothing else ends it."""
TURNS_OF_DRIVES = 30
"""The same of several drives, each turn of which takes longer to follow; two motors of their own
speeds never come to a steady state."""
STARTED = 0.95
"""Share of the mean speed of a steady state at which a machine has started."""
BRAKE, DRIVE = "brake", "drive"
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class LastCycle:
    """The last whole cycle of a run.

    mean_speed : of the crank, rad/s, positive counterclockwise.  highest, lowest : its fastest and
        slowest, rad/s, with the same sign; of a crank that turns clockwise `highest` is the least.
    turns : of the crank in the cycle.
    energy : that the drive gives in it, J.  time : that it takes, s.
    """

    mean_speed: float
    highest: float
    lowest: float
    turns: int
    energy: float
    time: float

    @property
    def fluctuation(self) -> float:
        """Coefficient of fluctuation: highest minus lowest speed, over the mean."""
        return (self.highest - self.lowest) / self.mean_speed

    @property
    def energy_per_turn(self) -> float:
        """Energy that the drive gives in a turn of the crank, J."""
        return self.energy / self.turns

    @property
    def power(self) -> float:
        """Mean power of the drive, W."""
        return self.energy / self.time


@dataclass(frozen=True, eq=False, repr=False)
class Run(Result):
    """How a machine runs from a start on, at M instants that are not equally spaced.

    time : (M,) s, rising.  crank_angle, crank_speed : (M,), rad and rad/s.
    drive_torque : (M,), on the crank, N m.
    work : what has acted -> work on the machine since the start (M,), J; the drive last.
    events : what happened; the last one ended the run.
    begins : instants at which a cycle began.
    flywheel : the one that a wanted fluctuation needs, where it is asked for.
    electric : circuit of a direct-current motor; None of any other.
    losses : joint with friction -> energy lost in it since the start (M,), J.
    """

    machine: Machine
    equation: CrankEquation
    time: Array
    crank_angle: Array
    crank_speed: Array
    drive_torque: Array
    work: Mapping[str, Array]
    events: tuple[Event, ...]
    begins: tuple[Instant, ...]
    flywheel: Flywheel | None = None
    electric: Electric | None = None
    losses: Mapping[str, Array] = field(default_factory=dict)
    blocks_in = "running.blocks.run_blocks"
    pictures_in = "figures.running.run_charts"
    headline_in: ClassVar[str] = "running.blocks.run_headline"

    @property
    def end(self) -> Event:
        """What ended the run."""
        return self.events[-1]

    @property
    def turned(self) -> float:
        """Turns of the crank from the start to the end."""
        return float(self.crank_angle[-1] - self.crank_angle[0]) / (2 * pi)

    @cached_property
    def kinetic_energy(self) -> Array:
        """(M,), J, from the linkage itself and not from what was integrated."""
        return self.equation.energy(self.crank_angle, self.crank_speed)

    @cached_property
    def energy_error(self) -> float:
        """Largest difference of kinetic energy and work done, over the largest of them all."""
        circuits: list[tuple[Driver, Electric, Array]] = []
        if self.electric is not None:
            circuits = [(Driver.of(self.machine), self.electric, self.work[DRIVE])]
        return energy_error(self.kinetic_energy, self.work.values(), circuits)

    @cached_property
    def contacts(self) -> tuple[RunContact, ...]:
        """Contacts of one-sided parts in all rows, in the order in which they begin."""
        contacts = [*contacts_of_couplings(self._passage)]
        if any(element.one_sided for *_, element in rated_elements(self.machine)):
            angles = (self.crank_angle + row.phase for row in rows_of(self.machine))
            motions = [move(self.machine, angle) for angle in angles]
            contacts += contacts_of_elements(motions, self.time, self.crank_speed)
        return tuple(sorted(contacts, key=lambda contact: contact.begin))

    @property
    def _passage(self) -> Passage:
        """The states that it has passed."""
        off = next((event.time for event in self.events if event.kind == "off"), 0.0)
        is_off = self.machine.drive.motor is None or off > 0
        braked = np.sign(self.crank_speed) * self.machine.drive.brake * is_off * (self.time >= off)
        machine, time = self.machine, self.time
        return passage_of_crank(
            machine, time, self.crank_angle, self.crank_speed, self.drive_torque - braked
        )

    @cached_property
    def last_cycle(self) -> LastCycle | None:
        """The last whole cycle; None where there was none."""
        whole = [
            (first, last, turns)
            for first, last in pairwise(self.begins)
            if (
                turns := round(abs(last.angle - first.angle) / (2 * pi))
            )  # 0 of a crank that swings
        ]
        if not whole:
            return None
        first, last, turns = whole[-1]
        inside = (self.time >= first.time) & (self.time <= last.time)
        size, time = np.abs(self.crank_speed[inside]), last.time - first.time
        sense = copysign(1.0, last.angle - first.angle)
        return LastCycle(
            (last.angle - first.angle) / time,
            sense * float(np.max(size)),
            sense * float(np.min(size)),
            turns,
            float(last.work[-1] - first.work[-1]),
            time,
        )

    @cached_property
    def starting_time(self) -> float | None:
        """Until the speed first reaches 95 % of its mean in the steady state, s; None without one,
        where it began so fast, or where loads drive it backwards.
        """
        cycle = self.last_cycle
        if self.end.kind != "steady" or cycle is None or self.driven_back is not None:
            return None
        fast = np.abs(self.crank_speed) >= STARTED * abs(cycle.mean_speed)
        k = int(np.argmax(fast))
        if k == 0:
            return None
        ends = np.abs(self.crank_speed[k - 1 : k + 1])
        share = (STARTED * abs(cycle.mean_speed) - ends[0]) / (ends[1] - ends[0])
        return float(self.time[k - 1] + share * (self.time[k] - self.time[k - 1]))

    @cached_property
    def driven_back(self) -> Event | None:
        """Where the crank turned back for good, against the sense of its drive, and loads have
        driven it since; None where they have not.

        A load over the crank angle gives energy where the machine passes it backwards.
        """
        back = next((event for event in self.events[::-1] if event.kind == "reversal"), None)
        loads = self.work.get(LOADS)
        if back is None or loads is None or self.end.kind not in ("steady", "turns", "time"):
            return None
        if self.end.speed * self.machine.drive.speed >= 0:
            return None
        return back if loads[-1] > np.interp(back.time, self.time, loads) else None

    @cached_property
    def stopping(self) -> tuple[float, float] | None:
        """Time, s, and turns of the crank, forward less back, from when the motor is switched off
        to a standstill; None where either does not happen.
        """
        off = next((event for event in self.events if event.kind == "off"), None)
        if off is None or self.end.kind != "standstill":
            return None
        turned = (self.end.crank_angle - off.crank_angle) / (2 * pi)
        return self.end.time - off.time, turned * copysign(1.0, off.speed)

    @cached_property
    def lacking_torque(self) -> tuple[float, float] | None:
        """Where a motor stalls: torque that the crank needs to go on, and that the motor gives,
        N m; None where it does not.
        """
        if self.end.kind != "stall":
            return None
        driver = Driver.of(self.machine)
        acting, holding = self.equation.at_rest(
            self.end.crank_angle, self.equation.factors_at(self.end.time, self.end.time)
        )
        given = float(driver.torque(np.zeros(())))
        return holding[driver.sense] - driver.sense * acting, driver.sense * given

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (M,) of every signal."""
        return [
            ("time", "s", self.time),
            ("crank_angle", "rad", self.crank_angle),
            ("crank_speed", "rad/s", self.crank_speed),
            ("drive_torque", "N m", self.drive_torque),
            ("kinetic_energy", "J", self.kinetic_energy),
            *((f"work.{name}", "J", values) for name, values in self.work.items()),
            *((f"losses.{name}", "J", values) for name, values in self.losses.items()),
            *(() if self.electric is None else self.electric.columns()),
        ]

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units."""
        cycle, lacking, stopping = self.last_cycle, self.lacking_torque, self.stopping
        return {
            "title": self.machine.title,
            "end": self.end.kind,
            "turns": self.turned,
            "starting_time": self.starting_time,
            "last_cycle": None
            if cycle is None
            else vars(cycle)
            | {
                "fluctuation": cycle.fluctuation,
                "energy_per_turn": cycle.energy_per_turn,
                "power": cycle.power,
            },
            "stall": None
            if lacking is None
            else {"torque_needed": lacking[0], "torque_given": lacking[1]},
            "stopping": None if stopping is None else {"time": stopping[0], "turns": stopping[1]},
            "flywheel": None if self.flywheel is None else self.flywheel.to_dict(),
            "energy_error": self.energy_error,
            "events": [vars(event) for event in self.events],
            "contacts": [contact.to_dict() for contact in self.contacts],
            "time": self.time,
            "crank_angle": self.crank_angle,
            "crank_speed": self.crank_speed,
            "drive_torque": self.drive_torque,
            "kinetic_energy": self.kinetic_energy,
            "work": dict(self.work),
            "losses": dict(self.losses),
            **({} if self.electric is None else {"electric": dict(vars(self.electric))}),
        }


def _check_turns(turns: float | None) -> None:
    if turns is not None and turns > MOST_TURNS:
        raise UsageError(
            Note(
                "got {turns!r} for turns; give at most {most_turns}",
                turns=turns,
                most_turns=MOST_TURNS,
            )
        )


def _positive(name: str, value: float | str | None) -> float:
    """The size of a limit of a run, in SI units; endless where none is given."""
    dimensions: dict[str, Dimension] = {"duration": "time", "off": "time"}
    number = in_si(value, dimensions[name], name) if name in dimensions else value
    if number is not None and not 0 < float(number) < inf:
        raise UsageError(
            Note(
                "got {value!r} for {name}; give a finite number of more than 0",
                value=value,
                name=name,
            )
        )
    return inf if number is None else float(number)


def run(
    machine: Machine,
    duration: float | str | None = None,
    *,
    turns: float | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    off: float | str | None = None,
    off_turns: float | None = None,
    fluctuation: float | str | None = None,
    support: bool | None = None,
    progress: Progress | None = None,
) -> Run | DrivesRun:
    """Let a machine run: its crank follows from motor, weight, springs and loads.

    Of a machine with several drives, those with a motor, and those that are free, follow from
    torques, and the others have the motion that is given; the result is a `DrivesRun`, and so it is
    of a machine on its support.

    The motor's curve holds as it is, whatever its `mean_speed`.  What is not given is that of the
    machine's `run`, where it has one; `duration` and `turns` replace its end, `off` and `off_turns`
    its switching off, each pair together.

    Parameters
    ----------
    duration : s, or a text such as ``"2 s"``; where neither it nor `turns` is given the run ends in
        a steady state, in a standstill, or after 300 turns; of several drives after 30 turns, or
        the time that these take at the drive's speed.
    turns : of the crank, after which the run ends.
    speed : of the crank at the start, rad/s, or a text such as ``"300 rpm"``; 0 with a motor, that
        of the drive without one, where not given.
    angle : crank angle at the start, rad, or a text; 0 where not given.
    off : time at which the motor is switched off, s, or a text.
    off_turns : turns of the crank from the start after which it is.
    fluctuation : highest less lowest speed over the mean for which a flywheel is sized; a share of
        1, or a text such as ``"2 %"``.
    support : whether the support moves too, from rest in the drawn position; else the frame is
        fixed.
    progress : called with the turns of the crank that were followed, and the most there can be; not
        where only a time, or less than a turn, ends the run.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the crank cannot turn fully.
    ModelError : with `support`, there is none, or its mounts do not hold the machine.
    UsageError : a value cannot be used, or `fluctuation` is given of a machine that is not driven
        by one crank, or whose support leaves the plane.
    ResponseError : the motion cannot be followed.
    """
    plan = machine.run or RunPlan()
    if duration is None and turns is None:
        duration, turns = plan.duration, plan.turns
    if off is None and off_turns is None:
        off, off_turns = plan.off, plan.off_turns
    speed = plan.speed if speed is None else speed
    angle = plan.angle if angle is None else angle
    limits = _limits(machine, {"duration": duration, "turns": turns, "off": off,
                               "off_turns": off_turns})  # fmt: skip
    on_support = plan.support if support is None else support
    if on_support or not machine.has_crank:
        wheel = None
        if fluctuation is not None:
            wheel = size_flywheel(machine, share_of_mean(fluctuation), progress, support=True)
        limits = _limits_of_drives(machine, limits)
        start = _start(machine.drive.speed, speed, angle)
        equation = (SupportedEquation if on_support else DrivesEquation)(machine, start[1])
        starts = _start_of_drives(machine, start, _turns_counted(limits, progress), speed is None)
        return replace(run_drives(equation, limits, starts), flywheel=wheel)
    whole_turns = _turns_counted(limits, progress)
    first = 0.0 if machine.drive.motor is not None else machine.drive.speed
    start = _start(first, speed, angle)
    wanted = None if fluctuation is None else share_of_mean(fluctuation)
    crank, driver = CrankEquation(machine), Driver.of(machine)
    integration = Integration(crank, driver, limits)
    integration.on_turns = whole_turns
    integration.follow(start[1], start[0])
    flywheel = None if wanted is None else size_flywheel(machine, wanted, progress)
    return _result(crank, integration, flywheel)


def _limits(machine: Machine, given: Mapping[str, float | str | None]) -> Limits:
    """Where a run ends, by what is given of it."""
    sizes = {name: _positive(name, value) for name, value in given.items()}
    _check_turns(given["turns"])  # type: ignore[arg-type]
    switched_off = given["off"] is not None or given["off_turns"] is not None
    if switched_off and not any(drive.motor for drive in machine.driven):
        raise UsageError(
            at_place("drive.motor", Note("missing; without a motor there is nothing to switch off"))
        )
    free = min(sizes["duration"], sizes["turns"]) == inf
    return Limits(
        sizes["duration"],
        TURNS if free else sizes["turns"],
        sizes["off"],
        sizes["off_turns"],
        steady=free,
    )


def _start(usual: float, speed: float | str | None, angle: float | str | None) -> list[float]:
    """Speed of the crank at the start, rad/s, and its angle, rad."""
    given = usual if speed is None else in_si(speed, "angular speed", "speed")
    start = [float(value or 0.0) for value in (given, in_si(angle, "angle", "angle"))]
    if not np.all(np.isfinite(start)):
        raise UsageError(
            Note(
                "got {speed!r} and {angle!r} for speed and angle; give finite numbers",
                speed=speed,
                angle=angle,
            )
        )
    return start


def _turns_counted(limits: Limits, progress: Progress | None) -> Callable[[float], None]:
    """What is called with the turns of the crank so far."""
    if progress is None or not 1 <= limits.turns < inf:
        return lambda turns: None
    most = ceil(limits.turns)
    return lambda done: progress(int(done), most)


def _limits_of_drives(machine: Machine, limits: Limits) -> Limits:
    """Where a run of several drives ends, which may never be steady: after `TURNS_OF_DRIVES` turns
    of the crank, or the time of these, where nothing is given.
    """
    crank_speed = abs(machine.drive.speed)
    if limits.steady:
        time = 2 * pi * TURNS_OF_DRIVES / (crank_speed or 1.0)
        return replace(limits, time=time, turns=TURNS_OF_DRIVES)
    counted = limits.turns < inf or limits.off_turns < inf
    if counted and not (crank_speed or machine.drive.moves_freely or machine.has_crank):
        raise UsageError(
            Note("turns are those of the crank, which has the speed 0; give times instead")
        )
    return limits


def _start_of_drives(
    machine: Machine, start: Sequence[float], on_turns: Callable[[float], None], usual: bool
) -> Start:
    """All drives at a speed of the crank, rad/s, and its angle, rad; where the speed is the `usual`
    one, those with a motor are at rest.
    """
    crank_speed, crank_angle = start
    angles, rates = (part.tolist() for part in drives_at(machine, crank_angle))
    speeds = [
        0.0 if usual and drive.motor is not None else rate * crank_speed
        for drive, rate in zip(machine.driven, rates, strict=True)
    ]
    return Start(angles, speeds, on_turns)


def _result(equation: CrankEquation, integration: Integration, flywheel: Flywheel | None) -> Run:
    """The run that an integration has followed."""
    machine = equation.machine
    time, crank_angle, crank_speed, *work = np.vstack(integration.track).T
    electric, work = np.array(work[:ELECTRIC]), work[ELECTRIC:]
    switched = next((event.time for event in integration.events if event.kind == "off"), inf)
    driver = Driver.of(machine)
    driver.begins(float(crank_angle[0]), float(crank_speed[0]))
    driving = driver.torque_at(crank_speed, crank_angle, time)
    driving = driver.torque_of(electric[0]) if driver.lags else driving
    torque = np.where(time <= switched, driving, 0.0)
    brake = [BRAKE] if driver.brake else []
    works = dict(zip([*equation.works, *brake, DRIVE], work, strict=True))
    works, losses = losses_apart(works, equation.rubbing)
    keys = [*(source.key for source in equation.sources), *brake, DRIVE]
    works = {key: works[key] for key in keys}
    return Run(
        machine,
        equation,
        time,
        crank_angle,
        crank_speed,
        torque,
        works,
        tuple(integration.events),
        tuple(integration.begins),
        flywheel,
        None if driver.circuit is None else Electric(*electric),
        losses,
    )
