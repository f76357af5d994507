"""Every command and what it takes, as it is registered: tests of all commands know a new one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from inspect import signature
from typing import Any, get_type_hints

from cyclopts import App, Parameter

from equipoise.cli import app
from equipoise.cli.models import LoadedFile
from equipoise.cli.runner import declared_of


def functions() -> dict[str, Callable[..., Any]]:
    """The function of each command by its name, such as ``balance trade-off``."""
    return dict(sorted(_below(app)))


def _below(group: App, before: str = "") -> Iterator[tuple[str, Callable[..., Any]]]:
    for word in group.resolved_commands():
        if not word.startswith("-"):
            name, found = f"{before}{word}", group[word]
            assert found.default_command is not None
            yield name, found.default_command
            yield from _below(found, f"{name} ")


def options(name: str) -> list[str]:
    """What a command takes: names of files and values first, then its options."""
    return [one for each, kind, hint in _taken(name) for one in _named(each, kind, hint)]


def _taken(name: str) -> Iterator[tuple[str, Any, Any]]:
    function = functions()[name]
    hints = get_type_hints(function, include_extras=True)
    for one in signature(function).parameters.values():
        yield one.name, one, hints[one.name]


def _named(name: str, one: Any, hint: Any) -> Iterator[str]:
    if is_dataclass(hint):
        inner = get_type_hints(hint, include_extras=True)
        for part in fields(hint):
            yield from _named(part.name, None, inner[part.name])
        return
    given = [mark.name for mark in _marks(hint, Parameter) if mark.name]
    typed = one is None or one.kind is one.KEYWORD_ONLY
    yield given[-1][0] if given else f"--{name.replace('_', '-')}" if typed else name.upper()


def loads(name: str) -> bool:
    """Whether a command loads a file."""
    return any(_marks(hint, LoadedFile) for _, _, hint in _taken(name))


def _marks(hint: Any, kind: type) -> list[Any]:
    return [mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, kind)]


def line_of(name: str, file: str = "") -> list[str]:
    """A command line with all that a command must have; empty where nobody says an example of it.

    file : instead of a bundled one.
    """
    words = name.split()
    for _, one, hint in _taken(name) if declared_of(functions()[name]) else ():
        if one.default is not one.empty or one.kind is one.KEYWORD_ONLY:
            continue
        examples = [mark.example for mark in _marks(hint, LoadedFile)]
        examples = [file or one for one in examples if one]
        wanted = [mark.metavar or "" for mark in _marks(hint, Parameter)]
        examples += [one.strip('"') for one in wanted if one.startswith('"')]
        if not examples:
            return []
        words.append(examples[0])
    return words if loads(name) else []
