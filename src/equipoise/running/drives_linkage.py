"""Equal linkages, `[[rows]]`, whose drives each go their own ways, and their inertia.

With q the angles of the driven links, i and j two of them, and p and alpha the place of a link's
anchor and its angle,

    M q.. + h = Q,    M_ij = sum of what a unit of acceleration of j demands, along dp/dq_i

where h is what the links demand while the drives do not accelerate, and Q the generalized force of
everything that acts beside the drives.  The steps of the linkage run once for many states: along
each q, where they give dp/dq, and along the velocity that the machine has, where the crank's speed
is 1, so that all derivatives by the crank angle are those by time.

The states of all rows stand side by side in the last axis of arrays (..., R K), one row after the
other, so that the linkage is computed once for all of them.  What the rows share, such as rotors, a
support, and torques on the shafts that turn them all, is divided among them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ResponseError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import frame_state, p, run, u
from equipoise.mechanism.dynamics.forces import flywheel_on, inertia_about
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.running.sources import AppliedSource, SourceInputs
from equipoise.signals import Array
from equipoise.vibration.linkages import rows_of

References = Mapping[str, Array]
"""About what running angles (..., K), and unknowns of loops, are, by their names in a linkage."""
STRIDE = 0.02
"""rad of the crank, by which loops are followed to the angle at which a run starts."""


class DriveAngles(NamedTuple):
    """Angles of all drives (N, K), rad, and their rates.

    crank_angle : (K,) rad.  speeds : rad/s.
    jacobian : (N, U, K), speeds with a unit of speed of each unknown alone.
    bias_accelerations : rad/s2, while no unknown accelerates.
    virtual_speeds : (N, U, K), with a unit of speed of each unknown while no given motion goes on,
    so that its drive does no work.
    effort_speeds : rad/s at which torques do work; of strokes m/s, at which forces do.
    lengths : of strokes (P, K), m.  slopes : of these by the angles of all drives (P, N, K), m/rad.
    """

    crank_angle: Array
    angles: Array
    speeds: Array
    jacobian: Array
    bias_accelerations: Array
    virtual_speeds: Array
    effort_speeds: Array
    lengths: Array
    slopes: Array


def drives_at(machine: Machine, crank_angle: float) -> tuple[Array, Array]:
    """Angles of all drives (N,), rad, as the file has them at a crank angle, rad, and their
    derivatives by it.
    """
    moved = machine.moved(np.array([crank_angle]))
    angles, rates = (
        np.array([np.ravel(moved[drive.link][order])[0] for drive in machine.driven])
        for order in (0, 1)
    )
    return angles, rates


@dataclass(frozen=True, eq=False)
class LinkageRows:
    """The R rows of a machine; the linkage of the file where it has none."""

    machine: Machine

    @cached_property
    def all(self) -> tuple[Row, ...]:
        """Phase and place of each row."""
        return rows_of(self.machine)

    @property
    def count(self) -> int:
        """How many rows."""
        return len(self.all)

    @cached_property
    def phases(self) -> Array:
        """(R,), rad, by which crank angles are larger than that of the drive."""
        return np.array([row.phase for row in self.all])

    @property
    def as_in_file(self) -> bool:
        """Whether there is one linkage, whose crank angle is that of the drive."""
        return self.count == 1 and not self.all[0].phase

    @cached_property
    def offsets(self) -> Array:
        """(R,), m, complex, of the planes of the rows beside the linkage of the file."""
        return np.array([complex(*row.offset) for row in self.all])

    @cached_property
    def laterals(self) -> Array:
        """(R,), m, z of the planes of the rows."""
        return np.array([row.lateral for row in self.all])

    def repeated(self, values: Array) -> Array:
        """(..., R K) of what is the same in all rows (..., K)."""
        return np.tile(values, self.count) if self.count > 1 else values

    def of_each(self, values: Array, count: int) -> Array:
        """(..., R K) of what differs by the row alone (..., R), in so many states K."""
        return np.repeat(values, count, axis=-1)

    def apart(self, values: Array) -> Array:
        """(..., R, K) of values (..., R K)."""
        return values.reshape(*values.shape[:-1], self.count, values.shape[-1] // self.count)

    def joined(self, values: Array) -> Array:
        """(..., R K) of values (..., R, K)."""
        return values.reshape(*values.shape[:-2], -1)

    def total(self, values: Array) -> Array:
        """Sums (..., K) over the rows of values (..., R K)."""
        return np.asarray(self.apart(values).sum(axis=-2)) if self.count > 1 else values

    def first(self, values: Array) -> Array:
        """(..., K) of the first row, of values (..., R K)."""
        return values[..., : values.shape[-1] // self.count]


@dataclass(frozen=True, eq=False)
class DrivesPose:
    """A linkage in K states of its N drives.

    along : motion in (N + 1) K places: with a unit of speed of each drive alone, and at last with
        the speeds that they have.
    share : of a flywheel, which rows of a machine have together, that such a linkage has.
    """

    linkage: Linkage
    along: Motion
    share: float

    @cached_property
    def count(self) -> int:
        """How many states."""
        return len(self.along.crank_angle) // (len(self.linkage.machine.driven) + 1)

    @cached_property
    def moving(self) -> Motion:
        """At the speeds that the drives have, where a crank speed of 1 makes derivatives by the
        crank angle those by time.
        """
        whole = len(self.along.crank_angle)
        return self.along.part(slice(whole - self.count, whole)).at(1.0, 0.0)

    def rows(self, name: str) -> Array:
        """A value of the state (N + 1, K)."""
        rows: Array = self._stacked([name])[0]
        return rows

    def _stacked(self, names: Sequence[str]) -> Array:
        """Values of the state (L, N + 1, K)."""
        values, places = [self.along.state[name] for name in names], len(self.along.crank_angle)
        kind = complex if any(map(np.iscomplexobj, values)) else float
        rows = np.empty((len(values), places), kind)
        for row, value in zip(rows, values, strict=True):
            row[:] = value
        return rows.reshape(len(values), -1, self.count)

    @cached_property
    def references(self) -> References:
        """What needed references have come to (..., K)."""
        names = self.linkage.needed_references
        state = self.moving.state if names else {}
        return {name: state[name if name in state else f"phi({name})"] for name in names}

    @cached_property
    def accelerated(self) -> list[Demands]:
        """What a unit of acceleration of each drive demands of the links."""
        force, moment = self._units
        return [
            {link: (force[k, j], moment[k, j]) for k, link in enumerate(self._heavy)}
            for j in range(force.shape[1])
        ]

    @cached_property
    def turning(self) -> Demands:
        """What the links demand while no drive accelerates."""
        force, moment = self._turned
        return {link: (force[k], moment[k]) for k, link in enumerate(self._heavy)}

    @cached_property
    def _heavy(self) -> list[str]:
        """Links that have a mass or an inertia."""
        return [*self._inertial]

    @cached_property
    def _inertial(self) -> dict[str, tuple[float, complex, float]]:
        """Mass, first moment and inertia about their anchors of the links that have any."""
        return inertial_of(self.linkage, self.share)

    @cached_property
    def _numbers(self) -> list[Array]:
        """Mass, first moment and inertia (L, 1)."""
        return [np.array(column)[:, None] for column in zip(*self._inertial.values(), strict=True)]

    @cached_property
    def _rates(self) -> list[Array]:
        """Both rates of anchors, rotations and both of their rates (L, N + 1, K)."""
        anchors = self.linkage.anchors
        names = [(*p(anchors[link])[1:], *u(link)) for link in self._heavy]
        return [self._stacked(column) for column in zip(*names, strict=True)]

    @cached_property
    def _units(self) -> tuple[Array, Array]:
        """Force and moment (L, N, K) that units of acceleration demand."""
        first, _, turn, w, _ = (part[:, :-1] for part in self._rates)
        mass, moment, inertia = (number[..., None] for number in self._numbers)
        pair: tuple[Array, Array] = kernels.inertia_demand(
            first, 0.0, turn, w, 0.0, 0.0, 1.0, mass, moment, inertia
        )
        return pair

    @cached_property
    def _turned(self) -> tuple[Array, Array]:
        """Force and moment (L, K) that links demand while no drive accelerates."""
        first, second, turn, w, a = (part[:, -1] for part in self._rates)
        mass, moment, inertia = self._numbers
        pair: tuple[Array, Array] = kernels.inertia_demand(
            first, second, turn, w, a, 1.0, 0.0, mass, moment, inertia
        )
        return pair

    @cached_property
    def inertia(self) -> Array:
        """M (N, N, K) of the links, kg m2."""
        force, moment = self._units
        return np.asarray(np.sum(self._along(force[:, None], moment[:, None]), axis=0))

    @cached_property
    def bias(self) -> Array:
        """h (N, K), N m."""
        force, moment = (part[:, None] for part in self._turned)
        first, _, _, w, _ = (part[:, :-1] for part in self._rates)
        return np.asarray(np.sum(kernels.dot(first, force) + w * moment, axis=0))

    def _along(self, force: Array, moment: Array) -> Array:
        """Work (L, N, N, K) of what acts (L, 1, N, K) along each drive."""
        first, _, _, w, _ = (part[:, :-1, None] for part in self._rates)
        return np.asarray(kernels.dot(first, force) + w * moment)

    def _ways(self, link: str) -> tuple[Array, Array]:
        """Rates (N, K) of a link's anchor and of its angle, by each drive."""
        anchor = self.linkage.anchors[link]
        return self.rows(p(anchor)[1])[:-1], self.rows(u(link)[1])[:-1]

    def generalized(self, demands: Demands) -> Array:
        """Generalized force (N, K), N m, of what demands (K,) hold."""
        total = np.zeros((len(self.linkage.machine.driven), self.count))
        for link, (force, moment) in demands.items():
            anchor, turn = self._ways(link)
            total -= kernels.dot(anchor, force) + turn * moment
        return total

    @property
    def gravity(self) -> Array | complex:
        """m/s2, complex, in axes of the frame."""
        return complex(*self.linkage.machine.gravity)

    def exerted(self, source: AppliedSource, inputs: SourceInputs, demands: Demands) -> Array:
        """Generalized force (N, K), N m, of a source.

        demands : as of `AppliedSource.demands`.
        """
        return self.generalized(demands)

    def margins(self, names: Sequence[str]) -> Array:
        """Values (D, K) of the state."""
        return self._stacked(names)[:, -1] if names else np.zeros((0, self.count))


