"""Named curves against speed: the loud ones told apart, the others quiet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.figures.style import KINDS, short
from equipoise.i18n import say
from equipoise.results.charts import Curve

Array = np.ndarray[Any, Any]

UNBOUNDED = 5e3
"""Over the median, what only a resonance without damping can reach."""


@dataclass(frozen=True, eq=False)
class Named:
    """Values (S,) against speed, and what they are called."""

    name: str
    values: Array

    @property
    def largest(self) -> float:
        """Largest value that is no resonance without damping."""
        return float(np.max(bounded(self.values), initial=0.0))


def bounded(values: Array) -> Array:
    """Those of some values that are numbers, and no peak without bound."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return finite
    return np.asarray(finite[finite <= UNBOUNDED * np.median(finite)])


def ordered(read: Mapping[str, Array]) -> list[Named]:
    """Curves that are named, in their order; behind them the quieter ones that are not."""
    found = [Named(name, values) for name, values in read.items()]
    loudest = sorted(found, key=lambda one: -one.largest)[: len(KINDS)]
    return [c for c in found if c in loudest] + [c for c in found if c not in loudest]


def curves_of(x: Array, found: Sequence[Named], stable: Array | None = None) -> tuple[Curve, ...]:
    """Curves over places (S,), dashed where they are not stable; the quieter ones share a name."""
    drawn = []
    quieter = say("{count} quieter ones", count=len(found) - len(KINDS))
    for number, one in enumerate(found):
        named = number < len(KINDS)
        role = f"kind {number}" if named else "quieter"
        label = short(one.name, 40) if named else quieter
        y = np.where(one.values > 0, one.values, np.nan)
        if stable is None or np.all(stable):
            drawn.append(Curve(x, y, label, role))
            continue
        near = np.convolve(~stable, np.ones(3), "same") > 0
        drawn.append(Curve(x, np.where(stable, y, np.nan), label, role))
        drawn.append(Curve(x, np.where(near, y, np.nan), "", role, dashed=True))
    return tuple(drawn)


def log_ends(
    found: Sequence[Named], below: float, above: float, more: Any = ()
) -> tuple[float, float]:
    """Ends of a log axis that holds curves and some more values, with room as factors."""
    every = np.concatenate([*(bounded(one.values) for one in found), np.asarray(more, float)])
    heard = every[np.isfinite(every) & (every > 0)]
    high = float(np.max(heard, initial=0.0)) or 1.0
    low = max(float(np.min(heard, initial=high)), high * 1e-6)
    return low / below, high * above
