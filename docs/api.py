"""Writes docs/api.txt: every public name with its signature and docstring, to be read in one go."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import cached_property
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from cyclopts import App

import equipoise
from equipoise.cli import app
from equipoise.keys import Frozen, Quantity, all_keys, innermost
from equipoise.quantities import SI
from equipoise.results.result import Result

PAGE = Path(__file__).with_name("api.txt")
HEAD = """\
Every public name of Equipoise, for "import equipoise as eq", and at the end every command with what
it takes.  All numbers are in SI units and radians; arrays are NumPy's.  What is wrong raises
eq.EquipoiseError with one sentence.

This page is written by docs/api.py from the docstrings; docs/python.md is a tour with examples,
docs/model-file.md has the keys of files, docs/tour.md the commands.
"""


def page() -> str:
    """The names of the package, of each room but those, and of what functions give besides."""
    rooms = [name for name in equipoise.__all__ if isinstance(getattr(equipoise, name), ModuleType)]
    told: set[Any] = set()
    lines = [HEAD]
    for room in ("", *rooms):
        module = import_module(f"equipoise.{room}".rstrip("."))
        lines += [f"# {f'eq.{room}'.rstrip('.')}\n\n{_text(module)}\n"]
        names = {name: getattr(module, name) for name in sorted(module.__all__, key=str.lower)}
        new = {name: one for name, one in names.items() if one not in told}
        lines += [line for one in new.items() for line in _named(f"eq.{room}".rstrip("."), *one)]
        told |= {*new.values()}
    lines += ["# what functions give, and what all results have\n"]
    for one in sorted({*_given(told)} - told, key=lambda one: one.__name__):
        lines += _named(one.__module__, one.__name__, one)
    return "\n".join([*lines, "# commands\n", *_commands(app), ""])


def _commands(group: App, before: str = "equipoise") -> Iterator[str]:
    """Each command with what it takes, and those below it."""
    for word in sorted(group.resolved_commands()):
        if not word.startswith("-"):
            found, words = group[word], f"{before} {word}"
            taken = found.assemble_argument_collection(parse_docstring=True)
            yield " ".join([words, *(one.name for one in taken if one.name != "*")])
            yield from _commands(found, words)


def _given(told: set[Any]) -> Iterator[type]:
    """Classes of what functions return, and those that such classes are made of."""
    for one in told:
        if inspect.isfunction(one):
            for name in re.findall(r"\w+", str(inspect.signature(one).return_annotation)):
                found = getattr(import_module(one.__module__), name, None)
                if inspect.isclass(found) and found.__module__.startswith("equipoise"):
                    yield found
                    yield from (base for base in found.__mro__ if base is Result)


def _named(place: str, name: str, found: Any) -> Iterator[str]:
    if isinstance(found, ModuleType):
        return
    kind = "class " if inspect.isclass(found) else ""
    yield f"## {kind}{place}.{name}{_signature(found)}\n\n{_text(found)}\n"
    yield from _members(found) if kind else ()


def _members(found: type) -> Iterator[str]:
    """What its values have: those from a file, then properties and methods."""
    yield from _keys(found) if issubclass(found, Frozen) else ()
    for key, one in vars(found).items():
        made = one.__func__ if isinstance(one, classmethod | staticmethod) else one
        if key.startswith("_") or not (text := _one_line(_text(made))):
            continue
        if inspect.isfunction(made):
            yield f"- {key}{_signature(made)}: {text}"
        elif isinstance(made, property | cached_property):
            yield f"- {key}: {text}"
    yield ""


def _keys(found: type[Frozen]) -> Iterator[str]:
    """What the values of a class mean that has them from a file."""
    for name, one in all_keys(found).items():
        kind = innermost(one.kind)
        unit = f", {SI[kind.dimension]}" if isinstance(kind, Quantity) else ""
        if one.text and (one.field or name) in inspect.signature(found).parameters:
            yield f"- {one.field or name}{unit}: {_one_line(one.text)}"


def _signature(found: Any) -> str:
    """Without quotes about annotations, and without addresses of what stands for a default."""
    if inspect.isclass(found) and issubclass(found, Exception):
        return ""
    text = str(inspect.signature(found))
    text = re.sub(r"""(: |-> )(["'])(.*?)\2(?=[,)]| =|$)""", r"\1\3", text)
    text = text.replace("(self, ", "(").replace("(self)", "()").removesuffix(" -> None")
    return re.sub(r"<([\w.]+)[^<>]*>", r"\1", text)


def _text(found: Any) -> str:
    return inspect.cleandoc(found.__doc__ or "")


def _one_line(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
