"""Charts of a machine on its support: at one speed gauges, mounts, drive and orders; over a range
of speeds gauges, mounts and the resonance map.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.chart_parts import (
    ROOM,
    VARIES,
    SpeedCurve,
    bounded,
    by_name,
    crank_axis,
    curves_of,
    ends,
    extremes,
    groups,
    log_ends,
    ordered,
    read_axis,
    speed_text,
    varies,
)
from equipoise.figures.style import KINDS, free_name, short
from equipoise.i18n import say, to_say
from equipoise.quantities import Display
from equipoise.results.charts import (
    RPM,
    Aside,
    Axis,
    Band,
    Bars,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    four_digits,
)
from equipoise.signals import Array
from equipoise.vibration.simplified import linear_of

if TYPE_CHECKING:
    from equipoise.signals import Figures, Periodic
    from equipoise.vibration.forced import Sweep
    from equipoise.vibration.linear import Resonance
    from equipoise.vibration.response import GaugeSignals, MountForce, Response


QUANTITIES = {
    "displacement": to_say("displacement"),
    "velocity": to_say("velocity"),
    "acceleration": to_say("acceleration"),
}
SAMPLES, LEAST_ORDER, MOST_BARS = 720, 10, 60
"""In a turn; orders that are drawn at least, and bars at most."""
BELOW = 0.4
"""Of the least amplitude that matters: where its axis begins, so that its dot is whole."""
MATTERS, TOUCHES = 1e-4, 1e-3
"""Shares: of the largest amplitude at which the log axis ends, and above which orders are drawn; of
the largest force below which a one-sided mount counts as off its ground."""
SMALL = 78.0
"""Points: height of one of many panels."""


def response_charts(response: Response) -> dict[str, Chart]:
    """Every picture of the vibration at one speed by name, which also does for a file.

    ``gauge-NAME`` for each gauge and ``spectrum``; ``mounts`` where there are any; ``drive``.
    Many gauges or mounts go on in ``spectrum-2``, ``mounts-2`` and so on.
    """
    charts: dict[str, Chart] = {}
    for name in response.gauges:
        own = free_name(f"gauge-{name}", charts)
        charts[own] = gauge(response, name).named(own)
    charts |= {chart.name: chart for chart in (*spectra(response), *mounts(response))}
    return charts | {"drive": drive(response)}


# -- signals over a period -------------------------------------------------------------------------


def sampled(signal: Periodic) -> tuple[Array, Array]:
    """Crank angles (rad) and values of a whole period, with its first value again at its end."""
    count = SAMPLES * signal.turns
    values = signal.samples(count)
    return np.linspace(0.0, signal.period, count + 1), np.append(values, values[0])


def plotted(signal: Periodic) -> tuple[Array, Array, list[tuple[float, float]]]:
    """Angles, values (constant if they vary by no more than rounding) and extremes."""
    theta, values = sampled(signal)
    if float(np.ptp(values)) <= VARIES * float(np.max(np.abs(values))):
        return theta, np.full_like(values, float(signal.mean)), []
    both = (signal.extreme(sign) for sign in (1, -1))
    return theta, values, [(float(at), float(value)) for value, at in both]


def phase_axis(response: Response) -> Axis:
    """The x axis: the crank's angle, or time where a motor drives."""
    link, with_motor = response.machine.drive.crank, response.drive.speed is not None
    return crank_axis(link, response.speed, response.turns, with_motor)


def period_text(response: Response) -> str:
    """Length of a period in turns, crank speed and excitation model, as text."""
    values = {"speed": speed_text(response.speed), "model": response.model}
    if response.turns == 1:
        return say("over one turn at {speed}; {model} model", **values)
    return say("over {turns} turns at {speed}; {model} model", turns=response.turns, **values)


def gauge(response: Response, name: str) -> Chart:
    """Displacement, velocity and acceleration at a gauge."""
    read = response.gauges[name]
    panels = []
    for quantity, name_of in QUANTITIES.items():
        theta, values, places = plotted(getattr(read, quantity))
        label = say("rotation") if read.rotation and quantity == "displacement" else say(name_of)
        y = read_axis(label, quantity, read.rotation, values, room=ROOM)
        marks = extremes(y, values, places, "main")
        panels.append(Panel(phase_axis(response), y, (Curve(theta, values),), marks))
    what = say("Rotation at {gauge}") if read.rotation else say("Motion at {gauge}")
    what = f"{what.format(gauge=short(name))}, {period_text(response)}"
    caption = to_say("Vibration at a gauge of the support over a cycle.")
    return Chart(f"gauge-{name}", response.machine.title, what, tuple(panels), caption=caption)


