"""Friction in joints: dry with a Stribeck peak, viscous, and a constant drag.

A joint that turns or slides at the speed v, rad/s or m/s, resists with the torque or force

    f = -(sign(v) (mu(v) P + D) + c v),    mu(v) = mu + (mu_0 - mu) exp(-(s / v_s)^2)

where s is the sliding speed, D the drag and c the damping.  P presses the surfaces on each other:
the force of a pin, at its radius; of a pin in a slot that of the slot; of a slider its normal force
N or, with a guide of length l and a moment M about the slider's point, the sum max(|N|, 2 |M| / l)
of the forces at both its ends.  Couplings lose a share mu of what they pass on: P is
their tangential force, at the pitch radius of the driven one, and v how fast that turns, or a rack
slides, on its carrier.

The pass over the joints is linear in what acts on links, friction too.  So what presses in each
joint is known, by one stack of passes, as a sum of what it is without friction and of what a unit
of each friction adds, which depends on the pose alone and is kept with it.  Then the law is put
into itself, at all crank angles at once, until it holds: where friction changes what presses by
less than itself, this converges to the only solution, and in few rounds, as coefficients are small.
Elsewhere friction follows by Newton's method.  Where coefficients grow from 0, the solution changes
smoothly until the matrix of this method is singular: there a machine locks itself, and beyond no
drive torque moves it that way.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from math import degrees
from typing import Any, TypeVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import svd
from equipoise.errors import LockError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.dynamics.reactions import (
    Acting,
    Demand,
    JointFriction,
    JointReactions,
    demands_of,
    reactions,
)
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.friction_joints import RubbingJoint, rates_of, rubbing_joints
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.signals import Array

Demands = Mapping[str, Demand]
Cached = TypeVar("Cached")

CLOSE = 1e-13
"""Share of the largest friction at a crank angle by which the law may be missed."""
MOST_ROUNDS = 20
"""Of Newton's method, which takes 3 to 6: the law is a piecewise linear or a smooth one."""
FIRST_INSERTIONS, MOST_INSERTIONS = 2, 16
"""Of the law into itself, after which it is looked at whether it holds, and at most.  Machines of
usual coefficients take 5 to 10 of these, each of which costs a tenth of a round of Newton's method;
what takes more is left to that."""
FLANKS = 8
"""Rounds after which flanks, or strands, that friction loads the other way have to stay."""
FIRST_STEP, LAST_STEP = 0.25, 1e-4
"""Shares of the coefficients, by which they grow at first, and at least, where a machine is looked
at that may lock itself."""
LEADING = 0.3
"""Share of the largest power, in the friction forces that grow where it locks, of a joint that is
named."""


