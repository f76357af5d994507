"""What balancing comes to, in sentences: what to change and what that brings; and where nobody said
what may be changed, what is large, and why not more.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING

from equipoise.balancing.headlines import STEADY, Advice
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.remedies import LEAST_GAIN
from equipoise.balancing.told import (
    aims_told,
    capital,
    freedoms,
    listed,
    proof_told,
    worse_told,
)
from equipoise.balancing.workshop import sentences
from equipoise.i18n import say, to_say
from equipoise.quantities import change, percent, told
from equipoise.results.blocks import Block, Cell, Change, Column, Table, Text
from equipoise.results.outputs import objective_named, shown_in
from equipoise.results.yardsticks import FigureAssessment, sentence

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced

LARGE = 0.5
"""Added mass over that of all links from which it is told."""


def helps_told(balanced: Balanced) -> Iterator[str]:
    """What is large, what to change, what that brings, and what it costs."""
    if balanced.advice is not None:
        yield from large_sentences(balanced.advice, balanced.original.crank_turns)
    if not balanced.helps:
        yield from nothing_told(balanced)
        return
    for made in balanced.changes:
        first, *pieces = sentences(made)
        yield say("{sentence}.", sentence="; ".join([first, *pieces]) if balanced.advice else first)
    yield from _heavy(balanced)
    for one, (before, after) in balanced.aims.items():
        unit = shown_in(unit_of(one, balanced.original), [before])
        yield say(
            "{what}: {before} → {after} {unit} ({change}).",
            what=capital(objective_named(one, len(balanced.original.rows))),
            before=unit.text(before, digits=3),
            after=unit.text(after, before, 3),
            unit=unit.name,
            change=change(before, after) or percent(0),
        )
    yield from worse_told(balanced)
    yield from proof_told(balanced)
    if balanced.planting_kept:
        yield say("The planting figures stay as they are.")
    yield from flywheel_sentences(balanced)


def _heavy(balanced: Balanced) -> Iterator[str]:
    """That the mass to be added is large, where it is."""
    links = balanced.original.mass
    added = sum(
        float(dict(change.values)["mass"])
        for change in balanced.changes
        if change.kind == "added mass"
    )
    if added > LARGE * links > 0:
        yield say(
            "That is a large mass for this linkage: all its links together have {links}, and "
            "{added} are added.",
            links=told(links, "mass", "kg", digits=3),
            added=told(added, "mass", "kg", digits=3),
        )


def nothing_told(found: Balanced) -> Iterator[str]:
    """That balancing brings nothing; how small the aims are, and what is proved."""
    if found.advice is not None:
        yield from reasons_to_leave(found)
        yield from flywheel_sentences(found)
        return
    for one, (before, _) in found.aims.items():
        unit = shown_in(unit_of(one, found.original), [before])
        yield say(
            "{what}, {value} {unit}, is {already}.",
            what=capital(objective_named(one, len(found.original.rows))),
            value=unit.text(before, digits=3),
            unit=unit.name,
            already=good_already(found),
        )
    yield from proof_told(found)


def good_already(found: Balanced) -> str:
    """What a machine is where balancing brings nothing, as a part of a sentence."""
    if found.advice is not None:
        return say("leave the masses as they are")
    return say("already as small as what may be changed can make it")


# -- where nobody said what may be changed ---------------------------------------------------------

MOST_LARGE = 3
"""Large figures that are named."""


def large_sentences(advice: Advice, crank_turns: bool) -> Iterator[str]:
    """What is large on the machine; where nothing is, how large the largest figure is."""
    large = [one for one in advice.before if one.is_large][:MOST_LARGE]
    for one in large:
        yield say("Large here: {figure}.", figure=sentence(one, crank_turns))
    if not large and advice.before:
        largest = sentence(advice.before[0], crank_turns)
        yield say("Nothing is large beside its yardstick. {figure}.", figure=largest)


def reasons_to_leave(found: Balanced) -> Iterator[str]:
    """Why the masses are best left as they are."""
    advice = found.advice
    assert advice is not None
    if not any(one.is_large and one.is_shaking for one in advice.before):
        yield say(
            "Leave the masses as they are: what shakes the frame is small here, and counterweights "
            "hardly act on anything else."
        )
        return
    if not found.changes:
        yield say(
            "Leave the masses as they are: in the room that there is, no change of a mass about a "
            "pivot of the frame makes {aims} noticeably smaller.",
            aims=aims_told(found),
        )
        return
    yield say(
        "Leave the masses as they are: nothing that can be built in the room that there is takes "
        "away {least} % of {aims}, and as large a share of it as it adds to the mass of the moving "
        "links, without making a headline figure worse.",
        least=percent(LEAST_GAIN, 0),
        aims=aims_told(found),
    )
    yield say(
        "The most, {gain} %, would be taken away by {remedy}; {why}.",
        gain=percent(max(found.gain, 0.0), 1),
        remedy=remedy_named(found),
        why=why_not(found),
    )


def flywheel_sentences(found: Balanced) -> Iterator[str]:
    """A flywheel against the swing of the drive's torque, where one helps."""
    if found.advice is not None and found.advice.flywheel is not None:
        yield say(
            "A flywheel of {inertia} more on {link} would keep its speed within {share} % of the "
            "mean.",
            inertia=told(found.advice.flywheel, "inertia", digits=2),
            link=found.original.drive.link,
            share=percent(STEADY, 0),
        )


