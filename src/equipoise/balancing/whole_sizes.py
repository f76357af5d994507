"""Counterweights of a plan in whole millimetres and degrees, as they are cut.

A plan's result is an optimum, whose sizes are any numbers.  A workshop cuts to whole ones; the
machine with these is computed again, and keeps the limits that the optimum keeps.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import ceil, floor, inf, isclose, isinf, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.balancing.design_variables import RADII, with_parameters
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.problem import ADDED, Problem
from equipoise.balancing.rounding import NEARLY
from equipoise.balancing.workshop import Change, PieceValues
from equipoise.i18n import Note, localized, say
from equipoise.mechanism.dynamics.parameters import parameter_values
from equipoise.mechanism.parts.balance import Balance
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import percent
from equipoise.results.outputs import objective_named, shown_in

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced, Price

MILLIMETRE, DEGREE = 1e-3, pi / 180
"""In SI units: what sizes are whole numbers of."""
WHOLE = 1e-6
"""Of a millimetre or degree, by which a size may be off a whole one."""
MATTERS = 1e-3
"""Of the value before: a change of the result that is reported, as `Balanced.proved` has it."""
LIMIT_ROUNDING = 1e-6
"""Of a limit, by which it may be exceeded by rounding of numbers."""

Round = Callable[[float], int]
WAYS: tuple[Round, ...] = (round, floor, ceil)
"""How sizes of a piece are rounded: to the nearest, to a lighter, to a heavier piece."""


def in_whole_sizes(balanced: Balanced) -> tuple[Balanced, str]:
    """The result with counterweights of whole sizes, and a sentence on what that changes.

    Sizes that the plan gives, such as the thickness of the plate, stay.  The sentence is empty
    where all sizes are whole already.  Where every rounding exceeds a limit the sizes stay, too.
    """
    if all(_is_whole(piece) for _, piece in _pieces(balanced.changes)):
        return balanced, ""
    exceeded = ""
    for way in WAYS:
        rounded = _rounded(balanced, way)
        exceeded = _exceeded(balanced, rounded)
        if not exceeded:
            return rounded, _difference(balanced, rounded)
    return balanced, say(
        "sizes of counterweights are given to 0.01 mm and 0.01 deg: rounded to whole millimetres "
        "and degrees they would exceed the limit on {name}",
        name=exceeded,
    )


def _pieces(changes: Sequence[Change]) -> Iterator[tuple[Change, PieceValues]]:
    for change in changes:
        for piece in change.values.get("pieces", ()):
            yield change, piece


def _rounded(balanced: Balanced, way: Round) -> Balanced:
    """The result with pieces of whole sizes, its figures computed anew."""
    machine, changes = balanced.machine, []
    for change in balanced.changes:
        if change.values.get("pieces"):
            new = _with_whole_pieces(change, way, _room(balanced.plan, change))
            machine = _with_mass(machine, change, new)
            changes.append(new)
        else:
            changes.append(change)
    aims = balanced.plan.objectives
    values = Problem.values_of(machine, aims)
    objectives = {
        aim.name: (balanced.objectives[aim.name][0], value)
        for aim, value in zip(aims, values, strict=True)
    }
    return replace(
        balanced,
        machine=machine,
        changes=tuple(changes),
        objectives=objectives,
        prices={**balanced.prices, **dict(_limits(balanced, machine, changes))},
    )


def _room(plan: Balance, change: Change) -> float:
    """How far from its centre a counterweight may reach, m."""
    at = change.values["at"]
    weights = [item.weight for item in plan.masses if (item.link, item.at) == (change.link, at)]
    weights += [geared.weight for geared in plan.geared if geared.name == change.link]
    if not weights:
        weights = [shafts.weight for shafts in plan.shafts]
    return max((weight.radius for weight in weights), default=inf)


def _limits(
    balanced: Balanced, machine: Machine, changes: Sequence[Change]
) -> Iterator[tuple[str, Price]]:
    """Limits on outputs, on the mass of each link and on all of it, with what is used of them."""
    limits = balanced.plan.limits
    values = Problem.values_of(machine, [limit.objective for limit in limits])
    for limit, value in zip(limits, values, strict=True):
        yield limit.name, replace(balanced.prices[limit.name], used=value)
    growth: dict[tuple[str, str], float] = {}
    for old, new in zip(balanced.changes, changes, strict=True):
        if old.values.get("pieces"):
            where = old.link, old.values["at"]
            gained = new.values["mass"] - old.values["mass"]
            growth[where] = growth.get(where, 0.0) + gained
    for name, price in balanced.prices.items():
        if name == ADDED:
            yield name, replace(price, used=price.used + sum(growth.values()))
        elif isinstance(name, Note) and name.template in RADII:
            point = _point_of_limit(balanced.plan, name)
            gained = sum(
                mass for (link, at), mass in growth.items()
                if link == name.values["link"] and point in (None, at)
            )  # fmt: skip
            yield name, replace(price, used=price.used + gained)


def _point_of_limit(plan: Balance, name: Note) -> str | None:
    """Point of the weight that a limit is named for, of a link with several; else None."""
    number: int | None = name.values.get("number")
    if number is None:
        return None
    same = [item.at for item in plan.masses if item.link == name.values["link"]]
    return same[number - 1]


def _exceeded(exact: Balanced, rounded: Balanced) -> str:
    """The first limit that rounded sizes do not keep; empty if they keep all."""
    for name, price in rounded.prices.items():
        most = max(price.at_most, exact.prices[name].used)
        if price.used > most + LIMIT_ROUNDING * abs(most):
            return localized(name)
    return ""


def _difference(exact: Balanced, rounded: Balanced) -> str:
    """What rounding of sizes changes, if it is seen in the result."""
    changed = []
    for aim in exact.plan.objectives:
        before, best = exact.objectives[aim.name]
        _, value = rounded.objectives[aim.name]
        if abs(value - best) > MATTERS * before:
            unit = shown_in(unit_of(aim, exact.original), [before, best, value])
            changed.append(
                say(
                    "{name} is {value} instead of {best} {unit}",
                    name=objective_named(aim, len(exact.original.rows)),
                    value=unit.text(value, digits=4),
                    best=unit.text(best, digits=4),
                    unit=unit.name,
                )
            )
    if changed:
        return say(
            "sizes of counterweights are rounded to whole millimetres and degrees: {changes}",
            changes=say("; ").join(changed),
        )
    return say(
        "sizes of counterweights are rounded to whole millimetres and degrees, which changes the "
        "result by less than {share} % of the value before",
        share=percent(MATTERS, 1),
    )


# -- pieces ----------------------------------------------------------------------------------------


def _is_whole(piece: PieceValues) -> bool:
    sizes = [*(value / MILLIMETRE for value in _lengths(piece)), *_angles(piece)]
    return all(abs(size - round(size)) < WHOLE for size in sizes)


def _lengths(piece: PieceValues) -> Iterator[float]:
    """Sizes that balancing chooses, m: those of a sector are its angles alone."""
    if piece["shape"] == "disc":
        yield from (2 * piece["radius"], *piece["place"])
    elif piece["shape"] == "ring":
        yield 2 * piece["outer_radius"]


def _angles(piece: PieceValues) -> Iterator[float]:
    """Degrees."""
    if piece["shape"] == "sector":
        yield from (piece["angle"] / DEGREE, piece["direction"] / DEGREE)


def _whole_piece(piece: PieceValues, way: Round, center: complex, room: float) -> PieceValues:
    """A piece of whole sizes inside its room: diameters and places in millimetres, angles in
    degrees.
    """
    plate = (piece.get("thickness") or 0.0) * (piece.get("density") or 0.0)
    if piece["shape"] == "disc":
        place = tuple(MILLIMETRE * round(item / MILLIMETRE) for item in piece["place"])
        most = room - abs(complex(*place) - center)
        radius = _half_of_whole(2 * piece["radius"], way, 2 * most)
        return {**piece, "radius": radius, "place": place, "mass": plate * pi * radius**2}
    if piece["shape"] == "ring":
        inner = piece["inner_radius"]
        # The next whole diameter beyond its hole is the thinnest ring that is left of it.
        least = floor(2 * inner / MILLIMETRE * (1 + WHOLE)) + 1
        outer = _half_of_whole(2 * piece["outer_radius"], way, 2 * room, least)
        mass = plate * pi * (outer**2 - inner**2)
        return {**piece, "outer_radius": outer, "mass": mass}
    if piece["shape"] == "sector":
        return _whole_sector(piece, way, plate)
    return piece


def _half_of_whole(diameter: float, way: Round, most: float, least: int = 1) -> float:
    """Radius of a circle of whole diameter, which is no larger than most, m; that of the diameter
    itself where there is no such circle.

    least : the smallest diameter, mm.
    """
    largest = most if isinf(most) else floor(most / MILLIMETRE * (1 + WHOLE))
    if largest < least:
        return diameter / 2
    return MILLIMETRE * min(max(way(diameter / MILLIMETRE), least), largest) / 2


def _whole_sector(piece: PieceValues, way: Round, plate: float) -> PieceValues:
    outer, inner = piece["outer_radius"], piece["inner_radius"]
    angle = DEGREE * min(max(way(piece["angle"] / DEGREE), 1), 360)
    direction = phase(rect(1.0, DEGREE * round(piece["direction"] / DEGREE)))
    center = complex(*piece["place"]) - rect(_reach(piece), piece["direction"])
    new = {**piece, "angle": angle, "direction": direction}
    place = center + rect(_reach(new), direction)
    mass = plate * angle / 2 * (outer**2 - inner**2)
    return {**new, "mass": mass, "place": (place.real, place.imag)}


def _reach(sector: PieceValues) -> float:
    """From the centre of a sector to its centre of mass, m."""
    outer, inner, half = sector["outer_radius"], sector["inner_radius"], sector["angle"] / 2
    return float(2 / 3 * sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2))


def _with_whole_pieces(change: Change, way: Round, room: float) -> Change:
    """A change with pieces of whole sizes, and the mass and moment that these have."""
    center = complex(*change.values["center"])
    pieces = [_whole_piece(piece, way, center, room) for piece in change.values["pieces"]]
    mass, first, inertia = _sum_of(pieces, center)
    moment = first - mass * center
    about = inertia - 2 * (center.conjugate() * first).real + mass * abs(center) ** 2
    values = {
        "mass": mass,
        "moment": abs(moment),
        "direction": phase(moment) if change.values["moment"] else 0.0,
        "radius": abs(moment) / mass if mass else 0.0,
        "inertia": about,
        "pieces": pieces,
    }
    return replace(change, values={**change.values, **values})


def _sum_of(pieces: Sequence[PieceValues], center: complex) -> tuple[float, complex, float]:
    """Mass, first moment and inertia of pieces about the origin of their link."""
    mass, first, inertia = 0.0, 0j, 0.0
    for piece in pieces:
        own, place = piece["mass"], complex(*piece["place"])
        mass, first = mass + own, first + own * place
        inertia += _inertia(piece, place, center)
    return mass, first, inertia


def _inertia(piece: PieceValues, place: complex, center: complex) -> float:
    """Of a piece about the origin of its link, kg m2; rings and sectors lie about a centre."""
    mass = float(piece["mass"])
    if piece["shape"] == "disc":
        return mass * (abs(place) ** 2 + float(piece["radius"]) ** 2 / 2)
    if piece["shape"] == "point":
        return mass * abs(place) ** 2
    about = (piece["outer_radius"] ** 2 + piece["inner_radius"] ** 2) / 2
    # From the centre to the centre of mass, and from there to the origin.
    return mass * float(about - abs(place - center) ** 2 + abs(place) ** 2)


def _with_mass(machine: Machine, old: Change, new: Change) -> Machine:
    """The machine with the masses of a new change in place of those of an old one."""
    center = complex(*old.values["center"])
    was, now = (_sum_of(change.values["pieces"], center) for change in (old, new))
    plane = old.values.get("plane")
    link = machine.links[old.link]
    if plane is not None and plane != link.plane:
        return _with_mass_beside(machine, old.link, plane, was, now)
    values = dict(zip(machine.links, parameter_values(machine).reshape(-1, 4), strict=True))
    mass, first, inertia = (after - before for before, after in zip(was, now, strict=True))
    change = np.array([mass, complex(first).real, complex(first).imag, inertia])
    return with_parameters(machine, old.link, values[old.link] + change)


def _with_mass_beside(
    machine: Machine, name: str, plane: float, was: tuple[Any, ...], now: tuple[Any, ...]
) -> Machine:
    """The machine with a mass in another plane than its link's changed: a body of that link.

    was, now : mass (kg), first moment (kg m) and inertia (kg m2) about the origin of the link.
    """
    mass, first, inertia = now
    place = first / mass
    body = Body("point", at=(place.real, place.imag), mass=mass,
                inertia=inertia - mass * abs(place) ** 2, plane=plane)  # fmt: skip
    bodies = [
        body if item.plane == plane and isclose(item.mass or 0.0, was[0], rel_tol=NEARLY) else item
        for item in machine.links[name].bodies
    ]
    return machine.with_link(name, bodies=tuple(bodies))
