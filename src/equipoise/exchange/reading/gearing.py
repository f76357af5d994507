"""Gears in files that know only sums of angles of joints that stay what they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import permutations

import numpy as np

from equipoise.decompositions import lstsq
from equipoise.errors import ModelError
from equipoise.exchange.reading.spatial import Array, Space
from equipoise.i18n import Note
from equipoise.mechanism.kinematics.outline import MachineDraft
from equipoise.mechanism.parts.machine import FRAME, Gear

EXACT = 1e-9
"""Share of a factor by which another may differ from it: rounding."""
Chains = Mapping[str, frozenset[str]]


def gears(
    space: Space, link_of: Mapping[str, str], normal: Array, outline: MachineDraft, crank: str
) -> Iterator[Gear]:
    """Pairs of gears that hold the sums of a system.

    link_of : the link of each body.  normal : of the plane, (3,).  crank : the driven link.

    Raises
    ------
    ModelError : there is none on a common carrier that does.
    """
    chains = {body: frozenset(_chain(space, link_of, body)) for body in outline.bodies}
    around = _around(outline)
    moved = {crank, FRAME}
    for name, factors in space.sums:
        wanted = {joint: factor * float(np.sign(space.joints[joint].axis @ normal))
                  for joint, factor in factors.items()}  # fmt: skip
        able = [item for item in _fitting(around, chains, wanted) if item.driven not in moved]
        if not able:
            raise ModelError(
                name,
                Note(
                    "it ties joints together otherwise than a pair of gears on a common "
                    "carrier does; leave it out"
                ),
            )
        gear = min(able, key=lambda gear: (gear.driver not in moved, _joints(outline, gear.driven)))
        moved.add(gear.driven)
        yield gear


def _joints(outline: MachineDraft, link: str) -> int:
    """At how many points a link is pinned; what is driven by gears alone has one."""
    return sum(link in bodies for bodies in outline.joints.pins.values())


def _chain(space: Space, link_of: Mapping[str, str], body: str) -> Iterator[str]:
    """Hinges whose angles add up to that of a link."""
    holding = {link_of[joint.child]: joint for joint in space.joints.values()}
    while body != FRAME and (joint := holding.pop(body, None)) is not None:
        if joint.kind == "hinge":
            yield joint.name
        body = link_of[joint.parent]


def _around(outline: MachineDraft) -> dict[str, list[str]]:
    """Of every body those that share one pin with it, about which they can turn on it."""
    bodies = outline.bodies
    return {body: [other for other in bodies if other != body
                   and len(bodies[body].keys() & bodies[other].keys()) == 1]
            for body in bodies}  # fmt: skip


def _fitting(
    around: Mapping[str, list[str]], chains: Chains, wanted: Mapping[str, float]
) -> Iterator[Gear]:
    """Pairs of gears that hold such a sum."""
    for carrier, bodies in around.items():
        for driven, driver in permutations(bodies, 2):
            three = [chains[body] for body in (driven, driver, carrier)]
            if frozenset().union(*three) - frozenset.intersection(*three) != wanted.keys():
                continue
            ratio = _ratio(wanted, *three)
            if driven != FRAME and ratio not in (None, 0.0, 1.0):
                yield Gear(driver, driven, ratio=ratio, carrier=carrier)


def _ratio(
    wanted: Mapping[str, float],
    driven: frozenset[str],
    driver: frozenset[str],
    carrier: frozenset[str],
) -> float | None:
    """The ratio r of which driven - r driver + (r - 1) carrier is a multiple of a sum, if any."""
    joints = [*(driven | driver | carrier | wanted.keys())]
    values = np.array([[joint in chain for joint in joints] for chain in (driven, driver, carrier)])
    own, geared, carried = values.astype(float)
    sides = np.column_stack([own - carried, carried - geared])
    right = np.array([wanted.get(joint, 0.0) for joint in joints])
    (scale, scaled), _, rank, _ = lstsq(sides, right)
    left = np.abs(sides @ (scale, scaled) - right).max()
    if rank < 2 or left > EXACT * np.abs(right).max() or abs(scale) < EXACT:
        return None
    return float(scaled / scale)
