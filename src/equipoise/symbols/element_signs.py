"""Signs of elements that are drawn as marks, by their kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.torsion_springs import TorsionSpring
from equipoise.symbols.shapes import Mark
from equipoise.symbols.slots import circular_sign, curved_sign
from equipoise.symbols.torsion_springs import torsion_sign

SIGNS: Mapping[type[Element], Callable[[Any, Structure, Bodies], Iterator[Mark]]] = {
    TorsionSpring: torsion_sign,
    CircularSlot: circular_sign,
    CurvedSlot: curved_sign,
}


def element_signs(elements: Iterable[Element], joints: Structure, bodies: Bodies) -> Iterator[Mark]:
    """The signs of each element that has one of its own."""
    for one in elements:
        if sign := SIGNS.get(type(one)):
            yield from sign(one, joints, bodies)
