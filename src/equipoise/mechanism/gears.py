"""Gears: where a pair touches, and a link that is geared to known bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism import kernels
from equipoise.mechanism.builder import Builder, Group, Reaction, demand_names, pin_reaction
from equipoise.mechanism.joints import Structure, gear_pins
from equipoise.mechanism.model import Gear
from equipoise.mechanism.steps import Call, Rotation, p, run, u


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
