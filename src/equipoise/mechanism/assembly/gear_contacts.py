"""Contacts of gears: where and along which line one pushes the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism.assembly.builder import Builder
from equipoise.mechanism.assembly.joints import Structure, coupling_pins, place_in_file
from equipoise.mechanism.assembly.loops import End, Poses
from equipoise.mechanism.assembly.steps import Call, Reaction, Step, flanked, p, u
from equipoise.mechanism.assembly.turned import Turned
from equipoise.mechanism.formulas import joint_kernels, kernels
from equipoise.mechanism.parts.couplings import Coupling, Law
from equipoise.mechanism.parts.gears import Gear


@dataclass(frozen=True)
class Mesh(Turned):
    """Where and how a pair of gears touches, in the carrier's axes.

    driver_pin, driven_pin : points of the carrier about which they turn.
    lever : from the driven gear's pin to the pitch point.
    radial : part of the tooth force along the lever, per unit of tangential force.
    """

    driver_pin: str
    driven_pin: str
    lever: Any
    radial: Any

    couples: ClassVar[bool] = False

    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        push, carrier = _push_of(coupling), coupling.carrier
        numbers = (self.lever, self.radial)
        return push, (
            Call(kernels.point, (*p(self.driven_pin), *u(carrier)), (self.lever,), p(push.at)),
            *flanked(push, ground, carrier, joint_kernels.gear_forces, numbers),
        )

    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """The pitch point."""
        return poses[on.body].place_of(on.arm) + poses[carrier].turn[0] * self.lever

    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, float]]:
        """The flank in contact, told by `sense`, sets the line of action."""
        turn = poses[carrier].turn[0]
        return [(joint_kernels.tooth(turn, sense, self.lever, self.radial), 0.0)]


@dataclass(frozen=True)
class RollingMesh(Turned):
    """Where and how a pair of gears touches whose ratio varies, in the carrier's axes.

    driver, law : whose angle, seen from the carrier, tells the ratio, and how.
    centres : from the driven gear's pin to the driver's.  radial : as of `Mesh`, where the pitch
    curves lie square to the line of centres.
    """

    driver_pin: str
    driven_pin: str
    driver: str
    law: Law
    centres: Any
    radial: Any

    couples: ClassVar[bool] = False

    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        push, name, carrier = _push_of(coupling), coupling.name, coupling.carrier
        place = lever, _ = f"lever({name})", f"slope({name})"
        angles = (f"phi({self.driver})", f"phi({carrier})")
        at = (f"p({self.driven_pin})", f"u({carrier})", lever)
        return push, (
            Call(rolled, angles, (self.law, self.centres), place),
            Call(joint_kernels.pitch_place, at, (), (f"p({push.at})",)),
            *flanked(push, ground, carrier, joint_kernels.rolling_forces, (self.radial,), place),
        )

    def rolled(self, poses: Poses, carrier: str) -> tuple[Any, Any]:
        return rolled(poses[self.driver].angle, poses[carrier].angle, self.law, self.centres)

    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """The pitch point."""
        lever, _ = self.rolled(poses, carrier)
        return poses[on.body].place_of(on.arm) + poses[carrier].turn[0] * lever

    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, float]]:
        """The pitch curves and the flank in contact, told by `sense`, set the line of action."""
        lever, slope = self.rolled(poses, carrier)
        turn, slant = poses[carrier].turn[0], joint_kernels.slant(sense, self.radial, slope)
        return [(joint_kernels.tooth(turn, 1.0, lever, slant), 0.0)]


def rolled(angle_r: Any, angle_c: Any, law: Law, centres: Any) -> tuple[Any, Any]:
    """Lever of the pitch point and slope of the pitch curves there; see `kernels.pitch_slope`."""
    _, ratio, bend = law(angle_r - angle_c)
    return centres / (1 - ratio), kernels.pitch_slope(ratio, bend)


def mesh_of(builder: Builder, joints: Structure, gear: Gear) -> Turned:
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
    if gear.law is not None:
        return RollingMesh(driver_pin, driven_pin, gear.driver, gear.law, centres, radial)
    return Mesh(driver_pin, driven_pin, centres / (1 - ratio), radial)


def _push_of(coupling: Coupling) -> Reaction:
    """The force between teeth, at their pitch point."""
    name, link = coupling.name, coupling.driven
    force = f"R({name}/{link})"
    return Reaction(name, coupling.table, link, coupling.driver, f"pitch({name})", force)
