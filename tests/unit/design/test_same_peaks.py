"""One peak has one value: in analyses, compiled studies, searches, balancing, maps and reports.

Each takes other crank angles: analyses 360 in a turn, balancing 720, studies as many as it takes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Weight
from equipoise.results.analysis import Analysis
from equipoise.results.blocks import Table, Value
from equipoise.schema.template import Template
from equipoise.signals import Periodic
from equipoise.studies.evaluate import OneByOne, evaluator
from equipoise.studies.objective_map import landscape
from equipoise.studies.searching import search

NAME = "yamashita-1"
MACHINE = eq.load(NAME)
PEAKS = ("drive_torque.peak", "shaking_force.peak", "shaking_force.y.peak_to_peak", "joints.B.max")
LINKS = ("crank", "rocker")
CLOSE = 1e-8
"""Share of a figure: a polynomial through nine samples, up to 3 degrees apart."""


@cache
def analysis(angles: int = 360) -> Analysis:
    return eq.analyze(MACHINE, angles)


def of_analysis(path: str, angles: int = 360) -> float:
    output, _, figure = path.rpartition(".")
    return float(getattr(analysis(angles).summary[output], figure))


def mass_of(link: str) -> float:
    mass = MACHINE.links[link].mass
    assert mass is not None
    return float(mass)


def study(**given: Any) -> eq.studies.Study:
    """Of ten designs, the first of which is the model itself."""
    heavier = eq.design.Choices(tuple(mass_of("crank") * k for k in range(1, 11)))
    return eq.studies.Study(
        title="",
        model=Template.load(NAME),
        vary=(eq.design.Variable("links.crank.mass", heavier),),
        outputs=tuple(eq.studies.Output(path, make="smallest") for path in PEAKS),
        sampling=eq.studies.Sampling("grid"),
        **given,
    )


def values_of(blocks: Iterable[object]) -> Iterator[float]:
    """Numbers in tables."""
    for block in blocks:
        if isinstance(block, Table):
            cells = (cell for row in block.rows for cell in row)
            yield from (cell.value for cell in cells if isinstance(cell, Value))


@pytest.mark.parametrize("path", PEAKS)
def test_more_crank_angles_change_nothing(path: str) -> None:
    """By a second route too: all orders of the signal, whose top Newton's method finds."""
    known = of_analysis(path)
    for angles in (250, 720, 5000):
        assert of_analysis(path, angles) == pytest.approx(known, rel=CLOSE)
    output, _, figure = path.rpartition(".")
    if output != "joints.B":  # the size of a vector has more orders than there are samples
        samples = analysis(2000).outputs[output].resolved
        spectrum = Periodic.of(samples).figures
        assert getattr(spectrum, figure) == pytest.approx(known, rel=CLOSE)
        highest = max(np.max(samples), -np.min(samples))
        assert highest < spectrum.peak < highest * (1 + 1e-5)


def test_a_study_has_them() -> None:
    """Compiled loops with as many crank angles as it takes, machines one by one, and a search."""
    known = [of_analysis(path) for path in PEAKS]
    given, masses = study(tolerance=1e-5), np.array([[mass_of("crank")]])
    assert evaluator(given)(masses).figures[0] == pytest.approx(known, rel=CLOSE)
    assert OneByOne(given)(masses).figures[0] == pytest.approx(known, rel=CLOSE)
    searched = search(given)
    (same,) = np.flatnonzero(searched.values[:, 0] == mass_of("crank"))
    assert searched.figures[same] == pytest.approx(known, rel=CLOSE)


def test_balance_has_them() -> None:
    """As objective, as limit, and in the table of figures, before and after."""
    torque, joint = Objective("drive_torque", "peak"), Objective("joints.D", "peak")
    crank = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
    plan = Balance(masses=(crank,), objectives=(torque,), limits=(Limit(joint, ratio=1.02),))
    balanced = eq.balance(MACHINE, plan)
    after = eq.analyze(balanced.machine).summary
    before = analysis().summary
    assert balanced.objectives[torque.name] == pytest.approx(
        (before["drive_torque"].peak, after["drive_torque"].peak), rel=CLOSE
    )
    assert after["joints.D"].peak <= 1.02 * before["joints.D"].peak * (1 + 1e-8)
    for figures, summary in ((balanced.before, before), (balanced.after, after)):
        for name in ("drive_torque.peak", "joints.D.peak", "shaking_force.peak"):
            output, _, figure = name.rpartition(".")
            assert figures[name] == pytest.approx(getattr(summary[output], figure), rel=CLOSE)


def test_a_map_has_them() -> None:
    over = {f"links.{link}.mass": mass_of(link) * np.array([1.0, 2.0]) for link in LINKS}
    result = landscape(Template.load(NAME), over, Objective("shaking_force", "peak"))
    assert result.values[0, 0] == pytest.approx(of_analysis("shaking_force.peak"), rel=CLOSE)


def test_tables_have_them() -> None:
    texts = [*values_of(analysis().blocks())]
    for path in ("drive_torque.peak", "shaking_force.peak"):
        assert of_analysis(path) in texts
