"""What has been found wrong in a file while it is read, and where."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import field
from typing import Any

from equipoise import keys
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.quantities import as_written, described
from equipoise.quantities.expressions import Names
from equipoise.quantities.reading import got


def within(place: KeyPath, error: ModelError) -> ModelError:
    """Copy of an error whose place is inside of another."""
    return error.within(place.shown)


def _is_below(place: str, where: str) -> bool:
    """Whether a place is that of an error, or in its table."""
    return place == where or place.startswith((f"{where}.", f"{where}["))


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
    written : texts of quantities that have been read, each with its place.
    """

    beside: Callable[[str, str], Any] | None = None
    makers: Mapping[type[keys.Frozen], Callable[[dict[str, Any]], Any]] = field(
        default_factory=dict
    )
    names: Names = field(default_factory=dict)
    problems: list[tuple[KeyPath, Note]] = field(default_factory=list)
    expressions: dict[KeyPath, str] = field(default_factory=dict)
    written: list[tuple[KeyPath, str]] = field(default_factory=list)

    def wrote(self, place: KeyPath, given: Any) -> None:
        """Keep a text as it stands in the file, for sentences about the quantity that it is."""
        if isinstance(given, str):
            self.written.append((place, given))

    @contextmanager
    def with_written(self) -> Iterator[None]:
        """Say what is wrong with objects in the units in which their numbers were written."""
        try:
            yield
        except ModelError as error:
            where, source = error.where, error.source
            texts = sorted(self.written, key=lambda item: not _is_below(item[0].shown, where))
            what = as_written(error.what, [text for _, text in texts])
            raise ModelError(where, what, source).like(error) from error

    def wrong(self, place: KeyPath, given: Any, right: Note) -> Any:
        """Note that a value is none that can be read."""
        self.problems.append((place, got(described(given), right)))
        return WRONG

    def say(self, place: KeyPath, sentence: Note) -> Any:
        self.problems.append((place, sentence))
        return WRONG
