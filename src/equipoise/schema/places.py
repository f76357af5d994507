"""What has been found wrong in a file while it is read, and where."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from equipoise import keys
from equipoise.errors import ModelError
from equipoise.keys.paths import KeyPath
from equipoise.quantities import described
from equipoise.quantities.expressions import Names
from equipoise.quantities.reading import got


def within(place: KeyPath, error: ModelError) -> ModelError:
    """The same error, whose place is inside of another."""
    return error.within(place.shown)


WRONG = object()
"""Instead of a value that could not be read."""


@dataclass
class Context:
    """What reading needs besides the content.

    beside : reads what lies in a file of its own, by its sort and the file's name.
    makers : make the objects of some classes otherwise than by `Frozen.from_table`.
    names : what names in expressions stand for.
    problems : what has been found wrong, with its place.
    expressions : those of numbers that have been worked out, by their places.
    """

    beside: Callable[[str, str], Any] | None = None
    makers: Mapping[type[keys.Frozen], Callable[[dict[str, Any]], Any]] = field(
        default_factory=dict
    )
    names: Names = field(default_factory=dict)
    problems: list[tuple[KeyPath, str]] = field(default_factory=list)
    expressions: dict[KeyPath, str] = field(default_factory=dict)

    def wrong(self, place: KeyPath, given: Any, right: str) -> Any:
        """Note that a value is none that can be read."""
        self.problems.append((place, got(described(given), right)))
        return WRONG

    def say(self, place: KeyPath, sentence: str) -> Any:
        self.problems.append((place, sentence))
        return WRONG
