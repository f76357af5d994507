"""The map of an objective: its lines are where the values are, and its signs where they belong."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from scipy.interpolate import RectBivariateSpline

import equipoise as eq
from equipoise.plotting.landscape import drawings, told
from equipoise.plotting.style import STRESS, render
from equipoise.studies.objective_map import Landscape
from unit.plotting.samples import texts, words


@cache
def smooth() -> Landscape:
    over = {
        "links.coupler.center_of_mass.x": np.linspace(-0.06, 0.06, 31),
        "links.coupler.center_of_mass.y": np.linspace(-0.04, 0.08, 31),
    }
    force = eq.balancing.Objective("shaking_force.y", "ripple")
    return eq.studies.landscape(eq.schema.Template.load("yamashita-2"), over, force)


@cache
def broken() -> Landscape:
    """Half of these linkages cannot turn."""
    over = {
        "links.crank.points.B.x": np.linspace(0.011, 0.081, 9),
        "counterweights.crank.radius": np.linspace(0.0, 0.05, 9),
    }
    force, given = eq.balancing.Objective("shaking_force"), {"counterweights.crank.mass": 0.3}
    return eq.studies.landscape(eq.schema.Template.load("yamashita-1"), over, force, given)


def drawn(found: Landscape) -> Figure:
    return drawings(found)["landscape"]


def marked(figure: Figure) -> dict[str, complex]:
    lines = [line for line in figure.axes[0].lines if isinstance(line, Line2D)]
    where = {line.get_marker(): complex(*line.get_xydata()[0]) for line in lines}
    return {str(marker): place for marker, place in where.items()}


def test_lines_run_where_the_objective_has_their_value() -> None:
    found = smooth()
    read = RectBivariateSpline(found.y, found.x, found.values)
    sets = [c for c in drawn(found).axes[0].collections if isinstance(c, QuadContourSet)]
    (lines,) = (one for one in sets if not one.filled)
    assert len(lines.levels) >= 5
    step = float(np.min(np.diff(lines.levels)))
    for level, paths in zip(lines.levels, lines.allsegs, strict=True):
        for path in paths:
            values = read(path[:, 1] / 1e3, path[:, 0] / 1e3, grid=False)
            np.testing.assert_allclose(values, level, atol=0.02 * step)


def test_the_least_and_the_model_are_marked_where_they_are() -> None:
    found = smooth()
    figure = drawn(found)
    signs = marked(figure)
    assert signs["P"] == pytest.approx(1e3 * complex(*found.best))
    assert signs["D"] == pytest.approx(complex(-45, -20))
    said = words(figure)
    for words_there in ("10.2 N", "17.05 N", "6.24 mm, 26.22 mm", "least", "as it is", "x, mm"):
        assert words_there in said


def test_what_cannot_turn_is_hatched_and_what_was_set_is_told() -> None:
    figure = drawn(broken())
    hatched = [p for p in figure.axes[0].patches if isinstance(p, Rectangle) and p.get_hatch()]
    assert len(hatched) == 1
    said = words(figure)
    assert "cannot turn" in said
    assert "counterweights.crank.mass = 300 g" in said
    assert "as it is" not in said
    assert "links.crank.points.B.x = 11 mm" in told(broken())


@pytest.mark.parametrize("found", [smooth, broken])
def test_texts_keep_apart_and_bytes_the_same(found: object) -> None:
    figure = drawn(found())  # type: ignore[operator]
    bold = [text for text in texts(figure) if text.get_color() == STRESS]
    others = [text for text in texts(figure) if text not in bold]
    for text in bold:
        box = text.get_window_extent()
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1
        assert not any(box.overlaps(other.get_window_extent()) for other in others)
    assert render(figure, "svg") == render(drawn(found()), "svg")  # type: ignore[operator]


def test_an_objective_that_is_the_same_everywhere_is_drawn_without_lines() -> None:
    """No shaking force depends on an inertia."""
    over = {"links.rocker.inertia": [1e-4, 2e-4], "links.coupler.inertia": [1e-4, 2e-4]}
    force = eq.balancing.Objective("shaking_force")
    found = eq.studies.landscape(eq.schema.Template.load("yamashita-1"), over, force)
    assert render(drawn(found), "svg")
