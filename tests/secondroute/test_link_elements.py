"""Loads along a link as a file of finite elements, read back and solved by beam elements of the
tests: forces and moments in them are those that the link cut there has.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

import equipoise as eq
from equipoise.mechanism.dynamics.section_loads import Cut, SectionLoads
from equipoise.mechanism.parts.sections import LinkSection
from support.refusals import refused

Array = np.ndarray[Any, Any]
STEEL = LinkSection(None, "22 mm", "10 mm", elastic_modulus="206 GPa")


@dataclass
class BeamFile:
    """What a file of beams holds.

    nodes : number -> place along x.  elements : their first and last nodes.  section : its kind
    and sizes.  modulus : Pa.  held : (node, freedom).  steps : loads by (node, freedom) of each.
    """

    nodes: dict[int, float]
    elements: list[tuple[int, int]]
    section: tuple[str, list[float]]
    modulus: float
    held: list[tuple[int, int]]
    steps: list[dict[tuple[int, int], float]]


def read_beams(text: str) -> BeamFile:
    """Read an input file of CalculiX by its keywords."""
    result = BeamFile({}, [], ("", []), 0.0, [], [])
    keyword, kind = "", ""
    for line in text.splitlines():
        assert line.isascii() and len(line) <= 80
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            keyword = line.partition(",")[0]
            kind = line.rpartition("SECTION=")[2] if keyword == "*BEAM SECTION" else kind
            if keyword == "*STEP":
                result.steps.append({})
            continue
        cells = [cell.strip() for cell in line.split(",")]
        assert keyword == "*HEADING" or all(len(cell) <= 20 for cell in cells)
        if keyword == "*NODE":
            result.nodes[int(cells[0])] = float(cells[1])
        elif keyword == "*ELEMENT":
            result.elements.append((int(cells[1]), int(cells[3])))
        elif keyword == "*BEAM SECTION" and not result.section[0]:
            result.section = kind, [float(cell) for cell in cells]
        elif keyword == "*ELASTIC":
            result.modulus = float(cells[0])
        elif keyword == "*BOUNDARY":
            first, last = int(cells[1]), int(cells[2])
            result.held += [(int(cells[0]), k) for k in range(first, last + 1)]
        elif keyword == "*CLOAD":
            result.steps[-1][int(cells[0]), int(cells[1])] = float(cells[2])
    return result


def stiffness(length: float, stretching: float, bending: float) -> Array:
    """Of a straight beam in its plane (6, 6): along, across and turned, at both its ends."""
    a, b = stretching / length, bending / length**3
    across = b * np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, 4 * length**2, -6 * length, 2 * length**2],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, 2 * length**2, -6 * length, 4 * length**2],
        ]
    )
    whole = np.zeros((6, 6))
    whole[np.ix_([0, 3], [0, 3])] = a * np.array([[1, -1], [-1, 1]])
    whole[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = across
    return whole


def solved(beams: BeamFile, loads: dict[tuple[int, int], float]) -> tuple[Array, Array, Array]:
    """Displacements (P, 3), forces at both ends of elements (E, 6), and what supports bear."""
    kind, (wide, high, *_) = beams.section
    assert kind == "RECT"
    area, second = wide * high, wide * high**3 / 12
    ends = sorted({node for pair in beams.elements for node in pair})
    number = {node: n for n, node in enumerate(ends)}
    rows, columns, values, own = [], [], [], []
    for first, last in beams.elements:
        length = beams.nodes[last] - beams.nodes[first]
        each = stiffness(length, beams.modulus * area, beams.modulus * second)
        where = [3 * number[node] + k for node in (first, last) for k in range(3)]
        rows += np.repeat(where, 6).tolist()
        columns += np.tile(where, 6).tolist()
        values += each.ravel().tolist()
        own.append((where, each))
    size = 3 * len(ends)
    whole = coo_array((values, (rows, columns)), shape=(size, size)).tocsc()
    planar = {1: 0, 2: 1, 6: 2}
    given = np.zeros(size)
    for (node, freedom), value in loads.items():
        given[3 * number[node] + planar[freedom]] += value
    held = [3 * number[node] + planar[k] for node, k in beams.held if k in planar]
    free = np.setdiff1d(np.arange(size), held)
    # stiffness grows with the fourth power of the number of elements, and with it the rounding
    dense, moved = whole.toarray().astype(np.longdouble), np.zeros(size, np.longdouble)
    for _ in range(4):
        missed = given - dense @ moved
        moved[free] += spsolve(whole[free][:, free], missed[free].astype(float))
    forces = np.array([each @ moved[where] for where, each in own], float)
    borne = (dense @ moved - given)[held].astype(float)
    return moved.astype(float).reshape(-1, 3), forces, borne


def with_section(machine: eq.Machine, *names: str, **changes: Any) -> eq.Machine:
    """A machine whose links have a section."""
    links = dict(machine.links)
    for name in names:
        links[name] = replace(links[name], section=replace(STEEL, **changes))
    return replace(machine, links=links, balance=None)


def engine(**changes: Any) -> eq.Machine:
    return with_section(eq.load("slider-crank-engine"), "rod", **changes)


def in_place(loads: SectionLoads, places: Array, behind: bool, angle: int) -> Array:
    """Axial force, shear force and moment (P, 3) that the link has in cuts."""
    count = len(loads.cuts[0].at)
    cuts = (loads.in_cut(Cut(np.broadcast_to(place, count), behind)) for place in places)
    return np.array([[part[angle] for part in cut] for cut in cuts])


def compare(beams: BeamFile, step: int, loads: SectionLoads, angle: int) -> None:
    """Forces in elements are the mean of those along the link, moments at nodes those of cuts."""
    _, forces, borne = solved(beams, beams.steps[step])
    ends = np.array([[beams.nodes[node] for node in pair] for pair in beams.elements])
    first, last = ends.T
    before = in_place(loads, first, True, angle)
    middle = in_place(loads, (first + last) / 2, True, angle)
    behind = in_place(loads, last, False, angle)
    mean = (before + 4 * middle + behind) / 6  # what is spread is a straight line
    force = np.max(np.abs(before[:, :2]))
    moment = max(np.max(np.abs(before[:, 2])), force * loads.length * 1e-3)
    # what the part behind exerts on the part before, at the end of an element
    assert np.max(np.abs(forces[:, 3:5] - mean[:, :2])) < 1e-9 * force
    assert np.max(np.abs(forces[:, 5] - behind[:, 2])) < 1e-9 * moment
    assert np.max(np.abs(forces[:, 2] + before[:, 2])) < 1e-9 * moment
    assert np.max(np.abs(borne)) < 1e-9 * force


def in_balance(beams: BeamFile, loads: dict[tuple[int, int], float], least: float = 0.0) -> None:
    """Sum of forces, and of moments about the first point, against the sum of their sizes.

    least : N and N m, of rounding where nothing acts.
    """
    parts = {k: {n: v for (n, f), v in loads.items() if f == k} for k in (1, 2, 6)}
    arms = {n: v * beams.nodes[n] for n, v in parts[2].items()}
    size = sum(map(abs, [*parts[1].values(), *parts[2].values()]))
    turning = sum(map(abs, [*arms.values(), *parts[6].values()]))
    assert abs(sum(parts[1].values())) < 1e-9 * size + least
    assert abs(sum(parts[2].values())) < 1e-9 * size + least
    assert abs(sum(arms.values()) + sum(parts[6].values())) < 1e-9 * turning + least


def test_at_the_angle_of_the_largest_stress(tmp_path: Path) -> None:
    machine, path = engine(), tmp_path / "rod.inp"
    assert eq.export(machine, path) == ()
    beams = read_beams(path.read_text("ascii"))
    analysis = eq.analyze(machine).resolved
    angle = int(np.argmin(np.abs(analysis.crank_angle - analysis.sections["rod"].stress_at)))
    assert len(beams.steps) == 1 and beams.modulus == 206e9
    assert beams.section == ("RECT", [0.01, 0.022])
    compare(beams, 0, analysis.forces.sections["rod"], angle)
    in_balance(beams, beams.steps[0])


@pytest.mark.parametrize(
    "name", ["transplanter", "baler-pickup", "twin-engine", "hydraulic-loader"]
)
def test_every_link_at_every_angle(name: str, tmp_path: Path) -> None:
    """With joints beside the line and beyond its ends, springs, loads, soil, and pins that slide
    along a link.
    """
    machine = eq.load(name)
    for link, body in machine.links.items():
        ends = tuple(body.points)[:: max(len(body.points) - 1, 1)]
        if len(ends) == 2 and body.points[ends[0]] != body.points[ends[1]]:
            machine = with_section(machine, link, between=ends)
    path = tmp_path / "link.inp"
    analysis = eq.analyze(machine, 4)
    largest = max(np.max(joint.size) for joint in analysis.forces.joints.values())
    for link, loads in analysis.forces.sections.items():
        eq.export(machine, path, link=link, angles=4)
        beams = read_beams(path.read_text("ascii"))
        assert len(beams.steps) == len(analysis.crank_angle)
        for step in beams.steps:
            in_balance(beams, step, 1e-12 * largest)
        if loads.mass.aside == 0 and all(np.ptp(at) == 0 for at, _, _ in loads.ends):
            compare(beams, 1, loads, 1)


def test_mass_beside_the_line(tmp_path: Path) -> None:
    """Its couples stand at nodes: the moment there is the link's to the size of an element's."""
    rod = eq.load("slider-crank-engine").links["rod"]
    assert rod.center_of_mass is not None
    machine = engine(height="4 mm").with_link("rod", center_of_mass=(rod.center_of_mass[0], 0.012))
    eq.export(machine, tmp_path / "rod.inp", crank_angle=0.8)
    beams = read_beams((tmp_path / "rod.inp").read_text("ascii"))
    in_balance(beams, beams.steps[0])
    loads = eq.analyze(machine, [0.8]).forces.sections["rod"]
    _, forces, _ = solved(beams, beams.steps[0])
    places = np.array([beams.nodes[last] for _, last in beams.elements])
    bent = in_place(loads, places, False, 0)[:, 2]
    np.testing.assert_allclose(forces[:, 5], bent, atol=0.02 * np.max(np.abs(bent)))


def test_deflection_of_a_bar_under_its_weight(tmp_path: Path) -> None:
    """Closed form of a uniform bar that rests on both ends: 5 w L^4 / 384 EI in its middle."""
    length, mass = 0.8, 2.4
    bar = eq.Link({"B": (0, 0), "C": (length, 0)}, mass, (length / 2, 0), mass * length**2 / 12,
                  section=STEEL)  # fmt: skip
    arm = {"A": (0, 0), "B": (0.3, 0)}
    links = {
        "crank": eq.Link(arm, 0, (0, 0), 0), "bar": bar,
        "rocker": eq.Link({"D": (0, 0), "C": (0.3, 0)}, 0, (0, 0), 0),
    }  # fmt: skip
    frame = {"A": (0.0, 0.0), "D": (length, 0.0)}
    machine = eq.Machine("swing", eq.Drive("crank", 1e-6), frame, links, assembly={"C": "parallel"})
    eq.export(machine, tmp_path / "bar.inp", crank_angle=1.2)
    beams = read_beams((tmp_path / "bar.inp").read_text("ascii"))
    moved, _, _ = solved(beams, beams.steps[0])
    second = 0.01 * 0.022**3 / 12
    sag = 5 * mass * 9.80665 * length**3 / (384 * 206e9 * second)
    assert moved[len(moved) // 2, 1] == pytest.approx(-sag, rel=1e-3)


def test_as_a_table(tmp_path: Path) -> None:
    machine = engine()
    eq.export(machine, tmp_path / "rod.csv", angles=24)
    with (tmp_path / "rod.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head[:3] == ["crank_angle [rad]", "place [m]", "axial_force [N]"]
    table = np.array(rows, float)
    loads = eq.analyze(machine, 24).forces.sections["rod"]
    of_one = table[table[:, 0] == table[0, 0]]
    assert len(table) == 24 * len(of_one) and np.all(np.diff(of_one[:, 1]) >= 0)
    assert np.max(table[:, 5:]) == pytest.approx(np.max(loads.stresses))
    assert np.min(table[:, 2]) == pytest.approx(np.min(loads.axial))
    # nothing before the first end nor behind the last
    assert np.max(np.abs(of_one[[0, -1], 2:5])) < 1e-9 * np.max(np.abs(table[:, 2]))
    eq.export(machine, tmp_path / "one.csv", crank_angle=0.3)
    assert len((tmp_path / "one.csv").read_text().splitlines()) == len(of_one) + 1


REFUSED: list[tuple[dict[str, Any], dict[str, Any], dict[str, Any]]] = [
    ({}, {"link": "rodd"}, {"given": "rodd", "name": "rod"}),
    ({}, {"link": "crank"}, {"place": "links.crank.section"}),
    ({"elastic_modulus": None}, {}, {"place": "links.rod.section.elastic_modulus"}),
    ({}, {"angles": 3, "crank_angle": 0.1}, {"by": "write_file"}),
]


@pytest.mark.parametrize(("section", "options", "expected"), REFUSED)
def test_refused(section: Any, options: Any, expected: dict[str, Any], tmp_path: Path) -> None:
    with refused(eq.EquipoiseError, **expected):
        eq.export(engine(**section), tmp_path / "x.inp", **options)
    assert not (tmp_path / "x.inp").exists()


def test_which_of_several_links(tmp_path: Path) -> None:
    both = with_section(engine(), "crank", between=("A", "B"))
    with refused(eq.EquipoiseError, names="crank, rod"):
        eq.export(both, tmp_path / "x.inp")
    with refused(eq.EquipoiseError, formats="inp, link-loads"):
        eq.export(both, tmp_path / "x.xml", link="rod")


def test_an_i_is_a_box_of_its_area_and_stiffness(tmp_path: Path) -> None:
    """CalculiX has no I: half its web stands at each side."""
    sizes = {"height": "22 mm", "width": "14 mm", "web": "4 mm", "flange": "3 mm"}
    machine = engine(**sizes)
    eq.export(machine, tmp_path / "rod.inp", link="rod")
    kind, (wide, high, right, top, left, bottom) = read_beams(
        (tmp_path / "rod.inp").read_text("ascii")
    ).section
    section = machine.links["rod"].section
    assert kind == "BOX" and section is not None
    inside = wide - right - left, high - top - bottom
    assert wide * high - inside[0] * inside[1] == pytest.approx(section.area)
    second = (wide * high**3 - inside[0] * inside[1] ** 3) / 12
    assert second == pytest.approx(section.second_moment)
