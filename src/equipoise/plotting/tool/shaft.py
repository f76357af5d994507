"""The shaft as an axis, and what sits on it: lines, marks, and names above the picture's panels."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from equipoise.figures.labels import spread
from equipoise.i18n import say, to_say
from equipoise.plotting.style import FAINT, INK, LINES, SMALL, blank, inches, short
from equipoise.plotting.vibration.panels import WIDTH

if TYPE_CHECKING:
    from equipoise.handheld.model import Station, Tool

Array = np.ndarray[Any, Any]

MM = 1000.0
PLACE = to_say("place on the shaft from its left end, mm")
BESIDE = 0.02
"""Share of the shaft that the axis goes on beyond its ends."""
LEAD, ROOM, EDGE = 0.1, 0.1, 0.06
"""Inches: length of the line from a panel to a name; room beside a name; from the paper's edge."""
UPRIGHT, FARTHEST = 0.145, 0.5
"""Inches that an upright name takes along the shaft; how far others may be from their stations."""
LONGEST, MOST = 20, 24
"""Signs of a name; names at most."""
SIGNS = {"hand": "s", "harness or ground": "^", "station": "o"}
"""What holds a station -> its marker; the last holds nothing."""
NAMES = {
    "hand": to_say("hand"),
    "harness or ground": to_say("harness or ground"),
    "station": to_say("station"),
}


@dataclass(frozen=True)
class Names:
    """Names of stations above the panels: upright where side by side they would go too far.

    places, moved : inches from the left edge of the paper, of each station and of its name.
    height : inches.
    """

    stations: tuple[Station, ...]
    places: Array
    moved: Array
    upright: bool
    height: float


def names_of(tool: Tool, left: float, right: float) -> Names:
    """How the stations' names fit above axes between two margins, inches.

    Where there are too many stations, those are named that matter most.
    """
    chosen = sorted(tool.stations, key=lambda one: _weight(tool, one), reverse=True)[:MOST]
    stations = tuple(sorted(chosen, key=lambda one: one.position))
    along = np.array([one.position / tool.shaft.length for one in stations])
    places = left + (WIDTH - left - right) * (along + BESIDE) / (1 + 2 * BESIDE)
    if not stations:
        return Names((), places, places, False, 0.0)
    scratch = blank(WIDTH, 1.0)
    texts = [scratch.text(0, 0, short(one.name, LONGEST), fontsize=SMALL) for one in stations]
    wide, tall = np.array([inches(text) for text in texts]).T
    ends = EDGE, WIDTH - EDGE
    moved = spread(places, wide + ROOM, *ends)
    upright = bool(np.max(np.abs(moved - places)) > FARTHEST)
    if upright:
        moved = spread(places, np.full(len(stations), UPRIGHT), *ends)
    height = float(np.max(wide if upright else tall))
    return Names(stations, places, moved, upright, LEAD + height + 0.06)


def _weight(tool: Tool, station: Station) -> tuple[bool, bool, float]:
    """What matters most: where hands hold, where it is shaken, then what is heavy."""
    shaken = any(one.station == station.name for one in tool.excitations)
    held = kind_of(station) != "station"
    return held, shaken, station.mass


def kind_of(station: Station) -> str:
    """Key of `SIGNS`."""
    if station.hand is not None:
        return "hand"
    grounded = any(station.stiffness) or any(station.rotational_stiffness)
    return "harness or ground" if station.harness is not None or grounded else "station"


def plane_named(plane: int, alike: bool) -> str:
    """The vertical plane, the lateral one, or both where they are alike."""
    if alike:
        return say("both planes")
    return say("lateral plane") if plane else say("vertical plane")


def shaft_axis(axes: Axes, tool: Tool) -> None:
    """The x axis along the shaft, mm, with a thin line at every station."""
    length = MM * tool.shaft.length
    axes.set_xlim(-BESIDE * length, (1 + BESIDE) * length)
    axes.grid(False, axis="x")
    for station in tool.stations:
        axes.axvline(MM * station.position, color=FAINT, linewidth=0.6, zorder=1)


def write_names(axes: Axes, names: Names) -> None:
    """Names of the stations above the highest panel, each with a line to its place."""
    figure: Any = axes.get_figure(root=True)
    foot = axes.get_window_extent().y1 / figure.dpi
    look: Any = {"transform": figure.dpi_scale_trans}
    for station, x, moved in zip(names.stations, names.places, names.moved, strict=True):
        ends = ([x, moved], [foot, foot + LEAD])
        figure.add_artist(Line2D(*ends, color=FAINT, linewidth=0.6, **look))
        figure.text(
            moved,
            foot + LEAD + 0.02,
            short(station.name, LONGEST),
            fontsize=SMALL,
            ha="center",
            va="bottom",
            rotation=90 if names.upright else 0,
            **look,
        )


def mark_stations(axes: Axes, tool: Tool, places: Any, values: Any) -> None:
    """Markers on a curve, values at places (m), where the stations sit."""
    for station in tool.stations:
        value = float(np.interp(station.position, places, values))
        axes.plot(MM * station.position, value, clip_on=False, zorder=4, **_look(kind_of(station)))


def station_keys(stations: Iterable[Station]) -> list[Line2D]:
    """What the markers are, those that there are."""
    there = {kind_of(station) for station in stations}
    return [
        Line2D([], [], label=say(NAMES[name]), **_look(name)) for name in SIGNS if name in there
    ]


def _look(kind: str) -> dict[str, Any]:
    look: dict[str, Any] = {"color": LINES, "linestyle": "", "markeredgewidth": 1.0}
    look |= {"markerfacecolor": INK if kind == "hand" else "white"}
    return look | {"marker": SIGNS[kind], "markersize": 5.0 if kind == "harness or ground" else 4.5}
