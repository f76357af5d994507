"""What a compiled loop needs beside the kernels: extremes and angles without branch or call."""

from __future__ import annotations

from collections.abc import Callable
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
        "angle_of": numba.njit(**INLINE)(angle_of),
        "rotation": numba.njit(**INLINE)(_rotation(_nearest())),
    }


# The polynomials below are Chebyshev interpolations, exact to 1e-17.


def angle_of(u: Any) -> Any:
    """Angle of a rotation u, of at most 2.09 rad to either side: from the tangent of its fourth."""
    half = (0.5 + 0.5 * u.real) ** 0.5
    quarter = 0.5 * u.imag / (half * (1.0 + half))
    z = quarter * quarter
    arc = -0.005280870051487617
    arc = arc * z + 0.018095230564342743
    arc = arc * z + -0.032661656028653945
    arc = arc * z + 0.043802683513332864
    arc = arc * z + -0.051663638584717154
    arc = arc * z + 0.05864670804294048
    arc = arc * z + -0.0666435417001706
    arc = arc * z + 0.07692094669579978
    arc = arc * z + -0.09090895671012374
    arc = arc * z + 0.11111110560344459
    arc = arc * z + -0.14285714272114403
    arc = arc * z + 0.19999999999824117
    arc = arc * z + -0.3333333333333243
    arc = arc * z + 1.0
    return 4.0 * quarter * arc


def _rotation(nearest: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def rotation(angle: Any) -> Any:
        """exp(i angle), as the fourth power of that of a fourth of the angle."""
        turns = angle * 0.15915494309189535
        quarter = (turns - nearest(turns)) * 1.5707963267948966
        z = quarter * quarter
        cos = -1.1353379638297575e-11
        cos = cos * z + 2.0875582380663952e-09
        cos = cos * z + -2.7557313097790086e-07
        cos = cos * z + 2.4801587283881152e-05
        cos = cos * z + -0.0013888888888861095
        cos = cos * z + 0.04166666666666645
        cos = cos * z + -0.5
        cos = cos * z + 1.0
        sin = 1.5894736651849094e-10
        sin = sin * z + -2.5050716974102745e-08
        sin = sin * z + 2.755731337640013e-06
        sin = sin * z + -0.000198412698286503
        sin = sin * z + 0.008333333333320363
        sin = sin * z + -0.16666666666666616
        sin = sin * z + 1.0
        u = complex(cos, quarter * sin)
        u = u * u
        return u * u

    return rotation


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
            # What is put aside on the stack lies across lines of the cache otherwise.  llvmlite
            # tells the alignment only beside another attribute.
            builder.function.attributes.alignstack = 64
            builder.function.attributes.add("nounwind")
            return builder.call(function, arguments, fastmath=("fast",))

        return types.float64(types.float64, types.float64), generate

    return intrinsic(extreme)


def _nearest() -> Any:
    """The whole number next to a number, by one instruction."""
    from llvmlite import ir
    from numba import types
    from numba.extending import intrinsic

    number = ir.DoubleType()

    def nearest(context: Any, a: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            kind = ir.FunctionType(number, [number])
            function = builder.module.declare_intrinsic("llvm.rint", [number], kind)
            return builder.call(function, arguments)

        return types.float64(types.float64), generate

    return intrinsic(nearest)
