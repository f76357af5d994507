"""Figures of an analysis that a loop can compute, what it gathers, and why a design has none."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.signals import ROUNDING, Array, Tops, place_of_peak

COMPUTED = 0
NO_ASSEMBLY = 1
NO_FULL_TURN = 2
CHANGE_POINT = 3
NO_MACHINE = 4
NOT_STILL = 5
NOT_COMPUTED = 6
NO_FIGURE = 7

REASONS: dict[int, str] = {
    COMPUTED: "computed",
    NO_ASSEMBLY: "does not assemble",
    NO_FULL_TURN: "does not turn fully",
    CHANGE_POINT: "change point",
    NO_MACHINE: "not a machine",
    NOT_STILL: "figures do not stand still",
    NOT_COMPUTED: "cannot be computed",
    NO_FIGURE: "no such figure",
}
"""Number -> words.

1: its links cannot be joined at any crank angle.  4: a number that no machine can have, such as a
mass below zero.  5: not even with `MOST_ANGLES` crank angles.  7: the design is computed, but lacks
a figure, such as that of a tip that never reaches the soil.
"""

MOST_ANGLES = 65_536
"""Crank angles in a turn beyond which figures are given up as not standing still."""


@dataclass(frozen=True)
class Reduction:
    """Something that a loop gathers of a signal over the crank angles.

    start : as source, before the first crank angle.
    add : line that takes in another value {x} of the signal; for places see `codegen.source`.
    of : the same of values (P, N) by NumPy, (P,).
    joined : of two sets of crank angles, from that of each.
    shared : line that takes in a value by its share in a mean, where crank angles have shares.
    """

    start: str
    add: str
    of: Callable[[Array], Array]
    joined: Callable[[Array, Array], Array]
    shared: str = ""

    def gathered(self, x: Array, shares: Array | None) -> Array:
        """What is gathered (P,) of values (P, N), by NumPy; shares : (N,) where there are any."""
        if shares is None or not self.shared:
            return self.of(x)
        return np.asarray((x if self.add == SUM else x * x) @ shares)


SUM = "{g} += {x}"
KINDS = {
    "sum": Reduction("0.0", SUM, lambda x: x.sum(axis=1), np.add, "{g} += share * {x}"),
    "squares": Reduction(
        "0.0",
        "{g} += {x} * {x}",
        lambda x: np.einsum("ij,ij->i", x, x),
        np.add,
        "{g} += share * {x} * {x}",
    ),
    "highest": Reduction("-1e300", "{g} = max({g}, {x})", lambda x: x.max(axis=1), np.maximum),
    "lowest": Reduction("1e300", "{g} = min({g}, {x})", lambda x: x.min(axis=1), np.minimum),
}
TOPS = {"top": 1.0, "top_at": 1.0, "dip": -1.0, "dip_at": -1.0}
"""What is taken from all values of a signal after the loop, as of an analysis: its extremes and
their crank angles, each with the sign by which it is highest."""
GATHERED = {
    "mean": ("sum",),
    "rms": (),
    "peak": ("top", "dip"),
    "max": ("top",),
    "min": ("dip",),
    "peak_to_peak": ("top", "dip"),
    "max_at": ("top", "top_at"),
    "min_at": ("dip", "dip_at"),
    "peak_at": ("top", "dip", "top_at", "dip_at"),
}
"""Figure -> what it is made of beside the sum of squares, which measures the size of a signal."""
PLACES = ("max_at", "min_at", "peak_at")


@dataclass(frozen=True)
class Figure:
    """A figure of a signal, such as the ``rms`` of ``shaking_force.y``."""

    signal: str
    name: str


def figure_of(value: str) -> Figure | None:
    """The figure by its path in the output of an analysis; None for what is no such figure."""
    unquoted = re.sub(r'"([^"]*)"', r"\1", value)  # as names stand in signals
    signal, dot, name = unquoted.removeprefix("summary.").rpartition(".")
    return Figure(signal, name) if dot and name in GATHERED else None


@dataclass(frozen=True)
class Gathered:
    """What a loop gathers: a kind of `KINDS` or `TOPS` of a signal, one column each."""

    columns: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, wanted: Sequence[Figure]) -> Gathered:
        needed = {(figure.signal, "squares") for figure in wanted}
        needed |= {(f.signal, kind) for f in wanted for kind in GATHERED[f.name]}
        sampled = {signal for signal, kind in needed if kind in TOPS}
        needed |= {(signal, kind) for signal in sampled for kind in ("highest", "lowest")}
        signals = list(dict.fromkeys(figure.signal for figure in wanted))
        order = [(signal, kind) for signal in signals for kind in (*KINDS, *TOPS)]
        return cls(tuple(column for column in order if column in needed))

    @property
    def signals(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(signal for signal, _ in self.columns))

    @property
    def sampled(self) -> tuple[str, ...]:
        """Signals of which every value is needed, since extremes lie between crank angles."""
        return tuple(dict.fromkeys(signal for signal, kind in self.columns if kind in TOPS))

    def fill_tops(
        self, out: Array, signal: str, values: Array, tops: Callable[[Array], Tops]
    ) -> None:
        """Fill the columns of `TOPS` in what is gathered (P, R), from values (P, N) of a signal."""
        kinds = [kind for name, kind in self.columns if name == signal and kind in TOPS]
        for sign in dict.fromkeys(TOPS[kind] for kind in kinds):
            top, at = tops(sign * values)
            for kind in kinds:
                if TOPS[kind] == sign:
                    place = self.columns.index((signal, kind))
                    out[:, place] = at if kind.endswith("_at") else sign * top

    def column(self, gathered: Array, signal: str, kind: str) -> Array:
        """One column (P,) of what was gathered (P, R)."""
        column: Array = gathered[:, self.columns.index((signal, kind))]
        return column

    def joined(self, first_part: Array, other: Array) -> Array:
        """What was gathered at two sets of crank angles, together."""
        result = np.empty_like(first_part)
        for k, (signal, kind) in enumerate(self.columns):
            if kind in KINDS:
                result[:, k] = KINDS[kind].joined(first_part[:, k], other[:, k])
                continue
            extreme = kind.removesuffix("_at")
            first, second = (
                TOPS[kind] * self.column(part, signal, extreme) for part in (first_part, other)
            )
            equal = np.abs(second - first) <= ROUNDING * np.abs(first)
            later = np.where(second > first, other[:, k], first_part[:, k])
            result[:, k] = np.where(equal, np.minimum(first_part[:, k], other[:, k]), later)
        return result

    def figure(self, gathered: Array, figure: Figure, count: int) -> Array:
        """A figure (P,) from what was gathered (P, R) at `count` crank angles; 1 where these have
        shares.
        """

        def column(kind: str) -> Array:
            return self.column(gathered, figure.signal, kind)

        if figure.name == "mean":
            return column("sum") / count
        if figure.name == "rms":
            return self.rms(gathered, figure.signal, count)
        if figure.name in ("max", "min", "max_at", "min_at"):
            return column(figure.name.replace("max", "top").replace("min", "dip"))
        high, low = column("top"), column("dip")
        if figure.name == "peak_to_peak":
            return high - low
        if figure.name == "peak":
            return np.maximum(high, -low)
        places = column("top_at"), column("dip_at")
        return place_of_peak(high, low, *places)

    def rms(self, gathered: Array, signal: str, count: int) -> Array:
        """Root of the mean square (P,) of a signal."""
        root: Array = np.sqrt(self.column(gathered, signal, "squares") / count)
        return root
