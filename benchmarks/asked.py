"""What was measured beside what is asked for, as one table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np


@dataclass(frozen=True)
class Limit:
    """What is asked for: at most or at least so much."""

    value: float
    at_most: bool = True

    def __str__(self) -> str:
        return f"{'at most' if self.at_most else 'at least'} {self.value:g}"

    def met(self, found: float) -> bool:
        return found <= self.value if self.at_most else found >= self.value


class Table:
    """Rows as they are measured; printed once all are there."""

    def __init__(self) -> None:
        self.rows: list[tuple[str, str, str, str, str]] = []

    def ratio(
        self, what: str, times: Sequence[float], peer: Sequence[float], limit: Limit | None = None
    ) -> None:
        """Times as multiples of a peer's in the same rounds: of the shortest, and the median."""
        found = min(times) / min(peer)
        each = [one / other for one, other in zip(times, peer, strict=True)]
        self._add(what, f"x {found:.3g}", f"x {median(each):.3g}", found, limit)

    def value(
        self, what: str, values: Sequence[float], unit: str, limit: Limit | None = None
    ) -> None:
        """Values in a unit: the smallest and the median."""
        found = min(values)
        self._add(what, f"{found:.3g} {unit}", f"{median(values):.3g} {unit}", found, limit)

    def remark(self, what: str, said: str) -> None:
        """Something that could not be measured, and why."""
        self.rows.append((what, said, "", "", ""))

    def _add(self, what: str, best: str, middle: str, found: float, limit: Limit | None) -> None:
        verdict = "" if limit is None else ("yes" if limit.met(found) else "NO")
        self.rows.append((what, best, middle, str(limit or ""), verdict))

    def print(self) -> None:
        head = ("", "of the best", "median", "asked for", "met")
        widths = [max(len(row[k]) for row in (head, *self.rows)) for k in range(len(head))]
        for row in (head, *self.rows):
            print("  ".join(f"{text:<{width}}" for text, width in zip(row, widths, strict=True)))


def agree(name: str, found: object, right: object, tolerance: float) -> None:
    """Stop where two that should be the same are not; prints how far they are apart."""
    found, right = np.asarray(found, float), np.asarray(right, float)
    apart = float(np.max(np.abs(found - right) / np.max(np.abs(right), axis=0)))
    print(f"{name:<64} {apart:8.1e} apart")
    if not apart <= tolerance:
        raise SystemExit(f"{name}: {apart:.2g} apart, more than {tolerance:g}")
