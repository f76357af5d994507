"""Tables of what a linkage does: to its support, in the field, and when it is balanced."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.measures import unit_of as si_unit
from equipoise.i18n import say, to_say
from equipoise.mechanism.balance import Objective
from equipoise.planting.summary import PlantingFigures
from equipoise.report.changes import told
from equipoise.report.document import Block, Paragraph, Points, Row, Table
from equipoise.report.findings import Findings
from equipoise.report.helps import nothing_told
from equipoise.report.notes import noted
from equipoise.report.numbers import PER_RPM, about, angle, change, number
from equipoise.results.naming import (
    MEASURES,
    objective_named,
    output_named,
    scaled,
    unit_of_measure,
)
from equipoise.vibration.response import Response
from equipoise.vibration.sweep import Sweep

MOST_RESONANCES = 8

INSTANTS = {
    "pick_up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest point"),
    "release": to_say("release"),
    "exit": to_say("exit"),
    "highest": to_say("highest point"),
}
PATH = (
    ("curve.height", to_say("height of the curve"), 1e3, "mm"),
    ("curve.width", to_say("width of the curve"), 1e3, "mm"),
    ("curve.length", to_say("length of the curve"), 1e3, "mm"),
    ("hill_spacing", to_say("distance of hills"), 1e3, "mm"),
    ("planting_frequency", to_say("planting frequency"), 1.0, "Hz"),
    ("soil.depth", to_say("depth in the soil"), 1e3, "mm"),
    ("soil.time", to_say("time in the soil"), 1e3, "ms"),
    ("soil.path_length_ground", to_say("path in the soil over ground"), 1e3, "mm"),
    ("soil.ground_distance", to_say("ground distance from entry to exit"), 1e3, "mm"),
    ("soil.hole_length", to_say("length of the hole at the surface"), 1e3, "mm"),
    ("max_speed.value", to_say("largest velocity of the tip"), 1.0, "m/s"),
    ("max_acceleration.value", to_say("largest acceleration of the tip"), 1.0, "m/s²"),
)


def planting_blocks(found: PlantingFigures) -> Iterator[Block]:
    """Instants of a stroke, the path, what it does in the soil."""
    get, rows = found.figures.get, []
    for name, label in INSTANTS.items():
        at = get(f"{name}.crank_angle")
        if at is None or (name == "release" and found.planting.release is None):
            continue
        height = 1e3 * (get("curve.height") or 0.0)
        cells = (number(1e3 * (get(f"{name}.{axis}") or 0.0), height) for axis in "xy")
        moved = (get(f"{name}.velocity.size"), get(f"{name}.acceleration.size"))
        shown = ("" if value is None else number(value) for value in moved)
        rows.append((say(label), angle(at), *cells, *shown))
    header = ("", f"{say('crank angle')} °", "x mm", "y mm", "m/s", "m/s²")
    yield Table(say("Instants of a stroke, relative to the machine"), header, tuple(rows))
    path: tuple[Row, ...] = tuple(
        (_headed(say(label), unit), number(value * scale))
        for name, label, scale, unit in PATH
        if (value := get(name)) is not None
    )
    yield Table(say("Path and soil"), ("", say("value")), path)
    yield from _notes(found.notes)


def _headed(*words: str) -> str:
    return say(", ").join(words)


def _notes(notes: tuple[str, ...]) -> Iterator[Block]:
    yield from map(Paragraph, map(noted, notes))


# -- vibration -------------------------------------------------------------------------------------


def vibration_blocks(response: Response, sweep: Sweep | None) -> Iterator[Block]:
    """Gauges, natural frequencies, resonances, mounts."""
    if response.gauges:
        yield _gauges(response)
    if response.modes:
        rows = tuple(
            (
                str(count),
                number(mode.cycles_per_second),
                number(60 * mode.cycles_per_second),
                damped,
            )
            for count, mode in enumerate(response.modes, 1)
            for damped in (number(mode.damping_ratio, 1e-6) if mode.natural_frequency else "",)
        )
        header = (say("mode"), "Hz", "1/min", say("damping ratio"))
        yield Table(say("Natural frequencies"), header, rows)
    if sweep is not None and sweep.resonances:
        yield _resonances(sweep)
    if response.mounts:
        yield _mounts(response)
    yield from _notes(response.notes)


def _gauges(response: Response) -> Table:
    rows = []
    for name, gauge in response.gauges.items():
        scale, unit = scaled("rad" if gauge.rotation else "m")
        rate = "rad/s²" if gauge.rotation else "m/s²"
        moved, shaken = gauge.displacement, gauge.acceleration
        rows.append(
            (
                name,
                f"{number(float(moved.peak_to_peak) * scale)} {unit}",
                f"{number(float(moved.vibration_rms) * scale)} {unit}",
                f"{number(float(shaken.vibration_rms))} {rate}",
            )
        )
    header = ("", say("peak to peak"), say("RMS about the mean"), say("acceleration, RMS"))
    return Table(say("Gauges"), header, tuple(rows))


def _resonances(sweep: Sweep) -> Table:
    rows = []
    loudest = sorted(sweep.resonances, key=lambda one: -one.share)[:MOST_RESONANCES]
    for one in sorted(loudest, key=lambda one: abs(one.speed)):
        avoid = ""
        if one.avoid is not None:
            avoid = " … ".join(number(abs(end) / PER_RPM) for end in one.avoid)
        speed, frequency = number(abs(one.speed) / PER_RPM), number(one.frequency / 2 / pi)
        rows.append((speed, f"{one.order:.4g}", str(one.mode), frequency, avoid))
    header = ("rpm", say("order"), say("mode"), "Hz", f"{say('to be avoided')} rpm")
    return Table(
        say("Resonances: crank speeds at which an order meets a mode"), header, tuple(rows)
    )


def _mounts(response: Response) -> Table:
    rows = []
    for name, mount in response.mounts.items():
        unit = "N m" if mount.torsional else "N"
        values = (float(mount.force.mean), mount.largest, mount.smallest)
        scale = 100 * max(map(abs, values))
        rows.append((_headed(name, unit), *(number(value, scale) for value in values)))
    header = ("", say("mean"), say("largest"), say("smallest"))
    return Table(say("Forces of the mounts on the support"), header, tuple(rows))


# -- balance ---------------------------------------------------------------------------------------


def balance_blocks(found: Findings, balanced: Balanced) -> Iterator[Block]:
    """What to change, and every figure before and after."""
    if not found.own_plan and balanced.plan.phases is not None:
        yield Paragraph(
            say(
                "The file does not say what may be changed. So this is the remedy that costs "
                "nothing: other phases of the rows."
            )
        )
    elif not found.own_plan:
        yield Paragraph(
            say(
                "The file does not say what may be changed. So this is the usual remedy: a "
                "counterweight on the axis of the drive link, within its reach."
            )
        )
    if not found.helped:
        yield from map(Paragraph, nothing_told(found))
        return
    lines = tuple(line for one in balanced.changes for line in told(one))
    yield Points(say("Changes; places and directions in the axes of each link"), lines)
    rows = len(found.machine.rows)
    if len(balanced.objectives) > 0:
        yield _objectives(balanced, rows)
    yield _before_after(balanced, rows)
    if balanced.gap is not None:
        gap = max(balanced.gap, 1e-12)
        yield Paragraph(
            say(
                "Proof: nothing that is allowed is better by more than {gap} of the value before.",
                gap=about(gap),
            )
        )
    yield from _notes(balanced.notes)


def _objectives(balanced: Balanced, rows: int) -> Table:
    lines = []
    for one in balanced.plan.objectives:
        before, after = balanced.objectives[one.name]
        scale, unit = scaled(balanced.units[one.name])
        values = (number(before * scale), number(after * scale, before * scale))
        lines.append((_headed(objective_named(one, rows), unit), *values, change(before, after)))
    header = ("", say("before"), say("after"), say("change"))
    return Table(say("What was made small"), header, tuple(lines))


def _before_after(balanced: Balanced, count: int) -> Table:
    """All figures, those of planting left out; rounding beside the largest of its unit is 0."""
    before, after = balanced.before, balanced.after
    names = [name for name in before | after if not name.startswith("planting.")]
    told = {name: _figure(balanced, name, count) for name in names}
    largest: dict[str, float] = {}
    for name, (_, scale, unit) in told.items():
        top = max(before.get(name, 0.0), after.get(name, 0.0)) * scale
        largest[_kin(unit)] = max(largest.get(_kin(unit), 0.0), top)
    rows = []
    for name, (label, scale, unit) in told.items():
        least = 10 * largest[_kin(unit)]
        cells = [number(x[name] * scale, least) if name in x else "" for x in (before, after)]
        zero = cells[0] in ("0", "")
        changed = "" if zero else change(before[name], after.get(name, 0.0))
        rows.append((_headed(label, unit), *cells, changed))
    header = ("", say("before"), say("after"), say("change"))
    return Table(say("Before and after"), header, tuple(rows))


def _kin(unit: str) -> str:
    """The unit of which rounding of a unit comes."""
    return "N m" if unit == "J" else unit


def _figure(balanced: Balanced, name: str, count: int) -> tuple[str, float, str]:
    """A figure in words, with factor and unit that are shown."""
    if name == "mass":
        return say("mass of the links"), 1e3, "g"
    output, _, measure = name.rpartition(".")
    label = _headed(output_named(output, count), say(MEASURES[measure]))
    if output.startswith("gauges"):
        return label, *scaled(si_unit(Objective(output), balanced.original))
    return label, *scaled(unit_of_measure(output, measure))
