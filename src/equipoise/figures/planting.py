"""The charts of a planting machine: both paths of the tip to one scale, relative to the machine and
over ground; ratios, motion of the tip, torque and joints.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import floor, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.chart_parts import (
    ROOM,
    angle_step,
    by_name,
    closed,
    crank_axis,
    degrees_text,
    extremes,
    marks_at_extremes,
)
from equipoise.figures.forces import named
from equipoise.figures.linkage import SOIL, panel_content
from equipoise.figures.motion import FORBIDDEN
from equipoise.figures.style import free_name, short
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.kinematics.tip import TipCurve, largest, smallest
from equipoise.planting.figures import GroundPath
from equipoise.quantities import Dimension
from equipoise.results.charts import (
    Arrow,
    Axis,
    Band,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    quantity,
)
from equipoise.signals import Array
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape, soil

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


def planting_charts(figures: PlantingFigures) -> dict[str, Chart]:
    """Every chart of a planting machine by name.

    ``path``; ``ratio-LINK`` for each link but the drive; ``velocity``, ``velocity-x``,
    ``velocity-y`` and the same of ``acceleration``, for a further arm such as ``velocity-x-Q``;
    ``torque`` and ``joints`` where there are forces in the soil.
    """
    result = {"path": path(figures)}
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
    figures: PlantingFigures,
    name: str,
    what: str,
    y: Axis,
    values: Array,
    places: Extremes,
    caption: str,
) -> Chart:
    """One signal (N,) of the curve's crank angles."""
    curve = figures.curve
    line = Curve(*closed(curve.theta, values, curve.period))
    marks = extremes(y, values, places, "main")
    panel = stay_panel(figures, y, [line], marks, flags=_flags(figures))
    what = f"{what}; {say(SHADED)}"
    return Chart(name, figures.machine.title, what, (panel,), caption=caption)


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
    caption = to_say("Angular velocity of a link over that of the crank.")
    return _chart(figures, f"ratio-{link}", what, Axis(label, room=ROOM), rates, places, caption)


def tips(figures: PlantingFigures) -> Iterator[Chart]:
    """Velocity and acceleration of each tip relative to the machine, and their parts."""
    caption = to_say("Velocity and acceleration of the finger's tip relative to the machine.")
    for number, arm in enumerate(figures.arms):
        of = f"-{arm.tip.translate(FORBIDDEN)}" if number else ""
        for name, (title, label, dimension, _) in QUANTITIES.items():
            for part, (text, suffix) in PARTS.items():
                values = tip_values(arm, name, part)
                what = say(title, tip=short(arm.tip))
                what += f", {say(text)}" if text else ""
                y = Axis.of(f"{say(label)}{suffix}", dimension, values, room=ROOM)
                places = [*_extremes(arm, name, part)]
                yield _chart(arm, name + part + of, what, y, values, places, caption)


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
    caption = to_say("Drive torque with and without the forces of the soil.")
    return Chart("torque", figures.machine.title, what, (panel,), caption=caption)


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
    caption = to_say("Forces in the joints with and without the forces of the soil.")
    columns = min(2, len(panels))
    return Chart("joints", figures.machine.title, what, tuple(panels), columns, caption=caption)


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


# -- both paths of the tip -------------------------------------------------------------------------

IN_TURN, SKETCHED = 720, 180
"""In a turn: places of the path that are drawn; crank angles by which ways of blocks are found."""
AHEAD = 2.5
"""Largest width of what is shown over ground, over its height."""
INSTANTS = {
    "pick-up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest"),
    "release": to_say("release"),
    "exit": to_say("exit"),
}
"""Instant of a planting stroke -> in words."""


@dataclass(frozen=True)
class PathInstant:
    """An instant on a path: its name, place (m, complex) and direction away from the path, deg."""

    name: str
    place: complex
    away: float


