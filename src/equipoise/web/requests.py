"""Types of what a page asks, which `web.messages` checks; written as `web.protocol` says."""

from __future__ import annotations

from typing import Annotated, Any, Literal, NotRequired, TypedDict

from equipoise.web.table_types import Pair


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
FileKind = Literal["model", "csv", "report", "drawing", "film", "played", "interactive"]


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
    kind: FileKind
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


Asked = (
    ReadyRequest | LanguageRequest | ExampleRequest | NewRequest | FileRequest | EditRequest
    | MakeRequest | PlainRequest | BalanceRequest | RunRequest | CompareRequest | EntryRequest
    | OutputsRequest | DownloadRequest | ChartRequest | ArrowsRequest | PinRequest | RenameRequest
    | VariantRequest | AgainstRequest | RecordRequest | StudyRequest | DesignRequest
    | CancelRequest
)  # fmt: skip
"""All that a page asks, beside the number of the question (``seq``)."""
