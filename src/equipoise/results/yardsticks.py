"""What is large on a machine: its figures, each against a yardstick of its own.

`assess` gives them ranked, the largest first.  Which outputs are assessed, and against what, is
declared with them (`yardstick` in `mechanism.outputs.declared`):

    weight        a force that shakes the frame: peak, over the weight of the machine or a quarter
                  of the largest load from outside, whichever is larger
    span          a moment that shakes the frame: peak, over that force at the span of the feet
    bearings      a moment across the plane: peak, over that force at the span across the plane
    effort        a torque: peak to peak, over its mean; where that is less than what lifts the
                  moving links at the crank's throw, over the largest force that acts, there, but
                  where loads swing it far more than the links do; and over what the turning masses
                  even out to a usual fluctuation of the speed, where that is not more;
                  a force: peak, over the largest load or the weight of the links
    acting        a force between bodies: peak, over the largest force that acts: weight, load,
                  spring, inertia of a link, and what the drive exerts at the crank's throw
    pressure      a pressure angle: peak, over 30 deg, of a follower that swings 45 deg
    transmission  a transmission angle: its distance from 90 deg, over 50 deg
    limit         a limit that is declared: of a gauge
    capacity      what a part bears or a motor gives, over what the machine asks of it: a safety of
                  a link or bearing, over 1; the life of a bearing or link, over the one that is
                  wanted; the largest torque of the motor, over the mean of the drive's
    contact       of a cam: the speed of the crank, over that at which the follower lifts off
    vibration     the velocity of a gauge without a limit: RMS, over 4.5 mm/s; but where nothing
                  moves except rotors (`results.rotors`), which may be there to shake, or where a
                  hand holds the machine: the daily exposure A(8) of that hand, over the limit
                  value of Directive 2002/44/EC

A ratio of 1 is the yardstick itself.  More is large; of what a machine always has of its kind,
more than `LARGE_FROM`: a joint carries what acts on it, and a torque without a mean swings to both
sides.  Weights are by standard gravity where a
machine lies flat.  The support counts where there is one.  30 and 45 deg of pressure and 40 deg of
transmission are the usual limits (Norton, Design of Machinery, 8.6 and 4.10); 4.5 mm/s is where
ISO 20816-3 ends zone B for machines of 15 to 300 kW on flexible supports.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from math import hypot, isfinite, pi, radians
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, PartName, capital, say, to_say
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.dynamics.forces import joint_properties
from equipoise.mechanism.dynamics.loads import acting_loads, outer_loads
from equipoise.mechanism.kinematics.strokes import declared_figures, least_value
from equipoise.mechanism.outputs.declared import DECLARED, declared, joint_named, named
from equipoise.mechanism.parts.balance import GAUGES
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import STANDARD_GRAVITY, Machine
from equipoise.quantities import SI, Dimension, angle, display, number, percent
from equipoise.results.analysis import Analysis
from equipoise.results.machine_blocks import pushing
from equipoise.results.outputs import (
    FIGURES,
    LEAST_MEAN,
    AnalysisOutput,
    figures_by_name,
    motor_torque,
)
from equipoise.results.rotors import STEADY, speed_fluctuation, unbalances

LARGE, NOTHING = 1.0, 1e-9
"""Ratio from which a figure is large, and up to which it is rounding."""
LARGE_FROM: Mapping[str, float] = {"acting": 2.0, "effort": 1.5}
"""By yardstick, where it is another: a joint bears a load and what holds against it."""
TRANSMISSION = radians(40)
"""Smallest transmission angle of a dyad, rad."""
NEARLY_DEAD = radians(20)
"""Of a transmission angle: below it play and friction of pins decide what moves, and forces in
joints are three times those across, so that lengths come before what shakes."""
LOAD_SHARE = 0.25
"""Of the largest load: a force that shakes the frame is felt beside the loads from there on."""
SHAKING = ("weight", "span", "bearings", "vibration")
"""Yardsticks of what counterweights and phases are for."""
BY_LOADS, TRIFLE = 0.9, 0.1
"""Shares of the swing of a torque: what loads make of it at least, and what lifts the links at
most, where its mean, which is the work that the loads take, is its yardstick in any case.  On a
press the load acts near a dead position, where its lever is a small part of the throw.  A load may
be a weight that is lifted and comes down again; a resistance takes nothing but work."""
MEAN = to_say("its mean")
VIBRATION = 4.5e-3
"""RMS of a velocity, m/s, beyond which a machine should not run for long."""


class HandReading(Protocol):
    """What a hand gets that holds a support, as `HandVibration` has it."""

    @property
    def a8(self) -> float: ...
    @property
    def limit(self) -> float: ...
    @property
    def verdict(self) -> Note: ...


class GaugeReading(Protocol):
    """What a gauge reads over a period, as `Response.gauges` has it."""

    @property
    def displacement(self) -> Any: ...
    @property
    def velocity(self) -> Any: ...
    @property
    def rotation(self) -> bool: ...
    @property
    def hand(self) -> HandReading | None: ...


@dataclass(frozen=True)
class FigureAssessment:
    """A figure of a machine beside its yardstick.

    figure : its path in the machine-readable output: in the summary of an analysis
        (``shaking_force.peak``), among its cams (``cams.lift.lift_off_speed``), or in a response
        (``gauges.cab.velocity.rms``).
    label : what it is called.
    value : SI units.  dimension : of it.
    yardstick : in the same unit.  against : what that is.
    ratio : 1 where the figure meets its yardstick; more is worse.
    output : the output that it is a figure of.  item : of a family, its member, such as a joint.
    crank_angle : rad, at which it is so large; None of what has no crank angle.
    shown_unit : in which it is shown, where that is not the usual unit of its dimension.
    is_limit : whether the machine does not do what it is meant to do beyond it: a limit that the
        file gives, or contact that is lost.
    is_contact : whether it is the speed at which a follower lifts off.
    is_capacity : whether it is a limit of what a part bears or a motor gives.
    """

    figure: str
    label: Note
    value: float
    dimension: Dimension | None
    yardstick: float
    against: Note
    ratio: float
    output: str
    item: str = ""
    crank_angle: float | None = None
    is_limit: bool = False
    is_contact: bool = False
    is_capacity: bool = False
    shown_unit: str | None = None

    @property
    def unit(self) -> str:
        """SI unit of value and yardstick; empty of plain numbers."""
        return "" if self.dimension is None else SI[self.dimension]

    @property
    def family(self) -> tuple[str, str]:
        """Name of its declared output, such as ``joints.{}``, and of the figure.

        A gauge is a family of its own.
        """
        known = None if self.output.startswith(GAUGES) else declared(self.output)
        name = self.output if known is None else known[0].name
        return name, self.figure.rpartition(".")[2]

    @property
    def yardstick_kind(self) -> str:
        """The yardstick that its output is declared with; empty of what is no output."""
        known = declared(self.output)
        return "" if known is None else known[0].yardstick

    @property
    def is_shaking(self) -> bool:
        """Whether it is what shakes the frame, or how a support vibrates."""
        return self.yardstick_kind in SHAKING

    @property
    def is_torque(self) -> bool:
        """Whether it is a torque of the drive."""
        return self.yardstick_kind == "effort" and self.dimension == "torque"

    @property
    def is_swing_about_mean(self) -> bool:
        """Whether it is a torque that swings about the mean that does the work."""
        return self.yardstick_kind == "effort" and self.against == MEAN

    @property
    def is_kept_contact(self) -> bool:
        """Whether it is that of a follower that stays on its cam at the speed of the machine."""
        return self.is_contact and not self.is_large

    @property
    def is_broken(self) -> bool:
        """Whether it is a limit beyond which the machine does not do what it is meant to."""
        return self.is_limit and self.is_large

    @property
    def is_exposure(self) -> bool:
        """Whether it is the daily exposure of a hand."""
        return self.output.startswith(GAUGES) and self.dimension == "acceleration"

    @property
    def is_nearly_dead(self) -> bool:
        """Whether it is a transmission angle of less than 20 deg."""
        if self.yardstick_kind != "transmission":
            return False
        return min(self.value, pi - self.value) < NEARLY_DEAD

    @property
    def large_from(self) -> float:
        """Ratio from which figures of its kind are large."""
        if self.is_limit or self.is_swing_about_mean:
            return LARGE
        return LARGE_FROM.get(self.yardstick_kind, LARGE)

    @property
    def excess(self) -> float:
        """Ratio of a figure over that from which it is large, by which figures are ranked."""
        return self.ratio / self.large_from

    @property
    def is_large(self) -> bool:
        """Whether it is as large as figures of its kind are from where on they count."""
        return self.excess >= LARGE

    def to_dict(self) -> dict[str, Any]:
        """As plain data, SI units and radians; an infinite ratio as None."""
        return {
            "figure": self.figure,
            "value": self.value,
            "unit": self.unit,
            "yardstick": self.yardstick,
            "against": str(self.against),
            "ratio": self.ratio if isfinite(self.ratio) else None,
            "large": self.is_large,
            "crank_angle": self.crank_angle,
        }


def assess(
    analysis: Analysis, readings: Mapping[str, GaugeReading] | None = None
) -> tuple[FigureAssessment, ...]:
    """Figures of a machine against their yardsticks, the largest first.

    Of each family, such as all joints, the largest member alone; of several rows the figures of
    all rows together.  A machine without masses has figures of motion alone; the tuple is empty
    where no figure has a yardstick.

    Parameters
    ----------
    readings : of gauges by name, as in `Response.gauges`; gauges are left out where not given.
    """
    worst: dict[str, FigureAssessment] = {}
    for assessment in _of_outputs(analysis):
        family = assessment.family[0]
        if family not in worst or assessment.ratio > worst[family].ratio:
            worst[family] = assessment
    entries = [*worst.values(), *_of_contacts(analysis), *capacities(analysis)]
    for name, reading in (readings or {}).items():
        entries += _of_gauge(analysis.machine, name, reading)
    return tuple(sorted(entries, key=lambda entry: -entry.excess))


def assess_parts(analysis: Analysis) -> tuple[FigureAssessment, ...]:
    """Each member of a family, such as every joint, and both components of the force that shakes
    the frame, against the yardstick of the whole; the largest ratio first.
    """
    scales = _Scales(analysis)
    components = [
        _weight(scales, output)
        for output in analysis.outputs
        if _yardstick_of_whole(output) == "weight" and not _is_of_one_row_or_drive(output)
    ]
    entries = [
        *filter(None, components),
        *(of_output for of_output in _of_outputs(analysis) if of_output.item),
    ]
    return tuple(sorted(entries, key=lambda entry: -entry.ratio))


def _of_outputs(analysis: Analysis) -> Iterator[FigureAssessment]:
    """Every output that has a yardstick; of several rows those of all rows together."""
    scales = _Scales(analysis)
    for output in analysis.outputs:
        if output.declared.yardstick and not _is_of_one_row_or_drive(output):
            assessment = OF_OUTPUT[output.declared.yardstick](scales, output)
            if assessment is not None:
                yield assessment


def _yardstick_of_whole(output: AnalysisOutput) -> str:
    """The yardstick of the vector that an output is a component of; empty of what is none."""
    whole = DECLARED.get(output.name.rpartition(".")[0])
    return "" if whole is None or output.declared.part not in ("x", "y") else whole.yardstick


def verdict(entries: tuple[FigureAssessment, ...]) -> FigureAssessment | None:
    """The figure by which a machine is judged first: a limit, else a dyad that is nearly dead, else
    what is largest.  A contact that is kept comes last, as nothing is wrong there, and what bears
    or drives enough is no limit to be named first.

    entries : from `assess`.
    """
    others = [entry for entry in entries if not entry.is_kept_contact]
    limits = (entry for entry in others if entry.is_limit and not entry.is_capacity)
    broken = (entry for entry in others if entry.is_capacity and entry.is_broken)
    nearly_dead = (entry for entry in others if entry.is_nearly_dead)
    largest = others[0] if others else kept_contact(entries)
    return next(broken, next(limits, next(nearly_dead, largest)))


def kept_contact(entries: tuple[FigureAssessment, ...]) -> FigureAssessment | None:
    """Of the followers that stay on their cams, that with the least margin; None without any.

    entries : from `assess`.
    """
    return next((entry for entry in entries if entry.is_kept_contact), None)


def contact_sentence(entry: FigureAssessment) -> str:
    """Up to which speed a contact is kept, and its margin."""
    unit_display = display(entry.dimension, [entry.value], entry.shown_unit)
    return say(
        "The follower of {cam} stays on its cam up to {speed}, {ratio} times the speed of the "
        "crank.",
        cam=named(entry.item),
        speed=unit_display.with_unit(unit_display.text(entry.value, digits=3)),
        ratio=number(1 / entry.ratio, digits=2),
    )


def sentence(entry: FigureAssessment, crank_turns: bool = True) -> str:
    """The figure beside its yardstick, in the language that is spoken; without a point.

    crank_turns : whether the machine's crank turns; if not, a position is an angle of the cycle.
    """
    is_beside = entry.dimension in ANGLES_AND_SPEEDS or entry.is_limit
    both = [entry.value, entry.yardstick] if is_beside else [entry.value]
    unit_display = display(entry.dimension, both, entry.shown_unit)
    values = {
        "what": entry.label.localized(),
        "value": unit_display.with_unit(unit_display.text(entry.value, digits=3)),
        "against": entry.against.localized(),
    }
    values["what"] = capital(values["what"])
    if entry.crank_angle is not None:
        of_crank = to_say("{value} at crank angle {angle}")
        of_cycle = to_say("{value} at {angle} of the cycle")
        at = angle(entry.crank_angle)
        template = of_crank if crank_turns else of_cycle
        values["value"] = say(template, value=values["value"], angle=at)
    if is_beside:
        limit = unit_display.with_unit(unit_display.text(entry.yardstick, digits=3))
        return say("{what}: {value}; {against}: {limit}", limit=limit, **values)
    if entry.ratio >= 1:
        ratio = number(entry.ratio, digits=2)
        return say("{what}: {value}, {ratio} times {against}", ratio=ratio, **values)
    share = percent(entry.ratio, 0 if entry.ratio >= FEW else 1)
    return say("{what}: {value}, {share} % of {against}", share=share, **values)


ANGLES_AND_SPEEDS = ("angle", "angular speed", "speed")
"""Dimensions of figures that are said beside their yardstick, not as a multiple of it."""
FEW = 0.1
"""Share below which a digit more is said."""


def _is_of_one_row_or_drive(output: AnalysisOutput) -> bool:
    """Whether all rows together, or the drives one by one, have the same output."""
    machine = output.analysis.machine
    one_of_drives = bool(machine.listed_drives) and output.name == machine.drive.effort
    return one_of_drives or f"rows.{output.name}" in output.analysis.outputs


# -- yardsticks ------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Scales:
    """Forces and lengths of a machine, SI units, against which figures are measured."""

    analysis: Analysis

    @property
    def machine(self) -> Machine:
        return self.analysis.machine

    @property
    def rows(self) -> int:
        return max(1, len(self.machine.rows))

    @cached_property
    def gravity(self) -> float:
        return hypot(*self.machine.gravity) or hypot(*STANDARD_GRAVITY)

    @cached_property
    def links_weight(self) -> float:
        """Of the moving links of one row."""
        return self.machine.mass * self.gravity

    @cached_property
    def weight(self) -> float:
        """Of the links of all rows, and the support."""
        support = self.machine.support
        carried = 0.0 if support is None else support.mass * self.gravity
        return self.rows * self.links_weight + carried

    @cached_property
    def outer_load(self) -> float:
        """Largest of a load from outside."""
        return _largest(outer_loads(self.analysis.motion))

    @cached_property
    def load(self) -> float:
        """Largest of any load, those that the frame bears too."""
        return max(self.outer_load, _largest(acting_loads(self.analysis.motion)))

    @cached_property
    def steadying(self) -> tuple[float, Note]:
        """The larger of weight and a share of the load from outside, and which it is."""
        if LOAD_SHARE * self.outer_load > self.weight:
            return LOAD_SHARE * self.outer_load, Note("a quarter of the largest load")
        supported = self.machine.support is not None
        return self.weight, Note("the weight of the machine") if supported else Note(LINKS)

    @cached_property
    def lifting(self) -> tuple[float, Note]:
        """The larger of the weight of a row's links and any load, and which it is."""
        if self.load > self.links_weight:
            return self.load, Note("the largest load")
        return self.links_weight, Note(LINKS)

    @cached_property
    def undriven(self) -> tuple[float, Note]:
        """The largest force that acts but for the drive's: weight, load, spring or inertia."""
        force, what = self.lifting
        summary = self.analysis.summary
        each = self.analysis.forces.inertia.values()
        others = {
            to_say("the largest pull of a spring"): max(
                (f.peak for name, f in summary.items() if _is_of(name, "springs", "pull")),
                default=0.0,
            ),
            to_say("the largest force of inertia"): max(_peak(force) for force, _ in each),
        }
        largest = max(others, key=others.__getitem__)
        return (others[largest], Note(largest)) if others[largest] > force else (force, what)

    @cached_property
    def acting(self) -> tuple[float, Note]:
        """The largest of all forces that act, that of the drive too."""
        summary = self.analysis.summary
        pushes = [f.peak for name, f in summary.items()
                  if name == "drive_force" or _is_of(name, "drives", "force")]  # fmt: skip
        torques = [f.peak for name, f in summary.items() if name == "drive_torque"]
        drive = max([*pushes, *(torque / self.throw for torque in torques)], default=0.0)
        force, what = self.undriven
        return (drive, Note("the force of the drive")) if drive > force else (force, what)

    def swings_drive(self, *causes: str) -> bool:
        """Whether causes, such as loads, make nearly all of the swing of the drive's torque."""
        forces, effort = self.analysis.resolved.forces, self.machine.drive.effort
        by_cause = forces.split.by_cause(effort)
        made = [by_cause[cause] for cause in causes if cause in by_cause]
        if not made:
            return False
        swing = forces.motion.figures(np.sum(made, axis=0)).peak_to_peak
        return bool(swing >= BY_LOADS * self.analysis.summary[effort].peak_to_peak)

    @cached_property
    def span(self) -> float:
        """How far apart the feet of the machine are, or its pins in the frame."""
        machine, support = self.machine, self.machine.support
        feet = [] if support is None else [m.point for m in support.mounts.values() if m.point]
        pins = [machine.frame[point] for point in self.analysis.motion.linkage.joints.pins
                if point in machine.frame]  # fmt: skip
        pins += [
            machine.frame[slider.through] for slider in machine.sliders if slider.on == "frame"
        ]
        sizes = (_extent([place[:2] for place in places]) for places in (feet, pins))
        return next((size for size in sizes if size > 0), size_of_links(machine))

    @cached_property
    def span_across(self) -> float:
        """Across the plane: between bearings, of rows or of links; `span` where that is nothing."""
        machine = self.machine
        rows = [row.lateral for row in machine.rows]
        bearings = [bearing.plane for bearing in machine.bearings.values()]
        planes = [z for link in machine.links.values() for z in (link.plane, *link.planes.values())]
        extents = (max(zs) - min(zs) for zs in (rows, bearings, planes) if zs)
        return next((extent for extent in extents if extent > 0), self.span)

    @cached_property
    def throw(self) -> float:
        return throw_of(self.analysis)


