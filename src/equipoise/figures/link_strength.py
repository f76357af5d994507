"""Charts of links with a section: loads along each where its stress is largest, and the cycles of
its stress in Haigh's diagram.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.chart_parts import ROOM, degrees_text, settled, title
from equipoise.figures.motion import FORBIDDEN
from equipoise.figures.style import KINDS, short
from equipoise.i18n import say, to_say
from equipoise.mechanism.dynamics.link_stress import (
    FatiguePlace,
    StressPeak,
    amplitudes_about_zero,
    largest_stress,
)
from equipoise.results.charts import Axis, Chart, Curve, Line, Mark, Panel, four_digits, quantity
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.mechanism.parts.sections import LinkSection
    from equipoise.quantities import Dimension
    from equipoise.results.analysis import Analysis

ALONG = (
    to_say("axial force"),
    to_say("shear force"),
    to_say("bending moment"),
    to_say("stress"),
)
"""What is drawn along a link, a panel each."""
CAPTIONS = {
    "stress": to_say(
        "Loads along the link and its stress, at the crank angle at which that is largest."
    ),
    "haigh": to_say("Haigh diagram: mean and amplitude of cycles of stress, and their limits."),
}
"""Kind of chart -> what it is."""
HEIGHT = 74.0
"""Points of each of the panels below each other."""
ASIDE = 30.0
"""Degrees above or below the axis in which the largest stress is written beside the line of its
place.
"""
LEAST = 1e-6
"""Over the largest force on a link, below which a load is none beside it."""


def link_charts(analysis: Analysis) -> Iterator[Chart]:
    """``stress-LINK`` of every link with a section, and ``haigh-LINK`` of those with a fatigue
    limit; none where the crank is not turned evenly, or the crank angles are no whole cycle.
    """
    for name in analysis.sections:
        yield along_link(analysis, name)
        if has_limit(analysis, name):
            yield haigh_diagram(analysis, name)


def has_limit(analysis: Analysis, name: str) -> bool:
    """Whether a link has a limit of fatigue, to which its cycles of stress can be held."""
    return _section(analysis, name).fatigue_limit is not None


def _section(analysis: Analysis, name: str) -> LinkSection:
    section = analysis.machine.links[name].section
    assert section is not None
    return section


def _chart(analysis: Analysis, kind: str, name: str, what: str, panels: Sequence[Panel]) -> Chart:
    own = f"{kind}-{name.translate(FORBIDDEN)}"
    return Chart(own, analysis.machine.title, what, tuple(panels), caption=CAPTIONS[kind])


# -- along a link ----------------------------------------------------------------------------------


def along_link(analysis: Analysis, name: str) -> Chart:
    """Axial force, shear force, bending moment and stress over the distance from the first point,
    at the crank angle, and in the duty state, of the largest stress.
    """
    state, peak = largest_stress(analysis.resolved.forces, name)
    motion = state.forces.motion
    at, forces, moment, stress = _loads_at(peak)
    first, last = _section(analysis, name).ends(analysis.machine.links[name].points)
    label = say("distance from {point} towards {end}", point=short(first), end=short(last))
    x = Axis.of(label, "length", unit="mm", low=0.0, high=peak.loads.length)
    place = Line(peak.place, "now", say("largest stress"))
    loads: tuple[tuple[str, str, Dimension, Array], ...] = (
        (say("Axial force, tension positive"), say("force"), "force", forces.real),
        (say("Shear force, to the left of the line positive"), say("force"), "force", forces.imag),
        (say("Bending moment, counterclockwise positive"), say("moment"), "torque", moment),
    )
    panels = [
        _panel(x, heading, Axis.of(quantity_label, dimension, values, room=ROOM), at, values, place)
        for heading, quantity_label, dimension, values in loads
    ]
    panels.append(_stress_panel(x, at, stress, peak, place))
    angle = degrees_text(float(motion.crank_angle[peak.angle]))
    what = say("Loads along {link} at crank angle {angle}", link=short(name), angle=angle)
    return _chart(
        analysis, "stress", name, title(analysis, what, of_one=True, speed=motion.speed), panels
    )


def _loads_at(peak: StressPeak) -> tuple[Array, Array, Array, Array]:
    """Places (K,), forces along and to the left of the line (K,), complex, moments (K,), and
    stresses (2, K) of all cuts, at the crank angle of the largest stress; next to none as 0.
    """
    loads, n = peak.loads, peak.angle
    cuts = sorted(loads.cuts, key=lambda cut: (cut.at[n], cut.behind))
    each = [loads.in_cut(cut) for cut in cuts]
    force = max(float(np.max(np.abs(own))) for _, own, _ in loads.ends)
    torque = max(float(np.max(np.abs(own))) for *_, own in loads.ends)
    least = LEAST * force, LEAST * (torque + force * loads.length)
    forces = settled(np.array([item.axial[n] + 1j * item.shear[n] for item in each]), least[0])
    moment = settled(np.array([item.bending[n] for item in each]), least[1])
    stress = np.array([loads.in_fibres(item)[:, n] for item in each]).T
    return np.array([float(cut.at[n]) for cut in cuts]), forces, moment, stress


def _panel(x: Axis, heading: str, y: Axis, at: Array, values: Array, place: Line) -> Panel:
    message = "" if np.any(values) else say("zero all along")
    curves, lines = (Curve(at, values, "", "main"),), (place,)
    return Panel(x, y, curves, (), (), lines, title=heading, message=message, height=HEIGHT)


def _stress_panel(x: Axis, at: Array, stress: Array, peak: StressPeak, place: Line) -> Panel:
    """Stress in both outermost fibres, with the largest of all marked."""
    y = Axis.of(say("stress"), "modulus", stress, "MPa", room=ROOM)
    names = say("left fibre"), say("right fibre")
    curves = tuple(
        Curve(at, values, fibre, f"several {number}")
        for number, (fibre, values) in enumerate(zip(names, stress, strict=True), 1)
    )
    text = say("{value} at {place}", value=y.quantity(peak.stress), place=x.quantity(peak.place))
    clear_side = (
        ASIDE if peak.place < peak.loads.length / 2 else 180.0 - ASIDE
    )  # of the place's line
    wish = clear_side if peak.stress > 0 else -clear_side
    mark = Mark(peak.place, peak.stress, text, curves[peak.side].role, wish)
    heading = say("Stress in the outermost fibres, tension positive")
    return Panel(x, y, curves, (mark,), (), (place,), title=heading, height=HEIGHT)


# -- Haigh's diagram -------------------------------------------------------------------------------


def haigh_diagram(analysis: Analysis, name: str) -> Chart:
    """Mean and amplitude of each cycle of stress where one comes nearest to the fatigue limit, and
    that limit and the yield strength, as far as they are given.
    """
    section, place = _section(analysis, name), analysis.sections[name].critical_place
    assert section.fatigue_limit is not None and place is not None
    means = np.concatenate([cycles.means for cycles in place.cycles])
    amplitudes = np.concatenate([cycles.ranges for cycles in place.cycles]) / 2
    high = 1.15 * max(section.fatigue_limit, float(np.max(amplitudes, initial=0.0)))
    limits = (*_limits(section, means, high),)
    every = np.concatenate([means, *(limit.x for limit in limits)])
    x = Axis.of(say("mean stress"), "modulus", every, "MPa")
    y = Axis.of(say("amplitude of stress"), "modulus", every, "MPa", low=0.0, high=high)
    panel = Panel(x, y, limits, (*_cycle_marks(place, section),))
    first = section.ends(analysis.machine.links[name].points)[0]
    at = quantity(float(place.cut.at[0]), "length", "mm")
    values = {"link": short(name), "distance": at, "point": short(first)}
    what = say("Cycles of stress in {link}, {distance} from {point}", **values)
    if analysis.machine.duty:
        what = say("{what}, over {count} duty states", what=what, count=len(place.cycles))
    else:
        what = title(analysis, what, of_one=True)
    return _chart(analysis, "haigh", name, what, [panel])


def _limits(section: LinkSection, means: Array, high: float) -> Iterator[Curve]:
    """Amplitudes over mean stress up to which a link lasts, and up to which it does not yield, as
    far as they lie below `high`, Pa.
    """
    limit, tensile, yields = section.fatigue_limit, section.tensile_strength, section.yield_strength
    assert limit is not None
    size = yields or limit
    low = min(-size, 1.1 * float(np.min(means, initial=0.0)))
    if tensile is None:
        end = max(size, 1.1 * float(np.max(means, initial=0.0)))
        ends = np.array([low, end]), np.array([limit, limit])
    else:
        ends = np.array([low, 0.0, tensile]), np.array([limit, limit, 0.0])
    yield Curve(*ends, say("fatigue limit"), "limit")
    if yields is not None:
        top = min(high, yields)
        places = np.array([-yields, top - yields, 0.0, yields - top, yields])
        peak = yields if yields <= high else np.nan
        yield Curve(places, np.array([0.0, top, peak, top, 0.0]), say("yielding"), "action value")


def _cycle_marks(place: FatiguePlace, section: LinkSection) -> Iterator[Mark]:
    """A sign for each cycle, of each duty state its own, with the safety of the worst of all."""
    limit, worst = section.fatigue_limit, place.largest(section.tensile_strength)
    assert limit is not None
    for number, cycles in enumerate(place.cycles):
        label = say("cycles of stress")
        if len(place.cycles) > 1:
            label = say("cycles in duty state {number}", number=number + 1)
        effects = amplitudes_about_zero(cycles, section.tensile_strength)
        for mean, size, effect in zip(cycles.means, cycles.ranges, effects, strict=True):
            text = ""
            if effect == worst and np.isfinite(worst):
                text, worst = say("safety {value}", value=four_digits(limit / effect)), np.inf
            role = f"cycles {number % len(KINDS)}"
            yield Mark(float(mean), float(size) / 2, text, role, label=label)
