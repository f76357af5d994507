"""Charts of studies: designs, scatter and its causes, maps."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

from equipoise.figures import render, studies
from equipoise.figures.layout import lay_out
from equipoise.figures.panel import finer, levels_of
from equipoise.figures.sheet import CanvasStroke
from equipoise.figures.style import INK
from equipoise.mechanism.parts.balance import Objective
from equipoise.results.charts import Chart
from equipoise.results.outputs import objective_named
from equipoise.schema.studies import load_study
from equipoise.schema.study_units import units_of
from equipoise.schema.template import Template
from equipoise.studies.objective_map import Landscape, landscape
from equipoise.studies.outcomes import DesignBlock, Outcome
from equipoise.studies.searching import Searched, search
from equipoise.studies.selection import MOST, SOME, Best
from equipoise.studies.tolerances import Tolerances, tolerance
from unit.figures.checks import check
from unit.figures.samples import words

OWN = (np.array([0.199, 0.012, 0.0, 0.0715, 0.08]), np.array([8.7, 12.2, 0.21]))


# -- designs and tolerances ------------------------------------------------------------------------


@cache
def tolerances() -> Tolerances:
    study = load_study("study-of-tolerances")
    return tolerance(replace(study, angles=90, sampling=replace(study.sampling, designs=800)))


@cache
def of_tolerances() -> dict[str, Chart]:
    return studies.tolerance_charts(tolerances(), units_of(tolerances().study))


@cache
def searched() -> Searched:
    pytest.importorskip("pymoo")
    study = replace(load_study("study-of-balance"), angles=90)
    return search(study, population=12, generations=3)


@cache
def of_search() -> dict[str, Chart]:
    return studies.searched_charts(searched(), units_of(searched().study), OWN)


@cache
def of_three() -> dict[str, Chart]:
    """Three aims, as `equipoise best` finds them in a store."""
    result = searched()
    count = len(result.values)
    by = {"forward": "smallest", "upward": "smallest", "stroke": "largest"}
    names = (result.study.paths, result.study.names)
    numbers = np.arange(count) + 100
    best = Best(by, *names, numbers, result.values, result.figures, *[count] * 4)  # type: ignore[arg-type]
    store = SimpleNamespace(
        wishes=result.study.outputs,
        in_blocks=lambda: [(0, result.tried)],
        size=len(result.tried.values),
    )
    return studies.best_charts(best, "A store", units_of(result.study), store)  # type: ignore[arg-type]


def given(size: int) -> tuple[studies.CloudDesigns, DesignBlock]:
    """Designs of which some break a limit and some fail, the first three of them chosen."""
    random = np.random.default_rng(5)
    study = load_study("study-of-balance")
    ranges = np.array([(item.spread.low, item.spread.high) for item in study.vary])  # type: ignore[union-attr]
    values = random.uniform(*ranges.T, (size, 5))
    figures = random.uniform([1.0, -2.0, 0.18], [9.0, 1.5, 0.25], (size, 3))
    figures[:, 1] = 10 ** figures[:, 1]
    reason = np.where(values[:, 0] > 0.8, 2, 0).astype(np.uint8)
    figures[reason > 0] = np.nan
    block = DesignBlock(values, Outcome(figures, reason))
    there = np.flatnonzero(reason == 0)[:3]
    table = np.hstack([values, figures])[there]
    by = {"forward": "smallest", "upward": "smallest"}
    texts = (study.title, by, study.paths, study.outputs, units_of(study), table, ["7", "8", "9"])
    front = table[:, [5, 6]]
    return studies.CloudDesigns(*texts, lambda: [(0, block)], size, OWN, front), block  # type: ignore[arg-type]


@pytest.mark.exhaustive(but=["600"])
@pytest.mark.parametrize("size", [600, 6000])
def test_all_designs_stand_behind_the_chosen_ones(size: int) -> None:
    some, block = given(size)
    charts = studies.charts_of(some)
    (panel,) = charts["front"].panels
    good = block.outcome.figures[:, 2] >= 0.2
    failed = np.isnan(block.outcome.figures[:, 0])
    shown = {"kept": 0, "beyond": 0}
    if size <= MOST:
        for curve in panel.curves:
            shown[curve.role] = len(curve.x)
    else:
        beyond, kept = panel.cells
        shown["kept"] = int(np.sum(kept.counts))
        assert np.all((beyond.counts == 0) | (kept.counts == 0))
        assert np.sum(beyond.counts) > 0 and beyond.dots
    assert shown["kept"] == np.sum(good & ~failed)
    assert size > MOST or shown["beyond"] == np.sum(~good & ~failed)
    (chosen,) = (curve for curve in panel.curves if curve.role == "design")
    np.testing.assert_array_equal(np.column_stack([chosen.x, chosen.y]), some.table[:, [5, 6]])
    (line,) = (curve for curve in panel.curves if curve.role == "front")
    assert list(line.x) == sorted(some.table[:, 5])
    assert [(m.x, m.y, m.text) for m in panel.marks if m.role == "own"] == [(8.7, 12.2, "model")]
    assert (panel.x.scale, panel.y.scale) == ("linear", "log")  # 1 to 9 N, 0.01 to 30 N
    reported = words(charts["front"])
    assert f"{size} designs, {np.sum(good & ~failed)} keep every limit" in reported
    assert f"{np.sum(failed)} cannot be computed" in reported
    mass = charts["designs"].panels[0]
    (lost,) = (curve for curve in mass.curves if curve.role == "failed")
    assert np.all(lost.x > 0.79) and len(lost.x) > 3
    for chart in charts.values():
        check(chart)
        assert render(chart) == render(chart)


def test_lines_run_from_axis_to_axis() -> None:
    some, _ = given(6000)
    chart = studies.charts_of(some)["parallel"]
    (panel,) = chart.panels
    reported = words(chart)
    for name, unit in (("mass of the", "g"), ("stroke", "mm"), ("forward", "N")):
        (flag,) = (flag for flag in panel.flags if " ".join(flag.texts).startswith(name))
        assert flag.texts[-1] == unit
    assert "lines of 2" in reported and "all designs" not in reported
    by_role = {curve.role: curve for curve in panel.curves}
    assert set(by_role) == {"kept line", "beyond line", "design line", "own line"}
    assert len(panel.rules) == 8 == len(panel.flags)
    lines = by_role["design line"].y.reshape(3, 9)
    assert np.all(np.isnan(lines[:, 8]))
    names = [*(name for name in some.names if name != "forward"), "forward"]
    for k, rule in enumerate(panel.rules):
        column = some.columns[names[k]]
        ends = np.array([rule.axis.low, rule.axis.high])
        values = [np.log(item) if rule.axis.scale == "log" else item for item in (column, ends)]
        np.testing.assert_allclose(lines[:, k], (values[0] - values[1][0]) / np.diff(values[1]))
    many = sum(np.sum(np.isnan(by_role[role].y)) for role in ("kept line", "beyond line"))
    assert f"lines of {many} designs" in reported and 150 < many <= SOME


def test_histograms_are_the_scatter_and_pale_outside_of_the_limit() -> None:
    chart, actual = of_tolerances()["scatter"], tolerances()
    for panel, scatter in zip(chart.panels, actual.scatters.values(), strict=True):
        (bars,) = panel.bars
        limits = [] if scatter.output.at_most is None else [scatter.output.at_most]
        first, last = (bars.at + sign * np.asarray(bars.width) / 2 for sign in (-1, 1))
        for low, high, count in zip(scatter.edges, scatter.edges[1:], scatter.counts, strict=False):
            inside = (first >= low - 1e-9) & (last <= high + 1e-9)
            np.testing.assert_allclose(bars.size[inside], count / actual.designs)
            assert np.sum(inside) == 1 + sum(low < limit < high for limit in limits)
        assert {line.at for line in panel.lines} == {scatter.base, *limits}
        pale = np.array([role == "outside" for role in bars.roles])
        beyond = bars.at > min(limits, default=np.inf)
        np.testing.assert_array_equal(pale, beyond)


def test_what_to_tighten_first_stands_at_the_top_and_shares_are_of_each() -> None:
    actual, chart = tolerances(), of_tolerances()["tighten"]
    (panel,) = chart.panels
    gains = [max(cause.gain, 0.0) for cause in actual.causes]
    np.testing.assert_allclose(panel.bars[0].size, gains)
    assert panel.y.low is not None and panel.y.high is not None and panel.y.low > panel.y.high
    assert panel.y.ticks is not None and panel.y.ticks[0][1] == "speed of the drive"
    assert "mass + inertia of the coupler" in words(chart)
    for part, name in zip(of_tolerances()["shares"].panels, actual.scatters, strict=True):
        effects = [cause.effects[name] for cause in actual.causes]
        for bars, kind in zip(part.bars, ("first", "total"), strict=True):
            shares = [getattr(effect, kind) for effect in effects]
            reported = np.array([(share.value, share.low, share.high) for share in shares]).T
            assert bars.interval is not None
            np.testing.assert_allclose([bars.size, *bars.interval], np.maximum(reported, 0.0))
            low, high = bars.interval
            assert np.all(low <= bars.size) and np.all(bars.size <= high) and np.any(low < high)
        drawn = [line for line in _lines(of_tolerances()["shares"], 0.9) if len(line) == 2]
        assert len(drawn) >= 3 * 2 * len(actual.causes)  # of each bar, with a cap at both ends


def _lines(chart: Chart, width: float) -> list[np.ndarray]:
    """Lines of ink of some width that a chart draws."""
    items = lay_out(chart).items
    strokes = (item for item in items if isinstance(item, CanvasStroke))
    return [line for s in strokes if (s.color, s.width) == (INK, width) for line in s.lines]


def test_designs_are_drawn_with_the_model_beside_them() -> None:
    chart, actual = of_search()["front"], searched()
    (panel,) = chart.panels
    (chosen,) = (curve for curve in panel.curves if curve.role == "design")
    np.testing.assert_allclose([chosen.x, chosen.y], actual.figures[:, :2].T)
    assert [(m.x, m.y) for m in panel.marks if m.role == "own"] == [tuple(OWN[1][:2])]
    reported = words(chart)
    assert "upward (small is good), N" in reported and "the model itself" in reported
    for number, (panel, label) in enumerate(
        zip(
            of_search()["designs"].panels,
            ("mass of the crank, g", "centre of mass of the crank, x, mm"),
            strict=False,
        )
    ):
        (chosen,) = (curve for curve in panel.curves if curve.role == "design")
        np.testing.assert_allclose(chosen.x, actual.values[:, number])
        assert panel.x.text == label
    (curve,) = of_search()["search"].panels[0].curves
    np.testing.assert_allclose(curve.y, actual.volumes)


def test_three_aims_are_drawn_in_pairs() -> None:
    chart, actual = of_three()["front"], searched()
    aims = [panel.x.label.split(" ")[0] for panel in chart.panels]
    assert aims == ["forward", "forward", "upward"]
    (chosen,) = (curve for curve in chart.panels[2].curves if curve.role == "design")
    np.testing.assert_allclose(chosen.x, actual.figures[:, 1])
    assert "stroke (large is good), mm" in words(chart)


@pytest.mark.parametrize("charts", [of_tolerances, of_search, of_three])
def test_charts_of_studies(charts: object) -> None:
    for chart in charts().values():  # type: ignore[operator]
        check(chart)


# -- maps ------------------------------------------------------------------------------------------


@cache
def smooth() -> Landscape:
    over = {
        "links.coupler.center_of_mass.x": np.linspace(-0.06, 0.06, 31),
        "links.coupler.center_of_mass.y": np.linspace(-0.04, 0.08, 31),
    }
    force = Objective("shaking_force.y", "ripple")
    return landscape(Template.load("yamashita-2"), over, force)


@cache
def broken() -> Landscape:
    """Half of these linkages cannot turn."""
    over = {
        "links.crank.points.B.x": np.linspace(0.011, 0.081, 9),
        "counterweights.crank.radius": np.linspace(0.0, 0.05, 9),
    }
    force, given = Objective("shaking_force"), {"counterweights.crank.mass": 0.3}
    return landscape(Template.load("yamashita-1"), over, force, given)


def test_the_least_and_the_model_are_marked_where_they_are() -> None:
    result = smooth()
    chart = studies.landscape(result)
    marks = {mark.role: (mark.x, mark.y) for mark in chart.panels[0].marks}
    assert marks == {"least": result.best, "own": result.start}
    assert f"{result.least:.4g} N" in words(chart) and f"{result.before:.4g} N" in words(chart)
    assert (
        f"least {objective_named(result.objective)}: {result.least:.4g} N"
        in studies.optimum_text(result)
    )
    spline = RectBivariateSpline(result.y, result.x, result.values)
    assert float(spline(result.best[1], result.best[0])[0, 0]) == pytest.approx(
        result.least, rel=0.05
    )
    levels = levels_of(result.values)
    assert 3 <= len(levels) <= 13 and np.allclose(np.diff(levels), levels[1] - levels[0])


@pytest.mark.parametrize(("most", "least", "words_of"), [(7e3, 6049.0, "6049 kg"),
                                                         (0.5, 0.25, "250 g")])  # fmt: skip
def test_a_number_has_a_unit_that_suits_its_range(most: float, least: float, words_of: str) -> None:
    """The mass of a counterweight of some tonnes was told in grams, with a power of ten."""
    smooth_map = smooth()
    path, best = smooth_map.paths[1], (smooth_map.best[0], least)
    of_mass = replace(
        smooth_map,
        dimensions={**smooth_map.dimensions, path: "mass"},
        y=np.linspace(0.0, most, len(smooth_map.y)),
        best=best,
        start=None,
    )
    assert studies.optimum_text(of_mass).split(" = ")[2].startswith(words_of)
    assert words_of in words(studies.landscape(of_mass))


@pytest.mark.parametrize("places", [9, 31])
def test_lines_of_equal_value_have_no_kinks(places: int) -> None:
    x, y = np.linspace(-1.0, 1.0, places), np.linspace(0.0, 3.0, places)
    values = np.sqrt(0.3 + x**2 + (y[:, None] - 1.3) ** 2)
    result = _lines(studies.landscape(replace(smooth(), x=x, y=y, values=values, start=None)), 0.8)
    assert len(result) > 5
    for line in result:
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        at = np.arange(0.0, along[-1], 8.0)
        ways = np.diff(np.interp(at, along, line @ [1, 1j]))
        turns = np.angle(ways[1:] / ways[:-1], deg=True)
        assert np.max(np.abs(turns), initial=0.0) < 20 + 6e3 / along[-1]


def test_lines_go_through_what_was_computed_and_do_not_swing_at_creases() -> None:
    x, y = np.geomspace(1.0, 9.0, 9), np.linspace(0.0, 1.0, 7)
    values = np.maximum(x, 4.0) + y[:, None]
    values[2:4, 5] = values[6, :3] = values[0, 8] = np.nan
    across, up, actual = finer(x, y, values)
    columns, rows = np.searchsorted(across, x - 1e-12), np.searchsorted(up, y - 1e-12)
    assert len(across) >= 240 and len(up) >= 240
    np.testing.assert_allclose(actual[np.ix_(rows, columns)], values)
    true = np.maximum(across, 4.0) + up[:, None]
    assert np.nanmax(np.abs(actual - true)) < 0.4 * np.max(np.diff(x))
    for j, k in np.ndindex(6, 8):
        cell = values[j : j + 2, k : k + 2]
        own = actual[rows[j] + 1 : rows[j + 1], columns[k] + 1 : columns[k + 1]]
        assert np.all(np.isfinite(own)) if np.all(np.isfinite(cell)) else np.all(np.isnan(own))


def test_what_cannot_turn_is_hatched_and_what_was_set_is_reported() -> None:
    chart = studies.landscape(broken())
    reported = words(chart)
    assert (
        "cannot turn" in reported and "mass of the counterweight on the crank = 300 g" in reported
    )
    assert "cannot turn" not in words(studies.landscape(smooth()))
    level = replace(smooth(), values=np.full_like(smooth().values, 3.0))
    for item in (chart, studies.landscape(smooth()), studies.landscape(level)):
        check(item)
        assert render(item) == render(item)
