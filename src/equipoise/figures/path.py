"""The picture of both paths of the tip: relative to the machine, and over ground."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.crank import angle_step
from equipoise.figures.linkage import drawn
from equipoise.figures.paths import Instant, Paths
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.results.charts import Arrow, Axis, Chart, Curve, Mark, Panel, shown
from equipoise.symbols.shapes import soil

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

CM = 100.0
MOST_UNITS = 12
SMALLER = 0.85
"""Size of the machine's signs, over that in a picture of their own."""
ABOVE, BELOW = 0.06, 0.16
"""Free above and below what is drawn, over its height."""
ARROWS_IN = ((0.12, 0.45), (0.55, 0.88))
"""Between which parts of the way from exit to entry the heads of arrows are."""
INSTANTS = {
    "pick-up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest"),
    "release": to_say("release"),
    "exit": to_say("exit"),
}
"""Instant of a planting stroke -> in words."""


def path(figures: PlantingFigures) -> Chart:
    """The path relative to the machine with the linkage, and the path over ground."""
    paths = Paths(figures)
    tip, drive = short(figures.planting.tip), short(figures.machine.drive.link)
    what = say(
        "Path of the tip {tip}, linkage at the lowest point; numbers: angle of {link}, deg",
        tip=tip,
        link=drive,
    )
    if paths.drives and figures.planting.units_per_turn > 1:
        what += "; " + say("dashed: other units")
    held = _held(paths)
    panels = [_machine_panel(paths, held[0])]
    if paths.drives:
        panels.append(_ground_panel(paths, held[1]))
    return Chart("path", figures.machine.title, what, tuple(panels), stacked=False)


def _held(paths: Paths) -> list[tuple[complex, complex]]:
    """Corners of what each panel shows, m: of one size, so that both have one scale."""
    places = np.concatenate(
        [paths.on_machine(paths.cycle), paths.scene.corners_at(-1), paths.tray, [1j * paths.level]]
    )
    low, high = float(np.min(places.imag)), float(np.max(places.imag))
    low, high = low - BELOW * (high - low), high + ABOVE * (high - low)
    spans = [(float(np.min(places.real)), float(np.max(places.real)))]
    if paths.drives:
        spans.append(paths.span_over_ground(high - low))
    half = max(stop - start for start, stop in spans) / 2
    middles = [(start + stop) / 2 for start, stop in spans]
    return [(complex(middle - half, low), complex(middle + half, high)) for middle in middles]


def _axis(label: str) -> Axis:
    return Axis.of(label, "length", [0.5], ("cm", "cm", "cm"), room=0.0)


def _machine_panel(paths: Paths, held: tuple[complex, complex]) -> Panel:
    instants = list(paths.instants(tuple(INSTANTS), over_ground=False))
    ticks = list(_ticks(paths))
    across = [np.array([one.place + out, one.place - out, np.nan]) for one, out in ticks]
    line = np.concatenate(across)
    marks = [*_signs(instants)]
    marks += [
        Mark(z.real, z.imag, short(name), "ink", 45.0, False, near=5.0, bold=True)
        for name, z in ((name, complex(p[-1])) for name, p in paths.scene.places.items())
    ]
    marks += _texts(instants, 0.006 * (held[1] - held[0]).imag)
    if paths.tray.size:
        z = complex(np.mean(paths.tray))
        marks.append(Mark(z.real, z.imag, say("tray"), "ink", 0.0, False))
    marks += [
        Mark(one.place.real, one.place.imag, one.name, "lines", one.away, False, True, near=5.0)
        for one, _ in ticks
    ]
    return Panel(
        _axis(say("x in the frame")),
        _axis(say("height y in the frame")),
        (*_path(paths, paths.on_machine(paths.cycle)), Curve(line.real, line.imag, "", "tick")),
        tuple(marks),
        arrows=tuple(_senses(paths, over_ground=False)),
        equal=True,
        zero=False,
        held=held,
        sign_size=SMALLER,
        **drawn(paths.scene, -1),
    )


