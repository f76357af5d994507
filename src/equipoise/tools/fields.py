"""The shape of the shaft between its nodes: displacement, slope, moment and shear anywhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from equipoise.errors import UsageError
from equipoise.tools.chain import States
from equipoise.tools.layout import Kind, Layout

Array = np.ndarray[Any, Any]


class Line(NamedTuple):
    """Of some places (X) of the shaft, in both planes: arrays (X, 2, F).

    displacement (m) and slope (rad); moment (N m) and shear (N), just right of a station.
    """

    displacement: Array
    slope: Array
    moment: Array
    shear: Array


@dataclass(frozen=True, eq=False)
class Field:
    """The answer of a layout at complex frequencies s (1 or 2, F)."""

    layout: Layout
    s: Array
    states: States
    kind: Kind = "forced"

    def at(self, places: Array) -> Line:
        """Shape at some places (X), m from the left end.

        Raises
        ------
        UsageError : a place is off the shaft.
        """
        places = np.asarray(places, dtype=float)
        length = self.layout.tool.shaft.length
        if np.any((places < 0) | (places > length)):
            raise UsageError(f"got a place off the shaft; give places from 0 to {length:g} m")
        starts = np.array([cell.start for cell in self.layout.cells])
        which = np.clip(np.searchsorted(starts, places, "right") - 1, 0, len(starts) - 1)
        over = self.layout.part(which, places - starts[which], self.s, self.kind)
        w, t = (np.array(part)[which] for part in zip(*self.states.motion, strict=True))
        v, m = (np.array(part)[which] for part in zip(*self.states.force, strict=True))
        displacement, slope, shear, moment = over.carried(w, t, v, m)
        return Line(displacement, slope, moment, shear)
