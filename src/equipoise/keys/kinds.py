"""What a value of a file can be, and how one that Python gives is checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from numbers import Integral, Real
from types import MappingProxyType
from typing import Any, ClassVar, Literal

from equipoise.dataclass import dataclass
from equipoise.i18n import LANGUAGES, Note, Worded
from equipoise.quantities import Dimension, in_si


class TableRecord:
    """What a table of a file is read to, and holds by the names of its fields."""

    wanted: ClassVar[Note] = Note("such an object")

    @classmethod
    def checked(cls, value: Any) -> Any:
        """The value of a field that holds such an object; a `TypeError` where it is none."""
        if not isinstance(value, TableRecord):
            raise TypeError
        return value


class Kind:
    """What a value is: `check` takes one that Python gives, `wanted` says what it has to be."""

    wanted: Note

    def check(self, value: Any) -> Any:
        """The value as it is kept.

        Raises
        ------
        TypeError, ValueError, OverflowError : it is something else.
        """
        return value


MOST_WHOLE = 1_000_000
NO_INERTIA = Note("no body has a negative moment of inertia")


def choice(names: Iterable[Any]) -> Note | str:
    """Say which there are: ``'a', 'b' or 'c'``."""
    *most, last = map(repr, names)
    return Note("{most} or {last}", most=", ".join(most), last=last) if most else last


@dataclass(frozen=True)
class TextKind(Kind):
    """Text; `names` are the only ones, if there are any.

    suggested : those that editors offer; what else is wrong with it is said elsewhere.
    of : what it is the name of: ``link``, ``body`` (a link or the frame), ``point``, or ``output``
        (that balancing can take).
    on : key beside it that names the body of that point, ``frame``, ``links`` for any link, or
        ``own`` for the link in whose table it stands; any body where not given.
    """

    names: tuple[str, ...] = ()
    suggested: tuple[str, ...] = ()
    of: Literal["", "link", "body", "point", "output"] = ""
    on: str = ""

    wanted = Note("text")

    def check(self, value: Any) -> str:
        if not isinstance(value, str):
            raise TypeError
        return value


@dataclass(frozen=True)
class Wording(TextKind):
    """Text for readers: one for all of them, or one for each of some languages."""

    def check(self, value: Any) -> str:
        if not isinstance(value, Mapping):
            return super().check(value)
        if not value or not value.keys() <= LANGUAGES.keys() or not all(value.values()):
            raise ValueError
        return Worded({code: super(Wording, self).check(item) for code, item in value.items()})


@dataclass(frozen=True)
class Number(Kind):
    """A plain number."""

    wanted = Note("a number")

    def check(self, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, Real):
            raise TypeError
        return float(value)


@dataclass(frozen=True)
class Quantity(Number):
    """A number with a unit in the file, in SI units in Python, where the text of a file will do."""

    dimension: Dimension = "length"

    def check(self, value: Any) -> float:
        return super().check(in_si(value, self.dimension))


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number; `names` are the only ones, if there are any."""

    least: int | None = None
    most: int = MOST_WHOLE
    names: tuple[int, ...] = ()

    wanted = Note("a whole number of at most {most_whole}", most_whole=MOST_WHOLE)

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

    wanted = Note("true or false")

    def check(self, value: Any) -> bool:
        if not isinstance(value, bool):
            raise TypeError
        return value


@dataclass(frozen=True)
class ParameterValue(Kind):
    """A quantity of any dimension, a plain number, or an expression, as it is written."""

    wanted = Note("text such as '33.5 mm', or a number")

    def check(self, value: Any) -> str | float:
        if isinstance(value, bool) or not isinstance(value, str | Real):
            raise TypeError
        return value if isinstance(value, str) else float(value)


@dataclass(frozen=True)
class Anything(Kind):
    """A value that another key has to be known to read; it comes through as it is.

    schema : what the JSON Schema says of it.
    """

    schema: Any = None


_IN_QUOTES = Note("give number and unit in quotes")


@dataclass(frozen=True)
class DependentQuantity(Number):
    """A number whose dimension depends on another key; `Frozen.from_table` reads its text.

    right : what to give where no text is given.  schema : what the JSON Schema says of it.
    """

    right: Note = _IN_QUOTES
    schema: Any = None


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
    right: Note | None = None

    @property
    def wanted(self) -> Note:  # type: ignore[override]
        if isinstance(self.item, TextKind):
            return Note("a list of texts")
        if isinstance(self.item, Listing | Point):
            return Note("two points of two numbers each") if self.sizes else Note("rows of numbers")
        if self.sizes == (2,):
            whole = Note("two whole numbers of at most {most_whole}", most_whole=MOST_WHOLE)
            return whole if isinstance(self.item, Whole) else Note("two numbers")
        return Note("numbers")

    def check(self, value: Any) -> tuple[Any, ...]:
        items = tuple(map(self.item.check, items_of(value)))
        if self.sizes == (2,) and len(items) != 2 and not self.right:
            raise ValueError
        return items


