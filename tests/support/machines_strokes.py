"""Random machines that are pushed: by a cylinder between two points, or along a sliding joint.

A machine that turns fully is taken and its crank let go; what pushes has a stroke that moves it
within a part of the turn over which the length only rises or only falls.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, permutations, product
from typing import Any

import numpy as np

from equipoise.errors import EquipoiseError, UsageError
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.drives import Drive
from equipoise.mechanism.parts.laws import AngleLaw, LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import FRAME, FurtherDrive, Link, Load, Machine
from support.machines import CYCLE, KINDS, Case, make
from support.poses import Array, from_motion


class CannotBePushed(AssertionError):
    """A random machine has no two points, or no sliding joint, by which it could be pushed."""


SHARES = 0.8, 0.3
"""Of the part of the turn over which the length rises or falls, what the stroke takes at most."""

LEAST = 0.03
"""Over the largest length, or the whole travel: by how much the length changes with the crank's
angle, or the equations have lost digits.
"""


def lengths(machine: Machine, drive: Drive) -> Array:
    """Length that a drive has over a turn of the crank, (N,)."""
    poses = from_motion(machine, move(machine, CYCLE))
    if drive.slider:
        first = next(slider for slider in machine.sliders if slider.name == drive.slider)
        point = machine.links[first.link].points[first.point]
        way = poses.place(first.link, point) - poses.place(
            first.on, machine.points_of(first.on)[first.through]
        )
        line = poses.turned(
            first.on, (float(np.cos(first.direction)), float(np.sin(first.direction)))
        )
        return np.asarray(np.sum(way * line, -1))
    assert drive.between is not None
    ends = zip(drive.ends(machine.bodies), drive.between, strict=True)
    a, b = (poses.place(body, machine.points_of(body)[point]) for body, point in ends)
    return np.asarray(np.linalg.norm(b - a, axis=-1))


def rising(values: Array) -> slice:
    """The longest part of a turn over which values only rise or only fall, from 0 on."""
    signs = np.sign(np.diff(values))
    cuts = [0, *(1 + np.flatnonzero(signs[1:] != signs[:-1])), len(signs)]
    k = int(np.argmax(np.diff(cuts)))
    return slice(cuts[k], cuts[k + 1] + 1)


def law(rng: np.random.Generator, first: float, last: float) -> LengthLaw:
    """From one length to another and back: by a sine, or with a rest at either end."""
    if rng.random() < 0.5:
        return LengthLaw(between=(first, last), phase=float(rng.uniform(0, 6)))
    parts = 2 * np.pi * rng.dirichlet([20.0] * 4)
    ends = (last, last, first, first)
    laws = ("cycloidal", "cycloidal", "modified sine", "cycloidal")
    each = zip(parts.tolist(), ends, laws, strict=True)
    return LengthLaw(start=first, segments=tuple(LengthSegment(*item) for item in each))


def pushed(machine: Machine, drive: Drive, share: float, rng: np.random.Generator) -> Machine:
    """The machine with a drive that pushes, and a stroke that it can do."""
    values = lengths(machine, drive)
    part = rising(values)
    span = part.stop - 1 - part.start
    low, high = part.start + 0.5 * (1 - share) * span, part.stop - 1 - 0.5 * (1 - share) * span
    ends = [round(float(rng.uniform(low, low + 0.3 * share * span))), round(high)]
    first, last = (float(values[k]) for k in ends[:: int(rng.choice([-1, 1]))])
    slope = np.min(np.abs(np.diff(values[round(low) : round(high) + 1]))) / CYCLE[1]
    if slope < LEAST * float(np.ptp(values) if drive.slider else np.max(values)):
        raise UsageError("hardly anything moves")
    stroke = law(rng, first, last)
    start = np.interp(float(stroke.value(0.0)[0]), *_sorted(values[part], CYCLE[part]))
    pushing = replace(drive, stroke=stroke, start=float(start))
    return replace(machine, drive=pushing)


def _sorted(values: Array, angles: Array) -> tuple[Array, Array]:
    order = slice(None) if values[-1] > values[0] else slice(None, None, -1)
    return values[order], angles[order]


def drives(machine: Machine, by_slider: bool) -> list[dict[str, Any]]:
    """Every pair of points of two bodies, or every sliding joint, that could be driven: no rack's
    that its pinion moves, as that tells where it is at crank angle 0."""
    if by_slider:
        moved = {coupling.driven for coupling in machine.couplings}
        return [{"slider": slider.name} for slider in machine.sliders if slider.link not in moved]
    bodies = machine.bodies
    ends = [(body, point) for body in (FRAME, *machine.links) for point in bodies[body]]
    actual = []
    for (first, a), (other, b) in permutations(ends, 2):
        drive = Drive(machine.drive.link, 1.0, between=(a, b))
        if a != b and first != other and drive.ends(bodies) == (first, other):
            actual.append({"between": (a, b)})
    return actual


def stroked(kind: str, seed: int, by_slider: bool = False) -> Case:
    """A random machine of a kind of `machines` that is pushed, the same at every call."""
    case = make(kind, seed)
    rng = np.random.default_rng([seed, by_slider, *kind.encode()])
    own = replace(case.machine.drive, flywheel=0.0, motor=None)
    machine = replace(case.machine, drive=own)
    result = drives(machine, by_slider)
    for share, k in product(SHARES, rng.permutation(len(result))):
        try:
            drive = replace(own, **result[k], stroke=LengthLaw(between=(0.0, 1.0)))
            pushing = pushed(machine, drive, share, rng)
            move(pushing, [0.0])
        except EquipoiseError:  # the points hang on gears, whose start is another one then
            continue
        return replace(case, machine=pushing)
    raise CannotBePushed(f"{kind}:{seed}")


# -- several drives of which one or more push ------------------------------------------------------

KNOTS = np.linspace(0, 2 * np.pi, 24, endpoint=False)
"""Crank angles at which the lengths of a stroke are given."""
NEAR = 0.1
"""rad: by which a link may start elsewhere than it is told to."""


def sine(rng: np.random.Generator) -> tuple[float, float, float]:
    """Draw the middle, the amplitude and the phase of a swing."""
    return float(rng.uniform(-3, 3)), float(rng.uniform(0.05, 0.2)), float(rng.uniform(-3, 3))


def through(values: Array) -> LengthLaw:
    """A stroke through lengths at the knots."""
    return LengthLaw(crank_angles=tuple(KNOTS), values=tuple(values.tolist()), spline="quintic")


def pushed_arm(rng: np.random.Generator) -> Machine:
    """An arm of two or three links, one on the other, each pushed by a cylinder to the one before
    it; or the first turned by a swing."""
    count, size = int(rng.integers(2, 4)), float(10 ** rng.uniform(-1, 0.5))
    bodies, angles = [FRAME, *(f"link {k}" for k in range(count))], [np.zeros(24)]
    points: dict[str, dict[str, Any]] = {FRAME: {"J0": tuple(rng.normal(size=2) * size)}}
    drives: list[Drive | FurtherDrive] = []
    for k, (before, body) in enumerate(pairwise(bodies)):
        middle, amplitude, phase = sine(rng)
        angles.append(middle + amplitude * np.sin(KNOTS + phase))
        points[body] = {f"J{k}": (0.0, 0.0), f"J{k + 1}": (size * float(rng.uniform(1, 2)), 0.0)}
        seen = angles[-1] - angles[-2]
        along, apart = rng.uniform(-3, 3), rng.choice([-1, 1]) * rng.uniform(0.5, 2.6)
        own, other = size * rng.uniform(0.3, 1, 2) * np.exp(1j * np.array([along, along + apart]))
        turned = other * np.exp(1j * np.mean(seen))  # so that the cylinder has a lever
        held = complex(*points[before][f"J{k}"]) + turned
        points[before][f"V{k}"] = (held.real, held.imag)
        points[body][f"U{k}"] = (own.real, own.imag)
        result = abs(own * np.exp(1j * seen) - turned)
        pair = (f"V{k}", f"U{k}") if rng.random() < 0.5 else (f"U{k}", f"V{k}")
        start = float(angles[-1][0]) + float(rng.uniform(-NEAR, NEAR))
        stroke: dict[str, Any] = {"between": pair, "stroke": through(result), "start": start}
        if k == 0 and rng.random() < 0.3:
            swing = (middle - amplitude, middle + amplitude)
            stroke = {"motion": AngleLaw(between=swing, phase=np.pi / 2 - phase)}
        first = Drive(body, float(rng.uniform(1, 9)), **stroke) if k == 0 else None
        drives.append(first or FurtherDrive(body, **stroke))
    links = {
        body: Link(points[body], float(rng.uniform(1, 5)), tuple(rng.normal(size=2) * size),
                   float(rng.uniform(0.1, 1)) * size**2)
        for body in bodies[1:]
    }  # fmt: skip
    first, *others = drives
    assert isinstance(first, Drive)
    load = Load(bodies[-1], point=f"J{count}", force=tuple(rng.normal(size=2) * 30))
    return Machine("arm", first, points[FRAME], links, {}, drives=tuple(others), loads=(load,))  # type: ignore[arg-type]


def pushed_five_bar(rng: np.random.Generator) -> Machine:
    """A five-bar of which one crank or both are pushed, between any two points."""
    case = make("geared_five_bar", int(rng.integers(1000)))
    swings = [AngleLaw(between=(m - a, m + a), phase=p) for m, a, p in (sine(rng), sine(rng))]
    (gear,) = case.machine.gears
    drive = Drive(case.machine.drive.link, case.machine.drive.speed, motion=swings[0])
    other = FurtherDrive(gear.driven, motion=swings[1])
    machine = replace(case.machine, gears=(), drive=drive, drives=(other,), loads=())
    motion = move(machine, KNOTS)
    result = drives(machine, by_slider=False)
    both = rng.permutation(len(result))[:2]
    pushing: list[Any] = []
    for item, k in zip((drive, other), both, strict=True):
        if pushing == [drive] or rng.random() < 0.7:
            whole = lengths(machine, replace(drive, motion=None, **result[k]))
            length = np.interp(KNOTS, CYCLE, whole)
            start = float(motion.links[item.link].angle[0])
            item = replace(item, motion=None, stroke=through(length), start=start, **result[k])  # noqa: PLW2901
        pushing.append(item)
    return replace(machine, drive=pushing[0], drives=(pushing[1],))


TOGETHER = {"arm": pushed_arm, "five-bar": pushed_five_bar}


PUSHED = [
    *(f"pushed {kind}:0" for kind in ("stephenson", "quick_return", "geared_coupler", *TOGETHER)),
    *(f"driven {kind}:0" for kind in ("slider_crank", "crossed_guides")),
    *(f"pushed {kind}:1" for kind in TOGETHER),
]
"""Names of some: by a cylinder, or along a sliding joint."""


def named(name: str) -> Case:
    """One of these by its name."""
    how, _, which = name.partition(" ")
    kind, _, seed = which.partition(":")
    make_one = together if kind in TOGETHER else stroked
    return make_one(kind, int(seed)) if how == "pushed" else stroked(kind, int(seed), True)


def together(kind: str, seed: int) -> Case:
    """A random machine of several drives of which one or more push, the same at every call."""
    rng = np.random.default_rng([seed, *kind.encode()])
    for _ in range(200):
        try:
            machine = TOGETHER[kind](rng)
            move(machine, [0.0])
        except EquipoiseError:
            continue
        return Case(machine)
    raise CannotBePushed(f"{kind}:{seed}")


FIRST = {kind: make(kind, 0).machine for kind in KINDS}
TURNING = [kind for kind, value in FIRST.items() if value.drive.motion is None and not value.drives]
SLIDING = [kind for kind in TURNING if drives(FIRST[kind], by_slider=True)]