LINKS = to_say("the weight of the moving links")


def throw_of(analysis: Analysis) -> float:
    """From the driven link's pin to its farthest point, m; half the largest link without one."""
    machine = analysis.machine
    points = machine.links[machine.drive.link].points
    pivot = complex(*points[analysis.motion.linkage.pivot])
    reach = max(abs(complex(*point) - pivot) for point in points.values())
    return reach or size_of_links(machine) / 2


def _is_of(name: str, group: str, what: str) -> bool:
    """Whether an output is that of a member of a group, such as ``springs.1.pull``."""
    return name.startswith(f"{group}.") and name.endswith(f".{what}")


def _peak(force: Any) -> float:
    return float(np.max(np.abs(force)))


def _largest(loads: Any) -> float:
    return max((_peak(force) for _, _, force, _ in loads), default=0.0)


def _extent(places: list[Any]) -> float:
    """Largest distance of any two places."""
    points = np.array([complex(*place) for place in places])
    return float(np.max(np.abs(points[:, None] - points), initial=0.0))


# -- figures of outputs ----------------------------------------------------------------------------


def _entry(
    output: AnalysisOutput,
    measure: str,
    yardstick: float,
    against: Note,
    ratio: float | None = None,
) -> FigureAssessment | None:
    """A figure of an output; None where there is no yardstick, or it is nothing beside that."""
    figures = output.figures
    value = float(getattr(figures, measure))
    assert output.dimension is not None
    if ratio is None:
        if not abs(value) > NOTHING * yardstick > 0:
            return None
        ratio = abs(value) / yardstick
    places = {"peak": "peak_at", "max": "max_at", "min": "min_at"}
    at = getattr(figures, places.get(measure, "peak_at"))
    pusher = pusher_of(output.analysis.machine, output.name)
    what = output.declared.note(output.item)
    if pusher is not None:
        what = Note("force of the {what}", what=pushing(pusher))
    label = Note("{what}, {part}", what=what, part=Note(FIGURES[measure]))
    return FigureAssessment(
        f"{output.name}.{measure}", label, value, output.dimension, yardstick, against, ratio,
        output.name, output.item, float(at),
    )  # fmt: skip


