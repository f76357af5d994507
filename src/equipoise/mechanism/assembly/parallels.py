"""Parallel cranks: four-bars of equal opposite sides, and further cranks that move as they do.

A four-bar of equal opposite sides comes into line twice a turn, where its links may go on parallel
or crossed; the file says which.  A third crank between the same two bodies has nothing left to
decide: its pins are where the others bring them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Builder, Group, Outer
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.steps import KernelCall, p, planar, u
from equipoise.mechanism.checks import MODE, MODES
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import Machine

SAME_LENGTH = 1e-9
"""Of the larger one: difference of two lengths that count as the same."""
NEARLY = 0.05
"""Of the larger one: difference up to which two lengths are meant to be the same."""


@dataclass(frozen=True)
class Closed:
    """A four-bar that a dyad closes: of two known bodies that share the pin `pivot`, `here` with
    the first and `there` with the second of its outer pins.

    sides : ends of each side and its length, m, those opposite to each other side by side.
    """

    here: str
    there: str
    pivot: str
    sides: tuple[tuple[str, Any], ...]

    def apart(self) -> Any:
        """Difference of opposite sides, over the larger one; of two pairs the larger."""
        lengths = [length for _, length in self.sides]
        pairs = zip(lengths[::2], lengths[1::2], strict=True)
        return np.maximum(*(abs(a - b) / np.maximum(a, b) for a, b in pairs))

    @property
    def equal(self) -> bool:
        """Whether opposite sides have the same length."""
        return bool(np.all(self.apart() <= SAME_LENGTH))

    def misfit(self) -> Note:
        """Say which opposite sides differ, and by how much."""
        pairs = zip(self.sides[::2], self.sides[1::2], strict=True)
        (item, a), (other, b) = max(pairs, key=lambda pair: float(abs(pair[0][1] - pair[1][1])))
        return Note(
            "opposite sides of a parallel linkage are equal, and {one} is {a:.7g} mm, {other} "
            "{b:.7g} mm, {apart:.4g} mm apart; give both one length",
            one=item,
            a=a * 1e3,
            other=other,
            b=b * 1e3,
            apart=abs(a - b) * 1e3,
        )


def closed_by(builder: Builder, first: Outer, second: Outer, pin: str) -> Closed | None:
    """The four-bar that two links with a pin between them close, if it is one."""
    points = builder.machine.assembled_points
    for here in (body for body in builder.rank if first.point in points(body)):
        for there in (body for body in builder.rank if second.point in points(body)):
            for pivot in () if here == there else points(here).keys() & points(there).keys():
                if pivot in (first.point, second.point):
                    continue
                ends = ((here, pivot, first.point), (second.link, second.point, pin),
                        (there, pivot, second.point), (first.link, first.point, pin))  # fmt: skip
                sides = ((f"{a}-{b}", abs(builder.arm(body, a, b))) for body, a, b in ends)
                return Closed(here, there, pivot, tuple(sides))
    return None


def parallel_by(builder: Builder, first: Outer, second: Outer, pin: str) -> Closed | None:
    """The four-bar of equal opposite sides that two links close, if they are to go on through its
    change points.

    Raises
    ------
    ModelError : the opposite sides are to be equal, and are not.
    """
    given = builder.machine.assembly.get(pin)
    wanted = given in MODES or (given is None and builder.mode is not None)
    closed = closed_by(builder, first, second, pin) if wanted or given is None else None
    if closed is None:
        return None
    if closed.equal:
        return closed
    if wanted and (given in MODES or np.all(closed.apart() <= NEARLY)):
        where = pin if given in MODES else MODE
        raise ModelError(f"assembly.{where}", closed.misfit())
    return None


def surplus_cranks(machine: Machine, joints: Structure) -> frozenset[str]:
    """Links beyond two that are equal and parallel cranks between the same two bodies."""
    between: dict[frozenset[str], list[tuple[str, Mapping[str, str]]]] = {}
    for link in sorted(machine.links, key=lambda link: link != machine.drive.link):
        pins = [(body, point) for point, bodies in joints.pins.items() if link in bodies
                for body in bodies if body != link]  # fmt: skip
        if len(pins) == len({body for body, _ in pins}) == len({pt for _, pt in pins}) == 2:
            between.setdefault(frozenset(body for body, _ in pins), []).append((link, dict(pins)))
    return frozenset(chain.from_iterable(_beyond(machine, *item) for item in between.items()))


def _beyond(
    machine: Machine, pair: frozenset[str], cranks: list[tuple[str, Mapping[str, str]]]
) -> Iterator[str]:
    """Of cranks between two bodies, those after the second that are parallel to the first."""
    here, there = pair
    ways = []
    for link, pins in cranks:
        points = machine.assembled_points(link)
        crank = abs(planar(points[pins[here]]) - planar(points[pins[there]]))
        a, b = (planar(machine.assembled_points(body)[pins[body]]) for body in (here, there))
        ways.append((link, crank, a, b))
    (_, size, a0, b0), *others = ways
    if not others or others[0][2] == a0:
        return
    turn = (others[0][3] - b0) / (others[0][2] - a0)
    if not abs(abs(turn) - 1) <= NEARLY:
        return
    for link, crank, a, b in others[1:]:
        far = NEARLY * max(size, crank, abs(a - a0))
        if abs(crank - size) <= NEARLY * size and abs(b - b0 - turn * (a - a0)) <= far:
            yield link


def pointed(builder: Builder, outers: list[Outer]) -> Group | None:
    """A link that is pinned to known bodies at two points or more, which tell where it is."""
    link, first = outers[0].link, outers[0].point
    second = max(
        (outer.point for outer in outers), key=lambda pt: abs(builder.arm(link, first, pt))
    )
    arm = builder.arm(link, first, second)
    if not arm:
        return None
    reach = [step for outer in outers for step in builder.reach(outer.body, outer.point)]
    builder.add({link: first})
    motion = KernelCall(kernels.pointed, (*p(first), *p(second)), (arm,), u(link))
    return Group(
        "pointed", (link,), (*reach, motion), (), tuple(item.reaction() for item in outers)
    )
