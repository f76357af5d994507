"""Charts of balancing: before and after, orders, rows with their phases, trade-offs."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced
from equipoise.figures import balancing as view
from equipoise.figures.balancing import aims_of
from equipoise.figures.forces import order_panel, spectrum
from equipoise.figures.layout import lay_out
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.results.charts import Chart
from equipoise.vibration.forced import respond
from unit.figures.balance_samples import balanced_case, front, in_rows, phasing, pictures
from unit.figures.samples import words


def curve(chart: Chart, role: str, panel: int = 0) -> np.ndarray:
    return next(c for c in chart.panels[panel].curves if c.role == role).y[:-1]


def test_names_in_order() -> None:
    every = ["aims", "force", "polar", "torque", "changes"]
    assert list(view.balance_charts(balanced_case("sector"))) == every
    assert list(pictures("phases")) == ["phases", "rows"]
    assert {"phases", "rows", "changes"} <= pictures("rows, both").keys()
    assert list(pictures("front")) == ["front"]


@pytest.mark.parametrize("kind", ["sector", "one of each", "moved"])
def test_curves_are_the_signals(kind: str) -> None:
    result, charts = balanced_case(kind), pictures(kind)
    for role, machine in (("before", result.original), ("after", result.machine)):
        forces = eq.analyze(machine, 360).forces
        for panel, values in enumerate((forces.shaking_force.x, forces.shaking_force.y)):
            mine = curve(charts["force"], role, panel)
            np.testing.assert_allclose(mine[:: len(mine) // 360], values, atol=1e-6)
    ends = {c.role: c.x + 1j * c.y for c in charts["polar"].panels[0].curves}
    np.testing.assert_allclose(ends["after"][:-1].real, curve(charts["force"], "after"))


def test_both_components_of_a_force_have_one_unit() -> None:
    """Of which one is above 10 kN, and the other below."""
    base = eq.load("yamashita-1")
    machine = base.with_number("drive.speed", base.drive.speed * (12e3 / 18.0) ** 0.5)
    force = eq.analyze(machine).forces.shaking_force
    assert np.max(np.abs(force.x)) < 1e4 < np.max(np.abs(force.y))
    panels = spectrum(eq.analyze(machine)).panels
    assert [panel.y.unit_name for panel in panels][:2] == ["kN", "kN"]
    moved = Objective("shaking_force", "rms")
    free = AddedMass("crank", "A", Weight("any", radius=0.05))
    plan = Balance(objectives=(moved,), masses=(free,))
    drawn = view.balance_charts(eq.balance(machine, plan))["force"]
    assert {panel.y.unit_name for panel in drawn.panels} == {"kN"}


def test_a_small_polar_is_a_dot_with_its_magnitude() -> None:
    """Of a machine that is balanced but for 1 % of its force, and wholly."""
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 90, endpoint=False))
    for part, text in ((0.01, "after: at most 1 N"), (0.0, "after: 0 N")):
        both = {"before": 100 * turn, "after": 100 * part * turn}
        parts = {"x": np.real, "y": np.imag}
        force = {axis: {k: of(v) for k, v in both.items()} for axis, of in parts.items()}
        chart = view.polar(balanced_case("sector"), np.angle(turn) % (2 * np.pi), force)
        (dot,) = (mark for mark in chart.panels[0].marks if mark.role == "after")
        assert dot.text == text and abs(dot.x + 1j * dot.y) < 1e-9


def test_what_did_not_change_is_reported_once() -> None:
    values = np.sin(np.linspace(0, 6, 90))
    assert list(view.roles_of({"before": values, "after": values * (1 + 1e-9)})) == ["unchanged"]
    assert list(view.roles_of({"before": values, "after": values / 2})) == ["before", "after"]
    assert view.keys({"after": values}) == (("after", "after"),)


def test_rounding_is_nothing() -> None:
    before = np.array([1.0, -2.0])
    assert not np.any(view.paired(before, 1e-10 * before, 1e-12)["after"])
    assert not np.any(view.paired(before, before, 3.0)["before"])
    assert np.any(view.paired(before, 0.1 * before, 1e-12)["after"])


def test_bars_are_the_orders() -> None:
    result = balanced_case("sector")
    panel = pictures("sector")["aims"].panels[1]
    for bars, machine in zip(panel.bars, (result.original, result.machine), strict=True):
        force = eq.analyze(machine, 360).forces.shaking_force.y
        sizes = np.abs(np.fft.rfft(force)) / 180
        np.testing.assert_allclose(bars.size[1:], sizes[1 : len(bars.size)], atol=1e-9)


@pytest.mark.parametrize("factor", [1.0, 123.0, 12345.0])
def test_numbers_at_bars_keep_apart(factor: float) -> None:
    sizes = factor * np.array([0.0, 1.0, 0.99, 0.98, 0.5, 0.02])
    read = {role: (np.arange(6.0), sizes) for role in ("bar before", "bar after")}
    panel = order_panel("", "force", read, 5)
    assert all(bars.labelled for bars in panel.bars)
    sheet = lay_out(Chart("", "", "", (panel,)))
    numbers = [w for w in sheet.words if w.color in ("#0060a8", "#595959") and w.text[:1].isdigit()]
    assert numbers


@pytest.mark.parametrize(
    ("factor", "free", "crowded"),
    [
        (0.1, "0.311 0.222 0.124 0.061", "0.31 0.22 0.12 0.06"),
        (1.0, "3.11 2.22 1.24 0.61", "3.1 2.2 1.2 0.6"),
        (10.0, "31.1 22.2 12.4 6.1", "31.1 22.2 12.4 6.1"),
        (100.0, "311 222 124 61", "311 222 124 61"),
    ],
)
def test_crowded_bars_have_fewer_decimals_that_still_report_them_apart(
    factor: float, free: str, crowded: str
) -> None:
    for times, expected in ((1, free), (3, crowded)):
        sizes = factor * np.tile([0.0, 3.11, 2.22, 1.24, 0.61], times)
        read = {role: (np.arange(float(len(sizes))), sizes) for role in ("bar before", "bar after")}
        panel = order_panel("", "force", read, len(sizes) - 1, most_with_numbers=len(sizes))
        words = lay_out(Chart("", "", "", (panel,))).words
        numbers = {w.text for w in words if w.color in ("#0060a8", "#595959")}
        assert numbers == {*expected.split()}


def test_aims_are_drawn_as_they_are_asked() -> None:
    """A vector by its size, a joint, and two orders of a moment."""
    result, chart = balanced_case("one of each"), pictures("one of each")["aims"]
    force, joint, moment = chart.panels[::2]
    for role, machine in (("before", result.original), ("after", result.machine)):
        forces = eq.analyze(machine, 720).forces
        for panel, size in ((force, forces.shaking_force.size), (joint, forces.joints["B"].size)):
            mine = next(curve for curve in panel.curves if curve.role == role)
            np.testing.assert_allclose(mine.y[:-1], size, atol=1e-6)
        drawn = next(curve for curve in moment.curves if curve.role == role)
        kept = np.fft.rfft(forces.shaking_moment)
        kept[[0, *range(3, len(kept))]] = 0.0
        np.testing.assert_allclose(drawn.y[:-1], np.fft.irfft(kept), atol=1e-6)
    assert "both components together" in words(chart).replace("\n", " ")


def test_aims_of_rows_are_of_all_of_them() -> None:
    rows = in_rows()
    (aim,) = aims_of(rows)
    first = eq.analyze(replace(rows.original, rows=()), 720).forces.shaking_force.size
    np.testing.assert_allclose(aim.pair["before"], 4 * first, atol=1e-6)


@cache
def rig() -> Balanced:
    return eq.balance(eq.load("balance-rig"))


# Gauges over speed: tests/unit/figures/test_vibration_charts.py.
@pytest.mark.exhaustive
def test_a_gauge_is_drawn_at_each_speed_at_which_it_is_read() -> None:
    """Against the steady state of both machines, and with the joint whose force is limited."""
    result = rig()
    chart = view.balance_charts(result)["aims"]
    (aim,), (limit,) = result.plan.objectives, result.plan.limits
    for k, speed in enumerate(aim.speeds):
        panel, orders = chart.panels[2 * k : 2 * k + 2]
        texts = []
        for role, machine in (("before", result.original), ("after", result.machine)):
            read = respond(machine, speed).gauges["gauge"].displacement
            values = next(curve for curve in panel.curves if curve.role == role).y
            texts.append(1000 * read.peak_to_peak)
            assert 1000 * np.ptp(values) == pytest.approx(texts[-1], rel=1e-4)
            (bars,) = (bars for bars in orders.bars if bars.role == f"bar {role}")
            np.testing.assert_allclose(bars.size[1:], read.sizes[1 : len(bars.size)], rtol=1e-6)
        whole = orders.title.replace("\N{NO-BREAK SPACE}", " ")
        assert whole == f"peak to peak: {texts[0]:.4g} → {texts[1]:.4g} mm"
        assert panel.title == f"reading at gauge, at {speed * 30 / np.pi:.4g} rpm"
    joint = chart.panels[6]
    assert joint.title.startswith("force in joint A")
    assert [line.at for line in joint.lines] == [result.prices[limit.name].at_most]


def test_what_did_not_change_is_left_out() -> None:
    """A weight about the crank's pivot leaves the moment about it; one that moves all, nothing."""
    assert list(view.balance_charts(rig())) == ["aims", "force", "polar", "torque", "changes"]
    result = balanced_case("sector")
    same = replace(result, machine=result.original)
    assert list(view.balance_charts(same)) == ["changes"]
    assert "Shaking moment about A, before and after" in words(pictures("moved")["moment"])


