"""What takes longer to tell of a design: strokes, what it plants, how its support is shaken."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from math import isfinite
from typing import Any

from equipoise.errors import EquipoiseError
from equipoise.figures.swing import ModeSwing, swinging
from equipoise.i18n import said, say
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import joint_named
from equipoise.mechanism.strokes import declared_figures, dimension_of
from equipoise.mechanism.support import FREEDOMS, PLANAR
from equipoise.planting.blocks import cell
from equipoise.planting.names import FIGURES
from equipoise.planting.summary import plant
from equipoise.quantities import Dimension, display
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene
from equipoise.vibration.forced import respond
from equipoise.vibration.resonance import around
from equipoise.vibration.response import Response
from equipoise.vibration.sampling import COARSE
from equipoise.vibration.sweep import sweep_speed
from equipoise.web.block import Block
from equipoise.web.edits import Solved
from equipoise.web.figures import chart, gauge_choice, text_of

Values = dict[str, Any]
SAMPLES = 360
"""In a turn."""


def can_be_shaken(machine: Machine) -> bool:
    """Whether there is a support, and masses that shake it."""
    return machine.support is not None and not massless(machine)


@lru_cache(16)
def responded(shown: Solved) -> Response:
    """The response of a design at its own speed, with the errors of `respond`."""
    return respond(shown.design.machine)


def response_of(shown: Solved) -> tuple[Values, bytes] | None:
    """What the gauges read over a turn at the machine's speed; None where nothing can be shaken.

    Where there is no steady state, no gauges and a note that says so.
    """
    machine, block = shown.design.machine, Block()
    if not can_be_shaken(machine):
        return None
    try:
        found = responded(shown)
    except EquipoiseError as error:
        return {
            "charts": [],
            "arrays": {},
            "notes": [error.told()],
            "swing": None,
            "modes": [],
        }, b""
    return _told(shown, found, block), block.data


def swept(shown: Solved, progress: Callable[[int, int], None]) -> tuple[Values, bytes] | None:
    """The same with the response over speeds around the machine's own.

    progress : as of `sweep_speed`; what it raises ends the work.
    """
    machine = shown.design.machine
    try:
        found = responded(shown)
        ends = around(machine.drive, found.speed)
        curves = sweep_speed(machine, *ends, speeds=COARSE, progress=progress)
    except EquipoiseError:  # of which `response_of` has told
        return None
    block = Block()
    content = _told(shown, found, block)
    block.add("sweep.speed", curves.speed)
    choices: list[Values] = []
    for name, curve in curves.gauges.items():
        array = f"sweep.{name}"
        block.add(array, curve.peak_to_peak)
        label = say("{gauge} against speed, peak to peak", gauge=_spoken(name))
        choices.append(gauge_choice(name, label, curve.rotation, array, log=True))
    rpm = display("angular speed", (), "rpm")
    over = {"array": "sweep.speed", "unit": rpm.name, "factor": rpm.factor, "at": found.speed}
    content["charts"].append(chart("sweep", choices, x=over))
    content["arrays"] = block.told
    return content, block.data


def _told(shown: Solved, found: Response, block: Block) -> Values:
    """Displacements against the crank angle, which runs as the crank does, and how to draw them."""
    count = SAMPLES * found.turns
    choices: list[Values] = []
    for name, gauge in found.gauges.items():
        array = f"response.{name}"
        block.add(array, gauge.displacement.samples(count))
        label = say("response of {gauge}", gauge=_spoken(name))
        choices.append(gauge_choice(name, label, gauge.rotation, array))
    charts = [chart("response", choices, chooser=say("Response of"))]
    notes = list(map(said, found.notes))
    swing = _swing(swinging(shown.scene, found), block)
    modes = [*_modes(shown.scene, found)]
    return {"charts": charts, "notes": notes, "swing": swing, "modes": modes, "arrays": block.told}


def _swing(scene: Scene, block: Block) -> list[str] | None:
    """What is to be said of the support's movement over the crank angle, which goes to the block.

    ``support.place`` : (2 N,) m, ``support.angle`` : (N,) rad; larger than true.
    """
    if scene.swing is None:
        return None
    block.add("support.place", scene.swing.place)
    block.add("support.angle", scene.swing.angle)
    return list(scene.swing.told)


def _modes(scene: Scene, found: Response) -> Iterator[Values]:
    """Modes of the support, as large as they are drawn.

    shape : real and imaginary parts of its displacements along x and y (m) and of its rotation.
    """
    support = found.machine.support
    assert support is not None
    for number, mode in enumerate(found.modes, 1):
        one = ModeSwing.of(scene, number, mode, support.coordinates)
        parts = (complex(one.amplitudes[FREEDOMS.index(name)]) for name in PLANAR)
        shape = [number for part in parts for number in (part.real, part.imag)]
        yield {"told": list(one.told), "seen": one.seen, "shape": shape}


def _spoken(name: str) -> str:
    return name.replace("_", " ")


class OutdatedError(Exception):
    """The design is no longer shown."""


def more(found: Solved, outdated: Callable[[], bool]) -> Iterator[tuple[Values, bytes]]:
    """Planting figures, and the response over speed; each as values and a block of floats.

    outdated : tells when the design is no longer shown, so that the rest is not wanted.
    """
    machine = found.design.machine
    if found.analysis.strokes and not outdated():
        yield {"type": "strokes", "figures": [*_strokes(found.analysis)], "notes": []}, b""
    if machine.planting is not None and machine.drive.speed:
        planted = _planted(machine)
        if not outdated():
            yield planted, b""
    if not can_be_shaken(machine):
        return

    def progress(done: int, total: int) -> None:
        if outdated():
            raise OutdatedError

    try:
        shaken = swept(found, progress)
    except OutdatedError:
        return
    if shaken is not None and not outdated():
        content, data = shaken
        yield {"type": "response", **content}, data


def _shown(value: float, dimension: Dimension | None, unit: str | None = None) -> Values:
    """A figure in the unit in which it is told; None where it is not finite."""
    shown = display(dimension, [value], unit)
    there = shown.factor * value if isfinite(value) else None
    return {"unit": shown.name, "value": there, "text": text_of(there)}


def _strokes(analysis: Analysis) -> Iterator[Values]:
    """Figures of every slider and rocker, but for the crank angles at which they are."""
    for name, one in analysis.strokes.items():
        for kind in declared_figures():
            value = getattr(one, kind.name)
            if value is not None and not kind.name.endswith("_at"):
                path = f"strokes.{name}.{kind.name}"
                label = f"{joint_named(name)}: {say(kind.metadata['label'])}"
                shown = _shown(value, dimension_of(analysis.machine, f"{name}.{kind.name}"))
                yield {"name": path, "label": label, **shown}


def _planted(machine: Machine) -> Values:
    """Figures of the tip's path, None where they are not finite, or why there are none."""
    try:
        found = plant(machine)
    except EquipoiseError as error:
        return {"type": "planting", "figures": [], "notes": [error.told()]}
    figures = [
        {"name": name, "label": say(one.words), **_shown(float(value), told.dimension, told.unit)}
        for name, one in FIGURES.items()
        if name in found.figures
        for value in [found.figures[name]]
        for told in [cell(float(value), name)]
        if told is not None
    ]
    return {"type": "planting", "figures": figures, "notes": list(map(said, found.notes))}
