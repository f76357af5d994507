"""Free vibration of a tool: frequencies, eigenvalues with damping, shapes and their nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from equipoise.tools.chain import Pair, carry, solve
from equipoise.tools.damped import eigenvalues, overdamped
from equipoise.tools.fields import Field
from equipoise.tools.frequencies import natural_frequencies, rigid_modes, scale_of
from equipoise.tools.layout import Kind, Layout
from equipoise.tools.model import PLANES, Tool

Array = np.ndarray[Any, Any]

POINTS = 401
"""Places at which a shape is told."""
BESIDE = 1e-9
"""Share of an eigenvalue by which a load shakes beside it to bring out the shape."""
SAME = 1e-9
"""Share of each other within which two natural frequencies are one."""
SLOWEST = 1e-4
"""Smallest eigenvalue looked for that does not swing, over the frequency of the bare shaft."""


@dataclass(frozen=True, eq=False)
class DampedMode:
    """A free motion that grows as exp(eigenvalue * t).

    eigenvalue : 1/s; with a positive imaginary part, or real where it does not swing.
    shape : (X,) complex, 1 where it is largest.
    """

    eigenvalue: complex
    shape: Array

    @property
    def damping_ratio(self) -> float:
        """Share of the critical damping."""
        return -self.eigenvalue.real / abs(self.eigenvalue)

    @property
    def cycles_per_second(self) -> float:
        """Frequency with which it swings, Hz."""
        return self.eigenvalue.imag / (2 * pi)


@dataclass(frozen=True, eq=False)
class PlaneModes:
    """Free vibration in one plane.

    frequency : natural frequencies (K,) without damping, rad/s; 0 for rigid motions.
    parameter : lambda = (m omega^2 L^4 / EI)^(1/4) of each, with mass and stiffness of the shaft.
    rigid : what the motions at 0 are called.
    shapes : (K, X) without damping, 1 where they are largest.
    nodes : places (m) that stand still in each of them.
    damped : with damping, in the order of |eigenvalue|, up to the highest of `frequency`.
    """

    frequency: Array
    parameter: Array
    rigid: tuple[str, ...]
    shapes: Array
    nodes: tuple[Array, ...]
    damped: tuple[DampedMode, ...]

    @property
    def cycles_per_second(self) -> Array:
        """Natural frequencies (K,), Hz."""
        return self.frequency / (2 * pi)


@dataclass(frozen=True, eq=False)
class ToolModes:
    """Free vibration of a tool.

    places : (X,), m from the left end, at which shapes are told.
    planes : vertical and lateral; the lateral one is the same object where the tool is alike.
    """

    tool: Tool
    places: Array
    planes: tuple[PlaneModes, PlaneModes]
    notes: tuple[str, ...]

    @property
    def alike(self) -> bool:
        """Whether both planes are the same."""
        return self.planes[0] is self.planes[1]

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units; natural frequencies in Hz."""
        first = self.planes[0]
        return {
            "natural_frequencies": first.cycles_per_second,
            "eigenvalues": first.parameter,
            "places": self.places,
            "planes": {
                name: _plane_dict(plane) for name, plane in zip(PLANES, self.planes, strict=True)
            },
            "notes": list(self.notes),
        }


def _plane_dict(plane: PlaneModes) -> dict[str, Any]:
    return {
        "natural_frequencies": plane.cycles_per_second,
        "eigenvalues": plane.parameter,
        "rigid": list(plane.rigid),
        "shapes": plane.shapes,
        "nodes": [nodes.tolist() for nodes in plane.nodes],
        "damped": [
            {
                "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
                "frequency": mode.cycles_per_second,
                "damping_ratio": mode.damping_ratio,
            }
            for mode in plane.damped
        ],
    }


def vibrate_tool(tool: Tool, number: int = 6) -> ToolModes:
    """The first natural frequencies of each plane, their shapes, and eigenvalues with damping.

    number : how many natural frequencies, rigid motions included.

    Raises
    ------
    UsageError : too many are asked for.
    """
    frequency = natural_frequencies(tool, number + 1)
    radius = np.maximum(np.sqrt(frequency[:, -2] * frequency[:, -1]), scale_of(tool))
    frequency = frequency[:, :-1]
    layout = Layout(tool, 2 * float(np.max(radius)))
    places = np.linspace(0.0, tool.shaft.length, POINTS)
    shapes = _still_shapes(layout, frequency, places)
    damped, lacking = _damped_modes(layout, frequency, radius, places)
    rigid = rigid_modes(tool)
    planes = [
        PlaneModes(
            frequency[plane],
            np.sqrt(frequency[plane] / scale_of(tool)),
            rigid_names(rigid[plane]),
            shapes[plane],
            tuple(_zeros(places, shape) for shape in shapes[plane]),
            damped[plane],
        )
        for plane in range(1 if tool.alike else 2)
    ]
    return ToolModes(tool, places, (planes[0], planes[-1]), tuple(_notes(tool, lacking)))


