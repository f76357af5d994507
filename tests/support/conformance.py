"""Published numbers and other programs: what of them the tests hold, and the page that lists it.

A row is data of a test: what is printed and where, what comes out here, to the digits told, and why
the two differ.  `published` makes a test of a function that computes a row's value; `equation` and
`compared` tell what a test of equations, or against another program, holds.  All of it is known
once the modules are imported, so that the page is written without running a test; that every row
holds is what the tests are for.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from decimal import Decimal
from functools import wraps
from pathlib import Path
from typing import Any

import numpy as np
import pytest

TESTS = Path(__file__).parents[1]
HALF = 0.501
"""Of a digit: what rounding as printed leaves, and rounding of processors on top."""
KINDS = ("met", "explained", "open", "slip", "drawn")
"""Of printed numbers."""


@dataclass(frozen=True)
class Source:
    """Where numbers come from: its name as a heading, what is to be said of it, slips in words."""

    name: str
    text: str
    slips: tuple[str, ...] = ()


@dataclass(frozen=True)
class Cause:
    """What makes a printed number another one than the computed one.

    text : in words, for the page.
    gives : computes the number that the cause makes of it, or the least and the largest one that it
        allows.
    """

    text: str
    gives: Callable[[], Any] = field(compare=False)

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class Observation:
    """What is known of a printed number that no cause explains, or of a slip.

    text : in words, for the page.
    holds : computes whether it is so.
    """

    text: str
    holds: Callable[[], bool] = field(compare=False)

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class Printed:
    """A published number.

    printed : as printed; "over 90" and "under 1.0" are bounds; none where it is drawn only.
    computed : what comes out here, each digit of it held; none where it is what is printed.
    within : how exactly a number that is met is met, if not to its last digit.
    why : the two differ: a cause, or what is known of an open difference or a slip, both computed;
        empty where they do not.
    slip : of the print, which cannot be met.
    of : what the test needs to compute it.
    """

    case: str
    what: str
    place: str
    printed: str
    computed: str = ""
    unit: str = ""
    within: float = 0.0
    why: Cause | Observation | str = ""
    slip: bool = False
    of: Any = field(default=None, compare=False)

    def __post_init__(self) -> None:
        """Refuse a difference that is not accounted for."""
        accounted = isinstance(self.why, Cause | Observation) or not self.differs
        if self.bound:
            accounted &= (self.off > 0) == (self.bound == "over")
        if not accounted:
            raise ValueError(f"{self}: {self.told} is not {self.printed}, and nothing says why")

    def __str__(self) -> str:
        return f"{self.case}, {self.what}" if self.case else self.what

    @property
    def told(self) -> str:
        """The number that comes out here."""
        return self.computed or self.printed

    @property
    def bound(self) -> str:
        """over or under, or nothing."""
        return self.printed.rpartition(" ")[0]

    @property
    def off(self) -> Decimal:
        """What comes out here less what is printed."""
        return self.apart(number(self.told), number(self.printed or self.told))

    @property
    def differs(self) -> bool:
        """Whether what comes out here does not round to what is printed."""
        return not self.bound and abs(float(self.off)) > HALF * digit(self.printed or self.told)

    @property
    def kind(self) -> str:
        """How print and computation stand to each other, as `KINDS` has it."""
        if not self.printed:
            return "drawn"
        if self.slip:
            return "slip"
        if not self.differs:
            return "met"
        return "explained" if isinstance(self.why, Cause) else "open"

    @property
    def allowed(self) -> float:
        """How exactly a printed number is met that nothing else is told of."""
        return self.within or HALF * digit(self.printed)

    def apart(self, item: Decimal, other: Decimal) -> Decimal:
        """One number less the other; angles are alike after a turn."""
        off = item - other
        return off - 360 * round(off / 360) if self.unit == "deg" else off

    def check_cause(self) -> None:
        """Hold what a cause gives to the printed digits, where one is needed; and what else is
        known of a difference to what is computed.
        """
        if isinstance(self.why, Observation):
            assert self.why.holds(), f"{self}: not so: {self.why}"
        if not isinstance(self.why, Cause) or self.kind not in ("explained", "slip"):
            return
        printed = number(self.printed)
        given = np.ravel(self.why.gives()).tolist()
        off = [float(self.apart(Decimal(item), printed)) for item in given]
        allowed = HALF * digit(self.printed)
        assert min(off) <= allowed and max(off) >= -allowed, (
            f"{self}: {self.why} gives {given}, not {self.printed}"
        )

    def hold(self, result: Any) -> None:
        """Hold one or more values, each by a way of its own, to the digits told."""
        values = np.ravel(result)
        allowed = HALF * digit(self.told) if self.computed else self.allowed
        assert values.size
        for value in values.tolist():
            off = abs(float(self.apart(Decimal(value), number(self.told))))
            assert off <= allowed, f"{self}: {value!r} is not {self.told}"


@dataclass(frozen=True)
class Agreement:
    """Equations, or outputs of another program, that a test meets to a part of the largest value.

    place : of the equation; none for a program.  slip : what is wrong in print.
    """

    case: str
    what: str
    place: str = ""
    within: float = 0.0
    slip: str = ""


Test = Callable[..., Any]
DECLARED: dict[tuple[str, int], tuple[Source, tuple[Printed | Agreement, ...]]] = {}
"""By file and line of the test."""


def _declare(source: Source, test: Test, rows: Iterable[Printed | Agreement]) -> None:
    """Keep what a test holds; a module that is imported twice says the same twice."""
    code = inspect.unwrap(test).__code__
    known = DECLARED.get((code.co_filename, code.co_firstlineno), (source, ()))[1]
    rows = tuple(row for row in rows if row not in known)
    DECLARED[code.co_filename, code.co_firstlineno] = source, (*known, *rows)


def published(source: Source, *rows: Printed) -> Callable[[Test], Test]:
    """Make a test of a function that computes the value of a row, or more than one of it.

    The test holds what the row's cause gives, too.
    """

    def made(compute: Test) -> Test:
        _declare(source, compute, rows)
        needs = inspect.signature(compute)
        takes_row = "row" in needs.parameters

        @wraps(compute)
        def test(row: Printed, **others: Any) -> None:
            row.hold(compute(**others, **({"row": row} if takes_row else {})))
            row.check_cause()

        if not takes_row:
            row = inspect.Parameter("row", inspect.Parameter.KEYWORD_ONLY)
            test.__signature__ = needs.replace(  # type: ignore[attr-defined]
                parameters=[*needs.parameters.values(), row]
            )
        return pytest.mark.parametrize("row", rows, ids=str)(test)

    return made


def equation(
    source: Source, place: str, what: str, within: float, slip: str = ""
) -> Callable[[Test], Test]:
    """Tell of equations that a test holds to a part of the largest value."""

    def told(test: Test) -> Test:
        _declare(source, test, [Agreement("", what, place, within, slip)])
        return test

    return told


def compared(source: Source, what: str, within: float, *names: str) -> Callable[[Test], Test]:
    """Tell of a test against another program, which asserts, or returns, how far machines are off.

    The difference is a part of the largest value.  names : of the machines; those of the test's
    parameters if none.
    """

    def made(measure: Test) -> Test:
        of = names or cases(measure)
        _declare(source, measure, [Agreement(case, what, "", within) for case in of])

        @wraps(measure)
        def test(**given: Any) -> None:
            off = measure(**given)
            assert off is None or off <= within

        return test

    return made


def cases(test: Test) -> list[str]:
    """Names of what a test is done with; random machines of a kind are one case."""
    (mark,) = (mark for mark in test.pytestmark if mark.name == "parametrize")  # type: ignore[attr-defined]
    names: dict[str, int] = {}
    for item in mark.kwargs.get("ids") or mark.args[1]:
        (name,) = item.values if isinstance(item, type(pytest.param())) else (item,)
        kind, _, seed = name.partition(":")
        names[kind] = names.get(kind, 0) + bool(seed)
    return [
        f"{seeds} random machines, {kind.replace('_', ' ')}" if seeds else kind
        for kind, seeds in names.items()
    ]


def number(text: str) -> Decimal:
    """The number of a printed figure."""
    return Decimal(text.rpartition(" ")[2])


def digit(text: str) -> float:
    """One of the last digit of a printed figure."""
    exponent = number(text).as_tuple().exponent
    assert isinstance(exponent, int)
    return 10.0**exponent
