"""Declaring keys: the fields of frozen dataclasses, with what each is in its file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar, dataclass_transform

from equipoise.errors import ModelError
from equipoise.keys.kinds import Kind, Listing, Number, Quantity, Record, Table, Whole, innermost
from equipoise.quantities import SI, Dimension, pattern

Class = TypeVar("Class", bound=type)
Result = TypeVar("Result")

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
    made: Any = dataclass(frozen=True)(cls)
    result: Class = made
    return result


def once(compute: Callable[[type[Frozen]], Result]) -> Callable[[type[Frozen]], Result]:
    """Compute something of each class when it is first asked for."""
    kept: Any = cache(compute)
    found: Callable[[type[Frozen]], Result] = kept
    return found


class Frozen(Record):
    """Base of the frozen dataclasses of a model: numbers as floats, lists as tuples, mappings
    read-only, each checked by its kind when the object is made.

    beside : keys of the file that are no fields, by name; `from_table` and `to_table` translate.
    file_order : names of keys in the order of the file, where it is not that of the fields.
    conditions : what the JSON Schema says of keys that go together.
    """

    beside: ClassVar[Keys] = {}
    file_order: ClassVar[tuple[str, ...]] = ()
    conditions: ClassVar[Conditions] = {}
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


# -- what a class declares -------------------------------------------------------------------------


@once
def keys_of(cls: type[Frozen]) -> Mapping[str, Key]:
    """Keys of a class in the order of the file, by name; a flat table is one of them."""
    found = {name: replace(one, name=name) for name, one in cls.beside.items()}
    for one in declarations(cls):
        if one.name:
            found[one.name] = one
    own = [name for name in found if name not in cls.beside]
    return {name: found[name] for name in dict.fromkeys((*cls.file_order, *own, *cls.beside))}


@once
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


@once
def declarations(cls: type[Frozen]) -> tuple[Key, ...]:
    """What is declared of the fields of a class; without a name where no file has it."""
    found: list[Key] = []
    for one in fields(cls):
        declared: Key | None = one.metadata.get(_KEY)
        if declared is not None:
            name = declared.name if declared.inside else declared.name or one.name
            found.append(replace(declared, name=name, field=one.name))
    return tuple(found)


@once
def _checked(cls: type[Frozen]) -> tuple[tuple[str, Kind, Any], ...]:
    """Fields of a class with what they have to be, and their defaults."""
    return tuple((one.field, one.kind, one.default) for one in declarations(cls))
