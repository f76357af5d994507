"""The expression graph: real numbers that record what is done to them.

Formulas run on terms as they run on numbers, and leave a graph behind, which `codegen.source`
writes out in several languages.  A term exists once (common subexpressions), operations on plain
numbers are carried out at once, and sums with 0 and products with 0 and 1 fall away.  Each term
knows whether it depends on the crank angle, on the design, on both or on neither: this decides
in which loop it is computed.  Vectors are pairs of terms.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

ANGLE, DESIGN = 1, 2
BOTH = ANGLE | DESIGN
"""What a term depends on, as bits."""
LEAVES = ("argument", "table")
"""Operations whose arguments are no terms."""


def _power(x: float, exponent: float) -> float:
    """A real power; NaN where there is none, as NumPy has it."""
    value = x**exponent if x >= 0 or exponent == round(exponent) else math.nan
    return float(value)


def _reciprocal(x: float) -> float:
    return 1.0 / x if x else math.copysign(math.inf, x)


FOLDED: dict[str, Callable[..., float]] = {
    "inverse": _reciprocal,
    "abs": abs,
    "sqrt": lambda x: _power(x, 0.5),
    "round": lambda x: float(np.rint(x)),
    "floor": lambda x: float(math.floor(x)),
    "cos": math.cos,
    "sin": math.sin,
    "angle": lambda x, y: math.atan2(y, x),
    "min": min,
    "max": max,
    "select": lambda x, y, yes, no: yes if x >= y else no,
}
"""Operations, but for sums and products, on plain numbers."""


class Graph:
    """Terms by what they are made of.

    base : numbers of arguments, by which comparisons of terms are decided, so that code that looks
        at numbers to distinguish cases takes the case of the base.
    """

    def __init__(self) -> None:
        self._terms: dict[tuple[Any, ...], Term] = {}
        self.base: dict[str, float] = {}

    def argument(self, name: str, mask: int) -> Term:
        """A number that is given by its name; mask : what it depends on."""
        return self._term(("argument", name), mask)

    def table(self, values: Iterable[float]) -> Term:
        """Numbers that all designs share; `pick` takes one of them."""
        return self._term(("table", tuple(map(float, values))), 0)

    def make(self, op: str, *args: Term | float) -> Term:
        """The term that is an operation on these, of which one at least is a term."""
        mask = 0
        for arg in args:
            if type(arg) is Term:
                mask |= arg.mask
        return self._term((op, *args), mask)

    def _term(self, key: tuple[Any, ...], mask: int) -> Term:
        term = self._terms.get(key)
        if term is None:
            term = self._terms[key] = Term(self, key[0], key[1:], mask, len(self._terms))
        return term


class TermArithmetic:
    """Arithmetic of terms and pairs."""

    __slots__ = ()

    def __add__(self, other: Any) -> Any:
        return _combined(add, self, other)

    def __radd__(self, other: Any) -> Any:
        return _combined(add, other, self)

    def __sub__(self, other: Any) -> Any:
        return _combined(subtract, self, other)

    def __rsub__(self, other: Any) -> Any:
        return _combined(subtract, other, self)

    def __mul__(self, other: Any) -> Any:
        return _combined(multiply, self, other)

    def __rmul__(self, other: Any) -> Any:
        return _combined(multiply, other, self)

    def __truediv__(self, other: Any) -> Any:
        return _combined(divide, self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _combined(divide, other, self)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **_: Any) -> Any:
        return _by_numpy(ufunc, method, inputs)


class Term(TermArithmetic):
    """A real number: an operation and what it is done to.

    order : of creation; a term comes after those that it is made of.
    """

    __slots__ = ("args", "graph", "mask", "op", "order")

    def __init__(self, graph: Graph, op: str, args: tuple[Any, ...], mask: int, order: int) -> None:
        self.graph, self.op, self.args, self.mask, self.order = graph, op, args, mask, order

    def __neg__(self) -> Any:
        return negative(self)

    def __abs__(self) -> Any:
        return _operation("abs", self)

    def __pow__(self, exponent: Any) -> Any:
        if exponent == 0.5:
            return _operation("sqrt", self)
        if exponent != int(exponent) or exponent < 1:
            raise TypeError(f"got the exponent {exponent}; terms have roots and whole powers")
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __lt__(self, other: Any) -> bool:
        return at_base(self) < at_base(other)

    def __le__(self, other: Any) -> bool:
        return at_base(self) <= at_base(other)

    def __gt__(self, other: Any) -> bool:
        return at_base(self) > at_base(other)

    def __ge__(self, other: Any) -> bool:
        return at_base(self) >= at_base(other)

    def conjugate(self) -> Term:
        return self

    @property
    def real(self) -> Term:
        return self

    @property
    def imag(self) -> float:
        return 0.0


Real = Term | float


class VectorTerm(TermArithmetic):
    """A vector in the plane, as a complex number of two terms or plain numbers."""

    __slots__ = ("imag", "real")

    def __init__(self, real: Any, imag: Any) -> None:
        self.real, self.imag = real, imag

    def __neg__(self) -> VectorTerm:
        return VectorTerm(negative(self.real), negative(self.imag))

    def __abs__(self) -> Any:
        return root(self.real * self.real + self.imag * self.imag)

    def conjugate(self) -> VectorTerm:
        return VectorTerm(self.real, negative(self.imag))


def at_base(value: Any) -> float:
    """A real number at the base of its graph.

    Raises
    ------
    TypeError : an argument has no number there.
    """
    if type(value) is not Term:
        return float(value)

    def number(term: Term, _: Any) -> Any:
        if term.op != "argument":
            return None
        if term.args[0] not in term.graph.base:
            raise TypeError(f"{term.args[0]} has no number by which terms can be compared")
        return term.graph.base[term.args[0]]

    return float(replaced([value], number)[0])


def as_value(value: Any) -> Any:
    """A number as terms compute with it: a term, a pair or a float; None for anything else."""
    if type(value) in (Term, VectorTerm, float):
        return value
    if isinstance(value, np.ndarray) and value.size == 1:
        return as_value(value.item())
    if isinstance(value, int | float | np.integer | np.floating):
        return float(value)
    if isinstance(value, complex | np.complexfloating):
        return VectorTerm(float(value.real), float(value.imag))
    return None


def _combined(how: Callable[[Any, Any], Any], left: Any, right: Any) -> Any:
    left, right = as_value(left), as_value(right)
    return NotImplemented if left is None or right is None else how(left, right)


# -- arithmetic ------------------------------------------------------------------------------------


def _without_sign(a: Any) -> tuple[Any, bool]:
    """A number without its minus, and whether it had one."""
    if type(a) is Term:
        return (a.args[0], True) if a.op == "-" and len(a.args) == 1 else (a, False)
    return (-a, True) if a < 0 else (a, False)


def _order(a: Any) -> int:
    return a.order if type(a) is Term else -1


def _in_order(a: Real, b: Real) -> tuple[Real, Real]:
    return (a, b) if _order(a) <= _order(b) else (b, a)


def _term(op: str, *args: Real) -> Term:
    return next(arg for arg in args if isinstance(arg, Term)).graph.make(op, *args)


def _operation(op: str, *args: Any) -> Any:
    """An operation on real numbers, carried out where all are plain."""
    if any(type(arg) is Term for arg in args):
        return _term(op, *args)
    return FOLDED[op](*args)


def negative(a: Any) -> Any:
    if type(a) is not Term:
        return -a
    term, minus = _without_sign(a)
    return term if minus else _term("-", term)


def add(a: Any, b: Any) -> Any:  # noqa: PLR0911
    if type(a) is VectorTerm or type(b) is VectorTerm:
        return VectorTerm(add(a.real, b.real), add(a.imag, b.imag))
    if type(a) is not Term and type(b) is not Term:
        return a + b
    if type(a) is not Term and a == 0:
        return b
    if type(b) is not Term and b == 0:
        return a
    (x, minus), (y, less) = _without_sign(a), _without_sign(b)
    if minus and less:
        return negative(add(x, y))
    if minus or less:
        return subtract(a, y) if less else subtract(b, x)
    return multiply(2.0, a) if a is b else _term("+", *_in_order(a, b))


def subtract(a: Any, b: Any) -> Any:  # noqa: PLR0911
    if type(a) is VectorTerm or type(b) is VectorTerm:
        return VectorTerm(subtract(a.real, b.real), subtract(a.imag, b.imag))
    if type(a) is not Term and type(b) is not Term:
        return a - b
    if type(b) is not Term and b == 0:
        return a
    if (type(a) is not Term and a == 0) or a is b:
        return 0.0 if a is b else negative(b)
    (x, minus), (y, less) = _without_sign(a), _without_sign(b)
    if less:
        return add(a, y)
    if minus:
        return negative(add(x, b))
    return _term("-", a, b) if _order(a) < _order(b) else negative(_term("-", b, a))


def multiply(a: Any, b: Any) -> Any:
    if type(a) is VectorTerm and type(b) is VectorTerm:
        return VectorTerm(
            subtract(multiply(a.real, b.real), multiply(a.imag, b.imag)),
            add(multiply(a.real, b.imag), multiply(a.imag, b.real)),
        )
    if type(a) is VectorTerm or type(b) is VectorTerm:
        vector, factor = (a, b) if type(a) is VectorTerm else (b, a)
        return VectorTerm(multiply(vector.real, factor), multiply(vector.imag, factor))
    if type(a) is not Term and type(b) is not Term:
        return a * b
    (a, minus), (b, less) = _without_sign(a), _without_sign(b)
    product = _positive_product(*_in_order(a, b))
    return negative(product) if minus != less else product


def _positive_product(a: Any, b: Any) -> Any:
    """Product of two numbers without a sign; only the first may be plain."""
    if type(a) is Term:
        return _term("*", a, b)
    if a in (0, 1):
        return b if a else 0.0
    if b.op == "*" and type(b.args[0]) is not Term:
        return _positive_product(a * b.args[0], b.args[1])
    return _term("*", a, b)


def inverse(a: Any) -> Any:
    """1 / a."""
    if type(a) is VectorTerm:
        return a.conjugate() * inverse(a.real * a.real + a.imag * a.imag)
    if type(a) is not Term:
        return _reciprocal(a)
    term, minus = _without_sign(a)
    return negative(_term("inverse", term)) if minus else _term("inverse", term)


def divide(a: Any, b: Any) -> Any:
    return multiply(a, inverse(b))


# -- functions -------------------------------------------------------------------------------------


def root(x: Any) -> Any:
    """Square root."""
    return _operation("sqrt", x)


def least(a: Any, b: Any) -> Any:
    """The smaller of two numbers."""
    return a if a is b else _operation("min", *_in_order(a, b))


def greatest(a: Any, b: Any) -> Any:
    """The larger of two numbers."""
    return a if a is b else _operation("max", *_in_order(a, b))


def floor(x: Any) -> Any:
    """The next whole number below."""
    return _operation("floor", x)


def nearest(x: Any) -> Any:
    """The nearest whole number."""
    return _operation("round", x)


def select(x: Any, y: Any, yes: Any, no: Any) -> Any:
    """`yes` where x >= y, else `no`."""
    return yes if yes is no else _operation("select", x, y, yes, no)


def pick(table: Term, place: Any) -> Any:
    """A number of a table, by its place from 0 on; the first or last where there is no such."""
    return _term("pick", table, place)


def rotation(angle: Any) -> VectorTerm:
    """exp(i angle); of a sum of what the crank angle and what the design alone decides, the product
    of both, of which an inner loop evaluates no function.
    """
    if type(angle) is Term and angle.mask == BOTH and (parts := _apart(angle)):
        first, second = map(rotation, parts)
        turned: VectorTerm = first * second
        return turned
    return VectorTerm(_operation("cos", angle), _operation("sin", angle))


def _apart(angle: Any) -> tuple[Any, Any] | None:
    """Summands that the crank angle and that the design alone decides; None of any other."""
    if type(angle) is not Term or angle.mask == DESIGN:
        return 0.0, angle
    if angle.mask == ANGLE:
        return angle, 0.0
    if angle.op == "*" and type(angle.args[0]) is not Term and (parts := _apart(angle.args[1])):
        return multiply(angle.args[0], parts[0]), multiply(angle.args[0], parts[1])
    sides = [_apart(arg) for arg in angle.args] if angle.op in ("+", "-") else []
    if not sides or None in sides:
        return None
    if len(sides) == 1:
        sides = [(0.0, 0.0), *sides]
    how = add if angle.op == "+" else subtract
    (a, b), (c, d) = (side for side in sides if side is not None)
    return how(a, c), how(b, d)


def angle_of(vector: Any) -> Any:
    """Angle of a vector, between minus and plus half a turn."""
    return _operation("angle", vector.real, vector.imag)


def _exponential(a: Any) -> Any:
    if isinstance(a.real, Term) or a.real != 0:
        raise TypeError("terms have exponentials of imaginary numbers only")
    return rotation(a.imag)


UFUNCS: dict[Any, Callable[..., Any]] = {
    np.add: add,
    np.subtract: subtract,
    np.multiply: multiply,
    np.divide: divide,
    np.negative: negative,
    np.positive: lambda a: a,
    np.power: lambda a, exponent: a**exponent,
    np.square: lambda a: a * a,
    np.sqrt: root,
    np.abs: abs,
    np.hypot: lambda a, b: root(a * a + b * b),
    np.cos: lambda a: _operation("cos", a),
    np.sin: lambda a: _operation("sin", a),
    np.tan: lambda a: _operation("sin", a) / _operation("cos", a),
    np.exp: _exponential,
    np.arctan2: lambda y, x: _operation("angle", x, y),
    np.minimum: least,
    np.maximum: greatest,
    np.floor: floor,
    np.heaviside: lambda a, at_zero: select(a, 0.0, select(0.0, a, at_zero, 1.0), 0.0),
    np.rint: nearest,
    np.conjugate: lambda a: a.conjugate(),
}
"""NumPy's functions on terms, so that code for arrays runs on terms, too."""


