"""The picture of a linkage, and the force on moving ones."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.linkage import linkage
from equipoise.figures.moving import laid_out
from equipoise.figures.stage import Arrow
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene
from unit.figures.samples import words


@cache
def analysis_of(name: str) -> Analysis:
    return eq.analyze(eq.load(name), 360)


def test_the_linkage_at_chosen_angles() -> None:
    analysis = analysis_of("yamashita-1")
    angles = [0.0, 1.0, 7.5]
    chart = linkage(analysis, angles)
    pins = analysis.motion.linkage.joints.pins
    for panel, angle in zip(chart.panels, angles, strict=True):
        motion = eq.move(analysis.machine, [angle])
        dots = np.array([shape.places[0] for shape in panel.signs if shape.role == "pin"])
        for pin in pins:
            assert np.min(np.abs(dots - motion.points[pin].place[0])) < 1e-12
        assert [mark.text for mark in panel.marks] == [*motion.points]
        assert panel.title == f"{np.degrees(angle):.4g}°"
    single = words(linkage(analysis))
    assert all(link in single for link in analysis.machine.links)
    for wrong in ([], np.zeros(25)):
        with pytest.raises(UsageError, match="a picture shows 1 to 24"):
            linkage(analysis, wrong)


def test_every_path_is_drawn_closed() -> None:
    analysis = analysis_of("watt-six-bar")
    (panel,) = linkage(analysis).panels
    places = [analysis.motion.points[name].place for name in "BCEF"]
    for curve, place in zip(panel.curves, places, strict=True):
        np.testing.assert_array_equal(curve.x + 1j * curve.y, np.append(place, place[0]))


@pytest.mark.parametrize("of_one", [False, True])
def test_a_moving_picture_says_whose_force_it_is(of_one: bool) -> None:
    found = eq.analyze(eq.load("four-row-transplanter"), 60)
    arrow = Arrow(found.forces.about, found.forces.shaking_force.value, of_one)
    told = [label.text for label in laid_out(Scene.of(found.motion), arrow=arrow).labels]
    (force,) = (text for text in told if text.startswith("shaking force"))
    assert ("of one row" in force) == of_one
    assert f"{np.max(np.abs(arrow.force)):.4g} N" in force
