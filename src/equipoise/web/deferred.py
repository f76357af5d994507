"""Slow results of a design: strokes, planting figures, vibration of its support."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import Field
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import localized, say, to_say
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.kinematics.strokes import declared_figures, dimension_of
from equipoise.mechanism.outputs.declared import DECLARED, coupling_named, joint_named
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import FREEDOMS, PLANAR
from equipoise.quantities import Dimension, display
from equipoise.results.analysis import Analysis
from equipoise.results.outputs import figures_by_name
from equipoise.symbols.scene import Scene
from equipoise.web.edits import Computed, kept_with_first
from equipoise.web.figures import chart, gauge_choice, text_of, was_of
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures
    from equipoise.vibration.forced import Sweep
    from equipoise.vibration.response import Response

SAMPLES = 360
"""In a turn."""


def can_be_shaken(machine: Machine) -> bool:
    """Whether there is a support, and masses that shake it."""
    return machine.support is not None and not massless(machine)


@kept_with_first
def responded(computed: Computed) -> Response:
    """The response of a design at its own speed, with the errors of `respond`."""
    from equipoise.vibration.forced import respond

    return respond(computed.analysis.machine)


@kept_with_first
def _curves(computed: Computed, speed: float, progress: Callable[[int, int], None]) -> Sweep:
    """The response of a design over speeds around one, rad/s."""
    from equipoise.vibration.forced import COARSE, sweep_speed
    from equipoise.vibration.linear import around

    ends = around(computed.analysis.machine.drive, speed)
    return sweep_speed(computed.analysis.machine, *ends, speeds=COARSE, progress=progress)


def response_of(computed: Computed) -> tuple[JsonObject, bytes] | None:
    """What the gauges read over a turn at the machine's speed; None where nothing can be shaken.

    Where there is no steady state, no gauges and a note that says so.
    """
    machine, block = computed.analysis.machine, FloatBlock()
    if not can_be_shaken(machine):
        return None
    try:
        response = responded(computed)
    except EquipoiseError as error:
        return {
            "charts": [],
            "arrays": {},
            "notes": [error.message()],
            "swing": None,
            "modes": [],
        }, b""
    return _displacements(computed, response, block), block.data


def swept(
    computed: Computed, progress: Callable[[int, int], None]
) -> tuple[JsonObject, bytes] | None:
    """Response over speeds around the machine's own, which is kept with it.

    progress : as of `sweep_speed`; what it raises ends the work.
    """
    try:
        response = responded(computed)
        curves = _curves(computed, response.speed, progress)
    except EquipoiseError:  # which `response_of` has reported
        return None
    block = FloatBlock()
    content = _displacements(computed, response, block)
    block.add("sweep.speed", curves.speed)
    choices: list[JsonObject] = []
    for name, curve in curves.gauges.items():
        array = f"sweep.{name}"
        block.add(array, curve.peak_to_peak)
        label = say("{gauge} against speed, peak to peak", gauge=_spoken(name))
        choices.append(gauge_choice(name, label, curve.rotation, array, log=True))
    rpm = display("angular speed", (), "rpm")
    over = {"array": "sweep.speed", "unit": rpm.name, "factor": rpm.factor, "at": response.speed}
    content["charts"].append(chart("sweep", choices, x=over))
    content["arrays"] = block.placement
    return content, block.data


def _displacements(computed: Computed, response: Response, block: FloatBlock) -> JsonObject:
    """Displacements against the crank angle, which runs as the crank does, and how to draw them."""
    count = SAMPLES * response.turns
    choices: list[JsonObject] = []
    for name, gauge in response.gauges.items():
        array = f"response.{name}"
        block.add(array, gauge.displacement.samples(count))
        label = say("response of {gauge}", gauge=_spoken(name))
        choices.append(gauge_choice(name, label, gauge.rotation, array))
    from equipoise.figures.swing import swinging

    charts = [chart("response", choices, chooser=say("Response of"))]
    notes = list(map(localized, response.notes))
    swing = _swing(swinging(computed.scene, response), block)
    modes = [*_modes(computed.scene, response)]
    return {
        "charts": charts,
        "notes": notes,
        "swing": swing,
        "modes": modes,
        "arrays": block.placement,
    }


def _swing(scene: Scene, block: FloatBlock) -> list[str] | None:
    """What is to be said of the support's movement over the crank angle, which goes to the block.

    ``support.place`` : (2 N,) m, ``support.angle`` : (N,) rad; larger than true.
    """
    if scene.swing is None:
        return None
    block.add("support.place", scene.swing.place)
    block.add("support.angle", scene.swing.angle)
    return list(scene.swing.captions)


def _modes(scene: Scene, response: Response) -> Iterator[JsonObject]:
    """Modes of the support, as large as they are drawn.

    shape : real and imaginary parts of its displacements along x and y (m) and of its rotation.
    """
    from equipoise.figures.swing import ModeSwing

    support = response.machine.support
    assert support is not None
    for number, mode in enumerate(response.modes, 1):
        item = ModeSwing.of(scene, number, mode, support.coordinates)
        parts = (complex(item.amplitudes[FREEDOMS.index(name)]) for name in PLANAR)
        shape = [number for part in parts for number in (part.real, part.imag)]
        yield {"lines": list(item.captions), "seen": item.visible, "shape": shape}


def _spoken(name: str) -> str:
    return name.replace("_", " ")


class OutdatedError(Exception):
    """The design is no longer shown."""


def deferred_replies(
    computed: Computed, against: Computed | None, sweep: bool, outdated: Callable[[], bool]
) -> Iterator[tuple[JsonObject, bytes]]:
    """Planes from the side, strokes, gauges, planting figures, the response over speed; each as
    values and a block of floats.

    against : the design that figures are compared with, if any.
    sweep : whether the response is wanted.
    outdated : whether the design is no longer shown, so that the rest is not wanted.
    """
    if computed.analysis.machine.has_planes and not outdated():
        from equipoise.figures import render
        from equipoise.figures.side import side

        yield {"type": "side", "svg": render(side(computed.analysis)).decode()}, b""
    # Where there are none any more, such as losses of friction, the page hides those that it has.
    if not outdated():
        figures, block = _compared_figures("strokes", _strokes, computed, against), FloatBlock()
        charts = [*_along_links(computed.analysis, block)]
        yield {**figures, "charts": charts, "arrays": block.placement}, block.data
    if can_be_shaken(computed.analysis.machine) and not outdated():
        yield _compared_figures("gauges", _gauges, computed, against), b""
    if _plants(computed) and not outdated():
        planted = _compared_figures("planting", _planted, computed, against)
        if not outdated():
            yield planted, b""
    if not sweep or not can_be_shaken(computed.analysis.machine):
        return

    def progress(done: int, total: int) -> None:
        if outdated():
            raise OutdatedError

    try:
        response = swept(computed, progress)
    except OutdatedError:
        return
    if response is not None and not outdated():
        content, data = response
        yield {"type": "response", **content}, data


@dataclass(frozen=True)
class FigureValue:
    """A figure: its label, its value (SI units), and its display unit."""

    label: str
    value: float
    dimension: Dimension | None
    unit: str | None = None


_Figures = Mapping[str, FigureValue]


def _compared_figures(
    kind: str, of: Callable[[Computed], _Figures], computed: Computed, against: Computed | None
) -> JsonObject:
    """Figures of a design, each beside the same figure of the other design, if that has it."""
    try:
        figures = of(computed)
    except EquipoiseError as error:
        return {"type": kind, "figures": [], "compared": False, "notes": [error.message()]}
    try:
        others = {} if against is None else of(against)
    except EquipoiseError:
        others = {}
    values = [_shown(name, figure, others.get(name)) for name, figure in figures.items()]
    notes = list(map(localized, planted(computed).notes)) if kind == "planting" else []
    return {"type": kind, "figures": values, "compared": bool(others), "notes": notes}


def _shown(name: str, figure: FigureValue, other: FigureValue | None) -> JsonObject:
    """A figure in its display unit; None where it is not finite."""
    unit_display = display(figure.dimension, [figure.value], figure.unit)

    def there(value: float) -> float | None:
        return unit_display.factor * value if isfinite(value) else None

    now = there(figure.value)
    text = {"name": name, "label": figure.label, "unit": unit_display.name, "value": now}
    was = {} if other is None else {"was": was_of(there(other.value), now)}
    return {**text, "text": text_of(now), **was}


READ = {"peak_to_peak": to_say("peak to peak"), "vibration_rms": to_say("RMS")}
"""Statistics of a gauge's reading; RMS is about the mean."""


