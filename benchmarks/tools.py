"""A brush cutter with six stations, beside the ways in which it is computed elsewhere.

Peers divide the shaft into 48 elements.  ROSS factors and inverts the matrix of all 294 degrees of
freedom, stretching and twisting among them, at each speed, and keeps displacement, velocity and
acceleration of each under a force on each, 2 GB; it is built beforehand, once for each call because
it remembers what it has computed.  The same elements in bending alone have 98 degrees of freedom a
plane: as full matrices at all speeds at once by NumPy, and as bands by LAPACK's gbsv.

All have to agree before any is timed.  Cubic elements of Euler-Bernoulli's beam are wrong as the
fourth power of their length; those of Timoshenko's beam in ROSS have one shear strain along their
length, and are wrong as its square.  A resonance of 1.4 % damping near 7800 rpm magnifies that.
What 12 and 24 elements give tells how much it is, and takes it out by Richardson's extrapolation.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import pi
from pathlib import Path
from statistics import median

import numpy as np
from scipy.linalg import eig, eigh
from scipy.linalg.lapack import zgbsv
from scipy.optimize import differential_evolution

from equipoise.handheld.design import design_tool
from equipoise.handheld.design_plan import DesignLimit, DesignPlan, DesignVariable
from equipoise.handheld.frequencies import natural_frequencies
from equipoise.handheld.hand_exposure import grips
from equipoise.handheld.model import Tool, changed
from equipoise.handheld.modes import vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.sweep import transmit
from peers import optional
from timing import in_turn, report

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from support.six_stations import (
    ELEMENTS,
    ENGINE,
    HANDLE,
    LENGTH,
    MASS,
    POWERS,
    STIFFNESS,
    TOOLS,
    UNBALANCE,
    mesh,
)

ross_shaft = optional("support.ross_shaft", "ross")

SPEEDS = np.linspace(1000.0, 9000.0, 500) * pi / 30
ROUGH, AGREE = {"euler-bernoulli": 1e-4, "timoshenko": 3e-3}, 2e-5
"""Of the largest displacement, with 48 elements, and with their error taken out."""
FREQUENCIES = 3e-5
"""Share to which natural frequencies and eigenvalues agree: the tenth has 15 elements a wave."""
DESIGN = DesignPlan(
    (600.0, 800.0),
    (
        DesignVariable("belt", "position", 0.11, 0.35),
        DesignVariable("weight", "position", 0.5, 1.4),
        DesignVariable("weight", "mass", 0.05, 0.6),
    ),
    (DesignLimit("added_mass", 0.3),),
)


TOOL = TOOLS["euler-bernoulli"]


def ours(tool: Tool) -> np.ndarray:
    """Displacement (2, S) of the handle, m."""
    return respond_tool(tool, SPEEDS).displacement(HANDLE)[:, 0]


# -- peers -----------------------------------------------------------------------------------------


class Elements:
    """Stiffness, damping and mass of Euler-Bernoulli's beam, (2, D, D): both planes in bending."""

    def __init__(self) -> None:
        lengths, self.nodes = mesh(ELEMENTS)
        self.size = 2 * len(lengths) + 2
        self.k, self.c, self.m = (np.zeros((2, self.size, self.size)) for _ in range(3))
        for number, length in enumerate(lengths):
            here = slice(2 * number, 2 * number + 4)
            stiffness, mass = element(length)
            self.k[:, here, here] += stiffness
            self.m[:, here, here] += mass
        for station in TOOL.stations:
            at = 2 * self.nodes[station.name]
            hand, harness = station.hand, station.harness
            self.m[:, at, at] += station.mass + (hand.hands * hand.mass if hand else 0.0)
            self.m[:, at + 1, at + 1] += station.inertia
            for count, part in ((hand.hands if hand else 0, hand), (1, harness)):
                if part is not None:
                    self.k[:, at, at] += count * np.array(part.stiffness)
                    self.c[:, at, at] += count * np.array(part.damping)
        self.load = np.zeros((2, len(SPEEDS), self.size), complex)
        force = UNBALANCE * np.array([[1], [-1j]]) * SPEEDS**2
        self.load[:, :, 2 * self.nodes[ENGINE]] = force
        self.banded = [bands(matrix) for matrix in (self.k, self.c, self.m)]

    @staticmethod
    def at_speeds(k: np.ndarray, c: np.ndarray, m: np.ndarray) -> np.ndarray:
        """Dynamic stiffness (2, S, ...)."""
        s = 1j * SPEEDS[:, None, None]
        return k[:, None] + s * c[:, None] + s**2 * m[:, None]

    def full(self) -> np.ndarray:
        """Displacement (2, S) of the handle by full matrices."""
        dynamic = self.at_speeds(self.k, self.c, self.m)
        return np.linalg.solve(dynamic, self.load[..., None])[..., 2 * self.nodes[HANDLE], 0]

    def by_bands(self) -> np.ndarray:
        """The same by band matrices."""
        dynamic, at = self.at_speeds(*self.banded), 2 * self.nodes[HANDLE]
        found = np.empty((2, len(SPEEDS)), complex)
        for index in np.ndindex(found.shape):
            found[index] = zgbsv(3, 3, dynamic[index], self.load[index])[2][at]
        return found

    def natural(self, number: int) -> np.ndarray:
        """Natural frequencies (2, number), rad/s."""
        return np.sqrt([
            eigh(k, m, eigvals_only=True, subset_by_index=[0, number - 1])
            for k, m in zip(self.k, self.m, strict=True)
        ])  # fmt: skip

    def damped(self) -> list[np.ndarray]:
        """Eigenvalues with damping of both planes, 1/s; their shapes are found too."""
        one, none = np.eye(self.size), np.zeros((self.size, self.size))
        found = []
        for k, c, m in zip(self.k, self.c, self.m, strict=True):
            flow = np.block([[none, one], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]])
            found.append(eig(flow)[0])
        return found


