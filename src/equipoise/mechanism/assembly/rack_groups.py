"""A rack that its pinion moves, and a pinion that its rack turns: their steps, and their teeth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Builder, Group, Guide, guide_reaction
from equipoise.mechanism.assembly.gear_contacts import Mesh
from equipoise.mechanism.assembly.joints import Structure, place_in_file
from equipoise.mechanism.assembly.loops import End, Poses, RackLoop
from equipoise.mechanism.assembly.steps import (
    Call,
    Reaction,
    Rotation,
    Step,
    at_start,
    demand_names,
    p,
    pin_reaction,
    run,
    u,
)
from equipoise.mechanism.assembly.turned import Turned
from equipoise.mechanism.formulas import joint_kernels, kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.racks import Rack


@dataclass(frozen=True)
class Teeth(Turned):
    """How a rack and its pinion push each other, in the carrier's axes.

    pin : about which the pinion turns.  guide : of the rack, as the carrier has it.
    lever : from the pin to the pitch point.  at : from the carrier's anchor to it.
    """

    rack: Rack
    pin: str
    guide: Guide
    lever: Any
    at: Any = 0j

    couples: ClassVar[bool] = False

    @classmethod
    def of(cls, joints: Structure, rack: Rack) -> Teeth:
        """From the joints of a rack.

        Raises
        ------
        ModelError : the rack has no guide on the carrier, or the pinion no pin.
        """
        pins = joints.pins_between(rack.pinion, rack.carrier)
        ends = (rack.rack, rack.carrier)
        sliders = [one for one in joints.sliders if (one.link, one.on) == ends]
        if len(pins) != 1 or len(sliders) != 1:
            raise ModelError(
                place_in_file(joints, rack),
                Note(
                    "{pinion!r} has {pins} pins and {rack!r} {sliders} guides on the carrier "
                    "{carrier!r}; a pinion turns about one point of the carrier, on which the rack "
                    "slides by one of [[sliders]]",
                    pinion=rack.pinion,
                    pins=len(pins),
                    rack=rack.rack,
                    sliders=len(sliders),
                    carrier=rack.carrier,
                ),
            )
        guide = Guide.seen_from(sliders[0], rack.carrier)
        lever = -1j * rack.left * rack.radius * guide.along
        return cls(rack, pins[0], guide, lever)

    @property
    def points(self) -> dict[str, str]:
        """The point of pinion and rack by which each is held on the carrier."""
        return {self.rack.pinion: self.pin, self.rack.rack: self.guide.point}

    @property
    def driver_pin(self) -> str:  # type: ignore[override]
        return self.points[self.rack.driver]

    @property
    def driven_pin(self) -> str:  # type: ignore[override]
        return self.points[self.rack.driven]

    @property
    def slant(self) -> Any:
        """Of the force on a driven rack: to the left of its way, for a push of 1."""
        return -self.rack.left * np.tan(self.rack.pressure_angle)

    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        rack, name, link = self.rack, coupling.name, coupling.driven
        if rack.drives == "rack":
            mesh = Mesh("", self.pin, self.lever, -np.tan(rack.pressure_angle))
            return mesh.steps(coupling, ground)
        carrier, sense, along = f"u({rack.carrier})", f"flank({name})", self.guide.along
        push = Reaction(name, rack.table, link, rack.pinion, f"pitch({name})", f"R({name}/{link})")
        force, moment = demand_names(link)
        at = (*p(self.pin), *u(rack.carrier))
        return push, (
            Call(kernels.point, at, (self.lever,), p(push.at)),
            Call(joint_kernels.rack_flank, (force, carrier), (along,), (sense,)),
            Call(
                joint_kernels.rack_forces,
                (force, moment, f"p({self.guide.point})", f"p({push.at})", carrier, sense),
                (along, self.slant),
                (*ground.outputs, push.force, f"T({name})"),
            ),
        )

    def group(self, builder: Builder, joints: Structure, coupling: Coupling) -> Group:
        return _racked(builder, joints, self)

    def loop(self, coupling: Coupling, end: Callable[[str, str], End]) -> RackLoop:
        rack = self.rack
        on, by = (end(body, self.points[body]) for body in (rack.driven, rack.driver))
        own = on if rack.drives == "pinion" else by
        base, placed = end(rack.carrier, self.guide.base), end(rack.carrier, self.pin)
        kernel, numbers = rack.relation
        teeth = replace(self, at=placed.arm + self.lever)
        return RackLoop(rack.name, rack.table, on, by, rack.carrier, kernel, numbers, 0.0, teeth,
                        own, base, self.guide.along)  # fmt: skip

    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """The pitch point."""
        return poses[carrier].place_of(self.at)

    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, float]]:
        way = poses[carrier].turn[0] * self.guide.along
        if self.rack.drives == "pinion":
            return [(way * (1 + 1j * self.slant * sense), 0.0)]
        return [(self.rack.left * way * (1 + 1j * np.tan(self.rack.pressure_angle) * sense), 0.0)]


def teeth_of(_: Builder, joints: Structure, rack: Rack) -> Teeth:
    """How a rack and its pinion go together."""
    return Teeth.of(joints, rack)


def _racked(builder: Builder, joints: Structure, teeth: Teeth) -> Group:
    """What a rack, or its pinion, drives."""
    rack, guide, link = teeth.rack, teeth.guide, teeth.rack.driven
    if rack.drives == "pinion":
        motion, ground = (
            _rack(builder, teeth),
            guide_reaction(guide, link, rack.carrier, guide.point),
        )
    else:
        bearer = builder.carrier_of(joints.pins[teeth.pin])
        motion, ground = _pinion(builder, teeth, bearer), pin_reaction(teeth.pin, link, bearer)
    builder.add({link: ground.at}, [ground.at])
    push, forces = teeth.steps(rack, ground)
    forces = (*forces, builder.hand_over(ground), builder.hand_over(push))
    return Group("coupled", (link,), motion, forces, (ground, push))


def _rack(builder: Builder, teeth: Teeth) -> tuple[Step, ...]:
    """Motion of a rack on a known carrier, moved by its pinion."""
    rack, guide = teeth.rack, teeth.guide
    before = (*builder.running_angle(rack.pinion), *builder.running_angle(rack.carrier))
    return (
        *before,
        *builder.reach(rack.carrier, guide.base),
        *builder.reach(rack.carrier, teeth.pin),
        _related(builder, rack, before, _turned(rack.pinion), _travelled(rack)),
        Call(
            kernels.railed,
            (*_travelled(rack), *p(guide.base), *u(rack.carrier)),
            (guide.along, guide.turn),
            (*p(guide.point), *u(rack.rack)),
        ),
    )


def _pinion(builder: Builder, teeth: Teeth, bearer: str) -> tuple[Step, ...]:
    """Motion of a pinion on a known carrier, turned by its rack."""
    rack, guide = teeth.rack, teeth.guide
    before = (
        *builder.running_angle(rack.carrier),
        *builder.reach(rack.rack, guide.point),
        *builder.reach(rack.carrier, guide.base),
        *builder.reach(bearer, teeth.pin),
        Call(
            kernels.travelled,
            (*p(guide.point), *p(guide.base), *u(rack.carrier)),
            (guide.along,),
            _travelled(rack),
        ),
    )
    wound = _related(builder, rack, before, _travelled(rack), _turned(rack.pinion))
    builder.running.add(rack.pinion)
    return (*before, wound, Rotation(rack.pinion))


def _turned(link: str) -> tuple[str, str, str]:
    return f"phi({link})", f"w({link})", f"a({link})"


def _travelled(rack: Rack) -> tuple[str, str, str]:
    return f"t({rack.name})", f"t1({rack.name})", f"t2({rack.name})"


def _related(
    builder: Builder,
    rack: Rack,
    before: tuple[Step, ...],
    driver: tuple[str, ...],
    driven: tuple[str, ...],
) -> Call:
    """What drives tells where the other is, from where it stands at crank angle 0."""
    kernel, numbers = rack.relation
    inputs = (*driver, *_turned(rack.carrier))
    state = run(before, builder.now)
    with np.errstate(all="ignore"):  # a driver that cannot come to crank angle 0 is told of later
        state = run([Call(kernel, inputs, (*numbers, 0.0), driven)], dict(state))
    offset = rack.start - at_start(state[driven[0]])
    return Call(kernel, inputs, (*numbers, offset), driven)
