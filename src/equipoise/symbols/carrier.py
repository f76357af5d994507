"""The support of a machine as it is seen from the side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.mechanism.model import Machine
from equipoise.mechanism.support import Gauge, Mount, Support
from equipoise.symbols.shapes import hull


@dataclass(frozen=True)
class Carrier:
    """The support as it is seen from the side; places complex, m.

    corners : all places by which it is drawn.  center : its centre of mass.
    reference : the pivot or, where there is none, the centre of mass.
    """

    support: Support
    corners: tuple[complex, ...]
    center: complex
    reference: complex

    @property
    def items(self) -> dict[str, Mount | Gauge]:
        """Mounts, then gauges."""
        return {**self.support.mounts, **self.support.gauges}

    @classmethod
    def of(cls, machine: Machine) -> Carrier | None:
        """That of a machine; None where it stands on solid ground."""
        support = machine.support
        if support is None:
            return None
        offsets = {complex(*row.offset) for row in machine.rows} or {0j}
        corners = [complex(*place) + by for place in machine.frame.values() for by in offsets]
        items: list[Mount | Gauge] = [*support.mounts.values(), *support.gauges.values()]
        corners += [complex(*item.point[:2]) for item in items if item.point is not None]
        center, reference = (complex(*z[:2]) for z in (support.center_of_mass, support.reference))
        around = hull(np.array([*corners, center, reference]))
        return cls(support, tuple(map(complex, around)), center, reference)
