"""What a page may ask: its types, and the check, since nothing that it sends is trusted.

The types become TypeScript as `equipoise.web.protocol` says.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import Annotated, Any, Literal, NoReturn, NotRequired, TypedDict

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.keys import MOST_WHOLE
from equipoise.keys.paths import KeyPath
from equipoise.quantities.reading import described
from equipoise.quantities.units import HUGE
from equipoise.schema.files import LARGEST

JsonObject = dict[str, Any]
"""What a page is sent or sends: a JSON object."""
KINDS = (
    "ready",
    "speak",
    "open",
    "edit",
    "make",
    "undo",
    "redo",
    "balance",
    "run",
    "cancel",
    "compare",
    "outputs",
    "save",
    "arrows",
    "variant",
    "record",
    "stores",
    "study",
    "design",
    "download",
    "gallery",
    "tables",
    "entry",
)
SLOW = ("balance", "run", "download", "gallery")
"""Those that take more than a moment."""
MOST_EDITS, MOST_OUTPUTS, MOST_LANGUAGES = 100, 20, 50
DEEPEST = 8
"""Steps on the way to a value of a file."""
LONGEST_LABEL = 200
LARGEST_MESSAGE = 3 * LARGEST
"""Bytes: of a model file as JSON, in which signs take up to six times their place, but few do."""


@dataclass(frozen=True)
class Spot:
    """Where something is put: at a point that is there, or at a place.

    point : name.  place : in the frame, m.  on : the body that gets a point at that place; None
    where there is nothing.
    """

    point: str | None = None
    place: complex = 0j
    on: str | None = None


@dataclass(frozen=True)
class Setting:
    """A number that is set: to the text that was typed, or to a value in SI units.

    keep : points from which the one that it moves keeps its distance.
    """

    path: str
    to: str | float
    keep: tuple[str, ...] = ()


@dataclass(frozen=True)
class Drag:
    """A point, or the centre of mass of a link, that is dragged.

    name : of the point, or of the link.  of_mass : whether it is a centre of mass.
    to : place in the frame, m.  at : sample of the crank angle at which it is there.
    keep : points whose distance from it is locked.
    """

    name: str
    of_mass: bool
    to: complex
    at: int
    keep: tuple[str, ...] = ()


DraftEdit = Setting | Drag


@dataclass(frozen=True)
class Entry:
    """A table of the file that is put, or deleted.

    place : keys, names and numbers from 0 on the way to it.  values : of its keys, as in a file;
        None to delete it.  name : what it is called from now on, if it has a name.
    files : texts of CSV files that it names.
    """

    place: KeyPath
    values: Mapping[str, Any] | None
    name: str | None
    files: Mapping[str, str]


@dataclass(frozen=True)
class Message:
    """One thing that a page asks.

    kind : one of `KINDS`.  seq : number that the answer carries.  values : as JSON has them.
    """

    kind: str
    seq: int | None
    values: Mapping[str, Any]

    def text(self, key: str, usual: str | None = None) -> str:
        """A text of the message."""
        value = self.values.get(key, usual)
        if not isinstance(value, str):
            _wrong(f"{self.kind}: {key}", value, Note("a text"))
        return value

    def flag(self, key: str, usual: bool) -> bool:
        """A yes or no of the message."""
        value = self.values.get(key, usual)
        if not isinstance(value, bool):
            _wrong(f"{self.kind}: {key}", value, Note("true or false"))
        return value

    def optional(self, key: str) -> str | None:
        """A text of the message, if it has one there."""
        return None if self.values.get(key) is None else self.text(key)

    def whole(self, key: str, usual: int | None = None, label: Note | None = None) -> int:
        """A whole number of the message.  label : what a refusal calls it."""
        value = self.values.get(key, usual)
        if isinstance(value, bool) or not isinstance(value, int) or abs(value) > MOST_WHOLE:
            _wrong(label or f"{self.kind}: {key}", value, Note("a whole number"))
        return value

    def spot(self, key: str) -> Spot:
        """Where something is put: ``{"point": "B"}``, or ``{"place": [x, y], "on": "frame"}``."""
        value = self.values.get(key)
        wanted = Note(
            "a point such as {point}, or a place such as {place}",
            point='{"point": "B"}',
            place='{"place": [0.1, 0]}',
        )
        if not isinstance(value, dict):
            _wrong(f"{self.kind}: {key}", value, wanted)
        point, on = value.get("point"), value.get("on")
        if not isinstance(point, str | None) or not isinstance(on, str | None):
            _wrong(f"{self.kind}: {key}", value, wanted)
        return Spot(point) if point else Spot(None, _place(key, value.get("place")), on)

    def names(self, key: str = "names", most: int = MOST_OUTPUTS) -> tuple[str, ...]:
        """A list of names of the message, each once; of `outputs`, those that it asks for."""
        names = self.values.get(key)
        good = isinstance(names, list) and all(isinstance(name, str) for name in names)
        if not isinstance(names, list) or not good or len(names) > most:
            _wrong(f"{self.kind}: {key}", names, Note("a list of at most {most} names", most=most))
        return tuple(dict.fromkeys(names))

    @property
    def label(self) -> str:
        """What an edit is called in undo and redo."""
        text = "".join(sign for sign in self.text("label", "edit") if sign.isprintable())
        return text[:LONGEST_LABEL] or "edit"

    def changes(self) -> list[DraftEdit]:
        """The edits of a message of the kind `edit`.

        Raises
        ------
        UsageError : one of them is not as it should be.
        """
        edits = self.values.get("edits")
        if not isinstance(edits, list) or not 0 < len(edits) <= MOST_EDITS:
            _wrong(
                "edit: edits",
                edits,
                Note("a list of 1 to {most_edits} edits", most_edits=MOST_EDITS),
            )
        return [_change(edit) for edit in edits]

    def entry(self) -> Entry:
        """What a message of the kind `entry` does.

        Raises
        ------
        UsageError : something of it is not as it should be.
        """
        place, values = self.values.get("place"), self.values.get("values")
        name = self.values.get("name")
        whole = KeyPath(())  # the file
        path = (KeyPath.parse(place) if place else whole) if isinstance(place, str) else None
        if path is None or len(path) > DEEPEST:
            _wrong("entry: place", place, Note("the path of a table such as springs[1]"))
        if values is not None and not (isinstance(values, dict) and _is_plain(values, DEEPEST)):
            _wrong("entry: values", values, Note("a table of values as in a file"))
        if name is not None and not isinstance(name, str):
            _wrong("entry: name", name, Note("a text"))
        return Entry(path, values, name, self.files)

    @property
    def files(self) -> Mapping[str, str]:
        """Texts of CSV files by their names."""
        files = self.values.get("files", {})
        if not isinstance(files, dict) or not all(isinstance(file, str) for file in files.values()):
            _wrong(f"{self.kind}: files", files, Note("texts of files by their names"))
        return files

    @property
    def preview(self) -> bool:
        """Whether a newer edit makes this one needless."""
        return self.kind == "edit" and self.values.get("commit") is False


def read(text: str) -> Message:
    """Read a message from JSON.

    Raises
    ------
    UsageError : it is no message.
    """
    if len(text) > LARGEST_MESSAGE:
        raise UsageError(
            Note(
                "the message has {size:.0f} MB; at most {most:.0f} MB are read: give a model file",
                size=len(text) / 1e6,
                most=LARGEST / 1e6,
            )
        )
    try:
        return message_of(json.loads(text))
    except (ValueError, RecursionError) as error:  # ValueError: no JSON, or endless digits
        raise UsageError(Note("the message is no JSON that a page would send")) from error


def message_of(values: object) -> Message:
    """Check a message that has been read from JSON.

    Raises
    ------
    UsageError : it is no message.
    """
    if not isinstance(values, dict):
        _wrong(
            "the message", values, Note("an object such as {example}", example='{"type": "undo"}')
        )
    kind, seq = values.get("type"), values.get("seq")
    if seq is not None and (isinstance(seq, bool) or not isinstance(seq, int) or abs(seq) > HUGE):
        _wrong("seq", seq, Note("a whole number"))
    if kind not in KINDS:
        _wrong("type", kind, Note("one of {names}", names=", ".join(KINDS)))
    return Message(kind, seq, values)


def _is_plain(value: object, deep: int) -> bool:
    """Whether a file could have it, so deep at most."""
    if isinstance(value, dict | list):
        inner = value.values() if isinstance(value, dict) else value
        return deep > 0 and all(_is_plain(item, deep - 1) for item in inner)
    return isinstance(value, str | int | float)


def makes_way(older: Message | UsageError, newer: Message | UsageError) -> bool:
    """Whether an edit that waits was only tried, and another comes."""
    if isinstance(older, UsageError) or isinstance(newer, UsageError):
        return False
    return older.preview and newer.kind == "edit"


def _change(edit: object) -> DraftEdit:
    if not isinstance(edit, dict):
        _wrong(
            "an edit",
            edit,
            Note(
                "an object such as {example}", example='{"set": "drive.speed", "text": "193 rpm"}'
            ),
        )
    given = [kind for kind in ("set", "move", "move_mass") if kind in edit]
    if len(given) != 1 or not isinstance(edit[given[0]], str):
        _wrong("an edit", edit, Note("one of set, move and move_mass, with a name"))
    kind, name = given[0], edit[given[0]]
    keep = edit.get("keep", [])
    if not isinstance(keep, list) or not all(isinstance(item, str) for item in keep):
        _wrong("keep", keep, Note("a list of points"))
    if kind == "set":
        return Setting(name, _typed(edit), tuple(keep))
    at = edit.get("at", 0)
    if isinstance(at, bool) or not isinstance(at, int):
        _wrong("at", at, Note("the number of a crank angle"))
    return Drag(name, kind == "move_mass", _place("to", edit.get("to")), at, tuple(keep))


def _typed(edit: Mapping[str, Any]) -> str | float:
    """What is to be set: a text such as ``"71.5 mm"``, or a value in SI units."""
    if isinstance(edit.get("text"), str):
        text: str = edit["text"]
        return text
    return _number("value", edit.get("value"))


def _place(what: str, value: object) -> complex:
    if not isinstance(value, list) or len(value) != 2:
        _wrong(what, value, Note("x and y in m"))
    return complex(_number(what, value[0]), _number(what, value[1]))


def _number(what: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        _wrong(what, value, Note("a number in SI units"))
    if not abs(value) <= HUGE or not isfinite(value):
        _wrong(what, value, Note("a number of usual size in SI units"))
    return float(value)


def _wrong(what: str | Note, value: object, wanted: Note) -> NoReturn:
    raise UsageError(
        at_place(what, Note("got {given}; give {wanted}", given=described(value), wanted=wanted))
    )


Pair = tuple[float, float]


class TypedEdit(TypedDict):
    """A number is set to the text that was typed."""

    set: str
    text: str
    keep: NotRequired[
        Annotated[list[str], "Points whose distance from the one that is moved is locked."]
    ]


class NumberEdit(TypedDict):
    """A number is set to a value in SI units."""

    set: str
    value: float


class DragEdit(TypedDict):
    """A point is dragged."""

    move: str
    to: Pair
    at: Annotated[int, "Sample of the crank angle at which it is there."]
    keep: NotRequired[list[str]]


class MassDragEdit(TypedDict):
    """The centre of mass of a link is dragged."""

    move_mass: str
    to: Pair
    at: int


Edit = TypedEdit | NumberEdit | DragEdit | MassDragEdit
DownloadKind = Literal["model", "csv", "report", "drawing", "film", "played", "interactive"]


class ReadyRequest(TypedDict):
    """The page is there."""

    type: Literal["ready"]


class LanguageRequest(TypedDict):
    """The languages of the reader."""

    type: Literal["speak"]
    languages: Annotated[list[str], "Codes, the one that is liked best first."]


class ExampleRequest(TypedDict):
    """A bundled model is opened."""

    type: Literal["open"]
    example: str


class NewRequest(TypedDict):
    """A machine is begun."""

    type: Literal["open"]
    new: Literal[True]


class FileRequest(TypedDict):
    """A model file is opened."""

    type: Literal["open"]
    name: str
    text: str
    file: NotRequired[
        Annotated[Literal[True], "It is what the file held that the server was started with."]
    ]
    files: NotRequired[Annotated[dict[str, str], "Texts of its tables."]]


class EditRequest(TypedDict):
    """Numbers and places are changed."""

    type: Literal["edit"]
    commit: bool
    label: str
    edits: list[Edit]


class MadeValues(TypedDict):
    """An operation on the parts of a machine, with what it needs."""

    do: str


class MakeRequest(MadeValues):
    """Parts of a machine are added, changed or taken away."""

    type: Literal["make"]
    at: int


class PlainRequest(TypedDict):
    """What needs to be said by its name alone."""

    type: Literal["undo", "redo", "save", "gallery", "tables", "stores"]


class BalanceRequest(TypedDict):
    """The machine is to be balanced."""

    type: Literal["balance"]
    hold: NotRequired[Annotated[bool, "Whether gauges may not read more."]]


class RunRequest(TypedDict):
    """The machine is to run, driven by its motor, weight, springs and loads."""

    type: Literal["run"]


class CompareRequest(TypedDict):
    """Comparison with the machine as it was before balancing ends."""

    type: Literal["compare"]
    on: Literal[False]


class EntryRequest(TypedDict):
    """A table is put, or deleted where it has no values."""

    type: Literal["entry"]
    label: str
    place: Annotated[str, "Its path in the file, such as `springs[1]`; empty of the whole file."]
    values: dict[str, Any] | None
    name: NotRequired[str]
    files: NotRequired[Annotated[dict[str, str], "Texts of CSV files that it names."]]


class OutputsRequest(TypedDict):
    """Outputs whose samples are wanted."""

    type: Literal["outputs"]
    names: list[str]


class DownloadRequest(TypedDict):
    """A file of the machine."""

    type: Literal["download"]
    kind: DownloadKind
    language: NotRequired[str]
    at: NotRequired[int]
    format: NotRequired[Literal["svg", "png"]]


class ChartRequest(TypedDict):
    """The picture of a chart."""

    type: Literal["download"]
    kind: Literal["chart"]
    chart: str
    choice: str
    format: Literal["svg", "png"]


class ArrowsRequest(TypedDict):
    """The point at which arrows are drawn."""

    type: Literal["arrows"]
    point: str


class PinRequest(TypedDict):
    """The design is kept as a variant."""

    type: Literal["variant"]
    do: Literal["pin"]


class RenameRequest(TypedDict):
    """A variant is called something else."""

    type: Literal["variant"]
    do: Literal["rename"]
    name: str
    to: str


class VariantRequest(TypedDict):
    """A variant is taken up, or dropped."""

    type: Literal["variant"]
    do: Literal["go", "drop"]
    name: str


class AgainstRequest(TypedDict):
    """With what figures are compared."""

    type: Literal["variant"]
    do: Literal["against"]
    to: str


class RecordRequest(TypedDict):
    """A measured record is laid over the curves."""

    type: Literal["record"]
    name: str
    text: str


class StudyRequest(TypedDict):
    """A store of a study is opened."""

    type: Literal["study"]
    store: NotRequired[Annotated[str, "Another one of the server's folder."]]


class DesignRequest(TypedDict):
    """A design of a study is opened."""

    type: Literal["design"]
    number: int
    store: str


class CancelRequest(TypedDict):
    """Questions that take long are given up."""

    type: Literal["cancel"]


PageRequest = (
    ReadyRequest | LanguageRequest | ExampleRequest | NewRequest | FileRequest | EditRequest
    | MakeRequest | PlainRequest | BalanceRequest | RunRequest | CompareRequest | EntryRequest
    | OutputsRequest | DownloadRequest | ChartRequest | ArrowsRequest | PinRequest | RenameRequest
    | VariantRequest | AgainstRequest | RecordRequest | StudyRequest | DesignRequest
    | CancelRequest
)  # fmt: skip
"""All that a page asks, beside the number of the question (``seq``)."""
