"""Results of balancing as messages to a page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import field, replace
from math import dist, isclose, sqrt
from re import sub
from types import MappingProxyType
from typing import Any

from equipoise.balancing.advice import advice_against, advise
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.objectives import unit_of as si_unit
from equipoise.balancing.optimisation import balance
from equipoise.balancing.outcome import (
    deterioration_sentences,
    figure_named,
    figure_unit,
    no_benefit_sentences,
    objectives_text,
    proof_sentences,
)
from equipoise.balancing.phase_search import PhaseSearch
from equipoise.balancing.problem import Problem
from equipoise.balancing.workshop import SPREAD, sentences
from equipoise.dataclass import dataclass
from equipoise.i18n import localized, say
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.balance import Balance, Limit, Objective
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.machine import Link, Machine
from equipoise.quantities import clean, clean_place, display, format_quantity
from equipoise.results.outputs import objective_named, shown_in
from equipoise.web.design import Counterweight, Design, PageDraft, joined, pin_of, place_of_pin
from equipoise.web.edits import Computed, solved
from equipoise.web.figures import compared, figures_of
from equipoise.web.messages import JsonObject

MAIN = ("rms", "peak")
"""Measures that come first."""
ROUNDED = 1e-7
GAIN = 1e-3
"""Share of the aim below which less of it is nothing that anybody would build."""


def balanced(base: PageDraft, hold: bool = False) -> Balanced:
    """By the plan of the file, or as `advise` does it; with the errors of `balance`.

    hold : whether no gauge may read more than it does, whatever the plan says; advice makes none
        read more anyway.

    A counterweight of which a plan is free to choose another is replaced, and so is a shaft that a
    plan has added: the plan begins without it, and what was before is nevertheless the machine as
    it is shown.
    """

    def solve(_: Machine, plan: Balance) -> Balanced:
        plan = _with_gauge_limits(base.machine, plan) if hold else plan
        free = _replaced(base, plan)
        result = balance(_without_shafts(base.without(free)).machine, plan)
        if not (free or base.shafts):
            return result
        unplanned = base.machine.with_balance(None)
        before = _aims_of(unplanned, plan)
        aims = {name: (before[name], after) for name, (_, after) in result.objectives.items()}
        return replace(result, original=unplanned, objectives=aims)

    own = base.machine.balance
    frees = own is not None and not own.changes_nothing
    return advise(base.machine, solve) if frees else _advised(base)


def _without_shafts(base: PageDraft) -> PageDraft:
    """The design without links that an earlier balance has added, their couplings and pins."""
    own, gone = base.own, base.shafts & base.own.links.keys()
    links = {name: link for name, link in own.links.items() if name not in gone}
    couplings: dict[str, Any] = {
        table: tuple(item for item in getattr(own, table) if gone.isdisjoint(item.bodies))
        for table in coupling_kinds(Machine)
    }
    used_points = {point for link in links.values() for point in link.points}
    pins = {point for name in gone for point in own.links[name].points} - used_points
    frame = {point: place for point, place in own.frame.items() if point not in pins}
    if not gone:
        return base
    return base.with_machine(replace(own, links=links, frame=frame, **couplings))


def _advised(base: PageDraft) -> Balanced:
    """As `advise` does it, in the place of all counterweights that there are."""
    weights = _weighted(base)
    result = advise(base.without(weights).machine)
    return advice_against(result, base.machine.with_balance(None)) if weights else result


def _weighted(base: PageDraft) -> list[str]:
    """Links that have a counterweight."""
    return [name for name, weight in base.counterweights.items() if weight.mass]


def _with_gauge_limits(machine: Machine, plan: Balance) -> Balance:
    """A plan by which no gauge reads more, RMS about the mean at the machine's own speed."""
    if machine.support is None or plan.phases is not None:
        return plan
    gauges = (Objective(f"gauges.{name}", "ripple") for name in machine.support.readings)
    return replace(plan, limits=(*plan.limits, *(Limit(gauge, ratio=1.0) for gauge in gauges)))


def _replaced(base: PageDraft, plan: Balance) -> list[str]:
    """Links that have a counterweight on the pin where the plan may add mass."""
    free = {(mass.link, mass.at) for mass in plan.masses}
    return [name for name in _weighted(base) if (name, pin_of(base.own, name)) in free]


def _taken_away(base: PageDraft, balanced: Balanced) -> list[str]:
    """Links whose counterweights a result takes away, or replaces."""
    return _weighted(base) if balanced.advice is not None else _replaced(base, balanced.plan)


def _replaced_shafts(base: PageDraft, balanced: Balanced) -> list[str]:
    """Shafts of an earlier balance that a result replaces."""
    return [] if balanced.advice is not None else sorted(base.shafts & base.own.links.keys())


