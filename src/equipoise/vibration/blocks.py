"""What vibration on the support shows at one speed, in time, over a range, and of free modes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import Note, coordinates, say, to_say
from equipoise.quantities import PER_RPM, Dimension, display, format_quantity, number
from equipoise.results.analysis_blocks import loud
from equipoise.results.blocks import (
    FAINT_IN_ROW,
    Block,
    Cell,
    Column,
    Facts,
    Many,
    Notes,
    Span,
    Table,
    Text,
    Value,
)
from equipoise.results.declaring import cells_of, headings, table_of
from equipoise.results.machine_blocks import driven
from equipoise.signals import Array
from equipoise.vibration.hand_held import HandVibration
from equipoise.vibration.headline import speeds_text
from equipoise.vibration.response import MODELS, GaugeSignals, Joint, Model, MountForce, members_of

if TYPE_CHECKING:
    from equipoise.signals import Figures
    from equipoise.vibration.free import FreeVibration, Transient
    from equipoise.vibration.response import Mode, Response
    from equipoise.vibration.support_motion import SupportMotion
    from equipoise.vibration.sweep import Sweep

Kind = tuple[Dimension, str | None]
"""A dimension, and the unit in which it is usual here."""

NOTHING = 1e-2
"""m, rad and their rates: scale beside which what is smaller than atoms is rounding."""
MOST_COMPLETE: tuple[Model, ...] = ("exact", "moment")
"""Models with which others are compared, the one that leaves out least first."""
AGREEING, ROUNDING = 0.05, 1e-9
"""Share by which readings of models may differ without a note; and what of them is rounding."""
PARTS = 5
"""Equal stretches of a time, of which the first and the last show whether it has settled."""
MOVED: tuple[Kind, ...] = (("length", "mm"), ("speed", "mm/s"), ("acceleration", "m/s^2"))
TURNED: tuple[Kind, ...] = (
    ("angle", "mrad"),
    ("angular speed", None),
    ("angular acceleration", None),
)
"""Of a gauge's displacement, velocity and acceleration, along a line or about an axis."""


def model_text(model: Model) -> str:
    """Sentence on the excitation model, and on what it assumes."""
    return say("Vibration by the {model} model: {what}", model=model, what=say(MODELS[model]))


def reading(
    value: float, rotation: bool, scale: float = NOTHING, speed: float | None = None
) -> Value:
    """What a gauge reads, m or rad, as a cell of its own kind; and at which speed of the crank."""
    kind, unit = (TURNED if rotation else MOVED)[0]
    return Value(value, scale, speed, dimension=kind, unit=unit)


def _row(name: str, values: Iterable[float], kind: Kind) -> tuple[Cell, ...]:
    """Values of a kind of their own in a row, rounded beside the largest."""
    values = [*map(float, values)]
    scale, (dimension, unit) = max(map(abs, values)), kind
    return (name, *(Value(value, scale, dimension=dimension, unit=unit) for value in values))


# -- at one speed ----------------------------------------------------------------------------------


def response_blocks(
    response: Response, others: Mapping[str, Response | None] | None = None
) -> Iterator[Block]:
    """Gauges, orders, mounts and drive; and the gauges by the other models."""
    yield Text(_driven(response))
    yield Text(model_text(response.model))
    if response.modes:
        yield modes_table(response.modes)
    yield from _gauges(response)
    hands = {name: gauge.hand for name, gauge in response.gauges.items() if gauge.hand is not None}
    if hands:
        title = say("Hand and arm vibration; weighted by ISO 5349-1, in all directions")
        yield table_of(title, hands, HandVibration.declared)
    if response.gauges:
        yield _orders(response)
    if others:
        yield _by_model(response, others)
    if response.mounts:
        yield _mounts(response)
    yield from _drive(response)
    if response.joints:
        title = say("Largest force in each joint of the first row")
        yield table_of(title, response.joints, Joint.declared)
    if lines := tuple(_solution(response)):
        yield Facts(say("Periodic solution"), lines)
    if notes := (*response.notes, *disagreement(others or {}, response.model)):
        yield Notes(notes)


def _driven(response: Response) -> str:
    rows = len(response.machine.rows)
    parts = [driven(response.machine, response.speed)]
    if rows > 1:
        parts.append(say("{rows} rows", rows=rows))
    if response.drive.speed is not None:
        parts.append(say("speed by the motor"))
    return say(", ").join(parts)


