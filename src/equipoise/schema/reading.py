"""From the content of a file to values, and what has been found wrong on the way.

A file is read in two steps.  First every value is read for itself, and whatever is wrong is
gathered: the first problem is reported, with the number of the others.  Then the objects are made,
from the inside out, with what lies in files beside; what does not go together is reported at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import field
from functools import partial
from math import isfinite
from typing import Any

from equipoise import keys
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, meant
from equipoise.i18n import LANGUAGES, Note, Worded
from equipoise.keys.paths import KeyPath, quoted
from equipoise.mechanism.checks import FRAME, unknown
from equipoise.mechanism.parts.shown_units import SIGN, worked_out
from equipoise.quantities import KINDS, Dimension, as_written, described, format_exact, parse
from equipoise.quantities.expressions import NamedAmounts, is_expression
from equipoise.quantities.reading import got
from equipoise.schema.numbers import Polar


def within(place: KeyPath, error: ModelError) -> ModelError:
    """Copy of an error whose place is inside of another."""
    return error.within(place.abbreviated)


def _is_below(place: str, where: str) -> bool:
    """Whether a place is that of an error, or in its table."""
    return place == where or place.startswith((f"{where}.", f"{where}["))


WRONG = object()
"""Instead of a value that could not be read."""


@dataclass
class Context:
    """What reading needs besides the content.

    read_side_file : reads what lies in a file of its own, by its sort and the file's name.
    makers : make the objects of some classes otherwise than by `Frozen.from_table`.
    names : what names in expressions stand for.
    bodies : tables of the links and of the frame, by name, as the file has them, of which examples
        of what is missing take their names.
    problems : what has been found wrong, with its place.
    expressions : those of numbers that have been worked out, by their places.
    written : texts of quantities that have been read, each with its place.
    """

    read_side_file: Callable[[str, str], Any] | None = None
    makers: Mapping[type[keys.Frozen], Callable[[dict[str, Any]], Any]] = field(
        default_factory=dict
    )
    names: NamedAmounts = field(default_factory=dict)
    bodies: Mapping[str, Any] = field(default_factory=dict)
    problems: list[tuple[KeyPath, Note]] = field(default_factory=list)
    expressions: dict[KeyPath, str] = field(default_factory=dict)
    written: list[tuple[KeyPath, str]] = field(default_factory=list)

    def wrote(self, place: KeyPath, given: Any) -> None:
        """Keep a text as it stands in the file, for sentences about the quantity that it is."""
        if isinstance(given, str):
            self.written.append((place, given))

    @contextmanager
    def with_written(self) -> Iterator[None]:
        """Say what is wrong with objects in the units in which their numbers were written."""
        try:
            yield
        except ModelError as error:
            where, source = error.where, error.source
            texts = sorted(self.written, key=lambda item: not _is_below(item[0].abbreviated, where))
            what = as_written(error.what, [text for _, text in texts])
            raise ModelError(where, what, source).like(error) from error

    def wrong(self, place: KeyPath, given: Any, right: Note) -> Any:
        """Note that a value is none that can be read."""
        self.problems.append((place, got(described(given), right)))
        return WRONG

    def say(self, place: KeyPath, sentence: Note) -> Any:
        self.problems.append((place, sentence))
        return WRONG


@dataclass(frozen=True)
class TableValues:
    """Values of a table, of which an object is to be made."""

    of: type[keys.Frozen]
    place: KeyPath
    given: dict[str, Any]


@dataclass(frozen=True)
class NamedFile:
    """What lies in a file that is named at a place."""

    sort: str
    place: KeyPath
    file: str


def read_table(
    of: type[keys.Frozen], content: Mapping[str, Any], context: Context, place: KeyPath = KeyPath()
) -> Any:
    """The object of a whole file, or of the table of one at a place.

    Raises
    ------
    ModelError : the first thing that is wrong with it, with the number of the others.
    """
    context.bodies = context.bodies or _bodies_in(content)
    table = _table(keys.KeyTable(of), content, place, context)
    if context.problems:
        (where, what), *others = context.problems
        if others:
            what = Note("{sentence} (and {more} more)", sentence=what, more=len(others))
        raise ModelError(where.abbreviated, what)
    with context.with_written():
        return constructed(table, context)


UNKNOWN = "no-key-of-that-name"
"""What `equipoise explain` knows about keys that there are not."""


def _table(kind: keys.KeyTable, given: Any, place: KeyPath, context: Context) -> Any:
    if not isinstance(given, dict):
        return context.wrong(place, given, Note("give a table"))
    of = kind.type
    known = keys.all_keys(of)
    for name in given:
        if name not in known:
            wrong = unknown(name, known, "key")
            if path := _meant_below(name, given[name], known):
                hint = Note("did you mean {name!r}?", name=path)
                what = Note("no {kind} is called {given!r}; {hint}", kind=Note("key"), given=name,
                            hint=hint)  # fmt: skip
                return context.say(place / name, what.about(UNKNOWN))
            return context.say(place / name, wrong.about(UNKNOWN))
    for name, item in known.items():
        if item.required and name not in given:
            example = _example(item, _own_names(item.kind, given, known, context.bodies))
            return context.say(place / name, Note("missing; add {example}", example=example))
    return TableValues(of, place, _values(of, given, place, context))


def _meant_below(name: str, value: Any, known: Mapping[str, keys.Key]) -> str:
    """Where a key belongs whose table was forgotten, such as ``points.A`` or ``links.rod``: below
    the only one here that has names of the user's, for what looks like its value; else nothing.
    """
    if meant(name, [*known]):
        return ""
    fitting = [
        item.name
        for item in known.values()
        if isinstance(item.kind, keys.Named) and _looks_like(item.kind.item, value)
    ]
    return f"{fitting[0]}.{name}" if len(fitting) == 1 else ""


def _looks_like(kind: keys.Kind, value: Any) -> bool:
    if isinstance(kind, keys.Point):
        return isinstance(value, list) and len(value) == (3 if kind.space else 2)
    if not isinstance(kind, keys.KeyTable) or not isinstance(value, dict) or not value:
        return False
    return value.keys() <= keys.all_keys(kind.type).keys()


def _values(
    of: type[keys.Frozen], given: Mapping[str, Any], place: KeyPath, context: Context
) -> dict[str, Any]:
    """What is given of the keys of a class, by field."""
    values: dict[str, Any] = {}
    for name, key in keys.keys_of(of).items():
        kind, at = key.kind, key.field or name
        if isinstance(kind, keys.KeyTable) and kind.flat:
            values[at] = TableValues(kind.type, place, _values(kind.type, given, place, context))
        elif name in given:
            values[at] = READERS[type(kind)](kind, given[name], place / name, context)
    return values


def _bodies_in(content: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of links and of the frame in the content of a file, as far as they are tables."""
    links, frame = content.get("links"), content.get(FRAME)
    tables = {**(links if isinstance(links, dict) else {}), FRAME: frame}
    return {name: table for name, table in tables.items() if isinstance(table, dict)}


