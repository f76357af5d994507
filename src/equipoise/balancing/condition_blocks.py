"""What is told of each mass parameter: conditions, added moments, and what it does to an output."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.balancing.blocks import OF_UNIT
from equipoise.i18n import say, to_say
from equipoise.quantities import angle
from equipoise.results.blocks import Block, Cell, Column, Facts, Table, Text, Value
from equipoise.results.outputs import output_named, unit_of_measure

if TYPE_CHECKING:
    from equipoise.balancing.least_norm import Added
    from equipoise.balancing.linear_conditions import Conditions
    from equipoise.balancing.physical_consistency import Feasibility
    from equipoise.balancing.sensitivity import Sensitivities


# -- conditions ------------------------------------------------------------------------------------

WANTED = {"zero": to_say("zero"), "sine": to_say("a pure sine of the crank angle")}
COMBINED = {"kg": "kg", "kg m": "kg mm", "kg m2": "kg mm^2"}
"""SI unit of a combination -> unit in which it is shown."""
TIMES = {"kg": 1.0, "kg m": 1e3, "kg m2": 1e6}
"""SI unit of a combination -> how many of the shown units it is."""


def conditions_blocks(*found: Conditions, verdict: Feasibility | None = None) -> Iterator[Block]:
    """Conditions, one table for each kind, and whether they can be met."""
    yield Text(
        say("moment_x, moment_y: mass times centre of mass; inertia: about the origin of the link")
    )
    for one in found:
        yield _conditions(one)
    if verdict is not None:
        title = say("By the links' own masses, none of them lighter than now")
        yield Facts(title, tuple(str(answer.reason) for answer in verdict.answers))


def _conditions(found: Conditions) -> Block:
    subject = say(" and ").join(map(output_named, found.outputs))
    told = {"what": subject, "wanted": say(WANTED[found.kind])}
    if not found.count:
        return Text(say("Conditions for {what} to be {wanted}: none, it always is.", **told))
    rows = tuple(
        (
            f"{one.text} = 0",
            Value(TIMES[one.unit] * one.factor * float(residual)),
            COMBINED[one.unit],
        )
        for one, residual in zip(found.readings, found.residuals, strict=True)
    )
    title = say("Conditions for {what} to be {wanted}", **told)
    return Table(title, (Column(""), Column(say("now")), Column("")), rows)


def added_blocks(added: Added) -> Iterator[Block]:
    """First moments to be added, and what that makes of the centres of mass."""
    scale = max((abs(part) for pair in added.totals.values() for part in pair), default=0.0)
    rows: list[tuple[Cell, ...]] = []
    for link, moment in added.moments.items():
        center = added.machine.links[link].center_of_mass or (0.0, 0.0)
        size = max(map(abs, center))
        moments = (Value(1e3 * part, 1e3 * scale) for part in (*moment, *added.totals[link]))
        rows.append((link, *moments, *(Value(part, size) for part in center)))
    labels = (say("added x"), say("added y"), say("then x"), say("then y"))
    columns = (Column(""), *(Column(label, unit="kg mm") for label in labels))
    centers = (Column(say("centre x"), "length", "mm"), Column(say("centre y"), "length", "mm"))
    title = say("Least first moments that make the shaking force zero, in each link's axes")
    yield Table(title, (*columns, *centers), tuple(rows))


CHANGES: dict[str, tuple[str, float]] = {
    "mass": ("kg", 1.0),
    "center_x": ("mm", 1e-3),
    "center_y": ("mm", 1e-3),
    "inertia": ("kg mm^2", 1e-6),
}
"""Unit of each change, and what it is in SI units."""


def sensitivities_blocks(found: Sensitivities, zero: float = 0.0) -> Iterator[Block]:
    """What each parameter does to an output, the largest first; crank angles from `zero`, rad."""
    if zero:
        yield Text(say("theta: crank angle from {angle}°", angle=angle(zero)))
    rows: list[tuple[Cell, ...]] = []
    for one in found.ranked:
        unit, size = CHANGES[one.change]
        shifted = np.sort(np.mod(one.no_effect_at - zero, 2 * np.pi * found.turns))
        places = say(", ").join(f"{degrees(at):.1f}" for at in shifted) or say("never")
        rows.append((one.name, Value(size * one.rms), unit, Value(one.percent), places))
    kind = OF_UNIT[unit_of_measure(found.output, "rms")]
    columns = (
        Column(""),
        Column(say("RMS"), kind),
        Column(say("per")),
        Column(say("RMS of 1 %"), kind),
        Column(f"{say('no effect at')}, deg"),
    )
    title = say(
        "{what}: effect of each parameter, at constant crank speed",
        what=output_named(found.output),
    )
    yield Table(title, columns, tuple(rows))
    yield Text(
        say(
            "1 %: of the link's mass or inertia, or its centre of mass moved by 1 % of the "
            "machine's size"
        )
    )
    still = [one.name for one in found.by_name.values() if not one.has_effect]
    if still:
        yield Text(say("No effect at any crank angle: {names}", names=say(", ").join(still)))


SHOWS: dict[str, Any] = {
    "Conditions": conditions_blocks,
    "Added": added_blocks,
    "Sensitivities": sensitivities_blocks,
}