def _gauges(computed: Computed) -> _Figures:
    """Figures of the gauges; none without a steady state, which `response_of` reports."""
    try:
        gauges = responded(computed).gauges
    except EquipoiseError:
        return {}
    reading = DECLARED["gauges.{}"]
    return {
        f"gauges.{name}.{measure}": FigureValue(
            say("{what}, {measure}", what=reading.say(_spoken(name)), measure=say(word)),
            float(getattr(gauge.displacement, measure)),
            "angle" if gauge.rotation else reading.dimension,
        )
        for name, gauge in gauges.items()
        for measure, word in READ.items()
    }


def _strokes(computed: Computed) -> _Figures:
    """Figures of strokes and of parts by name, but for the crank angles at which they are."""
    return dict(_strokes_of(computed.analysis))


def _strokes_of(analysis: Analysis) -> Iterator[tuple[str, FigureValue]]:
    machine = analysis.machine
    for name, stroke in analysis.strokes.items():
        of_joint = partial(_of_joint, machine, name)
        yield from _declared_of(f"strokes.{name}", joint_named(name), stroke, of_joint)
    for table, name, figures in figures_by_name(analysis):
        yield from _declared_of(f"{table}.{name}", coupling_named(name), figures, _own)
    yield from _losses_of(analysis)


