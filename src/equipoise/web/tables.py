"""The tables of a machine's file on a page: what there is, what can be added, and changing it.

A form has a control for each key of a table, as the key is declared: `CONTROLS` has that of each
kind of value, and nothing of forms knows a table or a key.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from itertools import count
from math import pi
from types import MappingProxyType
from typing import Annotated, Any, Literal, NotRequired, TypedDict

from equipoise import keys
from equipoise.errors import UsageError
from equipoise.i18n import Worded, say, to_say
from equipoise.keys import Frozen, Key, MenuSource, Named, Quantity, Tables, Wording
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.outputs.declaring import declared
from equipoise.mechanism.parts.balance import balanced_names
from equipoise.mechanism.parts.links import MASS_FIELDS
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import SIGN, amounts_of
from equipoise.quantities import (
    clean,
    display,
    format_exact,
    format_quantity,
    parse,
    parse_expression,
    pattern,
)
from equipoise.quantities.expressions import NamedAmounts, names_in
from equipoise.schema.entries import Document, entry_of, kind_at, own_keys, tables_below
from equipoise.schema.file_numbers import plain_word
from equipoise.schema.open_files import document_of
from equipoise.schema.writing import plain_default, value_text
from equipoise.web.design import DraftT, fitting_counterweights
from equipoise.web.messages import Entry, JsonObject, Pair

MOST_WORDS = 4
"""Keys of an entry, at most, that are shown where it is listed."""


LONGEST_VALUE = 40


MANY_DIGITS = re.compile(r"^-?\d*\.\d{6,}(?:e-?\d+)?(?= )")
"""A computed number before its unit."""


WHOLE = to_say("machine"), to_say("title, gravity and what else is of the whole")
"""What the table around all others is called, and what it holds."""


def entered(draft: DraftT, entry: Entry) -> DraftT:
    """A draft with an entry of its file that is new, other or gone.

    Raises
    ------
    ModelError : there can be no such entry; `where` is the key.
    """
    before = draft.own
    document = Document.of_machine(before)
    if entry.values is None:
        document = document.without(entry.place)
    else:
        kind = kind_at(document.of, entry.place)
        names = amounts_of(before.parameters)
        values = {
            name: _worked_out(kind.type, name, value, names) for name, value in entry.values.items()
        }
        document = document.put(entry.place, values, entry.name)
    own = completed(document, entry, before).machine(entry.files)
    own = own.with_constraints_met(before)
    weights = fitting_counterweights(draft.counterweights, own)
    return draft.with_machine(own).altered(counterweights=weights)


def _worked_out(of: type[Frozen], name: str, value: Any, names: NamedAmounts) -> Any:
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


def tables_of(machine: Machine) -> JsonObject:
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


def menu_items(of: type[Frozen] = Machine, place: KeyPath = KeyPath()) -> Iterator[JsonObject]:
    """What menus of a drawing offer to add, as tables of the file declare it, in its order and in
    the language that is spoken; place : of the table below which they are.
    """
    for name, item in tables_below(of).items():
        table = entry_of(item.kind)
        assert table is not None
        if (offered := table.type.menu_item) is not None:
            values = [*offered.values]
            yield {"name": say(offered.label), "place": str(place / name), "values": values}
        if not isinstance(item.kind, Tables | Named):
            yield from menu_items(table.type, place / name)


def _groups(
    machine: Machine, of: type[Frozen], entry: Mapping[str, Any] | None, place: KeyPath, name: str
) -> Iterator[JsonObject]:
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


def _group(place: KeyPath, of: type[Frozen], many: str, words: JsonObject) -> JsonObject:
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


def _entry(of: type[Frozen], entry: Mapping[str, Any], place: KeyPath) -> JsonObject:
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


# -- what goes with an entry -----------------------------------------------------------------------


APART = 0.05
"""m from a bearing in the plane of its link to the second one."""


ROUNDED = 1e-9
"""rad by which angles of segments may miss a cycle."""


OTHERWISE = ("between", "values", "crank_angles", "spline", "table", "segments")
"""Keys of a law, but for those that go with segments."""


def completed(document: Document, entry: Entry, own: Machine) -> Document:
    """A document with what goes with an entry of it that is new, other or gone.

    own : the machine before.
    """
    place = entry.place
    if place[:1] == ("links",) and (len(place) == 2 or place[2] == "bodies"):
        return _as_given(document, entry)
    if place[:1] == ("bearings",):
        return _in_twos(document, entry, own)
    if len(place) > 2 and place[-2] == "segments":
        try:
            return _in_a_cycle(document, entry)
        except (KeyError, UsageError):
            return document  # its reader reports the error
    return document


def _as_given(document: Document, entry: Entry) -> Document:
    """Without what of a link was assumed, once its mass or a body is given."""
    values: Mapping[str, Any] = entry.values or {}
    of_link = len(entry.place) == 2
    name = str(entry.name or entry.place[1]) if of_link else str(entry.place[1])
    given = values.keys() & MASS_FIELDS if of_link else values and not values.get("assumed")
    bodies = document.content.get("links", {}).get(name, {}).get("bodies", ())
    for number in reversed(range(len(bodies))) if given else ():
        if bodies[number].get("assumed"):
            document = document.without(KeyPath(("links", name, "bodies", number)))
    return document


def _in_twos(document: Document, entry: Entry, own: Machine) -> Document:
    """With the second bearing of a link that got its first, which can be no sooner than that: as
    far on the other side of the link's plane.  With one that is deleted goes the other.
    """
    bearings: Mapping[str, Any] = document.content.get("bearings", {})
    if entry.values is None:
        gone = own.bearings.get(str(entry.place[-1]))
        for name in [
            name for name, bearing in bearings.items() if gone and bearing["link"] == gone.link
        ]:
            document = document.without(KeyPath(("bearings", name)))
        return document
    name, link = str(entry.name or entry.place[-1]), entry.values.get("link")
    if (
        link not in own.links
        or [bearing.get("link") for bearing in bearings.values()].count(link) != 1
    ):
        return document
    try:
        plane = parse(entry.values.get("plane"), "length")
    except UsageError:
        return document  # its own reader reports the error
    middle = own.links[str(link)].plane
    other = 2 * middle - plane if plane != middle else plane + APART
    second = next(item for item in map(f"{name}{{}}".format, count(2)) if item not in bearings)
    values = {"link": link, "plane": format_exact(clean(other, "length"), "length")}
    return document.put(KeyPath(("bearings", second)), values)


def _in_a_cycle(document: Document, entry: Entry) -> Document:
    """With segments that fill the cycle of their law: the one after that which is entered, or else
    the one before, takes what is left.  The first one stands in place of another way to give the
    law, and a second one leads back to where it begins.
    """
    way, number = entry.place.parent, entry.place[-1]
    law: Any = way.parent.read(document.content)
    segments = law.get("segments", [])
    overs = [parse(segment["over"], "angle") for segment in segments]
    left = 2 * pi * law.get("turns", 1) - sum(overs)
    if not segments or abs(left) < ROUNDED:
        return document
    if len(segments) == 1 and entry.values is not None:
        start = law.get("start") or law.get("between", [_none_of(segments[0]["to"])])[0]
        plain = {key: value for key, value in law.items() if key not in OTHERWISE}
        document = document.put(way.parent, {**plain, "start": start})
        neighbor, values = 1, {"to": start}
    else:
        after = int(number) + (entry.values is not None)
        neighbor = after if after < len(segments) else int(number) - 1
        left, values = left + overs[neighbor], segments[neighbor]
    if left <= 0:
        return document
    over = format_exact(clean(left, "angle"), "angle")
    return document.put(way / neighbor, {**values, "over": over})


def _none_of(text: str) -> str:
    """0 in the dimension of a quantity."""
    try:
        parse(text, "angle")
    except UsageError:
        return format_exact(0.0, "length")
    return format_exact(0.0, "angle")


# -- forms -----------------------------------------------------------------------------------------


def forms_of(of: type[keys.Frozen]) -> dict[str, JsonObject]:
    """The form of a table and of all below it, by the name of its class.

    Each has its controls, those of required keys first, and what the JSON Schema says of keys that
    go together.
    """
    by_name: dict[str, JsonObject] = {}
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


def control_of(key: keys.Key, siblings: Mapping[str, keys.Key]) -> JsonObject:
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


def _control(kind: keys.Kind) -> JsonObject:
    return CONTROLS[type(kind)](kind)


def _text(kind: keys.TextKind) -> JsonObject:
    if kind.names:
        return {"kind": "choice", "options": [*kind.names]}
    if kind.of == "output":  # of which a file may have others, such as those of rows
        return {"kind": "text", "of": kind.of}
    if kind.of:
        return {"kind": "name", "of": kind.of, "on": kind.on}
    return {"kind": "text", "options": [*kind.suggested]}


def _whole(kind: keys.Whole) -> JsonObject:
    return {"kind": "choice", "options": [*kind.names]} if kind.names else {"kind": "number"}


def _unit(dimension: Any) -> str:
    return display(dimension).unit


def _listing(kind: keys.Listing) -> JsonObject:
    """Some in a row; how many there can be is none for one and more."""
    return {"kind": "list", "item": _control(kind.item), "sizes": [*kind.sizes], "bare": False}


def _one_or(kind: keys.OneOr) -> JsonObject:
    return {"kind": "list", "item": _control(kind.item), "sizes": [1, kind.size], "bare": True}


def _place(kind: keys.Point) -> JsonObject:
    text = {"named": kind.named, "space": kind.space, "axes": kind.axes}
    return {"kind": "place", "unit": _unit("length"), **text}


CONTROLS: Mapping[type[keys.Kind], Callable[[Any], JsonObject]] = {
    keys.ParameterValue: lambda kind: {"kind": "text", "options": []},
    keys.DirectionKind: lambda kind: {"kind": "direction", "unit": _unit("angle")},
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


# -- types of what is sent, see `equipoise.web.protocol` -------------------------------------------


class AskingValues(TypedDict):
    """What is asked for: how, and in which unit."""

    kind: Literal[
        "quantity", "number", "text", "choice", "flag", "name", "place", "direction", "list",
        "names", "file", "wording",
    ]  # fmt: skip
    unit: NotRequired[str]
    options: NotRequired[list[str | int]]
    of: NotRequired[
        Annotated[Literal["link", "body", "point", "output"], "Of what it is the name."]
    ]
    on: NotRequired[
        Annotated[str | None, "The key of the same table that names the body of a point."]
    ]
    named: NotRequired[Annotated[bool, "Of places: or a point's name."]]
    space: NotRequired[Annotated[bool, "Of places: with z."]]
    axes: NotRequired[
        Annotated[str | None, "Of places: the key that names the link whose axes they are in."]
    ]
    item: NotRequired[AskingValues]
    sizes: NotRequired[Annotated[list[int], "How many there can be; none for one and more."]]
    bare: NotRequired[Annotated[bool, "Whether one stands without brackets."]]
    by: NotRequired[Annotated[AskingValues, "What names are of."]]
    listed: NotRequired[Annotated[bool, "Whether names alone may do."]]


class ControlValues(AskingValues):
    """A key of a table."""

    key: str
    word: str
    text: str
    required: bool
    default: Any | None
    example: Any | None


ConstantValues = TypedDict(
    "ConstantValues",
    {
        "const": NotRequired[Any],
        "enum": NotRequired[list[Any]],
        "type": NotRequired[str],
        "not": NotRequired["ConstantValues"],
    },
)
ConstantValues.__doc__ = "The values that a key has to have where a rule looks at it."

RuleValues = TypedDict(
    "RuleValues",
    {
        "required": NotRequired[list[str]],
        "properties": NotRequired[dict[str, Literal[False] | ConstantValues]],
        "allOf": NotRequired[list["RuleValues"]],
        "anyOf": NotRequired[list["RuleValues"]],
        "oneOf": NotRequired[list["RuleValues"]],
        "not": NotRequired["RuleValues"],
        "if": NotRequired["RuleValues"],
        "then": NotRequired["RuleValues"],
        "else": NotRequired["RuleValues"],
        "dependentRequired": NotRequired[dict[str, list[str]]],
        "dependentSchemas": NotRequired[dict[str, "RuleValues"]],
    },
)
RuleValues.__doc__ = "The part of a JSON Schema that states which keys go together."


class FormValues(TypedDict):
    """The keys of a table, and which of them go together."""

    controls: list[ControlValues]
    rule: RuleValues


class TableEntryValues(TypedDict):
    """A table of the file."""

    place: Annotated[str, "Its path in the file; empty of the whole file."]
    where: Annotated[str, "Its path, as refusals have it."]
    words: str
    values: dict[str, Any]
    below: Annotated[list[str], "Keys of the tables below it."]


class GroupValues(TypedDict):
    """Tables of one sort that a machine has, or can have."""

    place: Annotated[str, "Its path in the file; empty of the whole file."]
    where: str
    form: str
    many: Literal["one", "list", "named"]
    word: str
    text: str
    of: Annotated[str, "The entry that it belongs to."]
    needs: Annotated[str, "What has to be there first."]
    required: bool
    entries: list[TableEntryValues]
    result: NotRequired[Annotated[str, "What its entries are together."]]


class MenuItemValues(TypedDict):
    """A table that menus of the drawing offer to add, as it declares."""

    name: str
    place: Annotated[str, "Path of the table or of its list in the file."]
    values: Annotated[
        list[dict[str, MenuSource]],
        "What its keys begin with, of what the menu is opened at; the first that can be had.",
    ]


class TablesValues(TypedDict):
    """The tables of the model file, and the forms in which they are asked for."""

    type: Literal["tables"]
    seq: int
    groups: list[GroupValues]
    forms: dict[str, FormValues]
    bodies: Annotated[
        dict[str, dict[str, Pair]], "Points of the frame and of links, in their own axes, m."
    ]
    outputs: Annotated[dict[str, str], "What outputs that balancing can take are called, by name."]
