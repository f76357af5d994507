"""From a linkage and signals to source: every step becomes a line, every signal an expression.

Signals go by their names in the output of an analysis.
"""

from __future__ import annotations

from collections.abc import Sequence

from equipoise.codegen.figures import Figure, Gathered
from equipoise.codegen.forces import write_demands, write_joints
from equipoise.codegen.motion import Writer, write_motion
from equipoise.codegen.source import Source, source_of
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.builder import Reaction
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.columns import can_vary
from equipoise.mechanism.linkage import Linkage, assemble
from equipoise.mechanism.model import Machine
from equipoise.mechanism.steps import Call, Rotation, RunningAngle

FRAME_SIGNALS = {
    "shaking_force.x": "{shaking force}.real",
    "shaking_force.y": "{shaking force}.imag",
    "shaking_force": "length({shaking force})",
    "shaking_moment": "{shaking moment}",
    "drive_torque": "{drive torque}",
    "frame_force.x": "{frame force}.real",
    "frame_force.y": "{frame force}.imag",
    "frame_force": "length({frame force})",
    "frame_moment": "{frame moment}",
}
OF_POINTS = ("x", "y", "vx", "vy", "ax", "ay")
OF_LINKS = ("angular_velocity", "angular_acceleration")


def needs_joints(signal: str) -> bool:
    """Whether a signal needs the pass over the joints."""
    return signal.startswith(("joints.", "gears."))


def needs_forces(signal: str) -> bool:
    """Whether a signal needs masses."""
    return signal in FRAME_SIGNALS or needs_joints(signal)


def expression(writer: Writer, signal: str) -> str:
    """A signal as an expression.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it.
    """
    if signal in FRAME_SIGNALS:
        text = FRAME_SIGNALS[signal]
        what = text[text.index("{") + 1 : text.index("}")]
        return text.replace(f"{{{what}}}", writer.name(what))
    kind, _, rest = signal.partition(".")
    found = None
    if kind in ("joints", "gears"):
        found = _joint(writer, rest)
    elif kind == "points":
        found = _point(writer, *rest.rpartition(".")[::2])
    elif kind == "links":
        found = _link(writer, *rest.rpartition(".")[::2])
    if found is None:
        raise UsageError(unknown(signal, _known(writer), "signal"))
    return found


def _known(writer: Writer) -> Sequence[str]:
    named = writer.linkage.named_reactions
    joints = [f"{'gears' if r.kind == 'gear' else 'joints'}.{name}" for name, r in named]
    return [*FRAME_SIGNALS, *joints]


def _joint(writer: Writer, name: str) -> str | None:
    reactions = dict(writer.linkage.named_reactions)
    if name in reactions:
        return f"length({writer.name(reactions[name].force)})"
    name, _, part = name.rpartition(".")
    if name not in reactions:
        return None
    reaction = reactions[name]
    sign = _sign(writer, reaction)
    force = f"({sign} * {writer.name(reaction.force)})"
    if part in ("force_x", "force_y"):
        return f"{force}.{'real' if part == 'force_x' else 'imag'}"
    if part == "moment" and reaction.couple is not None:
        slider = next(s for s in writer.machine.sliders if s.name == reaction.name)
        to, *_ = writer.point(slider.link, slider.point)
        at = writer.name(f"p({reaction.at})")
        return f"{sign} * {writer.name(reaction.couple)} + cross({at} - {to}, {force})"
    return None


def _sign(writer: Writer, reaction: Reaction) -> float:
    """A joint's force is told on the later of its bodies, a gear's on the driven one."""
    order = writer.linkage.joints.bodies.index
    return 1.0 if reaction.kind == "gear" or order(reaction.on) > order(reaction.by) else -1.0


def _point(writer: Writer, name: str, part: str) -> str | None:
    if part not in OF_POINTS:
        return None
    if name in writer.points:
        values = [writer.name(f"{key}({name})") for key in ("p", "p1", "p2")]
    else:
        links = [link for link, body in writer.machine.links.items() if name in body.points]
        if not links:
            return None
        values = writer.point(links[0], name)
    times = {"v": 1, "a": 2}.get(part[0], 0)
    return f"({_in_time(writer, values, times)}).{'real' if part[-1] == 'x' else 'imag'}"


def _link(writer: Writer, name: str, part: str) -> str | None:
    if part not in OF_LINKS or name not in writer.machine.links:
        return None
    return _in_time(writer, writer.body(name)[3:], 1 + OF_LINKS.index(part))


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
    if any(map(needs_forces, gathered.signals)):
        write_demands(writer)
    if any(map(needs_joints, gathered.signals)):
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
