"""What can be asked of a figure, each kind a class with a key of its own.

A further kind is a class here, in `REQUIREMENT_KINDS`.  ``[[outputs]]`` of studies, ``[[goals]]``
of target files, ``[[balance.limits]]`` and ``[[design.limits]]`` of tools take its key; studies,
searches, `plant fit`, balancing, the design of tools, tables, pictures and the page read off it
where the figure may lie and which way is better.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY
from math import inf, isfinite
from typing import Any, ClassVar, Literal

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, unknown
from equipoise.i18n import Note, any_of
from equipoise.keys.declaring import REQUIRED, Key
from equipoise.keys.kinds import Kind, TextKind

Make = Literal["smallest", "largest"]
Asks = tuple[tuple[str, Any], ...]
"""Values by the key of their kind, in the order of `REQUIREMENT_KINDS`."""


class RequirementKind(ABC):
    """One thing that can be asked of a figure.

    key : in files.  description : of that key.
    choices : texts that its value can be; none where it is a value of the figure, in SI units.
    tables : that have the key, of ``outputs``, ``goals`` and ``limits`` (of balancing and of tools,
        where a kind has to bound from above: what is at most something is convex).
    """

    key: ClassVar[str]
    description: ClassVar[str]
    choices: ClassVar[tuple[str, ...]] = ()
    tables: ClassVar[tuple[str, ...]] = ("outputs", "goals", "limits")

    def ends(self, value: Any) -> tuple[float, float]:
        """Between which the figure has to lie."""
        return -inf, inf

    def sense(self, value: Any) -> float:
        """1 where the figure is to become small, -1 where large, 0 where neither."""
        return 0.0

    def target(self, value: Any) -> float | None:
        """To what the figure is to come close."""
        return None


class Target(RequirementKind):
    """A value to come close to."""

    key, description, tables = "target", "what it has to be", ("goals",)

    def target(self, value: Any) -> float:
        return float(value)


class AtLeast(RequirementKind):
    """A lower limit."""

    key, description = "at_least", "lower limit, which a design has to keep"
    tables = ("outputs", "goals")

    def ends(self, value: Any) -> tuple[float, float]:
        return value, inf


class AtMost(RequirementKind):
    """An upper limit."""

    key, description = "at_most", "upper limit, which a design has to keep"

    def ends(self, value: Any) -> tuple[float, float]:
        return -inf, value


class MakeSmallOrLarge(RequirementKind):
    """An objective."""

    key, description = "make", "whether it is to become small or large"
    choices, tables = ("smallest", "largest"), ("outputs", "goals")

    def sense(self, value: Any) -> float:
        return {"smallest": 1.0, "largest": -1.0}.get(value, 0.0)


REQUIREMENT_KINDS: dict[str, RequirementKind] = {
    kind.key: kind for kind in (Target(), AtLeast(), AtMost(), MakeSmallOrLarge())
}
"""By key."""


class RequirementKeys(Mapping[str, Key]):
    """Keys of the kinds that a table has.

    table : see `RequirementKind.tables`.  value : how a value of the figure is given.
    needed : whether the key is required where there is one kind only.
    options : of each key, as of `Key`.
    """

    def __init__(self, table: str, value: Kind, needed: bool = False, **options: Any) -> None:
        self.table, self.value, self.needed, self.options = table, value, needed, options

    def __iter__(self) -> Iterator[str]:
        return (key for key, kind in REQUIREMENT_KINDS.items() if self.table in kind.tables)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __getitem__(self, key: str) -> Key:
        kind = REQUIREMENT_KINDS[key]
        if self.table not in kind.tables:
            raise KeyError(key)
        default = REQUIRED if self.needed and len(self) == 1 else None
        given: dict[str, Any] = {"text": kind.description, "default": default, **self.options}
        return Key(key, TextKind(kind.choices) if kind.choices else self.value, **given)


@dataclass(frozen=True)
class RequiredFigure:
    """What is asked of a figure, read the same way by all that compute with it."""

    _: KW_ONLY
    asks: Asks = ()

    @property
    def at_least(self) -> float | None:
        """The highest of what it has to be at least; None without a lower limit."""
        lowest = max((low for low, _ in self._ends), default=-inf)
        return None if lowest == -inf else lowest

    @property
    def at_most(self) -> float | None:
        """The lowest of what it may be at most; None without an upper limit."""
        highest = min((high for _, high in self._ends), default=inf)
        return None if highest == inf else highest

    @property
    def _ends(self) -> Iterator[tuple[float, float]]:
        return (REQUIREMENT_KINDS[key].ends(value) for key, value in self.asks)

    @property
    def target(self) -> float | None:
        """What it is to come close to."""
        targets = (REQUIREMENT_KINDS[key].target(value) for key, value in self.asks)
        return next((target for target in targets if target is not None), None)

    @property
    def make(self) -> Make | None:
        """Whether it is to become small or large."""
        senses = (REQUIREMENT_KINDS[key].sense(value) for key, value in self.asks)
        sense = next(filter(None, senses), 0.0)
        return {0.0: None, 1.0: "smallest", -1.0: "largest"}[sense]

    @property
    def limited(self) -> bool:
        """Whether it has a limit."""
        return (self.at_least, self.at_most) != (None, None)

    def asked_in(self, table: str) -> dict[str, Any]:
        """What is asked by each key that a table has; None where it is not."""
        return {key: dict(self.asks).get(key) for key in RequirementKeys(table, Kind())}

    def wrong_asks(self) -> Iterator[tuple[str, str, Note]]:
        """Keys whose values cannot be used, each with what was given and what is right."""
        for key, value in self.asks:
            choices = REQUIREMENT_KINDS[key].choices
            if choices and value not in choices:
                yield key, repr(value), Note("give {what}", what=any_of(choices))
            if not choices and not isfinite(value):
                yield key, str(value), Note("give a finite number")


def split_asks(given: Mapping[str, Any], keys: Mapping[str, Key]) -> dict[str, Any]:
    """Fields of a table, with the keys of requirements among them gathered as `asks`."""
    rest = {name: value for name, value in given.items() if name not in keys}
    return {**rest, "asks": {key: given[key] for key in keys if given.get(key) is not None}}


def asks_of(given: Mapping[str, Any], before: Asks = ()) -> Asks:
    """What is asked by key, with what was asked before; None asks nothing.

    Raises
    ------
    UsageError : there is no such kind.
    """
    for key in given:
        if key not in REQUIREMENT_KINDS:
            raise UsageError(unknown(key, REQUIREMENT_KINDS, "key"))
    values = {**dict(before), **given}
    return tuple((key, values[key]) for key in REQUIREMENT_KINDS if values.get(key) is not None)
