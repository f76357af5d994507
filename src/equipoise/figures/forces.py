"""Charts of forces: of a machine on its frame and of its drive, over crank angle, polar and by
order; and in the joints.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.chart_parts import (
    ALL,
    ROOM,
    SINGLE,
    about,
    angle_axis,
    compared,
    degrees_text,
    each,
    extent,
    extremes,
    extremes_of,
    groups,
    numbered_angles,
    numbers,
    over,
    rounding,
    row_keys,
    settled,
    size_of,
    title,
    with_figures,
    without_empty,
)
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.dynamics.reactions import JointForce, SliderForce
from equipoise.mechanism.outputs.declared import body_named, joint_named
from equipoise.quantities import Dimension
from equipoise.results.analysis_blocks import display_of_totals
from equipoise.results.charts import Arrow, Axis, Bars, Chart, Curve, Line, Mark, Panel
from equipoise.results.joint_blocks import contact_named, display_of_joints
from equipoise.results.outputs import CAUSES, output_named
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics.forces import Forces
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.results.analysis import Analysis


ALIKE = 1e-6
"""Over the peak: a force whose size varies by less has none."""
RESIDUE = 1e-9
"""Over the largest value: what is less is rounding."""
FEWEST, BAR_WIDE, MOST_NUMBERED = 6, 0.72, {False: 12, True: 7}
"""Orders that are drawn at least; width of the bars of an order; orders up to which bars are
numbered, of one kind or of two."""


PanelSignals = tuple[str, Dimension | None, Mapping[str, Array]]
"""Label and dimension of some signals, and these by role, (N,), SI units."""


# -- over crank angle ------------------------------------------------------------------------------


def over_crank(
    analysis: Analysis,
    name: str,
    what: str,
    panels: Sequence[PanelSignals],
    output: str = "",
    caption: str = "",
) -> Chart:
    """Signals over crank angle, below each other.

    panels : what is in each.  output : of frame or drive, whose unit they have.
    """
    x = angle_axis(analysis)
    unit = _unit(analysis, output)
    every = [(dimension, [*signals.values()]) for _, dimension, signals in panels]
    result = [
        compared(
            x,
            label,
            dimension,
            {role: with_figures(analysis, values) for role, values in signals.items()},
            extent=np.concatenate(
                [v for item, values in every if item == dimension for v in values]
            ),
            low=0.0 if label == say("magnitude") else None,
            unit=unit,
        )
        for label, dimension, signals in panels
    ]
    keys = row_keys(analysis)
    return Chart(name, analysis.machine.title, what, tuple(result), keys=keys, caption=caption)


def _unit(analysis: Analysis, output: str) -> str | None:
    """The unit of an output of frame or drive, as tables and sentences have it."""
    if not output or not analysis.has_forces:
        return None
    return display_of_totals(analysis, output).unit


def force(analysis: Analysis) -> Chart:
    """Both components of the shaking force and its size over crank angle."""
    analysis = analysis.resolved
    result = each(analysis, "shaking_force")
    parts: dict[str, Callable[[Array], Array]] = {
        say("along {axis}", axis="x"): np.real,
        say("along {axis}", axis="y"): np.imag,
        say("magnitude"): np.abs,
    }
    panels: list[PanelSignals] = [
        (label, "force", {role: part(values) for role, values in result.items()})
        for label, part in parts.items()
    ]
    what = title(analysis, say("Shaking force"))
    caption = to_say("Shaking force over crank angle.")
    return over_crank(analysis, "force", what, panels, "shaking_force", caption)


def moment(analysis: Analysis) -> Chart:
    """Shaking moment over crank angle, and of links beside each other rocking moments."""
    analysis = analysis.resolved
    what = title(analysis, say("Shaking moment about {point}", point=about(analysis)))
    signals = each(analysis, "shaking_moment")
    panels: list[PanelSignals] = [(say("shaking moment"), "torque", signals)]
    if analysis.machine.has_planes:
        rocking, role = (
            analysis.forces.across.rocking_moment,
            SINGLE if analysis.rows_total else ALL,
        )
        parts = {f"rocking_moment.{axis}": getattr(rocking, axis) for axis in "xy"}
        least = rounding(analysis)[1]
        panels += [
            (output_named(name), "torque", {role: settled(values, least)})
            for name, values in parts.items()
        ]
    caption = to_say("Shaking moment over crank angle.")
    return over_crank(analysis, "moment", what, panels, "shaking_moment", caption)


def torques(analysis: Analysis) -> Iterator[Chart]:
    """What each drive exerts over crank angle: ``torque``, and of further ones ``torque-2``, ..."""
    for number in range(1, len(analysis.machine.driven) + 1):
        yield torque(analysis, number)


def torque(analysis: Analysis, number: int = 1) -> Chart:
    """What a drive exerts over crank angle, a torque or a force, and below it what makes it."""
    analysis = analysis.resolved
    machine, drive = analysis.machine, analysis.machine.driven[number - 1]
    if number == 1:
        output, signals = machine.drive.effort, each(analysis, machine.drive.effort)
    else:  # of one row
        output = f"drives.{drive.link}.{drive.effort_in}"
        signals = {ALL: analysis.outputs[output].values_to_draw}
    link = short(drive.link, 16)
    of_torque = say("Torque of the drive on {link}", link=link)
    of_force = say("Force of the drive on {link}", link=link)
    what = title(analysis, of_force if drive.pushes else of_torque)
    name = "torque" if number == 1 else f"torque-{number}"
    panels = [(output_named(output), drive.effort_in, signals)]
    chart = over_crank(analysis, name, what, panels, output)
    (whole,) = chart.panels
    if analysis.motion.whole_cycle:
        whole = with_mean(whole, signals[ALL], analysis.motion)
    causes = _causes(analysis, output, drive.effort_in)
    caption = to_say("Drive torque over crank angle, and what it is for.")
    if drive.pushes:
        caption = to_say("Drive force over crank angle, and what it is for.")
    return replace(chart, panels=(whole, causes), caption=caption)


def with_mean(panel: Panel, values: Array, motion: Motion) -> Panel:
    """A panel with a dashed line at the mean of a signal (N,) of a motion, and its value above."""
    mean = float(motion.mean(values))
    if abs(mean) <= RESIDUE * float(np.max(np.abs(values))):
        mean = 0.0
    rms = float(np.sqrt(motion.mean(np.square(values))))
    text = {"mean": panel.y.quantity(mean), "rms": panel.y.quantity(rms)}
    remark = say("dashed: mean {mean}; RMS {rms}", **text)
    return replace(panel, lines=(Line(mean, "mean", axis="y"),), remark=remark)


def _causes(analysis: Analysis, output: str, kind: Dimension) -> Panel:
    """What each cause that there is adds to what a drive exerts; of one row."""
    parts = analysis.forces.split.by_cause(output)
    largest = max(float(np.max(np.abs(part))) for part in parts.values())
    curves = [
        Curve(*over(analysis, parts[name]), say(CAUSES[name]), f"several {number}")
        for number, name in enumerate(parts, 1)
        if np.max(np.abs(parts[name])) > RESIDUE * largest
    ]
    if not curves:
        curves = [Curve(*over(analysis, 0 * analysis.crank_angle))]
    every = np.concatenate([curve.y for curve in curves])
    unit = display_of_totals(analysis, output).unit
    y = Axis.of(say("by cause"), kind, every, unit, room=ROOM / 2)
    remark = say("of one row") if analysis.rows_total else ""
    return Panel(angle_axis(analysis), y, tuple(curves), title=remark, keyed=True)


# -- polar -----------------------------------------------------------------------------------------


def polar(analysis: Analysis) -> Chart:
    """Shaking force as a polar diagram, with crank angles along it, its peak and mean size."""
    result = each(analysis, "shaking_force")
    resolved = analysis.resolved
    every = np.concatenate([*result.values()])
    unit = display_of_totals(analysis, "shaking_force").unit
    x, y = (
        Axis.of(say("shaking force along {axis}", axis=axis), "force", every, unit)
        for axis in ("x", "y")
    )
    whole = each(resolved, "shaking_force")
    marks, curves, arrows, message = _size_marks(resolved, whole[ALL], x)
    if analysis.motion.whole_cycle:
        counts = numbered_angles(analysis.crank_angle)
        for role, values in reversed([*result.items()]):
            marks += numbers(counts, values, role, extent(every, np.zeros(1)))
    lines = [Curve.of(over(resolved, values)[1], "", role) for role, values in whole.items()]
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
    caption = to_say("Shaking force as a polar diagram: the end of its arrow over the cycle.")
    keys = row_keys(analysis)
    return Chart("polar", analysis.machine.title, what, (panel,), keys=keys, caption=caption)


def _size_marks(
    analysis: Analysis, values: Array, axis: Axis
) -> tuple[list[Mark], list[Curve], tuple[Arrow, ...], str]:
    """Marks, curves and arrows of a hodograph's peak and mean size; a message where it is zero."""
    sizes = np.abs(values)
    figures = analysis.motion.figures(sizes)
    theta, values = over(analysis, values)
    if not figures.peak:
        return [], [], (), say("zero at every crank angle")
    direction = np.interp(figures.peak_at, theta, np.unwrap(np.angle(values)))
    peak = figures.peak * complex(np.exp(1j * direction))
    circle = figures.mean * np.exp(1j * np.radians(np.arange(0, 361, 2)))
    marks: list[Mark] = []
    arrows: tuple[Arrow, ...] = ()

    def add_mark(place: complex, text: str, role: str) -> None:
        marks.append(Mark.of(place, text, role, float(np.degrees(np.angle(place))), sign=False))

    if figures.peak_to_peak > ALIKE * figures.peak:
        arrows = (Arrow(0j, peak, "stress"),)
        at = degrees_text(figures.peak_at)
        text = say("peak {value} at {angle}", value=axis.quantity(abs(peak)), angle=at)
        add_mark(peak, text, "stress")
    away = figures.mean * complex(np.exp(1j * (np.angle(peak) + 2.4)))
    add_mark(away, say("mean magnitude {value}", value=axis.quantity(figures.mean)), "mean size")
    return marks, [Curve.of(circle, "", "mean size")], arrows, ""


