"""From the content of a file to the values that it stands for, as the classes' keys declare it.

A file is read in two steps.  First every value is read for itself, and whatever is wrong is
gathered: the first problem is told, with the number of the others.  Then the objects are made, from
the inside out, with what lies in files beside; what does not go together is told at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from json import dumps as quoted
from math import isfinite
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.keys import (
    PLANES,
    Anything,
    Direction,
    File,
    Flag,
    Frozen,
    Key,
    Kind,
    Listing,
    Named,
    Number,
    OneOr,
    Planes,
    Point,
    Quantity,
    Table,
    Tables,
    Text,
    Told,
    Whole,
    all_keys,
    choice,
    keys_of,
)
from equipoise.mechanism.checks import unknown
from equipoise.quantities import KINDS, parse
from equipoise.schema.numbers import Polar
from equipoise.schema.objects import WRONG, Context, NamedFile, Place, Values, made, written_place


def read_table(
    of: type[Frozen], content: Mapping[str, Any], context: Context, place: Place = ()
) -> Any:
    """The object of a whole file, or of the table of one at a place.

    Raises
    ------
    ModelError : the first thing that is wrong with it, with the number of the others.
    """
    found = _table(Table(of), content, place, context)
    if context.problems:
        (where, what), *others = context.problems
        more = f" (and {len(others)} more)" if others else ""
        raise ModelError(written_place(where), what + more)
    return made(found, context)


def _table(kind: Table, given: Any, place: Place, context: Context) -> Any:
    if not isinstance(given, dict):
        return context.wrong(place, given, "give a table")
    of = kind.type
    known = all_keys(of)
    for name in given:
        if name not in known:
            return context.say((*place, name), unknown(name, known, "key"))
    for name, one in known.items():
        if one.required and name not in given:
            return context.say((*place, name), f"missing; add {_example(one)}")
    return Values(of, place, _values(of, given, place, context))


def _values(
    of: type[Frozen], given: Mapping[str, Any], place: Place, context: Context
) -> dict[str, Any]:
    """What is given of the keys of a class, by field."""
    values: dict[str, Any] = {}
    for name, one in keys_of(of).items():
        kind, at = one.kind, one.field or name
        if isinstance(kind, Table) and kind.flat:
            values[at] = Values(kind.type, place, _values(kind.type, given, place, context))
        elif name in given:
            values[at] = READERS[type(kind)](kind, given[name], (*place, name), context)
    return values


def _example(one: Key) -> str:
    """Return a key and its value as they would stand in the file."""
    name, example = one.name, one.example
    if example is None:
        return f"the table [{name}]"
    if isinstance(example, dict):
        first, example = next(iter(example.items()))
        name = f"{name}.{first}"
    return f"{name} = {quoted(example)}"


def _tables(kind: Tables, given: Any, place: Place, context: Context) -> Any:
    if not isinstance(given, list):
        return context.wrong(
            place, given, f"write each as a table under [[{written_place(place)}]]"
        )
    return tuple(_table(kind.item, one, (*place, n), context) for n, one in enumerate(given))


def _named(kind: Named, given: Any, place: Place, context: Context) -> Any:
    if not isinstance(given, dict):
        return context.wrong(place, given, "give a table")
    read, item = READERS[type(kind.item)], kind.item
    return {name: read(item, one, (*place, name), context) for name, one in given.items()}


# -- single values ---------------------------------------------------------------------------------


def _quantity(kind: Quantity, given: Any, place: Place, context: Context) -> Any:
    try:
        return parse(given, kind.dimension)
    except UsageError as error:
        return context.say(place, str(error))


def _text(kind: Text, given: Any, place: Place, context: Context) -> Any:
    if kind.names:
        right = f"give {choice(kind.names)}"
        return given if given in kind.names else context.wrong(place, given, right)
    return given if isinstance(given, str) else context.wrong(place, given, "give text in quotes")


def _number(kind: Number, given: Any, place: Place, context: Context) -> Any:
    if isinstance(given, bool) or not isinstance(given, int | float):
        return context.wrong(place, given, "give a plain number without unit and quotes")
    try:
        value = float(given)
    except OverflowError:
        return context.wrong(place, given, "give a finite number")
    return value if isfinite(value) else context.wrong(place, given, "give a finite number")


def _whole(kind: Whole, given: Any, place: Place, context: Context) -> Any:
    whole = isinstance(given, int) and not isinstance(given, bool)
    if kind.names:
        right = f"give {choice(kind.names)}"
        return given if whole and given in kind.names else context.wrong(place, given, right)
    if not whole:
        return context.wrong(place, given, "give a whole number without quotes")
    if kind.least is not None and given < kind.least:
        return context.wrong(place, given, f"give {kind.least} or more")
    return given if given <= kind.most else context.wrong(place, given, f"give {kind.most} or less")


def _flag(kind: Flag, given: Any, place: Place, context: Context) -> Any:
    if isinstance(given, bool):
        return given
    return context.wrong(place, given, "give true or false without quotes")


def _anything(kind: Anything, given: Any, place: Place, context: Context) -> Any:
    return given


def _told(kind: Told, given: Any, place: Place, context: Context) -> Any:
    return given if isinstance(given, str) else context.wrong(place, given, kind.right)


def _file(kind: File, given: Any, place: Place, context: Context) -> Any:
    if not isinstance(given, str):
        return context.wrong(place, given, "give text in quotes")
    return NamedFile(kind.sort, place, given)


# -- several values --------------------------------------------------------------------------------


def _listing(kind: Listing, given: Any, place: Place, context: Context) -> Any:
    if kind.right:
        counts = kind.sizes or range(1, len(given) + 1) if isinstance(given, list) else ()
        if not isinstance(given, list) or len(given) not in counts:
            return context.wrong(place, given, f"give {kind.right}")
    elif not isinstance(given, list):
        return context.wrong(place, given, "give a list of two values in brackets")
    read, item = READERS[type(kind.item)], kind.item
    values = tuple(read(item, one, (*place, n), context) for n, one in enumerate(given))
    if kind.right or len(given) == 2:
        return values
    for _ in range(max(2 - len(given), 1)):
        context.wrong(place, given, "give a list of two values")
    return WRONG


_LENGTH = Quantity(dimension="length")
_PAIR = Listing(_LENGTH, (2,))
_PLACE = '["0 mm", "300 mm"], or with z ["0 mm", "300 mm", "0 mm"]'
_POINT = 'give ["33.5 mm", "0 mm"] or { distance = "88 mm", direction = "-83 deg" }'


def _point(kind: Point, given: Any, place: Place, context: Context) -> Any:
    if isinstance(given, dict):
        count = len(context.problems)
        found = _table(Table(Polar), given, place, context)
        if len(context.problems) > count:
            return WRONG
        x, y = made(found, context)
        return (x, y, 0.0) if kind.space else (x, y)
    if not kind.space:
        if not isinstance(given, list):
            return context.wrong(place, given, _POINT)
        return _listing(_PAIR, given, place, context)
    values = _listing(Listing(_LENGTH, (2, 3), _PLACE), given, place, context)
    return (*values, 0.0) if isinstance(values, tuple) and len(values) == 2 else values


_VECTOR = 'an angle such as "90 deg", or three plain numbers such as [0, 1, 0]'


def _direction(kind: Direction, given: Any, place: Place, context: Context) -> Any:
    if isinstance(given, list):
        return _listing(Listing(Number(), (3,), _VECTOR), given, place, context)
    if not isinstance(given, str):
        return context.wrong(place, given, f"give {_VECTOR}")
    return _quantity(Quantity(dimension="angle"), given, place, context)


def _one_or(kind: OneOr, given: Any, place: Place, context: Context) -> Any:
    if isinstance(given, list):
        return _listing(Listing(kind.item, (kind.size,), kind.right), given, place, context)
    plain = isinstance(given, int | float) and not isinstance(given, bool)
    if not isinstance(kind.item, Quantity) and not plain:
        return context.wrong(place, given, f"give {kind.right}")
    value = READERS[type(kind.item)](kind.item, given, place, context)
    return value if value is WRONG else (value,) * (kind.size if kind.repeat else 1)


def _planes(kind: Planes, given: Any, place: Place, context: Context) -> Any:
    """One value, or two by the names of the planes."""
    read, item = READERS[type(kind.item)], kind.item
    example = example_of(item)
    if isinstance(given, list):
        table = ", ".join(f'{plane} = "{example}"' for plane in PLANES)
        return context.wrong(place, given, f'give "{example}", or {{ {table} }}')
    if not isinstance(given, dict):
        value = read(item, given, place, context)
        return value if value is WRONG else (value,) * (2 if isinstance(item, Quantity) else 1)
    for name in given:
        if name not in PLANES:
            return context.say((*place, name), unknown(name, PLANES, "plane"))
    for plane in PLANES:
        if plane not in given:
            return context.say((*place, plane), f'missing; add {plane} = "{example}"')
    return tuple(read(item, given[plane], (*place, plane), context) for plane in PLANES)


def example_of(kind: Kind) -> str:
    """Something of a kind as it would stand in a file."""
    return KINDS[kind.dimension].example if isinstance(kind, Quantity) else "hand.csv"


READERS: dict[type[Kind], Callable[[Any, Any, Place, Context], Any]] = {
    Anything: _anything,
    Direction: _direction,
    File: _file,
    Flag: _flag,
    Listing: _listing,
    Named: _named,
    Number: _number,
    OneOr: _one_or,
    Planes: _planes,
    Point: _point,
    Quantity: _quantity,
    Table: _table,
    Tables: _tables,
    Text: _text,
    Told: _told,
    Whole: _whole,
}
