"""What an engineer would point out when looking over a model that is formally right."""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, degrees, sqrt

from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import FRAME, size_of

POOR_TRANSMISSION = 30.0
"""Degrees from stretched or folded below which force is transmitted badly."""

WIDE_INERTIA = 5.0
"""Radius of gyration over size of the link above which a slip of units is likely."""


def remarks(linkage: Linkage) -> Iterator[str]:
    """Things worth a second look, each one sentence; none of them keeps a model from running."""
    machine = linkage.machine
    if missing := massless(machine):
        yield missing
    for joint, (number, angle) in linkage.cycle.weakest.items():
        transmission = degrees(asin(sqrt(min(number, 1.0))))
        if transmission < POOR_TRANSMISSION:
            yield (
                f"the dyad at {joint} comes within {transmission:.1f} deg of its dead position, at "
                f"crank angle {degrees(angle):.1f} deg; joint forces are large there"
            )
    for name, link in machine.links.items():
        size = size_of(link.points)
        if not link.mass or link.inertia is None or link.center_of_mass is None or not size:
            continue
        gyration = sqrt(link.inertia / link.mass)
        if gyration > WIDE_INERTIA * size:
            yield (
                f"links.{name}.inertia gives a radius of gyration of {gyration * 1e3:.4g} mm, for "
                f"a link of {size * 1e3:.4g} mm; check its unit"
            )
        x, y = link.center_of_mass
        px, py = next(iter(link.points.values()))
        if sqrt((x - px) ** 2 + (y - py) ** 2) > WIDE_INERTIA * size:
            yield f"links.{name}.center_of_mass lies far outside the link; check its unit"
    lone = [point for point in machine.frame if point not in linkage.joints.pins]
    used = {slider.through for slider in machine.sliders if slider.on == FRAME}
    used |= {spring.to for spring in machine.springs}
    for point in lone:
        if point not in used:
            yield f"frame.points.{point} is not used by any joint or spring"
