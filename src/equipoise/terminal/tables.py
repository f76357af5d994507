"""Numbers, spans and tables as they are printed."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees, pi
from typing import Any

import numpy as np
from tabulate import tabulate

Array = np.ndarray[Any, Any]
Row = tuple[str, ...]

PER_RPM = pi / 30


def number(value: float, scale: float = 0.0) -> str:
    """Four significant digits; 0 where the value is rounding error beside `scale`."""
    if abs(value) <= 1e-10 * abs(scale) or value == 0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return f"{value:.3e}"
    digits = max(0, 3 - int(np.floor(np.log10(abs(value)))))
    return f"{value:.{digits}f}"


def angle(radians: float) -> str:
    return f"{degrees(radians):.1f}"


def percent(share: float, digits: int) -> str:
    """A share as per cent without the sign, and without the minus of what rounds to 0."""
    return f"{round(100 * share, digits) + 0.0:.{digits}f}"


def span(values: Array, scale: float = 0.0) -> str:
    """Smallest to largest value."""
    low, high = float(np.min(values)), float(np.max(values))
    scale = max(abs(low), abs(high), scale)
    if high - low <= 1e-10 * scale:
        return number(high, scale)
    return f"{number(low, scale)} to {number(high, scale)}"


def table(title: str, header: Row, rows: Iterable[Row], words: int = 1) -> str:
    """A titled table whose first columns are words and whose others are numbers."""
    align = ["left"] * words + ["right"] * (len(header) - words)
    body = tabulate(list(rows), header, tablefmt="simple", disable_numparse=True, colalign=align)
    return f"\n{title}\n\n{body}"
