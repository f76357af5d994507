"""Linear springs between a point of a link and a point of the frame, as values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.frozen import Frozen

if TYPE_CHECKING:
    from equipoise.mechanism.balance import SpringChoice
    from equipoise.mechanism.model import Machine

MOST = 200
"""Far beyond any machine, as in `mechanism.checks`."""


@dataclass(frozen=True)
class Spring(Frozen):
    """A linear spring without mass: it pulls `point` of `link` towards the frame's point `to`.

    stiffness : N/m, more than 0.
    free_length : m, at which it exerts nothing; shorter than this it pushes.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("link", "point", "to"), "text"),
        **dict.fromkeys(("stiffness", "free_length"), "number"),
    }

    link: str
    point: str
    to: str
    stiffness: float
    free_length: float = 0.0


def wrong_springs(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with a machine's springs."""
    if len(machine.springs) > MOST:
        count = len(machine.springs)
        yield ModelError("springs", f"got {count}; at most {MOST} are computed with")
    for number, spring in enumerate(machine.springs, 1):
        yield from wrong_ends(f"springs[{number}]", spring, machine)
        yield from _wrong_numbers(f"springs[{number}]", spring)


def wrong_ends(where: str, spring: Spring | SpringChoice, machine: Machine) -> Iterator[ModelError]:
    """What is wrong with the two points of a spring, or of one that may be set."""
    if spring.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(spring.link, machine.links, "link"))
        return
    points = machine.links[spring.link].points
    if spring.point not in points:
        sentence = unknown(spring.point, points, f"point of {spring.link}")
        yield ModelError(f"{where}.point", sentence)
    elif spring.to not in machine.frame:
        yield ModelError(f"{where}.to", unknown(spring.to, machine.frame, "point of the frame"))
    elif spring.point in machine.frame:
        yield ModelError(
            f"{where}.point",
            f"{spring.point!r} is pinned to the frame, where a spring does nothing; give a point "
            "that moves",
        )


def _wrong_numbers(where: str, spring: Spring) -> Iterator[ModelError]:
    if spring.stiffness <= 0:
        yield ModelError(f"{where}.stiffness", f"got {spring.stiffness:g} N/m; give more than 0")
    if spring.free_length < 0:
        yield ModelError(
            f"{where}.free_length",
            f"got {spring.free_length:g} m; a length cannot be negative, give 0 or more",
        )
