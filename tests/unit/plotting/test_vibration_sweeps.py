"""Pictures of a range of speeds: curves, resonances, bands and the resonance map."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes

from equipoise.plotting.style import FAINT
from equipoise.plotting.vibration import sweep_drawings
from equipoise.plotting.vibration.curves import (
    KINDS,
    bounded,
    fraction,
    merged,
    ordered,
)
from equipoise.plotting.vibration.map import marker_size
from equipoise.vibration.free import Resonance
from equipoise.vibration.sweep import Sweep, sweep_speed
from unit.figures.samples import words
from unit.figures.vibration_samples import RPM, dashed_and_lost, pictures, plane, rig


@cache
def swept() -> Sweep:
    return sweep_speed(rig(), 3, 60, speeds=16)


def curve_of(axes: Axes, color: str = KINDS[0][0], dashed: bool = False) -> tuple[np.ndarray, ...]:
    """The longest line of a colour."""
    lines = [
        line
        for line in axes.get_lines()
        if line.get_color() == color and (line.get_linestyle() != "-") == dashed
    ]
    line = max(lines, key=lambda found: len(found.get_xdata()))
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


@pytest.mark.parametrize(
    ("picture", "key", "factor", "label"),
    [
        ("response", "peak_to_peak", 1e3, "peak to peak, mm"),
        ("velocity", "velocity_rms", 1e3, "RMS, mm/s"),
        ("acceleration", "acceleration_rms", 1.0, "RMS, m/s²"),
    ],
)
def test_curves_are_what_gauges_read(picture: str, key: str, factor: float, label: str) -> None:
    sweep = swept()
    axes = pictures("rig")[f"sweep {picture}"].axes[0]
    assert axes.get_yscale() == "log" and axes.get_ylabel() == label
    x, y = curve_of(axes)
    np.testing.assert_allclose(x, sweep.speed * RPM)
    np.testing.assert_allclose(y, factor * getattr(sweep.gauges["tip"], key))


def test_the_peak_is_at_the_resonance_and_told() -> None:
    sweep = swept()
    x, y = curve_of(pictures("rig")["sweep response"].axes[0])
    loudest = max(sweep.resonances, key=lambda r: r.share)
    speed, value = sweep.peaks["tip"][0]
    assert x[np.argmax(y)] == pytest.approx(loudest.speed * RPM, rel=1e-3)
    assert f"{1e3 * value:.4g} at {speed * RPM:.4g} rpm" in words(pictures("rig")["sweep response"])


def test_resonances_are_marked_and_named() -> None:
    sweep = swept()
    axes = pictures("rig")["sweep response"].axes[0]
    upright = [line.get_xdata()[0] for line in axes.get_lines() if list(line.get_ydata()) == [0, 1]]
    assert sorted(upright) == pytest.approx(sorted(r.speed * RPM for r in sweep.resonances))
    shown = [text.get_text() for text in axes.texts if "rpm" not in text.get_text()]
    named = sorted(sweep.resonances, key=lambda r: r.speed)
    assert shown[: 2 * len(named) : 2] == [fraction(r.order) for r in named]
    assert shown[1 : 2 * len(named) : 2] == [str(r.mode) for r in named]
    assert {"order", "mode"} <= set(shown)
    assert fraction(4 / 3) == "4/3" and fraction(2.0) == "2"


@pytest.mark.parametrize("sense", [1, -1])
def test_bands_to_keep_away_from(sense: int) -> None:
    sweep = sweep_speed(plane(), sense * 3, sense * 60, speeds=10)
    axes = sweep_drawings(sweep)["response"].axes[0]
    shaded = [(span.get_x(), span.get_x() + span.get_width()) for span in axes.patches]
    for resonance in sweep.resonances:
        if resonance.avoid is not None:
            low, high = sorted(abs(end) * RPM for end in resonance.avoid)
            assert any(a <= low + 1e-6 and high - 1e-6 <= b for a, b in shaded)
    assert axes.get_xlim() == pytest.approx((3 * RPM, 60 * RPM))


def test_clockwise_speeds_rise_to_the_right() -> None:
    figure = pictures("clockwise")["sweep response"]
    assert "crank speed, rpm (clockwise)" in words(figure)
    x, _ = curve_of(figure.axes[0])
    assert np.all(np.diff(x) > 0) and x[0] == pytest.approx(3 * RPM)


def test_spans_are_merged() -> None:
    assert merged([(3, 4), (0, 1), (0.5, 2), (3.5, 3.6)]) == [(0, 2), (3, 4)]
    assert merged([]) == []


def test_gaps_and_what_is_not_stable() -> None:
    sweep = dashed_and_lost(swept())
    figure = pictures("rig")["lost response"]
    x, whole = curve_of(figure.axes[0])
    _, dashed = curve_of(figure.axes[0], dashed=True)
    values = 1e3 * sweep.gauges["tip"].peak_to_peak
    np.testing.assert_array_equal(np.isfinite(whole), np.isfinite(values) & sweep.stable)
    assert np.all(np.isfinite(dashed[10:20])) and np.isfinite(dashed[20])
    assert not np.any(np.isfinite(dashed[np.isnan(values)]))
    assert "not stable" in words(figure)
    alone = [line for line in figure.axes[0].get_lines() if line.get_marker() == "."]
    assert [line.get_xdata()[0] for line in alone] == [x[6]]


def test_quieter_curves_are_thin_and_have_no_name() -> None:
    axes = pictures("crowded")["sweep response"].axes[0]
    thin = [
        line for line in axes.get_lines() if line.get_color() == FAINT and len(line.get_xdata()) > 9
    ]
    assert len(thin) == 5
    curves = ordered({str(k): np.array([float(k)]) for k in range(8)})
    assert [curve.name for curve in curves] == ["2", "3", "4", "5", "6", "7", "0", "1"]


def test_a_resonance_without_damping_does_not_squeeze_the_rest() -> None:
    assert list(bounded(np.array([1.0, 2.0, 1e12, np.nan, 3.0]))) == [1, 2, 3]
    assert bounded(np.array([np.nan])).size == 0
    sweep = swept()
    values = sweep.gauges["tip"].peak_to_peak.copy()
    values[9] = 1e9
    gauge = replace(sweep.gauges["tip"], peak_to_peak=values)
    figure = sweep_drawings(replace(sweep, gauges={"tip": gauge}))["response"]
    assert figure.axes[0].get_ylabel() == "peak to peak, mm"
    assert figure.axes[0].get_ylim()[1] < 1e5


def test_nothing_moves() -> None:
    sweep = swept()
    still = replace(sweep.gauges["tip"], peak_to_peak=np.zeros(len(sweep.speed)))
    figure = sweep_drawings(replace(sweep, gauges={"tip": still}))["response"]
    assert "nothing moves" in words(figure)


def test_mounts_hand_on_force() -> None:
    sweep = swept()
    force, torque, ratio = pictures("rig")["sweep mounts"].axes
    labels = [axes.get_ylabel() for axes in (force, torque, ratio)]
    assert labels == ["peak to peak, N", "peak to peak, N m", "transmissibility"]
    np.testing.assert_allclose(curve_of(force)[1], sweep.mounts["spring"].peak_to_peak)
    np.testing.assert_allclose(curve_of(torque)[1], sweep.mounts["damper"].peak_to_peak)
    np.testing.assert_allclose(curve_of(ratio)[1], sweep.mounts["spring"].transmissibility)


def test_the_map_shows_where_orders_meet_modes() -> None:
    sweep = swept()
    axes = pictures("rig")["sweep resonance-map"].axes[0]
    dots = [line for line in axes.get_lines() if line.get_marker() == "o"]
    assert len(dots) == len(sweep.resonances)
    for dot, r in zip(dots, sweep.resonances, strict=True):
        x, y = dot.get_xdata()[0], dot.get_ydata()[0]
        assert y == pytest.approx(sweep.modes[r.mode - 1].cycles_per_second)
        assert x / 60 * r.order == pytest.approx(y)
        assert dot.get_markersize() == marker_size(r.share)
    assert marker_size(1.0) > marker_size(0.1) > marker_size(0.001) > 2
    level = [line for line in axes.get_lines() if list(line.get_xdata()) == [0, 1]]
    assert level[0].get_ydata()[0] == pytest.approx(sweep.modes[0].cycles_per_second)
    shown = words(pictures("rig")["sweep resonance-map"])
    assert f"mode 1: {sweep.modes[0].cycles_per_second:.4g} Hz" in shown


def test_a_map_without_resonances() -> None:
    sweep = sweep_speed(rig(), 30, 60, speeds=4)
    assert not sweep.resonances
    figure = sweep_drawings(sweep)["resonance-map"]
    assert "order 1" in words(figure).split("\n")
    assert "keep away" not in words(figure)


def test_quiet_bands_are_paler() -> None:
    quiet = Resonance(10.0, 2.0, 1, 20.0, 0.01, (9.0, 11.0))
    loud = replace(quiet, speed=20.0, order=1.0, share=1.0, avoid=(18.0, 22.0))
    sweep = replace(swept(), resonances=(loud, quiet))
    axes = sweep_drawings(sweep)["response"].axes[0]
    fills = {round(span.get_x() / RPM): span.get_facecolor()[0] for span in axes.patches}
    assert fills[9] > fills[18]
