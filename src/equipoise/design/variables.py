"""What may change in a design problem."""

from __future__ import annotations

from equipoise.dataclass import dataclass
from equipoise.design.spreads import Spread


@dataclass(frozen=True)
class Variable:
    """A number that varies.

    path : of a number in the model file, such as ``links.crank.points.B.x``, or the name of a
        `Lift`, such as ``crank``, the length of that link.
    spread : what it may be, SI units.
    dimension : of its quantity, None for a plain number; a study has it from its model.
    """

    path: str
    spread: Spread
    dimension: str | None = None
