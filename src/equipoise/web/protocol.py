"""Types of the messages that a page is sent of a machine: `page/src/messages.ts` is written from
them by ``python page/messages.py``.

A class is a JSON object, its fields are the keys.  The text of an `Annotated` field becomes the
comment in TypeScript; the class ``NameValues`` becomes the interface ``Name``.  Lengths in m,
angles in rad, all else in SI.
"""

from __future__ import annotations

from typing import Annotated, Literal, NotRequired, TypedDict

Pair = tuple[float, float]
Arrays = dict[str, tuple[int, int]]
"""Name of an array -> its offset and length in the block of floats."""
Shape = Annotated[
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

    layer: str
    link: Annotated[str, "The link that it draws, if any."]
    hold: HoldValues | None
    part: Annotated[
        tuple[Literal["slider", "gears", "belts", "racks", "cams"], str] | None,
        "The slider or coupling that it draws, if any: its kind and name.",
    ]
    still: Annotated[bool, "Whether it is fixed to the ground, and not to the support."]
    shapes: list[Shape]


class BaseCircleValues(TypedDict):
    """A base circle that can be dragged, opposite to the point of its follower."""

    name: str
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
    cams: list[BaseCircleValues]
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
    at: float


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
    told: list[str]
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


class ExampleValues(TypedDict):
    """A bundled model."""

    name: str
    title: str


MESSAGES = (StateMessage, ExampleValues)
"""Classes that are written to TypeScript, with all that they refer to."""