def pusher_of(machine: Machine, output: str) -> Drive | FurtherDrive | None:
    """The drive whose force an output is: a cylinder, which pushes and turns nothing."""
    each = {f"drives.{item.link}.force": item for item in machine.driven if item.pushes}
    first = {machine.drive.effort: machine.drive} if machine.drive.pushes else {}
    return (each | first).get(output)


def _weight(scales: _Scales, output: AnalysisOutput) -> FigureAssessment | None:
    return _entry(output, "peak", *scales.steadying)


def _couple(scales: _Scales, output: AnalysisOutput, span: float) -> FigureAssessment | None:
    force, what = scales.steadying
    return _entry(output, "peak", force * span, Note("{force} at the span", force=what))


def _effort(scales: _Scales, output: AnalysisOutput) -> FigureAssessment | None:
    rows = 1 if output.declared.is_of_row else scales.rows
    if output.dimension == "force":
        force, what = scales.lifting
        return _entry(output, "peak", rows * force, what)
    torque = output.analysis.summary[output.name]
    mean = abs(torque.mean)
    lifted = rows * scales.links_weight * scales.throw
    working = ["resistance"]
    if lifted < TRIFLE * torque.peak_to_peak:
        working.append("load")
    if scales.swings_drive(*working):
        lifted = 0.0
    if mean >= max(lifted, LEAST_MEAN * torque.rms):
        uneven = speed_fluctuation(output.analysis)
        if uneven is None or not 0 < uneven <= STEADY:
            return _entry(output, "peak_to_peak", mean, Note(MEAN))
        carried = torque.peak_to_peak * STEADY / uneven
        return _entry(output, "peak_to_peak", carried, _carried(uneven))
    force, what = scales.undriven
    against = Note("{force} at the throw of the crank", force=what)
    return _entry(output, "peak_to_peak", rows * force * scales.throw, against)


