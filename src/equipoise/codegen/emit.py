"""From a linkage and signals to source: every step becomes a line, every signal an expression.

Signals go by their names in the output of an analysis.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from equipoise.codegen.across import write_bearing
from equipoise.codegen.applied import stretched
from equipoise.codegen.figures import Figure, Gathered
from equipoise.codegen.followers import can_write_followers
from equipoise.codegen.lines import write_demands, write_joints, write_motion
from equipoise.codegen.loops import can_write
from equipoise.codegen.source import Source, source_of
from equipoise.codegen.writer import Writer
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.assembly.family import can_vary
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.newton import LoopGroup
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.outputs.declared import DECLARED, Declared, declared
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.sliders import JOINTS

_LOOKED_UP = re.compile(r"\{([^}:]+)(:name)?\}")
"""Values in the expression of an output: of the machine, or of the member of a family."""
_OF_FORCES = re.compile(
    r"drive\..+|gravity\..+|springs\[\d+\]\..+|links\..+\.(mass|inertia|center_of_mass\..+)"
    r"|links\..+\.bodies\[\d+\]\..+"
)
"""Paths of numbers on which forces depend and the motion by crank angle does not."""
ORDERS = {"position": 0, "velocity": 1, "acceleration": 2}
OF_CAMS = {"cam push": "T({})", "cam forth": "forth({})", "cam normal": "normal({})"}
"""Values of a state that tell of a cam."""
LENGTH = "length({1} - {0})"
OF_SPRINGS = {"spring length": LENGTH, "spring pull": f"{{2}} * ({LENGTH} - {{3}})"}
"""Of a spring, from its ends, stiffness and free length."""
OF_BELTS = {"belt pull": 0, "belt left": 1, "belt right": -1}
"""Strands of a belt, by their side; 0 for what they differ by."""
TURNING = {"angular velocity": 1, "angular acceleration": 2}
"""How often a position, or an angle, is differentiated by time."""


def expression(writer: Writer, signal: str) -> str:
    """A signal as an expression.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it.
    """
    one, item = declared(signal) or (None, "")
    if one is None or not one.loop or not _has(writer, one):
        raise UsageError(unknown(signal, _known(writer), "signal"))
    try:
        whole = _LOOKED_UP.sub(lambda value: _identified(writer, value, item), one.loop)
    except _Missing:
        raise UsageError(unknown(signal, _known(writer), "signal")) from None
    parts = {"": "{}", "size": "length({})", "x": "({}).real", "y": "({}).imag"}
    return parts[one.part].format(whole)


class _Missing(LookupError):
    """The linkage has no such member."""


def _known(writer: Writer) -> Sequence[str]:
    named = writer.linkage.named_reactions
    families = {"gear": "gears", "cam": "cams", "rack": "racks", "belt": "belts"}
    joints = [f"{families.get(r.kind, 'joints')}.{name}" for name, r in named]
    ones = (one for one in DECLARED.values() if one.loop and not one.is_family)
    bearings = [f"bearings.{name}" for name in writer.machine.bearings]
    return [*(one.name for one in ones if _has(writer, one)), *joints, *bearings]


def _has(writer: Writer, one: Declared) -> bool:
    """Whether the machine has what an output tells of, as far as that depends on no member."""
    return one.needs != "planes" or writer.machine.has_planes


def _identified(writer: Writer, looked_up: re.Match[str], item: str) -> str:
    """The expression of a value of the machine, or of a member of a family."""
    value, of_member = looked_up.groups()
    if not of_member:
        return writer.rate(value) if value in ("speed", "acceleration") else writer.name(value)
    if value == "bearing force":
        if item not in writer.machine.bearings:
            raise _Missing
        force = lambda name: _reaction(writer, name, "joint force")  # noqa: E731
        return write_bearing(writer.sheet, writer.linkage, item, force)
    if value in ORDERS:
        return _in_time(writer, _point(writer, item), ORDERS[value])
    if value == "drive torque" and item in [drive.link for drive in writer.machine.driven]:
        return writer.name(f"M({item})")
    if value not in TURNING:
        return (_of_spring if value in OF_SPRINGS else _reaction)(writer, item, value)
    if item not in writer.machine.links:
        raise _Missing
    return _in_time(writer, writer.body(item)[3:], TURNING[value])


def _of_spring(writer: Writer, item: str, value: str) -> str:
    number = int(item) - 1 if item.isdecimal() else -1
    if not 0 <= number < len(writer.machine.springs):
        raise _Missing
    return f"({OF_SPRINGS[value].format(*stretched(writer, number))})"


def _reaction(writer: Writer, item: str, value: str) -> str:
    """A joint's force is told on the later of its bodies, a gear's on the driven one."""
    reaction = dict(writer.linkage.named_reactions).get(item)
    if reaction is None:
        raise _Missing
    if value in OF_CAMS:
        return writer.name(OF_CAMS[value].format(item))
    if value in OF_BELTS:
        return _of_belt(writer, item, OF_BELTS[value])
    order = writer.linkage.joints.bodies.index
    told = reaction.kind not in JOINTS or order(reaction.on) > order(reaction.by)
    sign = 1.0 if told else -1.0
    force = f"({sign} * {writer.name(reaction.force)})"
    if value == "joint force":
        return force
    if reaction.couple is None:
        raise _Missing
    slider = next(s for s in writer.machine.sliders if s.name == reaction.name)
    to, *_ = writer.point(slider.link, slider.point)
    at = writer.name(f"p({reaction.at})")
    return f"{sign} * {writer.name(reaction.couple)} + cross({at} - {to}, {force})"


def _of_belt(writer: Writer, item: str, side: int) -> str:
    """Its pull, or the tension of a strand, as `Pass.belts` has it."""
    belts, pull = writer.machine.belts, writer.name(f"T({item})")
    if not side:
        return pull
    number = next(k for k, one in enumerate(belts) if one.name == item)
    mean = f"0.5 * {writer.name(f'flank({item})')} * {pull}"
    if belts[number].tension is not None:
        what = f"tension of belt {number + 1}"
        mean = writer.sheet.slot(what, lambda found: found.machine.belts[number].tension)
    half = -0.5 * side if belts[number].crossed else 0.5 * side
    return f"({mean} + {half!r} * {pull})"


def _point(writer: Writer, name: str) -> list[str]:
    if name in writer.points:
        return [writer.name(f"{key}({name})") for key in ("p", "p1", "p2")]
    for link, body in writer.machine.links.items():
        if name in body.points:
            return writer.point(link, name)
    raise _Missing


def _in_time(writer: Writer, values: Sequence[str], times: int) -> str:
    """A value, or its first or second derivative by time, from those by crank angle."""
    speed, acceleration = writer.rate("speed"), writer.rate("acceleration")
    value, first, second = values
    return (
        value,
        f"{first} * {speed}",
        f"{second} * {speed} * {speed} + {first} * {acceleration}",
    )[times]


def can_emit(linkage: Linkage) -> bool:
    """Whether the steps of a linkage can be written out: no soil, no gears beside loops, and no
    drive that pushes.
    """
    if linkage.machine.pushers:
        return False
    machine = linkage.machine
    if machine.planting is not None and machine.planting.soil is not None:
        return False
    loops = [step for step in linkage.motion if isinstance(step, LoopGroup)]
    if not can_write_followers(linkage):
        return False
    return all(map(can_write, loops)) and not (loops and machine.couplings)


def emit(
    linkage: Linkage,
    gathered: Gathered,
    paths: Collection[str] | None = None,
    has_shares: bool = False,
) -> Source:
    """Write out the steps of a linkage, with the signals that are gathered.

    paths : of the numbers in which designs differ; None of one design.
    has_shares : whether crank angles have shares of their own in means.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it or this linkage.
    MassError : it needs masses, and the machine lacks some.
    """
    if not can_emit(linkage):
        raise UsageError(
            "large groups of loops, fingers in soil, drives that push, and couplings beside loops "
            "cannot be computed in a loop"
        )
    writer = Writer(linkage, paths)
    writer.sheet.has_shares = has_shares
    write_motion(writer)
    wanted = [one for one, _ in filter(None, map(declared, gathered.signals))]
    if any(one.is_of_row for one in wanted):
        write_demands(writer)
    passed = ["{joint ", "{bearing ", "{cam push", "{belt "]
    passed += [] if linkage.machine.has_crank else ["{drive torque"]
    if any(value in (one.loop or "") for one in wanted for value in passed):
        if linkage.shared is not None:
            raise UsageError("forces that joints share cannot be computed in a loop")
        if any(isinstance(step, LoopGroup) for step in linkage.motion):
            raise UsageError("joint forces of groups of loops cannot be computed in a loop")
        write_joints(writer)
    signals = [writer.sheet.put(f"signal {s}", expression(writer, s)) for s in gathered.signals]
    return source_of(writer.sheet, signals, writer.numbers(), gathered)


def moves_shared(linkage: Linkage, paths: Sequence[str]) -> bool:
    """Whether these numbers change the motion of a linkage whose lengths have to agree."""
    return linkage.shared is not None and not all(map(_OF_FORCES.fullmatch, paths))


def can_compute(machine: Machine, paths: Sequence[str], figure: Figure) -> bool:
    """Whether a loop can compute a figure of designs in which these numbers vary."""
    linkage = assemble(machine)
    if not can_emit(linkage) or not all(can_vary(machine, path) for path in paths):
        return False
    if moves_shared(linkage, paths):
        return False
    try:
        emit(linkage, Gathered.of([figure]), paths)
    except (UsageError, MassError):
        return False
    return True
