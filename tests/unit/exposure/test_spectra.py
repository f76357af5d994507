"""Records, spectra, bands and orders, weighted; and the value that comes of it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.exposure.spectra import (
    FADE,
    fade,
    signal,
    uneven,
    weigh_orders,
    weigh_signal,
    weigh_spectrum,
)
from equipoise.exposure.weighting import MIDDLES, NOMINAL, factor
from support.refusals import refused

RATE = 5000.0
TIME = np.arange(int(9 * RATE)) / RATE
SINE = np.sin(2 * np.pi * 80.0 * TIME)


def test_mean_squares_of_a_periodic_record_are_parsevals() -> None:
    rng = np.random.default_rng(1)
    for count in (1000, 1001):
        noise = rng.normal(size=(2, count)) + 3.0
        frequency, squares = signal(TIME[:count], noise, periodic=True).mean_squares()
        np.testing.assert_allclose(np.sum(squares, axis=1), np.var(noise, axis=1), rtol=1e-12)
        assert frequency[0] == pytest.approx(RATE / count)
        assert frequency[-1] <= RATE / 2 * (1 + 1e-12)


def test_mean_squares_of_noise_are_kept_by_the_fade() -> None:
    """As many samples count as the fade leaves; within four standard deviations."""
    noise = np.random.default_rng(2).normal(size=len(TIME))
    _, squares = signal(TIME, noise).mean_squares()
    assert np.sum(squares) == pytest.approx(1.0, abs=4 * np.sqrt(2 / len(TIME)))


def test_the_fade() -> None:
    share = fade(len(TIME), RATE)
    np.testing.assert_allclose(share, share[::-1])
    inside = np.abs(TIME - TIME[-1] / 2) < TIME[-1] / 2 - FADE
    assert np.all(share[inside] == 1) and share[0] < 1e-6
    assert np.all(fade(3, 1.0) == 1)


def test_the_mean_does_not_count() -> None:
    plain, raised = (weigh_signal(TIME, SINE + mean) for mean in (0.0, 9.80665))
    np.testing.assert_allclose(raised.a_hw, plain.a_hw, rtol=1e-9)
    np.testing.assert_allclose(raised.a_h, plain.a_h, rtol=1e-9)


def test_one_period_of_a_steady_vibration_is_enough_where_it_is_said() -> None:
    weighted = weigh_signal(TIME[:125], SINE[:125], periodic=True)  # two periods
    assert weighted.a_h == pytest.approx([np.sqrt(0.5)], rel=1e-12)
    assert not [note for note in weighted.notes if "close" in note or "above half" in note]


def test_times_rounded_in_a_file_are_equal_steps() -> None:
    assert uneven(TIME) is None
    assert uneven(np.round(TIME + 7.3, 4)) is None
    assert uneven(np.round(np.arange(1000) / 44100, 6)) is None


@pytest.mark.parametrize("lost", [1, 500, 998])
def test_a_lost_sample_is_found(lost: int) -> None:
    time = np.delete(TIME[:1000], lost)
    at = uneven(time)
    assert at is not None
    with refused(UsageError, place="time"):
        signal(time, SINE[:999])


def notes(time: Any, values: Any, **more: Any) -> str:
    return " ".join(weigh_signal(time, values, **more).notes)


def test_notes() -> None:
    short = TIME[TIME < 3]
    assert "takes 3 s; ISO 5349-2 calls less than 8 s hardly" in notes(short, SINE[: len(short)])
    slow = np.arange(30000) / 3000.0
    reported = notes(slow, np.sin(500 * slow))
    assert "ends at 1500 Hz" in reported and "takes 3991 Hz" in reported
    drift = SINE + 200 * np.sin(2 * np.pi * 0.3 * TIME)
    assert "% of the weighted mean square lies below 5.6 Hz; look for drift" in notes(TIME, drift)
    assert notes(TIME, np.vstack([SINE] * 3)) == ""


def test_notes_on_periodic_records() -> None:
    coarse = np.arange(100) / 1000.0
    sine = np.sin(2 * np.pi * 50 * coarse)
    reported = notes(coarse, sine, periodic=True)
    assert "nothing above half its sampling rate, 500 Hz" in reported and "close" not in reported
    saw = np.arange(100.0)
    assert "the record does not close" in notes(coarse, saw, periodic=True)


RECORDS: dict[str, tuple[Any, Any, dict[str, Any], dict[str, Any]]] = {
    "slow": (TIME[::4], SINE[::4], {}, {"rate": 1250.0, "least_rate": 2825.0}),
    "short": (TIME[:4000], SINE[:4000], {}, {"duration": 0.8, "least_duration": 1.0}),
    "one": ([0.0], [1.0], {}, {"place": "time", "by": "signal"}),
    "none": ([], [], {}, {"place": "time", "shape": "(0,)"}),
    "falling": (TIME[::-1], SINE, {}, {"place": "time", "by": "rising"}),
    "lengths": (TIME, SINE[:-1], {}, {"place": "acceleration", "count": 45000}),
    "four axes": (TIME, np.zeros((4, len(TIME))), {}, {"place": "acceleration", "count": 45000}),
    "nan": (
        TIME,
        np.where(TIME == 1, np.nan, SINE),
        {},
        {"place": "acceleration", "by": "_numbers"},
    ),
    "text": (TIME, "loud", {}, {"place": "acceleration", "kind": "str"}),
    "three axes": (TIME, np.zeros((3, len(TIME))), {"single_axis": True}, {"place": "single_axis"}),
    "names": (TIME, SINE, {"axes": ("x", "y")}, {"place": "axes", "names": "x, y", "count": 1}),
    "repeated": (
        TIME[:126],
        SINE[:126],
        {"periodic": True},
        {"by": "signal"},
    ),
}


@pytest.mark.parametrize(("time", "values", "more", "expected"), RECORDS.values(), ids=RECORDS)
def test_records_that_are_refused(
    time: Any, values: Any, more: dict[str, Any], expected: dict[str, Any]
) -> None:
    with refused(UsageError, **expected):
        weigh_signal(time, values, **more)


# -- spectra and orders ----------------------------------------------------------------------------


def test_lines_count_with_their_factors() -> None:
    lines, rms = np.array([0.0, 10.0, 80.0]), np.array([9.0, 3.0, 4.0])
    weighted = weigh_spectrum(lines, rms)
    assert weighted.a_hw == pytest.approx(np.hypot(3 * factor(10.0), 4 * factor(80.0)))
    assert weighted.a_h == pytest.approx(5.0)  # without the mean
    assert weighted.a_hv == weighted.a_hw[0]
    assert (weighted.kind, weighted.axes, weighted.duration) == ("spectrum", ("x",), None)


def test_bands_count_with_the_factors_of_exact_middles() -> None:
    rms = np.linspace(1, 3, 24)
    nominal, exact = (weigh_spectrum(at, rms, bands=True) for at in (NOMINAL, MIDDLES))
    np.testing.assert_array_equal(nominal.a_hw, exact.a_hw)
    assert nominal.a_hw == pytest.approx(np.sqrt(np.sum((rms * factor(MIDDLES)) ** 2)))
    np.testing.assert_allclose(nominal.band_a_h, [rms])
    assert nominal.kind == "bands"


def test_orders_are_lines_at_multiples_of_the_speed() -> None:
    speed, orders = 700.0, np.array([0.0, 0.5, 1.0, 3.0])
    peaks = np.array([[5.0, 1.0, 2.0, 4.0], [1.0, 1.0, 0.0, 2.0]])
    result = weigh_orders(speed, orders, peaks)
    lines = weigh_spectrum(speed * orders / (2 * np.pi), peaks / np.sqrt(2))
    np.testing.assert_allclose(result.a_hw, lines.a_hw)
    turned = weigh_orders(-speed, orders, peaks * np.exp(1j * orders))
    np.testing.assert_allclose(turned.a_hw, result.a_hw)


def test_the_total_value_of_three_axes_and_of_one() -> None:
    rms = np.array([[1.0], [2.0], [3.0]])
    whole = weigh_spectrum([12.5], rms)
    assert whole.a_hv == pytest.approx(np.sqrt(14) * factor(12.5))
    assert whole.notes == () and whole.dominant_axis == "z"
    some = weigh_spectrum([12.5], rms[1:], axes=("y", "z"))
    assert some.a_hv == pytest.approx(np.sqrt(13) * factor(12.5))
    assert "that of two axes and may be too low" in some.notes[0]
    single = weigh_spectrum([12.5], rms[1:], axes=("y", "z"), single_axis=True)
    assert single.a_hv == pytest.approx(1.7 * 3 * factor(12.5))
    assert "estimated as 1.7 times the largest axis" in single.notes[0]


def test_values_that_are_weighted_already() -> None:
    weighted = weigh_spectrum([10.0, 100.0], [[3.0, 4.0]], weighted=True)
    assert weighted.a_hw == pytest.approx(5.0)
    assert weighted.a_h is None and weighted.band_a_h is None
    assert weighted.to_dict()["bands"]["a_h"] is None
    time = np.arange(30_000) / 5000.0
    signal = weigh_signal(time, 2 * np.sin(2 * np.pi * 100 * time), weighted=True)
    assert signal.a_hw == pytest.approx(np.sqrt(2), rel=1e-6)


def test_the_dominant_band() -> None:
    weighted = weigh_spectrum([12.5, 400.0], [[1.0, 10.0]])
    assert weighted.dominant_band == 12.5
    share = factor(12.5) ** 2 / (factor(12.5) ** 2 + 100 * factor(400.0) ** 2)
    assert weighted.dominant_share == pytest.approx(float(share))
    nothing = weigh_spectrum([12.5], [[0.0]])
    assert (nothing.dominant_band, nothing.dominant_share, nothing.a_hv) == (None, 0.0, 0.0)


def test_bands_of_a_signal_hold_all_of_it() -> None:
    """Noise between 20 and 800 Hz: the bands add up to the whole, weighted and not."""
    rng = np.random.default_rng(3)
    time = np.arange(5000) / 5000.0
    waves = np.arange(20, 800)
    angles = 2 * np.pi * waves[:, None] * time + rng.uniform(0, 6, (len(waves), 1))
    weighted = weigh_signal(time, np.sum(np.sin(angles), axis=0), periodic=True)
    assert np.sum(weighted.band_a_hw**2) == pytest.approx(weighted.a_hw[0] ** 2, rel=1e-12)
    assert weighted.band_a_h is not None and weighted.a_h is not None
    assert np.sum(weighted.band_a_h**2) == pytest.approx(weighted.a_h[0] ** 2, rel=1e-12)


def test_plain_data() -> None:
    content = weigh_spectrum(NOMINAL, np.ones((3, 24)), bands=True).to_dict()
    assert json.loads(json.dumps(content, allow_nan=False)) == content
    assert content["bands"]["frequency"] == list(NOMINAL)
    assert len(content["a_hw"]) == len(content["bands"]["a_hw"]) == 3


def test_notes_on_bands() -> None:
    assert "say so (bands)" in weigh_spectrum(NOMINAL[:6], np.ones((3, 6))).notes[0]
    assert "6 of 24 bands" in weigh_spectrum(NOMINAL[:6], np.ones((3, 6)), bands=True).notes[0]


REFUSED: dict[str, tuple[Any, Any, dict[str, Any], dict[str, Any]]] = {
    "negative": ([10.0], [-1.0], {}, {"place": "acceleration", "min": -1.0}),
    "frequency": ([-1.0, 10.0], [1.0, 1.0], {}, {"place": "frequency", "lines": -1.0}),
    "twice": ([10.0, 10.0], [1.0, 1.0], {}, {"place": "frequency", "by": "rising"}),
    "band": ([11.0], [1.0], {"bands": True}, {"place": "frequency", "given": 11.0}),
    "infinite": ([10.0], [np.inf], {}, {"place": "acceleration", "by": "_numbers"}),
    "huge": ([10.0], [1e40], {}, {"place": "acceleration", "by": "_numbers"}),
    "ragged": ([10.0, 20.0], [[1.0, 2.0], [1.0]], {}, {"place": "acceleration", "kind": "list"}),
}


@pytest.mark.parametrize(("lines", "rms", "more", "expected"), REFUSED.values(), ids=REFUSED)
def test_spectra_that_are_refused(
    lines: Any, rms: Any, more: dict[str, Any], expected: dict[str, Any]
) -> None:
    with refused(UsageError, **expected):
        weigh_spectrum(lines, rms, **more)


@pytest.mark.parametrize(
    ("speed", "orders", "peaks", "expected"),
    [
        (0.0, [1.0], [1.0], {"turning": 0.0, "counts": 1.0}),
        (9.0, [-1.0], [1.0], {"turning": 9.0, "counts": -1.0}),
        (9.0, [1.0], ["loud"], {"place": "amplitude"}),
        (9.0, [2.0, 1.0], [1.0, 1.0], {"place": "orders"}),
        (np.nan, [1.0], [1.0], {"place": "speed"}),
    ],
)
def test_orders_that_are_refused(
    speed: Any, orders: Any, peaks: Any, expected: dict[str, Any]
) -> None:
    with refused(UsageError, **expected):
        weigh_orders(speed, orders, peaks)