def _own_names(
    kind: keys.Kind,
    given: Mapping[str, Any],
    known: Mapping[str, keys.Key],
    bodies: Mapping[str, Any],
) -> list[str]:
    """Names in the file that a key can have which names a link, or a point of a body that is given
    or the default beside it: of a link those first that are not in the frame, as little can be done
    to these.  Empty where that is not clear.
    """
    if not isinstance(kind, keys.TextKind):
        return []
    if kind.of == "link":
        return [name for name in bodies if name != FRAME]
    if kind.of != "point":
        return []
    key = known.get(kind.on)
    body = kind.on if key is None else given.get(kind.on, key.default)
    fixed = [] if body == FRAME else _points_in(bodies, FRAME)
    return sorted(_points_in(bodies, body), key=fixed.__contains__)


def _points_in(bodies: Mapping[str, Any], body: Any) -> list[str]:
    """Names of the points of a body in the file, whether with places or alone."""
    points = bodies.get(body, {}).get("points") if isinstance(body, str) else None
    if not isinstance(points, dict | list):
        return []
    return [name for name in points if isinstance(name, str)]


def _example(key: keys.Key, names: list[str]) -> str:
    """Return a key and its value as they would stand in the file: one of these names, if any."""
    name, example = key.name, names[0] if names else key.example
    if example is None:
        return Note("the table [{name}]", name=name)
    if isinstance(example, dict):
        first, example = next(iter(example.items()))
        name = f"{name}.{first}"
    return f"{name} = {quoted(example)}"


