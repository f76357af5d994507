"""Studies against what is known: shares of variance, scatter, worst cases, fronts."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.stats import norm, sobol_indices, uniform

from equipoise.design.variables import Normal, Range, Uniform, Variable
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Evaluator, Outcome
from equipoise.studies.searching import search
from equipoise.studies.study import Correlation, Output, Study
from equipoise.studies.tolerances import Tolerances, effects, tables, tolerance
from unit.studies.samples import PATHS, study

Array = np.ndarray[Any, Any]

ISHIGAMI = ((0.3139, 0.5576), (0.4424, 0.4424), (0.0, 0.2437))
"""First-order and total shares, with a = 7 and b = 0.1 (Saltelli et al., Global Sensitivity
Analysis, 2008, 4.6 prints the formulas that give them)."""


def of(*spreads: Any, designs: int = 2**15, seed: int = 1, **changes: Any) -> Study:
    vary = tuple(Variable(path, spread) for path, spread in zip(PATHS, spreads, strict=False))
    some = study(designs=designs, seed=seed, outputs=(Output("f", value="a.b"),))
    return replace(some, vary=vary, **changes)


def formula(function: Any) -> Evaluator:
    """Figures of designs (P, d), from a function of their columns."""

    def compute(values: Array) -> Outcome:
        figures = np.column_stack([np.asarray(function(*values.T))]).reshape(len(values), -1)
        return Outcome(figures, np.zeros(len(values), np.uint8))

    return compute


def ishigami(x: Array, y: Array, z: Array) -> Array:
    return np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)


def effects_of(result: Tolerances, output: str = "f") -> list[Any]:
    """By the number that varies, in the order of the study."""
    by_cause = {cause.numbers[0]: cause.effects[output] for cause in result.causes}
    return [by_cause[path] for path in result.study.paths if path in by_cause]


# -- shares of variance ----------------------------------------------------------------------------


@pytest.mark.parametrize("uniforms", [0, 2, 4])
def test_shares_of_a_sum(uniforms: int) -> None:
    """Of sum c_k x_k each share is c_k^2 var x_k over their sum, by itself and in total; with half
    of the tolerance three quarters of it go, without it all."""
    slopes, widths = np.array([1.0, -2.0, 0.5, 3.0]), np.array([0.3, 0.1, 0.4, 0.05])
    spreads = [
        Uniform(1.0, width) if k < uniforms else Normal(1.0, width)
        for k, width in enumerate(widths)
    ]
    variances = (slopes * widths) ** 2 / np.where(np.arange(4) < uniforms, 3, 1)
    result = tolerance(of(*spreads), compute=formula(lambda *x: slopes @ np.array(x)))
    assert result.scatters["f"].deviation == pytest.approx(np.sqrt(np.sum(variances)), rel=2e-3)
    assert result.scatters["f"].mean == pytest.approx(np.sum(slopes), abs=1e-3)
    for effect, share in zip(effects_of(result), variances / np.sum(variances), strict=True):
        assert effect.first.value == pytest.approx(share, abs=0.02)
        assert effect.total.value == pytest.approx(share, abs=0.02)
        assert effect.halved == pytest.approx(np.sqrt(1 - 0.75 * share), abs=0.01)
        assert effect.removed == pytest.approx(np.sqrt(1 - share), abs=0.01)


def test_shares_of_a_known_function() -> None:
    result = tolerance(of(*[Uniform(0.0, np.pi)] * 3), compute=formula(ishigami))
    for effect, (first, total) in zip(effects_of(result), ISHIGAMI, strict=True):
        assert effect.first.value == pytest.approx(first, abs=0.03)
        assert effect.total.value == pytest.approx(total, abs=0.03)
    variance = 49 / 8 + 0.1 * np.pi**4 / 5 + 0.01 * np.pi**8 / 18 + 0.5
    assert result.scatters["f"].deviation == pytest.approx(np.sqrt(variance), rel=1e-3)


def test_shares_against_scipy() -> None:
    """The same tables of figures give the same shares."""
    some = of(Uniform(0.0, np.pi), Uniform(0.0, np.pi), Uniform(0.0, np.pi))
    figures = [formula(ishigami)(table).figures[:, 0] for table in tables(some, 1024)]
    mine = effects(figures, 1)
    assert mine is not None
    table = {"f_A": figures[0][None], "f_B": figures[1][None]}
    table["f_AB"] = np.array(figures[2::3])[:, None]
    theirs = sobol_indices(func=table, n=1024, dists=[uniform()] * 3)
    for k, effect in enumerate(mine):
        # SciPy takes the mean of both tables off too, and divides by their common variance.
        assert effect.first.value == pytest.approx(float(np.ravel(theirs.first_order)[k]), abs=1e-9)
        assert effect.total.value == pytest.approx(float(np.ravel(theirs.total_order)[k]), abs=1e-9)


# Shares and scatter of known functions: the other tests of this file.
@pytest.mark.exhaustive
def test_intervals_cover_what_they_say() -> None:
    """Of 95 % intervals at 60 seeds nearly all hold the true share."""
    slopes, inside = np.array([1.0, 2.0]), []
    for seed in range(60):
        some = of(Normal(0.0, 1.0), Normal(0.0, 1.0), designs=1024, seed=seed)
        result = tolerance(
            some, compute=formula(lambda x, y: slopes[0] * x + slopes[1] * y + x * y)
        )
        first, total = (1 / 6, 4 / 6), (2 / 6, 5 / 6)
        for k, effect in enumerate(effects_of(result)):
            inside += [effect.first.low <= first[k] <= effect.first.high]
            inside += [effect.total.low <= total[k] <= effect.total.high]
    assert np.mean(inside) > 0.9


@pytest.mark.parametrize("coefficient", [-0.8, 0.5])
def test_correlated_numbers(coefficient: float) -> None:
    """The variance of a sum has twice the covariance in it, and both numbers are one cause."""
    together = (Correlation(PATHS[0], PATHS[2], coefficient),)
    some = of(Normal(0.0, 2.0), Normal(0.0, 1.0), Normal(0.0, 3.0), correlations=together)
    result = tolerance(some, compute=formula(lambda x, y, z: x + y + z))
    pair = 4 + 9 + 2 * coefficient * 6
    assert result.scatters["f"].deviation == pytest.approx(np.sqrt(pair + 1), rel=5e-3)
    assert {cause.numbers for cause in result.causes} == {(PATHS[0], PATHS[2]), (PATHS[1],)}
    both, alone = effects_of(result)
    assert both.first.value == pytest.approx(pair / (pair + 1), abs=0.03)
    assert alone.total.value == pytest.approx(1 / (pair + 1), abs=0.03)
    assert both.removed == pytest.approx(np.sqrt(1 / (pair + 1)), abs=0.01)


def test_failed_machines_do_not_bend_shares() -> None:
    """Machines that fail by chance leave the shares of the others as they are."""

    def failing(values: Array) -> Outcome:
        figures = (values[:, 0] + 2 * values[:, 1])[:, None]
        reason = np.where(np.sin(1e6 * values[:, 0] * values[:, 1]) > 0.95, 1, 0).astype(np.uint8)
        figures[reason != 0] = np.nan
        return Outcome(figures, reason)

    result = tolerance(of(Normal(0.0, 1.0), Normal(0.0, 1.0)), compute=failing)
    assert 0.05 < result.failures["does not assemble"] / result.designs < 0.15
    first, second = effects_of(result)
    assert first.first.value == pytest.approx(0.2, abs=0.03)
    assert second.total.value == pytest.approx(0.8, abs=0.03)


# -- scatter ---------------------------------------------------------------------------------------


def test_scatter_of_a_normal_sum() -> None:
    """Its percentiles, and the share within limits, are those of the normal curve."""
    outputs = (Output("f", value="a.b", at_least=-2.0, at_most=1.0),)
    some = of(Normal(0.0, 0.6), Normal(0.0, 0.8), designs=2**16)
    result = tolerance(replace(some, outputs=outputs), compute=formula(lambda x, y: x + y))
    scatter = result.scatters["f"]
    assert len(scatter.percentiles) == 7
    for percentage, value in scatter.percentiles.items():
        assert value == pytest.approx(norm.ppf(percentage / 100), abs=0.03)
    assert scatter.within is not None
    assert scatter.within.value == pytest.approx(norm.cdf(1) - norm.cdf(-2), abs=1e-3)
    assert (scatter.below, scatter.above) == pytest.approx((norm.cdf(-2), norm.sf(1)), abs=1e-3)


# Tolerances of a linkage: tests/unit/studies/test_tolerances.py; the laws of scatter: above.
@pytest.mark.exhaustive
def test_a_linkage_within_its_worst_case() -> None:
    """No machine lies beyond the corners of the tolerances, where these are small; and the scatter
    is that of the slopes between the corners."""
    paths = ("links.crank.points.B.x", "links.coupler.points.C.x", "links.rocker.points.C.x")
    own = [study().model.number(path)[0] for path in paths]
    half = 1e-4
    vary = tuple(Variable(p, Uniform(float(v), half)) for p, v in zip(paths, own, strict=True))
    outputs = (Output("four_bar.swing"), Output("four_bar.transmission_min"))
    some = replace(of(*[Normal(0.0, 1.0)] * 3, designs=512), vary=vary, outputs=outputs, angles=8)
    compute = evaluator(some)
    result = tolerance(some, compute=compute)
    signs = np.array(list(itertools.product((-1, 1), repeat=3)))
    corners = compute(np.array(own) + half * signs).figures
    slopes = signs.T @ corners / 8
    for k, output in enumerate(outputs):
        scatter = result.scatters[output.name]
        wide = np.ptp(corners[:, k])
        assert np.min(corners[:, k]) - 1e-3 * wide < scatter.least
        assert scatter.largest < np.max(corners[:, k]) + 1e-3 * wide
        assert scatter.deviation == pytest.approx(
            float(np.linalg.norm(slopes[:, k])) / np.sqrt(3), rel=0.02
        )
        assert scatter.mean == pytest.approx(scatter.base, abs=0.01 * wide)
        shares = slopes[:, k] ** 2 / np.sum(slopes[:, k] ** 2)
        order = [cause.effects[output.name].total.value for cause in result.causes]
        wanted = dict(zip(paths, shares, strict=True))
        assert order == pytest.approx([wanted[c.numbers[0]] for c in result.causes], abs=0.1)


# -- fronts ----------------------------------------------------------------------------------------


def zdt1(*numbers: Array) -> Array:
    """Zitzler, Deb and Thiele 2000, number 1: the front is g = 1, f2 = 1 - sqrt(f1)."""
    g = 1 + 9 * np.mean(numbers[1:], axis=0)
    return np.stack([numbers[0], g * (1 - np.sqrt(numbers[0] / g))], axis=1)


# A front that is missed: `test_the_front_within_a_limit`.
@pytest.mark.exhaustive
def test_the_front_of_a_known_problem() -> None:
    outputs = tuple(Output(name, value="a.b", make="smallest") for name in ("f", "g"))
    some = replace(of(*[Range(0.0, 1.0)] * 5), outputs=outputs)
    searched = search(some, compute=formula(zdt1), population=60, generations=120)
    first, second = searched.figures.T
    beyond = second - (1 - np.sqrt(first))
    assert np.all(beyond >= -1e-12)  # nothing is better than the front
    assert np.median(beyond) < 0.01
    assert np.min(first) < 0.01 and np.max(first) > 0.95
    assert searched.volumes[-1] > 0.99 * np.max(searched.volumes)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_front_within_a_limit(seed: int) -> None:
    """Two squares whose best designs lie between their centres; a limit cuts the one end off."""
    outputs = (
        Output("f", value="a.b", make="smallest"),
        Output("g", value="a.c", make="smallest"),
        Output("x", value="a.d", at_most=0.6),
    )
    some = replace(of(Range(0.0, 1.0), Range(-1.0, 1.0)), outputs=outputs)

    def squares(x: Array, y: Array) -> Array:
        return np.stack([(x - 0.2) ** 2 + y**2, (x - 0.8) ** 2 + y**2, x], axis=1)

    searched = search(some, compute=formula(squares), population=40, generations=60, seed=seed)
    x, y = searched.values.T
    assert np.max(np.abs(y)) < 0.02
    assert np.min(x) == pytest.approx(0.2, abs=0.02)
    assert np.max(x) == pytest.approx(0.6, abs=0.01)
    assert np.max(x) <= 0.6
