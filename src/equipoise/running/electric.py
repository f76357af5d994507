"""The circuit of a direct-current motor in a run."""

from __future__ import annotations

from equipoise.dataclass import dataclass
from equipoise.signals import Array


@dataclass(frozen=True, eq=False)
class Electric:
    """The circuit of a direct-current motor, at the M instants of a run.

    current : (M,) A.  supply : work of its supply since the start (M,), J.  heat : of that, what
    its resistance has turned into heat, and a switch with what the field held (M,), J.
    """

    current: Array
    supply: Array
    heat: Array

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (M,) of every signal."""
        units = {"current": "A", "supply": "J", "heat": "J"}
        return [(f"electric.{name}", unit, getattr(self, name)) for name, unit in units.items()]
