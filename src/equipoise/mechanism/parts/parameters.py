"""Named parameters of a model, and the numbers of it that are worked out from them.

A number that is written as an expression, such as ``length = "=2*crank + 3 mm"``, is worked out
when the model is read.  The machine has the number, and beside it the expression, so that the
model is written as it was for as long as the number is what the expression gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from keyword import iskeyword

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.quantities import Amount, Dimension, parse_amount, parse_expression
from equipoise.quantities.expressions import Names, names_in, parse_number, spelled
from equipoise.quantities.reading import described
from equipoise.quantities.units import OF_UNIT

PARAMETERS = "parameters"
"""The table of a model file."""
SIGN = "="
"""Begins an expression."""
MOST = 1000
"""Parameters of a model; each may name others, so that a file could make its reading long."""


def amounts_of(parameters: object) -> Names:
    """What the names of parameters stand for, by the name as an expression has it.

    Parameters
    ----------
    parameters : texts such as ``"33.5 mm"`` or ``"=2*crank"`` and plain numbers, by name.

    Raises
    ------
    ModelError : a name or a value cannot be used, or parameters are worked out from each other.
    """
    if not isinstance(parameters, Mapping):
        return {}  # its reader says what is wrong with it
    if len(parameters) > MOST:
        what = Note("there are {count}; give at most {most}", count=len(parameters), most=MOST)
        raise ModelError(PARAMETERS, what)
    amounts: dict[str, Amount] = {}
    given: dict[str, object] = {}
    waiting: dict[str, set[str]] = {}
    for name, value in parameters.items():
        needed, key = _named_by(name, value), spelled(name)
        if key in given:
            what = Note("{name!r} is given twice; give another name", name=name)
            raise ModelError(_place(name), what)
        given[key], waiting[key] = value, needed
    while waiting:
        ready = [name for name, of in waiting.items() if not of & waiting.keys()]
        if not ready:
            circle = _circle(waiting)
            what = Note(
                "is worked out from itself: {names}; give one of them as a number",
                names=" \N{RIGHTWARDS ARROW} ".join(circle),
            )
            raise ModelError(_place(circle[0]), what)
        for name in ready:
            try:
                amounts[name] = parse_amount(str(given[name]), amounts)
            except UsageError as error:
                raise ModelError(_place(name), error.note) from error
            del waiting[name]
    return amounts


def worked_out(expression: str, dimension: Dimension | None, names: Names) -> float:
    """The number that an expression gives, in SI units.

    dimension : of the number; None of a plain one.

    Raises
    ------
    UsageError : it gives no such number.
    """
    if dimension is None:
        return parse_number(expression, names)
    return parse_expression(expression, dimension, names)


def _place(name: object) -> str:
    return KeyPath((PARAMETERS, str(name))).shown


def _named_by(name: object, value: object) -> set[str]:
    """The names in the value of a parameter."""
    if not isinstance(name, str) or not name.isidentifier() or iskeyword(name) or name[0] == "_":
        what = Note("got {name!r}; give letters, digits and _, such as crank_2", name=str(name))
        raise ModelError(_place(name), what)
    if name in OF_UNIT:
        raise ModelError(_place(name), Note("{name} is a unit; give another name", name=name))
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        right = Note('give a quantity such as "33.5 mm", or a plain number')
        what = Note("got {given}; {right}", given=described(value), right=right)
        raise ModelError(_place(name), what)
    return names_in(value) if isinstance(value, str) else set()


def _circle(waiting: Mapping[str, set[str]]) -> list[str]:
    """Some parameters that are worked out from each other, each from the next."""
    names = [min(waiting)]
    while names[-1] not in names[:-1]:
        names.append(min(waiting[names[-1]] & waiting.keys()))
    return names[names.index(names[-1]) :]
