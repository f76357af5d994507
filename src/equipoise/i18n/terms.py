"""The glossary: what terms mean that reports, pictures, the live page and commands use.

The terms themselves are declared where they are used, such as the labels of outputs; here is what
each means, in one sentence. The catalogues have terms and meanings in the other languages.
"""

from __future__ import annotations

from equipoise.i18n import to_say

_EXPOSURE = to_say("A(8): the weighted vibration of a day's work, as if it lasted eight hours.")

_TRANSMISSION = to_say(
    "Angle between the two links that meet in a joint; near 0° or 180° forces grow and the linkage "
    "may jam."
)

TERMS = {
    to_say("A(8)"): _EXPOSURE,
    to_say("assembly mode"): to_say(
        "One of the ways in which the same links can be joined; a dyad can lie on either side "
        "of the line between its outer joints."
    ),
    to_say("change point"): to_say(
        "Position in which the links lie in one line and the assembly mode after it is "
        "undetermined."
    ),
    to_say("counterweight"): to_say(
        "Mass added to a link so that the shaking force, the shaking moment or the drive torque "
        "becomes smaller."
    ),
    to_say("coupler"): to_say("Link that joins two moving links and has no joint with the frame."),
    to_say("crank"): to_say(
        "Link that turns fully about a joint with the frame; usually the driven one."
    ),
    to_say("daily vibration exposure"): _EXPOSURE,
    to_say("dyad"): to_say(
        "Two links and three joints without a degree of freedom of their own; linkages are "
        "solved dyad by dyad."
    ),
    to_say("fluctuation"): to_say(
        "Largest less smallest speed of the crank in a cycle, over the mean speed; also called "
        "coefficient of fluctuation."
    ),
    to_say("frame"): to_say(
        "Body that does not move as a link, in whose axes positions are given."
    ),
    to_say("friction"): to_say(
        "Resistance of a joint to sliding or turning: the coefficient of friction times the "
        "normal force; a machine at rest has to overcome the static one."
    ),
    to_say("gauge"): to_say("Point of the support at which vibration is read."),
    to_say("mobility"): to_say(
        "Number of independent motions of a linkage; 1 for a machine with one drive."
    ),
    to_say("mode shape"): to_say(
        "Shape in which a support vibrates freely at one of its natural frequencies."
    ),
    to_say("mount"): to_say("Spring and damper between support and ground."),
    to_say("natural frequency"): to_say("Frequency at which a support vibrates freely."),
    to_say("objective"): to_say("Measure of an output that balancing makes small."),
    to_say("order"): to_say(
        "Number of times that a part of a signal repeats in a turn of the crank."
    ),
    to_say("resonance"): to_say(
        "Speed at which an order of the excitation meets a natural frequency, so that vibration "
        "is large."
    ),
    to_say("rocker"): to_say("Link that swings to and fro about a joint with the frame."),
    to_say("root mean square"): to_say("RMS: the root of the mean of the square over a cycle."),
    to_say("support"): to_say("Body on mounts that carries the machine and vibrates with it."),
    to_say("throw"): to_say(
        "Distance of the pin of a crank from its pivot; a force times the throw is the torque that "
        "this force needs at most."
    ),
    to_say("transmission angle"): _TRANSMISSION,
}
"""Terms of mechanisms, vibration and balancing."""