def _along_links(analysis: Analysis, block: FloatBlock) -> Iterator[JsonObject]:
    """Charts of loads and stress along links with a section, and of their cycles of stress; their
    arrays go to the block.
    """
    if analysis.sections:
        from equipoise.figures.link_strength import ALONG, along_link, haigh_diagram, has_limit
        from equipoise.web.result_blocks import marked_chart, stacked_chart

        for name in analysis.sections:
            chooser, labels = say("Along {link}", link=name), [f"{name}: {say(w)}" for w in ALONG]
            yield stacked_chart(along_link(analysis, name), labels, chooser, block)
            if has_limit(analysis, name):
                label = say("{link}: cycles of stress, amplitude over mean", link=name)
                yield marked_chart(haigh_diagram(analysis, name), label, block)


def _losses_of(analysis: Analysis) -> Iterator[tuple[str, FigureValue]]:
    """What friction costs, joint by joint and altogether; nothing where no joint rubs."""
    losses = analysis.resolved.losses
    if losses is None:
        return
    word = say("mean loss")
    for name, joint in losses.joints.items():
        label = f"{joint_named(name)}: {word}"
        yield f"friction.joints.{name}.loss", FigureValue(label, joint.loss, "power")
    yield "friction.loss", FigureValue(f"{say('all joints')}: {word}", losses.loss, "power")
    if losses.efficiency is not None:
        yield "friction.efficiency", FigureValue(say("efficiency"), losses.efficiency, None)


def _of_joint(machine: Machine, name: str, kind: Field[Any]) -> Dimension | None:
    return dimension_of(machine, f"{name}.{kind.name}")


def _own(kind: Field[Any]) -> Dimension | None:
    dimension: Dimension | None = kind.metadata["dimension"]
    return dimension


def _declared_of(
    path: str, named: str, owner: Any, dimension: Callable[[Field[Any]], Dimension | None]
) -> Iterator[tuple[str, FigureValue]]:
    """Figures that are declared on the class of something."""
    for kind in declared_figures(type(owner)):
        value, of = getattr(owner, kind.name), dimension(kind)
        if value is not None and not kind.name.endswith("_at"):
            unit = "rpm" if of == "angular speed" else None
            label = f"{named}: {say(kind.metadata['label'])}"
            yield f"{path}.{kind.name}", FigureValue(label, value, of, unit)


def _plants(computed: Computed) -> bool:
    """Whether there is a planting finger that moves."""
    machine = computed.analysis.machine
    return machine.planting is not None and machine.drive.speed != 0


@kept_with_first
def planted(computed: Computed) -> PlantingFigures:
    """What a design plants, with the errors of `plant`."""
    from equipoise.planting.summary import plant

    return plant(computed.analysis.machine)


def _planted(computed: Computed) -> _Figures:
    """Figures of the tip's path; none of a machine that has no planting finger."""
    if not _plants(computed):
        return {}
    from equipoise.planting.blocks import cell
    from equipoise.planting.names import FIGURES, figure_named, of_all_arms

    figures = planted(computed).figures
    return {
        name: FigureValue(figure_named(name), float(figures[name]), text.dimension, text.unit)
        for name in (*FIGURES, *(name for name in figures if of_all_arms(name) in FIGURES))
        if name in figures
        for text in [cell(float(figures[name]), name)]
        if text is not None
    }
