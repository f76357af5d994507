"""The best designs of a store, against all of its designs looked at at once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from equipoise.codegen.figures import NO_ASSEMBLY, NO_FULL_TURN
from equipoise.design.variables import Range
from equipoise.errors import UsageError
from equipoise.keys.requirement_kinds import Make
from equipoise.studies.outcomes import DesignBlock, Outcome, far_apart, non_dominated
from equipoise.studies.run import create_store
from equipoise.studies.selection import best
from equipoise.studies.store import Store
from equipoise.studies.study import Output
from support.refusals import refused
from unit.studies.samples import LENGTH, MASS, study

Array = np.ndarray[Any, Any]
OUTPUTS = (
    Output("force", value="a.b", dimension="force", at_most=0.8, make="smallest"),
    Output("lift", value="a.c", dimension="length", at_least=0.2),
    Output("torque", value="a.d"),
)


def random_designs(count: int, seed: int = 1) -> DesignBlock:
    """Figures from 0 to 1, on few steps, so that many are equal; one in five fails."""
    generator = np.random.default_rng(seed)
    figures = np.round(generator.random((count, len(OUTPUTS))), 2)
    reason = np.where(generator.random(count) < 0.2, NO_FULL_TURN, 0).astype(np.uint8)
    figures[reason != 0] = np.nan
    return DesignBlock(generator.random((count, 2)), Outcome(figures, reason))


def stored(
    folder: Path,
    block: DesignBlock,
    outputs: tuple[Output, ...] = OUTPUTS,
    chunk: int = 16,
    upto: int = -1,
) -> Store:
    """A store with these designs in it; only the first chunks where `upto` says so."""
    count = len(block.values)
    given = study(Range(0.1, 0.2), Range(0.05, 0.1), designs=count, outputs=outputs, chunk=chunk)
    store = create_store(folder / f"store-{chunk}", given, chunk, "test")
    for number in range(store.chunks if upto < 0 else upto):
        part = store.designs(number)
        some = slice(part.start, part.stop)
        outcome = Outcome(block.outcome.figures[some], block.outcome.reason[some])
        store.write(part, DesignBlock(block.values[some], outcome))
    return store


def good_ones(block: DesignBlock, force: float = 0.8, lift: float = 0.2) -> Array:
    """Numbers of the designs that keep the limits."""
    figures = block.outcome.figures
    good = (figures[:, 0] <= force) & (figures[:, 1] >= lift) & (block.outcome.reason == 0)
    return np.flatnonzero(good)


def undominated(costs: Array) -> list[int]:
    """By comparing each with each; the first of equal ones."""
    actual = []
    for k, cost in enumerate(costs):
        better = np.all(costs <= cost, axis=1) & np.any(costs < cost, axis=1)
        if not np.any(better) and not np.any(np.all(costs[:k] == cost, axis=1)):
            actual.append(k)
    return actual


# -- choosing --------------------------------------------------------------------------------------


@pytest.mark.parametrize("chunk", [7, 16, 1000])
def test_by_one_figure(tmp_path: Path, chunk: int) -> None:
    block = random_designs(300)
    result = best(stored(tmp_path, block, chunk=chunk), 12)
    good = good_ones(block)
    order = good[np.argsort(block.outcome.figures[good, 0], kind="stable")][:12]
    assert result.designs.tolist() == order.tolist()
    assert np.array_equal(result.values, block.values[order])
    assert np.array_equal(result.figures, block.outcome.figures[order])
    assert (result.kept, result.stored) == (len(good), 300)
    assert result.computed == np.sum(block.outcome.reason == 0)
    assert result.by == {"force": "smallest"}


@pytest.mark.parametrize(
    "by",
    [
        {"force": "smallest", "lift": "largest"},
        {"lift": "smallest", "torque": "smallest", "force": "largest"},
        {"force": None, MASS: "largest", "torque": None, LENGTH: "smallest"},
    ],
)
@pytest.mark.parametrize("chunk", [7, 64])
def test_by_several(tmp_path: Path, by: Mapping[str, Make | None], chunk: int) -> None:
    block = random_designs(300)
    result = best(stored(tmp_path, block, chunk=chunk), 1000, by)
    good = good_ones(block)
    columns = dict(zip(("force", "lift", "torque"), block.outcome.figures.T, strict=True))
    columns |= {MASS: block.values[:, 0], LENGTH: block.values[:, 1]}
    costs = [(-1 if way == "largest" else 1) * columns[name][good] for name, way in by.items()]
    wanted = good[undominated(np.stack(costs, axis=1))]
    assert sorted(result.designs.tolist()) == wanted.tolist()
    assert result.front == len(wanted) > 5
    first = costs[0][np.searchsorted(good, result.designs)]
    assert np.all(np.diff(first) >= 0)  # told in the order of the first figure


def test_some_of_a_large_front_lie_far_apart(tmp_path: Path) -> None:
    block = random_designs(400)
    angle = np.linspace(0, np.pi / 2, 400)
    figures = np.stack([1 - np.cos(angle), np.ones(400), 1 - np.sin(angle)], axis=1)
    block = DesignBlock(block.values, Outcome(figures, np.zeros(400, np.uint8)))
    outputs = (OUTPUTS[0], OUTPUTS[1], Output("torque", value="a.d", make="smallest"))
    result = best(stored(tmp_path, block, outputs), 5)
    kept = good_ones(block)
    assert result.front == len(kept)
    assert len(result.designs) == 5
    assert {int(kept[0]), int(kept[-1])} <= {*result.designs.tolist()}
    gaps = np.diff(result.designs)
    assert np.min(gaps) > 0.5 * np.mean(gaps)


def test_stores_that_are_not_finished(tmp_path: Path) -> None:
    block = random_designs(300)
    result = best(stored(tmp_path, block, upto=5), 3)
    assert result.stored == 5 * 16
    assert np.max(result.designs) < 5 * 16


def test_as_plain_values(tmp_path: Path) -> None:
    result = best(stored(tmp_path, random_designs(50)), 2)
    values = result.to_dict()
    assert values["by"] == {"force": "smallest"}
    assert values["kept"] == result.kept
    first = values["designs"][0]
    assert first["design"] == result.designs[0]
    assert first["values"] == dict(zip((MASS, LENGTH), result.values[0], strict=True))
    assert first["figures"]["lift"] == result.figures[0, 1]


# -- refused ---------------------------------------------------------------------------------------


def test_nothing_to_go_by(tmp_path: Path) -> None:
    outputs = tuple(Output(output.name, value=output.value) for output in OUTPUTS)
    store = stored(tmp_path, random_designs(20), outputs)
    with refused(UsageError, by="_ways"):
        best(store)
    with refused(UsageError, given="lfit", name="lift"):
        best(store, 5, {"lfit": None})
    with refused(UsageError, count=0):
        best(store, 0)


def test_no_design_keeps_the_limits(tmp_path: Path) -> None:
    block = random_designs(100)
    outputs = (
        Output("force", value="a.b", dimension="force", at_most=0.1, make="smallest"),
        Output("lift", value="a.c", dimension="length", at_least=2, at_most=3.0),
        Output("torque", value="a.d"),
    )
    store = stored(tmp_path, block, outputs)
    low = int(np.sum(block.outcome.figures[:, 0] <= 0.1))
    computed = int(np.sum(block.outcome.reason == 0))
    kept = f"force <= 0.1 N: {low}, 2000 <= lift <= 3000 mm: 0"
    with refused(UsageError, place=str(store.path), computed=computed, names=kept):
        best(store)


def test_every_design_failed(tmp_path: Path) -> None:
    reason = np.array([NO_FULL_TURN, NO_ASSEMBLY, NO_FULL_TURN], np.uint8)
    block = DesignBlock(np.ones((3, 2)), Outcome(np.full((3, 3), np.nan), reason))
    store = stored(tmp_path, block)
    failed = "does not assemble: 1, does not turn fully: 2"
    with refused(UsageError, place=str(store.path), names=failed):
        best(store)


def test_nothing_is_stored(tmp_path: Path) -> None:
    store = stored(tmp_path, random_designs(40), upto=0)
    with refused(UsageError, place=str(store.path), path=str(store.path)):
        best(store)


# -- fronts ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kinds", [1, 2, 3, 5])
@pytest.mark.parametrize("count", [0, 1, 2, 200])
def test_fronts(kinds: int, count: int) -> None:
    costs = np.random.default_rng(kinds).integers(0, 9, (count, kinds)).astype(float)
    result = non_dominated(costs).tolist()
    assert result == (undominated(costs)[:1] if kinds == 1 else undominated(costs))


def test_places_far_apart() -> None:
    costs = np.array([[0.0, 1e3], [0.01, 990.0], [0.5, 500.0], [0.52, 490.0], [1.0, 0.0]])
    assert far_apart(costs, 3).tolist() == [0, 2, 4]
    assert far_apart(costs, 5).tolist() == [0, 1, 2, 3, 4]
    assert far_apart(costs[:, :1] * 0 + 1, 2).tolist() == [0, 1]
