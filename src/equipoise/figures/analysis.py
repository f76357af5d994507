"""The charts of an analysis: paths and hodographs of points, shaking force and moment, torque."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.crank import (
    ROOM,
    angle_step,
    closed,
    compared,
    crank_axis,
    degrees_told,
    extent,
    numbers,
    told_angles,
    told_speed,
)
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.kernels import cross
from equipoise.quantities import Dimension
from equipoise.results.analysis import LEAST_ANGLES
from equipoise.results.charts import (
    DEGREES,
    Arrow,
    Axis,
    Bars,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    shown,
)
from equipoise.results.naming import CAUSES
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.mechanism.motion import Motion
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

MM = 1000.0
ONE, ALL = "one", "all"
"""Roles of one row, and of all of them together."""
NOTHING = 1e-11
"""Over what each link needs: less is rounding."""
RESIDUE = 1e-9
"""Over the largest value: what is less is rounding."""
ALIKE = 1e-6
"""Over the peak: a force whose size varies by less has none."""
STILL = 1e-9
"""Over the motion of what moves most: what is less stands still."""
MOST_POINTS, MOST_VECTORS = 4, 3
"""Points that are followed in one picture: their paths, and their hodographs."""
FEW = (0, 90)
"""Crank angles, deg, that are told on the hodographs of several points."""
FEWEST, BAR_WIDE, MOST_NUMBERED = 6, 0.72, {False: 12, True: 7}
"""Orders that are drawn at least; width of the bars of an order; orders up to which bars are
numbered, of one kind or of two."""


def has_orders(analysis: Analysis) -> bool:
    """Whether `spectrum` can be drawn."""
    motion = analysis.motion
    enough = len(motion.crank_angle) >= LEAST_ANGLES * motion.turns
    return analysis.solved is not None and motion.whole_cycle and enough


# -- words and samples -----------------------------------------------------------------------------


def title(analysis: Analysis, what: str, remark: str = "", of_one: bool = False) -> str:
    """What is shown, at which speed, and a remark.

    of_one : whether it is of one row where there are several.
    """
    values = {"what": what, "speed": told_speed(analysis.motion.speed)}
    if of_one and len(analysis.machine.rows) > 1:
        told = say("{what} of one row, at {speed}", **values)
    else:
        told = say("{what}, at {speed}", **values)
    return f"{told}; {remark}" if remark else told


def about(analysis: Analysis) -> str:
    """The point about which moments are taken, in words."""
    pole = analysis.forces.about
    for name, place in analysis.machine.frame.items():
        if complex(*place) == pole:
            return short(name)
    return f"({shown(MM * pole.real)} mm, {shown(MM * pole.imag)} mm)"


def over(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    """Crank angles (rad) and values (N,), of a whole cycle with the first of them again."""
    if not analysis.motion.whole_cycle:
        return analysis.crank_angle, values
    return closed(analysis.crank_angle, values, 2 * np.pi * analysis.motion.turns)


def angle_axis(analysis: Analysis) -> Axis:
    """The x axis: the whole cycle, or the crank angles there are."""
    motion = analysis.motion
    axis = crank_axis(short(motion.machine.drive.link, 16), motion.speed, motion.turns)
    if motion.whole_cycle:
        return axis
    low, high = (float(f(motion.crank_angle)) for f in (np.min, np.max))
    return Axis(axis.label, DEGREES, "crank", low, high if high > low else low + 0.02)


# -- rows ------------------------------------------------------------------------------------------


def has_rows(analysis: Analysis) -> bool:
    """Whether all rows together differ from one, and can be told."""
    return len(analysis.machine.rows) > 1 and analysis.motion.whole_cycle


def outputs(analysis: Analysis) -> dict[str, Array]:
    """Shaking force (complex), shaking moment and drive torque, (N,), of one row."""
    found = analysis.forces
    whole = {
        "shaking_force": found.shaking_force.value,
        "shaking_moment": found.shaking_moment,
        "drive_torque": found.drive_torque,
    }
    return _settled(analysis, whole)


def together(analysis: Analysis) -> dict[str, Array]:
    """The same of all rows, each with its crank ahead by its phase."""
    found = outputs(analysis)
    count = len(analysis.crank_angle)
    force, moment, torque = found.values()
    one = Periodic.of(np.array([force.real, force.imag, moment, torque]), analysis.motion.turns)
    whole = np.zeros((4, count))
    for row in analysis.machine.rows:
        values = one.shifted(row.phase).samples(count)
        values[2] += cross(complex(*row.offset), values[0] + 1j * values[1])
        whole += values
    summed = (whole[0] + 1j * whole[1], whole[2], whole[3])
    return _settled(analysis, dict(zip(found, summed, strict=True)))


def _settled(analysis: Analysis, found: dict[str, Array]) -> dict[str, Array]:
    """Zeros where nothing but rounding is left beside what each link needs."""
    force, moment = rounding(analysis)
    return {
        name: settled(values, force if name == "shaking_force" else moment)
        for name, values in found.items()
    }


def settled(values: Array, least: float) -> Array:
    """Values (N,), or zeros where none is larger than what is told as rounding."""
    return values if float(np.max(np.abs(values), initial=0.0)) > least else 0 * values


def rounding(analysis: Analysis) -> tuple[float, float]:
    """Force (N) and moment (N m) that are rounding beside what each link needs."""
    forces = analysis.forces
    demands = [
        demand
        for cause in (forces.inertia, forces.weights, forces.loads, forces.springs)
        for demand in cause.values()
    ]
    force = max(float(np.max(np.abs(demand))) for demand, _ in demands)
    moment = force * size_of(analysis)
    moment += max(float(np.max(np.abs(demand))) for _, demand in demands)
    return NOTHING * force, NOTHING * moment


def size_of(analysis: Analysis) -> float:
    """Diagonal of the box that holds every point all the time, m."""
    every = np.concatenate([point.place for point in analysis.motion.points.values()])
    return abs(complex(np.ptp(every.real), np.ptp(every.imag)))


def each(analysis: Analysis, output: str) -> Mapping[str, Array]:
    """An output of one row and, where there are several, of all together, by role."""
    one = outputs(analysis)[output]
    return {ONE: one, ALL: together(analysis)[output]} if has_rows(analysis) else {ALL: one}


def row_keys(analysis: Analysis) -> tuple[tuple[str, str], ...]:
    """What the two lines are, for a legend; nothing where there is one."""
    if not has_rows(analysis):
        return ()
    count = len(analysis.machine.rows)
    return (ONE, say("one row")), (ALL, say("all {count} rows", count=count))


# -- over crank angle ------------------------------------------------------------------------------


def over_crank(
    analysis: Analysis,
    name: str,
    what: str,
    panels: Sequence[tuple[str, Dimension | None, Mapping[str, Array]]],
    **rest: Any,
) -> Chart:
    """Signals over crank angle, below each other.

    panels : label and dimension of each, and its signals (N,) by role, SI units.
    """
    x = angle_axis(analysis)
    drawn = [
        compared(
            x,
            label,
            dimension,
            {role: over(analysis, values) for role, values in signals.items()},
            angles=len(panels) < 3,
            low=0.0 if label == say("size") else None,
        )
        for label, dimension, signals in panels
    ]
    return Chart(name, analysis.machine.title, what, tuple(drawn), keys=row_keys(analysis), **rest)


def force(analysis: Analysis) -> Chart:
    """Both components of the shaking force and its size over crank angle."""
    found = each(analysis, "shaking_force")
    parts: dict[str, Callable[[Array], Array]] = {
        say("along {axis}", axis="x"): np.real,
        say("along {axis}", axis="y"): np.imag,
        say("size"): np.abs,
    }
    return over_crank(
        analysis,
        "force",
        title(analysis, say("Shaking force")),
        [
            (label, "force", {role: part(values) for role, values in found.items()})
            for label, part in parts.items()
        ],
    )


def moment(analysis: Analysis) -> Chart:
    """Shaking moment over crank angle."""
    what = title(analysis, say("Shaking moment about {point}", point=about(analysis)))
    signals = each(analysis, "shaking_moment")
    return over_crank(analysis, "moment", what, [(say("shaking moment"), "torque", signals)])


def torque(analysis: Analysis) -> Chart:
    """Torque of the drive over crank angle, and below it what makes it."""
    signals = each(analysis, "drive_torque")
    drive = short(analysis.machine.drive.link, 16)
    what = title(analysis, say("Torque of the drive on {link}", link=drive))
    chart = over_crank(analysis, "torque", what, [(say("drive torque"), "torque", signals)])
    (whole,) = chart.panels
    if analysis.motion.whole_cycle:
        whole = with_mean(whole, signals[ALL])
    return Chart("torque", chart.title, what, (whole, _causes(analysis)), keys=chart.keys)


def with_mean(panel: Panel, values: Array) -> Panel:
    """A panel with a dashed line at the mean of a signal (N,), and its value above."""
    from dataclasses import replace

    mean = float(np.mean(values))
    if abs(mean) <= RESIDUE * float(np.max(np.abs(values))):
        mean = 0.0
    told = {
        "mean": panel.y.quantity(mean),
        "rms": panel.y.quantity(float(np.sqrt(np.mean(np.square(values))))),
    }
    remark = say("dashed: mean {mean}; RMS {rms}", **told)
    return replace(panel, lines=(Line(mean, "mean", axis="y"),), remark=remark)


def _causes(analysis: Analysis) -> Panel:
    """The torque of each cause that there is; of one row."""
    parts = analysis.forces.split.by_cause("drive_torque")
    largest = max(float(np.max(np.abs(part))) for part in parts.values())
    curves = [
        Curve(*over(analysis, parts[name]), say(CAUSES[name]), f"several {number}")
        for number, name in enumerate(CAUSES, 1)
        if np.max(np.abs(parts[name])) > RESIDUE * largest
    ]
    if not curves:
        curves = [Curve(*over(analysis, 0 * analysis.crank_angle))]
    every = np.concatenate([curve.y for curve in curves])
    y = Axis.of(say("by cause"), "torque", every, room=ROOM / 2)
    remark = say("of one row") if has_rows(analysis) else ""
    return Panel(angle_axis(analysis), y, tuple(curves), title=remark, keyed=True)


# -- polar -----------------------------------------------------------------------------------------


def polar(analysis: Analysis) -> Chart:
    """Shaking force as a polar diagram, with crank angles along it, its peak and mean size."""
    found = each(analysis, "shaking_force")
    every = np.concatenate([*found.values()])
    x, y = (
        Axis.of(say("shaking force along {axis}", axis=axis), "force", every) for axis in ("x", "y")
    )
    marks, curves, arrows, message = _told_sizes(analysis, found[ALL], x)
    if analysis.motion.whole_cycle:
        told = told_angles(analysis.crank_angle)
        for role, values in reversed([*found.items()]):
            marks += numbers(told, values, role, extent(every, np.zeros(1)))
    lines = [Curve(*_parts(over(analysis, values)[1]), "", role) for role, values in found.items()]
    panel = Panel(
        x,
        y,
        (*lines, *curves),
        tuple(marks),
        arrows=arrows,
        message=message,
        equal=True,
        rings=True,
    )
    what = title(analysis, say("Shaking force"), say("numbers: crank angle, deg"))
    return Chart("polar", analysis.machine.title, what, (panel,), keys=row_keys(analysis))


def _parts(places: Array) -> tuple[Array, Array]:
    return places.real, places.imag


def _told_sizes(
    analysis: Analysis, values: Array, axis: Axis
) -> tuple[list[Mark], list[Curve], tuple[Arrow, ...], str]:
    """An arrow to the peak and a circle of the mean size, with their values, or why not."""
    sizes = np.abs(values)
    k = int(np.argmax(sizes))
    if not sizes[k]:
        return [], [], (), say("zero at every crank angle")
    mean, peak = float(np.mean(sizes)), complex(values[k])
    circle = mean * np.exp(1j * np.radians(np.arange(0, 361, 2)))
    marks: list[Mark] = []
    arrows: tuple[Arrow, ...] = ()
    if np.ptp(sizes) > ALIKE * sizes[k]:
        arrows = (Arrow(0j, peak, "stress"),)
        at = degrees_told(float(analysis.crank_angle[k]))
        text = say("peak {value} at {angle}", value=axis.quantity(abs(peak)), angle=at)
        wish = float(np.degrees(np.angle(peak)))
        marks.append(Mark(peak.real, peak.imag, text, "stress", wish, sign=False))
    away = mean * complex(np.exp(1j * (np.angle(peak) + 2.4)))
    text = say("mean size {value}", value=axis.quantity(mean))
    wish = float(np.degrees(np.angle(away)))
    marks.append(Mark(away.real, away.imag, text, "mean size", wish, sign=False))
    return marks, [Curve(*_parts(circle), "", "mean size")], arrows, ""


# -- orders ----------------------------------------------------------------------------------------


def spectrum(analysis: Analysis) -> Chart:
    """Amplitudes of the orders of shaking force, shaking moment and drive torque.

    Raises
    ------
    UsageError : the crank angles are too few, or not equally spaced over the whole cycle.
    """
    _ = analysis.by_order  # raises where there are none
    vector = each(analysis, "shaking_force")
    signals: list[tuple[str, Dimension, Mapping[str, Array]]] = [
        (
            say("shaking force along {axis}", axis="x"),
            "force",
            {r: v.real for r, v in vector.items()},
        ),
        (
            say("shaking force along {axis}", axis="y"),
            "force",
            {r: v.imag for r, v in vector.items()},
        ),
        (
            say("shaking moment about {point}", point=about(analysis)),
            "torque",
            each(analysis, "shaking_moment"),
        ),
        (say("drive torque"), "torque", each(analysis, "drive_torque")),
    ]
    turns = analysis.motion.turns
    read = [
        (
            told,
            dimension,
            {BAR_ROLES[role]: orders_of(values, turns) for role, values in by.items()},
        )
        for told, dimension, by in signals
    ]
    last = max(FEWEST, *(last_order(bars) for _, _, bars in read))
    most = MOST_NUMBERED[has_rows(analysis)]
    panels = tuple(order_panel(told, dimension, bars, last, most) for told, dimension, bars in read)
    return Chart(
        "spectrum",
        analysis.machine.title,
        title(analysis, say("Amplitude of each order")),
        panels,
        keys=tuple((BAR_ROLES[role], name) for role, name in row_keys(analysis)),
    )


BAR_ROLES = {ONE: "bar before", ALL: "bar after"}
Read = Mapping[str, tuple[Array, Array]]
"""Role -> orders, and the size of each in SI units."""
MATTERS, VISIBLE = 0.01, 0.004
"""Over the largest amplitude: above this an order is drawn; below this a bar cannot be seen."""
LEAST, MOST, MOST_TOLD = 4, 12, 8
"""Orders that are drawn at least and at most; places on the axis up to which bars have numbers."""


def orders_of(values: Array, turns: int) -> tuple[Array, Array]:
    """Orders of a signal (N,) over so many turns, and their sizes."""
    signal = Periodic.of(values, turns)
    return signal.orders, signal.sizes


def last_order(read: Read) -> int:
    """Up to where orders matter, a whole number."""
    largest = max(float(np.max(sizes)) for _, sizes in read.values())
    last = max(
        float(np.max(orders[sizes > MATTERS * largest], initial=0.0))
        for orders, sizes in read.values()
    )
    return int(min(max(np.ceil(last), LEAST), MOST))


def order_panel(
    told: str, dimension: Dimension, read: Read, last: int, most_told: int = MOST_TOLD
) -> Panel:
    """Bars beside each other for each order up to the last; numbers at them where there is room."""
    largest = max(float(np.max(sizes)) for _, sizes in read.values())
    finest = _finest(read, VISIBLE * largest)
    wide = BAR_WIDE * finest / len(read)
    bars = []
    for number, (role, (orders, sizes)) in enumerate(read.items()):
        seen = (orders <= last) & np.isclose(np.mod(orders / finest + 0.5, 1), 0.5)
        at = orders[seen] + (number - (len(read) - 1) / 2) * wide
        told_too = last / finest <= most_told
        bars.append(Bars(at, sizes[seen], wide, role, told=told_too))
    ticks = tuple((float(k), f"{k}" if k else say("mean")) for k in range(last + 1))
    x = Axis(
        say("order: events in one turn of the crank"),
        low=-0.7 * finest,
        high=last + 0.7 * finest,
        ticks=ticks,
    )
    every = np.concatenate([sizes for _, sizes in read.values()])
    y = Axis.of(say("amplitude"), dimension, every, low=0.0, room=0.2)
    message = "" if largest else say("zero at every order")
    return Panel(x, y, bars=tuple(bars), title=told, message=message)


def _finest(read: Read, least: float) -> float:
    """Distance of orders: less than 1 where a period of several turns leaves any between."""
    for orders, sizes in read.values():
        if np.any(sizes[np.mod(orders, 1) > 0] > least):
            return float(orders[1])
    return 1.0


# -- points ----------------------------------------------------------------------------------------


def moving(motion: Motion) -> list[str]:
    """Points that do not stand still."""
    fastest = {name: float(np.max(np.abs(point.place_1))) for name, point in motion.points.items()}
    least = STILL * max(fastest.values())
    return [name for name, rate in fastest.items() if rate > least]


def traced(motion: Motion) -> list[str]:
    """Points with a path worth following: those of couplers, first those that are no joint.

    A point of a link that is pinned to the frame runs on a circle; these come only where a machine
    has no others, and those of the drive last of all.
    """
    machine, joints = motion.machine, motion.linkage.joints
    pinned = [link for link in machine.links.values() if set(link.points) & set(machine.frame)]
    circling = {point for link in pinned for point in link.points}
    names = moving(motion)
    driven = [name for name in names if name not in machine.links[machine.drive.link].points]
    found = [name for name in names if name not in circling] or driven or names
    return sorted(found, key=lambda name: name in joints.pins)


def followed(analysis: Analysis, points: Sequence[str] | None, most: int) -> list[str]:
    """The points that are asked for, or as many as a picture can hold."""
    return traced(analysis.motion)[:most] if points is None else [*points]


def curves(analysis: Analysis, points: Sequence[str] | None = None) -> Chart:
    """Paths of points of couplers, with dots after equal times; those of other points pale.

    points : names; where they are not given, some that are no joint of the frame's links.
    """
    motion = analysis.motion
    names = followed(analysis, points, MOST_POINTS)
    others = [name for name in moving(motion) if name not in names]
    frame = {name: complex(*place) for name, place in analysis.machine.frame.items()}
    every = [motion.points[name].place for name in (*names, *others)]
    size = extent(*every, np.array([*frame.values()]))
    drawn = [
        Curve(*_parts(over(analysis, motion.points[name].place)[1]), "", "faint") for name in others
    ]
    marks = [
        Mark(z.real, z.imag, short(name), "stand", 45.0, near=5.0, bold=True)
        for name, z in frame.items()
    ]
    arrows, dots = [], []
    for number, name in enumerate(names, 1):
        role, path = f"several {number}", motion.points[name].place
        label = say("path of {point}", point=short(name, 12))
        drawn.append(Curve(*_parts(over(analysis, path)[1]), label, role))
        arrows += _sense(analysis, name, role, size)
        if motion.whole_cycle:
            ways = np.arange(0, 360 * motion.turns, angle_step(motion.turns))
            at = np.round(ways * len(path) / (360 * motion.turns)).astype(int)
            dots += [Mark(float(z.real), float(z.imag), "", role) for z in path[at]]
    for name in (*names, *others):
        role = f"several {names.index(name) + 1}" if name in names else "lines"
        path = motion.points[name].place
        k = int(np.argmax((path * np.exp(-0.7j)).real))
        at_k = (float(path[k].real), float(path[k].imag))
        marks.append(Mark(*at_k, short(name), role, 40.0, sign=False, near=4.0, bold=True))
    if motion.whole_cycle:
        told = told_angles(motion.crank_angle)
        for number, name in enumerate(names, 1):
            path = motion.points[name].place
            dots += numbers(told, path, f"several {number}", size)
    x, y = (Axis.of(say("{axis} in the frame", axis=a), "length", every and size) for a in "xy")
    panel = Panel(
        x,
        y,
        tuple(drawn),
        (*marks, *dots),
        arrows=tuple(arrows),
        message="" if names else say("no point moves"),
        equal=True,
        zero=False,
    )
    keys = (("faint", say("other points")),) if others else ()
    return Chart("curves", analysis.machine.title, _told_dots(motion), (panel,), keys=keys)


def _told_dots(motion: Motion) -> str:
    """What is drawn, and after which time a dot comes."""
    if not motion.whole_cycle:
        return say("Paths of points, at {speed}", speed=told_speed(motion.speed))
    step = angle_step(motion.turns)
    values = {"step": step, "speed": told_speed(motion.speed)}
    if not motion.speed:
        return say("Paths of points; dots every {step}° of the crank", **values)
    values["time"] = shown(1000 * np.radians(step) / abs(motion.speed))
    return say("Paths of points; dots every {step}° = {time} ms, at {speed}", **values)


def _sense(analysis: Analysis, name: str, role: str, size: float) -> list[Arrow]:
    """The head of an arrow where the point is fastest."""
    point = analysis.motion.points[name]
    fastest = int(np.argmax(np.abs(point.place_1)))
    way = complex(point.place_1[fastest]) * float(np.sign(analysis.motion.speed))
    head = complex(point.place[fastest])
    return [Arrow(head - way / abs(way) * 0.02 * size, head, role)] if way else []


def hodograph(analysis: Analysis, points: Sequence[str] | None = None) -> Chart:
    """Ends of the arrows of velocity and acceleration of points.

    points : names; where they are not given, the same as of `curves`.
    """
    names = followed(analysis, points, MOST_VECTORS)
    every = [analysis.motion.points[name] for name in names]
    pairs: tuple[tuple[str, Dimension, list[Array]], ...] = (
        (VELOCITY, "speed", [point.velocity for point in every]),
        (ACCELERATION, "acceleration", [point.acceleration_vector for point in every]),
    )
    panels = []
    for what, dimension, values in pairs:
        whole = np.concatenate([*values, [0]])
        x, y = (
            Axis.of(say("{quantity} along {axis}", quantity=say(what), axis=axis), dimension, whole)
            for axis in ("x", "y")
        )
        marks: list[Mark] = [Mark(0.0, 0.0, "", "pivot")]
        drawn = []
        told: dict[int, int] = {}
        if analysis.motion.whole_cycle:
            told = told_angles(analysis.crank_angle)
            told = {a: k for a, k in told.items() if len(values) < 2 or a in FEW}
        for number, (name, one) in enumerate(zip(names, values, strict=True), 1):
            role = f"several {number}"
            drawn.append(Curve(*_parts(over(analysis, one)[1]), short(name, 14), role))
            marks += numbers(told, one, role, extent(whole))
        message = "" if names else say("no point moves")
        panels.append(Panel(x, y, tuple(drawn), tuple(marks), message=message, equal=True))
    told_what = title(
        analysis,
        say("Hodographs of velocity and acceleration"),
        say("numbers: crank angle, deg"),
        of_one=True,
    )
    return Chart(
        "hodograph", analysis.machine.title, told_what, tuple(panels), columns=2, stacked=False
    )


VELOCITY, ACCELERATION = to_say("velocity"), to_say("acceleration")
