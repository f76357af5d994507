"""Analyses under test: random machines and bundled examples, each computed once a session."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError
from equipoise.mechanism.parts.field import PlantingArm, Soil, SoilTable
from equipoise.mechanism.parts.machine import Machine
from support import machines_cams, machines_strokes
from support.chosen import few
from support.loads import loaded_long, springs_on_links
from support.machines import KINDS, Case, make
from support.machines_planes import set_apart
from support.machines_redundant import REDUNDANT
from support.poses import Array, Poses, from_motion

ANGLES = 0.0173 + np.linspace(0, 2 * np.pi, 24, endpoint=False)
"""Crank angles of every comparison, off the round numbers at which loads may begin or end."""

EXAMPLES = sorted(eq.examples("linkage"))
RANDOM = [f"{kind}:{seed}" for kind in (*KINDS, *REDUNDANT) for seed in range(10)]
PLANTED = [f"{kind} in soil:{seed}" for kind in KINDS for seed in range(2)]
APART = [f"{kind} apart:{seed}" for kind in KINDS for seed in range(2)]
APART += [name.replace(":", " apart:") for name in machines_strokes.PUSHED]
CAMMED = [f"{kind}:{seed}" for kind in machines_cams.ALL for seed in range(2)]
LONG = [f"{kind} long:{seed}" for kind in ("crank_rocker", "quick_return") for seed in range(4)]
every_subject = pytest.mark.parametrize("name", [*EXAMPLES, *RANDOM, *PLANTED, *LONG])
"""Bundled examples, and random machines by kind and seed, also with a point in the soil, or a load
over several turns."""
every_followed = pytest.mark.parametrize("name", [*machines_strokes.PUSHED, *CAMMED])
"""Random machines that are pushed, and such with cams."""
SLOW = {"pushed arm apart:0", "pushed five-bar apart:0"}
"""Before a release only: with all links in one plane they are among `every_followed`."""
every_apart = pytest.mark.parametrize("name", few(APART, {*APART} - SLOW))
"""Random machines whose links lie beside each other."""


@dataclass(frozen=True)
class Subject:
    """A machine, what Equipoise says about it, and the poses of its motion."""

    machine: Machine
    motion: Any
    analysis: Any
    case: Case | None = None

    @property
    def poses(self) -> Poses:
        return from_motion(self.machine, self.motion)

    @property
    def forces(self) -> Any:
        """The forces, or a skipped test for a model without masses."""
        try:
            return self.analysis.forces
        except MassError as error:
            pytest.skip(str(error))


def analysed(machine: Machine, case: Case | None = None) -> Subject:
    """Analyse a machine at the crank angles of the comparison, in all turns of tables of loads."""
    tables = (load.table.crank_angle for load in machine.loads if load.table is not None)
    turns = max((int(np.ceil(np.ptp(table) / (2 * np.pi) - 1e-9)) for table in tables), default=1)
    angles = np.concatenate([ANGLES + 2 * np.pi * k for k in range(turns)])
    analysis = eq.analyze(machine, angles=angles)
    assert analysis.motion.turns % turns == 0
    return Subject(machine, analysis.motion, analysis, case)


@cache
def subject_of(name: str) -> Subject:
    """Analyse an example or a random machine; without friction and resistances, which have tests of
    their own.
    """
    kind, _, seed = name.partition(":")
    if not seed:
        return analysed(replace(eq.load(name).without_friction(), resistances=()))
    kind, soil, _ = kind.partition(" in soil")
    kind, apart, _ = kind.partition(" apart")
    kind, long, _ = kind.partition(" long")
    drawn = f"{kind}:{seed}"
    pushed = drawn in machines_strokes.PUSHED
    case = machines_strokes.named(drawn) if pushed else make(kind, int(seed))
    machine = case.machine
    if long:
        machine = loaded_long(machine, np.random.default_rng([*name.encode()]))
    if apart:
        machine = set_apart(machine, np.random.default_rng([*name.encode()]))
    return analysed(planted(machine, np.random.default_rng(int(seed))) if soil else machine, case)


def planted(machine: Machine, rng: np.random.Generator) -> Machine:
    """Drive one point, or two, through soil that resists in every way, in some part of a path."""
    moving = {label for link in machine.links.values() for label in link.points} - {*machine.frame}
    tip = str(rng.choice(sorted(moving)))
    path = eq.move(machine, 360).points[tip]
    height, size = path.y, float(np.ptp(path.x) + np.ptp(path.y))
    # A point that moves along x has no height to speak of: all of its path is below the surface.
    depth = 0.4 * float(np.ptp(height)) + 0.01 * size
    level = {"depth": depth} if rng.random() < 0.5 else {"surface": float(np.min(height)) + depth}
    pace = size * abs(machine.drive.speed)
    forward = {"forward_speed": 0.3 * pace}
    if rng.random() < 0.5:
        forward = {"hill_spacing": 0.5 * size, "units_per_turn": 2}
    table = SoilTable((0.1 * size, 0.2 * size), (20.0, 70.0))
    soil = Soil(10.0, 100.0 / size, 20.0 / pace, 50.0 / (size * pace), table)
    way = str(rng.choice(["forward", "backward"]))
    others = sorted(moving - {tip})
    arms = (PlantingArm(str(rng.choice(others))),) if others and rng.random() < 0.5 else ()
    return machine.with_planting(tip=tip, travel=way, soil=soil, arms=arms, **level, **forward)


def vector(signal: Any) -> Array:
    """Return components x and y as (N, 2)."""
    return np.column_stack([signal.x, signal.y])


def agree(what: str, got: Array, want: Array, tolerance: float, least: float = 0.0) -> float:
    """Compare an output over all crank angles with its second route; tell how far they are apart.

    The difference is measured against the output's largest value, or against `least` where the
    output vanishes and rounding alone is left of it.
    """
    got, want = np.asarray(got), np.asarray(want)
    assert got.shape == want.shape, f"{what}: {got.shape} against {want.shape}"
    scale = max(float(np.max(np.abs(want))), least)
    apart = float(np.max(np.abs(got - want)))
    assert np.all(np.isfinite(got)), f"{what} is not finite"
    assert apart <= tolerance * scale, f"{what} is {apart:.3g} off, of {scale:.3g}"
    return apart / scale if scale else 0.0


def force_size(machine: Machine, poses: Poses) -> float:
    """Return the size of the forces in a machine, N: of all but the soil."""
    size = 0.0
    for name, link in machine.links.items():
        change = poses.change(name, link.center_of_mass or (0.0, 0.0))
        accelerated = float(np.max(np.abs(change)))
        size += (link.mass or 0.0) * (accelerated + float(np.hypot(*machine.gravity)))
    for load in machine.loads:
        columns = () if load.table is None else load.table.values
        size += float(np.max(np.abs([*(load.force or ()), *np.ravel(columns)]), initial=0.0))
    return size + sum(
        float(np.max(np.abs(force))) for _, _, force, _ in springs_on_links(machine, poses)
    )


def moment_size(machine: Machine, poses: Poses) -> float:
    """Return the size of moments in a machine, N m."""
    middle = np.mean(list(machine.frame.values()), axis=0)
    reach = max(float(np.max(np.abs(origin - middle))) for origin in poses.origin.values())
    size = force_size(machine, poses) * reach
    return size + sum(abs(load.torque or 0.0) for load in machine.loads)
