"""Slots as two edges beside the way of a pin."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.symbols.shapes import PIN, Array, Mark, Shape

HALF = PIN + 1.4
"""Half the width of a slot, units: a pin with play."""
SLOTS = ("path", "path-edge")
"""Roles of slots."""
CORNERS = 96
"""Of its middle line."""
CAP = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 9))
"""Round ends, seen along the way ahead."""


def circular_sign(slot: CircularSlot, joints: Structure, bodies: Bodies) -> Iterator[Mark]:
    """The slot in its body."""
    first, last = slot.arc or (0.0, 2 * np.pi)
    angle = np.linspace(first, last, CORNERS)
    way = np.exp(1j * angle)
    for shape in slot_shapes(slot.radius * way, 1j * way, closed=not slot.arc):
        yield Mark(slot.on, slot.center, shape)


def curved_sign(slot: CurvedSlot, joints: Structure, bodies: Bodies) -> Iterator[Mark]:
    """The slot in its body."""
    curve, turn = slot.curve, np.exp(1j * slot.direction)
    s = np.linspace(0.0, curve.knots[-1], CORNERS)
    middle, first, *_ = curve.at(s)
    for shape in slot_shapes(turn * middle, turn * first / abs(first), closed=slot.closed):
        yield Mark(slot.on, slot.origin, shape)


def slot_shapes(middle: Array, ahead: Array, closed: bool) -> Iterator[Shape]:
    """A slot about its middle line (n,), complex, m, with the directions along it, of size 1.

    closed : whether it ends where it begins.
    """
    aside = HALF * 1j * ahead
    if closed:
        yield from (Shape("path-edge", middle, edge, closed=True) for edge in (aside, -aside))
        return
    ends = [HALF * CAP * ahead[-1], HALF * CAP * -ahead[0]]
    places = [middle[::-1], np.full(len(CAP), middle[0]), middle, np.full(len(CAP), middle[-1])]
    offsets = [aside[::-1], ends[1], -aside, ends[0]]
    yield Shape("path", np.concatenate(places), np.concatenate(offsets), closed=True)
