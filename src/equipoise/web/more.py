"""What takes longer to tell of a design than a page has between two moves of a drag."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from equipoise.errors import EquipoiseError
from equipoise.mechanism.model import Machine
from equipoise.planting.summary import plant
from equipoise.report.effects import PATH
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


def _planted(machine: Machine) -> Values:
    """Figures of the tip's path, None where they are not finite, or why there are none."""
    try:
        found = plant(machine)
    except EquipoiseError as error:
        return {"type": "planting", "figures": [], "notes": [str(error)]}
    figures = [
        {"name": name, "label": label, "unit": unit, "value": value if isfinite(value) else None}
        for name, label, factor, unit in PATH
        if name in found.figures
        for value in [factor * float(found.figures[name])]
    ]
    return {"type": "planting", "figures": figures, "notes": list(found.notes)}
