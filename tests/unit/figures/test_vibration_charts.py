"""Charts of vibration: they hold what was found at one speed, over speeds and from rest."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures import pictures_of
from equipoise.figures.chart_parts import bounded, ordered
from equipoise.figures.layout import lay_out
from equipoise.figures.style import LOOKS, look_of
from equipoise.figures.time_charts import transient_charts
from equipoise.figures.vibration import fraction, meeting, merged, response_charts, sweep_charts
from equipoise.results.charts import Chart, Curve
from equipoise.vibration.forced import Sweep, respond, sweep_speed
from equipoise.vibration.free import simulate
from equipoise.vibration.linear import Resonance
from support.chosen import few
from support.refusals import refused
from unit.figures.checks import views
from unit.figures.samples import words
from unit.figures.vibration_samples import (
    RPM,
    dashed_and_lost,
    exact,
    linkage,
    pictures,
    plane,
    rig,
)


@cache
def swept() -> Sweep:
    return sweep_speed(rig(), 3, 60, speeds=16)


def curve_of(chart: Chart, panel: int = 0, dashed: bool = False) -> Curve:
    return next(c for c in chart.panels[panel].curves if c.dashed == dashed)


def test_names() -> None:
    assert list(response_charts(respond(plane()))) == [
        *("gauge-handle", "gauge-seat", "gauge-tilt", "spectrum", "mounts", "drive")
    ]
    assert list(sweep_charts(swept())) == [
        *("response", "resonance-map", "mounts", "velocity", "acceleration")
    ]
    assert {"spectrum-2", "mounts-2"} <= pictures("crowded").keys()
    machine = replace(eq.load("walking-transplanter"), support=None)
    assert list(response_charts(respond(machine, drive=True))) == ["drive"]
    assert list(transient_charts(simulate(machine, 0.3, drive=True, samples=40))) == ["speed"]
    with refused(eq.EquipoiseError, kind="int"):
        pictures_of(3)


# What gauges read: `test_curves_are_what_gauges_read`.
@pytest.mark.exhaustive
def test_gauges_read_what_balancing_reports() -> None:
    response = respond(plane())
    for name, gauge in response.gauges.items():
        panels = pictures("plane")[f"gauge-{name}"].panels
        read = (gauge.displacement, gauge.velocity, gauge.acceleration)
        for panel, signal in zip(panels, read, strict=True):
            (curve,) = panel.curves
            size = np.max(np.abs(curve.y))
            np.testing.assert_allclose(curve.y, signal.values(curve.x), atol=1e-9 * size)
    assert pictures("plane")["gauge-tilt"].panels[0].y.text == "rotation, mrad"
    assert pictures("plane")["gauge-seat"].panels[1].y.text == "velocity, mm/s"
    assert "time runs from right to left" in words(pictures("clockwise")["drive"])
    assert pictures("long cycle")["drive"].panels[0].x.high == pytest.approx(6 * np.pi)


def test_bars_are_the_orders() -> None:
    response = respond(plane())
    for panel, (name, gauge) in zip(
        pictures("plane")["spectrum"].panels, response.gauges.items(), strict=True
    ):
        (bars,) = panel.bars
        orders = np.rint(bars.at * gauge.displacement.turns).astype(int)
        np.testing.assert_allclose(bars.size, gauge.displacement.sizes[orders])
        assert panel.title == name


def test_mounts_and_what_they_carry_at_rest() -> None:
    response = respond(plane())
    panels = pictures("plane")["mounts"].panels
    for panel, mount in zip(panels, response.mounts.values(), strict=True):
        force, rest = panel.curves
        np.testing.assert_allclose(force.y, mount.force.values(force.x), atol=1e-9)
        assert rest.y[0] == rest.y[1]


# What mounts carry: `test_mounts_and_what_they_carry_at_rest`.
@pytest.mark.exhaustive
def test_lift_off_is_shaded() -> None:
    response = respond(eq.load("walking-transplanter"), model="exact")
    share = response.mounts["float"].lifts_off
    assert share > 0.1
    chart = response_charts(response)["mounts"]
    spans = [band.high - band.low for band in chart.panels[0].bands]
    assert sum(spans) / (2 * np.pi) == pytest.approx(share, abs=0.01)
    assert f"off its ground for {100 * share:.0f} %" in words(chart)
    assert np.min(chart.panels[0].curves[0].y) == 0
    linear = response_charts(respond(eq.load("walking-transplanter")))["mounts"]
    assert "would have to pull for" in words(linear)
    assert "off its ground" not in words(pictures("plane")["mounts"])
    mounts = dict(plane().support.mounts)  # type: ignore[union-attr]
    mounts["float"] = replace(mounts["float"], preload=0.0)
    assert "does not touch" in words(response_charts(respond(plane(mounts=mounts)))["mounts"])


# Curves of a response over the crank angle: the tests above.
@pytest.mark.exhaustive
def test_drive_torque_and_crank_speed() -> None:
    response = exact("walking-transplanter")
    chart = pictures("walking-transplanter")["exact drive"]
    torque, speed = chart.panels
    assert (torque.y.text, speed.y.text) == ("drive torque, N m", "crank speed, rpm")
    assert response.drive.speed is not None
    (curve,) = speed.curves
    np.testing.assert_allclose(curve.y, response.drive.speed.values(curve.x), rtol=1e-9)
    assert f"varies by {100 * response.drive.fluctuation:.4g} %" in words(chart)
    assert "mean 200" in words(chart) and "time, in degrees" in words(chart)
    assert len(pictures("rig")["drive"].panels) == 1


# Curves against the crank angle: the other tests of this file.
@pytest.mark.exhaustive
def test_from_rest_against_time() -> None:
    machine = eq.load("walking-transplanter")
    transient = simulate(machine, 0.5, drive=True, samples=300)
    drawn = pictures("walking-transplanter")
    panels = drawn["rest gauges"].panels
    for panel, (name, read) in zip(panels, transient.gauges.items(), strict=True):
        np.testing.assert_allclose(panel.curves[0].x, transient.time)
        np.testing.assert_allclose(panel.curves[0].y, read, rtol=1e-12)
        assert panel.title.startswith(name)
    assert panels[1].y.text == "turned, mrad"
    speed = drawn["rest speed"].panels[0].curves[0].y
    np.testing.assert_allclose(speed, transient.crank_speed)
    assert "rest speed" not in pictures("plane")
    bare = simulate(plane(linkage(), gauges={}), 0.2, samples=30)
    labels = [panel.y.label for panel in transient_charts(bare)["gauges"].panels]
    assert labels == ["moved", "moved", "turned"]


# -- a range of speeds -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("picture", "key", "label"),
    [
        ("response", "peak_to_peak", "peak to peak, mm"),
        ("velocity", "velocity_rms", "RMS, mm/s"),
        ("acceleration", "acceleration_rms", "RMS, m/s²"),
    ],
)
def test_curves_are_what_gauges_read(picture: str, key: str, label: str) -> None:
    panel = pictures("rig")[f"sweep {picture}"].panels[0]
    assert panel.y.scale == "log" and panel.y.text == label
    np.testing.assert_allclose(panel.curves[0].x, swept().speed)
    np.testing.assert_allclose(panel.curves[0].y, getattr(swept().gauges["tip"], key))


def test_the_peak_is_at_the_resonance_and_reported() -> None:
    sweep = swept()
    curve = curve_of(pictures("rig")["sweep response"])
    loudest = max(sweep.resonances, key=lambda r: r.share)
    speed, value = sweep.peaks["tip"][0]
    assert curve.x[np.argmax(curve.y)] == pytest.approx(loudest.speed, rel=1e-3)
    assert f"{1e3 * value:.4g} at {speed * RPM:.4g} rpm" in words(pictures("rig")["sweep response"])


@pytest.mark.parametrize("name", ["riding-transplanter", "exudyn-slider-crank"])
def test_names_in_modes_stand_at_their_signs(name: str) -> None:
    """Each once in all views, one beside the other, though mounts and gauges share a place."""
    machine = eq.load(name)
    assert machine.support is not None
    wanted = sorted([*machine.support.gauges, *machine.support.mounts])
    for chart in pictures_of(eq.vibration.modes(machine)).values():
        texts = [mark.text for panel in chart.panels for mark in panel.marks]
        assert sorted(texts) == wanted
        actual = [text for text in lay_out(chart).words if text.text in wanted]
        assert sorted(text.text for text in actual) == wanted
        ends = {(mark.x, mark.y, mark.off) for panel in chart.panels for mark in panel.marks}
        assert len({(x, y) for x, y, _ in ends}) < len(ends)


def test_views_of_modes_have_one_scale_and_no_more_height_than_they_need() -> None:
    chart = pictures_of(eq.vibration.modes(eq.load("riding-transplanter")))["mode-1"]
    side, rear, top = views(chart)
    assert len({round(v.x.length / (v.x.high - v.x.low), 9) for v in (side, rear, top)}) == 1
    assert (side.y.low, side.y.high) == pytest.approx((rear.y.low, rear.y.high))
    assert side.y.length < 0.7 * side.x.length


def test_resonances_are_marked_and_named() -> None:
    sweep = swept()
    panel = pictures("rig")["sweep response"].panels[0]
    named = sorted(sweep.resonances, key=lambda r: r.speed)
    met = [line.at for line in panel.lines if line.role != "work"]
    assert sorted(met) == pytest.approx([r.speed for r in named])
    assert [flag.texts for flag in panel.flags] == [(fraction(r.order), str(r.mode)) for r in named]
    assert panel.flag_words == ("order", "mode")
    assert fraction(4 / 3) == "4/3" and fraction(2.0) == "2"


def test_speed_of_work_is_marked_with_what_is_read_there() -> None:
    machine = rig()
    peak_to_peak = respond(machine).gauges["tip"].displacement.peak_to_peak
    chart = pictures("rig")["sweep response"]
    line = next(line for line in chart.panels[0].lines if line.role == "work")
    assert line.at == pytest.approx(machine.drive.speed)
    assert line.label == f"work, {machine.drive.speed * RPM:.4g} rpm"
    mark = next(mark for mark in chart.panels[0].marks if mark.x == line.at)
    assert mark.y == pytest.approx(float(peak_to_peak))
    assert f"{1e3 * mark.y:.4g}" in words(chart)


# Bands: `test_quiet_bands_are_paler`.
@pytest.mark.exhaustive
@pytest.mark.parametrize("sense", few([1, -1], {-1}))
def test_bands_to_keep_away_from(sense: int) -> None:
    sweep = sweep_speed(plane(), sense * 3, sense * 60, speeds=6)
    panel = sweep_charts(sweep)["response"].panels[0]
    for resonance in sweep.resonances:
        if resonance.avoid is not None:
            low, high = sorted(abs(end) for end in resonance.avoid)
            assert any(b.low <= low + 1e-9 and high - 1e-9 <= b.high for b in panel.bands)
    assert (panel.x.low, panel.x.high) == pytest.approx((3, 60))
    assert ("(clockwise)" in panel.x.text) == (sense < 0)
    assert np.all(np.diff(panel.curves[0].x) > 0)
    assert merged([(3, 4), (0, 1), (0.5, 2), (3.5, 3.6)]) == [(0, 2), (3, 4)]
    assert merged([]) == []


def test_quiet_bands_are_paler() -> None:
    quiet = Resonance(10.0, 2.0, 1, 20.0, 0.01, (9.0, 11.0))
    loud = replace(quiet, speed=20.0, order=1.0, share=1.0, avoid=(18.0, 22.0))
    bands = sweep_charts(replace(swept(), resonances=(loud, quiet)))["response"].panels[0].bands
    assert {band.low: band.role for band in bands} == {9.0: "quiet band", 18.0: "loud band"}
    assert LOOKS["quiet band"].fill > LOOKS["loud band"].fill


def test_gaps_and_what_is_not_stable() -> None:
    sweep = dashed_and_lost(swept())
    chart = pictures("rig")["lost response"]
    whole, dashed = curve_of(chart).y, curve_of(chart, dashed=True).y
    values = sweep.gauges["tip"].peak_to_peak
    np.testing.assert_array_equal(np.isfinite(whole), np.isfinite(values) & sweep.stable)
    assert np.all(np.isfinite(dashed[10:20])) and np.isfinite(dashed[20])
    assert not np.any(np.isfinite(dashed[np.isnan(values)]))
    assert "not stable" in words(chart)


def test_quieter_curves_are_thin_and_share_a_name() -> None:
    chart = pictures("crowded")["sweep response"]
    assert sum(curve.role == "quieter" for curve in chart.panels[0].curves) == 5
    assert words(chart).count("5 quieter ones") == 1
    names = ordered({str(k): np.array([float(k)]) for k in range(8)})
    assert [name.name for name in names] == ["2", "3", "4", "5", "6", "7", "0", "1"]


def test_a_resonance_without_damping_does_not_squeeze_the_rest() -> None:
    assert list(bounded(np.array([1.0, 2.0, 1e12, np.nan, 3.0]))) == [1, 2, 3]
    assert bounded(np.array([np.nan])).size == 0
    values = swept().gauges["tip"].peak_to_peak.copy()
    values[9] = 1e9
    gauge = replace(swept().gauges["tip"], peak_to_peak=values)
    y = sweep_charts(replace(swept(), gauges={"tip": gauge}))["response"].panels[0].y
    assert y.text == "peak to peak, mm" and y.high is not None and y.high < 1e2
    still = replace(gauge, peak_to_peak=np.zeros(len(swept().speed)))
    assert "nothing moves" in words(
        sweep_charts(replace(swept(), gauges={"tip": still}))["response"]
    )


def test_mounts_hand_on_force() -> None:
    chart = pictures("rig")["sweep mounts"]
    labels = [panel.y.text for panel in chart.panels]
    assert labels == ["peak to peak, N", "peak to peak, N m", "transmissibility"]
    expected = (
        swept().mounts["spring"].peak_to_peak,
        swept().mounts["damper"].peak_to_peak,
        swept().mounts["spring"].transmissibility,
    )
    for number, values in enumerate(expected):
        np.testing.assert_allclose(curve_of(chart, number).y, values)


def test_the_map_shows_where_orders_meet_modes() -> None:
    sweep, chart = swept(), pictures("rig")["sweep resonance-map"]
    panel = chart.panels[0]
    for mark, r in zip(panel.marks, sweep.resonances, strict=True):
        assert mark.y == pytest.approx(2 * np.pi * sweep.modes[r.mode - 1].cycles_per_second)
        assert mark.x * r.order == pytest.approx(mark.y)
    sizes = [look_of(meeting(share)).size for share in (1.0, 0.1, 0.001)]
    assert sizes == sorted(sizes, reverse=True) and sizes[-1] > 2
    assert f"mode 1: {sweep.modes[0].cycles_per_second:.4g} Hz" in words(chart)
    empty = sweep_charts(sweep_speed(rig(), 30, 60, speeds=4))["resonance-map"]
    assert "order 1" in words(empty).split("\n") and "keep away" not in words(empty)


# Names in order: tests/unit/figures/test_balance_charts.py.
@pytest.mark.exhaustive
def test_many_gauges_stand_in_their_order() -> None:
    labels = [c.label for c in pictures("space")["sweep response"].panels[0].curves]
    assert [label for label in labels if label] == ["middle", "left", "right"]
