"""Kinds of force elements: what acts between two bodies by where these are and how they move.

Beside what every element declares, a kind says what it exerts.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen
from equipoise.keys.declaring import once
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.parts.element_kinds import Element, Placed, element_kinds
from equipoise.quantities import Dimension

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
