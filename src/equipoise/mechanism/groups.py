"""Groups of links that are solved in closed form: dyads, and links that are geared.

A dyad is two links with three joints, R (pin) or P (sliding); the outer joints join it to known
bodies.  There is one
builder for each sequence of joints; it turns links and joints into kernel calls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism import kernels
from equipoise.mechanism.joints import Structure, gear_pins
from equipoise.mechanism.model import Gear, Slider
from equipoise.mechanism.steps import (
    Builder,
    Call,
    Group,
    Guide,
    Outer,
    Reaction,
    Rotation,
    demand_names,
    guide_reaction,
    p,
    pin_reaction,
    run,
    u,
)

AHEAD = ("forward", "backward")
NEAR = 1e-3
"""Distance, over the size of the machine, at which a block counts as near its guide's pivot."""


def rrr(builder: Builder, first: Outer, second: Outer, pin: str) -> Group:
    """Two links and three pins."""
    link, other = first.link, second.link
    meaning = f"{pin} lies left or right of the line from {first.point} to {second.point}"
    side = builder.side(pin, ("left", "right"), meaning)
    arms = (builder.arm(link, first.point, pin), builder.arm(other, second.point, pin))
    margin = f"s({pin})"
    motion = (
        *builder.reach(first.body, first.point),
        *builder.reach(second.body, second.point),
        Call(
            kernels.rrr,
            (*p(first.point), *p(second.point)),
            (*arms, side),
            (*u(link), *u(other), *p(pin), margin),
        ),
    )
    builder.add({link: first.point, other: second.point}, [pin])
    ground = pin_reaction(first.point, link, first.body)
    far = pin_reaction(second.point, other, second.body)
    inner = pin_reaction(pin, other, link)
    places = (f"p({first.point})", f"p({second.point})", f"p({pin})")
    in_line = f"{link!r} and {other!r} lie in line"
    forces = (
        Call(
            kernels.rrr_forces,
            (*places, *demand_names(link), *demand_names(other)),
            (),
            (ground.force, far.force, inner.force),
        ),
        builder.hand_over(first.body, first.point, ground.force),
        builder.hand_over(second.body, second.point, far.force),
    )
    return Group("dyad", (link, other), motion, forces, (ground, far, inner), margin, pin, in_line)


def rrp(builder: Builder, pinned: Outer, sliding: Outer, pin: str) -> Group:
    """A pinned link and a link on a known guide, joined by a pin."""
    link, other, guide = pinned.link, sliding.link, _guide(sliding)
    meaning = f"{pin} lies ahead of or behind {pinned.point}, seen along the guide's direction"
    side = builder.side(pin, AHEAD, meaning)
    arm = builder.arm(link, pinned.point, pin)
    shift = guide.turn * builder.arm(other, guide.point, pin)
    margin = f"s({pin})"
    motion = (
        *builder.reach(pinned.body, pinned.point),
        *builder.reach(sliding.body, guide.base),
        Call(
            kernels.rrp,
            (*p(pinned.point), *p(guide.base), *u(sliding.body)),
            (arm, guide.along, shift, guide.turn, side),
            (*u(link), *u(other), *p(pin), margin),
        ),
    )
    builder.add({link: pinned.point, other: pin}, [pin])
    ground = pin_reaction(pinned.point, link, pinned.body)
    rail = guide_reaction(guide, other, sliding.body, pin)
    inner = pin_reaction(pin, other, link)
    assert rail.couple is not None
    places = (f"p({pinned.point})", f"p({pin})", f"u({sliding.body})")
    square = f"{link!r} stands square to the line of {guide.name!r}"
    forces = (
        Call(
            kernels.rrp_forces,
            (*places, *demand_names(link), *demand_names(other)),
            (guide.along,),
            (ground.force, rail.force, rail.couple, inner.force),
        ),
        builder.hand_over(pinned.body, pinned.point, ground.force),
        builder.hand_over(sliding.body, pin, rail.force, rail.couple),
    )
    return Group("dyad", (link, other), motion, forces, (ground, rail, inner), margin, pin, square)


