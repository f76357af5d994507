"""What a run comes to, of one crank or several drives: motion, works, events and contacts."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from math import copysign, inf, pi
from typing import Any, ClassVar, Final, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.element_kinds import rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.declaring import columns_of, values_of
from equipoise.results.result import Result
from equipoise.running.collocation import Instant
from equipoise.running.drivers import Driver
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.drives_integration import DriveEvent
from equipoise.running.drives_linkage import DriveAngles, pose_of
from equipoise.running.equation import CrankEquation
from equipoise.running.flywheel import Flywheel
from equipoise.running.friction import FRICTION
from equipoise.running.integration import Event
from equipoise.running.run_contacts import (
    Passage,
    RunContact,
    contacts_of_couplings,
    contacts_of_elements,
    contacts_of_mounts,
    passage_of_crank,
)
from equipoise.running.sources import LOADS, load_factors
from equipoise.signals import Array
from equipoise.vibration.linkages import rows_of
from equipoise.vibration.support_motion import SupportMotion

DRIVE = "drive"
"""In the works of a run of one crank: its drive."""
MOTOR, FREE, GIVEN = "motor", "free", "given motion"
UNITS: Final = {"torque": "N m", "force": "N"}
STARTED = 0.95
"""Share of the mean speed of a steady state at which a machine has started."""


@dataclass(frozen=True, eq=False)
class Electric:
    """The circuit of a direct-current motor, at the M instants of a run.

    current : (M,) A.  supply : work of its supply since the start (M,), J.  heat : of that, what
    its resistance has turned into heat, and a switch with what the field held (M,), J.
    """

    current: Array
    supply: Array
    heat: Array

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (M,) of every signal."""
        units = {"current": "A", "supply": "J", "heat": "J"}
        return [(f"electric.{name}", unit, getattr(self, name)) for name, unit in units.items()]


