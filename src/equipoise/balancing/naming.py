"""Outputs, measures and causes in words."""

from __future__ import annotations

from math import pi

from equipoise.i18n import say, to_say
from equipoise.mechanism.balance import Objective

RPM = 30 / pi
OUTPUTS = {
    "shaking_force": to_say("shaking force"),
    "shaking_force.x": to_say("shaking force x"),
    "shaking_force.y": to_say("shaking force y"),
    "shaking_moment": to_say("shaking moment"),
    "drive_torque": to_say("drive torque"),
    "frame_force": to_say("force on the frame"),
    "frame_moment": to_say("moment on the frame"),
    "roll_moment": to_say("roll moment"),
    "yaw_moment": to_say("yaw moment"),
}
MEASURES = {
    "rms": to_say("RMS"),
    "ripple": to_say("RMS about the mean"),
    "peak": to_say("peak"),
    "peak_to_peak": to_say("peak to peak"),
    "area": to_say("area in a turn"),
}
CAUSES = {
    "translation": to_say("inertia of the centres of mass"),
    "rotation": to_say("inertia of rotation"),
    "weight": to_say("weight"),
    "load": to_say("loads"),
    "spring": to_say("springs"),
}
SCALES = {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "kg": (1e3, "g")}
"""SI unit -> factor and unit that is shown."""


def output_named(name: str, rows: int = 1) -> str:
    """An output, such as ``joints.A``, in words.

    rows : of the machine; where there are several, outputs are of one row if they do not say so.
    """
    first, _, rest = name.partition(".")
    if first == "rows":
        return say("all rows: {what}", what=output_named(rest))
    if first == "gauges":
        return say("gauge {name}", name=rest)
    if first == "joints":
        what = say("force in joint {name}", name=joint_named(rest))
    elif first == "gears":
        what = say("tooth force {name}", name=rest.replace(" to ", " → "))
    else:
        what = say(OUTPUTS[name]) if name in OUTPUTS else name
    return say("one row: {what}", what=what) if rows > 1 else what


def body_named(name: str) -> str:
    """A link, or the frame."""
    return say("frame") if name == "frame" else name


def joint_named(name: str) -> str:
    """A joint; a slider, such as ``ram on frame``, by its link and what it slides on."""
    link, _, on = name.partition(" on ")
    return say("{link} on {on}", link=link, on=body_named(on)) if on else name


def objective_named(one: Objective, rows: int = 1) -> str:
    """What is to become small, in words."""
    output = f"rows.{one.output}" if rows > 1 and one.output in OUTPUTS else one.output
    words = [output_named(output), say(MEASURES[one.measure])]
    if one.about:
        words.append(say("about {point}", point=one.about))
    if one.orders:
        words.append(say("order {orders}", orders=", ".join(f"{order:g}" for order in one.orders)))
    if one.speeds:
        speeds = ", ".join(f"{speed * RPM:.4g}" for speed in one.speeds)
        words.append(say("at {speeds} rpm", speeds=speeds))
    return say(", ").join(words)


def unit_of(output: str, measure: str) -> str:
    """SI unit of a figure that is told before and after."""
    if measure == "area":
        return "J"
    forces = ("force", "joints", "gears")
    return "N" if any(word in output for word in forces) else "N m"


def scaled(unit: str) -> tuple[float, str]:
    """Factor and shown unit of an SI unit."""
    return SCALES.get(unit, (1.0, unit))
