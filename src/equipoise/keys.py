"""Keys of files, declared once: a frozen dataclass says of each field what it is in its file.

::

    @declared
    class Spring(Frozen):
        stiffness: float = key("stiffness", "more than 0", example="2 kN/m", above=0)
        free_length: float = key("length", "at which it exerts nothing", default=0.0)

From this follow the checks of values made in Python (here), and reading, writing, the JSON Schema,
the tables of the documentation and access by path (`equipoise.schema`).  Rules between keys are
plain functions beside the class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from importlib import import_module
from math import inf, isfinite
from numbers import Integral, Real
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar, dataclass_transform

from equipoise.errors import ModelError
from equipoise.quantities import HUGE, SI, TINY, Dimension, pattern

Class = TypeVar("Class", bound=type)
MOST_WHOLE = 1_000_000

# -- kinds -----------------------------------------------------------------------------------------


class Kind:
    """What a value is: `check` takes one that Python gives, `wanted` says what it has to be."""

    wanted: str

    def check(self, value: Any) -> Any:
        """The value as it is kept.

        Raises
        ------
        TypeError, ValueError, OverflowError : it is something else.
        """
        return value


NO_INERTIA = "no body has a negative moment of inertia"


def choice(names: Iterable[Any]) -> str:
    """Say which there are: ``'a', 'b' or 'c'``."""
    *most, last = map(repr, names)
    return f"{', '.join(most)} or {last}" if most else last


@dataclass(frozen=True)
class Text(Kind):
    """Text; `names` are the only ones, if there are any.

    suggested : those that editors offer; what else is wrong with it is said elsewhere.
    """

    names: tuple[str, ...] = ()
    suggested: tuple[str, ...] = ()

    wanted = "text"

    def check(self, value: Any) -> str:
        if not isinstance(value, str):
            raise TypeError
        return value


@dataclass(frozen=True)
class Number(Kind):
    """A plain number."""

    wanted = "a number"

    def check(self, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, Real):
            raise TypeError
        return float(value)


@dataclass(frozen=True)
class Quantity(Number):
    """A number with a unit in the file, in SI units in Python."""

    dimension: Dimension = "length"


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number; `names` are the only ones, if there are any."""

    least: int | None = None
    most: int = MOST_WHOLE
    names: tuple[int, ...] = ()

    wanted = f"a whole number of at most {MOST_WHOLE}"

    def check(self, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, Integral):
            raise TypeError
        count = int(value)
        if abs(count) > max(self.most, MOST_WHOLE):
            raise ValueError
        return count


@dataclass(frozen=True)
class Flag(Kind):
    """True or false."""

    wanted = "true or false"

    def check(self, value: Any) -> bool:
        if not isinstance(value, bool):
            raise TypeError
        return value


@dataclass(frozen=True)
class Anything(Kind):
    """What cannot be told before something else is known; it comes through as it is.

    schema : what the JSON Schema says of it.
    """

    schema: Any = None


@dataclass(frozen=True)
class Told(Number):
    """A number whose dimension something else tells; `Frozen.from_table` makes it of its text.

    right : what to give where no text is given.  schema : what the JSON Schema says of it.
    """

    right: str = "give number and unit in quotes"
    schema: Any = None


def told_by(name: str, sizes: Sequence[str], dimensions: Mapping[str, Dimension]) -> dict[str, Any]:
    """JSON Schema of a table in which the key `name` tells the dimension of `sizes`."""
    cases = []
    for dimension in dict.fromkeys(dimensions.values()):
        names = [one for one, own in dimensions.items() if own == dimension]
        cases.append(
            {
                "if": {"properties": {name: {"enum": names}}, "required": [name]},
                "then": {"properties": {size: {"pattern": pattern(dimension)} for size in sizes}},
            }
        )
    return {"allOf": cases}


def items_of(value: Any) -> tuple[Any, ...]:
    """A list as a tuple; texts and mappings are none."""
    if isinstance(value, str | Mapping):
        raise TypeError
    return tuple(value)


@dataclass(frozen=True)
class Listing(Kind):
    """Some of a kind in a list.

    sizes : how many there can be; none for one or more.
    right : what to give instead of a list of another length, or of none.
    """

    item: Kind
    sizes: tuple[int, ...] = ()
    right: str = ""

    @property
    def wanted(self) -> str:  # type: ignore[override]
        if isinstance(self.item, Text):
            return "a list of texts"
        if isinstance(self.item, Listing | Point):
            return "two points of two numbers each" if self.sizes else "rows of numbers"
        if self.sizes == (2,):
            whole = f"two whole numbers of at most {MOST_WHOLE}"
            return whole if isinstance(self.item, Whole) else "two numbers"
        return "numbers"

    def check(self, value: Any) -> tuple[Any, ...]:
        items = tuple(map(self.item.check, items_of(value)))
        if self.sizes == (2,) and len(items) != 2 and not self.right:
            raise ValueError
        return items


