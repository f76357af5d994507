"""A machine of several drives, or on its support: how it moves under motors, weight and loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar, Final, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.force_kinds import rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.declaring import columns_of, values_of
from equipoise.results.result import Result
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drives_equation import DrivesEquation
from equipoise.running.drives_integration import DriveEvent, DrivesIntegration, DrivesTrack, joined
from equipoise.running.drives_linkage import pose_of
from equipoise.running.electric import Electric
from equipoise.running.energy_balance import energy_error, losses_apart
from equipoise.running.flywheel import Flywheel
from equipoise.running.integration import Limits
from equipoise.running.joint_forces import Passage
from equipoise.running.run_contacts import (
    RunContact,
    contacts_of_couplings,
    contacts_of_elements,
    contacts_of_mounts,
)
from equipoise.signals import Array
from equipoise.vibration.support_motion import SupportMotion


@dataclass(frozen=True)
class Start:
    """From where a run goes on.

    angles, speeds : of all drives (N,), rad and rad/s.  on_turns : as of `DrivesIntegration`.
    """

    angles: Sequence[float]
    speeds: Sequence[float]
    on_turns: Callable[[float], None]


MOTOR, FREE, GIVEN = "motor", "free", "given motion"
UNITS: Final = {"torque": "N m", "force": "N"}


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
class DrivesRun(Result):
    """How a machine of several drives, or on its support, moves from a start on, at M instants,
    not equally spaced.

    time : (M,) s, rising.  crank_angle : (M,) rad; of a machine whose first drive has a motion of
        its own the angle of its cycle.
    drives : how each moves, by its link.
    work : what has acted -> work on the machine since the start (M,), J; that of a drive as
        ``drives.LINK``.
    events : what happened; the last one ended the run.
    cycle_begins : times at which a cycle of the crank began, s.
    losses : joint with friction -> energy that it has taken since the start (M,), J.
    where : drives, and coordinates of the support, of each of R rows (R M).
    passage : the states that it has passed.
    references : about what running angles (..., R, M), and unknowns of loops, are, by their names
        in the linkage.
    support : how the support moves; None on a fixed frame.
    flywheel : the one that a wanted fluctuation needs, where it is asked for.
    """

    machine: Machine
    equation: DrivesEquation
    time: Array
    crank_angle: Array
    drives: Mapping[str, DriveCourse]
    work: Mapping[str, Array]
    events: tuple[DriveEvent, ...]
    cycle_begins: tuple[float, ...]
    losses: Mapping[str, Array]
    where: DriveAngles
    passage: Passage
    references: Mapping[str, Array]
    support: SupportMotion | None = None
    flywheel: Flywheel | None = None
    blocks_in = "running.drives_blocks.run_blocks"
    pictures_in = "figures.running.drives_charts"
    headline_in: ClassVar[str] = "running.drives_blocks.run_headline"

    @property
    def end(self) -> DriveEvent:
        """What ended the run."""
        return self.events[-1]

    @property
    def turned(self) -> float:
        """Turns of the crank from the start to the end."""
        return float(self.crank_angle[-1] - self.crank_angle[0]) / (2 * pi)

    @cached_property
    def kinetic_energy(self) -> Array:
        """(M,), J, from the linkage itself and not from what was integrated."""
        return self.equation.energy(self.where, self.references)

    @cached_property
    def energy_error(self) -> float:
        """Largest difference of kinetic energy and work done, or of what a motor's supply gave and
        what became of it, over the largest of them all.
        """
        each = zip(self.drives.items(), self.equation.drivers(), strict=True)
        circuits = (
            (driver, course.electric, self.work[f"drives.{link}"])
            for (link, course), driver in each
            if course.electric is not None
        )
        return energy_error(self.kinetic_energy, self.work.values(), circuits)

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

    @cached_property
    def contacts(self) -> tuple[RunContact, ...]:
        """Contacts of one-sided parts in all rows, in the order in which they begin."""
        contacts = [*contacts_of_couplings(self.passage)]
        if self.support is not None:
            contacts += contacts_of_mounts(self.support, self.time)
        if any(element.one_sided for *_, element in rated_elements(self.machine)):
            places = np.arange(len(self.time))
            motions = [self.motion_at(places, row) for row in range(self.equation.rows.count)]
            contacts += contacts_of_elements(motions, self.time, 1.0)
        return tuple(sorted(contacts, key=lambda contact: contact.begin))

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
        columns.append(("kinetic_energy", "J", self.kinetic_energy))
        columns += [(f"work.{name}", "J", values) for name, values in self.work.items()]
        return columns + [(f"losses.{name}", "J", values) for name, values in self.losses.items()]

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units."""
        return {
            "title": self.machine.title,
            "end": self.end.kind,
            "turns": self.turned,
            "drives": {link: course.to_dict() for link, course in self.drives.items()},
            "flywheel": None if self.flywheel is None else self.flywheel.to_dict(),
            "energy_error": self.energy_error,
            "events": [vars(event) for event in self.events],
            "contacts": [contact.to_dict() for contact in self.contacts],
            "time": self.time,
            "crank_angle": self.crank_angle,
            "kinetic_energy": self.kinetic_energy,
            "work": dict(self.work),
            "losses": dict(self.losses),
            **({} if self.support is None else values_of(self.support, SupportMotion.declared)),
        }