def modes_table(modes: Iterable[Mode]) -> Table:
    """Natural frequencies and damping, one mode a row."""
    rows: list[tuple[Cell, ...]] = []
    for count, mode in enumerate(modes, 1):
        rate = mode.natural_frequency
        damping = Value(mode.damping_ratio, 1e-6) if rate else None
        rates = map(Value, (rate, rate / 2 / pi, rate / PER_RPM))
        rows.append((str(count), *rates, damping, _kind(mode)))
    columns = (say("mode"), "rad/s", "Hz", "1/min", say("damping ratio"), "")
    return Table.of(say("Natural frequencies"), columns, rows)


def _kind(mode: Mode) -> str:
    if mode.natural_frequency == 0:
        return say("free, without a spring")
    if mode.eigenvalue.real > 1e-9 * mode.natural_frequency:
        return say("unstable: grows") if mode.swings else say("unstable: falls over")
    return "" if mode.swings else say("overdamped")


def _gauges(response: Response) -> Iterator[Table]:
    """What gauges read: first those that move along a line, then those that turn."""
    labels = (
        say("peak to peak"),
        say("velocity, peak to peak"),
        say("acceleration, peak to peak"),
    )
    for title, kinds, rotation in (
        (say("Gauges; RMS about the mean"), MOVED, False),
        (say("Gauges of rotation; RMS about the mean"), TURNED, True),
    ):
        rows: list[tuple[Cell, ...]] = []
        for name, gauge in response.gauges.items():
            if gauge.rotation is rotation:
                signals = (gauge.displacement, gauge.velocity, gauge.acceleration)
                sizes = ((signal.peak_to_peak, signal.vibration_rms) for signal in signals)
                cells = (Value(float(x), NOTHING) for pair in sizes for x in pair)
                rows.append((name, *cells, *cells_of(gauge, GaugeSignals.declared)))
        if rows:
            heads = (
                Column(what, *kind)
                for label, kind in zip(labels, kinds, strict=True)
                for what in (label, say("RMS"))
            )
            further = headings(GaugeSignals.declared, rotation)
            yield Table.of(title, ("", *heads, *further), rows)


def _orders(response: Response) -> Table:
    """Amplitude of the first orders that there are, at each gauge."""
    sizes = {name: gauge.displacement.sizes for name, gauge in response.gauges.items()}
    count = max(map(len, sizes.values()))
    padded = {name: np.pad(size, (0, count - len(size))) for name, size in sizes.items()}
    tops = {name: float(np.max(size[1:], initial=0.0)) for name, size in padded.items()}
    least = {name: max(FAINT_IN_ROW * top, ROUNDING * NOTHING) for name, top in tops.items()}
    places = loud([np.where(size > least[name], size, 0.0) for name, size in padded.items()])
    rows: list[tuple[Cell, ...]] = []
    for name, size in padded.items():
        scale = max(1e3 * tops[name], NOTHING)
        rotation = response.gauges[name].rotation
        rows.append((name, *(reading(float(size[k]), rotation, scale) for k in places)))
    columns = (say("order"), *(f"{k / response.turns:.4g}" for k in places))
    return Table.of(say("Gauges by order; amplitude"), columns, rows)


def _by_model(response: Response, others: Mapping[str, Response | None]) -> Table:
    """Peak to peak at each gauge, by every model that costs little."""
    rows: list[tuple[Cell, ...]] = []
    for name, gauge in response.gauges.items():
        cells = (
            say("none")
            if other is None
            else reading(float(other.gauges[name].displacement.peak_to_peak), gauge.rotation)
            for other in others.values()
        )
        rows.append((name, *cells))
    return Table.of(say("Gauges by each model; peak to peak"), ("", *others), rows)


