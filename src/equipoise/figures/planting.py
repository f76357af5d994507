"""The charts of a planting machine: ratios, motion of the tip, torque and joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.analysis import named
from equipoise.figures.chart_parts import (
    ROOM,
    by_name,
    closed,
    crank_axis,
    degrees_text,
    extremes,
    marks_at_extremes,
)
from equipoise.figures.points import FORBIDDEN
from equipoise.figures.style import free_name, short
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.tip import largest, smallest
from equipoise.quantities import Dimension
from equipoise.results.charts import Array, Axis, Band, Chart, Curve, Line, Mark, Panel, PlaceLabel

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

Extremes = Sequence[tuple[float, float]]

SHADED = to_say("shaded: tip in the soil")
EVENTS = {"entry": to_say("entry"), "lowest": to_say("lowest"), "exit": to_say("exit")}
QUANTITIES: dict[str, tuple[str, str, Dimension, str]] = {
    "velocity": (
        to_say("Velocity of the tip {tip} relative to the machine"),
        to_say("velocity"),
        "speed",
        "speed",
    ),
    "acceleration": (
        to_say("Acceleration of the tip {tip} relative to the machine"),
        to_say("acceleration"),
        "acceleration",
        "acceleration",
    ),
}
"""Name -> title, label, dimension, and what the figures call its size."""
PARTS = {
    "": ("", ""),
    "-x": (to_say("component along x"), " x"),
    "-y": (to_say("component along y"), " y"),
}


def charts(figures: PlantingFigures) -> dict[str, Chart]:
    """Every chart of a planting machine by name.

    ``ratio-LINK`` for each link but the drive; ``velocity``, ``velocity-x``, ``velocity-y`` and the
    same of ``acceleration``, for a further arm such as ``velocity-x-Q``; ``torque`` and ``joints``
    where there are forces in the soil.
    """
    result: dict[str, Chart] = {}
    for link in figures.machine.links:
        if link != figures.machine.drive.link:
            name = free_name(f"ratio-{link}", result)
            result[name] = ratio(figures, link).named(name)
    of_soil = (torque, joints) if figures.forces is not None else ()
    return result | by_name([*tips(figures), *(draw(figures) for draw in of_soil)])


# -- over crank angle, with the stay in the soil ---------------------------------------------------


def soil_spans(figures: PlantingFigures) -> list[tuple[float, float]]:
    """Stays in the soil as rising crank angles within one cycle, rad."""
    spans = []
    for visit in figures.visits:
        ends = (visit.entry, visit.exit)
        low, high = ends if figures["speed"] > 0 else ends[::-1]
        if low <= high:
            spans.append((low, high))
        else:
            spans += [(low, figures.curve.period), (0.0, high)]
    return spans


def stay_panel(
    figures: PlantingFigures,
    y: Axis,
    curves: Sequence[Curve],
    marks: Sequence[Mark],
    arms: Sequence[PlantingFigures] = (),
    **rest: Any,
) -> Panel:
    """Signals over crank angle, with the stay in the soil shaded and its events.

    arms : whose stays are shaded; where not given, the one of which the figures are.
    """
    spans = [span for arm in arms or [figures] for span in soil_spans(arm)]
    return Panel(
        crank_axis(figures.machine.drive.crank, figures["speed"], figures.curve.turns),
        y,
        tuple(curves),
        tuple(marks),
        tuple(Band(low, high, "soil") for low, high in spans),
        tuple(Line(figures[f"{name}.crank_angle"], name) for name in EVENTS),
        **rest,
    )


def _flags(figures: PlantingFigures) -> tuple[PlaceLabel, ...]:
    """What the events are, and when."""
    at = {text: figures[f"{name}.crank_angle"] for name, text in EVENTS.items()}
    return tuple(PlaceLabel(angle, (say(text), degrees_text(angle))) for text, angle in at.items())


def _chart(
    figures: PlantingFigures, name: str, what: str, y: Axis, values: Array, places: Extremes
) -> Chart:
    """One signal (N,) of the curve's crank angles."""
    curve = figures.curve
    line = Curve(*closed(curve.theta, values, curve.period))
    marks = extremes(y, values, places, "main")
    panel = stay_panel(figures, y, [line], marks, flags=_flags(figures))
    return Chart(name, figures.machine.title, f"{what}; {say(SHADED)}", (panel,))


