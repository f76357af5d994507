"""Free vibration of a tool: frequencies, damping, shapes, and what they depend on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.handheld.chain import NodePair, carry, solve
from equipoise.handheld.frequencies import (
    TOO_FAR_APART,
    characteristic,
    eigenvalues,
    floating,
    frequencies_below,
    natural_frequencies,
    rigid_modes,
    scale_of,
)
from equipoise.handheld.layout import ChainKind, HarmonicField, Layout
from equipoise.handheld.model import NOTHING, PLANES, Station, Tool, changed
from equipoise.i18n import Note, to_say
from equipoise.results.declaring import NOTES, Declarations, ResultOutput
from equipoise.results.result import Result
from equipoise.signals import Array, highest_at

POINTS = 401
"""Samples of a mode shape along the shaft."""

LOAD_OFFSET, ASIDE, LOUDER = 1e-9, 1e-3, 100.0
"""Shares of an eigenvalue by which a load shakes beside it to bring out the shape, and further off;
how many times as loud it must be at the first."""
SAME = 1e-9
"""Share of each other within which two natural frequencies are one."""


FREQUENCIES = ResultOutput(
    "natural frequencies without damping; 0 for rigid motions",
    "frequency",
    read="cycles_per_second",
)
PARAMETERS = ResultOutput(
    r"$\lambda = (m \omega^2 L^4 / EI)^{1/4}$ of each, with the shaft's mass and stiffness",
    read="parameter",
)


@dataclass(frozen=True, eq=False)
class DampedMode:
    """A free motion that grows as exp(eigenvalue * t).

    eigenvalue : 1/s; with a positive imaginary part, or real where it does not swing.
    shape : (X,) complex, 1 where it is largest.
    """

    eigenvalue: complex
    shape: Array

    declared: ClassVar[Declarations] = {
        "eigenvalue": ResultOutput(
            "growth as exp(eigenvalue t): real and imaginary part, 1/s",
            read=lambda mode: [mode.eigenvalue.real, mode.eigenvalue.imag],
        ),
        "frequency": ResultOutput(
            "frequency with which it swings", "frequency", read="cycles_per_second"
        ),
        "damping_ratio": ResultOutput("share of the critical damping"),
    }

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

    declared: ClassVar[Declarations] = {
        "natural_frequencies": FREQUENCIES,
        "eigenvalues": PARAMETERS,
        "rigid": ResultOutput("names of the rigid motions", read=lambda plane: list(plane.rigid)),
        "shapes": ResultOutput("shape of each mode at `places`, 1 where it is largest"),
        "nodes": ResultOutput(
            "places that stand still in each mode",
            "length",
            read=lambda plane: [nodes.tolist() for nodes in plane.nodes],
        ),
        "damped": ResultOutput("modes with damping", of=DampedMode.declared, many=True),
    }


@dataclass(frozen=True, eq=False, repr=False)
class ToolModes(Result):
    """Free vibration of a tool.

    places : (X,), m from the left end, at which shapes are sampled.
    planes : vertical and lateral; the lateral one is the same object where the tool is alike.
    """

    blocks_in = "handheld.blocks.modes_blocks"
    pictures_in = "figures.tool_side.side_mode_charts"
    headline_in = "handheld.blocks.modes_headline"

    tool: Tool
    places: Array
    planes: tuple[PlaneModes, PlaneModes]
    notes: tuple[Note, ...]

    @property
    def alike(self) -> bool:
        """Whether both planes are the same."""
        return self.planes[0] is self.planes[1]

    declared: ClassVar[Declarations] = {
        "natural_frequencies": replace(FREQUENCIES, read="vertical.cycles_per_second"),
        "eigenvalues": replace(PARAMETERS, read="vertical.parameter"),
        "places": ResultOutput("places of the shapes, from the left end", "length"),
        "planes": ResultOutput(
            "the planes `vertical` and `lateral`",
            of=PlaneModes.declared,
            family=True,
            read=lambda modes: dict(zip(PLANES, modes.planes, strict=True)),
        ),
        "notes": NOTES,
    }

    @property
    def vertical(self) -> PlaneModes:
        """Modes of the vertical plane."""
        return self.planes[0]


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
    damped = _damped_modes(layout, frequency, radius, places)
    rigid, loose = rigid_modes(tool), floating(tool)
    planes = [
        PlaneModes(
            frequency[plane],
            np.sqrt(frequency[plane] / scale_of(tool)),
            (
                *rigid_names(rigid[plane]),
                *(Note("absorber at {name} floats", name=name) for name in loose[plane]),
            ),
            shapes[plane],
            tuple(zeros_of(places, shape) for shape in shapes[plane]),
            damped[plane],
        )
        for plane in range(1 if tool.alike else 2)
    ]
    return ToolModes(tool, places, (planes[0], planes[-1]), (*_notes(tool),))


def _damped_modes(
    layout: Layout, frequency: Array, radius: Array, places: Array
) -> list[tuple[DampedMode, ...]]:
    """Modes with damping of both planes, by size."""
    if layout.tool.damped:
        values = eigenvalues(layout, frequency, radius)
    else:
        values = [1j * row[row > 0] for row in frequency]
    damped_modes = []
    for plane in range(2):
        own = values[plane]
        shapes = scaled(np.moveaxis(shapes_beside(layout, own[None], places, "free")[0], 0, -1))
        damped_modes.append(tuple(map(DampedMode, own.tolist(), shapes[plane])))
    return damped_modes


def swinging_below(tool: Tool, highest: float) -> Array:
    """Eigenvalues (K,) of both planes that swing, 1/s, smaller than a frequency, rad/s."""
    natural = frequencies_below(tool, highest)
    most = max(map(len, natural)) + max(map(len, rigid_modes(tool)))
    if not tool.damped or most == 0:
        return np.asarray(1j * np.concatenate(natural))
    values = eigenvalues(
        Layout(tool, 2 * highest), natural_frequencies(tool, most), np.full(2, highest)
    )
    both = np.concatenate(values)
    return np.asarray(both[both.imag > 0])


def rigid_names(free: Array) -> tuple[Note, ...]:
    """What rigid motions are called, by displacement of the left end (m) and slope (rad)."""
    across_alone = Note("moves to and fro")
    if len(free) == 2:
        return (across_alone, Note("turns about its left end"))
    return tuple(
        Note("turns about {place} m", place=f"{0.0 - across / slope:.4g}")
        if slope
        else across_alone
        for across, slope in free
    )


def _notes(tool: Tool) -> Iterator[Note]:
    template = to_say(
        "the hand at {name} is known by its impedance at real frequencies only; "
        "the modes are those of the tool without it"
    )
    for station in tool.grips:
        if station.hand is not None and station.hand.impedance:
            yield Note(template, name=station.name)


# -- shapes ----------------------------------------------------------------------------------------


def still_shapes(layout: Layout, frequency: Array, places: Array) -> Array:
    """Shapes (2, K, X) without damping; of equal frequencies such that they share no momentum."""
    swing = 1j * np.where(frequency > 0, frequency, 1.0)
    pair = shapes_beside(layout, swing, places, "undamped")
    shapes, slopes = (np.moveaxis(part, 0, -1).real.copy() for part in pair)
    for plane, free in enumerate(rigid_modes(layout.tool)):
        floats = len(floating(layout.tool)[plane])
        for k, (across, slope) in enumerate(free[: frequency.shape[1]]):
            shapes[plane, k], slopes[plane, k] = across + slope * places, slope
        shapes[plane, len(free) : len(free) + floats] = 0.0
        for k in range(1, shapes.shape[1]):
            earlier, later = frequency[plane, k - 1 : k + 1]
            if later - earlier <= SAME * later and later > 0:
                pairs = [(shapes[plane, item], slopes[plane, item]) for item in (k - 1, k)]
                share = _share(layout, plane, later, places, *pairs)
                shapes[plane, k] -= share * shapes[plane, k - 1]
    return np.asarray(scaled(shapes).real)


DeflectionAndSlope = tuple[Array, Array]
"""Displacement and slope at the places, (X,) each."""


def _share(
    layout: Layout,
    plane: int,
    frequency: float,
    places: Array,
    item: DeflectionAndSlope,
    other: DeflectionAndSlope,
) -> float:
    """How much of one shape is in another, by the momentum that they share."""

    def momentum(shape: DeflectionAndSlope) -> float:
        total = 0.0
        for start, stop, section in layout.tool.shaft.pieces:
            inside = (places >= start) & (places <= stop)
            for kind, density in ((0, section.mass_per_length), (1, section.rotary_inertia)):
                along = np.trapezoid((item[kind] * shape[kind])[inside], places[inside])
                total += density * float(along)
        for station in layout.tool.stations:
            here, there = (
                [float(np.interp(station.position, places, part)) for part in each]
                for each in (item, shape)
            )
            total += _mass(layout, station, plane, frequency) * here[0] * there[0]
            total += station.inertia[plane] * here[1] * there[1]
        return total

    own = momentum(item)
    return momentum(other) / own if own else 0.0


def _mass(layout: Layout, station: Station, plane: int, frequency: float) -> float:
    """What moves with a station, kg, with its absorber, which swings further than it."""
    total = float(layout.mass_at(station))
    absorber = station.absorber
    if absorber is not None:
        stiffness = absorber.stiffness[plane]
        below = stiffness - absorber.mass * frequency**2
        total += absorber.mass * (stiffness / below) ** 2 if below else 0.0
    return total


def shapes_beside(layout: Layout, s: Array, places: Array, kind: ChainKind) -> tuple[Array, Array]:
    """Displacement and slope (X, 2, K) of the shaft for each eigenvalue (1 or 2, K), 1/s.

    Its answer close beside each to a load that knows no symmetry; nothing where that is no louder
    than far beside, as the shaft then is at rest while something on it swings.
    """
    close, far = (_loaded(layout, s * (1 + share), places, kind) for share in (LOAD_OFFSET, ASIDE))
    still = np.max(np.abs(close[0]), axis=0) < LOUDER * np.max(np.abs(far[0]), axis=0)
    return np.where(still, 0.0, close[0]), np.where(still, 0.0, close[1])


def _loaded(layout: Layout, s: Array, places: Array, kind: ChainKind) -> tuple[Array, Array]:
    """Displacement and slope (X, 2, K) under that load."""
    numbers = np.arange(s.shape[-1])
    loads = [
        NodePair(1 + np.cos(2.4 * k + 0.7 * numbers), np.sin(1.3 * k + 0.3 + 1.1 * numbers))
        for k in range(len(layout.nodes))
    ]
    states = solve(carry(layout.chain(s, kind)), loads)
    line = HarmonicField(layout, np.broadcast_to(s, (2, s.shape[-1])), states, kind).at(places)
    return line.displacement, line.slope


def scaled(shapes: Array) -> Array:
    """Shapes (..., X), each 1 where it is largest."""
    if not np.all(np.isfinite(shapes)):
        raise ModelError("shaft", TOO_FAR_APART)
    at = highest_at(np.abs(shapes), smooth=False)[..., None]
    largest = np.take_along_axis(shapes, at, -1)
    return np.asarray(shapes / np.where(largest == 0, 1.0, largest))


def zeros_of(places: Array, shape: Array) -> Array:
    """Places at which a shape changes its sign, by a cubic through the four points about each."""
    before = np.flatnonzero(np.signbit(shape[1:]) != np.signbit(shape[:-1]))
    return np.array([_zero(places, shape, int(k)) for k in before])


def _zero(places: Array, shape: Array, k: int) -> float:
    """The place between two points, as a cubic of the displacement; on a line across a kink."""
    first = min(max(k - 1, 0), len(places) - 4)
    x, y = places[first : first + 4], shape[first : first + 4]
    cubic = 0.0
    with np.errstate(all="ignore"):
        for i in range(4):
            others = np.delete(y, i)
            cubic += float(x[i] * np.prod(others / (others - y[i])))
    if places[k] <= cubic <= places[k + 1]:
        return cubic
    share = shape[k] / (shape[k] - shape[k + 1])
    return float(places[k] + share * (places[k + 1] - places[k]))


@dataclass(frozen=True, eq=False, repr=False)
class Variation(Result):
    """Natural frequencies while a number of a station changes.

    values : (V,), SI units.
    frequency : (2, V, K), rad/s.
    parameter : lambda of each, as in `modes.PlaneModes`.
    """

    tool: Tool
    station: str
    key: str
    values: Array
    frequency: Array
    parameter: Array

    blocks_in = "handheld.blocks.variation_blocks"
    pictures_in = "figures.tool_charts.variation_charts"

    def to_dict(self) -> dict[str, Any]:
        """As plain values; natural frequencies in Hz."""
        values: dict[str, Any] = {"station": self.station, "key": self.key, "values": self.values}
        for suffix, frequency, parameter in zip(
            ("", "_lateral"), self.frequency, self.parameter, strict=True
        ):
            values[f"natural_frequencies{suffix}"] = frequency / (2 * np.pi)
            values[f"eigenvalues{suffix}"] = parameter
        return values


def vary_tool(tool: Tool, station: str, key: str, values: Array, number: int = 5) -> Variation:
    """Natural frequencies against a number of a station: Figs. 3 and 4 of Nagamine and Irie.

    Raises
    ------
    ModelError, UsageError : as `changed`.
    """
    tools = [changed(tool, station, key, float(value)) for value in values]
    frequency = np.stack([natural_frequencies(tool, number) for tool in tools], axis=1)
    parameter = np.sqrt(frequency / scale_of(tool))
    return Variation(tool, station, key, np.asarray(values), frequency, parameter)


@dataclass(frozen=True, eq=False)
class DeterminantChart:
    """The characteristic function without damping, against lambda: Fig. 2 of Nagamine and Irie.

    parameter : lambda, (N,).
    value : (2, N), sign times the decimal logarithm of 1 + its size over its smallest peak: the
        function itself runs over many powers of ten.
    """

    parameter: Array
    value: Array


def determinant_chart(tool: Tool, highest: float, count: int = 800) -> DeterminantChart:
    """The chart from 0 to a highest lambda."""
    if not highest > 0:
        raise UsageError(
            Note("got a highest lambda of {highest:g}; give more than 0", highest=highest)
        )
    parameter = np.linspace(highest / count, highest, count)
    frequency = scale_of(tool) * parameter**2
    undamped = Layout(without_damping(tool), float(frequency[-1]))
    logarithm, _ = characteristic(undamped, 1j * np.array([frequency, frequency]))
    sign, size = np.sign(np.cos(logarithm.imag)), logarithm.real
    turning = (size[:, 1:-1] > size[:, :-2]) & (size[:, 1:-1] > size[:, 2:])
    peaks = [row[1:-1][up] for row, up in zip(size, turning, strict=True)]
    least = np.array([np.min(row, initial=np.median(size)) for row in peaks])[:, None]
    return DeterminantChart(parameter, sign * np.log10(1 + np.exp(size - least)))


def without_damping(tool: Tool) -> Tool:
    """The tool without any loss or damper; a hand known by a table is left out."""
    stations = []
    for station in tool.stations:
        hand = None if station.hand is None or station.hand.impedance else station.hand
        parts: dict[str, Any] = {
            "absorber": station.absorber,
            "harness": station.harness,
            "hand": hand,
        }
        for name, part in parts.items():
            parts[name] = part and replace(part, damping=NOTHING)
        stations.append(replace(station, damping=NOTHING, rotational_damping=NOTHING, **parts))
    shaft = replace(tool.shaft, loss_factor=0.0)
    return replace(tool, shaft=shaft, stations=tuple(stations), design=None)
