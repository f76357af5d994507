"""From a linkage and signals to source: every step becomes a line, every signal an expression.

Signals go by their names in the output of an analysis.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from equipoise.codegen.figures import Figure, Gathered
from equipoise.codegen.forces import write_demands, write_joints
from equipoise.codegen.motion import Writer, write_motion
from equipoise.codegen.source import Source, source_of
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.family import can_vary
from equipoise.mechanism.linkage import Linkage, assemble
from equipoise.mechanism.model import Machine
from equipoise.mechanism.outputs import DECLARED, declared
from equipoise.mechanism.steps import Call, Reaction, Rotation, RunningAngle

_LOOKED_UP = re.compile(r"\{([^}:]+)(:name)?\}")
"""Values in the expression of an output: of the machine, or of the member of a family."""
ORDERS = {"position": 0, "velocity": 1, "acceleration": 2}
TURNING = {"angular velocity": 1, "angular acceleration": 2}
"""How often a position, or an angle, is differentiated by time."""


def expression(writer: Writer, signal: str) -> str:
    """A signal as an expression.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it.
    """
    one, item = declared(signal) or (None, "")
    whole = _whole(writer, one.loop, item) if one is not None and one.loop else None
    if one is None or whole is None:
        raise UsageError(unknown(signal, _known(writer), "signal"))
    parts = {"": "{}", "size": "length({})", "x": "({}).real", "y": "({}).imag"}
    return parts[one.part].format(whole)


def _known(writer: Writer) -> Sequence[str]:
    named = writer.linkage.named_reactions
    joints = [f"{'gears' if r.kind == 'gear' else 'joints'}.{name}" for name, r in named]
    return [*(one.name for one in DECLARED.values() if one.loop and not one.is_family), *joints]


def _whole(writer: Writer, loop: str, item: str) -> str | None:
    """The expression of an output with identifiers instead of names; None where one is missing."""
    found = {
        match[0]: _of_member(writer, match[1], item) if match[2] else _of_machine(writer, match[1])
        for match in _LOOKED_UP.finditer(loop)
    }
    if None in found.values():
        return None
    return _LOOKED_UP.sub(lambda match: str(found[match[0]]), loop)


def _of_machine(writer: Writer, value: str) -> str:
    return writer.rate(value) if value in ("speed", "acceleration") else writer.name(value)


def _of_member(writer: Writer, value: str, item: str) -> str | None:
    if value in ORDERS:
        return _point(writer, item, ORDERS[value])
    if value in TURNING:
        known = item in writer.machine.links
        return _in_time(writer, writer.body(item)[3:], TURNING[value]) if known else None
    reaction = dict(writer.linkage.named_reactions).get(item)
    if reaction is None:
        return None
    sign = _sign(writer, reaction)
    force = f"({sign} * {writer.name(reaction.force)})"
    if value == "joint force":
        return force
    if reaction.couple is None:
        return None
    slider = next(s for s in writer.machine.sliders if s.name == reaction.name)
    to, *_ = writer.point(slider.link, slider.point)
    at = writer.name(f"p({reaction.at})")
    return f"{sign} * {writer.name(reaction.couple)} + cross({at} - {to}, {force})"


def _sign(writer: Writer, reaction: Reaction) -> float:
    """A joint's force is told on the later of its bodies, a gear's on the driven one."""
    order = writer.linkage.joints.bodies.index
    return 1.0 if reaction.kind == "gear" or order(reaction.on) > order(reaction.by) else -1.0


def _point(writer: Writer, name: str, times: int) -> str | None:
    if name in writer.points:
        values = [writer.name(f"{key}({name})") for key in ("p", "p1", "p2")]
    else:
        links = [link for link, body in writer.machine.links.items() if name in body.points]
        if not links:
            return None
        values = writer.point(links[0], name)
    return _in_time(writer, values, times)


def _in_time(writer: Writer, values: Sequence[str], times: int) -> str:
    """A value, or its first or second derivative by time, from those by crank angle."""
    speed, acceleration = writer.rate("speed"), writer.rate("acceleration")
    value, first, second = values
    if times < 2:
        return (value, f"{first} * {speed}")[times]
    return f"{second} * {speed} * {speed} + {first} * {acceleration}"


def can_emit(linkage: Linkage) -> bool:
    """Whether the steps of a linkage can be written out: no group of loops, no soil."""
    machine = linkage.machine
    soil = machine.planting is not None and machine.planting.soil is not None
    return not soil and all(isinstance(s, Call | RunningAngle | Rotation) for s in linkage.motion)


def emit(linkage: Linkage, gathered: Gathered) -> Source:
    """Write out the steps of a linkage, with the signals that are gathered.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it or this linkage.
    MassError : it needs masses, and the machine lacks some.
    """
    if not can_emit(linkage):
        raise UsageError("groups of loops, and fingers in soil, cannot be computed in a loop")
    writer = Writer(linkage)
    write_motion(writer)
    wanted = [one for one, _ in filter(None, map(declared, gathered.signals))]
    if any(one.needs == "masses" for one in wanted):
        write_demands(writer)
    if any("{joint " in (one.loop or "") for one in wanted):
        write_joints(writer)
    signals = [writer.sheet.put(f"signal {s}", expression(writer, s)) for s in gathered.signals]
    return source_of(writer.sheet, signals, writer.numbers(), gathered)


def can_compute(machine: Machine, paths: Sequence[str], figure: Figure) -> bool:
    """Whether a loop can compute a figure of designs in which these numbers vary."""
    linkage = assemble(machine)
    if not can_emit(linkage) or not all(can_vary(machine, path) for path in paths):
        return False
    try:
        emit(linkage, Gathered.of([figure]))
    except (UsageError, MassError):
        return False
    return True