def _tables(kind: keys.Tables, given: Any, place: KeyPath, context: Context) -> Any:
    if not isinstance(given, list):
        header = KeyPath(step for step in place if isinstance(step, str)).abbreviated
        return context.wrong(
            place, given, Note("write each as a table under [[{header}]]", header=header)
        )
    return tuple(_table(kind.item, item, place / n, context) for n, item in enumerate(given))


def _named(kind: keys.Named, given: Any, place: KeyPath, context: Context) -> Any:
    if kind.listed and isinstance(given, list):
        return _listing(
            keys.Listing(keys.TextKind(), right=Note("names in quotes")), given, place, context
        )
    if not isinstance(given, dict):
        right = Note("give a table")
        if kind.listed:
            right = Note("give a table, or a list of names")
        elif isinstance(given, list) and isinstance(kind.item, keys.KeyTable):
            right = Note("write each as a table [{header}.NAME]", header=place.abbreviated)
        return context.wrong(place, given, right)
    read, item = READERS[type(kind.item)], kind.item
    return {name: read(item, entry, place / name, context) for name, entry in given.items()}


def constructed(value: Any, context: Context) -> Any:
    """The objects of what has been read."""
    if isinstance(value, dict):
        return {name: constructed(item, context) for name, item in value.items()}
    if isinstance(value, tuple) and value and isinstance(value[0], TableValues | NamedFile):
        return tuple(constructed(item, context) for item in value)
    if isinstance(value, TableValues):
        make = partial(context.makers.get(value.of, value.of.from_table), _given(value, context))
    elif isinstance(value, NamedFile) and context.read_side_file is not None:
        make = partial(context.read_side_file, value.sort, value.file)
    else:
        return value
    try:
        return make()
    except ModelError as error:
        raise within(value.place, error) from error


def _given(values: TableValues, context: Context) -> dict[str, Any]:
    """What an object is made of, by its fields."""
    given = {name: constructed(value, context) for name, value in values.given.items()}
    for name, key in keys.keys_of(values.of).items():
        if isinstance(key.kind, keys.File) and key.kind.named and name in given:
            given[key.kind.named] = values.given[name].file
    return given


# -- single values ---------------------------------------------------------------------------------


def _quantity(kind: keys.Quantity, given: Any, place: KeyPath, context: Context) -> Any:
    if isinstance(given, str) and given.startswith(SIGN):
        return _worked_out(kind.dimension, given, place, context)
    context.wrote(place, given)
    try:
        return parse(given, kind.dimension)
    except UsageError as error:
        return context.say(place, _without_sign(given, kind.dimension, context) or error.note)


def _without_sign(given: Any, dimension: Dimension | None, context: Context) -> Note | None:
    """What is said of an expression that lacks only its sign; None of anything else."""
    if not isinstance(given, str) or not (is_expression(given) or given in context.names):
        return None
    right = f"{SIGN}{given}"
    with suppress(UsageError):
        _ = worked_out(right, dimension, context.names)
        return Note("got {given!r}; begin an expression with =: {right!r}",
                    given=given, right=right)  # fmt: skip
    return None


def _worked_out(dimension: Dimension | None, given: str, place: KeyPath, context: Context) -> Any:
    """The number that an expression gives."""
    try:
        value = worked_out(given, dimension, context.names)
    except UsageError as error:
        return context.say(place, error.note)
    context.expressions[place] = given
    if dimension is not None:
        context.wrote(place, format_exact(value, dimension))
    return value


def _text(kind: keys.TextKind, given: Any, place: KeyPath, context: Context) -> Any:
    if kind.names:
        right = Note("give {what}", what=keys.choice(kind.names))
        if isinstance(given, str):
            right = meant(given, kind.names) or right
        return given if given in kind.names else context.wrong(place, given, right)
    return (
        given
        if isinstance(given, str)
        else context.wrong(place, given, Note("give text in quotes"))
    )


