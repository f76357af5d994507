"""Headline figures of a machine: its figures against their yardsticks, and what may not grow."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from equipoise.balancing.beyond_masses import Beyond
from equipoise.balancing.policy import (
    COUPLE_FROM_NOTHING,
    GROWTH_OF_GAIN,
    GROWTH_OF_SAVED,
    HEADLINE_GROWTH,
    PART_GROWTH,
    SMALL_FIGURE,
    TRIFLE,
)
from equipoise.balancing.problem import Problem
from equipoise.dataclass import dataclass
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.balance import GAUGES, MEASURES, ROWS, Limit, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.rotors import unbalances
from equipoise.results.yardsticks import FigureAssessment, assess, assess_parts
from equipoise.signals import Array
from equipoise.vibration.forced import readings_of

Assessment = tuple[FigureAssessment, ...]
AssessmentPair = tuple[FigureAssessment, FigureAssessment]
Pairs = tuple[AssessmentPair, ...]
"""Figures before and after."""


@dataclass(frozen=True)
class Advice:
    """What an advised machine is judged by.

    before, after : figures against their yardsticks, the largest first.
    worse : figures that are worse, before and after: headline figures, single joints, components.
    offered : whether the remedy gains enough for its mass, and leaves no figure worse.
    beyond : what helps beyond masses.
    requested : whether the objectives are the user's, and not the largest figures.
    """

    before: tuple[FigureAssessment, ...]
    after: tuple[FigureAssessment, ...]
    worse: Pairs
    offered: bool
    beyond: Beyond
    requested: bool


@dataclass(frozen=True)
class Saving:
    """What a remedy takes away, beside which the growth of other figures is judged.

    gain : share of the aims that is gone.  excess : of the largest aim as it was, over what is
        large of its kind.  force, moment : RMS of what shakes that is gone, N and N m; None where
        that is not the aim.  force_yardstick : against which the force is large, N.
    steadies : whether the aim is a torque: what makes that even may not shake the machine more.
    """

    gain: float = 0.0
    excess: float = 0.0
    force: float | None = None
    moment: float | None = None
    force_yardstick: float = 0.0
    steadies: bool = False

    def moment_against(self, couple: FigureAssessment) -> float:
        """What is gone as a moment, N m, RMS: a force at the arm that the couple acts at.

        Endless where the aim is neither.
        """
        if self.moment is not None:
            return self.moment
        if self.force is not None:
            return self.force * couple.yardstick / self.force_yardstick
        return float("inf")


@dataclass(frozen=True, eq=False)
class AssessedMachine:
    """A machine at constant speed, and its figures against their yardsticks.

    headline : the largest of each family.  parts : single joints, and components of forces.
    """

    analysis: Analysis
    headline: Assessment
    parts: Assessment

    def worse_in(self, after: AssessedMachine, saving: Saving) -> Pairs:
        """Figures that are worse in another machine, couples first, then headline figures."""
        couples = tuple(self._couples_made(after, saving))
        whole = (*couples, *worse_headlines(self.headline, after.headline, saving))
        parts = worse_parts(self.parts, after.parts, saving)
        known = {new.figure: (was, new) for was, new in reversed((*whole, *parts))}
        return tuple(reversed(known.values()))

    def _couples_made(self, after: AssessedMachine, saving: Saving) -> Iterator[AssessmentPair]:
        """Moments that were as good as nothing, and are larger now than what is saved."""
        for new in after.headline:
            if new.is_shaking and new.dimension == "torque":
                was, now = (_rms(item.analysis, new.output) for item in (self, after))
                if was <= COUPLE_FROM_NOTHING * now and now - was > saving.moment_against(new):
                    yield _before(self.headline, new), new

    def aims(self, objectives: Iterable[Objective]) -> Iterator[tuple[Objective, FigureAssessment]]:
        """Aims that are headline figures, and these."""
        # Reversed, for the largest entry of an output with several to remain.
        entries = {item.output: item for item in reversed(self.headline)}
        for objective in objectives:
            for name in (f"{ROWS}{objective.output}", objective.output):
                if name in entries:
                    yield objective, entries[name]
                    break

    def largest_aim(self, objectives: Iterable[Objective]) -> FigureAssessment | None:
        """The headline figure for which objectives stand; None where it is none."""
        entries = (entry for _, entry in self.aims(objectives))
        return max(entries, key=lambda item: item.excess, default=None)

    def figure_gain(self, objectives: Iterable[Objective], after: AssessedMachine) -> float:
        """Share of the largest figure of objectives, in its own measure, that is gone in another
        machine; 1 where they are none.
        """
        aim = self.largest_aim(objectives)
        if aim is None or not aim.ratio:
            return 1.0
        new = next((item for item in after.headline if item.family == aim.family), None)
        return 1.0 if new is None else 1 - _ratio(aim, new) / aim.ratio

    def saving(self, objectives: Mapping[Objective, tuple[float, float]], gain: float) -> Saving:
        """What a remedy takes away of aims, each before and after in SI units."""
        gone = [
            (objectives[item][0] - objectives[item][1], entry)
            for item, entry in self.aims(objectives)
            if entry.is_shaking
        ]
        forces = [(value, item.yardstick) for value, item in gone if item.dimension == "force"]
        moments = [value for value, item in gone if item.dimension == "torque"]
        force, yardstick = max(forces, default=(None, 0.0))
        largest = self.largest_aim(objectives)
        excess = 0.0 if largest is None else largest.excess
        steadies = largest is not None and not largest.is_shaking
        return Saving(gain, excess, force, max(moments, default=None), yardstick, steadies)


def assessed(machine: Machine) -> AssessedMachine:
    """A machine at constant speed against its yardsticks."""
    analysis = analyze(machine, acceleration=0.0)
    readings = readings_of(machine, machine.drive.speed)
    return AssessedMachine(analysis, assess(analysis, readings), assess_parts(analysis))


def worse_headlines(before: Assessment, after: Assessment, saving: Saving) -> Pairs:
    """Figures of two assessments that grew by more than they may, each before and after.

    Yardsticks are those before, which the change itself may have moved.
    """
    pairs = ((_before(before, new), new) for new in after)
    return tuple((was, new) for was, new in pairs if _ratio(was, new) > allowed_ratio(was, saving))


def _before(before: Assessment, new: FigureAssessment) -> FigureAssessment:
    """The figure of the same family before; 0 where there was none."""
    same = (item for item in before if item.family == new.family)
    return next(same, replace(new, value=0.0, ratio=0.0))


def worse_parts(before: Assessment, after: Assessment, saving: Saving) -> Iterator[AssessmentPair]:
    """Single joints and components that grew by more than they may, each before and after."""
    old = {item.figure: item for item in before}
    for new in after:
        was = old.get(new.figure)
        if was is not None and _ratio(was, new) > allowed_ratio(was, saving, PART_GROWTH):
            yield was, new


def allowed_ratio(was: FigureAssessment, saving: Saving, growth: float = HEADLINE_GROWTH) -> float:
    """The ratio that a figure may have after a change: what it was, and a little more; or more of
    what is small and stays small.
    """
    gain = np.array(saving.gain)
    return float(allowed_ratios(was, gain, saving.excess, growth, saving.steadies))


def allowed_ratios(
    was: FigureAssessment, gain: Array, excess: float, growth: float, steadies: bool = False
) -> Array:
    """Ratios (...) that a figure may have after many changes.

    gain : share (...) that each takes off the aims.  excess : of the largest of them.
    steadies : whether they are of a torque, for which nothing that shakes may grow.
    """
    excess = 0.0 if steadies and was.is_shaking else excess
    permitted = was.excess + GROWTH_OF_GAIN * gain * min(was.excess, excess)
    grown = np.maximum(growth * was.excess, permitted)
    small = np.minimum(SMALL_FIGURE, was.excess + GROWTH_OF_SAVED * gain * excess)
    return np.asarray(np.maximum(np.maximum(grown, small) * was.large_from, TRIFLE))


def _rms(analysis: Analysis, output: str) -> float:
    """RMS; 0 of what a machine does not have."""
    return float(analysis.outputs[output].figures.rms) if output in analysis.outputs else 0.0


def _ratio(was: FigureAssessment, new: FigureAssessment) -> float:
    """The ratio of a figure after a change, by the yardstick before."""
    by_value = not new.is_limit and bool(was.value)
    return was.ratio * abs(new.value / was.value) if by_value else new.ratio


@dataclass(frozen=True)
class HeadlineLimit:
    """A figure that may not grow by more than beside a gain.

    objectives : the figure of each member of a family, of which the largest counts.
    at_most : SI units, whatever is gained.
    entry : the figure as it is, of one that may grow with what is gained; growth : times its value,
        it may be in any case.
    """

    objectives: tuple[Objective, ...]
    at_most: float = 0.0
    entry: FigureAssessment | None = None
    growth: float = HEADLINE_GROWTH

    def most(self, gain: Array, excess: float, steadies: bool = False) -> Array:
        """What the figure may become (...), SI units, where shares (...) of aims of an excess are
        gone; steadies : whether these are of a torque.
        """
        if self.entry is None:
            return np.full(np.shape(gain), self.at_most)
        ratio = allowed_ratios(self.entry, gain, excess, self.growth, steadies)
        return np.asarray(ratio * abs(self.entry.value) / self.entry.ratio)

    def limits(
        self, gain: float = 0.0, excess: float = 0.0, steadies: bool = False
    ) -> Iterator[Limit]:
        """Limits of a plan where a share of aims of an excess is gone."""
        at_most = float(self.most(np.array(gain), excess, steadies))
        yield from (Limit(objective, at_most=at_most) for objective in self.objectives)


def watched_of(assessed: AssessedMachine) -> Iterator[HeadlineLimit]:
    """Figures that masses change, and the most that they may become."""
    for part in assessed.headline:
        if part.output.startswith(GAUGES):
            continue
        members = [
            out.name for out in assessed.analysis.outputs if out.declared.name == part.family[0]
        ]
        yield from _watched(part, members, HEADLINE_GROWTH)
    for part in assessed.parts:
        yield from _watched(part, [part.output], PART_GROWTH)
    yield from _watched_gauges(assessed)


def _watched(
    assessment: FigureAssessment, outputs: list[str], growth: float
) -> Iterator[HeadlineLimit]:
    """What the largest of some outputs may become; nothing where masses do not change it."""
    known, measure = declared(assessment.output), assessment.family[1]
    if known is None or known[0].reason or measure not in MEASURES:
        return
    objectives = tuple(Objective(name.removeprefix(ROWS), measure) for name in outputs)
    yield HeadlineLimit(objectives, entry=assessment, growth=growth)


def _watched_gauges(assessed: AssessedMachine) -> Iterator[HeadlineLimit]:
    """What gauges read at the machine's own speed: those that are judged, and beside them, where
    no rotor is there to shake, those that are not, as none is but by its limit or its hand where a
    hand holds the machine.
    """
    machine = assessed.analysis.machine
    judged = [item.output for item in assessed.headline if item.output.startswith(GAUGES)]
    names = dict.fromkeys(judged)
    if judged and machine.support is not None and not unbalances(machine):
        names |= dict.fromkeys(f"{GAUGES}{name}" for name in machine.support.readings)
    ratios = {item.output: item.ratio for item in assessed.headline}
    for name in names:
        ratio = ratios.get(name, TRIFLE)
        if not ratio:
            continue  # what it is read against after a change holds it down
        # A trifle may grow to one, as in `allowed_ratios`: a reading that is rounding would else
        # forbid every change.
        growth = max(HEADLINE_GROWTH, TRIFLE / ratio)
        for objective in (Objective(name, "ripple"), Objective(name, "peak_to_peak")):
            most = growth * Problem.value_of(machine, objective)
            yield HeadlineLimit((objective,), most)


def headline_objectives(entries: Assessment) -> tuple[Objective, ...]:
    """The largest figure that can be an objective; the shaking force where there is none."""
    for entry in entries:
        known, measure = declared(entry.output), entry.figure.rpartition(".")[2]
        gauge = entry.output.startswith(GAUGES)
        if gauge:
            return (Objective(entry.output, "ripple"),)
        if known is not None and not known[0].reason and measure in MEASURES:
            name = entry.output.removeprefix(ROWS)
            return (Objective(name, measure),)
    return (Objective("shaking_force"),)
