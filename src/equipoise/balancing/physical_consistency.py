"""Whether a linkage can be balanced completely by its own masses, and the proof where it cannot.

Any distribution of mass in a link has mass m, first moment S and moment of inertia J about the
origin of its axes with (J - I) m >= |S|^2, where I is the moment of inertia about the centre of
mass: a convex set, of second-order cones.  Here m and I are no smaller than now.  A set of linear
conditions, as those of `linear_conditions`, either has a solution among these, or a combination of
the conditions has a positive least value for all masses (Farkas): the proof.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from equipoise.balancing.linear_conditions import (
    SHOWN,
    Conditions,
    ParameterEffects,
    ParameterSum,
    machine_size,
    parameter_scales,
    reading,
)
from equipoise.balancing.program import Affine, NoSolutionError, Program
from equipoise.dataclass import dataclass
from equipoise.decompositions import pinv
from equipoise.i18n import Note, series, to_say
from equipoise.mechanism.dynamics.parameters import QUANTITIES
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import SI, display
from equipoise.signals import Array

MASS, X, Y, INERTIA = range(len(QUANTITIES))
EXACT = (1e-10,)
"""Asked of the solver: a link without mass has none, not even a billionth."""
SMALL = 1e-6
"""Relative to the mass of the machine, and this at its size: less is what the solver leaves."""
TRACE = 1e-3
"""The same, where a link without mass needs some."""
PIVOT, ROUNDING = 1e-10, 1e-12
"""Relative sizes below which a number counts as none."""
SUSPECT = (1e-2, 1e-4, ROUNDING)
"""Shares of the largest factor of a combination below which one may be rounding: tried in turn."""
MOST = 1e4
"""Times the mass of the machine, and this at its size: more no link gets, where the solver needs a
bound."""


@dataclass(frozen=True, eq=False)
class ConsistentMasses:
    """What masses are free to do, all relative to mass and size of the machine.

    rows : (B, P) conditions, orthogonal to each other.
    mass, inertia : (L,) least ones, inertia about centres of mass.
    unit : kg.  scale : (P,) of the parameters, in SI units.
    """

    links: tuple[str, ...]
    rows: Array
    mass: Array
    inertia: Array
    unit: float
    scale: Array

    @classmethod
    def of(cls, machine: Machine, conditions: Conditions) -> ConsistentMasses:
        links = machine.links
        mass = np.array([link.mass or 0.0 for link in links.values()])
        inertia = np.array([link.inertia or 0.0 for link in links.values()])
        unit = float(np.sum(mass)) or 1.0
        scale = parameter_scales(machine) * unit
        rows = np.linalg.qr((conditions.coefficients * scale).T)[0].T
        least = inertia / (unit * machine_size(machine) ** 2)
        return cls(tuple(links), rows, mass / unit, least, unit, scale)

    def least_added(self) -> dict[str, float] | None:
        """Least mass to be added, kg by link; None where no mass suffices.

        0 stands for a link without mass that needs some, however little.
        """
        program, x, share = self._program()
        program.zero(Affine.of(share, 1.0, -1.0))
        exact = program.copy()
        exact.zero(Affine.of(x[:, MASS], np.eye(len(x)), -self.mass))
        # The cone says as much of a link without mass, but too faintly for the solver to be sure.
        moments = x[self.mass == 0][:, [X, Y]].ravel()
        exact.zero(Affine.of(moments, np.eye(len(moments))))
        if exact.feasible(stalled=False):
            return {}
        program.cost = dict.fromkeys(x[:, MASS].tolist(), 1.0)
        try:
            masses = program.solve().x[x[:, MASS]]
        except NoSolutionError:
            return None
        added = dict(zip(self.links, (masses - self.mass).tolist(), strict=True))
        massless = [link for link, own in zip(self.links, self.mass, strict=True) if own == 0]
        traces = [link for link in massless if SMALL < added[link] <= TRACE]
        least = TRACE if traces else SMALL
        by_name = {link: mass * self.unit for link, mass in added.items() if mass > least}
        return by_name | dict.fromkeys(sorted(traces), 0.0)

    def by_points(self) -> bool:
        """Whether links without moments of inertia could meet the conditions.

        The conditions and the cones stay as they are when all masses grow alike; so moments of
        inertia can be kept whole, with more mass, or not at all.
        """
        program, _, share = self._program()
        program.nonnegative(Affine.of(share, [[1.0], [-1.0]], [0.0, 1.0]))
        program.cost = {int(share): -1.0}  # with a cost the solver is surer than without one
        try:
            program.solve()
        except NoSolutionError:
            return False
        return True

    def _program(self) -> tuple[Program, Array, Any]:
        """Parameters (L, 4) that meet the conditions, and the share of inertia that is kept."""
        program = Program(tolerances=EXACT)
        x = program.numbers(self.rows.shape[1]).reshape(-1, len(QUANTITIES))
        share = program.numbers(1)[0]
        program.zero(Affine.of(x.ravel(), self.rows))
        program.nonnegative(Affine.of(x[:, MASS], np.eye(len(x)), -self.mass))
        for (mass, first, second, inertia), own in zip(x, self.inertia, strict=True):
            program.rotated(
                Affine.of([inertia, share], [1.0, -own]),
                Affine.of(mass, 1.0),
                Affine.of([first, second], np.eye(2)),
            )
        return program, x, share

    def contradiction(self) -> tuple[Array, float] | None:
        """A combination (P,) of the conditions with a positive least value, and that value.

        In SI units.  None where the solver found none: the conditions can be met, or as nearly as
        one likes.
        """
        for bounded in (False, True):
            program, y = self._combinations(bounded)
            try:
                result = program.solve().x[y]
            except NoSolutionError:
                continue
            for share in SUSPECT:
                combination = self._tidied(result, share)
                size = float(np.max(np.abs(combination)))
                if size <= SMALL:  # all of it is what the solver leaves of zero
                    continue
                least = self._least(combination / size)
                if least > SMALL:
                    return combination / self.scale, size * least
        return None

    def _combinations(self, bounded: bool) -> tuple[Program, Array]:
        """Combinations y (B,) of the conditions, with minus their least value as cost.

        The factors of all masses and inertias add up to at most 1.  Often one ray of combinations
        alone has a least value for all masses; so that rounding does not lose it, bounds of mass
        and inertia, with prices, leave room about it.
        """
        program = Program(tolerances=EXACT)
        count = len(self.links)
        y, lost = program.numbers(len(self.rows)), program.numbers(count)
        prices = program.numbers(2 * count if bounded else 0)
        factors = self.rows.T.reshape(count, len(QUANTITIES), -1)
        for k, (own, less) in enumerate(zip(factors, lost, strict=True)):
            light, slow = prices[k : k + 1], prices[count + k : count + k + 1]
            values = np.ones(len(light))
            program.nonnegative(Affine.of([*y, less, *light], [[*own[MASS], -1.0, *values]]))
            program.rotated(
                Affine.of([*y, *slow], [[*own[INERTIA], *values]]),
                Affine.of(less, 1.0),
                Affine.of(y, own[[X, Y]] / 2),
            )
        if bounded:
            program.nonnegative(Affine.of(prices, np.eye(2 * count)))
        whole = np.sum(factors[:, [MASS, INERTIA]], axis=(0, 1))
        program.nonnegative(Affine.of(y, -whole, 1.0))
        least = self.mass @ factors[:, MASS] + self.inertia @ factors[:, INERTIA]
        bounds = MOST - np.concatenate([self.mass, self.inertia])
        costs = [*-least, *self.mass, *bounds[: len(prices)]]
        program.cost = dict(zip([*y, *lost, *prices], map(float, costs), strict=True))
        return program, y

    def _tidied(self, y: Array, share: float) -> Array:
        """The combination (P,) next to one that has no factors below a share of the largest."""
        combination = y @ self.rows
        gone = np.abs(combination) < share * np.max(np.abs(combination))
        unwanted = self.rows[:, gone].T
        unwanted = np.where(np.abs(unwanted) < PIVOT, 0.0, unwanted)  # no inverse of rounding
        tidied = (y - pinv(unwanted, rcond=PIVOT) @ (unwanted @ y)) @ self.rows
        gone_too = np.allclose(tidied[gone], 0.0, atol=ROUNDING)
        return np.where(gone, 0.0, tidied) if gone_too else combination

    def _least(self, combination: Array) -> float:
        """Least value of a combination (P,); minus infinity where it has none.

        Of a link's factors a it is a_J I + (a_m - |a_S|^2 / 4 a_J) m with the least m and I, where
        the bracket is not negative.
        """
        total = 0.0
        rounding = PIVOT * float(np.max(np.abs(combination)))
        of_links = combination.reshape(-1, len(QUANTITIES))
        for own, mass, inertia in zip(of_links, self.mass, self.inertia, strict=True):
            moments = float(own[X] ** 2 + own[Y] ** 2)
            turning = max(float(own[INERTIA]), 0.0)
            lost = np.inf if moments > rounding else 0.0
            if turning > rounding:
                lost = moments / (4 * turning)
            bracket = float(own[MASS]) - lost
            if bracket < -SMALL or own[INERTIA] < -rounding:
                return -np.inf
            total += turning * inertia + max(bracket, 0.0) * mass
        return total


ASKED: dict[str, tuple[str, ...]] = {
    to_say("shaking force"): ("shaking_force",),
    to_say("shaking moment"): ("shaking_moment",),
    to_say("shaking force and moment"): ("shaking_force", "shaking_moment"),
}


@dataclass(frozen=True, eq=False)
class Proof:
    """A combination of the conditions that no distribution of mass can make zero.

    coefficients : (P,) of the parameters.  reading : the combination in words, and `text` the same.
    least : the least value that it can have, in `unit`.
    """

    coefficients: Array
    reading: ParameterSum
    least: float
    unit: str

    @property
    def text(self) -> str:
        return self.reading.text

    def to_dict(self) -> dict[str, Any]:
        return {"text": self.text, "least": self.least, "unit": self.unit}


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
    proof : where it is not possible; None where it can be approached as nearly as one likes.
    """

    what: str
    possible: bool
    added_mass: Mapping[str, float] | None
    by_points: bool
    proof: Proof | None

    @property
    def reason(self) -> Note:
        if self.added_mass is not None:
            return _possible(self.what, self.added_mass)
        return _impossible(self.what, self.proof, self.by_points)

    @property
    def masses_kept(self) -> bool:
        """Whether it is possible with every mass as it is."""
        return self.added_mass is not None and not self.added_mass

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        return {
            "possible": self.possible,
            "masses_kept": self.masses_kept,
            "added_mass": None if self.added_mass is None else dict(self.added_mass),
            "by_points": self.by_points,
            "reason": self.reason,
            "proof": None if self.proof is None else self.proof.to_dict(),
        }


