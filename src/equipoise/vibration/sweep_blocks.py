"""What vibration shows beyond one speed: over a range of them, and of free modes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import coordinates, say, to_say
from equipoise.quantities import PER_RPM, Dimension, display, number
from equipoise.results.blocks import Block, Cell, Column, Many, Notes, Span, Table, Text, Value
from equipoise.signals import Array
from equipoise.vibration.blocks import model_told, modes_table, reading

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.sweep import Sweep

MOST_PEAKS = 6
"""Peaks that are told of each gauge."""
MET_ORDERS = (1, 2, 3, 4)
"""Orders of which the speeds that meet a mode are told."""
CRANK: tuple[Dimension, str] = ("angular speed", "rpm")

# -- over speeds -----------------------------------------------------------------------------------


def sweep_blocks(sweep: Sweep) -> Iterator[Block]:
    """Natural frequencies, resonances, and what each gauge reads at its peaks."""
    low, high = (number(float(sweep.speed[k]) / PER_RPM) for k in (0, -1))
    yield Text(
        say(
            "{link} driven at {low} to {high} rpm, {count} speeds",
            link=sweep.machine.drive.link,
            low=low,
            high=high,
            count=len(sweep.speed),
        )
    )
    yield Text(model_told(sweep.model))
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
    yield Text(model_told(model))
    yield Text(_reference_told(free))
    yield modes_table(free.modes)
    yield _met(free)
    title = say("Shapes; displacements in m beside rotations in rad, amplitude and phase")
    parts = np.transpose([mode.shape for mode in free.modes])
    yield _shapes(title, dict(zip(free.coordinates, parts, strict=True)))
    yield _shapes(say("Shapes at the gauges"), free.gauges)
    yield _rest(free)
    if free.notes:
        yield Notes(free.notes)


def _reference_told(free: FreeVibration) -> str:
    """About which point matrices and shapes are."""
    shown = display("length", [*free.reference], "mm")
    place = coordinates(shown.text(part, AT_RESONANCE) for part in free.reference)
    support = free.linear.body.support
    template = (
        to_say("Displacements, masses and stiffnesses are those of the support's pivot, ({place}).")
        if support.pivot is not None
        else to_say(
            "Displacements, masses and stiffnesses are those of the support's centre of mass, "
            "({place})."
        )
    )
    return say(template, place=shown.with_unit(place))


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


NOTHING, ROUNDING = 1e-6, 1e-12
"""Over the largest value of a part in any mode, and of all parts: a value that is none."""


def _shapes(title: str, parts: Mapping[str, Array]) -> Table:
    """Parts (modes,) of each mode's shape; its largest coordinate is 1."""
    largest = max((float(np.max(np.abs(part), initial=0.0)) for part in parts.values()), default=0)
    columns = [list(_part(part, ROUNDING * largest)) for part in parts.values()]
    rows = ((str(count), *row) for count, row in enumerate(zip(*columns, strict=True), 1))
    return Table.of(title, (say("mode"), *parts), rows)


def _part(values: Array, least: float) -> Iterator[Value]:
    """A part of each mode, which may be small beside others of another unit."""
    least = max(least, NOTHING * float(np.max(np.abs(values), initial=0.0)))
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
