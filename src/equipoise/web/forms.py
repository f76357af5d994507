"""Forms of the tables of a file: a control for each key, as the key is declared.

Nothing here knows a table or a key; `CONTROLS` has the control of each kind of value.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from equipoise import keys
from equipoise.i18n import say
from equipoise.quantities import display
from equipoise.schema.entries import entry_of, own_keys, tables_below
from equipoise.schema.file_numbers import plain_word
from equipoise.schema.open_files import document_of
from equipoise.schema.writing import plain_default

Values = dict[str, Any]


def forms_of(of: type[keys.Frozen]) -> dict[str, Values]:
    """The form of a table and of all below it, by the name of its class.

    Each has its controls, those of required keys first, and what the JSON Schema says of keys that
    go together.
    """
    by_name: dict[str, Values] = {}
    for table in _tables_of(of):
        own = own_keys(table)
        controls = [control_of(key, own) for key in own.values()]
        by_name[table.__name__] = {
            "rule": table.conditions,
            "controls": sorted(controls, key=lambda control: not control["required"]),
        }
    return by_name


def _tables_of(of: type[keys.Frozen]) -> Iterator[type[keys.Frozen]]:
    """A table and all below it, each once."""
    names: set[str] = set()
    waiting = [of]
    while waiting:
        item = waiting.pop()
        if item.__name__ not in names:
            names.add(item.__name__)
            yield item
            inner = (entry_of(key.kind) for key in tables_below(item).values())
            waiting += [table.type for table in inner if table is not None]


def word_in_forms(name: str) -> str:
    """What forms of the tables of a linkage call a key; the key where they have several words."""
    words = {word_of(keys_of_linkage) for keys_of_linkage in _keys_of_linkages().get(name, ())}
    return words.pop() if len(words) == 1 else name


@cache
def _keys_of_linkages() -> Mapping[str, tuple[keys.Key, ...]]:
    by_name: dict[str, tuple[keys.Key, ...]] = {}
    for table in _tables_of(document_of("linkage")):
        for name, own_key in own_keys(table).items():
            by_name[name] = (*by_name.get(name, ()), own_key)
    return MappingProxyType(by_name)


def control_of(key: keys.Key, siblings: Mapping[str, keys.Key]) -> Values:
    """What a page needs to ask for the value of a key; beside : keys of the same table."""
    default = plain_default(key)
    return {
        "key": key.name,
        "word": word_of(key),
        "text": text_of(key, siblings),
        "required": key.required,
        "default": None if default in ([], {}) else default,
        "example": key.example,
        **_control(key.kind),
    }


def word_of(key: keys.Key) -> str:
    """What a key is called: as its number is, where that does not take in what is around it."""
    return say(key.word if key.word and "{" not in key.word else plain_word(key))


def text_of(key: keys.Key, siblings: Mapping[str, keys.Key] = MappingProxyType({})) -> str:
    """What a key means; of keys beside it in what a form calls them."""
    values = getattr(key.kind, "names", ())

    def key_word(match: re.Match[str]) -> str:
        name = match[1]
        other = siblings.get(name) if name not in values else None
        return name if other is None else say("“{name}”", name=word_of(other))

    return re.sub("`([^`]*)`", key_word, say(key.text))


def _control(kind: keys.Kind) -> Values:
    return CONTROLS[type(kind)](kind)


def _text(kind: keys.TextKind) -> Values:
    if kind.names:
        return {"kind": "choice", "options": [*kind.names]}
    if kind.of == "output":  # of which a file may have others, such as those of rows
        return {"kind": "text", "of": kind.of}
    if kind.of:
        return {"kind": "name", "of": kind.of, "on": kind.on}
    return {"kind": "text", "options": [*kind.suggested]}


def _whole(kind: keys.Whole) -> Values:
    return {"kind": "choice", "options": [*kind.names]} if kind.names else {"kind": "number"}


def _unit(dimension: Any) -> str:
    return display(dimension).unit


def _listing(kind: keys.Listing) -> Values:
    """Some in a row; how many there can be is none for one and more."""
    return {"kind": "list", "item": _control(kind.item), "sizes": [*kind.sizes], "bare": False}


def _one_or(kind: keys.OneOr) -> Values:
    return {"kind": "list", "item": _control(kind.item), "sizes": [1, kind.size], "bare": True}


def _place(kind: keys.Point) -> Values:
    text = {"named": kind.named, "space": kind.space, "axes": kind.axes}
    return {"kind": "place", "unit": _unit("length"), **text}


CONTROLS: Mapping[type[keys.Kind], Callable[[Any], Values]] = {
    keys.ParameterValue: lambda kind: {"kind": "text", "options": []},
    keys.Direction: lambda kind: {"kind": "direction", "unit": _unit("angle")},
    keys.File: lambda kind: {"kind": "file"},
    keys.Flag: lambda kind: {"kind": "flag"},
    keys.Listing: _listing,
    keys.Named: lambda kind: {
        "kind": "names", "item": _control(kind.item), "by": _control(kind.by),
        "listed": kind.listed,
    },
    keys.Number: lambda kind: {"kind": "number"},
    keys.OneOr: _one_or,
    keys.Point: _place,
    keys.Quantity: lambda kind: {"kind": "quantity", "unit": _unit(kind.dimension)},
    keys.TextKind: _text,
    keys.DependentQuantity: lambda kind: {"kind": "text", "options": []},
    keys.Whole: _whole,
    keys.Wording: lambda kind: {"kind": "wording"},
}  # fmt: skip
"""Of kinds that files of linkages have."""