@dataclass(frozen=True, eq=False)
class Feasibility:
    """What of a machine can be balanced completely by redistributing and adding mass."""

    force: Answer
    moment: Answer
    both: Answer

    @property
    def answers(self) -> tuple[Answer, ...]:
        return self.force, self.moment, self.both

    def __str__(self) -> str:
        return "\n".join(answer.reason for answer in self.answers)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        return {answer.what.replace(" ", "_"): answer.to_dict() for answer in self.answers}


def feasibility(machine: Machine) -> Feasibility:
    """Whether shaking force, shaking moment about the drive pivot, or both can be made zero.

    Mass may be moved within every link and added to it; the crank's speed is constant.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    """
    effects = ParameterEffects.of(machine)
    return Feasibility(*(_answer(machine, effects, what) for what in ASKED))


def _answer(machine: Machine, effects: ParameterEffects, what: str) -> Answer:
    masses = ConsistentMasses.of(machine, effects.conditions("zero", ASKED[what]))
    added = masses.least_added()
    if added is not None:
        return Answer(what, True, added, True, None)
    proof, points, pair = None, masses.by_points(), masses.contradiction()
    if pair is not None:
        row, least = pair
        read = reading(machine, row, signed=True)
        proof = Proof(row * read.factor, read, least * read.factor, read.unit)
    return Answer(what, False, None, points, proof)


