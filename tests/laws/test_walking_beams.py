"""`check` and `analyze` say the same of walking beams about where their cranks just turn fully.

Chebyshev's and Hoecken's linkages, of any proportions and with a leg that a guide holds: lengths
lie on rows through the change of Grashof's sum, and through the farthest and nearest that the leg's
upper end comes to the guide's pivot, from far beyond a limit to a rounding away from it.
"""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MotionError
from equipoise.mechanism.parts.machine import Drive, Link, Machine
from equipoise.present.checks import machine_blocks
from support.chosen import EXHAUSTIVE

STEPS = (1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 0.0)
"""Shares of a length by which it is beyond, or short of, its limit."""
FEW, MANY = 30, 2000
ANGLES = np.linspace(0.0, 2 * np.pi, 3601)[:-1]


def four_bar(chance: np.random.Generator, apart: float) -> dict[str, float]:
    """Crank, coupler, rocker and ground, whose Grashof sums differ by a share of the crank."""
    if chance.random() < 0.5:
        actual = {"crank": 1.0, "coupler": 2.5, "rocker": 2.5}  # Chebyshev and Hoecken
        actual["ground"] = 4.0 * (1 - apart) if chance.random() < 0.3 else 2.0
        return actual
    crank, second, third = 1.0, *chance.uniform(1.5, 4.0, 2)
    lengths = [second, third, second + third - crank * (1 + apart)]
    longest = chance.permutation(lengths)
    return dict(zip(("coupler", "rocker", "ground"), longest.tolist(), strict=True)) | {
        "crank": crank
    }


def far_end(lengths: dict[str, float], reach: complex, side: float) -> np.ndarray | None:
    """Places (N,) of a point of the coupler, by the law of cosines; None where it does not turn."""
    crank = lengths["crank"] * np.exp(1j * ANGLES)
    to_pivot = lengths["ground"] - crank
    distance = np.abs(to_pivot)
    cosine = lengths["coupler"] ** 2 + distance**2 - lengths["rocker"] ** 2
    cosine = cosine / (2 * lengths["coupler"] * distance)
    if np.max(np.abs(cosine)) > 1:
        return None
    way = to_pivot / distance * np.exp(1j * side * np.arccos(cosine))
    return np.asarray(crank + reach * way)


def walking_beam(seed: int) -> Machine:
    chance = np.random.default_rng(seed)
    apart = chance.choice([-1.0, 1.0]) * chance.choice(STEPS)
    lengths = four_bar(chance, apart if seed % 2 else 0.3)
    side = chance.choice([-1.0, 1.0])
    reach = lengths["coupler"] * complex(
        2.0, 0.0 if chance.random() < 0.5 else chance.uniform(-0.4, 0.4)
    )
    links = {
        "crank": {"O": 0j, "A": complex(lengths["crank"])},
        "coupler": {"A": 0j, "B": complex(lengths["coupler"]), "P": reach},
        "rocker": {"Q": 0j, "B": complex(lengths["rocker"])},
    }
    frame, assembly = (
        {"O": 0j, "Q": complex(lengths["ground"])},
        {"B": "left" if side > 0 else "right"},
    )
    path = far_end(lengths, reach, side)
    if seed % 2 == 0 and path is not None:
        pivot = complex(*chance.uniform(-6.0, 6.0, 2))
        near, far = np.min(np.abs(path - pivot)), np.max(np.abs(path - pivot))
        if chance.random() < 0.5:
            leg = chance.uniform(0.35, 0.65) * far
            guide = far * (1 + apart) - leg
        else:
            guide = chance.uniform(1.1, 2.0) * far
            leg = guide - near * (1 - apart)
        links |= {"leg": {"P": 0j, "K": complex(leg)}, "guide": {"E": 0j, "K": complex(guide)}}
        frame["E"], assembly["K"] = pivot, chance.choice(["left", "right"])
    return Machine(
        title=f"walking beam {seed}",
        frame={name: (at.real, at.imag) for name, at in frame.items()},
        links={
            name: Link({p: (at.real, at.imag) for p, at in points.items()}, 1.0, (0.0, 0.0), 0.1)
            for name, points in links.items()
        },
        drive=Drive("crank", 10.0),
        assembly=assembly,
    )


def verdict(ask: object, machine: Machine) -> str:
    """What is said of a machine's motion; empty where it is taken."""
    try:
        ask(machine)  # type: ignore[operator]
    except MotionError as error:
        return str(error)
    return ""


def disagreements(seeds: range) -> tuple[list[tuple[int, str, str]], int]:
    """Machines of which the two say something else; and how many turn."""
    actual, turning = [], 0
    for seed in seeds:
        machine = walking_beam(seed)
        checked = verdict(lambda item: [*machine_blocks(item)], machine)
        analyzed = verdict(lambda item: eq.analyze(item).summary, machine)
        turning += not analyzed
        if checked != analyzed:
            actual.append((seed, checked, analyzed))
    return actual, turning


def test_check_and_analyze_agree() -> None:
    actual, turning = disagreements(range(FEW))
    assert not actual
    assert FEW // 5 < turning < FEW - FEW // 5  # both sides of the limits are there


@EXHAUSTIVE
@pytest.mark.parametrize("part", range(10))
def test_check_and_analyze_agree_on_many(part: int) -> None:
    size = MANY // 10
    actual, _ = disagreements(range(FEW + part * size, FEW + (part + 1) * size))
    assert not actual
