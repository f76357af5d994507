"""ISO 22867: one value for a brush cutter or grass trimmer from its two modes of running."""

from __future__ import annotations

from math import sqrt

from equipoise.exposure.checks import not_negative


def equivalent(idling: float, racing: float) -> float:
    """Equivalent total value a_hv,eq, m/s2, of those when idling and when racing, m/s2.

    Both count for equal times.  Source: ISO 22867, brush cutters and grass trimmers; that the times
    are equal is also told in makers' manuals, as in that of the Stihl FS 40, 20.6.

    Raises
    ------
    UsageError : a value is negative or no finite number.
    """
    idling, racing = not_negative("idling", idling), not_negative("racing", racing)
    return sqrt((idling**2 + racing**2) / 2)
