"""The phases of rows on one shaft that make objectives smallest.

Section 5-5 of Yamashita, Ichikawa and Mori looks for the phase of two rows that makes the standard
deviation of their sum smallest, and 5-6 (1) asks for the phases of all rows at once, which was too
much work then.  Here every arrangement of a grid is looked at, and the best ones are polished.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from equipoise.balancing.phase_cost import Combine, Term
from equipoise.balancing.phase_search import Progress, PhaseSearch
from equipoise.mechanism.balance import Objective, Phases
from equipoise.mechanism.balance_outputs import OF_ROWS
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

SURVIVES = 1e-9
"""Share of the largest amplitude of all rows in phase, above which an order is left."""


@dataclass(frozen=True, eq=False)
class Phasing:
    """Phases found for the rows of a machine.

    machine : with the rows in these phases.  phases : rad, of each row; row 1 has kept its own.
    before, after : objective -> its value, in SI units.
    combined : all objectives together, before and after; each counts over its value before.
    remaining : orders of the shaking force of all rows together that are left.
    lateral : ``roll_moment`` and ``yaw_moment`` -> RMS before and after, N m.
    combinations : arrangements that the first grid has, of `step`, rad; 0 without a grid.
    """

    machine: Machine
    phases: tuple[float, ...]
    before: Mapping[str, float]
    after: Mapping[str, float]
    combined: tuple[float, float]
    remaining: tuple[float, ...]
    lateral: Mapping[str, tuple[float, float]]
    combinations: int
    step: float
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units and rad."""
        return {
            "title": self.machine.title,
            "phases": list(self.phases),
            "objectives": [
                {"name": name, "before": self.before[name], "after": self.after[name]}
                for name in self.before
            ],
            "combined": {"before": self.combined[0], "after": self.combined[1]},
            "remaining_orders": list(self.remaining),
            "lateral": {
                name: {"before": before, "after": after}
                for name, (before, after) in self.lateral.items()
            },
            "combinations": self.combinations,
            "step": self.step,
            "notes": list(self.notes),
        }


def choose_phases(
    machine: Machine,
    objectives: Sequence[Objective],
    phases: Phases | None = None,
    combine: Combine = "sum",
    progress: Progress | None = None,
) -> Phasing:
    """Look for the phases of a machine's rows that make objectives smallest; row 1 keeps its own.

    Where several arrangements are as good, the one with the least roll and yaw moment is taken.

    Parameters
    ----------
    objectives : outputs with their measures; see `balancing.row_outputs.Rows.signals`.
    phases : how finely to look; every 5 deg if None.
    combine : several objectives by their weighted sum, or by the root of the sum of squares.
    progress : is told how many arrangements of the grid have been looked at.

    Raises
    ------
    ModelError : there are fewer than two rows, or an objective cannot be measured.
    UsageError : no phase changes an objective, or there is none.
    MassError, MotionError, ResponseError : the machine cannot be computed.
    """
    search = PhaseSearch(machine, tuple(objectives), phases or Phases(), combine)
    found = search.best(search.pool(progress or (lambda done, total: None)))
    present, cost, grid = search.present, search.cost, search.grid
    placed = _placed(search, found)
    lateral = [Term(wish, search.rows.signals(wish)) for wish in map(_varying, OF_ROWS)]
    before, after = (
        {term.objective.name: term.told(at) for term in cost.terms} for at in (present, found)
    )
    return Phasing(
        machine=placed,
        phases=tuple(row.phase for row in placed.rows),
        before=before,
        after=after,
        combined=(float(cost.of([*before.values()])), float(cost.of([*after.values()]))),
        remaining=_remaining(search, found),
        lateral={term.objective.output: (term.told(present), term.told(found)) for term in lateral},
        combinations=0 if grid is None else grid.count,
        step=search.step if grid is None else grid.step,
        notes=tuple(_notes(search, found)),
    )


def _varying(output: str) -> Objective:
    return Objective(output, "ripple")


def _placed(search: PhaseSearch, found: Array) -> Machine:
    """The machine with phases (m,) relative to row 1."""
    if found is search.present or np.all(found == search.present):
        return search.machine
    first, *others = search.machine.rows
    turned = (first.phase + found[1:]) % search.cost.period
    moved = [replace(row, phase=phase) for row, phase in zip(others, turned.tolist(), strict=True)]
    return search.machine.with_rows([first, *moved])


def _remaining(search: PhaseSearch, phases: Array) -> tuple[float, ...]:
    force = search.force
    left = np.max(np.abs(force.total(phases)[0]), axis=0)
    loudest = float(np.max(np.abs(force.amplitudes), initial=0.0)) * len(phases)
    loud = left[1:] > SURVIVES * loudest
    return tuple(float(order) for order in force.orders[1:][loud])


def _notes(search: PhaseSearch, found: Array) -> Iterator[str]:
    if np.all(found == search.present):
        yield "no phases were found that are better than the present ones"
    grid = search.grid
    if grid is None:
        yield (
            "there are too many rows for a grid: random arrangements were polished instead, and "
            "better ones may exist"
        )
    elif grid.levels < search.levels:
        yield (
            f"a grid of {np.degrees(search.step):.4g} deg has too many arrangements: one of "
            f"{np.degrees(grid.step):.4g} deg was looked at as a whole, and the fine one about its "
            "best arrangements"
        )
    for term in search.cost.terms:
        if search.vanishes(term):
            yield (
                f"{term.objective.name} is 0 before, so it counts over the sum of what each row "
                "does alone"
            )
