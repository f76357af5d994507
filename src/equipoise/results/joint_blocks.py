"""What an analysis shows of joints and links: forces, friction, bearings, stress in sections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import Note, say, to_say
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
from equipoise.quantities import Dimension, Display, display, format_quantity, percent
from equipoise.results.blocks import Block, Cell, Column, Facts, Notes, Table, Value
from equipoise.results.machine_blocks import largest, scale_of, smallest
from equipoise.results.remarks import remarks_of

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
    title = say("Force in each joint; largest with its crank angle")
    return Table.of_filled(title, columns, rows)


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


# -- friction, bearings and stress -----------------------------------------------------------------


def friction_blocks(analysis: Analysis) -> Iterator[Block]:
    """Losses of all joints, and the efficiency."""
    whole = analysis.resolved
    losses, forces = whole.losses, whole.forces
    if losses is None:
        return
    total = losses.loss
    rows: list[tuple[Cell, ...]] = []
    for name, joint in losses.joints.items():
        friction = forces.frictions[name]
        kind: Dimension = "torque" if friction.is_pin else "force"
        figures = forces.motion.figures(abs(friction.effort))
        resists = largest(figures, dimension=kind)
        share = f"{percent(joint.loss / total)} %" if total else ""
        wears = Value(joint.wear_work) if friction.wears else None
        rows.append((joint_named(name), Value(joint.loss), share, resists, wears))
    columns = (
        "",
        Column(say("mean loss"), "power"),
        say("share"),
        say("largest friction"),
        Column(say("contact force times sliding way in a turn"), "energy"),
    )
    yield Table.of(say("Friction in joints; largest with its crank angle"), columns, rows)
    lines = [
        say(
            "drive gives {drive}, loads give {loads}, joints lose {loss} in the mean",
            drive=format_quantity(losses.drive, "power", "W"),
            loads=format_quantity(losses.loads, "power", "W"),
            loss=format_quantity(total, "power", "W"),
        )
    ]
    if losses.efficiency is not None:
        lines.append(say("efficiency {share} %", share=percent(losses.efficiency)))
    yield Facts(say("Power in the mean of a cycle"), tuple(lines))


def bearing_blocks(analysis: Analysis) -> Iterator[Block]:
    """Tables of rolling and of plain bearings, where there are any."""
    if analysis.rolling_bearings:
        yield _rolling_table(analysis)
    if analysis.plain_bearings:
        yield _plain_table(analysis)


def _rolling_table(analysis: Analysis) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for name, rolling_bearing in analysis.rolling_bearings.items():
        reached = (
            None if rolling_bearing.reached is None else f"{percent(rolling_bearing.reached)} %"
        )
        numbers = (
            rolling_bearing.basic_life,
            rolling_bearing.rated_life,
            rolling_bearing.needed_rating,
            rolling_bearing.static_safety,
        )
        life, rated, rating, safety = (None if x is None else Value(x) for x in numbers)
        load, speed = Value(rolling_bearing.equivalent_load), Value(rolling_bearing.speed)
        rows.append((joint_named(name), load, speed, life, rated, reached, rating, safety))
    columns = [
        "",
        Column(say("equivalent load"), "force"),
        Column(say("mean speed"), "angular speed", "rpm"),
        Column(say("life that 90 % reach (L10)"), "time", "h"),
        Column(say("life at the wanted reliability"), "time", "h"),
        say("share that reaches the wanted life"),
        Column(say("dynamic rating needed"), "force"),
        say("static safety"),
    ]
    states = len(analysis.machine.duty)
    title = say("Rolling bearings in joints")
    if states:
        title = say("Rolling bearings in joints, over {count} duty states", count=states)
    return Table.of_filled(title, columns, rows)


def _plain_table(analysis: Analysis) -> Table:
    rows = [
        (
            joint_named(name),
            Value(item.pressure, at=item.pressure_at),
            Value(item.pressure_speed, at=item.pressure_speed_at),
            Value(item.mean_pressure_speed),
        )
        for name, item in analysis.plain_bearings.items()
    ]
    columns = (
        "",
        Column(say("largest pressure"), "modulus"),
        Column(say("largest pressure times speed"), "pressure times speed"),
        Column(say("mean"), "pressure times speed"),
    )
    title = say("Plain bearings in joints; largest with its crank angle")
    if (states := len(analysis.machine.duty)) and analysis.motion.is_steady_cycle:
        title = say(
            "Plain bearings in joints, over {count} duty states; largest with its crank angle",
            count=states,
        )
    return Table.of(title, columns, rows)


BELOW = 1e-9
"""Share of a link's mass below 0 that is rounding."""