# -- orders ----------------------------------------------------------------------------------------


def spectrum(analysis: Analysis) -> Chart:
    """Amplitudes of the orders of shaking force, shaking moment and drive torque.

    Raises
    ------
    UsageError : the crank angles are too few, or not equally spaced over the whole cycle.
    """
    _ = analysis.by_order  # raises where there are none
    analysis = analysis.resolved
    vector = each(analysis, "shaking_force")
    signals: list[PanelSignals] = [
        (
            say("shaking force along {axis}", axis=axis),
            "force",
            {role: part(values) for role, values in vector.items()},
        )
        for axis, part in (("x", np.real), ("y", np.imag))
    ]
    about_point = say("shaking moment about {point}", point=about(analysis))
    signals.append((about_point, "torque", each(analysis, "shaking_moment")))
    drive = analysis.machine.drive
    signals.append((output_named(drive.effort), drive.effort_in, each(analysis, drive.effort)))
    read = [
        {BAR_ROLES[role]: orders_of(values, analysis.motion) for role, values in by.items()}
        for _, _, by in signals
    ]
    last = max(FEWEST, *(last_order(bars) for bars in read))
    most = MOST_NUMBERED[bool(analysis.rows_total)]
    units = [_unit(analysis, "shaking_force")] * 2 + [None, None]  # both components in one unit
    panels, notes = without_empty(
        order_panel(text, dimension, bars, last, most, unit)
        for (text, dimension, _), bars, unit in zip(signals, read, units, strict=True)
    )
    what = title(analysis, say("Amplitude of each order"))
    keys = tuple((BAR_ROLES[role], name) for role, name in row_keys(analysis))
    caption = to_say("Shaking force, shaking moment and drive torque by orders of the crank angle.")
    if drive.pushes:
        caption = to_say(
            "Shaking force, shaking moment and drive force by orders of the crank angle."
        )
    return Chart(
        "spectrum", analysis.machine.title, what, panels, keys=keys, words=notes, caption=caption
    )