def test_hands_are_the_cranks() -> None:
    result = in_rows(3, True)
    chart = view.phases(result.original, result.machine)
    order = sorted(range(3), key=lambda k: result.machine.rows[k].lateral)
    for panel, k in zip(chart.panels, order, strict=True):
        heads = [arrow.head for arrow in panel.arrows]
        rows = (result.original.rows[k], result.machine.rows[k])
        np.testing.assert_allclose(heads, [np.exp(1j * row.phase) for row in rows])
        assert f"{1000 * result.machine.rows[k].lateral:.4g} mm" in panel.x.label
    alone = pictures("phases")
    assert all(len(panel.arrows) == 1 for panel in alone["phases"].panels)
    assert "before" not in words(alone["rows"])
    assert len(pictures("rows, many")["phases"].panels) == 14
    assert "of one row" in words(pictures("rows, both")["force"])


def test_rows_together_are_the_sum() -> None:
    machine = phasing().machine
    angles, total = view.summed(machine, "x")
    first = eq.analyze(replace(machine, rows=machine.rows[:1]), 720).forces.shaking_force.x
    shifted = [
        np.interp((angles + row.phase) % (2 * np.pi), angles, first, period=2 * np.pi)
        for row in machine.rows
    ]
    np.testing.assert_allclose(total, sum(shifted), atol=1e-6 * np.max(np.abs(first)))


def test_the_front_goes_through_its_points() -> None:
    (panel,) = pictures("front")["front"].panels
    (curve,) = panel.curves
    np.testing.assert_array_equal(np.column_stack([curve.x, curve.y]), front().values)
    reported = words(pictures("front")["front"])
    assert "as it is" in reported
    far = replace(front(), values=1e-6 * front().values)
    assert "as it is, far off" in words(view.front(far))
