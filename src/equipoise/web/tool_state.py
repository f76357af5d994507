"""What a page is sent of a hand-held tool: the side view with its modes, figures, curves."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.figures.tool_side import MOST_MODES, SWING
from equipoise.handheld.blocks import NAMED
from equipoise.handheld.hand_exposure import ToolExposure, expose_tool
from equipoise.handheld.model import Tool
from equipoise.handheld.modes import ToolModes, vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.side import side_of
from equipoise.handheld.sweep import default_answers, default_speeds, speeds_between
from equipoise.i18n import localized, say
from equipoise.quantities import Dimension, display, format_quantity
from equipoise.signals import Array
from equipoise.symbols.looks import LOOKS
from equipoise.symbols.tool import ToolScene
from equipoise.web.drawing import UNIT, shapes_of
from equipoise.web.figures import chart, compared
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock

MODES, SPEEDS, POINTS = 6, 81, 61
"""Natural frequencies in a plane, speeds of curves, places along the shaft."""


@dataclass(frozen=True, eq=False)
class ToolFigures:
    """What is computed of a tool."""

    tool: Tool

    @cached_property
    def modes(self) -> ToolModes:
        """Free vibration."""
        return vibrate_tool(self.tool, MODES)

    @cached_property
    def exposure(self) -> ToolExposure | None:
        """What the hands get; None where nothing shakes it, or nobody holds it."""
        ends = default_speeds(self.tool)
        if ends is None or "exposure" not in default_answers(self.tool):
            return None
        return expose_tool(self.tool, speeds_between(self.tool, *ends, SPEEDS))

    @cached_property
    def whole(self) -> dict[str, tuple[str, float, Dimension, str | None]]:
        """Figures by their name: label, value (SI units), dimension and unit."""
        return {name: item for name, *item in self._figures()}  # type: ignore[misc]

    def _figures(self) -> Iterator[tuple[str, str, float, Dimension, str | None]]:
        yield "mass", say("mass of the tool"), self.tool.mass, "mass", "kg"
        planes = {"vertical": self.modes.planes[0]}
        if not self.modes.alike:
            planes["lateral"] = self.modes.planes[1]
        for plane, result in planes.items():
            for k, hertz in enumerate(result.cycles_per_second, 1):
                if hertz > 0:
                    text = say("natural frequency {number}, {plane}", number=k, plane=say(plane))
                    yield f"{plane}.{k}", text, float(hertz), "frequency", "Hz"
        if self.exposure is None:
            return
        for what, hands in self.exposure.named.items():
            for name, grip in hands.items():
                text = say(
                    "weighted acceleration at {hand}, {state}", hand=name, state=say(NAMED[what])
                )
                yield f"{what}.{name}", text, float(grip.a_hv[0]), "acceleration", "m/s^2"
        for name, day in self.exposure.days.items():
            text = say("A(8) at {hand}", hand=name)
            yield f"day.{name}", text, float(day.a8), "acceleration", "m/s^2"


def tool_state(now: ToolFigures, first: ToolFigures) -> tuple[JsonObject, bytes]:
    """Everything that a page draws of a tool.

    first : as it was opened, with which it is compared.
    """
    tool, block = now.tool, FloatBlock()
    scene = side_of(tool)
    changed, length = now is not first, display("length", [tool.shaft.length])
    content: JsonObject = {
        "title": localized(tool.title),
        "description": localized(tool.description),
        "length": {"unit": length.name, "factor": length.factor},
        "scene": _scene(scene),
        "before": _scene(side_of(first.tool)) if changed else None,
        "along": [float(x) for x in np.linspace(0.0, tool.shaft.length, POINTS)],
        "views": [*_views(now)],
        "figures": [*_compared(now, first)],
        "charts": [*_charts(now, first if changed else None, block)],
        "notes": [localized(note) for note in now.modes.notes],
    }
    content["arrays"] = block.placement
    return content, block.data


# -- the side view ---------------------------------------------------------------------------------


def _scene(scene: ToolScene) -> JsonObject:
    """A tool at rest: tubes, and the signs of every station about its place on the shaft.

    Shapes are as in `drawing.stage_of`.
    """
    low, high = scene.box
    pieces = scene.pieces()
    roles = sorted(
        {"rim", "zero"} & LOOKS.keys() | {s.role for *_, shapes in pieces for s in shapes}
    )
    return {
        "tubes": [[item.start, item.stop, item.diameter] for item in scene.shaft],
        "stations": [
            {
                "name": seat.name,
                "place": seat.place,
                "text": format_quantity(seat.place, "length", "mm"),
            }
            for seat in scene.seats
        ],
        "pieces": [
            {
                "layer": layer,
                "place": seat.place,
                "turns": turns,
                "shapes": shapes_of(shapes),
            }
            for layer, seat, turns, shapes in pieces
        ],
        "looks": {role: LOOKS[role].css(UNIT) for role in roles},
        "box": [low.real, low.imag, high.real, high.imag],
    }


def _views(now: ToolFigures) -> Iterator[JsonObject]:
    """How the shaft may be seen to move: at work, and in its lowest modes of the vertical plane.

    shape : real and imaginary parts of its deflection at the places, m, as large as it is drawn.
    """
    tool, along = now.tool, np.linspace(0.0, now.tool.shaft.length, POINTS)
    swing = SWING * tool.shaft.length
    yield from _at_work(tool, along, swing)
    plane = now.modes.planes[0]
    lowest = np.flatnonzero(plane.frequency > 0)[:MOST_MODES]
    for k in map(int, lowest):
        shape = np.interp(along, now.modes.places, plane.shapes[k])
        value = f"{float(plane.cycles_per_second[k]):.4g}"
        name = say("mode {number}: {frequency} Hz", number=k + 1, frequency=value)
        yield {"name": name, "lines": [], "shape": _parts(shape * swing / np.max(np.abs(shape)))}


def _at_work(tool: Tool, along: Array, swing: float) -> Iterator[JsonObject]:
    if tool.operation is None or not tool.excitations:
        return
    try:
        response = respond_tool(tool, tool.operation.speed)
    except EquipoiseError:
        return
    moved = response.line(along).displacement[:, 0, :, 0]
    order = int(np.argmax(np.max(np.abs(moved), axis=0)))
    most = float(np.max(np.abs(moved[:, order])))
    if not most:
        return
    factor = float(f"{swing / most:.1g}")
    remark = say(
        "order {order}, displacement drawn {factor} times as large",
        order=f"{float(response.orders[order]):.4g}",
        factor=f"{factor:g}",
    )
    speed = f"{tool.operation.speed * 30 / pi:.4g}"
    name = say("at work, {speed} rpm", speed=speed)
    yield {"name": name, "lines": [remark], "shape": _parts(factor * moved[:, order])}


def _parts(shape: Array) -> list[float]:
    flat = np.asarray(shape, complex).view(float).ravel()
    return [float(f"{item:.5g}") for item in flat]


# -- figures and curves ----------------------------------------------------------------------------


def _compared(now: ToolFigures, first: ToolFigures) -> Iterator[JsonObject]:
    """Each figure as it was opened and as it is."""
    for name, (label, value, dimension, wanted) in now.whole.items():
        before = first.whole.get(name, (label, value, dimension, wanted))[1]
        unit = display(dimension, [value, before], wanted)
        changed = compared(unit.factor * before, unit.factor * value)
        if dimension == "frequency":  # which is better depends on what shakes
            changed["way"] = "same"
        yield {"name": name, "label": label, "unit": unit.name, **changed}


def _charts(now: ToolFigures, first: ToolFigures | None, block: FloatBlock) -> Iterator[JsonObject]:
    """Weighted acceleration of each hand against the speed of the engine."""
    if now.exposure is None or now.tool.operation is None:
        return
    rpm = display("angular speed", (), "rpm")
    unit = display("acceleration", (), "m/s^2")
    choices = []
    grid = now.exposure.speed
    block.add("speed", grid)
    for name, grip in now.exposure.grips.items():
        array = f"a_hv.{name}"
        block.add(array, grip.a_hv)
        old = None if first is None or first.exposure is None else first.exposure
        if old is not None and name in old.grips:
            block.add(f"before.{array}", np.interp(grid, old.speed, old.grips[name].a_hv))
        label = say("Weighted acceleration at {hand} against the speed of the engine", hand=name)
        choices.append({
            "name": name,
            "label": label,
            "of": None,
            "unit": unit.name,
            "factor": unit.factor,
            "log": False,
            "curves": [{"array": array, "stride": 1, "part": 0, "label": ""}],
        })  # fmt: skip
    over = {
        "array": "speed",
        "unit": rpm.name,
        "factor": rpm.factor,
        "at": now.tool.operation.speed,
    }
    yield chart("exposure", choices, x=over, chooser=say("Hand"))
