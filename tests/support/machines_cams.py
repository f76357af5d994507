"""Random machines with cams: all kinds of followers, sliding and pinned, on frame and links."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError, MotionError
from equipoise.mechanism.parts.cams import RIDES, Cam
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment, LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import FRAME, Drive, Machine, Position, Slider
from equipoise.mechanism.parts.springs import Spring
from support.cams import Cut
from support.machines import Case, Draft, _draft, _four_bar, _scaled, _unit
from unit.mechanism.build import heavy

SMOOTH = ("cycloidal", "modified sine", "modified trapezoid", "3-4-5", "4-5-6-7", "harmonic")


def _law(rng: np.random.Generator, largest: float, sliding: bool) -> dict[str, Any]:
    """Draw a motion: a sine, segments with dwells, or a spline."""
    law, part = (LengthLaw, LengthSegment) if sliding else (AngleLaw, AngleSegment)
    phase, high = float(rng.uniform(-pi, pi)), largest * float(rng.uniform(0.2, 1))
    kind = rng.integers(0, 4)
    if kind == 0:
        given: Any = law(between=(0.0, high), phase=phase)
    elif kind == 1:
        at = np.cumsum(rng.uniform(0.6, 1, 6))
        at *= 2 * pi / (at[-1] + 0.8)
        values = tuple(map(float, high * rng.uniform(0, 1, 6)))
        given = law(
            crank_angles=tuple(map(float, at)), values=values, spline="quintic", phase=phase
        )
    else:
        ends = [0.0, high, high, 0.3 * high, 0.0, 0.0]
        widths = rng.uniform(0.7, 1.3, 5)
        widths *= 2 * pi / widths.sum()
        names = rng.choice(SMOOTH, 5)
        parts = tuple(
            part(float(over), float(to), str(name))
            for over, (_, to), name in zip(widths, pairwise(ends), names, strict=True)
        )
        given = law(segments=parts, phase=phase)
    return {"lift" if sliding else "swing": given}


def _cam(
    rng: np.random.Generator,
    ends: tuple[str, str, str],
    size: float,
    *,
    sliding: bool,
    normal: float | None = None,
) -> Cam:
    """Draw a cam whose follower's roller, edge or face is at its point K."""
    rides = str(rng.choice(RIDES))
    roller = float(rng.uniform(0.1, 0.4)) * size if rides == "roller" else 0.0
    if rides != "flat":
        normal = None
    return Cam(
        ends[0],
        ends[1],
        rides,  # type: ignore[arg-type]
        "K",
        "ribs",
        size - roller,
        roller,
        ends[2],
        **_law(rng, 0.35 * size if sliding else 0.35, sliding),
        normal=normal,
        side="left" if rng.random() < 0.5 else "right",
    )


def _followed(
    draft: Draft, cam: str, carrier: str, size: float, axis: Any, *, sliding: bool
) -> Callable[[Machine], Machine]:
    """Add a follower to a draft whose carrier already has the points that it needs."""
    rng = draft.rng
    if sliding:
        draft.add("tappet", H=(0, 0), K=rng.normal(size=2) * 0.2 * size, T=_scaled(rng, draft))
        draft.slide("tappet", "H", carrier, axis[1], axis[0], level=True)
        if rng.random() < 0.3:  # the same guide, told by the other body
            first = draft.sliders.pop()
            turned = replace(
                first,
                link=first.on,
                point=first.through,
                on=first.link,
                through=first.point,
                direction=-first.angle,
                angle=-first.direction,
            )
            draft.sliders.append(turned if first.on != FRAME else first)
        lean = float(rng.uniform(-0.6, 0.6)) * bool(rng.random() < 0.5)
        normal = draft.turns["tappet"] + lean
    else:
        arm = size * float(rng.uniform(1.8, 2.4))
        draft.add("lever", **{axis[1]: (0, 0)}, K=(arm, 0), T=_scaled(rng, draft))
        normal = draft.turns["lever"] + float(rng.choice([-1, 1])) * pi / 2
    link = "tappet" if sliding else "lever"
    made = _cam(rng, (cam, link, carrier), size, sliding=sliding, normal=normal)
    return lambda machine: replace(machine, cams=(made,))


def _case(draft: Draft, with_cam: Callable[[Machine], Machine], drive: str = "crank") -> Case:
    case = draft.case(drive)
    machine = with_cam(case.machine)
    pulled = "T"
    if draft.rng.random() < 0.5:  # between the follower and a link that moves as well
        other = next(iter(machine.links))
        at = next((p for p in machine.links[other].points if p not in machine.frame), None)
        link = machine.cams[0].driven
        if at is not None and other != link and at not in machine.links[link].points:
            spring = Spring(link, pulled, at, 30.0, 0.0, other)
            machine = replace(machine, springs=(*machine.springs, spring))
    return Case(machine, case.sides)


def camshaft(rng: np.random.Generator, sliding: bool) -> Case:
    """A cam on the crank and a follower on the frame."""
    draft = _draft(rng)
    size = draft.size
    draft.ground("A", (0, 0))
    draft.add("crank", A=(0, 0), B=_scaled(rng, draft))
    way = float(rng.uniform(-pi, pi))
    side = float(rng.uniform(-0.3, 0.3)) * size
    draft.ground(
        "G", size * (2.5 * _unit(way) if not sliding else side / size * _unit(way + pi / 2))
    )
    return _case(draft, _followed(draft, "crank", FRAME, size, (way, "G"), sliding=sliding))