@dataclass(frozen=True)
class Point(Kind):
    """Two lengths along x and y, in a file by distance and direction too.

    space : with a third length along z, which may be left out.
    """

    space: bool = False

    @property
    def wanted(self) -> str:  # type: ignore[override]
        return "two or three numbers" if self.space else "two numbers"

    def check(self, value: Any) -> tuple[float, ...]:
        row = tuple(map(Number().check, items_of(value)))
        row = (*row, 0.0) if self.space and len(row) == 2 else row
        if len(row) != (3 if self.space else 2):
            raise ValueError
        return row


@dataclass(frozen=True)
class Direction(Kind):
    """An angle in the plane of the drawing, or a vector of three plain numbers."""

    wanted = "an angle, or three numbers"

    def check(self, value: Any) -> float | tuple[float, ...]:
        if isinstance(value, Real):
            return Number().check(value)
        if len(row := tuple(map(Number().check, items_of(value)))) != 3:
            raise ValueError
        return row


@dataclass(frozen=True)
class OneOr(Kind):
    """One of a kind, or several in a list; always a tuple in Python.

    repeat : one stands for as many equal ones.
    right : what to give instead of anything else.
    """

    item: Kind
    size: int
    repeat: bool = False
    right: str = ""

    @property
    def wanted(self) -> str:  # type: ignore[override]
        return "two numbers" if self.repeat else "numbers"

    def check(self, value: Any) -> tuple[Any, ...]:
        items = tuple(map(self.item.check, items_of(value)))
        if self.repeat and len(items) != self.size:
            raise ValueError
        return items


PLANES = ("vertical", "lateral")


@dataclass(frozen=True)
class Planes(Kind):
    """Of the vertical and the lateral plane: one for both, or a table of two."""

    item: Kind

    @property
    def wanted(self) -> str:  # type: ignore[override]
        return "two numbers" if isinstance(self.item, Quantity) else "a list of such objects"

    def check(self, value: Any) -> tuple[Any, ...]:
        items = tuple(map(self.item.check, items_of(value)))
        if isinstance(self.item, Quantity) and len(items) != 2:
            raise ValueError
        return items


@dataclass(frozen=True)
class Named(Kind):
    """Some of a kind by names that the user chooses."""

    item: Kind

    @property
    def wanted(self) -> str:  # type: ignore[override]
        of = {Point: "two numbers", Text: "text", Table: "such objects"}
        return f"a mapping of names to {of.get(type(self.item), 'numbers')}"

    def check(self, value: Any) -> Mapping[str, Any]:
        if not isinstance(value, Mapping):
            raise TypeError
        name, item = Text().check, self.item.check
        return MappingProxyType({name(key): item(one) for key, one in value.items()})


@dataclass(frozen=True)
class Table(Kind):
    """A table with keys of its own, those of a class.

    of : the class, or ``module:name`` of one that takes time to import.
    flat : its keys stand among those of the table that has it.
    headed : inside of another table it is written below a header of its own.
    without : keys of a flat one that do not stand there.
    """

    of: Any
    flat: bool = False
    headed: bool = False
    without: tuple[str, ...] = ()

    @property
    def wanted(self) -> str:  # type: ignore[override]
        return self.type.wanted

    @property
    def type(self) -> type[Frozen]:
        """The class."""
        if isinstance(self.of, str):
            module, _, name = self.of.partition(":")
            found: type[Frozen] = getattr(import_module(module), name)
            return found
        kept: type[Frozen] = self.of
        return kept

    def check(self, value: Any) -> Any:
        return self.type.checked(value)


@dataclass(frozen=True)
class Tables(Kind):
    """Any number of such tables."""

    item: Table
    wanted = "a list of such objects"

    def check(self, value: Any) -> tuple[Any, ...]:
        return tuple(map(self.item.check, value))


@dataclass(frozen=True)
class File(Kind):
    """What lies in a file of its own, which the key names.

    sort : what it is, such as ``load``.  named : field that keeps the file's name.
    """

    sort: str
    named: str = ""
    wanted = "such an object"

    def check(self, value: Any) -> Any:
        return Frozen.checked(value)


def innermost(kind: Kind) -> Kind:
    """What lists, and mappings of names, consist of."""
    while isinstance(kind, Listing | Named | OneOr | Planes):
        kind = kind.item
    return kind


# -- declaring -------------------------------------------------------------------------------------

REQUIRED = object()
"""Default of a key that has to be given."""
_KEY = "equipoise key"


