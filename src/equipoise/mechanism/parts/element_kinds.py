"""Kinds of parts of a machine that declare themselves: couplings, force elements, kinds of joints.

A kind has its keys, its outputs, and what can be wrong with it.  Whatever reads, shows or refuses a
machine asks for `PartKind` or `Element`, and for no kind of it.  What a kind computes is
arithmetic, so that it runs on arrays and on terms alike.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from typing import Any, ClassVar, NamedTuple, Protocol

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen
from equipoise.keys.declaring import listed_types, once
from equipoise.mechanism.checks import FRAME, Bodies, unknown, unknown_body, unknown_link
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.outputs.declared import GROUPS, of_element
from equipoise.mechanism.outputs.declaring import of_parts
from equipoise.quantities import Dimension


class Placed(Protocol):
    """Bodies where they are, by numbers, arrays over the crank angle, or terms."""

    def point(self, body: str, point: str) -> Any:
        """A point of a body in the frame, complex, m."""

    def velocity(self, body: str, point: str) -> Any:
        """Velocity of a point of a body in the frame, complex, m/s."""

    def angle(self, body: str, on: str, middle: Any) -> Any:
        """Angle of a body from the x axis of another, rad, within half a turn of `middle`."""

    def turn(self, body: str) -> Any:
        """Rotation of a body, complex of size 1."""

    def turned(self, body: str, angle: Any) -> Any:
        """Unit vector at an angle, rad, from the x axis of a body, complex."""

    def rate(self, body: str) -> Any:
        """Angular velocity of a body, rad/s."""

    def along(self, joint: str) -> tuple[Any, Any]:
        """How far along its track the rider of a joint is, m, and its speed along that, m/s."""

    def on_track(self, joint: str, wrong: str) -> None:
        """Refuse a motion in which a rider leaves its track; wrong : as of `within`."""

    def bearing(self, vector: Any, middle: Any) -> Any:
        """Angle of a vector, rad, within half a turn of `middle`."""

    def within(self, value: Any, ends: tuple[Any, Any], wrong: str) -> None:
        """Refuse a motion in which a value does not stay between two ends.

        wrong : the sentence, with ``{crank_angle}`` for where that is, deg.
        """


class PartKind(Frozen):
    """What a machine has in a list of its file, and what declares itself.

    list_name : key of its list in the model file.  list_text : what that is, for its readers.
    order : place of that list among those of its base: couplings, force elements, kinds of joints.
    most : that a machine may have.
    group : what several are called, above their outputs and their numbers.
    legend : role among its signs, and what a picture's legend calls that; empty where none does.
    sign : ``module:function`` of the room of symbols that draws it, from the part and its
        surroundings to marks; empty where it has no sign of its own.
    dragged : ``module:function`` of the room of symbols that gives the circle by which a number of
        the part is dragged on a drawing; empty where none is.
    drawn_as_spring : whether it is drawn as a spring, stretched between two points.
    page_tool : ``module:NAME`` of the tool by which a page adds one between two links; empty where
        only its form does.
    tables : ``module:function`` that shows what an analysis says of all parts of the kind, by the
        chapter in which that stands, ``motion`` or ``joints``.
    figures : ``module:class`` of the figures of a part; its `of_parts` computes those of all, by
        name, from a motion and its forces, which are None without masses.
    questions : ``module:function`` that says what may not be meant of parts of a linkage.
    remarks : ``module:function`` that says, by the forces of a machine, where its parts fail.
    exports : ``module:function`` that writes all parts of the kind into a file, by the name of a
        format whose code knows kinds of parts.
    fixes_ratio : whether the simplest of the kind do nothing but turn two links in a fixed ratio.
    by_formula : whether the motion of the simplest of the kind has a formula.
    """

    list_name: ClassVar[str]
    list_text: ClassVar[str]
    order: ClassVar[int] = 99
    most: ClassVar[int] = 200
    group: ClassVar[str]
    sign: ClassVar[str] = ""
    dragged: ClassVar[str] = ""
    drawn_as_spring: ClassVar[bool] = False
    page_tool: ClassVar[str] = ""
    tables: ClassVar[Mapping[str, str]] = {}
    figures: ClassVar[str] = ""
    questions: ClassVar[str] = ""
    remarks: ClassVar[str] = ""
    exports: ClassVar[Mapping[str, str]] = {}
    fixes_ratio: ClassVar[bool] = False
    by_formula: ClassVar[bool] = True
    legend: ClassVar[tuple[str, str] | None] = None

    @property
    @abstractmethod
    def bodies(self) -> tuple[str, ...]:
        """The bodies between which it is."""

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """Bodies and points that it names."""
        return ()

    @property
    def axed(self) -> tuple[str, ...]:
        """Bodies whose own axes it counts angles or ways from, so that these have to stay."""
        return ()

    @property
    def idle_keys(self) -> tuple[str, ...]:
        """Keys whose values count for nothing beside the others."""
        return ()

    @property
    @abstractmethod
    def label(self) -> Note:
        """Label that distinguishes it from others of its kind."""

    @property
    def special(self) -> str:
        """What it is called where a format lacks it."""
        return self.group

    @property
    def in_fixed_ratio(self) -> bool:
        """Whether it does nothing but turn two links in a fixed ratio, which any format has."""
        return self.fixes_ratio

    @property
    def has_formula(self) -> bool:
        """Whether its motion has a formula, for formats that evaluate no tables and laws."""
        return self.by_formula

    @abstractmethod
    def sentence(self) -> Note:
        """What it is, for a report."""

    @abstractmethod
    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        """Declare its outputs, of which the machine has those of a list of the file."""


class Element(PartKind):
    """A part between two bodies, which has outputs by its place in its list.

    outputs : dimension and label of each, by name.
    title : of the table of their outputs.  headings : of those outputs that it shows, of the
        smallest and of the largest value.
    still : fields whose numbers no design changes, so that compiled loops have them as they are.
    """

    still: ClassVar[tuple[str, ...]] = ()
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {}
    title: ClassVar[str]
    headings: ClassVar[Mapping[str, tuple[str, str]]]

    @property
    @abstractmethod
    def bodies(self) -> tuple[str, str]:
        """The bodies between which it is, the link first."""

    @property
    @abstractmethod
    def route(self) -> tuple[str, str]:
        """From where to where it acts."""

    @abstractmethod
    def values(self, at: Placed) -> Mapping[str, Any]:
        """Outputs of a force element by name."""

    @classmethod
    def declare_outputs(cls, table: str) -> None:
        for name, (dimension, label) in cls.outputs.items():
            of_element(table, name, dimension, label)

    def demands(self) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them."""
        return iter(())

    @abstractmethod
    def summary(self) -> str:
        """What it is with all its numbers, in a line of `check`."""


