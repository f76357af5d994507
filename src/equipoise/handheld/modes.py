"""Free vibration of a tool: frequencies, eigenvalues with damping, shapes and their nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from equipoise.handheld.frequencies import (
    eigenvalues,
    floating,
    frequencies_below,
    natural_frequencies,
    rigid_modes,
    scale_of,
)
from equipoise.handheld.layout import Layout
from equipoise.handheld.model import PLANES, Tool
from equipoise.handheld.shapes import scaled, shapes_beside, still_shapes, zeros_of
from equipoise.i18n import Note, to_say
from equipoise.results.result import Result

Array = np.ndarray[Any, Any]

POINTS = 401
"""Places at which a shape is told."""
NUDGE = 1e-3
"""Share of the radius at which the search for what moves without a spring begins."""
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


@dataclass(frozen=True, eq=False, repr=False)
class ToolModes(Result):
    """Free vibration of a tool.

    places : (X,), m from the left end, at which shapes are told.
    planes : vertical and lateral; the lateral one is the same object where the tool is alike.
    """

    tool: Tool
    places: Array
    planes: tuple[PlaneModes, PlaneModes]
    notes: tuple[Note, ...]

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
            "notes": list(map(str, self.notes)),
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
    shapes = still_shapes(layout, frequency, places)
    damped, lacking = _damped_modes(layout, frequency, radius, places)
    rigid, loose = rigid_modes(tool), floating(tool)
    planes = [
        PlaneModes(
            frequency[plane],
            np.sqrt(frequency[plane] / scale_of(tool)),
            (*rigid_names(rigid[plane]), *(f"absorber at {name} floats" for name in loose[plane])),
            shapes[plane],
            tuple(zeros_of(places, shape) for shape in shapes[plane]),
            damped[plane],
        )
        for plane in range(1 if tool.alike else 2)
    ]
    return ToolModes(tool, places, (planes[0], planes[-1]), tuple(_notes(tool, lacking)))


def _damped_modes(
    layout: Layout, frequency: Array, radius: Array, places: Array
) -> tuple[list[tuple[DampedMode, ...]], list[int]]:
    """Modes with damping of both planes, by size, and how many were not found."""
    if layout.tool.damped:
        values, lacking = _eigenvalues(layout, frequency, radius)
    else:
        values, lacking = [1j * row[row > 0] for row in frequency], [0, 0]
    found = []
    for plane in range(2):
        own = values[plane]
        shapes = scaled(np.moveaxis(shapes_beside(layout, own[None], places, "free")[0], 0, -1))
        found.append(tuple(map(DampedMode, own.tolist(), shapes[plane])))
    return found, lacking


def _eigenvalues(layout: Layout, frequency: Array, radius: Array) -> tuple[list[Array], list[int]]:
    """As `eigenvalues`, from the natural frequencies (2, K); rigid motions begin beside 0."""
    starts = np.maximum(frequency, NUDGE * radius[:, None])
    return eigenvalues(layout, starts, (_slowest(layout.tool, frequency), radius))


def _slowest(tool: Tool, frequency: Array) -> float:
    """Smallest size of an eigenvalue that is looked for, 1/s, by the natural frequencies, rad/s."""
    least = SLOWEST * scale_of(tool)
    return min(least, SLOWEST * float(np.min(frequency[frequency > 0], initial=least / SLOWEST)))


def swinging_below(tool: Tool, highest: float) -> Array:
    """Eigenvalues (K,) of both planes that swing, 1/s, smaller than a frequency, rad/s."""
    natural = frequencies_below(tool, highest)
    most = max(map(len, natural)) + max(map(len, rigid_modes(tool)))
    if not tool.damped or most == 0:
        return np.asarray(1j * np.concatenate(natural))
    frequency = natural_frequencies(tool, most)
    values, _ = _eigenvalues(Layout(tool, 2 * highest), frequency, np.full(2, highest))
    both = np.concatenate(values)
    return np.asarray(both[both.imag > 0])


def rigid_names(free: Array) -> tuple[str, ...]:
    """What rigid motions are called, by displacement of the left end (m) and slope (rad)."""
    if len(free) == 2:
        return ("moves to and fro", "turns about its left end")
    names = []
    for across, slope in free:
        still = 0.0 - across / slope if slope else np.inf
        names.append("moves to and fro" if not slope else f"turns about {still:.4g} m")
    return tuple(names)


def _notes(tool: Tool, lacking: Sequence[int]) -> list[Note]:
    notes = [
        Note(
            to_say(
                "the hand at {name} is known by its impedance at real frequencies only; "
                "the modes are those of the tool without it"
            ),
            name=one.name,
        )
        for one in tool.stations
        if one.hand is not None and one.hand.impedance
    ]
    for name, count in zip(PLANES, lacking, strict=True):
        if count > 0:
            one, many = to_say("1 eigenvalue"), to_say("{count} eigenvalues")
            told = Note(one) if count == 1 else Note(many, count=count)
            template = to_say("{many} with damping of the {name} plane could not be found")
            notes.append(Note(template, many=told, name=name))
    return notes
