"""Where to put handle, harness, mass and absorber so that the hands feel least: a search."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.minimax import MinimaxProblem, SequentialPrograms, ValuesAndSlopes
from equipoise.design.solvers import DesignSolution, solve
from equipoise.design.variables import Range
from equipoise.errors import ModelError
from equipoise.exposure.daily import Exposure
from equipoise.handheld.chain import Dual
from equipoise.handheld.design_plan import DesignLimit, DesignPlan
from equipoise.handheld.hand_exposure import (
    BandFigures,
    SpeedBand,
    days_of,
    grips,
    mean_over_band,
    values_of,
)
from equipoise.handheld.model import Tool, changed
from equipoise.handheld.response import ToolNumber, respond_tool, rms_over_time
from equipoise.handheld.shaft import KEYS
from equipoise.handheld.sweep import speeds_between
from equipoise.i18n import Note, to_say
from equipoise.results.result import ProgressCallback, Result
from equipoise.signals import Array

LEAST = 1e-3
"""Share of the largest force below which an order does not count in the search."""


class Search(MinimaxProblem):
    """The measure of a design's numbers, each from 0 to 1 of its range, and the limits.

    The measure is a square, (m/s2)^2: mean or largest a_hv^2 over the band, of the worst hand.
    """

    def __init__(
        self,
        tool: Tool,
        design: DesignPlan,
        speed: Array,
        report: ProgressCallback = lambda done, total: None,
        starts: Array | None = None,
    ) -> None:
        self.solvers = (SequentialPrograms(report, starts),)
        self.tool, self.design, self.band = tool, design, SpeedBand(tool, speed, LEAST)
        self.variables = [entry.variable for entry in design.variables]
        self.numbers: list[ToolNumber] = [(entry.station, entry.key) for entry in design.variables]
        self.low = np.array([spread.low for spread in self.spreads])
        self.wide = np.array([spread.high for spread in self.spreads]) - self.low
        self.hands = design.hands or tuple(grip.name for grip in tool.grips)
        forces = (
            limit.station for limit in design.limits if limit.output == "force" and limit.station
        )
        self.force_stations = tuple(dict.fromkeys(forces))
        self.present = values_of(tool, self.numbers)
        self.start = (self.present - self.low) / self.wide
        self._last: tuple[bytes, Any] = (b"", None)

    def functions(
        self, place: Array, slopes: bool = True
    ) -> tuple[ValuesAndSlopes, ValuesAndSlopes]:
        """Squares over the band (P,), of which the largest counts, and limits (C,), at most 1."""
        key = np.ascontiguousarray(place).tobytes()
        if self._last[0] != key:
            pair = self._at(self.values_of(place[None])[0], slopes)
            if not slopes:
                return pair
            self._last = (key, pair)
        pair_at: tuple[ValuesAndSlopes, ValuesAndSlopes] = self._last[1]
        return pair_at

    def _at(self, values: Array, slopes: bool) -> tuple[ValuesAndSlopes, ValuesAndSlopes]:
        felt = self.band.felt(self.numbers, values, self.force_stations, slopes)
        squares = [felt.hands[name] for name in self.hands]
        if self.design.measure == "rms":
            squares = [mean_over_band(square) for square in squares]
        limits = [self._limit(limit, felt, values) for limit in self.design.limits]
        return self._joined(squares), self._joined(limits)

    def _limit(self, limit: DesignLimit, felt: BandFigures, values: Array) -> Dual:
        """What is limited, over its limit."""
        if limit.output == "added_mass":
            mine = np.array([key in ("mass", "absorber.mass") for _, key in self.numbers])
            added = float(np.sum((values - self.present)[mine]))
            slopes = mine.astype(float)[: len(felt.hands[self.hands[0]].slopes), None]
            return Dual(np.array([added]), slopes) / max(limit.most, 1e-12)
        source = felt.hands if limit.output == "acceleration" else felt.forces
        return source[str(limit.station)] / limit.most**2

    def _joined(self, parts: list[Dual]) -> ValuesAndSlopes:
        """All values in a row, with slopes by place."""
        if not parts:
            return ValuesAndSlopes(np.empty(0), np.empty((0, len(self.wide))))
        slopes = np.concatenate([part.slopes for part in parts], axis=1)
        wide = self.wide[: len(slopes), None]
        values = np.concatenate([part.value for part in parts])
        return ValuesAndSlopes(values, (slopes * wide).T)

    @property
    def spreads(self) -> list[Range]:
        spreads = (variable.spread for variable in self.variables)
        return [spread for spread in spreads if isinstance(spread, Range)]


SPEEDS = 81
"""Speeds in the band, at first."""
FINER, STILL = 4, 0.002
"""On so many times as many speeds the measure must be the same to this share; else they double."""
DOUBLINGS = 3
"""Of the speeds at most, which are 641 then."""
DIGITS = 6
"""Significant digits of the numbers of a better tool, for people to set."""
EDGE = 1e-6
"""Share of its range within which a variable is at an end of it."""
NO_DESIGN = Note(
    "missing; add the table [design] with the band of speeds, and [[design.variables]] with what "
    "may be changed"
)


@dataclass(frozen=True, eq=False)
class Before:
    """A figure before and after, in SI units.  said : what it is, where that is no free number."""

    name: str
    dimension: str
    before: float
    after: float
    label: Note | None = None


@dataclass(frozen=True, eq=False, repr=False)
class ToolDesign(Result):
    """The best design found.

    tool, better : before and after.
    variables : what was changed.
    figures : measure, worst accelerations and forces before and after.
    edges : ``lowest`` or ``highest`` where a variable ends at an end of its range, else empty.
    searches, arrived : followed downhill, and how many of them came to the best.
    speed : (S,), rad/s; a_hv : of the worst hand, before and after, (2, S), m/s2.
    solver : name of what looked for it.
    proved : whether no design can be better; however many searches arrive at a place prove nothing.
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
    solver: str = "sequential quadratic programs"
    proved: bool = False

    blocks_in = "handheld.blocks.design_blocks"
    pictures_in = "figures.tool_side.design_charts"

    @cached_property
    def days(self) -> tuple[Exposure, Exposure] | None:
        """The day of the hand that gets most, before and after; None where no work is given."""
        each = [days_of(item, self.tool.work) for item in (self.tool, self.better)]
        before, after = (
            max(day.values(), key=lambda day_values: day_values.a8, default=None) for day in each
        )
        return None if before is None or after is None else (before, after)

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        a8 = (None, None) if self.days is None else tuple(day.a8 for day in self.days)

        def as_dict(rows: Iterable[Before]) -> dict[str, Any]:
            return {row.name: {"before": row.before, "after": row.after} for row in rows}

        names = [row.name for row in self.variables]
        return {
            "variables": as_dict(self.variables),
            "figures": as_dict(self.figures),
            "edges": dict(zip(names, self.edges, strict=True)),
            "solver": self.solver,
            "proved": self.proved,
            "searches": self.searches,
            "arrived": self.arrived,
            "speed": self.speed,
            "a_hv_before": self.a_hv[0],
            "a_hv_after": self.a_hv[1],
            "a8_before": a8[0],
            "a8_after": a8[1],
        }