@dataclass(frozen=True, eq=False)
class FrictionLaw:
    """The joints of a motion that resist it, with what does not depend on their forces.

    rates : (J, N) rad/s or m/s.  grip : (J, N) with the sign of the motion, what friction is of
    what presses: coefficients times radii.  given : (J, N) drag and viscous part, N m or N.
    sides : how many of the joints, the last ones, are meshes that press with their backward flank
        alone, where their push is below 0.
    """

    joints: tuple[RubbingJoint, ...]
    rates: Array
    grip: Array
    given: Array
    sides: int = 0

    @classmethod
    def of(cls, joints: Sequence[RubbingJoint], rates: Array, senses: Array) -> FrictionLaw:
        """From speeds (J, N) of the joints, and the signs that count where they are 0."""
        grip, given = np.zeros((2, *rates.shape))
        for k, joint in enumerate(joints):
            item, mu = joint.given, joint.coefficient
            if item.static_friction is not None and item.stribeck_speed is not None:
                slides = joint.reach * rates[k] / item.stribeck_speed
                grip[k] += (item.static_friction - mu) * np.exp(-(slides**2))
            grip[k] += mu
            grip[k] *= joint.reach
            damping, drag = joint.unloaded
            if damping or drag:
                given[k] = senses[k] * drag + damping * rates[k]
        return cls(tuple(joints), rates, grip * senses, given)

    def with_sides(self, sides: Sequence[RubbingJoint]) -> FrictionLaw:
        """With efforts of backward flanks of so many meshes, each as large as what presses."""
        if not sides:
            return self
        zeros = np.zeros((len(sides), self.rates.shape[1]))
        rates, given = (np.concatenate([item, zeros]) for item in (self.rates, self.given))
        grip = np.concatenate([self.grip, zeros - 1.0])
        return FrictionLaw((*self.joints, *sides), rates, grip, given, len(sides))

    @cached_property
    def levers(self) -> Array:
        """(J, 2): by which both parts of what presses count; see `pressing_parts`."""
        rows = []
        for joint in self.joints:
            length = joint.given.guide_length
            rows.append((1.0, 1.0 if not joint.slides else 2 / length if length else 0.0))
        return np.array(rows)

    @cached_property
    def sliders(self) -> Array:
        """Places of joints whose force presses across their guide; that of all others presses
        whatever its direction, and both its parts count as they are.
        """
        return np.flatnonzero([joint.slides for joint in self.joints])

    def pressing(self, parts: Array) -> Array:
        """What presses (J, N), N, by parts (J, 2, N)."""
        size = _length(parts[:, 0], parts[:, 1])
        if len(sliders := self.sliders):
            size[sliders] = np.max(np.abs(parts[sliders]) * self.levers[sliders, :, None], axis=1)
        if self.sides:
            size[-self.sides :] = np.maximum(-parts[-self.sides :, 0], 0.0)
        return size

    def slopes(self, parts: Array) -> Array:
        """Derivatives (J, 2, N) of what presses by parts (J, 2, N)."""
        scaled = parts * self.levers[..., None]
        size = _length(scaled[:, 0], scaled[:, 1])
        slopes = scaled / np.where(size > 0, size, 1.0)[:, None]
        if len(sliders := self.sliders):
            own = scaled[sliders]
            first, second = np.abs(own[:, 0]), np.abs(own[:, 1])
            slopes[sliders] = np.sign(own) * np.stack([first >= second, second > first], axis=1)
        if self.sides:
            slopes[-self.sides :, 0] = np.where(parts[-self.sides :, 0] < 0, -1.0, 0.0)
        return np.asarray(slopes * self.levers[..., None])

    def followed(self, parts: Array) -> Array:
        """Friction (J, N) of what presses, by its parts (J, 2, N)."""
        size = self.pressing(parts)
        size *= self.grip
        size += self.given
        return np.negative(size, out=size)

    def residual(self, efforts: Array, share: Array, press: Press) -> tuple[Array, Array]:
        """Residual (J, N) of the law at efforts (J, N), and its derivatives (J, J, N) by them.

        share : (N,) of the coefficients.
        """
        parts, grip = press.parts(efforts), share * self.grip
        residual = efforts + grip * self.pressing(parts) + self.given
        slopes = grip[:, None] * self.slopes(parts)
        slope = slopes[:, 0, None] * press.response[:, 0]
        slope += slopes[:, 1, None] * press.response[:, 1]
        own = np.arange(len(self.joints))
        slope[own, own] += 1.0
        return residual, slope

    def contraction(self, press: Press) -> Array:
        """By which share of itself (N,), at most, friction changes friction, whatever presses.

        Below 1 rows of the derivatives have more on their diagonal than beside it, and the law put
        into itself converges by this share each time.
        """
        couplings = np.abs(self.grip) * np.einsum("jc,jcn->jn", np.abs(self.levers), press.most)
        return np.asarray(np.max(couplings, axis=0, initial=0.0))

    def at(self, some: Array) -> FrictionLaw:
        """At some of the N crank angles."""
        return FrictionLaw(self.joints, self.rates[:, some], self.grip[:, some],
                           self.given[:, some], self.sides)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Press:
    """What presses in joints, as parts: x and y of a pin's force, normal force and moment of a
    slider.

    without : (J, 2, N) without friction.  response : (J, 2, J, N) to a unit of each friction.
    most : (J, 2, N) that a unit of every friction adds at most, of whatever signs.
    """

    without: Array
    response: Array
    most: Array

    @classmethod
    def of(cls, without: Array, response: Array) -> Press:
        """With what units add at most."""
        return cls(without, response, most_added(response))

    def parts(self, efforts: Array) -> Array:
        """(J, 2, N), with friction (J, N)."""
        parts = np.einsum("jckn,kn->jcn", self.response, efforts)
        parts += self.without
        return np.asarray(parts)

    def at(self, some: Array) -> Press:
        """At some of the N crank angles."""
        return Press(self.without[..., some], self.response[..., some], self.most[..., some])


