"""All designs of a study as a picture has them, against all of them looked at at once."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from equipoise.studies.outcomes import DesignBlock, Outcome
from equipoise.studies.selection import BINS, MOST, SOME, Cloud, cloud_of
from equipoise.studies.store import UNKNOWN
from equipoise.studies.study import Output

NUMBERS = ("length", "mass")
OUTPUTS = (Output("force", at_most=50.0), Output("torque", at_least=0.2))
PAIRS = [("length", "force"), ("force", "torque")]
Array = np.ndarray[Any, Any]


def designs(size: int) -> DesignBlock:
    """Force from 1 to 1000, torque from 0 to 1; some fail, and some are not computed yet."""
    random = np.random.default_rng(size)
    values = random.uniform([0.1, 2.0], [0.3, 5.0], (size, 2))
    figures = np.column_stack([np.geomspace(1.0, 1000.0, size), random.uniform(size=size)])
    reason = np.where(values[:, 0] > 0.28, 2, 0).astype(np.uint8)
    reason[-size // 10 :] = UNKNOWN
    figures[reason != 0] = np.nan
    values[reason == UNKNOWN] = np.nan
    return DesignBlock(values, Outcome(figures, reason))


def cloud(block: DesignBlock, chunk: int) -> Cloud:
    def blocks() -> Iterator[tuple[int, DesignBlock]]:
        for start in range(0, len(block.values), chunk):
            part = slice(start, start + chunk)
            outcome = Outcome(block.outcome.figures[part], block.outcome.reason[part])
            yield start, DesignBlock(block.values[part], outcome)

    return cloud_of(blocks, NUMBERS, OUTPUTS, PAIRS, len(block.values))


@pytest.mark.parametrize("size", [500, MOST, MOST + 1, 30_000])
def test_every_design_counts_once(size: int) -> None:
    block = designs(size)
    result = cloud(block, 700)
    figures, reason = block.outcome.figures, block.outcome.reason
    there, lost = reason == 0, reason == 2
    good = there & (figures[:, 0] <= 50) & (figures[:, 1] >= 0.2)
    assert (result.kept, result.beyond) == (np.sum(good), np.sum(there & ~good))
    assert result.failed == np.sum(lost)
    force, torque = result.spreads["force"], result.spreads["torque"]
    assert (force.log, torque.log, result.spreads["mass"].log) == (True, False, False)
    assert (force.low, force.high) == (np.min(figures[there, 0]), np.max(figures[there, 0]))
    assert np.all(np.abs(result.lost["length"] - 0.29) < 0.015) and len(result.lost["length"]) > 2
    assert result.each == (size <= MOST)
    if result.each:
        np.testing.assert_array_equal(result.some["torque"], figures[there, 1])
        np.testing.assert_array_equal(result.good, good[there])
        return
    for first, second in PAIRS:
        names = (*NUMBERS, *(output.name for output in OUTPUTS))
        columns = dict(zip(names, (*block.values.T, *figures.T), strict=True))
        edges = [result.spreads[name].edges for name in (second, first)]
        for counts, mask in zip(result.counts[first, second], (good, there & ~good), strict=True):
            x, y = columns[first][mask], columns[second][mask]
            wanted = np.histogram2d(y, x, edges)[0]
            assert counts.shape == (BINS, BINS) and np.sum(counts) == np.sum(mask)
            assert np.sum(np.abs(counts - wanted)) <= 4  # but for rounding at the ends
    assert SOME / 2 < len(result.good) <= SOME


def test_blocks_do_not_matter() -> None:
    block = designs(20_000)
    first, other = cloud(block, 20_000), cloud(block, 333)
    for pair in PAIRS:
        np.testing.assert_array_equal(first.counts[pair], other.counts[pair])
    for name, column in first.some.items():
        np.testing.assert_array_equal(column, other.some[name])


# Blocks of fewer designs are drawn by the other tests of this file.
@pytest.mark.exhaustive
def test_millions_take_no_more_memory_than_a_block() -> None:
    block = designs(10_000)
    times = 150

    def blocks() -> Iterator[tuple[int, DesignBlock]]:
        yield from ((k * 10_000, block) for k in range(times))

    tracemalloc.start()
    result = cloud_of(blocks, NUMBERS, OUTPUTS, PAIRS, times * 10_000)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 25e6  # of all figures alone it would be 24 MB, of all columns 48 MB
    assert result.kept + result.beyond + result.failed == times * 9000
    assert np.sum(result.counts[PAIRS[0]]) == result.kept + result.beyond


def test_nothing_that_has_figures() -> None:
    block = designs(50)
    block.outcome.reason[:] = 2
    block.outcome.figures[:] = np.nan
    result = cloud(block, 20)
    assert (result.kept, result.beyond, result.failed) == (0, 0, 50) and not len(result.good)