def losses_apart(
    works: Mapping[str, Array], joints: Iterable[str]
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Works (M,), J, in which the friction of all joints is one, and the energy that each joint has
    taken.

    works : of all that acts; of friction in joints by ``friction.JOINT``.
    """
    works = dict(works)
    rubbed = {name: works.pop(f"{FRICTION}.{name}") for name in joints}
    if rubbed:
        works[FRICTION] = np.sum([*rubbed.values()], axis=0)
    return works, {name: -work for name, work in rubbed.items()}


Circuits = Iterable[tuple[Driver, Electric, Array]]
"""Of each direct-current motor its driver, its circuit, and its work (M,) on the machine, J."""


@dataclass(frozen=True, eq=False, repr=False)
class RunResult(Result):
    """How a machine moves from a start on, at M instants that are not equally spaced.

    time : (M,) s, rising.  crank_angle : (M,) rad.
    work : what has acted -> work on the machine since the start (M,), J.
    losses : joint with friction -> energy that it has taken since the start (M,), J.
    events : what happened; the last one ended the run.
    flywheel : the one that a wanted fluctuation needs, where it is asked for.
    """

    machine: Machine
    equation: CrankEquation | DrivesEquation
    time: Array
    crank_angle: Array
    work: Mapping[str, Array]
    losses: Mapping[str, Array]
    events: tuple[Event, ...] | tuple[DriveEvent, ...]
    flywheel: Flywheel | None

    @property
    def turned(self) -> float:
        """Turns of the crank from the start to the end."""
        return float(self.crank_angle[-1] - self.crank_angle[0]) / (2 * pi)

    @cached_property
    @abstractmethod
    def kinetic_energy(self) -> Array:
        """(M,), J, from the linkage itself and not from what was integrated."""

    @abstractmethod
    def _circuits(self) -> Circuits:
        """All direct-current motors."""

    @cached_property
    def energy_error(self) -> float:
        """Largest difference of kinetic energy and work done, or of what a motor's supply gave and
        what became of it, over the largest of them all.
        """
        energy, each = self.kinetic_energy, np.array([*self.work.values()])
        each = each.reshape(-1, len(energy))
        worst = float(np.max(np.abs(energy - energy[0] - np.sum(each, axis=0))))
        size = max(float(np.max(energy)), float(np.max(np.abs(each), initial=0.0)))
        for driver, circuit, work in self._circuits():
            stored = driver.stored(circuit.current)
            missing = circuit.supply - circuit.heat - (stored - stored[0]) - work
            worst = max(worst, float(np.max(np.abs(missing))))
            size = max(size, float(np.max(np.abs(circuit.supply))))
        return worst / size if size else 0.0

    @abstractmethod
    def _contacts(self) -> Iterator[RunContact]:
        """Contacts of one-sided parts in all rows."""

    @cached_property
    def contacts(self) -> tuple[RunContact, ...]:
        """Contacts of one-sided parts in all rows, in the order in which they begin."""
        return tuple(sorted(self._contacts(), key=lambda contact: contact.begin))

    @property
    def _has_one_sided_elements(self) -> bool:
        return any(element.one_sided for *_, element in rated_elements(self.machine))

    def _energy_columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (M,) of all energies."""
        return [
            ("kinetic_energy", "J", self.kinetic_energy),
            *((f"work.{name}", "J", values) for name, values in self.work.items()),
            *((f"losses.{name}", "J", values) for name, values in self.losses.items()),
        ]

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units."""
        return {
            "title": self.machine.title,
            "end": self.events[-1].kind,
            "turns": self.turned,
            "flywheel": None if self.flywheel is None else self.flywheel.to_dict(),
            "energy_error": self.energy_error,
            "events": [vars(event) for event in self.events],
            "contacts": [contact.to_dict() for contact in self.contacts],
            "time": self.time,
            "crank_angle": self.crank_angle,
            "kinetic_energy": self.kinetic_energy,
            "work": dict(self.work),
            "losses": dict(self.losses),
        }


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
class Run(RunResult):
    """How a machine with one crank runs from a start on; beside the fields of `RunResult`:

    crank_speed : (M,) rad/s.  drive_torque : (M,), on the crank, N m.  The work of the drive comes
        last.
    begins : instants at which a cycle began.
    electric : circuit of a direct-current motor; None of any other.
    """

    equation: CrankEquation
    crank_speed: Array
    drive_torque: Array
    events: tuple[Event, ...]
    begins: tuple[Instant, ...]
    electric: Electric | None
    blocks_in = "running.blocks.run_blocks"
    pictures_in = "figures.time_charts.run_charts"
    headline_in: ClassVar[str] = "running.blocks.run_headline"

    @property
    def end(self) -> Event:
        """What ended the run."""
        return self.events[-1]

    @cached_property
    def kinetic_energy(self) -> Array:
        """(M,), J, from the linkage itself and not from what was integrated."""
        return self.equation.energy(self.crank_angle, self.crank_speed)

    def _circuits(self) -> Circuits:
        if self.electric is not None:
            yield Driver.of(self.machine), self.electric, self.work[DRIVE]

    def _contacts(self) -> Iterator[RunContact]:
        yield from contacts_of_couplings(self._passage)
        if self._has_one_sided_elements:
            angles = (self.crank_angle + row.phase for row in rows_of(self.machine))
            motions = [move(self.machine, angle) for angle in angles]
            yield from contacts_of_elements(motions, self.time, self.crank_speed)

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
            self.end.crank_angle, load_factors(self.machine, self.end.time, self.end.time)
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
            *self._energy_columns(),
            *(() if self.electric is None else self.electric.columns()),
        ]

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units."""
        cycle, lacking, stopping = self.last_cycle, self.lacking_torque, self.stopping
        return {
            **super().to_dict(),
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
            "crank_speed": self.crank_speed,
            "drive_torque": self.drive_torque,
            **({} if self.electric is None else {"electric": dict(vars(self.electric))}),
        }


@dataclass(frozen=True, eq=False)
class DriveCourse:
    """How a drive moves in a run, at M instants.

    link : the driven link.  moved_by : ``motor``, ``free`` or ``given motion``.
    angle, speed : of the link (M,) rad and rad/s.
    effort : torque (M,) of motor or given motion, N m; force of a stroke, N; on all rows.
    electric : circuit of a direct-current motor; None of any other.
    length : (M,) m, of a stroke; None of what turns.  What is pushed moves as in the first row.
    """

    link: str
    moved_by: str
    angle: Array
    speed: Array
    effort: Array
    electric: Electric | None
    length: Array | None = None

    @property
    def effort_in(self) -> Literal["force", "torque"]:
        """What it exerts."""
        return "torque" if self.length is None else "force"

    @property
    def turns(self) -> float:
        """Turns from the start to the end."""
        return float(self.angle[-1] - self.angle[0]) / (2 * pi)

    def to_dict(self) -> dict[str, Any]:
        """All of it, in SI units."""
        electric = {} if self.electric is None else {"electric": dict(vars(self.electric))}
        length = {} if self.length is None else {"length": self.length}
        return {
            "moved_by": self.moved_by,
            "turns": self.turns,
            "angle": self.angle,
            "speed": self.speed,
            self.effort_in: self.effort,
            **length,
            **electric,
        }


@dataclass(frozen=True, eq=False, repr=False)
class DrivesRun(RunResult):
    """How a machine of several drives, or on its support, moves; beside the fields of `RunResult`:

    crank_angle : of a machine whose first drive has a motion of its own the angle of its cycle.
    drives : how each moves, by its link.  The work of a drive is ``drives.LINK``.
    cycle_begins : times at which a cycle of the crank began, s.
    where : drives, and coordinates of the support, of each of R rows (R M).
    passage : the states that it has passed.
    references : about what running angles (..., R, M), and unknowns of loops, are, by their names
        in the linkage.
    support : how the support moves; None on a fixed frame.
    """

    equation: DrivesEquation
    drives: Mapping[str, DriveCourse]
    events: tuple[DriveEvent, ...]
    cycle_begins: tuple[float, ...]
    where: DriveAngles
    passage: Passage
    references: Mapping[str, Array]
    support: SupportMotion | None
    blocks_in = "running.blocks.drives_blocks"
    pictures_in = "figures.time_charts.drives_charts"
    headline_in: ClassVar[str] = "running.blocks.drives_headline"

    @property
    def end(self) -> DriveEvent:
        """What ended the run."""
        return self.events[-1]

    @cached_property
    def kinetic_energy(self) -> Array:
        """(M,), J, from the linkage itself and not from what was integrated."""
        return self.equation.energy(self.where, self.references)

    def _circuits(self) -> Circuits:
        for (link, course), driver in zip(
            self.drives.items(), self.equation.drivers(), strict=True
        ):
            if course.electric is not None:
                yield driver, course.electric, self.work[f"drives.{link}"]

    def reversals(self, link: str) -> tuple[DriveEvent, ...]:
        """Where a driven link turns back while motors are on."""
        off = next((event.time for event in self.events if event.kind == "off"), inf)
        return tuple(
            event
            for event in self.events
            if event.kind == "reversal" and event.of == link and event.time < off
        )

    @cached_property
    def driven_back(self) -> str | None:
        """Link that turns back against its motor, and completes no turn in the rest of the run;
        None where there is none.
        """
        for course, driver in zip(self.drives.values(), self.equation.drivers(), strict=True):
            back, sense = self.reversals(course.link), driver.sense
            if course.moved_by != MOTOR or not back:
                continue
            from_there = course.angle[-1] - np.interp(back[0].time, self.time, course.angle)
            swings = len(back) > 1 or sense * course.speed[-1] < 0  # else it may begin to turn
            if swings and sense * from_there < 2 * pi:
                return course.link
        return None

    def motion_at(self, places: Array, row: int = 0) -> Motion:
        """Poses of a row, from 0, in the axes of its frame at some of the M instants, by their
        places (K,), where derivatives by the crank angle are those by time.
        """
        count, rows, where = len(self.drives), self.equation.rows, self.where
        references = {name: values[..., row, places] for name, values in self.references.items()}
        crank, angles, speeds = (
            rows.apart(part)[..., row, places]
            for part in (where.crank_angle, where.angles, where.speeds)
        )
        linkage = self.equation.linkage
        return pose_of(linkage, crank, angles[:count], speeds[:count], references).moving

    def _contacts(self) -> Iterator[RunContact]:
        yield from contacts_of_couplings(self.passage)
        if self.support is not None:
            yield from contacts_of_mounts(self.support, self.time)
        if self._has_one_sided_elements:
            places = np.arange(len(self.time))
            motions = [self.motion_at(places, row) for row in range(self.equation.rows.count)]
            yield from contacts_of_elements(motions, self.time, 1.0)

    @property
    def last_cycle(self) -> Array | None:
        """Which of the M instants are in the last whole cycle of the crank; None without one."""
        if len(self.cycle_begins) < 2:
            return None
        first, last = self.cycle_begins[-2:]
        return np.asarray((self.time >= first) & (self.time <= last))

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (M,) of every signal."""
        columns = [("time", "s", self.time), ("crank_angle", "rad", self.crank_angle)]
        for link, course in self.drives.items():
            columns += [
                (f"drives.{link}.angle", "rad", course.angle),
                (f"drives.{link}.speed", "rad/s", course.speed),
                (f"drives.{link}.{course.effort_in}", UNITS[course.effort_in], course.effort),
            ]
            if course.length is not None:
                columns.append((f"drives.{link}.length", "m", course.length))
            if course.electric is not None:
                columns += [
                    (f"drives.{link}.{name}", unit, values)
                    for name, unit, values in course.electric.columns()
                ]
        if self.support is not None:
            columns += columns_of(self.support, SupportMotion.declared, model=self.machine)
        return columns + self._energy_columns()

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units."""
        return {
            **super().to_dict(),
            "drives": {link: course.to_dict() for link, course in self.drives.items()},
            **({} if self.support is None else values_of(self.support, SupportMotion.declared)),
        }
