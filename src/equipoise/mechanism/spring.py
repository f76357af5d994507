"""Linear springs between a point of a link and a point of the frame, as values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.keys import Frozen, Text, declared, key
from equipoise.mechanism.checks import unknown

if TYPE_CHECKING:
    from equipoise.mechanism.balance import SpringChoice
    from equipoise.mechanism.model import Machine

MOST = 200
"""Far beyond any machine, as in `mechanism.checks`."""


@declared
class Spring(Frozen):
    """A linear spring without mass: it pulls `point` of `link` towards the frame's point `to`."""

    link: str = key(Text(), "the link that it pulls", example="rocker")
    point: str = key(
        Text(), "its point on the link, not one that is pinned to the frame", example="C"
    )
    to: str = key(Text(), "its point on the frame", example="S")
    stiffness: float = key("stiffness", "more than 0", example="2 kN/m", above=0)
    free_length: float = key(
        "length",
        "at which it exerts nothing; shorter it pushes",
        default=0.0,
        shown="0 m",
        at_least=0,
        why="a length cannot be negative, give 0 or more",
    )


def wrong_springs(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with a machine's springs."""
    if len(machine.springs) > MOST:
        count = len(machine.springs)
        yield ModelError("springs", f"got {count}; at most {MOST} are computed with")
    for number, spring in enumerate(machine.springs, 1):
        yield from wrong_ends(f"springs[{number}]", spring, machine)


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
