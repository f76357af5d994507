"""Table 3 of Yamashita, Ichikawa and Mori, and how near their equations are to be met."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import equipoise as eq

EXACT = 1e-9


@dataclass(frozen=True)
class Finger:
    """A column of Table 3: mm, g, degrees and rpm as printed; lengths are a, b, c, d."""

    name: str
    lengths: tuple[float, float, float, float]
    centers: tuple[complex, complex, complex]
    masses: tuple[float, float, float]
    psi: float
    rpm: float

    @property
    def machine(self) -> eq.Machine:
        return eq.load(self.name)

    @property
    def total_mass(self) -> float:
        return sum(self.masses) / 1e3


TYPE_1 = Finger("yamashita-1", (88, 33.5, 71.5, 80), (12, -50 - 20j, 32), (199, 687, 259), 83, 193)
TYPE_2 = Finger("yamashita-2", (85, 40, 70, 80), (17, -45 - 20j, 12), (226, 761, 226), 100, 200)
FINGERS = pytest.mark.parametrize("finger", [TYPE_1, TYPE_2], ids=["I", "II"])


def close(found: Any, wanted: Any) -> None:
    """Assert equality to EXACT of the largest value."""
    np.testing.assert_allclose(found, wanted, rtol=0, atol=EXACT * float(np.max(np.abs(wanted))))
