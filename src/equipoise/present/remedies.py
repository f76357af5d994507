"""The summary of what balancing brings, in plain words, and where it brings nothing."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.workshop import sentences
from equipoise.i18n import say
from equipoise.mechanism.balance import Objective
from equipoise.present.findings import Findings
from equipoise.quantities import change, percent, told
from equipoise.results.outputs import objective_named, output_named, shown_in, unit_of_measure

WORSE, MOST_WORSE = 0.1, 3
NOTHING, ROUNDING = 1e-9, 1e-12
LARGE = 0.5
"""Added mass over that of all links from which it is told."""


def helps_told(found: Findings) -> Iterator[str]:
    """What to change, what that brings, and what it costs."""
    balanced = found.balanced
    if balanced is None:
        return
    if not found.helped:
        yield from nothing_told(found)
        return
    for made in balanced.changes:
        yield say("{sentence}.", sentence=next(sentences(made)))
    yield from _heavy(balanced)
    for one in balanced.plan.objectives:
        before, after = balanced.objectives[one.name]
        unit = shown_in(balanced.units[one.name], [before])
        yield say(
            "{what}: {before} → {after} {unit} ({change}).",
            what=_named(found, one),
            before=unit.text(before, digits=3),
            after=unit.text(after, before, 3),
            unit=unit.name,
            change=change(before, after) or percent(0),
        )
    if balanced.proved:
        yield say("Of all that may be changed here nothing is better; that is proved.")
    if worse := _worse(found, balanced):
        yield say("In exchange these become larger: {figures}.", figures=say(", ").join(worse))
    if balanced.planting_kept:
        yield say("The planting figures stay as they are.")


def good_already(found: Findings) -> str:
    """What a machine is where balancing brings nothing, as a part of a sentence."""
    if found.own_plan:
        return say("already as small as what may be changed can make it")
    if len(found.machine.rows) > 1:
        return say("already as small as other phases of the rows can make it")
    return say("already as small as a counterweight on the crank can make it")


def nothing_told(found: Findings) -> Iterator[str]:
    """That balancing brings nothing; objectives, how small they are, and whether it is proved."""
    balanced = found.balanced
    assert balanced is not None
    for one in balanced.plan.objectives:
        value = balanced.objectives[one.name][0]
        unit = shown_in(balanced.units[one.name], [value])
        yield say(
            "{what}, {value} {unit}, is {already}.",
            what=_named(found, one),
            value=unit.text(value, digits=3),
            unit=unit.name,
            already=good_already(found),
        )
    if balanced.proved:
        yield say("Less than 1 % could be gained; that is proved.")


def _named(found: Findings, one: Objective) -> str:
    return capital(objective_named(one, len(found.machine.rows)))


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


def _worse(found: Findings, balanced: Balanced) -> list[str]:
    """Peaks of outputs that grow by more than a tenth, the most first, and those from nothing."""
    least = ROUNDING * max(balanced.before.values(), default=0.0)
    grown = {
        name.removesuffix(".peak"): balanced.after.get(name, 0.0) / old - 1
        for name, old in balanced.before.items()
        if old > least and name.endswith(".peak") and name.startswith(("joints", "drive", "shak"))
    }
    worst = sorted((name for name in grown if grown[name] > WORSE), key=lambda name: -grown[name])
    rows = len(found.machine.rows)
    worse = [
        say("{what} by {share} %", what=output_named(name, rows), share=percent(grown[name]))
        for name in worst[:MOST_WORSE]
    ]
    # of all rows together, those that were nothing before, as moments of rows in phase are
    for name, after in balanced.after.items():
        output = name.removesuffix(".peak")
        of_rows = name.startswith("rows.") and output != name
        if of_rows and balanced.before.get(name, after) < NOTHING * after:
            unit, what = shown_in(unit_of_measure(output, "peak"), [after]), output_named(output)
            words = {"what": what, "size": unit.text(after, digits=3), "unit": unit.name}
            worse.append(say("{what} from 0 to {size} {unit}", **words))
    return worse


def capital(text: str) -> str:
    """A text that begins a sentence."""
    return text[:1].upper() + text[1:]
