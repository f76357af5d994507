"""Signals, spectra and orders, measured or simulated, weighted by Wh."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.exposure.daily import SINGLE_AXIS, total_value
from equipoise.exposure.signal import signal
from equipoise.exposure.weighting import (
    AXES,
    EDGES,
    NEAR,
    NUMBERS,
    Kind,
    Weighted,
    amplitudes,
    exact_middles,
    rising,
    rms_in_bands,
    row,
    sizes,
    squared_factor,
)

Array = np.ndarray[Any, Any]

MUCH = 0.1
"""Share of the weighted mean square below the lowest band, from where on it is told."""
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
    frequency, squares = record.mean_squares()
    return _weigh(
        "signal",
        frequency,
        squares,
        _named(axes, len(squares)),
        single_axis,
        weighted,
        tuple(record.notes()),
        record.duration,
        record.rate,
    )


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
        raise UsageError(f"frequency: got {lines[0]:g} Hz; give frequencies of 0 or more")
    squares = amplitudes("acceleration", acceleration, len(lines)) ** 2
    notes = tuple(_on_bands(lines, bands))
    if bands:
        lines = exact_middles(lines)
    kind: Kind = "bands" if bands else "spectrum"
    return _weigh(kind, lines, squares, _named(axes, len(squares)), single_axis, weighted, notes)


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
            f"got a speed of {turning:g} rad/s and orders from {counts[0]:g}; give a shaft that "
            "turns, and orders of 0 or more"
        )
    squares = amplitudes("amplitude", sizes("amplitude", amplitude), len(counts)) ** 2 / 2
    frequency = abs(turning) * counts / (2 * pi)
    return _weigh("orders", frequency, squares, _named(axes, len(squares)), single_axis, False, ())


def _weigh(
    kind: Kind,
    frequency: Array,
    squares: Array,
    axes: tuple[str, ...],
    single_axis: bool,
    weighted: bool,
    notes: tuple[str, ...],
    duration: float | None = None,
    rate: float | None = None,
) -> Weighted:
    """Of mean squares (axes, K), (m/s2)^2, at frequencies (K,), Hz."""
    if single_axis and len(axes) == len(AXES):
        raise UsageError(
            "single_axis: got three axes, whose total value needs no estimate; leave it out"
        )
    squares = np.where(frequency > 0, squares, 0.0)
    after = squares if weighted else squares * squared_factor(frequency**2)
    a_hw = np.sqrt(np.sum(after, axis=1))
    return Weighted(
        kind,
        axes,
        None if weighted else np.sqrt(np.sum(squares, axis=1)),
        a_hw,
        total_value(a_hw, single_axis),
        None if weighted else rms_in_bands(frequency, squares),
        rms_in_bands(frequency, after),
        single_axis,
        duration,
        rate,
        (*notes, *_on_axes(axes, single_axis), *_on_drift(kind, frequency, after)),
    )


def _named(axes: Sequence[str] | None, count: int) -> tuple[str, ...]:
    names = AXES[:count] if axes is None else tuple(axes)
    if len(names) != count or len(set(names)) != count:
        raise UsageError(f"axes: got {', '.join(names)}; give a name to each of {count} axes")
    return names


# -- notes -----------------------------------------------------------------------------------------


def _on_bands(frequency: Array, bands: bool) -> Iterator[str]:
    """Whether bands are missing, or were meant."""
    if bands and len(frequency) < len(NUMBERS):
        yield (
            f"{len(frequency)} of {len(NUMBERS)} bands were given; the others count as without "
            "vibration"
        )
    elif not bands and len(frequency) >= LOOKS_LIKE_BANDS and frequency[0] > 0:
        number = 10 * np.log10(frequency)
        if np.all(np.abs(number - np.rint(number)) < NEAR):
            yield (
                "the frequencies are middles of one-third-octave bands; say so (bands), and they "
                "count with the factors of the exact middles"
            )


def _on_axes(axes: tuple[str, ...], single_axis: bool) -> Iterator[str]:
    """What the total value leaves out."""
    if single_axis:
        yield (
            f"the total value is estimated as {SINGLE_AXIS} times the largest axis, the cautious "
            "end of what ISO 5349-1 allows; it has to be justified in a report"
        )
    elif len(axes) < len(AXES):
        given = "one axis" if len(axes) == 1 else "two axes"
        yield (
            f"the total value is that of {given} and may be too low; ISO 5349-1 allows "
            f"{SINGLE_AXIS} times the largest axis as an estimate (single axis)"
        )


def _on_drift(kind: Kind, frequency: Array, after: Array) -> Iterator[str]:
    """Whether slow motion takes part that no handle makes."""
    whole = float(np.sum(after))
    slow = float(np.sum(after[:, frequency < EDGES[0]]))
    if kind == "signal" and slow > MUCH * whole:
        yield (
            f"{100 * slow / whole:.0f} % of the weighted mean square lies below 5.6 Hz; look for "
            "drift, a shift of the zero (DC shift), or motion of the hand"
        )
