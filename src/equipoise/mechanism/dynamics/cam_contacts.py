"""Figures of cams; and contact of those that springs press on: where, and when, it is lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from equipoise.i18n import to_say
from equipoise.mechanism.assembly.cam_fits import fits_of, sharpest
from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.reactions import reactions
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.stroke_figures import figure
from equipoise.mechanism.parts.cams import Cam
from equipoise.signals import ROUNDING, highest_at


@dataclass(frozen=True)
class CamFigures:
    """Figures of a cam.

    least_radius : of curvature of its surface, m; least_radius_at : angle of the cam, rad, of it.
    lift_off_speed : size of the crank's speed, rad/s, from which its springs do not hold the
        follower; 0 where they do not even at rest, and None where it never lifts off, or where no
        spring, no masses or no whole cycle are there to tell.
    lift_off_at : crank angle, rad, at which that happens.
    lost : crank angles, rad, between which contact is lost at the speed analysed.
    """

    least_radius: float = figure(to_say("least radius of curvature"), "length")
    least_radius_at: float = figure(to_say("least radius of curvature at cam angle"), "angle")
    lift_off_speed: float | None = figure(to_say("lift-off speed of the crank"), "angular speed")
    lift_off_at: float | None = figure(to_say("lifts off at crank angle"), "angle")
    lost: tuple[tuple[float, float], ...] = ()

    def told(self) -> dict[str, Any]:
        """As plain data."""
        return vars(self) | {"lost": [{"from": a, "to": b} for a, b in self.lost]}


def cam_figures(motion: Motion, forces: Forces | None) -> Mapping[str, CamFigures]:
    """Figures of every cam, by name."""
    whole = forces if motion.whole_cycle else None
    lifts = {} if whole is None else {one.cam.name: one for one in let_go(whole)}
    found = {}
    for fit in fits_of(motion.machine, motion.linkage.joints):
        one = lifts.get(fit.cam.name)
        limited = one is not None and isfinite(one.speed)
        speed, at = (one.speed, one.at) if one is not None and limited else (None, None)
        lost = () if one is None else one.ranges
        radius, where = sharpest(fit)
        found[fit.cam.name] = CamFigures(radius, where, speed, at, lost)
    return found


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


def let_go(forces: Forces) -> tuple[LetGo, ...]:
    """Of each cam that springs close, where and from which speed its follower lifts off.

    The normal force is A + B times the square of the speed: B is what inertia asks for, A what
    weight, loads and springs do, and what an acceleration of the crank adds at any speed.  Soil,
    which resists faster fingers more, is taken as it is at the speed analysed.
    """
    machine, motion = forces.motion.machine, forces.motion
    sprung = [cam for cam in machine.cams if cam.closed_by == "spring"]
    if not sprung:
        return ()
    fast = forces.at(speed=1.0, acceleration=0.0).inertia
    squared = reactions(motion, fast, forces.solved).cams
    return tuple(
        _let_go(cam, motion, forces.cams[cam.name].normal, squared[cam.name].normal)
        for cam in sprung
    )


def _let_go(cam: Cam, motion: Motion, normal: Array, per_speed2: Array) -> LetGo:
    """From the normal force, and the share of it that a speed of 1 rad/s asks for."""
    theta, speed = motion.crank_angle, motion.speed
    at_rest = normal - per_speed2 * speed**2
    worst = int(highest_at(-at_rest))
    if at_rest[worst] <= 0:
        limit, place = 0.0, worst
    else:
        with np.errstate(divide="ignore"):
            squares = np.where(per_speed2 < 0, -at_rest / per_speed2, np.inf)
        place = int(highest_at(-squares, smooth=False))
        limit = float(np.sqrt(squares[place]))
    k = int(highest_at(-normal))
    least = float(normal[k]), float(theta[k])
    return LetGo(cam, _ranges(theta, normal), least, limit, float(theta[place]))


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
