"""What is marked on the paths: instants, senses, crank angles, the distance of hills."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from equipoise.i18n import say
from equipoise.plotting.crank import angle_step
from equipoise.plotting.labels import Labels
from equipoise.plotting.paths import CM, Mark, Paths
from equipoise.plotting.style import INK, MAIN, MARKS, NORMAL, SMALL, shown

ARROWS_IN = ((0.12, 0.45), (0.55, 0.88))
"""Between which parts of the way from exit to entry the heads of arrows are."""


def dots(axes: Axes, marks: Sequence[Mark], labels: Labels) -> None:
    """Instants, each with a marker of its own."""
    for mark in marks:
        axes.plot(
            CM * mark.place.real,
            CM * mark.place.imag,
            MARKS[mark.name],
            color=INK,
            markerfacecolor="white",
            markersize=5,
            markeredgewidth=1.1,
            zorder=4,
        )
        labels.reserve(CM * mark.place.real, CM * mark.place.imag)


def arrow(axes: Axes, tail: complex, head: complex, **look: Any) -> None:
    """An arrow in units of the axes."""
    coordinates = look.pop("coordinates", "data")
    order = look.pop("zorder", 4)
    axes.annotate(
        "",
        (head.real, head.imag),
        xytext=(tail.real, tail.imag),
        xycoords=coordinates,
        textcoords=coordinates,
        arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0, **look},
        zorder=order,
    )


def senses(axes: Axes, paths: Paths, over_ground: bool) -> None:
    """Heads of arrows that tell how the tip runs along its path, clear of the crank angles."""
    leave = paths.way_of("exit", paths.way_of("lowest", paths.start))
    above = paths.way_of("entry", leave) - leave
    step = np.radians(angle_step(paths.curve.turns))
    place = paths.over_ground if over_ground else paths.on_machine
    shunned = [*paths.crossings()] if over_ground else []
    for shares in ARROWS_IN:
        first, last = (round((leave + above * share) / step) for share in shares)
        ways = step * (np.arange(first, max(last, first + 1)) + 0.5)
        places = place(ways)
        apart = np.abs(places[:, None] - np.array(shunned, complex))
        best = int(np.argmax(np.min(apart, axis=1))) if shunned else len(ways) // 2
        shunned += [complex(places[best])] if over_ground else []
        tail, head = CM * place(ways[best] + np.array([-0.01, 0.01]))
        arrow(axes, tail, head, color=MAIN, mutation_scale=13, zorder=3.2)


def angle_ticks(axes: Axes, paths: Paths, inch: float) -> list[Mark]:
    """Short lines across the path at round crank angles; they come back with their numbers."""
    marks = []
    for angle in range(0, 360 * paths.curve.turns, angle_step(paths.curve.turns)):
        place, away = paths.place_and_away(paths.sense * np.radians(angle), over_ground=False)
        marks.append(Mark(str(angle), place, away))
        out = np.exp(1j * np.radians(away)) * 0.045 * inch
        ends = np.array([CM * place - out, CM * place + out])
        axes.plot(ends.real, ends.imag, color=MAIN, linewidth=0.8, zorder=3)
    return marks


def hill_spacing(axes: Axes, paths: Paths, labels: Labels, inch: float) -> None:
    """A dimension between the first hill and the next, below the path."""
    spacing = CM * paths.figures["hill_spacing"] * float(np.sign(paths.figures["forward_speed"]))
    left, right = axes.get_xlim()
    deep = CM * float(np.min(paths.over_ground(paths.ways).imag))
    y = deep - 0.24 * inch
    text = say("hill spacing {spacing} cm", spacing=shown(abs(spacing)))
    shown_whole = left < spacing < right and paths.curve.turns == 1
    if shown_whole:
        for x in (0.0, spacing):
            ends = [deep - 0.07 * inch, y - 0.05 * inch]
            axes.plot([x, x], ends, color=INK, linewidth=0.6, zorder=4)
            labels.avoid([x, x], ends)
        look = {"arrowstyle": "<|-|>", "lw": 0.7, "mutation_scale": 8}
        arrow(axes, complex(0, y), complex(spacing, y), **look)
    labels.occupy(
        axes.text(
            spacing / 2 if shown_whole else (left + right) / 2,
            y - 0.07 * inch,
            text,
            fontsize=SMALL,
            ha="center",
            va="top",
            zorder=5,
        )
    )


def travel(axes: Axes, paths: Paths, labels: Labels) -> None:
    """An arrow above the path in the direction in which the machine drives."""
    text = axes.annotate(
        say("machine drives"),
        (0.5, 1),
        xycoords="axes fraction",
        xytext=(0, -6),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=NORMAL,
    )
    labels.occupy(text)
    box = text.get_window_extent()
    ahead = paths.figures["forward_speed"] > 0
    gap, length = 6 * labels.dot, 32 * labels.dot
    tail, way = (box.x1 + gap, length) if ahead else (box.x0 - gap, -length)
    middle = (box.y0 + box.y1) / 2
    ends = axes.transAxes.inverted().transform([(tail, middle), (tail + way, middle)])
    arrow(
        axes,
        complex(*ends[0]),
        complex(*ends[1]),
        lw=1.6,
        mutation_scale=13,
        coordinates="axes fraction",
    )
