"""Tolerances: what is told of the scatter, what is refused, and which goes first."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.stats import norm

import equipoise as eq
from equipoise.codegen.figures import NO_ASSEMBLY
from equipoise.design.variables import Choices, Normal, Range, Uniform
from equipoise.errors import ModelError, UsageError
from equipoise.studies.outcomes import Outcome
from equipoise.studies.study import Correlation, Output, Study
from equipoise.studies.tolerances import causes_of, rows_of, tables, tolerance
from support.refusals import refused
from unit.studies.samples import LENGTH, MASS, SPEED, study

Array = np.ndarray[Any, Any]
SPREADS = (Normal(0.2, 0.01), Uniform(0.07, 0.001), Normal(20.0, 1.0, 2.0))
SUM = (Output("sum", value="a.b", at_least=20.0, at_most=21.0), Output("square", value="a.c"))


def given(designs: int = 4096, **changes: Any) -> Study:
    return replace(study(*SPREADS, designs=designs, outputs=SUM), **changes)


def formulas(values: Array) -> Outcome:
    """A sum, and a square; where the last is large it fails."""
    figures = np.stack([np.sum(values, axis=1), values[:, 2] ** 2], axis=1)
    reason = np.where(values[:, 2] > 21.5, NO_ASSEMBLY, 0).astype(np.uint8)
    figures[reason != 0] = np.nan
    return Outcome(figures, reason)


def test_scatter() -> None:
    result = tolerance(given(), compute=formulas)
    scatter = result.scatters["square"]
    cut = norm.cdf(2) - norm.cdf(-2)
    failed = (norm.cdf(2) - norm.cdf(1.5)) / cut
    assert result.failures == {"does not assemble": pytest.approx(4096 * failed, abs=4)}
    assert scatter.base == result.study.model.number(SPEED)[0] ** 2
    assert scatter.percentiles[50.0] == pytest.approx(
        (20 + norm.ppf(norm.cdf(-2) + 0.5 * (1 - failed) * cut)) ** 2, rel=1e-4
    )
    assert (scatter.least, scatter.largest) == pytest.approx((18**2, 21.5**2), rel=1e-2)
    assert np.sum(scatter.counts) == 4096 - sum(result.failures.values())
    assert (scatter.edges[0], scatter.edges[-1]) == (scatter.least, scatter.largest)
    assert scatter.within is None
    assert (scatter.below, scatter.above) == (0, 0)


def test_failed_machines_are_outside() -> None:
    result = tolerance(given(), compute=formulas)
    of_sum = result.scatters["sum"]
    assert of_sum.within is not None and result.within is not None
    failed = sum(result.failures.values()) / 4096
    assert of_sum.within.value == pytest.approx(1 - failed - of_sum.below - of_sum.above)
    assert result.within == of_sum.within  # the only one with limits
    assert result.within.low < result.within.value < result.within.high
    width = result.within.high - result.within.low
    share = result.within.value
    assert width == pytest.approx(2 * 1.96 * np.sqrt(share * (1 - share) / 4096), rel=0.01)
    assert any("cannot be computed" in note for note in result.notes)


@pytest.mark.parametrize(
    ("designs", "percentiles"),
    [(512, [5, 50, 95]), (1024, [1, 5, 50, 95, 99]), (16384, [0.1, 1, 5, 50, 95, 99, 99.9])],
)
def test_percentiles_that_the_sample_supports(designs: int, percentiles: list[float]) -> None:
    result = tolerance(given(designs), compute=lambda v: Outcome(v[:, :2], np.zeros(len(v), "u1")))
    assert list(result.scatters["sum"].percentiles) == percentiles


def test_what_to_tighten_first() -> None:
    outputs = (replace(SUM[0], at_most=22.0), SUM[1])
    result = tolerance(given(outputs=outputs), compute=formulas)
    first, *others = result.causes
    assert first.numbers == (SPEED,)
    assert all(first.gain > other.gain for other in others)
    assert first.halved is not None and first.removed is not None and result.unchanged is not None
    assert result.unchanged < first.halved < first.removed == 1.0
    assert first.effects["square"].first.value == pytest.approx(1, abs=0.02)
    assert first.gain == 1 - first.effects["sum"].halved ** 2  # the output with limits counts


def test_without_limits_all_outputs_count() -> None:
    outputs = (Output("sum", value="a.b"), Output("square", value="a.c"))
    result = tolerance(given(outputs=outputs), compute=formulas)
    assert result.within is result.unchanged is None
    for cause in result.causes:
        assert cause.halved is cause.removed is None
        gains = [1 - effect.halved**2 for effect in cause.effects.values()]
        assert cause.gain == pytest.approx(np.mean(gains))


def test_what_does_not_vary() -> None:
    def constant(values: Array) -> Outcome:
        outcome = formulas(values)
        outcome.figures[:, 1] = 7.0 + 1e-15 * values[:, 0]  # rounding
        return Outcome(outcome.figures, np.zeros(len(values), np.uint8))

    result = tolerance(given(), compute=constant)
    assert all(list(cause.effects) == ["sum"] for cause in result.causes)
    assert result.scatters["square"].deviation < 1e-14
    assert result.scatters["square"].counts.tolist() == [4096]
    assert "square does not vary, so that no tolerance is named as its cause" in result.notes


def test_it_is_the_same_again_and_reports_how_far_it_is() -> None:
    texts: list[tuple[int, int]] = []
    first = tolerance(given(), compute=formulas, progress=lambda *at: texts.append(at))
    assert texts == sorted(texts)
    assert texts[-1] == (first.computed, first.computed)
    assert first.computed == 4096 + rows_of(4096, 3) * 11
    again = tolerance(given(chunk=100), compute=formulas)
    assert str(again.to_dict()["tighten"]) == str(first.to_dict()["tighten"])
    assert str(again.to_dict()["outputs"]) == str(first.to_dict()["outputs"])


def test_correlated_numbers_are_one_cause() -> None:
    together = (Correlation(MASS, SPEED, 0.9),)
    some = given(correlations=together)
    assert causes_of(some) == ((0, 2), (1,))
    a, b, swapped, halved, removed, *_ = tables(some, 256)
    assert np.array_equal(swapped, np.column_stack([b[:, 0], a[:, 1], b[:, 2]]))
    assert halved[:, 2] - 20 == pytest.approx(0.5 * (a[:, 2] - 20))
    assert np.array_equal(removed, np.column_stack([0 * a[:, 0] + 0.2, a[:, 1], 0 * a[:, 2] + 20]))
    chain = (*together, Correlation(SPEED, LENGTH, 0.1))
    assert causes_of(given(correlations=chain)) == ((0, 1, 2),)


def test_rows() -> None:
    assert rows_of(65536, 6) == 2048
    assert [rows_of(k, 2) for k in (0, 7, 8, 255, 256, 512)] == [0, 0, 1, 16, 32, 64]


# -- refused ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("spread", [Range(0.1, 0.2), Choices((0.1, 0.2))])
def test_what_is_no_tolerance(spread: Range | Choices) -> None:
    some = study(Normal(0.2, 0.01), spread, outputs=SUM)
    with refused(ModelError, "vary[2]", path="links.coupler.points.C.x"):
        tolerance(some, compute=formulas)


def test_too_few() -> None:
    with refused(ModelError, "sampling.designs", count=3, size=300, least=352):
        tolerance(given(300), compute=formulas)
    assert tolerance(given(352), compute=formulas).rows == 32
    with refused(ModelError, "sampling.designs", size="10", count="1", least="160"):
        tolerance(study(Normal(0.2, 0.01), designs=10, outputs=SUM), compute=formulas)


def test_nothing_can_be_computed() -> None:
    def failing(values: Array) -> Outcome:
        count = len(values)
        return Outcome(np.full((count, 2), np.nan), np.full(count, NO_ASSEMBLY, np.uint8))

    with refused(UsageError, by="_tolerances"):
        tolerance(given(), compute=failing)


# -- a machine -------------------------------------------------------------------------------------


def test_a_machine() -> None:
    """By the study's own evaluator: the scatter about the machine, and its first-order slopes."""
    spreads = (Normal(0.199, 0.002), Uniform(0.0715, 0.0002))
    outputs = (Output("shaking_force.y.rms"), Output("joints.B.rms"))
    result = tolerance(study(*spreads, designs=256, outputs=outputs, angles=90))
    machine = eq.load("yamashita-1")
    for number, name in enumerate(("shaking_force.y", "joints.B")):
        scatter = result.scatters[outputs[number].name]
        assert scatter.base == pytest.approx(eq.analyze(machine, 90).summary[name].rms, rel=1e-12)
        slopes = []
        for cause, step in ((0, 0.002), (1, 0.0002 / np.sqrt(3))):
            points = {**machine.links["coupler"].points}
            x, y = points["C"]
            points["C"] = (x + step * cause, y)
            mass = machine.links["crank"].mass or 0.0
            changed = machine.with_link("crank", mass=mass + step * (1 - cause))
            changed = changed.with_link("coupler", points=points)
            slopes.append(eq.analyze(changed, 90).summary[name].rms - scatter.base)
        assert scatter.deviation == pytest.approx(float(np.hypot(*slopes)), rel=0.05)
        for cause in result.causes:
            own = slopes[result.study.paths.index(cause.numbers[0])]
            share = own**2 / np.sum(np.square(slopes))
            effect = cause.effects[outputs[number].name]
            assert effect.halved == pytest.approx(np.sqrt(1 - 0.75 * share), abs=0.03)