class Paths:
    """Both paths of a machine in the sense of time, as places in m.

    ``way`` is the crank angle that the drive has turned, rad.
    """

    def __init__(self, figures: PlantingFigures) -> None:
        self.figures = figures
        self.curve: TipCurve = figures.curve
        self.ground = GroundPath(self.curve)
        self.sense = self.ground.sense
        self.level = figures["surface"]
        self.tray = np.array([complex(*end) for end in figures.planting.tray or ()], complex)

    @property
    def drives(self) -> bool:
        """Whether there is a path over ground."""
        return self.figures["forward_speed"] != 0

    @cached_property
    def scene(self) -> Scene:
        """The machine over its cycle and, last of all, at the lowest point of the tip."""
        cycle = np.linspace(0, self.curve.period, SKETCHED * self.curve.turns, endpoint=False)
        return Scene.of(move(self.figures.machine, [*cycle, self.figures["lowest.crank_angle"]]))

    def way_of(self, name: str, after: float = 0.0) -> float:
        """When an instant comes for the first time at or after another way."""
        way = self.sense * self.figures[f"{name}.crank_angle"]
        return after + float(np.mod(way - after, self.curve.period))

    @cached_property
    def start(self) -> float:
        """When the drawing of the path over ground begins: high up before a hill."""
        lowest = self.way_of("lowest")
        if self.curve.turns > 1:
            return lowest - pi
        return lowest - float(np.mod(lowest - self.way_of("highest"), self.curve.period))

    @cached_property
    def travel(self) -> float:
        """Crank angle over which the path over ground is drawn: two hills, or one long cycle."""
        return 2 * pi * max(2, min(self.curve.turns, 4))

    @cached_property
    def ways(self) -> Array:
        """Over which the path over ground is drawn."""
        return self.start + np.linspace(0, self.travel, round(IN_TURN * self.travel / (2 * pi)) + 1)

    @cached_property
    def cycle(self) -> Array:
        """Over which the path relative to the machine is drawn: closed."""
        return np.linspace(0, self.curve.period, IN_TURN * self.curve.turns + 1)

    def on_machine(self, ways: Array, arm: int = 0) -> Array:
        """Places relative to the machine."""
        places: Array = self.curve.arms[arm].at(self.sense * ways[None]).place[0]
        return places

    @cached_property
    def first_hill(self) -> float:
        """Place over ground at which the first arm lets a seedling go, m."""
        hill = self.way_of("release", self.way_of("entry", self.start))
        return float(self.ground.place(np.array([[hill]])).real[0, 0])

    def over_ground(self, ways: Array, arm: int = 0) -> Array:
        """Places over ground, counted from the first hill."""
        places: Array = self.on_machine(ways, arm) + self.ground.drive * ways - self.first_hill
        return places

    def of_further_arms(self, over_ground: bool) -> Iterator[Curve]:
        """Paths of the further arms, each with the name of its tip."""
        place, ways = (
            (self.over_ground, self.ways) if over_ground else (self.on_machine, self.cycle)
        )
        for number, arm in enumerate(self.figures.further, 1):
            label = say("path of {point}", point=short(arm.tip, 12))
            yield Curve.of(place(ways, number), label, f"several {number + 1}")

    def instants(self, over_ground: bool) -> Iterator[PathInstant]:
        """Instants of the first hill that is drawn, on either path; over ground no pick-up."""
        lowest = self.way_of("lowest", self.start)
        for name in [*INSTANTS][1:] if over_ground else INSTANTS:
            key = name.replace("-", "_")
            released = key != "release" or self.curve.arm.release is not None
            if f"{key}.crank_angle" in self.figures.figures and released:
                before = key in ("entry", "pick_up")
                way = self.way_of(key, lowest - self.curve.period if before else lowest)
                yield PathInstant(name, *self.place_and_away(way, over_ground))

    def place_and_away(self, way: float, over_ground: bool) -> tuple[complex, float]:
        """Where the tip is, and the direction (deg) that points out of its path."""
        interval = np.array([way, way + 1e-3])
        here, then = (self.over_ground if over_ground else self.on_machine)(interval)
        away = (then - here) * 1j * (1 if over_ground else self._turning)
        return complex(here), float(np.degrees(np.angle(away)))

    @cached_property
    def _turning(self) -> float:
        """1 where the left of the path relative to the machine is outside, else -1."""
        places = self.on_machine(self.cycle)
        area = float(np.sum(np.imag(np.conj(places[:-1]) * places[1:])))
        return -1.0 if area > 0 else 1.0

    def crossings(self) -> Iterator[complex]:
        """Places over ground at which loops cross themselves, as far as they are drawn."""
        period = self.curve.period
        for loop in self.figures.loops:
            first = self.sense * loop.first
            first += period * -floor((first - self.start) / period)
            while first + loop.way < self.start + self.travel:
                yield complex(self.over_ground(np.array([first]))[0])
                first += period

    def span_over_ground(self, high: float) -> tuple[float, float]:
        """From where to where that path is shown, m: less than two hills of a long way.

        high : of the panel, m.
        """
        x, most = self.over_ground(self.ways).real, AHEAD * high
        start, stop = float(np.min(x)), float(np.max(x))
        if stop - start <= most:
            return start, stop
        shares = (0.3, 0.7) if self.figures["forward_speed"] > 0 else (0.7, 0.3)
        return -most * shares[0], most * shares[1]


MOST_UNITS = 12
SMALLER = 0.85
"""Size of the machine's signs, over that in a picture of their own."""
ABOVE, BELOW = 0.06, 0.16
"""Free above and below what is drawn, over its height."""
ARROWS_IN = ((0.12, 0.45), (0.55, 0.88))
"""Between which parts of the way from exit to entry the heads of arrows are."""