def design_tool(tool: Tool, progress: ProgressCallback | None = None) -> ToolDesign:
    """Change what the tool's [design] allows so that the hands feel least over its band.

    Designs spread over the whole room are tried, and the best of them followed downhill with exact
    derivatives; `arrived` of `searches` indicates how sure one may be that nothing better is there.

    progress : is called with how many searches are done, and how many there are.

    Raises
    ------
    ModelError : it has no design, or as `felt.Band`.
    ResponseError : nothing within the limits was found.
    """
    design = tool.design
    if design is None:
        raise ModelError("design", NO_DESIGN)
    count, starts = SPEEDS, None
    rounds = []
    report = progress or (lambda done, total: None)
    for _ in range(DOUBLINGS + 1):
        search = Search(tool, design, np.linspace(*design.speeds, count), report, starts)
        solution = solve(search)
        best = solution.places[0]
        rounds.append(solution)
        fine = Search(tool, design, np.linspace(*design.speeds, FINER * (count - 1) + 1))
        coarse, exact = search.cost(best), fine.cost(best)
        if abs(exact - coarse) <= STILL * exact:
            break
        count, starts = 2 * count - 1, best[None]
    return _tool_design(fine, best, rounds[0])


def _tool_design(search: Search, best: Array, solution: DesignSolution) -> ToolDesign:
    """The result, from the tool that the best numbers make, found first by a solution."""
    arrived, searches = solution.details or (1, 1)
    tool, design = search.tool, search.design
    values = search.values_of(best[None])[0]
    better = tool
    for entry, value in zip(design.variables, values, strict=True):
        handy = min(max(float(f"{value:.{DIGITS}g}"), entry.low), entry.high)
        better = changed(better, entry.station, entry.key, handy)
    after = values_of(better, search.numbers)
    rows = tuple(
        Before(entry.name, KEYS[entry.key], float(start), float(end))
        for entry, start, end in zip(design.variables, search.present, after, strict=True)
    )
    speed = search.band.speed
    edges = ("lowest" if at < EDGE else "highest" if at > 1 - EDGE else "" for at in best.tolist())
    a_hv = np.array([np.max(_curves(item, speed, search.hands), axis=0) for item in (tool, better)])
    figures = tuple(_figures(search, better))
    return ToolDesign(
        tool=tool,
        better=better,
        variables=rows,
        figures=figures,
        edges=tuple(edges),
        searches=searches,
        arrived=arrived,
        speed=speed,
        a_hv=a_hv,
        solver=solution.solver,
        proved=solution.proof is not None,
    )


