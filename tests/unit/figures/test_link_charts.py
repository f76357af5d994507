"""Charts of links with sections, against equilibrium of the whole link and Goodman's line by hand.

Joint forces are those that the analysis reports; what mass along the line needs is integrated from
the accelerations of both ends, as of any rigid body.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.link_strength import link_charts
from equipoise.figures.sheet import Words, box_of
from equipoise.i18n import speaking
from equipoise.mechanism.dynamics.section_loads import MassAlongLine
from equipoise.results.charts import Chart, Panel
from unit.figures.checks import Laid, check
from unit.figures.link_samples import DUTY, analysis_of, engine, pictures
from unit.figures.samples import words

ROD = 0.09
"""m, of the engine."""


def loads_of(chart: Chart) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places, axial and shear force as a complex number, and bending moment."""
    axial, shear, bending = (panel.curves[0] for panel in chart.panels[:3])
    return axial.x, axial.y + 1j * shear.y, bending.y


def marked(panel: Panel) -> tuple[float, float]:
    (mark,) = panel.marks
    return mark.x, mark.y


def test_names() -> None:
    assert [*pictures("engine")] == ["stress-crank", "haigh-crank", "stress-rod", "haigh-rod"]
    assert [*analysis_of("engine").pictures][-4:] == [*pictures("engine")]
    endless = eq.analyze(engine(fatigue_limit=None, tensile_strength=None), 90)
    assert [chart.name for chart in link_charts(endless)][2:] == ["stress-rod"]
    assert not [*link_charts(eq.analyze(engine(), [0.1, 0.2]))]


def test_joint_forces_and_mass_along_the_rod_hold_its_loads() -> None:
    """From one end to the other the axial and shear force change by what its mass needs, and end
    as the joint force there; the moment grows by the shear force, and ends at nothing.
    """
    analysis = analysis_of("engine").resolved
    at, force, bending = loads_of(pictures("engine")["stress-rod"])
    motion, angle = analysis.motion, analysis_of("engine").sections["rod"].stress_at
    n = int(np.argmin(np.abs(motion.crank_angle - angle)))
    turn = np.exp(1j * motion.links["rod"].angle[n])
    own = {}
    for name in "BC":
        joint = analysis.forces.joints[name]
        own[name] = (1 if joint.on == "rod" else -1) * joint.value[n] / turn
    begin, end = (motion.points[name].acceleration_vector[n] / turn for name in "BC")
    gravity = complex(*analysis.machine.gravity) / turn
    mass = MassAlongLine.of_link(analysis.machine.links["rod"])
    size = abs(own["B"])

    inside = (at > 0) & (at < ROD)
    assert np.count_nonzero(inside) >= 39
    share = at[inside] / ROD
    # of the lump at the first end, and of the rod from there to a cut, by the accelerations of
    # both: integral of the straight line between them
    needs = mass.first * (begin - gravity)
    needs = needs + mass.rod * share * ((begin - gravity) + (end - begin) * share / 2)
    # the part before a cut: joint force plus what the part behind exerts is mass times acceleration
    assert np.max(np.abs(own["B"] + force[inside] - needs)) < 1e-9 * size
    all_of_it = mass.first * begin + mass.last * end + mass.rod * (begin + end) / 2
    all_of_it -= (mass.first + mass.last + mass.rod) * gravity
    assert abs(own["B"] + own["C"] - all_of_it) < 1e-9 * size
    assert abs(force[-1]) < 1e-9 * size and abs(bending[-1]) < 1e-9 * size * ROD
    # Simpson's rule is exact: shear is a parabola, as spread mass has a straight line of inertia
    middle = own["B"] + mass.first * (gravity - begin)
    for (s, t), (m, w) in zip(pairwise(at[inside]), pairwise(bending[inside]), strict=True):
        between = np.array([s, (s + t) / 2, t]) / ROD
        shear = -(middle + mass.rod * between * (gravity - begin - (end - begin) * between / 2))
        grown = -(t - s) * (shear[0] + 4 * shear[1] + shear[2]).imag / 6
        assert w - m == pytest.approx(grown, abs=1e-9 * size * ROD)


