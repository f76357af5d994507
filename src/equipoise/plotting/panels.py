"""Sizes of the panels of a path: one scale, one height, and what each has to hold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.plotting.paths import CM, Paths

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = np.ndarray[Any, Any]

LEFT, RIGHT, BOTTOM, TOP, GAP = 0.62, 0.15, 0.5, 0.62, 0.22
"""Inches: margins of the picture, and the gap between the panels."""
WIDEST, HIGHEST = 9.4, 5.0
"""Inches: both panels together at most, and their height at most."""
LEAST = {1: (5.3,), 2: (1.8, 2.3)}
"""Inches: least width of each panel, by how many there are, for what is written above and below."""
AHEAD = 2.5
"""Largest width of the ground panel, over its height."""
ROOM, ABOVE, BELOW = 0.38, 0.42, 0.52
"""Inches kept free at the sides of what is drawn, for its labels; and above and below it."""


@dataclass(frozen=True)
class Panel:
    """Limits of one panel, cm, and how many cm make an inch."""

    left: float
    right: float
    bottom: float
    top: float
    inch: float

    @property
    def width(self) -> float:
        """Inches."""
        return (self.right - self.left) / self.inch

    @property
    def height(self) -> float:
        """Inches."""
        return (self.top - self.bottom) / self.inch

    def settle(self, axes: Axes) -> None:
        """Give axes these limits, and round numbers about half an inch apart, on both the same."""
        axes.set_xlim(self.left, self.right)
        axes.set_ylim(self.bottom, self.top)
        exact = 0.45 * self.inch
        power = 10.0 ** np.floor(np.log10(exact))
        step = next(k * power for k in (1, 2, 5, 10, 20) if k * power >= exact)
        for low, high, put in (
            (self.left, self.right, axes.set_xticks),
            (self.bottom, self.top, axes.set_yticks),
        ):
            put(step * np.arange(np.ceil(low / step), np.floor(high / step) + 1))


def panels(paths: Paths) -> list[Panel]:
    """The panel of the machine, and that of the ground where the machine drives."""
    held = CM * np.concatenate(
        [paths.on_machine(paths.cycle), paths.drawn.corners, paths.tray, [1j * paths.level]]
    )
    low, high = float(np.min(held.imag)), float(np.max(held.imag))
    spans = [(float(np.min(held.real)), float(np.max(held.real)))]
    if paths.drives:
        spans.append(_ground_span(paths, AHEAD * (high - low)))
    across = sum(stop - start for start, stop in spans)
    sides = 2 * ROOM * len(spans)
    inch = max(across / (WIDEST - sides), (high - low) / (HIGHEST - ABOVE - BELOW))
    ends = (low - BELOW * inch, high + ABOVE * inch)
    row = []
    for (start, stop), least in zip(spans, LEAST[len(spans)], strict=True):
        middle, half = (start + stop) / 2, max((stop - start) / 2 + ROOM * inch, least * inch / 2)
        row.append(Panel(middle - half, middle + half, *ends, inch))
    return row


def _ground_span(paths: Paths, most: float) -> tuple[float, float]:
    """From where to where the path over ground is shown, cm: less than two hills of a long way."""
    x = CM * paths.over_ground(paths.ways).real
    start, stop = float(np.min(x)), float(np.max(x))
    if stop - start <= most:
        return start, stop
    shares = (0.3, 0.7) if paths.figures["forward_speed"] > 0 else (0.7, 0.3)
    return -most * shares[0], most * shares[1]
