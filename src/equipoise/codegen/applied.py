"""What acts on links from outside, springs, and the tension of belts, in terms."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.terms import Pair
from equipoise.codegen.trace import Array, Trace
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import planar
from equipoise.mechanism.dynamics.loads import load_at
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import FRAME, Load, Spring

Held = tuple[str, Any, Any]
"""Link, and force and moment that hold something against it."""


def trace_load(trace: Trace, number: int, load: Load) -> Held:
    """What holds the load of this number, from 1 on."""
    parts = (
        trace.row(f"load {number} {key}", partial(_part_of_load, load, key))
        for key in ("x", "y", "torque")
    )
    x, y, torque = parts
    return _held(trace, load.link, load.point, Pair(x, y), torque)


def _part_of_load(load: Load, key: str, theta: Array) -> Array:
    force, torque = load_at(load, theta)
    return np.asarray({"x": force.real, "y": force.imag, "torque": torque}[key] + 0.0 * theta)


def trace_spring(trace: Trace, number: int, spring: Spring) -> Iterator[Held]:
    """What holds a spring at each of its ends on a link."""
    pull = kernels.spring(*stretched(trace, number))
    for (link, point), force in zip(spring.ends, (pull, -pull), strict=False):
        yield _held(trace, link, point, force, 0.0)


def stretched(trace: Trace, number: int) -> tuple[Any, Any, Any, Any]:
    """Both ends of a spring, its stiffness and its free length."""
    spring = trace.machine.springs[number]
    place, *_ = trace.point(spring.link, spring.point)
    on_frame = spring.on == FRAME
    to = trace.state[f"p({spring.to})"] if on_frame else trace.point(spring.on, spring.to)[0]
    stiffness = trace.slot(
        f"stiffness({number})", lambda one: one.machine.springs[number].stiffness
    )
    free = trace.slot(f"free({number})", lambda one: one.machine.springs[number].free_length)
    return place, to, stiffness, free


def trace_tension(trace: Trace, number: int) -> Iterator[Held]:
    """What holds the tension that both strands of a belt have anyway."""
    belt = trace.machine.belts[number]
    if belt.tension is None:
        return
    driver, driven = coupling_pins(trace.linkage.joints, belt)

    def pull(found: Linkage) -> Any:
        own, points = found.machine.belts[number], found.machine.points_of(belt.carrier)
        assert own.tension is not None  # machines of the same build have it or lack it
        strands = own.strands(planar(points[driven]) - planar(points[driver]))
        return own.tension * 2 * strands.cosine / strands.distance

    share = trace.slot(f"tension({number})", pull)
    ends = [trace.point(belt.carrier, pin)[0] for pin in (driver, driven)]
    force = (ends[1] - ends[0]) * share
    for link, pin, pulled in ((belt.driver, driver, force), (belt.driven, driven, -force)):
        if link != FRAME:
            yield _held(trace, link, pin, pulled, 0.0)


def _held(trace: Trace, link: str, point: str | None, force: Any, torque: Any) -> Held:
    """What holds a force at a point of a link, and a torque on it."""
    anchor = trace.body(link)[0]
    at = anchor if point is None else trace.point(link, point)[0]
    return link, *kernels.load_demand(anchor, at, force, torque)
