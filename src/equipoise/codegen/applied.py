"""What acts on links from outside, force elements, and preloads of couplings, in terms."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.terms import VectorTerm, angle_of, rotation
from equipoise.codegen.trace import FAR, Array, Trace
from equipoise.codegen.tracks import TracedCurve
from equipoise.dataclass import dataclass
from equipoise.keys import MEMORY, Frozen, with_fields
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import along, planar, u
from equipoise.mechanism.dynamics.loads import load_at
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.plane_curves import PlaneCurve
from equipoise.mechanism.kinematics.motion import ROUNDING
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.force_kinds import ForceElement
from equipoise.mechanism.parts.joint_kinds import joint_kinds
from equipoise.mechanism.parts.machine import FRAME, Load

ANGLE_MARGIN = 0.4
"""Added to the cosine of an angle, which is watched as that of a running angle is: beyond 154 deg
from its middle a design is computed by itself."""
HoldingWrench = tuple[str, Any, Any]
"""Link, and force and moment that hold something against it."""


def trace_load(trace: Trace, number: int, load: Load) -> HoldingWrench:
    """What holds the load of this number, from 1 on."""
    parts = (
        trace.row(f"load {number} {key}", partial(_part_of_load, load, key))
        for key in ("x", "y", "torque")
    )
    x, y, torque = parts
    force = VectorTerm(x, y)
    if load.axes is not None:
        force = force * trace.state[u(load.link)[0]]
    if load.axes == "slider":

        def turn(linkage: Linkage) -> Any:
            machine = linkage.machine
            return np.exp(1j * machine.loads[number - 1].axes_angle(machine.sliders))

        force = force * trace.slot(f"load {number} axes", turn, vector=True)
    return _holding_wrench(trace, load.link, load.point, force, torque)


def _part_of_load(load: Load, key: str, theta: Array) -> Array:
    force, torque = load_at(load, theta)
    return np.asarray({"x": force.real, "y": force.imag, "torque": torque}[key] + 0.0 * theta)


@dataclass(frozen=True)
class TracedBodies:
    """Bodies in terms, for the outputs of an element and what it exerts.

    name : of the element.
    """

    trace: Trace
    name: str

    def point(self, body: str, point: str) -> Any:
        """A point in the frame."""
        on_frame = body == FRAME
        return self.trace.state[f"p({point})"] if on_frame else self.trace.point(body, point)[0]

    def velocity(self, body: str, point: str) -> Any:
        """Velocity of a point in the frame, m/s."""
        if body == FRAME:
            return 0j
        return self.trace.point(body, point)[1] * self.trace.rate("speed")

    def angle(self, body: str, on: str, middle: Any) -> Any:
        """Angle of a body from the x axis of another, within half a turn of `middle`."""
        turn, other = (self.trace.state[u(item)[0]] for item in (body, on))
        away = turn * other.conjugate() * rotation(middle).conjugate()
        self.trace.running[f"{self.name}, {body} on {on}"] = away.real + ANGLE_MARGIN
        return middle + angle_of(away)

    def turn(self, body: str) -> Any:
        """Rotation of a body."""
        return self.trace.state[u(body)[0]]

    def turned(self, body: str, angle: Any) -> Any:
        """Unit vector at an angle from the x axis of a body."""
        return self.turn(body) * rotation(angle)

    def rate(self, body: str) -> Any:
        """Angular velocity of a body, rad/s."""
        return self.trace.state[u(body)[1]] * self.trace.rate("speed")

    def along(self, joint: str) -> tuple[Any, Any]:
        """How far along its track a rider is, m, and its speed along that, m/s."""
        s, speed = (self.trace.state[name] for name in along(joint))
        return TracedCurve(self.trace, self._curve(joint)).distance(s), speed * self.trace.rate(
            "speed"
        )

    def on_track(self, joint: str, wrong: str) -> None:
        """Watch how far a rider is from the ends of its track, as of `within`."""
        if not (curve := self._curve(joint)).closed:
            self.within(self.along(joint)[0], (0.0, curve.length), wrong)

    def _curve(self, joint: str) -> PlaneCurve:
        track = self.trace.linkage.joints.riders[joint].track
        assert track is not None
        return track.curve

    def bearing(self, vector: Any, middle: Any) -> Any:
        """Angle of a vector, within half a turn of `middle`."""
        return middle + angle_of(vector * rotation(middle).conjugate())

    def within(self, value: Any, ends: tuple[Any, Any], wrong: str) -> None:
        """Watch a value, so that a design in which it leaves its range is computed by itself."""
        for what, margin in (("lower", value - ends[0]), ("upper", ends[1] - value)):
            self.trace.running[f"{self.name}, {what} end"] = margin + (FAR + ROUNDING)


def trace_limits(trace: Trace) -> None:
    """Watch whether pins stay in their slots."""
    for table in joint_kinds(type(trace.machine)):
        for number in range(len(getattr(trace.machine, table))):
            element, at = traced_element(trace, table, number)
            element.values(at)


def trace_element(trace: Trace, table: str, number: int) -> Iterator[HoldingWrench]:
    """What holds a force element at each of its ends on a link.

    table, number : its list in the file, and its place there from 0.
    """
    element, at = traced_element(trace, table, number)
    assert isinstance(element, ForceElement)
    for link, point, force, torque in element.on_links(at):
        yield _holding_wrench(trace, link, point, force, torque)


def traced_element(trace: Trace, table: str, number: int) -> tuple[Element, TracedBodies]:
    """An element with terms for its numbers, and the bodies between which it acts."""
    name = f"{table}[{number}]"

    def read(linkage: Linkage, steps: tuple[str | int, ...]) -> Any:
        value = getattr(linkage.machine, table)[number]
        for step in steps:
            value = value[step] if isinstance(step, int) else getattr(value, step)
        return value

    def traced(value: Any, *steps: str | int) -> Any:
        """A value whose numbers are slots."""
        if isinstance(value, Frozen):
            still = value.still if isinstance(value, Element) else ()
            traceds = {key: traced(var, *steps, key) for key, var in vars(value).items()
                    if key not in still and key != MEMORY}  # fmt: skip
            return with_fields(value, **traceds)
        if isinstance(value, tuple):
            return tuple(traced(item, *steps, k) for k, item in enumerate(value))
        if not isinstance(value, float):
            return value
        return trace.slot(f"{name}{steps}", partial(read, steps=steps))

    element: Element = traced(getattr(trace.machine, table)[number])
    return element, TracedBodies(trace, name)


def trace_preload(trace: Trace, number: int) -> Iterator[HoldingWrench]:
    """What holds the preload of the coupling of this number, if it has one."""
    coupling = trace.machine.couplings[number]
    if not coupling.preload:
        return
    driver, driven = coupling_pins(trace.linkage.joints, coupling)

    def rate(linkage: Linkage) -> Any:
        points = linkage.machine.points_of(coupling.carrier)
        distance = abs(planar(points[driven]) - planar(points[driver]))
        return linkage.machine.couplings[number].preload_rate(distance)

    ends = [trace.point(coupling.carrier, pin)[0] for pin in (driver, driven)]
    force = (ends[1] - ends[0]) * trace.slot(f"preload rate({number})", rate)
    for link, pin, pulled in ((coupling.driver, driver, force), (coupling.driven, driven, -force)):
        if link != FRAME:
            yield _holding_wrench(trace, link, pin, pulled, 0.0)


def _holding_wrench(
    trace: Trace, link: str, point: str | None, force: Any, torque: Any
) -> HoldingWrench:
    """What holds a force at a point of a link, and a torque on it."""
    anchor = trace.body(link)[0]
    at = anchor if point is None else trace.point(link, point)[0]
    return link, *kernels.load_demand(anchor, at, force, torque)
