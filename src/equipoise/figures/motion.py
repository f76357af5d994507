"""Charts of motion: paths of points, their hodographs, any output over crank angle, and couplings:
speed ratios that vary, and outputs of kinds that have a picture, such as the strands of belts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.chart_parts import (
    ALL,
    angle_axis,
    angle_step,
    compared,
    extent,
    numbered_angles,
    numbers,
    over,
    speed_text,
    title,
    with_figures,
)
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.outputs.declared import guided, joint_named, pinned
from equipoise.quantities import Dimension
from equipoise.results.charts import Arrow, Axis, Chart, Curve, Mark, Panel, four_digits
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion, PointMotion
    from equipoise.mechanism.parts.couplings import Coupling
    from equipoise.results.analysis import Analysis
    from equipoise.results.outputs import AnalysisOutput


STILL = 1e-9
"""Over the motion of what moves most: what is less stands still."""
ALIKE = 1e-3
"""Over the size of a path: paths that are nearer to each other look like one."""
MOST_POINTS, MOST_VECTORS = 4, 3
"""Points that are followed in a picture or an animation: their paths; and their hodographs."""
SMALL_PATH, SHORT_PATH = 0.15, 0.08
"""Over the size of a picture: paths that are all smaller are enlarged, and shorter ones without
any dot."""
DOT_RADIUS, MOST_HIDDEN = 0.016, 0.62
"""Over the size of a picture in half of a page: radius of its dots; share of a path below these."""
FEW = (0, 90)
"""Crank angles, deg, that are labelled on curves of several points about one place."""


def moving(motion: Motion) -> list[str]:
    """Points that do not stand still."""
    fastest = {name: float(np.max(np.abs(point.place_1))) for name, point in motion.points.items()}
    least = STILL * max(fastest.values())
    return [name for name, rate in fastest.items() if rate > least]


def traced(motion: Motion) -> list[str]:
    """Points with a path worth following: planting tips, then those of couplers, first those that
    are no joint.

    A point of a link that is pinned to the frame runs on a circle; these come only where a machine
    has no others, and those of the drive last of all.
    """
    machine, joints = motion.machine, motion.linkage.joints
    pinned = [link for link in machine.links.values() if set(link.points) & set(machine.frame)]
    circling = {point for link in pinned for point in link.points}
    names = moving(motion)
    driven = [name for name in names if name not in machine.links[machine.drive.link].points]
    matching_names = [name for name in names if name not in circling] or driven or names
    tips = _tips(motion)
    every = dict.fromkeys([*tips, *matching_names])
    return sorted(every, key=lambda name: (name not in tips, name in joints.pins))


def _tips(motion: Motion) -> list[str]:
    planting = motion.machine.planting
    return [] if planting is None else [arm.tip for arm in planting.every_arm]


def followed(motion: Motion) -> list[str]:
    """Points whose paths are drawn where something moves: planting tips alone, else the first of
    those with a path worth following.
    """
    return _tips(motion)[:MOST_POINTS] or traced(motion)[:MOST_POINTS]


def _coincident(
    motion: Motion, names: Sequence[str], *curves_of: Callable[[PointMotion], Array]
) -> list[list[str]]:
    """Points whose curves are one, which they may pass at different times, together.

    curves_of : each curve (N,) of a point, complex, all of which have to be alike.
    """
    groups: list[list[str]] = []
    for name in names:
        point = motion.points[name]
        alike = (
            item
            for item in groups
            if all(_coincide(of(motion.points[item[0]]), of(point)) for of in curves_of)
        )
        group = next(alike, None) if motion.whole_cycle else None
        if group is None:
            groups.append([name])
        else:
            group.append(name)
    return groups


def _coincide(first: Array, other: Array) -> bool:
    """Whether two curves (N,) lie on each other but for a thousandth of their size."""
    size = float(np.ptp(first.real) + np.ptp(first.imag))
    if abs(np.mean(first) - np.mean(other)) > ALIKE * size:  # most differ by that already
        return False
    apart = np.abs(first[:, None] - other)
    return float(max(np.max(np.min(apart, axis=0)), np.max(np.min(apart, axis=1)))) <= ALIKE * size


def _names_of(group: Sequence[str]) -> str:
    """Names of points on one curve."""
    return short(group[0], 12) if len(group) == 1 else short(say(", ").join(group), 24)


def curves(analysis: Analysis, points: Sequence[str] | None = None) -> Chart:
    """Paths of points of couplers, with dots after equal times; those of other points pale.

    Where all are small beside the machine they are drawn enlarged, too, each about its middle.

    points : names; where they are not given, some that are no joint of the frame's links.
    """
    motion = analysis.motion
    names = traced(motion)[:MOST_POINTS] if points is None else [*points]
    others = [name for name in moving(motion) if name not in names]
    groups, other_groups = (_coincident(motion, each, _path) for each in (names, others))
    paths = [motion.points[name].place for name in names]
    frame = np.array([complex(*place) for place in analysis.machine.frame.values()])
    size = extent(*paths, *(motion.points[name].place for name in others), frame)
    small = 0 < max(map(extent, paths), default=0.0) < SMALL_PATH * size
    panels = [_in_frame(analysis, groups, other_groups, size, marked=not small)]
    if small:
        panels.append(_about_middles(analysis, groups))
    sparse = not small and any(_dots_hide(motion, path, size) for path in paths)
    return Chart(
        "curves",
        analysis.machine.title,
        _paths_title(motion, sparse),
        tuple(panels),
        columns=len(panels),
        stacked=False,
        keys=(("faint", say("other points")),) if others else (),
        caption=to_say("Paths of the points of the moving links, with marks at equal times."),
    )


def _in_frame(
    analysis: Analysis,
    groups: Sequence[Sequence[str]],
    other_groups: Sequence[Sequence[str]],
    size: float,
    marked: bool,
) -> Panel:
    """Paths where they are, by groups of points whose paths are one; marked : by crank angles."""
    motion = analysis.motion
    lines = [
        Curve.of(over(analysis, motion.points[group[0]].place)[1], "", "faint")
        for group in other_groups
    ]
    marks = [
        Mark.of(complex(*place), short(name), "stand", 45.0, distance=5.0, bold=True)
        for name, place in analysis.machine.frame.items()
    ]
    arrows: list[Arrow] = []
    along: list[Mark] = []
    for number, group in enumerate(groups, 1):
        role, path = f"several {number}", motion.points[group[0]].place
        label = say("path of {point}", point=_names_of(group))
        lines.append(Curve.of(over(analysis, path)[1], label, role))
        if marked:
            arrows += _sense(motion, group[0], path, role, size)
            along += _along(motion, path, role, size)
    for number, group in enumerate((*groups, *other_groups), 1):
        role = f"several {number}" if number <= len(groups) else "lines"
        marks.append(_name_at(motion.points[group[0]].place, group, role))
    x, y = (Axis.of(say("{axis} in the frame", axis=a), "length", size) for a in "xy")
    message = "" if groups else say("no point moves")
    return Panel(
        x,
        y,
        tuple(lines),
        (*marks, *along),
        arrows=tuple(arrows),
        message=message,
        equal=True,
        zero=False,
    )


def _about_middles(analysis: Analysis, groups: Sequence[Sequence[str]]) -> Panel:
    """Paths of points, each about its middle, in the looks that they have in the frame."""
    motion = analysis.motion
    roles = {group[0]: f"several {number}" for number, group in enumerate(groups, 1)}
    every = {group[0]: group for group in groups}
    size = max(extent(motion.points[name].place) for name in roles)
    lines, arrows, marks = [], [], []
    together = _coincident(motion, [*roles], _path_about_middle)
    for alike in together:
        name, role = alike[0], roles[alike[0]]
        path = _path_about_middle(motion.points[name])
        lines.append(Curve.of(over(analysis, path)[1], "", role))
        arrows += _sense(motion, name, path, role, size)
        marks.append(_name_at(path, [point for first in alike for point in every[first]], role))
        marks += _along(motion, path, role, size, few=len(together) > 1)
    x, y = (Axis.of(say("{axis} from the middle", axis=a), "length", size) for a in "xy")
    heading = say("enlarged, each path about its middle")
    return Panel(
        x,
        y,
        tuple(lines),
        tuple(marks),
        arrows=tuple(arrows),
        title=heading,
        equal=True,
        zero=False,
    )


def _path(point: PointMotion) -> Array:
    return point.place


def _path_about_middle(point: PointMotion) -> Array:
    """Path (N,), complex, from the middle of the box that holds it."""
    parts = (point.place.real, point.place.imag)
    x, y = (float(np.min(part) + np.max(part)) / 2 for part in parts)
    return np.asarray(point.place - complex(x, y))


def _name_at(path: Array, group: Sequence[str], role: str) -> Mark:
    """Names of points at the upper right of their path."""
    farthest = path[np.argmax((path * np.exp(-0.7j)).real)]
    return Mark.of(farthest, _names_of(group), role, 40.0, sign=False, distance=4.0, bold=True)


def _dots(motion: Motion, path: Array) -> Array:
    """Places of a path (N,) after equal times, complex."""
    ways = np.arange(0, 360 * motion.turns, angle_step(motion.turns))
    return np.asarray(path[np.round(ways * len(path) / (360 * motion.turns)).astype(int)])


def _dots_hide(motion: Motion, path: Array, size: float) -> bool:
    """Whether the dots of a path (N,) would hide most of it, in a picture of some size."""
    if not motion.whole_cycle:
        return False
    away = np.min(np.abs(path[:, None] - _dots(motion, path)), axis=1)
    lengths = np.abs(np.diff(path, append=path[0]))
    hidden = float(np.sum(lengths[away < DOT_RADIUS * size]))
    return hidden > MOST_HIDDEN * float(np.sum(lengths))


def _along(
    motion: Motion, path: Array, role: str, size: float, few: bool = False
) -> Iterator[Mark]:
    """Dots and numbers along a path (N,) of a cycle; of a short one those dots that have numbers,
    and none on one that is as small as they are.

    few : whether other paths lie on it, so that there is room for few numbers.
    """
    if not motion.whole_cycle:
        return
    if not _dots_hide(motion, path, size):
        yield from (Mark.of(z, "", role) for z in _dots(motion, path))
    elif extent(path) < SHORT_PATH * size:
        return
    angles = numbered_angles(motion.crank_angle)
    angles = {angle: k for angle, k in angles.items() if not few or angle in FEW}
    yield from numbers(angles, path, role, size)


def _paths_title(motion: Motion, sparse: bool) -> str:
    """Title of a chart of paths, with the crank angle and the time between dots.

    sparse : whether some paths have fewer dots.
    """
    if not motion.whole_cycle:
        return say("Paths of points, at {speed}", speed=speed_text(motion.speed))
    step = angle_step(motion.turns)
    values = {"step": step, "speed": speed_text(motion.speed)}
    if motion.speed:
        values["time"] = four_digits(1000 * np.radians(step) / abs(motion.speed))
        text = say("Paths of points; dots every {step}° = {time} ms, at {speed}", **values)
    else:
        text = say("Paths of points; dots every {step}° of the crank", **values)
    return f"{text}; {say('on short paths only where numbered')}" if sparse else text


def _sense(motion: Motion, name: str, path: Array, role: str, size: float) -> list[Arrow]:
    """The head of an arrow where a point is fastest; path : as it is drawn, (N,), complex."""
    rates = motion.points[name].place_1
    fastest = int(np.argmax(np.abs(rates)))
    way = complex(rates[fastest]) * float(np.sign(motion.speed))
    head = complex(path[fastest])
    return [Arrow(head - way / abs(way) * 0.02 * size, head, role)] if way else []


def hodograph(analysis: Analysis, points: Sequence[str] | None = None) -> Chart:
    """Ends of the arrows of velocity and acceleration of points.

    points : names; where they are not given, the same as of `curves`.
    """
    motion = analysis.motion
    given = traced(motion) if points is None else [*points]
    groups = _coincident(motion, given, attrgetter("velocity"), attrgetter("acceleration_vector"))
    groups = groups[:MOST_VECTORS] if points is None else groups
    names = [_names_of(group) for group in groups]
    every = [motion.points[group[0]] for group in groups]
    rates = [item.velocity for item in every]
    changes = [item.acceleration_vector for item in every]
    panels = (
        _ends(analysis, names, say("velocity"), "speed", rates),
        _ends(analysis, names, say("acceleration"), "acceleration", changes),
    )
    shown_here = say("Hodographs of velocity and acceleration")
    what = title(analysis, shown_here, say("numbers: crank angle, deg"), of_one=True)
    caption = to_say("Velocity and acceleration of these points: the ends of their arrows.")
    return Chart("hodograph", analysis.machine.title, what, panels, 2, False, caption=caption)


def _ends(
    analysis: Analysis,
    names: Sequence[str],
    quantity: str,
    dimension: Dimension,
    values: Sequence[Array],
) -> Panel:
    """Ends of arrows (N,), complex, of some points, with crank angles along them."""
    whole = np.concatenate([*values, [0]])
    x, y = (Axis.of(say("along {axis}", axis=axis), dimension, whole) for axis in ("x", "y"))
    counts: dict[int, int] = {}
    if analysis.motion.whole_cycle:
        counts = numbered_angles(analysis.crank_angle)
        counts = {a: k for a, k in counts.items() if len(values) < 2 or a in FEW}
    lines, marks = [], [Mark(0.0, 0.0, "", "pivot")]
    for number, (name, value) in enumerate(zip(names, values, strict=True), 1):
        role = f"several {number}"
        lines.append(Curve.of(over(analysis, value)[1], name, role))
        marks += numbers(counts, value, role, extent(whole))
    message = "" if names else say("no point moves")
    return Panel(x, y, tuple(lines), tuple(marks), title=quantity, message=message, equal=True)


# -- any output ------------------------------------------------------------------------------------

STEADY = 1e-6
"""Swing of a motion over its largest value, below which it is rounding: an angle from its cosine
near a right angle is known to the root of the digits of a number, 2e-8.
"""
KINEMATICS = to_say("Motion over crank angle: position, velocity and acceleration.")
MOST_LINKS = 3
"""Links whose motion stands in a report."""
FORBIDDEN = str.maketrans(dict.fromkeys(' /\\:*?"<>|', "-"))
"""What a file may not have in its name."""


def outputs_chart(
    analysis: Analysis,
    names: Sequence[str],
    name: str = "outputs",
    what: str = "",
    caption: str = "",
) -> Chart:
    """Outputs over crank angle, below each other, with their extremes.

    what : that is shown; the labels of the outputs where not given, as for the caption.

    Raises
    ------
    UsageError : there is no output of a name.
    """
    ones = analysis.outputs.chosen(names)
    x = angle_axis(analysis)
    panels = []
    for entry in ones:
        theta, values = over(analysis, _steady(entry.values_to_draw))
        if entry.dimension == "angle" and analysis.motion.whole_cycle:
            values = _turned_on(values)
        same_dimension = np.ravel(
            [other.values_to_draw for other in ones if other.dimension == entry.dimension]
        )
        lines = {ALL: (theta, values, analysis.motion.figures(entry.values_to_draw))}
        panel = compared(x, "", entry.dimension, lines, extent=same_dimension)
        panels.append(replace(panel, title=replace(panel.y, label=entry.label()).text))
    labels = [item.label() for item in ones]
    text = title(analysis, what or say(", ").join(labels))
    caption = caption or ", ".join(labels)
    return Chart(name, analysis.machine.title, text, tuple(panels), caption=caption)


def _steady(values: Array) -> Array:
    """Values (N,), or their mean where they swing by rounding alone."""
    swing, most = float(np.ptp(values)), float(np.max(np.abs(values)))
    return np.full_like(values, np.mean(values)) if swing <= STEADY * most else values


def _turned_on(values: Array) -> Array:
    """Angles over a cycle and the first again, (N + 1,), of a link that turns on by its turns."""
    turns = np.round((values[-2] - values[-1]) / (2 * np.pi))
    return np.append(values[:-1], values[-1] + 2 * np.pi * turns)


def kinematics(analysis: Analysis) -> Iterator[Chart]:
    """Motion of every slider, link and moving point, and all transmission angles."""
    yield from _each(analysis, "sliders")
    angles = [output.name for output in analysis.outputs if output.group == "transmission"]
    if angles:
        what = say("Transmission angles")
        yield outputs_chart(analysis, angles, kinematics_named("transmission"), what, KINEMATICS)
    yield from _each(analysis, "links")
    yield from _each(analysis, "points")


def main_kinematics(analysis: Analysis) -> list[Chart]:
    """The main charts: of sliders, or driven links, on the frame; transmission angles."""
    wanted = guided(analysis.machine) or pinned(analysis.machine)[:MOST_LINKS]
    names = {kinematics_named("transmission"), *map(kinematics_named, wanted)}
    return [chart for chart in kinematics(analysis) if chart.name in names]


def _each(analysis: Analysis, group: str) -> Iterator[Chart]:
    """A chart of each member of a group, with components of vectors but without magnitudes."""
    members: dict[str, list[AnalysisOutput]] = {}
    still = analysis.machine.frame if group == "points" else ()
    for output in analysis.outputs:
        if output.group == group and output.declared.array and output.item not in still:
            members.setdefault(output.item, []).append(output)
    for item, ones in members.items():
        what = say("Motion of {name}", name=short(joint_named(item), 24))
        names = [output.name for output in ones]
        yield outputs_chart(analysis, names, kinematics_named(item), what, KINEMATICS)


def kinematics_named(item: str) -> str:
    """Name of the chart of a slider, link or point."""
    return f"kinematics-{item.translate(FORBIDDEN)}"


# -- couplings -------------------------------------------------------------------------------------


def coupling_ratios(analysis: Analysis) -> Iterator[Chart]:
    """Of each coupling whose ratio varies, such as ``gears-DRIVEN``; none where planting has its
    own, and none where the driver stands still on its carrier at some crank angle.
    """
    if analysis.machine.planting is not None:
        return
    for item in analysis.machine.couplings:
        if not item.varies:
            continue
        driver, driven = (_rate(analysis, item, link) for link in (item.driver, item.driven))
        if np.all(driver != 0):
            names = {"link": short(item.driven, 16), "drive": short(item.driver, 16)}
            label = say("angular velocity ratio, {link} / {drive}", **names)
            signal = {ALL: with_figures(analysis, driven / driver)}
            panel = compared(angle_axis(analysis), label, None, signal)
            what = say("Speed ratio relative to the carrier")
            name = f"{item.list_name}-{item.driven.translate(FORBIDDEN)}"
            caption = to_say("Speed ratio over crank angle.")
            yield Chart(
                name, analysis.machine.title, title(analysis, what), (panel,), caption=caption
            )


def _rate(analysis: Analysis, coupling: Coupling, link: str) -> np.ndarray:
    """How a link turns on the coupling's carrier, by crank angle (N,)."""
    links = analysis.motion.links
    link_rate, carrier = (
        0.0 if item == FRAME else links[item].angle_1 for item in (link, coupling.carrier)
    )
    return np.asarray(link_rate - carrier + 0.0 * analysis.crank_angle)


def coupling_curves(analysis: Analysis) -> Iterator[Chart]:
    """Outputs of couplings that have a picture, such as both strands of a belt: ``belt-DRIVEN``."""
    for item in analysis.machine.couplings:
        if item.curves is not None:
            outputs, what, caption = item.curves
            names = [f"{item.list_name}.{item.name}.{output}" for output in outputs]
            name = f"{item.noun.replace(' ', '-')}-{item.driven.translate(FORBIDDEN)}"
            yield outputs_chart(analysis, names, name, say(what), caption)