@dataclass(frozen=True, eq=False)
class Key:
    """A key of a file.

    name : in the file.  field : of the class, the same where nothing else is said.
    text : what it means, in words that go on after its name.
    example : as it would stand in the file.  default : in Python; `shown` if the file's reader is
        better told otherwise.
    at_least, above, below : limits in SI units; `why` is said
        instead of words made of them.
    endless : it may be infinite, for no limit.  inside : no file has it.
    """

    name: str
    kind: Kind
    text: str = ""
    field: str = ""
    example: Any = None
    default: Any = REQUIRED
    shown: Any = None
    at_least: float | None = None
    above: float | None = None
    below: float | None = None
    why: str = ""
    endless: bool = False
    inside: bool = False

    @property
    def required(self) -> bool:
        return self.default is REQUIRED

    def allows(self, value: Any) -> Any:
        """Whether a number, or each of an array, is within the limits."""
        right: Any = True
        if self.at_least is not None:
            right = right & (value >= self.at_least)
        if self.above is not None:
            right = right & (value > self.above)
        if self.below is not None:
            right = right & (value < self.below)
        return right

    @property
    def unit(self) -> str:
        """SI unit of its quantity behind a space; nothing of a plain number."""
        kind = innermost(self.kind)
        return f" {SI[kind.dimension]}" if isinstance(kind, Quantity) else ""

    def right(self, value: float) -> str:
        """What to give instead of a number beyond the limits."""
        if self.why:
            return self.why
        if self.below is not None and value >= self.below:
            return f"give less than {self.below:g}"
        least = (
            f"more than {self.above:g}" if self.above is not None else f"{self.at_least:g} or more"
        )
        return f"give {least}"


Keys = Mapping[str, Key]
Conditions = Mapping[str, Any]


def key(
    kind: Kind | str,
    text: str = "",
    *,
    name: str = "",
    default: Any = REQUIRED,
    factory: Callable[[], Any] | None = None,
    compare: bool = True,
    **more: Any,
) -> Any:
    """Declare a field that is a key of the file; `kind` may be the dimension of a quantity.

    The other parameters are those of `Key`, and `factory` and `compare` as of a dataclass.
    """
    kind = Quantity(dimension=kind) if isinstance(kind, str) else kind  # type: ignore[arg-type]
    standing = factory() if factory is not None else default
    declaration = Key(name, kind, text, default=standing, **more)
    given: dict[str, Any] = {} if default is REQUIRED else {"default": default}
    if factory is not None:
        given = {"default_factory": factory}
    return field(metadata={_KEY: declaration}, compare=compare, **given)


def inside(kind: Kind | str, *, default: Any = REQUIRED, compare: bool = True, **more: Any) -> Any:
    """Declare a field that no file has a key for; it is checked all the same, as of `key`."""
    kind = Quantity(dimension=kind) if isinstance(kind, str) else kind  # type: ignore[arg-type]
    given: dict[str, Any] = {} if default is REQUIRED else {"default": default}
    return field(
        metadata={_KEY: Key("", kind, default=default, inside=True, **more)},
        compare=compare,
        **given,
    )


@dataclass_transform(frozen_default=True, field_specifiers=(key, inside, field))
def declared(cls: Class) -> Class:
    """Make a frozen dataclass of a class with keys."""
    return dataclass(frozen=True)(cls)


