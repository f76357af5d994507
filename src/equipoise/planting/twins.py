"""Arms that are alike on a carrier: what one does, the other does at another crank angle.

Gears are told by their angles at crank angle 0, at which the arms are not in the same place.  Where
the shape of gears changes these angles have to follow, or the arms would no longer be alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import degrees

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.tip import planting_of, tip_link
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array

ALIKE = 1e-5
"""Gears of arms that are this far, rad, from doing the same do it to the digits of a file."""
CLOSE, LATER = 1e-3, (0.7, 1.9, 3.1, 4.3, 5.5)
"""Gears that come closer to each other than this, rad, at these crank angles go the same way."""


@dataclass(frozen=True)
class Twin:
    """A gear of a further arm, and that of the first arm whose part it takes.

    gear, mate : places in the list, of its pair and of the first arm's.
    ahead : angle of the further arm on the carrier, from the first one, rad.
    offset : of the angle of the gear from that of the mate this much later, rad.
    """

    gear: int
    mate: int
    ahead: float
    offset: float


def twins_of(machine: Machine) -> tuple[Twin, ...]:
    """Gears of further arms on the drive that are like those of the first one."""
    planting = planting_of(machine)
    if not planting.arms or not machine.gears:
        return ()
    links = [tip_link(machine, arm.tip) for arm in planting.every_arm]
    first, *further = ([*_chain(machine, link)] for link in links)
    values = [pair for chain in further for pair in _paired(machine, first, chain)]
    starts = np.array([machine.gears[gear].start for gear, _, _ in values])
    offsets = starts - _angles(machine, [(mate, ahead) for _, mate, ahead in values])
    return tuple(Twin(*pair, offset) for pair, offset in zip(values, offsets.tolist(), strict=True))


def kept_alike(machine: Machine, twins: Sequence[Twin]) -> Machine:
    """The machine with gears of further arms at the angles that belong to those of the first."""
    if not twins:
        return machine
    angles = _angles(machine, [(twin.mate, twin.ahead) for twin in twins])
    gears = list(machine.gears)
    for twin, angle in zip(twins, angles.tolist(), strict=True):
        start = float(np.angle(np.exp(1j * (angle + twin.offset))))
        gears[twin.gear] = replace(gears[twin.gear], start=start)
    return replace(machine, gears=tuple(gears))


def nearly_alike(machine: Machine) -> Iterator[Note]:
    """Gears of further arms that would do what those of the first do at another start."""
    twins = twins_of(machine)
    met = kept_alike(machine, [replace(twin, offset=0.0) for twin in twins])
    if not all(_goes_with(met, twin) for twin in twins):
        return
    for twin in twins:
        off = float(np.angle(np.exp(1j * twin.offset)))
        if abs(off) > ALIKE:
            gear, mate = machine.gears[twin.gear], machine.gears[twin.mate]
            yield Note(
                "{link} does not do what {mate} does: for that gears[{number}] would start at "
                "{start:.7g} deg",
                link=gear.driven,
                mate=mate.driven,
                number=twin.gear + 1,
                start=degrees(gear.start - off),
            )


def _goes_with(machine: Machine, twin: Twin) -> bool:
    """Whether a gear does what its mate does at some more crank angles than that of the start."""
    own = _angles(machine, [(twin.gear, item) for item in LATER])
    mates = _angles(machine, [(twin.mate, item + twin.ahead) for item in LATER])
    return bool(np.max(np.abs(np.exp(1j * own) - np.exp(1j * mates))) < CLOSE)


def _chain(machine: Machine, link: str) -> Iterator[int]:
    """Gears from that of an arm back to one that stands still."""
    for _ in machine.gears:
        number = next((k for k, gear in enumerate(machine.gears) if gear.driven == link), None)
        if number is None:
            return
        yield number
        link = machine.gears[number].driver


def _paired(
    machine: Machine, first: Sequence[int], other: Sequence[int]
) -> Iterator[tuple[int, int, float]]:
    """Gear of another arm and of the first, and the angle between both on the carrier; none of
    arms that are not alike.
    """
    carrier = machine.links[machine.drive.link].points
    if len(first) != len(other) or machine.pushers:
        return
    pivot = complex(*carrier[assemble(machine).pivot])
    for mate, number in zip(first, other, strict=True):
        gears = [machine.gears[mate], machine.gears[number]]
        if any(gear.carrier != machine.drive.link for gear in gears):
            return
        points = [machine.links[gear.driven].points for gear in gears]
        pins = [next(place for name, place in carrier.items() if name in own) for own in points]
        arms = [complex(*pin) - pivot for pin in pins]
        yield number, mate, float(np.angle(arms[1] / arms[0]))


def _angles(machine: Machine, places: Sequence[tuple[int, float]]) -> Array:
    """Angles (n,), rad, of driven gears at crank angles."""
    theta = np.array([[crank_angle for _, crank_angle in places]])
    state = Family([assemble(machine)]).solve(theta)
    driven = [machine.gears[gear].driven for gear, _ in places]
    turned = [state[f"u({link})"][0, k] for k, link in enumerate(driven)]
    angles: Array = np.angle(np.array(turned, complex))
    return angles
