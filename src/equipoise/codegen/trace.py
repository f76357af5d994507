"""A linkage's steps run on terms: what is known of its state so far, and what has to be given."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.terms import ANGLE, BOTH, DESIGN, Graph, Term, VectorTerm, angle_of, rotation
from equipoise.dataclass import dataclass
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import KernelCall, RunningAngle, Step, p, planar, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling, coupled
from equipoise.mechanism.parts.machine import FRAME, Machine

Array = np.ndarray[Any, Any]
Read = Callable[[Linkage], Any]
Body = tuple[Any, Any, Any, Any, Any, Any]
"""A body's anchor and rotation, each with two derivatives by the crank angle."""
FAR = -0.5
"""Cosine of the angle between a link and the base's, beyond which it may go the other way round."""
FARTHEST = 3.0
"""rad: less than half a turn, within which the rotation determines an angle."""


@dataclass(frozen=True)
class Slot:
    """A number or vector that each design has of its own.

    read : finds it in the design's linkage.
    column : of the table; a vector takes this and the next.
    cyclic : whether it takes the motion over a cycle to find it, so that a script is handed it.
    """

    name: str
    vector: bool
    read: Read
    column: int
    cyclic: bool = False


@dataclass(frozen=True)
class AngleFunction:
    """Something that depends on the crank angle alone.

    name : of the argument.  what : that it is.  values : (N,) at crank angles (N,), rad.
    formula : term that is near enough to it, of the crank angle; None where there is none.
    """

    name: str
    what: str
    values: Callable[[Array], Array]
    formula: Any = None


@dataclass(frozen=True)
class Recurrence:
    """A value that each crank angle has from the one before.

    before : the argument.  start : of every design.  watch : what its last value decides, a key of
    `loops.WATCHED`, or nothing.
    """

    before: Term
    start: float
    watch: str


