"""The path of a number, or of a table, in a file: one notation in files, studies, pages, messages.

Keys stand between points, in quotes where they have odd signs; entries of a list are counted
from 1 in brackets: ``links.crank.points.B.x``, ``springs[1].stiffness``, ``links."arm 2".mass``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note

LONGEST_KEY = 60
"""Letters of a key that a message prints."""
_STEP = re.compile(r'(?:(?:^|\.)(?:"((?:[^"\\]|\\.)*)"|([^."\[\]]+))|\[([0-9]{1,9})\])')
_BARE = re.compile(r"[A-Za-z0-9_-]+")


class KeyPath(tuple[str | int, ...]):
    """Keys on the way to a value in a file, and numbers in lists, which here count from 0.

    It is the tuple of these, and `str` is its text, in which lists count from 1.

    >>> path = KeyPath.parse("springs[1].stiffness")
    >>> tuple(path)
    ('springs', 0, 'stiffness')
    >>> str(path.parent / "free_length")
    'springs[1].free_length'
    """

    __slots__ = ()

    @classmethod
    def parse(cls, text: str) -> KeyPath:
        """Read a path that somebody has written.

        Raises
        ------
        ModelError : it is no path; `where` is the text.
        """
        steps: list[str | int] = []
        end = 0
        while match := _STEP.match(text, end):
            in_quotes, bare, number = match.groups()
            if number is not None:
                steps.append(int(number) - 1)
            else:
                steps.append(_unquoted(in_quotes) if bare is None else bare.strip())
            end = match.end()
        if not text or end < len(text) or -1 in steps:
            given = text if len(text) <= LONGEST_KEY else f"{text[:57]}..."
            raise ModelError(
                text,
                Note(
                    "got {given!r}; give keys with points between, and numbers in lists from "
                    "1 in brackets, such as links.crank.points.B.x or gears[1].ratio",
                    given=given,
                ),
            )
        return cls(steps)

    @classmethod
    def of(cls, path: str | Iterable[str | int]) -> KeyPath:
        """A path that is given as text, or by its keys and numbers from 0; errors as `parse`."""
        if isinstance(path, KeyPath):
            return path
        return cls.parse(path) if isinstance(path, str) else cls(path)

    def __str__(self) -> str:
        steps = (f"[{s + 1}]" if isinstance(s, int) else f".{written_key(s)}" for s in self)
        return "".join(steps).removeprefix(".")

    @property
    def abbreviated(self) -> str:
        """Text of a path in a message, in which endless keys are cut."""
        return str(KeyPath(map(_cut, self)))

    def __repr__(self) -> str:
        return f"KeyPath.parse({str(self)!r})"

    def __truediv__(self, step: str | int) -> KeyPath:
        return KeyPath((*self, step))

    @property
    def parent(self) -> KeyPath:
        """The path of what holds the value."""
        return KeyPath(self[:-1])

    def begin(self, count: int) -> KeyPath:
        """The path of its first keys, or without so many of the last where `count` is below 0."""
        return KeyPath(self[:count])

    def matches(self, pattern: Iterable[str | type]) -> bool:
        """Whether it has the keys of a pattern, in which `str` is any key and `int` any number."""
        wanted = tuple(pattern)
        return len(wanted) == len(self) and all(
            isinstance(step, item) if isinstance(item, type) else step == item
            for step, item in zip(self, wanted, strict=True)
        )

    def read(self, document: Any) -> Any:
        """What stands there in a document of nested dicts and lists.

        Raises
        ------
        KeyError, IndexError, TypeError : there is no such place.
        """
        for step in self:
            document = document[step]
        return document

    def write(self, document: Mapping[str, Any], value: Any) -> dict[str, Any]:
        """A document with another value there, or with a new last key; errors as `read`."""
        return with_values(document, {self: value})


def with_values(document: Mapping[str, Any], values: Mapping[KeyPath, Any]) -> dict[str, Any]:
    """A document with other values at some paths; what is not changed is shared, not copied."""
    root = dict(document)
    copied: dict[tuple[str | int, ...], Any] = {(): root}
    for path, value in values.items():
        here: Any = root
        for length, key in enumerate(path[:-1], 1):
            if path[:length] not in copied:
                here[key] = copied[path[:length]] = here[key].copy()
            here = here[key]
        here[path[-1]] = value
    return root


def quoted(value: object) -> str:
    """Text, or a list of texts, as it stands in TOML."""
    return json.dumps(value, ensure_ascii=False)


@lru_cache(4096)
def written_key(name: str) -> str:
    """A key as it stands in TOML; a page writes those of a machine at every move of a drag."""
    return name if _BARE.fullmatch(name) else quoted(name)


def _cut(step: str | int) -> str | int:
    return step if isinstance(step, int) or len(step) <= LONGEST_KEY else f"{step[:57]}..."


def _unquoted(text: str) -> str:
    try:
        return str(json.loads(f'"{text}"'))
    except ValueError:
        return text
