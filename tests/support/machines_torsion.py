"""Machines with torsion springs between links that do not turn on and on against each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations

import numpy as np

import equipoise as eq
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.torsion_springs import TorsionSpring, TorsionTable
from support.poses import Array, Poses

MOST_TURNED = 2.2
"""rad, over which a pair of bodies may swing that gets a spring: loops know less than 154 deg from
its middle, which may lie at either end.
"""


def sprung_by_torsion(machine: Machine, rng: np.random.Generator) -> Machine:
    """Give a machine three torsion springs, of each way in which their law can be told."""
    motion = eq.move(machine, 120)
    angles: dict[str, Array] = {FRAME: np.zeros(len(motion.crank_angle))}
    angles |= {name: link.angle for name, link in motion.links.items()}
    pairs = [pair for pair in combinations(angles, 2)
             if 0.01 < np.ptp(angles[pair[1]] - angles[pair[0]]) < MOST_TURNED]  # fmt: skip
    springs = []
    for kind in range(3 if pairs else 0):
        on, link = pairs[rng.integers(len(pairs))]
        turned = angles[link] - angles[on]
        low, high = float(np.min(turned)), float(np.max(turned))
        springs.append(_spring(kind, link, on, low, high, rng))
    return replace(machine, torsion_springs=tuple(springs))


def _spring(
    kind: int, link: str, on: str, low: float, high: float, rng: np.random.Generator
) -> TorsionSpring:
    size = float(rng.uniform(20, 200))
    if kind == 0:
        angle = float(rng.uniform(low, high))
        preload = float(rng.normal() * size)
        return TorsionSpring(link, on, stiffness=size / (high - low), angle=angle, preload=preload)
    inside = np.sort(rng.uniform(low, high, 3))
    angles = (low + 0.1 * (inside[0] - low), *inside.tolist(), high - 0.1 * (high - inside[2]))
    torques = (*(rng.normal(size=5) * size).tolist(),)
    if kind == 1:
        return TorsionSpring(link, on, angles=angles, torques=torques)
    return TorsionSpring(link, on, table=TorsionTable(angles, torques))


def torsion_on_links(machine: Machine, poses: Poses) -> list[tuple[str, Array]]:
    """Link and torque at every end of a torsion spring on a link."""
    actual = []
    for spring in machine.torsion_springs:
        turned = poses.angle_of(spring.link) - poses.angle_of(spring.on)
        torque = torque_of(spring, turned)
        actual += [(spring.link, torque), (spring.on, -torque)]
    return [(link, torque) for link, torque in actual if link != FRAME]


def torque_of(spring: TorsionSpring, turned: Array) -> Array:
    """Torque on its link at angles of it, counted in whatever turn."""
    if spring.stiffness is not None:
        rows = np.array([[0.0, spring.preload], [1.0, spring.preload - spring.stiffness]])
        rows[:, 0] += spring.angle
        middle = spring.angle
    else:
        table = spring.table
        rows = np.transpose((spring.angles, spring.torques) if table is None
                            else (table.angle, table.torque))  # fmt: skip
        middle = (rows[0, 0] + rows[-1, 0]) / 2
    angle = middle + (turned - middle + np.pi) % (2 * np.pi) - np.pi
    far = np.array([[-10.0], [10.0]])
    first, last = ((b - a)[1] / (b - a)[0] for a, b in (rows[:2], rows[-2:]))
    ends = rows[[0, -1]] + np.hstack([far, far * np.array([[first], [last]])])
    whole = np.vstack([ends[0], rows, ends[1]])
    return np.interp(angle, *whole.T)


def torsion_sprung(
    maker: Callable[[np.random.Generator], object],
) -> Callable[[np.random.Generator], object]:
    """A maker whose machines get torsion springs."""

    def make(rng: np.random.Generator) -> object:
        case = maker(rng)
        return replace(case, machine=sprung_by_torsion(case.machine, rng))  # type: ignore[attr-defined,type-var]

    make.__name__ = f"torsion_{maker.__name__}"
    return make
