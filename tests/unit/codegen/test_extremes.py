"""Extremes by compiled functions are those that NumPy finds of the same values."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.codegen.backends import compiled_kernel
from equipoise.codegen.extremes import CurveTops, GridTops, PanelTops, columns_of
from equipoise.codegen.figures import Gathered
from equipoise.signals import JumpSampling
from support.batches import wanted_of
from support.curves import SHAPES, curve_of

Array = np.ndarray
COLUMNS = columns_of(Gathered((*(("y", kind) for kind in ("highest", "lowest")), *(
    ("y", kind) for kind in ("top", "top_at", "dip", "dip_at")))))  # fmt: skip


def assert_same(tops: CurveTops, values: Array, period: float) -> None:
    """Values to rounding, and places unless values are as good as equal."""
    out = np.full((len(values), 6), np.nan)
    out[:, 0], out[:, 1] = values.max(axis=1), values.min(axis=1)
    kernel = compiled_kernel(tops.kernel(values.shape[1]))
    kernel(np.ascontiguousarray(values[:, None]), out, COLUMNS, *tops.arguments())
    sizes = np.max(np.abs(values), axis=1)
    for sign, column in ((1.0, 2), (-1.0, 4)):
        known, at = tops(sign * values)
        assert np.all(np.abs(out[:, column] - sign * known) <= 1e-12 * sizes)
        apart = np.abs(out[:, column + 1] - at)
        # the top of a curve is flat, so rounding moves it by the root of that
        assert np.all(np.minimum(apart, period - apart) <= 1e-6)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("count", "turns", "first"), [(9, 1, 0.0), (64, 2, 0.3), (360, 1, 0.0)])
def test_of_equally_spaced_values(shape: str, count: int, turns: int, first: float) -> None:
    rng, theta = np.random.default_rng(count), np.arange(count * turns) * 2 * np.pi / count
    values = np.array([curve_of(shape, theta, turns, rng) for _ in range(30)])
    assert_same(GridTops(2 * np.pi * turns, first), values, 2 * np.pi * turns)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("count", "turns"), [(48, 1), (128, 2)])
def test_of_values_that_jump(shape: str, count: int, turns: int) -> None:
    rng, grid = np.random.default_rng(count), np.arange(count * turns) * 2 * np.pi / count
    tops = PanelTops(JumpSampling.of(grid, turns, np.array([1.0, 2.5, 4.0])))
    theta = tops.sampling.crank_angle[tops.order]
    jump = (theta > 1.0) & (theta < 2.5)
    values = np.array(
        [curve_of(shape, theta, turns, rng) + jump * rng.normal() / 3 for _ in range(30)]
    )
    assert_same(tops, values, 2 * np.pi * turns)


def test_columns_of_what_is_wanted() -> None:
    """A figure that takes one extreme has no column for the other."""
    (row,) = columns_of(Gathered.of(wanted_of(["points.B.x"], "max")))
    assert list(row[3:]) == [-1, -1, -1]
    assert len(set(row[:3])) == 3
    assert columns_of(Gathered.of(wanted_of(["points.B.x"], "rms"))).shape == (0, 6)
