"""Machines whose crank cannot turn, which swing instead where they are shown."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from equipoise.cli.options import linkage_of, naming
from equipoise.cli.outputs import tell

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine


def swinging(file: str, angles: Any = 1, speed: float | None = None) -> Machine:
    """The machine of a file, which swings where its crank cannot turn; then that is told.

    angles : number of crank angles in a turn; given ones are left to what a crank can reach.
    """
    from equipoise.mechanism.swings import swing

    machine = linkage_of(file, speed)
    with naming(file):
        found = swing(machine) if isinstance(angles, int) else None
    if found is None:
        return machine
    tell(f"note: {found.note}", sys.stderr)
    return found.machine