class Trace:
    """The state of a linkage in terms.

    state : values by the names that steps have for them.
    paths : of the numbers in which designs differ; None of one design.
    fixed : whether no design changes the motion, so that the crank angle alone decides it.
    loose : couplings of varying ratio at angles, or by numbers, that designs change.
    shifted : links that designs start at other angles.
    varied : paths of the numbers in which designs differ.
    late : followers whose laws designs begin at angles of their own.
    rotated : those of them whose rotation is known without their angle.
    counted : whether angles of links are counted on from crank angle to crank angle, because a
        coupling follows a link that a dyad moves.
    orders : link -> turns in a turn of the crank, of links that turn in proportion to it.
    apart : number of a dyad with a block -> how far, over the size of the machine and squared, the
        block is from its guide's pivot.  Near there the number drops too fast to be resolved
        between crank angles.
    running : link whose angle is taken from that of the base -> cosine of the angle between.
    alone : whether groups of loops start from the base at each crank angle, and nothing is carried.
    groups : of loops that were traced, by their references.
    carried, following : values of the crank angle before, and what they are after this one.
    """

    def __init__(
        self, linkage: Linkage, paths: Collection[str] | None = None, alone: bool = False
    ) -> None:
        self.alone, self.groups = alone, dict[str, Any]()
        self.linkage, self.machine, self.graph = linkage, linkage.machine, Graph()
        self.state: dict[str, Any] = {}
        self.slots: dict[str, Slot] = {}
        self.rows: dict[str, AngleFunction] = {}
        self.running: dict[str, Any] = {}
        self.carried: list[Recurrence] = []
        self.following: dict[Term, Any] = {}
        self.width = 0
        self.fixed = linkage.shared is not None and paths is not None
        self.shifted, self.loose = _changed(linkage, paths or ())
        self.varied = {*map(KeyPath.parse, paths or ())}
        self.late = {*_begun_elsewhere(self.machine, self.varied)}
        self.rotated: set[str] = set()
        steps = any(map(_counts, linkage.motion)) or _drives_on(self.machine)
        steps |= bool(self.loose or self.late)
        steps |= not self.shifted.isdisjoint(_turning(self.machine))
        self.counted = steps or not self.machine.has_crank
        self.orders: dict[str, float] = {FRAME: 0.0, self.machine.drive.link: 1.0}
        self.apart: dict[str, Any] = {}

    # -- what is given -----------------------------------------------------------------------------

    def slot(self, name: str, read: Read, vector: bool = False, cyclic: bool = False) -> Any:
        """A number or vector that each design has of its own; cyclic : as of `Slot`."""
        if name not in self.slots:
            self.slots[name] = Slot(name, vector, read, self.width, cyclic)
            self.width += 1 + vector
        column = self.slots[name].column
        parts = [self.graph.argument(f"d{k}", DESIGN) for k in range(column, column + 1 + vector)]
        return VectorTerm(*parts) if vector else parts[0]

    def row(self, name: str, values: Callable[[Array], Array], formula: Any = None) -> Term:
        """A number that depends on the crank angle alone."""
        if name not in self.rows:
            self.rows[name] = AngleFunction(f"a{len(self.rows)}", name, values, formula)
        return self.graph.argument(self.rows[name].name, ANGLE)

    @property
    def theta(self) -> Term:
        """The crank angle."""
        term = self.graph.argument("theta", ANGLE)
        self.rows.setdefault("theta", AngleFunction("theta", "the crank angle", np.asarray, term))
        return term

    def turned(self, order: float) -> VectorTerm:
        """exp(i order theta)."""
        return rotation(order * self.theta)

    def rate(self, key: str) -> Any:
        """The crank's ``speed`` or ``acceleration``."""
        return self.slot(key, lambda linkage: getattr(linkage.machine.drive, key))

    def carry(self, start: float | complex, watch: str = "") -> Any:
        """A value of the crank angle before; `carry_on` says what it is after this one."""
        if isinstance(start, complex):
            return VectorTerm(self.carry(start.real, watch), self.carry(start.imag, watch))
        before = self.graph.argument(f"c{len(self.carried)}", BOTH)
        self.carried.append(Recurrence(before, float(start), watch))
        return before

    def carry_on(self, before: Any, value: Any) -> None:
        """What the next crank angle has of a value that was carried."""
        if isinstance(before, VectorTerm):
            self.carry_on(before.real, value.real)
            self.carry_on(before.imag, value.imag)
        else:
            self.following[before] = value

    # -- what is known -----------------------------------------------------------------------------

    def put(self, names: Sequence[str], values: Sequence[Any]) -> None:
        """Add values to the state."""
        self.state.update(zip(names, values, strict=True))

    def body(self, link: str) -> Body:
        x, x1, x2 = (self.state[name] for name in p(self.linkage.anchors[link]))
        turn, w, a = (self.state[name] for name in u(link))
        return x, x1, x2, turn, w, a

    def point(self, link: str, point: str) -> tuple[Any, Any, Any]:
        """A point of a link and its derivatives."""
        if f"p2({point})" not in self.state:  # of a joint there may be its place alone
            anchor = self.linkage.anchors[link]

            def arm(linkage: Linkage) -> Any:
                points = linkage.machine.assembled_points(link)
                return planar(points[point]) - planar(points[anchor])

            slot = self.slot(f"arm({link}/{point})", arm, vector=True)
            self.put(p(point), kernels.point(*self.body(link), slot))
        place, first, second = (self.state[name] for name in p(point))
        return place, first, second

    def numbers(self) -> list[tuple[Any, int]]:
        """The dyads' own numbers, and what else is to be watched; each with the number of its
        dyad in the order in which dyads are solved.
        """
        own = [g.margin for g in self.linkage.groups if g.margin is not None and not g.through]
        numbers = [(self.state[number], k) for k, number in enumerate(own)]
        return numbers + [(self.apart[n], k) for k, n in enumerate(own) if n in self.apart]


