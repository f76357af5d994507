"""Numbers of a model file in words, such as ``mass of the crank``, from what their keys are called.

A key says what its number is called (`Key.word`), a kind of object what a number of such an object
is (`Frozen.called`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from string import Formatter
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    Key,
    KeyTable,
    Listing,
    Named,
    OneOr,
    ParameterValue,
    Planes,
    Point,
    Tables,
    all_keys,
)
from equipoise.keys import Kind as KeyKind
from equipoise.keys.paths import KeyPath
from equipoise.schema.finding import Content, NumberLocation
from equipoise.schema.numbers import vector_of
from equipoise.schema.opening import Kind, document_of

PARTS = {
    "distance": to_say("distance"),
    "direction": to_say("direction"),
    "vertical": to_say("vertical"),
    "lateral": to_say("lateral"),
}
"""Parts of vectors and pairs of planes; x, y and z are called so everywhere."""


NAMED: Mapping[type[KeyKind], str] = {
    Point: to_say("point {name}"),
    ParameterValue: to_say("parameter {name}"),
}
"""What is called by the name that a user has chosen for it."""


@dataclass(frozen=True)
class Layer:
    """A key on the way to a number.

    held : kind of what stands there.  names : for placeholders: ``name``, or ``number`` and the
    texts of the entry of a list.
    """

    key: Key
    held: KeyKind
    names: Mapping[str, str]

    @property
    def word(self) -> str:
        """Of a number that stands here."""
        named = NAMED.get(type(self.held)) if isinstance(self.key.kind, Named) else None
        return self.key.word or named or plain_word(self.key)

    @property
    def called(self) -> str:
        """Around a number in what stands here; nothing where that is no table."""
        return self.held.type.called if isinstance(self.held, KeyTable) else ""


def plain_word(key: Key) -> str:
    """What a key is called that says nothing else."""
    return (key.field or key.name).replace("_", " ")


def words_of(
    content: Content,
    kind: Kind,
    location: NumberLocation,
    others: Collection[str] = (),
    known: int = 0,
) -> Note | None:
    """The number that stands at a place in words; None where its keys have none.

    Of a point on the x axis of a body, or told by its distance, it is the length from the point in
    the origin of that body, where there is one, and the other coordinate is not among the `others`
    beside which it is told.

    known : how many tables on the way to it, from the top, are named by a heading, so that the
        words leave them out.
    """
    layers = _layers(content, kind, location.place)
    if not layers:
        return None
    *around, last = layers
    around = around[known:]
    other = location.place / "y"
    length = None if other in map(KeyPath.parse, others) else _length(content, location)
    what = length or Note(last.word, **last.names)
    for above, layer in enumerate(reversed(around)):
        alone = isinstance(layer.key.kind, KeyTable)
        if not layer.called and not (alone and above):
            return None
        if not (alone and above):  # a table tells what stands in it, not what is further down
            what = Note(layer.called, **layer.names, what=what)
    for part in () if length else (_number(last), location.part or last.names.get("part")):
        if part:
            named = Note(PARTS[part]) if part in PARTS else part
            what = Note("{what}, {part}", what=what, part=named)
    return what


def _number(layer: Layer) -> str:
    """Which number of several it is, where its word does not say that."""
    flag = any(name == "number" for _, name, _, _ in Formatter().parse(layer.word))
    return "" if flag else layer.names.get("number", "")


def _layers(content: Content, kind: Kind, place: KeyPath) -> list[Layer]:
    """Keys on the way to a place; none where they are not known."""
    key_kind: KeyKind = KeyTable(document_of(kind))
    here: Any = content
    layers: list[Layer] = []
    for step in place:
        here = _below(here, step)
        if isinstance(key_kind, KeyTable):
            key = all_keys(key_kind.type).get(str(step))
            if key is None:
                return []
            key_kind, names = key.kind, {}
        elif isinstance(key_kind, Named):
            key, key_kind, names = layers.pop().key, key_kind.item, {"name": str(step)}
        elif isinstance(key_kind, Planes):
            key, key_kind, names = layers.pop().key, key_kind.item, {"part": str(step)}
        elif isinstance(key_kind, Tables | Listing | OneOr):
            entry = here if isinstance(here, dict) else {}
            names = {name: text for name, text in entry.items() if isinstance(text, str)}
            names["number"] = str(int(step) + 1)
            key, key_kind = layers.pop().key, key_kind.item
        else:
            return []
        layers.append(Layer(key, key_kind, names))
    return layers


def _below(here: Any, step: str | int) -> Any:
    if isinstance(here, dict):
        return here.get(step)
    return here[step] if isinstance(here, list) and isinstance(step, int) else None


def _length(content: Content, location: NumberLocation) -> Note | None:
    """The length of a body from the point in its origin to one whose distance from there it is."""
    if location.place[-2:-1] != ("points",) or location.part not in ("x", "distance"):
        return None
    points = location.place.parent.read(content)
    if not isinstance(points, dict):  # a list of points has no origin among them
        return None
    places = {name: vector_of(point) for name, point in points.items()}
    name = str(location.place[-1])
    own = places.pop(name)
    origins = [other for other, place in places.items() if place and not any(place.components)]
    along = own is not None and own.components[0] > 0 and not any(own.components[1:])
    if not origins or not (along or location.part == "distance"):
        return None
    return Note("length {first}–{second}", first=origins[0], second=name)