BAR_ROLES = {SINGLE: "bar before", ALL: "bar after"}
OrderSizes = Mapping[str, tuple[Array, Array]]
"""Role -> orders, and the size of each in SI units; of the mean with its sign."""
MATTERS, VISIBLE, ROOM_BELOW = 0.01, 0.004, 1.1
"""Over the largest amplitude: above this an order is drawn; below this a bar cannot be seen.
Over a mean below 0: where its axis begins, with some room.
"""
LEAST, MOST, MOST_WITH_NUMBERS = 4, 12, 8
"""Orders that are drawn at least and at most; places on the axis up to which bars have numbers."""


def orders_of(values: Array, motion: Motion) -> tuple[Array, Array]:
    """Orders of a signal (N,) of a motion, and their sizes, of the mean with its sign."""
    signal = motion.periodic(values)
    return signal.orders, np.append(signal.amplitudes[:1].real, signal.sizes[1:])


def largest_order(read: OrderSizes) -> float:
    """The largest size of an order."""
    return max(float(np.max(np.abs(sizes))) for _, sizes in read.values())


def last_order(read: OrderSizes) -> int:
    """Up to where orders matter, a whole number."""
    largest = largest_order(read)
    last = max(
        float(np.max(orders[sizes > MATTERS * largest], initial=0.0))
        for orders, sizes in read.values()
    )
    return int(min(max(np.ceil(last), LEAST), MOST))


