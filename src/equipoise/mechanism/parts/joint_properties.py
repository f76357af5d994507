"""Properties of single joints, which the points that bodies share do not say.

A joint is named by the output of its force.  Whatever else a joint has of its own, such as friction
or clearance, is a further key here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Conditions, Frozen, Text, any_of, declared, key

JOINTS = ("pin", "slider")
"""Kinds of joints that hold bodies together, which no coupling is."""


def family_of(kind: str) -> str:
    """How the outputs begin that are forces of a kind of joint, or of the couplings of a list."""
    return "joints." if kind in JOINTS else f"{kind}."


@declared
class JointProperties(Frozen):
    """Properties of one joint, each of which may be left out."""

    called = to_say("{what} of joint {number}")
    file_order = ("joint", "radius", "stiffness")
    conditions: ClassVar[Conditions] = any_of("radius", "stiffness")

    joint: str = key(
        Text(),
        "the name of its force in outputs; `joints.B` is a whole pin, of however many links",
        example="joints.B",
    )
    radius: float | None = key("length", "of a pin", default=None, example="6 mm", above=0)
    stiffness: float | None = key(
        "stiffness",
        "by which joints share forces that statics leaves open",
        default=None,
        example="20000 kN/m",
        above=0,
    )


def wrong_joint(where: str, one: JointProperties, families: Iterable[str]) -> Iterator[ModelError]:
    """Report what is wrong with an entry by itself; the linkage knows which joints there are.

    families : groups of outputs that are forces of joints and couplings.
    """
    if not one.joint.startswith((*(f"{family}." for family in families),)):
        told = Note("got {joint!r}; give a joint as joints.B", joint=one.joint)
        yield ModelError(f"{where}.joint", told)
    if one.radius is None and one.stiffness is None:
        yield ModelError(where, Note("give radius, stiffness or both of the joint"))
