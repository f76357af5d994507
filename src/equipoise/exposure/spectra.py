"""Signals, spectra and orders, measured or simulated, weighted by Wh.

A record is cut out of a vibration that goes on, so its ends are faded in and out over half a second
each, and mean squares are referred to that of the fade.  Then Wh counts exactly at every frequency
up to half the sampling rate.  Taken as it is, the record would jump from its end to its beginning,
and a jump of something strong at 2 kHz, where Wh is 0.003, is heard at 10 Hz, where it is 1.  A
steady sine of any frequency and phase is read to 1 % from one second, and to 0.1 % from eight
(tests/literature/test_iso_8041.py).

A periodic record is whole periods of a steady vibration and closes by itself; it is exact as it is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.exposure.daily import SINGLE_AXIS, total_value
from equipoise.exposure.weighting import (
    AXES,
    BAND_TOLERANCE,
    EDGES,
    NUMBERS,
    RecordingKind,
    Weighted,
    amplitudes,
    exact_middles,
    of_axes,
    rising,
    rms_in_bands,
    row,
    sizes,
    squared_factor,
)
from equipoise.i18n import Note
from equipoise.signals import Array, harmonics

LEAST_RATE = 2 * float(EDGES[-1])
"""Hz: below, a record cannot hold the whole band of 1250 Hz."""
WHOLE_RATE = 2 * 10**3.3
"""Hz: below, it ends where ISO 8041-1, Table 4, still has a lower tolerance, at 1995 Hz."""
LEAST_DURATION = 1.0
"""s: both fades; a band of 6.3 Hz is 1.5 Hz wide, so that less could not separate it from
its neighbours."""
SHORT = 8.0
"""s, below which ISO 5349-2, 5.4.1, calls a measurement hardly reliable at low frequencies."""
FADE = 0.5
"""s, at each end."""
UNEVEN = 0.25
"""Steps, by which a time may stand off: rounded in the file.  One lost sample makes it 0.5."""
UNEVEN_STEPS = Note("is not where equal steps of time would have it; give a record without gaps")
"""What is said of such a time."""
JUMP = 3.0
"""Largest steps of a periodic record that its end may be away from its beginning."""
SAME = 1e-9
"""Of its range, by which a last sample may differ from the first that it repeats."""


@dataclass(frozen=True, eq=False)
class AccelerationSignal:
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
                yield Note(
                    "taken to hold nothing above half its sampling rate, {frequency} Hz",
                    frequency=f"{half:.4g}",
                )
            ends = np.abs(self.acceleration[:, 0] - self.acceleration[:, -1])
            steps = np.max(np.abs(np.diff(self.acceleration)), axis=1)
            if np.any(ends > JUMP * steps):
                yield Note("the record does not close as one of whole periods does")
            return
        if self.rate < WHOLE_RATE:
            yield Note(
                "the record ends at {frequency} Hz, half its sampling rate; ISO 8041-1 asks for a "
                "response up to 1995 Hz, which takes {rate} Hz",
                frequency=f"{half:.0f}",
                rate=f"{WHOLE_RATE:.0f}",
            )
        if self.duration < SHORT:
            yield Note(
                "the record takes {time} s; ISO 5349-2 calls less than 8 s hardly reliable at low "
                "frequencies, and asks for a minute in several records",
                time=f"{self.duration:.3g}",
            )


def fade(count: int, rate: float) -> Array:
    """Share (count,) by which samples count: sines squared at both ends, 1 between them."""
    from_end = (np.minimum(np.arange(count), np.arange(count)[::-1]) + 0.5) / rate
    return np.asarray(np.sin(np.pi / 2 * np.minimum(from_end / FADE, 1.0)) ** 2)


def signal(time: Any, acceleration: Any, periodic: bool = False) -> AccelerationSignal:
    """A record, checked; see `weigh_signal`.

    Raises
    ------
    UsageError : steps of time differ, or the record is too short or sampled too slowly.
    """
    times = rising("time", time, "s")
    values = of_axes("acceleration", acceleration, len(times))
    if len(times) < 2:
        raise UsageError(
            at_place("time", Note("got one sample; give a record of acceleration against time"))
        )
    at = uneven(times)
    if at is not None:
        raise UsageError(
            at_place(
                "time",
                Note(
                    "sample {at}, at {times:.6g} s, {uneven_steps}",
                    at=at + 1,
                    times=times[at],
                    uneven_steps=UNEVEN_STEPS,
                ),
            )
        )
    acceleration_signal = AccelerationSignal(
        values, (len(times) - 1) / float(times[-1] - times[0]), periodic
    )
    if periodic:
        span = np.ptp(values, axis=1)
        if np.any(span > 0) and np.all(np.abs(values[:, -1] - values[:, 0]) <= SAME * span):
            raise UsageError(
                Note(
                    "the last sample repeats the first, with which the next period begins; "
                    "leave it out"
                )
            )
        return acceleration_signal
    if acceleration_signal.rate < LEAST_RATE:
        raise UsageError(
            Note(
                "sampled at {rate:.4g} Hz; give at least {least_rate:.0f} Hz, as the "
                "bands of Wh go up to 1412 Hz, or whole periods of a steady vibration "
                "with nothing above half the rate (periodic)",
                rate=acceleration_signal.rate,
                least_rate=LEAST_RATE,
            )
        )
    if acceleration_signal.duration < LEAST_DURATION * (1 - SAME):
        raise UsageError(
            Note(
                "the record takes {duration:.3g} s; give at least {least_duration:g} s, "
                "or whole periods of a steady vibration (periodic)",
                duration=acceleration_signal.duration,
                least_duration=LEAST_DURATION,
            )
        )
    return acceleration_signal


def uneven(time: Array) -> int | None:
    """Number of the sample that stands farthest from equal steps; None if all are near them."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    off = np.abs(time - time[0] - step * np.arange(len(time)))
    worst = int(np.argmax(off))
    return worst if off[worst] > UNEVEN * step else None


