"""An analysis: motion and forces of a machine, as plain data, tables and blocks."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.limits import check_memory
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.checks import NamedItems
from equipoise.mechanism.dynamics.assessment import FourBar, four_bar
from equipoise.mechanism.dynamics.forces import Forces, forces, massless
from equipoise.mechanism.dynamics.joint_duty import (
    BearingLife,
    Losses,
    PlainBearingDuty,
    bearing_lives,
    losses_of,
    plain_bearing_duties,
)
from equipoise.mechanism.dynamics.link_stress import LinkStress, link_stresses
from equipoise.mechanism.dynamics.reactions import indeterminate_reactions
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.jumps import jumps_of, resolved
from equipoise.mechanism.kinematics.motion import Motion, move, move_again
from equipoise.mechanism.kinematics.strokes import Dwell, Stroke, dwell, strokes
from equipoise.mechanism.outputs.declared import DECLARED, OutputSource
from equipoise.mechanism.parts.links import in_frame
from equipoise.mechanism.parts.machine import Machine, Vector
from equipoise.quantities import Dimension, column_heading
from equipoise.results.declaring import OWN, Declarations, ResultOutput, values_of
from equipoise.results.outputs import (
    AnalysisOutput,
    AnalysisOutputs,
    figures_by_name,
    figures_of_kinds,
)
from equipoise.results.remarks import remarks_of
from equipoise.results.result import Result
from equipoise.signals import Array, Figures, Periodic

if TYPE_CHECKING:
    import pandas
    import xarray


SPLIT = 1000
"""Bytes that forces by cause and link, and their text, take at a crank angle for the square of the
number of links: as measured of four.
"""
AT_ONCE = 2**21
"""Values of outputs of which figures are taken at once."""
LATERAL = ("roll_moment", "yaw_moment")
"""Moments about x and y, from linkages side by side."""
ANGLES = 360
"""Crank angles in a turn where nobody asks for another number: every surface takes the same."""
LEAST_ANGLES = 90
"""In a turn, from which harmonics are taken: those that matter end before half of it."""


@dataclass(frozen=True, eq=False, repr=False)
class Analysis(Result):
    """What a machine does over its crank angles.

    motion : always there.  about : point of the frame's plane (m, complex) about which moments are
        taken; None without forces, as where masses are missing.
    """

    blocks_in = "results.analysis_blocks.shown_blocks"
    pictures_in = "figures.analysis.analysis_charts"
    headline_in: ClassVar[str] = "vibration.blocks.analysis_headline"

    motion: Motion
    about: complex | None

    @classmethod
    def of(cls, motion: Motion, about: str | Vector | complex | None = None) -> Analysis:
        """With forces where all masses are given.

        about : point about which moments are taken, a name or (x, y) in m; the drive pivot if None.

        Raises
        ------
        UsageError : there is no such point, be there masses or not.
        """
        pole = in_frame(motion.machine.frame, motion.linkage.pivot if about is None else about)
        return cls(motion, None if massless(motion.machine) else pole)

    @property
    def machine(self) -> Machine:
        return self.motion.machine

    @property
    def crank_angle(self) -> Array:
        """(N,) rad."""
        return self.motion.crank_angle

    @property
    def has_forces(self) -> bool:
        """Whether there are forces: all masses are given."""
        return self.about is not None

    @cached_property
    def solved(self) -> Forces | None:
        """Its forces; None without."""
        return None if self.about is None else forces(self.motion, self.about)

    @property
    def forces(self) -> Forces:
        """Forces; raises `MassError` where masses are missing."""
        if self.solved is None:
            missing = massless(self.machine)
            assert missing is not None
            raise MassError(missing)
        return self.solved

    @cached_property
    def four_bar(self) -> FourBar | None:
        """Names and figures of the four-bar at the crank, where there is one."""
        return four_bar(self.machine)

    @cached_property
    def strokes(self) -> Mapping[str, Stroke]:
        """Stroke, dead positions, time ratio and dwell of every slider and rocker, by name.

        They are those of the whole cycle, whatever the crank angles; none where the crank cannot
        turn fully.
        """
        return strokes(self.motion.linkage)

    @cached_property
    def part_figures(self) -> Mapping[str, Mapping[str, Any]]:
        """Figures of parts by list of the file and name: of ``cams`` how sharp each is, and when
        its follower lifts off.
        """
        kinds = figures_of_kinds(type(self.machine)).items()
        return {table: figures.of_parts(self.motion, self.solved) for table, figures in kinds}

    def dwell(self, name: str, tolerance: float | None = None) -> Dwell:
        """Longest crank angle over which a slider, link or point moves by no more than a tolerance
        (m, of a link rad), see `mechanism.kinematics.strokes.dwell`.
        """
        return dwell(self.motion.linkage, name, tolerance)

    def dwells(self, tolerance: float, of: Dimension = "length") -> Mapping[str, Dwell]:
        """Dwells of all sliders and points but the drive's, or, within an angle, of all links."""
        drive = self.machine.drive.link
        names = [link for link in self.motion.links if link != drive]
        if of == "length":
            known = {*self.machine.frame, *self.machine.links[drive].points}
            names = [*self.motion.sliders, *(n for n in self.motion.points if n not in known)]
        return {name: self.dwell(name, tolerance) for name in names}

    @cached_property
    def resolved(self) -> Analysis:
        """The machine at crank angles that resolve where forces jump, from which all figures are
        taken; this analysis itself where nothing jumps, or the crank angles are no whole cycle.
        """
        motion = resolved(self.motion)
        if motion is self.motion:
            return self
        return Analysis(motion, self.about)

    @cached_property
    def losses(self) -> Losses | None:
        """What friction in joints costs in a cycle; None where there is none, or no whole cycle
        that is turned evenly.
        """
        return losses_of(self.resolved.forces) if self.has_forces else None

    @cached_property
    def rolling_bearings(self) -> Mapping[str, BearingLife]:
        """Life of rolling bearings by joint; none where the crank is not turned evenly, or the
        crank angles are no whole cycle.
        """
        return bearing_lives(self.resolved.forces) if self.has_forces else {}

    @cached_property
    def plain_bearings(self) -> Mapping[str, PlainBearingDuty]:
        """Pressure, and pressure times speed, of plain bearings by joint."""
        return plain_bearing_duties(self.resolved.forces) if self.has_forces else {}

    @cached_property
    def sections(self) -> Mapping[str, LinkStress]:
        """Stress, buckling and life of links whose section is given, by link; none where the crank
        is not turned evenly, or the crank angles are no whole cycle.
        """
        return link_stresses(self.resolved.forces) if self.has_forces else {}

    @cached_property
    def outputs(self) -> AnalysisOutputs:
        """Every output of motion and forces, by name."""
        return AnalysisOutputs(self)

    @cached_property
    def summary(self) -> Mapping[str, Figures]:
        """Mean, RMS, peak and extremes of outputs, by name."""
        return self._figures(self.outputs.summed)

    def _figures(self, ones: Sequence[AnalysisOutput]) -> Mapping[str, Figures]:
        """Those of some outputs, by name; of so many at once as leave memory to others."""
        motion, figures = self.resolved.motion, NamedItems[Figures]("output", ())
        some = max(1, AT_ONCE // len(motion.crank_angle))
        for begin in range(0, len(ones), some):
            part = ones[begin : begin + some]
            figures_of_each = motion.figures_of_each(np.array([item.resolved for item in part]))
            figures.update(zip((item.name for item in part), figures_of_each, strict=True))
        return figures

    @property
    def has_rows_total(self) -> bool:
        """Whether there are figures of all rows together: see `rows_total`."""
        several = len(self.machine.rows) > 1
        return several and self.motion.whole_cycle and self.has_forces

    @cached_property
    def rows_total(self) -> Mapping[str, Array]:
        """Shaking force (complex), shaking, roll and yaw moment, and what drives (N,) of all rows.

        Each row's crank is ahead by its phase.  Moments are about the drive's pivot of the first,
        but for the shaking moment, which is about the point that the forces have.  Empty where
        there is one row, or the crank angles are not those of a whole cycle.
        """
        rows = self.machine.rows
        if not self.has_rows_total or self.solved is None:
            return {}
        count, effort = len(self.crank_angle), self.machine.drive.effort
        whole = {"shaking_force": np.zeros(count, complex)}
        whole |= {name: np.zeros(count) for name in ("shaking_moment", *LATERAL, effort)}
        for row, signals in zip(rows, self._of_each_row(self.solved), strict=True):
            x, y, moment, exerted, roll, yaw = signals
            whole["shaking_force"] += x + 1j * y
            whole["shaking_moment"] += moment + kernels.cross(complex(*row.offset), x + 1j * y)
            whole["roll_moment"] += roll - row.lateral * y
            whole["yaw_moment"] += yaw + row.lateral * x
            whole[effort] += exerted
        twice = (len(rows) - 1) * self.solved.flywheel_torque  # rows on one shaft share a flywheel
        whole["shaking_moment"] += twice
        whole[effort] -= twice
        return whole

    def whole(self, name: str) -> str:
        """The output that holds all rows together, such as ``rows.drive_torque``, where there are
        several; else the output itself.
        """
        return f"rows.{name}" if f"rows.{name}" in self.outputs else name

    def _of_each_row(self, result: Forces) -> Iterator[Array]:
        """Shaking force x and y, shaking moment, what drives, roll and yaw moment (6, N) of each
        row, at its own crank angles; without jumps orders are shifted, which is as exact.
        """
        motion, rows = self.motion, self.machine.rows
        if len(jumps_of(motion.linkage)):
            of_phase: dict[float, Array] = {}
            for phase in (row.phase for row in rows):
                if phase not in of_phase:
                    theta = self.crank_angle + phase
                    turned = move_again(self.machine, theta, motion.speed, motion.acceleration)
                    own = forces(turned, result.about) if phase else result
                    of_phase[phase] = _of_one_row(own)
                yield of_phase[phase]
            return
        item = Periodic.of(_of_one_row(result), motion.turns)
        for row in rows:
            yield item.shifted(row.phase).samples(len(self.crank_angle))

    @cached_property
    def notes(self) -> tuple[Note | str, ...]:
        """What to look at again, as `check` asks it: what may not be meant, and where it fails."""
        return tuple(dict.fromkeys(remarks_of(self)))

    @property
    def has_orders(self) -> bool:
        """Whether its crank angles are such that harmonics can be taken."""
        motion = self.motion
        return motion.whole_cycle and len(self.crank_angle) >= LEAST_ANGLES * motion.turns

    @cached_property
    def by_order(self) -> Mapping[str, Periodic]:
        """Outputs by order: shaking force and moment, drive torque, and acceleration of the common
        centre of mass (``mass_center.ax``, ``mass_center.ay``, m/s2).

        Raises
        ------
        MassError : masses are missing.
        UsageError : the crank angles are not equally spaced over the whole cycle.
        """
        _ = self.forces
        if not self.motion.whole_cycle:
            raise UsageError(
                Note("orders need crank angles over the whole cycle; give a number of them")
            )
        in_a_turn = len(self.crank_angle) // self.motion.turns
        if in_a_turn < LEAST_ANGLES:
            raise UsageError(
                Note(
                    "got {in_a_turn} crank angles in a turn; orders need {least_angles} and "
                    "more, or high ones are taken for low ones",
                    in_a_turn=in_a_turn,
                    least_angles=LEAST_ANGLES,
                )
            )
        return NamedItems("output", ((item.name, item.periodic) for item in self.outputs.ordered))

    def to_dict(
        self,
        split: bool = False,
        outputs: Iterable[str] = (),
        strokes: bool = True,
        wanted: Collection[str] | None = None,
    ) -> dict[str, Any]:
        """The machine-readable output, in SI units: dicts, numbers and arrays (N,).

        split : whether to add every force by cause and by link.
        outputs : names of further outputs that are added; None stands among the values of those
            that are infinite somewhere.
        strokes : whether to include figures of sliders, rockers and cams, and notes, which take
            some milliseconds.
        wanted : names of the outputs that stand in arrays and summary; None for all.
        """
        result: dict[str, Any] = {
            **self._heading,
            "crank_angle": self.crank_angle,
            "links": {},
            "points": {},
        }
        solved = self.solved
        if solved is None:
            result["missing"] = massless(self.machine)
        else:
            for family, forces in {"joints": solved.joints, **solved.couplings}.items():
                ends = {name: {"on": force.on, "by": force.by} for name, force in forces.items()}
                if ends or family == "joints":
                    result[family] = ends
            result.update(_undecided(self.motion.linkage))
            result.update(_friction(self.losses))
            result |= values_of(solved, ABOUT)
            if not self.machine.has_crank and self.motion.whole_cycle:
                works = self.resolved.forces.work
                result["drives"] = {link: {"work": work} for link, work in works.items()}
        arrays = self.outputs.arrays
        for entry in (item for item in arrays if wanted is None or item.name in wanted):
            *keys, last = entry.path
            values = result
            for key in keys:
                values = values.setdefault(key, {})
            values[last] = entry.values
        if solved is not None and split:
            result.update(_split(solved))
        if chosen := self.outputs.chosen(outputs):
            result["outputs"] = {item.name: _or_none(item.values) for item in chosen}
        if strokes:
            result["strokes"] = {name: stroke.to_dict() for name, stroke in self.strokes.items()}
            for table, name, figures in figures_by_name(self):
                result.setdefault(table, {}).setdefault(name, {}).update(figures.to_dict())
            result["notes"] = list(map(str, self.notes))
        return result | {"summary": self._summary_of(wanted)}

    def _summary_of(self, wanted: Collection[str] | None) -> dict[str, Any]:
        """The summary as plain data, of outputs of some names, or of all."""
        if wanted is None:
            figures = self.summary
        else:
            figures = self._figures([item for item in self.outputs.summed if item.name in wanted])
        summary: dict[str, Any] = {
            name: {**vars(figure), "peak_to_peak": figure.peak_to_peak}
            for name, figure in figures.items()
        }
        if self.four_bar is not None:
            summary["four_bar"] = values_of(self.four_bar, FOUR_BAR)
        return summary

    @property
    def _heading(self) -> dict[str, Any]:
        heading: dict[str, Any] = {"title": self.machine.title, **values_of(self.motion, HEADING)}
        return heading | (values_of(self.motion, CYCLE) if self.motion.whole_cycle else {})

    def to_dataset(self) -> xarray.Dataset:
        """Every array as an `xarray.Dataset` over crank angle (rad); loads xarray."""
        import xarray

        coordinate = {"crank_angle": ("crank_angle", self.crank_angle, {"units": "rad"})}
        arrays = {
            value.name: (
                "crank_angle",
                value.values,
                {"units": value.unit, "long_name": value.label()},
            )
            for value in self.outputs.arrays
        }
        return xarray.Dataset(arrays, coordinate, attrs=self._heading)

    def to_frame(self) -> pandas.DataFrame:
        """Every array as a column of a `pandas.DataFrame` over crank angle, by name and SI unit
        such as ``drive_torque [N m]``; loads pandas.
        """
        import pandas

        index = pandas.Index(self.crank_angle, name=column_heading("crank_angle", "rad"))
        columns = {
            column_heading(value.name, value.unit): value.values for value in self.outputs.arrays
        }
        return pandas.DataFrame(columns, index=index)


def _of_one_row(forces: Forces) -> Array:
    """Shaking force x and y, shaking moment, what drives, roll and yaw moment, (6, N)."""
    machine, force = forces.motion.machine, forces.shaking_force
    exerted = getattr(forces, machine.drive.effort)
    rocking = np.zeros(len(exerted))
    if machine.has_planes:
        rocking = forces.across.rocking_moment.value
    rocked = np.real(rocking), np.imag(rocking)
    return np.array([force.x, force.y, forces.shaking_moment, exerted, *rocked])


HEADING: Declarations = {
    "speed": ResultOutput("speed of the drive", "angular speed"),
    "acceleration": ResultOutput("acceleration of the drive", "angular acceleration"),
}
CYCLE: Declarations = {"turns": ResultOutput("turns of the crank in a cycle")}
ABOUT: Declarations = {
    "about": ResultOutput(
        "point of the frame about which moments are",
        of={
            "x": ResultOutput("to the right", "length", read="real"),
            "y": ResultOutput("upward", "length", read="imag"),
        },
    )
}
FOUR_BAR: Declarations = {
    **{name: ResultOutput(f"the {name}") for name in ("crank", "coupler", "rocker")},
    "pins": ResultOutput("its joints, from that of the crank and the frame on"),
    "a": ResultOutput("length of the frame", "length"),
    "b": ResultOutput("length of the crank", "length"),
    "c": ResultOutput("length of the coupler", "length"),
    "d": ResultOutput("length of the rocker", "length"),
    "grashof": ResultOutput("whether the shortest link can turn"),
    "type": ResultOutput("its type, by the shortest link"),
    "transmission_min": ResultOutput("smallest angle between coupler and rocker", "angle"),
    "transmission_max": ResultOutput("largest angle between coupler and rocker", "angle"),
    "swing": ResultOutput("angle through which the rocker swings", "angle"),
    "time_ratio": ResultOutput("time of the slower swing over that of the faster"),
    "condition_5": ResultOutput("whether the crank turns and the rocker is determined"),
    "condition_6": ResultOutput("whether it stays on its branch"),
}
BESIDE_OUTPUTS: Declarations = {
    **HEADING,
    **CYCLE,
    **ABOUT,
    "crank_angle": ResultOutput("crank angles of all arrays", "angle"),
    "four_bar": ResultOutput("the four-bar at the crank", of=FOUR_BAR),
}
"""What an analysis has that is no output of the machine."""
BY_ORDER: Declarations = {
    "orders": ResultOutput("events in one turn of the crank"),
    "a": ResultOutput("amplitudes of the cosines", OWN, read=lambda item: item.amplitudes.real),
    "b": ResultOutput("amplitudes of the sines", OWN, read=lambda item: -item.amplitudes.imag),
    "harmonics": ResultOutput("amplitudes", OWN, read="sizes"),
    "phases": ResultOutput("crank angles of the first top", "angle"),
}
"""What an analysis has of each output by order."""


def order_values(analysis: Analysis, orders: int, zero: float) -> dict[str, Any]:
    """Outputs by order, as in `Analysis.by_order`, up to an order; SI units and rad.

    zero : rad, direction from which crank angles count.
    """
    result = {}
    for name, whole in analysis.by_order.items():
        signal = whole.shifted(zero)
        shown_orders = slice(0, signal.count_to(orders))
        result[name] = {
            key: values[shown_orders] for key, values in values_of(signal, BY_ORDER).items()
        }
    return result


def _split(forces: Forces) -> dict[str, Any]:
    """Every force by cause, and by link: output -> cause or link -> array, or x and y.

    Raises
    ------
    UsageError : they take more memory than may be used.
    """
    motion = forces.motion
    count, links = len(motion.crank_angle), len(motion.machine.links)
    split_of = to_say("forces by cause and link at {count} crank angles, of {turns} turns")
    check_memory(SPLIT * links**2 * count, Note(split_of, count=count, turns=motion.turns))
    read = OutputSource(forces.motion, forces.split)
    result: dict[str, Any] = {key: {"joints": {}} for key in ("by_cause", "by_link")}
    for entry in DECLARED.values():
        if entry.part in ("x", "y") or not entry.is_split:
            continue
        for item in entry.items_of(read):
            whole = entry.vector(read, item)
            for key, names, axis in (
                ("by_cause", forces.split.causes, 1),
                ("by_link", forces.split.links, 0),
            ):
                parts = zip(names, whole.sum(axis=axis), strict=True)
                values = result[key]
                for step in entry.path(item)[:-1]:
                    values = values.setdefault(step, {})
                values[entry.path(item)[-1]] = {name: _parts(part) for name, part in parts}
    return result


def _friction(losses: Losses | None) -> dict[str, Any]:
    """What friction in joints costs, where there is some."""
    if losses is None:
        return {}
    joints = {name: dict(vars(joint)) for name, joint in losses.joints.items()}
    total = {"loss": losses.loss, "efficiency": losses.efficiency}
    given = {"drive": losses.drive, "loads": losses.loads}
    return {"friction": {**given, **total, "joints": joints}}


def _undecided(linkage: Linkage) -> dict[str, Any]:
    """Joints with statically indeterminate reactions; empty where there are none."""
    outcome = indeterminate_reactions(linkage)
    result: dict[str, Any] = {}
    if outcome.open:
        rule = "stiffness" if outcome.by_stiffness else "least squares"
        result["open"] = {"joints": [*outcome.open], "rule": rule}
    if outcome.unbounded:
        result["unbounded"] = {"joints": [*outcome.unbounded], "crank_angle": outcome.at}
    return result


def _or_none(values: Array) -> Array:
    """Values, with None where they are not finite."""
    there = np.isfinite(values)
    if np.all(there):
        return values
    numbers = values.astype(object)
    numbers[~there] = None
    return numbers


def _parts(values: Array) -> Any:
    return {"x": values.real, "y": values.imag} if np.iscomplexobj(values) else values


def analyze(
    machine: Machine,
    angles: int | Sequence[float] | np.ndarray[Any, Any] = ANGLES,
    speed: float | str | None = None,
    acceleration: float | str | None = None,
    about: str | Vector | complex | None = None,
) -> Analysis:
    """Motion and forces of a machine.

    Parameters
    ----------
    angles : number of crank angles in each turn, equally spaced from 0 over the whole cycle (which
        takes several turns where couplings or loops need them), or the crank angles, rad.
    speed, acceleration : of the crank, rad/s and rad/s2, or texts such as ``"300 rpm"``; those of
        the machine where not given.
    about : point about which moments are taken, a name or (x, y) in m; the drive pivot if None.

    Returns
    -------
    Analysis whose forces are None where the machine lacks masses.

    Raises
    ------
    MobilityError, MotionError, ModelError : the linkage cannot be moved so.
    LockError : friction in its joints locks it.
    UsageError : an argument cannot be used.
    """
    motion = move(machine, angles, speed, acceleration)
    analysis = Analysis.of(motion, about)
    if not machine.rubs:
        _ = analysis.solved
    elif analysis.has_forces:  # where friction locks it, there are no forces, and no figures
        _ = analysis.resolved.forces.solved
    return analysis
