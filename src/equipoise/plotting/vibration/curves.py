"""Lines against crank speed: the axis, bands to keep away from, resonances, curves and names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from equipoise.figures.labels import spread
from equipoise.i18n import say
from equipoise.plotting.style import FAINT, INK, LINES, MAIN, NORMAL, SMALL, STRESS, fit, short
from equipoise.plotting.vibration.panels import LEFT, RIGHT, RPM, WIDTH, log_scale

if TYPE_CHECKING:
    from equipoise.vibration.free import Resonance
    from equipoise.vibration.sweep import Sweep

Array = np.ndarray[Any, Any]

KINDS = (
    (MAIN, "o"),
    (STRESS, "s"),
    (INK, "^"),
    ("#008a6a", "D"),
    ("#a3478f", "v"),
    ("#8a6d00", "P"),
)
"""Colour and marker of each curve; what is beyond is drawn thin and without a name."""
LOUD, LOUD_BAND, QUIET_BAND = 0.1, "#d3d3d3", "#ededed"
"""Share from which a resonance is loud, and fills of the bands to keep away from."""
UNBOUNDED = 5e3
"""Over the median, what only a resonance without damping can reach."""
DECADES = 6.0
"""Of a log axis at most."""
FINE = ((8.0, (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)), (150.0, (1.0, 2.0, 5.0)))
"""Ratio of the ends of a log axis, up to which more numbers are told than 1 and 10, and which."""
MARKERS = 7
ENTRY, PER_ROW, LINE = 2.02, 3, 0.19
"""Inches that a name in a legend takes; how many stand in a row; height of a row."""


class Range(Protocol):
    """Speeds (S,), rad/s, and whether what was found at each is stable."""

    @property
    def speed(self) -> Array: ...
    @property
    def stable(self) -> Array: ...


@dataclass(frozen=True, eq=False)
class Curve:
    """Values (S,) against speed."""

    name: str
    values: Array

    @property
    def largest(self) -> float:
        """Largest value that is no resonance without damping."""
        return float(np.max(bounded(self.values), initial=0.0))


def bounded(values: Array) -> Array:
    """Those of some values that are numbers, and no peak without bound."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return finite
    return np.asarray(finite[finite <= UNBOUNDED * np.median(finite)])


def ordered(curves: Mapping[str, Array], factor: float = 1.0) -> list[Curve]:
    """Curves that are named, in their order; behind them the quieter ones that are not."""
    found = [Curve(name, factor * values) for name, values in curves.items()]
    loudest = sorted(found, key=lambda curve: -curve.largest)[: len(KINDS)]
    return [c for c in found if c in loudest] + [c for c in found if c not in loudest]


def speed_axis(axes: Axes, sweep: Range) -> None:
    """The x axis: the crank's speed in rpm, whatever its sense."""
    ends = np.abs(sweep.speed[[0, -1]]) * RPM
    axes.set_xlim(float(ends[0]), float(ends[1]))


def speed_label(sweep: Sweep) -> str:
    """What that axis is."""
    clockwise = " " + say("(clockwise)") if sweep.speed[-1] < 0 else ""
    return say("crank speed, rpm") + clockwise


def bands(axes: Axes, sweep: Sweep) -> None:
    """Shade the speeds to keep away from, loud resonances darker."""
    for loud, color, order in ((False, QUIET_BAND, 0.1), (True, LOUD_BAND, 0.2)):
        spans = [
            (abs(r.avoid[0]) * RPM, abs(r.avoid[1]) * RPM)
            for r in sweep.resonances
            if r.avoid is not None and (r.share >= LOUD) == loud
        ]
        for low, high in merged(spans):
            axes.axvspan(low, high, color=color, linewidth=0, zorder=order)