def order_panel(
    name: str,
    dimension: Dimension | None,
    read: OrderSizes,
    last: int,
    most_with_numbers: int = MOST_WITH_NUMBERS,
    unit: str | None = None,
) -> Panel:
    """Bars beside each other for each order up to the last; numbers at them where there is room.

    The bar of a mean below 0 goes down.

    unit : as of `Axis.of`.
    """
    largest = largest_order(read)
    finest = _finest(read, VISIBLE * largest)
    wide = BAR_WIDE * finest / len(read)
    bars = []
    # A mean that is rounding goes neither up nor down, and takes no room below.
    read = {role: (orders, np.where(np.abs(sizes) > VISIBLE * largest, sizes, np.abs(sizes)))
            for role, (orders, sizes) in read.items()}  # fmt: skip
    for number, (role, (orders, sizes)) in enumerate(read.items()):
        visible = (orders <= last) & np.isclose(np.mod(orders / finest + 0.5, 1), 0.5)
        at = orders[visible] + (number - (len(read) - 1) / 2) * wide
        with_numbers = last / finest <= most_with_numbers
        bars.append(Bars(at, sizes[visible], wide, role, labelled=with_numbers))
    ticks = tuple((float(k), f"{k}" if k else say("mean")) for k in range(last + 1))
    label, room = say("order: events in one turn of the crank"), 0.7 * finest
    x = Axis(label, low=-room, high=last + room, ticks=ticks)
    every = np.concatenate([sizes for _, sizes in read.values()])
    low = ROOM_BELOW * float(np.min(every, initial=0.0))
    y = Axis.of(say("amplitude"), dimension, every, unit, low=low, room=0.2)
    message = "" if largest else say("zero at every order")
    return Panel(x, y, bars=tuple(bars), title=name, message=message)


def _finest(read: OrderSizes, least: float) -> float:
    """Distance of orders: less than 1 where a period of several turns leaves any between."""
    for orders, sizes in read.values():
        if np.any(sizes[np.mod(orders, 1) > 0] > least):
            return float(orders[1])
    return 1.0


# -- joints ----------------------------------------------------------------------------------------

LEAST_FORCE = 1e-10
"""Over the largest force in a joint, and that at the length of the machine: less is rounding."""
IN_LINE, MOST_SQUARES = 3, 9
"""Squares side by side, and in one picture."""


@dataclass(frozen=True, eq=False)
class JointCurve:
    """A force (complex) or a couple (real) in a joint, (N,), SI units, and its name in words."""

    label: str
    values: Array

    @property
    def couple(self) -> bool:
        """Whether it is one."""
        return not np.iscomplexobj(self.values)


