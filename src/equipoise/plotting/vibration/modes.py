"""Pictures of modes: their places on the paper, and what is said about each."""

from __future__ import annotations

from math import ceil, pi
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.i18n import say, to_say
from equipoise.mechanism.support import AXES
from equipoise.plotting.style import LEFT, NORMAL, RIGHT, WIDTH, blank, fit, heading, place, shown
from equipoise.plotting.vibration.body import Shape, View
from equipoise.plotting.vibration.view import draw_view, keys_of, settle, write_keys

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.mode_shapes import Mode

VIEWS: dict[View, str] = {
    "side": to_say("from the side"),
    "rear": to_say("from the rear"),
    "top": to_say("from above"),
}
HEAD, TOP, FOOT, KEYS = 0.78, 0.76, 0.48, 0.2
"""Inches: heading of one view, and of three; labels of the x axis; a row of words."""
KEYS_IN_ROW = 4
UNDAMPED = 1e-9
"""Damping ratio that is rounding."""
NOTHING = 1e-4
"""Part of a shape, over its largest, that counts as none."""
LEAST, MOST = 1.9, 4.6
"""Inches: height of a single view."""
NARROW, SHALLOW = 1.75, 1.5
"""Inches: least width and height of one of three views."""
ROOM = 0.45
"""Inches kept free around what is drawn, for signs and names."""
SPACE = (0.74, 0.84)
"""Inches between views, beside and below each other."""


def mode_figure(free: FreeVibration, number: int) -> Figure:
    """One mode, counted from 1."""
    mode = free.modes[number - 1]
    shape = Shape(free, mode)
    planar = free.linear.body.support.planar
    figure, views = _one_view(shape) if planar else _three_views(shape)
    what = say("Mode {number}: {told}", number=number, told=told(mode))
    heading(figure, free.machine.title, what, LEFT)
    for view, axes in views.items():
        draw_view(axes, shape, view, alone=planar)
    return figure


def told(mode: Mode) -> str:
    """Frequency and damping in words."""
    frequency, decay = mode.natural_frequency, -mode.eigenvalue.real
    if frequency == 0:
        return say("free, without a spring")
    if mode.swings:
        hertz = shown(frequency / (2 * pi))
        damping = mode.damping_ratio if abs(mode.damping_ratio) > UNDAMPED else 0.0
        return say(
            "{hertz} Hz, {frequency} rad/s, damping ratio {damping}",
            hertz=hertz,
            frequency=shown(frequency),
            damping=shown(damping),
        )
    time = shown(1 / abs(decay))
    if decay > 0:
        return say("does not swing: overdamped, dies out by a factor of e in {time} s", time=time)
    return say("does not swing: falls over, grows by a factor of e in {time} s", time=time)


def shape_told(free: FreeVibration, mode: Mode) -> list[str]:
    """Each part of the shape in words; its phase where it does not move in step."""
    words = []
    for name, part in zip(free.coordinates, mode.shape.tolist(), strict=True):
        unit = "rad" if name in AXES else "m"
        size = abs(part)
        phase = round(float(np.degrees(np.angle(part))))
        if size < NOTHING:
            words.append(f"{name} 0")
        elif phase % 180:
            words.append(f"{name} {size:.3g} {unit} at {phase}°")
        else:
            words.append(f"{name} {size if phase == 0 else -size:.3g} {unit}")
    return [text.replace("-", "\N{MINUS SIGN}") for text in words]


def _one_view(shape: Shape) -> tuple[Figure, dict[View, Axes]]:
    """Room for the side view alone, as high as it has to be."""
    low, high = shape.extent("side")
    wide = WIDTH - LEFT - RIGHT
    scale = (high - low).real / (wide - 2 * ROOM)
    tall = float(np.clip((high - low).imag / scale + 2 * ROOM, LEAST, MOST))
    scale = max(scale, (high - low).imag / (tall - 2 * ROOM))
    whole = HEAD + tall + FOOT + KEYS * ceil(len(keys_of(shape)) / KEYS_IN_ROW)
    figure = blank(WIDTH, whole)
    axes = place(figure, LEFT, whole - HEAD - tall, wide, tall)
    settle(axes, (low + high) / 2, scale, "side")
    told = ", ".join(shape_told(shape.free, shape.mode))
    words = say("Shape: {told}, or any multiple", told=told)
    fit(figure.text(LEFT / WIDTH, 1 - 0.475 / whole, words, va="top"), wide)
    write_keys(figure, shape, LEFT, 0.06, KEYS_IN_ROW)
    return figure, {"side": axes}


def _three_views(shape: Shape) -> tuple[Figure, dict[View, Axes]]:
    """To one scale, as on a drawing: the rear beside the side, the top below it."""
    low, high = (np.array(ends) for ends in zip(*map(shape.extent, VIEWS), strict=True))
    x = min(low[0].real, low[2].real), max(high[0].real, high[2].real)
    y = min(low[0].imag, low[1].imag), max(high[0].imag, high[1].imag)
    spans = np.array([x[1] - x[0], high[1].real - low[1].real])
    heights = np.array([y[1] - y[0], high[2].imag - low[2].imag])
    both = WIDTH - LEFT - RIGHT - SPACE[0]
    scale = max(np.sum(spans) / (both - 4 * ROOM), np.sum(heights) / (2 * MOST - 4 * ROOM))
    first = float(np.clip(spans[0] / scale + 2 * ROOM, NARROW, both - NARROW))
    scale = max(scale, *(spans / (np.array([first, both - first]) - 2 * ROOM)))
    tall = np.maximum(heights / scale + 2 * ROOM, SHALLOW)
    tall[1] = max(tall[1], _words_height(shape))
    whole = TOP + float(np.sum(tall)) + SPACE[1] + FOOT
    figure = blank(WIDTH, whole)
    upper = whole - TOP - float(tall[0])
    lower = upper - SPACE[1] - float(tall[1])
    middles = (complex(sum(x), sum(y)) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2)
    places = (
        (LEFT, upper, first, float(tall[0])),
        (LEFT + first + SPACE[0], upper, both - first, float(tall[0])),
        (LEFT, lower, first, float(tall[1])),
    )
    views = {}
    for view, box, middle in zip(VIEWS, places, middles, strict=True):
        axes = views[view] = place(figure, *box)
        centered = {
            "side": middle,
            "rear": complex(middle.real, sum(y) / 2),
            "top": complex(sum(x) / 2, middle.imag),
        }
        settle(axes, centered[view], scale, view)
        axes.set_title(say(VIEWS[view]), fontsize=NORMAL, loc="left", pad=4)
    _words(figure, shape, LEFT + first + 0.3, lower + float(tall[1]))
    return figure, views


def _words_height(shape: Shape) -> float:
    """Inches that words and signs beside the top view take."""
    return KEYS * (len(keys_of(shape)) + len(shape.mode.shape) + 2)


def _words(figure: Figure, shape: Shape, left: float, top: float) -> None:
    """The shape and what the signs are, where no view is."""
    height = figure.get_figheight()
    lines = [say("Shape, or any multiple of it:"), *shape_told(shape.free, shape.mode)]
    for number, line in enumerate(lines):
        at = (left / WIDTH, (top - KEYS * number) / height)
        fit(figure.text(*at, line, va="top"), WIDTH - left - 0.1)
    write_keys(figure, shape, left, top - KEYS * (len(lines) + 1), 1)
