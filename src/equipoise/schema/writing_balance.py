"""From what may be changed to quieten a machine to the table [balance] of the model file."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Pair,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.model import Machine
from equipoise.mechanism.objectives import quantity_of
from equipoise.mechanism.weights import material_of
from equipoise.quantities import Dimension, format_exact
from equipoise.schema.numbers import format_share
from equipoise.schema.plain import listed, quantities, tidy, unless
from equipoise.schema.points import written


def balance_table(balance: Balance, machine: Machine) -> dict[str, Any]:
    """Content of [balance]; defaults are left out."""
    tables = {
        "moves": [_move(move) for move in balance.moves],
        "masses": [_mass(mass) for mass in balance.masses],
        "geared": [_geared(geared) for geared in balance.geared],
        "shafts": [_shafts(shafts) for shafts in balance.shafts],
        "springs": [_spring(spring) for spring in balance.springs],
        "objectives": [_objective(objective) for objective in balance.objectives],
        "limits": [_limit(limit, machine) for limit in balance.limits],
    }
    return {
        **quantities(balance, {"added_mass": "mass"}),
        **unless(balance.combine == "sum", combine=balance.combine),
        **({} if balance.phases is None else {"phases": _phases(balance.phases)}),
        **{key: items for key, items in tables.items() if items},
    }


def _ranges(table: Any, dimensions: Mapping[str, Dimension]) -> dict[str, list[str]]:
    """Write those attributes that are pairs of quantities."""
    return {
        name: listed(pair, dimension)
        for name, dimension in dimensions.items()
        if (pair := getattr(table, name)) is not None
    }


def _numbers(pair: Pair) -> float | list[float]:
    """Write a range of plain numbers, or the number that it consists of."""
    return tidy(pair[0]) if pair[0] == pair[1] else [tidy(value) for value in pair]


def _made_of(density: float | None, prefix: str = "") -> dict[str, str]:
    """Write a density, as the name of a material where it has one."""
    if density is None:
        return {}
    if name := material_of(density):
        return {f"{prefix}material": name}
    return {f"{prefix}density": format_exact(density, "density")}


def _weight(weight: Weight) -> dict[str, Any]:
    return {
        **unless(weight.shape == "any", shape=weight.shape),
        **({"radius": format_exact(weight.radius, "length")} if isfinite(weight.radius) else {}),
        **quantities(weight, {"inner_radius": "length", "thickness": "length"}),
        **_made_of(weight.density),
        **quantities(weight, {"mass": "mass", "at_most": "mass"}),
    }


def _move(move: CenterMove) -> dict[str, Any]:
    return {
        "link": move.link,
        **_ranges(move, {"x": "length", "y": "length"}),
        **({} if move.center is None else {"center": written(move.center)}),
        **quantities(move, {"radius": "length"}),
    }


def _mass(mass: AddedMass) -> dict[str, Any]:
    return {"link": mass.link, "at": mass.at, **_weight(mass.weight)}


def _geared(geared: GearedWeight) -> dict[str, Any]:
    table: dict[str, Any] = {"driver": geared.driver}
    if geared.ratio is not None:
        table["ratio"] = _numbers(geared.ratio)
    if geared.teeth is not None:
        table["teeth"] = list(geared.teeth)
    table |= quantities(geared, {"module": "length", "pitch_radius": "length"})
    if geared.axis is not None:
        table["axis"] = written(geared.axis)
    if geared.direction is not None:
        way = listed(geared.direction, "angle")
        table["direction"] = way if way[0] != way[1] else way[0]
    return {
        **table,
        **quantities(geared, {"gear_thickness": "length"}),
        **_made_of(geared.gear_density, "gear_"),
        **unless(not geared.clear_of, clear_of=list(geared.clear_of)),
        **_weight(geared.weight),
        **unless(geared.name == GearedWeight.name, name=geared.name),
    }


def _shafts(shafts: BalanceShafts) -> dict[str, Any]:
    return {
        "order": shafts.order,
        "axes": [written(axis) for axis in shafts.axes],
        **_weight(shafts.weight),
        **unless(shafts.name == BalanceShafts.name, name=shafts.name),
    }


def _spring(spring: SpringChoice) -> dict[str, Any]:
    return {
        "link": spring.link,
        "point": spring.point,
        "to": spring.to,
        **quantities(spring, {"stiffness": "stiffness"}),
        **_ranges(spring, {"free_length": "length"}),
    }


def _phases(phases: Phases) -> dict[str, Any]:
    return unless(phases.step == Phases.step, step=format_exact(phases.step, "angle"))


def _measured(objective: Objective) -> dict[str, Any]:
    return {
        "output": objective.output,
        **unless(objective.measure == "rms", measure=objective.measure),
        **unless(not objective.orders, orders=[tidy(order) for order in objective.orders]),
        **unless(objective.about is None, about=objective.about),
        **unless(not objective.speeds, speeds=listed(objective.speeds, "angular speed")),
    }


def _objective(objective: Objective) -> dict[str, Any]:
    weight = objective.weight
    return {**_measured(objective), **unless(weight == 1, weight=tidy(weight))}


def _limit(limit: Limit, machine: Machine) -> dict[str, Any]:
    if limit.ratio is not None:
        at_most = format_share(limit.ratio)
    else:
        quantity = quantity_of(limit.objective, machine)
        assert limit.at_most is not None and quantity is not None
        at_most = format_exact(limit.at_most, quantity)
    return {**_measured(limit.objective), "at_most": at_most}
