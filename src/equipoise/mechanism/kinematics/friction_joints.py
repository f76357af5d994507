"""Joints that resist their motion, and how fast they turn or slide."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.joints import given_properties
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Reaction, planar, size_of_links
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.joint_kinds import JointKind
from equipoise.mechanism.parts.joint_properties import JOINTS, JointProperties
from equipoise.mechanism.parts.machine import FRAME, Slider
from equipoise.signals import Array

STILL = 1e-10
"""rad or lengths of the largest link, by rad of the crank: a joint that moves less is at rest, as
rounding would decide the sense."""


@dataclass(frozen=True)
class RubbingJoint:
    """A joint that resists its motion.

    name : in outputs.  reaction : its force.  given : what the file says of it.
    slider : the sliding joint that it is; None of a pin.  slot : that of a pin in one.
    still : rad or m by rad of the crank, below which it is at rest.
    mesh : the coupling that loses in passing its force on, or on whose surface a follower slides;
        None of a joint.  A driven rack has its guide as `slider`.
    pitch_radius : of the driven body of it, m; 1 of a driven rack, of a follower, and of gears of
        varying ratio, whose effort is a force along their pitch curves.
    centres : distance of the pins of gears of varying ratio, m; 0 of all else.
    """

    name: str
    reaction: Reaction
    given: JointProperties
    slider: Slider | None
    still: float
    mesh: Coupling | None = None
    pitch_radius: float = 0.0
    slot: JointKind | None = None
    centres: float = 0.0

    @property
    def on(self) -> str:
        """The body whose motion against `by` counts, and on which friction is given."""
        if self.mesh is not None:
            return self.mesh.driven
        guide = self.slider or self.slot
        return self.reaction.on if guide is None else guide.link

    @property
    def by(self) -> str:
        """The other body: of gears and belts their carrier, of a follower what pushes it."""
        if self.mesh is not None:
            return self.mesh.driver if self.on_surface else self.mesh.carrier
        guide = self.slider or self.slot
        return self.reaction.by if guide is None else guide.on

    @property
    def on_surface(self) -> bool:
        """Whether it is a follower that slides on the surface that pushes it."""
        return self.mesh is not None and self.mesh.contact == "surface"

    @property
    def slides(self) -> bool:
        """Whether its bodies slide on each other, along a guide, a slot or a surface, and do
        not turn.
        """
        return self.slider is not None or self.slot is not None or self.on_surface

    @property
    def reach(self) -> float:
        """From its turning to its sliding: the radius of a pin, or of the driven gear's pitch
        circle, m; 1 of what slides.
        """
        if self.mesh is not None:
            return self.pitch_radius
        return 1.0 if self.slides else self.given.radius or 0.0

    def lever(self, motion: Motion) -> Array:
        """Torque (N,) of a unit of what makes its bodies turn against each other: 1 where its
        effort is a torque, the driven pitch radius, m, of gears of varying ratio.
        """
        if not self.centres:
            return np.ones(())
        assert self.mesh is not None and self.mesh.rolling_law is not None
        ends = (self.mesh.driver, self.mesh.carrier)
        driver, carrier = (0.0 if end == FRAME else motion.links[end].angle for end in ends)
        _, ratio, _ = self.mesh.rolling_law(driver - carrier)
        return np.asarray(np.abs(self.centres / (1 - ratio)))

    @property
    def coefficient(self) -> float:
        """Of friction while it moves; of gears and belts the share of their force that is lost."""
        return self.given.mesh_loss or self.given.friction or 0.0

    @property
    def unloaded(self) -> tuple[float, float]:
        """What resists whatever presses in it: damping, and a drag that is always against the
        motion; N s/m and N where it slides, else N m s/rad and N m.
        """
        given = self.given
        if self.slides:
            return given.damping, given.drag_force
        return given.torsional_damping, given.drag_torque

    @property
    def jumps(self) -> bool:
        """Whether its friction changes suddenly where it turns back."""
        given = self.given
        return bool(self.coefficient or given.static_friction or given.drag_force
                    or given.drag_torque)  # fmt: skip

    def way(self, motion: Motion) -> Array:
        """How fast it turns (rad) or slides (m) by rad of the crank, (N,) or the same everywhere;
        with the rounding of what rests.
        """
        if self.slot is not None:
            return self._rate_along(self.slot, motion)
        if self.on_surface:
            return self._rate_on_surface(motion)
        if self.slider is not None:
            return motion.slider(self.slider).travel_1
        rate = motion.state[f"w({self.on})"] - motion.state[f"w({self.by})"]
        return np.asarray(rate * self.lever(motion) if self.centres else rate)

    def place(self, motion: Motion) -> Array:
        """Where what slides rubs (N,), m, complex: of a rack where it meets its pinion, of a
        follower where it touches what pushes it.
        """
        if self.on_surface:
            contact = motion.state[f"p(contact({self.name}))"]
            return np.asarray(np.broadcast_to(contact, motion.crank_angle.shape))
        if self.mesh is not None:
            ends = self.mesh.driver, self.mesh.driven
            turning = next(body for body in ends if body != self.mesh.slides)
            pins = motion.linkage.joints.pins_between(turning, self.mesh.carrier)
            return motion.point(pins[0]).place + self.mesh.foot * self.direction(motion)
        guide = self.slider or self.slot
        assert guide is not None
        return motion.point(guide.point).place

    def direction(self, motion: Motion) -> Array:
        """Unit vector (N,) along the line of a slider, along a slot at its pin, or along a
        surface where its follower is, complex.
        """
        if self.on_surface:
            line = -1j * motion.state[f"normal({self.name})"]
        elif self.slot is not None:
            rider = motion.linkage.joints.riders[self.slot.name]
            line = motion.state[f"u({self.slot.name})"] * (-1j * rider.normal)
        else:
            assert self.slider is not None
            line = motion.state[f"u({self.slider.on})"] * np.exp(1j * self.slider.direction)
        return np.asarray(np.broadcast_to(line, motion.crank_angle.shape), complex)

    def _rate_on_surface(self, motion: Motion) -> Array:
        """How fast the follower slides along the surface that pushes it, m by rad of the crank
        (N,).
        """
        mesh, at = self.mesh, self.place(motion)
        assert mesh is not None
        rates = []
        pin = motion.linkage.joints.pins_between(mesh.driver, mesh.carrier)[0]
        for body, point in (*mesh.points, (mesh.driver, pin)):
            own = motion.point(point)
            rates.append(own.place_1 + 1j * motion.state[f"w({body})"] * (at - own.place))
        return np.asarray(dot(self.direction(motion), rates[0] - rates[1]))

    def _rate_along(self, slot: JointKind, motion: Motion) -> Array:
        """How fast a pin slides along its slot, m by rad of the crank (N,)."""
        pin, base = motion.point(slot.point), motion.point(getattr(slot, slot.base))
        turning = motion.state[f"w({slot.on})"]
        moving = pin.place_1 - base.place_1 - 1j * turning * (pin.place - base.place)
        return np.asarray(dot(self.direction(motion), moving))


def ways_of(joints: Sequence[RubbingJoint], motion: Motion) -> Array:
    """How fast joints turn (rad) or slide (m) by rad of the crank (J, N), with the rounding of what
    rests.
    """
    rates = np.empty((len(joints), len(motion.crank_angle)))
    for rate, joint in zip(rates, joints, strict=True):
        rate[:] = joint.way(motion)
    return rates


def rates_of(joints: Sequence[RubbingJoint], motion: Motion) -> Array:
    """How fast joints turn (rad) or slide (m) by rad of the crank (J, N); 0 where they rest."""
    rates = ways_of(joints, motion)
    still = np.array([joint.still for joint in joints]).reshape(-1, 1)
    return np.where(np.abs(rates) > still, rates, 0.0)


def rubbing_joints(linkage: Linkage) -> tuple[RubbingJoint, ...]:
    """Joints of a linkage that resist their motion; kept with it."""
    if not linkage.machine.rubs:
        return ()
    known: tuple[RubbingJoint, ...] | None = linkage.memory.get("rubbing")
    if known is None:
        known = tuple(_rubbing(linkage))
        linkage.memory["rubbing"] = known
    return known


def guide_of(linkage: Linkage, mesh: Coupling) -> Slider | None:
    """The sliding joint along which a driven rack slides on its carrier; None of all else."""
    return linkage.joints.guides(mesh)[0] if mesh.slides == mesh.driven else None


def _rubbing(linkage: Linkage) -> Iterator[RubbingJoint]:
    machine = linkage.machine
    names = {item.force: name for name, item in linkage.named_reactions}
    sliders = {slider.name: slider for slider in machine.sliders}
    couplings = {(coupling.list_name, coupling.name): coupling for coupling in machine.couplings}
    size = size_of_links(machine)
    for _, reaction, entry in given_properties(machine, linkage.joints, linkage.reactions):
        if not entry.rubs:
            continue
        if reaction.kind in JOINTS:
            slider = sliders[reaction.name] if reaction.kind == "slider" else None
            slot = machine.pins_in_slots.get(reaction.name) if reaction.kind == "pin" else None
            still = STILL * (1.0 if (slider or slot) is None else size)
            name = names[reaction.force]
            yield RubbingJoint(name, reaction, entry, slider, still, slot=slot)
        else:
            mesh = couplings[reaction.kind, reaction.name]
            yield _passing_on(linkage, mesh, reaction, entry, STILL * size)


def _passing_on(
    linkage: Linkage, mesh: Coupling, reaction: Reaction, entry: JointProperties, still: float
) -> RubbingJoint:
    """A coupling that loses a share of what it passes on, or on whose surface a follower slides;
    still : m by rad of the crank.
    """
    guide = guide_of(linkage, mesh)
    joint = RubbingJoint(mesh.name, reaction, entry, guide, still, mesh, pitch_radius=1.0)
    if joint.slides:
        return joint
    if mesh.rolling_law is not None:
        return replace(joint, centres=_centres(linkage, mesh))
    return replace(joint, still=STILL, pitch_radius=_pitch_radius(linkage, mesh))


def _pitch_radius(linkage: Linkage, mesh: Coupling) -> float:
    """Radius of the pitch circle of the driven gear or pulley, m."""
    return float(dict(mesh.circles(lambda: _centres(linkage, mesh)))[mesh.driven])


def _centres(linkage: Linkage, mesh: Coupling) -> float:
    """Distance of the pins of driver and driven body on the carrier, m."""
    points = linkage.machine.bodies[mesh.carrier]
    pins = [linkage.joints.pins_between(body, mesh.carrier)[0] for body in mesh.bodies[:2]]
    driver, driven = (planar(points[pin]) for pin in pins)
    return abs(driven - driver)
