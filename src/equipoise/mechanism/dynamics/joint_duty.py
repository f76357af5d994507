"""What joints bear over a whole cycle: life of rolling bearings, plain bearings, friction losses.

ISO 281: of many equal bearings 90 % turn L10 = (C / P)^p million times under a load P.  Where load
and speed change, each part of a turn uses up its share of the life, so that

    P^p = int F^p |w| dt / int |w| dt,

with w the speed of one ring against the other: a joint that swings counts by the way that it turns.
Several duty states are parts of one long cycle: both integrals are sums over the states, each by
its share of the time.
Lives scatter as a Weibull distribution with three parameters, in units of L10 (Shigley's Mechanical
Engineering Design, chapter 11):

    R(x) = exp(-((x - x0) / (theta - x0))^b).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import exp, log, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.assembly.steps import Reaction
from equipoise.mechanism.dynamics.forces import Forces, WorkingState, joint_properties, ring_speed
from equipoise.mechanism.dynamics.reduced import generalized_force
from equipoise.mechanism.kinematics.strokes import figure
from equipoise.mechanism.parts.joint_properties import RollingBearing
from equipoise.signals import Array, Figures

MILLION = 1e6
LEAST, SCALE, SHAPE = 0.02, 4.439, 1.483
"""x0, theta - x0 and b of the lives of rolling bearings, in units of L10."""


@dataclass(frozen=True)
class BearingLife:
    """Figures of a rolling bearing over a whole cycle of even speed, or those of all duty states.

    equivalent_load : the even load of the same life, with the load factor, N.
    speed : mean of the size of the speed of one ring against the other, rad/s.
    basic_life : that 9 of 10 bearings reach, s; None without a load or where it does not turn.
    basic_turns : the same in turns of one ring against the other.
    rated_life : that the wanted share of bearings reaches, s.
    reached : share of bearings that reach the wanted life; None where none is wanted.
    needed_rating : dynamic rating of the bearing that reaches it as reliably as wanted, N.
    static_safety : static rating over the largest load.
    """

    equivalent_load: float = figure(to_say("equivalent load"), "force")
    speed: float = figure(to_say("mean speed of one ring against the other"), "angular speed")
    basic_life: float | None = figure(to_say("life that 90 % reach (L10)"), "time")
    basic_turns: float | None = figure(to_say("turns in that life"))
    rated_life: float | None = figure(
        to_say("life at the wanted reliability"), "time", at_least="life"
    )
    reached: float | None = figure(to_say("share that reaches the wanted life"))
    needed_rating: float | None = figure(to_say("dynamic rating needed"), "force")
    static_safety: float | None = figure(to_say("static safety"), at_least=1.0)

    def to_dict(self) -> dict[str, Any]:
        """As plain data in SI units."""
        return dict(vars(self))


def life_share(reliability: float) -> float:
    """Life, in units of L10, that a share of bearings reaches."""
    return float(LEAST + SCALE * log(1 / reliability) ** (1 / SHAPE))


def reliability_of(share: float) -> float:
    """Share of bearings that reaches a life in units of L10."""
    return exp(-((max(share - LEAST, 0.0) / SCALE) ** SHAPE))


def bearing_life(
    bearing: RollingBearing, load: float, speed: float, largest: float | None = None
) -> BearingLife:
    """Life of a bearing under an equivalent load, N, without its load factor.

    speed : mean of its size, rad/s, of one ring against the other.
    largest : load, N, against which the static rating is held; the equivalent one if None.
    """
    load, peak = load * bearing.load_factor, (load if largest is None else largest)
    peak *= bearing.load_factor
    static = bearing.static_rating
    safety = static / peak if static is not None and peak > 0 else None
    wanted = None if bearing.life is None else bearing.life * speed / (2 * pi * MILLION)
    if not (load > 0 and speed > 0):
        reached, needed = (None, None) if wanted is None else (1.0, 0.0)
        return BearingLife(load, speed, None, None, None, reached, needed, safety)
    millions = (bearing.dynamic_rating / load) ** bearing.exponent
    basic = millions * MILLION * 2 * pi / speed
    share = life_share(bearing.reliability)
    reached, needed = None, None
    if wanted is not None:
        reached = reliability_of(wanted / millions)
        needed = load * (wanted / share) ** (1 / bearing.exponent)
    return BearingLife(
        load, speed, basic, millions * MILLION, share * basic, reached, needed, safety
    )


def bearing_lives(forces: Forces) -> Mapping[str, BearingLife]:
    """Figures of rolling bearings by joint, over all duty states of the machine; none where the
    crank is not turned evenly, or the crank angles are not those of a whole cycle.
    """
    motion = forces.motion
    if not motion.is_steady_cycle:
        return {}
    rolling = {
        name: (reaction, item.bearing)
        for name, (reaction, item) in joint_properties(motion).items()
        if item.bearing is not None and name in forces.joints
    }
    return {name: _life_over(forces.working_states, name, *both) for name, both in rolling.items()}


def _life_over(
    states: Sequence[WorkingState], name: str, reaction: Reaction, bearing: RollingBearing
) -> BearingLife:
    """Figures of one bearing over duty states."""
    sizes = [state.forces.joints[name].size for state in states]
    turns = [np.abs(ring_speed(state.forces.motion, reaction)) for state in states]

    def mean(signals: Iterable[Array]) -> float:
        each = zip(states, signals, strict=True)
        return sum(state.share * float(state.forces.motion.mean(item)) for state, item in each)

    speed, top = mean(turns), max(float(np.max(size)) for size in sizes)
    load, p = 0.0, bearing.exponent
    if speed > 0 and top > 0:  # scaled, as a small force to a high power is 0
        both = zip(sizes, turns, strict=True)
        load = top * (mean((size / top) ** p * turn for size, turn in both) / speed) ** (1 / p)
    return bearing_life(bearing, load, speed, top)


@dataclass(frozen=True)
class PlainBearingDuty:
    """Figures of a plain bearing over the crank angles of an analysis, or those of all duty states.

    pressure : largest force over width times diameter, Pa.
    pressure_speed : largest pressure times sliding speed, Pa m/s.
    pressure_at, pressure_speed_at : crank angles of these, rad; None where they do not vary.
    mean_pressure_speed : mean of that over the operating time, Pa m/s.
    """

    pressure: float = figure(to_say("largest pressure"), "modulus")
    pressure_at: float | None = figure(to_say("largest pressure at crank angle"), "angle")
    pressure_speed: float = figure(to_say("largest pressure times speed"), "pressure times speed")
    pressure_speed_at: float | None = figure(
        to_say("largest pressure times speed at crank angle"), "angle"
    )
    mean_pressure_speed: float = figure(
        to_say("pressure times speed in the mean"), "pressure times speed"
    )

    def to_dict(self) -> dict[str, Any]:
        """As plain data in SI units."""
        return dict(vars(self))


def plain_bearing_duties(forces: Forces) -> Mapping[str, PlainBearingDuty]:
    """Figures of plain bearings by joint: over all duty states of the machine where the crank is
    turned evenly over a whole cycle, else over these forces alone.
    """
    steady = forces.motion.is_steady_cycle
    states = forces.working_states if steady else (WorkingState(1.0, forces),)
    return {name: _over(states, name) for name in forces.plain_bearings}


def _over(states: Sequence[WorkingState], name: str) -> PlainBearingDuty:
    """The largest of all states, and the mean by their shares of the time."""
    bearings = [(state, state.forces.plain_bearings[name]) for state in states]
    pressures, speeds = (
        [state.forces.motion.figures(getattr(item, signal)) for state, item in bearings]
        for signal in ("pressure", "pressure_speed")
    )
    pressure, warming = (max(each, key=lambda item: item.max) for each in (pressures, speeds))
    mean = sum(state.share * item.mean for (state, _), item in zip(bearings, speeds, strict=True))
    return PlainBearingDuty(
        pressure.max, _angle_of_largest(pressure), warming.max, _angle_of_largest(warming), mean
    )


def _angle_of_largest(figures: Figures) -> float | None:
    """Crank angle of the largest value, rad; None where it is as large everywhere."""
    return None if figures.is_constant() else figures.max_at


NOTHING = 1e-9
"""Share of the power that goes through a machine below which the rest is rounding."""


@dataclass(frozen=True)
class JointLoss:
    """What one joint costs in the mean of a cycle.

    loss : power, W.  wear_work : contact force times sliding way in a turn of the crank, J.
    """

    loss: float
    wear_work: float


@dataclass(frozen=True)
class Losses:
    """Powers of a cycle in the mean, W.

    joints : by name.  drive : that all drives give.  loads : that loads and soil give; below 0
        where they take it.
    """

    joints: Mapping[str, JointLoss]
    drive: float
    loads: float

    @property
    def loss(self) -> float:
        """That all joints lose."""
        return sum(joint.loss for joint in self.joints.values())

    @property
    def efficiency(self) -> float | None:
        """Share of the power given that is taken at the other end, from drive to loads or from
        loads to drive; None where nothing takes any.
        """
        given, taken = max(self.drive, self.loads), -min(self.drive, self.loads)
        return taken / given if taken > NOTHING * given > 0 else None


def losses_of(forces: Forces) -> Losses | None:
    """Losses of a whole cycle; None where no joint has any, the crank is not turned evenly, or the
    crank angles are not those of a whole cycle.
    """
    motion = forces.motion
    if not forces.frictions or not motion.is_steady_cycle:
        return None
    turn = 2 * pi / abs(motion.speed)
    joints = {
        name: JointLoss(
            float(motion.mean(friction.loss)), float(motion.mean(friction.sliding_power)) * turn
        )
        for name, friction in forces.frictions.items()
    }
    loads = np.asarray(generalized_force(motion, forces.loads) * motion.speed)
    return Losses(joints, float(motion.mean(forces.power)), float(motion.mean(loads)))
