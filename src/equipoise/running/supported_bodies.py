"""Masses of a linkage and of the support that bears it, about the anchors of its links.

Links are flat: their own inertia about an axis in the plane is half of that across it.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.forces import flywheel_on, inertia_about
from equipoise.mechanism.parts.links import masses_of, moments_across
from equipoise.running.drives_linkage import inertial_of
from equipoise.signals import Array
from equipoise.vibration.body import SupportBody


@dataclass(frozen=True, eq=False)
class SupportedBodies:
    """L links that have a mass or an inertia, and at last the support.

    share : of the support, and of what turns with links, that such a linkage has.
    """

    linkage: Linkage
    body: SupportBody
    share: float

    @cached_property
    def links(self) -> list[str]:
        """Names of the links."""
        return [*inertial_of(self.linkage, self.share)]

    @cached_property
    def flywheels(self) -> Array:
        """Moments of inertia (L, 1) of what turns with links, kg m2, as it presses in joints."""
        each = [flywheel_on(self.linkage.machine, link) for link in self.links]
        return self.share * np.array(each)[:, None]

    @cached_property
    def _constants(self) -> Array:
        """Of each link (L, 1), complex where in its plane: mass, first moment from the anchor and
        that across the plane, half the inertia about the anchor, the integral of the squares of the
        plane's axes that turns twice as fast as the link, those of the plane's axes times that
        across, and of the square of that.
        """
        rows = []
        for name in self.links:
            link, anchor = self.linkage.machine.links[name], self.linkage.anchors[name]
            mass, moment, inertia = inertia_about(link, anchor)
            across, out_of_plane = moments_across(link, anchor)
            thickness = sum(part * plane**2 for part, _, plane in masses_of(link))
            twice = moment**2 / (2 * mass) if mass else 0j
            rows.append([mass, moment, across, inertia / 2, twice, out_of_plane, thickness])
        return np.array(rows, complex).reshape(-1, 7).T[..., None]

    def inertias(self, turn: Array) -> Array:
        """Mass matrices (L + 1, 6, 6, K) at the anchors, for translations before rotations, kg,
        kg m and kg m2.

        turn : unit vectors (L, K), complex, of the links.
        """
        mass, moment, across, half, twice, out_of_plane, thickness = self._constants
        matrices = np.zeros((len(turn) + 1, 6, 6, turn.shape[-1]))
        matrices[-1] = self.share * self.body.mass[..., None]
        own, even = matrices[:-1], half.real + thickness.real
        first, squares, tilted = moment * turn, twice * turn**2, -out_of_plane * turn
        for axis in range(3):
            own[:, axis, axis] = mass.real
        own[:, 3, 3], own[:, 4, 4] = even - squares.real, even + squares.real
        own[:, 5, 5] = 2 * half.real
        for row, column, value in (
            (0, 4, across.real), (0, 5, -first.imag), (1, 3, -across.real), (1, 5, first.real),
            (2, 3, first.imag), (2, 4, -first.real),
            (3, 4, -squares.imag), (3, 5, tilted.real), (4, 5, tilted.imag),
        ):  # fmt: skip
            own[:, row, column] = own[:, column, row] = value
        return matrices
