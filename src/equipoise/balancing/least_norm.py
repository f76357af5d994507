"""The smallest first moments that, added to some links, make the shaking force zero.

(84) to (87) of Yamashita, Ichikawa and Mori for any linkage: the conditions are linear in the added
moments x, rows x = -residuals, and x has the least sum of squares; moments of free links cost
nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.balancing.linear_conditions import Conditions, conditions, parameter_scales
from equipoise.errors import UsageError
from equipoise.mechanism.model import Machine, Vector, unknown
from equipoise.mechanism.parameters import parameter_values
from equipoise.results.result import Result
from equipoise.signals import Array

MET = 1e-9
"""Share of a condition's largest term that may be left of it."""
RANK = 1e-10
"""Share of the largest singular value below which one counts as none."""


@dataclass(frozen=True, eq=False, repr=False)
class Added(Result):
    """First moments to be added, in the axes of each link, kg m.

    moments : link -> (x, y) to be added.  totals : link -> (x, y) that it then has, about the
        origin of its axes.
    cost : root of the sum of squares of the moments of all links that are not free, kg m.
    machine : with them; masses, and moments of inertia about the centres of mass, are kept.
    """

    shown_in = "balancing.condition_blocks"

    moments: Mapping[str, Vector]
    totals: Mapping[str, Vector]
    cost: float
    machine: Machine

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        centers = {link: self.machine.links[link].center_of_mass for link in self.moments}
        return {
            "added": {link: list(moment) for link, moment in self.moments.items()},
            "total": {link: list(moment) for link, moment in self.totals.items()},
            "center_of_mass": {link: list(center or ()) for link, center in centers.items()},
            "cost": self.cost,
        }


def least_moments(machine: Machine, links: Sequence[str], free: Sequence[str] = ()) -> Added:
    """First moments with the least sum of squares that make the shaking force zero.

    Parameters
    ----------
    links : whose first moments count.
    free : links that may take any first moment without cost.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    UsageError : there is no such link, one is named twice or has mass 0, or these links do not
        suffice.
    """
    names = _checked(machine, links, free)
    found = conditions(machine)
    places = [
        found.parameters.index((link, quantity))
        for link in names
        for quantity in ("moment_x", "moment_y")
    ]
    scale = _row_scales(machine, found)
    rows, right = found.coefficients[:, places] / scale[:, None], -found.residuals / scale
    costed = 2 * len(names) - 2 * len(free)
    x = _least(rows[:, :costed], rows[:, costed:], right)
    _refuse_rest(found, rows @ x - right, names)
    whole = parameter_values(machine)[places] + x
    changed = machine
    for link, moment in zip(names, whole.reshape(-1, 2), strict=True):
        mass = machine.links[link].mass
        assert mass is not None
        center = (float(moment[0] / mass), float(moment[1] / mass))
        changed = changed.with_link(link, center_of_mass=center)
    cost = float(np.linalg.norm(x[:costed]))
    return Added(_by_link(names, x), _by_link(names, whole), cost, changed)


def _checked(machine: Machine, links: Sequence[str], free: Sequence[str]) -> list[str]:
    names = [*links, *free]
    for k, name in enumerate(names):
        if name not in machine.links:
            raise UsageError(unknown(name, machine.links, "link"))
        if name in names[:k]:
            raise UsageError(f"{name} is named twice; name each link once")
        if machine.links[name].mass == 0:
            raise UsageError(f"{name} has mass 0 and so no first moment; give it a mass")
    return names


def _row_scales(machine: Machine, found: Conditions) -> Array:
    """Size of each condition's terms (B,) at the machine's mass, in its own unit."""
    mass = machine.mass or 1.0
    sizes: Array = np.max(np.abs(found.coefficients * parameter_scales(machine)), axis=1) * mass
    return sizes


def _least(costed: Array, free: Array, right: Array) -> Array:
    """Solution of costed x + free z = right with the least |x|; of least squares where none is."""
    blind = _blind_to(free)
    x = np.linalg.lstsq(blind @ costed, blind @ right, rcond=RANK)[0]
    z = np.linalg.lstsq(free, right - costed @ x, rcond=RANK)[0]
    return np.concatenate([x, z])


def _blind_to(columns: Array) -> Array:
    """Rows that are orthogonal to columns, and to each other."""
    left, sizes, _ = np.linalg.svd(columns, full_matrices=True)
    rank = int(np.sum(sizes > RANK * np.max(sizes, initial=0.0)))
    rows: Array = left[:, rank:].T
    return rows


def _refuse_rest(found: Conditions, rest: Array, names: list[str]) -> None:
    if rest.size and np.max(np.abs(rest)) > MET:
        worst = found.sentences[int(np.argmax(np.abs(rest)))]
        raise UsageError(
            f"first moments of {', '.join(names) or 'no link'} cannot meet {worst}; name more links"
        )


def _by_link(names: list[str], flat: Array) -> dict[str, Vector]:
    return {
        link: (float(pair[0]), float(pair[1]))
        for link, pair in zip(names, flat.reshape(-1, 2), strict=True)
    }
