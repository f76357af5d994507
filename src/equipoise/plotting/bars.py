"""Amplitudes of orders as bars, several beside each other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from equipoise.i18n import say
from equipoise.plotting.style import SMALL
from equipoise.plotting.vibration.panels import Unit, name_y

Array = np.ndarray[Any, Any]
Read = Mapping[str, tuple[Array, Array]]
"""Name -> orders, and the size of each in SI units."""
Look = tuple[str, str]
"""Colours of the bars and of their numbers."""

MATTERS = 0.01
"""Over the largest amplitude: above this an order is drawn."""
LEAST, MOST = 4, 12
"""Orders that are drawn at least, and at most."""
TOLD = 8
"""Places on the axis up to which every bar has its number."""
VISIBLE = 0.004
"""Over the largest amplitude: below this a bar cannot be seen, and gets no number."""
MOST_DECIMALS = 4
"""Of numbers at bars; longer ones are left out."""
CLEAR = 3
"""Pixels between numbers at least."""
FEWEST = 10
"""Steps of its last digit that the largest number keeps at least."""
WIDE = 0.72
"""Width of the bars of an order, over the distance of orders."""


def bars(
    axes: Axes,
    read: Read,
    looks: Mapping[str, Look],
    rotation: bool,
    last: int,
    most_told: int = TOLD,
) -> None:
    """Bars beside each other for each order up to the last.

    rotation : whether they are moments.  most_told : orders up to which bars are numbered.
    """
    unit = Unit.of("force", rotation, np.concatenate([sizes for _, sizes in read.values()]))
    largest = unit.factor * max(float(np.max(sizes)) for _, sizes in read.values())
    finest = _finest(read, VISIBLE * largest / unit.factor)
    wide = WIDE * finest / len(read)
    told: list[tuple[Array, Array, str]] = []
    for number, (name, (orders, sizes)) in enumerate(read.items()):
        fill, ink = looks[name]
        seen = (orders <= last) & np.isclose(np.mod(orders / finest + 0.5, 1), 0.5)
        at = orders[seen] + (number - (len(read) - 1) / 2) * wide
        heights = unit.factor * sizes[seen]
        axes.bar(at, heights, wide, color=fill, linewidth=0, zorder=3, label=name)
        if last / finest <= most_told:
            told.append((at, heights, ink))
    axes.set_xlim(-0.7 * finest, last + 0.7 * finest)
    axes.set_ylim(0, 1.18 * largest or 1.0)
    _numbers(axes, told, largest)
    if not largest:
        axes.set_yticks([])
        look: Any = {"transform": axes.transAxes, "ha": "center", "va": "center"}
        axes.text(0.5, 0.5, say("zero at every order"), **look)
    ticks = np.arange(last + 1)
    axes.set_xticks(ticks, [say("mean"), *(f"{order:g}" for order in ticks[1:])])
    axes.grid(visible=False, axis="x")
    name_y(axes, say("amplitude, {unit}", unit=unit.name))


def last_order(read: Read) -> int:
    """Up to where orders matter, a whole number."""
    largest = max(float(np.max(sizes)) for _, sizes in read.values())
    last = max(
        float(np.max(orders[sizes > MATTERS * largest], initial=0.0))
        for orders, sizes in read.values()
    )
    return int(min(max(np.ceil(last), LEAST), MOST))


def _finest(read: Read, least: float) -> float:
    """Distance of orders: less than 1 where a period of several turns leaves any between."""
    for orders, sizes in read.values():
        if np.any(sizes[np.mod(orders, 1) > 0] > least):
            return float(orders[1])
    return 1.0


def _numbers(axes: Axes, told: list[tuple[Array, Array, str]], largest: float) -> None:
    """Heights of bars that can be seen, above them, with as many digits as all have room for.

    told : places, heights and colour of the numbers of each kind of bar.  Where even the shortest
    numbers would lie on each other, the lower bars have none.
    """
    decimals = max(0, 2 - int(np.floor(np.log10(largest)))) if largest else 0
    if decimals > MOST_DECIMALS:
        return
    seen = [
        (float(x), float(height), ink)
        for at, heights, ink in told
        for x, height in zip(at, heights, strict=True)
        if height > VISIBLE * largest
    ]
    for fewer in range(decimals, -1, -1):
        texts = [_number(axes, one, fewer) for one in seen if round(one[1], fewer)]
        clear = _clear(texts)
        if len(clear) == len(texts) or not fewer or largest * 10 ** (fewer - 1) < FEWEST:
            break
        for text in texts:
            text.remove()
    for text in texts:
        if text not in clear:
            text.remove()


def _number(axes: Axes, bar: tuple[float, float, str], decimals: int) -> Annotation:
    x, height, color = bar
    text = f"{height:.{decimals}f}"
    look: Any = {"fontsize": SMALL, "color": color, "ha": "center"}
    return axes.annotate(text, (x, height), xytext=(0, 2), textcoords="offset points", **look)


def _clear(texts: list[Annotation]) -> list[Annotation]:
    """Those that lie on no number of a higher bar."""
    clear: list[Annotation] = []
    for text in sorted(texts, key=lambda one: -one.xy[1]):
        box = text.get_window_extent().padded(CLEAR)
        if not any(box.overlaps(other.get_window_extent()) for other in clear):
            clear.append(text)
    return clear