def element(length: float) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and consistent mass of a cubic element."""
    h, square = length, length**2
    stiffness = np.array([
        [12, 6 * h, -12, 6 * h],
        [6 * h, 4 * square, -6 * h, 2 * square],
        [-12, -6 * h, 12, -6 * h],
        [6 * h, 2 * square, -6 * h, 4 * square],
    ])  # fmt: skip
    mass = np.array([
        [156, 22 * h, 54, -13 * h],
        [22 * h, 4 * square, 13 * h, -3 * square],
        [54, 13 * h, 156, -22 * h],
        [-13 * h, -3 * square, -22 * h, 4 * square],
    ])  # fmt: skip
    return stiffness * STIFFNESS / h**3, mass * MASS / LENGTH * h / 420


def bands(matrices: np.ndarray) -> np.ndarray:
    """The three diagonals on each side of matrices (2, D, D), as LAPACK has them, (2, 10, D)."""
    found = np.zeros((len(matrices), 10, matrices.shape[-1]))
    rows, columns = np.nonzero(np.any(matrices, axis=0))
    found[:, 6 + rows - columns, columns] = matrices[:, rows, columns]
    return found


def rotors(theory: str, count: int, number: int) -> Callable[[], np.ndarray]:
    """Displacement (2, S) of the handle by ROSS, so often as rotors are built for it."""
    lengths, nodes = mesh(count)
    ready = [ross_shaft.rotor(TOOLS[theory], lengths, nodes) for _ in range(number)]
    return lambda: ross_shaft.response(ready.pop(), nodes[ENGINE], UNBALANCE, SPEEDS, nodes[HANDLE])


# -- comparisons -----------------------------------------------------------------------------------


def difference(name: str, peer: np.ndarray, theory: str) -> float:
    """Print how far a peer's displacement of the handle is from ours; returns the largest share."""
    mine = ours(TOOLS[theory])
    share = float(np.max(np.abs(peer - mine)) / np.max(np.abs(mine)))
    size = np.max(np.abs(np.abs(peer) / np.abs(mine) - 1))
    phase = np.max(np.abs(np.angle(peer / mine)))
    print(f"{name:<36} {share:9.1e}   {size:9.1e}   {phase:9.1e} rad")
    return share


def demand(name: str, found: float, limit: float) -> None:
    """Stop where two that should be the same are not."""
    if not found <= limit:
        raise SystemExit(f"{name}: {found:.2g} apart, more than {limit:g}")


