"""Couplings that push along a line which is fixed on their carrier: by a flank, or by strands.

Driver and driven body turn about a pin of the carrier each, or one of them slides on it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.mechanism.assembly.builder import Builder, Group, Guide, guide_reaction
from equipoise.mechanism.assembly.joints import Structure, coupling_pins, place_in_file
from equipoise.mechanism.assembly.loops import CouplingLoop, End, Poses, Rides, Wrench
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Reaction,
    Rotation,
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
from equipoise.mechanism.parts.couplings import (
    Coupling,
    Law,
    LineOfAction,
    RollingLine,
    Seat,
    StrandLine,
)


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
                KernelCall(rolled, angles, (line.law, line.centres), place),
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
        bare = KernelCall(kernel, inputs, (*numbers, 0.0), driven.coordinate)
        with np.errstate(all="ignore"):  # what cannot come to crank angle 0 is refused later
            offset = coupling.start - at_start(run([bare], state)[driven.coordinate[0]])
        reached = builder.reach(bearer, guide.base if guide else driven.point)
        if guide:
            reached += builder.reach(carrier, self.pin)
        related = KernelCall(kernel, inputs, (*numbers, offset), driven.coordinate)
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
        return CouplingLoop(coupling.name, coupling.list_name, on, by, coupling.carrier, kernel,
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


def rolled(angle_r: Any, angle_c: Any, law: Law, centres: Any) -> tuple[Any, Any]:
    """Lever of the pitch point and slope of the pitch curves there; see `kernels.pitch_slope`."""
    _, ratio, bend = law(angle_r - angle_c)
    return centres / (1 - ratio), kernels.pitch_slope(ratio, bend)


def contact(builder: Builder, joints: Structure, coupling: Coupling) -> Flank:
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
