"""Signs of elements that are drawn as marks, each by the function that its kind names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import Any

from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.symbols.shapes import Mark

Sign = Callable[[Any, Structure, Bodies, Mapping[str, float]], Iterator[Mark]]


@cache
def sign_of(kind: type[Element]) -> Sign | None:
    """What draws elements of a kind; None where this has no sign of its own."""
    module, _, name = kind.sign.partition(":")
    found: Sign | None = getattr(import_module(module), name) if module else None
    return found


def element_signs(
    elements: Iterable[Element], joints: Structure, bodies: Bodies, radii: Mapping[str, float]
) -> Iterator[Mark]:
    """The signs of each element that has one of its own.

    radii : of pins that are drawn to scale, by point, m.
    """
    for one in elements:
        kind: Any = type(one)
        if sign := sign_of(kind):
            yield from sign(one, joints, bodies, radii)