def ratio(figures: PlantingFigures, link: str) -> Chart:
    """Angular velocity of a link over that of the drive."""
    curve = figures.curve
    rates = curve.family.rates(curve.grid.state, link)[0][0]
    places = [
        (figures[f"ratio.{link}.{which}_at"], figures[f"ratio.{link}.{which}"])
        for which in ("max", "min")
    ]
    both = {"link": link, "drive": figures.machine.drive.link}
    names, brief = ({k: short(item, most) for k, item in both.items()} for most in (24, 14))
    what = say("Angular velocity of {link} over that of {drive}", **names)
    label = say("angular velocity ratio, {link} / {drive}", **brief)
    return _chart(figures, f"ratio-{link}", what, Axis(label, room=ROOM), rates, places)


def tips(figures: PlantingFigures) -> Iterator[Chart]:
    """Velocity and acceleration of each tip relative to the machine, and their parts."""
    for number, arm in enumerate(figures.arms):
        of = f"-{arm.tip.translate(FORBIDDEN)}" if number else ""
        for name, (title, label, dimension, _) in QUANTITIES.items():
            for part, (text, suffix) in PARTS.items():
                values = tip_values(arm, name, part)
                what = say(title, tip=short(arm.tip))
                what += f", {say(text)}" if text else ""
                y = Axis.of(f"{say(label)}{suffix}", dimension, values, room=ROOM)
                places = [*_extremes(arm, name, part)]
                yield _chart(arm, name + part + of, what, y, values, places)


def tip_values(figures: PlantingFigures, name: str, part: str = "") -> Array:
    """Velocity or acceleration of the tip, m/s or m/s2: its size, or its part "-x" or "-y"."""
    return np.asarray(_component(_vector(figures, name, figures.curve.theta[None]), part)[0])


def _extremes(figures: PlantingFigures, name: str, part: str) -> Iterator[tuple[float, float]]:
    """Crank angle and value of the largest and the smallest value."""
    if not part:
        key = QUANTITIES[name][3]
        for which in ("max", "min"):
            text = f"{which}_{key}"
            yield figures[f"{text}.crank_angle"], figures[f"{text}.value"]
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
        return np.asarray(rates[order] * curve.speed)
    change = figures.machine.drive.acceleration
    return np.asarray(rates[order + 1] * curve.speed**2 + rates[order] * change)


def _component(vector: Array, part: str) -> Array:
    sizes: dict[str, Array] = {"": np.abs(vector), "-x": vector.real, "-y": vector.imag}
    return sizes[part]


# -- in the air and in the soil --------------------------------------------------------------------


def torque(figures: PlantingFigures) -> Chart:
    """Torque that the drive has to give, in the air and in the soil."""
    forces = figures.forces
    assert forces is not None
    pair = {"air": forces.in_air.drive_torque, "soil signal": forces.in_soil.drive_torque}
    y = Axis.of(say("drive torque"), "torque", [*pair.values()], room=ROOM)
    panel = _air_and_soil(figures, y, pair, both=True, flags=_flags(figures))
    drive = short(figures.machine.drive.link)
    what = f"{say('Torque of the drive on {link}', link=drive)}; {say(SHADED)}"
    return Chart("torque", figures.machine.title, what, (panel,))


def joints(figures: PlantingFigures) -> Chart:
    """Size of the force in every joint, in the air and in the soil."""
    forces = figures.forces
    assert forces is not None
    air, soil = (item.solved.contacts for item in (forces.in_air, forces.in_soil))
    panels = []
    pairs = {name: {"air": air[name].size, "soil signal": soil[name].size} for name in soil}
    every = [[*pair.values()] for pair in pairs.values()]
    y = Axis.of(say("force"), "force", every, room=ROOM, low=0.0)
    for name, joint in soil.items():
        panels.append(
            _air_and_soil(
                figures, y, pairs[name], title=named(forces.in_soil, name, joint), height=74.0
            )
        )
    what = f"{say('Force in each joint')}; {say(SHADED)}"
    return Chart("joints", figures.machine.title, what, tuple(panels), columns=min(2, len(panels)))


def _air_and_soil(
    figures: PlantingFigures, y: Axis, pair: Mapping[str, Array], both: bool = False, **rest: Any
) -> Panel:
    """Signals (N,) in the air and in the soil; of both all extremes, or of the soil the largest."""
    assert figures.forces is not None
    motion = figures.forces.motion
    names = {"air": say("in the air"), "soil signal": say("in the soil")}
    lines = {role: (*motion.shown(values), motion.figures(values)) for role, values in pair.items()}
    marks = marks_at_extremes(y, lines)
    if not both:
        marks = tuple(mark for mark in marks if mark.role == "soil signal")[:1]
    period = figures.curve.period
    curves = [
        Curve(*closed(theta, values, period), names[role], role)
        for role, (theta, values, _) in lines.items()
    ]
    return stay_panel(figures, y, curves, marks, figures.arms, **rest)