def most_added(response: Array) -> Array:
    """What a unit of every friction (J, 2, J, N) adds at most (J, 2, N), of whatever signs."""
    return np.asarray(np.sum(np.abs(response), axis=2))


def _length(x: Array, y: Array) -> Array:
    """Of vectors, in a fifth of the time that `hypot` takes to keep forces of 1e154 N and more."""
    size = x * x
    size += y * y
    return np.asarray(np.sqrt(size, out=size))


# -- the law and the balance of forces together ----------------------------------------------------


def balanced(law: FrictionLaw, press: Press, start: Array | None = None) -> tuple[Array, Array]:
    """Friction (J, N) that obeys the law with the forces that it makes itself, and the share (N,)
    of the coefficients up to which there is one: 1 where it is that of the whole.
    """
    efforts = law.followed(press.without if start is None else press.parts(start))
    whole, contraction = np.ones(law.rates.shape[1]), law.contraction(press)
    contracts = contraction < 1
    good = np.zeros_like(contracts)
    if np.any(contracts):
        inserted, converged = _inserted(law, press, efforts, contraction)
        good = converged & contracts
        efforts = inserted if np.all(good) else np.where(good, inserted, efforts)
    for some in (contracts, ~contracts):
        if len(rest := np.flatnonzero(some & ~good)):
            own, own_press = law.at(rest), press.at(rest)
            efforts[:, rest], good[rest] = _newton(
                own, own_press, efforts[:, rest], whole[rest], some is contracts
            )
    if len(bad := np.flatnonzero(~good)):
        efforts[:, bad], whole[bad] = _grown(law.at(bad), press.at(bad))
    return efforts, whole


def _inserted(
    law: FrictionLaw, press: Press, efforts: Array, contraction: Array
) -> tuple[Array, Array]:
    """Efforts (J, N) by the law put into itself, and where (N,) they obey it: what the last time
    has changed, times the contraction (N,), is what they miss it by at most.
    """
    for _ in range(1, FIRST_INSERTIONS):
        efforts = law.followed(press.parts(efforts))
    size = np.max(np.abs(efforts), axis=0) + np.max(np.abs(law.given), axis=0)
    start, last = efforts, None
    for _ in range(MOST_INSERTIONS - FIRST_INSERTIONS):
        efforts = law.followed(press.parts(start))
        change = efforts - start
        good = contraction * np.max(np.abs(change), axis=0) <= CLOSE * size
        if np.all(good):
            break
        start, last = _ahead(efforts, change, last), (efforts, change)
    return efforts, good


def _ahead(efforts: Array, change: Array, last: tuple[Array, Array] | None) -> Array:
    """Efforts (J, N) from which the law is put into itself next: what makes the change (J, N) the
    least on the line through these and the last, as of Anderson; these themselves at first.
    """
    if last is None:
        return efforts
    turned = change - last[1]
    size = np.sum(turned * turned, axis=0)
    share = np.sum(turned * change, axis=0) / np.where(size > 0, size, 1.0)
    return np.asarray(efforts - share * (efforts - last[0]))


