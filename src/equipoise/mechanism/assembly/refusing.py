"""Designs that no machine can have: the checks of a `Machine`, on columns of numbers."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.cam_fits import can_be_made, fits_of
from equipoise.mechanism.assembly.family import Columns, joints_of
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, planar
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.planes import demands_across
from equipoise.quantities.units import HUGE, TINY


def invalid_designs(machine: Machine, base: Linkage, columns: Columns) -> Array:
    """Which of the designs (P,) no machine can have."""
    count = max((len(column) for column in columns.values()), default=1)
    values = np.zeros((count, 1), dtype=bool)
    with np.errstate(all="ignore"):
        for column in columns.values():
            size = np.abs(column)
            values |= ~((size <= HUGE) & ((size >= TINY) | (size == 0)))
        for right in _demands(machine, base):
            values |= np.logical_not(right)
    return values[:, 0]


def _demands(machine: Machine, base: Linkage) -> Iterator[Any]:
    """What has to be true of the numbers of a machine: flags, or columns of them."""
    for body in (FRAME, *machine.links):
        points = machine.bodies[body]
        places = [planar(points[point]) for point in points if point in base.joints.pins]
        yield from (place != other for place, other in combinations(places, 2))
    for link in machine.links.values():
        if link.mass is not None and link.inertia is not None:
            yield (link.mass >= 0) & (link.inertia >= 0)
            yield (link.mass > 0) | (np.asarray(link.inertia) == 0)
        yield from link.demands()
    for coupling in machine.couplings:
        yield from coupling.demands(partial(_distance, machine, base, coupling))
    fits = fits_of(machine, joints_of(machine, base)) if _has_surfaces(machine) else ()
    yield from (can_be_made(fit) for fit in fits if np.ndim(fit.rest))
    yield from demands_across(machine)
    for *_, element in machine.elements:
        yield from element.demands()


def _has_surfaces(machine: Machine) -> bool:
    return any(coupling.contact == "surface" for coupling in machine.couplings)


def _distance(machine: Machine, base: Linkage, coupling: Coupling) -> Any:
    """Of the pins of driver and driven body."""
    points = machine.points_of(coupling.carrier)
    driver, driven = (planar(points[pin]) for pin in coupling_pins(base.joints, coupling))
    return abs(driven - driver)
