"""What links beside each other do across the plane: rocking moment, couples in joints, bearings.

A force in the plane z has the moment i z F about the axes x and y, complex as all planar vectors
are.  Everything here is linear in the demands, as the forces in the plane are.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import p, u
from equipoise.mechanism.checks import NamedItems
from equipoise.mechanism.dynamics.acting import acting_elements, acting_preloads
from equipoise.mechanism.dynamics.reactions import (
    PUSH,
    Acting,
    JointForce,
    JointReactions,
    VectorSignal,
    full,
)
from equipoise.mechanism.dynamics.statics import Statics, statics
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.pushing import pushes
from equipoise.mechanism.parts.joint_properties import JOINTS
from equipoise.mechanism.parts.planes import moments_across

Needed = Mapping[str, Any]
"""Link -> sum of planes times the forces that it needs, N m, complex (..., N)."""

OF_FRAME = ("rocking_moment", "frame_rocking_moment")
"""Outputs of `OutOfPlaneMoments` that the frame feels."""


@dataclass(frozen=True, eq=False)
class OutOfPlaneMoments:
    """Moments and forces of links beside each other, arrays (..., N).

    inertia, weights, loads, springs : what each link needs, by what makes it.
    exerted : name -> force in each joint and mesh.
    outer : those of the loads that come from outside.
    """

    motion: Motion
    inertia: Needed
    weights: Needed
    loads: Needed
    springs: Needed
    exerted: Mapping[str, JointForce]
    outer: Needed = field(default_factory=dict)

    @cached_property
    def statics(self) -> Statics:
        """How couples go from link to link."""
        return statics(self.motion.linkage)

    @cached_property
    def rocking_moment(self) -> VectorSignal:
        """Minus the rate of change of angular momentum about x and y, in the plane 0, N m."""
        return self._on_frame(self.inertia)

    @cached_property
    def frame_rocking_moment(self) -> VectorSignal:
        """Moment of all joints and springs on the frame about x and y, in the plane 0, N m."""
        return self._on_frame(self.inertia, self.weights, self.outer)

    def _on_frame(self, *needed: Needed) -> VectorSignal:
        whole: Any = sum(value for item in needed for value in item.values())
        return VectorSignal(full(self.motion, -1j * whole, complex))

    @cached_property
    def _couples(self) -> dict[str, Any]:
        """Couple of each joint, as a sum of planes times forces."""
        total: dict[str, Any] = dict.fromkeys(self.motion.machine.links, 0.0)
        for needed in (self.inertia, self.weights, self.loads, self.springs):
            for link, value in needed.items():
                total[link] = total[link] + value
        return self.statics.couples(
            total, {k: joint_force.value for k, joint_force in self.exerted.items()}
        )

    @cached_property
    def tilting_moments(self) -> Mapping[str, JointForce]:
        """Moment about x and y in each joint, N m, about its own plane."""
        result = []
        for name, couple in self._couples.items():
            on, by = self.exerted[name].on, self.exerted[name].by
            result.append((name, JointForce(full(self.motion, 1j * couple, complex), on, by)))
        return NamedItems("joint", result)

    @cached_property
    def bearings(self) -> Mapping[str, JointForce]:
        """Force of each bearing on its link, N."""
        given = self.motion.machine.bearings
        result = {}
        for name, bearing in given.items():
            both = {at: item.plane for at, item in given.items() if item.link == bearing.link}
            other = sum(both.values()) - bearing.plane
            _, pin = self.statics.pin_of(bearing.link)
            if pin.name not in self._couples:
                continue
            force = self.exerted[pin.name]
            lever = (other - pin.plane) * force.value - self._couples[pin.name]
            result[name] = replace(force, value=lever / (other - bearing.plane))
        return NamedItems("bearing", result.items())


def exerted_in(solved: JointReactions) -> dict[str, JointForce]:
    """Force in each joint, and whatever else bodies push each other with, by name."""
    motion, by_name = solved.motion, dict(solved.joints)

    def put(name: str, force: Any, on: str, by: str) -> None:
        by_name[name] = JointForce(full(motion, force, complex), on, by)

    for name, item in motion.linkage.named_reactions:
        if item.kind not in JOINTS:
            put(name, solved.state[item.force], item.on, item.by)
    for drive in motion.machine.pushers:
        (on, _, way), (by, *_) = pushes(motion, drive)
        name = PUSH.format(drive.link)
        put(name, solved.state[name] * way, on, by)
    return by_name


def needed_by_inertia(motion: Motion, link: str, own: tuple[Any, Any]) -> Any:
    """What moves a link of these moments of its masses across the plane about its anchor."""
    _, p1, p2 = (motion.state[name] for name in p(motion.linkage.anchors[link]))
    rotation, w, a = (motion.state[name] for name in u(link))
    rates = motion.speed**2, motion.acceleration
    return kernels.inertia_demand(p1, p2, rotation, w, a, *rates, *own, 0.0)[0]


def masses_across(motion: Motion) -> tuple[dict[str, Any], dict[str, Any]]:
    """What inertia and weight of every link need."""
    gravity = complex(*motion.machine.gravity)
    inertia, weights = {}, {}
    for name, link in motion.machine.links.items():
        own = moments_across(link, motion.linkage.anchors[name])
        inertia[name] = needed_by_inertia(motion, name, own)
        weights[name] = kernels.weight_demand(motion.state[f"u({name})"], *own, gravity)[0]
    return inertia, weights


def pushes_across(motion: Motion, acting: Iterable[Acting]) -> dict[str, Any]:
    """What holds forces at points of links."""
    links, values = motion.machine.links, dict[str, Any]()
    for link, point, force, _ in acting:
        values[link] = values.get(link, 0.0) - links[link].plane_of(point) * force
    return values


def springs_across(motion: Motion) -> dict[str, Any]:
    """What holds force elements, and preloads of couplings, in the plane of their driven link."""
    values = pushes_across(motion, acting_elements(motion))
    for driven, ends in acting_preloads(motion):
        plane = motion.machine.links[driven].plane
        for link, _, force, _ in ends:
            values[link] = values.get(link, 0.0) - plane * force
    return values


def apart(
    whole: OutOfPlaneMoments, exerted: Mapping[str, JointForce], shape: tuple[int, ...]
) -> OutOfPlaneMoments:
    """What links do across the plane, by cause and link: arrays of a shape (C, L, N)."""

    def by(cause: int, needed: Needed) -> Needed:
        result = {}
        for k, link in enumerate(whole.motion.machine.links):
            result[link] = np.zeros(shape, complex)
            result[link][cause, k] = needed.get(link, 0.0)
        return result

    parts = (whole.inertia, whole.weights, whole.loads, whole.springs, whole.outer)
    inertia, weights, loads, springs, outer = map(by, (0, 2, 3, 4, 3), parts)
    return OutOfPlaneMoments(whole.motion, inertia, weights, loads, springs, exerted, outer)
