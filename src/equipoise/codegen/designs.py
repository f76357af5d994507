"""Designs as a table, one row a design; the crank angles of a loop; how large signals are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from math import pi
from typing import Any

import numpy as np

from equipoise.codegen.source import Source
from equipoise.mechanism.family import linkage_of, with_columns, wrong
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import Machine
from equipoise.mechanism.steps import size_of_bodies

Array = np.ndarray[Any, Any]


def all_angles(count: int, turns: int) -> Array:
    """`count` crank angles (rad) in each turn, equally spaced from 0."""
    return np.arange(count * turns) * (2 * pi / count)


def angles_between(count: int, turns: int) -> Array:
    """The angles half-way between those of `all_angles`."""
    return all_angles(count, turns) + pi / count


def grid_of(source: Source, theta: Array) -> Array:
    """Rows (G, N) of what the source wants to know of crank angles (N,), rad."""
    return np.ascontiguousarray([row.values(theta) for row in source.rows], dtype=float)


def sizes_of(machine: Machine, signals: Sequence[str]) -> dict[str, Any]:
    """Size of each signal, in its own unit; a column (P, 1) where numbers of the machine are."""
    size, speed = size_of_bodies(machine), np.abs(machine.drive.speed)
    masses = (0.0 if link.mass is None else link.mass for link in machine.links.values())
    mass = reduce(np.add, masses)
    force = mass * (size * speed**2 + np.hypot(*machine.gravity))
    rates = {"v": speed, "a": speed**2}
    found = {}
    for signal in signals:
        last = signal.rpartition(".")[2]
        if signal.startswith("points."):
            found[signal] = size * rates.get(last[0], 1.0)
        elif signal.startswith("links."):
            found[signal] = speed if last == "angular_velocity" else speed**2
        elif last in ("shaking_moment", "frame_moment", "drive_torque", "moment"):
            found[signal] = force * size
        else:
            found[signal] = force
    return found


def has_steps(machine: Machine) -> bool:
    """Whether loads begin or end at once, so that means come closer as 1 / N only."""
    return any(load.start is not None for load in machine.loads)


@dataclass(frozen=True, eq=False)
class Designs:
    """Some designs (P) of a machine.

    table : (P, T) numbers, as the source wants them.
    refused : (P,) whether no machine can have them; those have the numbers of the base.
    machine : the machine with their numbers as columns.
    """

    source: Source
    table: Array
    refused: Array
    machine: Machine

    def sizes(self, some: Array) -> Mapping[str, Any]:
        """Size of each signal of some of the designs, (K,) or one for all."""
        found = sizes_of(self.machine, self.source.gathered.signals)
        return {name: size[some, 0] if np.ndim(size) else size for name, size in found.items()}


def designs_of(source: Source, base: Linkage, paths: Sequence[str], values: Array) -> Designs:
    """Designs of a base by the numbers (P, d) that vary, SI units, and their paths."""
    columns = {path: values[:, k, None] for k, path in enumerate(paths)}
    machine = with_columns(base.machine, columns)
    refused = np.zeros(len(values), dtype=bool) | wrong(machine, base, columns)
    found = linkage_of(machine, base)
    table = np.empty((len(values), sum(1 + slot.vector for slot in source.slots)))
    place = 0
    for slot in source.slots:
        width = 1 + slot.vector
        value, own = slot.read(found), slot.read(base)
        parts = ("real", "imag")[:width]
        for column, part in zip(table[:, place : place + width].T, parts, strict=True):
            column[:] = np.ravel(np.real(getattr(value, part)))
            column[refused] = getattr(own, part)
        place += width
    return Designs(source, table, refused, machine)
