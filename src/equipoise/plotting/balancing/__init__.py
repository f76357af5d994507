"""The pictures of balancing: what to change, what that does, and what can be traded for what."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.balancing.pareto import Front
from equipoise.balancing.phase_search import Phasing
from equipoise.figures.changes import changes_figure
from equipoise.plotting.balancing.front import front_figure
from equipoise.plotting.balancing.orders import orders_figures
from equipoise.plotting.balancing.phases import phases_figure, together_figure
from equipoise.plotting.balancing.signals import signal_figures
from equipoise.plotting.style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.model import Machine


def drawings(
    found: Balanced | Phasing | Front, original: Machine | None = None
) -> dict[str, Figure]:
    """Every picture of a result of balancing by name, which also does for a file.

    Of a balanced machine ``force``, ``polar``, ``moment``, ``torque``; ``orders`` where a force,
    moment or torque was made small, with ``orders-2`` and so on where there are many; ``changes``.
    Where phases of rows are chosen, ``phases`` and ``rows``; then the others only if the linkage
    itself is changed too.  Of a trade-off ``front``.

    original : the machine before; phases alone do not know it.
    """
    with styled():
        if isinstance(found, Front):
            return {"front": front_figure(found)}
        if isinstance(found, Phasing):
            return _of_rows(original, found.machine)
        return _of_balanced(found)


def _of_balanced(found: Balanced) -> dict[str, Figure]:
    of_linkage = any(change.kind != "phases" for change in found.changes)
    drawn = signal_figures(found) if of_linkage else {}
    for number, figure in enumerate(orders_figures(found), 1):
        drawn["orders" if number == 1 else f"orders-{number}"] = figure
    if of_linkage:
        drawn["changes"] = changes_figure(found)
    if found.phasing is not None:
        drawn |= _of_rows(found.original, found.machine)
    return drawn


def _of_rows(original: Machine | None, machine: Machine) -> dict[str, Figure]:
    return {
        "phases": phases_figure(original, machine),
        "rows": together_figure(original, machine),
    }
