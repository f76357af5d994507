"""What acts on a machine beside its drives: sources of generalized force.

For one crank, each says which functions of the crank angle it needs, which are tabulated, and what
it makes of their values and of the crank's speed.  For several drives, each says what would hold
it on every link.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.checks import FRAME, numbered
from equipoise.mechanism.dynamics.forces import ELEMENTS, weight_demands
from equipoise.mechanism.dynamics.friction import Demands
from equipoise.mechanism.dynamics.loads import (
    against_soil,
    given_loads,
    load_axis,
    loads_from_outside,
    soil_loads,
    spring_demands,
)
from equipoise.mechanism.dynamics.reactions import Acting, Demand, demands_of
from equipoise.mechanism.dynamics.reduced import (
    generalized_force,
    generalized_size,
    rated_torque,
    rated_ways,
)
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.element_kinds import RatedElement, rated_elements
from equipoise.mechanism.parts.field import Planting
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.run_plans import TimedLoad
from equipoise.results.outputs import CAUSES
from equipoise.signals import Array

Motions = Sequence[Motion]
"""Of each row of a machine, at the same N instants."""

Factors = Sequence[Any]
"""Of each load over time (...), in the order of the file; none at all counts as 0."""

LATER = 1e-12
"""s, or share of a time, by which an instant may be before a row of a load that it stands for."""


class Source(ABC):
    """What exerts a generalized force on the crank, by its angle and speed.

    key : its name in JSON.  label : for readers.
    conserves : whether it gives back over a cycle what it takes.
    """

    key: str
    label: str
    conserves: bool = False

    @abstractmethod
    def columns(self, motions: Motions) -> list[Array]:
        """Smooth functions (N,) of the crank angle that it needs."""

    def groups(self, count: int) -> list[int]:
        """Of each of so many columns, the group that it belongs to: one whose largest value tells
        what is rounding in all of it; each is a group of its own where not said otherwise.
        """
        return [*range(count)]

    def sizes(self, motions: Motions) -> list[float]:
        """Of each column the size of the terms in it, beside whose rounding a smaller column is
        nothing; 0 where a column is of one term.
        """
        return [0.0] * len(self.columns(motions))

    @abstractmethod
    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        """Generalized force (...), N m, by these (C, ...), the crank's speed (...), rad/s, and
        factors of loads over time.
        """

    def sliding_torque(self, columns: Array, speed: Array, sense: float, factors: Factors) -> Array:
        """Torque (...) as of `torque`, with dry friction of full size against a sense, 1 or -1, in
        which the crank turns, or would.
        """
        return self.torque(columns, speed, factors)

    def holding(self, columns: Array, sense: float) -> float:
        """Torque, N m, by which it holds a crank at rest against one that turns it in a sense."""
        still = np.zeros(())
        added = self.sliding_torque(columns, still, sense, ()) - self.torque(columns, still, ())
        return -sense * float(added)


LOADS = "loads"
"""In the works of a run: loads over the crank angle."""


class SourceInputs(NamedTuple):
    """What sources depend on in K states beside the motion of links.

    crank_speed : (K,), rad/s, at which the machine drives over ground.
    factors : of each load over time (K,).
    gravity : m/s2, complex, in axes of the frame, (K,) where it tilts.
    """

    crank_speed: Array
    factors: Factors
    gravity: Array | complex


class AppliedSource(Source):
    """A source that acts on links whatever presses in joints.

    weighs : whether it is the weight, which every body has, a support too.
    """

    weighs: ClassVar[bool] = False

    @abstractmethod
    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        """What would hold it, by link, in a motion whose crank speed is 1, so that its derivatives
        by the crank angle are those by time.
        """

    def from_outside(self, motion: Motion, inputs: SourceInputs) -> Iterator[Acting]:
        """What of it no body of the machine bears the opposite of, so that it moves a support, too:
        nothing where not said otherwise; weight acts on the support itself as well.
        """
        yield from ()


@dataclass(frozen=True)
class ByAngle(AppliedSource):
    """A source that depends on places alone.

    of : what would hold it.  outside : that part of it whose opposite no body of the machine bears.
    """

    key: str
    label: str
    of: Callable[[Motion], Demands]
    conserves: bool = False
    outside: Callable[[Motion], Iterable[Acting]] = lambda motion: ()

    def columns(self, motions: Motions) -> list[Array]:
        return [np.asarray(sum(generalized_force(motion, self.of(motion)) for motion in motions))]

    def sizes(self, motions: Motions) -> list[float]:
        return [sum(generalized_size(motion, self.of(motion)) for motion in motions)]

    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        return self.of(motion)

    def from_outside(self, motion: Motion, inputs: SourceInputs) -> Iterator[Acting]:
        yield from self.outside(motion)

    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        torque: Array = columns[0]
        return torque


@dataclass(frozen=True)
class OfWeight(ByAngle):
    """Weight of the links."""

    key: str = "weight"
    label: str = to_say("weight")
    of: Callable[[Motion], Demands] = weight_demands
    conserves: bool = True
    weighs: ClassVar[bool] = True

    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        return weight_demands(motion, inputs.gravity)


@dataclass(frozen=True)
class OfSoil(AppliedSource):
    """The soil, whose force follows the velocity of each tip over ground."""

    planting: Planting
    surface: float
    key: str = "soil"
    label: str = to_say("soil")

    def columns(self, motions: Motions) -> list[Array]:
        tips = [motion.point(arm.tip) for motion in motions for arm in self.planting.every_arm]
        places = [self.surface - tip.y for tip in tips]
        return [*places, *(tip.place_1.real for tip in tips), *(tip.place_1.imag for tip in tips)]

    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        depth, x, y = columns.reshape(3, -1, *columns.shape[1:])
        if not np.any(depth > 0):  # most of a turn
            return np.zeros_like(speed)
        return np.asarray(np.sum(dot(self.forces(columns, speed), x + 1j * y), axis=0))

    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        return demands_of(motion, soil_loads(motion, inputs.crank_speed))

    def from_outside(self, motion: Motion, inputs: SourceInputs) -> Iterator[Acting]:
        yield from soil_loads(motion, inputs.crank_speed)

    def forces(self, columns: Array, speed: Array) -> Array:
        """Force (A, ...) on each tip of each row, N, complex."""
        assert self.planting.soil is not None
        depth, x, y = columns.reshape(3, -1, *columns.shape[1:])
        over_ground = (x + 1j * y) * speed + self.planting.forward(speed)
        return np.asarray(against_soil(self.planting.soil, depth, over_ground))


def _of_loads(motion: Motion) -> Demands:
    return demands_of(motion, given_loads(motion))


def _of_springs(motion: Motion) -> Demands:
    return spring_demands(motion, rated=False)


@dataclass(frozen=True)
class OfRatedElements(AppliedSource):
    """Force elements of one cause whose forces depend on velocities."""

    elements: tuple[tuple[str, int, RatedElement], ...]
    key: str
    label: str

    def columns(self, motions: Motions) -> list[Array]:
        """Of each row its ways and their derivatives, as of `rated_ways`."""
        return [column for motion in motions for column in rated_ways(motion, self.elements)]

    def groups(self, count: int) -> list[int]:
        """Ways of an element and their derivatives are measured together: some may vanish, such as
        the way across its direction.
        """
        sizes = [2 * element.freedoms for element in self._each]
        sizes *= count // sum(sizes)
        return [number for number, size in enumerate(sizes) for _ in range(size)]

    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        return rated_torque(self._each, columns, speed)

    def sliding_torque(self, columns: Array, speed: Array, sense: float, factors: Factors) -> Array:
        return rated_torque(self._each, columns, speed, sense)

    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        return spring_demands(motion, rated=True, cause=self._each[0].cause)

    @property
    def _each(self) -> list[RatedElement]:
        return [element for *_, element in self.elements]


@dataclass(frozen=True)
class OfTimedLoads(AppliedSource):
    """Loads that change with the time since the start of the run."""

    loads: tuple[TimedLoad, ...]
    key: str = "timed_loads"
    label: str = to_say("loads over time")

    def columns(self, motions: Motions) -> list[Array]:
        """Of each row what each load would do with a factor of 1."""
        return [
            generalized_force(motion, demands)
            for motion in motions
            for demands in timed_units(motion)
        ]

    def sizes(self, motions: Motions) -> list[float]:
        return [
            generalized_size(motion, demands)
            for motion in motions
            for demands in timed_units(motion)
        ]

    def torque(self, columns: Array, speed: Array, factors: Factors) -> Array:
        each = [*factors] * (len(columns) // len(self.loads))
        shares = (factor * column for factor, column in zip(each, columns, strict=False))
        return np.asarray(sum(shares, np.zeros(np.shape(speed))))

    def demands(self, motion: Motion, inputs: SourceInputs) -> Demands:
        parts = (
            {link: (factor * force, factor * moment) for link, (force, moment) in unit.items()}
            for factor, unit in zip(inputs.factors, timed_units(motion), strict=True)
        )
        return plus(*parts)


def just_after(time: float) -> float:
    """An instant, s, after a row of a load at a time, s, that rounding may have moved."""
    return time + LATER * (1 + time)


def load_factors(machine: Machine, time: Array | float, since: float) -> list[Array]:
    """Factors (...) of loads over time at times (...), s, each on the line that it follows just
    after an instant `since`, also beyond the end of that.
    """
    after = just_after(since)
    return [load.line_after(after)(np.asarray(time)) for load in machine.timed_loads]


def timed_units(motion: Motion) -> list[dict[str, Demand]]:
    """What holds each load over time, with a factor of 1."""
    loads = numbered("timed_loads", motion.machine.timed_loads)
    return [demands_of(motion, _ends(motion, where, load)) for where, load in loads]


def _ends(motion: Motion, where: str, load: TimedLoad) -> Iterator[Acting]:
    """What a load over time exerts on its link, and on the body that bears its opposite."""
    none = np.zeros(len(motion.crank_angle))
    place, force = None, none + 0j
    if load.force is not None and load.point is not None:
        force = (none + complex(*load.force)) * load_axis(motion, where, load)
        place = motion.point(load.point).place
    torque = load.torque or 0.0
    yield load.link, place, force, torque
    if load.on != FRAME:
        yield load.on, place, -force, -torque


def plus(*demands: Mapping[str, Demand]) -> dict[str, Any]:
    """Demands of links, added up."""
    total: dict[str, Any] = {}
    for demand in demands:
        for link, (force, moment) in demand.items():
            own = total.get(link, (0.0, 0.0))
            total[link] = own[0] + force, own[1] + moment
    return total


def sources_of(machine: Machine) -> Iterator[AppliedSource]:
    """Everything but drives, brakes and friction in joints."""
    if any(machine.gravity):
        yield OfWeight()
    stiff = [element for *_, element in machine.force_elements if not element.rated]
    if stiff or any(coupling.preload for coupling in machine.couplings):
        yield ByAngle("springs", to_say("springs"), _of_springs, conserves=True)
    rated = rated_elements(machine)
    for cause in ELEMENTS:
        if own := tuple(item for item in rated if item[2].cause == cause):
            yield OfRatedElements(own, f"{cause}s", CAUSES[cause])
    if machine.loads:
        yield ByAngle(LOADS, to_say("loads"), _of_loads, outside=loads_from_outside)
    if machine.timed_loads:
        yield OfTimedLoads(machine.timed_loads)
    planting = machine.planting
    if planting is not None and planting.soil is not None:
        yield OfSoil(planting, surface_of(machine))
