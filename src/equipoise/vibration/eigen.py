"""Modes of a linear system."""

from __future__ import annotations

import numpy as np

from equipoise.decompositions import svd
from equipoise.signals import Array, highest_at
from equipoise.vibration.response import Mode

STILL = 1e-7
"""Share of the largest frequency below which a motion counts as free, without a spring."""


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
    _, sizes, shapes = svd(stiffness)
    free = sizes <= STILL**2 * np.max(sizes, initial=0.0)
    modes = [Mode(0j, _scaled(shape)) for shape in shapes[free].astype(complex)]
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value) > least and value.imag >= -STILL * abs(value):
            swinging = value.imag > STILL * abs(value)
            eigenvalue = complex(value if swinging else value.real)
            modes.append(Mode(eigenvalue, _scaled(vector[:count])))
    return tuple(sorted(modes, key=lambda mode: (mode.natural_frequency, mode.eigenvalue.real)))


def _scaled(shape: Array) -> Array:
    """The shape with its largest part 1."""
    largest = shape[highest_at(np.abs(shape), smooth=False)]
    return np.asarray(shape / largest) if largest else shape
