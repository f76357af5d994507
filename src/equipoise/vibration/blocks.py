"""What vibration on the support shows: first, at one speed, in time, over speeds, of free modes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.errors import EquipoiseError
from equipoise.i18n import Note, capital, coordinates, localized, say, to_say
from equipoise.quantities import PER_RPM, Dimension, brief, display, format_quantity, number
from equipoise.results import analysis_blocks
from equipoise.results.analysis import Analysis, analyze
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
    broken_if,
    look_at_next,
)
from equipoise.results.declaring import cells_of, headings, table_of
from equipoise.results.machine_blocks import driven
from equipoise.results.outputs import shown_in
from equipoise.results.rotors import rotor_sentence
from equipoise.results.yardsticks import assess, sentence, verdict
from equipoise.signals import Array
from equipoise.vibration.forced import readings_of
from equipoise.vibration.linear import around, resonance_note, resonances
from equipoise.vibration.response import (
    MODELS,
    ExcitationModel,
    GaugeSignals,
    HandVibration,
    Joint,
    MountForce,
    members_of,
)
from equipoise.vibration.simplified import linear_of

if TYPE_CHECKING:
    from equipoise.signals import Figures
    from equipoise.vibration.forced import Sweep
    from equipoise.vibration.free import FreeVibration, Transient
    from equipoise.vibration.response import DriveSignals, Mode, Response
    from equipoise.vibration.support_motion import SupportMotion


# -- what stands first -----------------------------------------------------------------------------

MOST_NOTES, MOST_GAUGES, MOST_LOUD = 3, 6, 3
"""Notes, gauges and resonances that stand first; the others follow with all tables."""
READINGS = to_say("What the gauges read, peak to peak")


def analysis_headline(analysis: Analysis, alone: bool = False) -> Iterator[Block]:
    """What stands first of an analysis, of a machine on a support also by what its gauges read.

    alone : whether nothing follows, as on a terminal.
    """
    readings = readings_of(analysis.machine, analysis.motion.speed)
    yield from analysis_blocks.analysis_headline(analysis, alone, readings)


def response_headline(response: Response, alone: bool = False) -> Iterator[Block]:
    """Which gauge is the worst beside its limit; alone also what all read, and resonances.

    alone : whether nothing follows, as on a terminal.
    """
    machine = response.machine
    analysis = analyze(machine, speed=response.speed, acceleration=0.0)
    read = [
        figure_assessment
        for figure_assessment in assess(analysis, response.gauges)
        if figure_assessment.figure.startswith("gauges.")
    ]
    first = verdict(tuple(read))
    if first is not None:
        words = say("{sentence}.", sentence=sentence(first, machine.crank_turns))
        yield Text(words, broken_if(first.is_broken))
    elif words := rotor_sentence(machine):
        yield Text(words)
    if response.drive.speed is not None:
        yield Text(_crank_speed(response.drive))
    if not alone:
        return
    yield Text(driven(machine, response.speed))
    yield Text(say("Model {model}: {what}", model=response.model, what=say(MODELS[response.model])))
    if response.gauges:
        worst = "" if first is None else first.item
        yield Facts(say(READINGS), tuple(_readings(response, worst)))
    yield from map(Text, _resonances(response))
    if response.notes:
        yield Notes(response.notes[:MOST_NOTES])
    if machine.support is None:  # which answers at no other speeds
        yield look_at_next("run", "balance")
        return
    low, high = sorted(abs(item) / PER_RPM for item in around(machine.drive, response.speed))
    yield look_at_next(f'respond --speed "{_rpm(low)} : {_rpm(high)}"', "balance")


def _rpm(speed: float) -> str:
    """A speed in rpm to three digits, without an exponent, to be copied into a command."""
    return f"{float(f'{speed:.3g}'):.10g} rpm"


def _crank_speed(drive: DriveSignals) -> str:
    """Mean and fluctuation of the speed of a crank that a motor drives."""
    assert drive.speed is not None
    return say(
        "The machine runs at {speed} rpm, with a fluctuation of {share} %.",
        speed=number(float(drive.speed.mean) / PER_RPM),
        share=f"{100 * drive.fluctuation:.3g}",
    )


def _readings(response: Response, worst: str) -> Iterator[str]:
    """What gauges read: the one that the verdict is about, then the largest of each dimension."""

    def place(name: str) -> tuple[bool, bool, float]:
        gauge = response.gauges[name]
        return name != worst, gauge.rotation, -_size(float(gauge.displacement.peak_to_peak))

    for name in sorted(response.gauges, key=place)[:MOST_GAUGES]:
        gauge = response.gauges[name]
        yield _reading(name, float(gauge.displacement.peak_to_peak), gauge.rotation)


def readings_in_time(motion: SupportMotion) -> Iterator[Block]:
    """What gauges read of a motion in time, where there are any."""
    turning = members_of("gauges")(motion.body.machine)
    sizes = {name: float(np.ptp(values)) for name, values in motion.gauges.items()}
    if lines := [_reading(name, size, turning[name]) for name, size in sizes.items()]:
        yield Facts(say(READINGS), tuple(lines[:MOST_GAUGES]))


def _reading(name: str, size: float, rotation: bool) -> str:
    """What a gauge reads, peak to peak, m or rad."""
    unit = shown_in("rad" if rotation else "m", [size])
    return say("{gauge}: {size}", gauge=name, size=unit.with_unit(unit.text(size, digits=3)))


def _size(value: float) -> float:
    """What sizes are ordered by: gauges that read alike keep their order whatever rounding does."""
    return float(f"{value:.6g}")


def _resonances(response: Response) -> Iterator[str]:
    """The nearest loud resonance of small motion."""
    try:
        linear = linear_of(response.machine, response.model)
        met = resonances(linear, *around(response.machine.drive, response.speed))
    except EquipoiseError:  # without a small-motion description there are no resonances
        return
    if met:
        text = localized(resonance_note(met, response.speed))
        yield say("{sentence}.", sentence=capital(text))


def sweep_headline(sweep: Sweep, alone: bool = False) -> Iterator[Block]:
    """At which speed a gauge reads most; alone also the others, and speeds to keep away from.

    alone : whether nothing follows, as on a terminal.
    """
    lines = tuple(_peak_sentences(sweep))
    if lines:
        yield Text(say("{sentence}.", sentence=lines[0]))
    if not alone:
        return
    yield Text(speeds_text(sweep))
    if lines[1:]:
        yield Facts(say("Where the other gauges read most"), lines[1:MOST_GAUGES])
    if met := tuple(_loud(sweep)):
        yield Facts(say("Resonances"), met)
    else:
        yield Text(say("There is no resonance in this range."))
    if sweep.notes:
        yield Notes(sweep.notes[:MOST_NOTES])
    yield look_at_next("respond --speed")


def speeds_text(sweep: Sweep) -> str:
    """Over which speeds the crank is driven, as text."""
    low, high = (brief(abs(float(sweep.speed[k])) / PER_RPM) for k in (0, -1))
    return say(
        "{link} driven at {low} to {high} rpm, {count} speeds",
        link=sweep.machine.drive.link,
        low=low,
        high=high,
        count=len(sweep.speed),
    )


def _peak_sentences(sweep: Sweep) -> Iterator[str]:
    """The highest peak of each gauge, of each dimension the largest first."""
    rotates = {name: gauge.rotation for name, gauge in sweep.gauges.items()}
    highest = {name: tops[0] for name, tops in sweep.peaks.items() if tops}
    for name in sorted(highest, key=lambda name: (rotates[name], -_size(highest[name][1]))):
        speed, size = highest[name]
        unit = shown_in("rad" if rotates[name] else "m", [size])
        yield say(
            "Gauge {gauge} moves most at {speed} rpm, by {size} peak to peak",
            gauge=name,
            speed=brief(abs(speed) / PER_RPM),
            size=unit.with_unit(unit.text(size, digits=3)),
        )


def _loud(sweep: Sweep) -> Iterator[str]:
    """Loud resonances, the loudest first."""
    loud = sorted(
        (resonance for resonance in sweep.resonances if resonance.is_loud),
        key=lambda resonance: -resonance.share,
    )
    for item in loud[:MOST_LOUD]:
        values = {
            "speed": brief(abs(item.speed) / PER_RPM),
            "order": f"{item.order:.4g}",
            "mode": item.mode,
        }
        low, high = sorted(map(abs, item.avoid or (0.0, 0.0)))
        avoided = to_say(
            "{speed} rpm: order {order} meets mode {mode}; keep away from {low} to {high} rpm"
        )
        harmless = to_say("{speed} rpm: order {order} meets mode {mode}, well damped")
        ends = {"low": brief(low / PER_RPM), "high": brief(high / PER_RPM)}
        yield say(harmless if item.avoid is None else avoided, **values, **ends)


# -- figures as cells ------------------------------------------------------------------------------

UsualUnit = tuple[Dimension, str | None]
"""A dimension, and the unit in which it is usual here."""

NOTHING = 1e-2
"""m, rad and their rates: scale beside which what is smaller than atoms is rounding."""
MOST_COMPLETE: tuple[ExcitationModel, ...] = ("exact", "moment")
"""Models with which others are compared, the one that leaves out least first."""
AGREEING, ROUNDING = 0.05, 1e-9
"""Share by which readings of models may differ without a note; and what of them is rounding."""
PARTS = 5
"""Equal stretches of a time, of which the first and the last show whether it has settled."""
MOVED: tuple[UsualUnit, ...] = (("length", "mm"), ("speed", "mm/s"), ("acceleration", "m/s^2"))
TURNED: tuple[UsualUnit, ...] = (
    ("angle", "mrad"),
    ("angular speed", None),
    ("angular acceleration", None),
)
"""Of a gauge's displacement, velocity and acceleration, along a line or about an axis."""


