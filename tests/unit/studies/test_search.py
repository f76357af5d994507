"""The search: on formulas whose best is known, and on a four-bar against all of its designs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any
from unittest import mock

import numpy as np
import pytest

from equipoise.codegen.figures import NO_ASSEMBLY, NO_MACHINE
from equipoise.design.variables import Choices, Normal, Range, Variable
from equipoise.errors import ModelError, UsageError
from equipoise.keys.requirement_kinds import Make
from equipoise.mechanism.parts.machine import Machine
from equipoise.studies import searching
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Evaluator, Outcome, feasible, non_dominated
from equipoise.studies.searching import search, search_size
from equipoise.studies.study import Correlation, Output, Study
from support.chosen import EXHAUSTIVE
from support.refusals import refused, values_of
from unit.studies.samples import LENGTH, MASS, PATHS, study

Array = np.ndarray[Any, Any]


UNIT = (Range(0.0, 1.0),) * 3


def of(*outputs: Output, spreads: tuple[Any, ...] = UNIT, **changes: Any) -> Study:
    vary = tuple(Variable(path, spread) for path, spread in zip(PATHS, spreads, strict=False))
    some = study()
    sampling = replace(some.sampling, designs=20_000)
    return replace(some, **{"vary": vary, "outputs": outputs, "sampling": sampling, **changes})


def made(*names: str, make: Make = "smallest") -> tuple[Output, ...]:
    return tuple(Output(name, value="a.b", make=make) for name in names)


def formula(function: Any, failing: Any = None) -> Evaluator:
    """Figures of designs (P, d), from a function that gives them by their columns."""

    def compute(values: Array) -> Outcome:
        figures = np.stack(function(*values.T), axis=1)
        reason = np.zeros(len(values), np.uint8)
        if failing is not None:
            reason[failing(*values.T)] = NO_ASSEMBLY
        figures[reason != 0] = np.nan
        return Outcome(figures, reason)

    return compute


def searched(outputs: tuple[Output, ...], function: Any, failing: Any = None, **given: Any) -> Any:
    """The search of a study of these outputs over the unit cube, or other spreads."""
    some = of(*outputs, spreads=given.pop("spreads", UNIT))
    return search(some, compute=formula(function, failing), **given)


def bowl(x: Array, y: Array, z: Array) -> list[Array]:
    return [(x - 0.3) ** 2 + (y - 0.6) ** 2 + (z - 0.9) ** 2]


def two_bowls(x: Array, y: Array, z: Array) -> list[Array]:
    """Between their lowest points, (0.2, 0.5, 0.5) and (0.8, 0.5, 0.5), nothing is better."""
    away = (y - 0.5) ** 2 + (z - 0.5) ** 2
    return [(x - 0.2) ** 2 + away, (x - 0.8) ** 2 + away]


# -- one objective ---------------------------------------------------------------------------------


def test_one_objective() -> None:
    result = searched(made("f"), bowl, population=30, generations=100)
    assert result.values[0] == pytest.approx([0.3, 0.6, 0.9], abs=2e-3)
    assert len(result.values) == result.front == 1
    assert np.all(np.diff(result.volumes) <= 0)
    assert result.volumes[-1] == result.figures[0, 0]


def test_the_largest() -> None:
    upside_down = lambda *at: [5 - item for item in bowl(*at)]  # noqa: E731
    result = searched(made("f", make="largest"), upside_down, population=30)
    assert result.figures[0, 0] == pytest.approx(5, abs=1e-4)
    assert result.volumes[-1] == result.figures[0, 0]
    assert result.stood_still
    assert result.generations < 200


def test_limits_and_failures() -> None:
    """The best lies in the corner of a limit and of a region where nothing can be computed."""
    outputs = (*made("f"), Output("x", value="a.c", at_least=0.5), Output("free", value="a.d"))
    figures, failing = lambda x, y, z: [*bowl(x, y, z), x, z], lambda x, y, z: y > 0.5
    result = searched(outputs, figures, failing, population=30)
    assert result.values[0] == pytest.approx([0.5, 0.5, 0.9], abs=2e-3)
    assert result.values[0, 0] >= 0.5
    assert 0 < result.failures["does not assemble"] < result.computed


def test_lists_and_whole_numbers() -> None:
    spreads = (Choices((0.9, 0.1, 0.35)), Range(-3, 12, whole=True), Range(0.0, 1.0))
    given: dict[str, Any] = {"spreads": spreads, "population": 20, "generations": 60}
    result = searched(made("f"), lambda x, y, z: bowl(x, y / 10, z), **given)
    assert result.values[0, :2].tolist() == [0.35, 6.0]
    assert result.values[0, 2] == pytest.approx(0.9, abs=0.01)


# -- several ---------------------------------------------------------------------------------------


# Designs off their front fail in `test_the_front_of_a_known_problem` of
# tests/laws/test_study_laws.py too.
@EXHAUSTIVE
def test_a_front_that_is_known() -> None:
    result = searched(made("f", "g"), two_bowls, population=60)
    x, y, z = result.values.T
    assert np.all((x > 0.19) & (x < 0.81))
    assert max(np.max(abs(y - 0.5)), np.max(abs(z - 0.5))) < 0.03
    assert np.all(np.diff(result.figures[:, 0]) > 0)  # in the order of the first
    assert np.all(np.diff(result.figures[:, 1]) < 0)
    assert np.max(np.diff(np.sort(x))) < 0.05  # along all of it
    assert result.front >= len(result.values) == 60
    assert result.objectives == {"f": "smallest", "g": "smallest"}


# Fronts: `test_many_objectives`.
@pytest.mark.exhaustive
def test_one_down_and_one_up() -> None:
    """Largest x for smallest x squared, where y only harms: the front is y = 0."""
    outputs = (*made("low"), *made("high", make="largest"))
    figures = lambda x, y, z: [x**2 + y, x - y - (z - 0.5) ** 2]  # noqa: E731
    result = searched(outputs, figures, population=40)
    assert result.figures[:, 1] == pytest.approx(np.sqrt(result.figures[:, 0]), abs=0.02)
    assert np.ptp(result.figures[:, 1]) > 0.9


def test_many_objectives() -> None:
    """Distances from the corners of a simplex: what lies in it is the front."""
    corners = np.eye(4)[:, :3]

    def distances(x: Array, y: Array, z: Array) -> list[Array]:
        return [(x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2 for a, b, c in corners]

    result = searched(made("a", "b", "c", "d"), distances, population=84, generations=40)
    assert np.mean(np.sum(result.values, axis=1) < 1.1) > 0.85
    assert len(result.values) == 84
    assert np.all(np.min(result.figures, axis=0) < 0.03)


# Fronts: `test_many_objectives`.
@pytest.mark.exhaustive
def test_the_volume_grows_until_it_stands_still() -> None:
    result = searched(made("f", "g"), two_bowls, population=40)
    assert np.all(np.diff(result.volumes) >= -1e-12)
    assert result.stood_still
    assert result.generations == len(result.volumes) < 200
    few = searched(made("f", "g"), two_bowls, population=40, generations=3)
    assert (few.generations, few.stood_still) == (3, False)


def test_the_same_seed_gives_the_same() -> None:
    texts: list[tuple[int, ...]] = []
    small = {"population": 20, "generations": 12}

    def run(seed: int | None = None, **given: Any) -> Array:
        values: Array = searched(made("f", "g"), two_bowls, seed=seed, **small, **given).values
        return values

    first = run(progress=lambda *at: texts.append(at))
    assert np.array_equal(run(1), first)
    assert not np.array_equal(run(2), first)
    assert [item[:2] for item in texts] == [(k, 12) for k in range(1, 13)]
    assert [item[2] for item in texts] == sorted(item[2] for item in texts)


@pytest.mark.parametrize(("generations", "solver"), [(200, "complete enumeration"), (5, "NSGA-II")])
def test_nothing_is_computed_twice(
    generations: int, solver: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """Nor does the library say anything."""
    seen: list[tuple[float, ...]] = []

    def compute(values: Array) -> Outcome:
        seen.extend(map(tuple, values.tolist()))
        return formula(two_bowls)(values)

    spreads = (Choices(tuple(np.linspace(0, 1, 4).tolist())),) * 3
    some, size = (
        of(*made("f", "g"), spreads=spreads),
        {"population": 12, "generations": generations},
    )
    result = search(some, compute=compute, **size)  # type: ignore[arg-type]
    assert result.solver == solver
    assert len(seen) == len(set(seen)) == result.computed <= 4**3
    assert capfd.readouterr() == ("", "")


# -- refused ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("some", "place"),
    [
        (of(*made("f"), spreads=(Range(0.0, 1.0), Normal(0.07, 0.001))),
         "vary[2]"),
        (of(*made("f"), correlations=(Correlation(MASS, LENGTH, 0.5),)),
         "correlations"),
        (of(Output("f", value="a.b", at_most=1.0)),
         "outputs"),
    ],
)  # fmt: skip
def test_what_cannot_be_searched(some: Study, place: str) -> None:
    with refused(ModelError, place):
        search(some, compute=formula(bowl))


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"population": 4}, {"population": 4, "most": "8 to 100000"}),
        ({"generations": 0}, {"generations": 0, "most_generations": 100000}),
    ],
)
def test_sizes(given: dict[str, int], expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        searched(made("f"), bowl, **given)


def test_nothing_keeps_the_limits() -> None:
    """Each in the unit that its figure is shown in, and by how many designs."""
    for dimension, limit in (
        (None, "x >= 2"),
        ("length", "x >= 2000 mm"),
        ("angle", "x >= 114.59"),
    ):
        outputs = (*made("f"), Output("x", value="a.c", dimension=dimension, at_least=2.0))
        with pytest.raises(UsageError) as caught:
            searched(outputs, lambda x, y, z: [x, y], population=8, generations=3)
        (text,) = [text for name, text in values_of(caught.value.note) if name == "names"]
        assert text.startswith(limit) and text.endswith(": 0")


def test_nothing_can_be_computed() -> None:
    def failing(values: Array) -> Outcome:
        count = len(values)
        return Outcome(np.full((count, 1), np.nan), np.full(count, NO_MACHINE, np.uint8))

    with refused(UsageError, by="_result"):
        search(of(*made("f")), compute=failing, population=8, generations=3)


# -- a machine -------------------------------------------------------------------------------------


@EXHAUSTIVE
def test_a_four_bar_against_every_design() -> None:
    """Of a grid of designs the search finds the whole front; between them it finds better ones."""
    rocker = "links.rocker.points.C.x"
    lengths = tuple(np.linspace(0.05, 0.1, 10).tolist())
    outputs = (
        Output("shaking_force.y.rms", make="smallest"),
        Output("four_bar.swing", make="largest"),
        Output("four_bar.transmission_min", at_least=0.6),
    )
    vary = (Variable(LENGTH, Choices(lengths)), Variable(rocker, Choices(lengths)))
    some = replace(of(*outputs), vary=vary, angles=90)
    compute = evaluator(some)
    every = np.stack(np.meshgrid(lengths, lengths, indexing="ij"), axis=-1).reshape(-1, 2)
    outcome = compute(every)
    good = np.flatnonzero(
        np.all(feasible(outputs, outcome.figures), axis=1) & (outcome.reason == 0)
    )
    wanted = good[non_dominated(outcome.figures[good, :2] * (1, -1))]
    assert 3 < len(wanted) < len(good) < len(every)

    result = search(some, compute=compute, population=20)
    assert {*map(tuple, result.values)} == {*map(tuple, every[wanted])}
    assert result.stood_still  # there was nothing else to compute
    machine = result.machine(0)
    assert isinstance(machine, Machine)
    assert machine.links["rocker"].points["C"][0] == result.values[0, 1]

    ranges = (Variable(LENGTH, Range(0.05, 0.1)), Variable(rocker, Range(0.05, 0.1)))
    between = search(replace(some, vary=ranges), compute=compute, population=24, generations=12)
    best_of_grid = np.min(outcome.figures[wanted, 0])
    assert np.min(between.figures[:, 0]) < best_of_grid
    for number in (0, len(between.values) - 1):
        own = np.array([between.values[number]])
        assert np.array_equal(compute(own).figures[0], between.figures[number])


# -- how many designs ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("designs", "given", "size"),
    [
        (16384, {}, (100, 163)),
        (10**6, {}, (100, 200)),
        (200, {}, (20, 10)),
        (20, {}, (8, 2)),
        (2000, {"population": 40}, (40, 50)),
        (30, {"population": 40}, (40, 1)),
        (30, {"generations": 5}, (100, 5)),
        (5, {"population": 8, "generations": 3}, (8, 3)),
    ],
)
def test_the_number_of_designs_bounds_a_search(
    designs: int, given: dict[str, int], size: tuple[int, int]
) -> None:
    some = of(*made("f"), sampling=replace(study().sampling, designs=designs))
    assert search_size(some, **given) == size


def test_no_more_designs_are_computed_than_the_study_has() -> None:
    computed = 0

    def counting(values: Array) -> Outcome:
        nonlocal computed
        computed += len(values)
        return formula(two_bowls)(values)

    some = of(*made("f", "g"), sampling=replace(study().sampling, designs=150))
    assert search(some, compute=counting).computed == computed <= 150


def test_too_few_designs_for_a_search() -> None:
    some = of(*made("f"), sampling=replace(study().sampling, designs=5))
    with refused(ModelError, "sampling.designs", size="5", least_population="8"):
        search(some, compute=formula(bowl))


def test_the_time_to_breed_is_measured_without_computing() -> None:
    def failing(*_: Any) -> Any:
        raise AssertionError

    outputs = (*made("f", "g"), Output("x", value="a.c", at_least=2.0, at_most=3.0))
    some = of(*outputs)
    with mock.patch.object(searching, "pooled", failing):
        assert searching.breeding_time(some, 10) > 0
