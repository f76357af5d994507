"""The motion of a support in time: what its gauges read, and how its mounts push."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

from equipoise.dataclass import dataclass
from equipoise.quantities import Dimension
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array
from equipoise.vibration.body import SupportBody
from equipoise.vibration.linear import gauges_of
from equipoise.vibration.response import of_support
from equipoise.vibration.support_place import SpatialMounts, SpatialReadings, SupportPlace


def _signal(name: str, dimension: Dimension, turned: Dimension) -> ResultOutput:
    """A signal (M,) of a gauge or mount."""
    return ResultOutput(name, dimension, turned, read=lambda values: values, column=name)


@dataclass(frozen=True, eq=False)
class SupportMotion:
    """How a support moves, at M instants.

    at : where it is, and how it moves there.  mounted : its mounts.
    """

    body: SupportBody
    at: SupportPlace
    mounted: SpatialMounts

    @property
    def place(self) -> Array:
        """Displacements (6, M), m, and rotation vector, rad, in the order of `FREEDOMS`."""
        return self.at.place

    @property
    def rate(self) -> Array:
        """Their rates by time (6, M)."""
        return self.at.rate

    @cached_property
    def gauges(self) -> Mapping[str, Array]:
        """Displacement (M,) at each gauge, m or rad."""
        gauges = gauges_of(self.body)
        moved, _ = SpatialReadings.of(self.body, [*gauges.values()]).read(self.at)
        return dict(zip(gauges, moved, strict=True))

    @cached_property
    def mounts(self) -> Mapping[str, Array]:
        """Force (M,) of each mount, N or N m."""
        names = (contact.name for contact in self.mounted.contacts)
        return dict(zip(names, self.mounted.forces(self.at), strict=True))

    @property
    def smooth_forces(self) -> Array:
        """(G, M) of its mounts, N or N m, below 0 where a one-sided mount would have to pull."""
        smooth = [replace(contact, one_sided=False) for contact in self.mounted.contacts]
        return SpatialMounts(smooth, self.mounted.at).forces(self.at)

    declared: ClassVar[Declarations] = {
        "gauges": of_support(
            "gauges", "of each gauge", {"displacement": _signal("displacement", "length", "angle")}
        ),
        "mounts": of_support(
            "mounts", "of each mount", {"force": _signal("force", "force", "torque")}
        ),
    }
