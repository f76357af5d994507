"""A weighted vibration, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from equipoise.exposure.bands import NOMINAL
from equipoise.results.result import Result

Array = np.ndarray[Any, Any]
Kind = Literal["signal", "spectrum", "bands", "orders"]


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

    kind: Kind
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

    @property
    def dominant_axis(self) -> str:
        """The axis with the largest weighted value."""
        return self.axes[int(np.argmax(self.a_hw))]

    @property
    def dominant_band(self) -> float | None:
        """Nominal frequency, Hz, of the band with the largest weighted value; None if all are 0."""
        sums = np.sum(self.band_a_hw**2, axis=0)
        return NOMINAL[int(np.argmax(sums))] if np.any(sums) else None

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
