"""Types of the messages between a page and its server, in both directions: `page/src/messages.ts`
is written from them by ``python page/messages.py``.

A class is a JSON object, its fields are the keys.  The text of an `Annotated` field becomes the
comment in TypeScript; the class ``NameValues`` becomes the interface ``Name``, and what stands in
`ALIASES` a name of a type.  `Any` is any value of JSON.  Lengths in m, angles in rad, all else in
SI.
"""

from __future__ import annotations

from typing import Annotated, Literal, NotRequired, TypedDict

from equipoise.keys import MenuSource
from equipoise.web.messages import DownloadKind, Edit, MadeValues, MakeRequest, PageRequest, Pair
from equipoise.web.tables import MenuItemValues, TablesValues

Arrays = dict[str, tuple[int, int]]
"""Name of an array -> its offset and length in the block of floats."""
DrawnShape = Annotated[
    tuple[str, bool, float, float, list[float]],
    "Role, whether it is closed, radius of a circle (m, and pixels; one of them is not 0), and x, y"
    " (m) and offsets from there (pixels) of each corner; y upward.",
]


class UnitValues(TypedDict):
    """The unit in which a number is shown."""

    unit: str
    factor: Annotated[float, "How many of the unit an SI unit is."]


class StatusValues(TypedDict):
    """Whether a machine can be computed, and what it lacks otherwise."""

    mobility: Annotated[int, "Degrees of freedom; the drive commands one."]
    text: Annotated[str, "What moves, or what is missing."]
    finished: bool
    drive: str | None
    stand: NotRequired[Annotated[float | None, "Crank angle at which it was drawn, degrees."]]


class FieldValues(UnitValues):
    """A number of the machine that can be edited."""

    path: str
    group: str
    heading: Annotated[str, "Title of the group."]
    label: str
    value: float
    text: Annotated[str, "With all digits that are kept, as it is typed."]
    shown: Annotated[str, "Rounded, for display."]
    kind: Literal["number"]
    min: NotRequired[float | None]
    max: NotRequired[float | None]
    step: NotRequired[float | None]
    pair: NotRequired[Annotated[str, "Label of the place whose x or y it is, both shown together."]]
    moves: NotRequired[Annotated[str, "The point that a length or direction moves."]]
    between: NotRequired[Annotated[tuple[str, str], "Ends of a length between points."]]


class BodyValues(TypedDict):
    """A link, with its points."""

    name: str
    points: list[str]


class GuideValues(TypedDict):
    """A guide, with the point that slides on it."""

    name: str
    point: str


class HoldValues(TypedDict):
    """Origin of a sign's axes, and what its x axis follows: a link, a guide, or a second point."""

    point: NotRequired[str]
    link: NotRequired[str]
    guide: NotRequired[str]
    to: NotRequired[str]
    length: NotRequired[float]
    rigid: NotRequired[Annotated[bool, "Whether the length between two points is constant."]]
    mount: NotRequired[str]
    at: NotRequired[Annotated[Pair, "Place of a mount on the support at rest, m."]]
    ground: NotRequired[Annotated[Pair, "From there to its ground, pixels."]]


class SignValues(TypedDict):
    """A part of the drawing, in its own axes; without a hold it does not move."""

    ground: Annotated[bool, "Whether it is around the linkage, and paths are drawn on it."]
    compared: Annotated[bool, "Whether a pale design beside another is drawn by it."]
    link: Annotated[str, "The link that it draws, if any."]
    hold: HoldValues | None
    part: Annotated[
        tuple[str, str] | None,
        "The slider or coupling that it draws, if any: `slider`, or its list, and its name.",
    ]
    still: Annotated[bool, "Whether it is fixed to the ground, and not to the support."]
    shapes: list[DrawnShape]


class CircleValues(TypedDict):
    """A circle that can be dragged, opposite to a point."""

    name: str
    table: Annotated[str, "List of the file that has its part."]
    path: str
    radius: Annotated[float, "m"]
    axis: str
    point: str


class SceneValues(TypedDict):
    """The drawing of a machine."""

    frame: list[str]
    standing: Annotated[list[str], "Points of the frame that hold something."]
    bodies: list[BodyValues]
    guides: list[GuideValues]
    mass_centers: list[str]
    box: tuple[float, float, float, float]
    movable: list[str]
    circles: list[CircleValues]
    signs: Annotated[list[SignValues], "From the back to the front."]
    reference: Annotated[Pair | None, "Centre of a support's rotation, m."]
    looks: Annotated[dict[str, str], "Role of a shape -> its style."]


