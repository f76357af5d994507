"""What is drawn against crank angle: ratios, velocities, accelerations, torque, joint forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise import signals
from equipoise.i18n import say, to_say
from equipoise.mechanism.instants import largest, smallest
from equipoise.plotting.crank import Line, closed, crank_axis, crank_label, draw, mark
from equipoise.plotting.stay import event_lines, event_names, soil_shade
from equipoise.plotting.style import LINES, NORMAL, STRESS, blank, heading, short

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics import Forces, JointForce
    from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]

SHADED = to_say("shaded: tip in the soil")
AIR = (0, (4, 1.6))
"""Dashes of signals in the air."""
WIDTH, HEIGHT = 7.2, 3.6
LEFT, RIGHT, BOTTOM, TOP = 0.78, 0.2, 0.52, 0.92
"""Inches: the picture and its margins."""
HEAD, ROW, FOOT, BETWEEN = 0.55, 1.65, 0.34, 0.6
"""Inches: height of the heading, of a row of small axes, of the label below; between columns."""


def signal_figure(figures: PlantingFigures, what: str, label: str, lines: Sequence[Line]) -> Figure:
    """One pair of axes: signals against crank angle, with the stay in the soil."""
    figure = blank(WIDTH, HEIGHT)
    axes = figure.add_axes(
        (
            LEFT / WIDTH,
            BOTTOM / HEIGHT,
            1 - (LEFT + RIGHT) / WIDTH,
            1 - (BOTTOM + TOP) / HEIGHT,
        )
    )
    heading(figure, figures.machine.title, what, LEFT)
    crank_axis(axes, figures.curve.turns)
    axes.set_xlabel(_crank_label(figures))
    axes.set_ylabel(label)
    draw(axes, lines)
    soil_shade(figures, axes)
    event_names(figures, axes)
    mark(axes, lines, event_lines(figures, axes))
    if len(lines) > 1:
        figure.legend(
            handles=axes.get_lines()[: len(lines)],
            loc="upper right",
            bbox_to_anchor=(1 - RIGHT / WIDTH, 1 - 0.24 / HEIGHT),
            ncols=len(lines),
            borderaxespad=0,
        )
    return figure


def _crank_label(figures: PlantingFigures) -> str:
    return crank_label(figures.machine.drive.link, figures["speed"])


def ratio_figure(figures: PlantingFigures, link: str) -> Figure:
    """Angular velocity of a link over that of the drive."""
    curve = figures.curve
    rates = curve.family.rates(curve.grid.state, link)[0][0]
    theta, values = closed(curve.theta, rates, curve.period)
    marked = [
        (figures[f"ratio.{link}.{which}_at"], figures[f"ratio.{link}.{which}"])
        for which in ("max", "min")
    ]
    drive = figures.machine.drive.link
    return signal_figure(
        figures,
        say("Angular velocity of {link} over that of {drive}", link=short(link), drive=short(drive))
        + f"; {say(SHADED)}",
        say(
            "angular velocity ratio, {link} / {drive}",
            link=short(link, 14),
            drive=short(drive, 14),
        ),
        [Line(theta, values, marked=marked)],
    )


QUANTITIES = {
    "velocity": (
        to_say("Velocity of the tip {tip} relative to the machine"),
        to_say("velocity"),
        "m/s",
        "speed",
    ),
    "acceleration": (
        to_say("Acceleration of the tip {tip} relative to the machine"),
        to_say("acceleration"),
        "m/s²",
        "acceleration",
    ),
}
PARTS = {
    "": ("", ""),
    "-x": (to_say("part along x"), " x"),
    "-y": (to_say("part along y"), " y"),
}


def tip_figures(figures: PlantingFigures) -> Iterator[tuple[str, Figure]]:
    """Velocity and acceleration of the tip relative to the machine, and their parts."""
    for name, (title, label, unit, _) in QUANTITIES.items():
        for part, (told, suffix) in PARTS.items():
            line = tip_line(figures, name, part)
            what = say(title, tip=short(figures.planting.tip))
            what += f", {say(told)}" if told else ""
            axis = f"{say(label)}{suffix}, {unit}"
            yield name + part, signal_figure(figures, f"{what}; {say(SHADED)}", axis, [line])


def tip_line(figures: PlantingFigures, name: str, part: str = "") -> Line:
    """Velocity or acceleration of the tip, m/s or m/s2: its size, or its part "-x" or "-y"."""
    curve = figures.curve
    values = _component(_vector(figures, name, curve.theta[None]), part)[0]
    theta, values = closed(curve.theta, values, curve.period)
    return Line(theta, values, marked=tuple(_extremes(figures, name, part)))


def _extremes(figures: PlantingFigures, name: str, part: str) -> Iterator[tuple[float, float]]:
    """Crank angle and value of the largest and the smallest value."""
    if not part:
        key = QUANTITIES[name][3]
        for which in ("max", "min"):
            found = f"{which}_{key}"
            yield figures[f"{found}.crank_angle"], figures[f"{found}.value"]
        return

    def signal(theta: Array) -> Array:
        return _component(_vector(figures, name, theta), part)

    def slope(theta: Array) -> Array:
        return _component(_vector(figures, name, theta, 1), part)

    curve = figures.curve
    for find in (largest, smallest):
        value, at = find(signal, slope, curve.theta, signal(curve.grid.theta))
        yield float(np.mod(at[0], curve.period)), float(value[0])


def _vector(figures: PlantingFigures, name: str, theta: Array, order: int = 0) -> Array:
    """Velocity or acceleration of the tip, or its derivative by crank angle, (1, K), complex."""
    curve = figures.curve
    tip = curve.at(theta)
    rates = (tip.place_1, tip.place_2, curve.place_3(theta) if order and name != "velocity" else 0)
    if name == "velocity":
        velocity: Array = rates[order] * curve.speed
        return velocity
    change = figures.machine.drive.acceleration
    acceleration: Array = rates[order + 1] * curve.speed**2 + rates[order] * change
    return acceleration


def _component(vector: Array, part: str) -> Array:
    sizes: dict[str, Array] = {"": np.abs(vector), "-x": vector.real, "-y": vector.imag}
    return sizes[part]


def torque_figure(figures: PlantingFigures) -> Figure:
    """Torque that the drive has to give, in the air and in the soil."""
    found = figures.forces
    assert found is not None
    pair = (found.in_air.drive_torque, found.in_soil.drive_torque)
    lines = _air_and_soil(figures, *pair, both=True)
    drive = short(figures.machine.drive.link)
    what = f"{say('Torque of the drive on {link}', link=drive)}; {say(SHADED)}"
    return signal_figure(figures, what, say("drive torque, {unit}", unit="N m"), lines)


def _air_and_soil(
    figures: PlantingFigures, air: Array, soil: Array, both: bool = False
) -> list[Line]:
    assert figures.forces is not None
    angles = figures.forces.motion.crank_angle
    lines = []
    for name, values, color, dashes in (
        (say("in the air"), air, LINES, AIR),
        (say("in the soil"), soil, STRESS, "-"),
    ):
        told = signals.figures(angles, values)
        marked = [(told.max_at, told.max), (told.min_at, told.min)] if both else []
        if not both and values is soil:
            marked = [(told.max_at, told.max)]
        lines.append(
            Line(*closed(angles, values, figures.curve.period), name, color, dashes, marked)
        )
    return lines


def joints_figure(figures: PlantingFigures) -> Figure:
    """Size of the force in every joint, each with axes of its own."""
    found = figures.forces
    assert found is not None
    air, soil = _joints(found.in_air), _joints(found.in_soil)
    columns = min(2, len(air))
    figure = blank(WIDTH, HEAD + ceil(len(air) / columns) * ROW + FOOT)
    heading(figure, figures.machine.title, f"{say('Force in each joint')}; {say(SHADED)}", LEFT)
    for number, (name, joint) in enumerate(soil.items()):
        lines = _air_and_soil(figures, air[name].size, joint.size)
        axes = _small_axes(figure, divmod(number, columns), columns)
        axes.set_title(
            short(say("{name}: {by} on {on}", name=name, by=joint.by, on=joint.on), 44),
            fontsize=NORMAL,
            loc="left",
            pad=4,
        )
        crank_axis(axes, figures.curve.turns, most=8)
        draw(axes, lines, floor=0.0)
        soil_shade(figures, axes)
        mark(axes, lines, event_lines(figures, axes), angles=False)
    figure.text(
        (LEFT + WIDTH - RIGHT) / 2 / WIDTH,
        0.12 / figure.get_figheight(),
        _crank_label(figures),
        ha="center",
        fontsize=NORMAL,
    )
    figure.legend(
        handles=figure.axes[0].get_lines()[:2],
        loc="upper right",
        bbox_to_anchor=(1 - RIGHT / WIDTH, 1 - 0.26 / figure.get_figheight()),
        ncols=2,
        borderaxespad=0,
    )
    return figure


def _joints(forces: Forces) -> dict[str, JointForce]:
    return {**forces.joints, **forces.gears}


def _small_axes(figure: Figure, place: tuple[int, int], columns: int) -> Axes:
    """Axes in a row and column."""
    row, column = place
    height = figure.get_figheight()
    width = (WIDTH - LEFT - RIGHT - BETWEEN * (columns - 1)) / columns
    axes = figure.add_axes(
        (
            (LEFT + column * (width + BETWEEN)) / WIDTH,
            (height - HEAD - (row + 1) * ROW + 0.25) / height,
            width / WIDTH,
            (ROW - 0.53) / height,
        )
    )
    if column == 0:
        axes.set_ylabel(say("force, {unit}", unit="N"))
    return axes