def _newton(
    law: FrictionLaw, press: Press, efforts: Array, share: Array, contracts: bool
) -> tuple[Array, Array]:
    """Efforts (J, N), and where they obey the law and are those that grow from none (N,).

    contracts : as the law says of all these crank angles.
    """
    step_of = _eliminated if contracts else _step
    for _ in range(MOST_ROUNDS):
        residual, slopes = law.residual(efforts, share, press)
        size = np.max(np.abs(efforts), axis=0, initial=0.0) + np.max(np.abs(law.given), axis=0)
        good = np.max(np.abs(residual), axis=0) <= CLOSE * size
        if np.all(good):
            break
        step = step_of(slopes, residual)
        efforts = efforts - np.where(np.isfinite(step), step, 0.0)
    return efforts, good if contracts else good & _grows_from_none(slopes)


def _eliminated(slopes: Array, residual: Array) -> Array:
    """A step (J, N) of Newton's method by elimination of all crank angles at once, without a
    search for pivots, of which rows with more on the diagonal than beside it have no need.
    """
    left, right = slopes.copy(), residual.copy()
    count = len(right)
    for k in range(count - 1):
        share = left[k + 1 :, k] / left[k, k]
        left[k + 1 :, k + 1 :] -= share[:, None] * left[k, None, k + 1 :]
        right[k + 1 :] -= share * right[k]
    for k in reversed(range(count)):
        right[k] -= np.sum(left[k, k + 1 :] * right[k + 1 :], axis=0)
        right[k] /= left[k, k]
    return np.asarray(right)


def _step(slopes: Array, residual: Array) -> Array:
    """A step (J, N) of Newton's method; NaN where its matrix (J, J, N) is singular."""
    slopes = np.moveaxis(slopes, -1, 0)
    with np.errstate(all="ignore"):
        try:
            return np.asarray(np.linalg.solve(slopes, residual.T[..., None])[..., 0].T)
        except np.linalg.LinAlgError:
            singular = ~(np.abs(np.linalg.det(slopes)) > 0)
            slopes = np.where(singular[:, None, None], np.nan, slopes)
            return np.asarray(np.linalg.solve(slopes, residual.T[..., None])[..., 0].T)


def _grows_from_none(slopes: Array) -> Array:
    """Whether determinants (N,) are above 0, as they are without friction; which they are, too,
    where friction's part of the matrix (J, J, N) has row sums below 1.
    """
    own = np.eye(len(slopes))[..., None]
    if np.max(np.sum(np.abs(slopes - own), axis=1), initial=0.0) < 1:
        return np.ones(slopes.shape[-1], bool)
    return np.asarray(np.linalg.det(np.moveaxis(slopes, -1, 0)) > 0)


def _grown(law: FrictionLaw, press: Press) -> tuple[Array, Array]:
    """Efforts by coefficients that grow step by step from 0, and the share that they reach."""
    share = np.zeros(law.rates.shape[1])
    step = np.full_like(share, FIRST_STEP)
    efforts = -law.given
    while np.any(going := (share < 1) & (step >= LAST_STEP)):
        some = np.flatnonzero(going)
        tried = np.minimum(share[some] + step[some], 1.0)
        own, own_press = law.at(some), press.at(some)
        result, good = _newton(own, own_press, efforts[:, some], tried, contracts=False)
        efforts[:, some[good]], share[some[good]] = result[:, good], tried[good]
        step[some] *= np.where(good, 1.0, 0.5)
    return efforts, share


# -- of a motion -----------------------------------------------------------------------------------


def law_of(motion: Motion) -> FrictionLaw:
    """The law of the joints of a motion."""
    joints = rubbing_joints(motion.linkage)
    rates = _cached(motion, "rates of friction", joints, lambda: rates_of(joints, motion))
    return FrictionLaw.of(joints, rates * motion.speed, np.sign(rates * motion.speed))


