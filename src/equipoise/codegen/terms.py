"""Formulas that are run on names instead of numbers, so that they can be written out.

A term remembers how it came about.  What is nothing, or times one, falls away at once; whatever is
used twice becomes a line of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np


class Term:
    """A value that lines will compute: text with a place for each of its parts."""

    __array_ufunc__ = None
    """So that NumPy's numbers leave arithmetic with terms to these."""

    def __init__(self, text: str | Callable[[], str], *parts: Any) -> None:
        self.text, self.parts = text, parts

    def __add__(self, other: Any) -> Any:
        return self if _is(other, 0) else Term("{} + {}", self, other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self if _is(other, 0) else Term("{} - {}", self, other)

    def __rsub__(self, other: Any) -> Any:
        return -self if _is(other, 0) else Term("{} - {}", other, self)

    def __neg__(self) -> Any:
        return Term("-{}", self)

    def __mul__(self, other: Any) -> Any:
        if _is(other, 0):
            return 0.0
        if _is(other, 1):
            return self
        return -self if _is(other, -1) else Term("{} * {}", self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return Term("{} / {}", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return Term("{} / {}", other, self)

    def __abs__(self) -> Any:
        return Term("abs({})", self)

    def conjugate(self) -> Any:
        return Term("{}.conjugate()", self)

    @property
    def real(self) -> Any:
        return Term("{}.real", self)

    @property
    def imag(self) -> Any:
        return Term("{}.imag", self)


def _is(value: Any, number: float) -> bool:
    return isinstance(value, int | float | complex | np.number) and bool(value == number)


class Lines:
    """Writes terms, each but once."""

    def __init__(self, name: str, put: Callable[[str, str], str]) -> None:
        """name : of these lines among others.  put : writes a line that gives a value, and returns
        the value's identifier.
        """
        self._name, self._put = name, put
        self._numbers: dict[Any, int] = {}
        self._written: dict[int, str] = {}

    def write(self, values: dict[str, Any]) -> None:
        """Write lines that give values by their names."""
        terms = {name: self._number(term) for name, term in values.items()}
        content = {number: key for key, number in self._numbers.items()}
        uses = Counter(self._uses(terms.values(), content))
        for name, number in terms.items():
            self._put(name, self._text(number, content, uses))

    def _number(self, term: Any) -> int:
        """Number of a term, the same for all that come about alike."""
        if not isinstance(term, Term):
            number = complex(term)
            key: tuple[Any, ...] = (repr(number if isinstance(term, complex) else number.real),)
        else:
            kept = vars(term).get("number")
            if kept is not None:
                return int(kept)
            key = (term.text, *map(self._number, term.parts))
        found = self._numbers.setdefault(key, len(self._numbers))
        if isinstance(term, Term):
            vars(term)["number"] = found
        return found

    def _uses(self, roots: Iterable[int], content: dict[int, Any]) -> Iterator[int]:
        """Every term that is used, once for each use."""
        left, seen = [*roots], set(self._written)
        while left:
            number = left.pop()
            yield number
            if number not in seen:
                seen.add(number)
                left += content[number][1:]

    def _text(self, number: int, content: dict[int, Any], uses: Counter[int]) -> str:
        if number in self._written:
            return self._written[number]
        text, *parts = content[number]
        if not parts:
            return text() if callable(text) else f"({text})"
        whole = text.format(*(self._text(part, content, uses) for part in parts))
        if uses[number] == 1:
            return f"({whole})"
        name = self._written[number] = self._put(f"term {number} {self._name}", whole)
        return name
