"""Frozen classes do what those of the standard library do."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field, fields, replace
from inspect import signature
from typing import Any, get_type_hints

import pytest

from equipoise.dataclass import Constructor, dataclass, remembered


def made_by(decorator: Callable[..., Any]) -> Any:
    """The same class with fields of all kinds, by one decorator or the other."""

    @decorator(frozen=True)
    class Base:
        first: int
        second: float = 2.0
        hidden: str = field(default="h", repr=False)
        aside: int = field(default=0, compare=False)
        made: list[int] = field(default_factory=list, hash=False)
        alone: int = field(default=7, kw_only=True)
        own: dict[str, int] = field(default_factory=dict, init=False, compare=False)

    @decorator(frozen=True)
    class Inner(Base):
        """With a check."""

        third: str = "t"

        def __post_init__(self) -> None:
            if self.first < 0:
                raise ValueError(self.first)

    return Inner


OURS, THEIRS = made_by(dataclass), made_by(dataclasses.dataclass)


@pytest.mark.parametrize("kind", [OURS, THEIRS])
def test_objects_of_both(kind):
    first = kind(1, 3.0, third="x", alone=8)
    assert repr(first).endswith(
        "Inner(first=1, second=3.0, aside=0, made=[], alone=8, own={}, third='x')"
    )
    assert first == kind(1, 3.0, aside=5, third="x", alone=8)
    assert first != kind(1, 3.0, third="y", alone=8)
    assert first != (1, 3.0)
    assert hash(first) == hash(kind(1, 3.0, aside=5, third="x", alone=8))
    assert replace(first, first=2).first == 2
    assert first.made is not kind(1).made
    assert copy.deepcopy(first) == first
    with pytest.raises(FrozenInstanceError, match="first"):
        first.first = 2
    with pytest.raises(FrozenInstanceError, match="third"):
        del first.third
    with pytest.raises(FrozenInstanceError, match="new"):
        first.new = 2
    with pytest.raises(ValueError, match="-1"):
        kind(-1)
    for wrong in [{}, {"first": 1, "nothing": 2}]:
        with pytest.raises(TypeError):
            kind(**wrong)
    with pytest.raises(TypeError):
        kind(1, 2.0, "h", 0, [], "t", 9)  # alone is by name


def test_signatures_are_the_same():
    assert get_type_hints(Kept.__init__) == {"value": float, "return": type(None)}
    assert str(signature(OURS)) == str(signature(THEIRS))
    assert [item.name for item in fields(OURS)] == [item.name for item in fields(THEIRS)]


def test_nothing_is_compiled_before_the_first_object():
    kind = made_by(dataclass)
    assert isinstance(vars(kind)["__init__"], Constructor)
    kind(1)
    assert not isinstance(vars(kind)["__init__"], Constructor)


@dataclass(frozen=True)
class Kept:
    """A class by whose name objects are read again."""

    value: float


@dataclass(frozen=True, eq=False)
class Apart(Kept):
    """Equal as its base is."""

    more: int = 1


@dataclass(frozen=True)
class OwnEqual:  # noqa: PLW1641
    """With a comparison of its own."""

    value: int

    def __eq__(self, other: object) -> bool:
        return isinstance(other, OwnEqual) and abs(self.value - other.value) < 2


def test_what_a_class_has_itself_stays():
    assert pickle.loads(pickle.dumps(Kept(1.5))) == Kept(1.5)
    nan = float("nan")
    assert Kept(nan) == Kept(nan)  # as tuples are that hold the same object
    assert Apart(1.0, more=2) == Apart(1.0, more=3)  # by the base's fields
    assert Apart(1.0) != Kept(1.0)
    assert OwnEqual(1) == OwnEqual(2)
    assert hash(OwnEqual(1)) == hash(OwnEqual(1))


def test_an_object_that_holds_itself_is_printed():
    first = Kept(1.0)
    object.__setattr__(first, "value", first)
    assert repr(first) == "Kept(value=...)"


def test_what_is_remembered_is_computed_once_and_can_be_handed_on() -> None:
    calls = []

    @dataclass(frozen=True)
    class Square:
        side: float
        memory: dict[str, Any] = field(default_factory=dict, init=False, compare=False)

        @remembered
        def area(self) -> float:
            """In m2."""
            calls.append(self.side)
            return self.side**2

    first = Square(3.0)
    assert (first.area, first.area, calls) == (9.0, 9.0, [3.0])
    other = replace(first)
    assert other == first
    other.memory.update(first.memory)
    assert (other.area, calls) == (9.0, [3.0])
    assert Square.area.__doc__ == "In m2."