def disagreement(others: Mapping[str, Response | None], used: str | None = None) -> Iterator[Note]:
    """That models differ: the worst reading beside that of the model that leaves out least.

    used : model that the other results are by, which the reader need not change if it agrees.
    """
    known = {name: other for name, other in others.items() if other is not None}
    reference = next((name for name in MOST_COMPLETE if name in known), None)
    if reference is None:
        return
    readings = {
        (name, gauge): float(signals.displacement.peak_to_peak)
        for name, other in known.items()
        for gauge, signals in other.gauges.items()
    }

    def error(key: tuple[str, str]) -> float:
        right = readings[reference, key[1]]
        return abs(readings[key] - right) / max(right, ROUNDING * NOTHING)

    worst = max(readings, key=error, default=None)
    if worst is None or error(worst) <= AGREEING:
        return
    (model, gauge), (dimension, unit) = worst, MOVED[0]
    if known[reference].gauges[gauge].rotation:
        dimension, unit = TURNED[0]
    template = to_say(
        "the models differ: at {gauge}, {model} gives {reading} and {reference}, the most "
        "complete model, {right}; use {reference} where they differ"
    )
    own = [error(key) for key in readings if key[0] == used]
    if own and used != reference and max(own) <= AGREEING:
        template = to_say(
            "the models differ: at {gauge}, {model} gives {reading} and {reference}, the most "
            "complete model, {right}; {used}, which is used here, agrees with {reference}"
        )
    values = (
        format_quantity(readings[key], dimension, unit) for key in (worst, (reference, gauge))
    )
    reading, right = values
    yield Note(
        template,
        gauge=gauge,
        model=model,
        reading=reading,
        reference=reference,
        right=right,
        used=used or "",
    )


def _mounts(response: Response) -> Table:
    """Forces of the mounts, and what they hand on."""
    rows: list[tuple[Cell, ...]] = []
    lifting = any(mount.lifts_off for mount in response.mounts.values())
    for name, mount in response.mounts.items():
        force = mount.force
        values = (float(force.mean), mount.largest, mount.smallest, float(force.vibration_rms))
        scale = 100 * max(map(abs, values))
        kind: Dimension = "torque" if mount.torsional else "force"
        ratio = None if np.isnan(mount.whole) else Value(mount.whole, 1.0)
        off = Value(100 * mount.lifts_off, after=0) if mount.least == 0 else None
        cells = (Value(value, scale, dimension=kind) for value in values)
        further = cells_of(mount, MountForce.declared)
        rows.append((name, *cells, ratio, *([off] if lifting else []), *further))
    labels = (say("mean"), say("largest"), say("smallest"), say("RMS"), say("transmissibility"))
    in_air = (Column(say("in the air"), unit="%"),) if lifting else ()
    title = say(
        "Mounts: force on the support, RMS about the mean; transmitted share of the shaking force"
    )
    return Table.of(title, ("", *labels, *in_air, *headings(MountForce.declared)), rows)


def _drive(response: Response) -> Iterator[Block]:
    drive = response.drive
    rows = [_extremes(say("drive torque"), drive.torque_figures, ("torque", None))]
    if drive.speed is not None:
        figures = drive.speed.figures
        rows.append(_extremes(say("crank speed"), figures, ("angular speed", "rpm")))
    labels = ("", say("mean"), say("largest"), say("smallest"), say("peak to peak"))
    title = say("Drive, all rows together") if response.machine.rows else say("Drive")
    yield Table.of(title, labels, rows)
    if drive.speed is None:
        return
    share = f"{100 * drive.fluctuation:.3g}"
    yield Text(say("The speed fluctuates by {share} % of its mean.", share=share))
    if abs(drive.shift) > 1e-9 * abs(response.speed):
        shift = number(drive.shift / PER_RPM)
        yield Text(
            say("The motor's curve is shifted by {shift} rpm to hold the mean.", shift=shift)
        )


def _extremes(name: str, figures: Figures, kind: Kind) -> tuple[Cell, ...]:
    return _row(name, (figures.mean, figures.max, figures.min, figures.peak_to_peak), kind)


def _solution(response: Response) -> Iterator[str]:
    """How far the periodic solution can be trusted."""
    if response.residual is not None:
        yield say("residual {residual}", residual=f"{response.residual:.1e}")
    if response.energy is not None and response.mounts:
        yield say(
            "energy per period: {fed} J supplied, {lost} J dissipated in mounts",
            fed=f"{response.energy.fed_in:.6g}",
            lost=f"{response.energy.lost:.6g}",
        )
    if response.multipliers is not None and response.multipliers.size:
        yield say(
            "{verdict}: the largest multiplier of a disturbance over a period is {size}",
            verdict=say("stable") if response.stable else say("not stable"),
            size=f"{abs(response.multipliers[0]):.4f}",
        )


