"""Finding a number in the content of a model file by its path, and naming it in words.

A key says what its number is called (`Key.word`), a kind of object what a number of such an object
is (`Frozen.called`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import field
from numbers import Real
from string import Formatter
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of, to_say
from equipoise.keys import (
    PLANES,
    Key,
    KeyTable,
    Listing,
    Named,
    OneOr,
    ParameterValue,
    Planes,
    Point,
    Tables,
    Whole,
    all_keys,
)
from equipoise.keys import Kind as KeyKind
from equipoise.keys.paths import KeyPath, with_values
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.shown_units import SIGN
from equipoise.quantities import KINDS, Dimension
from equipoise.quantities.reading import described
from equipoise.schema.numbers import (
    POLAR,
    XYZ,
    FileNumber,
    FileVector,
    PlanePair,
    read_number,
    unit_of,
    vector_of,
)
from equipoise.schema.open_files import ModelKind, document_of
from equipoise.schema.writing import plain_default

Content = Mapping[str, Any]


@dataclass(frozen=True)
class NumberLocation:
    """Where a number stands.

    place : of the number itself, or of the vector or pair of planes whose `part` it is.
    rest : path inside of the linkage whose file is named there; then `number` is not known here.
    defaults : lists that the file leaves out and of which the number is one, by their places.
    """

    place: KeyPath
    number: FileNumber | None = None
    whole: FileVector | PlanePair | None = None
    part: str = ""
    rest: str = ""
    defaults: Mapping[KeyPath, Any] = field(default_factory=dict)


def find(content: Content, kind: ModelKind, path: str) -> NumberLocation:
    """Where the number of a path stands.

    Raises
    ------
    ModelError : there is none; `where` is the path.
    """
    steps = KeyPath.parse(path)
    place = KeyPath()
    here: Any = content
    defaults: dict[KeyPath, Any] = {}
    for count, step in enumerate(steps):
        group = _group(here, step, kind, place) if count == len(steps) - 1 else None
        if group is not None:
            part = XYZ[step] if isinstance(step, int) else step
            return NumberLocation(place, group.numbers[part], group, part)
        if kind == "tool" and place[-1:] == ("linkage",) and isinstance(here, str):
            return NumberLocation(place, rest=str(KeyPath(steps[count:])))
        below = _below(content, kind, path, place / step, here)
        place = place / step
        if isinstance(here, dict) and step not in here and isinstance(below, list):
            defaults[place] = below
        here = below
    number = read_number(here, isinstance(here, int) and is_whole(kind, place))
    if number is None:
        raise ModelError(path, _no_number(path, here))
    return NumberLocation(place, number, defaults=defaults)


def all_numbers(content: Content, kind: ModelKind) -> dict[str, FileNumber]:
    """Every number that is written in a model file, by its path."""
    return dict(_walk(content, KeyPath(), kind))


def _walk(here: Any, place: KeyPath, kind: ModelKind) -> Iterator[tuple[str, FileNumber]]:
    vector, number = _vector_at(kind, place, here), read_number(here)
    if vector is not None:
        for part, component in vector.numbers.items():
            yield str(place / part), component
    elif number is not None and place != ("schema",):
        yield str(place), number
    elif isinstance(here, dict | list):
        for key, below in here.items() if isinstance(here, dict) else enumerate(here):
            yield from _walk(below, place / key, kind)


def _vector_at(kind: ModelKind, place: KeyPath, here: Any) -> FileVector | None:
    """The vector at a place, or None: lengths in a list that is no point are values of their own,
    such as the two ends of a lift.
    """
    vector = vector_of(here)
    if vector is not None and vector.dimension == "length":
        return None if isinstance(_kind_at(kind, place), Listing) else vector
    return vector


def _group(
    here: Any, step: str | int, kind: ModelKind, place: KeyPath
) -> FileVector | PlanePair | None:
    """The vector or pair of planes that has a number of that name, or None."""
    if kind == "tool" and step in PLANES and isinstance(here, str):
        number = read_number(here)
        return None if number is None else PlanePair(here, number)
    vector = _vector_at(kind, place, here)
    if vector is None:
        return None
    if isinstance(step, int):
        return vector if step < len(vector.components) else None
    return vector if step in vector.numbers else None


# -- what the file can have at a place -------------------------------------------------------------


def key_at(kind: ModelKind, place: KeyPath) -> Key | None:
    """The key at the end of a place; None where it is a name of the user's, or unknown."""
    above = _kind_at(kind, place.parent)
    return all_keys(above.type).get(str(place[-1])) if isinstance(above, KeyTable) else None