def _wording(kind: keys.Wording, given: Any, place: KeyPath, context: Context) -> Any:
    if not isinstance(given, dict):
        return _text(kind, given, place, context)
    example = f'{place[-1]}.en = "..."'
    if not given:
        return context.wrong(
            place, given, Note("give text in quotes, or by language: {example}", example=example)
        )
    for code, text in given.items():
        if code not in LANGUAGES:
            return context.say(place / code, unknown(code, LANGUAGES, "language"))
        if text == "":
            return context.say(place / code, Note("is empty; give text, or leave it out"))
    read = {code: _text(kind, item, place / code, context) for code, item in given.items()}
    return WRONG if WRONG in read.values() else Worded(read)


def _number(kind: keys.Number, given: Any, place: KeyPath, context: Context) -> Any:
    if isinstance(given, str) and given.startswith(SIGN):
        return _worked_out(None, given, place, context)
    if (note := _without_sign(given, None, context)) is not None:
        return context.say(place, note)
    if isinstance(given, bool) or not isinstance(given, int | float):
        return context.wrong(place, given, Note("give a plain number without unit and quotes"))
    with suppress(OverflowError):
        if isfinite(value := float(given)):
            return value
    return context.wrong(place, given, Note("give a finite number"))


def _whole(kind: keys.Whole, given: Any, place: KeyPath, context: Context) -> Any:
    if isinstance(given, str) and given.startswith(SIGN) and not kind.names:
        value = _worked_out(None, given, place, context)
        if value is WRONG:
            return WRONG
        if not float(value).is_integer():
            what = Note("got {given!r}, which gives {value:g}; give a whole number",
                        given=given, value=value)  # fmt: skip
            return context.say(place, what)
        given = int(value)
    whole = isinstance(given, int) and not isinstance(given, bool)
    if kind.names:
        right = Note("give {what}", what=keys.choice(kind.names))
        return given if whole and given in kind.names else context.wrong(place, given, right)
    if not whole:
        return context.wrong(place, given, Note("give a whole number without quotes"))
    if kind.least is not None and given < kind.least:
        return context.wrong(place, given, Note("give {limit:g} or more", limit=kind.least))
    return (
        given
        if given <= kind.most
        else context.wrong(place, given, Note("give {limit} or less", limit=kind.most))
    )


def _file(kind: keys.File, given: Any, place: KeyPath, context: Context) -> Any:
    file = _text(keys.TextKind(), given, place, context)
    return file if file is WRONG else NamedFile(kind.sort, place, file)


# -- several values --------------------------------------------------------------------------------


def _listing(kind: keys.Listing, given: Any, place: KeyPath, context: Context) -> Any:
    if kind.right:
        counts = kind.sizes or range(1, len(given) + 1) if isinstance(given, list) else ()
        if not isinstance(given, list) or len(given) not in counts:
            return context.wrong(place, given, Note("give {what}", what=kind.right))
    elif not isinstance(given, list):
        return context.wrong(place, given, _two_of(kind.item))
    read, item = READERS[type(kind.item)], kind.item
    values = tuple(read(item, entry, place / n, context) for n, entry in enumerate(given))
    if kind.right or len(given) == 2:
        return values
    for _ in range(max(2 - len(given), 1)):
        context.wrong(place, given, Note("give a list of two values"))
    return WRONG


def _two_of(item: keys.Kind) -> Note:
    """What to give instead of a list of two values."""
    if not isinstance(item, keys.Quantity):
        return Note("give a list of two values in brackets")
    kind = KINDS[item.dimension]
    example = quoted([f"0 {kind.example.partition(' ')[2]}", kind.example])
    return Note("give a list of two values in brackets, such as {example}", example=example)


_LENGTH = keys.Quantity(dimension="length")
_PAIR = keys.Listing(_LENGTH, (2,))
_PLACE = Note('["0 mm", "300 mm"], or with z ["0 mm", "300 mm", "0 mm"]')
_EXAMPLE = '["33.5 mm", "0 mm"] or { distance = "88 mm", direction = "-83 deg" }'

_POINT = Note("give {example}", example=_EXAMPLE)
_OR_NAME = Note("give {example}, or the name of a point", example=_EXAMPLE)


