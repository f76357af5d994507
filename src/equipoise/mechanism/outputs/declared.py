"""The outputs of a machine, each declared once; everything that lists outputs follows.

Where there is none, for it lies at infinity, or has no bound, values are NaN.

An analysis reads them: it has the machine, motion and forces, and in `rows_total` the signals of
all rows.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import combinations
from typing import TYPE_CHECKING, Any

from equipoise.i18n import say, to_say
from equipoise.mechanism.checks import FRAME, bodies_at
from equipoise.mechanism.outputs.declaring import (
    DECLARED,
    GROUPS,
    Declared,
    OutputSource,
    Statistic,
    alike,
    declare_as,
    declared,
    declaring,
    kept_until_declared,
    looked_up,
    matches,
    output,
)
from equipoise.quantities import Dimension

if TYPE_CHECKING:
    from equipoise.signals import Array

PARALLEL = 1e-12
"""Difference of two rates of turning, over the larger of them and the crank's, below which bodies
only slide along each other; rate over the largest of the cycle below which something stands."""


def pairs(machine: Any) -> dict[str, tuple[str, str]]:
    """Pairs of bodies by name, such as ``coupler/frame``; not those that a guide keeps parallel."""
    parallel = {frozenset((slider.link, slider.on)) for slider in machine.sliders}
    both = combinations((*machine.links, FRAME), 2)
    return {"/".join(pair): pair for pair in both if frozenset(pair) not in parallel}


def pinned(machine: Any) -> list[str]:
    """Links other than the drive that turn about a pin in the frame."""
    met = [bodies for bodies in bodies_at(machine.bodies).values() if FRAME in bodies]
    on_frame = {body for bodies in met for body in bodies} - {machine.drive.link}
    return [link for link in machine.links if link in on_frame]


def guided(machine: Any) -> list[str]:
    """Names of sliders on the frame."""
    return [slider.name for slider in machine.sliders if FRAME in (slider.link, slider.on)]


def instant_center(motion: Any, pair: str) -> Array:
    """Place in the frame, m, complex (N,), at which both bodies of a pair have one velocity.

    That of two bodies that share a pin is there, even while they turn alike.
    """
    import numpy as np  # here, so that a file is read without it

    item, other = pairs(motion.machine)[pair]
    bodies = motion.machine.bodies
    if shared := [point for point in bodies[item] if point in bodies[other]]:
        place: Array = motion.points[shared[0]].place
        return place
    (v, w), (o, r) = _carried(motion, item), _carried(motion, other)
    apart = w - r
    least = PARALLEL * np.maximum(np.maximum(np.abs(w), np.abs(r)), 1.0)
    turning = np.abs(apart) > least
    center = -1j * (o - v) / np.where(turning, apart, 1.0)
    return np.where(turning, center, complex(np.nan, np.nan))


def _carried(motion: Any, body: str) -> tuple[Array, Array]:
    """Velocity by crank angle of a body's point at the frame's origin, and how the body turns."""
    import numpy as np

    if body == FRAME:
        return np.zeros(len(motion.crank_angle), complex), np.zeros(len(motion.crank_angle))
    anchor = motion.points[motion.linkage.anchors[body]]
    w = motion.links[body].angle_1
    return anchor.place_1 - 1j * w * anchor.place, w


def advantage(rate: Array) -> Array:
    """Force or torque of an output over the torque of the crank (N,), by virtual power.

    rate : derivative of its place by crank angle, m or 1.
    """
    import numpy as np

    moves = np.abs(rate) > PARALLEL * np.max(np.abs(rate), initial=0.0)
    return np.where(moves, 1 / np.where(moves, rate, 1.0), np.nan)


def joint_names(machine: Any) -> list[str]:
    """Names of pins, slots and sliders, as far as they follow from names in the model.

    At a pin of several bodies each moving link has one; which of them carries the others is found
    only when the linkage is put together.
    """
    shared = bodies_at(machine.bodies).items()
    pins = [point for point, bodies in shared if len(bodies) == 2]
    several = [(point, bodies) for point, bodies in shared if len(bodies) > 2]
    shared_pins = [
        f"{point}/{body}" for point, bodies in several for body in bodies if body != FRAME
    ]
    return [*pins, *shared_pins, *machine.riders, *slider_names(machine)]


def slider_names(machine: Any) -> list[str]:
    """Names of sliding joints, such as ``ram on frame``."""
    return [slider.name for slider in machine.sliders]


def body_named(name: str) -> str:
    """A link, or the frame, in words."""
    return say("frame") if name == FRAME else name


def coupling_named(name: str) -> str:
    """A coupling by its two bodies, such as ``frame to idler``, in words."""
    return " → ".join(map(body_named, name.split(" to ")))


LETTER = re.compile(r"[A-Z]'?[0-9]*")


def named(name: str) -> str:
    """A name of a file as a sentence has it: in quotation marks, but for letters such as ``B2``."""
    return name if LETTER.fullmatch(name) else say("“{name}”", name=name)


def joint_named(name: str) -> str:
    """A joint in words; a slider, such as ``ram on frame``, by its link and what it slides on, and
    a pin in a slot, such as ``P in frame``, by its point and what has the slot.
    """
    link, _, on = name.partition(" on ")
    pin, _, slot = name.partition(" in ")
    if slot:
        return say("{pin} in {on}", pin=pin, on=body_named(slot))
    return say("{link} on {on}", link=link, on=body_named(on)) if on else name


def pair_named(name: str) -> str:
    """A pair of bodies, such as ``coupler/frame``, in words."""
    item, _, other = name.rpartition("/")
    return f"{item}/{body_named(other)}"


__all__ = [
    "DECLARED",
    "GROUPS",
    "Declared",
    "OutputSource",
    "declared",
    "declaring",
    "kept_until_declared",
    "matches",
    "output",
]
"""What `declaring` has is had from here, where something is declared."""

FORCE: tuple[Statistic, ...] = ("rms", "peak")
MOMENT: tuple[Statistic, ...] = ("rms", "peak", "area")
TORQUE: tuple[Statistic, ...] = ("rms", "ripple", "peak", "peak_to_peak")
"""Measures of an output that are reported before and after balancing."""
XY, FORCES = (".x", ".y"), (".force_x", ".force_y")
"""Components of vectors, behind their names."""


# -- motion ----------------------------------------------------------------------------------------

of_link = alike(
    "links.{}.",
    lambda name, result, link: getattr(result.motion.links[link], name),
    needs="motion",
    members=lambda machine: machine.links,
    summed=False,
    loop=True,
)
of_link("angle", "angle", to_say("angle of {name}"), loop=None)
of_link("angular_velocity", "angular speed", to_say("angular velocity of {name}"))
of_link("angular_acceleration", "angular acceleration", to_say("angular acceleration of {name}"))

UNBOUNDED: dict[str, Any] = {"array": False, "summed": False, "loop": None, "unbounded": True}
of_link(
    "advantage",
    None,
    to_say("mechanical advantage of {name}"),
    had="angle_1",
    members=lambda machine: pinned(machine) * machine.has_crank,
    of=advantage,
    **UNBOUNDED,
)

of_point = alike(
    "points.{}.",
    lambda name, result, point: getattr(result.motion.points[point], name),
    needs="motion",
    members=lambda machine: bodies_at(machine.bodies),
    summed=False,
)
of_point(
    "place",
    "length",
    to_say("position of {name}"),
    ("x", "y"),
    sized=False,
    loop=looked_up("position"),
)
of_point("velocity", "speed", to_say("velocity of {name}"), ("vx", "vy"), loop=True)
of_point(
    "acceleration",
    "acceleration",
    to_say("acceleration of {name}"),
    ("ax", "ay"),
    loop=True,
    had="acceleration_vector",
)

of_slider = alike(
    "sliders.{}.",
    lambda name, result, slider: getattr(result.motion.sliders[slider], name),
    needs="motion",
    members=slider_names,
    spoken=joint_named,
)
of_slider("travel", "length", to_say("travel of {name}"))
of_slider("velocity", "speed", to_say("sliding velocity of {name}"))
of_slider(
    "acceleration",
    "acceleration",
    to_say("sliding acceleration of {name}"),
    had="along_acceleration",
)
of_slider(
    "advantage",
    "per length",
    to_say("mechanical advantage of {name}"),
    had="travel_1",
    members=lambda machine: guided(machine) * machine.has_crank,
    of=advantage,
    **UNBOUNDED,
)
of_dyad = alike(
    "transmission.{}",
    lambda _, result, joint: result.motion.transmission[joint],
    needs="motion",
    members=lambda machine: (),
    items=lambda result: result.motion.transmission,
    spoken=joint_named,
)
of_dyad("", "angle", to_say("transmission angle at {name}"), yardstick="transmission")
of_pair = alike(
    "centers.{}",
    lambda _, result, pair: instant_center(result.motion, pair),
    needs="motion",
    members=pairs,
    spoken=pair_named,
    sized=False,
    **UNBOUNDED,
)
of_pair("", "length", to_say("instant centre of {name}"), (".x", ".y"))

# -- frame and drive -------------------------------------------------------------------------------


def _force(name: str, result: Any) -> Any:
    return getattr(result.forces, name)


linear = alike("", _force, linear=True, loop=True)
linear("shaking_force", "force", to_say("shaking force"), XY, ordered=True, compared=FORCE,
       yardstick="weight")  # fmt: skip
linear("shaking_moment", "torque", to_say("shaking moment"), about=True, ordered=True,
       compared=MOMENT, yardstick="span")  # fmt: skip
TURNED: dict[str, Any] = {"members": lambda machine: () if machine.drive.pushes else ("",)}
PUSHED: dict[str, Any] = {"members": lambda machine: ("",) if machine.drive.pushes else ()}
EFFORT: dict[str, Any] = {"ordered": True, "compared": TORQUE, "yardstick": "effort",
                          "by_friction": True}  # fmt: skip
linear("drive_torque", "torque", to_say("drive torque"), **TURNED, **EFFORT)
linear("drive_force", "force", to_say("drive force"), with_loads=True, **PUSHED, **EFFORT)
linear("frame_force", "force", to_say("force on the frame"), XY, summed=(True, False),
       with_loads=True)  # fmt: skip
linear("frame_moment", "torque", to_say("moment on the frame"), about=True, with_loads=True)
of_space = alike(
    "",
    lambda name, result: getattr(result.forces.across, name),
    needs="planes",
    members=lambda machine: ("",) if machine.has_planes else (),
    linear=True,
    loop=True,
)
of_space("rocking_moment", "torque", to_say("rocking moment"), XY, ordered=True, compared=FORCE,
         yardstick="bearings")  # fmt: skip
of_space(
    "frame_rocking_moment",
    "torque",
    to_say("rocking moment on the frame"),
    XY,
    summed=(True, False),
)
of_weight = alike(
    "",
    _force,
    linear=True,
    reason=to_say("{what} shakes nothing; take the force or moment on the frame instead"),
    summed=False,
)
of_weight("weight", "force", to_say("weight"), XY, sized=False)
of_weight("weight_moment", "torque", to_say("moment of the weight"), about=True)
of_center = alike(
    "mass_center.",
    lambda _, result: -result.forces.shaking_force.value / result.machine.mass,
    reason=to_say("{what} is the shaking force over the mass; take the shaking force instead"),
    items=lambda result: ("",) if result.machine.mass else (),
    ordered=True,
    summed=False,
    sized=False,
)
of_center("acceleration", "acceleration", to_say("acceleration of the common centre of mass"),
          ("ax", "ay"))  # fmt: skip


def _of_drive(name: str, result: Any, link: str) -> Any:
    effort, motion = result.forces.drives[link], result.motion
    return effort * motion.way(link) * motion.speed if name == "power" else effort


def _links_of_drives(machine: Any, effort_in: str) -> list[str]:
    """Links of drives that turn or push."""
    kinds = {item.link: item.effort_in for item in machine.driven}
    return [link for link in machine.listed_drives if kinds[link] == effort_in]


of_drive = alike("drives.{}.", _of_drive, linear=True, by_friction=True)
of_drive(
    "torque",
    "torque",
    to_say("drive torque of {name}"),
    loop=looked_up("drive torque"),
    members=lambda machine: _links_of_drives(machine, "torque"),
    yardstick="effort",
)
of_drive(
    "force",
    "force",
    to_say("drive force of {name}"),
    loop=looked_up("drive force"),
    members=lambda machine: _links_of_drives(machine, "force"),
    yardstick="effort",
    with_loads=True,
)
of_drive(
    "power",
    "power",
    to_say("drive power of {name}"),
    loop=looked_up("drive power"),
    members=lambda machine: machine.listed_drives,
)

# -- joints ----------------------------------------------------------------------------------------


def _members(forces: Any, name: str, member: str) -> Any:
    """A force by its member, or of that force what follows a dot."""
    return getattr(forces[member], name[1:]) if name else forces[member]


def _of_joint(name: str, result: Any, joint: str) -> Any:
    if name == "tilting_moments":
        return result.forces.across.tilting_moments[joint]
    return _members(result.forces.joints, name, joint)


of_joint = alike(
    "joints.{}",
    _of_joint,
    spoken=joint_named,
    linear=True,
    internal=True,
    by_friction=True,
)
of_joint(
    "",
    "force",
    to_say("force in joint {name}"),
    FORCES,
    members=joint_names,
    items=lambda result: result.forces.joints,
    loop=looked_up("joint force"),
    summed=(True, False),
    compared=FORCE,
    yardstick="acting",
)


def _having(part: str) -> dict[str, Any]:
    """Joints whose force has a part."""
    return {"items": lambda result: [n for n, joint in result.forces.joints.items()
                                    if hasattr(joint, part)]}  # fmt: skip


RAILS: dict[str, Any] = {
    "reason": "{what} is only read; take the whole force in the joint instead",
}
of_joint(".normal", "force", to_say("normal force in joint {name}"), summed=False,
         members=lambda machine: [*slider_names(machine), *machine.riders],
         **_having("normal"), **RAILS)  # fmt: skip
of_joint(".moment", "torque", to_say("moment in joint {name}"), loop=looked_up("joint moment"),
         members=slider_names, **_having("moment"), **RAILS)  # fmt: skip

of_joint(
    ".tilting_moment",
    "torque",
    to_say("tilting moment in joint {name}"),
    XY,
    members=lambda machine: joint_names(machine) if machine.has_planes else (),
    items=lambda result: result.forces.across.tilting_moments if result.machine.has_planes else (),
    had="tilting_moments",
    needs="planes",
    summed=(True, False),
)
of_bearing = alike(
    "bearings.{}",
    lambda _, result, bearing: result.forces.across.bearings[bearing],
    needs="planes",
    members=lambda machine: machine.bearings,
    items=lambda result: result.forces.across.bearings if result.machine.bearings else (),
    linear=True,
    internal=True,
    by_friction=True,
)
of_bearing(
    "",
    "force",
    to_say("force of bearing {name}"),
    FORCES,
    loop=looked_up("bearing force"),
    summed=(True, False),
    compared=FORCE,
    yardstick="acting",
)


def _of_friction(name: str, result: Any, joint: str) -> Any:
    return getattr(result.forces.frictions[joint], name)


def _named_in_file(machine: Any, wanted: Callable[[Any], bool]) -> list[str]:
    """Names of joints whose entry in the file meets a condition."""
    given = {joint.joint.removeprefix("joints.") for joint in machine.joints if wanted(joint)}
    names = joint_names(machine) if given else ()
    return [name for name in names if {name, name.partition("/")[0]} & given]


def _rubbing(*kinds: str) -> dict[str, Any]:
    """Joints that resist their motion, pins or sliders."""

    def members(machine: Any) -> list[str]:
        sliders = slider_names(machine) if machine.rubs else []
        mine = _named_in_file(machine, lambda joint: joint.rubs)
        return [item for item in mine if ("slider" if item in sliders else "pin") in kinds]

    def items(result: Any) -> list[str]:
        frictions = result.forces.frictions.items()
        return [name for name, item in frictions
                if not item.table and ("pin" if item.is_pin else "slider") in kinds]  # fmt: skip

    return {"members": members, "items": items, "spoken": joint_named}


of_friction = alike("joints.{}.", _of_friction)
of_friction("friction_torque", "torque", to_say("friction torque in joint {name}"), had="effort",
            **_rubbing("pin"))  # fmt: skip
of_friction("friction_force", "force", to_say("friction force in joint {name}"), had="effort",
            **_rubbing("slider"))  # fmt: skip
BOTH = _rubbing("pin", "slider")
of_friction("friction_loss", "power", to_say("friction loss in joint {name}"), had="loss",
            **BOTH)  # fmt: skip
of_friction("sliding_power", "power", to_say("contact force times sliding speed in joint {name}"),
            **BOTH)  # fmt: skip
alike("", _force)(
    "friction_loss",
    "power",
    to_say("friction loss in all joints"),
    members=lambda machine: ("",) if machine.rubs else (),
)

of_plain_bearing = alike(
    "joints.{}.",
    lambda name, result, joint: getattr(result.forces.plain_bearings[joint], name),
    members=lambda machine: _named_in_file(machine, lambda item: item.width is not None),
    items=lambda result: result.forces.plain_bearings,
    spoken=joint_named,
)
of_plain_bearing("pressure", "modulus", to_say("pressure in joint {name}"))
of_plain_bearing("pressure_speed", "pressure times speed",
                 to_say("pressure times sliding speed in joint {name}"))  # fmt: skip

of_section = alike(
    "links.{}.",
    lambda name, result, link: getattr(result.forces.sections[link], name),
    members=lambda machine: [name for name, link in machine.links.items() if link.section],
)
of_section("stress", "modulus", to_say("largest stress along {name}"))
of_section("axial_force", "force", to_say("largest axial force along {name}"))
of_section("bending_moment", "torque", to_say("largest bending moment along {name}"))


def _members_of(table: str) -> dict[str, Any]:
    return {
        "members": lambda machine: [item.name for item in getattr(machine, table)],
        "spoken": coupling_named,
    }


def of_mesh(table: str) -> None:
    """Declare what couplings of a list of the file lose in passing their force on."""

    def members(machine: Any) -> list[str]:
        given = {joint.joint for joint in machine.joints if joint.rubs}
        return [item.name for item in getattr(machine, table) if f"{table}.{item.name}" in given]

    def items(result: Any) -> list[str]:
        return [
            name for name, friction in result.forces.frictions.items() if friction.table == table
        ]

    label = to_say("friction loss at {name}")
    own = {**_members_of(table), "members": members, "items": items}
    alike(table + ".{}.", _of_friction, **own)("friction_loss", "power", label, had="loss")


def part_in_loops(part: str) -> Callable[[Callable[..., Any]], Any]:
    """A part of a coupling's force in compiled loops."""
    return lambda value: value("coupling part", part)


