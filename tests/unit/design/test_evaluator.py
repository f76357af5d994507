"""Designs that are given, shared out among processes: the same figures in the same order."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from equipoise import load
from equipoise.design import evaluator as pooling
from equipoise.design.evaluator import PooledEvaluator
from equipoise.design.requirements import Requirement
from equipoise.errors import UsageError
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.parts.balance import Objective
from equipoise.planting.figures import machine_figures
from equipoise.planting.search import Designs, fit_planting
from equipoise.schema.studies import load_study
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator, pooled
from equipoise.studies.objective_map import landscape
from equipoise.studies.searching import search
from equipoise.studies.study import Output, Study, samples
from equipoise.studies.tolerances import tolerance
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused


def slow(name: str, designs: int) -> Study:
    """A bundled study whose only output no loop computes."""
    some = load_study(name)
    output = Output("swing", "analyze", "strokes.rocker.stroke", make="smallest")
    return replace(some, outputs=(output,), sampling=replace(some.sampling, designs=designs))


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Processes begin with the second design; returns what is computed by them."""
    parts: list[Any] = []
    computed = pooling.computed

    def counted(pool: Any, chunks: Any, here: Any = None) -> Any:
        for part, outcome in computed(pool, chunks, here):
            parts.append(part)
            yield part, outcome

    monkeypatch.setattr(pooling, "PATIENCE", -1.0)
    monkeypatch.setattr(pooling, "HANDY", 0.0)
    monkeypatch.setattr(pooling.Processes, "is_ready", True)  # else this process does it all
    monkeypatch.setattr(pooling, "computed", counted)
    return parts


# Figures in another order fail in `test_a_search_is_the_same_with_any_number_of_workers` too.
@EXHAUSTIVE
def test_processes_give_the_figures_in_the_order_of_the_designs(at_once: list[Any]) -> None:
    some = slow("study-of-balance", 64)
    values = samples(some, 0, 23)
    values[5] = -values[5]  # no machine
    with pooled(some, 2) as evaluate:
        actual, again = evaluate(values), evaluate(values[::-1])
    alone = evaluator(some)(values)
    assert alone.reason[5] != 0
    assert np.isfinite(alone.figures).any()
    for outcome, order in ((actual, slice(None)), (again, slice(None, None, -1))):
        np.testing.assert_array_equal(outcome.figures[order], alone.figures)
        np.testing.assert_array_equal(outcome.reason[order], alone.reason)
    assert sum(len(part.values) for part in at_once) == 22 + 23


def test_what_is_over_soon_starts_no_process() -> None:
    some = slow("study-of-balance", 64)
    with pooled(some, 2) as evaluate:
        evaluate(samples(some, 0, 4))
        assert evaluate.runner.pool is None


