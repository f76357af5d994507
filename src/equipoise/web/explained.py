"""What each chart of a page shows, and what to look for in it: said where a reader asks."""

from __future__ import annotations

from equipoise.i18n import say, to_say

CHARTS = {
    "polar": to_say(
        "The shaking force on the frame as an arrow that goes around with the crank; numbers are "
        "crank angles. A long, narrow curve shakes in one direction, which a counterweight on the "
        "crank hardly helps; a round one is what such a counterweight takes away."
    ),
    "path": to_say(
        "The path of a point, with marks at equal steps of the crank. Where marks are close the "
        "point is slow; a corner is a stop, and a straight stretch is guided motion."
    ),
    "shaking_force": to_say(
        "The force that the moving links put on the frame, by its components. Look for the height "
        "of its peaks, which the frame has to bear, and for jumps, which are heard."
    ),
    "shaking_moment": to_say(
        "The moment of the moving links on the frame. It rocks the machine even where the shaking "
        "force is balanced, and counterweights often make it larger."
    ),
    "drive_torque": to_say(
        "The torque that keeps the crank at its speed. Below zero the linkage drives the motor; "
        "the larger the swing, the more a flywheel or a larger motor is needed."
    ),
    "drive_force": to_say(
        "The force with which the drive pushes its ends apart. Below zero it holds back; its sign "
        "tells which side of a cylinder bears the pressure."
    ),
    "roll_moment": to_say(
        "The moment of all rows together about the direction of travel: it rolls the machine from "
        "side to side. Phases between the rows change it."
    ),
    "yaw_moment": to_say(
        "The moment of all rows together about the vertical: it turns the machine to and fro. "
        "Phases between the rows change it."
    ),
    "spectrum": to_say(
        "How much of the signal comes once, twice and more often in 360° of crank angle. A "
        "counterweight on the crank acts on order 1 alone; an order that meets a natural frequency "
        "of the support shakes it most."
    ),
    "joint": to_say(
        "The force in a joint over the crank angle. Its peak sizes the bearing; where it comes "
        "near zero and turns round, a joint with play knocks."
    ),
    "output": to_say(
        "Any figure that the machine has over the crank angle, such as velocities, transmission "
        "angles and forces: type some of its name."
    ),
    "response": to_say(
        "What a gauge on the support reads over one turn at this speed. Compare gauges: the "
        "largest is where the machine is felt to shake."
    ),
    "sweep": to_say(
        "What the gauges read against speed, peak to peak. Peaks are resonances; the line is the "
        "speed of work, which should stand well away from them."
    ),
}
"""Name of a chart -> what it shows, what to look for."""


def explained() -> dict[str, str]:
    """Explanations of charts, by name, in the language that is spoken."""
    return {name: say(text) for name, text in CHARTS.items()}