def _ground_panel(paths: Paths, held: tuple[complex, complex]) -> Panel:
    places = paths.over_ground(paths.ways)
    instants = list(paths.instants(tuple(INSTANTS)[1:], over_ground=True))
    ahead = paths.figures["forward_speed"] > 0
    marks = [*_signs(instants), *_texts(_beside(instants, ahead))]
    for number, place in enumerate(paths.crossings()):
        text = say("crossing of the loop") if number == 0 else ""
        marks.append(Mark(place.real, place.imag, text, "crossing", 0.0, near=9.0))
    spacing, arrows, lines = _hill_spacing(paths, held)
    way = say("machine drives")
    over = held[1].real - held[0].real
    ends = held[0].real - over, held[1].real + over
    bottom = held[0].imag - over
    return Panel(
        _axis(say("distance over ground")),
        _axis(say("height y in the frame")),
        (*_others(paths), *_path(paths, places), *lines),
        (*marks, spacing),
        arrows=(*_senses(paths, over_ground=True), *arrows),
        title=f"{way} →" if ahead else f"← {way}",
        equal=True,
        zero=False,
        held=held,
        ground=tuple(soil(*ends, paths.level, bottom, paths.scene.unit)),
    )


def _beside(instants: list[Instant], ahead: bool) -> list[Instant]:
    """Instants over ground with their names outside, and clear of the dimension."""
    places = {one.name: one.place for one in instants}
    wishes = {"lowest": -135.0 if ahead else -45.0}
    left, right = sorted(("entry", "exit"), key=lambda name: places[name].real)
    wishes |= {left: 160.0, right: 20.0}
    return [replace(one, away=wishes.get(one.name, one.away)) for one in instants]


def _signs(instants: Sequence[Instant]) -> Iterator[Mark]:
    """Instants, each with a marker of its own."""
    for one in instants:
        yield Mark(one.place.real, one.place.imag, "", f"instant {one.name}")


def _texts(instants: Sequence[Instant], lower: float = 0.0) -> Iterator[Mark]:
    """lower : so much, m, that a point at the same place keeps its own name."""
    for one in instants:
        z, text = one.place - 1j * lower, say(INSTANTS[one.name])
        yield Mark(z.real, z.imag, text, "ink", one.away, sign=False)


def _path(paths: Paths, places: np.ndarray) -> Iterator[Curve]:
    """A path, bolder where it is in the soil."""
    yield Curve(places.real, places.imag, "", "main")
    below = paths.in_soil(places)
    yield Curve(below.real, below.imag, "", "path in soil")


def _others(paths: Paths) -> Iterator[Curve]:
    """Paths of other planting units of the same drive, which plant the hills between."""
    places, sense = paths.over_ground(paths.ways), np.sign(paths.figures["forward_speed"])
    for number in range(1, min(paths.figures.planting.units_per_turn, MOST_UNITS)):
        x = places.real + sense * number * paths.figures["hill_spacing"]
        yield Curve(x, places.imag, "", "other unit")


def _senses(paths: Paths, over_ground: bool) -> Iterator[Arrow]:
    """Heads of arrows that tell how the tip runs along its path, clear of the crank angles."""
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


def _ticks(paths: Paths) -> Iterator[tuple[Instant, complex]]:
    """Round crank angles on the path, and half a short line across it there."""
    size = float(np.ptp(paths.on_machine(paths.cycle).imag))
    for angle in range(0, 360 * paths.curve.turns, angle_step(paths.curve.turns)):
        place, away = paths.place_and_away(paths.sense * np.radians(angle), over_ground=False)
        yield Instant(str(angle), place, away), 0.012 * size * np.exp(1j * np.radians(away))


def _hill_spacing(
    paths: Paths, held: tuple[complex, complex]
) -> tuple[Mark, list[Arrow], list[Curve]]:
    """A dimension between the first hill and the next, below the path."""
    spacing = paths.figures["hill_spacing"] * float(np.sign(paths.figures["forward_speed"]))
    deep = float(np.min(paths.over_ground(paths.ways).imag))
    room = deep - held[0].imag
    y, top = deep - 0.5 * room, deep - 0.15 * room
    text = say("hill spacing {spacing} cm", spacing=shown(CM * abs(spacing)))
    whole = held[0].real < spacing < held[1].real and paths.curve.turns == 1
    x = spacing / 2 if whole else (held[0].real + held[1].real) / 2
    mark = Mark(x, y, text, "ink", -90.0, sign=False, near=3.0)
    if not whole:
        return mark, [], []
    ends = complex(0, y), complex(spacing, y)
    lines = [
        Curve(np.array([at, at]), np.array([top, y - 0.1 * room]), "", "dimension")
        for at in (0.0, spacing)
    ]
    return mark, [Arrow(*ends, "dimension"), Arrow(*ends[::-1], "dimension")], lines
