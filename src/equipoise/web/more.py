"""What takes longer to tell of a design than a page has between two moves of a drag."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from equipoise.errors import EquipoiseError
from equipoise.mechanism.model import Machine
from equipoise.planting.blocks import EXTREMES, PATH, SOIL, cell
from equipoise.planting.summary import plant
from equipoise.quantities import display, in_unit
from equipoise.web.edits import Solved
from equipoise.web.shaken import can_be_shaken, swept

Values = dict[str, Any]


class OutdatedError(Exception):
    """The design is no longer shown."""


def more(found: Solved, outdated: Callable[[], bool]) -> Iterator[tuple[Values, bytes]]:
    """Planting figures, and the response over speed; each as values and a block of floats.

    outdated : tells when the design is no longer shown, so that the rest is not wanted.
    """
    machine = found.design.machine
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


_LABELS = {**PATH, **SOIL, **{f"{name}.value": label for name, label in EXTREMES.items()}}


def _shown(name: str, value: float) -> Values:
    """A figure in the unit in which it is told; None where it is not finite."""
    told = cell(value, name)
    assert told is not None
    unit = display(told.dimension, [value]) if told.unit is None else in_unit(told.unit)
    return {"unit": unit.name, "value": unit.factor * value if isfinite(value) else None}


def _planted(machine: Machine) -> Values:
    """Figures of the tip's path, None where they are not finite, or why there are none."""
    try:
        found = plant(machine)
    except EquipoiseError as error:
        return {"type": "planting", "figures": [], "notes": [str(error)]}
    figures = [
        {"name": name, "label": label, **_shown(name, float(found.figures[name]))}
        for name, label in _LABELS.items()
        if name in found.figures
    ]
    return {"type": "planting", "figures": figures, "notes": list(map(str, found.notes))}
