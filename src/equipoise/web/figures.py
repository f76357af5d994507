"""RMS and peak of what shakes the frame and drives the machine, as a page shows them."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

import numpy as np

from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import DECLARED, Declared
from equipoise.quantities import change, number, typeset
from equipoise.quantities.numbers import SAME
from equipoise.results.analysis import Analysis
from equipoise.web.edits import extent_of

Array = np.ndarray[Any, Any]
Signals = dict[str, Array]
Values = dict[str, Any]


def signals_of(analysis: Analysis) -> Signals:
    """Signals over the crank angle (N,), complex for vectors; none where masses are missing."""
    found = analysis.solved
    if found is None:
        return {}
    signals = {
        "shaking_force": found.shaking_force.value,
        "shaking_moment": found.shaking_moment,
        "drive_torque": found.drive_torque,
    }
    signals |= {f"joint.{name}": joint.size for name, joint in found.joints.items()}
    return signals | _together(analysis)


def _together(analysis: Analysis) -> Signals:
    """The same of all rows together, where there are several and they turn."""
    if analysis.motion.speed == 0:
        return {}
    return {f"rows.{name}": values for name, values in analysis.together.items()}


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.abs(values) ** 2)))


def _peak(values: Array) -> float:
    return float(np.max(np.abs(values)))


MEASURES = {"rms": ("RMS", _rms), "peak": ("peak", _peak)}


NOTHING = 1e-12
"""Of the largest force in the machine, and of its moment over the machine, below which a figure is
what rounding leaves of forces that cancel."""


def _size_of(machine: Machine) -> float:
    """Size of a machine with all its rows, m."""
    rows = [abs(length) for row in machine.rows for length in (row.lateral, *row.offset)]
    return max(extent_of(machine), *rows, 0.0)


def figures_of(signals: Signals, before: Signals | None, machine: Machine) -> list[Values]:
    """RMS and peak of each signal, with what they were before; 0 where that is rounding."""
    return [*_figures(signals, before, _size_of(machine))]


def _figures(signals: Signals, old: Signals | None, size: float) -> Iterator[Values]:
    parts = _with_parts(signals)
    olds, several = {} if old is None else _with_parts(old), "rows.shaking_force" in signals
    loudest = max(
        (_peak(values) for one in (parts, olds) for name, values in one.items() if _is_force(name)),
        default=0.0,
    )
    for name, one in told_signals().items():
        if name not in parts:
            continue
        values, was = parts[name], olds.get(name)
        least = NOTHING * loudest * (1.0 if _is_force(name) else size)
        label = one.say("", several)
        for measure, (shown, of) in MEASURES.items():
            value = _plain(of(values), least)
            entry = {
                "name": f"{name}.{measure}",
                "signal": label,
                "measure": measure,
                "label": f"{label}, {shown}",
                "unit": one.unit,
                "value": value,
                "text": text_of(value),
            }
            if was is not None:
                before = _plain(of(was), least)
                entry |= {"before": before, "was": _was(before, value)}
            yield entry


def told_signals() -> dict[str, Declared]:
    """Outputs of which figures are told: those of frame and drive, and of all rows together.

    The size of a vector stands before its components.
    """
    found = {
        name: one
        for name, one in DECLARED.items()
        if (one.group == "forces" and one.compared) or (one.group == "rows" and one.summed)
    }
    whole = {
        name: name.removesuffix(f".{one.part}") if one.part in ("x", "y") else name
        for name, one in found.items()
    }
    order = list(dict.fromkeys(whole.values()))
    first = sorted(found, key=lambda name: (order.index(whole[name]), name != whole[name]))
    return {name: found[name] for name in first}


def _is_force(name: str) -> bool:
    return name.startswith(("shaking_force", "rows.shaking_force", "joint."))


def _with_parts(signals: Signals) -> Signals:
    """Signals with the components of the shaking force beside it."""
    force = signals.get("shaking_force")
    if force is None:
        return signals
    return {**signals, "shaking_force.x": force.real, "shaking_force.y": force.imag}


NONE = "\N{EN DASH}"


def text_of(value: float | None) -> str:
    """A number as the page prints it; a dash where there is none."""
    return NONE if value is None or not isfinite(value) else typeset(number(value))


def compared(before: float, after: float) -> Values:
    """Texts of a figure before and after and of its change, and whether that is for the better."""
    if abs(after - before) <= SAME * abs(before):
        way = "same"
    else:
        way = "worse" if after > before else "better"
    texts = [text_of(before), text_of(after), typeset(change(before, after))]
    return {"before": before, "after": after, "texts": texts, "way": way}


def _was(before: float | None, value: float | None) -> str:
    """What a figure was, and by how much it has changed; nothing where it is the same."""
    if before is None or value is None:
        return ""
    told = compared(before, value)
    was, _, by = told["texts"]
    return "" if told["way"] == "same" else " · ".join(filter(None, (was, by)))


def _plain(value: float, least: float) -> float | None:
    """A number that JSON can hold; 0 below what counts."""
    if not isfinite(value):
        return None
    return value if value > least else 0.0
