"""Balancing as a page is told of it."""

from __future__ import annotations

from dataclasses import replace
from math import dist, hypot, isclose
from typing import Any

from equipoise.balancing.balance import balance
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.measures import unit_of as si_unit
from equipoise.balancing.usual import usual_plan
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.model import Link, Machine
from equipoise.report.changes import told
from equipoise.report.naming import MEASURES, objective_named, output_named, scaled, unit_of
from equipoise.web.design import Counterweight, Design, pin_of

Values = dict[str, Any]
EXACT, ROUNDED = 1e-12, 1e-9


def balanced(machine: Machine) -> Balanced:
    """By the machine's own plan, or the usual one; with its figures, and errors, of `balance`."""
    found = balance(machine, usual_plan(machine))
    _ = found.before, found.after
    return found


def balanced_design(base: Design, found: Balanced) -> Design:
    """The balanced machine, whose point masses on pins of the frame can be changed further.

    base : what was balanced.
    """
    design = base.with_machine(base.own.with_balance(found.machine.balance))
    for change in found.changes:
        link, values = change.link, dict(change.values)
        shapes = [piece["shape"] for piece in values.get("pieces", ())]
        known = link in base.own.links  # and no shaft that is new
        if known and shapes == ["point"] and values["at"] == pin_of(base.own, link):
            weight = Counterweight(values["mass"], values["radius"], values["direction"])
            design = design.with_weight(link, weight)
    return design if _alike(design.machine, found.machine) else Design(base.name, found.machine)


def _alike(one: Machine, other: Machine) -> bool:
    """Whether two machines are the same but for rounding in the masses of their links."""
    return (
        one.links.keys() == other.links.keys()
        and replace(one, links=other.links) == other
        and all(_same(link, other.links[name]) for name, link in one.links.items())
    )


def _same(one: Link, other: Link) -> bool:
    x, y = other.center_of_mass or (0.0, 0.0)
    numbers = ((one.mass, other.mass), (one.inertia, other.inertia))
    return (
        one.points == other.points
        and all(isclose(a or 0.0, b or 0.0, rel_tol=ROUNDED) for a, b in numbers)
        and dist(one.center_of_mass or (0.0, 0.0), (x, y)) <= ROUNDED * hypot(x, y)
    )


def balanced_told(found: Balanced) -> Values:
    """What to change, aims and every figure before and after, and what is proved."""
    before, after = found.before, found.after
    names = [name for name in before if name in after and not name.startswith("planting.")]
    return {
        "changes": [line for change in found.changes for line in told(change)],
        "aims": [_aim(found, one) for one in found.plan.objectives],
        "figures": [_figure(found, name, before[name], after[name]) for name in names],
        "proof": _proof(found),
        "notes": list(found.notes),
    }


def _aim(found: Balanced, one: Objective) -> Values:
    """What was to become small."""
    factor, unit = scaled(found.units[one.name])
    before, after = (factor * value for value in found.objectives[one.name])
    label = objective_named(one, len(found.machine.rows))
    return {"label": label, "unit": unit, "before": before, "after": after}


def _figure(found: Balanced, name: str, before: float, after: float) -> Values:
    if name == "mass":
        label, factor, unit = "mass of the links", 1e3, "g"
    else:
        output, _, measure = name.rpartition(".")
        label = f"{output_named(output, len(found.machine.rows))}, {MEASURES[measure]}"
        if output.startswith("gauges"):
            factor, unit = scaled(si_unit(Objective(output), found.original))
        else:
            factor, unit = scaled(unit_of(output, measure))
    return {"label": label, "unit": unit, "before": factor * before, "after": factor * after}


def _proof(found: Balanced) -> str:
    if found.gap is None:
        return f"Found among {found.method}; that nothing better exists is not proved of phases."
    gap = max(found.gap, EXACT)
    proved = f"proved {found.scope}".strip()
    return (
        f"Found by {found.method}; {proved}: nothing that is allowed is better by more than "
        f"{gap:.0e} of the value before."
    )
