"""Planting figures of many designs at once, the same as `equipoise plant` gives of each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine
from equipoise.mechanism.steps import Call
from equipoise.studies.figures import Step

Array = np.ndarray[Any, Any]

OF_ONE = {"visits", "loops", "cusps", "tray_crossings", "forces"} | {
    *("speed", "forward_speed", "hill_spacing", "planting_frequency")
}
"""Keys of what `plant` reads off one machine, not off a curve of many."""
EACH_ITS_OWN = {"planting.depth", "planting.forward_speed", "planting.hill_spacing"}
"""Numbers of the field that may differ from machine to machine of a curve."""


def can_have(
    machine: Machine, paths: Sequence[str], figures: Sequence[Sequence[Step]]
) -> list[bool]:
    """Which of some figures can be had of many designs at once.

    paths : of the numbers that vary.  figures : as steps through what `plant` gives.
    """
    field = {path for path in paths if path.startswith("planting.")}
    alike = field <= EACH_ITS_OWN and not machine.gears
    alike = alike and all(isinstance(step, Call) for step in assemble(machine).motion)
    return [alike and steps[0] not in OF_ONE for steps in figures]


def planted(machines: Sequence[Machine], steps: Sequence[Sequence[Step]]) -> Array:
    """Figures (P, m) of machines of one build whose cranks turn fully; NaN where one is missing."""
    from equipoise.mechanism.tip import TipCurve
    from equipoise.planting.figures import tip_figures
    from equipoise.planting.stroke import TOUCH, soil_crossings

    curve = TipCurve(machines)
    entry, leave = soil_crossings(curve)
    lowest, highest = curve.lowest[0], curve.highest[0]
    touch = TOUCH * (highest - lowest)
    plants = (curve.surface > lowest + touch) & (curve.surface < highest - touch)
    plants &= curve.speed[:, 0] != 0
    names = [".".join(map(str, one)) for one in steps]
    wanted = {str(one[0]) for one in steps}
    found = tip_figures(curve, entry, leave, wanted=wanted)
    columns = [found.get(name, np.full(len(machines), np.nan)) for name in names]
    table: Array = np.where(plants[:, None], np.stack(columns, axis=1), np.nan)
    return table
