"""Numbers that carry their derivatives, so that one copy of each formula gives both.

A kernel of plain arithmetic (`+ - * /`) runs on these as it runs on arrays, and what comes out has
the exact derivative by every variable that went in: forward differentiation, without a step.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class Dual:
    """A value with its derivatives.

    value : array (...), real or complex.
    slopes : derivatives (P, ...) by P variables, of the value's shape or broadcast against it.
    """

    __array_ufunc__ = None  # an array on the left leaves the operation to this class
    __slots__ = ("slopes", "value")

    def __init__(self, value: Any, slopes: Any) -> None:
        self.value, self.slopes = value, slopes

    def __add__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.slopes + other.slopes)
        return Dual(self.value + other, self.slopes)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.slopes)

    def __sub__(self, other: Any) -> Dual:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Dual:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            slopes = self.slopes * other.value + other.slopes * self.value
            return Dual(self.value * other.value, slopes)
        return Dual(self.value * other, self.slopes * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.value / other, self.slopes / other)
        ratio = self.value / other.value
        return Dual(ratio, (self.slopes - ratio * other.slopes) / other.value)

    def __rtruediv__(self, other: Any) -> Dual:
        ratio = other / self.value
        return Dual(ratio, -ratio * self.slopes / self.value)

    def __getitem__(self, key: Any) -> Dual:
        """A part of the value; the slopes must have its full shape."""
        return Dual(self.value[key], self.slopes[(slice(None), *np.index_exp[key])])

    def conj(self) -> Dual:
        """Complex conjugate."""
        return Dual(np.conj(self.value), np.conj(self.slopes))


def value_of(number: Any) -> Any:
    """The value of a number with or without derivatives."""
    return number.value if isinstance(number, Dual) else number