MUCH = 0.1
"""Share of the weighted mean square below the lowest band, from which on a note reports it."""
LOOKS_LIKE_BANDS = 5
"""Frequencies, all of them middles of bands, from where on a spectrum is asked whether it has."""


def weigh_signal(
    time: Any,
    acceleration: Any,
    *,
    axes: Sequence[str] | None = None,
    single_axis: bool = False,
    weighted: bool = False,
    periodic: bool = False,
) -> Weighted:
    """Weighted RMS of a record of acceleration against time; Wh is exact at any sampling rate.

    Parameters
    ----------
    time : (N,), s, at equal steps.
    acceleration : (axes, N), m/s2, of one to three axes.  The mean is taken off.
    axes : their names; x, y, z if not given.
    single_axis : estimate the total value of one or two axes as 1.7 times the largest.
    weighted : the values are weighted already.
    periodic : the record is whole periods of a steady vibration that has nothing above half the
        sampling rate, as a simulated one; any rate and duration will do then.

    Raises
    ------
    UsageError
        An argument cannot be used; steps of time differ; less than 1 s; sampled below 2825 Hz.
    """
    record = signal(time, acceleration, periodic)
    weigh = _weigh("signal", *record.mean_squares(), axes, single_axis, weighted, record.notes())
    return replace(weigh, duration=record.duration, sampling_rate=record.rate)


def weigh_spectrum(
    frequency: Any,
    acceleration: Any,
    *,
    bands: bool = False,
    axes: Sequence[str] | None = None,
    single_axis: bool = False,
    weighted: bool = False,
) -> Weighted:
    """Weighted RMS of a spectrum: of lines, or of one-third-octave bands.

    Parameters
    ----------
    frequency : (K,), Hz, rising; of bands, nominal or exact middles from 6.3 to 1250 Hz.
    acceleration : (axes, K), m/s2, RMS of every line or band.
    bands : whether they are one-third-octave bands, which count with the factor of the exact
        middle, as in ISO 5349-1, equation A.1.
    axes, single_axis, weighted : as in `weigh_signal`.

    Raises
    ------
    UsageError : an argument cannot be used.
    """
    lines = rising("frequency", frequency, "Hz")
    if lines[0] < 0:
        raise UsageError(
            at_place(
                "frequency", Note("got {lines:g} Hz; give frequencies of 0 or more", lines=lines[0])
            )
        )
    squares = amplitudes("acceleration", acceleration, len(lines)) ** 2
    kind: RecordingKind = "bands" if bands else "spectrum"
    middles = exact_middles(lines) if bands else lines
    return _weigh(kind, middles, squares, axes, single_axis, weighted, _on_bands(lines, bands))