class OutputValues(UnitValues):
    """An output that can be plotted over the crank angle; its samples are sent on request."""

    name: str
    label: str
    group: Annotated[str, "Heading under which it is offered."]
    winds: Annotated[bool, "Whether it is an angle, which may turn fully."]


class FigureValues(TypedDict):
    """RMS or peak of a signal, and that of the design it is compared with."""

    name: str
    signal: str
    measure: Literal["rms", "peak"]
    label: str
    unit: str
    value: Annotated[float | None, "Null if it is not finite."]
    before: NotRequired[float | None]
    text: str
    was: NotRequired[Annotated[str, "Previous value and change; empty if it is the same."]]


class ArrowOfValues(UnitValues):
    """A vector at a point over the crank angle."""

    kind: Literal["velocity", "acceleration", "force"]
    array: str
    label: str


class CurveOfValues(TypedDict):
    """A curve of a chart: every `stride`th number of an array, beginning with `part`."""

    array: str
    stride: int
    part: int
    label: str
    points: NotRequired[Annotated[bool, "Whether it is points alone, without a line."]]


class ChoiceValues(UnitValues):
    """A signal that a chart can show."""

    name: str
    label: str
    of: Annotated[
        str | None,
        'Whose forces have to be shown for it: "rows." of all rows, "" of one row; null for any.',
    ]
    log: Annotated[bool, "Whether the scale is logarithmic."]
    curves: list[CurveOfValues]


class AxisValues(UnitValues):
    """An array as the x axis of a chart, and the machine's place on it."""

    array: str
    at: Annotated[float | None, "Null where it follows what is played."]


class ChartDataValues(TypedDict):
    """A chart: its x axis and the signals that it can show."""

    name: str
    x: Literal["angle", "order"] | AxisValues
    chooser: Annotated[str | None, "Label of its selection; null if it follows another chart's."]
    choices: list[ChoiceValues]


class WordingValues(TypedDict):
    """Texts of this machine that replace those of others, by English text and by chart."""

    words: dict[str, str]
    explained: dict[str, str]


class ModelFileValues(TypedDict):
    """The file that can be saved, and whether it holds the present model."""

    name: str
    saved: bool
    comments: bool


class MeasuredRecordValues(TypedDict):
    """A measured record, and how the machine compares with it."""

    name: str
    lines: list[str]
    left_out: list[str]


class PlantingValues(TypedDict):
    """Tips of planting fingers, and the height of the soil's surface."""

    tips: list[str]
    surface: float


class StateMessage(TypedDict):
    """A machine, finished or not, with everything that is drawn of it."""

    type: Literal["state"]
    seq: Annotated[int, "Number of the question that it answers."]
    name: str
    title: str
    description: str
    undo: str | None
    redo: str | None
    steps: Annotated[Pair, "How many steps can be undone and redone."]
    design: Annotated[int, "The same as long as the same design is shown."]
    file: ModelFileValues | None
    angles: int
    turns: int
    speed: float
    length: Annotated[UnitValues, "Unit of the drawing's lengths."]
    lacking: Annotated[str, "Why there are no forces, and nothing to balance; empty if there are."]
    shaken: NotRequired[Annotated[bool, "Whether the gauges of a support have readings."]]
    fields: list[FieldValues]
    wording: WordingValues
    scene: SceneValues
    arrays: Arrays
    figures: list[FigureValues]
    outputs: list[OutputValues]
    charts: list[ChartDataValues]
    first: Annotated[
        Literal["squares", "output", "answers"], "The charts that show the purpose of the machine."
    ]
    traced: Annotated[list[str], "Points whose paths are drawn, the most important first."]
    least: Annotated[float, "Size below which a force or moment is drawn as 0, N and N m."]
    orders: list[float]
    notes: list[str]
    held: NotRequired[Annotated[str | None, "Why a point is not where it was dragged to."]]
    before: Annotated[bool, "Whether curves of another design are drawn behind."]
    status: StatusValues
    compared: Annotated[bool, "Whether figures of another design are shown."]
    points: Annotated[list[str], "Points at which arrows can be drawn."]
    arrows_at: Annotated[str | None, "The point at which they are drawn."]
    record: Annotated[MeasuredRecordValues | None, "Its signals are `measured.` and an output."]
    arrows: list[ArrowOfValues]
    planting: NotRequired[PlantingValues | None]
    beside: NotRequired[Annotated[bool, "Whether links lie in different planes."]]


