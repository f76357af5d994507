"""What an analysis shows: the verdict for this machine, then motion, forces on frame and drive,
joints, and all of it by orders.

`yardsticks` has the reference value against which each figure is large or not.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import say, to_say
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.kinematics.strokes import SHARE, Dwell
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.mechanism.parts.balance import GAUGES
from equipoise.quantities import Dimension, Display, angle, display, format_quantity, percent
from equipoise.quantities.numbers import ROUNDING
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Facts,
    Many,
    Notes,
    Table,
    Text,
    Value,
    broken_if,
    look_at_next,
)
from equipoise.results.joint_blocks import elements_tables, joint_blocks, kind_tables
from equipoise.results.machine_blocks import (
    crank_angles_text,
    driven,
    drives_table,
    four_bar_facts,
    four_bar_table,
    largest,
    point_text,
    points_table,
    scale_of,
    smallest,
    span,
)
from equipoise.results.outputs import CAUSES, TOTALS, tops_of
from equipoise.results.remarks import RemarkPlace, remarks_of
from equipoise.results.rotors import rotor_sentence
from equipoise.results.yardsticks import (
    FigureAssessment,
    GaugeReading,
    assess,
    contact_sentence,
    kept_contact,
    sentence,
    verdict,
)
from equipoise.signals import EQUAL, Array, Periodic

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.results.analysis import Analysis


MOST_ORDERS = 8
"""Orders at most in a table of harmonics."""
MOST_DEAD = 4
"""Dead positions at most that are listed beside the outermost two."""
LISTED_ANGLES = 24
"""Crank angles in a turn at which an output that the user chose is tabulated."""


MOST_LARGE, MOST_SMALL = 3, 2
"""Figures at most beside the verdict: among large figures, and where no figure is large."""


MOST_NOTES = 3
"""Notes that stand first; the others follow with all tables."""


ELSE_LARGE = to_say("Other large figures, each with its reference value")


NEXT_TO_ONE = to_say("Nothing else is large; nearest to their reference values")


NEXT_TO_NONE = to_say("Nothing is large; nearest to their reference values")


def analysis_headline(
    analysis: Analysis,
    alone: bool = False,
    readings: Mapping[str, GaugeReading] | None = None,
) -> Iterator[Block]:
    """The verdict and what else is large; alone also what the machine is, and what to look at next.

    alone : whether nothing follows, as on a terminal.
    readings : of gauges, as of `assess`.
    """
    entries = assess(analysis, readings)
    first = verdict(entries)
    yield from verdict_blocks(analysis, readings)
    if alone:
        yield Text(what_it_is(analysis))
    is_of_gauge = first is not None and first.output.startswith(GAUGES)
    rest = [entry for entry in entries if entry is not first and not entry.is_kept_contact]
    if is_of_gauge:  # `respond` has the others
        rest = [item for item in rest if not item.output.startswith(GAUGES)]
    large = [item for item in rest if item.is_large]
    if largest := large[:MOST_LARGE] or rest[:MOST_SMALL]:
        lines = tuple(sentence(item, analysis.machine.crank_turns) for item in largest)
        small = NEXT_TO_ONE if first is not None and first.is_large else NEXT_TO_NONE
        yield Facts(say(ELSE_LARGE if large else small), lines)
    if alone and (notes := analysis.notes):
        yield Notes(notes[:MOST_NOTES])
    if alone:
        yield look_at_next(*_next(analysis, first))


def verdict_blocks(
    analysis: Analysis, readings: Mapping[str, GaugeReading] | None = None
) -> Iterator[Text]:
    """The figure by which the machine is judged first, and up to which speed followers stay on
    their cams; nothing where there is neither.

    readings : of gauges, as of `assess`.
    """
    entries = assess(analysis, readings)
    first, figure_assessment = verdict(entries), kept_contact(entries)
    words = [*filter(None, [rotor_sentence(analysis.machine)])]
    if first is not None and first is not figure_assessment:
        words.append(say("{sentence}.", sentence=sentence(first, analysis.machine.crank_turns)))
    if figure_assessment is not None:
        words.append(contact_sentence(figure_assessment))
    if words:
        is_broken = first is not None and first.is_broken
        yield Text(" ".join(words), broken_if(is_broken))


def what_it_is(analysis: Analysis) -> str:
    """How many links move, their mass where it is known, and how they are driven."""
    machine = analysis.machine
    values = {
        "links": moving_links(len(machine.links)),
        "driven": driven(machine, analysis.motion.speed),
        "mass": "" if massless(machine) else format_quantity(machine.mass, "mass", "kg", digits=3),
    }
    without = to_say("{links}; {driven}")
    with_mass = to_say("{links} of {mass} together; {driven}")
    several = to_say("{rows} rows, in each {links} of {mass} together; {driven}")
    if massless(machine):
        return say(without, **values)
    if len(machine.rows) > 1:
        return say(several, rows=len(machine.rows), **values)
    return say(with_mass, **values)


def _next(analysis: Analysis, first: FigureAssessment | None) -> Iterator[str]:
    """Commands that show more of what is large, and what to do about it."""
    machine = analysis.machine
    if output := _output_of(analysis, first):
        yield f"analyze --output {shlex.quote(output) if ' ' in output else output}"
    if machine.planting is not None:
        yield "plant"
    if machine.support is not None and not massless(machine):
        yield "respond"
    if not massless(machine):
        yield "balance"


def _output_of(analysis: Analysis, first: FigureAssessment | None) -> str:
    """The output to look at: that of the verdict, of a contact its force."""
    if first is None:
        return ""
    names = (first.output, f"{first.output}.normal")
    return next((name for name in names[first.is_contact :] if name in analysis.outputs), "")


def analysis_blocks(analysis: Analysis) -> Iterator[Block]:
    """Motion, forces and joints."""
    machine, motion = analysis.machine, analysis.motion
    yield Text(f"{driven(machine, motion.speed)}; {crank_angles_text(analysis)}")
    yield from motion_blocks(analysis)
    yield from kind_tables(analysis, "motion")
    yield from elements_tables(analysis)
    if not analysis.has_forces:
        yield from question_blocks(analysis)
        return
    yield from force_blocks(analysis)
    yield from joint_blocks(analysis)
    yield from kind_tables(analysis, "joints")
    yield from question_blocks(analysis)


def question_blocks(analysis: Analysis) -> Iterator[Block]:
    """What may not be meant as the file gives it; without masses also what else stands beside
    tables of forces, which there are none of.
    """
    place: RemarkPlace | None = "end" if analysis.has_forces else None
    if questions := (*remarks_of(analysis, place),):
        yield Notes(questions)


# -- motion ----------------------------------------------------------------------------------------


def motion_blocks(analysis: Analysis) -> Iterator[Block]:
    """How links and points move."""
    if analysis.four_bar is not None:
        carried = analysis.motion.linkage.shared is not None
        yield four_bar_table(analysis.four_bar)
        yield Facts("", tuple(four_bar_facts(analysis.four_bar, carried)))
    if analysis.strokes:
        yield strokes_table(analysis)
        yield advantages_table(analysis)
    motion = analysis.motion
    rate = abs(motion.speed)
    columns = (
        "",
        Column(say("angle"), "angle"),
        Column(say("velocity"), "angular speed"),
        Column(say("acceleration"), "angular acceleration"),
    )
    rows = (
        (
            name,
            turned(analysis, name) or span(motion, link.angle, pi),
            span(motion, link.angular_velocity, rate),
            span(motion, link.angular_acceleration, rate**2),
        )
        for name, link in analysis.motion.links.items()
    )
    yield Table.of(say("Links: angle, angular velocity and acceleration"), columns, rows)
    yield from points_table(analysis)


def turned(analysis: Analysis, link: str) -> str:
    """That a link turns fully, where it does: a range of its angle would say nothing more."""
    motion = analysis.motion
    if not motion.whole_cycle or not motion.speed:
        return ""
    mean = float(np.mean(motion.links[link].angular_velocity)) / motion.speed
    return say("turns fully") if abs(mean) * motion.turns > 0.5 else ""


def strokes_table(analysis: Analysis) -> Table:
    """Strokes of sliders and swings of rockers, with their dead positions and time ratios."""
    rows: list[tuple[Cell, ...]] = []
    for name, item in analysis.strokes.items():
        dead = [
            Value(place.place, item.stroke, place.crank_angle, dimension=item.dimension)
            for place in item.dead_positions
        ]
        ends = [next(d for d in dead if d.at == at) for at in (item.lowest_at, item.highest_at)]
        least = EQUAL * item.stroke
        others = [d for d in dead if item.lowest + least < d.value < item.highest - least]
        rest = Many(tuple(others[:MOST_DEAD]), max(len(others) - MOST_DEAD, 0)) if others else None
        stroke = Value(item.stroke, dimension=item.dimension)
        rows.append((joint_named(name), stroke, *ends, Value(item.time_ratio), rest))
    heads = (say("stroke"), say("lowest"), say("highest"), say("time ratio"))
    columns = ("", *heads, say("further dead positions"))
    title = say(
        "Sliders and rockers: stroke between dead positions (at crank angle), and time of the "
        "slower stroke over that of the faster"
    )
    return Table.of_filled(title, columns, rows)


def advantages_table(analysis: Analysis) -> Table:
    """Over which crank angle sliders and rockers rise and dwell, and their least advantage."""
    rows: list[tuple[Cell, ...]] = []
    for name, stroke in analysis.strokes.items():
        least = None
        if stroke.least_advantage is not None:
            least = Value(stroke.least_advantage, at=stroke.least_advantage_at)
        pushes = (least, None) if stroke.kind == "slider" else (None, least)
        dwell = Value(stroke.dwell, at=stroke.dwell_at, after=1)
        rows.append((joint_named(name), Value(stroke.rise, after=1), dwell, *pushes))
    columns = (
        "",
        Column(say("rises over"), "angle", "deg"),
        Column(say("dwell"), "angle", "deg"),
        Column(say("force over crank torque"), "per length"),
        say("torque over crank torque"),
    )
    without = to_say(
        "Crank angle over which they rise; longest dwell within {share} % of the stroke"
    )
    pushing = to_say(
        "Crank angle over which they rise; longest dwell within {share} % of the stroke; least "
        "mechanical advantage, which has no bound towards dead positions"
    )
    title = say(
        pushing if any(row[3:] != (None, None) for row in rows) else without, share=percent(SHARE)
    )
    return Table.of_filled(title, columns, rows)


# -- forces ----------------------------------------------------------------------------------------


def display_of_totals(analysis: Analysis, output: str) -> Display:
    """The unit in which an output of frame or drive is shown everywhere.

    Shaking forces have one, and those that hold loads another: a cylinder may push a hundred times
    as much as its machine shakes.  So have moments.
    """
    own = analysis.outputs[output].declared
    ones = (
        item.figures
        for item in analysis.outputs.summed
        if item.group in TOTALS and item.dimension == own.dimension
        and item.declared.with_loads == own.with_loads
    )  # fmt: skip
    return display(own.dimension, [0.0, *(max(item.peak, item.peak_to_peak) for item in ones)])


def force_blocks(analysis: Analysis) -> Iterator[Block]:
    """Forces on frame and drive; what they come from; their orders."""
    named = [f"drives.{analysis.machine.drive.link}.{analysis.machine.drive.effort_in}"]
    ones = [item for item in analysis.outputs.summed if item.group in TOTALS]
    if not analysis.machine.drives:
        ones = [item for item in ones if item.name not in named]  # which is the drive torque
    rows: list[tuple[Cell, ...]] = []
    for entry in ones:
        figures, kind = entry.figures, entry.dimension
        scale, unit = scale_of(analysis, kind), display_of_totals(analysis, entry.name).unit
        mean, rms, swing = (
            Value(value, scale, dimension=kind, unit=unit)
            for value in (figures.mean, figures.rms, figures.peak_to_peak)
        )
        ends = (replace(end(figures, scale, kind), unit=unit) for end in (largest, smallest))
        rows.append((entry.label(), mean, rms, *ends, swing))
    about = analysis.forces.about
    title = say(
        "On frame and drive; extremes with their crank angle, moments about {place}",
        place=point_text((about.real, about.imag)),
    )
    labels = (say("mean"), say("RMS"), say("largest"), say("smallest"), say("peak to peak"))
    yield Table.of(title, ("", *labels), rows)
    yield from drives_table(analysis)
    yield _by_link(analysis)
    yield _causes(analysis)
    if analysis.has_orders:
        yield orders_table(analysis)


def _by_link(analysis: Analysis) -> Table:
    analysis = analysis.resolved
    parts = analysis.forces.split.by_link("shaking_force")
    rows = (
        (
            name,
            Value(analysis.motion.figures(np.abs(parts[name])).peak),
            Value(100 * share, after=0),
        )
        for name, share in shares(parts, analysis.motion).items()
    )
    columns = say("link"), Column(say("peak"), "force")
    every = tuple(rows)
    if any(row[2].value <= -100 * CANCELLING for row in every):
        title = say("Shaking force by link; these parts mostly cancel")
        return Table.of(title, columns, (row[:2] for row in every))
    share = Column(say("share of the mean square"), unit="%")
    return Table.of(say("Shaking force by link"), (*columns, share), every)


CANCELLING = 0.5
"""A cause whose share is below minus this mostly cancels the others: shares then mislead."""


def shares(parts: Mapping[str, Array], motion: Motion) -> dict[str, float]:
    """Share of each part in the mean square of their sum, the largest first.

    One below 0 works against the others, and all are 0 where they cancel but for rounding.
    parts : signals (N,) at the crank angles of a motion, real or complex.
    """
    signals = np.array(list(parts.values()))
    whole, signal = np.sum(signals, axis=0), np.max(np.abs(signals), initial=0.0)
    if np.max(np.abs(whole)) <= ROUNDING * signal:
        return dict.fromkeys(parts, 0.0)
    square = float(motion.mean(np.abs(whole) ** 2))
    by_name = {
        name: float(motion.mean((part * np.conj(whole)).real)) / square
        for name, part in parts.items()
    }
    return dict(sorted(by_name.items(), key=lambda item: -item[1]))


def _causes(analysis: Analysis) -> Table:
    drive, forces = analysis.machine.drive, analysis.resolved.forces
    scale = analysis.summary[drive.effort].peak
    springs = [item for _, _, item in analysis.machine.force_elements if item.cause == "spring"]
    given = {"load": forces.loads, "spring": springs}
    rows: list[tuple[Cell, ...]] = []
    for cause, values in forces.split.by_cause(drive.effort).items():
        if given.get(cause, True):
            figures = forces.motion.figures(values)
            parts = (figures.mean, figures.rms, figures.max, figures.min)
            rows.append((say(CAUSES[cause]), *(Value(value, scale) for value in parts)))
    labels = (say("mean"), say("RMS"), say("largest"), say("smallest"))
    columns = (Column(label, drive.effort_in) for label in labels)
    title = say("Drive force by cause") if drive.pushes else say("Drive torque by cause")
    return Table.of(title, ("", *columns), rows)


def orders_table(analysis: Analysis) -> Table:
    """Amplitudes of the first orders that there are."""
    ones = [item for item in analysis.outputs.ordered if item.declared.summed]
    signals = [analysis.by_order[item.name] for item in ones]
    count = max(len(signal.amplitudes) for signal in signals)
    sizes = [np.pad(signal.sizes, (0, count - len(signal.sizes))) for signal in signals]
    tops = tops_of(zip(ones, (size[1:] for size in sizes), strict=True))
    kinds = [item.dimension for item in ones]
    scales = [max(1e3 * tops[kind], scale_of(analysis, kind)) for kind in kinds]
    turns = analysis.motion.turns
    per_order = abs(analysis.motion.speed) / (2 * np.pi)
    rows = (
        (
            f"{k / turns:.4g}",
            Value(k / turns * per_order),
            *(Value(float(size[k]), scale) for size, scale in zip(sizes, scales, strict=True)),
        )
        for k in loud(sizes)
    )
    columns = (Column(item.declared.say(item.item), item.dimension) for item in ones)
    heads = (say("order"), Column(say("frequency"), "frequency"), *columns)
    return Table.of(say("Amplitudes by order"), heads, rows)


def loud(sizes: list[Array], most: int = MOST_ORDERS) -> list[int]:
    """Places of the first orders but the mean that are there in some of the amplitudes (K,)."""
    relative = [size / (np.max(size[1:], initial=0.0) or 1.0) for size in sizes]
    top = np.max(relative, axis=0)
    return [k for k in range(1, len(top)) if top[k] > 1e-6][:most]


# -- harmonics -------------------------------------------------------------------------------------


def harmonic_blocks(analysis: Analysis, orders: int, zero: float) -> Iterator[Block]:
    """Harmonics of each output, as in Table 4 of Yamashita and others, up to an order.

    zero : rad, direction from which crank angles count.
    """
    yield Text("y = sum A_n cos(n theta) + B_n sin(n theta) = sum R_n sin(n theta + phase_n)")
    yield Text(say("theta: crank angle from {angle}", angle=angle(zero)))
    signals = analysis.by_order
    tops = tops_of((item, signals[item.name].sizes) for item in analysis.outputs.ordered)
    # the motion before the forces, as in that table
    for entry in sorted(
        analysis.outputs.ordered, key=lambda entry: entry.dimension != "acceleration"
    ):
        kind = entry.dimension
        columns = [say("order"), *(Column(label, kind, alike=False) for label in ("A", "B", "R"))]
        columns += [Column(say("phase"), "angle"), Column(say("RMS"), kind, alike=False)]
        rows = _harmonics(
            signals[entry.name].shifted(zero),
            orders,
            max(10 * tops[kind], scale_of(analysis, kind)),
        )
        yield Table.of(entry.declared.title(entry.item), columns, rows)


def _harmonics(signal: Periodic, orders: int, scale: float) -> Iterator[tuple[Cell, ...]]:
    for k in range(signal.count_to(orders)):
        value = complex(signal.amplitudes[k])
        phase = (
            None
            if abs(value) <= 1e-10 * scale or k == 0
            else Value(float(np.angle(1j * value)), after=1)
        )
        parts = (Value(part, scale) for part in (value.real, -value.imag, abs(value)))
        rms = Value(float(signal.rms_by_order[k]), scale)
        yield f"{float(signal.orders[k]):.4g}", *parts, phase, rms


# -- chosen by name --------------------------------------------------------------------------------


def outputs_table(analysis: Analysis, names: Iterable[str]) -> Table:
    """Outputs over crank angle: at those that were asked for, or some equally spaced ones."""
    ones = analysis.outputs.chosen(names)
    theta, motion = analysis.crank_angle, analysis.motion
    apart = max(len(theta) // (LISTED_ANGLES * motion.turns), 1) if motion.whole_cycle else 1
    columns = [Column(item.label(), item.dimension, alike=False) for item in ones]
    cells = []
    for entry in ones:
        sizes = np.abs(entry.declared.vector(analysis, entry.item))
        scale = float(np.median(sizes[np.isfinite(sizes)])) if np.any(np.isfinite(sizes)) else 0.0
        cells.append(
            [
                Value(value, scale) if np.isfinite(value) else say("infinite")
                for value in entry.values[::apart].tolist()
            ]
        )
    angles = (Value(angle, after=1) for angle in theta[::apart].tolist())
    rows = zip(angles, *cells, strict=True)
    heads = (Column(say("crank angle"), "angle", "deg"), *columns)
    return Table.of(say("Outputs over crank angle"), heads, rows)


def dwells_table(dwells: Mapping[str, Dwell], kind: Dimension) -> Table:
    """How long things hardly move."""
    rows = (
        (joint_named(name), Value(dwell.tolerance), Value(dwell.angle, after=1, at=dwell.begin))
        for name, dwell in dwells.items()
    )
    columns = ("", Column(say("within"), kind), Column(say("dwell"), "angle", "deg"))
    title = say("Longest crank angle over which each moves by no more, from crank angle")
    return Table.of(title, columns, rows)


def shown_blocks(
    analysis: Analysis,
    orders: int | None = None,
    zero: float = 0.0,
    outputs: Sequence[str] = (),
    dwells: Mapping[str, Dwell] | None = None,
) -> Iterator[Block]:
    """What `Analysis` shows; or its harmonics up to an order, outputs, or dwells that are given."""
    if orders is not None:
        yield from harmonic_blocks(analysis, orders, zero)
    if outputs:
        yield outputs_table(analysis, outputs)
    if dwells is not None:
        of_links = dwells.keys() <= analysis.motion.links.keys()
        yield dwells_table(dwells, "angle" if of_links else "length")
    if orders is None and not outputs and dwells is None:
        yield from analysis_blocks(analysis)
