"""What the model file can have at a place, told by its pydantic models.

A place is a tuple of keys and of numbers in lists, from 0: ``("gears", 0, "start")``.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from typing_extensions import TypeAliasType

from equipoise.schema.document import Document
from equipoise.schema.document_tool import ToolDocument
from equipoise.schema.opening import Kind

Place = tuple[str | int, ...]


def is_known(kind: Kind, place: Place) -> bool:
    """Whether the key at the end of a place is one of the model file, not a name of the user's."""
    return _field(kind, place) is not None


def default_at(kind: Kind, place: Place) -> Any:
    """What a key that is left out stands for, as it would be written; None for nothing."""
    field = _field(kind, place)
    if field is None or field.is_required():
        return None
    told = field.json_schema_extra
    return (told.get("default") if isinstance(told, dict) else None) or field.default


def is_whole(kind: Kind, place: Place) -> bool:
    """Whether only whole numbers will do there."""
    sorts = {sort for found in _at(kind, place) for sort in _leaves(found)}
    return bool(sorts) and sorts <= {int}


def _field(kind: Kind, place: Place) -> FieldInfo | None:
    *above, key = place
    for found in _at(kind, tuple(above)):
        if isinstance(found, type) and issubclass(found, BaseModel):
            return {f.alias or name: f for name, f in found.model_fields.items()}.get(str(key))
    return None


def _at(kind: Kind, place: Place) -> list[Any]:
    """Types of what stands at a place."""
    found: list[Any] = [ToolDocument if kind == "tool" else Document]
    if kind == "linkage" and place[:1] == ("balance",):
        from equipoise.schema.document_balance import Balance

        found, place = [Balance], place[1:]  # which the document reads in a second step
    for key in place:
        found = [below for one in found for below in _below(one, key)]
    return found


def _below(found: Any, key: str | int) -> Iterator[Any]:
    if isinstance(found, type) and issubclass(found, BaseModel):
        fields = found.model_fields.items()
        for field in (field for name, field in fields if (field.alias or name) == key):
            yield from _plain(field.annotation)
        return
    origin, inner = get_origin(found), get_args(found)
    if origin is dict:
        yield from _plain(inner[1])
    elif origin in (list, tuple) and isinstance(key, int):
        yield from _plain(inner[min(key, len(inner) - 1)])


def _plain(annotation: Any) -> Iterator[Any]:
    """The types that an annotation stands for, without what goes round them."""
    if isinstance(annotation, TypeAliasType):
        yield from _plain(annotation.__value__)
    elif get_origin(annotation) is Annotated:
        yield from _plain(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, UnionType):
        for one in get_args(annotation):
            yield from _plain(one)
    elif annotation is not NoneType:
        yield annotation


def _leaves(found: Any) -> Iterator[type]:
    if get_origin(found) is Literal:
        yield from map(type, get_args(found))
    else:
        yield found