def run_drives(equation: DrivesEquation, limits: Limits, start: Start) -> DrivesRun:
    """Run from a start until something ends it; a support begins at rest in the drawn position."""
    unknowns = equation.unknowns
    integration = DrivesIntegration(equation, limits)
    integration.on_turns = start.on_turns
    at_rest = [0.0] * (equation.coordinates - len(equation.drives))
    angles, speeds = ([*each, *at_rest] for each in (start.angles, start.speeds))
    integration.follow([angles[k] for k in unknowns], [speeds[k] for k in unknowns])
    track, rates = joined(integration.tracks), integration.rates
    where = rates.where(track.time, track.states)
    passed = DriveAngles(*(values.copy() for values in where))
    of_rows = equation.in_rows(track.time, where, track.references)
    pushed = () if equation.strokes is None else equation.strokes.places
    lengths = dict(zip(pushed, equation.rows.first(of_rows.lengths), strict=True))
    for k in pushed:
        where.angles[k], where.speeds[k] = (
            equation.rows.first(part[k]) for part in (of_rows.angles, of_rows.speeds)
        )
    courses = {
        drive.link: DriveCourse(
            drive.link,
            MOTOR if drive.motor else FREE if k in unknowns else GIVEN,
            where.angles[k],
            where.speeds[k],
            track.torques[k],
            _electric(integration, k, track, where),
            lengths.get(k),
        )
        for k, drive in enumerate(equation.drives)
    }
    works = dict(zip(rates.works, track.quadratures[2 * len(rates.circuits) :], strict=True))
    works, losses = losses_apart(works, rates.rubbing)
    return DrivesRun(
        equation.machine,
        equation,
        track.time,
        where.crank_angle,
        courses,
        works,
        tuple(integration.events),
        tuple(integration.marks),
        losses,
        of_rows,
        Passage(equation, track.time, passed, track.references, track.accelerations),
        track.references,
        equation.support_motion(where.angles, where.speeds),
    )


def _electric(
    integration: DrivesIntegration, drive: int, track: DrivesTrack, where: DriveAngles
) -> Electric | None:
    """The circuit of a drive's motor; None of one without."""
    rates = integration.rates
    if drive not in rates.circuits:
        return None
    place = 2 * rates.circuits.index(drive)
    if drive in rates.lagging:
        current = rates.current(drive, track.states, where)
    else:
        off = next((event.time for event in integration.events if event.kind == "off"), inf)
        motor = integration.equation.drivers()[drive]
        current = np.where(track.time <= off, motor.current(where.speeds[drive]), 0.0)
    return Electric(current, *track.quadratures[place : place + 2])