@pytest.mark.parametrize(("expected", "is_early"), [(399, False), (400, True)])
def test_processes_start_before_many_expected_designs(
    expected: int, is_early: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While this process still imports what it needs for the first."""
    begun: list[bool] = []
    monkeypatch.setattr(pooling.Runner, "begin", lambda _: begun.append(True))
    make = partial(partial, np.square)
    PooledEvaluator(np.square, make, np.concatenate, 2, expected=expected)
    PooledEvaluator(np.square, make, np.concatenate, 1, expected=expected)
    PooledEvaluator(np.square, make, np.concatenate, 2, expected=expected, batch_size=2)
    assert begun == [True] * is_early


def test_processes_are_for_all_designs_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not for those of a call alone, of which a search makes many short ones."""
    monkeypatch.setattr(pooling, "QUICK", 0.0)
    few, many = (
        PooledEvaluator(np.square, lambda: np.square, np.concatenate, 2, expected=count)
        for count in (8, 399)
    )
    moments = iter(range(100))
    monkeypatch.setattr(pooling, "monotonic", lambda: 0.1 * next(moments))  # of a design
    for evaluate in (few, many):
        evaluate(np.arange(1.0))
        assert not evaluate.is_shared_out, "the first takes long for another reason"
        evaluate(np.arange(1.0))
    assert (few.is_shared_out, many.is_shared_out) == (False, True)


def test_a_few_quick_designs_do_not_keep_the_others_from_processes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Such as those that are no machine, as the first may happen to be."""
    durations = iter([0.1, 0.0, 1.0])
    moments = (moment for took in durations for moment in (0.0, took))
    monkeypatch.setattr(pooling, "monotonic", lambda: next(moments))
    evaluate = PooledEvaluator(np.square, lambda: np.square, np.concatenate, 2)
    for _ in range(2):
        evaluate(np.arange(1.0))
    evaluate.begun = True
    assert evaluate.each < pooling.HANDY
    evaluate(np.arange(1.0))
    assert evaluate.each > pooling.HANDY


def test_loops_share_out_nothing(at_once: list[Any]) -> None:
    some = load_study("study-of-balance")
    with pooled(some, 2) as evaluate:
        evaluate(samples(some, 0, 64))
        assert evaluate.runner.pool is None
    assert not at_once


def test_a_search_is_the_same_with_any_number_of_workers(at_once: list[Any]) -> None:
    some = slow("study-of-balance", 64)
    results = [search(some, population=8, generations=2, workers=k) for k in (1, 2)]
    assert results[0].to_dict() == results[1].to_dict()
    assert at_once


# Parts in another order fail in `test_a_search_is_the_same_with_any_number_of_workers` too.
@EXHAUSTIVE
def test_a_map_is_the_same_with_any_number_of_workers(at_once: list[Any]) -> None:
    """Of lengths, of which some cannot turn; bit for bit."""
    over = {
        "links.crank.points.B.x": np.linspace(0.011, 0.081, 5),
        "links.coupler.points.C.x": np.linspace(0.041, 0.151, 5),
    }
    first, two = (
        landscape(Template.load("yamashita-1"), over, Objective("shaking_force"), workers=k)
        for k in (1, 2)
    )
    assert 0 < np.isnan(first.values).sum() < 25
    assert np.array_equal(first.values, two.values, equal_nan=True)
    assert (first.best, first.least, first.before) == (two.best, two.least, two.before)
    assert sum(len(part.values) for part in at_once) == 24, "all but the first"


@EXHAUSTIVE  # On every change: the search above, by the same processes.
def test_a_search_of_geometry_is_the_same_with_any_number_of_workers(at_once: list[Any]) -> None:
    goals = [
        Requirement("curve.width", target=0.1),
        Requirement("max_speed.value", make="smallest"),
    ]
    machine, few = load("kim-chung-c"), {"seed": 3, "generations": 2, "population": 8}
    first, two = (fit_planting(machine, goals, workers=k, **few) for k in (1, 2))  # type: ignore[arg-type]
    assert first.to_dict() == two.to_dict()
    assert (first.machine, first.judged) == (two.machine, two.judged)
    assert at_once


@pytest.mark.exhaustive(but=["100-sizes0"])
@pytest.mark.parametrize(("count", "sizes"), [(100, {32}), (41, {20})])
def test_what_arrays_compute_is_sent_in_large_parts(
    count: int, sizes: set[int], at_once: list[Any]
) -> None:
    """But so that each process has some; the first design is computed here."""
    make = partial(partial, np.square)
    with PooledEvaluator(np.square, make, np.concatenate, 2, batch_size=32) as evaluate:
        np.testing.assert_array_equal(evaluate(np.arange(count)), np.arange(count) ** 2)
    assert {len(part.values) for part in at_once[:-1]} <= sizes | {(count - 1) % 32}
    assert max(len(part.values) for part in at_once) in sizes


def test_what_is_over_at_once_is_computed_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few designs are not sent to processes, though there are some."""
    with PooledEvaluator(np.square, lambda: np.square, np.concatenate, 2) as evaluate:
        evaluate(np.arange(3.0))
        evaluate.runner.pool = object()  # type: ignore[assignment]  # which computes nothing
        np.testing.assert_array_equal(evaluate(np.array([2.0, 3.0])), [4.0, 9.0])
        evaluate.runner.pool = None


# Nor does any in a loop: tests/unit/codegen/test_batch.py, by NumPy.
@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(["kim-chung-a", "transplanter"], {"kim-chung-a"}))
def test_no_figure_of_a_finger_depends_on_those_computed_beside_it(name: str) -> None:
    """Bit for bit, so that it does not matter into which parts designs are shared out."""
    designs = Designs(load(name))
    low, high = designs.bounds
    shares = 0.03 * (np.random.default_rng(1).random((6, len(low))) - 0.5)
    machines = [designs.build(row) for row in designs.start + shares * (high - low)]
    together = machine_figures(TipCurve(machines))
    for k, machine in enumerate(machines):
        alone = machine_figures(TipCurve([machine]))
        for figure, values in together.items():
            np.testing.assert_array_equal(values[k], alone[figure][0], figure)


@pytest.mark.parametrize("count", [0, -1])
def test_fewer_than_one_worker_is_refused(count: int) -> None:
    with refused(UsageError, workers=count):
        pooled(load_study("study-of-balance"), count)
    with refused(UsageError, workers=count):
        tolerance(load_study("study-of-tolerances"), workers=count)
