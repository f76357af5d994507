"""Pictures of balancing: what they draw is what was found, and texts keep clear of each other."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from matplotlib.axes import Axes

import equipoise as eq
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.optimisation import default_plan
from equipoise.plotting.balancing import drawings
from equipoise.plotting.balancing.looks import paired
from equipoise.plotting.bars import bars as draw_bars
from equipoise.plotting.style import Kind, render, styled
from equipoise.plotting.vibration.panels import stack
from unit.plotting.balance_samples import (
    EVERY,
    Pictures,
    found,
    front,
    hashed,
    in_rows,
    labelled,
    line,
    phasing,
    pictures,
)
from unit.plotting.samples import words
from unit.plotting.vibration_samples import check_texts

SIGNALS = ["force", "polar", "moment", "torque"]


def columns(result: Balanced) -> dict[str, np.ndarray]:
    return {name: values for name, _, values in result.columns()}


# -- names, words, files ---------------------------------------------------------------------------


def test_names_in_order() -> None:
    assert list(pictures("sector")) == [*SIGNALS, "orders", "changes"]
    assert list(pictures("rows")) == ["orders", "phases", "rows"]
    assert list(pictures("rows, both")) == [*SIGNALS, "orders", "changes", "phases", "rows"]
    assert list(pictures("phases")) == ["phases", "rows"]
    assert list(pictures("front")) == ["front"]


@pytest.mark.parametrize("kind", EVERY)
def test_texts_keep_clear_of_each_other(kind: str) -> None:
    for name, figure in pictures(kind).items():
        check_texts(f"{kind}: {name}", figure)


def test_odd_names_are_no_formulas() -> None:
    for name, figure in pictures("odd names").items():
        svg = ElementTree.fromstring(render(figure, "svg"))
        assert "Costs $5 and " in "".join(svg.itertext()), name
    assert "$cr_a$nk" in words(pictures("odd names")["changes"])
    assert "right to left" in words(pictures("odd names")["force"])


def drawn_again() -> Pictures:
    again = {name: figure for kind in ("sector", "geared") for name, figure in _of(kind).items()}
    return again | drawings(phasing()) | drawings(front())


def _of(kind: str) -> Pictures:
    return {f"{kind} {name}": figure for name, figure in drawings(found(kind)).items()}


def test_the_same_bytes_on_every_run() -> None:
    once, again = drawn_again(), drawn_again()
    for name, figure in once.items():
        kinds: tuple[Kind, ...] = ("svg", "png", "pdf") if name == "sector changes" else ("svg",)
        for kind in kinds:
            file = render(figure, kind)
            assert file == render(figure, kind) == render(again[name], kind), name


def test_the_same_bytes_in_another_process() -> None:
    program = "from unit.plotting.balance_samples import hashed\nprint(hashed())\n"
    tests = str(Path(__file__).parents[2])
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        check=True,
        text=True,
        env={**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": tests},
    )
    assert run.stdout.strip() == hashed()


def test_the_users_settings_do_not_matter() -> None:
    file = render(pictures("sector")["changes"], "svg")
    with matplotlib.rc_context({"font.size": 30, "axes.grid": False, "lines.linewidth": 9}):
        assert render(drawings(found("sector"))["changes"], "svg") == file


# -- signals ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["sector", "one of each", "long cycle"])
def test_lines_are_the_signals(kind: str) -> None:
    told = columns(found(kind))
    drawn = pictures(kind)
    turns = 2 if kind == "long cycle" else 1
    panels = {
        "shaking_force.x": drawn["force"].axes[0],
        "shaking_force.y": drawn["force"].axes[1],
        "shaking_moment": drawn["moment"].axes[0],
        "drive_torque": drawn["torque"].axes[0],
    }
    for name, axes in panels.items():
        assert axes.get_xlim() == (0, 360 * turns)
        alike = axes.get_lines()[0].get_label() == "unchanged"
        for number, when in enumerate(("after",) if alike else ("before", "after")):
            values = told[f"{name}.{when}"]
            expected = np.append(values, values[0])
            np.testing.assert_allclose(line(axes, number).imag, expected, atol=1e-12)
            degrees = np.degrees(told["crank_angle"])
            angles = np.append(degrees, 360 * turns)
            np.testing.assert_allclose(line(axes, number).real, angles, atol=1e-9)
        if alike:
            np.testing.assert_allclose(told[f"{name}.before"], values, rtol=1e-6)
            continue
        before, after = axes.get_lines()[:2]
        assert before.get_linewidth() < after.get_linewidth()
    largest = np.max(told["shaking_moment.after"])
    assert f"{largest:.4g} at " in words(drawn["moment"])


def test_hodograph() -> None:
    told = columns(found("sector"))
    axes = pictures("sector")["polar"].axes[0]
    assert axes.get_aspect() == 1
    for when in ("before", "after"):
        (drawn,) = labelled(axes, when)
        values = told[f"shaking_force.x.{when}"] + 1j * told[f"shaking_force.y.{when}"]
        np.testing.assert_allclose(drawn, np.append(values, values[0]), atol=1e-12)
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert right - left == pytest.approx(top - bottom)
    assert [words(pictures("sector")["polar"]).count(f"\n{k}\n") for k in (90, 180)] == [2, 2]


def test_what_did_not_change_is_seen_and_told_once() -> None:
    told = words(pictures("sector")["moment"])
    largest = np.max(columns(found("sector"))["shaking_moment.after"])
    assert told.count(f"{largest:.4g} at ") == 1
    before, after = pictures("sector")["force"].axes[0].get_lines()[:2]
    assert before.get_zorder() > after.get_zorder()
    assert "unchanged" in told and "before\n" not in told


def test_rounding_is_nothing() -> None:
    before = np.array([1.0, -2.0])
    assert np.all(paired(before, 1e-12 * before, 0.0)["after"] == 0)
    assert np.all(paired(before, 1e-3 * before, 0.0)["after"] == 1e-3 * before)
    assert np.all(paired(0 * before, before, 0.0)["after"] == before)
    assert not any(np.any(one) for one in paired(1e-13 * before, 2e-13 * before, 1e-12).values())


@pytest.mark.parametrize("name", ["planetary-planting-arm", "scotch-yoke"])
def test_a_moment_that_is_always_zero_is_no_curve(name: str) -> None:
    machine = eq.load(name)
    drawn = drawings(eq.balance(machine, default_plan(machine)))["moment"]
    assert "zero at every crank angle" in words(drawn)
    assert not np.any(line(drawn.axes[0], 0).imag)


# -- orders ----------------------------------------------------------------------------------------


def bars(axes: Axes, side: int) -> dict[float, float]:
    """Order -> height, of the bars before (0) or after (1)."""
    found = axes.containers[side].patches  # type: ignore[attr-defined]
    middles = (bar.get_x() + bar.get_width() * (1 - side) for bar in found)
    return {
        round(2 * middle) / 2: bar.get_height() for middle, bar in zip(middles, found, strict=True)
    }


def test_bars_are_the_orders() -> None:
    told = columns(found("sector"))
    axes = pictures("sector")["orders"].axes[0]
    for side, when in enumerate(("before", "after")):
        amplitudes = np.abs(eq.signals.harmonics(told[f"shaking_force.y.{when}"]))
        heights = bars(axes, side)
        assert list(heights) == list(range(len(heights))) and len(heights) > 4
        for order, height in heights.items():
            assert height == pytest.approx(amplitudes[int(order)], abs=1e-9)
    assert axes.get_title(loc="left") == "shaking force y, RMS"
    assert f"{bars(axes, 0)[1.0]:.1f}" in words(pictures("sector")["orders"])


@pytest.mark.parametrize("factor", [1.0, 1e3])
def test_numbers_at_bars_keep_apart(factor: float) -> None:
    """Also where they have no digit after the point that could go."""
    orders = np.arange(9.0)
    read = {when: (orders, factor * size * 0.8**orders) for when, size in (("a", 1), ("b", 0.95))}
    with styled():
        _, (axes,) = stack(1, 2.0, "title", "what")
        draw_bars(axes, read, {"a": ("k", "k"), "b": ("b", "b")}, False, 8)
        boxes = [one.get_window_extent() for one in axes.texts]
    assert len(boxes) > 6
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_orders_of_vectors_and_joints_and_of_some_orders() -> None:
    result = found("one of each")
    force, joint, moment = pictures("one of each")["orders"].axes
    told = columns(result)
    parts = [np.abs(eq.signals.harmonics(told[f"shaking_force.{axis}.before"])) for axis in "xy"]
    assert bars(force, 0)[1.0] == pytest.approx(np.hypot(*(part[1] for part in parts)), rel=1e-9)
    at_b = eq.forces(eq.move(result.original, 720)).joints["B"]
    mean = np.hypot(np.mean(at_b.x), np.mean(at_b.y))
    assert bars(joint, 0)[0.0] == pytest.approx(mean, rel=1e-6)
    assert [order for order, height in bars(moment, 0).items() if height > 1e-9] == [1, 2]
    assert force.get_title(loc="left") == "shaking force, RMS: both components together"
    assert moment.get_title(loc="left") == "shaking moment, RMS, order 1, 2"
    assert force.get_xlim() == joint.get_xlim() == moment.get_xlim()
    assert (force.get_ylabel(), moment.get_ylabel()) == ("amplitude, N", "amplitude, N m")


def test_half_orders_only_where_there_are_some() -> None:
    axes = pictures("long cycle")["orders"].axes[0]
    halves = [order for order in bars(axes, 1) if order % 1]
    told = columns(found("long cycle"))
    parts = [np.abs(eq.signals.harmonics(told[f"shaking_force.{a}.after"])) for a in "xy"]
    amplitudes = np.hypot(*parts)
    assert np.max(amplitudes[1::2]) > 0.1 and halves
    assert bars(axes, 1)[1.5] == pytest.approx(amplitudes[3], rel=1e-6)


def test_orders_of_rows_are_of_all_of_them() -> None:
    axes = pictures("rows")["orders"].axes[0]
    before, after = in_rows().objectives["rms of shaking_force"]
    for side, value in ((0, before), (1, after)):
        powers = [
            height**2 / (1 if order == 0 else 2) for order, height in bars(axes, side).items()
        ]
        assert np.sqrt(sum(powers)) == pytest.approx(value, rel=0.02)


def test_gauges_have_no_bars() -> None:
    result = eq.balance(eq.load("balance-rig"))
    assert "orders" not in drawings(result)


def test_many_objectives_go_on_in_further_pictures() -> None:
    result = found("sector")
    many = tuple(eq.balancing.Objective("shaking_force.y", "rms", (k,)) for k in range(1, 7))
    drawn = drawings(replace(result, plan=replace(result.plan, objectives=many)))
    assert [len(drawn[name].axes) for name in ("orders", "orders-2")] == [4, 2]
    assert "5 to 6 of 6" in words(drawn["orders-2"])