MEANINGS: dict[str, str] = {
    "acceleration of the common centre of mass": to_say(
        "Acceleration of the centre of mass of all moving links together; the shaking force is "
        "the total mass times its negative."
    ),
    "acceleration of {name}": to_say("Acceleration of a point in the frame."),
    "angle of {name}": to_say(
        "Angle of the axes of a link from those of the frame, anticlockwise."
    ),
    "angular acceleration of {name}": to_say("Rate of change of the angular velocity of a link."),
    "angular velocity of {name}": to_say("Rate of change of the angle of a link."),
    "contact force times sliding speed in joint {name}": to_say(
        "Contact force times sliding speed; wear grows with its integral over time."
    ),
    "drive force": to_say(
        "Force that a cylinder or linear motor needs to move the machine as prescribed."
    ),
    "drive force of {name}": to_say("Force that one of several drives needs."),
    "drive power of {name}": to_say("Power that one of several drives puts into the machine."),
    "drive torque": to_say(
        "Torque that the drive needs to turn its link as prescribed; negative where the machine "
        "drives the motor."
    ),
    "drive torque of {name}": to_say("Torque that one of several drives needs."),
    "force in joint {name}": to_say("Force that one link puts on another in a joint."),
    "force of bearing {name}": to_say(
        "Force of a bearing of a shaft that is held in several planes."
    ),
    "force on the frame": to_say(
        "Shaking force and weight together: what the machine puts on its foundation."
    ),
    "friction force in joint {name}": to_say(
        "Force of friction in a sliding joint, along its guide."
    ),
    "friction loss in all joints": to_say("Power that friction in all joints turns into heat."),
    "friction loss at {name}": to_say(
        "Power that friction between teeth, at a cam, or in a belt or chain turns into heat."
    ),
    "friction loss in joint {name}": to_say("Power that friction in a joint turns into heat."),
    "friction torque in joint {name}": to_say("Torque of friction in a pin joint."),
    "instant centre of {name}": to_say(
        "Point at which two bodies have the same velocity at the moment."
    ),
    "largest axial force along {name}": to_say(
        "Largest tension or compression along a link, by size."
    ),
    "largest bending moment along {name}": to_say("Largest bending moment along a link, by size."),
    "largest stress along {name}": to_say(
        "Largest normal stress along a link, of bending and axial force."
    ),
    "mechanical advantage of {name}": to_say(
        "Torque or force on a link that a unit of crank torque balances, without losses."
    ),
    "moment in joint {name}": to_say("Moment that a guide puts on a slider against turning."),
    "moment of the weight": to_say(
        "Moment of the weight of all links about the point of reference."
    ),
    "moment on the frame": to_say("Shaking moment and moment of the weight together."),
    "normal force in joint {name}": to_say(
        "Component of the force in a sliding joint across its guide."
    ),
    "position of {name}": to_say("Coordinates of a point in the frame."),
    "pressure in joint {name}": to_say(
        "Force in a plain bearing over its projected area, diameter times width."
    ),
    "pressure times sliding speed in joint {name}": to_say(
        "Pressure times sliding speed of a plain bearing, which limits its heating."
    ),
    "reading at {name}": to_say(
        "What a gauge on the support reads: displacement, velocity or acceleration."
    ),
    "rocking moment": to_say(
        "Moment of the shaking forces of links that move in different planes; it rocks the "
        "machine out of these planes."
    ),
    "rocking moment on the frame": to_say("Rocking moment of shaking forces and weight together."),
    "roll moment": to_say("Moment of all rows together about the direction of travel."),
    "shaking force": to_say("Force of inertia that the moving links put on the frame."),
    "shaking moment": to_say(
        "Moment of the inertia forces of the moving links on the frame, about the pivot of the "
        "drive if no other point is given."
    ),
    "sliding acceleration of {name}": to_say("Rate of change of the sliding velocity."),
    "sliding velocity of {name}": to_say("Velocity of a slider along its guide."),
    "tilting moment in joint {name}": to_say(
        "Moment in a joint of links in different planes, which tilts its pin."
    ),
    "transmission angle at {name}": _TRANSMISSION,
    "travel of {name}": to_say(
        "Distance of a slider along its guide from the reference point of the guide."
    ),
    "velocity of {name}": to_say("Velocity of a point in the frame."),
    "weight": to_say("Force of gravity on all moving links."),
    "yaw moment": to_say("Moment of all rows together about the vertical."),
}
"""Outputs by their labels, each with what it means; kinds of parts add theirs by `with_meaning`."""


def with_meaning(label: str, meaning: str) -> str:
    """The label of an output of a kind of parts, whose meaning the glossary has from here on."""
    MEANINGS[label] = meaning
    return label
