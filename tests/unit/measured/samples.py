"""Records of free decays, and a second way to their motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import equipoise as eq

Array = np.ndarray[Any, Any]

OMEGA = 12.4


def simulated(
    duration: float = 5.0,
    count: int = 1000,
    ratio: float = 0.03,
    coulomb: float = 0.02,
    **more: Any,
) -> eq.measured.Record:
    """A decay from 1 m; without friction about 60 samples in a half-swing."""
    time = np.linspace(0.0, duration, count)
    return eq.measured.simulate_decay(
        time, natural_frequency=OMEGA, damping_ratio=ratio, coulomb=coulomb, **more
    )


def held(time: Array, release: float, **more: Any) -> Array:
    """Displacement that stays at 1 m until it is released."""
    values = {"natural_frequency": OMEGA, "damping_ratio": 0.03, "coulomb": 0.02, **more}
    free = time > release
    moved = np.ones(len(time))
    since = np.concatenate([[release], time[free]])
    moved[free] = eq.measured.simulate_decay(since, **values).displacement[1:]
    return moved


def noisy(time: Array, values: Array, noise: float = 0.01, seed: int = 1) -> eq.measured.Record:
    added = np.random.default_rng(seed).normal(0.0, noise, len(time))
    return eq.measured.Record(time, values + added)


def integrated(
    time: Array, omega: float, ratio: float, coulomb: float, start: float, velocity: float
) -> Array:
    """The equation of motion by steps of an integrator, a half-swing at a time.

    It knows neither half-period nor line: a half-swing ends where the velocity passes zero, and the
    motion where the spring then pulls less than the friction.
    """
    at, state = float(time[0]), [start, velocity]
    moved = np.full(len(time), np.nan)
    while True:
        sense = np.sign(state[1]) if state[1] else -np.sign(state[0])
        if not state[1] and abs(state[0]) <= coulomb:
            moved[time >= at] = state[0]
            return moved

        def pull(_: float, y: Array, sense: float = sense) -> list[float]:
            spring = -(omega**2) * (y[0] + sense * coulomb)
            return [y[1], spring - 2 * ratio * omega * y[1]]

        def halt(_: float, y: Array, sense: float = sense) -> float:
            return float(sense * y[1])

        halt.terminal, halt.direction = True, -1  # type: ignore[attr-defined]
        end = at + 4 / omega
        done = solve_ivp(
            pull, (at, end), state, "DOP853", dense_output=True, events=halt, rtol=1e-11, atol=1e-13
        )
        stop = float(done.t[-1])
        part = (time >= at) & (time <= stop)
        moved[part] = done.sol(time[part])[0]
        if stop >= time[-1]:
            return moved
        at, state = stop, [float(done.y[0, -1]), 0.0]