@cache
def named_value(name: str) -> Any:
    """What a kind of part names as ``module:name``."""
    module, _, item = name.partition(":")
    return getattr(import_module(module), item)


def named_function(name: str) -> Callable[..., Any]:
    """The function that a kind of part names as ``module:function``."""
    function: Callable[..., Any] = named_value(name)
    return function


@once
def part_kinds(of: type[Frozen]) -> Mapping[str, type[PartKind]]:
    """Kinds of parts that a class of machines has, by field, couplings before elements, each in the
    order of the file.
    """
    kinds = listed_types(of).items()
    by_name = {field: kind for field, kind in kinds if issubclass(kind, PartKind)}
    return dict(sorted(by_name.items(), key=lambda item: issubclass(item[1], Element)))


def declare_outputs(of: type[Frozen]) -> None:
    """Declare the outputs of all parts of a class of machines, and what they are called."""
    with of_parts():
        for table, kind in part_kinds(of).items():
            GROUPS[table] = kind.group
            kind.declare_outputs(table)


@once
def element_kinds(of: type[Frozen]) -> Mapping[str, type[Element]]:
    """Kinds of elements that a class of machines has, by field, in the order of the file."""
    kinds = listed_types(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, Element)}


Action = tuple[str, str | None, Any, Any]
"""A body, its point (None of a torque alone), the force on it (complex, N) and the torque (N m)."""


