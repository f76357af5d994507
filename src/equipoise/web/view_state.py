"""What a page shows besides the machine itself: arrows, records, comparisons."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from threading import Lock
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.outputs.declared import body_named
from equipoise.quantities import Dimension, display
from equipoise.results.analysis import Analysis
from equipoise.web.block import Array, FloatBlock, Values
from equipoise.web.deferred import SAMPLES
from equipoise.web.drawing import ground_of, moves_of, stage_of
from equipoise.web.edits import Computed
from equipoise.web.figures import listed_signals
from equipoise.web.measured_records import MeasuredSignals, compared_with, record_of_text
from equipoise.web.messages import MOST_OUTPUTS, Message
from equipoise.web.replies import Reply
from equipoise.web.variants import NOTHING, OPENED, STEP, VARIANT, Variants


def points_of(analysis: Analysis) -> list[str]:
    """Points that arrows can be at: those that move, then those of the frame."""
    frame = analysis.machine.frame
    return sorted(analysis.motion.points, key=lambda name: name in frame)


def arrows_of(analysis: Analysis, point: str, block: FloatBlock) -> list[Values]:
    """What there is to show at a point; vectors over the crank angle go to the block.

    kind : ``velocity``, ``acceleration`` or ``force``.  array : its name in the block, (2 N,).
    """
    items = [*_arrows_at(analysis, point)]
    for entry, values in items:
        block.add(entry["array"], values)
    return [item for item, _ in items]


def _arrows_at(analysis: Analysis, point: str) -> Iterator[tuple[Values, Array]]:
    motion = analysis.motion.points.get(point)
    if motion is None:
        return
    if point not in analysis.machine.frame and analysis.motion.speed:
        moved: Mapping[str, tuple[Dimension, Array]] = {
            "velocity": ("speed", motion.velocity),
            "acceleration": ("acceleration", motion.acceleration_vector),
        }
        for kind, (dimension, values) in moved.items():
            label = analysis.outputs[f"points.{point}.{kind}"].label()
            yield _quantity(kind, f"arrow.{kind}", label, dimension), values
    joints = analysis.forces.joints if analysis.has_forces else {}
    for name in _joints_at(analysis, point, joints):
        joint = joints[name]
        label = analysis.outputs[f"joints.{name}"].label()
        label = say("{force}, on {body}", force=label, body=body_named(joint.on))
        yield _quantity("force", f"arrow.force.{name}", label, "force"), joint.value


def _quantity(kind: str, array: str, label: str, dimension: Dimension) -> Values:
    unit = display(dimension)
    return {"kind": kind, "array": array, "label": label, "unit": unit.name, "factor": unit.factor}


def _joints_at(analysis: Analysis, point: str, joints: Mapping[str, Any]) -> list[str]:
    """Names of pins and sliding joints at a point."""
    slides = {slider.name for slider in analysis.machine.sliders if slider.point == point}
    return [name for name in joints if name.partition("/")[0] == point or name in slides]


GAUGES = "gauges."


def gauges_of(computed: Computed) -> tuple[str, ...]:
    """Names of the gauges of a machine's support."""
    support = computed.design.machine.support
    return () if support is None else tuple(support.gauges)


def charted(output: str) -> bool:
    """Whether an output has a chart without being asked for."""
    if output.startswith("joints."):
        return output.count(".") == 1
    return output in listed_signals()


def record_values(
    record: MeasuredSignals | None, computed: Computed, block: FloatBlock
) -> Values | None:
    """Values of a record compared with a design: its name and notes; signals go to the block.

    ``measured.`` and the name of an output : (N,) SI units, NaN in gaps; what gauges read has as
    many numbers as their response.
    """
    if record is None:
        return None
    try:
        compared = compared_with(record, computed.analysis, gauges_of(computed))
    except EquipoiseError as error:  # of a machine that has been changed meanwhile
        return {"name": record.name, "told": [error.message()], "left_out": []}
    for name, values in compared.signals.items():
        count, own = len(values), len(values)
        if name.startswith(GAUGES):
            count = SAMPLES * computed.motion.turns
        at = np.arange(count) * own / count
        block.add(f"measured.{name}", np.interp(at, np.arange(own), values, period=own))
    text = {"told": [*compared.sentences], "left_out": [*compared.left_out]}
    return {"name": record.name, **text}