# -- what else a page is sent ----------------------------------------------------------------------

DrawnDisplacements = Annotated[
    list[float], "Real and imaginary parts along the shaft or support, as large as they are drawn."
]
AnsweredNumber = Annotated[
    int | None, "Number of the question that it answers; null for what comes later."
]


class ExampleValues(TypedDict):
    """A bundled model."""

    name: str
    title: str


class NumberRulesValues(TypedDict):
    """How numbers are written everywhere in the product."""

    least: Annotated[float, "Sizes between which there is no power of ten."]
    most: float
    units: Annotated[list[str], "What may follow a number in a sentence; longer ones first."]
    lengths: Annotated[dict[str, float], "m in each unit in which a length may be typed."]


class HelloValues(TypedDict):
    """The first message of a server."""

    type: Literal["hello"]
    version: str
    examples: list[ExampleValues]
    tools: list[ExampleValues]
    study: NotRequired[Annotated[str | None, "Name of the store that is open."]]
    largest: Annotated[int, "Most bytes of a model file."]
    machine: Annotated[bool, "Whether the server holds a machine already."]
    base: Annotated[
        str, "Sign of the file that it can save, else name of what is open; empty where nothing is."
    ]
    numbers: NumberRulesValues


class ParticlesValues(TypedDict):
    """Korean particles by the word before them."""

    forms: Annotated[
        dict[str, tuple[str, str, str]],
        "Both forms, as they stand in texts -> after a consonant, after rieul, after a vowel.",
    ]
    endings: Annotated[
        list[tuple[str, int]],
        "What a word ends in, in NFD, and which of the three that is; the first match counts.",
    ]
    closing: Annotated[str, "Signs that may stand between a word and its particle."]
    reach: Annotated[int, "How many signs before a particle are looked at."]


PluralForms = dict[str, str]
"""Category of a count, such as ``one`` -> the text; ``by`` is the placeholder of the count."""


class ToolOptionsValues(TypedDict):
    """What is asked beside the links of a part before it is added."""

    word: str
    labels: Annotated[dict[str, str], "What each is called, by its key in the request."]
    choices: Annotated[dict[str, str], "Values with their names; none where numbers are asked."]
    value: Annotated[str, "Of each at first."]


class PartToolValues(TypedDict):
    """A tool that adds a part which joins two links."""

    tool: str
    key: Annotated[str, "By which it is taken."]
    name: str
    first: Annotated[str, "What to click first."]
    then: str
    picture: Annotated[str, "Path of its icon, in a square of 16."]
    slides: Annotated[bool, "Whether a click on the block of a slider means its link."]
    options: ToolOptionsValues | None


class SpokenValues(TypedDict):
    """The language that is spoken from now on."""

    type: Literal["spoken"]
    seq: int
    language: str
    languages: Annotated[dict[str, str], "Code of each language there is, and its own name."]
    words: Annotated[dict[str, str], "English text of the page -> text in the language."]
    explained: Annotated[dict[str, str], "Chart -> what it shows, and what to look for."]
    part_tools: Annotated[list[PartToolValues], "As kinds of parts declare them."]
    menu_items: Annotated[list[MenuItemValues], "As tables of the file declare them."]
    particles: ParticlesValues | None
    decimal: Annotated[str, "The sign before the decimals of a number that is shown."]
    forms: Annotated[dict[str, PluralForms], "English text of the page -> its forms by a count."]


class PicturedValues(TypedDict):
    """A bundled machine, with its drawing."""

    type: Literal["pictured"]
    seq: int
    name: str
    title: str
    line: str
    kind: Annotated[str, "The part of the gallery that it stands in."]
    words: Annotated[str, "By which it is found."]
    at: Annotated[int, "Sample at which it is drawn where it stands still."]
    scene: SceneValues
    arrays: Arrays


class GalleryValues(TypedDict):
    """All pictures of the gallery have come."""

    type: Literal["gallery"]
    seq: int


class SupportModeValues(TypedDict):
    """A natural mode of the support."""

    lines: list[str]
    seen: bool
    shape: Annotated[
        list[float],
        "Real and imaginary parts along x, along y (m) and of the rotation, as large as drawn.",
    ]


class ResponseMessage(TypedDict):
    """The response of the support over speed."""

    type: Literal["response"]
    seq: AnsweredNumber
    charts: list[ChartDataValues]
    arrays: Arrays
    notes: list[str]
    swing: Annotated[
        list[str] | None,
        "What is to be said of the motion at work; its arrays are `support.place` and `.angle`.",
    ]
    modes: list[SupportModeValues]