def _by_numpy(ufunc: Any, method: str, inputs: Sequence[Any]) -> Any:
    values = [as_value(item) for item in inputs]
    if method != "__call__" or ufunc not in UFUNCS or any(value is None for value in values):
        return NotImplemented
    return UFUNCS[ufunc](*values)


# -- graphs ----------------------------------------------------------------------------------------


def reached(outputs: Iterable[Any], known: Container[Term] = ()) -> list[Term]:
    """Terms that real outputs need, each after those that it is made of; of those that are known,
    what they are made of is not needed.
    """
    terms: set[Term] = set()
    left = [output for output in outputs if type(output) is Term]
    while left:
        term = left.pop()
        if term not in terms:
            terms.add(term)
            if term.op not in LEAVES and term not in known:
                left += [arg for arg in term.args if type(arg) is Term]
    return sorted(terms, key=_order)


REMADE: dict[str, Callable[..., Any]] = {
    "+": add,
    "-": lambda *args: negative(*args) if len(args) == 1 else subtract(*args),
    "*": multiply,
    "inverse": inverse,
    "min": least,
    "max": greatest,
    "select": select,
    "pick": pick,
}


def replaced(outputs: Iterable[Any], change: Callable[[Term, Sequence[Any]], Any]) -> list[Any]:
    """Outputs with other terms in the place of some.

    change : from a term and what its arguments have become to what takes its place; None where it
        stays the same operation.
    """
    outputs = list(outputs)
    known: dict[Term, Any] = {}
    for term in reached(outputs):
        args = [known.get(arg, arg) if type(arg) is Term else arg for arg in term.args]
        value = change(term, args)
        if value is None and term.op in LEAVES:
            value = term
        elif value is None:
            value = REMADE[term.op](*args) if term.op in REMADE else _operation(term.op, *args)
        known[term] = value
    return [known[output] if type(output) is Term else output for output in outputs]


def substituted(outputs: Iterable[Any], values: Mapping[Term, Any]) -> list[Any]:
    """Outputs with values in the place of arguments."""
    return replaced(outputs, lambda term, _: values.get(term))