def merged(spans: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Spans that do not overlap, and cover the same."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(high, found[-1][1]))
        else:
            found.append((low, high))
    return found


def resonance_lines(axes: Axes, sweep: Sweep) -> None:
    """Thin lines where an order meets a mode."""
    for resonance in sweep.resonances:
        loud = resonance.share >= LOUD
        axes.axvline(
            abs(resonance.speed) * RPM,
            color=LINES if loud else FAINT,
            linewidth=0.8 if loud else 0.5,
            linestyle=(0, (4, 2)) if loud else (0, (1.5, 2)),
            zorder=1.5,
        )


def resonance_names(axes: Axes, resonances: Sequence[Resonance]) -> None:
    """Order and mode of the loudest resonances, two rows of numbers above the axes."""
    figure: Any = axes.get_figure(root=True)
    width = axes.get_window_extent().width / figure.dpi
    height = axes.get_window_extent().height / figure.dpi
    low, high = axes.get_xlim()
    look: Any = {"fontsize": SMALL, "transform": axes.get_xaxis_transform()}
    feet = {"mode": 1 + 0.11 / height, "order": 1 + 0.245 / height}
    least = 0.17
    loudest = sorted(resonances, key=lambda r: -r.share)[: int(width / least) - 1]
    named = sorted(loudest, key=lambda r: abs(r.speed))
    if not named:
        return
    rows = [
        [
            axes.text(0, feet[key], text, ha="center", **look)
            for key, text in (("order", fraction(r.order)), ("mode", str(r.mode)))
        ]
        for r in named
    ]
    inch = (high - low) / width
    sizes = [max(t.get_window_extent().width for t in row) / figure.dpi + 0.06 for row in rows]
    while sum(sizes) > width:  # fractions are wide
        gone = int(np.argmin([r.share for r in named]))
        for text in rows.pop(gone):
            text.remove()
        del named[gone], sizes[gone]
    speeds = [abs(r.speed) * RPM for r in named]
    moved = spread(speeds, [size * inch for size in sizes], low, high)
    for row, speed, x in zip(rows, speeds, moved, strict=True):
        for text in row:
            text.set_x(x)
        ends = ([speed, x], [1, 1 + 0.09 / height])
        transform = axes.get_xaxis_transform()
        axes.plot(*ends, color=FAINT, linewidth=0.6, clip_on=False, transform=transform)
    words = {"order": say("order"), "mode": say("mode")}
    for key, foot in feet.items():
        axes.text(low - 0.1 * inch, foot, words[key], ha="right", color=LINES, **look)


def fraction(order: float) -> str:
    """An order as a whole number or a fraction of one."""
    return str(Fraction(order).limit_denominator(1000))


def draw_curves(axes: Axes, sweep: Range, curves: Sequence[Curve]) -> list[Line2D]:
    """Curves against speed, dashed where they are not stable; what stands in the legend."""
    speed = np.abs(sweep.speed) * RPM
    handles = []
    for number, curve in enumerate(curves):
        named = number < len(KINDS)
        color, marker = KINDS[number] if named else (FAINT, "")
        look: Any = {"color": color, "linewidth": 1.5 if named else 0.7}
        look["zorder"] = 3.9 - 0.1 * number if named else 2.5
        heard = np.where(curve.values > 0, curve.values, np.nan)
        _draw_parts(axes, speed, heard, sweep, look)
        if named:
            draw_markers(axes, speed, heard, marker, number, look)
            look |= {"marker": marker, "markersize": 4.5, "markerfacecolor": "white"}
            handles.append(Line2D([], [], label=short(curve.name, 40), **look))
    if len(curves) > len(KINDS):
        text = say("{count} quieter ones", count=len(curves) - len(KINDS))
        handles.append(Line2D([], [], color=FAINT, linewidth=0.7, label=text))
    return handles


def _draw_parts(axes: Axes, x: Array, y: Array, sweep: Range, look: dict[str, Any]) -> None:
    """A curve, its parts that are not stable dashed, and points that stand alone."""
    axes.plot(x, np.where(sweep.stable, y, np.nan), solid_capstyle="butt", **look)
    near = np.convolve(~sweep.stable, np.ones(3), "same") > 0
    loose = ~sweep.stable & np.isfinite(y)
    if np.any(loose):
        axes.plot(x, np.where(near, y, np.nan), linestyle=(0, (2.2, 1.3)), **look)
    there = np.concatenate([[False], np.isfinite(y), [False]])
    alone = there[1:-1] & ~there[:-2] & ~there[2:]
    if np.any(alone):
        axes.plot(x[alone], y[alone], ".", markersize=4, **look)


def draw_markers(
    axes: Axes, x: Array, y: Array, marker: str, number: int, look: dict[str, Any]
) -> None:
    """A few markers on a curve, beside those of the others, so that grey tells it apart."""
    wanted = x[0] + (x[-1] - x[0]) * (np.arange(MARKERS) + (number + 0.5) / len(KINDS)) / MARKERS
    nearest = np.unique(np.argmin(np.abs(x[:, None] - wanted), axis=0))
    at = [k for k in nearest.tolist() if np.isfinite(y[k])]
    own = {**look, "linewidth": 0, "markersize": 4.5, "markerfacecolor": "white"}
    axes.plot(x[at], y[at], marker, **own)


def log_axis(axes: Axes, curves: Sequence[Curve]) -> None:
    """The y axis: as many decades as there are values, but not too many."""
    every = np.concatenate([bounded(curve.values) for curve in curves])
    heard = every[every > 0]
    if not heard.size:
        axes.set_ylim(0, 1)
        axes.set_yticks([])
        axes.text(
            0.5, 0.5, say("nothing moves"), transform=axes.transAxes, ha="center", va="center"
        )
        return
    high = float(np.max(heard))
    low = max(float(np.min(heard)), high * 10**-DECADES)
    fine_log(axes, low / 1.6, high * 3)


def fine_log(axes: Axes, low: float, high: float) -> None:
    """A log y axis with as many plain numbers as are good to read."""
    log_scale(axes, low, high)
    subs = next((digits for ratio, digits in FINE if high < ratio * low), (1.0,))
    axes.yaxis.set_major_locator(LogLocator(subs=subs))


def rows_of(handles: Sequence[Any]) -> int:
    """Rows that a legend takes."""
    return -(-len(handles) // PER_ROW)


def legend_at(figure: Figure, handles: Sequence[Any], top: float) -> None:
    """What the curves are, some inches below the top of the picture."""
    height = figure.get_figheight()
    step = (WIDTH - LEFT - RIGHT) / PER_ROW
    for number, handle in enumerate(handles):
        down, across = divmod(number, PER_ROW)
        found = figure.legend(
            handles=[handle],
            loc="upper left",
            bbox_to_anchor=((LEFT + across * step) / WIDTH, 1 - (top + down * LINE) / height),
            borderaxespad=0,
            borderpad=0,
            fontsize=NORMAL,
        )
        fit(found.get_texts()[0], step - 0.42)