def _curves(tool: Tool, speed: Array, hands: Iterable[str]) -> list[Array]:
    """a_hv of each hand (S,), m/s2."""
    result = grips(respond_tool(tool, speed))
    return [result[name].a_hv for name in hands]


def _figures(search: Search, better: Tool) -> Iterable[Before]:
    """Figures of the tools themselves, not of the search, the measure first.

    Each tool at speeds of its own, that are dense about its resonances.
    """
    low, high = search.design.speeds
    means, tops = [], []
    for tool in (search.tool, better):
        speed = speeds_between(tool, low, high, len(search.band.speed))
        curves = dict(zip(search.hands, _curves(tool, speed, search.hands), strict=True))
        squares = {
            name: np.trapezoid(curve**2, speed) / (high - low) for name, curve in curves.items()
        }
        means.append({name: float(np.sqrt(square)) for name, square in squares.items()})
        tops.append({name: float(np.max(curve)) for name, curve in curves.items()})
    rms, top, both = to_say("RMS over the band"), to_say("largest"), to_say("{what}, {measure}")
    for label, result in (
        (Note(to_say("total value a_hv of the worst hand, RMS over the band")), means),
        (Note(to_say("total value a_hv of the worst hand, largest")), tops),
    ):
        yield _before(label, "acceleration", *(max(item.values()) for item in result))
    for name in search.hands if len(search.hands) > 1 else ():
        what = Note(to_say("total value a_hv at {station}"), station=name)
        for measure, result in ((rms, means), (top, tops)):
            label = Note(both, what=what, measure=Note(measure))
            yield _before(label, "acceleration", *(item[name] for item in result))
    for name in search.force_stations:
        responses = (respond_tool(item, search.band.speed) for item in (search.tool, better))
        forces = (float(np.max(rms_over_time(item.whole_force(name)))) for item in responses)
        what = Note(to_say("force at {station}"), station=name)
        yield _before(Note(both, what=what, measure=Note(top)), "force", *forces)
    yield _before(Note(to_say("mass")), "mass", search.tool.mass, better.mass)


def _before(label: Note, dimension: str, before: float, after: float) -> Before:
    key = str(label).removeprefix("total value ")  # which JSON has without
    return Before(key, dimension, before, after, label)
