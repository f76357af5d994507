"""The exact equations followed in time, from any state."""

from __future__ import annotations

from dataclasses import fields
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import ResponseError
from equipoise.mechanism.linkage import assemble
from equipoise.structures.coupled import Coupled
from equipoise.structures.linkages import Sums

Array = np.ndarray[Any, Any]

KNOTS = 1440
"""Crank angles in a turn between which the linkages' sums are interpolated by cubic splines."""
MOST_EVALUATIONS, TO_SETTLE = 600_000, 60_000
"""Of the equations, in all; and for a guess."""
RELATIVE, ABSOLUTE = 1e-9, 1e-12
SETTLING_TURNS = 40


class Table:
    """The linkages' sums at any crank angle, one at a time, by periodic splines."""

    def __init__(self, system: Coupled) -> None:
        from scipy.interpolate import CubicSpline

        turns = assemble(system.machine).cycle.turns
        s = np.linspace(0.0, 2 * pi * turns, KNOTS * turns + 1)
        found = system.sums(s)
        self.mass = found.mass
        columns: list[Array] = []
        self.complex: list[bool] = []
        for item in fields(Sums)[1:]:
            values = np.broadcast_to(getattr(found, item.name), s.shape)
            self.complex.append(np.iscomplexobj(values))
            columns += [values.real, values.imag] if self.complex[-1] else [values]
        table = np.column_stack(columns)
        table[-1] = table[0]
        self._spline = CubicSpline(s, table, bc_type="periodic")

    def at(self, theta: float) -> Sums:
        values = iter(self._spline(theta).tolist())
        found = [
            np.array(complex(next(values), next(values)) if two else next(values))
            for two in self.complex
        ]
        return Sums(self.mass, *found)


def follow(
    system: Coupled,
    time: Array,
    begin: Array,
    shift: float = 0.0,
    evaluations: int = MOST_EVALUATIONS,
) -> Array:
    """States (D + D + 2, M) at times (M,): displacements, velocities, crank's speed and angle."""
    from scipy.integrate import solve_ivp

    table = Table(system)
    d = len(system.free)
    left = evaluations

    def rates(_: float, y: Array) -> Array:
        nonlocal left
        left -= 1
        if left < 0:
            raise ResponseError(
                f"the motion over {time[-1]:g} s takes more than {evaluations} evaluations to "
                "follow; give a shorter time, or softer mounts with less damping"
            )
        driven = [] if system.torque is None else [y[2 * d], 0.0, shift]
        states = np.array([*y[: 2 * d], *driven])
        found = system.accelerations(table.at(y[2 * d + 1]), states)
        spin_up = 0.0 if system.torque is None else found[d]
        return np.array([*y[d : 2 * d], *found[:d], spin_up, y[2 * d]])

    step = 2 * pi / abs(system.speed) / 24
    done = solve_ivp(
        rates,
        (float(time[0]), float(time[-1])),
        begin,
        "DOP853",
        t_eval=time,
        rtol=RELATIVE,
        atol=ABSOLUTE,
        max_step=step,
    )
    if not done.success or not np.all(np.isfinite(done.y)):
        raise ResponseError(f"the motion cannot be followed beyond {done.t[-1]:g} s: it grows away")
    return np.asarray(done.y)


def settled(system: Coupled, s: Array) -> Array:
    """States at crank angles s (M,) of the last cycle, after many turns from rest."""
    turns = assemble(system.machine).cycle.turns
    cycles = -(-SETTLING_TURNS // turns)
    start = 2 * pi * turns * cycles
    order = np.argsort(s)
    instants = (start + s[order]) / system.speed
    begin = np.zeros(2 * len(system.free) + 2)
    begin[-2] = system.speed
    states = follow(system, np.concatenate([[0.0], np.abs(instants)]), begin, 0.0, TO_SETTLE)
    found = np.empty((2 * len(system.free), len(s)))
    found[:, order] = states[: 2 * len(system.free), 1:]
    return found
