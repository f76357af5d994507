"""Linear response: small motion of the support under the linkages' force and moment, by orders.

(K - (n w)^2 M + i n w C) q_n = W_n for every order n at the crank's speed w.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from equipoise.errors import ModelError, ResponseError
from equipoise.mechanism.model import Machine
from equipoise.mechanism.support import AXES, FREEDOMS, Gauge
from equipoise.signals import Periodic
from equipoise.structures.body import Body, Rest, at_rest
from equipoise.structures.excitation import Excitation, Step
from equipoise.structures.modes import Mode, find_modes

Array = np.ndarray[Any, Any]

SINGULAR = 1e10
"""Condition of an order's equations above which it meets an undamped mode."""


@dataclass(frozen=True, eq=False)
class Linear:
    """The support with its linkages as a linear system; matrices (D, D) of the free coordinates."""

    excitation: Excitation

    @classmethod
    def of(cls, machine: Machine, step: Step) -> Linear:
        return cls(Excitation(Body(machine), step))

    @property
    def body(self) -> Body:
        return self.excitation.body

    @cached_property
    def rest(self) -> Rest:
        """What holds the machine in the drawn position."""
        return at_rest(self.body, self.excitation.weights)

    @cached_property
    def mass(self) -> Array:
        """Of the support and the linkages, kg, kg m and kg m2."""
        return self._free(self.body.mass + self.excitation.mass)

    @cached_property
    def damping(self) -> Array:
        """Of the mounts that carry something."""
        return self._free(self._of_mounts("damper"))

    @cached_property
    def stiffness(self) -> Array:
        """Of the mounts that carry something, of preloads and of weights."""
        mounts = self._of_mounts("spring")
        return self._free(mounts + self.rest.stiffness)

    def _of_mounts(self, part: Literal["spring", "damper"]) -> Array:
        total = np.zeros((6, 6))
        for name, mount in self.body.support.mounts.items():
            if self.rest.carries(name, mount):
                row = self.body.row(mount)
                total += getattr(mount, part) * np.outer(row, row)
        return total

    def _free(self, matrix: Array) -> Array:
        return np.asarray(matrix[np.ix_(self.body.free, self.body.free)])

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Free vibration, by frequency."""
        return find_modes(self.mass, self.damping, self.stiffness)

    def wrench(self, speed: float) -> Periodic:
        """What excites the free coordinates (D, K + 1) at a speed, rad/s."""
        found = self.excitation.at(speed)
        amplitudes = found.amplitudes[self.body.free].copy()
        amplitudes[:, 0] += self.rest.unbalance[self.body.free]
        return Periodic(amplitudes, found.turns)

    def wrench_at(self, theta: Array, speed: float) -> Array:
        """The same (D, P) at crank angles (P,), rad, not by orders."""
        found = self.excitation.samples(theta, speed)[self.body.free]
        return np.asarray(found + self.rest.unbalance[self.body.free, None])

    def motion(self, speed: float) -> Periodic:
        """Displacements of the free coordinates (D, K + 1), m and rad, at a speed, rad/s.

        Raises
        ------
        ModelError : a constant force drives the support away.
        ResponseError : a resonance without damping.
        """
        wrench = self.wrench(speed)
        frequency = wrench.orders * speed
        impedance = self.impedance(frequency)
        loads = wrench.amplitudes.T.copy()
        # A coordinate without a spring has no mean of its own; nothing must push it in the mean.
        mean = self._mean(loads[0].real)
        loads[0], impedance[0] = mean, np.eye(len(mean))
        if self._resonant(impedance, frequency):
            raise ResponseError(
                f"resonance without damping at {speed:g} rad/s; give the mounts a damping, or take "
                "another speed"
            )
        moved = np.linalg.solve(impedance, loads[..., None])[..., 0]
        return Periodic(moved.T, wrench.turns)

    def impedance(self, frequency: Array) -> Array:
        """Wrench for a unit of each displacement (F, D, D) at angular frequencies (F,), rad/s."""
        frequency = frequency[:, None, None]
        found: Array = self.stiffness - frequency**2 * self.mass + 1j * frequency * self.damping
        return found

    def _resonant(self, impedance: Array, frequency: Array) -> bool:
        """Whether an order meets a mode that nothing damps, as near as rounding tells."""
        inertia = frequency[:, None] ** 2 * np.diagonal(self.mass)
        size = np.abs(np.diagonal(self.stiffness)) + inertia
        size[0] = 1.0
        scaled = impedance / np.sqrt(size[:, :, None] * size[:, None, :])
        return bool(np.max(np.linalg.cond(scaled)) > SINGULAR)

    def _mean(self, load: Array) -> Array:
        scale = float(np.linalg.norm(self.excitation.weights[0][0])) + float(np.linalg.norm(load))
        mean = np.linalg.lstsq(self.stiffness, load, rcond=1e-12)[0]
        over = np.abs(self.stiffness @ mean - load)
        if np.max(over, initial=0.0) > 1e-9 * scale:
            names = self.body.support.coordinates
            loose = [name for name, value in zip(names, over, strict=True) if value > 1e-9 * scale]
            raise ModelError(
                "support.mounts",
                f"a constant force drives the support away in {' and '.join(loose)}; add a mount "
                "there",
            )
        return mean

    def seen_by(self, row: Array, moved: Periodic) -> Periodic:
        """What a row (6,) of the body reads off displacements (D, K + 1)."""
        return Periodic(row[self.body.free] @ moved.amplitudes, moved.turns)


def gauges_of(body: Body) -> dict[str, Gauge]:
    """The gauges of the model; the free coordinates at the reference point where it has none."""
    if body.support.gauges:
        return dict(body.support.gauges)
    x, y, z = (float(part) for part in body.reference)
    units = np.eye(3)
    found = {}
    for name in body.support.coordinates:
        if name in AXES:
            found[name] = Gauge(axis=name)
        else:
            direction = units[FREEDOMS.index(name)]
            found[name] = Gauge(
                (x, y, z), (float(direction[0]), float(direction[1]), float(direction[2]))
            )
    return found