def is_whole(kind: ModelKind, place: KeyPath) -> bool:
    """Whether only whole numbers will do at a place."""
    return isinstance(_kind_at(kind, place), Whole)


def _kind_at(kind: ModelKind, place: KeyPath) -> KeyKind | None:
    """What stands at a place; None where nothing is known of it."""
    key_kind: KeyKind | None = KeyTable(document_of(kind))
    for step in place:
        if isinstance(key_kind, KeyTable):
            item = all_keys(key_kind.type).get(str(step))
            key_kind = None if item is None else item.kind
        elif isinstance(key_kind, Named | Tables | Listing | OneOr):
            key_kind = key_kind.item
        else:
            return None
    return key_kind


# -- one step --------------------------------------------------------------------------------------


def _below(content: Content, kind: ModelKind, path: str, place: KeyPath, here: Any) -> Any:
    """What stands at a place, of which `here` stands above; what is left out is its default."""
    step = place[-1]
    if isinstance(step, int) and isinstance(here, list) and step < len(here):
        return here[step]
    if isinstance(here, dict):
        if step in here:
            return here[step]
        key = key_at(kind, place)
        default = None if key is None else plain_default(key)
        if default is not None:
            return default
        if key is not None:
            missing = place.abbreviated
            raise ModelError(
                path,
                Note(
                    "{missing} is not written in the model; add it there to vary it",
                    missing=missing,
                ),
            )
    if expression := _expression_in_point(here, step):
        raise ModelError(path, _worked_out(path, expression))
    raise ModelError(path, unknown(path, all_numbers(content, kind), "number of the model"))


def _expression_in_point(here: Any, step: str | int) -> str | None:
    """The first expression in a point, which has no part that could vary beside it."""
    if isinstance(here, dict) and here.keys() == {*POLAR}:
        here = [*here.values()]
    if step not in (*XYZ, *POLAR) or not isinstance(here, list):
        return None
    return next((item for item in here if _is_expression(item)), None)


def _is_expression(here: Any) -> bool:
    return isinstance(here, str) and here.startswith(SIGN)


def _worked_out(path: str, expression: str) -> Note:
    return Note(
        "{path} is worked out by {expression!r}; let a parameter in it vary",
        path=path,
        expression=expression,
    )


def _no_number(path: str, here: Any) -> Note:
    if _is_expression(here):
        return _worked_out(path, here)
    vector = vector_of(here)
    if vector is not None:
        parts = [f"{path}.{part}" for part in vector.numbers]
        return Note(
            "{path} is more than one number; give {names} or {parts}",
            path=path,
            names=", ".join(parts[:-1]),
            parts=parts[-1],
        )
    what = described(here)
    return Note("{path} is {what}; give the path of one number", path=path, what=what)


NumberChange = tuple[str, NumberLocation, float]
"""Path of a number, where it stands, and what is to stand there."""


def replaced(content: Content, given: Iterable[NumberChange]) -> dict[str, Any]:
    """The content with other numbers.

    Raises
    ------
    ModelError : a value is none, or two paths mean the same number; `where` is the path.
    """
    changes: dict[KeyPath, Any] = {}
    defaults: dict[KeyPath, Any] = {}
    parts: dict[KeyPath, dict[str, float]] = {}
    wholes: dict[KeyPath, FileVector | PlanePair] = {}
    for path, result, value in given:
        if isinstance(value, bool) or not isinstance(value, Real):
            raise ModelError(path, Note("got {value!r}; give a number", value=value))
        defaults |= result.defaults
        siblings = parts.setdefault(result.place, {})
        _check_company(path, result, siblings, result.place in changes)
        if result.whole is not None:
            siblings[result.part] = value
            wholes[result.place] = result.whole
        elif result.number is not None:
            changes[result.place] = result.number.written(value)
    changes |= {place: whole.changed(parts[place]) for place, whole in wholes.items()}
    return with_values(with_values(content, defaults), changes)


