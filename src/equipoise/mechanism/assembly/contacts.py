"""How the two bodies of a coupling go together: in one of two ways, which its kind names.

Along a line that is fixed on their carrier one pushes the other by a flank, or by strands; each
turns about a pin of the carrier, or one of them slides on it.  By a surface a cam pushes its
follower, whose displacement in the carrier follows from it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.mechanism.assembly.builder import Builder, Group, Guide, guide_reaction
from equipoise.mechanism.assembly.cam_shapes import CamFit, check_shape, fitted
from equipoise.mechanism.assembly.joints import Structure, coupling_pins, place_in_file
from equipoise.mechanism.assembly.loops import Contact, CouplingLoop, End, Poses, Rides, Wrench
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Reaction,
    Rotation,
    State,
    Step,
    at_start,
    demand_names,
    p,
    pin_reaction,
    planar,
    run,
    u,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.kernels import travelled
from equipoise.mechanism.parts import laws
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.couplings import (
    Coupling,
    DerivedLaw,
    LineOfAction,
    RollingLine,
    Seat,
    StrandLine,
    coupled,
)


@dataclass(frozen=True)
class RelationCall(KernelCall):
    """The relation of a coupling, of whose numbers the last is the offset of the driven body."""

    coupling: Coupling

    @property
    def law(self) -> DerivedLaw | None:
        """By which the driven body's angle follows; None in a fixed ratio."""
        return self.parameters[0] if self.kernel is coupled else None


@dataclass(frozen=True)
class RollingCall(KernelCall):
    """Where pitch curves that are no circles touch: their law, and the way between the pins."""

    coupling: Coupling


@dataclass(frozen=True)
class CarrierJoint:
    """How the carrier holds driver or driven body: by a pin, or by a guide through a point of it.

    coordinate : names of its angle, or of its way along the guide, with both derivatives.
    """

    body: str
    point: str
    guide: Guide | None
    coordinate: tuple[str, str, str]

    @classmethod
    def of(cls, joints: Structure, coupling: Coupling, body: str, pin: str) -> CarrierJoint:
        """pin : about which it turns; empty of what slides."""
        if body == coupling.slides:
            guide = Guide.seen_from(joints.guides(coupling)[0], coupling.carrier)
            name = coupling.name
            return cls(body, guide.point, guide, (f"t({name})", f"t1({name})", f"t2({name})"))
        return cls(body, pin, None, (f"phi({body})", *u(body)[1:]))

    def known(self, builder: Builder, carrier: str) -> list[Step]:
        """Steps that find the coordinate of a body that is moved already."""
        if self.guide is None:
            return builder.running_angle(self.body)
        ends = (*p(self.point), *p(self.guide.base), *u(carrier))
        return [
            *builder.reach(self.body, self.point),
            *builder.reach(carrier, self.guide.base),
            KernelCall(kernels.travelled, ends, (self.guide.along,), self.coordinate),
        ]

    def moved(self, carrier: str) -> Step:
        """The step from the coordinate to the place of the body."""
        if self.guide is None:
            return Rotation(self.body)
        inputs = (*self.coordinate, *p(self.guide.base), *u(carrier))
        numbers = (self.guide.along, self.guide.turn)
        return KernelCall(kernels.railed, inputs, numbers, (*p(self.point), *u(self.body)))

    def reaction(self, by: str) -> Reaction:
        """What the carrier, or the body `by` that carries the pin, exerts on it."""
        if self.guide is None:
            return pin_reaction(self.point, self.body, by)
        return guide_reaction(self.guide, self.body, by, self.point)