def drive(response: Response) -> Chart:
    """Torque of the drive and, where it varies, speed of the crank."""
    result = response.drive
    y = read_axis(say("drive torque"), "force", True, sampled(result.torque)[1], room=ROOM)
    panels = [_with_mean(response, result.torque, result.torque_figures, y)]
    if result.speed is not None:
        title = say("varies by {share} % of its mean", share=four_digits(100 * result.fluctuation))
        y = Axis.of(say("crank speed"), "angular speed", (), "rpm", room=ROOM)
        panels.append(_with_mean(response, result.speed, result.speed.figures, y, title=title))
    what = say("Drive of {link}", link=short(response.machine.drive.link))
    rows = len(response.machine.rows)
    what += ", " + say("{rows} rows together", rows=rows) if rows > 1 else ""
    what += f", {period_text(response)}"
    caption = to_say("Torque and speed of the drive on the moving support.")
    return Chart("drive", response.machine.title, what, tuple(panels), caption=caption)


def _with_mean(
    response: Response, signal: Periodic, figures: Figures, y: Axis, **rest: Any
) -> Panel:
    """A signal over a period, marked at its extremes, with a dashed line at its mean."""
    theta, values, places = plotted(signal)
    lines: tuple[Line, ...] = ()
    if varies(values):
        mean = 0.0 if abs(figures.mean) <= VARIES * float(np.ptp(values)) else figures.mean
        places = [(figures.max_at, figures.max), (figures.min_at, figures.min)]
        lines = (Line(mean, "mean", axis="y"),)
        rest["remark"] = say("dashed: mean {value}", value=y.quantity(mean))
    marks = extremes(y, values, places, "main")
    return Panel(phase_axis(response), y, (Curve(theta, values),), marks, lines=lines, **rest)


# -- orders at the gauges --------------------------------------------------------------------------


def spectra(response: Response) -> Iterator[Chart]:
    """Amplitude of each order at the gauges."""
    every = list(response.gauges)
    for suffix, names, which in groups(every):
        what = say("Amplitude at the gauges by order") + which
        values = {"speed": speed_text(response.speed), "model": response.model}
        what += ", " + say("at {speed}; {model} model", **values)
        last = max(_last_order(response.gauges[name]) for name in names)
        panels = tuple(_bars(response.gauges[name], name, last) for name in names)
        own, columns = f"spectrum{suffix}", min(2, len(panels))
        caption = to_say("Vibration at the gauges by orders of the crank angle.")
        yield Chart(own, response.machine.title, what, panels, columns, caption=caption)


def _last_order(signals: GaugeSignals) -> float:
    """Up to where orders matter."""
    signal = signals.displacement
    sizes = signal.sizes[1:]
    above = np.flatnonzero(sizes > MATTERS * np.max(sizes, initial=0.0))
    count = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDER * signal.turns)
    return min(count, max(MOST_BARS, LEAST_ORDER * signal.turns)) / signal.turns


def _bars(signals: GaugeSignals, name: str, last: float) -> Panel:
    signal = signals.displacement
    orders, sizes = signal.orders[1:], signal.sizes[1:]
    orders, sizes = orders[orders <= last], sizes[orders <= last]
    largest = float(np.max(sizes, initial=0.0))
    ends: dict[str, Any] = {}
    if largest:
        ends = {"low": largest * MATTERS * BELOW, "high": largest * 6, "scale": "log"}
    x = Axis(say("order: events in one turn of the crank"), low=0.0, high=last + 1)
    y = read_axis(say("amplitude"), "displacement", signals.rotation, sizes, **ends)
    title = short(name, 44)
    if not largest:
        return Panel(x, y, title=title, message=say("does not move"), height=SMALL)
    significant, loudest = sizes > largest * MATTERS, int(np.argmax(sizes))
    mark = Mark(float(orders[loudest]), largest, y.format_value(largest), sign=False, distance=5.0)
    bars = Bars(orders[significant], sizes[significant], 0.62 / signal.turns)
    return Panel(x, y, marks=(mark,), bars=(bars,), title=title, height=SMALL)


# -- forces in the mounts --------------------------------------------------------------------------