def _check_company(
    path: str, location: NumberLocation, siblings: Mapping[str, float], taken: bool
) -> None:
    """Refuse a number that others have changed already."""
    if taken or location.part in siblings or (siblings and not location.part):
        raise ModelError(
            path, Note("{path} is a number that varies already; leave one of them out", path=path)
        )
    forms = {key in POLAR for key in (location.part, *siblings)}
    if isinstance(location.whole, FileVector) and len(forms) == 2:
        above = path.rpartition(".")[0]
        raise ModelError(
            path,
            Note(
                "{path} cannot vary beside {other}; let either {cartesian} or {polar} of "
                "a point vary",
                path=path,
                other=f"{above}.{next(iter(siblings))}",
                cartesian=all_of(XYZ[:2]),
                polar=all_of(POLAR),
            ),
        )


SHARE = "%"


def unit_in(content: Mapping[str, Any], location: NumberLocation) -> str:
    """Unit in which a model file gives a number; one that is usual where it has none.

    Returns
    -------
    str
        ``mm``, ``%`` of a share, nothing of a plain number.
    """
    number = location.number
    if number is None or number.share:
        return SHARE if number is not None else ""
    if number.dimension is None:
        return ""
    for given in _given(content, location):
        read = read_number(given)
        if read is not None and read.dimension == number.dimension:
            return unit_of(given)
    return handy(number.dimension)


def handy(dimension: Dimension) -> str:
    """Customary unit of quantities of a dimension."""
    return KINDS[dimension].printed[0]


def _given(content: Mapping[str, Any], location: NumberLocation) -> Iterator[Any]:
    """What stands in the file where a number does: first its own text, then those beside it."""
    try:
        here = location.place.read(content)
    except KeyError:
        return  # left out, so that a default stands for it
    if isinstance(here, dict):
        yield from (here[key] for key in sorted(here, key=lambda key: key != location.part))
    elif isinstance(here, list):
        yield from here[XYZ.index(location.part) :] if location.part in XYZ else ()
        yield from here
    else:
        yield here


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

    kind : kind of what stands there.  names : for placeholders: ``name``, or ``number`` and the
    texts of the entry of a list.
    """

    key: Key
    kind: KeyKind
    names: Mapping[str, str]

    @property
    def word(self) -> str:
        """Of a number that stands here."""
        named = NAMED.get(type(self.kind)) if isinstance(self.key.kind, Named) else None
        return self.key.word or named or plain_word(self.key)

    @property
    def called(self) -> str:
        """Around a number in what stands here; nothing where that is no table."""
        return self.kind.type.called if isinstance(self.kind, KeyTable) else ""


def plain_word(key: Key) -> str:
    """What a key is called that says nothing else."""
    return (key.field or key.name).replace("_", " ")


def words_of(
    content: Content,
    kind: ModelKind,
    location: NumberLocation,
    others: Collection[str] = (),
    known: int = 0,
) -> Note | None:
    """The number that stands at a place in words; None where its keys have none.

    Of a point on the x axis of a body, or given by its distance, it is the length from the point in
    the origin of that body, where there is one, and the other coordinate is not among the `others`
    beside which it is named.

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
        if not (alone and above):  # a table names its own keys, not those of tables in it
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


def _layers(content: Content, kind: ModelKind, place: KeyPath) -> list[Layer]:
    """Keys on the way to a place; none where they are not known."""
    key_kind: KeyKind = KeyTable(document_of(kind))
    here: Any = content
    layers: list[Layer] = []
    for step in place:
        here = _item_below(here, step)
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


def _item_below(here: Any, step: str | int) -> Any:
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