def response_of(
    motion: Motion, joints: Sequence[RubbingJoint], units: Sequence[Demands]
) -> tuple[Array, Array]:
    """Parts (J, 2, J, N) of what presses in joints with a unit of friction in each of them, where
    no coupling bears on one flank or the other, and what they add at most (J, 2, N).
    """
    response = _cached(motion, "response to friction", joints,
                     lambda: pressing_rows(motion, units, joints, None))  # fmt: skip
    return response, _cached(motion, "most friction", joints, lambda: most_added(response))


def _cached(
    motion: Motion, what: str, joints: Sequence[RubbingJoint], compute: Callable[[], Cached]
) -> Cached:
    """What depends on the pose and on which joints rub alone: kept with the state of the motion."""
    name = f"{what}({', '.join(joint.name for joint in joints)})"
    if name not in motion.state:
        motion.state[name] = compute()
    value: Cached = motion.state[name]
    return value


def unit_demands(motion: Motion, joints: Sequence[RubbingJoint]) -> list[dict[str, Demand]]:
    """What holds a unit of friction in each joint, on both its bodies."""
    demands = []
    for joint in joints:
        if not joint.slides:
            lever = joint.lever(motion)
            demands.append({joint.on: (0j, -lever), joint.by: (0j, lever)})
            continue
        at, along = joint.place(motion), joint.direction(motion)
        ends: list[Acting] = [(joint.on, at, along, 0.0), (joint.by, at, -along, 0.0)]
        demands.append(demands_of(motion, ends))
    return demands


def pressing_parts(
    solved: JointReactions, joints: Sequence[RubbingJoint], shape: tuple[int, ...]
) -> Array:
    """Parts (J, 2, ..., N) of what presses in joints, of a pass whose values have a shape."""
    motion, values = solved.motion, []
    for joint in joints:
        reaction, state = joint.reaction, solved.state
        if joint.mesh is not None:
            push = np.broadcast_to(state[f"T({reaction.name})"], shape).real
            values.append((push, np.zeros(shape)))
            continue
        force = np.broadcast_to(state[reaction.force], shape)
        if not joint.slides:
            values.append((force.real, force.imag))
            continue
        moment: Any = np.zeros(shape)
        if reaction.couple is not None:
            arm = state[f"p({reaction.at})"] - joint.place(motion)
            moment = np.broadcast_to(state[reaction.couple], shape) + cross(arm, force)
        values.append((cross(joint.direction(motion), force), moment))
    return np.array(values)


def with_friction(
    motion: Motion, demands: Demands, like: JointReactions | None = None
) -> JointReactions:
    """Joint forces that meet the demands of all links, and friction as it follows from them.

    like : as of `reactions`.

    Raises
    ------
    LockError : the machine locks itself.
    """
    law = law_of(motion)
    units = _units(motion, law.joints)
    result = like
    if result is None and motion.machine.switches:
        result = reactions(motion, demands)
    start: Array | None = None
    for _ in range(FLANKS):
        press = press_of(motion, demands, law.joints, units, result)
        efforts, whole = balanced(law, press, start)
        if np.any(whole < 1):
            raise _locked(motion, law, press, efforts, whole)
        solved = reactions(motion, added(demands, units, efforts), like)
        if result is None or like is not None or _same_flanks(result, solved):
            break
        result, start = solved, efforts
    size = law.pressing(press.parts(efforts))
    frictions = [
        JointFriction(
            joint.on,
            joint.by,
            not joint.slides and not joint.centres,
            efforts[k],
            size[k],
            law.rates[k],
            joint.reach,
            "" if joint.mesh is None else joint.mesh.list_name,
            joint.mesh is None or joint.on_surface,
        )
        for k, joint in enumerate(law.joints)
    ]
    names = [joint.name for joint in law.joints]
    return JointReactions(motion, solved.state, dict(zip(names, frictions, strict=True)))


