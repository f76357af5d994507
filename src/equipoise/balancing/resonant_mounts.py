"""Mounts that bring a resonance near the speeds at which a machine runs, and other ones.

Beside a resonance the support moves by what the mounts make of the shaking force, not by the force
alone, and no counterweight helps as much as another stiffness does, or another speed.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from math import sqrt
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import (
    AMPLIFIED,
    AMPLIFIED_LEFT,
    ENOUGH_OF_BEST,
    LEAST_GAIN,
    MASSES_BESIDE_MOUNTS,
    SHARE_OF_ENERGY,
    SHARE_OF_READING,
    STIFFNESS_FACTORS,
)
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, ResponseError
from equipoise.i18n import say, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Mount
from equipoise.quantities import PER_RPM, brief, number, percent
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.vibration.body import gauges_of
from equipoise.vibration.forced import respond
from equipoise.vibration.linear import LEAST_DAMPING, Linear, Resonance, around, resonances

SAME_SPEED = 0.05
"""Share of a speed within which two resonances are one: along and across on like mounts."""


@dataclass(frozen=True)
class ResonantMounts:
    """A loud resonance beside a speed at which the machine runs, and what moves it away.

    speed : of the crank at the resonance, rad/s.  near : the speed beside it, at which it runs.
    avoid : speeds to be kept away from, the slower one first.
    mounts : names of those that its mode strains.
    factor : times their stiffness and damping that helps; None where none of those tried does.
    gain : share of what the gauges read that is gone with that; 0 without.
    away : rad/s, speed beyond which, on the side of `near`, it no longer amplifies the motion.
    """

    speed: float
    near: float
    avoid: tuple[float, float]
    mounts: tuple[str, ...]
    factor: float | None
    gain: float
    away: float

    @property
    def is_beside(self) -> bool:
        """Whether the machine runs at a speed to be kept away from."""
        low, high = sorted(map(abs, self.avoid))
        return low <= self.near <= high

    declared: ClassVar[Declarations] = {
        "speed": ResultOutput("of the crank at the resonance", "angular speed"),
        "near": ResultOutput("the speed beside it at which the machine runs", "angular speed"),
        "avoid": ResultOutput("speeds to be kept away from, the slower one first", "angular speed"),
        "mounts": ResultOutput("those that its mode strains"),
        "factor": ResultOutput("times their stiffness and damping that helps, or null"),
        "gain": ResultOutput("share of what the gauges read that is gone with that"),
        "away": ResultOutput("beyond which it no longer amplifies", "angular speed"),
    }


def outweighs(gain: float, mounts: ResonantMounts) -> bool:
    """Whether a change of masses is worth it beside what other mounts bring."""
    return gain >= MASSES_BESIDE_MOUNTS * mounts.gain


def resonant_mounts_for(
    machine: Machine,
    speeds: Sequence[float],
    gauges: Collection[str],
    gain: Callable[[Machine], float],
) -> ResonantMounts | None:
    """The resonance beside a speed of a machine that moves it most there; None where none is.

    Parameters
    ----------
    speeds : at which it runs, rad/s.
    gauges : names of those that are to read less.
    gain : share of what the gauges read that is gone with another machine.

    Raises
    ------
    ModelError, ResponseError : nothing holds the support, or there is no steady state.
    """
    linear = Linear.of(machine)
    pairs = [pair for pair in _loud_beside(linear, speeds) if _is_read(linear, gauges, *pair)]
    if not pairs:
        return None
    resonance, speed = max(pairs, key=lambda pair: _motion_beside(linear, speeds, *pair))
    names = _strained(linear, [item for item in pairs if _is_near(item[0], resonance)])
    tried = [*_tried(machine, speeds, names, gain)]
    most = max((gone for gone, _ in tried), default=0.0)
    enough = (item for item in tried if item[0] >= ENOUGH_OF_BEST * most)
    gone, factor = next(enough, (0.0, None))
    edges = _amplified_between(linear.modes[resonance.mode - 1].damping_ratio)
    assert edges is not None
    low, high = (share * resonance.speed for share in edges)
    avoid = resonance.avoid or (low, high)
    away = abs(low if abs(speed) < abs(resonance.speed) else high)
    return ResonantMounts(abs(resonance.speed), abs(speed), avoid, names, factor, gone, away)


def _amplified_between(damping: float, times: float = AMPLIFIED) -> tuple[float, float] | None:
    """Ratios of a speed to that of a resonance between which it amplifies; None where it nowhere
    does so.

    A mode of the damping ratio z moves by H = 1 / |1 - r^2 + 2 i z r| of what stiffness alone
    would leave, and by r^2 H of what mass alone would: the edges are H = a below, r^2 H = a above,
    with a the times.
    """
    half, square = 1 - 2 * damping**2, times**2
    if half**2 <= 1 - 1 / square:  # the peaks of both, 1 / sqrt(1 - half^2), do not reach a
        return None
    low = half - sqrt(half**2 - 1 + 1 / square)
    # r^2 H of r is H of 1 / r.
    return sqrt(low), 1 / sqrt(low)


def _motion_beside(
    linear: Linear, speeds: Sequence[float], resonance: Resonance, speed: float
) -> float:
    """What a mode moves a gauge by at a speed, over the loudest resonance at that gauge.

    At its own speed a mode of the damping ratio z amplifies 1 / (2 z) times; at r times that, where
    what shakes is r^2 times as large, r^2 H times.
    """
    slowest, fastest = min(map(abs, speeds)), max(map(abs, speeds))
    if slowest <= abs(resonance.speed) <= fastest:  # the machine runs through it
        return resonance.share
    damping = max(abs(linear.modes[resonance.mode - 1].damping_ratio), LEAST_DAMPING)
    ratio = speed / resonance.speed
    amplified = ratio**2 / abs(1 - ratio**2 + 2j * damping * ratio)
    return resonance.share * 2 * damping * amplified


def _loud_beside(
    linear: Linear, speeds: Sequence[float], times: float = AMPLIFIED
) -> list[tuple[Resonance, float]]:
    """Loud resonances beside any of some speeds, and the speed nearest to each."""
    drive = linear.body.machine.drive
    ends = [end for speed in speeds for end in around(drive, speed)]
    low, high = min(ends, key=abs), max(ends, key=abs)  # else the loudest may lie outside
    loud = [resonance for resonance in resonances(linear, low, high) if resonance.is_loud]
    slowest, fastest = min(map(abs, speeds)), max(map(abs, speeds))
    pairs = []
    for item in loud:
        nearest = speeds[int(np.argmin([abs(np.log(speed / item.speed)) for speed in speeds]))]
        inside = slowest <= abs(item.speed) <= fastest
        edges = _amplified_between(linear.modes[item.mode - 1].damping_ratio, times)
        if edges is not None and (inside or edges[0] < nearest / item.speed < edges[1]):
            pairs.append((item, nearest))
    return pairs


def _is_read(linear: Linear, gauges: Collection[str], resonance: Resonance, speed: float) -> bool:
    """Whether the mode of a resonance, moved by its order, has a part in what any of some gauges
    reads at a speed.
    """
    body, mode, motion = linear.body, linear.modes[resonance.mode - 1], linear.excitation.motion
    place = np.array([round(resonance.order * motion.turns)])
    wrench = linear.excitation.at_orders(np.array([speed]), place)[body.free][:, 0]
    rate, frequency = mode.natural_frequency, resonance.order * abs(speed)
    # Undamped on its resonance it would move without end: LEAST_DAMPING keeps that a number.
    damping = max(abs(mode.damping_ratio), LEAST_DAMPING)
    stiffness = abs(rate**2 - frequency**2 + 2j * damping * rate * frequency)
    inertia = float(abs(mode.shape @ linear.mass @ mode.shape))
    moved = float(abs(mode.shape @ wrench)) / (stiffness * inertia)
    readings = respond(body.machine, speed).gauges
    for name, gauge in gauges_of(body).items():
        if name in gauges:
            part = frequency * abs(body.row(gauge)[body.free] @ mode.shape) * moved / sqrt(2)
            if part >= SHARE_OF_READING * readings[name].velocity.figures.rms:
                return True
    return False


def _is_near(resonance: Resonance, other: Resonance) -> bool:
    return abs(resonance.speed / other.speed - 1) < SAME_SPEED


def _strained(linear: Linear, met: Sequence[tuple[Resonance, float]]) -> tuple[str, ...]:
    """Mounts that have enough of the energy of any mode that is met, in the order of the file."""
    body = linear.body
    result = set[str]()
    for resonance, _ in met:
        shape = linear.modes[resonance.mode - 1].shape
        energy = {
            name: mount.spring * abs(body.row(mount)[body.free] @ shape) ** 2
            for name, mount in body.support.mounts.items()
            if linear.rest.carries(name, mount)
        }
        whole = sum(energy.values())
        result |= {name for name, item in energy.items() if item >= SHARE_OF_ENERGY * whole > 0}
    return tuple(name for name in body.support.mounts if name in result)


def _tried(
    machine: Machine,
    speeds: Sequence[float],
    names: Sequence[str],
    gain: Callable[[Machine], float],
) -> Iterator[tuple[float, float]]:
    """Gain and factor of other mounts with which no loud resonance lies beside a speed."""
    assert machine.support is not None
    for factor in STIFFNESS_FACTORS:
        mounts = _scaled(machine.support.mounts, names, factor)
        changed = machine.with_support(mounts=mounts)
        try:
            if _loud_beside(Linear.of(changed), speeds, AMPLIFIED_LEFT):
                continue
            gone = gain(changed)
        except (ModelError, ResponseError):
            continue
        if gone >= LEAST_GAIN:
            yield gone, factor


def _scaled(mounts: Mapping[str, Mount], names: Sequence[str], factor: float) -> dict[str, Mount]:
    """Mounts of which some are so many times as stiff and damp."""
    by_name = dict(mounts)
    for name in names:
        item = by_name[name]
        fields = ("stiffness", "damping") if item.axis is None else (
            "torsional_stiffness", "torsional_damping")  # fmt: skip
        known = {field: getattr(item, field) for field in fields}
        changed = {field: factor * value for field, value in known.items() if value}
        by_name[name] = replace(item, **changed)
    return by_name


# -- sentences -------------------------------------------------------------------------------------


def mount_sentences(mounts: ResonantMounts, comes_first: bool) -> Iterator[str]:
    """Which resonance lies beside the speed, and what moves it away.

    comes_first : whether other mounts bring more than the change of masses, if there is one.
    """
    low, high = sorted(map(abs, mounts.avoid))
    advice = to_say(
        "First move the resonance at {speed} rpm (keep away from {low} to {high} rpm), beside "
        "which it runs at {near} rpm"
    )
    amplifies = to_say(
        "First move the resonance at {speed} rpm, which amplifies the motion at {near} rpm too"
    )
    besides = to_say("The resonance at {speed} rpm amplifies the motion at {near} rpm too: move it")
    above, below = to_say("run above {away} rpm"), to_say("run below {away} rpm")
    first = say(
        advice if mounts.is_beside else amplifies if comes_first else besides,
        speed=brief(mounts.speed / PER_RPM),
        low=number(low / PER_RPM),
        high=number(high / PER_RPM),
        near=brief(mounts.near / PER_RPM),
    )
    other = say(above if mounts.away > mounts.near else below, away=brief(mounts.away / PER_RPM))
    yield say("{first}, or {other}.", first=first, other=other)
    if mounts.factor is None:
        return
    single, several = to_say("Mount {names}"), to_say("Mounts {names}")
    softer = to_say("{mounts} {times} times softer would take {gain} % off what the gauges read.")
    stiffer = to_say("{mounts} {times} times stiffer would take {gain} % off what the gauges read.")
    names = mounts.mounts
    yield say(
        softer if mounts.factor < 1 else stiffer,
        mounts=say(single if len(names) == 1 else several, names=say(", ").join(names)),
        times=number(max(mounts.factor, 1 / mounts.factor), digits=1),
        gain=percent(mounts.gain),
    )
