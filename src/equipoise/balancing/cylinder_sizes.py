"""What a cylinder whose force is large has to be: its bore, its rod, and whether it can be built.

Closed, a cylinder is as long as its stroke and what piston, gland and eyes need; a longer lever
takes less force over more stroke, and is named only where the cylinder of it can be built.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import pi
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import (
    BUCKLING_SAFETY,
    CYLINDER_PRESSURE,
    DEAD_BORES,
    LEAST_GAIN,
    LONGER_LEVERS,
    THICK_ROD,
    THIN_ROD,
)
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.i18n import say, to_say
from equipoise.quantities import display, format_quantity, number, percent
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import FigureAssessment, pusher_of
from equipoise.signals import Array

STOCK = (8, 10, 12, 16, 20, 25, 32, 40, 50, 63, 80, 100, 125, 140, 160, 180, 200, 220, 250, 280,
         320, 360, 400, 450, 500)  # fmt: skip
"""Bores, mm, of ISO 3320; above 125 of its second choice, too."""
RODS = (4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50, 56, 63, 70, 80, 90,
        100, 110, 125, 140, 160, 180, 200, 220, 250, 280, 320, 360)  # fmt: skip
"""Diameters of rods, mm, of ISO 3320."""
BAR = 1e5
"""Pa."""
MODULUS = 210e9
"""Pa, of steel."""


@dataclass(frozen=True)
class LongerLever:
    """A pin of a cylinder farther from the pivot.

    point : the pin.  distance : m, from the pivot.  force : N, largest then.
    closed, open : m, lengths of the cylinder then.
    """

    point: str
    distance: float
    force: float
    closed: float
    open: float

    declared: ClassVar[Declarations] = {
        "point": ResultOutput("pin of the cylinder that moves"),
        "distance": ResultOutput("of it from the pivot", "length"),
        "force": ResultOutput("largest then", "force"),
        "closed": ResultOutput("shortest length of the cylinder then", "length"),
        "open": ResultOutput("longest length then", "length"),
    }


@dataclass(frozen=True)
class Cylinder:
    """The cylinder whose force is the largest figure.

    push, pull : N, largest each way.  closed, open : m, its shortest and longest length.
    pressure : Pa, at which `bore` (m) holds the force.  rod : m, that does not buckle.
    dead : m, of its closed length, for piston, gland and eyes.
    is_buildable : whether its stroke fits beside that.
    is_slender : whether the rod has to be thicker than usual, so as not to buckle.
    pivot : the pin about which it turns its link; empty where there is no single one.
    lever : a longer one whose cylinder can be built, and that takes enough of the force.
    is_lever_stopped : whether there is none because no cylinder of one can be built.
    """

    push: float
    pull: float
    closed: float
    open: float
    pressure: float
    bore: float
    rod: float
    dead: float
    is_buildable: bool
    is_slender: bool
    pivot: str
    lever: LongerLever | None
    is_lever_stopped: bool

    declared: ClassVar[Declarations] = {
        "push": ResultOutput("largest force that pushes", "force"),
        "pull": ResultOutput("largest force that pulls", "force"),
        "closed": ResultOutput("shortest length", "length"),
        "open": ResultOutput("longest length", "length"),
        "pressure": ResultOutput("at which the bore holds the force", "modulus"),
        "bore": ResultOutput("of the cylinder", "length"),
        "rod": ResultOutput("diameter of a rod that does not buckle", "length"),
        "dead": ResultOutput("of the closed length, for piston, gland and eyes", "length"),
        "is_buildable": ResultOutput("whether its stroke fits beside that"),
        "is_slender": ResultOutput("whether the rod is thicker than usual, so as not to buckle"),
        "pivot": ResultOutput("about which it turns its link; empty where there is no single one"),
        "lever": ResultOutput("a longer one that can be built, or null", of=LongerLever.declared),
        "is_lever_stopped": ResultOutput("whether there is none because none can be built"),
    }


def cylinder_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> Cylinder | None:
    """The cylinder whose force is the largest figure; None where it is no cylinder's, or small, or
    where no bore in stock holds it.
    """
    machine, motion = analysis.machine, analysis.resolved.motion
    largest = next(iter(entries), None)
    drive = None if largest is None else pusher_of(machine, largest.output)
    if largest is None or drive is None or drive.between is None or not largest.is_large:
        return None
    force = analysis.outputs[largest.output].resolved
    first, second = (motion.points[at].place for at in drive.between)
    length = np.abs(second - first)
    if (sizes := _sized(force, length)) is None:
        return None
    bore, rod = sizes
    closed, most = float(np.min(length)), float(np.max(length))
    bodies = machine.bodies
    first_bodies, second_bodies = (set(bodies[body]) for body in drive.ends(bodies))
    shared = first_bodies & second_bodies
    pivot = next(iter(shared)) if len(shared) == 1 else ""
    levers = [*_longer(analysis, force, drive.between, pivot)] if pivot else []
    built = [item for item, fits in levers if fits]
    return Cylinder(
        push=float(max(np.max(force), 0.0)), pull=float(max(-np.min(force), 0.0)),
        closed=closed, open=most, pressure=CYLINDER_PRESSURE, bore=bore, rod=rod,
        dead=DEAD_BORES * bore,
        is_buildable=_fits(closed, most, bore), is_slender=rod > _usual_rod(bore),
        pivot=pivot, lever=min(built, key=lambda lever: lever.force, default=None),
        is_lever_stopped=bool(levers) and not built,
    )  # fmt: skip


def _fits(closed: float, most: float, bore: float) -> bool:
    """Whether a cylinder has room for its stroke while it is closed."""
    return most - closed + DEAD_BORES * bore <= closed * (1 + NEARLY)


def _usual_rod(bore: float) -> float:
    return next(rod / 1e3 for rod in RODS if rod / 1e3 >= THIN_ROD * bore)


def _sized(force: Array, length: Array) -> tuple[float, float] | None:
    """The smallest bore in stock that holds forces (N,) both ways, and its rod, m.

    A rod of diameter d with pins at both ends of the length L buckles from pi^3 E d^4 / (64 L^2)
    on; that the tube is stiffer is left to the safety.
    """
    pushed = float(np.max(np.maximum(force, 0.0) * length**2))
    stiff = (64 * BUCKLING_SAFETY * pushed / (pi**3 * MODULUS)) ** 0.25
    for bore in (size / 1e3 for size in STOCK):
        rod = next((d / 1e3 for d in RODS if d / 1e3 >= max(stiff, THIN_ROD * bore)), None)
        if rod is None or rod > THICK_ROD * bore:
            continue
        push, pull = (CYLINDER_PRESSURE * pi / 4 * area for area in (bore**2, bore**2 - rod**2))
        if np.max(force) <= push and -np.min(force) <= pull:
            return bore, rod
    return None


def _longer(
    analysis: Analysis, force: Array, ends: tuple[str, str], pivot: str
) -> Iterator[tuple[LongerLever, bool]]:
    """Longer levers of either pin that take enough of the force, and whether the cylinder of each
    can be built.

    The cylinder, which has no mass, gives the same moment about the pivot as before: with the pins
    at a and b, seen from the pivot, its lever is |Im(conj(a) b)| / |b - a|.
    """
    points = analysis.resolved.motion.points
    pins = [points[at].place - points[pivot].place for at in ends]
    before = float(np.max(np.abs(force)))
    moment = force * _arm(*pins)
    for k, longer_lever in product(range(2), LONGER_LEVERS):
        moved = [pin * (longer_lever if j == k else 1.0) for j, pin in enumerate(pins)]
        length = np.abs(moved[1] - moved[0])
        needed = moment / _arm(*moved)
        most, sizes = float(np.max(np.abs(needed))), _sized(needed, length)
        if sizes is not None and most <= (1 - LEAST_GAIN) * before:
            low, high = float(np.min(length)), float(np.max(length))
            distance = float(np.max(np.abs(moved[k])))
            yield LongerLever(ends[k], distance, most, low, high), _fits(low, high, sizes[0])


def _arm(a: Array, b: Array) -> Array:
    """Lever (N,) of a cylinder between two pins, seen from the pivot, m; its sign is its sense."""
    return np.asarray(np.imag(np.conj(a) * b) / np.abs(b - a))


# -- sentences -------------------------------------------------------------------------------------


def cylinder_sentences(cylinder: Cylinder) -> Iterator[str]:
    """The bore at a pressure, the rod where it is slender, and a lever that can be built."""
    words = {
        "pressure": number(cylinder.pressure / BAR, digits=3),
        "bore": format_quantity(cylinder.bore, "length", "mm", digits=3),
        "rod": format_quantity(cylinder.rod, "length", "mm", digits=3),
        "open": format_quantity(cylinder.open, "length", digits=3),
    }
    usual = to_say("At {pressure} bar a cylinder of {bore} bore with a rod of {rod} holds that.")
    slender = to_say(
        "At {pressure} bar a cylinder of {bore} bore holds that; {open} long, it takes a rod of "
        "{rod} not to buckle."
    )
    yield say(slender if cylinder.is_slender else usual, **words)
    unit_display = display("length", [cylinder.closed, cylinder.open])
    if not cylinder.is_buildable:
        yield say(
            "Closed it is {closed}, which leaves no room for its stroke of {stroke} and {dead} of "
            "piston and ends: it cannot be built so.",
            closed=unit_display.with_unit(unit_display.text(cylinder.closed, digits=3)),
            stroke=unit_display.with_unit(
                unit_display.text(cylinder.open - cylinder.closed, digits=3)
            ),
            dead=unit_display.with_unit(unit_display.text(cylinder.dead, digits=3)),
        )
    if (lever := cylinder.lever) is not None:
        yield say(
            "With {point} {distance} from {pivot} it needs {share} % less force, and is from "
            "{closed} to {open} long, which can be built.",
            point=lever.point,
            distance=format_quantity(lever.distance, "length", digits=3),
            pivot=cylinder.pivot,
            share=percent(1 - lever.force / max(cylinder.push, cylinder.pull)),
            closed=format_quantity(lever.closed, "length", digits=3),
            open=format_quantity(lever.open, "length", digits=3),
        )
    elif cylinder.is_lever_stopped and cylinder.is_buildable:
        yield say(
            "A longer lever about {pivot} would need a stroke for which its closed length, "
            "{closed}, has no room.",
            pivot=cylinder.pivot,
            closed=format_quantity(cylinder.closed, "length", digits=3),
        )