def remedy_named(found: Balanced) -> str:
    """What is changed, in a few words."""
    off = [change.link for change in found.changes if change.kind == "removed mass"]
    if off:
        return say("less mass on {link}", link=listed(off))
    return listed(freedoms(found.plan))


def why_not(found: Balanced) -> str:
    """Why a remedy is not offered; empty of one that is."""
    advice = found.advice
    assert advice is not None
    if advice.offered:
        return ""
    if found.gain < LEAST_GAIN:
        return say("that is too little")
    if advice.worse:
        return say("{figures} would grow", figures=listed(map(_grown, advice.worse)))
    return say("{mass} would be added", mass=told(found.added_mass, "mass", digits=3))


def _grown(pair: tuple[FigureAssessment, FigureAssessment]) -> str:
    was, new = pair
    what = was.label.said()
    if not was.value:
        return what
    growth = percent(abs(new.value / was.value) - 1, 0)
    return say("{what}, by {share} %", what=what, share=growth)


# -- what was tried --------------------------------------------------------------------------------


def advice_blocks(found: Balanced) -> Iterator[Block]:
    """What is large, and what was tried against it."""
    advice = found.advice
    assert advice is not None
    yield from map(Text, large_sentences(advice, found.original.crank_turns))
    if not found.helps:
        yield from map(Text, nothing_told(found))
    else:
        yield from map(Text, flywheel_sentences(found))
    for aims, same in groupby(found.tried, key=aims_told):
        rows: tuple[tuple[Cell, ...], ...] = tuple(
            (remedy_named(one), Change(1.0, 1 - one.gain), why_not(one)) for one in same
        )
        columns = (Column(say("remedy")), Column(say("change")), Column(say("why not")))
        yield Table(say("What was tried to make smaller {aims}", aims=aims), columns, rows)
    yield from map(Text, _asking_for_more(found))


def _asking_for_more(found: Balanced) -> Iterator[str]:
    """What is offered, and how to ask for something else."""
    if found.tried:
        yield say(
            "A change is offered that takes away at least {least} % of its aim, and as large a "
            "share of it as it adds to the mass of the moving links, and that makes no headline "
            "figure worse by more than 1 %, and no force in a single joint and no component of the "
            "shaking force by more than 5 %.",
            least=percent(LEAST_GAIN, 0),
        )
    of_one = to_say(
        "The file does not say what may be changed: [balance] in it asks for something else, or "
        "options such as --objective, --counterweight and --move-cm."
    )
    of_rows = to_say(
        "The file does not say what may be changed: [balance] in it asks for something else, or "
        "options such as --objective, --phases, --counterweight and --move-cm."
    )
    yield say(of_rows if len(found.original.rows) > 1 else of_one)
