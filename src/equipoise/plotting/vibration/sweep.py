"""Pictures of a range of speeds: what gauges read and mounts hand on against crank speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.plotting.style import INK, LINES, blank, heading, shown
from equipoise.plotting.vibration.curves import (
    KINDS,
    LINE,
    LOUD_BAND,
    Curve,
    bands,
    bounded,
    draw_curves,
    legend_at,
    log_axis,
    ordered,
    resonance_lines,
    resonance_names,
    rows_of,
    speed_axis,
    speed_label,
)
from equipoise.plotting.vibration.panels import (
    FOOT,
    LEFT,
    RIGHT,
    RPM,
    WIDTH,
    Unit,
    name_x,
    name_y,
    place,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.vibration.sweep import Sweep

Array = np.ndarray[Any, Any]

TALL = {1: 2.9, 2: 2.2, 3: 1.8}
"""Inches: height of a panel, by how many there are."""
TOP, NUMBERS, GAP = 0.58, 0.38, 0.3
"""Inches: heading; order and mode of resonances; gap below a panel."""
QUANTITIES = {
    "displacement": (
        to_say("Peak-to-peak displacement at the gauges against crank speed"),
        "peak_to_peak",
    ),
    "velocity": (to_say("RMS of the velocity at the gauges against crank speed"), "velocity_rms"),
    "acceleration": (
        to_say("RMS of the acceleration at the gauges against crank speed"),
        "acceleration_rms",
    ),
}
PEAKS = 3
"""Curves whose highest peak is told."""
MOST_SPEEDS = 0.9
"""Share of the values that the unit suits."""
ALIKE = 0.02
"""Share by which two peaks differ that are told apart."""


@dataclass(frozen=True)
class Panel:
    """Curves over one axis.  told : whether the highest peaks are written beside them."""

    label: str
    curves: list[Curve]
    told: bool = True


def gauges_curves(sweep: Sweep, quantity: str) -> Figure:
    """What the gauges read of a quantity against speed."""
    what, key = QUANTITIES[quantity]
    panels = []
    for rotation in (False, True):
        read = {n: getattr(c, key) for n, c in sweep.gauges.items() if c.rotation == rotation}
        if read:
            unit = _unit(quantity, rotation, read)
            label = say("peak to peak") if quantity == "displacement" else say("RMS")
            named = f"{say('rotation')}, {label}" if rotation else label
            panels.append(Panel(f"{named}, {unit.name}", ordered(read, unit.factor)))
    return _figure(sweep, say(what), panels)


def _unit(quantity: str, rotation: bool, read: Mapping[str, Array]) -> Unit:
    """The unit that suits most speeds, whatever the highest peak."""
    found = np.concatenate([bounded(values) for values in read.values()])
    return Unit.of(quantity, rotation, np.quantile(found, MOST_SPEEDS) if found.size else 0.0)


def mounts_curves(sweep: Sweep) -> Figure:
    """Force that varies in the mounts, and share of the shaking force that they hand on."""
    assert sweep.machine.support is not None
    mounts = sweep.machine.support.mounts
    panels = []
    for rotation in (False, True):
        read = {
            name: curve.peak_to_peak
            for name, curve in sweep.mounts.items()
            if (mounts[name].axis is not None) == rotation
        }
        if read:
            unit = _unit("force", rotation, read)
            panels.append(Panel(f"{say('peak to peak')}, {unit.name}", ordered(read, unit.factor)))
    handed = {
        name: curve.transmissibility
        for name, curve in sweep.mounts.items()
        if np.any(np.isfinite(curve.transmissibility))
    }
    if handed:
        panels.append(Panel(say("transmissibility"), _in_order_of(panels[0], handed), told=False))
    what = say("Force in the mounts")
    if handed:
        what += "; " + say("transmissibility: its RMS over the shaking force's")
    return _figure(sweep, what, panels)


def _in_order_of(panel: Panel, curves: Mapping[str, Array]) -> list[Curve]:
    """Curves that look like those of the same names in another panel."""
    names = [curve.name for curve in panel.curves if curve.name in curves]
    if len(names) < len(curves):
        return ordered(curves)
    return [Curve(name, curves[name]) for name in names]


def _figure(sweep: Sweep, what: str, panels: list[Panel]) -> Figure:
    """Panels below each other, each under its legend, the first under names of resonances."""
    legends = [rows_of([*panel.curves[: len(KINDS) + 1]]) for panel in panels]
    tall = TALL[len(panels)]
    above = [LINE * count + 0.05 for count in legends]
    keys = _keys(sweep)
    head = TOP + (LINE if keys else 0.0)
    numbers = NUMBERS if sweep.resonances else 0.08
    whole = head + numbers + sum(above) + len(panels) * (tall + GAP) - GAP + FOOT
    figure = blank(WIDTH, whole)
    heading(figure, sweep.machine.title, f"{what}; {say('model {model}', model=sweep.model)}", LEFT)
    legend_at(figure, keys, TOP - 0.06)
    top = head
    for number, (panel, room) in enumerate(zip(panels, above, strict=True)):
        lower = room + (numbers if number == 0 else 0.0)
        box = (LEFT, whole - top - lower - tall, WIDTH - LEFT - RIGHT, tall)
        axes = place(figure, *box)
        speed_axis(axes, sweep)
        handles = _panel(axes, sweep, panel)
        legend_at(figure, handles, top)
        if number == 0:
            resonance_names(axes, sweep.resonances)
        if number < len(panels) - 1:
            axes.tick_params(labelbottom=False)
        top += lower + tall + GAP
    name_x(figure, speed_label(sweep))
    return figure


def _keys(sweep: Sweep) -> list[Any]:
    """What the lines and bands are that every panel has."""
    keys: list[Any] = []
    if sweep.resonances:
        dashes: Any = (0, (4, 2))
        text = say("order meets mode")
        keys.append(Line2D([], [], color=LINES, linewidth=0.8, linestyle=dashes, label=text))
    if any(resonance.avoid is not None for resonance in sweep.resonances):
        text = say("keep away (pale: quiet)")
        keys.append(Patch(facecolor=LOUD_BAND, linewidth=0, label=text))
    if np.any(~sweep.stable & np.isfinite(sweep.fluctuation)):
        keys.append(Line2D([], [], color=INK, linestyle=(0, (2.2, 1.3)), label=say("not stable")))
    return keys


def _panel(axes: Axes, sweep: Sweep, panel: Panel) -> list[Line2D]:
    name_y(axes, panel.label)
    log_axis(axes, panel.curves)
    bands(axes, sweep)
    resonance_lines(axes, sweep)
    handles = draw_curves(axes, sweep, panel.curves)
    if panel.told:
        _tell_peaks(axes, sweep, panel)
    return handles


def _tell_peaks(axes: Axes, sweep: Sweep, panel: Panel) -> None:
    """Value and speed at the highest place of the first curves."""
    speed = np.abs(sweep.speed) * RPM
    labels = Labels(axes)
    for curve in panel.curves[: len(KINDS)]:
        heard = np.isfinite(curve.values) & (curve.values > axes.get_ylim()[0])
        if np.any(heard):
            labels.avoid(speed[heard], curve.values[heard])
    told: list[tuple[int, float]] = []
    named = [*enumerate(panel.curves[: len(KINDS)])]
    for number, curve in sorted(named, key=lambda pair: -pair[1].largest)[:PEAKS]:
        if not curve.largest or np.nanmax(curve.values) > curve.largest:
            continue
        k = int(np.nanargmax(curve.values))
        size = curve.largest
        if any(k == peak and abs(size - same) < ALIKE * size for peak, same in told):
            continue
        told.append((k, size))
        if 0 < k < len(speed) - 1:
            text = say("{value} at {speed} rpm", value=shown(size), speed=shown(speed[k]))
            look: Any = {"wish": 20.0, "color": KINDS[number][0], "optional": len(told) > 1}
            labels.put(text, float(speed[k]), size, **look)
