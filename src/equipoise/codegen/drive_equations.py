"""Equations of motion of a machine whose drives each go their own way, from its traced steps.

With q the angles of the driven links, i and j two of them, and p and alpha the place of a link's
anchor and its angle,

    M q.. + h = Q,    M_ij = sum of what a unit of acceleration of j demands, along dp/dq_i

where h is what the links demand while the drives do not accelerate, and Q the generalized force of
everything that acts beside the drives.  The steps are traced once along each q, and once along the
velocity that the machine has: positions are the same terms in all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import accumulate, combinations_with_replacement, pairwise
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from equipoise.codegen.emit import can_emit
from equipoise.codegen.source import on_arrays, on_numbers
from equipoise.codegen.steps import (
    HoldingWrench,
    holding_wrench,
    inertial,
    run_motion,
    trace_element,
    trace_frame,
    trace_inertia,
    trace_load,
    trace_preload,
)
from equipoise.codegen.terms import BOTH, DESIGN, Term, VectorTerm, rotation, substituted
from equipoise.codegen.trace import FAR, Array, Body, Trace
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.timed_loads import TimedLoad


@dataclass(frozen=True, eq=False)
class DriveEquations:
    """The equations of motion as functions of what changes with time.

    links : the N driven links.  sources : keys of what acts beside the drives, in order.
    dyads : inner joints of the dyads whose margins are watched.
    ranges : what has to stay where its values hold: an element, or a pin in a slot.
    loads : functions of the crank angle (K,), rad, of which the equations take the values.
    arguments : names of angles (N), speeds (N), of those loads, and of factors of loads over time.
    outputs : terms of M's upper triangle, of h (N), of Q (N) of each source, of margins, and of
        how far each range is from its end.
    """

    links: tuple[str, ...]
    sources: tuple[str, ...]
    dyads: tuple[str, ...]
    ranges: tuple[str, ...]
    loads: tuple[Callable[[Array], Array], ...]
    arguments: tuple[str, ...]
    outputs: tuple[Any, ...]

    @cached_property
    def _ends(self) -> tuple[slice, ...]:
        count = len(self.links)
        sizes = [count * (count + 1) // 2, count, count * len(self.sources), len(self.dyads),
                 len(self.ranges)]  # fmt: skip
        return tuple(slice(*both) for both in pairwise(accumulate(sizes, initial=0)))

    @cached_property
    def _places(self) -> list[tuple[int, int]]:
        """Rows and columns of M's upper triangle."""
        return [*combinations_with_replacement(range(len(self.links)), 2)]

    @cached_property
    def _on_numbers(self) -> Callable[..., tuple[float, ...]]:
        return on_numbers(self.outputs, self.arguments)

    @cached_property
    def _inertia_on_arrays(self) -> Callable[..., tuple[Any, ...]]:
        return on_arrays(self.outputs[self._ends[0]])

    def at(self, *numbers: float) -> DriveState | None:
        """The equations at numbers in the order of `arguments`; None where a dyad cannot reach."""
        try:
            values = self._on_numbers(*numbers)
        except (ArithmeticError, ValueError):
            return None
        if not isfinite(sum(values)):
            return None
        upper, bias, forces, margins, ranges = (values[part] for part in self._ends)
        count = len(self.links)
        inertia = [[0.0] * count for _ in range(count)]
        for value, (i, j) in zip(upper, self._places, strict=True):
            inertia[i][j] = inertia[j][i] = value
        each: list[Sequence[float]] = [forces[k : k + count] for k in range(0, len(forces), count)]
        return DriveState(inertia, bias, each, margins, ranges)

    def inertia(self, angles: Array) -> Array:
        """M (N, N, K), kg m2, at angles (N, K), rad."""
        names = {f"q{k}": row for k, row in enumerate(angles)}
        needed = self._inertia_on_arrays.__code__.co_varnames
        known = {name: row for name, row in names.items() if name in needed}
        values = self._inertia_on_arrays(**known)
        whole = np.empty((len(angles), *angles.shape))
        for value, (i, j) in zip(values, self._places, strict=True):
            whole[i, j] = whole[j, i] = value
        return whole


class DriveState(NamedTuple):
    """The equations of motion in one state, in plain numbers: an integration asks for thousands of
    states one by one, of which each call of NumPy takes as long as all formulas together.

    inertia : M (N, N), kg m2.  bias : h (N,), N m.  forces : Q of each source (S, N), N m.
    margins : of dyads from their dead positions.  ranges : below 0 where one is left.
    """

    inertia: list[list[float]]
    bias: Sequence[float]
    forces: list[Sequence[float]]
    margins: Sequence[float]
    ranges: Sequence[float]


def can_trace_drives(linkage: Linkage) -> bool:
    """Whether every link's place follows from the angles of the drives alone: no drive that pushes,
    no loops, and no coupling that follows a link moved by a dyad.
    """
    return can_emit(linkage) and not linkage.machine.pushers and not linkage.needed_references


def drive_equations(linkage: Linkage, causes: Mapping[str, str]) -> DriveEquations:
    """Trace the equations of motion of a linkage.

    causes : of force elements whose forces depend on velocities, with the keys of their sources.

    Raises
    ------
    UsageError : they cannot be traced; see `can_trace_drives`.
    """
    if not can_trace_drives(linkage):
        raise UsageError(
            Note(
                "a run of several drives computes dyads and couplings of driven links; leave out "
                "strokes, loops, and couplings of links that dyads move"
            )
        )
    return _DriveTrace(linkage, causes).equations()


