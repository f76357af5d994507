"""Places in a file, what is wrong there, and from what is read to the objects that it makes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from json import dumps as quoted
from typing import Any

from equipoise.errors import ModelError
from equipoise.keys import File, Frozen, keys_of
from equipoise.quantities import described

Place = tuple[str | int, ...]
"""Keys, and numbers in lists from 0."""
LONGEST_KEY = 60


def written_key(name: str) -> str:
    """Return a key as it stands in TOML, cut where it is endless."""
    name = name if len(name) <= LONGEST_KEY else f"{name[:57]}..."
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)


def written_place(place: Iterable[str | int]) -> str:
    """Dotted path with numbers from 1, as the machine's own checks write it."""
    text = "".join(f"[{s + 1}]" if isinstance(s, int) else f".{written_key(s)}" for s in place)
    return text.removeprefix(".")


# -- what has been read ---

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
    makers: Mapping[type[Frozen], Callable[[dict[str, Any]], Any]] = field(default_factory=dict)
    problems: list[tuple[Place, str]] = field(default_factory=list)

    def wrong(self, place: Place, given: Any, right: str) -> Any:
        """Note that a value is none that can be read."""
        self.problems.append((place, f"got {described(given)}; {right}"))
        return WRONG

    def say(self, place: Place, sentence: str) -> Any:
        self.problems.append((place, sentence))
        return WRONG


@dataclass(frozen=True)
class Values:
    """Values of a table, of which an object is to be made."""

    of: type[Frozen]
    place: Place
    given: dict[str, Any]


@dataclass(frozen=True)
class NamedFile:
    """What lies in a file that is named at a place."""

    sort: str
    place: Place
    file: str


def made(value: Any, context: Context) -> Any:
    """The objects of what has been read."""
    if isinstance(value, Values):
        return _object(value, context)
    if isinstance(value, NamedFile):
        return _read_beside(value, context)
    if isinstance(value, dict):
        return {name: made(item, context) for name, item in value.items()}
    if isinstance(value, tuple) and value and isinstance(value[0], Values | NamedFile):
        return tuple(made(item, context) for item in value)
    return value


def _object(found: Values, context: Context) -> Any:
    given = {name: made(value, context) for name, value in found.given.items()}
    for name, one in keys_of(found.of).items():
        if isinstance(one.kind, File) and one.kind.named and name in given:
            given[one.kind.named] = found.given[name].file
    try:
        return context.makers.get(found.of, found.of.from_table)(given)
    except ModelError as error:
        within = written_place(found.place)
        inner = "." if within and error.where and error.where[0] != "[" else ""
        raise ModelError(f"{within}{inner}{error.where}", error.what) from error


def _read_beside(named: NamedFile, context: Context) -> Any:
    assert context.beside is not None
    try:
        return context.beside(named.sort, named.file)
    except ModelError as error:
        raise ModelError(written_place(named.place), error.what) from error
