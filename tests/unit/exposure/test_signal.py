"""Records of acceleration against time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.exposure.spectra import FADE, fade, signal, uneven, weigh_signal

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
    found = weigh_signal(TIME[:125], SINE[:125], periodic=True)  # two periods
    assert found.a_h == pytest.approx([np.sqrt(0.5)], rel=1e-12)
    assert not [note for note in found.notes if "close" in note or "above half" in note]


def test_times_rounded_in_a_file_are_equal_steps() -> None:
    assert uneven(TIME) is None
    assert uneven(np.round(TIME + 7.3, 4)) is None
    assert uneven(np.round(np.arange(1000) / 44100, 6)) is None


@pytest.mark.parametrize("lost", [1, 500, 998])
def test_a_lost_sample_is_found(lost: int) -> None:
    time = np.delete(TIME[:1000], lost)
    at = uneven(time)
    assert at is not None
    with pytest.raises(UsageError, match=f"time: sample {at + 1}, at .* s, is not where equal"):
        signal(time, SINE[:999])


def notes(time: Any, values: Any, **more: Any) -> str:
    return " ".join(weigh_signal(time, values, **more).notes)


def test_notes() -> None:
    short = TIME[TIME < 3]
    assert "takes 3 s; ISO 5349-2 calls less than 8 s hardly" in notes(short, SINE[: len(short)])
    slow = np.arange(30000) / 3000.0
    told = notes(slow, np.sin(500 * slow))
    assert "ends at 1500 Hz" in told and "takes 3991 Hz" in told
    drift = SINE + 200 * np.sin(2 * np.pi * 0.3 * TIME)
    assert "% of the weighted mean square lies below 5.6 Hz; look for drift" in notes(TIME, drift)
    assert notes(TIME, np.vstack([SINE] * 3)) == ""


def test_notes_on_periodic_records() -> None:
    coarse = np.arange(100) / 1000.0
    sine = np.sin(2 * np.pi * 50 * coarse)
    told = notes(coarse, sine, periodic=True)
    assert "nothing above half its sampling rate, 500 Hz" in told and "close" not in told
    saw = np.arange(100.0)
    assert "the record does not close" in notes(coarse, saw, periodic=True)


REFUSED: dict[str, tuple[Any, Any, dict[str, Any], str]] = {
    "slow": (TIME[::4], SINE[::4], {}, r"sampled at 1250 Hz; give at least 2825 Hz, as the bands"),
    "short": (TIME[:4000], SINE[:4000], {}, r"the record takes 0.8 s; give at least 1 s"),
    "one": ([0.0], [1.0], {}, "time: got one sample"),
    "none": ([], [], {}, r"time: got the shape \(0,\); give a row of numbers in s"),
    "falling": (TIME[::-1], SINE, {}, "time: the values must rise"),
    "lengths": (TIME, SINE[:-1], {}, r"give one to three axes of 45000 values"),
    "four axes": (TIME, np.zeros((4, len(TIME))), {}, "give one to three axes of 45000 values"),
    "nan": (TIME, np.where(TIME == 1, np.nan, SINE), {}, "acceleration: a value is not finite"),
    "text": (TIME, "loud", {}, "acceleration: got str; give rows of numbers"),
    "three axes": (TIME, np.zeros((3, len(TIME))), {"single_axis": True}, "got three axes, whose"),
    "names": (TIME, SINE, {"axes": ("x", "y")}, "axes: got x, y; give a name to each of 1 axes"),
    "repeated": (
        TIME[:126],
        SINE[:126],
        {"periodic": True},
        "the last sample repeats the first",
    ),
}


@pytest.mark.parametrize(("time", "values", "more", "said"), REFUSED.values(), ids=REFUSED)
def test_refused(time: Any, values: Any, more: dict[str, Any], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        weigh_signal(time, values, **more)
