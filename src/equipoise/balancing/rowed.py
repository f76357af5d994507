"""Outputs of all rows of linkages together, as signals of the numbers of one.

Rows are equal, so that a change to the linkage is made in each of them; each is ahead by its phase.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.balancing.effects import Effects
from equipoise.balancing.measures import Signal
from equipoise.mechanism.balance_outputs import GAUGES, JOINTS, OF_ROWS
from equipoise.mechanism.dynamics import place_of
from equipoise.mechanism.kernels import cross

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
        if output == "roll_moment":
            here = _mapped(force, lambda f, z=row.lateral: -z * f.imag)
        elif output == "yaw_moment":
            here = _mapped(force, lambda f, z=row.lateral: z * f.real)
        elif output.endswith("_moment"):
            arm = _arm(effects, complex(*row.offset), about)
            here = _added(one, _mapped(force, lambda f, a=arm: cross(a, f)))
        else:
            here = one
        total = _added(total, shifted(here, row.phase))
    return total


def _arm(effects: Effects, offset: complex, about: str | None) -> complex:
    """From the point about which moments are taken to a row's pivot."""
    pivot = complex(*effects.machine.frame[effects.motion.linkage.pivot])
    return pivot + offset - (pivot if about is None else place_of(effects.machine, about))


def _mapped(signal: Signal, change: Any) -> Signal:
    """A signal of which every value is changed alike, linearly."""
    return Signal(change(signal.start), change(signal.columns), signal.turns)


def _added(one: Signal, other: Signal) -> Signal:
    return Signal(one.start + other.start, one.columns + other.columns, one.turns)


def shifted(signal: Signal, phase: float) -> Signal:
    """The signal ahead by a phase, rad."""
    count = len(signal.start)
    turning = np.exp(1j * phase * np.fft.fftfreq(count, 1 / count) / signal.turns)

    def turned(values: Array) -> Array:
        found: Array = np.fft.ifft(np.fft.fft(values) * turning)
        return found if np.iscomplexobj(values) else found.real

    return _mapped(signal, turned)
