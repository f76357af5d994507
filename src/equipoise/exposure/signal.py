"""A record of acceleration against time, as mean squares at frequencies.

A record is cut out of a vibration that goes on, so its ends are faded in and out over half a second
each, and mean squares are referred to that of the fade.  Then Wh counts exactly at every frequency
up to half the sampling rate.  Taken as it is, the record would jump from its end to its beginning,
and a jump of something strong at 2 kHz, where Wh is 0.003, is heard at 10 Hz, where it is 1.  A
steady sine of any frequency and phase is read to 1 % from one second, and to 0.1 % from eight
(tests/literature/test_iso_8041.py).

A periodic record is whole periods of a steady vibration and closes by itself; it is exact as it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.exposure.weighting import EDGES, of_axes, rising
from equipoise.signals import harmonics

Array = np.ndarray[Any, Any]

LEAST_RATE = 2 * float(EDGES[-1])
"""Hz: below, a record cannot hold the whole band of 1250 Hz."""
WHOLE_RATE = 2 * 10**3.3
"""Hz: below, it ends where ISO 8041-1, Table 4, still has a lower tolerance, at 1995 Hz."""
LEAST_DURATION = 1.0
"""s: both fades; a band of 6.3 Hz is 1.5 Hz wide, so that less could not tell it from its
neighbours."""
SHORT = 8.0
"""s, below which ISO 5349-2, 5.4.1, calls a measurement hardly reliable at low frequencies."""
FADE = 0.5
"""s, at each end."""
UNEVEN = 0.25
"""Steps, by which a time may stand off: rounded in the file.  One lost sample makes it 0.5."""
UNEVEN_STEPS = "is not where equal steps of time would have it; give a record without gaps"
"""What is said of such a time."""
JUMP = 3.0
"""Largest steps of a periodic record that its end may be away from its beginning."""
SAME = 1e-9
"""Of its range, by which a last sample may differ from the first that it repeats."""


@dataclass(frozen=True, eq=False)
class Signal:
    """Acceleration (axes, N), m/s2, at equal steps of time.

    rate : samples a second.
    periodic : whether it is whole periods of a steady vibration.
    """

    acceleration: Array
    rate: float
    periodic: bool

    @property
    def count(self) -> int:
        """Samples of an axis."""
        return len(self.acceleration[0])

    @property
    def duration(self) -> float:
        """s; every sample stands for a step."""
        return self.count / self.rate

    def mean_squares(self) -> tuple[Array, Array]:
        """Frequencies (K,), Hz, without 0, and mean squares (axes, K), (m/s2)^2."""
        share = np.ones(self.count) if self.periodic else fade(self.count, self.rate)
        mean = self.acceleration @ share / np.sum(share)
        faded = share * (self.acceleration - mean[:, np.newaxis])
        squares = np.abs(harmonics(faded)[:, 1:]) ** 2 / (2 * np.mean(share**2))
        if self.count % 2 == 0:  # a cosine that is 1 or -1 at all samples
            squares[:, -1] *= 2
        return self.rate / self.count * np.arange(1, squares.shape[1] + 1), squares

    def notes(self) -> Iterator[str]:
        """What deserves a second look."""
        half = self.rate / 2
        if self.periodic:
            if self.rate < LEAST_RATE:
                yield f"taken to hold nothing above half its sampling rate, {half:.4g} Hz"
            ends = np.abs(self.acceleration[:, 0] - self.acceleration[:, -1])
            steps = np.max(np.abs(np.diff(self.acceleration)), axis=1)
            if np.any(ends > JUMP * steps):
                yield "the record does not close as one of whole periods does"
            return
        if self.rate < WHOLE_RATE:
            yield (
                f"the record ends at {half:.0f} Hz, half its sampling rate; ISO 8041-1 asks for a "
                f"response up to 1995 Hz, which takes {WHOLE_RATE:.0f} Hz"
            )
        if self.duration < SHORT:
            yield (
                f"the record takes {self.duration:.3g} s; ISO 5349-2 calls less than 8 s hardly "
                "reliable at low frequencies, and asks for a minute in several records"
            )


def fade(count: int, rate: float) -> Array:
    """Share (count,) by which samples count: sines squared at both ends, 1 between them."""
    from_end = (np.minimum(np.arange(count), np.arange(count)[::-1]) + 0.5) / rate
    share: Array = np.sin(np.pi / 2 * np.minimum(from_end / FADE, 1.0)) ** 2
    return share


def signal(time: Any, acceleration: Any, periodic: bool = False) -> Signal:
    """A record, checked; see `weigh_signal`.

    Raises
    ------
    UsageError : steps of time differ, or the record is too short or sampled too slowly.
    """
    times = rising("time", time, "s")
    values = of_axes("acceleration", acceleration, len(times))
    if len(times) < 2:
        raise UsageError("time: got one sample; give a record of acceleration against time")
    at = uneven(times)
    if at is not None:
        raise UsageError(f"time: sample {at + 1}, at {times[at]:.6g} s, {UNEVEN_STEPS}")
    found = Signal(values, (len(times) - 1) / float(times[-1] - times[0]), periodic)
    if periodic:
        _check_end(values)
        return found
    if found.rate < LEAST_RATE:
        raise UsageError(
            f"sampled at {found.rate:.4g} Hz; give at least {LEAST_RATE:.0f} Hz, as the bands of "
            "Wh go up to 1412 Hz, or whole periods of a steady vibration with nothing above half "
            "the rate (periodic)"
        )
    if found.duration < LEAST_DURATION * (1 - SAME):
        raise UsageError(
            f"the record takes {found.duration:.3g} s; give at least {LEAST_DURATION:g} s, or "
            "whole periods of a steady vibration (periodic)"
        )
    return found


def uneven(time: Array) -> int | None:
    """Number of the sample that stands farthest from equal steps; None if all are near them."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    off = np.abs(time - time[0] - step * np.arange(len(time)))
    worst = int(np.argmax(off))
    return worst if off[worst] > UNEVEN * step else None


def _check_end(values: Array) -> None:
    """The last sample of a period comes a step before the next period begins."""
    span = np.ptp(values, axis=1)
    if np.any(span > 0) and np.all(np.abs(values[:, -1] - values[:, 0]) <= SAME * span):
        raise UsageError(
            "the last sample repeats the first, with which the next period begins; leave it out"
        )
