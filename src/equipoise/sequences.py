"""Sobol's sequence, from SciPy, which loses an interrupt while it builds one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from equipoise.interrupts import held_back

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol


def sobol(width: int, seed: Any, bits: int | None = None) -> Sobol:
    """A scrambled Sobol sequence of points with so many coordinates, each from 0 to 1.

    seed : a number, or a generator of random numbers.  bits : of each coordinate; 30 if None.

    Interrupts are held back meanwhile: SciPy loads the direction numbers in a compiled function
    that cannot raise, and would keep a sequence of zeros for as long as the process lives.
    """
    from scipy.stats.qmc import Sobol

    with held_back():
        return Sobol(width, bits=bits, seed=seed)