def with_given_friction(
    motion: Motion,
    demands: Demands,
    frictions: Mapping[str, JointFriction],
    like: JointReactions | None = None,
) -> JointReactions:
    """Joint forces that meet the demands of all links, and friction that is known, by joint: linear
    in the demands.

    like : as of `reactions`.
    """
    joints = law_of(motion).joints
    efforts = np.array([frictions[joint.name].effort for joint in joints])
    solved = reactions(motion, added(demands, _units(motion, joints), efforts), like)
    return JointReactions(motion, solved.state, frictions)


def _units(motion: Motion, joints: tuple[RubbingJoint, ...]) -> list[dict[str, Demand]]:
    """What holds a unit of friction in each joint; kept with the motion."""
    return _cached(motion, "units of friction", joints, lambda: unit_demands(motion, joints))


def press_of(
    motion: Motion,
    demands: Demands,
    joints: Sequence[RubbingJoint],
    units: Sequence[Demands],
    like: JointReactions | None,
) -> Press:
    """What presses in joints: of the demands, and of each unit."""
    if like is None:
        shape = motion.crank_angle.shape
        without = pressing_parts(reactions(motion, demands), joints, shape)
        return Press(without, *response_of(motion, joints, units))
    parts = pressing_rows(motion, [demands, *units], joints, like)
    return Press.of(parts[:, :, 0], parts[:, :, 1:])


def pressing_rows(
    motion: Motion,
    rows: Sequence[Demands],
    joints: Sequence[RubbingJoint],
    like: JointReactions | None,
) -> Array:
    """Parts (J, 2, R, N) of what presses in joints with each of R demands, by one stack of passes.

    like : as of `reactions`.
    """
    shape = (len(rows), len(motion.crank_angle))
    stack: dict[str, Demand] = {}
    for body in dict.fromkeys([*motion.machine.links, *(body for row in rows for body in row)]):
        force, moment = np.zeros(shape, complex), np.zeros(shape)
        for number, row in enumerate(rows):
            if body in row:
                force[number], moment[number] = row[body]
        stack[body] = force, moment
    return pressing_parts(reactions(motion, stack, like), joints, shape)


def added(demands: Demands, units: Sequence[Demands], efforts: Array) -> dict[str, Demand]:
    """Demands with what holds friction (J, N) of so many units."""
    total = dict(demands)
    for effort, unit in zip(efforts, units, strict=True):
        for body, (force, moment) in unit.items():
            own = total.get(body, (0j, 0.0))
            pushes = own[0] + effort * force if np.ndim(force) else own[0]  # else it only turns
            total[body] = pushes, own[1] + effort * moment
    return total


def _same_flanks(reactions: JointReactions, other: JointReactions) -> bool:
    flanks = other.flanks
    return all(np.array_equal(value, flanks[name]) for name, value in reactions.flanks.items())


def _locked(
    motion: Motion, law: FrictionLaw, press: Press, efforts: Array, share: Array
) -> LockError:
    """That a machine locks itself: where with the least friction, and in which joints."""
    worst = int(np.argmin(share))
    at = np.array([worst])
    _, slopes = law.at(at).residual(efforts[:, at], share[at], press.at(at))
    _, _, ways = svd(slopes[..., 0])
    power = np.abs(ways[-1] * law.rates[:, worst])
    leading = power >= LEADING * np.max(power)
    names = [
        f"{'joints' if joint.mesh is None else joint.mesh.list_name}.{joint.name}"
        for joint, leads in zip(law.joints, leading, strict=True)
        if leads
    ]
    return LockError(
        Note(
            "friction in {joints} locks the machine at crank angle {angle:.4g} deg, however large "
            "the drive torque; it moves with less than {share:.3g} of the coefficients given",
            joints=all_of(names, commas=True),
            angle=degrees(motion.crank_angle[worst]),
            share=max(float(share[worst]), LAST_STEP),
        )
    )
