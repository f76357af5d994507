"""Target files: what a search of geometry has to reach, and what it may change.

Values with units are read once the figures that they belong to are known to exist.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from typing import Any, ClassVar, get_args

from equipoise.dataclass import dataclass
from equipoise.design.lifts import dimension_of_lift
from equipoise.design.requirements import Requirement
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys import (
    VERSION,
    Anything,
    Frozen,
    Keys,
    KeyTable,
    Named,
    Tables,
    TextKind,
    Whole,
    declared,
    inside,
    key,
)
from equipoise.keys.requirement_kinds import REQUIREMENT_KINDS, RequirementKeys, split_asks
from equipoise.mechanism.parts.machine import unknown
from equipoise.planting.names import dimension_of
from equipoise.planting.search import GENERATIONS, POPULATION, Sense, check_asks
from equipoise.schema.files import FileError, printable, read_text
from equipoise.schema.numbers import si_value
from equipoise.schema.open_files import in_file, toml_content
from equipoise.schema.reading import Context, read_table

QuantityValue = str | float
VALUE = Anything()
"""Of a figure: its dimension is known later."""


@declared
class SearchTable(Frozen):
    """How to search."""

    seed: int = key(Whole(0, 2**32 - 1), "of random numbers", default=1)
    generations: int = key(Whole(1, 100_000), "at most so many", default=GENERATIONS)
    population: int = key(Whole(5, 10_000), "designs of a generation", default=POPULATION)
    crank: Sense = key(TextKind(get_args(Sense)), "sense in which it turns", default="as given")


@declared
class GoalTable(Frozen):
    """What one figure has to be."""

    extra_keys: ClassVar[Keys] = RequirementKeys("goals", VALUE)

    figure: str = key(TextKind(), "that `equipoise plant` reports", example="curve.height")
    tolerance: QuantityValue | None = key(VALUE, "of the target", default=None)
    asks: Any = inside(Anything(), factory=dict)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> GoalTable:
        return cls(**split_asks(given, cls.extra_keys))


@declared
class TargetTable(Frozen):
    """A target file."""

    extra_keys: ClassVar[Keys] = {"schema": VERSION}

    goals: tuple[GoalTable, ...] = key(
        Tables(KeyTable(GoalTable)), "what figures have to be", example=[]
    )
    search: SearchTable = key(KeyTable(SearchTable), "how to search", default=SearchTable())
    vary: Mapping[str, Any] | None = key(Named(VALUE), "numbers with their limits", default=None)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> TargetTable:
        del given["schema"]
        return cls(**given)


@dataclass(frozen=True)
class Targets:
    """A target file that has been read; SI units and radians."""

    goals: tuple[Requirement, ...]
    vary: Mapping[str, tuple[float, float]] | None
    search: SearchTable


def read_targets(path: str | os.PathLike[str], figures: Collection[str]) -> Targets:
    """Read a target file.

    Parameters
    ----------
    figures : names of the figures that the machine has.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    with in_file(printable(path) or "''"):
        try:
            text = read_text(path)
        except FileError as problem:
            raise ModelError("", problem.note) from problem
        content = toml_content(text)
        if "goals" not in content:
            raise ModelError("goals", Note("missing; add at least one table [[goals]]"))
        table: TargetTable = read_table(TargetTable, content, Context())
        if not table.goals:
            raise ModelError("goals", Note("there is none; give at least one [[goals]]"))
        goals = tuple(_goal(f"goals[{n}]", goal, figures) for n, goal in enumerate(table.goals, 1))
        vary = None if table.vary is None else dict(_limits(table.vary))
        return Targets(goals, vary, table.search)


def _goal(where: str, goal: GoalTable, figures: Collection[str]) -> Requirement:
    if goal.figure.startswith("pick_up.") and goal.figure not in figures:
        raise ModelError(
            f"{where}.figure",
            Note("got {figure!r}; the machine has no planting.tray", figure=goal.figure),
        )
    if goal.figure not in figures:
        raise ModelError(f"{where}.figure", unknown(goal.figure, figures, "figure"))
    given: dict[str, Any] = dict(goal.asks)
    if goal.tolerance is not None:
        given["tolerance"] = goal.tolerance
    for item, value in given.items():
        if item not in REQUIREMENT_KINDS or not REQUIREMENT_KINDS[item].choices:
            given[item] = si_value(f"{where}.{item}", value, dimension_of(goal.figure))
    try:
        requirement = Requirement(goal.figure, **given)
        check_asks(requirement)
    except UsageError as error:
        raise ModelError(where, error.note) from error
    return requirement


def _limits(
    table: Mapping[str, Any], prefix: str = ""
) -> Iterator[tuple[str, tuple[float, float]]]:
    """Numbers to vary with their limits, by dotted name."""
    for item, value in table.items():
        name = f"{prefix}{item}"
        if isinstance(value, Mapping):
            yield from _limits(value, f"{name}.")
            continue
        if not isinstance(value, list) or len(value) != 2:
            raise ModelError(f"vary.{name}", Note('give two limits, such as ["20 mm", "60 mm"]'))
        dimension = dimension_of_lift(name)
        low, high = (si_value(f"vary.{name}", limit, dimension) for limit in value)
        yield name, (low, high)
