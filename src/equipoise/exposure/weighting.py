"""The frequency weighting Wh of ISO 5349-1, Annex A, exactly; its bands, and weighted vibration.

Analog filters in series, with s = i f where f is the frequency in Hz:

    high pass       s^2 / (s^2 + s f1/Q1 + f1^2)
    low pass        f2^2 / (s^2 + s f2/Q1 + f2^2)
    a-v transition  K (1 + s/f3) / (1 + s/(Q2 f4) + s^2/f4^2)

The transition leaves acceleration as it is below some 16 Hz and makes a velocity of it above.

One-third-octave bands: their exact middles 10^(n/10) Hz, their names, and sums over them.

Source of middles and edges: IEC 61260-1, system of base ten; of the range: ISO 5349-1, Table A.2.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.quantities.units import HUGE, TINY
from equipoise.results.result import Result
from equipoise.signals import Array, highest_at

AXES = ("x", "y", "z")


def not_negative(name: str, value: Any, unit: str = "m/s^2") -> float:
    """A finite number of 0 or more."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise UsageError(
            at_place(name, Note("got {value!r}; give a number of 0 or more", value=value))
        )
    if value != 0 and not TINY <= value <= HUGE:
        raise UsageError(
            at_place(
                name,
                Note(
                    "got {value:g} {unit}; give a finite number of 0 or more",
                    value=value,
                    unit=unit,
                ),
            )
        )
    return float(value)


def row(name: str, values: Any, unit: str) -> Array:
    """Finite numbers (N,)."""
    numbers = _numbers(name, values)
    if numbers.ndim != 1 or not numbers.size:
        raise UsageError(
            at_place(
                name,
                Note(
                    "got the shape {shape}; give a row of numbers in {unit}",
                    shape=numbers.shape,
                    unit=unit,
                ),
            )
        )
    return numbers


def rising(name: str, values: Any, unit: str) -> Array:
    """Finite numbers (N,), each larger than the one before."""
    numbers = row(name, values, unit)
    if not np.all(np.diff(numbers) > 0):
        raise UsageError(at_place(name, Note("the values must rise from one to the next")))
    return numbers


def of_axes(name: str, values: Any, count: int) -> Array:
    """Finite numbers (axes, count) of one to three axes; a single row is one axis."""
    numbers = _numbers(name, values)
    numbers = numbers[np.newaxis] if numbers.ndim == 1 else numbers
    if numbers.ndim != 2 or not 1 <= len(numbers) <= len(AXES) or numbers.shape[1] != count:
        raise UsageError(
            at_place(
                name,
                Note(
                    "got the shape {shape}; give one to three axes of {count} values",
                    shape=np.shape(values),
                    count=count,
                ),
            )
        )
    return numbers


def amplitudes(name: str, values: Any, count: int) -> Array:
    """As `of_axes`, of 0 or more."""
    numbers = of_axes(name, values, count)
    if np.any(numbers < 0):
        raise UsageError(
            at_place(name, Note("got {min:g}; give values of 0 or more", min=np.min(numbers)))
        )
    return numbers


def sizes(name: str, values: Any) -> Array:
    """Absolute values of complex numbers of any shape."""
    try:
        numbers: Array = np.abs(np.array(values, dtype=complex))
    except (TypeError, ValueError):
        raise UsageError(
            at_place(name, Note("got {kind}; give rows of numbers", kind=type(values).__name__))
        ) from None
    return numbers


def _numbers(name: str, values: Any) -> Array:
    try:
        numbers = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(
            at_place(name, Note("got {kind}; give rows of numbers", kind=type(values).__name__))
        ) from None
    if not np.all(np.abs(numbers) <= HUGE):
        raise UsageError(at_place(name, Note("a value is not finite; give finite numbers")))
    return numbers


F1, F2 = 10**0.8, 10**3.1
"""Hz, corners of the band limits.  This and what follows: ISO 8041-1, Table 3, row Wh, as quoted in
the reference manual of the Larson Davis HVM200, Table 3.1; ISO 5349-1, Table A.1, rounds them."""
F3 = F4 = 100 / (2 * pi)
"""Hz, corners of the a-v transition: 100 rad/s."""
Q1, Q2 = sqrt(0.5), 0.64
"""Resonance quality of the band limits (Butterworth) and of the transition."""
K = 1.0
"""Gain."""

FASTEST = 1e20
"""Hz, beyond which the weighting is taken as 0; it is 1e-53 there."""


def squared_factor(f2: Any) -> Any:
    """Square of the magnitude of Wh, a rational function of the square of the frequency.

    f2 : frequency squared, Hz^2, not negative.  Only + - * / are used, so that it may be any object
        that has them: an array, a number of many digits, a number that carries derivatives.
    """
    high, low = f2 / F1**2, f2 / F2**2
    rise, fall = f2 / F3**2, f2 / F4**2
    passed = high * high / (1 + high * high) / (1 + low * low)  # as Q1 is that of Butterworth
    return passed * K**2 * (1 + rise) / (1 + fall * (1 / Q2**2 - 2) + fall * fall)


def factor(frequency: Any) -> Array:
    """Magnitude of Wh at frequencies of any shape, Hz; 0 and infinity are allowed.

    Raises
    ------
    UsageError : a frequency is not a number.
    """
    within, beyond = _within(frequency)
    return np.where(beyond, 0.0, np.sqrt(squared_factor(within * within)))


def weighting(frequency: Any) -> Array:
    """Complex response of Wh at frequencies of any shape, Hz; as `factor`.

    A negative frequency gives the conjugate, as filters of real signals do.
    """
    within, beyond = _within(frequency)
    s = 1j * within
    high = s * s / (s * s + s * F1 / Q1 + F1**2)
    low = F2**2 / (s * s + s * F2 / Q1 + F2**2)
    transition = K * (1 + s / F3) / (1 + s / (Q2 * F4) + (s / F4) ** 2)
    return np.where(beyond, 0.0, high * low * transition)