class _DriveTrace:
    """The trace of a linkage along each of its drives, and along its velocity."""

    def __init__(self, linkage: Linkage, causes: Mapping[str, str]) -> None:
        self.linkage, self.machine, self.causes = linkage, linkage.machine, causes
        self.trace = trace = Trace(linkage, own_ways=True)
        trace_frame(trace)
        self.links = [drive.link for drive in self.machine.driven]
        numbers = range(len(self.links))
        self.angles = [trace.graph.argument(f"q{k}", BOTH) for k in numbers]
        self.speeds = [trace.graph.argument(f"v{k}", BOTH) for k in numbers]
        resting = dict(trace.state)
        self.along = []
        for number in numbers:
            trace.state = dict(resting)
            self.along.append(self._moved([float(number == k) for k in numbers]))
        trace.state = dict(resting)
        self._moved(self.speeds)

    def _moved(self, rates: Sequence[Any]) -> dict[str, Body]:
        """Links of the machine, with the drives at these rates."""
        each = zip(self.links, self.angles, rates, strict=True)
        run_motion(self.trace, {link: (angle, rotation(angle), w, 0.0) for link, angle, w in each})
        bodies = self.linkage.joints.bodies[1:]
        return {link: self.trace.body(link) for link in bodies}

    def equations(self) -> DriveEquations:
        """Everything, with numbers of the machine in the place of slots."""
        trace = self.trace
        moving, weights = trace_inertia(trace)
        forces: dict[str, list[HoldingWrench]] = {}
        for key, wrench in self._acting(weights):
            forces.setdefault(key, []).append(wrench)
        along = range(len(self.along))
        inertia = [
            self._generalized(i, self._accelerated(j)) for i in along for j in along if j >= i
        ]
        bias = [self._generalized(i, moving) for i in along]
        acting = [-self._generalized(i, wrenches) for wrenches in forces.values() for i in along]
        margins = [number for number, _ in trace.numbers()]
        own = [group for group in self.linkage.groups if group.margin and not group.through]
        ranges = [value - FAR for value in trace.running.values()]
        terms = [*inertia, *bias, *acting, *margins[: len(own)], *ranges]
        rows = [*trace.rows.values()]
        timed = [f"f{k}" for k in range(len(self.machine.timed_loads))]
        arguments = [item.args[0] for item in (*self.angles, *self.speeds)]
        return DriveEquations(
            tuple(self.links),
            tuple(forces),
            tuple(group.joint for group in own),
            tuple(trace.running),
            tuple(row.values for row in rows),
            (*arguments, *(row.name for row in rows), *timed),
            tuple(substituted(terms, self._numbers())),
        )

    def _acting(self, weights: Sequence[HoldingWrench]) -> Iterator[tuple[str, HoldingWrench]]:
        """Keys of sources, with what holds a part of each."""
        trace, machine = self.trace, self.machine
        if any(machine.gravity):
            yield from (("weight", wrench) for wrench in weights)
        for k in range(len(machine.couplings)):
            yield from (("springs", wrench) for wrench in trace_preload(trace, k))
        for table, number, element in machine.force_elements:
            key = self.causes[element.cause] if element.rated else "springs"
            yield from ((key, wrench) for wrench in trace_element(trace, table, number))
        for k, load in enumerate(loads_of(trace.linkage), 1):
            yield "loads", trace_load(trace, k, load)
        for k, timed in enumerate(machine.timed_loads):
            factor = trace.graph.argument(f"f{k}", BOTH)
            yield from (("timed_loads", wrench) for wrench in self._timed(timed, factor))

    def _timed(self, load: TimedLoad, factor: Any) -> Iterator[HoldingWrench]:
        """What holds a load over time, on its link and on the link that bears its opposite."""
        trace, force, torque = self.trace, 0j, factor * (load.torque or 0.0)
        if load.force is not None:
            turn = trace.state[u(load.link)[0]] if load.axes else 1.0
            force = VectorTerm(*load.force) * turn * factor
        yield holding_wrench(trace, load.link, load.point, force, torque)
        if load.on == FRAME:
            return
        anchor = trace.body(load.on)[0]
        at = anchor if load.point is None else trace.point(load.link, load.point)[0]
        yield load.on, *kernels.load_demand(anchor, at, -force, -torque)

    def _accelerated(self, number: int) -> Iterator[HoldingWrench]:
        """What a unit of acceleration of a drive demands of every link."""
        for link in self.machine.links:
            _, p1, p2, turn, w, a = self.along[number][link]
            yield (
                link,
                *kernels.inertia_demand(p1, p2, turn, w, a, 0.0, 1.0, *inertial(self.trace, link)),
            )

    def _generalized(self, number: int, wrenches: Any) -> Any:
        """Sum of the wrenches along the angle of a drive."""
        along, total = self.along[number], 0.0
        for link, force, moment in wrenches:
            _, p1, _, _, w, _ = along[link]
            total = total + kernels.drive_torque(p1, w, force, moment)
        return total

    def _numbers(self) -> dict[Term, float]:
        """Of arguments that stand for numbers of the machine; `speeds` have the speed in them."""
        given = {"speed": 1.0, "acceleration": 0.0}
        values: dict[Term, float] = {}
        for name, slot in self.trace.slots.items():
            value = given[name] if name in given else slot.read(self.linkage)
            parts = (value.real, value.imag) if slot.vector else (value,)
            for place, part in enumerate(parts, slot.column):
                values[self.trace.graph.argument(f"d{place}", DESIGN)] = float(part)
        return values
