"""Checks of the numbers and texts of a value against what is declared of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, isfinite
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys.declaring import MEMORY, Frozen, Key, declarations, once
from equipoise.keys.kinds import PLANES, KeyTable, OneOr, Planes, choice, innermost
from equipoise.quantities import HUGE, TINY, Measured


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
