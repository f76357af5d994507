"""What an analysis shows of links whose section is given: stress, buckling and life."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.i18n import Note, say, to_say
from equipoise.quantities import format_quantity
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.remarks import remarks_of
from equipoise.results.scales import scale_of

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

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
            point=_first(analysis, name),
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
    filled = [k for k in range(len(columns)) if any(row[k] is not None for row in strength)]
    title = say("Largest stress along links (at crank angle), and safety")
    if states := len(analysis.machine.duty):
        title = say(
            "Largest stress along links (at crank angle), and safety, over {count} duty states",
            count=states,
        )
    rows = ([row[k] for k in filled] for row in strength)
    yield Table.of(title, [columns[k] for k in filled], rows)
    yield from _elastic_blocks(analysis)
    if notes := (*_notes(analysis), *remarks_of(analysis, "sections")):
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


def _first(analysis: Analysis, link: str) -> str:
    body = analysis.machine.links[link]
    assert body.section is not None
    return body.section.ends(body.points)[0]


def _notes(analysis: Analysis) -> Iterator[Note]:
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