def section_blocks(analysis: Analysis) -> Iterator[Block]:
    """Loads and strength of each link with a section."""
    if not analysis.sections:
        return
    loads: list[tuple[Cell, ...]] = []
    strength: list[tuple[Cell, ...]] = []
    force, moment = scale_of(analysis, "force"), scale_of(analysis, "torque")
    for name, section in analysis.sections.items():
        along = (section.tension, section.compression, section.shear)
        forces = (Value(value, force) for value in along)
        loads.append((name, *forces, Value(section.bending_moment, moment)))
        safeties = (section.safety, section.buckling_safety, section.fatigue_safety)
        cells = (None if safety is None else Value(safety) for safety in safeties)
        life = None if section.life is None else Value(section.life)
        place = say(
            "{distance} from {point}, {side}",
            distance=format_quantity(section.place, "length", "mm"),
            point=_first_end(analysis, name),
            side=say("left fibre") if section.fibre == "left" else say("right fibre"),
        )
        stress = Value(section.stress, at=section.stress_at)
        strength.append((name, stress, place, *cells, life))
    heads = (say("tension"), say("compression"), say("shear"))
    columns = ["", *(Column(head, "force") for head in heads)]
    columns.append(Column(say("bending moment"), "torque"))
    yield Table.of(say("Loads along links, largest"), columns, loads)
    heads = (say("yielding"), say("buckling"), say("fatigue"))
    columns = ["", Column(say("stress"), "modulus"), say("place"), *heads]
    columns.append(Column(say("life"), "time", "h"))
    title = say("Largest stress along links (at crank angle), and safety")
    if states := len(analysis.machine.duty):
        title = say(
            "Largest stress along links (at crank angle), and safety, over {count} duty states",
            count=states,
        )
    yield Table.of_filled(title, columns, strength)
    yield from _elastic_blocks(analysis)
    if notes := (*_section_notes(analysis), *remarks_of(analysis, "sections")):
        yield Notes(notes)


def _elastic_blocks(analysis: Analysis) -> Iterator[Block]:
    """How links with an elastic modulus bend."""
    rows: list[tuple[Cell, ...]] = []
    for name, section in analysis.sections.items():
        if section.deflection is not None:
            frequency = (
                None if section.natural_frequency is None else Value(section.natural_frequency)
            )
            bent = Value(section.deflection, at=section.deflection_at)
            rows.append((name, frequency, bent, Value(section.path_error or 0.0)))
    if rows:
        columns = (
            "",
            Column(say("first natural frequency"), "frequency"),
            Column(say("largest deflection"), "length"),
            Column(say("largest error of the path of a point"), "length"),
        )
        yield Table.of(say("Links as beams on pins at both ends (at crank angle)"), columns, rows)


def _first_end(analysis: Analysis, link: str) -> str:
    body = analysis.machine.links[link]
    assert body.section is not None
    return body.section.ends(body.points)[0]


def _section_notes(analysis: Analysis) -> Iterator[Note]:
    """Links whose mass does not lie between the ends of their line."""
    for name, section in analysis.sections.items():
        mass = analysis.machine.links[name].mass or 0.0
        if min(section.rod_mass, section.least_end_mass) < -BELOW * mass:
            yield Note(
                to_say(
                    "mass of the {link} lies beyond the ends of the line of its section, or close "
                    "to its middle: a rod with a lump at each end has it only with one of these "
                    "below 0"
                ),
                link=name,
            )
