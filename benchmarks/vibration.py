"""Steady vibration, beside the ways in which it is found elsewhere, in one process.

The peers of the exact response solve the same equations of the same machine: shooting with SciPy's
DOP853 (one turn for the state and one for each disturbance, twice), and SciPy's `solve_bvp`.  All
have to agree before any is timed.
"""

from __future__ import annotations

from math import pi

import numpy as np
from scipy.integrate import solve_bvp

import equipoise as eq
from equipoise.vibration.coupled import Coupled, follow
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.linear import Linear
from timing import in_turn, report

MACHINE = eq.load("yamashita-rig")
SPEED = MACHINE.drive.speed
TURN = 2 * pi / SPEED
AGREE = 1e-6
"""Of the largest pitch; the peers are not asked for more."""


def system() -> Coupled:
    """The exact equations, put together anew."""
    linear = Linear.of(MACHINE)
    return Coupled.on_support(linear.body, linear.rest, SPEED)


def collocation() -> float:
    """Pitch at crank angle 0, rad."""
    return float(solve_exact(MACHINE, SPEED, False).states[0, 0])


def shooting() -> float:
    """Pitch at crank angle 0 by Newton's method on the state after one turn."""
    equations, start = system(), np.zeros(2)

    def after(state: np.ndarray) -> np.ndarray:
        ends = follow(equations, np.array([0.0, TURN]), np.array([*state, SPEED, 0.0]))
        return ends[:2, -1]

    for _ in range(2):
        reached = after(start)
        steps = np.diag([1e-5, 1e-4])
        carry = np.column_stack([(after(start + s) - reached) / s.sum() for s in steps])
        start = start + np.linalg.solve(np.eye(2) - carry, reached - start)
    return float(start[0])


def boundary_values() -> float:
    """Pitch at crank angle 0 by SciPy's boundary value solver."""
    equations = system()
    mesh = np.linspace(0, 2 * pi, 61)
    found = solve_bvp(
        lambda s, y: equations.rates(s)(y),
        lambda begin, end: end - begin,
        mesh,
        np.zeros((2, len(mesh))),
        tol=1e-7,
        max_nodes=20_000,
    )
    return float(found.y[0, 0])


def main() -> None:
    """Print both comparisons."""
    exact = {
        "shooting, DOP853": shooting,
        "SciPy solve_bvp": boundary_values,
        "collocation against crank angle": collocation,
    }
    values = {name: task() for name, task in exact.items()}
    right = values["collocation against crank angle"]
    for name, value in values.items():
        if abs(value - right) > AGREE * 0.004:
            raise SystemExit(f"{name} gives {value}, not {right}")
    print("steady state of yamashita-rig by the exact equations")
    report(in_turn(exact, 10), "shooting, DOP853", 1e-3, "ms")
    print("\nresponses at 200 speeds and those about resonances, in ms")
    sweeps = {
        f"sweep, model {model}": lambda model=model: eq.vibration.sweep_speed(
            MACHINE, 2.0, 30.0, model
        )
        for model in ("linear", "exact")
    }
    report(in_turn(sweeps, 3), "sweep, model linear", 1e-3, "ms")


if __name__ == "__main__":
    main()
