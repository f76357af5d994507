"""Balanced machines, rows with phases, trade-offs, and their pictures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi

import equipoise as eq
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.pareto import Front, trade_off
from equipoise.balancing.phase_search import Phasing, choose_phases
from equipoise.figures import pictures_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.results.charts import Chart

MM, STEEL = 1e3, 7850.0
FORCE_Y = eq.balancing.Objective("shaking_force.y")
FORCE = eq.balancing.Objective("shaking_force")
MOMENT = eq.balancing.Objective("shaking_moment")
RIPPLE = eq.balancing.Objective("drive_torque", "ripple")
Pictures = dict[str, Chart]


def plate(shape: str, radius: float, inner: float = 0.0) -> eq.balancing.Weight:
    """Steel, 20 mm thick."""
    return eq.balancing.Weight(shape, radius, inner, thickness=0.02, density=STEEL)  # type: ignore[arg-type]


def on_crank(
    weight: eq.balancing.Weight, *objectives: eq.balancing.Objective
) -> eq.balancing.Balance:
    return eq.balancing.Balance(
        masses=(eq.balancing.AddedMass("crank", "A", weight),), objectives=objectives
    )


def one_of_each() -> eq.balancing.Balance:
    """A disc, any mass, a centre that moves in a box; force, joint and orders of a moment."""
    rocker = eq.balancing.AddedMass("rocker", "D", eq.balancing.Weight("any", 0.05, at_most=1.0))
    objectives = (
        FORCE,
        eq.balancing.Objective("joints.B", "peak"),
        eq.balancing.Objective("shaking_moment", "rms", (1, 2)),
    )
    plan = on_crank(plate("disc", 0.06), *objectives)
    box = eq.balancing.CenterMove("coupler", x=(-0.05, 0.05), y=(-0.03, 0.03))
    return replace(plan, masses=(*plan.masses, rocker), moves=(box,))


def moved() -> eq.balancing.Balance:
    circle = eq.balancing.CenterMove("coupler", center=(0.0, 0.0), radius=0.03)
    return eq.balancing.Balance(moves=(circle,), objectives=(FORCE,))


def geared() -> eq.balancing.Balance:
    weight = eq.balancing.GearedWeight("rocker", plate("disc", 0.04), (0.6, 0.6), pitch_radius=0.05)
    return eq.balancing.Balance(geared=(weight,), objectives=(MOMENT,))


def shafts() -> eq.balancing.Balance:
    pair = eq.balancing.BalanceShafts(
        1, ((0.05, 0.05), (0.15, 0.05)), eq.balancing.Weight("point", 0.03, at_most=0.5)
    )
    return eq.balancing.Balance(shafts=(pair,), objectives=(FORCE,))


def long_cycle() -> tuple[Machine, eq.balancing.Balance]:
    """Beside the crank an uneven shaft that is back after two turns."""
    base = eq.load("yamashita-1")
    shaft = eq.Link({"X": (0.0, 0.0)}, 0.3, (0.02, 0.0), 1e-4)
    machine = replace(
        base,
        frame={**base.frame, "X": (0.0, 0.05)},
        links={**base.links, "shaft": shaft},
        gears=(eq.Gear("crank", "shaft", ratio=-1.5),),
    )
    return machine, on_crank(eq.balancing.Weight("point", 0.05), FORCE)


def sprung() -> tuple[Machine, eq.balancing.Balance]:
    """Slow, so that its weight is most of what the drive has to carry; with one spring already."""
    base = eq.load("kim-chung-a")
    machine = replace(
        base,
        frame={**base.frame, "S": (0.05, 0.12)},
        drive=replace(base.drive, speed=2.0),
        springs=(eq.Spring("coupler", "P", "S", 5.0, 0.1),),
    )
    choice = eq.balancing.SpringChoice("rocker", "C", "S", 500.0)
    return machine, eq.balancing.Balance(springs=(choice,), objectives=(RIPPLE,))


def odd_names() -> tuple[Machine, eq.balancing.Balance]:
    base = eq.load("yamashita-1")
    names = {"crank": "$cr_a$nk 軸 " + "long " * 9, "coupler": "a/b", "rocker": "A_b"}
    links = {names[name]: link for name, link in base.links.items()}
    machine = replace(
        base,
        title=r"Costs $5 and \alpha_{1}^2 <b>'\"</b> " + "long " * 20,
        links=links,
        drive=replace(base.drive, link=names["crank"], speed=-base.drive.speed),
    )
    mass = eq.balancing.AddedMass(names["crank"], "A", plate("sector", 0.06, 0.01))
    return machine, eq.balancing.Balance(masses=(mass,), objectives=(FORCE_Y,))


def of(name: str, plan: eq.balancing.Balance) -> tuple[Machine, eq.balancing.Balance]:
    return eq.load(name), plan


def cases() -> dict[str, tuple[Machine, eq.balancing.Balance]]:
    rings = eq.balancing.AddedMass("rocker", "D", plate("ring", 0.05, 0.01))
    return {
        "sector": of("yamashita-1", on_crank(plate("sector", 0.06, 0.01), FORCE_Y)),
        "one of each": of("yamashita-1", one_of_each()),
        "ring": of(
            "yamashita-1", eq.balancing.Balance(masses=(rings,), objectives=(RIPPLE, MOMENT))
        ),
        "moved": of("yamashita-2", moved()),
        "geared": of("lee-kim-a", geared()),
        "shafts": of("yamashita-1", shafts()),
        "flat": of(
            "exudyn-slider-crank",
            eq.balancing.Balance(moves=(eq.balancing.CenterMove("crank"),), objectives=(FORCE,)),
        ),
        "long cycle": long_cycle(),
        "spring": sprung(),
        "odd names": odd_names(),
    }


KINDS = tuple(cases())


@cache
def balanced_case(kind: str) -> Balanced:
    return eq.balance(*cases()[kind])


@cache
def in_rows(count: int = 4, weight: bool = False) -> Balanced:
    """Rows in one phase that get others; with a counterweight too."""
    rows = tuple(Row(lateral=0.3 * ((7 * k) % count)) for k in range(count))
    machine = replace(eq.load("yamashita-1"), rows=rows)
    plan = (
        on_crank(eq.balancing.Weight("point", 0.05), FORCE)
        if weight
        else eq.balancing.Balance(objectives=(FORCE,))
    )
    return eq.balance(machine, replace(plan, phases=eq.balancing.Phases(pi / 6)))


@cache
def phasing() -> Phasing:
    return choose_phases(in_rows().original, [FORCE], eq.balancing.Phases(pi / 6))


@cache
def front(first: eq.balancing.Objective = MOMENT, points: int = 4) -> Front:
    plan = eq.balancing.Balance(moves=(eq.balancing.CenterMove("coupler"),))
    return trade_off(
        eq.load("yamashita-2"), first, eq.balancing.Objective("drive_torque"), plan, points
    )


@cache
def pictures(kind: str) -> Pictures:
    """Charts of a case by name."""
    drawn = pictures_of(_result(kind))
    return {name: chart for name, chart in drawn.items() if isinstance(chart, Chart)}


def _result(kind: str) -> Balanced | Phasing | Front:
    if kind == "phases":
        return phasing()
    if kind == "front":
        return front()
    if kind.startswith("rows"):
        return in_rows(*{"rows": (4,), "rows, many": (14,), "rows, both": (3, True)}[kind])
    return balanced_case(kind)


EVERY = (*KINDS, "rows", "rows, many", "rows, both", "phases", "front")