class StationOnShaftValues(TypedDict):
    """A station on the shaft of a tool."""

    name: str
    place: float
    text: str


class ShaftPieceValues(TypedDict):
    """Signs about a place of the shaft."""

    layer: Literal["below", "above"]
    place: float
    turns: Annotated[bool, "Whether they turn with the shaft."]
    shapes: list[DrawnShape]


class ToolSceneValues(TypedDict):
    """A tool from the side at rest: lengths in m."""

    tubes: Annotated[list[tuple[float, float, float]], "Start, stop, diameter."]
    stations: list[StationOnShaftValues]
    pieces: list[ShaftPieceValues]
    looks: dict[str, str]
    box: tuple[float, float, float, float]


class ShaftViewValues(TypedDict):
    """How the shaft may be seen to move."""

    name: str
    lines: list[str]
    shape: DrawnDisplacements


class ChangeValues(TypedDict):
    """A figure before and after."""

    name: NotRequired[str]
    label: str
    unit: str
    before: float
    after: float
    texts: Annotated[tuple[str, str, str], "Before, after, and the change."]
    way: Literal["same", "better", "worse"]
    main: NotRequired[
        Annotated[
            bool,
            "Whether it comes first: of a whole signal on the frame, or the mass that it takes.",
        ]
    ]


class ToolMessage(TypedDict):
    """A hand-held tool."""

    type: Literal["tool"]
    seq: int
    name: str
    title: str
    description: str
    undo: str | None
    redo: str | None
    steps: Annotated[Pair, "How many steps can be undone and redone."]
    file: ModelFileValues | None
    length: UnitValues
    fields: list[FieldValues]
    scene: ToolSceneValues
    before: Annotated[ToolSceneValues | None, "As it was opened, where it is another now."]
    along: Annotated[list[float], "Places along the shaft."]
    views: list[ShaftViewValues]
    figures: list[ChangeValues]
    charts: list[ChartDataValues]
    arrays: Arrays
    notes: list[str]


class ColumnOfValues(UnitValues):
    """What varies in a study, or what came of it."""

    name: str
    label: str
    kind: Literal["number", "output"]
    limits: Annotated[tuple[float | None, float | None], "At least and at most, SI units."]
    make: Literal["smallest", "largest"] | None


class RefusedDesignsValues(TypedDict):
    """Designs of a study that failed for one reason."""

    why: str
    code: int
    count: int


class StudyMessage(TypedDict):
    """A store of a study."""

    type: Literal["study"]
    seq: int
    name: str
    title: str
    columns: list[ColumnOfValues]
    own: Annotated[list[float] | None, "Of the model itself, column by column, SI units."]
    size: int
    drawn: int
    computed: int
    kept: int
    limited: bool
    refused: list[RefusedDesignsValues]
    best: list[int]
    arrays: Arrays


class StoresValues(TypedDict):
    """Stores that can be opened."""

    type: Literal["stores"]
    seq: int
    folder: Annotated[str | None, "That they lie in; null where there is no server."]
    names: list[str]


class GhostMessage(TypedDict):
    """A design that is drawn pale, or none."""

    type: Literal["ghost"]
    seq: AnsweredNumber
    scene: SceneValues | None
    arrays: Arrays


class VariantRowValues(TypedDict):
    """A figure of every variant."""

    label: str
    unit: str
    texts: list[str]
    best: list[int]


class VariantsMessage(TypedDict):
    """Figures of designs that are kept, by column, and of the one that is."""

    type: Literal["variants"]
    seq: AnsweredNumber
    kept: list[str]
    against: Annotated[str, "With what figures are compared: a word, or a variant."]
    rows: list[VariantRowValues]


class SideValues(TypedDict):
    """Links in different planes, drawn from the side."""

    type: Literal["side"]
    seq: AnsweredNumber
    svg: str


class ReadingValues(TypedDict):
    """A figure that comes after the state."""

    name: str
    label: str
    unit: str
    value: Annotated[float | None, "Null if it is not finite."]
    text: str
    was: NotRequired[Annotated[str, "Previous value and change; empty if it is the same."]]


class StrokesValues(TypedDict):
    """Figures of sliders, rockers and parts, and charts of loads along links with a section."""

    type: Literal["strokes"]
    seq: AnsweredNumber
    figures: list[ReadingValues]
    compared: Annotated[bool, "Whether figures of another design are shown beside them."]
    notes: list[str]
    charts: list[ChartDataValues]
    arrays: Arrays


