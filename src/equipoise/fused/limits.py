"""What loops can do: which machines, numbers and figures."""

from __future__ import annotations

from collections.abc import Sequence

from equipoise.errors import MassError, UsageError
from equipoise.fused.emit import can_emit, emit
from equipoise.fused.figures import Figure, Gathered
from equipoise.mechanism.columns import can_vary
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine


def can_have(machine: Machine, paths: Sequence[str], figure: Figure) -> bool:
    """Whether a loop can compute a figure of designs in which these numbers vary."""
    linkage = assemble(machine)
    if not can_emit(linkage) or not all(can_vary(machine, path) for path in paths):
        return False
    try:
        emit(linkage, Gathered.of([figure]))
    except (UsageError, MassError):
        return False
    return True
