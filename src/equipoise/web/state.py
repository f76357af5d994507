"""What a page is sent of a machine: plain values, and arrays in one block of 32-bit floats."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

import numpy as np

from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import DECLARED, GROUPS, Declared
from equipoise.mechanism.tip import surface_of
from equipoise.quantities import display
from equipoise.results.analysis import Analysis
from equipoise.signals import Periodic
from equipoise.symbols.scene import Scene
from equipoise.web.edits import Solved, extent_of, movable
from equipoise.web.stage import stage_of

Array = np.ndarray[Any, Any]
Values = dict[str, Any]

MOST_ORDER = 20
"""Highest order of the spectra."""


@dataclass
class Block:
    """Arrays one behind the other, as 32-bit floats, and where each begins."""

    places: dict[str, tuple[int, int]] = field(default_factory=dict)
    parts: list[Array] = field(default_factory=list)
    size: int = 0

    def add(self, name: str, values: Array) -> None:
        """Add real (N,) values, or complex ones as (2 N,): x and y in turn."""
        flat = np.ascontiguousarray(values)
        if np.iscomplexobj(flat):
            flat = flat.view(float)
        with np.errstate(over="ignore"):  # what no drawing could show
            self.parts.append(flat.astype("<f4"))
        self.places[name] = (self.size, flat.size)
        self.size += flat.size

    @property
    def told(self) -> dict[str, list[int]]:
        """Offset and length of each array, in numbers."""
        return {name: list(place) for name, place in self.places.items()}

    @property
    def data(self) -> bytes:
        """All arrays, little-endian."""
        return b"".join(part.tobytes() for part in self.parts)


def state_of(
    found: Solved, before: Solved | None, wanted: Sequence[str] = ()
) -> tuple[Values, bytes]:
    """Everything that a page draws of a machine.

    before : with which it is compared, if with any.
    wanted : names of further outputs that it draws, as far as there are such.
    """
    analysis, block = found.analysis, Block()
    machine, motion = analysis.machine, analysis.motion
    scene = Scene.of(motion)
    block.add("crank_angle", scene.crank_angle)
    for name, place in scene.places.items():
        block.add(f"place.{name}", place)
    for name, place in scene.mass_centers.items():
        block.add(f"mass_center.{name}", place)
    for name, link in motion.links.items():
        block.add(f"angle.{name}", link.angle)
    for guide in scene.guides:
        block.add(f"guide.{guide.name}", guide.way)
    signals = signals_of(analysis)
    _add_signals(block, signals, analysis)
    _add_outputs(block, analysis, wanted)
    old = None
    if before is not None:
        old = signals_of(before.analysis)
        _add_signals(block, old, before.analysis, "before.")
        _add_outputs(block, before.analysis, wanted, "before.")
    content: Values = {
        "name": found.design.name,
        "title": machine.title,
        "description": machine.description,
        "angles": len(scene.crank_angle),
        "turns": motion.turns,
        "speed": motion.speed,
        "has_forces": analysis.solved is not None,
        "missing": [name for name, link in machine.links.items() if not link.has_mass],
        "scene": stage_of(scene, movable(machine)),
        "figures": [*_figures(signals, old, _size_of(machine))],
        "outputs": [
            {
                "name": one.name,
                "label": one.label(),
                "group": GROUPS[one.group],
                "unit": shown.name,
                "factor": shown.factor,
            }
            for one in analysis.outputs
            for shown in [display(one.dimension)]
        ],
        "orders": _orders(analysis),
        "notes": [massless(machine)] if analysis.solved is None else [],
        "before": before is not None,
        **_ground(found, scene, block),
    }
    content["arrays"] = block.told
    return content, block.data


def signals_of(analysis: Analysis) -> dict[str, Array]:
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


def _together(analysis: Analysis) -> dict[str, Array]:
    """The same of all rows together, where there are several and they turn."""
    if analysis.motion.speed == 0:
        return {}
    return {f"rows.{name}": values for name, values in analysis.together.items()}


def _add_outputs(block: Block, analysis: Analysis, names: Sequence[str], prefix: str = "") -> None:
    """Outputs that the page has asked for, in the unit in which it reads them."""
    for name in names:
        if name in analysis.outputs:
            block.add(f"{prefix}output.{name}", analysis.outputs[name].values)


def _add_signals(
    block: Block, signals: dict[str, Array], analysis: Analysis, prefix: str = ""
) -> None:
    if prefix and signals:
        block.add(f"{prefix}crank_angle", analysis.crank_angle)
    for name, values in signals.items():
        block.add(f"{prefix}{name}", values)
    for name, sizes in _spectra(analysis, signals):
        block.add(f"{prefix}spectrum.{name}", sizes)


def _spectra(analysis: Analysis, signals: dict[str, Array]) -> Iterator[tuple[str, Array]]:
    """Amplitude at each order that is shown, by name."""
    if analysis.solved is None:
        return
    turns = analysis.motion.turns
    for one in analysis.outputs.ordered:
        if one.declared.compared:
            yield one.name, _sizes(analysis.by_order[one.name])
    whole = signals.get("rows.shaking_force")
    if whole is not None:
        yield "rows.shaking_force.x", _sizes(Periodic.of(whole.real, turns))
        yield "rows.shaking_force.y", _sizes(Periodic.of(whole.imag, turns))


def _sizes(signal: Periodic) -> Array:
    sizes = np.zeros(MOST_ORDER * signal.turns + 1)
    kept = signal.sizes[: len(sizes)]
    sizes[: len(kept)] = kept
    return sizes


def _orders(analysis: Analysis) -> list[float]:
    if analysis.solved is None:
        return []
    turns = analysis.motion.turns
    return [number / turns for number in range(MOST_ORDER * turns + 1)]


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.abs(values) ** 2)))


def _peak(values: Array) -> float:
    return float(np.max(np.abs(values)))


MEASURES = {"rms": ("RMS", _rms), "peak": ("peak", _peak)}


NOTHING = 1e-12
"""Of the largest force in the machine, and of its moment over the machine, below which a figure is
what rounding leaves of forces that cancel."""


def figures_of(analysis: Analysis, before: Analysis | None = None) -> list[Values]:
    """RMS and peak of each signal, with what they were before; 0 where that is rounding."""
    old = None if before is None else signals_of(before)
    return [*_figures(signals_of(analysis), old, _size_of(analysis.machine))]


def _size_of(machine: Machine) -> float:
    """Size of a machine with all its rows, m."""
    rows = [abs(length) for row in machine.rows for length in (row.lateral, *row.offset)]
    return max(extent_of(machine), *rows, 0.0)


def _figures(
    signals: dict[str, Array], old: dict[str, Array] | None, size: float
) -> Iterator[Values]:
    """The same of signals, for a machine of a size (m)."""
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
            entry = {
                "name": f"{name}.{measure}",
                "signal": label,
                "measure": measure,
                "label": f"{label}, {shown}",
                "unit": one.unit,
                "value": _plain(of(values), least),
            }
            yield entry if was is None else entry | {"before": _plain(of(was), least)}


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


def _with_parts(signals: dict[str, Array]) -> dict[str, Array]:
    """Signals with the components of the shaking force beside it."""
    force = signals.get("shaking_force")
    if force is None:
        return signals
    return {**signals, "shaking_force.x": force.real, "shaking_force.y": force.imag}


def _plain(value: float, least: float) -> float | None:
    """A number that JSON can hold; 0 below what counts."""
    if not isfinite(value):
        return None
    return value if value > least else 0.0


def _ground(found: Solved, scene: Scene, block: Block) -> Values:
    """Path of a planting tip over ground, and the soil that it goes into."""
    machine = found.analysis.machine
    planting, speed = machine.planting, found.motion.speed
    if planting is None or speed == 0:
        return {}
    way = planting.forward(speed) / speed * scene.crank_angle
    block.add(f"ground.{planting.tip}", scene.places[planting.tip] + way)
    return {"planting": {"tip": planting.tip, "surface": surface_of(machine)}}
