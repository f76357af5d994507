"""Headline figures of a machine: its figures against their yardsticks, and what may not grow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from equipoise.balancing.beyond_masses import Beyond
from equipoise.balancing.problem import Problem
from equipoise.balancing.remedies import HeadlineLimit
from equipoise.errors import ModelError, ResponseError
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.objectives import GAUGES, MEASURES, ROWS
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.yardsticks import FigureAssessment, assess, assess_parts
from equipoise.vibration.forced import respond

GROWTH, GROWTH_OF_PART, TRIFLE = 1.01, 1.05, 0.1
"""Times its value before, a headline figure may be after, and that of a single joint or component,
of which the life of a bearing falls by a seventh; share of its yardstick up to which a figure may
grow."""
Assessment = tuple[FigureAssessment, ...]
Pairs = tuple[tuple[FigureAssessment, FigureAssessment], ...]
"""Figures before and after."""


@dataclass(frozen=True)
class Advice:
    """What an advised machine is judged by.

    before, after : figures against their yardsticks, the largest first.
    worse : figures that are worse, before and after: headline figures, single joints, components.
    offered : whether the remedy gains enough for its mass, and leaves no figure worse.
    beyond : what helps beyond masses.
    """

    before: tuple[FigureAssessment, ...]
    after: tuple[FigureAssessment, ...]
    worse: Pairs
    offered: bool
    beyond: Beyond


@dataclass(frozen=True, eq=False)
class AssessedMachine:
    """A machine at constant speed, and its figures against their yardsticks.

    headline : the largest of each family.  parts : single joints, and components of forces.
    """

    analysis: Analysis
    headline: Assessment
    parts: Assessment

    def worse_in(self, after: AssessedMachine) -> Pairs:
        """Figures that are worse in another machine, headline figures first."""
        whole = worse_headlines(self.headline, after.headline)
        known = {new.figure for _, new in whole}
        parts = worse_parts(self.parts, after.parts)
        return (*whole, *(pair for pair in parts if pair[1].figure not in known))


def assessed(machine: Machine) -> AssessedMachine:
    """A machine at constant speed against its yardsticks."""
    analysis = analyze(machine, acceleration=0.0)
    readings = None
    if machine.support is not None and machine.support.gauges:
        try:
            readings = respond(machine).gauges
        except (ModelError, ResponseError):  # without a steady state gauges tell nothing
            readings = None
    return AssessedMachine(analysis, assess(analysis, readings), assess_parts(analysis))


def worse_headlines(before: Assessment, after: Assessment) -> Pairs:
    """Figures of two assessments that grew by more than 1 %, each before and after.

    What stays below a tenth of its yardstick is no headline.  What was nothing is worse where it
    becomes large.  Yardsticks are those before, which the change itself may have moved.
    """
    old = {one.family: one for one in before}
    pairs = ((old.get(new.family, replace(new, value=0.0, ratio=0.0)), new) for new in after)
    return tuple((was, new) for was, new in pairs if _is_worse(was, new))


def _is_worse(was: FigureAssessment, new: FigureAssessment) -> bool:
    if not was.ratio:
        return new.is_large
    return _ratio(was, new) > allowed_ratio(was)


def worse_parts(
    before: Assessment, after: Assessment
) -> Iterator[tuple[FigureAssessment, FigureAssessment]]:
    """Single joints and components that grew by more than 5 %, each before and after."""
    old = {one.figure: one for one in before}
    for new in after:
        was = old.get(new.figure)
        if was is not None and _ratio(was, new) > allowed_ratio(was, GROWTH_OF_PART):
            yield was, new


def allowed_ratio(was: FigureAssessment, growth: float = GROWTH) -> float:
    """The ratio that a figure may have after a change."""
    return max(growth * was.ratio, TRIFLE)


def _ratio(was: FigureAssessment, new: FigureAssessment) -> float:
    """The ratio of a figure after a change, by the yardstick before."""
    by_value = not new.is_limit and bool(was.value)
    return was.ratio * abs(new.value / was.value) if by_value else new.ratio


def watched_of(found: AssessedMachine) -> Iterator[HeadlineLimit]:
    """Figures that masses change, and the most that they may become."""
    for one in found.headline:
        if one.output.startswith(GAUGES):
            yield from _watched_gauge(found.analysis.machine, one)
            continue
        members = [out.name for out in found.analysis.outputs if out.declared.name == one.family[0]]
        yield from _watched(one, members, GROWTH)
    for one in found.parts:
        yield from _watched(one, [one.output], GROWTH_OF_PART)


def _watched(one: FigureAssessment, outputs: list[str], growth: float) -> Iterator[HeadlineLimit]:
    """What the largest of some outputs may become; nothing where masses do not change it."""
    known, measure = declared(one.output), one.family[1]
    if known is None or known[0].reason or measure not in MEASURES:
        return
    objectives = tuple(Objective(name.removeprefix(ROWS), measure) for name in outputs)
    yield HeadlineLimit(objectives, allowed_ratio(one, growth) * abs(one.value) / one.ratio)


def _watched_gauge(machine: Machine, one: FigureAssessment) -> Iterator[HeadlineLimit]:
    """What a gauge reads at the machine's own speed."""
    for objective in (Objective(one.output, "ripple"), Objective(one.output, "peak_to_peak")):
        yield HeadlineLimit((objective,), GROWTH * Problem.value_of(machine, objective))


def headline_objectives(entries: Assessment) -> tuple[Objective, ...]:
    """The largest figure that can be an objective; the shaking force where there is none."""
    for one in entries:
        known, measure = declared(one.output), one.figure.rpartition(".")[2]
        gauge = one.output.startswith(GAUGES)
        if gauge:
            return (Objective(one.output, "ripple"),)
        if known is not None and not known[0].reason and measure in MEASURES:
            name = one.output.removeprefix(ROWS)
            return (Objective(name, measure),)
    return (Objective("shaking_force"),)
