"""Contacts of couplings: where and along which line one body pushes the other, of each kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism import joint_kernels, kernels
from equipoise.mechanism.builder import Builder
from equipoise.mechanism.cams import Cam
from equipoise.mechanism.couplings import Coupling
from equipoise.mechanism.gears import Gear
from equipoise.mechanism.joints import Structure, coupling_pins, place_in_file
from equipoise.mechanism.loops import Contact, End, Poses
from equipoise.mechanism.steps import Call, Reaction, Step, demand_names, p, u


def contact_of(builder: Builder, joints: Structure, coupling: Coupling) -> Contact:
    """Where the two bodies of a coupling push each other.

    Raises
    ------
    ModelError : there is no such place.
    """
    return CONTACTS[coupling.table](builder, joints, coupling)


@dataclass(frozen=True)
class Mesh:
    """Where and how a pair of gears touches, in the carrier's axes.

    driver_pin, driven_pin : points of the carrier about which they turn.
    lever : from the driven gear's pin to the pitch point.
    radial : part of the tooth force along the lever, per unit of tangential force.
    """

    driver_pin: str
    driven_pin: str
    lever: Any
    radial: Any

    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        link, name = coupling.driven, coupling.name
        pitch, tooth, sense = f"pitch({name})", f"R({name}/{link})", f"flank({name})"
        push = Reaction(name, coupling.kind, link, coupling.driver, pitch, tooth)
        return push, (
            Call(
                kernels.point, (*p(self.driven_pin), *u(coupling.carrier)), (self.lever,), p(pitch)
            ),
            Call(joint_kernels.flank, (f"M({link})",), (), (sense,)),
            Call(
                joint_kernels.gear_forces,
                (*demand_names(link), f"u({coupling.carrier})", sense),
                (self.lever, self.radial),
                (ground.force, tooth, f"T({name})"),
            ),
        )

    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """The pitch point."""
        return poses[on.body].point(on.arm)[0] + poses[carrier].turn[0] * self.lever

    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, float]]:
        """The flank in contact, told by `sense`, sets the line of action."""
        turn = poses[carrier].turn[0]
        return [(joint_kernels.tooth(turn, sense, self.lever, self.radial), 0.0)]


def mesh_of(builder: Builder, joints: Structure, gear: Gear) -> Mesh:
    """The pitch point divides the line of centres so that both gears move alike there."""
    driver_pin, driven_pin = coupling_pins(joints, gear)
    ratio = gear.speed_ratio
    centres = builder.arm(gear.carrier, driven_pin, driver_pin)
    if np.all(centres == 0):
        raise ModelError(
            place_in_file(joints, gear),
            f"both gears turn about {driven_pin}; set their centres apart",
        )
    ring_driven = 0 < ratio < 1
    radial = np.tan(gear.pressure_angle) * (1 if ring_driven else -1)
    return Mesh(driver_pin, driven_pin, centres / (1 - ratio), radial)


def no_contact(_: Builder, joints: Structure, cam: Cam) -> Contact:
    """A cam's follower is solved when cam and carrier are known, and never by Newton's method."""
    raise ModelError(
        place_in_file(joints, cam),
        Note(
            "{cam!r} and {carrier!r} have to be moved before {follower!r} is; other joints hold "
            "that, or the cam itself moves by it",
            cam=cam.driver,
            carrier=cam.carrier,
            follower=cam.driven,
        ),
    )


CONTACTS: Mapping[str, Callable[[Builder, Structure, Any], Contact]] = {
    "gears": mesh_of,
    "cams": no_contact,
}
"""What makes the contact of a coupling, by its `table`."""