def model_text(model: ExcitationModel) -> str:
    """Sentence on the excitation model, and on what it assumes."""
    return say("Vibration by the {model} model: {what}", model=model, what=say(MODELS[model]))


def reading(
    value: float, rotation: bool, scale: float = NOTHING, speed: float | None = None
) -> Value:
    """What a gauge reads, m or rad, as a cell of its own kind; and at which speed of the crank."""
    kind, unit = (TURNED if rotation else MOVED)[0]
    return Value(value, scale, speed, dimension=kind, unit=unit)


def _row(name: str, values: Iterable[float], kind: UsualUnit) -> tuple[Cell, ...]:
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


def _extremes(name: str, figures: Figures, kind: UsualUnit) -> tuple[Cell, ...]:
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
    ends: TimeStretches = slice(count), slice(-count, None)
    rows = [] if transient.support is None else [*support_rows(transient.support, ends)]
    speed = transient.crank_speed
    rows.append(_in_stretches(say("crank speed"), speed, ends, ("angular speed", "rpm")))
    yield Table.of(say("Gauges, mounts and drive"), extreme_labels(), rows)


TimeStretches = tuple[slice, slice]
"""Instants in the first and the last stretch of a time."""


def extreme_labels() -> tuple[str, ...]:
    """Heads of a table with `support_rows`."""
    ranges = (say("range in the first fifth"), say("range in the last fifth"))
    return ("", say("smallest"), say("largest"), *ranges)


def support_rows(motion: SupportMotion, ends: TimeStretches) -> Iterator[tuple[Cell, ...]]:
    """Extremes of every gauge and mount, and their ranges in the first and the last stretch."""
    turning = members_of("gauges")(motion.body.machine)
    for name, values in motion.gauges.items():
        yield _in_stretches(name, values, ends, (TURNED if turning[name] else MOVED)[0])
    turning = members_of("mounts")(motion.body.machine)
    for name, values in motion.mounts.items():
        yield _in_stretches(name, values, ends, ("torque" if turning[name] else "force", None))


def _in_stretches(
    name: str, values: Array, ends: TimeStretches, kind: UsualUnit
) -> tuple[Cell, ...]:
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
