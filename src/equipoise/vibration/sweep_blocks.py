"""What vibration shows beyond one speed: over a range of them, and of free modes."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.i18n import say
from equipoise.quantities import PER_RPM, number
from equipoise.results.blocks import Block, Cell, Column, Many, Notes, Span, Table, Text, Value
from equipoise.vibration.blocks import MOVED, NOTHING, TURNED, model_told, modes_table

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.sweep import Sweep


MOST_PEAKS = 6
"""Peaks that are told of each gauge."""
MET_ORDERS = (1, 2, 3, 4)
"""Orders of which the speeds that meet a mode are told."""
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
    rows = tuple(
        (
            Value(one.speed),
            f"{one.order:.4g}",
            str(one.mode),
            Value(one.frequency / 2 / pi),
            Value(100 * one.share),
            say("no need") if one.avoid is None else Span(*one.avoid),
        )
        for one in sweep.resonances
    )
    columns = (
        Column(say("crank speed"), "angular speed", "rpm"),
        Column(say("order")),
        Column(say("mode")),
        Column(say("frequency"), "frequency"),
        Column(say("share"), unit="%"),
        Column(say("keep away from"), "angular speed", "rpm"),
    )
    title = (
        say("Resonances of small motion: crank speeds at which an order meets a mode")
        if sweep.model == "exact"
        else say("Resonances: crank speeds at which an order meets a mode")
    )
    what = say("share of the loudest; to be kept away from where amplified more than three times")
    return Table(f"{title} ({what})", columns, rows)


def _peaks(sweep: Sweep) -> Table:
    rows = []
    for name, curve in sweep.gauges.items():
        tops = tuple(
            reading_at(value, speed, curve.rotation)
            for speed, value in sweep.peaks[name][:MOST_PEAKS]
        )
        k = int(np.nanargmin(curve.peak_to_peak))
        lowest = reading_at(float(curve.peak_to_peak[k]), float(sweep.speed[k]), curve.rotation)
        rows.append((name, lowest, Many(tops) if tops else say("none")))
    columns = (
        Column(""),
        Column(say("smallest"), at=("angular speed", "rpm")),
        Column(say("peaks, the largest first"), at=("angular speed", "rpm")),
    )
    return Table(say("Gauges: peak to peak, at the speed of the crank"), columns, tuple(rows))


def reading_at(value: float, speed: float, rotation: bool) -> Value:
    """What a gauge reads at a speed of the crank."""
    units = TURNED if rotation else MOVED
    return Value(value, NOTHING, speed, dimension=units.dimensions[0], unit=units.names[0])


# -- free, and in time -----------------------------------------------------------------------------


def free_blocks(free: FreeVibration) -> Iterator[Block]:
    """Natural frequencies, damping, shapes, and the crank speeds that meet them."""
    step = free.linear.excitation.step
    if step == "moment":
        yield Text(say("Mass of the linkages spread as in the mean of a turn."))
    else:
        yield Text(say("Mass of the linkages at the drive's pivot."))
    yield Text(model_told(step))
    yield modes_table(free.modes)
    yield _met(free)
    yield from _shapes(free)
    yield _rest(free)


def _met(free: FreeVibration) -> Block:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (str(count), *(Value(mode.natural_frequency / order) for order in MET_ORDERS))
        for count, mode in enumerate(free.modes, 1)
        if mode.swings
    )
    if not rows:
        return Text(say("No mode swings, so no crank speed meets one."))
    heads = (say("order {order}", order=order) for order in MET_ORDERS)
    columns = (Column(say("mode")), *(Column(head, "angular speed", "rpm") for head in heads))
    return Table(say("Crank speeds that meet a mode"), columns, rows)


def _shapes(free: FreeVibration) -> Iterator[Table]:
    """Each mode in the coordinates and at the gauges; the largest coordinate is 1."""
    shapes: tuple[tuple[Cell, ...], ...] = tuple(
        (str(count), *map(_part, mode.shape.tolist())) for count, mode in enumerate(free.modes, 1)
    )
    title = say("Shapes; displacements in m beside rotations in rad, amplitude and phase")
    yield Table(title, tuple(map(Column, (say("mode"), *free.coordinates))), shapes)
    gauges: tuple[tuple[Cell, ...], ...] = tuple(
        (str(count), *(_part(complex(values[count - 1])) for values in free.gauges.values()))
        for count in range(1, len(free.modes) + 1)
    )
    yield Table(
        say("Shapes at the gauges"), tuple(map(Column, (say("mode"), *free.gauges))), gauges
    )


def _part(value: complex) -> Value:
    size, phase = abs(value), float(np.angle(value))
    if size < 1e-6:
        return Value(0.0)
    if abs(phase) < np.radians(0.05):
        return Value(size)
    if abs(abs(phase) - pi) <= np.radians(0.05):
        return Value(-size)
    return Value(size, at=phase)


def _rest(free: FreeVibration) -> Table:
    mounts = free.linear.body.support.mounts
    scale = max((abs(value) for value in free.preloads.values()), default=0.0)
    rows = tuple(
        (
            name,
            Value(force, scale, dimension="force" if mounts[name].axis is None else "torque"),
            "" if free.linear.rest.carries(name, mounts[name]) else say("does not touch"),
        )
        for name, force in free.preloads.items()
    )
    columns = (Column(""), Column(say("force on the support")), Column(""))
    return Table(say("Mounts at rest"), columns, rows)


SHOWS: dict[str, Any] = {"Sweep": sweep_blocks, "FreeVibration": free_blocks}
