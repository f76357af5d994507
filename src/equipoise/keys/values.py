"""Values of objects whose keys are declared: what is wrong with them, and access by path."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite
from typing import Any, TypeVar

from equipoise.errors import ModelError
from equipoise.keys.declaring import Frozen, Key, declarations, keys_of
from equipoise.keys.kinds import PLANES, OneOr, Planes, Quantity, Table, choice, innermost
from equipoise.quantities import HUGE, TINY

Value = TypeVar("Value")
XYZ = ("x", "y", "z")

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
            text = f"{leaf:g} in SI units"
            yield ModelError(place, f"got {text}, which no machine can have").about(leaf, text)
    for place, leaf, one in leaves:
        if one is None:
            continue
        names = getattr(innermost(one.kind), "names", ())
        if names and leaf not in names:
            yield ModelError(place, f"got {leaf!r}; give {choice(names)}")
        elif not isinstance(leaf, str) and not one.allows(leaf):
            text = f"{leaf:g}{one.unit}"
            yield ModelError(place, f"got {text}; {one.right(leaf)}").about(leaf, text)


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
        several = of is not None and isinstance(of.kind, OneOr | Planes)
        alike = several and all(item == value[0] for item in value)
        planes = of is not None and isinstance(of.kind, Planes) and len(value) == len(PLANES)
        for number, item in enumerate(value, 1):
            part = f".{PLANES[number - 1]}" if planes else f"[{number}]"
            yield from _leaves(where if alike else where + part, item, of)
    else:
        for one in declarations(type(value)):
            flat = isinstance(one.kind, Table) and one.kind.flat
            place = where if flat else f"{where}.{one.name or one.field}".lstrip(".")
            yield from _leaves(place, getattr(value, one.field), one)


# -- by path ---------------------------------------------------------------------------------------


def quantities_of(value: Frozen) -> Mapping[str, Key]:
    """Keys of an object that are one quantity each, by name."""
    found = keys_of(type(value)).items()
    return {name: one for name, one in found if isinstance(one.kind, Quantity) and one.field}


def changed(
    value: Any,
    steps: Sequence[str],
    change: Callable[[Any], Any],
    make: Callable[..., Any] = replace,
) -> Any:
    """An object with something else at a place.

    steps : keys of the file and names; of lists the number from 1, of points ``x``, ``y`` or ``z``.
    change : from what is there to what is to be there.  make : as `dataclasses.replace`.

    Raises
    ------
    KeyError, IndexError : there is no such place.
    """
    if not steps:
        return change(value)
    step, rest = steps[0], steps[1:]
    if isinstance(value, tuple):
        index = XYZ.index(step) if step in XYZ else int(step) - 1
        inner = changed(value[index], rest, change, make)
        return (*value[:index], inner, *value[index + 1 :])
    if isinstance(value, Mapping):
        return {**value, step: changed(value[step], rest, change, make)}
    one = keys_of(type(value))[step]
    held = getattr(value, one.field)
    if isinstance(one.kind, Table) and not isinstance(held, Frozen):
        rest = rest[1:]  # a table with one key, which the object has without it
    return make(value, **{one.field: changed(held, rest, change, make)})
