"""Kinds of parts of a machine that declare themselves: couplings, force elements, kinds of joints.

A kind has its keys, its outputs, and what can be wrong with it.  Whatever reads, shows or refuses a
machine asks for `PartKind` or `Element`, and for no kind of it.  What a kind computes is
arithmetic, so that it runs on arrays and on terms alike.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from equipoise.i18n import Note
from equipoise.keys import Frozen
from equipoise.keys.declaring import listed_types, once
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.outputs.declared import GROUPS, of_element
from equipoise.mechanism.outputs.declaring import of_parts
from equipoise.quantities import Dimension

if TYPE_CHECKING:
    from equipoise.errors import ModelError


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
    """

    list_name: ClassVar[str]
    list_text: ClassVar[str]
    order: ClassVar[int] = 99
    most: ClassVar[int] = 200
    group: ClassVar[str]
    sign: ClassVar[str] = ""
    dragged: ClassVar[str] = ""
    page_tool: ClassVar[str] = ""
    tables: ClassVar[Mapping[str, str]] = {}
    figures: ClassVar[str] = ""
    questions: ClassVar[str] = ""
    remarks: ClassVar[str] = ""
    exports: ClassVar[Mapping[str, str]] = {}
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
        return False

    @property
    def has_formula(self) -> bool:
        """Whether its motion has a formula, for formats that evaluate no tables and laws."""
        return True

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
