"""Mounts that bring a resonance near the speeds at which a machine runs, and other ones.

Beside a resonance the support moves by what the mounts make of the shaking force, not by the force
alone, and no counterweight helps as much as another stiffness does, or another speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from equipoise.errors import ModelError, ResponseError
from equipoise.i18n import say, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.mounts import Mount
from equipoise.quantities import PER_RPM, brief, number, percent
from equipoise.vibration.linear import Linear
from equipoise.vibration.resonance import Resonance, around, resonances

BESIDE = sqrt(2)
"""A resonance lies beside a speed within this ratio, where it more than doubles the motion."""
FACTORS = (1 / 2, 1 / 3, 1 / 4, 2.0, 3.0, 4.0)
"""Times the stiffness of the mounts that are tried; softer ones isolate, and come first."""
SHARE = 0.1
"""Of the energy of a mode, from which a mount takes part in it."""
CLEAR = 0.5
"""Share of the most that other mounts bring from which milder ones are enough."""
WORTH_IT = 2 / 3
"""Share of what other mounts bring from which a change of masses is worth it as well: beside a
resonance mass moves the frequency too, so that less is a matter of luck."""
LEAST = 0.15
"""Share of what gauges read that has to go."""


@dataclass(frozen=True)
class ResonantMounts:
    """A loud resonance beside a speed at which the machine runs, and what moves it away.

    speed : of the crank at the resonance, rad/s.  near : the speed beside it, at which it runs.
    avoid : speeds to be kept away from, the slower one first; None without such.
    mounts : names of those that its mode strains.
    factor : times their stiffness and damping that helps; None where none of those tried does.
    gain : share of what the gauges read that is gone with that; 0 without.
    away : rad/s, speed from which on the resonance no longer doubles the motion.
    """

    speed: float
    near: float
    avoid: tuple[float, float] | None
    mounts: tuple[str, ...]
    factor: float | None
    gain: float
    away: float


def outweighs(gain: float, mounts: ResonantMounts) -> bool:
    """Whether a change of masses is worth it beside what other mounts bring."""
    return gain >= WORTH_IT * mounts.gain


def resonant_mounts_for(
    machine: Machine, speeds: Sequence[float], gain: Callable[[Machine], float]
) -> ResonantMounts | None:
    """The loudest resonance that lies beside a speed at which a machine runs; None where none does.

    Parameters
    ----------
    speeds : at which it runs, rad/s.
    gain : share of what the gauges read that is gone with another machine.

    Raises
    ------
    ModelError, ResponseError : nothing holds the support, or there is no steady state.
    """
    linear = Linear.of(machine)
    near = _loudest_beside(linear, speeds)
    if near is None:
        return None
    resonance, speed = near
    names = _strained(linear, resonance)
    tried = [*_tried(machine, speeds, names, gain)]
    most = max((gone for gone, _ in tried), default=0.0)
    enough = (one for one in tried if one[0] >= CLEAR * most)
    gone, factor = next(enough, (0.0, None))
    away = abs(resonance.speed) * BESIDE
    return ResonantMounts(
        abs(resonance.speed), abs(speed), resonance.avoid, names, factor, gone, away
    )


def _loudest_beside(linear: Linear, speeds: Sequence[float]) -> tuple[Resonance, float] | None:
    """The loudest resonance beside any of some speeds, and the speed nearest to it."""
    drive = linear.body.machine.drive
    low, high = around(drive, speeds[0])
    loud = [one for one in resonances(linear, low, high) if one.is_loud and one.avoid is not None]
    slowest, fastest = min(map(abs, speeds)), max(map(abs, speeds))
    beside = []
    for one in loud:
        near = speeds[int(np.argmin([abs(np.log(speed / one.speed)) for speed in speeds]))]
        inside = slowest <= abs(one.speed) <= fastest
        if inside or 1 / BESIDE < near / one.speed < BESIDE:
            beside.append((one, near))
    return max(beside, key=lambda pair: pair[0].share, default=None)


def _strained(linear: Linear, resonance: Resonance) -> tuple[str, ...]:
    """Mounts that have enough of the energy of a resonance's mode, in the order of the file."""
    shape = linear.modes[resonance.mode - 1].shape
    body = linear.body
    energy = {
        name: mount.spring * abs(body.row(mount)[body.free] @ shape) ** 2
        for name, mount in body.support.mounts.items()
        if linear.rest.carries(name, mount)
    }
    whole = sum(energy.values())
    return tuple(name for name, one in energy.items() if one >= SHARE * whole > 0)


def _tried(
    machine: Machine,
    speeds: Sequence[float],
    names: Sequence[str],
    gain: Callable[[Machine], float],
) -> Iterator[tuple[float, float]]:
    """Gain and factor of other mounts with which no loud resonance lies beside a speed."""
    assert machine.support is not None
    for factor in FACTORS:
        mounts = _scaled(machine.support.mounts, names, factor)
        changed = machine.with_support(mounts=mounts)
        try:
            if _loudest_beside(Linear.of(changed), speeds) is not None:
                continue
            gone = gain(changed)
        except (ModelError, ResponseError):
            continue
        if gone >= LEAST:
            yield gone, factor


def _scaled(mounts: Mapping[str, Mount], names: Sequence[str], factor: float) -> dict[str, Mount]:
    """Mounts of which some are so many times as stiff and damp."""
    found = dict(mounts)
    for name in names:
        one = found[name]
        fields = ("stiffness", "damping") if one.axis is None else (
            "torsional_stiffness", "torsional_damping")  # fmt: skip
        known = {field: getattr(one, field) for field in fields}
        changed = {field: factor * value for field, value in known.items() if value}
        found[name] = replace(one, **changed)
    return found


# -- sentences -------------------------------------------------------------------------------------


def mount_sentences(found: ResonantMounts) -> Iterator[str]:
    """Which resonance lies beside the speed, and what moves it away."""
    low, high = sorted(map(abs, found.avoid or (found.speed, found.speed)))
    yield say(
        "First move the resonance at {speed} rpm (keep away from {low} to {high} rpm), beside "
        "which it runs at {near} rpm, or run above {away} rpm.",
        speed=brief(found.speed / PER_RPM),
        low=number(low / PER_RPM),
        high=number(high / PER_RPM),
        near=brief(found.near / PER_RPM),
        away=brief(found.away / PER_RPM),
    )
    if found.factor is None:
        return
    softer = to_say(
        "Mounts {mounts} {times} times softer would take {gain} % off what the gauges read."
    )
    stiffer = to_say(
        "Mounts {mounts} {times} times stiffer would take {gain} % off what the gauges read."
    )
    times = max(found.factor, 1 / found.factor)
    yield say(
        softer if found.factor < 1 else stiffer,
        mounts=say(", ").join(found.mounts),
        times=number(times, digits=1),
        gain=percent(found.gain),
    )
