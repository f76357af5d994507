"""Forces in joints and between teeth, as an analysis shows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import say, to_say
from equipoise.mechanism.dynamics.reactions import (
    JointForce,
    SliderForce,
)
from equipoise.mechanism.outputs.declared import DECLARED, body_named, joint_named
from equipoise.mechanism.parts.element_kinds import (
    Element,
    element_kinds,
    named_function,
    part_kinds,
)
from equipoise.quantities import Dimension, Display, display
from equipoise.results.bearing_blocks import bearing_blocks
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.friction_blocks import friction_blocks
from equipoise.results.machine_blocks import largest, smallest
from equipoise.results.remarks import remarks_of
from equipoise.results.scales import scale_of
from equipoise.results.section_blocks import section_blocks

if TYPE_CHECKING:
    from equipoise.mechanism.dynamics.forces import Forces
    from equipoise.results.analysis import Analysis


MOST_OUTPUTS = 3
"""Outputs of one kind of elements in one table; each has its smallest and its largest value."""


def joint_blocks(analysis: Analysis) -> Iterator[Block]:
    """Forces in joints, which of them statics leaves open, friction, bearings, stress in links."""
    if analysis.forces.solved.contacts:
        yield joint_table(analysis)
    if items := (*remarks_of(analysis, "joints"),):
        yield Notes(items)
    yield from friction_blocks(analysis)
    yield from bearing_blocks(analysis)
    yield from section_blocks(analysis)


def kind_tables(analysis: Analysis, chapter: str) -> Iterator[Block]:
    """What kinds of parts have tables of in a chapter, of each kind that the machine has."""
    for table, kind in part_kinds(type(analysis.machine)).items():
        if chapter in kind.tables and getattr(analysis.machine, table):
            yield from named_function(kind.tables[chapter])(analysis)


def elements_tables(analysis: Analysis) -> Iterator[Table]:
    """Outputs of elements, smallest and largest, a table for each kind."""
    for table, kind in element_kinds(type(analysis.machine)).items():
        if elements := getattr(analysis.machine, table):
            for names in _side_by_side(table, kind):
                yield _elements_table(analysis, table, kind, elements, names)


def _side_by_side(table: str, kind: type[Element]) -> list[list[str]]:
    """Outputs of a kind that one table shows: all of few, else those of a dimension, since a page
    is as wide as six numbers with their crank angles.
    """
    if len(kind.headings) <= MOST_OUTPUTS:
        return [[*kind.headings]]
    by_dimension: dict[Dimension | None, list[str]] = {}
    for name in kind.headings:
        by_dimension.setdefault(DECLARED[f"{table}.{{}}.{name}"].dimension, []).append(name)
    return [*by_dimension.values()]


def _elements_table(
    analysis: Analysis,
    table: str,
    kind: type[Element],
    elements: Sequence[Element],
    names: Sequence[str],
) -> Table:
    """The smallest and the largest value of outputs of these names, a row for each element."""
    rows: list[tuple[Cell, ...]] = []
    for number, element in enumerate(elements):
        values = analysis.motion.element_values(table, number)
        figures = (analysis.motion.figures(values[name]) for name in names)
        cells = (cell(figure) for figure in figures for cell in (smallest, largest))
        rows.append((str(number + 1), " → ".join(map(body_named, element.route)), *cells))
    columns: list[str | Column] = ["", say("from → to")]
    for name in names:
        dimension = DECLARED[f"{table}.{{}}.{name}"].dimension
        columns += [Column(say(head), dimension) for head in kind.headings[name]]
    return Table.of(say(kind.title), columns, rows)


def contact_named(forces: Forces, name: str) -> str:
    """A joint or coupling, by the kind of its contact."""
    if name in forces.joints:
        return joint_named(name)
    couplings = forces.motion.machine.couplings
    return say(next(coupling.touch for coupling in couplings if coupling.name == name))


def display_of_joints(analysis: Analysis) -> Display:
    """The unit in which forces in joints, between teeth and of bearings are shown everywhere."""
    forces = analysis.forces
    ones = [*forces.solved.contacts.values()]
    if analysis.machine.has_planes:
        ones += forces.across.bearings.values()
    return display("force", [0.0, *(float(np.max(item.size, initial=0.0)) for item in ones)])


def joint_table(analysis: Analysis) -> Table:
    """The force in every joint, mesh and bearing."""
    analysis = analysis.resolved
    forces = analysis.forces
    joints: dict[str, JointForce] = forces.solved.contacts
    across = forces.across if analysis.machine.has_planes else None
    tilting = {} if across is None else across.tilting_moments
    scale = scale_of(analysis, "torque")
    rows: list[tuple[Cell, ...]] = []
    for name, joint in joints.items():
        couple = None
        if isinstance(joint, SliderForce):
            couple = Value(analysis.motion.figures(joint.moment).peak, scale)
        rows.append(
            (
                contact_named(forces, name),
                *_cells(analysis, joint),
                couple,
                _peak(analysis, tilting.get(name), scale),
            )
        )
    for name, joint in across.bearings.items() if across is not None else ():
        rows.append((say("bearing {name}", name=name), *_cells(analysis, joint), None, None))
    labels = (say("mean"), say("RMS"), say("largest"))
    unit = display_of_joints(analysis).unit
    columns = ["", say("by → on"), *(Column(label, "force", unit) for label in labels)]
    columns += [Column(say(item), "torque") for item in (MOMENT, TILTING)]
    filled = [k for k in range(len(columns)) if any(row[k] is not None for row in rows)]
    title = say("Force in each joint; largest with its crank angle")
    return Table.of(title, [columns[k] for k in filled], ([row[k] for k in filled] for row in rows))


MOMENT, TILTING = to_say("moment"), to_say("tilting moment")


def _cells(analysis: Analysis, joint: JointForce) -> tuple[Cell, ...]:
    """Which bodies it is between, and mean, RMS and largest of a force."""
    figures = analysis.motion.figures(joint.size)
    ends = f"{body_named(joint.by)} → {body_named(joint.on)}"
    return ends, Value(figures.mean), Value(figures.rms), largest(figures)


def _peak(analysis: Analysis, moment: JointForce | None, scale: float) -> Value | None:
    if moment is None:
        return None
    return Value(analysis.motion.figures(moment.size).peak, scale)