def _within(frequency: Any) -> tuple[Array, Array]:
    """Frequencies that can be squared, and which of them were beyond."""
    values = np.asarray(frequency, dtype=float)
    if np.any(np.isnan(values)):
        raise UsageError(
            at_place("frequency", Note("got a value that is no number; give frequencies in Hz"))
        )
    return np.clip(values, -FASTEST, FASTEST), np.abs(values) > FASTEST


NUMBERS = tuple(range(8, 32))
"""n of the bands that Wh is given for; band n has its middle at 10^(n/10) Hz."""
NOMINAL: tuple[float, ...] = (
    *(6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0, 50.0),
    *(63.0, 80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0, 500.0),
    *(630.0, 800.0, 1000.0, 1250.0),
)
"""Hz, names of these bands."""
MIDDLES = 10 ** (np.array(NUMBERS) / 10)
"""Hz, (24,)."""
EDGES = 10 ** ((np.arange(8, 33) - 0.5) / 10)
"""Hz, (25,): band k reaches from edge k to edge k + 1."""

BAND_TOLERANCE = 0.06
"""Bands, by which a nominal frequency may miss the exact one: 31.5 Hz misses it by 0.02."""


def band_factors() -> dict[float, float]:
    """Factor of every band by its nominal frequency, Hz, taken at its exact middle."""
    return dict(zip(NOMINAL, factor(MIDDLES).tolist(), strict=True))


def exact_middles(frequency: Array) -> Array:
    """Exact middles, Hz, of bands (K,) that are given by nominal or exact ones.

    Raises
    ------
    UsageError : a frequency is the middle of no band from 6.3 to 1250 Hz.
    """
    with np.errstate(divide="ignore"):
        number = 10 * np.log10(frequency)
    nearest = np.clip(np.nan_to_num(np.rint(number)), NUMBERS[0], NUMBERS[-1])
    for given in frequency[np.abs(number - nearest) > BAND_TOLERANCE]:
        raise UsageError(
            at_place(
                "frequency",
                Note(
                    "got {given:g} Hz; give middles of one-third-octave bands, 6.3, 8, 10, "
                    "12.5 Hz and so on to 1250 Hz",
                    given=given,
                ),
            )
        )
    middles: Array = 10 ** (nearest / 10)
    return middles


def rms_in_bands(frequency: Array, squares: Array) -> Array:
    """RMS (axes, 24) in every band of lines (K,), Hz, with mean squares (axes, K).

    A line belongs to the band between whose edges it lies: the bands are ideal filters.
    """
    at = np.searchsorted(EDGES, frequency, side="right") - 1
    inside = (at >= 0) & (at < len(NUMBERS))
    sums = [np.bincount(at[inside], weights=row[inside], minlength=len(NUMBERS)) for row in squares]
    return np.sqrt(np.array(sums).reshape(len(squares), len(NUMBERS)))


RecordingKind = Literal["signal", "spectrum", "bands", "orders"]


@dataclass(frozen=True, eq=False, repr=False)
class Weighted(Result):
    """Weighted acceleration of a handle; see docs/exposure.md.

    kind : what it comes from.
    axes : names of the axes that were measured.
    a_h : (axes,) RMS without weighting and without the mean, m/s2; None where it is not known.
    a_hw : (axes,) weighted RMS, m/s2.
    a_hv : vibration total value, m/s2.
    band_a_h, band_a_hw : (axes, 24) the same in one-third-octave bands from 6.3 to 1250 Hz.
    single_axis : whether the total value is estimated from the largest axis.
    duration, sampling_rate : of a signal, s and Hz; else None.
    notes : what deserves a second look, as sentences.
    """

    kind: RecordingKind
    axes: tuple[str, ...]
    a_h: Array | None
    a_hw: Array
    a_hv: float
    band_a_h: Array | None
    band_a_hw: Array
    single_axis: bool = False
    duration: float | None = None
    sampling_rate: float | None = None
    notes: tuple[str, ...] = ()

    blocks_in = "exposure.blocks.weighted_blocks"

    @property
    def dominant_axis(self) -> str:
        """The axis with the largest weighted value."""
        return self.axes[int(highest_at(self.a_hw, smooth=False))]

    @property
    def dominant_band(self) -> float | None:
        """Nominal frequency, Hz, of the band with the largest weighted value; None if all are 0."""
        sums = np.sum(self.band_a_hw**2, axis=0)
        return NOMINAL[int(highest_at(sums, smooth=False))] if np.any(sums) else None

    @property
    def dominant_share(self) -> float:
        """Share of the weighted mean squares of all axes that lies in that band."""
        sums = np.sum(self.band_a_hw**2, axis=0)
        whole = float(np.sum(self.a_hw**2))
        return float(np.max(sums)) / whole if whole else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        return {
            "kind": self.kind,
            "axes": list(self.axes),
            "duration": self.duration,
            "sampling_rate": self.sampling_rate,
            "a_h": _plain(self.a_h),
            "a_hw": _plain(self.a_hw),
            "a_hv": self.a_hv,
            "single_axis": self.single_axis,
            "dominant_axis": self.dominant_axis,
            "dominant_band": self.dominant_band,
            "dominant_share": self.dominant_share,
            "bands": {
                "frequency": list(NOMINAL),
                "a_h": _plain(self.band_a_h),
                "a_hw": _plain(self.band_a_hw),
            },
            "notes": list(self.notes),
        }


def _plain(values: Array | None) -> Any:
    return None if values is None else values.tolist()
