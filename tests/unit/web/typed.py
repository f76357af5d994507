"""Whether messages hold to the types of `equipoise.web.protocol`, which the page relies on."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, is_typeddict

from equipoise.web.protocol import OPEN, Sent

PAGE = Path(__file__).resolve().parents[3] / "page"


@cache
def writer() -> ModuleType:
    """The script that writes the types."""
    spec = importlib.util.spec_from_file_location("page_messages", PAGE / "messages.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def declared_keys(of: Any) -> dict[str, tuple[Any, bool]]:
    """Type of each key of an object, and whether it has to be there."""
    return {name: (item, required) for name, item, _, required in writer().fields(of)}


@cache
def sent() -> dict[str, Any]:
    """Class of the messages of each ``type`` that a server sends."""
    return {
        kind: item for item in get_args(Sent) for kind in get_args(declared_keys(item)["type"][0])
    }


def misfits_of_reply(content: Any) -> list[str]:
    """Places at which what is sent does not hold to its type."""
    return [*misfits(content, sent()[content["type"]], content["type"])]


def misfits(value: Any, hint: Any, place: str = "") -> Iterator[str]:
    """Places at which a value of JSON is not of a type."""
    origin, inner = get_origin(hint), get_args(hint)
    if hint is Any:
        return
    if origin is Annotated:
        yield from misfits(value, inner[0], place)
    elif origin in (Union, UnionType):
        yield from min(([*misfits(value, item, place)] for item in inner), key=len)
    elif origin is Literal:
        yield from [] if value in inner else [f"{place}: {value!r}"]
    elif not isinstance(value, kind_of(hint)) or (isinstance(value, bool) and hint is not bool):
        yield f"{place}: {value!r}"
    elif is_typeddict(hint):
        yield from misfits_of_keys(value, hint, place)
    elif origin is tuple and len(value) != len(inner):
        yield f"{place}: not {len(inner)} values"
    elif origin in (tuple, list):
        hints = inner if origin is tuple else inner * len(value)
        yield from misfits_of_parts(value, hints, place)
    elif origin is dict:
        for name, part in value.items():
            yield from misfits(part, inner[1], f"{place}.{name}")


def misfits_of_parts(value: Any, hints: tuple[Any, ...], place: str) -> Iterator[str]:
    """Places in an array of JSON whose values are not of their types."""
    if {*hints} == {float} and {*map(type, value)} <= {float, int}:  # a curve, at once
        return
    for number, (part, item) in enumerate(zip(value, hints, strict=True)):
        yield from misfits(part, item, f"{place}[{number}]")


def kind_of(hint: Any) -> Any:
    """Class of the values that JSON gives for a type."""
    if is_typeddict(hint):
        return dict
    kinds = {tuple: list, float: (int, float)}
    origin = get_origin(hint) or hint
    return kinds.get(origin, origin)


def misfits_of_keys(value: Any, of: Any, place: str) -> Iterator[str]:
    """Keys of an object that are missing, not declared, or of another type."""
    declared = declared_keys(of)
    if of not in OPEN:
        yield from (f"{place}.{name}: not declared" for name in value if name not in declared)
    for name, (item, required) in declared.items():
        if name in value:
            yield from misfits(value[name], item, f"{place}.{name}")
        elif required:
            yield f"{place}.{name}: missing"