def path(figures: PlantingFigures) -> Chart:
    """The path relative to the machine with the linkage, and the path over ground."""
    paths = Paths(figures)
    tip, drive = short(figures.tip), short(figures.machine.drive.link)
    what = say(
        "Path of the tip {tip}, linkage at the lowest point; numbers: angle of {link}, deg",
        tip=tip,
        link=drive,
    )
    if paths.drives and figures.planting.units_per_turn > 1:
        what += "; " + say("dashed: other units")
    draw = (_machine_panel, _ground_panel)
    panels = tuple(
        item(paths, corners) for item, corners in zip(draw, _corners(paths), strict=False)
    )
    caption = to_say("Path of the planting finger relative to the machine and over the ground.")
    return Chart("path", figures.machine.title, what, panels, stacked=False, caption=caption)


def _corners(paths: Paths) -> list[tuple[complex, complex]]:
    """Corners of what each panel shows, m: of one size, so that both have one scale."""
    every = [paths.on_machine(paths.cycle, arm) for arm in range(len(paths.curve.arms))]
    places = np.concatenate([*every, paths.scene.corners_at(-1), paths.tray, [1j * paths.level]])
    low, high = float(np.min(places.imag)), float(np.max(places.imag))
    low, high = low - BELOW * (high - low), high + ABOVE * (high - low)
    spans = [(float(np.min(places.real)), float(np.max(places.real)))]
    if paths.drives:
        spans.append(paths.span_over_ground(high - low))
    half = max(stop - start for start, stop in spans) / 2
    middles = [(start + stop) / 2 for start, stop in spans]
    return [(complex(middle - half, low), complex(middle + half, high)) for middle in middles]


def _axis(label: str) -> Axis:
    return Axis.of(label, "length", [0.5], "cm", room=0.0)


def _machine_panel(paths: Paths, corners: tuple[complex, complex]) -> Panel:
    instants, ticks = list(paths.instants(over_ground=False)), list(_ticks(paths))
    across = [np.array([item.place + out, item.place - out, np.nan]) for item, out in ticks]
    marks = [Mark.of(instant.place, "", f"instant {instant.name}") for instant in instants]
    marks += [
        Mark.of(complex(place[-1]), short(name), "ink", 45.0, False, distance=5.0, bold=True)
        for name, place in paths.scene.places.items()
    ]
    # a little lower than they are, so that a point at the same place keeps its own name
    marks += _names(instants, 0.006 * (corners[1] - corners[0]).imag)
    if paths.tray.size:
        marks.append(Mark.of(complex(np.mean(paths.tray)), say("tray"), "ink", 0.0, False))
    marks += [
        Mark.of(item.place, item.name, "lines", item.away, False, True, distance=5.0)
        for item, _ in ticks
    ]
    content = panel_content(paths.scene, -1, without=SOIL)
    return Panel(
        _axis(say("x in the frame")),
        _axis(say("height y in the frame")),
        (
            *paths.of_further_arms(over_ground=False),
            *_path(paths, paths.on_machine(paths.cycle)),
            Curve.of(np.concatenate(across), "", "tick"),
        ),
        tuple(marks),
        arrows=tuple(_senses(paths, over_ground=False)),
        equal=True,
        zero=False,
        always_shown=corners,
        sign_size=SMALLER,
        **{**content, "ground": (*_earth(paths, corners), *content["ground"])},
    )


def _earth(paths: Paths, corners: tuple[complex, complex]) -> list[Shape]:
    """Soil that reaches beyond all sides of a panel but the upper one."""
    over = corners[1].real - corners[0].real
    ends = corners[0].real - over, corners[1].real + over
    return soil(*ends, paths.level, corners[0].imag - over, paths.scene.unit)


def _ground_panel(paths: Paths, corners: tuple[complex, complex]) -> Panel:
    places = paths.over_ground(paths.ways)
    instants = list(paths.instants(over_ground=True))
    ahead = paths.figures["forward_speed"] > 0
    marks = [Mark.of(instant.place, "", f"instant {instant.name}") for instant in instants]
    marks += _names(_outside(instants, ahead))
    for number, place in enumerate(paths.crossings()):
        text = say("crossing of the loop") if number == 0 else ""
        marks.append(Mark.of(place, text, "crossing", 0.0, distance=9.0))
    spacing, arrows, lines = _hill_spacing(paths, corners)
    way = say("machine drives")
    return Panel(
        _axis(say("distance over ground")),
        _axis(say("height y in the frame")),
        (
            *_other_units(paths, places),
            *paths.of_further_arms(over_ground=True),
            *_path(paths, places),
            *lines,
        ),
        (*marks, spacing),
        arrows=(*_senses(paths, over_ground=True), *arrows),
        title=f"{way} →" if ahead else f"← {way}",
        equal=True,
        zero=False,
        always_shown=corners,
        ground=tuple(_earth(paths, corners)),
    )


