"""Mounts of a support whose motion is integrated: one-sided ones let go and touch again.

The force of a one-sided mount bends where it lets go.  So each is taken to touch, or not to, until
its force changes its sign at an instant that is sought, and goes on smoothly in between.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from equipoise.signals import Array
from equipoise.vibration.support_place import SpatialMounts, SupportPlace

Read = Callable[[Array, Array], SupportPlace]
"""Where the support is, by coordinates (C, K) of a machine and their rates."""
AT_CONTACT = 1e-9
"""Share of a mount's usual force within which it is just letting go, or touching."""


class MountContacts:
    """The mounts of a support, and which of them touch.

    one_sided : names of mounts that push only, and their places.
    """

    def __init__(self, mounts: SpatialMounts, size: float, read: Read) -> None:
        """size : of usual displacements, m.  read : where the support is."""
        self.read = read
        contacts = mounts.contacts
        self.one_sided = {item.name: k for k, item in enumerate(contacts) if item.one_sided}
        smooth = [replace(contact, one_sided=False) for contact in contacts]
        self._smooth = SpatialMounts(smooth, mounts.at)
        self._sizes = [abs(item.preload) + item.stiffness * size or 1.0 for item in contacts]
        self._touches = [True] * len(contacts)

    def wrench(self, at: SupportPlace) -> Array:
        """Generalized forces (6, K) on a support."""
        return self._smooth.wrench(at, self._touches)

    def left(self, name: str, coordinates: Array, rates: Array) -> Array:
        """How far (K,) a one-sided mount is from letting go, or from touching, as a share of its
        usual force, with coordinates (C, K) and their rates.
        """
        mount = self.one_sided[name]
        share = self._smooth.forces(self.read(coordinates, rates))[mount] / self._sizes[mount]
        return np.asarray(share if self._touches[mount] else -share)

    def observe(self, coordinates: Array, rates: Array) -> None:
        """Set which of them touch in a state (C, 1), but for those that are about to change."""
        for name in self.one_sided:
            if float(self.left(name, coordinates, rates)[0]) < -AT_CONTACT:
                self.switch(name)

    def switch(self, name: str) -> None:
        """A mount lets go, or touches again."""
        self._touches[self.one_sided[name]] ^= True
