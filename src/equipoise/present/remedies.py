"""The summary of what balancing brings, in plain words, and where it brings nothing."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.told import capital, nothing_told, proof_told, worse_told
from equipoise.balancing.workshop import sentences
from equipoise.i18n import say
from equipoise.present.findings import Findings
from equipoise.quantities import brief, change, percent
from equipoise.results.outputs import objective_named, scaled

LARGE = 0.5
"""Added mass over that of all links from which it is told."""


def helps_told(found: Findings) -> Iterator[str]:
    """What to change, what that brings, and what it costs."""
    balanced = found.balanced
    if balanced is None:
        return
    if not found.helped:
        yield from nothing_told(balanced)
        return
    for made in balanced.changes:
        first, *pieces = sentences(made)
        yield say("{sentence}.", sentence="; ".join([first, *pieces]) if balanced.tried else first)
    yield from _heavy(balanced)
    for one, (before, after) in balanced.aims.items():
        scale, unit = scaled(unit_of(one, balanced.original))
        yield say(
            "{what}: {before} → {after} {unit} ({change}).",
            what=capital(objective_named(one, len(found.machine.rows))),
            before=brief(before * scale),
            after=brief(after * scale, before * scale),
            unit=unit,
            change=change(before, after) or percent(0),
        )
    yield from worse_told(balanced)
    yield proof_told(balanced)
    if balanced.planting_kept:
        yield say("The planting figures stay as they are.")


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
            "That is a large mass for this linkage: all its links together have {links} kg, and "
            "{added} kg are added.",
            links=brief(links),
            added=brief(added),
        )
