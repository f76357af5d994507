"""What a compiled loop needs beside the kernels: extremes without a branch, running angles."""

from __future__ import annotations

import cmath
import math
from functools import cache
from typing import Any

INLINE = {"forceinline": True, "fastmath": True, "error_model": "numpy"}


@cache
def compiled() -> dict[str, Any]:
    """Functions by name, to be called from compiled loops."""
    import numba

    return {
        "smallest": _extreme("llvm.minnum"),
        "greatest": _extreme("llvm.maxnum"),
        "running": numba.njit(**INLINE)(running),
        "rotation": numba.njit(**INLINE)(rotation),
    }


def running(u: complex, before: float) -> float:
    """Angle of a rotation u, counted on from an angle that is less than half a turn away."""
    angle = math.atan2(u.imag, u.real)
    return angle + 2 * math.pi * round((before - angle) / (2 * math.pi))


def rotation(angle: float) -> complex:
    """exp(i angle)."""
    return cmath.rect(1.0, angle)


def _extreme(instruction: str) -> Any:
    """The smaller or larger of two numbers by one instruction.

    A comparison, or `min` and `max`, which look after NaN, would keep the loop from handling
    several crank angles at once.
    """
    from llvmlite import ir
    from numba import types
    from numba.extending import intrinsic

    number = ir.DoubleType()

    def extreme(context: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            kind = ir.FunctionType(number, [number, number])
            function = builder.module.declare_intrinsic(instruction, [number], kind)
            return builder.call(function, arguments, fastmath=("fast",))

        return types.float64(types.float64, types.float64), generate

    return intrinsic(extreme)
