"""Figures of cams; and contact of those that springs press on: where, and when, it is lost."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import isfinite
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.assembly.cam_shapes import fits_of, fitted, pressure_angle, sharpest
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.forces import forces as forces_of
from equipoise.mechanism.dynamics.reactions import reactions
from equipoise.mechanism.kinematics.motion import MOST_ANGLES, Motion, move
from equipoise.mechanism.kinematics.strokes import figure
from equipoise.mechanism.parts.cams import Cam
from equipoise.signals import ROUNDING, Array, highest_at

PER_TURN = 360
"""Crank angles in a turn among which the place where a follower lifts off is looked for first."""
CANDIDATE_RATIO, MOST_PLACES = 1.1, 16
"""Squares of speeds, over the least sample, up to which a place may be the lowest; most places."""
ROUNDS, FINER = 3, 24
"""How often such a place is looked at more closely, and how much more so each time: to 1e-6 rad."""


@dataclass(frozen=True)
class CamFigures:
    """Figures of a cam.

    least_radius : of curvature of its surface, m; least_radius_at : angle of the cam, rad, of it.
    lift_off_speed : size of the crank's speed, rad/s, from which its springs do not hold the
        follower; 0 where they do not even at rest, and None where it never lifts off, or where
        springs, masses or a whole cycle are missing.
    lift_off_at : crank angle, rad, at which that happens.
    lost : crank angles, rad, between which contact is lost at the speed analysed.
    """

    least_radius: float = figure(to_say("least radius of curvature"), "length")
    least_radius_at: float = figure(to_say("least radius of curvature at cam angle"), "angle")
    lift_off_speed: float | None = figure(
        to_say("lift-off speed of the crank"), "angular speed", limits_crank="lift_off_at"
    )
    lift_off_at: float | None = figure(to_say("lifts off at crank angle"), "angle")
    lost: tuple[tuple[float, float], ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return vars(self) | {"lost": [{"from": a, "to": b} for a, b in self.lost]}

    @classmethod
    def of_parts(cls, motion: Motion, forces: Forces | None) -> Mapping[str, CamFigures]:
        """Figures of every cam, by name."""
        whole = forces if motion.whole_cycle else None
        lifts = {} if whole is None else {item.cam.name: item for item in let_go(whole)}
        by_name = {}
        for fit in fits_of(motion.machine, motion.linkage.joints):
            entry = lifts.get(fit.cam.name)
            limited = entry is not None and isfinite(entry.speed)
            speed, at = (entry.speed, entry.at) if entry is not None and limited else (None, None)
            lost = () if entry is None else entry.ranges
            radius, where = sharpest(fit)
            by_name[fit.cam.name] = cls(radius, where, speed, at, lost)
        return by_name


def contact_values(motion: Motion, cam: Cam) -> Mapping[str, Array]:
    """Pressure angle, from the way in which its follower rises to the normal, rad, and curvature of
    the surface where the follower touches, 1/m: arrays (N,).
    """
    links, fit = motion.links, fitted(motion.machine, motion.linkage.joints, cam)
    ends = [links[body].angle if body in links else 0.0 for body in (cam.driver, cam.carrier)]
    shape = fit.shape(np.asarray(ends[0] - ends[1]))
    return {
        "pressure_angle": pressure_angle(cam.name, motion.state),
        "curvature": shape.surface_curvature,
    }


@dataclass(frozen=True, eq=False)
class LetGo:
    """A follower that its springs do not keep on the cam everywhere.

    ranges : crank angles, rad, between which it would have to be pulled, at the speed analysed.
    least : smallest normal force, N, and crank angle, rad, of it.
    speed : size of the crank's speed, rad/s, from which on contact is lost; 0 where it is at rest,
        and inf where it never is.
    at : crank angle, rad, at which that happens.
    """

    cam: Cam
    ranges: tuple[tuple[float, float], ...]
    least: tuple[float, float]
    speed: float
    at: float


@lru_cache(maxsize=1)  # figures and notes of the same analysis ask for it
def let_go(forces: Forces) -> tuple[LetGo, ...]:
    """Of each cam that springs close, where and from which speed its follower lifts off.

    The normal force is A + B times the square of the speed: B is what inertia asks for, A what
    weight, loads and springs do, and what an acceleration of the crank adds at any speed.  Soil,
    which resists faster fingers more, is taken as it is at the speed analysed.
    """
    sprung = [cam for cam in forces.motion.machine.cams if cam.closed_by == "spring"]
    fine = _finely(forces) if sprung else forces
    return tuple(_let_go(cam, forces, fine) for cam in sprung)


def _finely(forces: Forces) -> Forces:
    """Forces at so many crank angles that the lowest of a curve lies beside the lowest of them."""
    motion = forces.motion
    per_turn = min(PER_TURN, MOST_ANGLES // motion.turns)
    if not motion.whole_cycle or len(motion.crank_angle) >= per_turn * motion.turns:
        return forces
    return _forces_at(forces, per_turn)


def _forces_at(like: Forces, angles: int | Array) -> Forces:
    motion = like.motion
    return forces_of(move(motion.machine, angles, motion.speed, motion.acceleration), like.about)


def _let_go(cam: Cam, forces: Forces, fine: Forces) -> LetGo:
    theta, normal = forces.motion.crank_angle, forces.cams[cam.name].normal
    figures = forces.motion.figures(normal)
    least = figures.min, figures.min_at
    return LetGo(cam, _ranges(theta, normal), least, *_limit(cam.name, fine))


def _limit(name: str, forces: Forces) -> tuple[float, float]:
    """Speed from which a follower lifts off, rad/s, and crank angle, rad, at which it does.

    Between the samples it lifts off at a lower speed than at any of them, so that every place which
    may be the lowest is looked at ever more closely.  That needs no derivative: laws of cams jump
    in their acceleration, and are lowest just beside that.
    """
    theta = forces.motion.crank_angle
    at_rest, per_speed2 = _at_rest(name, forces)
    worst = int(highest_at(-at_rest))
    if at_rest[worst] <= 0:
        return 0.0, float(theta[worst])
    squares = _squares(at_rest, per_speed2)
    first = int(highest_at(-squares, smooth=False))
    if not isfinite(squares[first]) or len(theta) < 2:
        return float(np.sqrt(squares[first])), float(theta[first])
    return _lowest(name, forces, squares)


def _lowest(name: str, forces: Forces, squares: Array) -> tuple[float, float]:
    """Lowest lift-off speed and its angle, from its squares at each crank angle of the forces."""
    motion, theta = forces.motion, forces.motion.crank_angle
    ends = (-np.inf, np.inf) if motion.whole_cycle else (theta[0], theta[-1])
    low = (squares <= np.roll(squares, 1)) & (squares <= np.roll(squares, -1))
    places = np.flatnonzero(low & (squares <= CANDIDATE_RATIO * np.min(squares)))
    places = np.sort(places[np.argsort(squares[places], kind="stable")][:MOST_PLACES])
    step, at, least = theta[1] - theta[0], theta[places], squares[places]
    for _ in range(ROUNDS):
        samples = np.clip(at[:, None] + step * np.linspace(-1, 1, 2 * FINER + 1), *ends)
        result = _squares(*_at_rest(name, _forces_at(forces, samples.ravel()))).reshape(
            samples.shape
        )
        best = np.argmin(result, axis=1)[:, None]
        better = np.take_along_axis(result, best, 1)[:, 0] < least * (1 - ROUNDING)
        at = np.where(better, np.take_along_axis(samples, best, 1)[:, 0], at)
        least = np.where(better, np.take_along_axis(result, best, 1)[:, 0], least)
        step /= FINER
    k = int(highest_at(-least, smooth=False))
    return float(np.sqrt(least[k])), float(at[k] % (2 * np.pi * motion.turns))


def _at_rest(name: str, forces: Forces) -> tuple[Array, Array]:
    """Normal force on a follower as its crank stands still, N, and what a speed of 1 rad/s adds."""
    fast = forces.at(speed=1.0, acceleration=0.0).inertia
    per_speed2 = reactions(forces.motion, fast, forces.solved).force_on(name).normal
    return forces.cams[name].normal - per_speed2 * forces.motion.speed**2, per_speed2


def _squares(at_rest: Array, per_speed2: Array) -> Array:
    """Square of the speed at which the normal force is 0, at each crank angle; inf where never."""
    squares = np.full(len(at_rest), np.inf)
    with np.errstate(divide="ignore", over="ignore"):
        np.divide(-at_rest, per_speed2, out=squares, where=per_speed2 < 0)
    return squares


def _ranges(theta: Array, normal: Array) -> tuple[tuple[float, float], ...]:
    """Between which crank angles a force is negative, by straight lines between its samples."""
    none = ROUNDING * np.max(np.abs(normal), initial=0.0)
    if len(theta) < 2 or not np.any(normal < -none):
        return ()
    period = theta[-1] - theta[0] + theta[1] - theta[0]
    x = np.append(theta, theta[0] + period)
    y = np.append(normal, normal[0])
    below = y < -none
    if np.all(below):
        return ((float(x[0]), float(x[-1])),)
    k = np.flatnonzero(below[:-1] != below[1:])
    crossings = x[k] - y[k] * (x[k + 1] - x[k]) / (y[k + 1] - y[k])
    down = crossings[below[k + 1]]
    up = crossings[below[k]]
    if up[0] < down[0]:
        up = np.append(up[1:], up[0] + period)
    return tuple((float(a), float(b)) for a, b in zip(down, up, strict=True))