def _carried(uneven: float) -> Note:
    """What a torque that swings is held against where the speed fluctuates by a small share."""
    return Note(
        "what the turning masses even out to a speed fluctuation of {most} %; it is {share} %",
        most=percent(STEADY),
        share=percent(uneven, 1),
    )


def _acting(scales: _Scales, output: AnalysisOutput) -> FigureAssessment | None:
    return _entry(output, "peak", *scales.acting)


def _pressure(scales: _Scales, output: AnalysisOutput) -> FigureAssessment | None:
    (coupling,) = (item for item in scales.machine.couplings if item.name == output.item)
    return _entry(output, "peak", coupling.usual_pressure_angle, Note("the usual limit"))


def _transmission(scales: _Scales, output: AnalysisOutput) -> FigureAssessment | None:
    groups = scales.analysis.motion.linkage.groups
    if output.item in {group.joint for group in groups if group.through}:
        return None  # other joints carry it through its dead position
    figures = output.analysis.summary[output.name]
    is_stretched = figures.max - pi / 2 > pi / 2 - figures.min
    measure = "max" if is_stretched else "min"
    limit = pi - TRANSMISSION if is_stretched else TRANSMISSION
    ratio = abs(getattr(figures, measure) - pi / 2) / (pi / 2 - TRANSMISSION)
    return _entry(output, measure, limit, Note("the usual limit"), ratio)


