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
            name, actual = f"{before}{word}", group[word]
            assert actual.default_command is not None
            yield name, actual.default_command
            yield from _below(actual, f"{name} ")


def options(name: str) -> list[str]:
    """What a command takes: names of files and values first, then its options."""
    return [item for each, kind, hint in _taken(name) for item in _named(each, kind, hint)]


def _taken(name: str) -> Iterator[tuple[str, Any, Any]]:
    function = functions()[name]
    hints = get_type_hints(function, include_extras=True)
    for parameter in signature(function).parameters.values():
        yield parameter.name, parameter, hints[parameter.name]


def _named(name: str, item: Any, hint: Any) -> Iterator[str]:
    if is_dataclass(hint):
        inner = get_type_hints(hint, include_extras=True)
        for part in fields(hint):
            yield from _named(part.name, None, inner[part.name])
        return
    given = [mark.name for mark in _marks(hint, Parameter) if mark.name]
    typed = item is None or item.kind is item.KEYWORD_ONLY
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
    for _, first, hint in _taken(name) if declared_of(functions()[name]) else ():
        if first.default is not first.empty or first.kind is first.KEYWORD_ONLY:
            continue
        examples = [mark.example for mark in _marks(hint, LoadedFile)]
        examples = [file or example for example in examples if example]
        wanted = [mark.metavar or "" for mark in _marks(hint, Parameter)]
        examples += [item.strip('"') for item in wanted if item.startswith('"')]
        if not examples:
            return []
        words.append(examples[0])
    return words if loads(name) else []
