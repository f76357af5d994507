"""What `equipoise analyze --orders` prints: harmonics, as in Table 4 of Yamashita and others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.signals import Periodic
from equipoise.terminal.tables import Row, angle, number, table

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

TITLES = {
    "mass_center.ax": ("Common centre of mass, acceleration along x", "m/s2"),
    "mass_center.ay": ("Common centre of mass, acceleration along y", "m/s2"),
    "shaking_force.x": ("Shaking force along x", "N"),
    "shaking_force.y": ("Shaking force along y", "N"),
    "shaking_moment": ("Shaking moment", "N m"),
    "drive_torque": ("Drive torque", "N m"),
}


def print_orders(analysis: Analysis, orders: int, zero: float) -> None:
    """A table for each output, up to an order; crank angles count from `zero`, rad."""
    print(analysis.machine.title)
    print("y = sum A_n cos(n theta) + B_n sin(n theta) = sum R_n sin(n theta + phase_n)")
    print(f"theta: crank angle from {angle(zero)} deg")
    for name, (title, unit) in TITLES.items():
        if name in analysis.by_order:
            signal = analysis.by_order[name].shifted(zero)
            header = ("order", f"A {unit}", f"B {unit}", f"R {unit}", "phase deg", f"RMS {unit}")
            print(table(title, header, _rows(signal, orders)))


def _rows(signal: Periodic, orders: int) -> list[Row]:
    scale = 10 * float(np.max(signal.sizes))
    found = []
    for k in range(signal.count_to(orders)):
        value = complex(signal.amplitudes[k])
        size = abs(value)
        silent = size <= 1e-10 * scale
        phase = "" if silent or k == 0 else angle(float(np.angle(1j * value)))
        numbers = (value.real, -value.imag, size)
        rms = number(float(signal.rms_by_order[k]), scale)
        order = f"{float(signal.orders[k]):.4g}"
        found.append((order, *(number(part, scale) for part in numbers), phase, rms))
    return found
