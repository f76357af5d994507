"""Charts of vibration over a range of speeds: at gauges, in mounts, and the resonance map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.chart_parts import (
    SpeedCurve,
    bounded,
    by_name,
    curves_of,
    ends,
    log_ends,
    ordered,
    read_axis,
)
from equipoise.figures.style import KINDS
from equipoise.i18n import say, to_say
from equipoise.quantities import Display
from equipoise.results.charts import (
    RPM,
    Array,
    Aside,
    Axis,
    Band,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    four_digits,
)

if TYPE_CHECKING:
    from equipoise.vibration.linear import Resonance
    from equipoise.vibration.sweep import Sweep

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
PEAKS, ALIKE, MOST_SPEEDS = 3, 0.02, 0.9
"""Curves at most whose highest peak is labelled; relative difference above which two peaks count as
two; share of the values that the unit suits."""
MOST_ORDERS, USUAL_ORDERS = 20, (1.0, 2.0, 3.0)
"""Orders that are drawn in the map at most, and where none meets a mode."""
MOST_IN_HALF = 3
"""Curves in a panel that are told apart, with their numbers, in half the width of a page."""
HERTZ = Display("Hz", 1 / (2 * pi))


def sweep_charts(sweep: Sweep) -> dict[str, Chart]:
    """Every picture of the vibration over a range of speeds by name.

    ``response``, ``velocity`` and ``acceleration`` of the gauges; ``resonance-map``; ``mounts``
    where there are any.
    """
    response, *others = (gauges(sweep, quantity) for quantity in QUANTITIES)
    of_mounts = [mounts(sweep)] if sweep.mounts else []
    return by_name([response.named("response"), resonance_map(sweep), *of_mounts, *others])


# -- curves ----------------------------------------------------------------------------------------


def speed_axis(sweep: Sweep) -> Axis:
    """The x axis: the crank's speed, whatever its sense."""
    clockwise = " " + say("(clockwise)") if sweep.speed[-1] < 0 else ""
    low, high = (float(end) for end in np.abs(sweep.speed[[0, -1]]))
    return Axis(say("crank speed"), replace(RPM, unit=f"rpm{clockwise}"), low=low, high=high)


def bands(sweep: Sweep) -> tuple[Band, ...]:
    """The speeds to keep away from, loud resonances darker."""
    result = []
    for loud, role in ((False, "quiet band"), (True, "loud band")):
        spans = [
            (abs(r.avoid[0]), abs(r.avoid[1]))
            for r in sweep.resonances
            if r.avoid is not None and r.is_loud == loud
        ]
        result += [Band(low, high, role) for low, high in merged(spans)]
    return tuple(result)