def _aims_of(machine: Machine, plan: Balance) -> dict[str, float]:
    """Value of each objective, SI units, as `balance` reports it."""
    if plan.phases is None:
        return {
            objective.name: Problem.value_of(machine, objective) for objective in plan.objectives
        }
    search = PhaseSearch(machine, plan.objectives, plan.phases, plan.combine)
    return {term.objective.name: term.value_at(search.present) for term in search.cost.terms}


def nothing_gained(balanced: Balanced) -> str | None:
    """The sentence that what was to become small hardly does; None where it does."""
    if balanced.advice is not None:
        return None if balanced.helps else " ".join(no_benefit_sentences(balanced))
    if balanced.gain > GAIN:
        return None
    return say(
        "nothing to gain: balancing would not make {aims} smaller by {share} %",
        aims=objectives_text(balanced),
        share=f"{100 * GAIN:g}",
    )


DIGITS = 9
"""Digits of a place: a program finds -1e-12 m beside 40 mm for 0."""


def balanced_design(base: PageDraft, balanced: Balanced) -> Design:
    """The balanced machine, whose masses on pins of the frame can be changed further.

    base : what was balanced.
    """
    weights = {
        **base.without(_taken_away(base, balanced)).counterweights,
        **_weights(base, balanced),
    }
    links = {}
    for name, link in balanced.machine.links.items():
        own, weight = base.own.links.get(name), weights.get(name)
        if own is not None and weight is not None:
            own = joined(own, weight, place_of_pin(base.own, name))
        if own is not None and _same(own, link):
            links[name] = base.own.links[name]
            continue
        links[name] = link if own is None else _clean(own, link)  # with its counterweight in it
        if weight is not None:
            weights[name] = replace(weight, mass=0.0)
    machine = replace(balanced.machine, links=links)
    machine = machine.with_balance(_plan_after(base.own.balance, machine))
    shafts = base.shafts & machine.links.keys() | machine.links.keys() - base.own.links.keys()
    return Design(base.name, machine, MappingProxyType(weights), frozenset(shafts))


def _plan_after(plan: Balance | None, machine: Machine) -> Balance | None:
    """The plan of the file in the machine that it has changed, whose new links have its names."""
    if plan is None:
        return None
    taken = {*machine.bodies}  # by the shafts that have been added
    geared = []
    for weight in plan.geared:
        name = _free_name(weight.name, taken, "{}")
        geared.append(replace(weight, name=name))
    shafts = []
    for pair in plan.shafts:
        name = _free_name(pair.name, taken, "{}-1", "{}-2")
        shafts.append(replace(pair, name=name))
    return replace(plan, geared=tuple(geared), shafts=tuple(shafts))


def _free_name(name: str, taken: set[str], *links: str) -> str:
    """The name, or with a number behind it, of which all links are free; these become taken."""
    plain = sub(r" \d+$", "", name)
    for candidate in (name, plain, *(f"{plain} {number}" for number in range(2, len(taken) + 3))):
        called = {link.format(candidate) for link in links}
        if not called & taken:
            taken |= called
            return candidate
    raise AssertionError  # there are more candidates than names


def _clean(own: Link, link: Link) -> Link:
    """A link whose point masses that are new have numbers as somebody would have given them."""
    bodies = [body if body in own.bodies else _rounded(body) for body in link.bodies]
    return link.altered(bodies=tuple(bodies)) if bodies else link


def _rounded(body: Body) -> Body:
    if not isinstance(body.at, tuple) or body.mass is None:
        return body
    x, y = clean_place(complex(*body.at), digits=DIGITS)
    at = clean(x, "length"), clean(y, "length")
    return replace(body, at=at, mass=clean(body.mass, "mass"))


def _weights(base: PageDraft, balanced: Balanced) -> dict[str, Counterweight]:
    """Masses that were found about pins of the frame, by link."""
    weights = {}
    for change in balanced.changes:
        link, values = change.link, dict(change.values)
        # No shaft that is new, and nothing beside the link's plane: a counterweight lies in it.
        known = link in base.own.links and "plane" not in values
        if known and values.get("pieces") and values["at"] == pin_of(base.own, link):
            beyond = values["inertia"] / values["mass"] - values["radius"] ** 2
            point = beyond <= SPREAD * values["radius"] ** 2
            weights[link] = Counterweight(
                clean(values["mass"], "mass"),
                clean(values["radius"], "length"),
                clean(values["direction"], "angle"),
                0.0 if point else clean(sqrt(beyond), "length"),
            )
    return weights


