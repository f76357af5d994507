"""Signs of parts that are drawn as marks, each by the function that its kind names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.element_kinds import PartKind
from equipoise.symbols.shapes import BodyMark

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine, Slider

UPPERMOST = ("rider", "face")
"""Roles of shapes that no other sign covers."""


@dataclass(frozen=True)
class Surroundings:
    """What a sign may depend on beside its part.

    machine : makes the whole machine, which a sketch may not be.
    radii : of pins that are drawn to scale, by point, m.
    travel : tells how far a slider is along its guide, m, at one or at all crank angles.
    """

    machine: Callable[[], Machine]
    joints: Structure
    bodies: Bodies
    radii: Mapping[str, float]
    travel: Callable[[Slider], Any]


Sign = Callable[[Any, Surroundings], Iterator[BodyMark]]


@cache
def sign_of(kind: type[PartKind]) -> Sign | None:
    """What draws parts of a kind; None where this has no sign of its own."""
    module, _, name = kind.sign.partition(":")
    sign: Sign | None = getattr(import_module(module), name) if module else None
    return sign


def signs_of(table: str, part: PartKind, around: Surroundings) -> list[BodyMark]:
    """The signs of a part, if its kind has one.  table : key of its list."""
    kind: Any = type(part)
    sign = sign_of(kind)
    marks = sign(part, around) if sign else ()
    return [replace(mark, table=table, legend=part.legend) for mark in marks]


def in_order(marks: Iterable[BodyMark]) -> tuple[BodyMark, ...]:
    """Marks, of which those come last that no other covers."""
    return tuple(sorted(marks, key=lambda mark: mark.shape.role in UPPERMOST))
