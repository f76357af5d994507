"""One-third-octave bands: their exact middles 10^(n/10) Hz, their names, and sums over them.

Source of middles and edges: IEC 61260-1, system of base ten; of the range: ISO 5349-1, Table A.2.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.exposure.weighting import factor

Array = np.ndarray[Any, Any]

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

NEAR = 0.06
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
    for given, wrong in zip(frequency, np.abs(number - nearest) > NEAR, strict=True):
        if wrong:
            raise UsageError(
                f"frequency: got {given:g} Hz; give middles of one-third-octave bands, 6.3, 8, 10, "
                "12.5 Hz and so on to 1250 Hz"
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
