"""ISO 5349-1 and ISO 5349-2: the total value of three axes, daily exposure, years to white finger.

Sources: ISO 5349-1:2001, 4.4 (equation 1), 5.3 (equations 2 and 3), Annex C (equation C.1, Table
C.1); ISO 5349-2:2001, clause 8.  What of that was checked, and how, is told in docs/exposure.md.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, sqrt
from typing import Any

import numpy as np

EIGHT_HOURS = 28_800.0
"""s, to which a day's exposure is referred."""
SINGLE_AXIS = 1.7
"""Total value over that of the largest axis where no other was measured.  ISO 5349-1, 4.4, asks for
a factor from 1.0 to 1.7; this is the cautious end, three axes alike."""
YEARS_OF_TABLE = (1.0, 8.0)
"""Ends of Table C.1, which goes from 26 to 3.7 m/s2; beyond them equation C.1 extrapolates."""


def total_value(a_hw: Any, single_axis: bool = False) -> float:
    """Vibration total value a_hv, m/s2, of weighted RMS accelerations (axes,), m/s2.

    single_axis : estimate it as 1.7 times the largest axis.
    """
    values = np.asarray(a_hw, dtype=float)
    if single_axis:
        return SINGLE_AXIS * float(np.max(values))
    return float(np.sqrt(np.sum(values**2)))


def partial_exposure(a_hv: float, duration: float) -> float:
    """A_i(8), m/s2, of a total value, m/s2, that acts for a time, s."""
    return a_hv * sqrt(duration / EIGHT_HOURS)


def together(partial: Iterable[float]) -> float:
    """A(8), m/s2, of partial exposures, m/s2."""
    return sqrt(sum(part**2 for part in partial))


def years_to_white_finger(a8: float) -> float:
    """D_y: years of exposure after which 10 % of a group have white fingers; A(8) in m/s2."""
    return 31.8 * a8**-1.06 if a8 > 0 else inf
