"""Declaring keys: fields of frozen dataclasses, what each is in its file, checks of values.

`wrong_values` checks the numbers and texts of a value against what is declared of them; `needs`,
`lacks` and the others say in JSON Schema which keys of a table go together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, fields, replace
from functools import cache, cached_property
from math import inf, isfinite
from types import MappingProxyType
from typing import Any, ClassVar, Literal, NamedTuple, Self, TypeVar, dataclass_transform

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.guarding import keyworded
from equipoise.i18n import Note
from equipoise.keys.kinds import (
    PLANES,
    DependentQuantity,
    KeyTable,
    Kind,
    Listing,
    Number,
    OneOr,
    Planes,
    Quantity,
    TableRecord,
    Tables,
    Whole,
    choice,
    innermost,
)
from equipoise.quantities import HUGE, TINY, Dimension, Measured, pattern

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
KeyConditions = Mapping[str, Any]


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


MenuSource = Literal["link", "point", "moving_point", "ends", "line", "place"]
"""What a menu is opened at: a link; a joint by its name, the same where it is not pinned to the
frame, or as the only one of a list; two points of a link; a place of the drawing.
"""


class MenuItem(NamedTuple):
    """What menus of a drawing offer, to add a table where they are opened.

    label : of it, in English.  values : what some of its keys begin with, by name; of several the
        first whose sources are all there, and it is not offered where there is none.
    """

    label: str
    values: tuple[Mapping[str, MenuSource], ...]


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
    menu_item : by which menus of a drawing offer to add one; None where only a form does.
    """

    extra_keys: ClassVar[Keys] = {}
    handed_on: ClassVar[frozenset[str]] = frozenset()
    file_order: ClassVar[tuple[str, ...]] = ()
    conditions: ClassVar[KeyConditions] = {}
    called: ClassVar[str] = ""
    menu_item: ClassVar[MenuItem | None] = None
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


# -- which keys go together, in JSON Schema --------------------------------------------------------


def needs(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has all of these keys."""
    return {"required": [*keys]}


def lacks(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has none of these keys."""
    return {"properties": dict.fromkeys(keys, False)}


def any_of(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has one of these keys."""
    return {"anyOf": [needs(key) for key in keys]}


def not_both(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that lacks one of these keys."""
    return {"not": needs(*keys)}


def schema_by_dimension(
    name: str, sizes: Sequence[str], dimensions: Mapping[str, Dimension]
) -> dict[str, Any]:
    """JSON Schema of a table in which the key `name` decides the dimension of `sizes`."""
    cases = []
    for dimension in dict.fromkeys(dimensions.values()):
        names = [item for item, own in dimensions.items() if own == dimension]
        cases.append(
            {
                "if": {"properties": {name: {"enum": names}}, "required": [name]},
                "then": {"properties": {size: {"pattern": pattern(dimension)} for size in sizes}},
            }
        )
    return {"allOf": cases}


# -- checks of values ------------------------------------------------------------------------------


def wrong_values(where: str, value: Any) -> Iterator[ModelError]:
    """Complain of every number below a value that is not finite, of no usual size, or beyond its
    limits, and of every text that is none of those that there are.
    """
    if _is_sound(value):
        return
    leaves = list(_leaves(where, value, None))
    for place, leaf, _ in leaves:
        if isinstance(leaf, str):
            continue
        if not isfinite(leaf):
            yield ModelError(place, Note("got {leaf}; give a finite number", leaf=leaf))
        elif abs(leaf) > HUGE or 0 < abs(leaf) < TINY:
            size = Note("{size} in SI units", size=f"{leaf:g}")
            yield ModelError(place, Note("got {text}, which no machine can have", text=size))
    for place, leaf, item in leaves:
        names = () if item is None else _names(item)
        if names and leaf not in names:
            note = Note("got {leaf!r}; give {choice}", leaf=leaf, choice=choice(names))
            yield ModelError(place, note)
        elif item is not None and not isinstance(leaf, str) and not item.allows(leaf):
            given = Measured(leaf, item.dimension)
            yield ModelError(place, Note("got {text}; {right}", text=given, right=item.right(leaf)))


def _leaves(where: str, value: Any, of: Key | None) -> Iterator[tuple[str, Any, Key | None]]:
    """Numbers and texts below a value, each with its place and its declaration."""
    if isinstance(value, bool) or value is None:
        return
    if isinstance(value, int | float | str):
        if of is None or not of.endless or value != inf:
            yield where, value, of
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from _leaves(f"{where}.{name}".lstrip("."), item, of)
    elif isinstance(value, tuple | list):
        several = of is not None and isinstance(of.kind, OneOr | Planes)
        alike = several and all(item == value[0] for item in value)
        planes = of is not None and isinstance(of.kind, Planes) and len(value) == len(PLANES)
        for number, item in enumerate(value, 1):
            part = f".{PLANES[number - 1]}" if planes else f"[{number}]"
            yield from _leaves(where if alike else where + part, item, of)
    else:
        for declaration in declarations(type(value)):
            flat = isinstance(declaration.kind, KeyTable) and declaration.kind.flat
            place = (
                where if flat else f"{where}.{declaration.name or declaration.field}".lstrip(".")
            )
            yield from _leaves(place, getattr(value, declaration.field), declaration)


def _names(key: Key) -> tuple[Any, ...]:
    """The only values that there are of a key, if they have names."""
    names: tuple[Any, ...] = getattr(innermost(key.kind), "names", ())
    return names


@once
def _limits(cls: type[Frozen]) -> tuple[tuple[str, Key, tuple[Any, ...]], ...]:
    """Fields of a class, each with its declaration and its names."""
    return tuple(
        (declaration.field, declaration, _names(declaration)) for declaration in declarations(cls)
    )


def _is_sound(value: Any, of: Key | None = None, names: tuple[Any, ...] = ()) -> bool:
    """Whether there is nothing to complain of in a value."""
    if value is None or isinstance(value, bool):
        return True
    if isinstance(value, str):
        return not names or value in names
    if isinstance(value, int | float):
        return _is_usual(value, of) and (not names or value in names)
    if isinstance(value, tuple | list | Mapping):
        items = value.values() if isinstance(value, Mapping) else value
        return all(_is_sound(item, of, names) for item in items)
    return _parts_are_sound(value, finished=of is not None)


def _is_usual(value: float, of: Key | None) -> bool:
    """Whether a number is of a usual size and within its limits."""
    if value and not TINY <= abs(value) <= HUGE:  # which NaN is not either
        return of is not None and of.endless and value == inf
    return of is None or bool(of.allows(value))


def _parts_are_sound(value: Any, finished: bool) -> bool:
    """Whether an object's fields are; one that is finished is looked at once, whoever has it."""
    values = vars(value)
    if "sound" in values.get(MEMORY, {}):
        return bool(value.memory["sound"])
    sound = all(_is_sound(values[name], item, names) for name, item, names in _limits(type(value)))
    if finished:
        value.memory["sound"] = sound
    return sound
