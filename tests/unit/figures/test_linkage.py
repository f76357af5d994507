"""The picture of a linkage, and the force on moving ones."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.linkage import linkage_figure
from equipoise.figures.moving import laid_out
from equipoise.figures.stage import Arrow
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene
from unit.figures.samples import words


@cache
def analysis_of(name: str) -> Analysis:
    return eq.analyze(eq.load(name), 360)


def pins_of(axes: Axes) -> np.ndarray:
    """Middles of the signs of pins, (n, 2)."""
    outlines = [patch.get_path() for patch in axes.patches if patch.get_gid() == "pin"]
    rings = [ring[:-1] for path in outlines for ring in path.to_polygons()]
    return np.array([(ring.min(axis=0) + ring.max(axis=0)) / 2 for ring in rings])


def test_the_linkage_at_chosen_angles() -> None:
    analysis = analysis_of("yamashita-1")
    angles = [0.0, 1.0, 7.5]
    figure = linkage_figure(analysis, angles)
    pins = analysis.motion.linkage.joints.pins
    for axes, angle in zip(figure.axes, angles, strict=True):
        motion = eq.move(analysis.machine, [angle])
        dots = pins_of(axes)
        for pin in pins:
            z = 1000 * complex(motion.points[pin].place[0])
            assert np.min(np.hypot(*(dots - [z.real, z.imag]).T)) < 1e-6
        told = {text.get_text() for text in axes.texts}
        assert {"A", "B", "C", "D", "P"} <= told
        assert axes.get_title(loc="left") == f"{np.degrees(angle):.4g}°"
    single = words(linkage_figure(analysis))
    assert all(link in single for link in analysis.machine.links)
    for wrong in ([], np.zeros(25)):
        with pytest.raises(UsageError, match="a picture shows 1 to 24"):
            linkage_figure(analysis, wrong)


@pytest.mark.parametrize("of_one", [False, True])
def test_a_moving_picture_says_whose_force_it_is(of_one: bool) -> None:
    found = eq.analyze(eq.load("four-row-transplanter"), 60)
    arrow = Arrow(found.forces.about, found.forces.shaking_force.value, of_one)
    told = [label.text for label in laid_out(Scene.of(found.motion), arrow=arrow).labels]
    (force,) = (text for text in told if text.startswith("shaking force"))
    assert ("of one row" in force) == of_one
    assert f"{np.max(np.abs(arrow.force)):.4g} N" in force
