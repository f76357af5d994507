"""Designs that no other design beats in everything."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.studies.extras import needed

Array = np.ndarray[Any, Any]


def front(costs: Array) -> Array:
    """Places of the rows of costs (n, M) that no other row dominates, in order; all to be small.

    Of equal rows only the first is taken.

    Raises
    ------
    UsageError : the library for several costs is not installed.
    """
    if costs.shape[1] == 1 or len(costs) < 2:
        return np.array([np.argmin(costs[:, 0])] if len(costs) else [], np.intp)
    moocore = needed("moocore", "a choice by several figures")
    return np.flatnonzero(moocore.is_nondominated(costs, keep_weakly=False))


def spread(costs: Array, count: int) -> Array:
    """Places of so many rows of costs (n, M) that lie far from each other, in order.

    The best of each cost first, then whichever is furthest from all that are taken, each cost
    measured over its range.
    """
    if not 0 < count < len(costs):
        return np.arange(min(count, len(costs)))
    low, high = costs.min(axis=0), costs.max(axis=0)
    places = (costs - low) / np.where(high > low, high - low, 1.0)
    taken = list(dict.fromkeys(int(k) for k in np.argmin(places, axis=0)))[:count]
    gap = np.min([np.sum((places - places[k]) ** 2, axis=1) for k in taken], axis=0)
    while len(taken) < count:
        gap[taken] = -1.0
        furthest = int(np.argmax(gap))
        taken.append(furthest)
        gap = np.minimum(gap, np.sum((places - places[furthest]) ** 2, axis=1))
    return np.sort(taken)
