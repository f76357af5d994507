"""Target files: what a search of geometry has to reach, and what it may change.

Like the model file, pydantic stands at the door only; values with units are read once the figures
they belong to are known to exist.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field

from equipoise import quantities
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.model import unknown
from equipoise.planting.designs import Sense
from equipoise.planting.goals import Goal, dimension_of
from equipoise.planting.search import GENERATIONS, POPULATION
from equipoise.schema.fields import PAIR, Table
from equipoise.schema.files import FileError, printable, read_text
from equipoise.schema.opening import toml_content
from equipoise.schema.problems import validated

Quantity = str | float


class _Search(Table):
    """How to search."""

    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 1
    generations: Annotated[int, Field(ge=1, le=100_000)] = GENERATIONS
    population: Annotated[int, Field(ge=5, le=10_000)] = POPULATION
    crank: Sense = "as given"


class _Goal(Table):
    """What one figure has to be."""

    figure: str = Field(examples=["curve.height"])
    target: Quantity | None = None
    at_least: Quantity | None = None
    at_most: Quantity | None = None
    tolerance: Quantity | None = None
    make: Literal["smallest", "largest"] | None = None


class _Document(Table):
    """A target file."""

    version: Literal[1] = Field(alias="schema", examples=[1])
    search: _Search = _Search()
    vary: dict[str, Any] | None = None
    goals: Annotated[list[_Goal], PAIR] = Field(examples=[[]])


@dataclass(frozen=True)
class Targets:
    """A target file that has been read; SI units and radians."""

    goals: tuple[Goal, ...]
    vary: Mapping[str, tuple[float, float]] | None
    sense: Sense
    seed: int
    generations: int
    population: int


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
    try:
        text = read_text(path)
    except FileError as problem:
        raise ModelError("", str(problem), printable(path) or "''") from problem
    try:
        return _targets(_document(text), figures)
    except ModelError as error:
        raise ModelError(printable(error.where), error.what, printable(path)) from error


def _document(text: str) -> _Document:
    content = toml_content(text)
    if "goals" not in content:
        raise ModelError("goals", "missing; add at least one table [[goals]]")
    return validated(_Document, content)


def _targets(document: _Document, figures: Collection[str]) -> Targets:
    if not document.goals:
        raise ModelError("goals", "there is none; give at least one [[goals]]")
    search = document.search
    return Targets(
        goals=tuple(_goal(f"goals[{n}]", g, figures) for n, g in enumerate(document.goals, 1)),
        vary=None if document.vary is None else dict(_limits(document.vary)),
        sense=search.crank,
        seed=search.seed,
        generations=search.generations,
        population=search.population,
    )


def _goal(where: str, goal: _Goal, figures: Collection[str]) -> Goal:
    if goal.figure.startswith("pick_up.") and goal.figure not in figures:
        raise ModelError(
            f"{where}.figure", f"got {goal.figure!r}; the machine has no planting.tray"
        )
    if goal.figure not in figures:
        raise ModelError(f"{where}.figure", unknown(goal.figure, figures, "figure"))
    keys = ("target", "at_least", "at_most", "tolerance")
    given = {
        key: _value(f"{where}.{key}", getattr(goal, key), dimension_of(goal.figure))
        for key in keys
        if getattr(goal, key) is not None
    }
    try:
        return Goal(goal.figure, make=goal.make, **given)
    except UsageError as error:
        raise ModelError(where, str(error)) from error


def _value(where: str, given: Quantity, dimension: str | None) -> float:
    if dimension is None:
        if isinstance(given, str):
            raise ModelError(where, f"got {given!r}; give a plain number, such as -0.9")
        return float(given)
    try:
        return quantities.parse(given, dimension)  # type: ignore[arg-type]
    except UsageError as error:
        raise ModelError(where, str(error)) from error


def _limits(
    table: Mapping[str, Any], prefix: str = ""
) -> Iterator[tuple[str, tuple[float, float]]]:
    """Numbers to vary with their limits, by dotted name."""
    for key, value in table.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            yield from _limits(value, f"{name}.")
            continue
        if not isinstance(value, list) or len(value) != 2:
            raise ModelError(f"vary.{name}", 'give two limits, such as ["20 mm", "60 mm"]')
        dimension = "angle" if name == "ground_angle" else "length"
        low, high = (_value(f"vary.{name}", limit, dimension) for limit in value)
        yield name, (low, high)