def camshaft_tappet(rng: np.random.Generator) -> Case:
    return camshaft(rng, True)


def camshaft_lever(rng: np.random.Generator) -> Case:
    return camshaft(rng, False)


def fixed_cam(rng: np.random.Generator, sliding: bool) -> Case:
    """A cam that stands still, round which the crank carries its follower."""
    draft = _draft(rng)
    size = draft.size
    draft.ground("A", (0, 0))
    way = float(rng.uniform(-pi, pi))
    side = float(rng.uniform(-0.3, 0.3)) * size
    draft.add("crank", A=(0, 0), G=2.5 * size * _unit(way), S=side * _unit(way + pi / 2))
    line = (way, "S") if sliding else (way, "G")
    return _case(draft, _followed(draft, FRAME, "crank", size, line, sliding=sliding))


def fixed_cam_tappet(rng: np.random.Generator) -> Case:
    return fixed_cam(rng, True)


def fixed_cam_lever(rng: np.random.Generator) -> Case:
    return fixed_cam(rng, False)


def pusher(rng: np.random.Generator, sliding: bool) -> Case:
    """A four-bar whose crank is a cam for a follower on the coupler, as in a planting arm."""
    way, side = float(rng.uniform(-pi, pi)), float(rng.uniform(-0.3, 0.3))
    spot = side * _unit(way + pi / 2) if sliding else 2.5 * _unit(way)
    four = _four_bar(rng, (float(spot[0]), float(spot[1])))
    draft = four.draft
    follow = _followed(draft, "crank", "coupler", draft.size, (way, "P"), sliding=sliding)
    return _case(draft, follow)


def pusher_tappet(rng: np.random.Generator) -> Case:
    return pusher(rng, True)


def pusher_lever(rng: np.random.Generator) -> Case:
    return pusher(rng, False)


def looped(rng: np.random.Generator, sliding: bool) -> Case:
    """A five-bar whose coupler is a cam for a link on the next one: none can be moved by itself."""
    draft = _draft(rng)
    size, way, lean = draft.size, float(rng.uniform(-0.5, 0.5)), float(rng.normal() * 0.3)
    link = "tappet" if sliding else "lever"
    foot = (0.0, 0.3 * size) if sliding else (2.5 * size, 0.0)
    points = {"K": (0.0, 0.0)} if sliding else {"S": (0.0, 0.0), "K": (2.2 * size, 0.0)}
    far = size * (4.5 * _unit(float(rng.uniform(-0.6, 0.6))))
    links = {
        "crank": heavy(A=(0.0, 0.0), B=(0.6 * size, 0.0)),
        "coupler": heavy(B=(0.0, 0.0), C=(4 * size, 0.0)),
        "bar": heavy(C=(0.0, 0.0), S=foot),
        link: heavy(**points, D=(float(far[0]), float(far[1]))),
    }
    slider = Slider("tappet", "K", "bar", "S", way, 0.3)
    normal = -0.3 + lean if sliding else float(rng.choice([-1, 1])) * pi / 2
    cam = _cam(rng, ("coupler", link, "bar"), size, sliding=sliding, normal=normal)
    machine = Machine(
        "looped", Drive("crank", 7.0, 20.0), {"A": (0.0, 0.0), "D": (1.0, 1.0)}, links,
        sliders=(slider,) if sliding else (), cams=(cam,), gravity=(0.3, -9.0),
    )  # fmt: skip
    cut, angles = Cut(machine, cam), rng.uniform(0, 2 * pi, 2)
    b = 0.6 * size + 0j
    c = b + 4 * size * np.exp(1j * angles[0])
    start, sense = cut.rest
    place, turn = cut.pose(start + sense * float(cam.law.value(angles[0] - angles[1])[0]))
    place, turn = c + place * np.exp(1j * angles[1]), turn + angles[1]
    d = place + np.exp(1j * turn) * (cut.at(link, "D") - cut.foot)
    rough = {"B": b, "C": c, "D": d}
    position = Position(
        0.0, {name: (at.real, at.imag) for name, at in rough.items()},
        {"coupler": angles[0], "bar": angles[1], link: turn},
    )  # fmt: skip
    frame = {"A": (0.0, 0.0), "D": (float(d.real), float(d.imag))}
    return Case(replace(machine, frame=frame, position=position))


def looped_tappet(rng: np.random.Generator) -> Case:
    return looped(rng, True)


def looped_lever(rng: np.random.Generator) -> Case:
    return looped(rng, False)


LOOPED = {"looped_tappet": looped_tappet, "looped_lever": looped_lever}
"""Kinds that Newton's method has to solve."""
KINDS = {item.__name__: item for item in (camshaft_tappet, camshaft_lever, fixed_cam_tappet,
                                       fixed_cam_lever, pusher_tappet, pusher_lever)}  # fmt: skip
ALL = {**KINDS, **LOOPED}


def make(kind: str, seed: int) -> Case:
    """Return the machine of a kind that belongs to a seed, one whose cam can be made."""
    from equipoise.mechanism.assembly.linkage import assemble

    for draw in range(200):
        case = ALL[kind](np.random.default_rng([seed, draw, *kind.encode()]))
        try:
            assemble(case.machine).cycle  # noqa: B018
        except (ModelError, MotionError):
            continue
        return case
    raise AssertionError("no draw can be made")
