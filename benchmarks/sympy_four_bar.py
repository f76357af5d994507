"""The objective of a four-bar in closed form: derived by SymPy, run on arrays by NumPy.

Where coupler and rocker meet is one root; everything else follows from it by differentiation, and
common subexpressions are taken out.  Cosine and sine of the crank angle are handed over, and
numbers that do not vary are numbers in the code.  Written with `atan2` and `acos`, as in
``analysis.py``, the same takes a little longer.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np
import sympy as sp

from equipoise.mechanism.parts.machine import Machine


class Form:
    """The closed form of a four-bar with crank AB, coupler BC and rocker DC.

    paths : of the numbers that vary: lengths of links, their masses.
    """

    def __init__(self, machine: Machine, paths: Sequence[str], angles: int) -> None:
        numbers = [sp.Symbol(f"x{k}", real=True) for k in range(len(paths))]
        cos, sin = sp.symbols("cos_theta sin_theta", real=True)
        outputs = _outputs(machine, dict(zip(paths, numbers, strict=True)), cos, sin)
        self.compiled = sp.lambdify((*numbers, cos, sin), outputs, "numpy", cse=True)
        theta = np.arange(angles) * (2 * np.pi / angles)
        self.cos, self.sin, self.angles = np.cos(theta), np.sin(theta), angles

    def __call__(self, values: np.ndarray, at_once: int) -> np.ndarray:
        """RMS (P, 3) of vertical shaking force, shaking moment and drive torque of designs (P, d).

        at_once : designs of one call.
        """
        found = np.empty((len(values), 3))
        for begin in range(0, len(values), at_once):
            some = slice(begin, begin + at_once)
            columns = [column[:, None] for column in values[some].T]
            for k, signal in enumerate(self.compiled(*columns, self.cos, self.sin)):
                found[some, k] = np.sqrt(np.einsum("ij,ij->i", signal, signal) / self.angles)
        return found


def _outputs(
    machine: Machine, varied: dict[str, sp.Symbol], cos: sp.Symbol, sin: sp.Symbol
) -> list[sp.Expr]:
    """Vertical shaking force, shaking moment and drive torque."""
    theta = sp.Symbol("theta", real=True)
    turn = {"crank": _vector(sp.cos(theta), sp.sin(theta))}

    def number(path: str, value: float) -> sp.Expr:
        return varied.get(path, sp.Float(value))

    def length(link: str, point: str) -> sp.Expr:
        return number(f"links.{link}.points.{point}.x", machine.links[link].points[point][0])

    b, c, d = length("crank", "B"), length("coupler", "C"), length("rocker", "C")
    pivot = _vector(*machine.frame["D"])
    start = {"crank": _vector(0, 0), "coupler": b * turn["crank"], "rocker": pivot}
    line = pivot - start["coupler"]
    square = line.dot(line)
    along = (square + c**2 - d**2) / 2
    side = 1 if machine.assembly["C"] == "left" else -1
    across = side * sp.sqrt(c**2 * square - along**2)
    to_pin = (along * line + across * _vector(-line[1], line[0])) / square
    turn["coupler"], turn["rocker"] = to_pin / c, (to_pin - line) / d
    momentum, spin, kinetic, potential = _vector(0, 0), 0, 0, 0
    for name, link in machine.links.items():
        x, y = link.center_of_mass
        mass = number(f"links.{name}.mass", link.mass)
        u = turn[name]
        place = start[name] + x * u + y * _vector(-u[1], u[0])
        rate = place.diff(theta)
        turning = u[0] * u[1].diff(theta) - u[1] * u[0].diff(theta)
        momentum += mass * rate
        spin += mass * (place[0] * rate[1] - place[1] * rate[0]) + link.inertia * turning
        kinetic += (mass * rate.dot(rate) + link.inertia * turning**2) / 2
        potential += mass * hypot(*machine.gravity) * place[1]
    speed2 = machine.drive.speed**2
    outputs = [
        -momentum[1].diff(theta) * speed2,
        -sp.diff(spin, theta) * speed2,
        sp.diff(kinetic, theta) * speed2 + sp.diff(potential, theta),
    ]
    return [found.subs({sp.cos(theta): cos, sp.sin(theta): sin}) for found in outputs]


def _vector(x: sp.Expr, y: sp.Expr) -> sp.Matrix:
    return sp.Matrix([x, y])
