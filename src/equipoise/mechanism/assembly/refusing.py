"""Designs that no machine can have: the checks of a `Machine`, on columns of numbers."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from math import pi
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.cam_demands import can_be_made
from equipoise.mechanism.assembly.cam_fits import fits_of
from equipoise.mechanism.assembly.family import Columns, joints_of
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, planar
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.pitch_curves import can_roll
from equipoise.mechanism.parts.planes import demands_across
from equipoise.mechanism.parts.racks import Rack
from equipoise.quantities.units import HUGE, TINY


def wrong(machine: Machine, base: Linkage, columns: Columns) -> Array:
    """Which of the designs (P,) no machine can have."""
    count = max((len(column) for column in columns.values()), default=1)
    found = np.zeros((count, 1), dtype=bool)
    with np.errstate(all="ignore"):
        for column in columns.values():
            size = np.abs(column)
            found |= ~((size <= HUGE) & ((size >= TINY) | (size == 0)))
        for right in _demands(machine, base):
            found |= np.logical_not(right)
    return found[:, 0]


def _demands(machine: Machine, base: Linkage) -> Iterator[Any]:
    """What has to be true of the numbers of a machine: flags, or columns of them."""
    for body in (FRAME, *machine.links):
        points = machine.points_of(body)
        places = [planar(points[point]) for point in points if point in base.joints.pins]
        yield from (one != other for one, other in combinations(places, 2))
    for link in machine.links.values():
        if link.mass is not None and link.inertia is not None:
            yield (link.mass >= 0) & (link.inertia >= 0)
            yield (link.mass > 0) | (np.asarray(link.inertia) == 0)
        yield from link.demands()
    for belt in machine.belts:
        points = machine.points_of(belt.carrier)
        driver, driven = (planar(points[pin]) for pin in coupling_pins(base.joints, belt))
        yield abs(driver - driven) > sum(belt.pitch_radii)
        yield belt.tension is None or belt.tension > 0
    fits = fits_of(machine, joints_of(machine, base)) if machine.cams else ()
    yield from (can_be_made(fit) for fit in fits if np.ndim(fit.rest))
    toothed: tuple[Gear | Rack, ...] = (*machine.gears, *machine.racks)
    for gear in toothed:
        yield (gear.pressure_angle >= 0) & (np.asarray(gear.pressure_angle) < pi / 2)
    for pair in machine.gears:
        if pair.shape is not None and pair.shape.varies:
            yield can_roll(pair.shape, pair)
    yield from demands_across(machine)
    for *_, element in machine.force_elements:
        yield from element.demands()