def merged(spans: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Spans that do not overlap, and cover the same."""
    pairs: list[tuple[float, float]] = []
    for low, high in sorted((min(span), max(span)) for span in spans):
        if pairs and low <= pairs[-1][1]:
            pairs[-1] = (pairs[-1][0], max(high, pairs[-1][1]))
        else:
            pairs.append((low, high))
    return pairs


def fraction(order: float) -> str:
    """An order as a whole number or a fraction of one."""
    return str(Fraction(order).limit_denominator(1000))


def peaks(axis: Axis, speed: Array, curves: Sequence[SpeedCurve]) -> tuple[Mark, ...]:
    """Value and speed at the highest places of the loudest of the named curves."""
    marks: list[Mark] = []
    named = [*enumerate(curves[: len(KINDS)])]
    for number, item in sorted(named, key=lambda pair: -pair[1].largest)[:PEAKS]:
        if not item.largest or np.nanmax(item.values) > item.largest:
            continue
        k, size = int(np.nanargmax(item.values)), item.largest
        at, role, text = float(speed[k]), f"kind {number}", ""
        if any(mark.x == at and abs(size - mark.y) < ALIKE * size for mark in marks):
            continue
        if 0 < k < len(speed) - 1:
            statement = {"value": axis.format_value(size), "speed": four_digits(at * RPM.factor)}
            text = say("{value} at {speed} rpm", **statement)
        marks.append(Mark(at, size, text, role, 20.0, sign=False, optional=bool(marks)))
    return tuple(mark for mark in marks if mark.text)


def own_speed(sweep: Sweep) -> tuple[Line, ...]:
    """A line at the speed of the machine, where that is in the range."""
    at, (low, high) = abs(sweep.machine.drive.speed), sorted(np.abs(sweep.speed[[0, -1]]))
    text = say("work, {speed} rpm", speed=four_digits(at * RPM.factor))
    return (Line(at, "work", text),) if low <= at <= high else ()


def at_work(axis: Axis, sweep: Sweep, curves: Sequence[SpeedCurve]) -> Iterator[Mark]:
    """Value of the named curves at the speed of the machine, where it is in sight."""
    least, most = ends(axis)
    for line in own_speed(sweep):
        k = int(np.argmin(np.abs(np.abs(sweep.speed) - line.at)))
        for number, item in enumerate(curves[: len(KINDS)]):
            value = float(item.values[k])
            if least <= value <= most:
                text, role = axis.format_value(value), f"kind {number}"
                yield Mark(line.at, value, text, role, 30.0, optional=True)


# -- a range of speeds -----------------------------------------------------------------------------


def gauges(sweep: Sweep, quantity: str) -> Chart:
    """What the gauges read of a quantity against speed."""
    what, key = QUANTITIES[quantity]
    panels = []
    for rotation in (False, True):
        read = {n: getattr(c, key) for n, c in sweep.gauges.items() if c.rotation == rotation}
        if read:
            label = say("peak to peak") if quantity == "displacement" else say("RMS")
            named = f"{say('rotation')}, {label}" if rotation else label
            panels.append(_panel(sweep, named, quantity, rotation, ordered(read)))
    caption = to_say("Vibration at the gauges against speed.")
    return _chart(sweep, quantity, say(what), panels, caption)


def mounts(sweep: Sweep) -> Chart:
    """Force that varies in the mounts, and share of the shaking force that they hand on."""
    assert sweep.machine.support is not None
    own = sweep.machine.support.mounts
    panels = []
    for rotation in (False, True):
        read = {
            name: curve.peak_to_peak
            for name, curve in sweep.mounts.items()
            if (own[name].axis is not None) == rotation
        }
        if read:
            panels.append(_panel(sweep, say("peak to peak"), "force", rotation, ordered(read)))
    shares = {name: curve.transmissibility for name, curve in sweep.mounts.items()}
    handed = {name: share for name, share in shares.items() if np.any(np.isfinite(share))}
    what = say("Force in the mounts")
    if handed:
        names = [curve.label for curve in panels[0].curves if curve.label in handed]
        speed_curves = ordered(handed)  # as the first panel has them, if it has all
        if len(names) == len(handed):
            speed_curves = [SpeedCurve(name, handed[name]) for name in names]
        panels.append(_panel(sweep, say("transmissibility"), "", False, speed_curves))
        what += "; " + say("transmissibility: its RMS over the shaking force's")
    crowded = any(len({c.label for c in panel.curves}) > MOST_IN_HALF for panel in panels)
    caption = to_say("Forces in the mounts against speed.")
    return replace(_chart(sweep, "mounts", what, panels, caption), across=crowded)


def _panel(
    sweep: Sweep, label: str, quantity: str, rotation: bool, curves: Sequence[SpeedCurve]
) -> Panel:
    """Curves over one axis; where it is a quantity, with their highest peaks."""
    bounded_values = np.concatenate([bounded(item.values) for item in curves])
    speed = np.abs(sweep.speed)
    y = Axis(label)
    if quantity:
        usual = np.quantile(bounded_values, MOST_SPEEDS) if bounded_values.size else 0.0
        y = read_axis(label, quantity, rotation, usual)
    lines = [Line(abs(r.speed), "loud" if r.is_loud else "quiet") for r in sweep.resonances]
    parts: dict[str, Any] = {"bands": bands(sweep), "keyed": True}
    parts["lines"] = (*lines, *own_speed(sweep))
    if not np.any(bounded_values > 0):
        y = replace(y, low=0.0, high=1.0 / y.unit.factor, ticks=())
        return Panel(speed_axis(sweep), y, message=say("nothing moves"), **parts)
    low, high = log_ends(curves, 1.6, 3.0)
    y = replace(y, low=low, high=high, scale="log")
    marks = (*(peaks(y, speed, curves) if quantity else ()), *at_work(y, sweep, curves))
    return Panel(speed_axis(sweep), y, curves_of(speed, curves, sweep.stable), marks, **parts)


def flags(resonances: Sequence[Resonance]) -> tuple[PlaceLabel, ...]:
    """Order and mode of resonances, the quietest left out first."""
    return tuple(
        PlaceLabel(abs(r.speed), (fraction(r.order), str(r.mode)), r.share)
        for r in sorted(resonances, key=lambda r: abs(r.speed))
    )


def _chart(sweep: Sweep, name: str, what: str, panels: list[Panel], caption: str) -> Chart:
    """Panels below each other, the first under names of resonances."""
    words = (say("order"), say("mode")) if sweep.resonances else ()
    first = replace(panels[0], flags=flags(sweep.resonances), flag_words=words)
    keys = _keys(sweep, "loud")
    if np.any(~sweep.stable & np.isfinite(sweep.fluctuation)):
        keys.append(("not stable", say("not stable")))
    what = f"{what}; {say('{model} model', model=sweep.model)}"
    whole = (first, *panels[1:])
    return Chart(name, sweep.machine.title, what, whole, keys=tuple(keys), caption=caption)


def _keys(sweep: Sweep, meeting: str) -> list[tuple[str, str]]:
    """Entries of the legend on resonances; meeting : role of an order that meets a mode."""
    keys = [(meeting, say("order meets mode"))] if sweep.resonances else []
    if any(resonance.avoid is not None for resonance in sweep.resonances):
        keys.append(("loud band", say("speeds to avoid (pale: weak resonance)")))
    return keys


# -- the resonance map -----------------------------------------------------------------------------


def resonance_map(sweep: Sweep) -> Chart:
    """Natural frequencies, orders, and their meetings, each as large as it is loud (Campbell)."""
    axis, top = speed_axis(sweep), highest(sweep)
    first, last = ends(axis)
    low, high = min(first, last), max(first, last)
    marks = tuple(Mark(abs(r.speed), r.frequency, "", meeting(r.share)) for r in sweep.resonances)
    asides: list[Aside] = []
    lines, curves, above = [], [], []
    for number, mode in enumerate(sweep.modes, 1):
        if mode.swings:
            at = 2 * pi * mode.cycles_per_second
            statement = {"number": number, "frequency": four_digits(mode.cycles_per_second)}
            lines.append(Line(at, "mode", axis="y"))
            asides.append(Aside(at, say("mode {number}: {frequency} Hz", **statement), "mode"))
    for order in _orders(sweep):
        curves.append(Curve(np.array([low, high]), order * np.array([low, high]), "", "order"))
        if order * high <= top:
            text = say("order {order}", order=fraction(order))
            asides.append(Aside(order * high, text))
        elif order * low < top:
            above.append(PlaceLabel(top / order, (fraction(order),), order))
    if first > last:  # the names stand where the lines leave at the right
        asides = [a for a in asides if a.role == "mode"]
    panel = Panel(
        axis,
        Axis(say("frequency"), HERTZ, low=0.0, high=top),
        tuple(curves),
        marks,
        bands(sweep),
        (*lines, *own_speed(sweep)),
        flags=tuple(above),
        flag_words=(say("order"),),
        asides=tuple(asides),
        height=240.0,
    )
    keys = _keys(sweep, "meeting")
    what = say(
        "Orders of the crank speed and natural frequencies; larger circle: stronger resonance"
    )
    caption = to_say("Where orders of the crank meet natural frequencies.")
    keyed = tuple(keys)
    return Chart("resonance-map", sweep.machine.title, what, (panel,), keys=keyed, caption=caption)


def meeting(share: float) -> str:
    """The role of a meeting: its area grows with the share, from what can just be seen."""
    size = round(3 + 11 * float(np.sqrt(share)), 1)
    return f"meeting {min(size, 14.0):g}"


def highest(sweep: Sweep) -> float:
    """Upper end of the y axis, rad/s."""
    swinging = [2 * pi * mode.cycles_per_second for mode in sweep.modes if mode.swings]
    fastest = float(np.max(np.abs(sweep.speed)))
    if not swinging:
        return USUAL_ORDERS[-1] * fastest
    top = 1.2 * max(swinging)
    return top if sweep.resonances else max(top, fastest)


def _orders(sweep: Sweep) -> list[float]:
    """Orders that meet a mode, the loudest if they are many; or else the usual ones."""
    usual = USUAL_ORDERS[:1] if sweep.resonances else USUAL_ORDERS
    loudness: dict[float, float] = dict.fromkeys(usual, 0.0)
    for resonance in sweep.resonances:
        loudness[resonance.order] = max(resonance.share, loudness.get(resonance.order, 0.0))
    return sorted(sorted(loudness, key=lambda order: (-loudness[order], order))[:MOST_ORDERS])
