"""Natural frequencies against a number of the tool, and the determinant whose zeros they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.frequencies import characteristic, natural_frequencies, scale_of
from equipoise.handheld.layout import Layout
from equipoise.handheld.model import NOTHING, Station, Tool
from equipoise.i18n import Note
from equipoise.mechanism.checks import unknown
from equipoise.results.result import Result
from equipoise.signals import Array


def changed(tool: Tool, station: str, key: str, value: float) -> Tool:
    """The tool with one number of a station changed, of a pair both.

    station, key : as in `design_plan.DesignVariable`.

    Raises
    ------
    ModelError, UsageError : there is no such station or number, or it cannot have that value.
    """
    item = tool.station(station)
    check_key(item, key)
    *path, last = key.split(".")
    owner: Any = getattr(item, path[0]) if path else item
    number = (value, value) if isinstance(getattr(owner, last), tuple) else value
    owner = replace(owner, **{last: number})
    return tool.with_station(station, **({path[0]: owner} if path else {last: number}))


def check_key(station: Station, key: str) -> None:
    """A station must have the number that a key names."""
    known = [name for name in KEYS if has(station, name)]
    if key not in KEYS:
        raise UsageError(unknown(key, known, Note("number of {name!r}", name=station.name)))
    if key not in known:
        raise UsageError(
            Note(
                "{name!r} has no {key}; give it one first",
                name=station.name,
                key=key.partition(".")[0],
            )
        )


def has(station: Station, key: str) -> bool:
    """Whether a station has what a key's number belongs to."""
    owner, dot, _ = key.partition(".")
    return not dot or getattr(station, owner) is not None


def number_of(tool: Tool, station: str, key: str) -> float:
    """A number of a station; of a pair the vertical one."""
    value = tool.station(station).number(key)
    return value[0] if isinstance(value, tuple) else value


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

    blocks_in = "handheld.hand_blocks.variation_blocks"
    pictures_in = "figures.tool_designs.variation_charts"

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
