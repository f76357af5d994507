"""Followers of cams: links whose displacement in the carrier follows from a cam moved before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.builder import Builder, Group, guide_reaction
from equipoise.mechanism.assembly.cam_fits import CamFit, check_shape, fitted
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.loops import CouplingLoop, End, Poses
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Reaction,
    Rotation,
    State,
    Step,
    demand_names,
    p,
    pin_reaction,
    u,
)
from equipoise.mechanism.formulas import cam_kernels as kernels
from equipoise.mechanism.formulas.kernels import travelled
from equipoise.mechanism.parts.cams import Cam


@dataclass(frozen=True)
class Displacement:
    """What the law of a cam says at the angle that this has turned against its carrier."""

    cam: Cam
    outputs: tuple[str, str, str]

    def run(self, state: State) -> None:
        cam = self.cam
        angle = np.asarray(state[f"phi({cam.driver})"]) - state[f"phi({cam.carrier})"]
        state.update(zip(self.outputs, cam.law.value(angle), strict=True))


def contact(builder: Builder, joints: Structure, cam: Cam) -> CamPush:
    """How a cam and its follower go together.

    Raises
    ------
    ModelError : they cannot be joined like this, or the cam cannot be made.
    """
    fit = fitted(builder.machine, joints, cam)
    if not fit.has_columns:  # else `can_be_made` checks design by design
        check_shape(builder.machine, joints, fit)
    return CamPush(fit)


@dataclass(frozen=True)
class CamPush:
    """How a cam pushes its follower."""

    fit: CamFit

    couples: ClassVar[bool] = False

    def group(self, builder: Builder, joints: Structure) -> Group:
        return _follower(builder, joints, self.fit)

    def loop(self, end: Callable[[str, str], End]) -> CamLoop:
        fit, cam = self.fit, self.fit.cam
        on, by = end(cam.driven, fit.joint), end(cam.driver, fit.cam_pin)
        base = end(cam.carrier, fit.pin if fit.guide is None else fit.guide.base)
        kernel, numbers = cam.relation
        return CamLoop(
            cam.name, cam.list_name, on, by, cam.carrier, kernel, numbers, 0.0, self, None,
            end(cam.driven, cam.point), end(cam.carrier, fit.cam_pin), base,
        )  # fmt: skip


@dataclass(frozen=True)
class CamLoop(CouplingLoop):
    """Loop of a follower, whose displacement is a function of the angle of its cam.

    rider : what is on the cam.  axis : of the cam, and base : of the follower's pin or guide, as
    the carrier has them.
    """

    contact: Any
    rider: End
    axis: End
    base: End

    starts: ClassVar[bool] = False
    switches: ClassVar[bool] = False

    @property
    def fit(self) -> CamFit:
        fit: CamFit = self.contact.fit
        return fit

    @property
    def at(self) -> str:
        return _at(self.fit.cam)

    def after(self, builder: Builder) -> list[Step]:
        """What the law says, and where the two touch."""
        cam = self.fit.cam
        steps = _displaced(builder, self.fit)
        return [*steps, *builder.reach(cam.driven, cam.point), *_touch(self.fit)]

    def displaced(self, poses: Poses) -> tuple[Any, Any, Any]:
        turned = poses[self.by.body].angle - poses[self.carrier].angle
        y, y1, y2 = self.fit.cam.law.value(turned)
        return y, y1, y2

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        fit, carrier, link = self.fit, poses[self.carrier], poses[self.on.body]
        (_, w, a), (_, w_r, a_r) = carrier.turn, poses[self.by.body].turn
        y, y1, y2 = self.displaced(poses)
        if fit.guide is None:
            parts = kernels.swung(y, y1, y2, w_r, a_r, carrier.angle, w, a, fit.rest, fit.sense)
            off = link.turn[0] * np.exp(-1j * parts[0])
            half = 2 * off.imag / (1 + off.real)  # twice the tangent of half the angle
            return [(half, link.turn[1] - parts[1], link.turn[2] - parts[2])[level]]
        ends = (*link.point(self.on.arm), *carrier.point(self.base.arm))
        way = travelled(*ends, *carrier.turn, fit.guide.along)
        slip = w_r - w
        parts = fit.rest + y, y1 * slip, y1 * (a_r - a) + y2 * slip * slip
        return [way[level] - parts[level]]

    def touching(self, poses: Poses) -> tuple[Any, Any]:
        """Where the two touch, and the common normal."""
        fit, (_, y1, _) = self.fit, self.displaced(poses)
        carrier, link = poses[self.carrier], poses[self.on.body]
        p, axis = link.place_of(self.rider.arm), carrier.place_of(self.axis.arm)
        if fit.guide is None:
            (rate,) = kernels.rate_swung(p, carrier.place_of(self.base.arm), y1, fit.sense)
        else:
            (rate,) = kernels.rate_lifted(carrier.turn[0], y1, fit.guide.along)
        if fit.face is None:
            at, normal = kernels.touch_round(p, axis, rate, fit.cam.roller_radius)
        else:
            sense = fit.sense if fit.guide is None else 0.0
            at, normal = kernels.touch_flat(p, axis, rate, link.turn[0], y1, fit.face, sense)
        return at, normal

    def place(self, poses: Poses) -> Any:
        return self.touching(poses)[0]

    def wrenches(self, poses: Poses, sense: Any) -> list[tuple[Any, float]]:
        return [(self.touching(poses)[1], 0.0)]


def _displaced(builder: Builder, fit: CamFit) -> list[Step]:
    """Steps that find what the law says."""
    cam = fit.cam
    steps: list[Step] = []
    for body in (cam.driver, cam.carrier):
        steps += builder.running_angle(body)
    steps += builder.reach(cam.driver, fit.cam_pin)
    steps.append(Displacement(cam, _lift(cam)))
    return steps


def _lift(cam: Cam) -> tuple[str, str, str]:
    return f"y({cam.name})", f"y1({cam.name})", f"y2({cam.name})"


def _follower(builder: Builder, joints: Structure, fit: CamFit) -> Group:
    """A follower whose cam and carrier are known; the steps of its motion and forces."""
    cam, lift = fit.cam, _lift(fit.cam)
    motion = _displaced(builder, fit)
    motion += (_swung if fit.guide is None else _lifted)(builder, joints, fit, lift)
    motion += builder.reach(cam.driven, cam.point)
    motion += _touch(fit)
    ground, push, *forces = _forces(builder, joints, fit)
    reactions = builder.hand_over(ground), builder.hand_over(push)
    return Group("coupled", (cam.driven,), tuple(motion), (*forces, *reactions), (ground, push))


def _turning(body: str) -> tuple[str, str]:
    return f"w({body})", f"a({body})"


def _lifted(builder: Builder, _: Structure, fit: CamFit, lift: tuple[str, ...]) -> list[Step]:
    """A follower on a guide of the carrier."""
    cam, guide = fit.cam, fit.guide
    assert guide is not None
    inputs = (*lift, *_turning(cam.driver), *p(guide.base), *u(cam.carrier))
    numbers = (guide.along, guide.turn, fit.rest)
    steps = builder.reach(cam.carrier, guide.base)
    builder.add({cam.driven: guide.point}, [guide.point])
    outputs = (*p(guide.point), *u(cam.driven))
    return [*steps, KernelCall(kernels.lifted, inputs, numbers, outputs)]


def _swung(builder: Builder, joints: Structure, fit: CamFit, lift: tuple[str, ...]) -> list[Step]:
    """A follower on a pin of the carrier."""
    cam = fit.cam
    link, carrier = cam.driven, cam.carrier
    steps = builder.reach(builder.carrier_of(joints.pins[fit.pin]), fit.pin)
    inputs = (*lift, *_turning(cam.driver), f"phi({carrier})", *_turning(carrier))
    angles = (f"phi({link})", *_turning(link))
    builder.add({link: fit.pin}, [fit.pin])
    builder.running.add(link)
    return [
        *steps,
        KernelCall(kernels.swung, inputs, (fit.rest, fit.sense), angles),
        Rotation(link),
    ]


def _touch(fit: CamFit) -> list[Step]:
    """Where cam and follower touch, the common normal, and how the follower moves there."""
    cam, name = fit.cam, fit.cam.name
    place, contact, rate = f"p({cam.point})", f"p({_at(cam)})", f"rate({name})"
    pressed, forth = contact if cam.rides == "flat" else place, (f"forth({name})",)
    if fit.guide is not None:
        along: Any = fit.guide.along
        carrier = f"u({cam.carrier})"
        towards = KernelCall(kernels.rate_lifted, (carrier, f"y1({name})"), (along,), (rate,))
        rising = KernelCall(kernels.forth_lifted, (carrier,), (along,), forth)
    else:
        inputs = (place, f"p({fit.pin})", f"y1({name})")
        towards = KernelCall(kernels.rate_swung, inputs, (fit.sense,), (rate,))
        rising = KernelCall(kernels.forth_swung, (pressed, f"p({fit.pin})"), (fit.sense,), forth)
    ends, parts = (place, f"p({fit.cam_pin})", rate), (contact, f"normal({name})")
    if fit.face is None:
        return [towards, KernelCall(kernels.touch_round, ends, (cam.roller_radius,), parts), rising]
    face_inputs = (*ends, f"u({cam.driven})", f"y1({name})")
    sense = fit.sense if fit.guide is None else 0.0
    return [towards, KernelCall(kernels.touch_flat, face_inputs, (fit.face, sense), parts), rising]


def _at(cam: Cam) -> str:
    """The point at which cam and follower touch."""
    return f"contact({cam.name})"


def _forces(builder: Builder, joints: Structure, fit: CamFit) -> tuple[Any, ...]:
    """Reactions of joint and cam on the follower, and the step that finds them."""
    cam, link = fit.cam, fit.cam.driven
    push = Reaction(cam.name, cam.list_name, link, cam.driver, _at(cam), f"R({cam.name}/{link})")
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
            KernelCall(kernels.lifted_forces, inputs, numbers, (*ground.outputs, *pressed)),
        )
    ground = pin_reaction(fit.pin, link, builder.carrier_of(joints.pins[fit.pin]))
    return ground, push, KernelCall(kernels.swung_forces, inputs, (), (*ground.outputs, *pressed))
