"""The picture of what to change: masses, moves, gears, shafts and springs to scale."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.workshop import Change
from equipoise.figures.changes import changes, grams, sector
from equipoise.figures.linkage import linkage
from equipoise.figures.sheet import box_of
from equipoise.results.charts import Chart, Outline
from unit.figures.balance_samples import (
    MM,
    STEEL,
    balanced_case,
)
from unit.figures.checks import Laid
from unit.figures.samples import words


@cache
def changes_of(kind: str) -> Chart:
    return changes(balanced_case(kind))


def curves(chart: Chart, role: str) -> list[np.ndarray]:
    """Lines of a role as complex numbers, mm."""
    (panel,) = chart.panels
    return [MM * (curve.x + 1j * curve.y) for curve in panel.curves if curve.role == role]


def springs(chart: Chart) -> list[np.ndarray]:
    (panel,) = chart.panels
    return [MM * shape.places for shape in panel.signs if shape.role == "added"]


def crank_angle(kind: str) -> float:
    """At which the picture says that it shows the machine, rad."""
    match = re.search(r"in the frame: ([0-9.]+)°", words(changes_of(kind)))
    assert match is not None
    return float(np.radians(float(match[1])))


def at_pose(kind: str, link: str, place: tuple[float, float]) -> complex:
    """Where a place of a link is in the frame at that angle, mm, by its point and angle."""
    machine = balanced_case(kind).machine
    motion = eq.move(machine, np.array([crank_angle(kind)]))
    name, own = next(iter(machine.links[link].points.items()))
    turned = np.exp(1j * motion.links[link].angle[0])
    there = motion.points[name].place[0] + turned * (complex(*place) - complex(*own))
    return complex(MM * there)


def moments(outline: Outline) -> tuple[float, complex]:
    """Area, mm2, and its centre, of an outline less its holes."""
    area, first = 0.0, 0j
    for sign, places in ((1, outline.places), *((-1, hole) for hole in outline.holes)):
        z = MM * places
        cross = (np.conj(z[:-1]) * z[1:]).imag
        whole = float(np.sum(cross)) / 2
        sense = sign * np.sign(whole)
        area += sense * whole
        first += sense * complex(np.sum((z[:-1] + z[1:]) * cross)) / 6
    return area, first / area


@pytest.mark.exhaustive(but=["ring", "one of each", "sector"])
@pytest.mark.parametrize("kind", ["sector", "one of each", "ring", "geared"])
def test_plates_are_to_scale(kind: str) -> None:
    """What is filled has the area of the piece, and its centre is the centre of mass."""
    result = balanced_case(kind)
    drawn = changes_of(kind).panels[0].outlines
    cut = [
        (change.link, piece)
        for change in result.changes
        for piece in change.values.get("pieces", ())
        if piece["shape"] != "point"
    ]
    assert len(drawn) == len(cut) > 0
    for outline, (link, piece) in zip(drawn, cut, strict=True):
        area, middle = moments(outline)
        assert area * 1e-6 == pytest.approx(piece["mass"] / (STEEL * 0.02), rel=2e-3)
        assert middle == pytest.approx(at_pose(kind, link, piece["place"]), abs=0.1)
        assert f"{MM * piece['mass']:.4g} g on {link}" in words(changes_of(kind))


def test_points_and_moved_centres() -> None:
    result = balanced_case("one of each")
    (panel,) = changes_of("one of each").panels
    by_kind = {change.kind + change.link: change for change in result.changes}
    move = by_kind["center of masscoupler"].values
    ends = [at_pose("one of each", "coupler", move[k]) for k in ("from", "to")]
    (drawn,) = panel.arrows
    assert [MM * drawn.tail, MM * drawn.head] == pytest.approx(ends)
    dots = [MM * complex(mark.x, mark.y) for mark in panel.marks if mark.role == "point mass"]
    for piece in by_kind["added massrocker"].values["pieces"]:
        place = at_pose("one of each", "rocker", piece["place"])
        assert min(abs(place - dot) for dot in dots) < 1e-6
    arms = curves(changes_of("one of each"), "arm")  # which say of which link each of them is
    assert [arm[1] for arm in arms] == pytest.approx(dots) and len(arms) > 0
    assert f"coupler, {MM * move['mass']:.4g} g" in words(changes_of("one of each"))


def test_rooms() -> None:
    circle, other, box = curves(changes_of("one of each"), "room")
    assert np.abs(circle) == pytest.approx(60.0)
    pivot = MM * complex(*eq.load("yamashita-1").frame["D"])
    assert np.abs(other - pivot) == pytest.approx(50.0)
    assert np.abs(np.diff(box)) == pytest.approx([100, 60, 100, 60])
    (round_about,) = curves(changes_of("moved"), "room")
    middle = at_pose("moved", "coupler", (0, 0))
    assert np.abs(round_about - middle) == pytest.approx(30.0)


def test_the_pose_is_that_of_the_linkages_picture() -> None:
    """Of a machine that has gears already, which are told apart from new ones."""
    machine = eq.load("geared-counterweight")
    weight = eq.balancing.AddedMass("crank", "O2", eq.balancing.Weight("point", 0.03))
    force = eq.balancing.Objective("shaking_force")
    chart = changes(
        eq.balance(machine, eq.balancing.Balance(masses=(weight,), objectives=(force,)))
    )
    angle = re.search(r"in the frame: [0-9.]+°", words(chart))
    assert angle and angle[0] in words(linkage(eq.analyze(machine, 720)))
    parts = words(chart).split("\n")
    for name in ("added mass", "room allowed", "pitch circles of gears"):
        assert parts.count(name) == 1
    assert "pitch circles of new gears" not in parts


def test_gears_touch() -> None:
    result = balanced_case("geared")
    driver, shaft = curves(changes_of("geared"), "gear")
    values = result.changes[0].values
    middles = [np.mean(circle[:-1]) for circle in (driver, shaft)]
    assert middles[1] == pytest.approx(MM * complex(*values["axis"]))
    radii = [float(np.mean(np.abs(c - m))) for c, m in zip((driver, shaft), middles, strict=True)]
    assert radii == pytest.approx([50.0, 50.0 / 0.6])
    assert abs(middles[1] - middles[0]) == pytest.approx(sum(radii))


def test_weights_on_shafts() -> None:
    rooms = curves(changes_of("shafts"), "room")
    assert [np.mean(room[:-1]) for room in rooms] == pytest.approx([50 + 50j, 150 + 50j])
    assert "on balance-shaft-2" in words(changes_of("shafts"))


def test_springs() -> None:
    result = balanced_case("spring")
    (spring_drawn,) = springs(changes_of("spring"))
    spring = result.machine.springs[-1]
    ends = [at_pose("spring", "rocker", result.machine.links["rocker"].points["C"]), 50 + 120j]
    assert spring_drawn[[0, -1]] == pytest.approx(np.array(ends))
    panel = changes_of("spring").panels[0]
    stands = [item.places[0] for item in (*panel.ground, *panel.signs) if item.role == "stand"]
    assert any(abs(MM * place - ends[1]) < 1e-6 for place in stands)  # so it is held in the frame
    assert f"{spring.stiffness:.4g} N/m" in words(changes_of("spring"))
    values = {"point": "C", "to": "S", "stiffness": 21530.0, "free_length": 0.1}
    stiff = changes(replace(result, changes=(Change("spring", "rocker", values),)))
    assert "21.53 kN/m, 100 mm free" in words(stiff)
    none = Change("spring", "rocker", {"point": "C", "to": "S", "stiffness": 0.0, "free_length": 0})
    chart = changes(replace(result, changes=(none,)))
    assert not springs(chart) and "Nothing to change" in words(chart)


def test_nothing_to_add() -> None:
    result = balanced_case("sector")
    (change,) = result.changes
    none = replace(change, values={**change.values, "pieces": [], "mass": 0.0})
    chart = changes(replace(result, changes=(none,)))
    assert not chart.panels[0].outlines and "Nothing to change" in words(chart)
    assert "What to change" in words(changes_of("sector"))


def test_a_room_far_larger_than_the_machine_leaves_it_its_scale() -> None:
    result = balanced_case("sector")
    (mass,) = result.plan.masses
    wide = replace(mass, weight=replace(mass.weight, radius=30.0))
    (panel,) = changes(replace(result, plan=replace(result.plan, masses=(wide,)))).panels
    usual = changes_of("sector").panels[0].x
    assert (panel.x.low, panel.x.high) == pytest.approx((usual.low, usual.high), rel=1e-2)


def test_two_points_at_one_place_share_a_label() -> None:
    result = balanced_case("one of each")
    change = next(change for change in result.changes if change.link == "rocker")
    piece = {"shape": "point", "mass": 0.2, "place": (0.0, 0.0)}
    twins = replace(change, values={**change.values, "pieces": [piece, piece]})
    assert "2 × 200 g on rocker" in words(changes(replace(result, changes=(twins,))))


def test_masses_in_words() -> None:
    assert [grams(mass) for mass in (0.0123, 1.5, 12.0)] == ["12.3 g", "1500 g", "12 kg"]


def test_a_sector_without_a_hole_ends_in_a_point() -> None:
    assert 0j in sector(0j, 0.0, 1.0, 0.3, 1.0)
    assert np.min(np.abs(sector(0j, 0.5, 1.0, 0.3, 1.0))) == pytest.approx(0.5)


def test_labels_of_weights_are_nearest_to_their_own() -> None:
    """And on none of them: beside the crank's half disc is the sector of a shaft."""
    chart = changes(eq.balance(eq.load("balance-shafts")))
    laid = Laid.of(chart)
    ((view, _),) = laid.panels
    edges = [
        view.places(outline.places.real, outline.places.imag) for outline in view.panel.outlines
    ]
    starts = [mark for mark in view.panel.marks if " g on " in mark.text]
    assert len(edges) == len(starts) == 3
    for number, mark in enumerate(starts):
        at = view.places(np.array([mark.x]), np.array([mark.y]))[0]
        apart = [float(np.min(np.hypot(*(edge - at).T))) for edge in edges]
        assert int(np.argmin(apart)) == number
        others = [size for k, size in enumerate(apart) if k != number]
        assert min(others) > 30
    for text in laid.sheet.words:
        if " g on " in text.text or text.text.endswith("-axis"):
            left, top, right, bottom = box_of(text)
            for edge in edges:
                inside = (left < edge[:, 0]) & (edge[:, 0] < right)
                inside &= (top < edge[:, 1]) & (edge[:, 1] < bottom)
                assert not np.any(inside), text.text
