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

MEANINGS = {
    "acceleration of the common centre of mass": to_say(
        "Acceleration of the centre of mass of all moving links together; the shaking force is "
        "the total mass times its negative."
    ),
    "acceleration of {name}": to_say("Acceleration of a point in the frame."),
    "angle in circular slot {name}": to_say("Angle of the pin about the centre of the slot."),
    "angle of torsion spring {name}": to_say(
        "Angle between the two bodies that a torsion spring joins."
    ),
    "angle of {name}": to_say(
        "Angle of the axes of a link from those of the frame, anticlockwise."
    ),
    "angular acceleration of {name}": to_say("Rate of change of the angular velocity of a link."),
    "angular velocity of {name}": to_say("Rate of change of the angle of a link."),
    "contact force along the normal {name}": to_say(
        "Component of the force between cam and follower along their common normal."
    ),
    "contact force times sliding speed in joint {name}": to_say(
        "Contact force times sliding speed; wear grows with its integral over time."
    ),
    "contact force {name}": to_say("Force between cam and follower."),
    "curvature of the cam {name}": to_say(
        "Curvature of the surface of a cam at the contact, the inverse of its radius."
    ),
    "distance along curved slot {name}": to_say(
        "Distance of the pin along the centre line of a slot from its first point."
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
    "effective pull {name}": to_say(
        "Difference of the tensions of both strands of a belt, which transmits the torque."
    ),
    "energy of torsion spring {name}": to_say("Energy stored in a torsion spring."),
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
    "deflection along bushing {name}": to_say(
        "How far a point is from that of its bushing along the direction of this."
    ),
    "deflection across bushing {name}": to_say(
        "How far a point is from that of its bushing across the direction of this."
    ),
    "force along bushing {name}": to_say("Force of a bushing on its link along its direction."),
    "force across bushing {name}": to_say("Force of a bushing on its link across its direction."),
    "torque of bushing {name}": to_say("Torque of a bushing on its link about its pin."),
    "loss of bushing {name}": to_say("Power that a bushing turns into heat."),
    "force of stop {name}": to_say("Force with which a stop pushes a point back."),
    "gap of stop {name}": to_say(
        "Distance of a point from the line of its stop; below 0 it presses the stop in."
    ),
    "loss of stop {name}": to_say("Power that a stop turns into heat while it is pressed."),
    "force of resistance {name}": to_say("Force with which a resistance holds a point back."),
    "speed of resistance {name}": to_say(
        "Speed of a point that a resistance holds back, along its direction where it has one."
    ),
    "loss of resistance {name}": to_say("Power that a resistance takes from the machine."),
    "loss of damper {name}": to_say("Power that a damper turns into heat."),
    "loss of torsion damper {name}": to_say("Power that a torsion damper turns into heat."),
    "pull of damper {name}": to_say(
        "Force with which a damper pulls its two ends together; below 0 it holds them apart."
    ),
    "speed of damper {name}": to_say("Speed with which the ends of a damper move apart."),
    "speed of torsion damper {name}": to_say(
        "Angular speed of a link relative to the body that a torsion damper ties it to."
    ),
    "torque of torsion damper {name}": to_say(
        "Torque with which a torsion damper holds a link back."
    ),
    "length of spring {name}": to_say("Distance between the ends of a spring."),
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
    "pressure angle {name}": to_say(
        "Angle between the normal of the contact and the motion of the follower."
    ),
    "pressure in joint {name}": to_say(
        "Force in a plain bearing over its projected area, diameter times width."
    ),
    "pressure times sliding speed in joint {name}": to_say(
        "Pressure times sliding speed of a plain bearing, which limits its heating."
    ),
    "pull of spring {name}": to_say("Force with which a spring pulls its ends together."),
    "radial tooth force {name}": to_say(
        "Component of the force between teeth towards the axes, which pushes the gears apart."
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
    "sliding speed in circular slot {name}": to_say("Speed of the pin along the slot."),
    "sliding speed in curved slot {name}": to_say(
        "Speed of the pin along the centre line of the slot."
    ),
    "sliding velocity of {name}": to_say("Velocity of a slider along its guide."),
    "tangential tooth force {name}": to_say(
        "Component of the force between teeth along the pitch circles, which transmits the torque."
    ),
    "tension of the left strand {name}": to_say(
        "Tension of the strand of a belt on the left, seen from the driving "
        "towards the driven pulley."
    ),
    "tension of the right strand {name}": to_say(
        "Tension of the strand of a belt on the right, seen from the driving "
        "towards the driven pulley."
    ),
    "tilting moment in joint {name}": to_say(
        "Moment in a joint of links in different planes, which tilts its pin."
    ),
    "tooth force {name}": to_say(
        "Force between the teeth of two gears at the pitch point, along the line of action."
    ),
    "torque of torsion spring {name}": to_say(
        "Torque with which a torsion spring turns its bodies towards its free angle."
    ),
    "transmission angle at {name}": _TRANSMISSION,
    "travel of {name}": to_say(
        "Distance of a slider along its guide from the reference point of the guide."
    ),
    "velocity of {name}": to_say("Velocity of a point in the frame."),
    "weight": to_say("Force of gravity on all moving links."),
    "yaw moment": to_say("Moment of all rows together about the vertical."),
}
"""Outputs by their labels, each with what it means."""