OF_OUTPUT: Mapping[str, Callable[[_Scales, AnalysisOutput], FigureAssessment | None]] = {
    "weight": _weight,
    "span": lambda scales, output: _couple(scales, output, scales.span),
    "bearings": lambda scales, output: _couple(scales, output, scales.span_across),
    "effort": _effort,
    "acting": _acting,
    "pressure": _pressure,
    "transmission": _transmission,
}
"""How an output is assessed, by the yardstick that it is declared with."""


# -- figures of parts and gauges -------------------------------------------------------------------


def _of_contacts(analysis: Analysis) -> Iterator[FigureAssessment]:
    """Speeds from which contacts are lost, against the speed at which the crank turns."""
    if not analysis.machine.crank_turns:
        return
    speed = abs(analysis.motion.speed)
    for table, name, figures in figures_by_name(analysis):
        for item in declared_figures(type(figures)):
            at, limit = item.metadata["limits_crank"], getattr(figures, item.name)
            if not at or limit is None:
                continue
            ratio = speed / limit if limit else float("inf")
            yield FigureAssessment(
                f"{table}.{name}.{item.name}", Note(item.metadata["label"]), limit,
                item.metadata["dimension"], speed, Note("the speed of the crank"), ratio,
                f"{table}.{name}", name, getattr(figures, at), is_limit=True, is_contact=True,
                shown_unit="rpm",
            )  # fmt: skip