def weigh_orders(
    speed: float,
    orders: Any,
    amplitude: Any,
    *,
    axes: Sequence[str] | None = None,
    single_axis: bool = False,
) -> Weighted:
    """Weighted RMS of a steady vibration that is known by orders of a shaft.

    Parameters
    ----------
    speed : of the shaft, rad/s, of either sign.
    orders : (K,), rising, 0 or more; they need not be whole.  Order 0 is the mean, which does not
        count.
    amplitude : (axes, K), m/s2, peak amplitude of every order; complex ones count by their size.
    axes, single_axis : as in `weigh_signal`.

    Raises
    ------
    UsageError : an argument cannot be used.
    """
    turning = float(row("speed", [speed], "rad/s")[0])
    counts = rising("orders", orders, "orders")
    if turning == 0 or counts[0] < 0:
        raise UsageError(
            Note(
                "got a speed of {turning:g} rad/s and orders from {counts:g}; give a "
                "shaft that turns, and orders of 0 or more",
                turning=turning,
                counts=counts[0],
            )
        )
    squares = amplitudes("amplitude", sizes("amplitude", amplitude), len(counts)) ** 2 / 2
    frequency = abs(turning) * counts / (2 * pi)
    return _weigh("orders", frequency, squares, axes, single_axis)


def _weigh(
    kind: RecordingKind,
    frequency: Array,
    squares: Array,
    axes: Sequence[str] | None,
    single_axis: bool,
    weighted: bool = False,
    notes: Iterable[str] = (),
) -> Weighted:
    """Of mean squares (axes, K), (m/s2)^2, at frequencies (K,), Hz."""
    count = len(squares)
    names = AXES[:count] if axes is None else tuple(axes)
    if len(names) != count or len(set(names)) != count:
        raise UsageError(
            at_place(
                "axes",
                Note(
                    "got {names}; give a name to each of {count} axes",
                    names=", ".join(names),
                    count=count,
                ),
            )
        )
    if single_axis and count == len(AXES):
        raise UsageError(
            at_place(
                "single_axis",
                Note("got three axes, whose total value needs no estimate; leave it out"),
            )
        )
    squares = np.where(frequency > 0, squares, 0.0)
    after = squares if weighted else squares * squared_factor(frequency**2)
    a_hw = np.sqrt(np.sum(after, axis=1))
    return Weighted(
        kind,
        names,
        None if weighted else np.sqrt(np.sum(squares, axis=1)),
        a_hw,
        total_value(a_hw, single_axis),
        None if weighted else rms_in_bands(frequency, squares),
        rms_in_bands(frequency, after),
        single_axis,
        notes=(*notes, *_on_axes(names, single_axis), *_on_drift(kind, frequency, after)),
    )


# -- notes -----------------------------------------------------------------------------------------


def _on_bands(frequency: Array, bands: bool) -> Iterator[str]:
    """Whether bands are missing, or were meant."""
    if bands and len(frequency) < len(NUMBERS):
        yield Note(
            "{number} of {most} bands were given; the others count as without vibration",
            number=len(frequency),
            most=len(NUMBERS),
        )
    elif not bands and len(frequency) >= LOOKS_LIKE_BANDS and frequency[0] > 0:
        number = 10 * np.log10(frequency)
        if np.all(np.abs(number - np.rint(number)) < BAND_TOLERANCE):
            yield Note(
                "the frequencies are middles of one-third-octave bands; say so (bands), and they "
                "count with the factors of the exact middles"
            )


def _on_axes(axes: tuple[str, ...], single_axis: bool) -> Iterator[str]:
    """What the total value leaves out."""
    if single_axis:
        yield Note(
            "the total value is estimated as {times} times the largest axis, the cautious end of "
            "what ISO 5349-1 allows; it has to be justified in a report",
            times=SINGLE_AXIS,
        )
    elif len(axes) < len(AXES):
        yield Note(
            "the total value is that of {given} and may be too low; ISO 5349-1 allows {times} "
            "times the largest axis as an estimate (single axis)",
            given=Note("one axis") if len(axes) == 1 else Note("two axes"),
            times=SINGLE_AXIS,
        )


def _on_drift(kind: RecordingKind, frequency: Array, after: Array) -> Iterator[str]:
    """Whether slow motion takes part that no handle makes."""
    whole = float(np.sum(after))
    slow = float(np.sum(after[:, frequency < EDGES[0]]))
    if kind == "signal" and slow > MUCH * whole:
        yield Note(
            "{share} % of the weighted mean square lies below 5.6 Hz; look for drift, a shift of "
            "the zero (DC shift), or motion of the hand",
            share=f"{100 * slow / whole:.0f}",
        )
