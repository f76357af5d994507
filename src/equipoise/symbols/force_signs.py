"""Signs of force elements that are drawn as marks, by their kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.force_kinds import ForceElement
from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from equipoise.symbols.shapes import Mark
from equipoise.symbols.torsion_springs import torsion_sign

SIGNS: Mapping[type[ForceElement], Callable[[Any, Structure, Bodies], Mark]] = {
    TorsionSpring: torsion_sign,
}


def force_signs(
    elements: Iterable[ForceElement], joints: Structure, bodies: Bodies
) -> Iterator[Mark]:
    """The sign of each force element that has one of its own."""
    for one in elements:
        if sign := SIGNS.get(type(one)):
            yield sign(one, joints, bodies)
