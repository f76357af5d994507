"""Values that cannot be changed: numbers as floats, lists as tuples, mappings read-only."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from numbers import Integral, Real
from types import MappingProxyType
from typing import Any, ClassVar

from equipoise.errors import ModelError


class Frozen:
    """Base of the frozen dataclasses of a model.

    shapes : field -> what it has to be, with a question mark where it may be None: ``text``,
        ``number``, ``pair`` (of numbers), ``segment`` (two pairs), ``count`` (a whole number),
        ``counts`` (two of them), ``flag`` (true or false), ``place`` (two or three numbers),
        ``direction`` (an angle or three numbers), ``row`` and ``rows`` of numbers, ``names`` (a
        list of texts), ``list``; ``pairs``, ``numbers``, ``texts`` and ``values`` are mappings of
        such.
    flat : fields whose own values stand beside the others in the model file, not in a table below.
    endless : numbers that may be infinite, for no limit.
    """

    shapes: ClassVar[dict[str, str]]
    flat: ClassVar[tuple[str, ...]] = ()
    endless: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        for name, shape in self.shapes.items():
            value = getattr(self, name)
            if value is None and shape.endswith("?"):
                continue
            read, wanted = SHAPES[shape.rstrip("?")]
            try:
                object.__setattr__(self, name, read(value))
            except (TypeError, ValueError, OverflowError):
                raise ModelError(name, f"got {_shown(value)}; give {wanted}") from None

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


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError
    return float(value)


def _count(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError
    count = int(value)
    if abs(count) > MOST_TEETH:
        raise ValueError
    return count


def _two(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def pair(value: Any) -> tuple[Any, Any]:
        if isinstance(value, str | Mapping):
            raise TypeError
        first, second = value
        return read(first), read(second)

    return pair


def _row(value: Any) -> tuple[float, ...]:
    return tuple(map(_number, value))


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _three(value: Any) -> tuple[float, ...]:
    if isinstance(value, str | Mapping) or len(row := _row(value)) != 3:
        raise TypeError
    return row


def _place(value: Any) -> tuple[float, ...]:
    """A place in space; of two coordinates, in the plane of the drawing."""
    if isinstance(value, str | Mapping):
        raise TypeError
    row = _row(value)
    return _three((*row, 0.0) if len(row) == 2 else row)


def _direction(value: Any) -> float | tuple[float, ...]:
    return _number(value) if isinstance(value, Real) else _three(value)


def _names(value: Any) -> tuple[str, ...]:
    if isinstance(value, str | Mapping):
        raise TypeError
    return tuple(map(_text, value))


def _each(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def mapping(value: Any) -> Mapping[str, Any]:
        if not isinstance(value, Mapping):
            raise TypeError
        return MappingProxyType({_text(key): read(item) for key, item in value.items()})

    return mapping


def _frozen(value: Any) -> Frozen:
    if not isinstance(value, Frozen):
        raise TypeError
    return value


MOST_TEETH = 1_000_000
_pair = _two(_number)

SHAPES: dict[str, tuple[Callable[[Any], Any], str]] = {
    "text": (_text, "text"),
    "number": (_number, "a number"),
    "pair": (_pair, "two numbers"),
    "segment": (_two(_pair), "two points of two numbers each"),
    "count": (_count, f"a whole number of at most {MOST_TEETH}"),
    "counts": (_two(_count), f"two whole numbers of at most {MOST_TEETH}"),
    "flag": (_flag, "true or false"),
    "place": (_place, "two or three numbers"),
    "direction": (_direction, "an angle, or three numbers"),
    "row": (_row, "numbers"),
    "names": (_names, "a list of texts"),
    "rows": (lambda value: tuple(map(_row, value)), "rows of numbers"),
    "list": (lambda value: tuple(map(_frozen, value)), "a list of such objects"),
    "pairs": (_each(_pair), "a mapping of names to two numbers"),
    "numbers": (_each(_number), "a mapping of names to numbers"),
    "texts": (_each(_text), "a mapping of names to text"),
    "values": (_each(_frozen), "a mapping of names to such objects"),
}
"""How a value is read, and what to say it has to be."""
