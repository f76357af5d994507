"""Where to put handle, harness, mass and absorber so that the hands feel least."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.results.result import Result
from equipoise.tools.exposed import grips
from equipoise.tools.felt import values_of
from equipoise.tools.model import Tool
from equipoise.tools.response import respond_tool, rms_over_time
from equipoise.tools.search import Search, Told
from equipoise.tools.studies import changed
from equipoise.tools.sweep import speeds_between
from equipoise.tools.wishes import KEYS

Array = np.ndarray[Any, Any]

SPEEDS = 81
"""Speeds in the band, at first."""
FINER, STILL = 4, 0.002
"""On so many times as many speeds the measure must be the same to this share; else they double."""
DOUBLINGS = 3
DIGITS = 6
"""Significant digits of the numbers of a better tool, for people to set."""
EDGE = 1e-6
"""Share of its range within which a variable is at an end of it."""
ACCELERATION = "acceleration"
WORDS = {"rms": "RMS over the band", "peak": "largest"}
NO_DESIGN = (
    "missing; add the table [design] with the band of speeds, and [[design.variables]] with what "
    "may be changed"
)


@dataclass(frozen=True, eq=False)
class Before:
    """A figure before and after, in SI units."""

    name: str
    dimension: str
    before: float
    after: float


@dataclass(frozen=True, eq=False, repr=False)
class ToolDesign(Result):
    """The best design found.

    tool, better : before and after.
    variables : what was changed.
    figures : measure, worst accelerations and forces before and after.
    edges : ``lowest`` or ``highest`` where a variable ends at an end of its range, else empty.
    searches, arrived : followed downhill, and how many of them came to the best.
    speed : (S,), rad/s; a_hv : of the worst hand, before and after, (2, S), m/s2.
    """

    tool: Tool
    better: Tool
    variables: tuple[Before, ...]
    figures: tuple[Before, ...]
    edges: tuple[str, ...]
    searches: int
    arrived: int
    speed: Array
    a_hv: Array

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""

        def told(rows: Iterable[Before]) -> dict[str, Any]:
            return {row.name: {"before": row.before, "after": row.after} for row in rows}

        names = [row.name for row in self.variables]
        return {
            "variables": told(self.variables),
            "figures": told(self.figures),
            "edges": dict(zip(names, self.edges, strict=True)),
            "searches": self.searches,
            "arrived": self.arrived,
            "speed": self.speed,
            "a_hv_before": self.a_hv[0],
            "a_hv_after": self.a_hv[1],
        }


def design_tool(tool: Tool, told: Told | None = None) -> ToolDesign:
    """Change what the tool's [design] allows so that the hands feel least over its band.

    Designs spread over the whole room are tried, and the best of them followed downhill with exact
    derivatives; `arrived` of `searches` tells how sure one may be that nothing better is there.

    told : is called with how many searches are done, and how many there are.

    Raises
    ------
    ModelError : it tells no design, or as `felt.Band`.
    ResponseError : nothing within the limits was found.
    """
    design = tool.design
    if design is None:
        raise ModelError("design", NO_DESIGN)
    count, starts = SPEEDS, None
    first: tuple[int, int] | None = None
    for _ in range(DOUBLINGS + 1):
        search = Search(tool, design, np.linspace(*design.speeds, count))
        best, arrived, searches = search.best(told or _silent, starts)
        first = first or (arrived, searches)
        fine = Search(tool, design, np.linspace(*design.speeds, FINER * (count - 1) + 1))
        coarse, exact = search.measure(best), fine.measure(best)
        if abs(exact - coarse) <= STILL * exact:
            break
        count, starts = 2 * count - 1, best[None]
    return _told(fine, best, *(first or (0, 0)))


def _silent(done: int, total: int) -> None:
    """For those who do not want to be told."""


def _told(search: Search, best: Array, arrived: int, searches: int) -> ToolDesign:
    """The result, from the tool that the best numbers make."""
    tool, design = search.tool, search.design
    values = search.low + search.wide * best
    better = tool
    for one, value in zip(design.variables, values, strict=True):
        handy = min(max(float(f"{value:.{DIGITS}g}"), one.low), one.high)
        better = changed(better, one.station, one.key, handy)
    after = values_of(better, search.numbers)
    rows = tuple(
        Before(one.name, KEYS[one.key], float(start), float(end))
        for one, start, end in zip(design.variables, search.start, after, strict=True)
    )
    speed = search.band.speed
    edges = ("lowest" if at < EDGE else "highest" if at > 1 - EDGE else "" for at in best.tolist())
    a_hv = np.array([np.max(_curves(one, speed, search.hands), axis=0) for one in (tool, better)])
    return ToolDesign(
        tool,
        better,
        rows,
        tuple(_figures(search, better)),
        tuple(edges),
        searches,
        arrived,
        speed,
        a_hv,
    )


def _curves(tool: Tool, speed: Array, hands: Iterable[str]) -> list[Array]:
    """a_hv of each hand (S,), m/s2."""
    found = grips(respond_tool(tool, speed))
    return [found[name].a_hv for name in hands]


def _figures(search: Search, better: Tool) -> Iterable[Before]:
    """Figures of the tools themselves, not of the search, the measure first.

    Each tool at speeds of its own, that are dense about its resonances.
    """
    low, high = search.design.speeds
    means, tops = [], []
    for tool in (search.tool, better):
        speed = speeds_between(tool, low, high, len(search.band.speed))
        curves = dict(zip(search.hands, _curves(tool, speed, search.hands), strict=True))
        squares = {name: np.trapezoid(one**2, speed) / (high - low) for name, one in curves.items()}
        means.append({name: float(np.sqrt(one)) for name, one in squares.items()})
        tops.append({name: float(np.max(one)) for name, one in curves.items()})
    yield Before(f"a_hv of the worst hand, {WORDS['rms']}", ACCELERATION, *map(_worst, means))
    yield Before(f"a_hv of the worst hand, {WORDS['peak']}", ACCELERATION, *map(_worst, tops))
    for name in search.hands if len(search.hands) > 1 else ():
        yield Before(f"a_hv at {name}, {WORDS['rms']}", ACCELERATION, *(one[name] for one in means))
        yield Before(f"a_hv at {name}, {WORDS['peak']}", ACCELERATION, *(one[name] for one in tops))
    for name in filter(None, search.held):
        forces = [_largest_force(one, search.band.speed, name) for one in (search.tool, better)]
        yield Before(f"force at {name}, largest", "force", *forces)
    yield Before("mass", "mass", search.tool.mass, better.mass)


def _worst(values: dict[str, float]) -> float:
    return max(values.values())


def _largest_force(tool: Tool, speed: Array, station: str) -> float:
    """RMS over time of the force on all that holds a station, at the worst speed, N."""
    return float(np.max(rms_over_time(respond_tool(tool, speed).whole_force(station))))
