"""Followers of cams: links whose displacement in the carrier a cam tells that is moved already."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.mechanism import cam_kernels as kernels
from equipoise.mechanism.builder import Builder, Group, guide_reaction
from equipoise.mechanism.cam_fits import Fit, check_shape, fitted
from equipoise.mechanism.cams import Cam
from equipoise.mechanism.joints import Structure, place_in_file
from equipoise.mechanism.laws import Law
from equipoise.mechanism.steps import (
    Call,
    Reaction,
    Rotation,
    State,
    Step,
    demand_names,
    p,
    pin_reaction,
    u,
)


@dataclass(frozen=True)
class Displacement:
    """What the law says at the angle that a cam has turned against its carrier."""

    driver: str
    carrier: str
    law: Law
    outputs: tuple[str, str, str]

    def run(self, state: State) -> None:
        angle = np.asarray(state[f"phi({self.driver})"]) - state[f"phi({self.carrier})"]
        state.update(zip(self.outputs, self.law.value(angle), strict=True))


def follower(builder: Builder, joints: Structure, cam: Cam) -> Group:
    """A follower whose cam and carrier are known; the steps of its motion and forces."""
    fit = fitted(builder.machine, joints, cam)
    if np.ndim(fit.rest) == 0:  # else `family` tells which designs can be made
        check_shape(fit, place_in_file(joints, cam))
    motion: list[Step] = []
    for body in (cam.driver, cam.carrier):
        motion += builder.running_angle(body)
    motion += builder.reach(cam.driver, fit.cam_pin)
    lift = tuple(f"{y}({cam.name})" for y in ("y", "y1", "y2"))
    motion.append(Displacement(cam.driver, cam.carrier, cam.law, lift))  # type: ignore[arg-type]
    motion += (_swung if fit.guide is None else _lifted)(builder, joints, fit, lift)
    motion += builder.reach(cam.driven, cam.point)
    motion += _touch(fit)
    ground, push, *forces = _forces(builder, joints, fit)
    held = builder.hand_over(ground), builder.hand_over(push)
    return Group("coupled", (cam.driven,), tuple(motion), (*forces, *held), (ground, push))


def _turning(body: str) -> tuple[str, str]:
    return f"w({body})", f"a({body})"


def _lifted(builder: Builder, _: Structure, fit: Fit, lift: tuple[str, ...]) -> list[Step]:
    """A follower on a guide of the carrier."""
    cam, guide = fit.cam, fit.guide
    assert guide is not None
    inputs = (*lift, *_turning(cam.driver), *p(guide.base), *u(cam.carrier))
    numbers = (guide.along, guide.turn, fit.rest)
    steps = builder.reach(cam.carrier, guide.base)
    builder.add({cam.driven: guide.point}, [guide.point])
    outputs = (*p(guide.point), *u(cam.driven))
    return [*steps, Call(kernels.lifted, inputs, numbers, outputs)]


def _swung(builder: Builder, joints: Structure, fit: Fit, lift: tuple[str, ...]) -> list[Step]:
    """A follower on a pin of the carrier."""
    cam = fit.cam
    link, carrier = cam.driven, cam.carrier
    steps = builder.reach(builder.carrier_of(joints.pins[fit.pin]), fit.pin)
    inputs = (*lift, *_turning(cam.driver), f"phi({carrier})", *_turning(carrier))
    angles = (f"phi({link})", *_turning(link))
    builder.add({link: fit.pin}, [fit.pin])
    builder.running.add(link)
    return [*steps, Call(kernels.swung, inputs, (fit.rest, fit.sense), angles), Rotation(link)]


def _touch(fit: Fit) -> list[Step]:
    """Where cam and follower touch, the common normal, and how the follower moves there."""
    cam, name = fit.cam, fit.cam.name
    place, contact, rate = f"p({cam.point})", f"p({_at(cam)})", f"rate({name})"
    pressed, forth = contact if cam.rides == "flat" else place, (f"forth({name})",)
    if fit.guide is not None:
        along: Any = fit.guide.along
        carrier = f"u({cam.carrier})"
        towards = Call(kernels.rate_lifted, (carrier, f"y1({name})"), (along,), (rate,))
        rising = Call(kernels.forth_lifted, (carrier,), (along,), forth)
    else:
        inputs = (place, f"p({fit.pin})", f"y1({name})")
        towards = Call(kernels.rate_swung, inputs, (fit.sense,), (rate,))
        rising = Call(kernels.forth_swung, (pressed, f"p({fit.pin})"), (fit.sense,), forth)
    ends, found = (place, f"p({fit.cam_pin})", rate), (contact, f"normal({name})")
    if fit.face is None:
        return [towards, Call(kernels.touch_round, ends, (cam.roller_radius,), found), rising]
    more = (*ends, f"u({cam.driven})", f"y1({name})")
    sense = fit.sense if fit.guide is None else 0.0
    return [towards, Call(kernels.touch_flat, more, (fit.face, sense), found), rising]


def _at(cam: Cam) -> str:
    """The point at which cam and follower touch."""
    return f"contact({cam.name})"


def _forces(builder: Builder, joints: Structure, fit: Fit) -> tuple[Any, ...]:
    """Reactions of joint and cam on the follower, and the step that finds them."""
    cam, link = fit.cam, fit.cam.driven
    push = Reaction(cam.name, cam.kind, link, cam.driver, _at(cam), f"R({cam.name}/{link})")
    pressed = (*push.outputs, f"T({cam.name})")
    touching = (f"p({_at(cam)})", f"normal({cam.name})")
    inputs: tuple[str, ...] = (*demand_names(link), f"p({fit.joint})", *touching)
    if fit.guide is not None:
        ground = guide_reaction(fit.guide, link, cam.carrier, fit.joint)
        inputs = (*inputs, f"u({cam.carrier})")
        numbers: tuple[Any, ...] = (fit.guide.along,)
        return (
            ground,
            push,
            Call(kernels.lifted_forces, inputs, numbers, (*ground.outputs, *pressed)),
        )
    ground = pin_reaction(fit.pin, link, builder.carrier_of(joints.pins[fit.pin]))
    return ground, push, Call(kernels.swung_forces, inputs, (), (*ground.outputs, *pressed))