@dataclass(frozen=True)
class Point(Kind):
    """Two lengths along x and y, in a file by distance and direction too.

    space : with a third length along z, which may be left out.
    named : or the name of a point of the body that it lies on.
    axes : key beside it that names the link in whose axes it is; where not given, they are those of
        the link that has its table, or the frame's.
    """

    space: bool = False
    named: bool = False
    axes: str = ""

    @property
    def wanted(self) -> Note:  # type: ignore[override]
        words = Note("two or three numbers") if self.space else Note("two numbers")
        return Note("the name of a point, or {numbers}", numbers=words) if self.named else words

    def check(self, value: Any) -> Any:
        if self.named and isinstance(value, str):
            return value
        row = tuple(map(Quantity(dimension="length").check, items_of(value)))
        row = (*row, 0.0) if self.space and len(row) == 2 else row
        if len(row) != (3 if self.space else 2):
            raise ValueError
        return row


@dataclass(frozen=True)
class DirectionKind(Kind):
    """An angle in the plane of the drawing, or a vector of three plain numbers."""

    wanted = Note("an angle, or three numbers")

    def check(self, value: Any) -> float | tuple[float, ...]:
        if isinstance(value, Real | str):
            return Quantity(dimension="angle").check(value)
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
    right: Note | None = None

    @property
    def wanted(self) -> Note:  # type: ignore[override]
        return Note("two numbers") if self.repeat else Note("numbers")

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
    def wanted(self) -> Note:  # type: ignore[override]
        return (
            Note("two numbers")
            if isinstance(self.item, Quantity)
            else Note("a list of such objects")
        )

    def check(self, value: Any) -> tuple[Any, ...]:
        items = tuple(map(self.item.check, items_of(value)))
        if isinstance(self.item, Quantity) and len(items) != 2:
            raise ValueError
        return items


@dataclass(frozen=True)
class Named(Kind):
    """Some of a kind by names that the user chooses.

    listed : or a list of the names alone, where other keys have the rest.
    by : what the names are of, where they are of something that is there.
    """

    item: Kind
    listed: bool = False
    by: TextKind = TextKind()

    @property
    def wanted(self) -> Note:  # type: ignore[override]
        of = {Point: Note("two numbers"), TextKind: Note("text"), KeyTable: Note("such objects")}
        values = of.get(type(self.item), Note("numbers"))
        return Note("a mapping of names to {values}", values=values)

    def check(self, value: Any) -> Any:
        if self.listed and isinstance(value, tuple | list):
            return tuple(map(TextKind().check, value))
        if not isinstance(value, Mapping):
            raise TypeError
        name, item = TextKind().check, self.item.check
        return MappingProxyType({name(key): item(entry) for key, entry in value.items()})


@dataclass(frozen=True)
class KeyTable(Kind):
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
    def wanted(self) -> Note:  # type: ignore[override]
        wanted: Note = self.type.wanted
        return wanted

    @property
    def type(self) -> Any:
        """The class, a `Frozen`."""
        if isinstance(self.of, str):
            module, _, name = self.of.partition(":")
            return getattr(import_module(module), name)
        return self.of

    def check(self, value: Any) -> Any:
        return self.type.checked(value)


@dataclass(frozen=True)
class Tables(Kind):
    """Any number of such tables."""

    item: KeyTable
    wanted = Note("a list of such objects")

    def check(self, value: Any) -> tuple[Any, ...]:
        return tuple(map(self.item.check, value))


@dataclass(frozen=True)
class File(Kind):
    """What lies in a file of its own, which the key names.

    sort : what it is, such as ``load``.  named : field that keeps the file's name.
    """

    sort: str
    named: str = ""
    wanted = Note("such an object")

    def check(self, value: Any) -> Any:
        return TableRecord.checked(value)


def innermost(kind: Kind) -> Kind:
    """What lists, and mappings of names, consist of."""
    while isinstance(kind, Listing | Named | OneOr | Planes):
        kind = kind.item
    return kind