def inertial_of(linkage: Linkage, share: float) -> dict[str, tuple[float, complex, float]]:
    """Mass, first moment and inertia about their anchors of the links that have any; `share` as of
    `DrivesPose`.
    """
    each = {}
    for name, link in linkage.machine.links.items():
        mass, moment, inertia = inertia_about(link, linkage.anchors[name])
        each[name] = mass, moment, inertia + share * flywheel_on(linkage.machine, name)
    return {link: own for link, own in each.items() if any(own)}


def pose_of(
    linkage: Linkage,
    crank: Array,
    angles: Array,
    speeds: Array,
    references: References,
    share: float = 1.0,
) -> DrivesPose:
    """A linkage with its drives at angles (N, K), rad, and speeds, rad/s.

    crank : crank angle (K,), rad.  share : as of `DrivesPose`.

    Raises
    ------
    MotionError : loops have no solution near the references.
    """
    count, states = np.shape(angles)
    rates = np.concatenate([np.repeat(np.eye(count)[:, :, None], states, 2), speeds[None]])
    theta = np.tile(crank, count + 1)
    state = frame_state(linkage.machine, theta)
    for k, drive in enumerate(linkage.machine.driven):
        angle = np.tile(angles[k], count + 1)
        values = np.exp(1j * angle), rates[:, k].ravel(), np.zeros(len(theta))
        state.update(zip(u(drive.link), values, strict=True))
        state[f"phi({drive.link})"] = angle
    for name in linkage.needed_references:
        reference = references[name]
        state[f"reference({name})"] = np.tile(reference, (*[1] * (reference.ndim - 1), count + 1))
    run(linkage.motion, state)
    return DrivesPose(linkage, Motion(linkage, theta, 1.0, 0.0, False, state), share)


def references_at(linkage: Linkage, crank_angle: float) -> References:
    """References (..., 1) at a crank angle, rad, with all drives as the file has them there, which
    loops are followed to from crank angle 0.

    Raises
    ------
    ResponseError : the links do not get there.
    """
    if not linkage.needed_references:
        return {}
    count = max(2, int(abs(crank_angle) / STRIDE) + 2)
    state = linkage.start(np.linspace(0.0, crank_angle, count))
    try:
        run(linkage.motion, state)
    except EquipoiseError:
        raise cannot_be_assembled() from None
    names = linkage.needed_references
    return {
        name: np.asarray(state[name if name in state else f"phi({name})"])[..., -1:]
        for name in names
    }


def cannot_be_assembled() -> ResponseError:
    """That a run has no start."""
    return ResponseError(
        Note("the links cannot be assembled at the angles of the drives at the start").about(
            "links-cannot-be-joined-at-any-crank-angle"
        )
    )
