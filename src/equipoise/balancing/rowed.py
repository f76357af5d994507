"""Outputs of all rows of linkages together, as signals of the numbers of one.

Rows are equal, so that a change to the linkage is made in each of them; each is ahead by its phase.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.balancing.effects import Effects
from equipoise.balancing.measures import Signal
from equipoise.balancing.multi_row import arm_of, moment_of_row
from equipoise.mechanism.balance_outputs import GAUGES, JOINTS, OF_ROWS

Array = np.ndarray[Any, Any]


def counts_rows(effects: Effects, output: str) -> bool:
    """Whether an output is that of all rows: of machines that have several, but within no row."""
    of_one = output.startswith((GAUGES, JOINTS))
    return output in OF_ROWS or (len(effects.machine.rows) > 1 and not of_one)


def of_all_rows(effects: Effects, output: str, about: str | None = None) -> Signal:
    """An output summed over all rows in their phases."""
    kind, _, axis = output.rpartition(".")
    if axis in {"x", "y"} and kind:
        whole = of_all_rows(effects, kind, about)
        part = np.real if axis == "x" else np.imag
        return Signal(part(whole.start), part(whole.columns), whole.turns)
    first = "frame" if output.startswith("frame") else "shaking"
    one = effects.signal(output if output not in OF_ROWS else "shaking_force")
    force = effects.signal(f"{first}_force")
    total = Signal(0.0 * one.start, 0.0 * one.columns, one.turns)
    if output in OF_ROWS:
        total = Signal(total.start.real, total.columns.real, one.turns)
    for row in effects.machine.rows:
        here = one
        if output.endswith("_moment"):
            arm = arm_of(effects.machine, effects.motion, row, about)
            start = moment_of_row(output, row, arm, force.start, one.start)
            columns = moment_of_row(output, row, arm, force.columns, one.columns)
            here = Signal(start, columns, one.turns)
        total = _added(total, shifted(here, row.phase))
    return total


def _added(one: Signal, other: Signal) -> Signal:
    return Signal(one.start + other.start, one.columns + other.columns, one.turns)


def shifted(signal: Signal, phase: float) -> Signal:
    """The signal ahead by a phase, rad."""
    count = len(signal.start)
    turning = np.exp(1j * phase * np.fft.fftfreq(count, 1 / count) / signal.turns)

    def turned(values: Array) -> Array:
        found: Array = np.fft.ifft(np.fft.fft(values) * turning)
        return found if np.iscomplexobj(values) else found.real

    return Signal(turned(signal.start), turned(signal.columns), signal.turns)
