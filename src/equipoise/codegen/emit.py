"""From a linkage and signals to source: the linkage's steps are traced, signals are read off.

Signals go by their names in the output of an analysis.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property, partial
from typing import Any

from equipoise.codegen.coupled import can_trace_followers
from equipoise.codegen.figures import Figure, Gathered
from equipoise.codegen.loops import can_trace
from equipoise.codegen.redundant_forces import check_shared
from equipoise.codegen.source import TermSource, source_of
from equipoise.codegen.steps import (
    bearing_force,
    trace_demands,
    trace_joints,
    trace_motion,
    traced_element,
)
from equipoise.codegen.strokes import SPEED, can_trace_strokes
from equipoise.codegen.trace import Trace
from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.cam_shapes import pressure_angle
from equipoise.mechanism.assembly.family import can_vary
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.loops import LoopGroup
from equipoise.mechanism.assembly.steps import Reaction, planar
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.reactions import PUSH, Push, moment_of_guide, read_on
from equipoise.mechanism.formulas.kernels import length
from equipoise.mechanism.kinematics.motion import in_time
from equipoise.mechanism.outputs.declared import DECLARED, Declared, declared
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.element_kinds import force_kinds
from equipoise.mechanism.parts.machine import Machine

RUBS = Note("what friction in joints changes cannot be computed in a loop")
WATCHED = "cosine "
"""Before the number of what is watched."""
PARTS: dict[str, Callable[[Any], Any]] = {
    "": lambda value: value,
    "size": length,
    "x": lambda value: value.real,
    "y": lambda value: value.imag,
}


class _Missing(LookupError):
    """The linkage has no such member."""


@dataclass
class Signals:
    """Signals of a linkage, read off the trace of its steps, as far as these are needed."""

    trace: Trace

    def __post_init__(self) -> None:
        self.linkage, self.machine = self.trace.linkage, self.trace.machine
        trace_motion(self.trace)

    def __call__(self, signal: str) -> Any:
        """A signal by its name.

        Raises
        ------
        UsageError : there is no such signal, or a loop cannot have it.
        """
        try:
            return self.value(signal)
        except _Missing:
            raise UsageError(unknown(signal, self._known(), "signal")) from None

    def value(self, signal: str) -> Any:
        """As a call, but for a signal that there is not a `_Missing` is raised, which costs less
        than to name those that there are.
        """
        if signal in self.poses:
            return self.poses[signal]
        if signal.startswith(WATCHED):
            return self.watched[signal]
        entry, item = declared(signal) or (None, "")
        if entry is None:
            raise _Missing
        return self._value(entry, item)

    def _value(self, entry: Declared, item: str) -> Any:
        """An output, or a member of a family of outputs."""
        if entry.loop is None or item not in entry.members(self.machine):
            raise _Missing
        if entry.by_friction and self.machine.rubs:
            raise UsageError(RUBS)
        read = partial(self.of_member, item) if entry.is_family else self.of_machine
        return PARTS[entry.part](entry.loop(read))

    def _known(self) -> Iterator[str]:
        """Names of the outputs that there are."""
        for entry in DECLARED.values():
            for item in entry.members(self.machine):
                with suppress(_Missing, UsageError, MassError):
                    self._value(entry, item)
                    yield entry.named(item)

    # -- values ------------------------------------------------------------------------------------

    @cached_property
    def poses(self) -> dict[str, Any]:
        """Signals that are no outputs but give the pose of each link, and the distance of each dyad
        from its dead positions: ``rotation(crank).x`` of exp(i angle), ``center(crank).x`` of its
        centre of mass (m), and ``margin 0`` of the first dyad.
        """
        trace = self.trace
        values: dict[str, Any] = {}
        for link, body in self.machine.links.items():
            anchor, *_, turn, _, _ = trace.body(link)
            vectors = {"rotation": turn}
            if body.has_mass:
                arm = trace.slot(f"center({link})", partial(_arm_of_center, link), vector=True)
                vectors["center"] = anchor + turn * arm
            for what, vector in vectors.items():
                values |= {f"{what}({link}).x": vector.real, f"{what}({link}).y": vector.imag}
        return values | {f"margin {k}": number for k, (number, _) in enumerate(trace.numbers())}

    @cached_property
    def watched(self) -> dict[str, Any]:
        """Signals that are `FAR` or more where what was traced holds, that is motion and, where
        there are masses, forces: ``cosine 0`` of the first.
        """
        with suppress(UsageError, MassError):
            self.forces  # noqa: B018  some of them are watched
        return {f"{WATCHED}{k}": item for k, item in enumerate(self.trace.running.values())}

    @cached_property
    def demands(self) -> dict[str, Any]:
        """The state with what links demand of their joints, and what reaches the frame."""
        trace_demands(self.trace)
        return self.trace.state

    @cached_property
    def forces(self) -> dict[str, Any]:
        """The state with the forces in joints."""
        self.demands  # noqa: B018  they are what joints supply
        if self.linkage.shared is not None:
            check_shared(self.trace)
        trace_joints(self.trace)
        return self.trace.state

    def of_machine(self, name: str) -> Any:
        """A value of the machine as a whole."""
        if name == "speed":
            return self.trace.rate(name)
        if name == "drive force":
            return self.drive_force(self.machine.drive.link)
        return self.demands[name] if name in self.demands else self.forces[name]

    def of_member(self, item: str, name: str, *names: str) -> Any:
        """A value of one of the members of a family."""
        return OF_MEMBERS[name](self, item, *names)

    def position(self, item: str, order: int = 0) -> Any:
        """A point, or its first or second derivative by time."""
        state, links = self.trace.state, self.machine.links
        if f"p({item})" not in state:
            link = next((link for link, body in links.items() if item in body.points), None)
            if link is None:
                raise _Missing
            self.trace.point(link, item)
        return self._by_time([state[f"{key}({item})"] for key in ("p", "p1", "p2")], order)

    def turning(self, item: str, order: int) -> Any:
        """First or second derivative of a link's angle by time."""
        if item not in self.machine.links:
            raise _Missing
        return self._by_time(self.trace.body(item)[3:], order)

    def _by_time(self, values: Sequence[Any], order: int) -> Any:
        speed, acceleration = self.trace.rate("speed"), self.trace.rate("acceleration")
        value, first, second = values
        if order == 2:
            return in_time(first, second, speed, acceleration)
        return first * speed if order else value

    def drive_torque(self, item: str) -> Any:
        return self.forces[f"M({self._drive(item).link})"]

    def drive_force(self, item: str) -> Any:
        """Force of a drive that pushes."""
        return self.forces[PUSH.format(self._drive(item).link)]

    def drive_power(self, item: str) -> Any:
        """Power of a drive."""
        if self._drive(item).pushes:
            return self.drive_force(item) * self.forces[SPEED.format(item)]
        return self.drive_torque(item) * self.turning(item, 1)

    def _drive(self, item: str) -> Drive | FurtherDrive:
        """The drive of a link."""
        drive = next((drive for drive in self.machine.driven if drive.link == item), None)
        if drive is None:
            raise _Missing
        return drive

    def joint_force(self, item: str) -> Any:
        """A joint's force on the later of its bodies, a coupling's on the driven one."""
        reaction = self._reaction(item)
        _, _, sign = read_on(self.linkage.joints, reaction)
        return sign * self.forces[reaction.force]

    def joint_moment(self, item: str) -> Any:
        """Moment of a guide about the point of the slider."""
        reaction = self._reaction(item)
        if reaction.couple is None:
            raise _Missing
        force = self.joint_force(item)
        slider = next(s for s in self.machine.sliders if s.name == reaction.name)
        point, *_ = self.trace.point(slider.link, slider.point)
        _, _, sign = read_on(self.linkage.joints, reaction)
        return moment_of_guide(self.forces, reaction, point, (sign, force))

    def _reaction(self, item: str) -> Reaction:
        reaction = dict(self.linkage.named_reactions).get(item)
        if reaction is None:
            raise _Missing
        return reaction

    def bearing_force(self, item: str) -> Any:
        if item not in self.machine.bearings:
            raise _Missing
        self.demands  # noqa: B018
        return bearing_force(self.trace, item, self.joint_force)

    def pressure_angle(self, item: str) -> Any:
        self._reaction(item)
        return pressure_angle(item, self.forces)

    def coupling_part(self, item: str, part: str) -> Any:
        """A part of a coupling's force by its name."""
        reaction, couplings = self._reaction(item), self.machine.couplings
        number, coupling = next(
            (k, coupling) for k, coupling in enumerate(couplings) if coupling.name == item
        )
        preload = coupling.preload and self.trace.slot(
            f"preload of {item}", lambda linkage: linkage.machine.couplings[number].preload
        )
        at = Push(self.forces, reaction, self.linkage.joints, coupling, preload)
        return coupling.parts(at)[part]

    def element_value(self, item: str, table: str, name: str) -> Any:
        """An output of an element, by its number from 1 in a list of the file."""
        number = int(item) - 1 if item.isdecimal() else -1
        if not 0 <= number < len(getattr(self.machine, table)):
            raise _Missing
        element, at = traced_element(self.trace, table, number)
        return element.values(at)[name]