def joints_of(analysis: Analysis) -> dict[str, JointCurve]:
    """Every joint, coupling and bearing; of a slider its couple too; rounding as zeros."""
    joint_curves, forces = {}, analysis.forces
    every = forces.solved.contacts
    largest = max((float(np.max(joint.size)) for joint in every.values()), default=0.0)
    force, moment = LEAST_FORCE * largest, LEAST_FORCE * largest * size_of(analysis)
    for name, joint in every.items():
        joint_curves[name] = JointCurve(named(forces, name, joint), settled(joint.value, force))
        if isinstance(joint, SliderForce):
            on = short(body_named(joint.on))
            text = say("{name}: couple on {on}", name=short(joint_named(name)), on=on)
            joint_curves[f"{name}.moment"] = JointCurve(text, settled(joint.moment, moment))
    for name in analysis.machine.bearings:
        value = forces.across.bearings[name].value
        joint_curves[f"bearings.{name}"] = JointCurve(
            say("bearing {name}", name=short(name)), value
        )
    return joint_curves


def named(forces: Forces, name: str, joint: JointForce) -> str:
    """Name of a joint, and which body acts on which; names made of these are not said twice."""
    bodies = {"on": short(body_named(joint.on)), "by": short(body_named(joint.by))}
    if name not in forces.joints:
        what = contact_named(forces, name)
        return say("{name}: {by} on {on}", name=what, **bodies)
    if name in (f"{joint.by} on {joint.on}", f"{joint.on} on {joint.by}"):
        return say("slider: {by} on {on}", **bodies)
    return say("{name}: {by} on {on}", name=short(joint_named(name)), **bodies)


def joints(analysis: Analysis) -> Iterator[Chart]:
    """Size of the force in every joint over crank angle, ten in a picture."""
    analysis = analysis.resolved
    result = joints_of(analysis)
    every = list(result)
    for suffix, names, which in groups(every, columns=2):
        what = title(analysis, say("Force in each joint") + which, "", True)
        panels, words = without_empty(
            _over_angle(analysis, result[name], result.values()) for name in names
        )
        own = f"joints{suffix}"
        caption = to_say("Forces in the joints over crank angle.")
        yield Chart(own, analysis.machine.title, what, panels, 2, words=words, caption=caption)


def _over_angle(analysis: Analysis, joint: JointCurve, every: Iterable[JointCurve]) -> Panel:
    """One of several joints, whose forces have one unit."""
    same_kind = np.concatenate([item.values for item in every if item.couple == joint.couple])
    if joint.couple:
        values, most = joint.values, 2
        y = Axis.of(say("couple"), "torque", same_kind, room=ROOM)
    else:
        values, most = np.abs(joint.values), 1
        unit = display_of_joints(analysis).unit
        y = Axis.of(say("force"), "force", same_kind, unit, low=0.0, room=ROOM)
    places = extremes_of(analysis.motion.figures(values))[:most]
    return Panel(
        angle_axis(analysis),
        y,
        (Curve(*over(analysis, values)),),
        extremes(y, values, places, "main"),
        title=joint.label,
        message="" if np.any(values) else say("zero at every crank angle"),
        height=74.0,
    )


def joint_polars(analysis: Analysis) -> Iterator[Chart]:
    """The end of the arrow of every joint force, in the frame's axes, nine in a picture."""
    by_name = {name: joint for name, joint in joints_of(analysis).items() if not joint.couple}
    every, unit = list(by_name), display_of_joints(analysis).unit
    in_line = 2 if len(every) == 4 else min(len(every), IN_LINE)
    for suffix, names, which in groups(every, MOST_SQUARES, in_line):
        axis = Axis.of("", "force", np.concatenate([by_name[name].values for name in names]), unit)
        what = say("Force in each joint along x and y") + which
        remark = say("in {unit}; numbers: crank angle, deg", unit=axis.unit_name)
        text = title(analysis, what, remark, of_one=True)
        panels = tuple(_square(analysis, by_name[name], axis) for name in names)
        own = f"joint-polars{suffix}"
        caption = to_say("Forces in the joints as polar diagrams: the ends of their arrows.")
        yield Chart(own, analysis.machine.title, text, panels, in_line, False, caption=caption)


def _square(analysis: Analysis, joint: JointCurve, axis: Axis) -> Panel:
    values = joint.values
    marks: tuple[Mark, ...] = ()
    if analysis.motion.whole_cycle:
        size = extent(values, np.zeros(1))
        marks = numbers(numbered_angles(analysis.crank_angle), values, "all", size)
    curve = Curve.of(over(analysis, values)[1], "", "thin")
    return Panel(axis, axis, (curve,), marks, title=joint.label, equal=True, rings=True)
