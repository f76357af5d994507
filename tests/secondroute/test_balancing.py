"""Balancing against a blind search, against convex programs in other matrices, and as it is made.

`support.balancing_reference` shares nothing with `equipoise.balancing`.  Differential evolution
must find nothing better; where it comes close, and polishing brings it to the spot, it must find
the same.

Tolerances, over the values before.  What is found may be beaten by 1e-6, as is promised; solvers
of cone programs stop at 1e-8 and less.  A machine made from the pieces that were told gives the
same outputs to 1e-9, to 1e-7 where two points stand for a spread mass: their distance is the root
of a small difference.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.mechanism.outputs.declared import joint_names
from equipoise.mechanism.parts.balance import MEASURES, Balance, Objective, Weight
from equipoise.mechanism.parts.machine import Machine
from support.balancing_reference import (
    FreeShaft,
    Problem,
    convex_optimum,
    evolved,
    loads_jump,
    made,
    mass_range,
    measured,
    measured_exactly,
    piece_inertia,
    plate,
    signals_of,
)
from support.chosen import few
from support.conformance import compared
from support.machines import KINDS, make
from support.sources import BLIND_SEARCH

BEATEN = 1e-6
"""Over the value before, by which no other machine may be better."""
SEARCHED = 2e-5
"""Over the value before, to which a blind search comes."""
GAP = 1e-8
STEEL = {"thickness": 0.01, "density": 7850.0}


def added(link: str, at: str, shape: str = "any", **room: float) -> eq.balancing.AddedMass:
    return eq.balancing.AddedMass(link, at, Weight(shape, **room))  # type: ignore[arg-type]


def small(words: str) -> tuple[Objective, ...]:
    """Objectives in words: measures and outputs."""
    return tuple(Objective(*part.split()[::-1]) for part in words.split(", "))  # type: ignore[arg-type]


def limits(words: str) -> Iterator[eq.balancing.Limit]:
    """Limits in words: measure, output, and how much of it, in SI units or % of before."""
    for part in filter(None, words.split(", ")):
        measure, output, much, *share = part.split()
        wish = Objective(output, measure)  # type: ignore[arg-type]
        most = {"ratio": float(much) / 100} if share else {"at_most": float(much)}
        yield eq.balancing.Limit(wish, **most)


def plan(wishes: str, kept: str = "", **parts: Any) -> Balance:
    return Balance(objectives=small(wishes), limits=tuple(limits(kept)), **parts)


def geared(low: float, high: float, shape: str = "any", **room: float) -> eq.balancing.GearedWeight:
    weight = Weight(shape, **{"radius": 0.05, **room})  # type: ignore[arg-type]
    return eq.balancing.GearedWeight("rocker", weight, ratio=(low, high), pitch_radius=0.05)


# -- plans -----------------------------------------------------------------------------------------

MOMENT = "rms shaking_moment"
CRANK = added("crank", "A", radius=0.06, at_most=0.5)
ROCKER = added("rocker", "D", radius=0.06, at_most=0.5)
BOX = eq.balancing.CenterMove("coupler", x=(-0.06, 0.02), y=(-0.03, 0.03))
ANY = added("rocker", "C", radius=0.05, at_most=0.6)
CIRCLE = eq.balancing.CenterMove("coupler", center=(-0.045, -0.02), radius=0.02)
CRANK_POINT = replace(CRANK, weight=replace(CRANK.weight, shape="point"))
ROCKER_POINT = replace(ROCKER, weight=replace(ROCKER.weight, shape="point"))
ROCKER_DISC = added("rocker", "D", "disc", radius=0.05, **STEEL)
ROCKER_SECTOR = added("rocker", "D", "sector", radius=0.06, inner_radius=0.01, **STEEL)
TWO = "peak shaking_moment, ripple drive_torque"

PAPERS: dict[str, tuple[str, Balance]] = {
    "coupler in a box": ("yamashita-1", plan(MOMENT, moves=(BOX,))),
    "coupler in a circle": ("yamashita-2", plan("peak shaking_force", moves=(CIRCLE,))),
    "coupler, moment's range": (
        "yamashita-2",
        plan("peak_to_peak shaking_moment", moves=(CIRCLE,)),
    ),
    "crank": ("yamashita-1", plan("rms shaking_force", masses=(CRANK,))),
    "crank, vertical": (
        "yamashita-2",
        plan("peak shaking_force.y", "peak shaking_force.x 120 %", masses=(CRANK_POINT,)),
    ),
    "rocker": (
        "yamashita-1",
        plan("peak shaking_moment", "peak joints.B 110 %", masses=(ROCKER,)),
    ),
    "crank and rocker": (
        "yamashita-1",
        plan(
            MOMENT,
            "rms shaking_force 70 %, peak joints.D 100 %",
            masses=(CRANK, ROCKER),
            added_mass=0.8,
        ),
    ),
    "rocker's disc": ("yamashita-1", plan(MOMENT, masses=(ROCKER_DISC,))),
    "rocker's sector": ("yamashita-2", plan(TWO, masses=(ROCKER_SECTOR,), combine="squares")),
    "all": (
        "yamashita-1",
        plan(
            "peak shaking_moment, peak shaking_force",
            "peak drive_torque 100 %",
            moves=(BOX,),
            masses=(CRANK, ROCKER_POINT),
            added_mass=0.5,
        ),
    ),
    **{
        f"geared counterweight {which}": (
            f"lee-kim-{which}",
            plan("area shaking_moment", geared=(geared(0.57, 0.57, at_most=0.6),)),
        )
        for which in "abc"
    },
    "geared point": (
        "lee-kim-a",
        plan(
            "rms shaking_moment, rms shaking_force",
            geared=(geared(0.8, 0.8, "point", at_most=0.6),),
            masses=(added("crank", "O2", radius=0.04, at_most=0.4),),
            added_mass=0.5,
        ),
    ),
}


@dataclass(frozen=True)
class Draws:
    """Random plans that suit a machine."""

    machine: Machine
    rng: np.random.Generator

    @property
    def size(self) -> float:
        """Typical extent of a link, m."""
        extents = [np.ptp([*link.points.values()], 0).max() for link in self.machine.links.values()]
        return float(np.mean([extent for extent in extents if extent > 0]))

    @property
    def mass(self) -> float:
        """Typical mass of a link, kg."""
        return float(np.mean([link.mass or 0.0 for link in self.machine.links.values()]))

    def uniform(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    def plan(self) -> Balance:
        links = list(self.machine.links)
        heavy = [name for name in links if self.machine.links[name].mass]
        count = int(self.rng.integers(1, 4))
        moving = int(self.rng.binomial(min(count, 2), 0.4))
        moves = tuple(
            self.move(str(name)) for name in self.rng.choice(heavy, min(moving, len(heavy)), False)
        )
        masses = tuple(self.added(str(self.rng.choice(links))) for _ in range(count - len(moves)))
        fixed = any(mass.weight.mass is not None for mass in masses)
        return Balance(
            moves=moves,
            masses=masses,
            objectives=self.objectives(int(self.rng.choice([1, 1, 2, 3]))),
            limits=() if fixed else tuple(self.limits(int(self.rng.choice([0, 0, 1, 2])))),
            combine="sum" if self.rng.random() < 0.5 else "squares",
            added_mass=self.mass * self.uniform(0.1, 1)
            if masses and not fixed and self.rng.random() < 0.4
            else None,
        )

    def move(self, link: str) -> eq.balancing.CenterMove:
        center = np.array(self.machine.links[link].center_of_mass)
        radius = self.size * self.uniform(0.05, 0.6)
        if self.rng.random() < 0.5:
            x, y = map(float, center + radius * self.rng.uniform(-0.5, 0.5, 2))
            return eq.balancing.CenterMove(link, center=(x, y), radius=radius)
        low, high = center + radius * np.array([[-1], [1]]) * self.rng.uniform(0.2, 1, (2, 2))
        return eq.balancing.CenterMove(link, *zip(low.tolist(), high.tolist(), strict=True))

    def added(self, link: str) -> eq.balancing.AddedMass:
        at = str(self.rng.choice([*self.machine.links[link].points]))
        shape = str(self.rng.choice(["any", "any", "point", "disc", "ring", "sector"]))
        radius = self.size * self.uniform(0.2, 1.2)
        room: dict[str, float] = {"radius": radius}
        most = self.mass * self.uniform(0.1, 1.5)
        if shape in ("disc", "ring", "sector"):
            full = self.mass * self.uniform(0.3, 3)
            room |= {"thickness": 0.01, "density": full / (0.01 * pi * radius**2)}
            most = min(most, 0.7 * full)
        if shape in ("ring", "sector") and self.rng.random() < 0.5:
            room["inner_radius"] = radius * self.uniform(0.1, 0.5)
        if self.rng.random() < 0.15:
            return added(link, at, shape, **room, mass=0.3 * most)
        if shape in ("any", "point") or self.rng.random() < 0.4:
            room["at_most"] = most
        return added(link, at, shape, **room)

    def objectives(self, count: int) -> tuple[Objective, ...]:
        drawn = {item.name: item for item in (self.objective() for _ in range(count))}
        return tuple(drawn.values())

    def limits(self, count: int) -> Iterator[eq.balancing.Limit]:
        for item in self.objectives(count):
            yield eq.balancing.Limit(item, ratio=self.uniform(1, 1.3))

    def objective(self) -> Objective:
        """Draw a measure; forces in joints only without gears, whose flanks change sides."""
        joints = [] if self.machine.gears else joint_names(self.machine)
        vector, number = ["rms", "peak"], list(MEASURES)
        choices = [
            ("shaking_force", vector),
            ("shaking_force.x", number),
            ("shaking_force.y", number),
            ("shaking_moment", number),
            ("drive_torque", number),
            *((f"joints.{joint}", vector) for joint in joints[:1]),
        ]
        output, measures = choices[int(self.rng.integers(len(choices)))]
        about = None
        if output == "shaking_moment" and self.rng.random() < 0.3:
            about = str(self.rng.choice([*self.machine.frame]))
        orders = (1.0, 2.0) if self.rng.random() < 0.1 else ()
        measure, weight = str(self.rng.choice(measures)), float(self.rng.choice([1.0, 2.5, 0.3]))
        return Objective(output, measure, orders, about, weight)  # type: ignore[arg-type]


def random_case(seed: int) -> tuple[Machine, Balance]:
    """Draw a machine, of another kind with each seed, and a plan for it."""
    machine = make(list(KINDS)[seed % len(KINDS)], seed).machine
    return machine, Draws(machine, np.random.default_rng(seed)).plan()


RANDOM = (
    0,
    1,
    3,
    4,
    7,
    9,
    10,
    11,
    12,
    13,
    14,
    15,
    16,
    17,
    20,
    23,
    24,
    25,
    26,
    27,
    32,
    51,
    54,
    75,
    131,
    266,
)
"""Seeds of machines of different kinds."""
CASES = {**PAPERS, **{f"random {seed}": seed for seed in RANDOM}}
every_case = pytest.mark.parametrize(
    "name", few(CASES, {*PAPERS, *(f"random {seed}" for seed in RANDOM[::10])})
)


def case_of(name: str) -> tuple[Machine, Balance]:
    case = CASES[name]
    return random_case(case) if isinstance(case, int) else (eq.load(case[0]), case[1])


@cache
def balanced(name: str) -> eq.balancing.Balanced:
    return eq.balance(*case_of(name))


# -- against a blind search ------------------------------------------------------------------------


@pytest.mark.exhaustive(
    but=[
        "rocker's sector",
        "geared counterweight a",
        "crank, vertical",
        "coupler, moment's range",
        "random 14",
        "crank",
        "geared point",
    ]
)
@compared(BLIND_SEARCH, "least cost, over that before; differential evolution", SEARCHED)
@every_case
def test_no_other_is_better(name: str) -> None:
    machine, plan = case_of(name)
    actual, problem = balanced(name), Problem(machine, plan)
    whole = sum(problem.weights)
    for seed in range(1, 9):  # a blind search may end in another valley
        sampled, at = evolved(problem, seed=seed)
        if sampled <= actual.cost + SEARCHED * whole:
            break
    rebuilt = problem.rebuilt(at)
    values = [measured(rebuilt, objective) for objective in plan.objectives]
    before = [goal.before for goal in problem.goals]
    real = problem.combined([np.array(v / b) for v, b in zip(values, before, strict=True)])
    assert float(real) == pytest.approx(sampled, abs=1e-9 * whole)
    wishes = plan.objectives
    shares = [measured_exactly(rebuilt, w) / measured_exactly(machine, w) for w in wishes]
    cost = float(problem.combined([np.array(share) for share in shares]))
    assert cost >= actual.cost - BEATEN * whole
    assert cost >= actual.bound - BEATEN * whole
    # where the signal jumps, the search sees peaks and areas at its own crank angles only
    peaks = any(objective.measure.startswith("peak") for objective in plan.objectives)
    misses = 2e-3 if peaks and (loads_jump(machine) or has_corners(machine)) else SEARCHED
    assert cost <= actual.cost + misses * whole


def has_corners(machine: Machine) -> bool:
    """Whether tables of springs have corners, near which neither samples nor their curve are the
    peak.
    """
    return (
        any(spring.table or spring.angles for spring in machine.torsion_springs)
        or any(spring.table or spring.lengths for spring in machine.springs)
        or any(load.table for load in machine.loads)
    )


@every_case
def test_values_before_and_after(name: str) -> None:
    machine, plan = case_of(name)
    actual, problem = balanced(name), Problem(machine, plan)
    values = []
    for item, goal in zip(plan.objectives, problem.goals, strict=True):
        before, after = actual.objectives[item.name]
        jumps = loads_jump(machine)
        # the reference's samples miss a little of an area where the signal jumps
        near = 1e-4 if jumps and item.measure == "area" else 1e-12
        peaks = item.measure.startswith("peak")
        if peaks:  # where loads jump, those of the reference's samples, though of many
            near = 1e-6 if jumps else 5e-3 if has_corners(machine) else 1e-9
        assert before == pytest.approx(measured_exactly(machine, item), rel=near)
        # the reference's own peaks are those of samples, which the curve rises above
        coarse = item.measure.startswith("peak")
        assert before >= goal.before * (1 - (5e-3 if jumps else 1e-12))
        assert before == pytest.approx(
            goal.before, rel=2e-2 if jumps else 1e-3 if coarse else 1e-12
        )
        exact = measured_exactly(actual.machine, item)
        assert after == pytest.approx(exact, abs=max(near, 1e-9) * before)
        values.append(np.array(after / before))
    assert actual.cost == pytest.approx(float(problem.combined(values)), rel=1e-9)
    assert actual.bound <= actual.cost + GAP * sum(problem.weights)
    assert actual.gap < BEATEN  # mostly 1e-9; how near a cone program ends, rounding decides
    for given, most in zip(plan.limits, problem.limits, strict=True):
        assert measured(actual.machine, given.objective) <= most * (1 + 1e-7)


def test_area_and_torque_of_a_sector() -> None:
    machine, plan = eq.load(PAPERS["rocker's sector"][0]), PAPERS["rocker's sector"][1]
    plan = replace(plan, objectives=small("area shaking_moment, ripple drive_torque"))
    actual, problem = eq.balance(machine, plan), Problem(machine, plan)
    assert evolved(problem)[0] == pytest.approx(actual.cost, abs=BEATEN * 2)


def test_each_weight_has_a_price() -> None:
    masses = (added("rocker", "D", radius=0.05, at_most=0.2), ANY)
    solution = eq.balance(eq.load("yamashita-1"), plan(MOMENT, masses=masses))
    masses = [price for name, price in solution.prices.items() if name.startswith("mass")]
    assert sorted(price.at_most for price in masses) == [0.2, 0.6]


@pytest.mark.parametrize("which", few("abc", "c"))
def test_a_free_ratio(which: str) -> None:
    machine = eq.load(f"lee-kim-{which}")
    free = plan(MOMENT, geared=(geared(0.4, 1.5, at_most=0.6),))
    solution = eq.balance(machine, free)
    cost, _ = FreeShaft(machine, free).evolved()
    assert solution.cost - BEATEN <= cost <= solution.cost + 1e-6


# -- against convex programs -----------------------------------------------------------------------

SECTOR = added("rocker", "D", "sector", radius=0.05, inner_radius=0.02, **STEEL)
CRANK_SECTOR = added("crank", "A", "sector", radius=0.05, **STEEL)
LIMITED = (
    added("crank", "O2", radius=0.05, at_most=0.5),
    added("rocker", "O4", radius=0.05, at_most=0.8),
)
POINTS = (
    added("crank", "A", "point", radius=0.05, at_most=0.4),
    added("rocker", "D", "point", radius=0.04, at_most=0.4),
)
CONVEX: dict[str, tuple[str, Balance]] = {
    **{name: PAPERS[name] for name in ("crank and rocker", "geared counterweight a")},
    **{name: PAPERS[name] for name in ("geared counterweight b", "geared counterweight c")},
    "any, root mean square": ("yamashita-1", plan(MOMENT, masses=(CRANK, ANY))),
    "any, forces and torque": (
        "yamashita-1",
        plan(
            "rms shaking_force.x, rms shaking_force.y, ripple drive_torque",
            "rms joints.D 100 %",
            masses=(CRANK, ROCKER),
            combine="squares",
            added_mass=0.6,
        ),
    ),
    "any, area": ("yamashita-2", plan("area shaking_moment", masses=(CRANK, ROCKER))),
    "any, squares": (
        "yamashita-1",
        plan(
            "peak_to_peak shaking_moment, peak shaking_force, ripple drive_torque",
            masses=(CRANK, ROCKER, added("coupler", "C", radius=0.03, mass=0.1)),
            combine="squares",
        ),
    ),
    "any, limits": (
        "lee-kim-b",
        plan(
            "peak shaking_moment",
            "peak shaking_force 80 %, rms joints.O4 100 %, peak_to_peak drive_torque 110 %",
            masses=LIMITED,
            added_mass=0.9,
        ),
    ),
    "sector": ("yamashita-1", plan(MOMENT, masses=(SECTOR,))),
    "sector, force": (
        "yamashita-2",
        plan(
            "rms shaking_force, rms shaking_moment",
            masses=(CRANK_SECTOR, SECTOR),
            combine="squares",
        ),
    ),
    "disc on the crank": (
        "yamashita-1",
        plan(
            "rms shaking_force.x, peak shaking_force.y",
            masses=(added("crank", "A", "disc", radius=0.05, **STEEL),),
        ),
    ),
    "points and force": (
        "yamashita-2",
        plan("peak shaking_force", "rms shaking_force.x 80 %", masses=POINTS, added_mass=0.5),
    ),
    "coupler and force": (
        "yamashita-2",
        plan(
            "peak_to_peak shaking_force.y, area shaking_force.x", moves=(CIRCLE,), masses=(CRANK,)
        ),
    ),
}
SMOOTH = ("any, root mean square", "any, forces and torque")
"""Small enough, written in the factors of the mean squares, for a first-order solver."""


def convex_case(name: str) -> tuple[eq.balancing.Balanced, Problem]:
    machine, plan = eq.load(CONVEX[name][0]), CONVEX[name][1]
    return eq.balance(machine, plan), Problem(machine, plan)


@pytest.mark.exhaustive(
    but=[
        "sector",
        "any, squares",
        "any, limits",
        "coupler and force",
        "points and force",
        "geared counterweight a",
        "disc on the crank",
        "any, root mean square",
        "any, area",
    ]
)
@compared(BLIND_SEARCH, "least cost, over that before; convex program", BEATEN)
@pytest.mark.parametrize("name", CONVEX)
def test_optimum_of_a_convex_program(name: str) -> None:
    actual, problem = convex_case(name)
    whole = sum(problem.weights)
    assert actual.cost == pytest.approx(convex_optimum(problem), abs=BEATEN * whole)
    assert actual.gap < GAP


@pytest.mark.parametrize("name", SMOOTH)
def test_optimum_by_a_first_order_solver(name: str) -> None:
    actual, problem = convex_case(name)
    whole = sum(problem.weights)
    assert actual.cost == pytest.approx(convex_optimum(problem, "SCS"), abs=BEATEN * whole)


# -- the changes are real --------------------------------------------------------------------------

REAL = [*CASES, *(f"convex: {name}" for name in CONVEX if name not in CASES)]
every_real = pytest.mark.parametrize(
    "name", few(REAL, {*REAL} - {f"random {seed}" for seed in RANDOM if seed not in RANDOM[::5]})
)


def real_case(name: str) -> tuple[Machine, Balance, eq.balancing.Balanced]:
    if name.startswith("convex: "):
        source, plan = CONVEX[name.removeprefix("convex: ")]
        return eq.load(source), plan, eq.balance(eq.load(source), plan)
    return *case_of(name), balanced(name)


@every_real
def test_changes_report_the_machine(name: str) -> None:
    machine, plan, actual = real_case(name)
    rebuilt = made(machine, plan, actual.changes)
    joints = [f"joints.{joint}" for joint in eq.analyze(machine, 90).forces.joints]
    outputs = [
        (output, None, ())
        for output in ("shaking_force", "shaking_moment", "drive_torque", "frame_force", *joints)
    ]
    spread = any(len(change.values.get("pieces", ())) > 1 for change in actual.changes)
    before = signals_of(machine, outputs)
    text, given = signals_of(rebuilt, outputs), signals_of(actual.machine, outputs)
    for (output, _, _), size, item, other in zip(outputs, before, text, given, strict=True):
        apart, largest = np.max(np.abs(item - other)), np.max(np.abs(size))
        assert apart <= (1e-7 if spread else 1e-9) * max(largest, np.max(np.abs(other))), output


@every_real
def test_changes_keep_to_their_room(name: str) -> None:
    _, plan, actual = real_case(name)
    texts = [change for change in actual.changes if change.kind == "added mass"]
    asked = [*((a.link, a.weight) for a in plan.masses), *((g.name, g.weight) for g in plan.geared)]
    assert [change.link for change in texts] == [link for link, _ in asked]
    for (_, weight), change in zip(asked, texts, strict=True):
        pieces = change.values["pieces"]
        mass = sum(piece["mass"] for piece in pieces)
        least, most = mass_range(weight)
        assert mass == pytest.approx(change.values["mass"], rel=1e-9)
        assert least * (1 - 1e-7) <= mass <= most * (1 + 1e-7)
        for piece in pieces:
            keeps_to(weight, piece, np.array(change.values["center"]))
    moved = [change for change in actual.changes if change.kind == "center of mass"]
    for move, change in zip(plan.moves, moved, strict=True):
        place = np.array(change.values["to"])
        if move.center is not None and move.radius is not None:
            assert np.linalg.norm(place - move.center) <= move.radius * (1 + 1e-7)
        else:
            low, high = np.transpose([move.x, move.y])
            slack = 1e-7 * (high - low)
            assert np.all((low - slack <= place) & (place <= high + slack))
    total = sum(change.values["mass"] for change in texts)
    assert actual.added_mass == pytest.approx(total, abs=1e-12)
    assert total <= (plan.added_mass or np.inf) * (1 + 1e-7)


def keeps_to(weight: Weight, piece: dict[str, object], center: np.ndarray) -> None:
    """Hold a piece to its room and, where it is cut from a plate, to its own mass."""
    away = float(np.linalg.norm(np.array(piece["place"]) - center))
    radius, edge = weight.radius, weight.radius * (1 + 1e-7)
    mass, inertia = float(piece["mass"]), piece_inertia(piece)  # type: ignore[arg-type]
    if weight.shape in ("any", "point"):
        assert piece["shape"] == "point" and away <= edge
        return
    assert piece["shape"] == weight.shape and piece["thickness"] == weight.thickness
    if weight.shape == "disc":
        size = float(piece["radius"])  # type: ignore[arg-type]
        assert away + size <= edge
        assert mass == pytest.approx(plate(weight) * pi * size**2, rel=1e-9)
        return
    inner, outer = float(piece["inner_radius"]), float(piece["outer_radius"])  # type: ignore[arg-type]
    assert inner == weight.inner_radius
    if weight.shape == "ring":
        assert outer <= edge and away == 0
        assert mass == pytest.approx(plate(weight) * pi * (outer**2 - inner**2), rel=1e-9)
        return
    angle, direction = float(piece["angle"]), float(piece["direction"])  # type: ignore[arg-type]
    assert outer == radius
    assert mass == pytest.approx(plate(weight) * angle / 2 * (outer**2 - inner**2), rel=1e-7)
    half = (np.arange(4000) + 0.5) / 4000 * angle - angle / 2  # strips of the sector, from afar
    strips = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2) * np.cos(half).mean()
    assert away == pytest.approx(strips, rel=1e-5, abs=1e-7 * radius)
    assert mass * away**2 + inertia == pytest.approx(mass * (inner**2 + outer**2) / 2, rel=1e-6)
    if away > 1e-6 * radius:
        x, y = np.array(piece["place"]) - center
        assert np.angle(np.exp(1j * (np.arctan2(y, x) - direction))) == pytest.approx(0, abs=1e-6)


# -- prices ----------------------------------------------------------------------------------------


def loosened(plan: Balance, name: str, share: float) -> Balance:
    """Make a limit larger by a share."""
    if name == "added mass":
        assert plan.added_mass is not None
        return replace(plan, added_mass=plan.added_mass * share)
    what, _, link = name.partition(" on ")
    if what in {"mass", "radius"}:
        key = {"mass": "at_most", "radius": "radius"}[what]

        def more(part: Any, owner: str) -> Any:
            larger = {key: getattr(part.weight, key) * share}
            return replace(part, weight=replace(part.weight, **larger)) if owner == link else part

        masses = tuple(more(part, part.link) for part in plan.masses)
        return replace(plan, masses=masses, geared=tuple(more(g, g.name) for g in plan.geared))
    (which,) = (limit for limit in plan.limits if limit.name == name)
    key = "ratio" if which.ratio else "at_most"
    larger = replace(which, **{key: getattr(which, key) * share})
    return replace(plan, limits=tuple(larger if limit is which else limit for limit in plan.limits))


PRICED = {
    **{name: CONVEX[name] for name in ("crank and rocker", "any, limits", "points and force")},
    **{name: PAPERS[name] for name in ("rocker", "all", "geared counterweight a")},
    "tight": (
        "yamashita-1",
        plan(
            MOMENT,
            "rms shaking_force 60 %, peak joints.D 90 %, peak joints.B 90",
            masses=(
                added("rocker", "D", radius=0.05, at_most=2),
                added("crank", "A", radius=0.05, at_most=2),
            ),
            added_mass=1.0,
        ),
    ),
}


@pytest.mark.exhaustive(but=["any, limits", "geared counterweight a"])
@pytest.mark.parametrize(
    "name", few(PRICED, {"crank and rocker", "any, limits", "geared counterweight a", "tight"})
)
def test_prices(name: str) -> None:
    """The objective falls by the price, and by less and less: these programs are convex."""
    machine, plan = eq.load(PRICED[name][0]), PRICED[name][1]
    solution = eq.balance(machine, plan)
    unit = next(iter(solution.objectives.values()))[0] if len(plan.objectives) == 1 else 1.0
    for limited, price in solution.prices.items():
        for share, near in ((1e-3, 0.15), (1e-4, 0.03)):
            after = eq.balance(machine, loosened(plan, limited, 1 + share))
            fall = unit * (solution.cost - after.cost)
            more, slack = share * price.at_most, GAP * unit
            convex = not limited.startswith("radius")  # which counts by its square
            between = after.prices[limited].price * more - slack, price.price * more + slack
            assert not convex or between[0] <= fall <= between[1]
            assert fall == pytest.approx(price.price * more, rel=near, abs=slack), limited
        assert price.used <= price.at_most * (1 + 1e-7)
    assert any(price.active for price in solution.prices.values())


# -- plans that cannot be kept ---------------------------------------------------------------------

BOTH = (added("crank", "A", radius=0.05, at_most=2), added("rocker", "D", radius=0.05, at_most=2))
CLASHES: dict[str, Balance] = {
    "force and mass": plan(MOMENT, "rms shaking_force 80 %", masses=BOTH, added_mass=0.1),
    "two outputs": plan(
        MOMENT,
        "rms shaking_force 87 %, peak shaking_force.x 87 %, peak drive_torque 200 %",
        moves=(CIRCLE,),
    ),
    "alone": plan(MOMENT, "peak drive_torque 30 %", masses=BOTH),
}


def refusal(plan: Balance) -> str:
    with pytest.raises(UsageError) as caught:
        eq.balance(eq.load("yamashita-1"), plan)
    return str(caught.value)


def without(plan: Balance, sentence: str) -> Iterator[tuple[str, Balance]]:
    """Take each of the limits that a sentence names out of a plan."""
    for limit in plan.limits:
        if re.search(rf"\b{re.escape(limit.name)} at most", sentence):
            yield limit.name, replace(plan, limits=tuple(x for x in plan.limits if x is not limit))
    if "added mass" in sentence:
        yield "added mass", replace(plan, added_mass=None)
    for number, limit in enumerate(plan.masses):
        for what, much in (("radius", 1e3), ("mass", 1e3)):
            if f"{what} on {limit.link}" in sentence:
                weight = limit.weight
                most = {"radius": weight.radius * much} if what == "radius" else {"at_most": much}
                other = replace(limit, weight=replace(weight, **most))
                masses = (*plan.masses[:number], other, *plan.masses[number + 1 :])
                yield f"{what} on {limit.link}", replace(plan, masses=masses)


@pytest.mark.parametrize("name", CLASHES)
def test_a_clash_is_named(name: str) -> None:
    """Each of the named limits stands in the way, and the least that is told is the least."""
    plan, machine = CLASHES[name], eq.load("yamashita-1")
    sentence = refusal(plan)
    named = dict(without(plan, sentence))
    assert len(named) > ("clash" in sentence)
    for other in named.values():
        assert eq.balance(machine, other).gap < BEATEN
    match = re.search(r"; (.*) can become ([\d.]+) (N|N m) at the least", sentence)
    assert match
    number = [limit.name for limit in plan.limits].index(match[1])
    kept = tuple(limit for limit in plan.limits if limit.name in named)
    problem = Problem(machine, replace(plan, limits=kept))
    number = [item.name for item in kept].index(match[1])
    least = convex_optimum(problem, least=number)
    assert least > 1
    assert least * problem.limits[number] == pytest.approx(float(match[2]), rel=1e-3)