OF_MEMBERS: dict[str, Callable[..., Any]] = {
    "position": Signals.position,
    "velocity": lambda signals, item: signals.position(item, 1),
    "acceleration": lambda signals, item: signals.position(item, 2),
    "angular velocity": lambda signals, item: signals.turning(item, 1),
    "angular acceleration": lambda signals, item: signals.turning(item, 2),
    "drive torque": Signals.drive_torque,
    "drive force": Signals.drive_force,
    "drive power": Signals.drive_power,
    "joint force": Signals.joint_force,
    "joint moment": Signals.joint_moment,
    "bearing force": Signals.bearing_force,
    "coupling part": Signals.coupling_part,
    "pressure angle": Signals.pressure_angle,
    "element": Signals.element_value,
}
"""Values of members of families, by the names that `declared` looks them up by."""


def _arm_of_center(link: str, linkage: Linkage) -> Any:
    """From a link's anchor to its centre of mass, in its axes, m."""
    points = linkage.machine.assembled_points(link)
    center = linkage.machine.links[link].center_of_mass or (0.0, 0.0)
    return planar(center) - planar(points[linkage.anchors[link]])


def can_emit(linkage: Linkage) -> bool:
    """Whether the steps of a linkage can be traced: no couplings beside loops, and no drive that
    pushes beside anything but dyads.
    """
    if not can_trace_strokes(linkage):
        return False
    loops = [step for step in linkage.motion if isinstance(step, LoopGroup)]
    if not can_trace_followers(linkage):
        return False
    return all(map(can_trace, loops)) and not (loops and linkage.machine.couplings)


