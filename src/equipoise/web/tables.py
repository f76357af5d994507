"""The tables of a machine's file on a page: what there is, what can be added, and changing it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import Worded, say, to_say
from equipoise.keys import Frozen, Key, Named, Quantity, Tables, Wording
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.outputs.declaring import declared
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.objectives import balanced_names
from equipoise.mechanism.parts.shown_units import SIGN, amounts_of
from equipoise.quantities import clean, format_exact, format_quantity, parse_expression, pattern
from equipoise.quantities.expressions import Names, names_in
from equipoise.schema.entries import Document, entry_of, kind_at, own_keys, tables_below
from equipoise.schema.writing import value_text
from equipoise.web.dependent_entries import completed
from equipoise.web.design import Design, pin_of
from equipoise.web.forms import Values, forms_of, text_of, word_of
from equipoise.web.messages import Entry

MOST_WORDS = 4
"""Keys of an entry, at most, that are shown where it is listed."""
LONGEST_VALUE = 40
MANY_DIGITS = re.compile(r"^-?\d*\.\d{6,}(?:e-?\d+)?(?= )")
"""A computed number before its unit."""
WHOLE = to_say("machine"), to_say("title, gravity and what else is of the whole")
"""What the table around all others is called, and what it holds."""


def entered(design: Design, entry: Entry) -> Design:
    """A design with an entry of its file that is new, other or gone.

    Raises
    ------
    ModelError : there can be no such entry; `where` is the key.
    """
    document = Document.of_machine(design.own)
    if entry.values is None:
        document = document.without(entry.place)
    else:
        kind = kind_at(document.of, entry.place)
        names = amounts_of(design.own.parameters)
        values = {
            name: _worked_out(kind.type, name, value, names) for name, value in entry.values.items()
        }
        document = document.put(entry.place, values, entry.name)
    own = completed(document, entry, design.own).machine(entry.files)
    own = own.with_constraints_met(design.own)
    return replace(design, own=own, counterweights=_that_fit(design, own))


def _worked_out(of: type[Frozen], name: str, value: Any, names: Names) -> Any:
    """A value of a form, where it is a sum or product of quantities as the quantity that it is.

    names : parameters.  An expression that has them, or the sign of expressions, stays as it is.
    """
    item = own_keys(of).get(name)
    if item is None or not isinstance(item.kind, Quantity) or not isinstance(value, str):
        return value
    if value.startswith(SIGN):
        return value
    dimension = item.kind.dimension
    try:
        worked_out = parse_expression(value.strip(), dimension, names)
    except UsageError:
        return value  # its reader reports the error
    if names_in(value):
        return f"{SIGN}{value.strip()}"
    is_plain = re.fullmatch(pattern(dimension), value.strip())
    return value if is_plain else format_exact(clean(worked_out, dimension), dimension)


def _that_fit(design: Design, own: Machine) -> Mapping[str, Any]:
    """Counterweights of links that still have a pin and a mass."""
    weights = design.counterweights.items()
    return MappingProxyType({
        name: weight for name, weight in weights
        if name in own.links and own.links[name].has_mass and pin_of(own, name) is not None
    })  # fmt: skip


def tables_of(machine: Machine) -> Values:
    """What a page needs to show and change every table of a machine's file.

    groups : a key below which there are tables, or can be, in the order of the file.
    forms : by the name that groups have.
    bodies : points of the frame and of links by name, in their own axes, m.
    outputs : those that balancing can take, each with what it is called.
    """
    document = Document.of_machine(machine)
    of = type(machine)
    first = {"word": say(WHOLE[0]), "text": say(WHOLE[1]), "of": ""}
    whole = _group(KeyPath(), of, "one", first) | {"required": True}
    whole["entries"] = [_entry(of, document.content, KeyPath())]
    bodies = {name: dict(points) for name, points in machine.bodies.items()}
    groups = [whole, *_groups(machine, of, document.content, KeyPath(), "")]
    result = ((name, declared(name)) for name in balanced_names(machine))
    outputs = {name: item[0].say(item[1]) for name, item in result if item is not None}
    return {"groups": groups, "forms": forms_of(of), "bodies": bodies, "outputs": outputs}


def _groups(
    machine: Machine, of: type[Frozen], entry: Mapping[str, Any] | None, place: KeyPath, name: str
) -> Iterator[Values]:
    """The groups below an entry; below one that is not there they name what has to be added first.

    name : what the entry is called.
    """
    for key, item in tables_below(of).items():
        inner = entry_of(item.kind)
        assert inner is not None
        at = place / key
        many = {Tables: "list", Named: "named"}.get(type(item.kind), "one")
        words = {"word": word_of(item), "text": text_of(item), "of": name}
        group = _group(at, inner.type, many, words)
        group["required"] = item.required and many == "one"
        if entry is None:
            group["needs"] = name
        given = (entry or {}).get(key)
        entries = [*_entries(given, at, many)]
        group["entries"] = [_entry(inner.type, value, place) for place, value in entries]
        if key == "bodies" and entries:
            group["result"] = _mass_of(machine, str(place[-1]))
        yield group
        for below, value in entries:
            called = str(below[-1]) if many == "named" else _called(item, below)
            yield from _groups(machine, inner.type, value, below, called)
        if not entries and many == "one":
            yield from _groups(machine, inner.type, None, at, word_of(item))


def _group(place: KeyPath, of: type[Frozen], many: str, words: Values) -> Values:
    text = {"place": str(place), "where": place.abbreviated, "form": of.__name__}
    return {**text, "many": many, "needs": "", **words}


def _entries(value: Any, place: KeyPath, many: str) -> Iterator[tuple[KeyPath, Any]]:
    """The entries of a key, each with its place."""
    if many == "one":
        yield from [] if value is None else [(place, value)]
    elif many == "list":
        yield from ((place / number, item) for number, item in enumerate(value or ()))
    else:
        yield from ((place / name, item) for name, item in (value or {}).items())


def _called(item: Any, place: KeyPath) -> str:
    last = place[-1]
    return f"{word_of(item)} {last + 1}" if isinstance(last, int) else word_of(item)


def _entry(of: type[Frozen], entry: Mapping[str, Any], place: KeyPath) -> Values:
    own = own_keys(of)
    values = {name: value for name, value in entry.items() if name in own}
    given_values = ((item, values[name]) for name, item in own.items() if name in values)
    words = [
        f"{word_of(item)} {_brief(_localized_value(item, value))}" for item, value in given_values
    ]
    return {
        "place": str(place),
        "where": place.abbreviated,
        "words": ", ".join(words[:MOST_WORDS]),
        "values": values,
        "below": [
            name for name, value in entry.items()
            if name in tables_below(of) and not _is_assumed(value)
        ],
    }  # fmt: skip


def _is_assumed(value: Any) -> bool:
    """Whether tables are such that what is given takes their place."""
    return isinstance(value, list) and all(item.get("assumed") for item in value)


def _localized_value(key: Key, value: Any) -> Any:
    """A text of several languages in the one that is spoken, all else as it is."""
    several = isinstance(key.kind, Wording) and isinstance(value, Mapping)
    return Worded(value).localized() if several else value


def _brief(value: Any) -> str:
    """A value of a file in a list of entries."""
    if isinstance(value, Mapping):
        text = " ".join(value)
    elif isinstance(value, list):
        text = " ".join(map(_brief, value))
    else:
        text = value if isinstance(value, str) else value_text(value)
        text = MANY_DIGITS.sub(lambda result: f"{float(result[0]):.6g}", text)
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 1]}…"


def _mass_of(machine: Machine, name: str) -> str:
    """What the bodies of a link are together."""
    link = machine.links[name]
    if link.mass is None or link.center_of_mass is None or link.inertia is None:
        return ""
    x, y = (format_quantity(value, "length") for value in link.center_of_mass)
    mass, inertia = format_quantity(link.mass, "mass"), format_quantity(link.inertia, "inertia")
    return say(
        "together {mass}; centre of mass at {x}, {y}; moment of inertia {inertia}",
        mass=mass,
        x=x,
        y=y,
        inertia=inertia,
    )