@pytest.mark.parametrize("kind", ["engine", "duty", "shaper"])
def test_the_place_marked_has_the_largest_stress_of_all(kind: str) -> None:
    """Its value follows from the loads that are drawn there; none of the cycle is larger."""
    analysis = analysis_of(kind)
    for name, figures in analysis.sections.items():
        chart = pictures(kind)[f"stress-{name}"]
        place, value = marked(chart.panels[3])
        assert place == figures.place and abs(value) == pytest.approx(figures.stress)
        assert all(panel.lines[0].at == place for panel in chart.panels)
        section = analysis.machine.links[name].section
        assert section is not None and section.height is not None and section.width is not None
        area = section.height * section.width
        at, force, bending = loads_of(chart)
        bent = bending / (area * section.height / 6)
        for sign, curve in zip((-1, 1), chart.panels[3].curves, strict=True):
            own = np.abs(curve.y - (force.real / area + sign * bent))
            assert np.max(own) < 1e-5 * figures.stress  # next to no force is drawn as none
        peaks = [float(np.max(np.abs(curve.y))) for curve in chart.panels[3].curves]
        assert max(peaks) == pytest.approx(figures.stress)
        assert np.all(np.diff(at) >= 0) and at[0] == 0


def test_the_largest_stress_is_written_beside_the_line_of_its_place() -> None:
    """That line went through its letters."""
    for name, kind in (("stress-rod", "engine"), ("stress-connecting-link", "shaper")):
        view, items = Laid.of(pictures(kind)[name]).panels[-1]
        (line,), (mark,) = view.panel.lines, view.panel.marks
        (text,) = (item for item in items if isinstance(item, Words) and item.text == mark.text)
        left, _, right, _ = box_of(text)
        assert not left < float(view.x.at(line.at)) < right


def test_the_state_of_the_duty_is_that_of_the_largest_stress() -> None:
    stresses = []
    for state in DUTY:
        machine = engine()
        speed = machine.drive.speed if state.speed is None else state.speed
        alone = replace(machine, loads=state.scaled(machine.loads)).with_drive(speed=speed)
        stresses.append(eq.analyze(alone, 360).sections["rod"].stress)
    assert int(np.argmax(stresses)) == 2
    chart = pictures("duty")["stress-rod"]
    assert abs(marked(chart.panels[3])[1]) == pytest.approx(stresses[2])
    assert "at 6800 rpm" in words(chart)


@pytest.mark.parametrize("kind", ["engine", "duty", "weak", "bare"])
def test_safety_is_that_of_goodmans_line(kind: str) -> None:
    """The fatigue limit at a cycle's mean over its amplitude is not the safety; the line through
    the cycle that ends at the same tensile strength has it, at a mean of 0.
    """
    analysis = analysis_of(kind)
    (panel,) = pictures(kind)["haigh-rod"].panels
    section = analysis.machine.links["rod"].section
    assert section is not None and section.fatigue_limit is not None
    lines = []
    for mark in panel.marks:
        amplitude = mark.y
        if section.tensile_strength is not None and mark.x > 0:
            slope = mark.y / (section.tensile_strength - mark.x)
            amplitude = slope * section.tensile_strength
        lines.append(amplitude)
    safety = section.fatigue_limit / max(lines)
    assert safety == pytest.approx(analysis.sections["rod"].fatigue_safety)
    (worst,) = (mark for mark in panel.marks if mark.text)
    assert lines[panel.marks.index(worst)] == max(lines)
    assert worst.text == f"safety {safety:.4g}"
    limit = panel.curves[0]
    assert limit.y[0] == section.fatigue_limit
    assert (limit.x[-1], limit.y[-1]) == (section.tensile_strength, 0) or kind == "bare"
    assert len({mark.label for mark in panel.marks}) == (3 if kind == "duty" else 1)
    if kind == "bare":
        assert len(panel.curves) == 1 and np.all(limit.y == section.fatigue_limit)
        return
    # nowhere on the line of yielding is the largest stress of a cycle below the strength
    yields = panel.curves[1]
    known = np.isfinite(yields.y)
    assert np.abs(yields.x[known]) + yields.y[known] == pytest.approx(section.yield_strength)


def test_largest_cycle_is_from_the_lowest_to_the_highest_stress() -> None:
    (panel,) = pictures("engine")["haigh-rod"].panels
    (worst,) = (mark for mark in panel.marks if mark.text)
    loads = analysis_of("engine").resolved.forces.sections["rod"]
    low, high = np.min(loads.stresses, axis=2), np.max(loads.stresses, axis=2)
    swings = (high - low) / 2 / (1 - np.maximum(high + low, 0) / 2 / 510e6)
    side, k = np.unravel_index(int(np.argmax(swings)), swings.shape)
    assert worst.x == pytest.approx((high + low)[side, k] / 2)
    assert worst.y == pytest.approx((high - low)[side, k] / 2)


@pytest.mark.parametrize("language", ["de", "ja", "ko"])
def test_they_speak_other_languages(language: str) -> None:
    machine = replace(engine(), duty=DUTY)
    with speaking(language):
        drawn = [*link_charts(eq.analyze(machine, 90))]
        for chart in drawn:
            check(chart)
            assert "stress" not in words(chart)
    assert len(drawn) == 4