def signals_in_loops(linkage: Linkage, names: Iterable[str]) -> list[str]:
    """Those of some outputs of a linkage that a loop can have.

    Raises
    ------
    UsageError : a loop cannot have this linkage.
    MassError : an output needs masses, and the machine lacks some.
    """
    signals, texts = _traced(linkage), []
    for name in names:
        with suppress(_Missing, UsageError):
            signals.value(name)
            texts.append(name)
    return texts


def pose_signals(linkage: Linkage) -> list[str]:
    """Names of the signals in `Signals.poses` and `Signals.watched` of a linkage at crank angles
    that stand alone; errors as `signals_in_loops`.
    """
    signals = _traced(linkage, alone=True)
    return [*signals.poses, *signals.watched]


def _traced(linkage: Linkage, paths: Collection[str] | None = None, alone: bool = False) -> Signals:
    """Signals of a linkage whose steps can be traced."""
    if not can_emit(linkage):
        raise UsageError(
            Note(
                "large groups of loops, drives that push beside loops or couplings, and couplings "
                "beside loops cannot be computed in a loop"
            )
        )
    return Signals(Trace(linkage, paths, alone))


def emit(
    linkage: Linkage,
    gathered: Gathered,
    paths: Collection[str] | None = None,
    has_shares: bool = False,
    alone: bool = False,
) -> TermSource:
    """Trace the steps of a linkage, with the signals that are gathered.

    paths : of the numbers in which designs differ; None of one design.
    has_shares : whether crank angles have shares of their own in means.
    alone : whether each crank angle stands alone, also in groups of loops: these start from the
        base there, and cosines show whether they arrive.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it or this linkage.
    MassError : it needs masses, and the machine lacks some.
    """
    signals = _traced(linkage, paths, alone)
    values = {name: signals(name) for name in gathered.signals}
    return source_of(signals.trace, gathered, values, has_shares)


OWN_MOTION: Sequence[tuple[Callable[[Linkage], bool], Note]] = (
    (
        lambda linkage: linkage.shared is not None,
        Note(
            "got lengths of an overconstrained linkage; each design has to be checked by "
            "itself for compatible lengths"
        ),
    ),
    (
        lambda linkage: linkage.machine.in_soil,
        Note(
            "got numbers that move a finger in soil; each design has to be computed by "
            "itself, as its own motion tells where the finger goes in"
        ),
    ),
    (
        lambda linkage: any(load.indicator is not None for load in linkage.machine.loads),
        Note(
            "got numbers that move a piston with an indicator diagram; each design has to "
            "be computed by itself, as its own motion tells where the piston is"
        ),
    ),
)
"""Which linkages need a computation of each design's motion, and why."""


def own_motion(linkage: Linkage, paths: Sequence[str]) -> Note | None:
    """Why designs in which these numbers differ have to be computed each by itself; None where a
    loop computes them.
    """
    if _moves(linkage, paths):
        return next((why for needs, why in OWN_MOTION if needs(linkage)), None)
    return None


def moves_shared(linkage: Linkage, paths: Sequence[str]) -> bool:
    """Whether these numbers change the motion of a linkage whose lengths have to agree."""
    return linkage.shared is not None and _moves(linkage, paths)


def _moves(linkage: Linkage, paths: Sequence[str]) -> bool:
    """Whether the motion by crank angle depends on one of these numbers."""
    tables = force_kinds(type(linkage.machine))
    return not all(_of_forces(KeyPath.parse(path), tables) for path in paths)


def _of_forces(path: KeyPath, tables: Collection[str]) -> bool:
    """Whether forces depend on a number and the motion by crank angle does not."""
    if path[0] == "links" and len(path) > 2:
        return path[2] in ("mass", "inertia", "center_of_mass", "bodies")
    return path[0] in ("drive", "gravity", "loads", *tables)


def can_compute(machine: Machine, paths: Sequence[str], figure: Figure) -> bool:
    """Whether a loop can compute a figure of designs in which these numbers vary."""
    linkage = assemble(machine)
    if not can_emit(linkage) or not all(can_vary(machine, path) for path in paths):
        return False
    if own_motion(linkage, paths) is not None:
        return False
    try:
        emit(linkage, Gathered.of([figure]), paths)
    except (UsageError, MassError):
        return False
    return True
