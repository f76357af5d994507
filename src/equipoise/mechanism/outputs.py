"""The outputs of a machine, each declared once; everything that lists outputs reads them here.

An analysis reads them: `found` has its machine, motion and forces, and in `together` the signals of
all rows.
"""

from __future__ import annotations

from typing import Any

from equipoise.i18n import say, to_say
from equipoise.mechanism.declaring import (
    DECLARED,
    GROUPS,
    Declared,
    Found,
    Measure,
    declared,
    declaring,
    matches,
    output,
)

__all__ = ["DECLARED", "GROUPS", "Declared", "Found", "declared", "declaring", "matches", "output"]
"""What `declaring` has is had from here, where something is declared."""

FRAME = "frame"
FORCE: tuple[Measure, ...] = ("rms", "peak")
MOMENT: tuple[Measure, ...] = ("rms", "peak", "area")
TORQUE: tuple[Measure, ...] = ("rms", "ripple", "peak", "peak_to_peak")
"""Measures that are told of an output before and after balancing."""


# -- members of families ---------------------------------------------------------------------------


def joint_names(machine: Any) -> list[str]:
    """Names of pins and sliders, as far as the names in the model tell.

    At a pin of several bodies each moving link has one; which of them carries the others is found
    only when the linkage is put together.
    """
    shared: dict[str, list[str]] = {}
    for body in (FRAME, *machine.links):
        for point in machine.points_of(body):
            shared.setdefault(point, []).append(body)
    pins = [point for point, bodies in shared.items() if len(bodies) == 2]
    several = (
        f"{point}/{body}"
        for point, bodies in shared.items()
        if len(bodies) > 2
        for body in bodies
        if body != FRAME
    )
    return [*pins, *several, *slider_names(machine)]


def slider_names(machine: Any) -> list[str]:
    """Names of sliding joints, such as ``ram on frame``."""
    return [slider.name for slider in machine.sliders]


def point_names(machine: Any) -> list[str]:
    """Names of points, those of the frame first."""
    names = dict.fromkeys(machine.frame)
    for link in machine.links.values():
        names.update(dict.fromkeys(link.points))
    return list(names)


def gauge_names(machine: Any) -> list[str]:
    """Names of the gauges on the support."""
    return [] if machine.support is None else list(machine.support.gauges)


def body_named(name: str) -> str:
    """A link, or the frame, in words."""
    return say("frame") if name == FRAME else name


def joint_named(name: str) -> str:
    """A joint in words; a slider, such as ``ram on frame``, by its link and what it slides on."""
    link, _, on = name.partition(" on ")
    return say("{link} on {on}", link=link, on=body_named(on)) if on else name


# -- motion ----------------------------------------------------------------------------------------

_LINKS: dict[str, Any] = {
    "needs": "motion",
    "members": lambda machine: machine.links,
    "summed": False,
}
output("links.{}.angle", "angle", to_say("angle of {name}"), **_LINKS)(
    lambda found, link: found.motion.links[link].angle
)
output(
    "links.{}.angular_velocity",
    "angular speed",
    to_say("angular velocity of {name}"),
    loop="{angular velocity:name}",
    **_LINKS,
)(lambda found, link: found.motion.links[link].angular_velocity)
output(
    "links.{}.angular_acceleration",
    "angular acceleration",
    to_say("angular acceleration of {name}"),
    loop="{angular acceleration:name}",
    **_LINKS,
)(lambda found, link: found.motion.links[link].angular_acceleration)

_POINTS: dict[str, Any] = {"needs": "motion", "members": point_names, "summed": False}
output(
    "points.{}.place",
    "length",
    to_say("position of {name}"),
    parts=("points.{}.x", "points.{}.y"),
    sized=False,
    loop="{position:name}",
    **_POINTS,
)(lambda found, point: found.motion.points[point].place)
output(
    "points.{}.velocity",
    "speed",
    to_say("velocity of {name}"),
    parts=("points.{}.vx", "points.{}.vy"),
    loop="{velocity:name}",
    **_POINTS,
)(lambda found, point: found.motion.points[point].velocity)
output(
    "points.{}.acceleration",
    "acceleration",
    to_say("acceleration of {name}"),
    parts=("points.{}.ax", "points.{}.ay"),
    loop="{acceleration:name}",
    **_POINTS,
)(lambda found, point: found.motion.points[point].acceleration_vector)

_SLIDERS: dict[str, Any] = {"needs": "motion", "members": slider_names, "spoken": joint_named}
output("sliders.{}.travel", "length", to_say("travel of {name}"), **_SLIDERS)(
    lambda found, slider: found.motion.sliders[slider].travel
)
output("sliders.{}.velocity", "speed", to_say("sliding velocity of {name}"), **_SLIDERS)(
    lambda found, slider: found.motion.sliders[slider].velocity
)
output(
    "sliders.{}.acceleration", "acceleration", to_say("sliding acceleration of {name}"), **_SLIDERS
)(lambda found, slider: found.motion.sliders[slider].along_acceleration)
output(
    "transmission.{}",
    "angle",
    to_say("transmission angle at {name}"),
    needs="motion",
    members=lambda machine: (),
    items=lambda found: found.motion.transmission,
    spoken=joint_named,
)(lambda found, joint: found.motion.transmission[joint])