def rpr(builder: Builder, block: Outer, other: Outer, slider: Slider) -> Group:
    """Two pinned links, of which the first slides on the second."""
    link, on = block.link, other.link
    inner_guide = Guide.seen_from(slider, on)
    meaning = f"{block.point} lies ahead of or behind {other.point}, along the guide's direction"
    side = builder.side(slider.point, AHEAD, meaning)
    from_pivot = builder.arm(on, other.point, inner_guide.base) / inner_guide.along
    from_point = builder.arm(link, inner_guide.point, block.point) * inner_guide.turn
    offset = (from_pivot + from_point).imag
    margin = f"s({slider.name})"
    back = inner_guide.along.conjugate()
    motion = (
        *builder.reach(block.body, block.point),
        *builder.reach(other.body, other.point),
        Call(
            kernels.rpr,
            (*p(block.point), *p(other.point)),
            (offset, inner_guide.turn, back, (NEAR * builder.size()) ** 2, side),
            (*u(link), *u(on), margin),
        ),
    )
    builder.add({link: block.point, on: other.point})
    ground = pin_reaction(block.point, link, block.body)
    far = pin_reaction(other.point, on, other.body)
    inner = guide_reaction(inner_guide, link, on, block.point)
    assert inner.couple is not None
    places = (f"p({block.point})", f"p({other.point})", f"u({link})")
    stuck = f"{block.point} comes to {other.point}, or square to it across {slider.name!r}"
    forces = (
        Call(
            kernels.rpr_forces,
            (*places, *demand_names(link), *demand_names(on)),
            (inner_guide.turn.conjugate(),),
            (ground.force, far.force, inner.force, inner.couple),
        ),
        builder.hand_over(block.body, block.point, ground.force),
        builder.hand_over(other.body, other.point, far.force),
    )
    return Group(
        "dyad", (link, on), motion, forces, (ground, far, inner), margin, slider.point, stuck
    )


def prp(builder: Builder, first: Outer, second: Outer, pin: str) -> Group:
    """Two links on known guides, joined by a pin; there is only one way to assemble them."""
    link, other = first.link, second.link
    guides = (_guide(first), _guide(second))
    shapes: list[complex] = []
    for outer, guide in zip((first, second), guides, strict=True):
        shift = guide.turn * builder.arm(outer.link, guide.point, pin)
        shapes += (guide.along, shift, guide.turn)
    margin = f"s({pin})"
    bases = tuple(
        (*p(guide.base), *u(outer.body))
        for outer, guide in zip((first, second), guides, strict=True)
    )
    motion = (
        *builder.reach(first.body, guides[0].base),
        *builder.reach(second.body, guides[1].base),
        Call(
            kernels.prp,
            (*bases[0], *bases[1]),
            tuple(shapes),
            (*u(link), *u(other), *p(pin), margin),
        ),
    )
    builder.add({link: pin, other: pin}, [pin])
    near = guide_reaction(guides[0], link, first.body, pin)
    far = guide_reaction(guides[1], other, second.body, pin)
    inner = pin_reaction(pin, other, link)
    assert near.couple is not None and far.couple is not None
    turns = (f"u({first.body})", f"u({second.body})")
    parallel = f"the lines of {guides[0].name!r} and {guides[1].name!r} are parallel"
    forces = (
        Call(
            kernels.prp_forces,
            (*turns, *demand_names(link), *demand_names(other)),
            (guides[0].along, guides[1].along),
            (near.force, near.couple, far.force, far.couple, inner.force),
        ),
        builder.hand_over(first.body, pin, near.force, near.couple),
        builder.hand_over(second.body, pin, far.force, far.couple),
    )
    return Group("dyad", (link, other), motion, forces, (near, far, inner), margin, pin, parallel)


