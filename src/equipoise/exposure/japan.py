"""Guideline on vibrating tools of the Japanese Ministry of Health, Labour and Welfare, 2009.

Source: notifications Kihatsu 0710 No. 1 (chain saws) and No. 2 (other tools) of 10 July 2009: A(8)
shall not exceed 5.0 m/s2; above 2.5 m/s2 one has to work for less; the longest time a day follows
from the total value a as T = 200/a^2 hours, and where that is more than 2 hours, it is 2 hours for
the time being.
"""

from __future__ import annotations

from math import inf

COUNTERMEASURE, LIMIT = 2.5, 5.0
"""m/s2, of A(8): the countermeasure value and the limit value of a day."""
HOURS, LONGEST = 200.0, 7200.0
"""T a^2 in h (m/s2)^2, and the longest time a day, s."""


def limit_time(a_hv: float) -> float:
    """T = 200/a^2 hours a day, here in s, of a total value, m/s2; infinite for 0."""
    return 3600 * HOURS / a_hv**2 if a_hv > 0 else inf


def allowed_time(a_hv: float) -> float:
    """Time a day, s, that a tool may be used for: T, but at most two hours."""
    return min(limit_time(a_hv), LONGEST)