def capacities(analysis: Analysis) -> Iterator[FigureAssessment]:
    """What parts bear and the motor gives, against what the machine asks of them; of each figure
    that of the weakest part.
    """
    figures: list[FigureAssessment] = []
    for name, section in analysis.sections.items():
        figures += _least_figures("sections", name, section, analysis.machine.links[name].section)
    joints = joint_properties(analysis.motion) if analysis.rolling_bearings else {}
    for name, bearing in analysis.rolling_bearings.items():
        figures += _least_figures("rolling_bearings", name, bearing, joints[name][1].bearing)
    weakest: dict[str, FigureAssessment] = {}
    for assessment in figures:
        kind = assessment.family[1]
        if kind not in weakest or assessment.ratio > weakest[kind].ratio:
            weakest[kind] = assessment
    yield from weakest.values()
    yield from _of_motor(analysis)


def _least_figures(group: str, name: str, figures: Any, part: Any) -> Iterator[FigureAssessment]:
    """Figures of a part that are declared with what they have to be at least.

    part : what the file gives of it.
    """
    for item in declared_figures(type(figures)):
        least, value = least_value(item, part), getattr(figures, item.name)
        if least is None or value is None:
            continue
        dimension = item.metadata["dimension"]
        what = Note(
            "{what}, {part}", what=Note(item.metadata["label"]), part=PartName(name, joint_named)
        )
        ratio = least / value if value > 0 else float("inf")
        output = f"{group}.{name}"
        yield FigureAssessment(
            f"{output}.{item.name}", what, value, dimension, least, Note("required minimum"), ratio,
            output, name, is_limit=True, is_capacity=True,
            shown_unit="h" if dimension == "time" else None,
        )  # fmt: skip


