"""Whether a linkage can be balanced completely by its own masses, and the proof where it cannot.

What mass can do is a convex set, and the conditions of `balancing.conditions` are linear.  Where
both have nothing in common, a combination of the conditions is positive for all masses: the proof.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.balancing.linear_conditions import conditions
from equipoise.balancing.physical_consistency import ConsistentMasses
from equipoise.balancing.linear_conditions import reading
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

ASKED: dict[str, tuple[str, ...]] = {
    "shaking force": ("shaking_force",),
    "shaking moment": ("shaking_moment",),
    "shaking force and moment": ("shaking_force", "shaking_moment"),
}


@dataclass(frozen=True, eq=False)
class Proof:
    """A combination of the conditions that no distribution of mass can make zero.

    coefficients : (P,) of the parameters.  text : the combination in words.
    least : the least value that it can have, in `unit`.
    """

    coefficients: Array
    text: str
    least: float
    unit: str


@dataclass(frozen=True, eq=False)
class Answer:
    """Whether something can be balanced completely at constant crank speed, and why.

    what : of `ASKED`.
    possible : with every mass, and every moment of inertia about a centre of mass, at least as
        large as now.
    added_mass : least mass (kg) that has to be added to links, link -> kg; empty where every mass
        can stay as it is, None where it is not possible.  0 stands for a link that has no mass and
        needs some, however little.
    by_points : whether it is possible if links have no moments of inertia about their centres of
        mass, as mass points.  (With some of their moments of inertia, all is as with the whole.)
    reason : a sentence.
    proof : where it is not possible.
    """

    what: str
    possible: bool
    added_mass: Mapping[str, float] | None
    by_points: bool
    reason: str
    proof: Proof | None

    @property
    def masses_kept(self) -> bool:
        """Whether it is possible with every mass as it is."""
        return self.added_mass is not None and not self.added_mass

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        proof = None
        if self.proof is not None:
            proof = {name: getattr(self.proof, name) for name in ("text", "least", "unit")}
        return {
            "possible": self.possible,
            "masses_kept": self.masses_kept,
            "added_mass": None if self.added_mass is None else dict(self.added_mass),
            "by_points": self.by_points,
            "reason": self.reason,
            "proof": proof,
        }


@dataclass(frozen=True, eq=False)
class Verdict:
    """What of a machine can be balanced completely by redistributing and adding mass."""

    force: Answer
    moment: Answer
    both: Answer

    @property
    def answers(self) -> tuple[Answer, Answer, Answer]:
        return self.force, self.moment, self.both

    def __str__(self) -> str:
        return "\n".join(answer.reason for answer in self.answers)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        return {answer.what.replace(" ", "_"): answer.to_dict() for answer in self.answers}


def verdict(machine: Machine) -> Verdict:
    """Whether shaking force, shaking moment about the drive pivot, or both can be made zero.

    Mass may be moved within every link and added to it; the crank's speed is constant.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    """
    return Verdict(*(_answer(machine, what) for what in ASKED))


def _answer(machine: Machine, what: str) -> Answer:
    masses = ConsistentMasses.of(machine, conditions(machine, "zero", ASKED[what]))
    added = masses.least_added()
    if added is not None:
        return Answer(what, True, added, True, _possible(what, added), None)
    proof, points = _proof(machine, masses), masses.by_points()
    return Answer(what, False, None, points, _impossible(what, proof, points), proof)


def _proof(machine: Machine, masses: ConsistentMasses) -> Proof | None:
    found = masses.contradiction()
    if found is None:
        return None
    row, least = found
    words = reading(machine, row, signed=True)
    return Proof(row * words.factor, words.text, least * words.factor, words.unit)


def _possible(what: str, added: Mapping[str, float]) -> str:
    if not added:
        return f"The {what} can be made zero, with every mass as it is."
    where = ", ".join(
        f"{1e3 * more:.4g} g on {link}" if more else f"some mass, however little, on {link}"
        for link, more in added.items()
    )
    return f"The {what} can be made zero, but not with every mass as it is: it takes {where}."


def _impossible(what: str, proof: Proof | None, points: bool) -> str:
    if proof is None:
        return f"The {what} can at best be approached, by ever larger masses."
    because = (
        f"The {what} cannot be made zero: {proof.text} would have to be 0, but is at least "
        f"{proof.least:.4g} {proof.unit} with masses and moments of inertia no smaller than now"
    )
    if points:
        return f"{because}; only mass points, without moments of inertia, could do it."
    return f"{because}."