# -- frame and drive -------------------------------------------------------------------------------

output(
    "shaking_force",
    "force",
    to_say("shaking force"),
    parts=("shaking_force.x", "shaking_force.y"),
    linear=True,
    loop="{shaking force}",
    ordered=True,
    compared=FORCE,
)(lambda found: found.forces.shaking_force)
output(
    "shaking_moment",
    "torque",
    to_say("shaking moment"),
    linear=True,
    about=True,
    loop="{shaking moment}",
    ordered=True,
    compared=MOMENT,
)(lambda found: found.forces.shaking_moment)
output(
    "drive_torque",
    "torque",
    to_say("drive torque"),
    linear=True,
    loop="{drive torque}",
    ordered=True,
    compared=TORQUE,
)(lambda found: found.forces.drive_torque)
output(
    "frame_force",
    "force",
    to_say("force on the frame"),
    parts=("frame_force.x", "frame_force.y"),
    linear=True,
    loop="{frame force}",
    summed=(True, False),
)(lambda found: found.forces.frame_force)
output(
    "frame_moment",
    "torque",
    to_say("moment on the frame"),
    linear=True,
    about=True,
    loop="{frame moment}",
)(lambda found: found.forces.frame_moment)

_WEIGHT: dict[str, Any] = {
    "linear": "{what} shakes nothing; take the force or moment on the frame instead",
    "summed": False,
}
output("weight", "force", to_say("weight"), parts=("weight.x", "weight.y"), sized=False, **_WEIGHT)(
    lambda found: found.forces.weight
)
output("weight_moment", "torque", to_say("moment of the weight"), about=True, **_WEIGHT)(
    lambda found: found.forces.weight_moment
)
output(
    "mass_center.acceleration",
    "acceleration",
    to_say("acceleration of the common centre of mass"),
    parts=("mass_center.ax", "mass_center.ay"),
    linear="{what} is the shaking force over the mass; take the shaking force instead",
    items=lambda found: ("",) if found.machine.mass else (),
    ordered=True,
    summed=False,
    sized=False,
)(lambda found: -found.forces.shaking_force.value / found.machine.mass)

# -- joints ----------------------------------------------------------------------------------------

output(
    "joints.{}",
    "force",
    to_say("force in joint {name}"),
    parts=("joints.{}.force_x", "joints.{}.force_y"),
    members=joint_names,
    items=lambda found: found.forces.joints,
    spoken=joint_named,
    linear=True,
    loop="{joint force:name}",
    summed=(True, False),
    compared=FORCE,
)(lambda found, joint: found.forces.joints[joint])

_RAILS: dict[str, Any] = {
    "members": slider_names,
    "items": lambda found: [
        name for name, joint in found.forces.joints.items() if hasattr(joint, "moment")
    ],
    "spoken": joint_named,
    "linear": "{what} is only read; take the whole force in the joint instead",
}
output("joints.{}.normal", "force", to_say("normal force in joint {name}"), summed=False, **_RAILS)(
    lambda found, joint: found.forces.joints[joint].normal
)
output(
    "joints.{}.moment",
    "torque",
    to_say("moment in joint {name}"),
    loop="{joint moment:name}",
    **_RAILS,
)(lambda found, joint: found.forces.joints[joint].moment)

_GEARS: dict[str, Any] = {
    "members": lambda machine: [gear.name for gear in machine.gears],
    "spoken": lambda name: name.replace(" to ", " → "),
    "linear": "{what} goes with the flank in contact, which other masses may change",
}
output(
    "gears.{}",
    "force",
    to_say("tooth force {name}"),
    parts=("gears.{}.force_x", "gears.{}.force_y"),
    loop="{joint force:name}",
    summed=(True, False),
    compared=FORCE,
    **_GEARS,
)(lambda found, gear: found.forces.gears[gear])
output(
    "gears.{}.tangential", "force", to_say("tangential tooth force {name}"), summed=False, **_GEARS
)(lambda found, gear: found.forces.gears[gear].tangential)
output("gears.{}.radial", "force", to_say("radial tooth force {name}"), summed=False, **_GEARS)(
    lambda found, gear: found.forces.gears[gear].radial
)

# -- rows and support ------------------------------------------------------------------------------

_ROWS: dict[str, Any] = {"needs": "rows", "linear": True}
output(
    "rows.shaking_force",
    "force",
    to_say("shaking force"),
    parts=("rows.shaking_force.x", "rows.shaking_force.y"),
    summed=(True, False),
    compared=FORCE,
    **_ROWS,
)(lambda found: found.together["shaking_force"])
output("rows.shaking_moment", "torque", to_say("shaking moment"), compared=FORCE, **_ROWS)(
    lambda found: found.together["shaking_moment"]
)
output("rows.roll_moment", "torque", to_say("roll moment"), compared=FORCE, **_ROWS)(
    lambda found: found.together["roll_moment"]
)
output("rows.yaw_moment", "torque", to_say("yaw moment"), compared=FORCE, **_ROWS)(
    lambda found: found.together["yaw_moment"]
)
output("rows.drive_torque", "torque", to_say("drive torque"), **_ROWS)(
    lambda found: found.together["drive_torque"]
)
DECLARED["gauges.{}"] = Declared(
    "gauges.{}", "length", to_say("gauge {name}"), None, needs="support", members=gauge_names
)
