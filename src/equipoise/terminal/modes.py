"""What `equipoise modes` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.terminal.tables import PER_RPM, number, table
from equipoise.terminal.vibration import modes_table
from equipoise.vibration.response import EQUATIONS

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration

ORDERS = (1, 2, 3, 4)


def print_modes(free: FreeVibration) -> None:
    """Natural frequencies, damping, shapes, and the crank speeds that meet them."""
    step = free.linear.excitation.step
    print(free.machine.title)
    where = "spread as in the mean of a turn" if step == "moment" else "at the drive's pivot"
    print(f"mass of the linkages {where}, as in the model {step}, {EQUATIONS[step]}")
    print(modes_table(free.modes))
    print(_speeds(free))
    print(_shapes(free))
    print(_rest(free))


def _speeds(free: FreeVibration) -> str:
    rows = [
        (
            str(count),
            *(number(mode.natural_frequency / order / PER_RPM) for order in ORDERS),
        )
        for count, mode in enumerate(free.modes, 1)
        if mode.swings
    ]
    if not rows:
        return "\nno mode swings, so no crank speed meets one"
    header = ("mode", *(f"order {order}" for order in ORDERS))
    return table("Crank speeds that meet a mode, rpm", header, rows)


def _shapes(free: FreeVibration) -> str:
    """Each mode in the coordinates and at the gauges; the largest coordinate is 1."""
    shapes = [
        (str(count), *map(_part, mode.shape.tolist())) for count, mode in enumerate(free.modes, 1)
    ]
    gauges = [
        (str(count), *(_part(complex(values[count - 1])) for values in free.gauges.values()))
        for count in range(1, len(free.modes) + 1)
    ]
    title = "Shapes; displacements in m beside rotations in rad, amplitude and phase in deg"
    first = table(title, ("mode", *free.coordinates), shapes)
    return first + "\n" + table("Shapes at the gauges", ("mode", *free.gauges), gauges)


def _part(value: complex) -> str:
    size = abs(value)
    if size < 1e-6:
        return "0"
    phase = float(np.degrees(np.angle(value)))
    if abs(phase) < 0.05:
        return number(size)
    return f"{number(size)} at {phase:.1f}" if abs(abs(phase) - 180) > 0.05 else f"-{number(size)}"


def _rest(free: FreeVibration) -> str:
    mounts = free.linear.body.support.mounts
    rows = []
    for name, force in free.preloads.items():
        unit = "N" if mounts[name].axis is None else "N m"
        rest = "does not touch" if not free.linear.rest.carries(name, mounts[name]) else ""
        scale = max(abs(value) for value in free.preloads.values())
        rows.append((name, number(force, scale), unit, rest))
    return table("Mounts at rest", ("", "force on the support", "", ""), rows)
