"""Kinds of force elements: what acts between two bodies by where these are, and by nothing else.

A kind declares itself: its keys, what it exerts, its outputs, and what can be wrong with it.
Whatever reads, analyses, compiles or shows a machine asks for `ForceElement`, and for no kind of
it.  What a kind exerts is arithmetic, so that it runs on arrays and on terms alike.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from equipoise.i18n import Note
from equipoise.keys import Frozen
from equipoise.keys.declaring import listed_types, once
from equipoise.mechanism.checks import FRAME, Bodies

if TYPE_CHECKING:
    from equipoise.errors import ModelError

Action = tuple[str, str | None, Any, Any]
"""A body, its point (None of a torque alone), the force on it (complex, N) and the torque (N m)."""


class Placed(Protocol):
    """Bodies where they are, by numbers, arrays over the crank angle, or terms."""

    def point(self, body: str, point: str) -> Any:
        """A point of a body in the frame, complex, m."""

    def angle(self, body: str, on: str, middle: Any) -> Any:
        """Angle of a body from the x axis of another, rad, within half a turn of `middle`."""


class ForceElement(Frozen):
    """What exerts forces on two bodies, and stores what work they do on it.

    most : that a machine may have.
    title : of the table of their outputs.  headings : of those outputs that it shows, of the
        smallest and of the largest value.
    """

    most: ClassVar[int] = 200
    title: ClassVar[str]
    headings: ClassVar[Mapping[str, tuple[str, str]]]

    @property
    @abstractmethod
    def bodies(self) -> tuple[str, str]:
        """The bodies on which it acts, the link first."""

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """Bodies and points at which its forces act; empty of what exerts torques alone."""
        return ()

    @property
    def idle_keys(self) -> tuple[str, ...]:
        """Keys whose values count for nothing beside the others."""
        return ()

    @property
    @abstractmethod
    def label(self) -> Note:
        """What tells it from others of its kind."""

    @property
    @abstractmethod
    def route(self) -> tuple[str, str]:
        """From where to where it acts."""

    @abstractmethod
    def sentence(self) -> Note:
        """What it is, for a report."""

    @abstractmethod
    def actions(self, at: Placed) -> Iterator[Action]:
        """What it exerts on each of its bodies, the frame too."""

    @abstractmethod
    def values(self, at: Placed) -> Mapping[str, Any]:
        """Its outputs by name."""

    @abstractmethod
    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with it in a machine of these bodies."""

    def demands(self) -> Iterator[Any]:
        """What has to be true of its numbers, or of columns of them."""
        return iter(())

    @abstractmethod
    def summary(self) -> str:
        """What it is with all its numbers, in a line of `check`."""

    def on_links(self, at: Placed) -> Iterator[Action]:
        """What it exerts on moving links."""
        return (one for one in self.actions(at) if one[0] != FRAME)


@once
def force_kinds(of: type[Frozen]) -> Mapping[str, type[ForceElement]]:
    """Kinds of force elements that a class of machines has, by field, in the order of the file."""
    kinds = listed_types(of).items()
    return {field: kind for field, kind in kinds if issubclass(kind, ForceElement)}
