"""What goes along where joints hold more than the motion needs: other points, so that they agree.

Bodies that never turn against each other are of one kind, such as cranks that are parallel.  Around
a ring of pins through bodies of two kinds the arms of each kind add up to nothing, as one kind
turns against the other.  These are linear equations of all points.  Of changes that fulfil
them with those that were asked for, that is made which moves the fewest points, least those of the
frame, and rather those near to what was moved.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, count, product

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.steps import planar
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.quantities import clean_place
from equipoise.signals import Array
from equipoise.web.design import DRAGGED

COINCIDENT = 1e-9
"""rad: by how much bodies turn against each other that count as one kind."""
FITS = 1e-10
"""Of the size of the machine: what rounding misses."""
FARTHER, OF_FRAME = 0.1, 10.0
"""Cost of moving a point for each pin on the way to what was moved, and for one of the frame."""
ROUNDS, LEAST, SAME, THERE = 30, 1e-9, 1e-12, 1e-6
"""Rounds of reweighted least squares; floor of the weights, and change that counts as one, over the
largest change; relative singular value below which equations are dependent."""

DragGoals = dict[str, tuple[int, complex]]
"""Points that are dragged: the sample at which each is to be at a place, m."""
BodySpot = tuple[str, str]
"""A body, and a point of it."""
Terms = dict[BodySpot, complex]
"""Factors of places of points in the axes of their bodies, in a sum."""


@dataclass(frozen=True)
class Following:
    """A machine whose points agree again, and what went along."""

    machine: Machine
    spots: tuple[BodySpot, ...]

    @property
    def note(self) -> Note:
        values = [
            Note("{what} of the frame", what=point)
            if body == FRAME
            else Note("{point} of {body!r}", point=point, body=body)
            for body, point in self.spots
        ]
        return Note("{spots} moved too, so that all joints fit", spots=all_of(values, commas=True))


def following(motion: Motion, machine: Machine, goals: DragGoals) -> Following | None:
    """The machine with dependent changes, from bodies that do not rotate relative to each other.

    motion : of the machine before it was changed.  goals : where points were dragged to.
    """
    rings = [*_rings(motion)]
    if not rings:
        return None
    was, size = _spots(motion.machine), extent_of(machine)
    now = _spots(machine)
    typed = {spot for spot, at in now.items() if at != was[spot] and spot[1] not in goals}
    given = {spot: at for spot, at in now.items() if any(spot[0] == body for body, _ in typed)}
    places = {**was, **given}
    free = [spot for spot in was if spot not in given]
    ways = [_way(motion, point, at) for point, (at, _) in goals.items()]
    wanted = np.array([0j] * len(rings) + [to for _, to in goals.values()])
    matrix, sums = _system([*rings, *ways], places, free)
    cost = _costs(motion.machine, free, {*goals, *(point for _, point in typed)})
    change = _fewest(matrix, wanted - sums, cost)
    moved = {spot: by for spot, by in zip(free, change, strict=True) if by}
    led = next((spot for spot in moved if spot[1] in goals), None)
    if led is not None:  # where it was put, in digits that a file is to have
        places[led] = complex(*clean_place(was[led] + moved.pop(led), size, DRAGGED))
    matrix, sums = _system(rings, places, [*moved])
    change = lstsq(matrix, -sums, rcond=None)[0]
    if np.max(np.abs(matrix @ change + sums)) > FITS * size:
        return None
    for spot, by in zip(moved, change, strict=True):
        places[spot] = complex(*clean_place(places[spot] + complex(by), size))
    return Following(_placed(machine, places), tuple(moved))


def extent_of(machine: Machine) -> float:
    """Size of the machine as a whole, m."""
    return max(map(abs, _spots(machine).values())) or 1.0


def _spots(machine: Machine) -> dict[BodySpot, complex]:
    """Place of every point in the axes of its body, m."""
    bodies = machine.bodies.items()
    return {(body, point): planar(at) for body, points in bodies for point, at in points.items()}


def _placed(machine: Machine, places: Mapping[BodySpot, complex]) -> Machine:
    """The machine with its points at other places, m."""
    bodies = {
        body: {point: (places[body, point].real, places[body, point].imag) for point in points}
        for body, points in machine.bodies.items()
    }
    links = {
        name: link if link.points == bodies[name] else link.altered(points=bodies[name])
        for name, link in machine.links.items()
    }
    return replace(machine, frame=bodies[FRAME], links=links)


# -- equations -------------------------------------------------------------------------------------


def _rings(motion: Motion) -> Iterator[Terms]:
    """What vanishes: the arms of one kind around a ring of pins through bodies of two kinds."""
    angles = {FRAME: np.zeros(len(motion.crank_angle))}
    angles |= {name: link.angle for name, link in motion.links.items()}
    kinds: list[list[str]] = []
    for body, angle in angles.items():
        like = (kind for kind in kinds if np.ptp(angle - angles[kind[0]]) <= COINCIDENT)
        kind = next(like, None)
        if kind is None:
            kinds.append([body])
        else:
            kind.append(body)
    for pair in combinations(kinds, 2):
        _, rings = _walk(motion, [*pair[0], *pair[1]])
        for ring, kind in product(rings, pair):
            yield {spot: factor * np.exp(1j * angles[spot[0]][0])
                   for spot, factor in ring.items() if spot[0] in kind}  # fmt: skip


def _walk(motion: Motion, bodies: list[str]) -> tuple[dict[str, Terms], list[Terms]]:
    """Ways to bodies from the first one of those joined to each other, and rings among them."""
    known: dict[str, Terms] = {}
    rings: list[Terms] = []
    pins = motion.linkage.joints.pins
    bodies_at = {point: [body for body in of if body in bodies] for point, of in pins.items()}
    left = [(point, of[0], other) for point, of in bodies_at.items() for other in of[1:]]
    for first in bodies:
        if first in known:
            continue
        known[first] = {}
        reached = [first]
        for body in reached:
            for pin in [pin for pin in left if body in pin[1:]]:
                left.remove(pin)
                point, other = pin[0], pin[2] if pin[1] == body else pin[1]
                way = {**known[body]}
                _add(way, (body, point), 1)
                _add(way, (other, point), -1)
                if other not in known:
                    known[other] = way
                    reached.append(other)
                    continue
                for spot, factor in known[other].items():
                    _add(way, spot, -factor)
                rings.append(way)
    return known, rings


def _add(terms: Terms, spot: BodySpot, factor: complex) -> None:
    terms[spot] = terms.get(spot, 0) + factor


def _way(motion: Motion, point: str, at: int) -> Terms:
    """Where a point is at a sample, as a sum of arms from the frame on."""
    bodies = motion.machine.bodies
    known, _ = _walk(motion, [*bodies])
    body = next(body for body in bodies if point in bodies[body])
    way = {**known[body]}
    _add(way, (body, point), 1)
    turns = {name: np.exp(1j * link.angle[at]) for name, link in motion.links.items()}
    return {spot: factor * turns.get(spot[0], 1) for spot, factor in way.items()}


def _system(
    sums: Sequence[Terms], places: Mapping[BodySpot, complex], free: Sequence[BodySpot]
) -> tuple[Array, Array]:
    """Factors of places that may change, (n, m), and what the sums are (n,), m."""
    matrix = np.array([[terms.get(spot, 0) for spot in free] for terms in sums], complex)
    values = [sum(factor * places[spot] for spot, factor in terms.items()) for terms in sums]
    return matrix.reshape(len(sums), len(free)), np.array(values, complex)


# -- the fewest changes ----------------------------------------------------------------------------


def _costs(machine: Machine, spots: Sequence[BodySpot], moved: set[str]) -> Array:
    """What it costs to move points of bodies by a unit of length, (n,)."""
    far, ring = dict.fromkeys(moved, 0), moved
    for steps in count(1):
        matching_bodies = {point for points in machine.bodies.values() if ring & points.keys()
                  for point in points}  # fmt: skip
        ring = matching_bodies - far.keys()
        far |= dict.fromkeys(ring, steps)
        if not ring:
            break
    farthest = len(far)
    return np.array([
        (1 + FARTHER * far.get(point, farthest)) * (OF_FRAME if body == FRAME else 1.0)
        for body, point in spots
    ])  # fmt: skip


def _fewest(matrix: Array, wanted: Array, cost: Array) -> Array:
    """The cheapest change (m,) with that of sums (n,): weighted least squares, again and again with
    weights by what the last ones found, until all that does not help is left alone.
    """
    change = np.ones(len(cost), complex)
    for _ in range(ROUNDS):
        least = LEAST * np.max(np.abs(change), initial=0.0)
        scale = (np.abs(change) + least) / cost
        old, change = change, scale * lstsq(matrix * scale, wanted, rcond=SAME)[0]
        if np.max(np.abs(change - old), initial=0.0) <= least:
            break
    helps = np.abs(change) > THERE * np.max(np.abs(change), initial=0.0)
    return np.where(helps, change, 0.0)
