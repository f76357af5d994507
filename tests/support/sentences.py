"""Sentences of results by what says them and by their values, so that their wording is free."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from inspect import unwrap
from string import Formatter
from types import CodeType
from typing import Any

from equipoise.i18n import Note
from support.refusals import has_value


def constants_of(code: CodeType) -> Iterator[object]:
    """Constants in the source of a function, and in that of functions and loops inside it."""
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from constants_of(constant)
        else:
            yield constant


def placeholders(template: object) -> set[str]:
    """Names of the values that a sentence has; none of what is no template."""
    try:
        return {name for _, name, _, _ in Formatter().parse(str(template)) if name}
    except ValueError:
        return set()


def notes_by(
    source: Callable[..., Any], notes: Iterable[object], /, *names: str, **values: Any
) -> list[Note]:
    """Those of the notes whose sentence stands in a function of the product.

    names : of values that the sentence has, whatever they are.  values : those that it has, as in
    `has_value`.  Both together are all that the sentence has, and no other sentence of the
    function has the same, so that another one is never taken for it.
    """
    wanted = {*names, *values}
    templates = {
        item for item in constants_of(unwrap(source).__code__) if placeholders(item) == wanted
    }
    assert len(templates) == 1 or not wanted, templates
    return [
        note
        for note in notes
        if isinstance(note, Note)
        and note.template in templates
        and {*note.values} == wanted
        and all(has_value(note, name, value) for name, value in values.items())
    ]