CONTACT: dict[str, Any] = {"loop": looked_up("joint force"), "summed": (True, False),
                           "compared": FORCE, "yardstick": "acting"}  # fmt: skip
"""Of the whole force of a coupling."""
PART_OF_FORCE = {"summed": False, "reason": "{what} is only read; take the whole force instead"}
"""Of one part of it."""


def of_coupling(table: str) -> Callable[..., None]:
    """A way to declare outputs of the couplings of a list of the file, which are linear for the
    flanks in contact and the strands that pull.
    """
    shared: dict[str, Any] = {"linear": True, "internal": True, "by_friction": True}
    shared |= _members_of(table)
    read = lambda name, result, item: _members(result.forces.couplings[table], name, item)  # noqa: E731
    return alike(table + ".{}", read, **shared)


def of_contacts(table: str) -> Callable[..., None]:
    """A function that declares outputs of motion at the contacts of couplings of one list."""

    def read(name: str, result: Any, item: str) -> Any:
        names = [coupling.name for coupling in getattr(result.motion.machine, table)]
        return result.motion.element_values(table, names.index(item))[name]

    return alike(table + ".{}.", read, needs="motion", **_members_of(table))


def of_element(table: str, name: str, dimension: Dimension, label: str) -> None:
    """Declare an output of the elements of a list of the file."""
    alike(
        table + ".{}.",
        lambda name, result, item: result.motion.element_values(table, int(item) - 1)[name],
        members=lambda machine: [str(k + 1) for k in range(len(getattr(machine, table)))],
        needs="motion",
    )(name, dimension, label, loop=lambda value: value("element", table, name))


# -- rows and support ------------------------------------------------------------------------------

of_rows = alike("rows.", lambda name, result: result.rows_total[name], needs="rows", linear=True)
of_rows("shaking_force", "force", to_say("shaking force"), XY, summed=(True, False), compared=FORCE,
        yardstick="weight")  # fmt: skip
of_rows("shaking_moment", "torque", to_say("shaking moment"), compared=FORCE, yardstick="span")
of_rows("roll_moment", "torque", to_say("roll moment"), compared=FORCE, yardstick="bearings")
of_rows("yaw_moment", "torque", to_say("yaw moment"), compared=FORCE, yardstick="bearings")
of_rows("drive_torque", "torque", to_say("drive torque"), compared=TORQUE, yardstick="effort",
        by_friction=True, **TURNED)  # fmt: skip
of_rows("drive_force", "force", to_say("drive force"), compared=TORQUE, yardstick="effort",
        by_friction=True, with_loads=True, **PUSHED)  # fmt: skip
declare_as(
    Declared(
        "gauges.{}",
        "length",
        to_say("reading at {name}"),
        None,
        needs="support",
        yardstick="vibration",
        members=lambda machine: [] if machine.support is None else list(machine.support.readings),
    )
)
