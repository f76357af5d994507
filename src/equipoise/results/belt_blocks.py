"""What an analysis shows of belts: tension of both strands, and where one would have to push."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.i18n import Note, say
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.outputs.spoken import body_named
from equipoise.quantities import angle, told
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.machine_blocks import largest, smallest


def belt_blocks(forces: Forces) -> Iterator[Block]:
    """Strands of all belts."""
    rows: list[tuple[Cell, ...]] = []
    if not forces.belts:
        return
    for belt in forces.belts.values():
        ends = f"{body_named(belt.by)} → {body_named(belt.on)}"
        for strand, tension in ((say("left"), belt.left), (say("right"), belt.right)):
            found = forces.motion.figures(tension)
            cells = (Value(found.mean), Value(found.rms), largest(found), smallest(found))
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
        found = forces.belts[belt.name]
        left, right = motion.figures(found.left), motion.figures(found.right)
        least = min(left, right, key=lambda strand: strand.min)
        if belt.tension is not None and least.min < 0:
            yield Note(
                "the belt {name} hangs loose: at crank angle {angle} its slack strand would have "
                "to push with {push}; give it a tension of more than {tension}",
                name=belt.name,
                angle=angle(least.min_at),
                push=told(-least.min, "force"),
                tension=told(motion.figures(found.pull).peak / 2, "force"),
            )
