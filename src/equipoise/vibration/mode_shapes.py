"""Free vibration: natural frequencies, damping and shapes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from equipoise.signals import highest_at

Array = np.ndarray[Any, Any]

STILL = 1e-7
"""Share of the largest frequency below which a motion counts as free, without a spring."""


@dataclass(frozen=True, eq=False)
class Mode:
    """One way in which the support vibrates by itself, growing as exp(eigenvalue * t).

    eigenvalue : 1/s, of the pair that one with positive imaginary part; real where it does not
        swing back.
    shape : (D,) complex, of the free coordinates (m and rad).
    """

    eigenvalue: complex
    shape: Array

    @property
    def natural_frequency(self) -> float:
        """Angular frequency without damping, rad/s: the absolute value of the eigenvalue."""
        return abs(self.eigenvalue)

    @property
    def damped_frequency(self) -> float:
        """Angular frequency of the free motion, rad/s."""
        return self.eigenvalue.imag

    @property
    def damping_ratio(self) -> float:
        """Share of the critical damping; 1 and more do not swing, below 0 grows."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size else 0.0

    @property
    def swings(self) -> bool:
        return self.eigenvalue.imag > 0

    @property
    def cycles_per_second(self) -> float:
        """Natural frequency, Hz."""
        return self.natural_frequency / (2 * pi)


def find_modes(mass: Array, damping: Array, stiffness: Array) -> tuple[Mode, ...]:
    """Modes of M x'' + C x' + K x = 0, by frequency; overdamped and growing ones are told twice.

    mass, damping, stiffness : (D, D).
    """
    count = len(mass)
    system = np.zeros((2 * count, 2 * count))
    system[:count, count:] = np.eye(count)
    system[count:, :count] = -np.linalg.solve(mass, stiffness)
    system[count:, count:] = -np.linalg.solve(mass, damping)
    values, vectors = np.linalg.eig(system)
    least = STILL * float(np.max(np.abs(values), initial=0.0))
    # Eigenvectors of a zero that stands twice, for standing and drifting, are one; the stiffness
    # tells free motions apart.
    found = [Mode(0j, _scaled(shape)) for shape in _free(stiffness)]
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value) <= least:
            continue
        if value.imag > STILL * abs(value):
            found.append(Mode(complex(value), _scaled(vector[:count])))
        elif abs(value.imag) <= STILL * abs(value):
            found.append(Mode(complex(value.real), _scaled(vector[:count])))
    return tuple(sorted(found, key=lambda mode: (mode.natural_frequency, mode.eigenvalue.real)))


def swings_in_a_turn(modes: Iterable[Mode], speed: float) -> float:
    """How often the fastest mode swings while the crank turns once at a speed, rad/s."""
    return max((mode.damped_frequency for mode in modes), default=0.0) / abs(speed)


def _free(stiffness: Array) -> Array:
    """Motions (F, D), complex, that no spring holds."""
    _, sizes, shapes = np.linalg.svd(stiffness)
    return np.asarray(shapes[sizes <= STILL**2 * np.max(sizes, initial=0.0)], dtype=complex)


def _scaled(shape: Array) -> Array:
    """The shape with its largest part 1."""
    largest = shape[highest_at(np.abs(shape), smooth=False)]
    return np.asarray(shape / largest) if largest else shape
