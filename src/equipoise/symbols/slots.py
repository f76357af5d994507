"""Slots as two edges beside the way of a pin."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.signals import Array
from equipoise.symbols.part_signs import Surroundings
from equipoise.symbols.shapes import PIN, BodyMark, Shape

PLAY = 1.4
"""Between a pin and either edge of its slot, units."""
SLOTS = ("path", "path-edge")
"""Roles of slots."""
CORNERS = 96
"""Of its middle line."""
CAP = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 9))
"""Round ends, seen along the way ahead."""


def circular_sign(slot: CircularSlot, around: Surroundings) -> Iterator[BodyMark]:
    """The slot in its body."""
    first, last = slot.arc or (0.0, 2 * np.pi)
    angle = np.linspace(first, last, CORNERS)
    way = np.exp(1j * angle)
    for shape in slot_shapes(
        slot.radius * way, 1j * way, not slot.arc, around.radii.get(slot.point)
    ):
        yield BodyMark(slot.on, slot.center, shape)


def curved_sign(slot: CurvedSlot, around: Surroundings) -> Iterator[BodyMark]:
    """The slot in its body."""
    curve, turn = slot.curve, np.exp(1j * slot.direction)
    s = np.linspace(0.0, curve.knots[-1], CORNERS)
    middle, first, *_ = curve.at(s)
    ahead = turn * first / abs(first)
    for shape in slot_shapes(turn * middle, ahead, slot.closed, around.radii.get(slot.point)):
        yield BodyMark(slot.on, slot.origin, shape)


def slot_shapes(
    middle: Array, ahead: Array, closed: bool, radius: float | None = None
) -> Iterator[Shape]:
    """A slot about its middle line (n,), complex, m, with the directions along it, of size 1.

    closed : whether it ends where it begins.  radius : of its pin, m, where that is drawn to scale.
    """
    size, grown = (0.0, PIN + PLAY) if radius is None else (radius, PLAY)
    aside = 1j * ahead
    if closed:
        for way in (aside, -aside):
            yield Shape("path-edge", middle + size * way, grown * way, closed=True)
        return
    rounds = [CAP * ahead[-1], CAP * -ahead[0]]
    places = [middle[::-1], np.full(len(CAP), middle[0]), middle, np.full(len(CAP), middle[-1])]
    ways = np.concatenate([aside[::-1], rounds[1], -aside, rounds[0]])
    yield Shape("path", np.concatenate(places) + size * ways, grown * ways, closed=True)
