"""Declaring keys: fields of frozen dataclasses, what each is in its file, and checks of values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, fields, replace
from functools import cache, cached_property
from types import MappingProxyType
from typing import Any, ClassVar, Self, TypeVar, dataclass_transform

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.guarding import keyworded
from equipoise.i18n import Note
from equipoise.keys.base import Kind, TableRecord
from equipoise.keys.kinds import (
    DependentQuantity,
    KeyTable,
    Listing,
    Number,
    Quantity,
    Tables,
    Whole,
    innermost,
)
from equipoise.quantities import Dimension

GivenT = TypeVar("GivenT")
Class = TypeVar("Class", bound=type)
ResultT = TypeVar("ResultT")

# -- declaring -------------------------------------------------------------------------------------

XYZ = ("x", "y", "z")
REQUIRED = object()
"""Default of a key that has to be given."""
_KEY = "equipoise key"
MEMORY = "memory"
"""Of `Frozen`, which copies do not share."""


@dataclass(frozen=True, eq=False)
class Key:
    """A key of a file.

    name : in the file.  field : of the class, the same where nothing else is said.
    text : what it means, in words that go on after its name.
    example : as it would stand in the file.  default : in Python; `shown` instead, if
        documentation states it better.
    at_least, above, below : limits in SI units; `why` is said instead of words made of them.
    endless : it may be infinite, for no limit.  inside : no file has it.
    word : what its number is called, the name of the key in words where not given.
    """

    name: str
    kind: Kind
    text: str = ""
    field: str = ""
    example: Any = None
    default: Any = REQUIRED
    written_default: Any = None
    at_least: float | None = None
    above: float | None = None
    below: float | None = None
    why: Note | str = ""
    endless: bool = False
    inside: bool = False
    word: str = ""

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
    def dimension(self) -> Dimension | None:
        """What the number of this key is, or each of its numbers; None without a unit."""
        kind = innermost(self.kind)
        return kind.dimension if isinstance(kind, Quantity) else None

    def right(self, value: float) -> Note | str:
        """What to give instead of a number beyond the limits."""
        if self.why:
            return self.why
        if self.below is not None and value >= self.below:
            return Note("give less than {limit:g}", limit=self.below)
        if self.above is not None:
            return Note("give more than {limit:g}", limit=self.above)
        return Note("give {limit:g} or more", limit=self.at_least)


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
    kw_only: bool = False,
    **options: Any,
) -> Any:
    """Declare a field that is a key of the file; `kind` may be the dimension of a quantity.

    The other parameters are those of `Key`; `factory`, `compare`, `kw_only` as of a dataclass.
    """
    kind = Quantity(dimension=kind) if isinstance(kind, str) else kind  # type: ignore[arg-type]
    standing = factory() if factory is not None else default
    declaration = Key(name, kind, text, default=standing, **options)
    given: dict[str, Any] = {} if default is REQUIRED else {"default": default}
    if factory is not None:
        given = {"default_factory": factory}
    return field(metadata={_KEY: declaration}, compare=compare, kw_only=kw_only, **given)


def inside(kind: Kind | str, **options: Any) -> Any:
    """Declare a field that no file has a key for; it is checked all the same, as of `key`."""
    return key(kind, inside=True, **options)


@dataclass_transform(frozen_default=True, field_specifiers=(key, inside, field))
def declared(cls: Class) -> Class:
    """Make a frozen dataclass of a class with keys."""
    declared_class: Class = keyworded(dataclass(frozen=True)(cls))
    return declared_class


def once(compute: Callable[[type[Frozen]], ResultT]) -> Callable[[type[Frozen]], ResultT]:
    """Compute something of each class when it is first asked for."""
    return cache(compute)  # type: ignore[return-value]


class Frozen(TableRecord):
    """Base of the frozen dataclasses of a model: numbers as floats, lists as tuples, mappings
    read-only, each checked by its kind when the object is made.  A quantity may be given as the
    text that a file has, such as ``"300 rpm"``.

    extra_keys : keys of the file without a field, by name; `from_table` and `to_table` translate.
    handed_on : names in `memory` that hold for copies with other numbers too.
    file_order : names of keys in the order of the file, where it is not that of the fields.
    conditions : what the JSON Schema says of keys that go together.
    called : what a number of such an object is called, around the word of its key in ``{what}``,
        with ``{name}`` or ``{number}`` of the object, or one of its texts.
    """

    extra_keys: ClassVar[Keys] = {}
    handed_on: ClassVar[frozenset[str]] = frozenset()
    file_order: ClassVar[tuple[str, ...]] = ()
    conditions: ClassVar[Conditions] = {}
    called: ClassVar[str] = ""
    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __post_init__(self) -> None:
        for declaration in declarations(type(self)):
            value = getattr(self, declaration.field)
            if value is declaration.default and value in (
                None,
                (),
            ):  # there is one empty tuple only
                continue
            try:
                object.__setattr__(self, declaration.field, declaration.kind.check(value))
            except (TypeError, ValueError, OverflowError):
                text = repr(value)
                given = text if len(text) <= 60 else f"{text[:57]}..."
                raise ModelError(
                    declaration.field,
                    Note("got {given}; give {wanted}", given=given, wanted=declaration.kind.wanted),
                ) from None
            except UsageError as error:
                raise ModelError(declaration.field, error.note) from None

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
        given = ((item, getattr(value, item.field)) for item in keys_of(cls).values() if item.field)
        return {
            entry.name: item for entry, item in given if entry.required or item != entry.default
        }

    def following(self, changes: dict[str, Any]) -> dict[str, Any]:
        """Changes of fields, with what they do to other fields that follow from them."""
        return changes

    def dependent_fields(self) -> dict[str, Any]:
        """Fields that follow from others, of which columns may be some; nothing is checked."""
        return {}

    @cached_property
    def memory(self) -> dict[str, Any]:
        """What was computed of the value elsewhere and takes time, by name; no part of it."""
        return {}

    def altered(self, **changes: Any) -> Self:
        """Copy with other fields, and with what follows from them."""
        return replace(self, **self.following(changes))

    def __getstate__(self) -> dict[str, Any]:
        return {
            key: dict(value) if isinstance(value, MappingProxyType) else value
            for key, value in self.__dict__.items()
            if not key.startswith("_") and key not in cached_names(type(self))
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        for key, value in state.items():
            readonly = MappingProxyType(value) if isinstance(value, dict) else value
            object.__setattr__(self, key, readonly)


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


@once
def keys_of(cls: type[Frozen]) -> Mapping[str, Key]:
    """Keys of a class in the order of the file, by name; a flat table is one of them."""
    own = {declaration.name: declaration for declaration in declarations(cls) if declaration.name}
    value = {name: replace(item, name=name) for name, item in cls.extra_keys.items()} | own
    return {name: value[name] for name in dict.fromkeys((*cls.file_order, *own, *cls.extra_keys))}


@once
def listed_types(cls: type[Frozen]) -> Mapping[str, type[Frozen]]:
    """Classes of the lists of tables that a class has, by field, in the order of the file."""
    lists = {item.field: item.kind for item in keys_of(cls).values()}
    return {field: kind.item.type for field, kind in lists.items() if isinstance(kind, Tables)}


@once
def all_keys(cls: type[Frozen]) -> Mapping[str, Key]:
    """Keys that stand in the table of a class, by name, with those of flat ones in their places."""
    keys: dict[str, Key] = {}
    for item in keys_of(cls).values():
        kind = item.kind
        if isinstance(kind, KeyTable) and kind.flat:
            inner = all_keys(kind.type).items()
            keys |= {name: own for name, own in inner if name not in kind.without}
        else:
            keys[item.name] = item
    return keys


@once
def declarations(cls: type[Frozen]) -> tuple[Key, ...]:
    """What is declared of the fields of a class; without a name where no file has it."""
    values = [(item.name, item.metadata[_KEY]) for item in fields(cls) if _KEY in item.metadata]
    return tuple(
        replace(item, field=field, name=item.name or ("" if item.inside else field))
        for field, item in values
    )


# -- by path ---------------------------------------------------------------------------------------


def quantities_of(value: Frozen | type[Frozen]) -> Mapping[str, Key]:
    """Keys of an object or a class that are one quantity each, by name."""
    keys = keys_of(value if isinstance(value, type) else type(value)).items()
    return {name: item for name, item in keys if isinstance(item.kind, Quantity) and item.field}


def numbers_of(value: Frozen | type[Frozen]) -> Mapping[str, Key]:
    """Keys of an object or a class that are one number each, by name: quantities, and numbers
    without a unit such as a coefficient of friction.
    """
    keys = keys_of(value if isinstance(value, type) else type(value)).items()
    numbers = {name: item for name, item in keys if isinstance(item.kind, Number) and item.field}
    # The dimension of a number that depends on another key, such as a limit, is not known here.
    return {
        name: number
        for name, number in numbers.items()
        if not isinstance(number.kind, DependentQuantity)
    }


def changed(
    value: Any,
    steps: Sequence[str | int],
    change: Callable[[Any], Any],
    make: Callable[..., Any] = replace,
) -> Any:
    """An object with something else at a place.

    steps : keys of the file, names, and numbers in lists, such as a `KeyPath`; of points ``x``,
        ``y`` or ``z``.
    change : from what is there to what is to be there.  make : as `dataclasses.replace`.

    Raises
    ------
    KeyError, IndexError : there is no such place.
    """
    if not steps:
        return change(value)
    step, rest = steps[0], steps[1:]
    if isinstance(value, tuple):
        index = step if isinstance(step, int) else _coordinate(step)
        inner = changed(value[index], rest, change, make)
        return (*value[:index], inner, *value[index + 1 :])
    if isinstance(value, Mapping):
        return {**value, step: changed(value[step], rest, change, make)}
    item = keys_of(type(value))[str(step)]
    old_value = getattr(value, item.field)
    if isinstance(item.kind, KeyTable) and not isinstance(old_value, Frozen):
        rest = rest[1:]  # a table with one key, which the object has without it
    new = {item.field: changed(old_value, rest, change, make)}
    return make(value, **value.following(new))


def _coordinate(step: str) -> int:
    if step not in XYZ:
        raise KeyError(step)
    return XYZ.index(step)


def with_fields(value: GivenT, **changes: Any) -> GivenT:
    """A frozen value with fields changed, unchecked; what was kept with it is left behind."""
    result = object.__new__(type(value))
    left = cached_names(type(value))
    values = {k: v for k, v in vars(value).items() if not k.startswith("_") and k not in left}
    _set(result, values | changes)
    if isinstance(value, Frozen) and isinstance(result, Frozen):
        _set(result, result.dependent_fields())
        if shared := value.handed_on & vars(value).get(MEMORY, {}).keys():
            result.memory.update((name, value.memory[name]) for name in shared)
    return result


def cached_names(cls: type[Any]) -> frozenset[str]:
    """Names of the cached properties of a class, `memory` among them."""
    # Mypy takes the hash of a class for that of its values, which frozen ones with lists have not.
    return _cached_names(cls)  # type: ignore[arg-type]


@cache
def _cached_names(cls: type[Any]) -> frozenset[str]:
    own = (name for base in cls.__mro__ for name, item in vars(base).items()
           if isinstance(item, cached_property))  # fmt: skip
    return frozenset(own)


def _set(new: Any, values: Mapping[str, Any]) -> None:
    """Give a new frozen value its fields."""
    for name, value in values.items():
        object.__setattr__(new, name, value)
