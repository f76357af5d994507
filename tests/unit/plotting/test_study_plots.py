"""Pictures of studies: dots, bars and lines are what was found."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import equipoise as eq
from equipoise.plotting.studies import best_drawings, searched_drawings, tolerance_drawings
from equipoise.plotting.style import FAINT, render
from equipoise.schema.study_units import units_of
from equipoise.studies.search import Searched
from equipoise.studies.selection import Best
from equipoise.studies.tolerances import Tolerances
from unit.plotting.samples import texts, words

pytest.importorskip("pymoo")


@cache
def tolerances() -> Tolerances:
    study = eq.schema.load_study("study-of-tolerances")
    return eq.studies.tolerance(
        replace(study, angles=90, sampling=replace(study.sampling, designs=800))
    )


@cache
def of_tolerances() -> dict[str, Figure]:
    return tolerance_drawings(tolerances(), units_of(tolerances().study))


@cache
def searched() -> Searched:
    study = replace(eq.schema.load_study("study-of-balance"), angles=90)
    return eq.studies.search_designs(study, population=12, generations=3)


OWN = (np.array([0.199, 0.012, 0.0, 0.0715, 0.08]), np.array([8.7, 12.2, 0.21]))


@cache
def of_search() -> dict[str, Figure]:
    return searched_drawings(searched(), units_of(searched().study), OWN)


@cache
def of_three() -> dict[str, Figure]:
    """Three aims, as `equipoise best` finds them in a store."""
    found = searched()
    count = len(found.values)
    by = {"forward": "smallest", "upward": "smallest", "stroke": "largest"}
    names = (found.study.paths, found.study.names)
    numbers = np.arange(count) + 100
    best = Best(by, *names, numbers, found.values, found.figures, *[count] * 4)  # type: ignore[arg-type]
    return best_drawings(best, "A store", units_of(found.study))


def bars(figure: Figure, panel: int) -> list[Rectangle]:
    axes = figure.axes[panel]
    return [patch for patch in axes.patches if isinstance(patch, Rectangle) and patch.get_width()]


def test_histograms_are_the_scatter_and_pale_outside_of_the_limit() -> None:
    figure, found = of_tolerances()["scatter"], tolerances()
    for panel, one in enumerate(found.scatters.values()):
        drawn = bars(figure, panel)
        heights = [bar.get_height() for bar in drawn]
        np.testing.assert_allclose(heights, 100 * one.counts / found.designs)
        np.testing.assert_allclose([bar.get_x() for bar in drawn], one.edges[:-1], rtol=1e-12)
        lines = {float(line.get_xdata()[0]) for line in figure.axes[panel].lines}
        limit = one.output.at_most
        assert lines == {one.base, *([] if limit is None else [limit])}
        pale = [
            bar.get_x() for bar in drawn if bar.get_facecolor()[:3] == pytest.approx(_of(FAINT))
        ]
        assert all(limit is not None and x >= limit for x in pale)


def _of(color: str) -> tuple[float, float, float]:
    return tuple(int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))  # type: ignore[return-value]


def test_what_to_tighten_first_stands_at_the_top() -> None:
    figure, found = of_tolerances()["tighten"], tolerances()
    drawn = bars(figure, 0)
    gains = [100 * cause.gain for cause in found.causes]
    np.testing.assert_allclose(
        [bar.get_width() for bar in drawn], np.maximum(gains, 0)[: len(drawn)]
    )
    axes = figure.axes[0]
    assert axes.get_ylim()[0] > axes.get_ylim()[1]
    assert axes.get_yticklabels()[0].get_text() == found.causes[0].numbers[0] == "drive.speed"
    assert "links.coupler.mass + inertia" in words(figure)


def test_shares_are_those_of_each_figure() -> None:
    figure, found = of_tolerances()["shares"], tolerances()
    for panel, name in enumerate(found.scatters):
        effects = [cause.effects[name] for cause in found.causes]
        both = [*(e.total.value for e in effects), *(e.first.value for e in effects)]
        drawn = [bar.get_width() for bar in figure.axes[panel].patches]  # type: ignore[attr-defined]
        np.testing.assert_allclose(drawn, 100 * np.maximum(both, 0))


def test_the_front_is_drawn_with_the_model_beside_it() -> None:
    figure, found = of_search()["front"], searched()
    dots, own = figure.axes[0].lines[:2]
    np.testing.assert_allclose(dots.get_xydata(), found.figures[:, :2])
    np.testing.assert_allclose(own.get_xydata(), [OWN[1][:2]])
    said = words(figure)
    assert "upward, N (small is good)" in said and "the model itself" in said


def test_numbers_of_the_designs_are_drawn_in_the_units_of_the_file() -> None:
    figure, found = of_search()["designs"], searched()
    for panel, (factor, name) in enumerate([(1e3, "mass, g"), (1e3, "center_of_mass.x, mm")]):
        dots = figure.axes[panel].lines[0]
        values = np.column_stack([factor * found.values[:, panel], found.figures[:, 0]])
        np.testing.assert_allclose(dots.get_xydata(), values)
        assert figure.axes[panel].get_xlabel() == f"links.crank.{name}"


def test_the_course_of_a_search_is_drawn() -> None:
    (line,) = of_search()["search"].axes[0].lines
    np.testing.assert_allclose(line.get_ydata(), 100 * searched().volumes)


def test_three_aims_are_drawn_in_pairs() -> None:
    figure, found = of_three()["front"], searched()
    assert [axes.get_xlabel().split(",")[0] for axes in figure.axes] == ["forward"] * 2 + ["upward"]
    np.testing.assert_allclose(figure.axes[2].lines[0].get_xdata(), found.figures[:, 1])
    assert "stroke, mm (large is good)" in words(figure)


@pytest.mark.parametrize("drawn", [of_tolerances, of_search, of_three])
def test_texts_lie_in_the_picture_and_bytes_are_the_same(drawn: object) -> None:
    for figure in drawn().values():  # type: ignore[operator]
        figure.draw_without_rendering()
        whole = figure.bbox
        for text in texts(figure):
            box = text.get_window_extent()
            assert whole.x0 - 1 <= box.x0 and box.x1 <= whole.x1 + 1, text.get_text()
            assert whole.y0 - 1 <= box.y0 and box.y1 <= whole.y1 + 1, text.get_text()
        assert render(figure, "svg") == render(figure, "svg")
