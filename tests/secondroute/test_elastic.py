"""Bending links against closed forms of beams on two pins, and beam elements of the tests."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import equipoise as eq
from equipoise.mechanism import LinkSection
from equipoise.mechanism.dynamics.section_loads import elastic_link
from equipoise.mechanism.parts.balance import Balance, CenterMove, Objective
from equipoise.results.remarks import slender_links
from secondroute.test_link_elements import engine, read_beams, solved, stiffness
from support.sentences import notes_by
from surface.running import equipoise, succeeded

LENGTH, MASS = 0.8, 2.4
BENDING = 206e9 * 0.01 * 0.022**3 / 12
STEEL = LinkSection(None, "22 mm", "10 mm", elastic_modulus="206 GPa")


def swing(speed: float = 1e-6, **points: Any) -> eq.Machine:
    """A uniform bar between two parallel arms, which stays level."""
    section = replace(STEEL, between=("B", "C"))
    bar = eq.Link({"B": (0, 0), "C": (LENGTH, 0), **points}, MASS, (LENGTH / 2, 0),
                  MASS * LENGTH**2 / 12, section=section)  # fmt: skip
    links = {
        "crank": eq.Link({"A": (0, 0), "B": (0.3, 0)}, 0, (0, 0), 0),
        "bar": bar,
        "rocker": eq.Link({"D": (0, 0), "C": (0.3, 0)}, 0, (0, 0), 0),
    }
    frame = {"A": (0.0, 0.0), "D": (LENGTH, 0.0)}
    return eq.Machine("swing", eq.Drive("crank", speed), frame, links, assembly={"C": "parallel"})


def first_frequency(parts: int) -> float:
    """Hz, of consistent beam elements on two pins."""
    h, mu = LENGTH / parts, MASS / LENGTH
    k, m = np.zeros((2 * parts + 2,) * 2), np.zeros((2 * parts + 2,) * 2)
    bent = stiffness(h, 0.0, BENDING)[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])]
    own = mu * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2],
         [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]]
    )  # fmt: skip
    for n in range(parts):
        where = slice(2 * n, 2 * n + 4)
        k[where, where] += bent
        m[where, where] += own
    free = np.setdiff1d(np.arange(2 * parts + 2), [0, 2 * parts])
    values = eigh(k[np.ix_(free, free)], m[np.ix_(free, free)], eigvals_only=True)
    return float(values[0] ** 0.5 / (2 * pi))


def test_natural_frequency_of_a_beam_on_two_pins() -> None:
    first = eq.analyze(swing()).sections["bar"]
    assert first.natural_frequency == pytest.approx(first_frequency(12), rel=1e-5)


def test_sag_of_a_bar_that_stays_level() -> None:
    """5 w L^4 / 384 E I in its middle, and w L^3 / 24 E I of slope at its ends."""
    sections = eq.analyze(swing(), [1.2]).forces.sections["bar"]
    elastic = elastic_link(sections)
    assert elastic is not None
    weight = MASS * 9.80665
    sag = 5 * weight * LENGTH**3 / (384 * BENDING)
    assert elastic.moved(LENGTH / 2 + 0j)[0].imag == pytest.approx(-sag, rel=2e-4)
    slope = weight * LENGTH**2 / (24 * BENDING)
    beyond = elastic.moved(LENGTH + 0.2 + 0.1j)[0] - elastic.stretch[-1, 0]
    assert beyond == pytest.approx(1j * slope * (0.2 + 0.1j), rel=2e-4)


def test_the_error_of_a_path_is_the_largest_of_all_points() -> None:
    machine = engine(height="3 mm")
    rod = machine.links["rod"]
    points = {**rod.points, "E": (0.03, 0.0), "F": (0.05, 0.04)}
    between = replace(rod.section, between=("B", "C"))
    links = {**machine.links, "rod": replace(rod, points=points, section=between)}
    analysis = eq.analyze(replace(machine, links=links))
    elastic = elastic_link(analysis.resolved.forces.sections["rod"])
    assert elastic is not None
    errors = [float(np.max(np.abs(elastic.moved(at)))) for at in (0.03 + 0j, 0.05 + 0.04j)]
    assert analysis.sections["rod"].path_error == pytest.approx(max(errors))
    assert analysis.sections["rod"].deflection == pytest.approx(np.max(np.abs(elastic.deflection)))


def test_deflection_against_beam_elements(tmp_path: Path) -> None:
    """Of a rod in motion, by the file that is written for programs of finite elements."""
    machine = engine(height="3 mm")
    eq.export(machine, tmp_path / "rod.inp", crank_angle=1.0)
    beams = read_beams((tmp_path / "rod.inp").read_text("ascii"))
    moved, _, _ = solved(beams, beams.steps[0])
    ends = sorted({node for pair in beams.elements for node in pair})
    places = np.array([beams.nodes[node] for node in ends])
    elastic = elastic_link(eq.analyze(machine, [1.0]).forces.sections["rod"])
    assert elastic is not None
    bent = np.interp(places, elastic.places, elastic.deflection[:, 0])
    longer = np.interp(places, elastic.places, elastic.stretch[:, 0])
    # weight and inertia between nodes are lumped there, of 40 elements
    np.testing.assert_allclose(moved[:, 1], bent, atol=2e-3 * np.max(np.abs(bent)))
    np.testing.assert_allclose(moved[:, 0], longer, atol=2e-3 * np.max(np.abs(longer)))


def test_where_rigid_links_mislead(tmp_path: Path) -> None:
    natural = eq.analyze(swing()).sections["bar"].natural_frequency
    assert natural is not None
    slow, fast, beyond = (swing(2 * pi * natural / times) for times in (10.0, 5.0, 1.9))
    assert not notes_by(slender_links, eq.analyze(slow).notes, "link", "ratio", "share")
    share = f"{100 * (2 / 5) ** 2 / (1 - (2 / 5) ** 2):.0f}"
    notes = eq.analyze(fast).notes
    assert notes_by(slender_links, notes, link="bar", ratio="5.00", share=share)
    assert notes_by(slender_links, eq.analyze(beyond).notes, link="bar", ratio="1.90")
    eq.save(fast, tmp_path / "fast.toml")
    assert "natural frequency" in succeeded(equipoise("analyze", tmp_path / "fast.toml", "--full"))


def test_without_a_modulus_there_is_none() -> None:
    machine = engine(elastic_modulus=None)
    first = eq.analyze(machine).sections["rod"]
    assert first.natural_frequency is None and first.deflection is None and first.path_error is None


@pytest.mark.exhaustive(but=["True"])
@pytest.mark.parametrize("planned", [False, True])
def test_balancing_says_where_rigid_links_mislead(tmp_path: Path, planned: bool) -> None:
    """Of the machine that is balanced, whether or not somebody said what may be changed."""
    machine = engine(height="3 mm")
    natural = eq.analyze(machine).sections["rod"].natural_frequency
    assert natural is not None
    plan = None
    if planned:
        moves = (CenterMove("rod", x=(0.0, 0.1), y=(-0.02, 0.02)),)
        plan = Balance(moves=moves, objectives=(Objective("shaking_force"),))
    for times, warned in ((1.9, True), (30.0, False)):
        drive = replace(machine.drive, speed=2 * pi * natural / times)
        eq.save(replace(machine, drive=drive, balance=plan), tmp_path / "engine.toml")
        text = succeeded(equipoise("balance", tmp_path / "engine.toml"))
        assert ("the rod bends at 1.90 times the crank's speed" in text) == warned
