"""The search of a design: the best of many places, followed downhill with exact derivatives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from equipoise.errors import ResponseError
from equipoise.tools.duals import Dual
from equipoise.tools.felt import Band, Number, mean_over_band, values_of
from equipoise.tools.model import Tool
from equipoise.tools.wishes import DesignLimit, DesignPlan

Array = np.ndarray[Any, Any]

Told = Callable[[int, int], None]
"""Is called with how many searches are done, and how many there are."""
TRIED, FOLLOWED = 256, 8
"""Designs spread over the room, and how many of the best are followed downhill."""
STEPS, TOLERANCE = 200, 1e-9
LEAST = 1e-3
"""Share of the largest force below which an order does not count in the search."""
SAME = 1e-4
"""Share of the best within which a search has arrived at it too."""


class Search:
    """The measure of a design's numbers, each from 0 to 1 of its range, and the limits.

    The measure is a square, (m/s2)^2: mean or largest a_hv^2 over the band, of the worst hand.
    """

    def __init__(self, tool: Tool, design: DesignPlan, speed: Array) -> None:
        self.tool, self.design, self.band = tool, design, Band(tool, speed, LEAST)
        self.numbers: list[Number] = [(one.station, one.key) for one in design.variables]
        self.low = np.array([one.low for one in design.variables])
        self.wide = np.array([one.high for one in design.variables]) - self.low
        self.hands = design.hands or tuple(one.name for one in tool.grips)
        self.held = tuple({one.station: 0 for one in design.limits if one.output == "force"})
        self.start = values_of(tool, self.numbers)
        self._seen: tuple[bytes, Any] = (b"", None)

    def at(self, place: Array, slopes: bool = True) -> tuple[Dual, Dual]:
        """Measures (M,), of which the largest counts, and limits (C,), each at most 1."""
        key = np.ascontiguousarray(place).tobytes()
        if self._seen[0] != key:
            found = self._at(self.low + self.wide * place, slopes)
            if not slopes:
                return found
            self._seen = (key, found)
        kept: tuple[Dual, Dual] = self._seen[1]
        return kept

    def _at(self, values: Array, slopes: bool) -> tuple[Dual, Dual]:
        held = [name for name in self.held if name]
        felt = self.band.felt(self.numbers, values, held, slopes)
        squares = [felt.hands[name] for name in self.hands]
        if self.design.measure == "rms":
            squares = [mean_over_band(one) for one in squares]
        limits = [self._limit(one, felt.hands, felt.forces, values) for one in self.design.limits]
        return self._joined(squares), self._joined(limits)

    def _limit(
        self, limit: DesignLimit, hands: dict[str, Dual], forces: dict[str, Dual], values: Array
    ) -> Dual:
        """What is limited, over its limit."""
        if limit.output == "added_mass":
            mine = np.array([key in ("mass", "absorber.mass") for _, key in self.numbers])
            added = float(np.sum((values - self.start)[mine]))
            slopes = mine.astype(float)[: len(next(iter(hands.values())).slopes), None]
            return Dual(np.array([added]), slopes) / max(limit.at_most, 1e-12)
        source = hands if limit.output == "acceleration" else forces
        return source[str(limit.station)] / limit.at_most**2

    def _joined(self, parts: list[Dual]) -> Dual:
        """All values in a row, with slopes by place."""
        if not parts:
            return Dual(np.empty(0), np.empty((len(self.wide), 0)))
        slopes = np.concatenate([part.slopes for part in parts], axis=1)
        wide = self.wide[: len(slopes), None]
        return Dual(np.concatenate([part.value for part in parts]), slopes * wide)

    def measure(self, place: Array) -> float:
        """The measure, (m/s2)^2."""
        return float(np.max(self.at(place, slopes=False)[0].value))

    def best(self, told: Told, starts: Array | None = None) -> tuple[Array, int, int]:
        """Best place, how many searches arrived there, and how many there were."""
        places = self._promising() if starts is None else starts
        found = []
        for done, place in enumerate(places):
            told(done, len(places))
            found.append(self._downhill(place))
        within = [place for place in found if self._within(place)]
        if not within:
            raise ResponseError(
                "no design within the limits was found; raise a limit, or widen the range of a "
                "variable"
            )
        values = np.array([self.measure(place) for place in within])
        best = int(np.argmin(values))
        arrived = int(np.sum(values <= values[best] * (1 + SAME)))
        return within[best], arrived, len(places)

    def _within(self, place: Array) -> bool:
        return bool(np.all(self.at(place, slopes=False)[1].value <= 1 + 1e-6))

    def _promising(self) -> Array:
        """The best of designs spread over the room; the tool's own is among them."""
        from scipy.stats import qmc

        spread = qmc.Sobol(len(self.wide), seed=1).random(TRIED)
        own = np.clip((self.start - self.low) / self.wide, 0, 1)
        places = np.vstack([own, spread])
        worth = [self._worth(place) for place in places]
        order = np.argsort(worth, kind="stable")[:FOLLOWED]
        return places[order if 0 in order else np.append(order[:-1], 0)]

    def _worth(self, place: Array) -> float:
        measures, limits = self.at(place, slopes=False)
        beyond = float(np.sum(np.maximum(limits.value - 1, 0)))
        return float(np.nan_to_num(np.max(measures.value), nan=np.inf)) * (1 + 10 * beyond)

    def _downhill(self, place: Array) -> Array:
        """The least bound on all measures, by sequential quadratic programs."""
        from scipy.optimize import Bounds, minimize

        unit = self.measure(place)
        count = len(place)

        def room(x: Array) -> Array:
            measures, limits = self.at(x[:-1])
            return np.concatenate([x[-1] - measures.value / unit, 1 - limits.value])

        def slopes(x: Array) -> Array:
            measures, limits = self.at(x[:-1])
            one = np.ones((measures.value.size, 1))
            upper = np.hstack([-measures.slopes.T / unit, one])
            lower = np.hstack([-limits.slopes.T, np.zeros((limits.value.size, 1))])
            return np.vstack([upper, lower])

        ahead = np.append(np.zeros(count), 1.0)
        done = minimize(
            lambda x: x[-1],
            np.append(place, 1.0),
            jac=lambda x: ahead,
            bounds=Bounds(np.zeros(count + 1), np.append(np.ones(count), np.inf)),
            constraints={"type": "ineq", "fun": room, "jac": slopes},
            method="SLSQP",
            options={"maxiter": STEPS, "ftol": TOLERANCE},
        )
        end = np.clip(done.x[:-1], 0, 1)
        better = self._worth(end) <= self._worth(place)
        return np.asarray(end if better else place)