def _outside(instants: list[PathInstant], ahead: bool) -> list[PathInstant]:
    """Instants over ground with their names outside, and clear of the dimension."""
    places = {instant.name: instant.place for instant in instants}
    wishes = {"lowest": -135.0 if ahead else -45.0}
    left, right = sorted(("entry", "exit"), key=lambda name: places[name].real)
    wishes |= {left: 160.0, right: 20.0}
    return [replace(instant, away=wishes.get(instant.name, instant.away)) for instant in instants]


def _names(instants: Sequence[PathInstant], lower: float = 0.0) -> Iterator[Mark]:
    """What the instants are; lower : how far below their places, m."""
    for instant in instants:
        yield Mark.of(
            instant.place - 1j * lower, say(INSTANTS[instant.name]), "ink", instant.away, sign=False
        )


def _path(paths: Paths, places: Array) -> Iterator[Curve]:
    """A path, bolder where it is in the soil."""
    yield Curve.of(places)
    below = np.where(places.imag <= paths.level, places, complex(np.nan, np.nan))
    yield Curve.of(below, "", "path in soil")


def _other_units(paths: Paths, places: Array) -> Iterator[Curve]:
    """Paths of other planting units of the same drive, which plant the hills between."""
    sense = np.sign(paths.figures["forward_speed"])
    for number in range(1, min(paths.figures.planting.units_per_turn, MOST_UNITS)):
        spacing = len(paths.curve.arms) * paths.figures["hill_spacing"]
        x = places.real + sense * number * spacing
        yield Curve(x, places.imag, "", "other unit")


def _senses(paths: Paths, over_ground: bool) -> Iterator[Arrow]:
    """Arrow heads in the direction of the tip's motion, clear of the labels of crank angles."""
    leave = paths.way_of("exit", paths.way_of("lowest", paths.start))
    above = paths.way_of("entry", leave) - leave
    step = np.radians(angle_step(paths.curve.turns))
    place = paths.over_ground if over_ground else paths.on_machine
    size = float(np.ptp(place(paths.cycle).imag))
    shunned = [*paths.crossings()] if over_ground else []
    for shares in ARROWS_IN:
        first, last = (round((leave + above * share) / step) for share in shares)
        ways = step * (np.arange(first, max(last, first + 1)) + 0.5)
        places = place(ways)
        apart = np.abs(places[:, None] - np.array(shunned, complex))
        best = int(np.argmax(np.min(apart, axis=1))) if shunned else len(ways) // 2
        shunned += [complex(places[best])] if over_ground else []
        tail, head = (complex(z) for z in place(ways[best] + np.array([-0.01, 0.01])))
        yield Arrow(head - 0.03 * size * (head - tail) / (abs(head - tail) or 1.0), head, "main")


def _ticks(paths: Paths) -> Iterator[tuple[PathInstant, complex]]:
    """Round crank angles on the path, and half a short line across it there."""
    size = float(np.ptp(paths.on_machine(paths.cycle).imag))
    for angle in range(0, 360 * paths.curve.turns, angle_step(paths.curve.turns)):
        place, away = paths.place_and_away(paths.sense * np.radians(angle), over_ground=False)
        yield PathInstant(str(angle), place, away), 0.012 * size * np.exp(1j * np.radians(away))


def _hill_spacing(
    paths: Paths, corners: tuple[complex, complex]
) -> tuple[Mark, list[Arrow], list[Curve]]:
    """A dimension between the first hill and the next, below the path."""
    spacing = paths.figures["hill_spacing"] * float(np.sign(paths.figures["forward_speed"]))
    deep = float(np.min(paths.over_ground(paths.ways).imag))
    room = deep - corners[0].imag
    y, top = deep - 0.5 * room, deep - 0.15 * room
    text = say("hill spacing {spacing}", spacing=quantity(abs(spacing), "length", "cm"))
    whole = corners[0].real < spacing < corners[1].real and paths.curve.turns == 1
    x = spacing / 2 if whole else (corners[0].real + corners[1].real) / 2
    mark = Mark(x, y, text, "ink", -90.0, sign=False, distance=3.0)
    if not whole:
        return mark, [], []
    ends = complex(0, y), complex(spacing, y)
    lines = [
        Curve(np.array([at, at]), np.array([top, y - 0.1 * room]), "", "dimension")
        for at in (0.0, spacing)
    ]
    return mark, [Arrow(*ends, "dimension"), Arrow(*ends[::-1], "dimension")], lines
