"""Places in a file, and what has been found wrong there while it is read."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from equipoise import keys
from equipoise.errors import ModelError
from equipoise.quantities import described
from equipoise.quantities.reading import got
from equipoise.schema.files import written_key

Place = tuple[str | int, ...]
"""Keys, and numbers in lists from 0."""


def written_place(place: Iterable[str | int]) -> str:
    """Dotted path with numbers from 1, as the machine's own checks write it."""
    text = "".join(f"[{s + 1}]" if isinstance(s, int) else f".{written_key(s)}" for s in place)
    return text.removeprefix(".")


def within(place: Place, error: ModelError) -> ModelError:
    """The same error, whose place is inside of another."""
    return error.within(written_place(place))


WRONG = object()
"""Instead of a value that could not be read."""


@dataclass
class Context:
    """What reading needs besides the content.

    beside : reads what lies in a file of its own, by its sort and the file's name.
    makers : make the objects of some classes otherwise than by `Frozen.from_table`.
    problems : what has been found wrong, with its place.
    """

    beside: Callable[[str, str], Any] | None = None
    makers: Mapping[type[keys.Frozen], Callable[[dict[str, Any]], Any]] = field(
        default_factory=dict
    )
    problems: list[tuple[Place, str]] = field(default_factory=list)

    def wrong(self, place: Place, given: Any, right: str) -> Any:
        """Note that a value is none that can be read."""
        self.problems.append((place, got(described(given), right)))
        return WRONG

    def say(self, place: Place, sentence: str) -> Any:
        self.problems.append((place, sentence))
        return WRONG
