"""Joints that resist their motion, and how fast they turn or slide."""

from __future__ import annotations

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.named_joints import given_properties
from equipoise.mechanism.assembly.steps import Array, Reaction, planar, size_of_links
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.joint_properties import JOINTS, JointProperties
from equipoise.mechanism.parts.machine import Slider

STILL = 1e-10
"""rad or lengths of the largest link, by rad of the crank: a joint that moves less is at rest, as
rounding would tell the sense."""


@dataclass(frozen=True)
class RubbingJoint:
    """A joint that resists its motion.

    name : in outputs.  reaction : its force.  given : what the file says of it.
    slider : the sliding joint that it is; None of a pin.
    still : rad or m by rad of the crank, below which it is at rest.
    mesh : the gears or the belt that lose in passing their force on; None of a joint.
    pitch_radius : of the driven one of these, m.
    """

    name: str
    reaction: Reaction
    given: JointProperties
    slider: Slider | None
    still: float
    mesh: Coupling | None = None
    pitch_radius: float = 0.0

    @property
    def on(self) -> str:
        """The body whose motion against `by` counts, and on which friction is given."""
        if self.mesh is not None:
            return self.mesh.driven
        return self.reaction.on if self.slider is None else self.slider.link

    @property
    def by(self) -> str:
        """The other body: of gears and belts their carrier."""
        if self.mesh is not None:
            return self.mesh.carrier
        return self.reaction.by if self.slider is None else self.slider.on

    @property
    def reach(self) -> float:
        """From its turning to its sliding: the radius of a pin, or of the driven gear's pitch
        circle, m; 1 of a slider.
        """
        if self.mesh is not None:
            return self.pitch_radius
        return 1.0 if self.slider is not None else self.given.radius or 0.0

    @property
    def coefficient(self) -> float:
        """Of friction while it moves; of gears and belts the share of their force that is lost."""
        return self.given.mesh_loss or self.given.friction or 0.0

    @property
    def jumps(self) -> bool:
        """Whether its friction changes suddenly where it turns back."""
        given = self.given
        return bool(self.coefficient or given.static_friction or given.drag_force
                    or given.drag_torque)  # fmt: skip

    def rate(self, motion: Motion) -> Array:
        """How fast it turns (rad) or slides (m) by rad of the crank (N,); 0 where it rests."""
        if self.slider is None:
            turns = [motion.state[f"w({body})"] for body in (self.on, self.by)]
            rate = np.broadcast_to(np.asarray(turns[0] - turns[1], float), motion.crank_angle.shape)
        else:
            rate = motion.slider(self.slider).travel_1
        return np.where(np.abs(rate) > self.still, rate, 0.0)


def rubbing_joints(linkage: Linkage) -> tuple[RubbingJoint, ...]:
    """Joints of a linkage that resist their motion; kept with it."""
    if not linkage.machine.rubs:
        return ()
    known: tuple[RubbingJoint, ...] | None = linkage.memory.get("rubbing")
    if known is None:
        known = tuple(_rubbing(linkage))
        linkage.memory["rubbing"] = known
    return known


def _rubbing(linkage: Linkage) -> list[RubbingJoint]:
    machine = linkage.machine
    names = {item.force: name for name, item in linkage.named_reactions}
    sliders = {slider.name: slider for slider in machine.sliders}
    couplings = {(coupling.table, coupling.name): coupling for coupling in machine.couplings}
    size, result = size_of_links(machine), []
    for _, reaction, entry in given_properties(machine, linkage.joints, linkage.reactions):
        if entry.rubs:
            slider = sliders[reaction.name] if reaction.kind == "slider" else None
            still = STILL * (1.0 if slider is None else size)
            if reaction.kind in JOINTS:
                result.append(RubbingJoint(names[reaction.force], reaction, entry, slider, still))
                continue
            mesh = couplings[reaction.kind, reaction.name]
            radius = _pitch_radius(linkage, mesh)
            result.append(RubbingJoint(mesh.name, reaction, entry, None, still, mesh, radius))
    return result


def _pitch_radius(linkage: Linkage, mesh: Coupling) -> float:
    """Radius of the pitch circle of the driven gear or pulley, m."""
    points = linkage.machine.bodies[mesh.carrier]
    pins = [linkage.joints.pins_between(body, mesh.carrier)[0] for body in mesh.bodies[:2]]
    driver, driven = (planar(points[pin]) for pin in pins)
    return float(dict(mesh.circles(lambda: abs(driven - driver)))[mesh.driven])
