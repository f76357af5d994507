"""Natural frequencies of a tool without damping, by a count that cannot miss one."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.tools.chain import carry, count
from equipoise.tools.layout import Layout
from equipoise.tools.model import PLANES, Station, Tool

Array = np.ndarray[Any, Any]

PARTS, ROUNDS = 63, 20
"""Each round cuts the bracket of every frequency into so many parts, one more than these, until
nothing lies between its ends."""
GROWTH, DOUBLINGS = 2.0, 200
"""Growth of the highest frequency until there are enough below it."""
MOST = 200


def scale_of(tool: Tool) -> float:
    """Frequency (rad/s) of the shaft at which lambda is 1: sqrt(EI / (m L^3)) with its own mass."""
    shaft = tool.shaft
    stiffness = shaft.profile.section(shaft.theory).bending_stiffness
    return float(np.sqrt(stiffness / (shaft.mass * shaft.length**3)))


def rigid_modes(tool: Tool) -> list[Array]:
    """Motions (D, 2) of the shaft that no spring holds, in the vertical and in the lateral plane.

    Displacement of the left end (m) and slope (rad) of each rigid motion that is free.
    """
    return [_free(tool, plane) for plane in range(len(PLANES))]


def floating(tool: Tool) -> list[list[str]]:
    """Stations of each plane whose absorber has a mass, but no spring."""
    return [
        [
            one.name
            for one in tool.stations
            if one.absorber is not None and one.absorber.mass and not one.absorber.stiffness[plane]
        ]
        for plane in range(len(PLANES))
    ]


def _free(tool: Tool, plane: int) -> Array:
    """By how many places springs hold, and whether one holds a rotation: however stiff they are."""
    places = sorted({one.position for one in tool.stations if _spring(one, plane)})
    turning = any(one.rotational_stiffness[plane] for one in tool.stations)
    if len(places) > 1 or (places and turning):
        return np.empty((0, 2))
    if places:
        place = places[0]
        return np.array([[-place, 1.0] if place else [0.0, 1.0]])
    across, turned = [1.0, 0.0], [0.0, 1.0]
    return np.array([across] if turning else [across, turned])


def _spring(station: Station, plane: int) -> float:
    """Stiffness to what does not move, N/m; a measured hand is none."""
    total = station.stiffness[plane]
    if station.harness is not None:
        total += station.harness.stiffness[plane]
    if station.hand is not None and not station.hand.impedance:
        total += station.hand.hands * station.hand.stiffness[plane]
    return total


def natural_frequencies(tool: Tool, number: int) -> Array:
    """The first so many natural frequencies (2, number) of both planes, rad/s, without damping.

    Rigid motions that no spring holds come first, as 0.  A frequency that stands twice is told
    twice.  Hands known by a table of impedance are left out.

    Raises
    ------
    UsageError : too many are asked for.
    """
    if not 1 <= number <= MOST:
        raise UsageError(f"got {number} natural frequencies; ask for 1 to {MOST}")
    layout, below = _enough(tool, number)
    wanted = np.arange(1, number + 1)
    free = zip(rigid_modes(tool), floating(tool), strict=True)
    rigid = np.array([[len(motions) + len(names)] for motions, names in free])
    bottom, top = np.zeros((2, number)), np.full((2, number), below)
    shares = np.arange(1, PARTS + 1) / (PARTS + 1)
    for _ in range(ROUNDS):
        inner = bottom[..., None] + (top - bottom)[..., None] * shares
        reached = _count(layout, inner.reshape(2, -1)).reshape(inner.shape) >= wanted[:, None]
        before = np.sum(~reached, axis=-1)  # the count grows with the frequency
        edges = np.concatenate([bottom[..., None], inner, top[..., None]], axis=-1)
        bottom = np.take_along_axis(edges, before[..., None], -1)[..., 0]
        top = np.take_along_axis(edges, before[..., None] + 1, -1)[..., 0]
        if np.all((top - bottom <= 2 * np.spacing(top)) | (wanted <= rigid)):
            break
    found: Array = np.where(wanted <= rigid, 0.0, (bottom + top) / 2)
    return found


def frequencies_below(tool: Tool, highest: float) -> list[Array]:
    """All natural frequencies of each plane below one, rad/s, without rigid motions."""
    reached = _count(Layout(tool, highest), np.full((2, 1), highest))[:, 0]
    most = int(min(np.max(reached), MOST))
    if most == 0:
        return [np.empty(0), np.empty(0)]
    found = natural_frequencies(tool, most)
    return [row[(row > 0) & (row < highest)] for row in found]


def _enough(tool: Tool, number: int) -> tuple[Layout, float]:
    """A layout, and a frequency below which both planes have so many natural ones, rad/s."""
    highest = scale_of(tool) * (np.pi * (number + 1)) ** 2
    for _ in range(DOUBLINGS):
        layout = Layout(tool, highest)
        if np.all(_count(layout, np.full((2, 1), highest)) >= number):
            return layout, highest
        highest *= GROWTH
    raise ModelError("shaft", "has no such high natural frequencies; check its length and section")


def _count(layout: Layout, frequency: Array) -> Array:
    """Natural frequencies below each of these (2, F), rad/s."""
    s = 1j * frequency
    total = count(carry(layout.chain(s, "undamped")))
    for below in layout.absorbers(s, "undamped"):  # with its base held, it swings at k = m w^2
        total = total + (np.real(below) < 0)
    return np.broadcast_to(total, frequency.shape)