def _still_shapes(layout: Layout, frequency: Array, places: Array) -> Array:
    """Shapes (2, K, X) without damping; of equal frequencies such that they share no momentum."""
    found = _shapes(layout, 1j * np.where(frequency > 0, frequency, 1.0), places, "undamped")
    shapes = np.moveaxis(found, 0, -1).real.copy()
    for plane, free in enumerate(rigid_modes(layout.tool)):
        for k, (across, slope) in enumerate(free):
            shapes[plane, k] = across + slope * places
        for k in range(1, shapes.shape[1]):
            earlier, later = frequency[plane, k - 1 : k + 1]
            if later - earlier <= SAME * later and later > 0:
                shapes[plane, k] -= _share(layout.tool, places, *shapes[plane, k - 1 : k + 1])
    return np.asarray(_scaled(shapes).real)


def _share(tool: Tool, places: Array, one: Array, other: Array) -> Array:
    """The part of one shape that is in another, by momentum."""

    def momentum(shape: Array) -> float:
        total = 0.0
        for start, stop, section in tool.shaft.pieces:
            inside = (places >= start) & (places <= stop)
            along = np.trapezoid(one[inside] * shape[inside], places[inside])
            total += section.mass_per_length * float(along)
        for station in tool.stations:
            here, there = (
                float(np.interp(station.position, places, part)) for part in (one, shape)
            )
            total += station.mass * here * there
        return total

    return one * (momentum(other) / momentum(one))


def _damped_modes(
    layout: Layout, frequency: Array, radius: Array, places: Array
) -> tuple[list[tuple[DampedMode, ...]], list[int]]:
    """Modes with damping of both planes, by size, and how many were not found."""
    starts = np.maximum(frequency, 1e-3 * radius[:, None])
    if layout.tool.damped:
        swinging, lacking = eigenvalues(layout, starts, radius)
        slow = overdamped(layout, SLOWEST * scale_of(layout.tool), radius)
    else:
        swinging, lacking = [1j * row[row > 0] for row in frequency], [0, 0]
        slow = [np.empty(0), np.empty(0)]
    found = []
    for plane in range(2):
        values = np.array(sorted([*swinging[plane], *slow[plane]], key=abs), complex)
        shapes = _scaled(np.moveaxis(_shapes(layout, values[None], places, "free"), 0, -1))
        found.append(tuple(map(DampedMode, values.tolist(), shapes[plane])))
    return found, lacking


def _shapes(layout: Layout, s: Array, places: Array, kind: Kind) -> Array:
    """Displacement (X, 2, K) close beside each eigenvalue, under a load that knows no symmetry."""
    s = s * (1 + BESIDE)
    carried = carry(layout.chain(s, kind))
    numbers = np.arange(s.shape[-1])
    loads = [
        Pair(1 + np.cos(2.4 * k + 0.7 * numbers), np.sin(1.3 * k + 0.3 + 1.1 * numbers))
        for k in range(len(layout.nodes))
    ]
    states = solve(carried, loads)
    return Field(layout, np.broadcast_to(s, (2, s.shape[-1])), states, kind).at(places).displacement


def _scaled(shapes: Array) -> Array:
    """Shapes (..., X), each 1 where it is largest."""
    at = np.argmax(np.abs(shapes), axis=-1)[..., None]
    return np.asarray(shapes / np.take_along_axis(shapes, at, -1))


def _zeros(places: Array, shape: Array) -> Array:
    """Places at which a shape changes its sign, by a cubic through the four points about each."""
    before = np.flatnonzero(np.signbit(shape[1:]) != np.signbit(shape[:-1]))
    first = np.clip(before - 1, 0, len(places) - 4)
    found = []
    for k in first:
        x, y = places[k : k + 4], shape[k : k + 4]
        # the place as a cubic of the displacement, as the shape rises or falls through it
        found.append(
            sum(
                x[i] * np.prod([y[j] / (y[j] - y[i]) for j in range(4) if j != i]) for i in range(4)
            )
        )
    return np.array(found)


def rigid_names(free: Array) -> tuple[str, ...]:
    """What rigid motions are called, by displacement of the left end (m) and slope (rad)."""
    if len(free) == 2:
        return ("moves to and fro", "turns about its left end")
    names = []
    for across, slope in free:
        still = -across / slope if slope else np.inf
        names.append("moves to and fro" if not slope else f"turns about {still:.4g} m")
    return tuple(names)


def _notes(tool: Tool, lacking: Sequence[int]) -> list[str]:
    notes = [
        f"the hand at {one.name} is known by its impedance at real frequencies only; the modes are "
        "those of the tool without it"
        for one in tool.stations
        if one.hand is not None and one.hand.impedance
    ]
    if max(lacking) > 0:
        notes.append(f"{max(lacking)} eigenvalues with damping could not be found")
    return notes