@dataclass(frozen=True)
class Flank:
    """How a coupling pushes along a line that is fixed on the carrier, and how it is solved.

    arm : from the carrier's anchor to the pin from which the line's lever is counted; for loops.
    """

    coupling: Coupling
    driver: CarrierJoint
    driven: CarrierJoint
    line: LineOfAction | StrandLine | RollingLine
    arm: Any = 0j

    @property
    def couples(self) -> bool:
        """Whether the force goes with a couple, about the driven body's pin."""
        return isinstance(self.line, StrandLine)

    @property
    def pin(self) -> str:
        """From which the lever is counted."""
        return (self.driver if self.driven.guide else self.driven).point

    @property
    def push(self) -> Reaction:
        """The force of flank or strands on the driven body."""
        name, link = self.coupling.name, self.driven.body
        at, couple = (self.pin, f"C({name}/{link})") if self.couples else (f"pitch({name})", None)
        force = f"R({name}/{link})"
        return Reaction(name, self.coupling.list_name, link, self.driver.body, at, force, couple)

    def steps(self, ground: Reaction) -> tuple[Step, ...]:
        """Steps that find the push, and what holds the driven body on the carrier: `ground`.

        The sign of the moment that the driven body needs selects the flank, or strand, that bears.
        """
        line, name, turn = self.line, self.coupling.name, f"u({self.coupling.carrier})"
        sense, (force, moment) = f"flank({name})", demand_names(self.driven.body)
        sense_call = KernelCall(kernels.flank, (moment,), (), (sense,))
        inputs: tuple[str, ...] = (force, moment, turn, sense)
        outputs = (*ground.outputs, *self.push.outputs, f"T({name})")
        numbers: tuple[Any, ...]
        if isinstance(line, StrandLine):
            numbers = (line.radius, line.across, line.along)
            return sense_call, KernelCall(kernels.strand_forces, inputs, numbers, outputs)
        pitch = f"p({self.push.at})"
        if isinstance(line, RollingLine):
            place = lever, _ = f"lever({name})", f"slope({name})"
            angles = (f"phi({self.driver.body})", f"phi({self.coupling.carrier})")
            kernel = kernels.rolling_forces
            return (
                RollingCall(rolled, angles, (line.law, line.centres), place, self.coupling),
                KernelCall(kernels.pitch_place, (f"p({self.pin})", turn, lever), (), (pitch,)),
                sense_call,
                KernelCall(kernel, (*inputs, *place), (line.radial,), outputs),
            )
        at = KernelCall(kernels.point, (*p(self.pin), *u(self.coupling.carrier)), (line.lever,),
                  p(self.push.at))  # fmt: skip
        if self.driven.guide is None:
            numbers = (line.lever, line.slope)
            return at, sense_call, KernelCall(kernels.flank_forces, inputs, numbers, outputs)
        along = self.driven.guide.along
        inputs = (force, moment, f"p({self.driven.point})", pitch, turn, sense)
        return (
            at,
            KernelCall(kernels.flank_ahead, (force, turn), (along,), (sense,)),
            KernelCall(kernels.sliding_forces, inputs, (along, line.slope), outputs),
        )

    def group(self, builder: Builder, joints: Structure) -> Group:
        """The driven link, where driver and carrier are known."""
        coupling, driven, carrier = self.coupling, self.driven, self.coupling.carrier
        guide = driven.guide
        bearer = carrier if guide else builder.carrier_of(joints.pins[driven.point])
        before = (*self.driver.known(builder, carrier), *builder.running_angle(carrier))
        inputs = (*self.driver.coordinate, f"phi({carrier})", *u(carrier)[1:])
        kernel, numbers = coupling.relation
        state = run(before, dict(builder.now))
        bare = RelationCall(kernel, inputs, (*numbers, 0.0), driven.coordinate, coupling)
        with np.errstate(all="ignore"):  # what cannot come to crank angle 0 is refused later
            offset = coupling.start - at_start(run([bare], state)[driven.coordinate[0]])
        reached = builder.reach(bearer, guide.base if guide else driven.point)
        if guide:
            reached += builder.reach(carrier, self.pin)
        related = replace(bare, parameters=(*numbers, offset))
        motion = (*before, *reached, related, driven.moved(carrier))
        builder.add({driven.body: driven.point}, [driven.point])
        if not guide:
            builder.running.add(driven.body)
        ground = driven.reaction(bearer)
        passed = builder.hand_over(ground), builder.hand_over(self.push)
        forces = (*self.steps(ground), *passed)
        return Group("coupled", (driven.body,), motion, forces, (ground, self.push))

    def loop(self, end: Callable[[str, str], End]) -> CouplingLoop:
        """Flank as a loop equation; `end` finds points of bodies from their anchors."""
        coupling = self.coupling
        on, by = (end(item.body, item.point) for item in (self.driven, self.driver))
        rides = None
        for own, entry in ((on, self.driven), (by, self.driver)):
            if entry.guide is not None:
                rides = Rides(own, end(coupling.carrier, entry.guide.base), entry.guide.along)
        placed = replace(self, arm=end(coupling.carrier, self.pin).arm)
        kernel, numbers = coupling.relation
        return CouplingLoop(coupling.name, on, by, coupling.list_name, coupling.carrier, kernel,
                            numbers, 0.0, placed, rides)  # fmt: skip

    def place(self, poses: Poses) -> Any:
        """Where the push acts, complex, m."""
        return poses[self.coupling.carrier].place_of(self.arm + self._placed(poses)[0])

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Wrenches on the driven body for a push of 1 N; `sense` selects the flank that bears."""
        line, turn = self.line, poses[self.coupling.carrier].turn[0]
        if isinstance(line, StrandLine):
            return [(turn * (line.across + sense * line.along), line.radius)]
        lever, bend = self._placed(poses)
        if isinstance(line, RollingLine):
            slope = -kernels.slant(sense, line.radial, bend)
        else:
            slope = line.slope * sense
        guide = self.driven.guide
        ahead = guide.along if guide else 1j * lever * (1 / kernels.length(lever))
        return [(turn * ahead * (1 + 1j * slope), 0.0)]

    def _placed(self, poses: Poses) -> tuple[Any, Any]:
        """Where the push acts, from the pin, and the slope of pitch curves there."""
        line = self.line
        if isinstance(line, RollingLine):
            driver, carrier = poses[self.driver.body], poses[self.coupling.carrier]
            return rolled(driver.angle, carrier.angle, line.law, line.centres)
        return (line.lever if isinstance(line, LineOfAction) else 0.0), 0.0


def rolled(angle_r: Any, angle_c: Any, law: DerivedLaw, centres: Any) -> tuple[Any, Any]:
    """Lever of the pitch point and slope of the pitch curves there; see `kernels.pitch_slope`."""
    _, ratio, bend = law(angle_r - angle_c)
    return centres / (1 - ratio), kernels.pitch_slope(ratio, bend)


def flank_contact(builder: Builder, joints: Structure, coupling: Coupling) -> Flank:
    """The flank, or the strands, of a coupling.

    Raises
    ------
    ModelError : its bodies are not joined to the carrier, or cannot be where they are.
    """
    pins = _pins(joints, coupling)
    ends = zip((coupling.driver, coupling.driven), pins, strict=True)
    driver, driven = (CarrierJoint.of(joints, coupling, *end) for end in ends)
    carrier, way = coupling.carrier, 0j
    centres = builder.arm(carrier, pins[1], pins[0]) if all(pins) else 0j
    for item in (driver, driven):
        way = way if item.guide is None else item.guide.along

    def others() -> Iterator[tuple[str, Any, list[str]]]:
        points = builder.machine.points_of(carrier)
        for pin, bodies in joints.pins.items():
            if carrier not in bodies or pin in pins:
                continue
            turning = [body for body in bodies if body != carrier and body not in joints.riders]
            if turning:  # the centre of a slot is no axle
                yield pin, planar(points[pin]) - planar(points[pins[0]]), turning

    where = place_in_file(joints, coupling)
    line = coupling.line(Seat(where, pins, centres, way, others))
    return Flank(coupling, driver, driven, line)


def _pins(joints: Structure, coupling: Coupling) -> tuple[str, str]:
    """About which driver and driven body turn on the carrier; empty of the one that slides."""
    if not coupling.slides:
        return coupling_pins(joints, coupling)
    guides = len(joints.guides(coupling))
    pins, counts = [], []
    for body in (coupling.driver, coupling.driven):
        shared = joints.pins_between(body, coupling.carrier)
        slides = body == coupling.slides
        pins.append("" if slides else "".join(shared[:1]))
        counts.append(guides if slides else len(shared))
    if counts != [1, 1]:
        raise ModelError(place_in_file(joints, coupling), coupling.unheld(*counts))
    return pins[0], pins[1]


# -- surfaces of cams ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Displacement:
    """What the law of a cam says at the angle that this has turned against its carrier."""

    coupling: Cam
    outputs: tuple[str, str, str]

    @property
    def law(self) -> laws.Law:
        return self.coupling.law

    @property
    def law_key(self) -> str:
        """Of the law, in the table of the coupling."""
        return self.coupling.law_key

    def run(self, state: State) -> None:
        coupling = self.coupling
        angle = np.asarray(state[f"phi({coupling.driver})"]) - state[f"phi({coupling.carrier})"]
        state.update(zip(self.outputs, self.law.value(angle), strict=True))


def cam_contact(builder: Builder, joints: Structure, cam: Cam) -> CamPush:
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
            cam.name, on, by, cam.list_name, cam.carrier, kernel, numbers, 0.0, self, None,
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
        KernelCall(kernels.swung, inputs, (fit.rest, int(fit.sense)), angles),
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


WAYS: Mapping[str, Callable[..., Contact]] = {"line": flank_contact, "surface": cam_contact}
"""Kind of the line of action -> contact: fixed on the carrier or moving with a ratio, or normal to
a surface."""


def contact_of(builder: Builder, joints: Structure, coupling: Coupling) -> Contact:
    """How a coupling is solved, and how its driver pushes.

    Raises
    ------
    ModelError : its bodies are not joined as they would have to be.
    """
    return WAYS[coupling.contact](builder, joints, coupling)