def _same(link: Link, other: Link) -> bool:
    """Whether two links are the same but for rounding in their masses."""
    size = max(abs(complex(*place)) for place in (*other.points.values(), _center(other)))
    numbers = ((link.mass, other.mass), (link.inertia, other.inertia))
    return (
        link.points == other.points
        and all(isclose(a or 0.0, b or 0.0, rel_tol=ROUNDED) for a, b in numbers)
        and dist(_center(link), _center(other)) <= ROUNDED * size
    )


def _center(link: Link) -> tuple[float, float]:
    return link.center_of_mass or (0.0, 0.0)


def balanced_values(base: Computed, after: Computed, balanced: Balanced) -> JsonObject:
    """What to change, aims and every figure before and after, and what is proved.

    base, after : the design before and after, computed; their figures
        are read from them as the page shows them.
    """
    replaced, shafts = _taken_away(base.design, balanced), _replaced_shafts(base.design, balanced)
    old, new = balanced.before, balanced.after
    names = [name for name in old if name in new and not name.startswith("planting.")]
    figures = {name: (old[name], new[name]) for name in names} | _read(base, after)
    return {
        "changes": [
            *(_taken_off(name, base.design.counterweights[name]) for name in replaced),
            *(say("{link}: take off this shaft", link=name) for name in shafts),
            *(line for change in balanced.changes for line in sentences(change)),
        ],
        "aims": [_aim(balanced, aim, figures) for aim in balanced.aims],
        "figures": [_figure(balanced, name, *figures[name]) for name in names],
        "worse": list(deterioration_sentences(balanced)),
        "gauges_worse": any(worse.group == "gauges" for worse in balanced.worse),
        "proof": " ".join(proof_sentences(balanced)),
        "notes": list(map(localized, balanced.notes)),
    }


def _taken_off(link: str, weight: Counterweight) -> str:
    mass = format_quantity(weight.mass, "mass")
    return say("{link}: take off the counterweight of {mass}", link=link, mass=mass)


def _read(base: Computed, after: Computed) -> dict[str, tuple[float, float]]:
    """Figures before and after as the page shows them, by name; SI units."""
    if base.analysis.machine.drive.acceleration:  # which balancing leaves out
        return {}
    figures = figures_of(after.analysis, base.analysis)
    pairs = {figure["name"]: (figure.get("before"), figure["value"]) for figure in figures}
    return {name: (a, b) for name, (a, b) in pairs.items() if a is not None and b is not None}


def _aim(
    balanced: Balanced, objective: Objective, figures: Mapping[str, tuple[float, float]]
) -> JsonObject:
    """What was to become small."""
    rows, pair = len(balanced.machine.rows), balanced.aims[objective]
    if not (objective.about or objective.orders or objective.speeds):
        name = f"{objective.output}.{objective.measure}"
        pair = figures.get(f"rows.{name}" if rows > 1 else name, pair)
    unit = shown_in(si_unit(objective, balanced.original), pair)
    before, after = (unit.factor * value for value in pair)
    return {"label": objective_named(objective, rows), "unit": unit.name, **compared(before, after)}


def _figure(balanced: Balanced, name: str, before: float, after: float) -> JsonObject:
    """A figure before and after; `main` where it is of a whole signal on the frame, or the mass."""
    main = True
    if name == "mass":
        label, unit = say("mass of the links"), display("mass", [before, after])
    else:
        output, _, measure = name.rpartition(".")
        item, _ = declared(output) or (None, "")
        whole = (
            item is not None and item.part not in ("x", "y") and item.group in ("forces", "rows")
        )
        main = whole and measure in MAIN
        label = figure_named(name, len(balanced.machine.rows))
        unit = shown_in(figure_unit(balanced, name), [before, after])
    values = compared(unit.factor * before, unit.factor * after)
    return {"label": label, "unit": unit.name, "main": main, **values}


@dataclass(frozen=True)
class Balancing:
    """What came of balancing a design.

    nothing : why it stays as it is; None where it changes.
    design : the balanced one.  content : what to change, figures and proof, as a page shows them.
    """

    nothing: str | None = None
    design: Design | None = None
    content: JsonObject = field(default_factory=dict)


def balancing_of(
    base: Computed, hold: bool, localized: Callable[[], AbstractContextManager[None]]
) -> Balancing:
    """Balance a design; errors as of `balance`.

    hold : as of `balanced`.  localized : context in the reader's language and units.
    """
    moved = base.moved
    result = balanced(moved, hold)
    with localized():
        nothing = nothing_gained(result)
    if nothing is not None:
        return Balancing(nothing)
    design = balanced_design(moved, result)
    after = solved(design)
    with localized():
        return Balancing(design=design, content=balanced_values(base, after, result))
