"""What figures of planting are called, and what they are: declared here for tables and searches."""

from __future__ import annotations

import re
from typing import NamedTuple

from equipoise.design.requirements import TURNING
from equipoise.i18n import say, to_say
from equipoise.quantities import Dimension


class NamedFigure(NamedTuple):
    """A figure in words, and its dimension; None of a plain number."""

    words: str
    dimension: Dimension | None


INSTANTS = {
    "pick_up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest point"),
    "release": to_say("release"),
    "exit": to_say("exit"),
    "highest": to_say("highest point"),
}
"""Columns of the table of instants; it begins with the first that there is."""
OF_AN_INSTANT = {
    "crank_angle": NamedFigure(to_say("crank angle"), "angle"),
    "x": NamedFigure(to_say("x"), "length"),
    "y": NamedFigure(to_say("y"), "length"),
    "velocity.x": NamedFigure(to_say("velocity x"), "speed"),
    "velocity.y": NamedFigure(to_say("velocity y"), "speed"),
    "velocity.size": NamedFigure(to_say("velocity"), "speed"),
    "velocity.direction": NamedFigure(to_say("direction of velocity"), "angle"),
    "acceleration.x": NamedFigure(to_say("acceleration x"), "acceleration"),
    "acceleration.y": NamedFigure(to_say("acceleration y"), "acceleration"),
    "acceleration.size": NamedFigure(to_say("acceleration"), "acceleration"),
    "acceleration.direction": NamedFigure(to_say("direction of acceleration"), "angle"),
    "ground_velocity.x": NamedFigure(to_say("over ground: velocity x"), "speed"),
    "ground_velocity.size": NamedFigure(to_say("over ground: velocity"), "speed"),
    "ground_velocity.direction": NamedFigure(to_say("over ground: direction"), "angle"),
    "attitude": NamedFigure(to_say("attitude of the finger"), "angle"),
}
PATH = {
    "curve.height": NamedFigure(to_say("height of the curve"), "length"),
    "curve.width": NamedFigure(to_say("width of the curve"), "length"),
    "curve.length": NamedFigure(to_say("length of the curve"), "length"),
    "curve.lift": NamedFigure(to_say("rise above the soil"), "length"),
    "curve.smallest_radius.value": NamedFigure(to_say("smallest radius of the curve"), "length"),
    "ground.smallest_radius.value": NamedFigure(to_say("smallest radius over ground"), "length"),
    "hill_spacing": NamedFigure(to_say("distance of hills"), "length"),
    "hills.smallest_distance": NamedFigure(to_say("smallest distance of hills"), "length"),
    "hills.largest_distance": NamedFigure(to_say("largest distance of hills"), "length"),
    "planting_frequency": NamedFigure(to_say("planting frequency"), "frequency"),
}
SOIL = {
    "soil.depth": NamedFigure(to_say("depth in the soil"), "length"),
    "soil.crank_travel": NamedFigure(to_say("crank travel in the soil"), "angle"),
    "soil.time": NamedFigure(to_say("time in the soil"), "time"),
    "soil.path_length_ground": NamedFigure(to_say("path in the soil over ground"), "length"),
    "soil.path_length_machine": NamedFigure(
        to_say("path in the soil relative to the machine"), "length"
    ),
    "soil.ground_distance": NamedFigure(to_say("ground distance from entry to exit"), "length"),
    "soil.hole_length": NamedFigure(to_say("length of the hole at the surface"), "length"),
    "soil.max_acceleration.value": NamedFigure(
        to_say("largest acceleration in the soil"), "acceleration"
    ),
}
EXTREMES = {
    "max_speed": NamedFigure(to_say("largest velocity of the tip"), "speed"),
    "min_speed": NamedFigure(to_say("smallest velocity of the tip"), "speed"),
    "max_acceleration": NamedFigure(to_say("largest acceleration of the tip"), "acceleration"),
    "min_acceleration": NamedFigure(to_say("smallest acceleration of the tip"), "acceleration"),
}
FIGURES = {
    **PATH,
    **SOIL,
    **{f"{name}.value": extreme for name, extreme in EXTREMES.items()},
}
SHAKING_FIGURES = {
    "shaking_force.rms": NamedFigure(to_say("RMS of the shaking force"), "force"),
    "shaking_force.peak": NamedFigure(to_say("largest shaking force"), "force"),
    "shaking_moment.rms": NamedFigure(to_say("RMS of the shaking moment"), "torque"),
    "shaking_moment.peak": NamedFigure(to_say("largest shaking moment"), "torque"),
    "drive_torque.rms": NamedFigure(to_say("RMS of the drive torque in the air"), "torque"),
    "drive_torque.peak": NamedFigure(to_say("largest drive torque in the air"), "torque"),
}
"""Of inertia, which a search may ask for; the moment is about the drive's pivot."""
LINKAGE = {"transmission.min": NamedFigure(to_say("smallest transmission angle"), "angle")}
OF_INSTANTS = ("crank_angle", "velocity.size", "acceleration.size", "attitude")
OTHERS = (
    *(f"{name}.{key}" for name in ("pick_up", "entry", "lowest", "exit") for key in OF_INSTANTS),
    *LINKAGE,
    *SHAKING_FIGURES,
)
"""Further figures that a search compares before and after."""
DIMENSIONS: dict[str, Dimension] = {
    **dict.fromkeys(("surface", "soil.ground_advance"), "length"),
    "speed": "angular speed",
    "forward_speed": "speed",
    "limit": "acceleration",
    "highest_speed": "angular speed",
    "highest_forward_speed": "speed",
}
"""Of the others, by their name or its last part."""
FIRST = {*INSTANTS, *(name.partition(".")[0] for name in FIGURES), "limits", "clearance"}
ARM = re.compile(rf"arms\.(?P<tip>.+?)\.(?=(?:{'|'.join(FIRST)})\.)")
"""Begin of the name of a figure of a further arm; tips may be called anything, with dots too."""


def of_all_arms(figure: str) -> str:
    """The name of a figure without that of its arm."""
    return ARM.sub("", figure)


def dimension_of(figure: str) -> Dimension | None:
    """Dimension of a figure such as ``curve.height``, or None for a plain number."""
    figure = of_all_arms(figure)
    first, _, rest = figure.partition(".")
    last = figure.rpartition(".")[2]
    if last in TURNING:
        return "angle"
    if first == "clearance" and last == "value":
        return "length"
    known = (FIGURES | LINKAGE | SHAKING_FIGURES).get(figure)
    if first in INSTANTS:
        known = OF_AN_INSTANT.get(rest.removeprefix("ground_"))
    if known is not None:
        return known.dimension
    return DIMENSIONS.get(last if first == "limits" else figure)


def figure_named(name: str) -> str:
    """A figure, such as ``pick_up.velocity.size``, in words, where there are any."""
    if arm := ARM.match(name):
        return say("{what}, tip {tip}", what=figure_named(name[arm.end() :]), tip=arm["tip"])
    known = FIGURES | LINKAGE | SHAKING_FIGURES
    if name in known:
        return say(known[name].words)
    instant, _, key = name.partition(".")
    if instant not in INSTANTS or key not in OF_AN_INSTANT:
        return name
    what = say(OF_AN_INSTANT[key].words)
    return say("{what} at {instant}", what=what, instant=say(INSTANTS[instant]))
