"""Pictures of balancing: pieces, gears and springs to scale, cranks of rows, trade-offs."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.text import Text

import equipoise as eq
from equipoise.balancing.design_variables import Change
from equipoise.balancing.pareto import Front
from equipoise.figures.additions import grams, sector
from equipoise.figures.changes import changes_figure
from equipoise.plotting.analysis import linkage_figure
from equipoise.plotting.balancing import drawings
from equipoise.plotting.balancing.front import front_figure
from equipoise.plotting.style import styled
from unit.plotting.balance_samples import (
    MM,
    STEEL,
    arrows,
    found,
    front,
    in_rows,
    labelled,
    line,
    phasing,
    pictures,
)
from unit.plotting.samples import words
from unit.plotting.vibration_samples import check_texts


def key(figure: Figure) -> list[tuple[Text, Any]]:
    """Names and signs of a legend."""
    (legend,) = figure.legends
    return list(zip(legend.get_texts(), legend.legend_handles, strict=True))


def crank_angle(kind: str) -> float:
    """At which the picture says that it shows the machine, rad."""
    told = re.search(r"in the frame: ([0-9.]+)°", words(pictures(kind)["changes"]))
    assert told is not None
    return float(np.radians(float(told[1])))


def at_pose(kind: str, link: str, place: tuple[float, float]) -> complex:
    """Where a place of a link is in the frame at that angle, mm, by its point and angle."""
    machine = found(kind).machine
    motion = eq.move(machine, np.array([crank_angle(kind)]))
    name, own = next(iter(machine.links[link].points.items()))
    turned = np.exp(1j * motion.links[link].angle[0])
    there = motion.points[name].place[0] + turned * (complex(*place) - complex(*own))
    return complex(MM * there)


# -- changes ---------------------------------------------------------------------------------------


def shapes(axes: Axes) -> list[PathPatch]:
    return [one for one in axes.patches if isinstance(one, PathPatch) and one.get_alpha()]


def moments(patch: PathPatch) -> tuple[float, complex]:
    """Area, mm2, and its centre, of outlines less holes."""
    area, first = 0.0, 0j
    for corners in patch.get_path().to_polygons():
        z = corners[:, 0] + 1j * corners[:, 1]
        cross = (np.conj(z[:-1]) * z[1:]).imag
        area += float(np.sum(cross)) / 2
        first += complex(np.sum((z[:-1] + z[1:]) * cross)) / 6
    return abs(area), first / area


@pytest.mark.parametrize("kind", ["sector", "one of each", "ring", "geared"])
def test_plates_are_to_scale(kind: str) -> None:
    """What is filled has the area of the piece, and its centre is the centre of mass."""
    result = found(kind)
    drawn = shapes(pictures(kind)["changes"].axes[0])
    cut = [
        (change.link, piece)
        for change in result.changes
        for piece in change.values.get("pieces", ())
        if piece["shape"] != "point"
    ]
    assert len(drawn) == len(cut) > 0
    for patch, (link, piece) in zip(drawn, cut, strict=True):
        area, middle = moments(patch)
        assert area * 1e-6 == pytest.approx(piece["mass"] / (STEEL * 0.02), rel=2e-3)
        assert middle == pytest.approx(at_pose(kind, link, piece["place"]), abs=0.1)
        assert f"{MM * piece['mass']:.4g} g on {link}" in words(pictures(kind)["changes"])


def test_points_and_moved_centres() -> None:
    result = found("one of each")
    axes = pictures("one of each")["changes"].axes[0]
    by_kind = {change.kind + change.link: change for change in result.changes}
    move = by_kind["center of masscoupler"].values
    ends = [at_pose("one of each", "coupler", move[k]) for k in ("from", "to")]
    (drawn,) = arrows(axes)
    assert list(drawn) == pytest.approx(ends)
    dots = [complex(line(axes, k)[0]) for k in range(len(axes.lines)) if len(line(axes, k)) == 1]
    for piece in by_kind["added massrocker"].values["pieces"]:
        place = at_pose("one of each", "rocker", piece["place"])
        assert min(abs(place - dot) for dot in dots) < 1e-6
    assert f"coupler, {MM * move['mass']:.4g} g" in words(pictures("one of each")["changes"])


def test_rooms() -> None:
    circle, other, box = labelled(pictures("one of each")["changes"].axes[0], "room")
    assert np.abs(circle) == pytest.approx(60.0)
    pivot = MM * complex(*eq.load("yamashita-1").frame["D"])
    assert np.abs(other - pivot) == pytest.approx(50.0)
    assert np.abs(np.diff(box)) == pytest.approx([100, 60, 100, 60])
    (round_about,) = labelled(pictures("moved")["changes"].axes[0], "room")
    middle = at_pose("moved", "coupler", (0, 0))
    assert np.abs(round_about - middle) == pytest.approx(30.0)


def test_the_pose_is_that_of_the_linkages_picture() -> None:
    """Of a machine that has gears already, which are told apart from new ones."""
    machine = eq.load("geared-counterweight")
    weight = eq.balancing.AddedMass("crank", "O2", eq.balancing.Weight("point", 0.03))
    result = eq.balance(
        machine,
        eq.balancing.Balance(
            masses=(weight,), objectives=(eq.balancing.Objective("shaking_force"),)
        ),
    )
    with styled():
        figure = changes_figure(result)
    angle = re.search(r"in the frame: [0-9.]+°", words(figure))
    assert angle and angle[0] in words(linkage_figure(eq.analyze(machine, 720)))
    signs = {text.get_text(): sign for text, sign in key(figure)}
    assert {"added mass", "room allowed", "pitch circles of gears"} == signs.keys()
    assert signs["added mass"].get_marker() == "o"


def test_gears_touch() -> None:
    result = found("geared")
    driver, shaft = labelled(pictures("geared")["changes"].axes[0], "gear")
    values = result.changes[0].values
    middles = [np.mean(circle[:-1]) for circle in (driver, shaft)]
    assert middles[1] == pytest.approx(MM * complex(*values["axis"]))
    radii = [float(np.mean(np.abs(c - m))) for c, m in zip((driver, shaft), middles, strict=True)]
    assert radii == pytest.approx([50.0, 50.0 / 0.6])
    assert abs(middles[1] - middles[0]) == pytest.approx(sum(radii))


def test_weights_on_shafts() -> None:
    axes = pictures("shafts")["changes"].axes[0]
    rooms = labelled(axes, "room")
    assert [np.mean(room[:-1]) for room in rooms] == pytest.approx([50 + 50j, 150 + 50j])
    assert "on balance-shaft-2" in words(pictures("shafts")["changes"])


def test_springs() -> None:
    result = found("spring")
    (drawn,) = labelled(pictures("spring")["changes"].axes[0], "spring")
    spring = result.machine.springs[-1]
    ends = [
        at_pose("spring", "rocker", result.machine.links["rocker"].points["C"]),
        50 + 120j,
    ]
    assert drawn[[0, -1]] == pytest.approx(np.array(ends))
    assert f"{spring.stiffness:.4g} N/m" in words(pictures("spring")["changes"])
    none = Change("spring", "rocker", {"point": "C", "to": "S", "stiffness": 0.0, "free_length": 0})
    figure = drawings(replace(result, changes=(none,)))["changes"]
    assert not labelled(figure.axes[0], "spring") and "Nothing to change" in words(figure)


def test_nothing_to_add() -> None:
    result = found("sector")
    (change,) = result.changes
    none = replace(change, values={**change.values, "pieces": [], "mass": 0.0})
    figure = drawings(replace(result, changes=(none,)))["changes"]
    check_texts("nothing", figure)
    assert not shapes(figure.axes[0]) and "Nothing to change" in words(figure)
    assert "What to change" in words(pictures("sector")["changes"])


def test_a_room_far_larger_than_the_machine_leaves_it_its_scale() -> None:
    result = found("sector")
    (mass,) = result.plan.masses
    wide = replace(mass, weight=replace(mass.weight, radius=30.0))
    axes = drawings(replace(result, plan=replace(result.plan, masses=(wide,))))["changes"].axes[0]
    assert axes.get_xlim() == pictures("sector")["changes"].axes[0].get_xlim()


def test_two_points_at_one_place_share_a_label() -> None:
    result = found("one of each")
    change = next(change for change in result.changes if change.link == "rocker")
    piece = {"shape": "point", "mass": 0.2, "place": (0.0, 0.0)}
    twins = replace(change, values={**change.values, "pieces": [piece, piece]})
    assert "2 × 200 g on rocker" in words(drawings(replace(result, changes=(twins,)))["changes"])


def test_masses_in_words() -> None:
    assert [grams(mass) for mass in (0.0123, 1.5, 12.0)] == ["12.3 g", "1500 g", "12 kg"]


def test_a_sector_without_a_hole_ends_in_a_point() -> None:
    assert 0j in sector(0j, 0.0, 1.0, 0.3, 1.0)
    assert np.min(np.abs(sector(0j, 0.5, 1.0, 0.3, 1.0))) == pytest.approx(0.5)


# -- phases ----------------------------------------------------------------------------------------


def test_hands_are_the_cranks() -> None:
    result = in_rows()
    figure = pictures("rows")["phases"]
    order = np.argsort([row.lateral for row in result.machine.rows], kind="stable")
    for axes, k in zip(figure.axes, order, strict=True):
        hands = arrows(axes)
        phases = [machine.rows[k].phase for machine in (result.original, result.machine)]
        assert [head for _, head in hands] == pytest.approx([np.exp(1j * phi) for phi in phases])
        told = "\n".join(text.get_text() for text in axes.texts)
        assert f"row {k + 1}\n" in told and f"{MM * result.machine.rows[k].lateral:.4g} mm" in told
        assert f"after {round(np.degrees(phases[1]), 2) % 360:.4g}°" in told
    assert list(order) != sorted(order)


def test_rows_together() -> None:
    result = in_rows()
    one = eq.forces(eq.move(result.original, 720)).shaking_force
    for axes, signal in zip(pictures("rows")["rows"].axes, (one.x, one.y), strict=True):
        drawn = line(axes, 1)
        phases = [row.phase for row in result.machine.rows]
        angles = np.radians(drawn.real)
        grid = np.arange(721) * (2 * np.pi / 720)
        closed = np.append(signal, signal[0])
        total = sum(np.interp((angles + phi) % (2 * np.pi), grid, closed) for phi in phases)
        assert np.max(np.abs(drawn.imag - total)) < 2e-3 * np.max(np.abs(signal))
        np.testing.assert_allclose(line(axes, 0).imag[:-1], 4 * signal, atol=1e-6)


def test_phases_without_the_machine_before() -> None:
    drawn = pictures("phases")
    assert "before" not in words(drawn["phases"]) + words(drawn["rows"])
    both = drawings(phasing(), in_rows().original)
    assert words(both["phases"]) == words(pictures("rows")["phases"])


def test_many_rows_stand_in_several_lines() -> None:
    figure = pictures("rows, many")["phases"]
    bottoms = {round(axes.get_position().y0, 6) for axes in figure.axes}
    assert len(figure.axes) == 14 and len(bottoms) == 3


def test_signals_of_one_of_several_rows_say_so() -> None:
    assert "of one row" in words(pictures("rows, both")["force"])
    assert "of one row" not in words(pictures("sector")["force"])


# -- front -----------------------------------------------------------------------------------------


def test_front_goes_through_its_points() -> None:
    axes = pictures("front")["front"].axes[0]
    drawn = line(axes)
    np.testing.assert_allclose(drawn, front().values @ [1, 1j], rtol=1e-12)
    assert axes.get_xlabel() == "shaking moment, RMS, N m"
    assert axes.get_ylabel() == "drive torque, RMS, N m"
    x, y = front().values[0]
    assert f"{x:.4g} N m, {y:.4g} N m" in words(pictures("front")["front"])


def test_the_machine_as_it_is() -> None:
    result = front()
    (moment, torque) = (
        eq.balance(result.original, replace(result.points[0].plan, objectives=(o,)))
        for o in (result.first, result.second)
    )
    before = complex(
        moment.objectives[result.first.name][0], torque.objectives[result.second.name][0]
    )
    assert "far off" in words(pictures("front")["front"])
    assert not labelled(pictures("front")["front"].axes[0], "as it is")
    wide = replace(result, values=result.values * [[1, 1], [1, 1], [1, 1], [3, 3]])
    with styled():
        figure = front_figure(wide)
    check_texts("wide front", figure)
    (place,) = labelled(figure.axes[0], "as it is")
    assert complex(place[0]) == pytest.approx(before)
    assert "far off" not in words(figure)
    (left, right), (bottom, top) = figure.axes[0].get_xlim(), figure.axes[0].get_ylim()
    assert left < before.real < right and bottom < before.imag < top


def test_lengths_in_mm_and_added_mass() -> None:
    rig = eq.load("balance-rig")
    gauge = eq.balancing.Objective("gauges.gauge", "peak_to_peak")
    values = np.array([[0.010, 0.5], [0.012, 0.4]])
    result = Front(
        rig, gauge, eq.balancing.Objective("drive_torque"), (found("sector"),) * 2, values
    )
    figure = drawings(result)["front"]
    check_texts("front of a gauge", figure)
    axes = figure.axes[0]
    assert axes.get_xlabel() == "gauge gauge, peak to peak, mm"
    np.testing.assert_allclose(line(axes), values @ [MM, 1j])
    assert f"with {grams(found('sector').added_mass)} more" in words(figure)