def running_angle(trace: Trace, link: str) -> None:
    """The angle of a link that a dyad moves: that of the base, and what lies between them.

    Nothing is counted on from crank angle to crank angle, which would keep the loop from handling
    several at once.
    """
    reference = partial(trace.linkage.cycle.reference, link)
    base = trace.row(f"angle({link} of base)", reference, _straight(trace, link))
    between = trace.state[f"u({link})"] * rotation(base).conjugate()
    trace.state[f"phi({link})"] = base + angle_of(between)
    trace.running[link] = between.real


def _straight(trace: Trace, link: str) -> Any:
    """A line over the crank angle that takes the place of the base's angle; None where this goes
    too far from any.
    """
    cycle = trace.linkage.cycle
    theta = np.linspace(0.0, 2 * np.pi * cycle.turns, 721)
    angle = cycle.reference(link, theta)
    slope = float(angle[-1] - angle[0]) / float(theta[-1])
    rest = angle - slope * theta
    middle = float(np.max(rest) + np.min(rest)) / 2
    return middle + slope * trace.theta if np.ptp(rest) < 2 * FARTHEST else None


def _drives_on(machine: Machine) -> bool:
    """Whether the angle of a pinned follower is one that another coupling starts from."""
    carrying = {
        body for coupling in machine.couplings for body in (coupling.driver, coupling.carrier)
    }
    surfaces = (coupling for coupling in machine.couplings if coupling.contact == "surface")
    return any(surface.driven in carrying for surface in surfaces)


def _counts(step: Step) -> bool:
    """Whether a step asks for the angle of a link that a dyad moves, or gives one of a rack's."""
    racked = isinstance(step, KernelCall) and step.kernel in (kernels.rolled, kernels.wound)
    return racked or isinstance(step, RunningAngle)


def links_of(step: KernelCall) -> list[str]:
    """Driver, carrier and driven link of a coupling's step."""
    angles = step.inputs[0], step.inputs[3], step.outputs[0]
    return [name.removeprefix("phi(")[:-1] for name in angles]


def _turning(machine: Machine) -> set[str]:
    """Bodies from whose angle a law counts."""
    laws = [coupling for coupling in machine.couplings if coupling.relation[0] is coupled]
    return {body for law in laws for body in (law.driver, law.carrier)}


def _changed(linkage: Linkage, paths: Collection[str]) -> tuple[set[str], set[str]]:
    """Links that designs start at other angles; couplings of varying ratio at angles, or by
    numbers, that designs change.
    """
    shifted, shaped = set(), set()
    varied = {*map(KeyPath.parse, paths)}
    for where, item in numbered(linkage.machine):
        if where / "start" in varied:
            shifted.add(item.driven)
        if any(path.begin(3) == where / "shape" for path in varied):
            shaped.add(item.driven)
    text, loose = {FRAME, *(drive.link for drive in linkage.machine.driven)}, set()
    for step in linkage.motion:
        if not (isinstance(step, KernelCall) and step.outputs[0].startswith("phi(")):
            continue
        driver, carrier, driven = links_of(step)
        known = {driver, carrier} <= text
        if step.kernel is not coupled:
            text |= {driven} if known else set()
        elif known and driven not in shaped and shifted.isdisjoint((driver, carrier)):
            text.add(driven)
        else:
            loose.add(driven)
    return shifted, loose


def _begun_elsewhere(machine: Machine, varied: set[KeyPath]) -> Iterator[str]:
    """Followers of cams whose laws designs begin at angles of their own."""
    for where, item in numbered(machine):
        if item.contact == "surface" and any(
            path.begin(2) == where and path[-1] == "phase" for path in varied
        ):
            yield item.driven


def numbered(machine: Machine) -> Iterator[tuple[KeyPath, Coupling]]:
    """Couplings, each with its path in the file."""
    counts: Counter[str] = Counter()
    for coupling in machine.couplings:
        yield KeyPath((coupling.list_name, counts[coupling.list_name])), coupling
        counts[coupling.list_name] += 1
