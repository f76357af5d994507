"""What `equipoise decay` prints."""

from __future__ import annotations

from math import floor, log10, pi
from typing import TYPE_CHECKING

from equipoise.terminal.tables import Row, number, table

if TYPE_CHECKING:
    from equipoise.measured.decay import Decay
    from equipoise.measured.estimate import Quantity
    from equipoise.measured.record import Kind

SHOWN: dict[Kind, tuple[str, float]] = {"length": ("mm", 1e3), "angle": ("deg", 180 / pi)}
"""Unit of displacements, and how many of it make the SI unit."""

ROWS: dict[Kind, tuple[tuple[str, str, str], ...]] = {
    "length": (
        ("mass", "kg", "mass"),
        ("viscous damping", "N s/m", "viscous_damping"),
        ("Coulomb friction", "N", "coulomb_force"),
    ),
    "angle": (
        ("moment of inertia", "kg m^2", "inertia"),
        ("viscous damping", "N m s/rad", "viscous_damping"),
        ("Coulomb friction", "N m", "coulomb_torque"),
    ),
}
"""Text, unit and name of what a stiffness adds."""


MOST_DIGITS = 7
"""Behind the decimal point."""


def print_decay(decay: Decay, title: str) -> None:
    """Both methods side by side, and what deserves a second look."""
    from equipoise.schema.files import printable

    print(printable(title))
    for line in _heading(decay):
        print(line)
    percent = f"{100 * decay.confidence:g} % interval"
    header = ("", "half-swings", percent, "whole record", percent)
    print(
        table(
            "Free decay, by the line of half-swings and by a fit of the record",
            header,
            _rows(decay),
        )
    )
    for note in decay.notes:
        print(f"\nnote: {note}")


def _heading(decay: Decay) -> list[str]:
    unit, scale = SHOWN[decay.kind]
    record, turns = decay.record, decay.turns
    heights = [number(scale * height) for height in (turns.heights[0], turns.heights[-1])]
    line = {name: number(quantity.value) for name, quantity in decay.line.items()}
    cut = decay.line["intercept"].value * scale
    sign = "-" if cut < 0 else "+"
    return [
        f"{len(record.time)} samples over {number(record.duration)} s, noise "
        f"{number(scale * turns.noise)} {unit}; {len(turns.heights)} half-swings from "
        f"{heights[0]} to {heights[1]} {unit}",
        f"line of half-swings: next = {line['slope']} height {sign} {number(abs(cut))} {unit}",
    ]


def _rows(decay: Decay) -> list[Row]:
    unit, scale = SHOWN[decay.kind]
    rows: list[tuple[str, str, str, float]] = [
        ("damped frequency", "Hz", "damped_frequency", 1.0),
        ("natural frequency", "Hz", "natural_frequency", 1.0),
        ("natural angular frequency", "rad/s", "natural_angular_frequency", 1.0),
        ("damping ratio", "", "damping_ratio", 1.0),
        ("logarithmic decrement", "", "logarithmic_decrement", 1.0),
        ("Coulomb friction over stiffness", unit, "coulomb_displacement", scale),
    ]
    if decay.stiffness is not None:
        rows += [(*row, 1.0) for row in ROWS[decay.kind]]
    return [
        (
            f"{text} {unit}".strip(),
            *_cells(decay.by_line[name], scale),
            *_cells(decay.by_record[name], scale),
        )
        for text, unit, name, scale in rows
    ]


def _cells(quantity: Quantity, scale: float) -> tuple[str, str]:
    """A value and its interval, with as many digits as make two of half the interval."""
    value, low, high = quantity.value, quantity.low, quantity.high
    if low is None or high is None:
        return number(scale * value), "none"
    half, largest = scale * (high - low) / 2, scale * max(abs(low), abs(high))
    digits = 1 - floor(log10(half)) if half > 0 else MOST_DIGITS + 1
    if digits > MOST_DIGITS or largest >= 1e6:
        parts = [number(scale * part, largest) for part in (value, low, high)]
    else:
        parts = [f"{scale * part:.{max(digits, 0)}f}" for part in (value, low, high)]
    return parts[0], f"{parts[1]} to {parts[2]}"
