"""Extremes in JavaScript, run by Node, are those that NumPy finds of the same values."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from equipoise.codegen.extremes import CurveTops, GridTops, PanelTops
from equipoise.codegen.kernel_script import extremes_script, script_of
from equipoise.signals import JumpSampling
from support.curves import SHAPES, curve_of
from support.interactive import NODE

Array = np.ndarray
needs_node = pytest.mark.skipif(NODE is None, reason="needs Node to run JavaScript: install nodejs")
RUN = """
const { signals, period, at, edges } = JSON.parse(require("fs").readFileSync("given.json", "utf8"));
const places = [at, edges].map((each) => each && Float64Array.from(each));
const answer = signals.map((each) => [...extremes(Float64Array.from(each), period, ...places)]);
console.log(JSON.stringify(answer));
"""


def by_node(text: str, given: dict[str, Any], folder: Path) -> Any:
    """What a script prints as JSON, in a folder with what it is given."""
    (folder / "given.json").write_text(json.dumps(given), encoding="utf-8")
    (folder / "run.js").write_text(text, encoding="utf-8")
    assert NODE is not None
    done = subprocess.run(
        [NODE, "run.js"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def assert_same(tops: CurveTops, values: Array, period: float, folder: Path) -> None:
    """Values to rounding, and places as far as a flat top tells them."""
    at, edges = tops.arguments()[:2] if isinstance(tops, PanelTops) else (None, None)
    given = {
        "signals": values.tolist(),
        "period": period,
        "at": at if at is None else at.tolist(),
        "edges": edges if edges is None else edges.tolist(),
    }
    text = extremes_script(jumps=edges is not None) + RUN
    out = np.array(by_node(text, given, folder))
    sizes = np.max(np.abs(values), axis=1)
    for sign, column in ((1.0, 2), (-1.0, 4)):
        known, places = tops(sign * values)
        assert np.all(np.abs(out[:, column] - sign * known) <= 1e-12 * sizes)
        apart = np.abs(out[:, column + 1] - places)
        # the top of a curve is flat, so rounding moves it by the root of that
        assert np.all(np.minimum(apart, period - apart) <= 1e-6)


@needs_node
@pytest.mark.parametrize(("count", "turns"), [(9, 1), (64, 2), (360, 1)])
def test_of_equally_spaced_values(count: int, turns: int, tmp_path: Path) -> None:
    rng, theta = np.random.default_rng(count), np.arange(count * turns) * 2 * pi / count
    values = [curve_of(shape, theta, turns, rng) for shape in SHAPES for _ in range(12)]
    assert_same(GridTops(2 * pi * turns), np.array(values), 2 * pi * turns, tmp_path)


@needs_node
@pytest.mark.parametrize(("count", "turns"), [(48, 1), (128, 2)])
def test_of_values_that_jump(count: int, turns: int, tmp_path: Path) -> None:
    rng, grid = np.random.default_rng(count), np.arange(count * turns) * 2 * pi / count
    tops = PanelTops(JumpSampling.of(grid, turns, np.array([1.0, 2.5, 4.0])))
    theta = tops.sampling.crank_angle[tops.order]
    jump = (theta > 1.0) & (theta < 2.5)
    values = [
        curve_of(shape, theta, turns, rng) + jump * rng.normal() / 3
        for shape in SHAPES
        for _ in range(12)
    ]
    assert_same(tops, np.array(values), 2 * pi * turns, tmp_path)


def passed_on(values: Array, count: int) -> tuple[float, int]:
    """A function of everything that the translation knows beside what extremes use."""
    total = 0.0
    for k in range(count, 0, -2):
        if k == 3 or (k != 5 and not total < -7 % 4):
            total -= values[k] / 2
            break
        total *= 2
    for value in values[1:]:
        total += value
    return total if total else -1.0, int(len(values) - 0.5)


@needs_node
def test_statements_mean_the_same(tmp_path: Path) -> None:
    values = [1.0, 2.5, -3.0, 4.0, 0.5, 7.0, 11.0]
    text = extremes_script(jumps=False) + script_of(passed_on)
    text += f"console.log(JSON.stringify(passed_on(Float64Array.from({values}), 5)));"
    assert by_node(text, {}, tmp_path) == [*passed_on(np.array(values), 5)]


def called_by_name(values: Array) -> Array:
    return np.sum(values, axis=0)


def kept_in_a_table(values: Array) -> dict[str, Array]:
    return {"values": values}


def gone_through_twice(values: Array) -> float:
    while values[0] > 0:
        values[0] -= 1
    return float(values[0])


def summed_by_python(values: Array) -> float:
    return float(sum(values))


def taken_from_the_end(values: Array) -> float:
    return values[-1]  # type: ignore[no-any-return]


def raised_in_place(values: Array) -> None:
    values[0] **= 2


@pytest.mark.parametrize(
    "function",
    [
        called_by_name,
        kept_in_a_table,
        gone_through_twice,
        summed_by_python,
        taken_from_the_end,
        raised_in_place,
    ],
)
def test_what_has_no_counterpart_is_refused(function: Callable[..., Any]) -> None:
    with pytest.raises(TypeError):
        script_of(function)
