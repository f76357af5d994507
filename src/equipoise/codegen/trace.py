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
from equipoise.mechanism.assembly.contacts import RelationCall
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import State, p, planar, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array

LinkageReader = Callable[[Linkage], Any]
BodyTerms = tuple[Any, Any, Any, Any, Any, Any]
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
    read: LinkageReader
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


class PrescribedMotion:
    """The motion of a linkage: its state at crank angles, kept while they stay the same."""

    def __init__(self, linkage: Linkage) -> None:
        self.linkage = linkage
        self.theta: Array | None = None
        self.state: State = {}

    def at(self, theta: Array) -> State:
        """The state at crank angles (N,), rad."""
        if theta is not self.theta:
            self.theta, self.state = theta, self.linkage.solve(theta)
        return self.state

    def part(self, name: str, part: str, theta: Array) -> Array:
        """Real or imaginary part (N,) of a value of the state at crank angles (N,), rad."""
        return np.asarray(getattr(np.asarray(self.at(theta)[name]), part) + 0.0 * theta)

    def relative(self, coupling: Coupling, theta: Array) -> Array:
        """Angle (N,) of a coupling's driver, seen from its carrier, rad."""
        driver, carrier = (self.part(f"phi({body})", "real", theta)
                           for body in (coupling.driver, coupling.carrier))  # fmt: skip
        return driver - carrier


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
    fixed : whether no design changes the motion, so that the crank angle alone decides it.
    loose : couplings of varying ratio at angles, or by numbers, that designs change.
    shifted : links that designs start at other angles.
    paths : of couplings in the file, by their names.
    varied : paths of the numbers in which designs differ.
    late : followers whose laws designs begin at angles of their own.
    rotated : those of them whose rotation is known without their angle.
    by_crank : bodies whose angles, up to those at which designs start, are functions of the crank
        angle alone.
    base : motion of the linkage itself.
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
        self.paths = {item.name: where for where, item in numbered(self.machine)}
        self.varied = {*map(KeyPath.parse, paths or ())}
        self.shifted = {item.driven for where, item in numbered(self.machine)
                        if where / "start" in self.varied}  # fmt: skip
        self.by_crank, self.loose = _followed(self)
        self.late = {*_begun_elsewhere(self.machine, self.varied)}
        self.rotated: set[str] = set()
        self.base = PrescribedMotion(linkage)
        self.apart: dict[str, Any] = {}

    # -- what is given -----------------------------------------------------------------------------

    def slot(
        self, name: str, read: LinkageReader, vector: bool = False, cyclic: bool = False
    ) -> Any:
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

    def base_row(self, name: str, part: str = "real") -> Term:
        """Part of a value of the state that no design changes: that of the base."""
        return self.row(f"{part} {name}", partial(self.base.part, name, part))

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

    def body(self, link: str) -> BodyTerms:
        x, x1, x2 = (self.state[name] for name in p(self.linkage.anchors[link]))
        turn, w, a = (self.state[name] for name in u(link))
        return x, x1, x2, turn, w, a

    def point(self, link: str, point: str) -> tuple[Any, Any, Any]:
        """A point of a link and its derivatives."""
        if f"p2({point})" not in self.state:  # of a joint there may be its place alone
            arm = self.arm(link, self.linkage.anchors[link], point)
            self.put(p(point), kernels.point(*self.body(link), arm))
        place, first, second = (self.state[name] for name in p(point))
        return place, first, second

    def arm(self, link: str, anchor: str, point: str) -> Any:
        """Vector from a link's anchor to another of its points, in the link's axes."""

        def read(linkage: Linkage) -> Any:
            points = linkage.machine.assembled_points(link)
            return planar(points[point]) - planar(points[anchor])

        return self.slot(f"arm({link}/{point})", read, vector=True)

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


def _followed(trace: Trace) -> tuple[set[str], set[str]]:
    """Bodies whose angles are functions of the crank angle alone; driven bodies of couplings of
    varying ratio at angles, or by numbers, that designs change.
    """
    machine = trace.machine
    # numbers of a law stand in a table within that of the coupling
    of_laws = [path.begin(2) for path in trace.varied if len(path) > 3]
    shaped = {item.driven for where, item in numbered(machine) if where in of_laws}
    by_crank, loose = {FRAME, *(drive.link for drive in machine.driven)}, set[str]()
    for step in trace.linkage.motion:
        if not isinstance(step, RelationCall) or step.coupling.slides:
            continue
        driver, driven, carrier = step.coupling.bodies
        known = {driver, carrier} <= by_crank
        if step.law is None:
            by_crank |= {driven} if known else set()
        elif known and driven not in shaped and trace.shifted.isdisjoint((driver, carrier)):
            by_crank.add(driven)
        else:
            loose.add(driven)
    return by_crank, loose


def _begun_elsewhere(machine: Machine, varied: set[KeyPath]) -> Iterator[str]:
    """Followers whose laws designs begin at angles of their own."""
    for where, item in numbered(machine):
        if any(path.begin(2) == where and path[-1] == item.shifted_by for path in varied):
            yield item.driven


def numbered(machine: Machine) -> Iterator[tuple[KeyPath, Coupling]]:
    """Couplings, each with its path in the file."""
    counts: Counter[str] = Counter()
    for coupling in machine.couplings:
        yield KeyPath((coupling.list_name, counts[coupling.list_name])), coupling
        counts[coupling.list_name] += 1