# -- in time ---------------------------------------------------------------------------------------


def transient_blocks(transient: Transient) -> Iterator[Block]:
    """Extremes of every gauge and mount, in the first and the last stretch of the time."""
    yield Text(
        say(
            "From rest for {time} s, {turns} turns of the crank",
            time=number(float(transient.time[-1])),
            turns=number(abs(float(transient.crank_angle[-1])) / (2 * pi)),
        )
    )
    count = max(1, len(transient.time) // PARTS)
    ends: Ends = slice(count), slice(-count, None)
    rows = [] if transient.support is None else [*support_rows(transient.support, ends)]
    speed = transient.crank_speed
    rows.append(_in_stretches(say("crank speed"), speed, ends, ("angular speed", "rpm")))
    yield Table.of(say("Gauges, mounts and drive"), extreme_labels(), rows)


Ends = tuple[slice, slice]
"""Instants in the first and the last stretch of a time."""


def extreme_labels() -> tuple[str, ...]:
    """Heads of a table with `support_rows`."""
    ranges = (say("range in the first fifth"), say("range in the last fifth"))
    return ("", say("smallest"), say("largest"), *ranges)


def support_rows(motion: SupportMotion, ends: Ends) -> Iterator[tuple[Cell, ...]]:
    """Extremes of every gauge and mount, and their ranges in the first and the last stretch."""
    turning = members_of("gauges")(motion.body.machine)
    for name, values in motion.gauges.items():
        yield _in_stretches(name, values, ends, (TURNED if turning[name] else MOVED)[0])
    turning = members_of("mounts")(motion.body.machine)
    for name, values in motion.mounts.items():
        yield _in_stretches(name, values, ends, ("torque" if turning[name] else "force", None))


def _in_stretches(name: str, values: Array, ends: Ends, kind: Kind) -> tuple[Cell, ...]:
    ranges = (np.ptp(values[end]) for end in ends)
    return _row(name, (np.min(values), np.max(values), *ranges), kind)


MOST_PEAKS = 6
"""Peaks at most that are listed for each gauge."""
MET_ORDERS = (1, 2, 3, 4)
"""Orders whose speeds that meet a mode are listed."""
CRANK: tuple[Dimension, str] = ("angular speed", "rpm")

# -- over speeds -----------------------------------------------------------------------------------


def sweep_blocks(sweep: Sweep) -> Iterator[Block]:
    """Natural frequencies, resonances, and what each gauge reads at its peaks."""
    yield Text(speeds_text(sweep))
    yield Text(model_text(sweep.model))
    yield modes_table(sweep.modes)
    if sweep.resonances:
        yield resonances_table(sweep)
    else:
        yield Text(say("There is no resonance in this range."))
    yield _peaks(sweep)
    if sweep.notes:
        yield Notes(sweep.notes)


def resonances_table(sweep: Sweep) -> Table:
    """Where orders of the crank meet modes."""
    rows = (
        (
            Value(resonance.speed),
            f"{resonance.order:.4g}",
            str(resonance.mode),
            Value(resonance.frequency / 2 / pi),
            Value(100 * resonance.share),
            say("no need") if resonance.avoid is None else Span(*resonance.avoid),
        )
        for resonance in sweep.resonances
    )
    columns = (
        Column(say("crank speed"), *CRANK),
        say("order"),
        say("mode"),
        Column(say("frequency"), "frequency"),
        Column(say("share"), unit="%"),
        Column(say("keep away from"), *CRANK),
    )
    title = (
        say("Resonances of small motion: crank speeds at which an order meets a mode")
        if sweep.model == "exact"
        else say("Resonances: crank speeds at which an order meets a mode")
    )
    what = say("share of the loudest; to be kept away from where amplified more than three times")
    return Table.of(f"{title} ({what})", columns, rows)


def _peaks(sweep: Sweep) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for name, curve in sweep.gauges.items():
        k = int(np.nanargmin(curve.peak_to_peak))
        lowest = float(sweep.speed[k]), float(curve.peak_to_peak[k])
        least, *tops = (
            reading(value, curve.rotation, speed=speed)
            for speed, value in (lowest, *sweep.peaks[name][:MOST_PEAKS])
        )
        rows.append((name, least, Many(tuple(tops)) if tops else say("none")))
    labels = (say("smallest"), say("peaks, the largest first"))
    columns = ("", *(Column(label, at=CRANK) for label in labels))
    return Table.of(say("Gauges: peak to peak, at the speed of the crank"), columns, rows)


# -- free ------------------------------------------------------------------------------------------


def free_blocks(free: FreeVibration) -> Iterator[Block]:
    """Natural frequencies, damping, shapes, and the crank speeds that meet them."""
    model = free.linear.excitation.model
    if model == "moment":
        yield Text(say("Mass of the linkages: distributed, mean over one turn."))
    else:
        yield Text(say("Mass of the linkages at the drive's pivot."))
    yield Text(model_text(model))
    yield Text(_reference_text(free))
    yield modes_table(free.modes)
    yield _met(free)
    title = say("Shapes; displacements in m beside rotations in rad, amplitude and phase")
    parts = np.transpose([mode.shape for mode in free.modes])
    yield _shapes(title, dict(zip(free.coordinates, parts, strict=True)))
    yield _shapes(say("Shapes at the gauges"), free.gauges)
    yield _rest(free)
    if free.notes:
        yield Notes(free.notes)


def _reference_text(free: FreeVibration) -> str:
    """Sentence on the reference point of matrices and mode shapes."""
    unit_display = display("length", [*free.reference], "mm")
    place = coordinates(unit_display.text(part, AT_RESONANCE) for part in free.reference)
    support = free.linear.body.support
    template = (
        to_say("Displacements, masses and stiffnesses are those of the support's pivot, ({place}).")
        if support.pivot is not None
        else to_say(
            "Displacements, masses and stiffnesses are those of the support's centre of mass, "
            "({place})."
        )
    )
    return say(template, place=unit_display.with_unit(place))


AT_RESONANCE = 1e-3
"""m beside which a coordinate that is smaller than atoms is 0."""


def _met(free: FreeVibration) -> Block:
    rows = [
        (str(count), *(Value(mode.natural_frequency / order) for order in MET_ORDERS))
        for count, mode in enumerate(free.modes, 1)
        if mode.swings
    ]
    if not rows:
        return Text(say("No mode oscillates, so there is no resonance."))
    columns = (Column(say("order {order}", order=order), *CRANK) for order in MET_ORDERS)
    return Table.of(say("Crank speeds that meet a mode"), (say("mode"), *columns), rows)


NO_MOTION, PART_ROUNDING = 1e-6, 1e-12
"""Over the largest value of a part in any mode, and of all parts: a value that is none."""


def _shapes(title: str, parts: Mapping[str, Array]) -> Table:
    """Parts (modes,) of each mode's shape; its largest coordinate is 1."""
    largest = max((float(np.max(np.abs(part), initial=0.0)) for part in parts.values()), default=0)
    columns = [list(_part(part, PART_ROUNDING * largest)) for part in parts.values()]
    rows = ((str(count), *row) for count, row in enumerate(zip(*columns, strict=True), 1))
    return Table.of(title, (say("mode"), *parts), rows)


def _part(values: Array, least: float) -> Iterator[Value]:
    """A part of each mode, which may be small beside others of another unit."""
    least = max(least, NO_MOTION * float(np.max(np.abs(values), initial=0.0)))
    for value in map(complex, values):
        size, phase = abs(value), float(np.angle(value))
        if size < least:
            yield Value(0.0)
        elif abs(phase) < np.radians(0.05):
            yield Value(size)
        elif abs(abs(phase) - pi) <= np.radians(0.05):
            yield Value(-size)
        else:
            yield Value(size, at=phase)


def _rest(free: FreeVibration) -> Table:
    mounts, rest = free.linear.body.support.mounts, free.linear.rest
    scale = max(map(abs, free.preloads.values()), default=0.0)
    rows: list[tuple[Cell, ...]] = []
    for name, force in free.preloads.items():
        kind: Dimension = "force" if mounts[name].axis is None else "torque"
        touching = "" if rest.carries(name, mounts[name]) else say("does not touch")
        rows.append((name, Value(force, scale, dimension=kind), touching))
    return Table.of(say("Mounts at rest"), ("", say("force on the support"), ""), rows)
