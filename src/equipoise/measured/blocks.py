"""What a free decay shows: both methods side by side, and what deserves a second look."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, log10
from typing import TYPE_CHECKING, Any

from equipoise.i18n import say, to_say
from equipoise.quantities import in_unit, number
from equipoise.results.blocks import Block, Cell, Column, Notes, Span, Table, Text, Value

if TYPE_CHECKING:
    from equipoise.measured.decay import Decay
    from equipoise.measured.estimate import Quantity
    from equipoise.measured.record import Kind

SHOWN: dict[Kind, str] = {"length": "mm", "angle": "deg"}
"""Unit of displacements."""
ALWAYS = {
    "damped_frequency": (to_say("damped frequency"), "Hz"),
    "natural_frequency": (to_say("natural frequency"), "Hz"),
    "natural_angular_frequency": (to_say("natural angular frequency"), "rad/s"),
    "damping_ratio": (to_say("damping ratio"), ""),
    "logarithmic_decrement": (to_say("logarithmic decrement"), ""),
}
BY_STIFFNESS: dict[Kind, dict[str, tuple[str, str]]] = {
    "length": {
        "mass": (to_say("mass"), "kg"),
        "viscous_damping": (to_say("viscous damping"), "N s/m"),
        "coulomb_force": (to_say("Coulomb friction"), "N"),
    },
    "angle": {
        "inertia": (to_say("moment of inertia"), "kg m^2"),
        "viscous_damping": (to_say("viscous damping"), "N m s/rad"),
        "coulomb_torque": (to_say("Coulomb friction"), "N m"),
    },
}
"""What a stiffness adds: text and unit by name."""
MOST_DIGITS = 7
"""Behind the decimal point."""


def decay_blocks(decay: Decay) -> Iterator[Block]:
    """The record, the line of half-swings, and every figure by both methods."""
    unit = SHOWN[decay.kind]
    scale = in_unit(unit).factor
    record, turns = decay.record, decay.turns
    first, last = (number(scale * height) for height in (turns.heights[0], turns.heights[-1]))
    yield Text(
        say(
            "{count} samples over {time} s, noise {noise} {unit}; {swings} half-swings from "
            "{first} to {last} {unit}",
            count=len(record.time),
            time=number(record.duration),
            noise=number(scale * turns.noise),
            unit=unit,
            swings=len(turns.heights),
            first=first,
            last=last,
        )
    )
    cut = decay.line["intercept"].value * scale
    yield Text(
        say(
            "line of half-swings: next = {slope} height {sign} {cut} {unit}",
            slope=number(decay.line["slope"].value),
            sign="-" if cut < 0 else "+",
            cut=number(abs(cut)),
            unit=unit,
        )
    )
    interval = say("{share} % interval", share=f"{100 * decay.confidence:g}")
    labels = ("", say("half-swings"), interval, say("whole record"), interval)
    title = say("Free decay, by the line of half-swings and by a fit of the record")
    yield Table(title, tuple(map(Column, labels)), tuple(_rows(decay, unit, scale)))
    if decay.notes:
        yield Notes(decay.notes)


def _rows(decay: Decay, unit: str, scale: float) -> Iterator[tuple[Cell, ...]]:
    rows = {name: (*row, 1.0) for name, row in ALWAYS.items()}
    rows["coulomb_displacement"] = (to_say("Coulomb friction over stiffness"), unit, scale)
    if decay.stiffness is not None:
        rows |= {name: (*row, 1.0) for name, row in BY_STIFFNESS[decay.kind].items()}
    for name, (text, own, factor) in rows.items():
        label = say(", ").join(filter(None, (say(text), own)))
        yield label, *_cells(decay.by_line[name], factor), *_cells(decay.by_record[name], factor)


def _cells(quantity: Quantity, scale: float) -> tuple[Cell, Cell]:
    """A value and its interval, with as many digits as make two of half the interval."""
    value, low, high = quantity.value, quantity.low, quantity.high
    if low is None or high is None:
        return Value(scale * value), say("none")
    half, largest = scale * (high - low) / 2, scale * max(abs(low), abs(high))
    digits = 1 - floor(log10(half)) if half > 0 else MOST_DIGITS + 1
    after = None if digits > MOST_DIGITS or largest >= 1e6 else max(digits, 0)
    interval = Span(scale * low, scale * high, largest, after=after)
    return Value(scale * value, largest, after=after), interval


SHOWS: dict[str, Any] = {"Decay": decay_blocks}
