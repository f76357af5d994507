"""What a design does to the hands: its figures over a band of speeds, with exact derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.tools.duals import Dual, variables
from equipoise.tools.exposed import NO_HANDS, weighted_squares
from equipoise.tools.hands import check_coverage
from equipoise.tools.layout import Layout
from equipoise.tools.model import Tool
from equipoise.tools.response import NOTHING, shaken
from equipoise.tools.sources import loud, orders_of, shakes
from equipoise.tools.studies import has, number_of
from equipoise.tools.wishes import KEYS

Array = np.ndarray[Any, Any]
TOGETHER = 24
"""Numbers of whose derivatives memory has to hold at once."""
Number = tuple[str, str]
"""Station and key of a number of the tool."""


@dataclass(frozen=True, eq=False)
class Felt:
    """Squares over a band of speeds (S,), with their derivatives by the numbers (P,) asked for.

    hands : a_hv^2 of each hand, (m/s2)^2: value (S,) and slopes (P, S).
    forces : mean square over time of the force on the body at each station that is held, N2.
    """

    hands: dict[str, Dual]
    forces: dict[str, Dual]


class Band:
    """A tool over a band of speeds (S,), rad/s; what does not depend on a design is done once.

    least : share of the largest force below which an order is left out.

    Raises
    ------
    ModelError : no hand holds it, nothing shakes it, or a hand's table does not reach that far.
    """

    def __init__(self, tool: Tool, speed: Array, least: float = 0.0) -> None:
        if not tool.grips:
            raise ModelError("shaft.stations", NO_HANDS)
        if not tool.excitations:
            raise ModelError("excitations", NOTHING)
        self.tool, self.speed = tool, speed
        self.shakes = loud(shakes(tool), float(np.max(speed)), least)
        self.orders = orders_of(self.shakes)
        self.highest = float(self.orders[-1] * np.max(speed))
        check_coverage(tool, float(self.orders[0] * np.min(speed)), self.highest)
        self.frequency = np.multiply.outer(self.orders, speed).reshape(1, -1)

    def felt(
        self,
        numbers: Sequence[Number],
        values: Array | None = None,
        held: Sequence[str] = (),
        slopes: bool = True,
    ) -> Felt:
        """What the hands get with some numbers (P,) of the tool changed.

        values : of the numbers, both of a pair alike; the tool's own, each of a pair, if None.
        held : stations at which the force on the body is asked for too.
        slopes : whether the derivatives are asked for.
        """
        own = values is None
        start = values_of(self.tool, numbers) if values is None else values
        changed = dict(zip(numbers, variables(start, 2, slopes), strict=True))
        for (station, key), variable in changed.items() if own else ():
            variable.value = self._own(station, key)
        layout = Layout(self.tool, self.highest, changed)
        field = shaken(layout, self.shakes, self.orders, self.speed)
        motion = {
            name: field.states.motion[layout.node_of[name]].across
            for name in {*held, *(one.name for one in self.tool.grips)}
        }
        return Felt(
            {
                one.name: self._over_orders(weighted_squares(self.frequency, motion[one.name]))
                for one in self.tool.grips
            },
            {name: self._force(layout, field.s, name, motion[name]) for name in held},
        )

    def _own(self, station: str, key: str) -> Array:
        """A number of the tool as (1, 1), a pair as (2, 1)."""
        return np.atleast_1d(np.array(self.tool.station(station).number(key)))[:, None]

    def _force(self, layout: Layout, s: Array, name: str, moved: Any) -> Dual:
        """Mean square of the force on all that holds a station."""
        stiffness: Any = sum(layout.on_body(self.tool.station(name), s).values())
        force = stiffness * moved
        return self._over_orders(force * force.conj() * 0.5)

    def _over_orders(self, squares: Dual) -> Dual:
        """Sum over planes and orders: from (2, K S) to (S,)."""
        shape = (2, len(self.orders), len(self.speed))
        value = squares.value.real.reshape(shape).sum(axis=(0, 1))
        count = len(squares.slopes)
        full = np.broadcast_to(squares.slopes.real, (count, *squares.value.shape))
        return Dual(value, full.reshape(count, *shape).sum(axis=(1, 2)))


def values_of(tool: Tool, numbers: Sequence[Number]) -> Array:
    """What these numbers are in the tool, (P,)."""
    return np.array([number_of(tool, station, key) for station, key in numbers])


def band_weights(count: int) -> Array:
    """Weights (S,) of equally spaced speeds for a mean, by trapezia."""
    weights = np.ones(count)
    weights[[0, -1]] = 0.5
    return np.asarray(weights / weights.sum())


def mean_over_band(square: Dual) -> Dual:
    """Mean (1,) over the speeds of a band (S,)."""
    weights = band_weights(square.value.size)
    return Dual((square.value @ weights)[None], (square.slopes @ weights)[:, None])


def tool_sensitivities(tool: Tool, speed: Array) -> dict[Number, float]:
    """Derivative of the RMS over speeds (S,) of the worst hand's a_hv by every number of the tool.

    In m/s2 for each SI unit; of a pair of numbers, by both together.
    """
    numbers = [(one.name, key) for one in tool.stations for key in KEYS if has(one, key)]
    band = Band(tool, speed)
    parts = [band.felt(numbers[k : k + TOGETHER]) for k in range(0, len(numbers), TOGETHER)]
    means = {name: mean_over_band(one).value[0] for name, one in parts[0].hands.items()}
    worst = max(means, key=lambda name: float(means[name]))
    slopes = np.concatenate([mean_over_band(part.hands[worst]).slopes[:, 0] for part in parts])
    return dict(zip(numbers, (slopes / (2 * np.sqrt(means[worst]))).tolist(), strict=True))