class PlantedValues(TypedDict):
    """Figures of a planting finger or of gauges."""

    type: Literal["planting", "gauges"]
    seq: AnsweredNumber
    figures: list[ReadingValues]
    compared: Annotated[bool, "Whether figures of another design are shown beside them."]
    notes: list[str]


class BalancedValues(TypedDict):
    """A balanced machine, beside the one that it comes from."""

    type: Literal["balanced"]
    seq: int
    changes: list[str]
    aims: Annotated[list[ChangeValues], "What was to become small."]
    figures: list[ChangeValues]
    worse: Annotated[list[str], "What got worse, a sentence for each kind of figure."]
    gauges_worse: Annotated[
        bool, "Whether a gauge reads more; then balancing can be asked for that holds them."
    ]
    proof: str
    notes: list[str]


class TextBlockValues(TypedDict):
    """Running text of a result."""

    kind: Literal["text"]
    text: str
    emphasized: Annotated[bool, "Whether it stands out, as of a limit that is broken."]


class FactsBlockValues(TypedDict):
    """Sentences of a kind."""

    kind: Literal["facts"]
    title: Annotated[str, "Empty where there is none."]
    items: list[str]


class TableBlockValues(TypedDict):
    """A table whose cells are texts."""

    kind: Literal["table"]
    title: str
    heads: list[str]
    rows: list[list[str]]
    numbers: Annotated[list[bool], "Whether each column is set to the right."]
    emphasized: Annotated[list[tuple[int, int]], "Row and column of each cell that stands out."]


class RunMessage(TypedDict):
    """How the machine runs, and what came of it."""

    type: Literal["run"]
    seq: int
    design: Annotated[int, "That of the state whose machine has run; 0 if it is shown no more."]
    blocks: list[TextBlockValues | FactsBlockValues | TableBlockValues]
    charts: list[ChartDataValues]
    frames: Annotated[int, "Poses that come along; 0 where those of the cycle are played."]
    arrays: Annotated[
        Arrays,
        "`run.time`, and `run.cycles`, the crank angle in cycles; poses, and `run.place` and "
        "`run.angle` of a support that moves; curves.",
    ]


class RefusedValues(TypedDict):
    """Why something cannot be done."""

    type: Literal["refused"]
    seq: AnsweredNumber
    message: str
    path: NotRequired[Annotated[str, "Key of the model file that is wrong."]]
    what: Annotated[str, "What is wrong, without its place, and keys by the words of forms."]
    topic: NotRequired[Annotated[str, "What `equipoise explain` knows about it."]]
    cure: NotRequired[Annotated[tuple[str, str], "Title and text of its page of errors."]]


class HandedOutValues(TypedDict):
    """A file to be kept."""

    type: Literal["file"]
    seq: int
    name: str
    mime: str
    files: NotRequired[Annotated[dict[str, str], "Texts of the tables that it names."]]


class SavedValues(TypedDict):
    """The file is saved."""

    type: Literal["saved"]
    seq: int
    name: str
    base: Annotated[str, "Sign of the file as it is now."]
    text: Annotated[str, "The model that the page's steps began with."]


class BusyValues(TypedDict):
    """Something that takes longer has begun."""

    type: Literal["busy"]
    seq: int
    what: str


class AnsweredValues(TypedDict):
    """All answers to a question have come, those too that take longer."""

    type: Literal["answered"]
    seq: int


Sent = (
    HelloValues | SpokenValues | PicturedValues | GalleryValues | StateMessage | ResponseMessage
    | GhostMessage | ToolMessage | StudyMessage | StoresValues | VariantsMessage | StrokesValues
    | PlantedValues | SideValues | BalancedValues | RunMessage | RefusedValues | TablesValues
    | SavedValues | BusyValues | HandedOutValues | AnsweredValues
)  # fmt: skip
"""All that a server sends."""

ALIASES = {
    "Pair": Pair,
    "Arrays": Arrays,
    "DrawnShape": DrawnShape,
    "PluralForms": PluralForms,
    "Edit": Edit,
    "MenuSource": MenuSource,
    "DownloadKind": DownloadKind,
    "Sent": Sent,
    "PageRequest": PageRequest,
}
"""Names of types in TypeScript that are no interfaces."""
OPEN = (MadeValues, MakeRequest)
"""Classes whose objects have other keys too: those that an operation needs."""
MESSAGES = (Sent, PageRequest, MadeValues)
"""What is written to TypeScript, with all that it refers to."""
