"""What stands first of an analysis: the verdict for this machine, what else is large, what is next.

`yardsticks` has the reference value against which each figure is large or not.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from equipoise.i18n import say, to_say
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.balance import GAUGES
from equipoise.quantities import format_quantity
from equipoise.results.blocks import Block, Facts, Notes, Text, broken_if
from equipoise.results.machine_blocks import driven
from equipoise.results.rotors import rotor_sentence
from equipoise.results.yardsticks import (
    FigureAssessment,
    GaugeReading,
    assess,
    contact_sentence,
    kept_contact,
    sentence,
    verdict,
)

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

MOST_LARGE, MOST_SMALL = 3, 2
"""Figures at most beside the verdict: among large figures, and where no figure is large."""
MOST_NOTES = 3
"""Notes that stand first; the others follow with all tables."""
ELSE_LARGE = to_say("Other large figures, each with its reference value")
NEXT_TO_ONE = to_say("Nothing else is large; nearest to their reference values")
NEXT_TO_NONE = to_say("Nothing is large; nearest to their reference values")


def analysis_headline(
    analysis: Analysis,
    alone: bool = False,
    readings: Mapping[str, GaugeReading] | None = None,
) -> Iterator[Block]:
    """The verdict and what else is large; alone also what the machine is, and what to look at next.

    alone : whether nothing follows, as on a terminal.
    readings : of gauges, as of `assess`.
    """
    entries = assess(analysis, readings)
    first = verdict(entries)
    yield from verdict_blocks(analysis, readings)
    if alone:
        yield Text(what_it_is(analysis))
    is_of_gauge = first is not None and first.output.startswith(GAUGES)
    rest = [entry for entry in entries if entry is not first and not entry.is_kept_contact]
    if is_of_gauge:  # `respond` has the others
        rest = [item for item in rest if not item.output.startswith(GAUGES)]
    large = [item for item in rest if item.is_large]
    if largest := large[:MOST_LARGE] or rest[:MOST_SMALL]:
        lines = tuple(sentence(item, analysis.machine.crank_turns) for item in largest)
        small = NEXT_TO_ONE if first is not None and first.is_large else NEXT_TO_NONE
        yield Facts(say(ELSE_LARGE if large else small), lines)
    if alone and (notes := analysis.notes):
        yield Notes(notes[:MOST_NOTES])
    if alone:
        yield look_at_next(*_next(analysis, first))


def look_at_next(*commands: str) -> Text:
    """Commands that show more, in a line."""
    return Text(say("Look at next: {commands}.", commands="; ".join(commands)))


def verdict_blocks(
    analysis: Analysis, readings: Mapping[str, GaugeReading] | None = None
) -> Iterator[Text]:
    """The figure by which the machine is judged first, and up to which speed followers stay on
    their cams; nothing where there is neither.

    readings : of gauges, as of `assess`.
    """
    entries = assess(analysis, readings)
    first, figure_assessment = verdict(entries), kept_contact(entries)
    words = [*filter(None, [rotor_sentence(analysis.machine)])]
    if first is not None and first is not figure_assessment:
        words.append(say("{sentence}.", sentence=sentence(first, analysis.machine.crank_turns)))
    if figure_assessment is not None:
        words.append(contact_sentence(figure_assessment))
    if words:
        is_broken = first is not None and first.is_broken
        yield Text(" ".join(words), broken_if(is_broken))


def what_it_is(analysis: Analysis) -> str:
    """How many links move, their mass where it is known, and how they are driven."""
    machine = analysis.machine
    values = {
        "links": moving_links(len(machine.links)),
        "driven": driven(machine, analysis.motion.speed),
        "mass": "" if massless(machine) else format_quantity(machine.mass, "mass", "kg", digits=3),
    }
    without = to_say("{links}; {driven}")
    with_mass = to_say("{links} of {mass} together; {driven}")
    several = to_say("{rows} rows, in each {links} of {mass} together; {driven}")
    if massless(machine):
        return say(without, **values)
    if len(machine.rows) > 1:
        return say(several, rows=len(machine.rows), **values)
    return say(with_mass, **values)


def _next(analysis: Analysis, first: FigureAssessment | None) -> Iterator[str]:
    """Commands that show more of what is large, and what to do about it."""
    machine = analysis.machine
    if output := _output_of(analysis, first):
        yield f"analyze --output {shlex.quote(output) if ' ' in output else output}"
    if machine.planting is not None:
        yield "plant"
    if machine.support is not None and not massless(machine):
        yield "respond"
    if not massless(machine):
        yield "balance"


def _output_of(analysis: Analysis, first: FigureAssessment | None) -> str:
    """The output to look at: that of the verdict, of a contact its force."""
    if first is None:
        return ""
    names = (first.output, f"{first.output}.normal")
    return next((name for name in names[first.is_contact :] if name in analysis.outputs), "")
