"""What a page shows besides the machine: arrows, a record, variants of the design to compare."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from string import ascii_uppercase
from types import MappingProxyType
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.outputs.declared import DECLARED, body_named
from equipoise.quantities import Dimension, display
from equipoise.quantities.numbers import SAME
from equipoise.results.analysis import Analysis
from equipoise.signals import Array
from equipoise.web.deferred import SAMPLES, can_be_shaken, responded
from equipoise.web.drawing import ground_of, moves_of, stage_of
from equipoise.web.edits import Computed
from equipoise.web.figures import figures_of, listed_signals, text_of
from equipoise.web.measured_records import MeasuredSignals, compared_with
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock, Reply

MOST, LONGEST = 12, 40
"""Variants; signs of the name of one."""
NOTHING, STEP, OPENED = "nothing", "step", "opened"
"""Designs for comparison, besides a variant: none, that before the last change, or as opened."""
VARIANT = "variant:"
"""What stands before the name of one."""


@dataclass(frozen=True)
class Variants:
    """Designs that are kept, by name, and the design with which the one shown is compared."""

    pinned_designs: Mapping[str, Computed] = field(default_factory=dict)
    against: str = STEP

    def pinned(self, computed: Computed) -> Variants:
        """Variants with one more, with which the design is compared from now on.

        Raises
        ------
        UsageError : there are too many.
        """
        if len(self.pinned_designs) >= MOST:
            raise UsageError(
                Note("{most} variants are kept already; delete one of them", most=MOST)
            )
        letters = (a + b for b in ("", *"23456789") for a in ascii_uppercase)
        name = next(letter for letter in letters if letter not in self.pinned_designs)
        return Variants(MappingProxyType({**self.pinned_designs, name: computed}), VARIANT + name)

    def of(self, name: str) -> Computed:
        """One of them, by its name; a `UsageError` where there is none of it."""
        if name not in self.pinned_designs:
            raise UsageError(unknown(name, self.pinned_designs, "variant"))
        return self.pinned_designs[name]

    def renamed(self, name: str, to: str) -> Variants:
        """Variants with one of another name; a `UsageError` where that is none or is taken."""
        self.of(name)
        to = "".join(sign for sign in to.strip() if sign.isprintable())
        if not to or len(to) > LONGEST:
            raise UsageError(
                Note(
                    "got a name of {to} signs; give one of 1 to {longest}",
                    to=len(to),
                    longest=LONGEST,
                )
            )
        if to != name and to in self.pinned_designs:
            raise UsageError(
                Note("there is a variant of the name {to!r} already; give another", to=to)
            )
        by_name = {
            to if item == name else item: result for item, result in self.pinned_designs.items()
        }
        against = VARIANT + to if self.against == VARIANT + name else self.against
        return Variants(MappingProxyType(by_name), against)

    def without(self, name: str) -> Variants:
        """Variants without one of them."""
        self.of(name)
        by_name = {item: result for item, result in self.pinned_designs.items() if item != name}
        against = STEP if self.against == VARIANT + name else self.against
        return Variants(MappingProxyType(by_name), against)

    def with_comparison(self, what: str) -> Variants:
        """Variants compared with something else: one of the three words, or a variant."""
        if what not in (NOTHING, STEP, OPENED):
            self.of(what.removeprefix(VARIANT))
        return replace(self, against=what)

    def named(self) -> str:
        """Name of the design with which figures are compared, in the language that is spoken."""
        if self.against == STEP:
            return say("before the last change")
        if self.against == OPENED:
            return say("as it was opened")
        return self.against.removeprefix(VARIANT)

    def table(self, now: Computed) -> JsonObject:
        """Figures of every variant and of the design that is, and which is best of each.

        Of every figure the smallest is best; none is where all are the same.
        """
        every = [item.analysis for item in (*self.pinned_designs.values(), now)]
        figures = [_named(figures_of(item)) for item in every]
        names = [name for name in figures[-1] if all(name in figure for figure in figures)]
        rows = [_row([figure[name] for figure in figures]) for name in names]
        rows += _gauges((*self.pinned_designs.values(), now))
        masses = [item.machine.mass for item in every]
        if all(masses):
            unit = display("mass", masses)
            words = {"label": say("mass of the links"), "unit": unit.name}
            values = [unit.factor * mass for mass in masses]
            rows.append(
                _row([{**words, "value": value, "text": text_of(value)} for value in values])
            )
        return {"kept": [*self.pinned_designs], "against": self.against, "rows": rows}


def _named(figures: list[JsonObject]) -> dict[str, JsonObject]:
    return {figure["name"]: figure for figure in figures}


def _gauges(every: Sequence[Computed]) -> Iterator[JsonObject]:
    """What gauges read peak to peak, where every design has the same and a steady state."""
    try:
        items = [responded(item).gauges for item in every if can_be_shaken(item.design.machine)]
    except EquipoiseError:
        return
    if len(items) < len(every):
        return
    for name in (item for item in items[-1] if all(item in gauges for gauges in items)):
        read = [gauges[name].displacement.peak_to_peak for gauges in items]
        output = DECLARED["gauges.{}"].say(name)
        dimension: Dimension = "angle" if items[-1][name].rotation else "length"
        unit = display(dimension, read, "mrad" if dimension == "angle" else None)
        words = {"label": say("{output}, peak to peak", output=output), "unit": unit.name}
        values = [float(unit.factor * item) for item in read]
        yield _row([{**words, "value": value, "text": text_of(value)} for value in values])


def _row(cells: list[JsonObject]) -> JsonObject:
    values = [cell["value"] for cell in cells]
    known = [abs(value) for value in values if value is not None]
    least, most = min(known, default=0.0), max(known, default=0.0)
    best = [
        number
        for number, value in enumerate(values)
        if value is not None and most - least > SAME * most and abs(value) - least <= SAME * most
    ]
    texts = [cell["text"] for cell in cells]
    return {"label": cells[-1]["label"], "unit": cells[-1]["unit"], "texts": texts, "best": best}


def points_of(analysis: Analysis) -> list[str]:
    """Points that arrows can be at: those that move, then those of the frame."""
    frame = analysis.machine.frame
    return sorted(analysis.motion.points, key=lambda name: name in frame)


def arrows_of(analysis: Analysis, point: str, block: FloatBlock) -> list[JsonObject]:
    """What there is to show at a point; vectors over the crank angle go to the block.

    kind : ``velocity``, ``acceleration`` or ``force``.  array : its name in the block, (2 N,).
    """
    items = [*_arrows_at(analysis, point)]
    for entry, values in items:
        block.add(entry["array"], values)
    return [item for item, _ in items]


def _arrows_at(analysis: Analysis, point: str) -> Iterator[tuple[JsonObject, Array]]:
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


def _quantity(kind: str, array: str, label: str, dimension: Dimension) -> JsonObject:
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
    return () if support is None else tuple(support.readings)


def charted(output: str) -> bool:
    """Whether an output has a chart without being asked for."""
    if output.startswith("joints."):
        return output.count(".") == 1
    return output in listed_signals()


def signals_without_chart(record: MeasuredSignals, computed: Computed) -> list[str]:
    """Outputs that a record measures, and that have no chart unless they are asked for.

    Raises
    ------
    EquipoiseError : the record cannot be compared with the design.
    """
    analysis = computed.analysis
    compared = compared_with(record, analysis, gauges_of(computed))
    return [name for name in compared.signals if name in analysis.outputs and not charted(name)]


def record_values(
    record: MeasuredSignals | None, computed: Computed, block: FloatBlock
) -> JsonObject | None:
    """Values of a record compared with a design: its name and notes; signals go to the block.

    ``measured.`` and the name of an output : (N,) SI units, NaN in gaps; what gauges read has as
    many numbers as their response.
    """
    if record is None:
        return None
    try:
        compared = compared_with(record, computed.analysis, gauges_of(computed))
    except EquipoiseError as error:  # of a machine that has been changed meanwhile
        return {"name": record.name, "lines": [error.message()], "left_out": []}
    for name, values in compared.signals.items():
        count, own = len(values), len(values)
        if name.startswith(GAUGES):
            count = SAMPLES * computed.motion.turns
        at = np.arange(count) * own / count
        block.add(f"measured.{name}", np.interp(at, np.arange(own), values, period=own))
    text = {"lines": [*compared.sentences], "left_out": [*compared.left_out]}
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