class Frozen:
    """Base of the frozen dataclasses of a model: numbers as floats, lists as tuples, mappings
    read-only, each checked by its kind when the object is made.

    beside : keys of the file that are no fields, by name; `from_table` and `to_table` translate.
    file_order : names of keys in the order of the file, where it is not that of the fields.
    conditions : what the JSON Schema says of keys that go together.
    """

    beside: ClassVar[Keys] = {}
    file_order: ClassVar[tuple[str, ...]] = ()
    conditions: ClassVar[Conditions] = {}
    wanted: ClassVar[str] = "such an object"
    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __post_init__(self) -> None:
        for name, kind, without in _checked(type(self)):
            value = getattr(self, name)
            if value is without and without in (None, ()):  # there is one empty tuple only
                continue
            try:
                object.__setattr__(self, name, kind.check(value))
            except (TypeError, ValueError, OverflowError):
                raise ModelError(name, f"got {_shown(value)}; give {kind.wanted}") from None

    @classmethod
    def checked(cls, value: Any) -> Any:
        """The value of a field that holds such an object; a `TypeError` where it is none."""
        if not isinstance(value, Frozen):
            raise TypeError
        return value

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Any:
        """The object of the keys that a file has given, in SI units.

        Raises
        ------
        ModelError : they do not go together; `where` is the key inside of this table.
        """
        return cls(**given)

    @classmethod
    def to_table(cls, value: Any) -> dict[str, Any]:
        """What the file says of an object, by key, in SI units; defaults are left out."""
        given = ((one, getattr(value, one.field)) for one in keys_of(cls).values() if one.field)
        return {one.name: item for one, item in given if one.required or item != one.default}

    def __getstate__(self) -> dict[str, Any]:
        return {
            key: dict(value) if isinstance(value, MappingProxyType) else value
            for key, value in self.__dict__.items()
            if not key.startswith("_")
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        for key, value in state.items():
            self.__dict__[key] = MappingProxyType(value) if isinstance(value, dict) else value


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


ROW = Listing(Number())
"""Numbers of a table, in Python only."""
SCHEMA_VERSION = 1
VERSION = Key(
    "schema",
    Whole(names=(SCHEMA_VERSION,)),
    f"version of the format: {SCHEMA_VERSION}",
    example=SCHEMA_VERSION,
)
"""The first key of every file."""


# -- what a class declares -------------------------------------------------------------------------


@cache
def keys_of(cls: type[Frozen]) -> Mapping[str, Key]:
    """Keys of a class in the order of the file, by name; a flat table is one of them."""
    found = {name: replace(one, name=name) for name, one in cls.beside.items()}
    for one in _declarations(cls):
        if one.name:
            found[one.name] = one
    own = [name for name in found if name not in cls.beside]
    return {name: found[name] for name in dict.fromkeys((*cls.file_order, *own, *cls.beside))}


@cache
def all_keys(cls: type[Frozen]) -> Mapping[str, Key]:
    """Keys that stand in the table of a class, by name, with those of flat ones in their places."""
    found: dict[str, Key] = {}
    for one in keys_of(cls).values():
        kind = one.kind
        if isinstance(kind, Table) and kind.flat:
            inner = all_keys(kind.type).items()
            found |= {name: own for name, own in inner if name not in kind.without}
        else:
            found[one.name] = one
    return found


@cache
def _declarations(cls: type[Frozen]) -> tuple[Key, ...]:
    """What is declared of the fields of a class; without a name where no file has it."""
    found: list[Key] = []
    for one in fields(cls):
        declared: Key | None = one.metadata.get(_KEY)
        if declared is not None:
            name = declared.name if declared.inside else declared.name or one.name
            found.append(replace(declared, name=name, field=one.name))
    return tuple(found)


@cache
def _checked(cls: type[Frozen]) -> tuple[tuple[str, Kind, Any], ...]:
    """Fields of a class with what they have to be, and their defaults."""
    return tuple((one.field, one.kind, one.default) for one in _declarations(cls))


# -- values of an object ---------------------------------------------------------------------------


def wrong_values(where: str, value: Any) -> Iterator[ModelError]:
    """Complain of every number below a value that is not finite, of no usual size, or beyond its
    limits, and of every text that is none of those that there are.
    """
    leaves = list(_leaves(where, value, None))
    for place, leaf, _ in leaves:
        if isinstance(leaf, str):
            continue
        if not isfinite(leaf):
            yield ModelError(place, f"got {leaf}; give a finite number")
        elif abs(leaf) > HUGE or 0 < abs(leaf) < TINY:
            yield ModelError(place, f"got {leaf:g} in SI units, which no machine can have")
    for place, leaf, one in leaves:
        if one is None:
            continue
        names = getattr(innermost(one.kind), "names", ())
        if names and leaf not in names:
            yield ModelError(place, f"got {leaf!r}; give {choice(names)}")
        elif not isinstance(leaf, str) and not one.allows(leaf):
            yield ModelError(place, f"got {leaf:g}{one.unit}; {one.right(leaf)}")


def _leaves(where: str, value: Any, of: Key | None) -> Iterator[tuple[str, Any, Key | None]]:
    """Numbers and texts below a value, each with its place and its declaration."""
    if isinstance(value, bool) or value is None:
        return
    if isinstance(value, int | float | str):
        if not (of is not None and of.endless and value == inf):
            yield where, value, of
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from _leaves(f"{where}.{name}".lstrip("."), item, of)
    elif isinstance(value, tuple | list):
        one = of is not None and isinstance(of.kind, OneOr | Planes)
        alike = one and all(item == value[0] for item in value)
        planes = of is not None and isinstance(of.kind, Planes) and len(value) == len(PLANES)
        for number, item in enumerate(value, 1):
            part = f".{PLANES[number - 1]}" if planes else f"[{number}]"
            yield from _leaves(where if alike else where + part, item, of)
    else:
        for one in _declarations(type(value)):
            flat = isinstance(one.kind, Table) and one.kind.flat
            place = where if flat else f"{where}.{one.name or one.field}".lstrip(".")
            yield from _leaves(place, getattr(value, one.field), one)
