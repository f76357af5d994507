"""Putting other numbers in their places in the content of a model file, which stays as it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from numbers import Real
from typing import Any

from equipoise.errors import ModelError
from equipoise.schema.finding import Content, Found
from equipoise.schema.numbers import POLAR, XYZ, Planes, Vector
from equipoise.schema.schema_keys import Place

Given = tuple[str, Found, float]
"""Path of a number, where it stands, and what is to stand there."""


def replaced(content: Content, given: Iterable[Given]) -> dict[str, Any]:
    """The content with other numbers.

    Raises
    ------
    ModelError : a value is none, or two paths mean the same number; `where` is the path.
    """
    changes: dict[Place, Any] = {}
    parts: dict[Place, dict[str, float]] = {}
    wholes: dict[Place, Vector | Planes] = {}
    for path, found, value in given:
        if isinstance(value, bool) or not isinstance(value, Real):
            raise ModelError(path, f"got {value!r}; give a number")
        beside = parts.setdefault(found.place, {})
        _check_company(path, found, beside, found.place in changes)
        if found.whole is not None:
            beside[found.part] = value
            wholes[found.place] = found.whole
        elif found.number is not None:
            changes[found.place] = found.number.written(value)
    changes |= {place: whole.changed(parts[place]) for place, whole in wholes.items()}
    return with_changes(content, changes)


def _check_company(path: str, found: Found, beside: Mapping[str, float], taken: bool) -> None:
    """Refuse a number that others have changed already."""
    if taken or found.part in beside or (beside and not found.part):
        raise ModelError(path, f"{path} is a number that varies already; leave one of them out")
    forms = {key in POLAR for key in (found.part, *beside)}
    if isinstance(found.whole, Vector) and len(forms) == 2:
        above = path.rpartition(".")[0]
        raise ModelError(
            path,
            f"{path} cannot vary beside {above}.{next(iter(beside))}; let either "
            f"{' and '.join(XYZ[:2])} or {' and '.join(POLAR)} of a point vary",
        )


def with_changes(content: Content, changes: Mapping[Place, Any]) -> dict[str, Any]:
    """The content with other values at some places; what is not changed is shared, not copied."""
    root = dict(content)
    copied: dict[Place, Any] = {(): root}
    for place, value in changes.items():
        here: Any = root
        for length, key in enumerate(place[:-1], 1):
            if place[:length] not in copied:
                here[key] = copied[place[:length]] = here[key].copy()
            here = here[key]
        here[place[-1]] = value
    return root
