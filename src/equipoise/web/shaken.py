"""What takes longer to tell of a design: strokes, what it plants, how its support is shaken."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from equipoise.errors import EquipoiseError
from equipoise.i18n import said, say
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import joint_named
from equipoise.mechanism.strokes import declared_figures, dimension_of
from equipoise.planting.blocks import cell
from equipoise.planting.names import FIGURES
from equipoise.planting.summary import plant
from equipoise.quantities import Dimension, display
from equipoise.results.analysis import Analysis
from equipoise.vibration.forced import respond
from equipoise.vibration.resonance import around
from equipoise.vibration.response import Response
from equipoise.vibration.sampling import COARSE
from equipoise.vibration.sweep import sweep_speed
from equipoise.web.edits import Solved
from equipoise.web.figures import chart, gauge_choice, text_of
from equipoise.web.state import Block

Values = dict[str, Any]
SAMPLES = 360
"""In a turn."""


def can_be_shaken(machine: Machine) -> bool:
    """Whether there is a support, and masses that shake it."""
    return machine.support is not None and not massless(machine)


def response_of(machine: Machine) -> tuple[Values, bytes] | None:
    """What the gauges read over a turn at the machine's speed; None where nothing can be shaken.

    Where there is no steady state, no gauges and a note that says so.
    """
    if not can_be_shaken(machine):
        return None
    block = Block()
    try:
        found = respond(machine)
    except EquipoiseError as error:
        return {"charts": [], "arrays": {}, "notes": [str(error)]}, b""
    return _told(found, block), block.data


def swept(machine: Machine, progress: Callable[[int, int], None]) -> tuple[Values, bytes] | None:
    """The same with the response over speeds around the machine's own.

    progress : as of `sweep_speed`; what it raises ends the work.
    """
    try:
        found = respond(machine)
        ends = around(machine.drive, found.speed)
        curves = sweep_speed(machine, *ends, speeds=COARSE, progress=progress)
    except EquipoiseError:  # of which `response_of` has told
        return None
    block = Block()
    content = _told(found, block)
    block.add("sweep.speed", curves.speed)
    choices: list[Values] = []
    for name, curve in curves.gauges.items():
        array = f"sweep.{name}"
        block.add(array, curve.peak_to_peak)
        label = f"{_spoken(name)} against speed, peak to peak"
        choices.append(gauge_choice(name, label, curve.rotation, array, log=True))
    rpm = display("angular speed", (), "rpm")
    over = {"array": "sweep.speed", "unit": rpm.name, "factor": rpm.factor, "at": found.speed}
    content["charts"].append(chart("sweep", choices, x=over))
    content["arrays"] = block.told
    return content, block.data


def _told(found: Response, block: Block) -> Values:
    """Displacements against the crank angle, which runs as the crank does."""
    count = SAMPLES * found.turns
    choices: list[Values] = []
    for name, gauge in found.gauges.items():
        array = f"response.{name}"
        block.add(array, gauge.displacement.samples(count))
        label = f"response of {_spoken(name)}"
        choices.append(gauge_choice(name, label, gauge.rotation, array))
    charts = [chart("response", choices, chooser="Response of")]
    return {"charts": charts, "arrays": block.told, "notes": list(map(said, found.notes))}


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
        shaken = swept(machine, progress)
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
        return {"type": "planting", "figures": [], "notes": [str(error)]}
    figures = [
        {"name": name, "label": one.words, **_shown(float(value), told.dimension, told.unit)}
        for name, one in FIGURES.items()
        if name in found.figures
        for value in [found.figures[name]]
        for told in [cell(float(value), name)]
        if told is not None
    ]
    return {"type": "planting", "figures": figures, "notes": list(map(said, found.notes))}