class TableArgument(NamedTuple):
    """What a table of an element goes by: a position, a length or an angle.

    label : of it, for readers.  dimension : of it.  rows : its values in the table, m or rad.
    values : those that the motion has, m or rad.
    """

    label: Note
    dimension: Dimension
    rows: Sequence[Any]
    values: Any


class ForceElement(Element):
    """What exerts forces on two bodies, and stores or loses what work they do on it.

    rated : whether its forces depend on velocities.
    cause : under which its share of forces and drive torques is listed.
    cause_label : that for readers.
    """

    rated: ClassVar[bool] = False
    cause: ClassVar[str] = "spring"
    cause_label: ClassVar[str] = to_say("springs")

    @abstractmethod
    def actions(self, at: Placed) -> Iterator[Action]:
        """What it exerts on each of its bodies, the frame too."""

    @property
    def meeting(self) -> str:
        """Sentence for where its two points meet, of what has no direction there: with point, link,
        to and angle, deg; empty of what does not need one.
        """
        return ""

    def table_argument(self, at: Placed) -> TableArgument | None:
        """By what the rows of its table go, of one that has rows."""
        return None

    def on_links(self, at: Placed) -> Iterator[Action]:
        """What it exerts on moving links."""
        return (action for action in self.actions(at) if action[0] != FRAME)


class RatedElement(ForceElement):
    """A force element whose forces depend on ways between its bodies and on the speeds of these.

    freedoms : how many ways it has.
    one_sided : whether it only pushes, with its one effort, where its one way is below 0.
    """

    rated = True
    freedoms: ClassVar[int] = 1
    one_sided: ClassVar[bool] = False

    @property
    @abstractmethod
    def linear(self) -> bool:
        """Whether its forces change in proportion to the speeds, wherever it is."""

    @abstractmethod
    def ways(self, at: Placed) -> tuple[tuple[Any, Any], ...]:
        """Ways between its bodies, m or rad, each with its speed, m/s or rad/s."""

    @abstractmethod
    def efforts(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Any, ...]:
        """Force (N) or torque (N m) along each way: times the speed it is the power that the
        bodies get.
        """

    def sliding_efforts(
        self, ways: Sequence[tuple[Any, Any]], senses: Sequence[Any]
    ) -> tuple[Any, ...]:
        """Efforts as of `efforts`, but dry friction has its full size however slow the motion is,
        and where it is about to begin.

        senses : of each way any multiple above 0 of its speed, or of what that will be.
        """
        return self.efforts(ways)

    @property
    def dry(self) -> bool:
        """Whether its force jumps where its point turns back."""
        return False

    def sign_changes(self, ways: Sequence[tuple[Any, Any]]) -> tuple[Sequence[Any], Sequence[Any]]:
        """Of a dry one speeds at whose change of sign its force jumps, m/s or rad/s, and ways at
        whose change of sign it has a corner, m or rad.
        """
        return (), ()

    @abstractmethod
    def exerted(self, at: Placed, efforts: Sequence[Any]) -> Iterator[Action]:
        """What it exerts on each of its bodies, the frame too, where these are its efforts."""

    def actions(self, at: Placed) -> Iterator[Action]:
        """What it exerts on each of its bodies, the frame too."""
        return self.exerted(at, self.efforts(self.ways(at)))


@once
def force_kinds(of: type[Frozen]) -> Mapping[str, type[ForceElement]]:
    """Kinds of force elements that a class of machines has, by field, in the order of the file."""
    kinds = element_kinds(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, ForceElement)}


def rated_elements(machine: Any) -> tuple[tuple[str, int, RatedElement], ...]:
    """Force elements of a machine whose forces depend on velocities, each with its list and its
    place from 0.
    """
    return tuple(item for item in machine.force_elements if isinstance(item[2], RatedElement))