@dataclass
class ViewState:
    """What a page shows besides the machine.

    arrows_at : a point.  variants : that are kept.
    last : the design before the last change.  opened : the first one.
    record : signals that were measured, drawn beside the machine's own.
    ghost, table : the pale drawing, and the table of variants, as the page has them.
    """

    arrows_at: str | None = None
    variants: Variants = field(default_factory=Variants)
    last: Computed | None = None
    opened: Computed | None = None
    record: MeasuredSignals | None = None
    ghost: Computed | None = None
    table: dict[str, Any] | None = None

    def against(self, previous: Computed | None) -> Computed | None:
        """The design that figures are compared with; None without a comparison.

        previous : the one that a drag, which is under way, began with.
        """
        what = self.variants.against
        if what == NOTHING:
            return None
        if what == STEP:
            return previous or self.last
        return self.opened if what == OPENED else self.variants.of(what.removeprefix(VARIANT))

    @property
    def pale(self) -> Computed | None:
        """The design that is drawn pale, with pale curves."""
        return None if self.variants.against == STEP else self.against(None)

    def opening(self, computed: Computed | None) -> ViewState:
        """View of a machine that is opened: nothing is kept but what the page knows."""
        return ViewState(opened=computed, ghost=self.ghost, table=self.table)

    def compared(self, computed: Computed | None) -> Iterator[Reply]:
        """The pale drawing and the table of variants, where the page has others.

        computed : the design that is; None while something is dragged.
        """
        if self.pale is not self.ghost:
            self.ghost = self.pale
            yield _ghost(self.ghost)
        if computed is None:
            return
        bare = Variants()
        table = None if self.variants == bare else self.variants.table(computed)
        if table != self.table:
            self.table = table
            yield Reply({"type": "variants", "seq": None, **(table or bare.table(computed))})


def _ghost(pale: Computed | None) -> Reply:
    block = FloatBlock()
    if pale is None:
        return Reply({"type": "ghost", "seq": None, "scene": None, "arrays": {}})
    moves_of(pale.scene, block)
    ground_of(pale, block)
    scene = stage_of(pale.scene, ())
    return Reply(
        {"type": "ghost", "seq": None, "scene": scene, "arrays": block.placement}, block.data
    )


# -- what a page may ask ---------------------------------------------------------------------------


class ViewSession(Protocol):
    """What answers need of a session."""

    view_state: ViewState
    lock: Lock
    wanted: tuple[str, ...]

    @property
    def shown(self) -> Computed:
        """What the page sees."""

    def current(self) -> Computed:
        """The design that is."""

    def go_to(self, computed: Computed, label: str) -> None:
        """Make another design the one that is."""

    def state_replies(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """Replies on the design that is shown."""


def _arrows(session: ViewSession, message: Message) -> Iterator[Reply]:
    """Show arrows at a point, or at none."""
    point = message.text("point", "") or None
    points = points_of(session.shown.analysis)
    if point is not None and point not in points:
        raise UsageError(unknown(point, points, "point"))
    session.view_state.arrows_at = point
    yield from session.state_replies(message.seq)


def _variant(session: ViewSession, message: Message) -> Iterator[Reply]:
    """Keep the design, or do something with one that is kept."""
    doing = message.text("do")
    if doing not in DOING:
        raise UsageError(unknown(doing, DOING, "thing to do with a variant"))
    with session.lock:
        DOING[doing](session, message)
    yield from session.state_replies(message.seq)


def _pin(session: ViewSession, _: Message) -> None:
    session.view_state.variants = session.view_state.variants.pinned(session.current())


def _rename(session: ViewSession, message: Message) -> None:
    view = session.view_state
    view.variants = view.variants.renamed(message.text("name"), message.text("to"))


def _drop(session: ViewSession, message: Message) -> None:
    session.view_state.variants = session.view_state.variants.without(message.text("name"))


def _go(session: ViewSession, message: Message) -> None:
    name = message.text("name")
    result = session.view_state.variants.of(name)
    session.go_to(result, say("go to {name}", name=name))


def _against(session: ViewSession, message: Message) -> None:
    session.view_state.variants = session.view_state.variants.with_comparison(message.text("to"))


def _record(session: ViewSession, message: Message) -> Iterator[Reply]:
    """Draw a record beside the machine's own signals, or none where it has no text."""
    text, record = message.text("text", ""), None
    if text:
        analysis = session.shown.analysis
        record = record_of_text(message.text("name", "record.csv"), text)
        compared = compared_with(record, analysis, gauges_of(session.shown))
        matching_signals = [
            name for name in compared.signals if name in analysis.outputs and not charted(name)
        ]
        session.wanted = tuple(dict.fromkeys((*session.wanted, *matching_signals)))[-MOST_OUTPUTS:]
    session.view_state.record = record
    yield from session.state_replies(message.seq)


NO_STORE = Note("no store of a study is open; give one to `equipoise serve`")


def _stores(session: ViewSession, message: Message) -> Iterator[Reply]:
    """Without a server there are none."""
    yield Reply({"type": "stores", "seq": message.seq, "folder": None, "names": []})


def _stored(session: ViewSession, message: Message) -> Iterator[Reply]:
    """Nothing that is asked of a store is here."""
    raise UsageError(NO_STORE)


DOING: dict[str, Callable[[ViewSession, Message], None]] = {
    "pin": _pin,
    "rename": _rename,
    "drop": _drop,
    "go": _go,
    "against": _against,
}
ASKED: dict[str, Callable[[ViewSession, Message], Iterator[Reply]]] = {
    "arrows": _arrows,
    "variant": _variant,
    "record": _record,
    "stores": _stores,
    "study": _stored,
    "design": _stored,
}
"""Answers to messages, by their kind."""
