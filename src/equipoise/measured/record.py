"""A recorded or simulated decay, as a value."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any, Literal

import numpy as np

from equipoise.errors import UsageError

Array = np.ndarray[Any, Any]

LARGEST_SWING = 1.0
"""rad: far more than a gauge's displacement over its arm can stand for."""
Kind = Literal["length", "angle"]

LEAST_SAMPLES = 12
"""Fewer cannot show three half-swings."""


@dataclass(frozen=True, eq=False)
class Record:
    """A displacement against time.

    Parameters
    ----------
    time : (N,), s, rising; it may begin anywhere, and its steps may differ.
    displacement : (N,), m or rad, from any zero.
    kind : ``"length"`` for m, ``"angle"`` for rad.

    Raises
    ------
    UsageError
        Shapes differ, a value is not finite, time does not rise, fewer than twelve samples.
    """

    time: Array
    displacement: Array
    kind: Kind = "length"

    def __post_init__(self) -> None:
        if self.kind not in ("length", "angle"):
            raise UsageError(f'kind: got {self.kind!r}; give "length" or "angle"')
        for name in ("time", "displacement"):
            object.__setattr__(self, name, _column(name, getattr(self, name)))
        if self.time.shape != self.displacement.shape:
            raise UsageError(
                f"got {len(self.time)} times and {len(self.displacement)} displacements; "
                "give as many of both"
            )
        if len(self.time) < LEAST_SAMPLES:
            raise UsageError(
                f"got {len(self.time)} samples; give at least {LEAST_SAMPLES}, "
                "over three half-swings or more"
            )
        if not np.all(np.diff(self.time) > 0):
            raise UsageError("time: the times must rise from sample to sample")

    @property
    def unit(self) -> str:
        """Of the displacement: ``m`` or ``rad``."""
        return "m" if self.kind == "length" else "rad"

    @property
    def duration(self) -> float:
        """From the first to the last sample, s."""
        return float(self.time[-1] - self.time[0])

    def as_angle(self, arm: float) -> Record:
        """The record as an angle, rad: displacement over the arm, m, from the pivot to the gauge.

        Raises
        ------
        UsageError : the record is one of angles, or the arm is not positive.
        """
        if self.kind == "angle":
            raise UsageError("arm: the record is one of angles, which need no arm; leave it out")
        angle = self.displacement / positive("arm", arm)
        swing = float(np.ptp(angle)) / 2
        if swing > LARGEST_SWING:
            raise UsageError(
                f"arm: got {arm:g} m, by which the record swings {np.degrees(swing):.3g} deg to "
                "either side; that is no small angle, give the distance from the pivot to the gauge"
            )
        return Record(self.time, angle, "angle")


def positive(name: str, value: float) -> float:
    """The value, which has to be a finite number above 0."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise UsageError(f"{name}: got {value!r}; give a number above 0")
    if not (isfinite(value) and value > 0):
        raise UsageError(f"{name}: got {value:g}; give a number above 0")
    return float(value)


def _column(name: str, values: Any) -> Array:
    try:
        column: Array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(f"{name}: got {type(values).__name__}; give a row of numbers") from None
    if column.ndim != 1:
        raise UsageError(f"{name}: got {column.ndim} dimensions; give one row of numbers")
    if not np.all(np.isfinite(column)):
        raise UsageError(f"{name}: a value is not finite; leave such samples out")
    column.flags.writeable = False
    return column