class BetweenPoints:
    """Between `point` of `link` and the point `to` of `on`."""

    link: str
    point: str
    to: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the body of the other point."""
        return self.link, self.on

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """Both bodies, each with its point."""
        return (self.link, self.point), (self.on, self.to)

    @property
    def label(self) -> Note:
        """Both points, which distinguish it from others of its kind."""
        return Note("{point} to {other}", point=self.point, other=self.to)

    @property
    def route(self) -> tuple[str, str]:
        """Both points."""
        return self.point, self.to

    def pulled(self, force: Any) -> Iterator[Action]:
        """A force on the link in the line of both points, N, complex, and its opposite."""
        yield self.link, self.point, force, 0.0
        yield self.on, self.to, -force, 0.0

    def pushed(self, arm: Any, force: Any, torque: Any = 0.0) -> Iterator[Action]:
        """A force, N, complex, and torque, N m, on the link at its point, and their opposites there
        on the other body.

        arm : from the other point to the point, m, complex.
        """
        yield self.link, self.point, force, torque
        yield self.on, self.to, -force, -cross(arm, force) - torque

    def relative_motion(
        self, at: Placed, direction: Any
    ) -> tuple[Any, Any, tuple[tuple[Any, Any], ...]]:
        """Way from the other point to the point, m, complex in the frame; unit vector of a
        direction, rad from the x axis of the other body; and the ways along and across that in the
        axes of the other body, m, with their speeds there, m/s.
        """
        arm = at.point(self.link, self.point) - at.point(self.on, self.to)
        velocity = at.velocity(self.link, self.point) - at.velocity(self.on, self.to)
        along = at.turned(self.on, direction)
        rate = at.rate(self.on)
        ways = tuple(
            (dot(way, arm), dot(way, velocity) + cross(way, arm) * rate)
            for way in (along, 1j * along)
        )
        return arm, along, ways


def wrong_end_points(where: str, item: Any, bodies: Bodies, itself: Note) -> Iterator[ModelError]:
    """What is wrong with bodies and points of something between two points, of which the other is
    one of the frame where it names no body.

    itself : sentence for a link on itself.
    """
    link, point, to, on = item.link, item.point, item.to, getattr(item, "on", FRAME)
    wrong = [
        *unknown_link(f"{where}.link", link, bodies),
        *unknown_body(f"{where}.on", on, bodies),
    ]
    yield from wrong
    if wrong:
        return
    if link == on:
        yield ModelError(f"{where}.on", itself)
    if point not in bodies[link]:
        of = Note("point of {body}", body=link)
        yield ModelError(f"{where}.point", unknown(point, bodies[link], of))
    if to not in bodies[on]:
        kind: Note | str = "point of the frame"
        if on != FRAME:
            kind = Note("point of {body}", body=on)
        yield ModelError(f"{where}.to", unknown(to, bodies[on], kind))


class BetweenBodies:
    """Between `link` and `on`, whatever their places."""

    link: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the other body."""
        return self.link, self.on

    @property
    def label(self) -> Note:
        """Both bodies, which distinguish it from others of its kind."""
        return Note("{link} on {on}", link=self.link, on=self.on)

    @property
    def route(self) -> tuple[str, str]:
        """From the other body to the link."""
        return self.on, self.link

    def turned(self, torque: Any) -> Iterator[Action]:
        """A torque on the link, N m, and its opposite."""
        yield self.link, None, 0j, torque
        yield self.on, None, 0j, -torque

    def wrong_bodies(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """What is wrong with the link and the other body."""
        yield from unknown_link(f"{where}.link", self.link, bodies)
        yield from unknown_body(f"{where}.on", self.on, bodies)
        if self.link == self.on:
            wrong = Note("{link!r} cannot be turned against itself", link=self.link)
            yield ModelError(f"{where}.on", wrong)