def rpp(builder: Builder, pinned: Outer, sliding: Outer, slider: Slider) -> Group:
    """A pinned link that slides on (or carries) a link on a known guide: a yoke."""
    link, other, guide = pinned.link, sliding.link, _guide(sliding)
    inner_guide = Guide.seen_from(slider, other)
    line = guide.turn * inner_guide.along
    if np.all(abs(line.imag) < 1e-9):
        raise ModelError(
            f"sliders[{builder.machine.sliders.index(slider) + 1}]",
            f"its line is parallel to that of {guide.name!r}, which leaves {other!r} free to "
            "slide; turn one of them",
        )
    turn = line * inner_guide.turn
    shift = turn * builder.arm(link, pinned.point, inner_guide.point) - guide.turn * builder.arm(
        other, guide.point, inner_guide.base
    )
    margin = f"s({slider.name})"
    motion = (
        *builder.reach(pinned.body, pinned.point),
        *builder.reach(sliding.body, guide.base),
        Call(
            kernels.rpp,
            (*p(pinned.point), *p(guide.base), *u(sliding.body)),
            (guide.along, guide.turn, line, turn, shift),
            (*u(link), *u(other), *p(guide.point), margin),
        ),
    )
    builder.add({link: pinned.point, other: guide.point}, [guide.point])
    ground = pin_reaction(pinned.point, link, pinned.body)
    rail = guide_reaction(guide, other, sliding.body, guide.point)
    inner = guide_reaction(inner_guide, link, other, pinned.point)
    assert rail.couple is not None and inner.couple is not None
    places = (f"p({pinned.point})", f"p({guide.point})", f"u({sliding.body})")
    forces = (
        Call(
            kernels.rpp_forces,
            (*places, *demand_names(link), *demand_names(other)),
            (guide.along, line),
            (ground.force, rail.force, rail.couple, inner.force, inner.couple),
        ),
        builder.hand_over(pinned.body, pinned.point, ground.force),
        builder.hand_over(sliding.body, guide.point, rail.force, rail.couple),
    )
    return Group("dyad", (link, other), motion, forces, (ground, rail, inner), margin, slider.point)


def _guide(outer: Outer) -> Guide:
    assert outer.guide is not None
    return outer.guide


@dataclass(frozen=True)
class Mesh:
    """Where and how a pair of gears touches, in the carrier's axes.

    lever : from the driven gear's pin to the pitch point.
    radial : part of the tooth force along the lever, per unit of tangential force.
    """

    driver_pin: str
    driven_pin: str
    lever: complex
    radial: float

    @classmethod
    def of(cls, builder: Builder, joints: Structure, gear: Gear) -> Mesh:
        """The pitch point divides the line of centres so that both gears move alike there."""
        driver_pin, driven_pin = gear_pins(joints, gear)
        ratio = gear.speed_ratio
        centres = builder.arm(gear.carrier, driven_pin, driver_pin)
        if np.all(centres == 0):
            raise ModelError(
                f"gears[{builder.machine.gears.index(gear) + 1}]",
                f"both gears turn about {driven_pin}; set their centres apart",
            )
        ring_driven = 0 < ratio < 1
        radial = np.tan(gear.pressure_angle) * (1 if ring_driven else -1)
        return cls(driver_pin, driven_pin, centres / (1 - ratio), radial)


def geared(builder: Builder, joints: Structure, gear: Gear) -> Group:
    """A link that is pinned to a known carrier and geared to a known driver."""
    mesh = Mesh.of(builder, joints, gear)
    bearer = builder.carrier_of(joints.pins[mesh.driven_pin])
    link, carrier, pin = gear.driven, gear.carrier, mesh.driven_pin
    before = (*builder.running_angle(gear.driver), *builder.running_angle(carrier))
    now = run(before, builder.now)
    ratio = gear.speed_ratio
    angles = tuple(
        (f"phi({body})", f"w({body})", f"a({body})") for body in (gear.driver, carrier, link)
    )
    bare = Call(kernels.gear, (*angles[0], *angles[1]), (ratio, 0.0), angles[2])
    with np.errstate(all="ignore"):  # a driver that cannot come to crank angle 0 is told of later
        at_start = run([bare], dict(now))[f"phi({link})"]
    offset = gear.start - (at_start if at_start.ndim > 1 else float(at_start[0]))
    motion = (
        *before,
        *builder.reach(bearer, pin),
        Call(kernels.gear, (*angles[0], *angles[1]), (ratio, offset), angles[2]),
        Rotation(link),
    )
    builder.add({link: pin}, [pin])
    builder.running.add(link)
    pitch, tooth, sense = f"pitch({gear.name})", f"R({gear.name}/{link})", f"flank({gear.name})"
    ground = pin_reaction(pin, link, bearer)
    forces = (
        Call(kernels.point, (*p(pin), *u(carrier)), (mesh.lever,), p(pitch)),
        Call(kernels.flank, (f"M({link})",), (), (sense,)),
        Call(
            kernels.gear_forces,
            (*demand_names(link), f"u({carrier})", sense),
            (mesh.lever, mesh.radial),
            (ground.force, tooth, f"T({gear.name})"),
        ),
        builder.hand_over(bearer, pin, ground.force),
        builder.hand_over(gear.driver, pitch, tooth),
    )
    reaction = Reaction(gear.name, "gear", link, gear.driver, pitch, tooth)
    return Group("geared", (link,), motion, forces, (ground, reaction))
