"""The shaking force of a machine as a whole: how large, how often, which way, and from what."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import hypot, pi
from typing import Any

import numpy as np

from equipoise.mechanism.model import Machine
from equipoise.present.findings import Findings
from equipoise.signals import Figures, figures, harmonics

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Shaking:
    """The shaking force of all rows together.

    force : complex (N,), N, of equally spaced crank angles of a whole cycle of `turns`.
    """

    machine: Machine
    crank_angle: Array
    force: Array
    turns: int

    @classmethod
    def of(cls, found: Findings) -> Shaking:
        """From the analysis; rows turn ahead by their phases."""
        motion, force = found.analysis.motion, found.analysis.forces.shaking_force.value
        if len(rows := found.machine.rows) > 1:
            orders = np.fft.fftfreq(len(force), 1 / len(force)) / motion.turns
            ahead = sum(np.exp(1j * orders * row.phase) for row in rows)
            force = np.fft.ifft(np.fft.fft(force) * ahead)
        return cls(found.machine, found.analysis.crank_angle, force, motion.turns)

    @cached_property
    def size(self) -> Figures:
        """Figures of its size."""
        return figures(self.crank_angle, np.abs(self.force))

    @property
    def over_weight(self) -> float:
        """Peak over the weight of the links; 0 without gravity."""
        weight = self.machine.mass * hypot(*self.machine.gravity)
        return self.size.peak / (weight * max(1, len(self.machine.rows))) if weight else 0.0

    @cached_property
    def loudest(self) -> tuple[float, float]:
        """Order with the largest share of the mean square, the mean left out, and that share."""
        squares = sum(np.abs(harmonics(part)) ** 2 for part in (self.force.real, self.force.imag))
        squares = np.asarray(squares)
        squares[0] = 0.0
        top = int(np.argmax(squares))
        return top / self.turns, float(squares[top] / (np.sum(squares) or 1.0))

    @cached_property
    def direction(self) -> tuple[float, float]:
        """Direction along which most of its mean square acts, rad in [0, pi), and that share."""
        parts = np.vstack([self.force.real, self.force.imag])
        values, vectors = np.linalg.eigh(parts @ parts.T)
        share = float(values[1] / (np.sum(values) or 1.0))
        x, y = vectors[:, 1]
        return float(np.arctan2(y, x) % pi), share
