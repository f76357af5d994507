"""What an analysis shows of belts: tension of both strands, and where one would have to push."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.i18n import Note, say
from equipoise.mechanism.outputs.declared import body_named
from equipoise.quantities import angle, format_quantity
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.machine_blocks import largest, smallest

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics.forces import Forces
    from equipoise.results.analysis import Analysis


def belt_blocks(analysis: Analysis) -> Iterator[Block]:
    """Strands of all belts."""
    forces = analysis.resolved.forces
    rows: list[tuple[Cell, ...]] = []
    for belt in forces.belts.values():
        ends = f"{body_named(belt.by)} → {body_named(belt.on)}"
        for strand, tension in ((say("left"), belt.left), (say("right"), belt.right)):
            figures = forces.motion.figures(tension)
            cells = (Value(figures.mean), Value(figures.rms), largest(figures), smallest(figures))
            rows.append((strand, ends, *cells))
    labels = (say("mean"), say("RMS"), say("largest"), say("smallest"))
    columns = ("", say("by → on"), *(Column(label, "force") for label in labels))
    yield Table.of(say("Tension of the strands of belts, with its crank angle"), columns, rows)
    if loose := tuple(slack(forces)):
        yield Notes(loose)


def slack(forces: Forces) -> Iterator[Note]:
    """Where a belt would have to push, which it cannot."""
    motion = forces.motion
    for belt in motion.machine.belts:
        result = forces.belts[belt.name]
        left, right = motion.figures(result.left), motion.figures(result.right)
        least = min(left, right, key=lambda strand: strand.min)
        if belt.tension is not None and least.min < 0:
            yield Note(
                "the belt {name} hangs loose: at crank angle {angle} its slack strand would have "
                "to push with {push}; give it a tension of more than {tension}",
                name=belt.name,
                angle=angle(least.min_at),
                push=format_quantity(-least.min, "force"),
                tension=format_quantity(motion.figures(result.pull).peak / 2, "force"),
            )
