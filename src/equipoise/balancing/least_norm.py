"""The smallest first moments that, added to some links, make the shaking force zero.

(84) to (87) of Yamashita, Ichikawa and Mori for any linkage: the conditions are linear in the added
moments x, rows x = -residuals, and x has the least sum of squares; moments of free links cost
nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from equipoise.balancing.linear_conditions import conditions, parameter_scales
from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq, svd
from equipoise.errors import UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.dynamics.parameters import parameter_values
from equipoise.mechanism.parts.machine import Machine, Vector, unknown
from equipoise.results.blocks import Block, Cell, Column, Table, Value
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

    moments: Mapping[str, Vector]
    totals: Mapping[str, Vector]
    cost: float
    machine: Machine

    blocks_in = "balancing.least_norm.added_blocks"

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
    names = [*links, *free]
    for k, name in enumerate(names):
        if name not in machine.links:
            raise UsageError(unknown(name, machine.links, "link"))
        if name in names[:k]:
            raise UsageError(Note("{name} is named twice; name each link once", name=name))
        if machine.links[name].mass == 0:
            raise UsageError(
                Note("{name} has mass 0 and so no first moment; give it a mass", name=name)
            )
    result = conditions(machine)
    places = [
        result.parameters.index((link, moment))
        for link in names
        for moment in ("moment_x", "moment_y")
    ]
    sizes = np.abs(result.coefficients * parameter_scales(machine))  # of each condition's terms
    scale = np.max(sizes, axis=1) * (machine.mass or 1.0)
    rows, right = result.coefficients[:, places] / scale[:, None], -result.residuals / scale
    costed = 2 * len(links)
    x = _least(rows[:, :costed], rows[:, costed:], right)
    rest = np.abs(rows @ x - right)
    if rest.size and np.max(rest) > MET:
        worst = result.sentences[int(np.argmax(rest))]
        raise UsageError(
            Note(
                "first moments of {names} cannot meet {worst}; name more links",
                names=", ".join(names) or "no link",
                worst=worst,
            )
        )
    moments, totals = (
        {
            link: (float(a), float(b))
            for link, (a, b) in zip(names, flat.reshape(-1, 2), strict=True)
        }
        for flat in (x, parameter_values(machine)[places] + x)
    )
    changed = machine
    for link, (first, second) in totals.items():
        mass = machine.links[link].mass
        assert mass is not None
        changed = changed.with_link(link, center_of_mass=(first / mass, second / mass))
    return Added(moments, totals, float(np.linalg.norm(x[:costed])), changed)


def _least(costed: Array, free: Array, right: Array) -> Array:
    """Solution of costed x + free z = right with the least |x|; of least squares where none is."""
    blind = _blind_to(free)
    x = lstsq(blind @ costed, blind @ right, rcond=RANK)[0]
    z = lstsq(free, right - costed @ x, rcond=RANK)[0]
    return np.concatenate([x, z])


def _blind_to(columns: Array) -> Array:
    """Rows that are orthogonal to columns, and to each other."""
    left, sizes, _ = svd(columns, full_matrices=True)
    rank = int(np.sum(sizes > RANK * np.max(sizes, initial=0.0)))
    return np.asarray(left[:, rank:].T)


def added_blocks(added: Added) -> Iterator[Block]:
    """First moments to be added, and what that makes of the centres of mass."""
    scale = max((abs(part) for pair in added.totals.values() for part in pair), default=0.0)
    rows: list[tuple[Cell, ...]] = []
    for link, moment in added.moments.items():
        center = added.machine.links[link].center_of_mass or (0.0, 0.0)
        size = max(map(abs, center))
        moments = (Value(1e3 * part, 1e3 * scale) for part in (*moment, *added.totals[link]))
        rows.append((link, *moments, *(Value(part, size) for part in center)))
    labels = (say("added x"), say("added y"), say("then x"), say("then y"))
    columns = (Column(""), *(Column(label, unit="kg mm") for label in labels))
    centers = (Column(say("centre x"), "length", "mm"), Column(say("centre y"), "length", "mm"))
    title = say("Least first moments that make the shaking force zero, in each link's axes")
    yield Table(title, (*columns, *centers), tuple(rows))