def mounts(response: Response) -> Iterator[Chart]:
    """Force in each mount over a period, beside what it carries at rest."""
    every = list(response.mounts)
    at_rest = _at_rest(response) if every else {}
    largest = _largest(response, at_rest)
    for suffix, names, which in groups(every):
        what = say("Force in the mounts on the support") + which
        what = f"{what}, {period_text(response)}"
        panels = tuple(_mount(response, name, at_rest[name], largest) for name in names)
        keys, columns = (("main", say("force")), ("mean", say("at rest"))), min(2, len(panels))
        own, caption = f"mounts{suffix}", to_say("Forces in the mounts over a cycle.")
        yield Chart(own, response.machine.title, what, panels, columns, keys=keys, caption=caption)


def _at_rest(response: Response) -> dict[str, float]:
    """What each mount carries at rest, N or N m; 0 where it does not touch."""
    machine = response.machine
    rest = linear_of(machine, response.model).rest
    assert machine.support is not None
    return {
        name: rest.preload[name] if rest.carries(name, mount) else 0.0
        for name, mount in machine.support.mounts.items()
    }


def _largest(response: Response, at_rest: Mapping[str, float]) -> dict[bool, float]:
    """Of all torques (True), and of all forces, so that each of these has one unit; SI units."""
    values: dict[bool, float] = {}
    for name, mount in response.mounts.items():
        sizes = np.abs([*sampled(mount.force)[1], at_rest[name]])
        values[mount.torsional] = max(values.get(mount.torsional, 0.0), float(np.max(sizes)))
    return values


def _mount(response: Response, name: str, rest: float, largest: Mapping[bool, float]) -> Panel:
    """One mount; rest : what it carries there.  largest : by which the unit is chosen."""
    assert response.machine.support is not None
    mount, model = response.mounts[name], response.machine.support.mounts[name]
    rotation = model.axis is not None
    theta, values, places = plotted(mount.force)
    lifted = off_ground(mount) if model.one_sided else []
    if lifted and response.model == "exact":  # the sum of its orders swings about 0
        values, places = np.maximum(values, 0.0), places[:1]
    label = say("torque") if rotation else say("force")
    y = read_axis(label, "force", rotation, largest[rotation], room=ROOM)
    lift_off = f"{short(name, 20)}: {_lift_off_text(response, mount, lifted)}" if lifted else ""
    return Panel(
        phase_axis(response),
        y,
        (Curve(theta, values), Curve(theta[[0, -1]], np.full(2, rest), "", "mean")),
        extremes(y, values, places, "main"),
        tuple(Band(low, high, "off", say("off its ground")) for low, high in lifted),
        title=lift_off or short(name, 44),
        height=SMALL,
    )


def off_ground(mount: MountForce) -> list[tuple[float, float]]:
    """Crank angles (rad) between which a one-sided mount does not push."""
    theta, values = sampled(mount.force)
    off = values <= TOUCHES * max(float(np.max(values)), 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
    return [
        (float(theta[start]), float(theta[min(stop, len(theta)) - 1]))
        for start, stop in edges.reshape(-1, 2)
    ]


def _lift_off_text(response: Response, mount: MountForce, off: list[tuple[float, float]]) -> str:
    """Share of the period for which a one-sided mount is off its ground, as text."""
    share = sum(high - low for low, high in off) / mount.force.period
    if not np.any(mount.force.sizes):
        return say("does not touch")
    if response.model == "exact":
        return say("off its ground for {share} %", share=f"{100 * mount.lifts_off:.0f}")
    return say("would have to pull for {share} %", share=f"{100 * share:.0f}")


# -- over a range of speeds ------------------------------------------------------------------------

OVER_SPEED = {
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
    response, *others = (gauges_over_speed(sweep, quantity) for quantity in OVER_SPEED)
    of_mounts = [mounts_over_speed(sweep)] if sweep.mounts else []
    return by_name([response.named("response"), resonance_map(sweep), *of_mounts, *others])


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


def gauges_over_speed(sweep: Sweep, quantity: str) -> Chart:
    """What the gauges read of a quantity against speed."""
    what, key = OVER_SPEED[quantity]
    panels = []
    for rotation in (False, True):
        read = {n: getattr(c, key) for n, c in sweep.gauges.items() if c.rotation == rotation}
        if read:
            label = say("peak to peak") if quantity == "displacement" else say("RMS")
            named = f"{say('rotation')}, {label}" if rotation else label
            panels.append(_panel(sweep, named, quantity, rotation, ordered(read)))
    caption = to_say("Vibration at the gauges against speed.")
    return _chart(sweep, quantity, say(what), panels, caption)


def mounts_over_speed(sweep: Sweep) -> Chart:
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