def _possible(what: str, added: Mapping[str, float]) -> Note:
    if not added:
        return Note("The {what} can be made zero, with every mass as it is.", what=Note(what))
    unit = display("mass", [*added.values()])
    weights = [
        Note("{mass} on {link}", mass=f"{unit.factor * mass:.4g} {unit.unit}", link=link)
        if mass
        else Note("some mass, however little, on {link}", link=link)
        for link, mass in added.items()
    ]
    return Note(
        "The {what} can be made zero, but not with every mass as it is: it takes {weights}.",
        what=Note(what),
        weights=series(weights),
    )


def _impossible(what: str, proof: Proof | None, points: bool) -> Note:
    if proof is None:
        return Note(
            "The {what} can at best be approached, by ever larger masses or moments of inertia.",
            what=Note(what),
        )
    words = proof.reading.words
    dimension, _ = SHOWN[proof.unit]
    unit = display(dimension, [proof.least], SI[dimension])
    because = Note(
        "The {what} cannot be made zero: {words} would have to be 0, but is at least {least} with "
        "masses and moments of inertia no smaller than now",
        what=Note(what),
        words=words,
        least=f"{unit.factor * proof.least:.4g} {unit.unit}",
    )
    if points:
        template = to_say("{because}; only mass points, without moments of inertia, could do it.")
        return Note(template, because=because)
    return Note("{because}.", because=because)
