"""The motion of a planar support in time: what its gauges read, and how its mounts push."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

from equipoise.dataclass import dataclass
from equipoise.quantities import Dimension
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array
from equipoise.vibration.body import MountContact, Reading, SupportBody
from equipoise.vibration.linear import gauges_of
from equipoise.vibration.response import of_support


def _signal(name: str, dimension: Dimension, turned: Dimension) -> ResultOutput:
    """A signal (M,) of a gauge or mount."""
    return ResultOutput(name, dimension, turned, read=lambda values: values, column=name)


@dataclass(frozen=True, eq=False)
class SupportMotion:
    """How a support moves, at M instants.

    place, rate : displacements and velocities (3, M) along surge, heave and pitch, m and rad.
    contacts : its mounts.
    """

    body: SupportBody
    place: Array
    rate: Array
    contacts: tuple[MountContact, ...]

    @cached_property
    def gauges(self) -> Mapping[str, Array]:
        """Displacement (M,) at each gauge, m or rad."""
        return {
            name: Reading.of(self.body, gauge).displacement(self.place)
            for name, gauge in gauges_of(self.body).items()
        }

    @cached_property
    def mounts(self) -> Mapping[str, Array]:
        """Force (M,) of each mount, N or N m."""
        return {contact.name: contact.force(self.place, self.rate) for contact in self.contacts}

    declared: ClassVar[Declarations] = {
        "gauges": of_support(
            "gauges", "of each gauge", {"displacement": _signal("displacement", "length", "angle")}
        ),
        "mounts": of_support(
            "mounts", "of each mount", {"force": _signal("force", "force", "torque")}
        ),
    }