def _point(kind: keys.Point, given: Any, place: KeyPath, context: Context) -> Any:
    if kind.named and isinstance(given, str):
        return given
    if isinstance(given, dict):
        count = len(context.problems)
        table = _table(keys.KeyTable(Polar), given, place, context)
        if len(context.problems) > count:
            return WRONG
        x, y = constructed(table, context)
        return (x, y, 0.0) if kind.space else (x, y)
    if not kind.space:
        if not isinstance(given, list):
            return context.wrong(place, given, _OR_NAME if kind.named else _POINT)
        return _listing(_PAIR, given, place, context)
    values = _listing(keys.Listing(_LENGTH, (2, 3), _PLACE), given, place, context)
    return (*values, 0.0) if isinstance(values, tuple) and len(values) == 2 else values


_VECTOR = Note('an angle such as "90 deg", or three plain numbers such as [0, 1, 0]')


def _direction(kind: keys.DirectionKind, given: Any, place: KeyPath, context: Context) -> Any:
    if isinstance(given, list):
        return _listing(keys.Listing(keys.Number(), (3,), _VECTOR), given, place, context)
    if not isinstance(given, str):
        return context.wrong(place, given, Note("give {what}", what=_VECTOR))
    return _quantity(keys.Quantity(dimension="angle"), given, place, context)


def _one_or(kind: keys.OneOr, given: Any, place: KeyPath, context: Context) -> Any:
    if isinstance(given, list):
        return _listing(keys.Listing(kind.item, (kind.size,), kind.right), given, place, context)
    plain = isinstance(given, int | float) and not isinstance(given, bool)
    plain = plain or (isinstance(given, str) and given.startswith(SIGN))
    if not isinstance(kind.item, keys.Quantity) and not plain:
        return context.wrong(place, given, Note("give {what}", what=kind.right))
    value = READERS[type(kind.item)](kind.item, given, place, context)
    return value if value is WRONG else (value,) * (kind.size if kind.repeat else 1)


def _planes(kind: keys.Planes, given: Any, place: KeyPath, context: Context) -> Any:
    """One value, or two by the names of the planes."""
    read, item = READERS[type(kind.item)], kind.item
    example = example_of(item)
    if isinstance(given, list):
        table = ", ".join(f'{plane} = "{example}"' for plane in keys.PLANES)
        return context.wrong(
            place,
            given,
            Note("give {example}, or {table}", example=f'"{example}"', table=f"{{ {table} }}"),
        )
    if not isinstance(given, dict):
        value = read(item, given, place, context)
        return value if value is WRONG else (value,) * (2 if isinstance(item, keys.Quantity) else 1)
    for name in given:
        if name not in keys.PLANES:
            return context.say(place / name, unknown(name, keys.PLANES, "plane"))
    for plane in keys.PLANES:
        if plane not in given:
            return context.say(
                place / plane, Note("missing; add {example}", example=f'{plane} = "{example}"')
            )
    return tuple(read(item, given[plane], place / plane, context) for plane in keys.PLANES)


def example_of(kind: keys.Kind) -> str:
    """Something of a kind as it would stand in a file."""
    return KINDS[kind.dimension].example if isinstance(kind, keys.Quantity) else "hand.csv"


def _read_dependent(
    kind: keys.DependentQuantity, given: Any, place: KeyPath, context: Context
) -> Any:
    context.wrote(place, given)
    return given if isinstance(given, str) else context.wrong(place, given, kind.right)


READERS: dict[type[keys.Kind], Callable[[Any, Any, KeyPath, Context], Any]] = {
    keys.ParameterValue: lambda kind, given, place, context: given,
    keys.Anything: lambda kind, given, place, context: given,
    keys.DirectionKind: _direction,
    keys.File: _file,
    keys.Flag: lambda kind, given, place, context: (
        given
        if isinstance(given, bool)
        else context.wrong(place, given, Note("give true or false without quotes"))
    ),
    keys.Listing: _listing,
    keys.Named: _named,
    keys.Number: _number,
    keys.OneOr: _one_or,
    keys.Planes: _planes,
    keys.Point: _point,
    keys.Quantity: _quantity,
    keys.KeyTable: _table,
    keys.Tables: _tables,
    keys.TextKind: _text,
    keys.DependentQuantity: _read_dependent,
    keys.Whole: _whole,
    keys.Wording: _wording,
}