def _of_motor(analysis: Analysis) -> Iterator[FigureAssessment]:
    """The mean torque of the drive, against the largest that the motor has at the crank."""
    motor, driven = analysis.machine.drive.motor, motor_torque(analysis.machine, analysis.outputs)
    if motor is None or driven is None:
        return
    (torque, needed), most = driven, motor.ratio * motor.largest_torque
    if needed <= 0:
        return
    yield FigureAssessment(
        f"{torque.name}.mean", Note("{what}, {part}", what=Note("drive torque"), part=Note("mean")),
        torque.figures.mean, "torque", most, Note("the largest torque of the motor at the crank"),
        needed / most, "drive.motor", is_limit=True, is_capacity=True,
    )  # fmt: skip


def _of_gauge(machine: Machine, name: str, reading: GaugeReading) -> Iterator[FigureAssessment]:
    """What a gauge reads against the limits that the file gives, the daily exposure of a hand that
    holds the machine there, or its velocity where there is neither.
    """
    output = f"gauges.{name}"
    if (hand := reading.hand) is not None:
        yield FigureAssessment(
            f"{output}.hand.a8",
            Note("daily exposure A(8) of the hand at {name}, {verdict}", name=name,
                 verdict=hand.verdict),
            hand.a8, "acceleration", hand.limit, Note("limit value"), hand.a8 / hand.limit,
            output, name, is_limit=True, shown_unit="m/s^2",
        )  # fmt: skip
    what = DECLARED["gauges.{}"].note(name)
    dimension: Dimension = "angle" if reading.rotation else "length"
    limits = machine.balance.limits if machine.balance else ()
    read = {"peak_to_peak": "peak_to_peak", "ripple": "vibration_rms"}
    known = [item for item in limits if item.objective.output == output and item.at_most is not None
             and item.objective.measure in read and not item.objective.orders]  # fmt: skip
    for limit in known:
        measure, most = limit.objective.measure, limit.at_most or 0.0
        value = float(getattr(reading.displacement, read[measure]))
        path = "rms" if measure == "ripple" else measure
        label = Note("{what}, {part}", what=what, part=Note(FIGURES[measure]))
        ratio = value / most if most else float("inf")
        yield FigureAssessment(
            f"{output}.{path}", label, value, dimension, most, Note("its limit"), ratio,
            output, name, is_limit=True,
        )  # fmt: skip
    assert machine.support is not None
    on_hands = any(gauge.exposure is not None for gauge in machine.support.gauges.values())
    if known or on_hands or unbalances(machine):  # a rotor may be meant to shake the machine
        return
    rate: Dimension = "angular speed" if reading.rotation else "speed"
    most = VIBRATION / (_reach_of_support(machine) if reading.rotation else 1.0)
    value = float(reading.velocity.vibration_rms)
    label = Note("velocity at {name}, RMS", name=name)
    of_turns = Note("what moves the farthest mount at the limit of ISO 20816-3")
    against = Note("the limit of ISO 20816-3 for lasting operation")
    against = of_turns if reading.rotation else against
    yield FigureAssessment(
        f"{output}.velocity.rms", label, value, rate, most, against, value / most, output, name,
        shown_unit=None if reading.rotation else "mm/s",
    )  # fmt: skip


def _reach_of_support(machine: Machine) -> float:
    """From the centre of mass of the support to the farthest point at which it is held, m."""
    support = machine.support
    assert support is not None
    places = [mount.point for mount in support.mounts.values()]
    places += [gauge.point for gauge in support.gauges.values()]
    positions = [place for place in places if place is not None]
    center = np.array(support.center_of_mass)
    reach = max(
        (float(np.linalg.norm(np.array(point) - center)) for point in positions), default=0.0
    )
    return reach or size_of_links(machine)