def compare(beam: Elements) -> None:
    """Print how well all agree on the displacement of the handle."""
    print("the handle's displacement in both planes, beside Equipoise: largest difference")
    print(f"{'':<36} {'of largest':>9}   {'amplitude':>9}   {'phase':>9}")
    first = next(iter(POWERS))
    for name, found in (("full", beam.full()), ("bands", beam.by_bands())):
        share = difference(f"{ELEMENTS} elements, {name}, euler-bernoulli", found, first)
        demand(name, share, ROUGH[first])
    if ross_shaft is None:
        return
    for theory, power in POWERS.items():
        found = []
        for count in (ELEMENTS // 4, ELEMENTS // 2, ELEMENTS):
            found.append(rotors(theory, count, 1)())
            gc.collect()  # 2 GB
            share = difference(f"ROSS, {count} elements, {theory}", found[-1], theory)
        demand(theory, share, ROUGH[theory])
        for order in (power, power + 2):
            found = [fine + (fine - one) / (2**order - 1) for one, fine in pairwise(found)]
        share = difference("    with the error of their length out", found[0], theory)
        demand(theory, share, AGREE)


def compare_modes(beam: Elements) -> None:
    """Natural frequencies and eigenvalues must be the same, too."""
    for number in (5, 10):
        right = beam.natural(number)
        apart = np.max(np.abs(natural_frequencies(TOOL, number) / right - 1))
        demand(f"{number} natural frequencies", float(apart), FREQUENCIES)
    for plane, right in zip(vibrate_tool(TOOL, 6).planes, beam.damped(), strict=True):
        for mode in plane.damped:
            apart = np.min(np.abs(right - mode.eigenvalue)) / abs(mode.eigenvalue)
            demand(f"eigenvalue {mode.eigenvalue:.6g}", float(apart), FREQUENCIES)


def worst(values: Sequence[float], speeds: np.ndarray) -> float:
    """RMS over the band of the worst hand's weighted acceleration, of a changed tool, m/s2."""
    tool = TOOL
    for one, value in zip(DESIGN.variables, values, strict=True):
        tool = changed(tool, one.station, one.key, value)
    weights = np.ones(len(speeds))
    weights[[0, -1]] = 0.5
    felt = grips(respond_tool(tool, speeds)).values()
    return float(np.sqrt(max(weights @ grip.a_hv**2 / weights.sum() for grip in felt)))


def evolved() -> np.ndarray:
    """The design by differential evolution over whole responses at 81 speeds, as ours has them."""
    limits = [(one.low, one.high) for one in DESIGN.variables]
    own = TOOL.station("weight").mass + DESIGN.limits[0].at_most
    limits[2] = (limits[2][0], min(limits[2][1], own))
    speeds = np.linspace(*DESIGN.speeds, 81)
    return differential_evolution(worst, limits, (speeds,), seed=1, tol=1e-6, polish=False).x


def designed() -> np.ndarray:
    """The design by Equipoise."""
    return np.array([one.after for one in design_tool(replace(TOOL, design=DESIGN)).variables])


def best_of(times: Mapping[str, list[float]], name: str) -> None:
    """Print the absolute time of a task, beside what is asked for."""
    took = [1e3 * one for one in times[name]]
    print(f"{name}: best {min(took):.3f} ms, median {median(took):.3f} ms; asked for: under 5 ms")


def main() -> None:
    """Print the comparisons."""
    beam, rounds = Elements(), 3
    compare(beam)
    compare_modes(beam)
    own = {f"equipoise, {theory}": lambda t=tool: ours(t) for theory, tool in TOOLS.items()}
    first, last = own
    if ross_shaft is not None:
        print(f"\nunbalance response at {len(SPEEDS)} speeds; ROSS {ross_shaft.VERSION}")
        places = np.cumsum([0.0, *mesh(ELEMENTS)[0]]).clip(0, LENGTH)
        tasks = {
            f"ROSS, {ELEMENTS} elements": rotors("euler-bernoulli", ELEMENTS, rounds + 1),
            "clearing up": gc.collect,
            "equipoise, at all 49 nodes": lambda: respond_tool(TOOL, SPEEDS).line(places),
            first: own[first],
        }
        times = in_turn(tasks, rounds)
        del times["clearing up"]
        report(times, first, 1e-3, "ms")
    print(f"\nthe same beside {ELEMENTS} elements in bending alone, both planes")
    peers = {"full, np.linalg.solve": beam.full, "bands, LAPACK gbsv": beam.by_bands}
    times = in_turn(peers | own, 15)
    report(times, first, 1e-3, "ms")
    best_of(times, first)
    best_of(times, last)
    for number in (5, 10):
        print(f"\n{number} natural frequencies in each plane")
        tasks = {
            "scipy eigh": lambda n=number: beam.natural(n),
            "natural_frequencies": lambda n=number: natural_frequencies(TOOL, n),
        }
        report(in_turn(tasks, 10), "scipy eigh", 1e-3, "ms")
    print("\nsix modes in each plane with damping, and their shapes")
    tasks = {"scipy eig, all modes": beam.damped, "vibrate_tool": lambda: vibrate_tool(TOOL, 6)}
    report(in_turn(tasks, 5), "scipy eig, all modes", 1e-3, "ms")
    print("\nforce on hands and belt at 500 speeds, and the quiet speeds")
    tasks = {first: own[first], "transmit": lambda: transmit(TOOL, SPEEDS)}
    report(in_turn(tasks, 15), first, 1e-3, "ms")
    fine = np.linspace(*DESIGN.speeds, 2001)
    felt = [worst(x, fine) for x in (evolved(), designed())]
    print(
        f"\ndesign of {len(DESIGN.variables)} numbers: {felt[0]:.4f} m/s2 by differential "
        f"evolution, {felt[1]:.4f} m/s2 by design_tool"
    )
    tasks = {"differential evolution": evolved, "design_tool": designed}
    report(in_turn(tasks, 2), "differential evolution", 1.0, "s")


if __name__ == "__main__":
    main()
