"""What `equipoise balance` prints of conditions, verdicts, least moments and sensitivities."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from equipoise.results.naming import output_named
from equipoise.results.outputs import unit_of
from equipoise.terminal.tables import Row, angle, number, table

if TYPE_CHECKING:
    from equipoise.balancing.least_norm import Added
    from equipoise.balancing.linear_conditions import Conditions
    from equipoise.balancing.physical_consistency import Feasibility
    from equipoise.balancing.sensitivity import Sensitivities, Sensitivity
    from equipoise.mechanism.model import Machine

KINDS = {"zero": "zero", "sine": "a pure sine of the crank angle"}
SHOWN = {"kg": ("kg", 1.0), "kg m": ("kg mm", 1e3), "kg m2": ("kg mm2", 1e6)}
"""Unit of a combination, and how many of it make the SI unit."""

CHANGES = {
    "mass": ("kg", 1.0),
    "center_x": ("mm", 1e-3),
    "center_y": ("mm", 1e-3),
    "inertia": ("kg mm2", 1e-6),
}
"""Unit of each change, and what it is in SI units."""


def print_conditions(
    machine: Machine, found: Iterable[Conditions], told: Feasibility | None = None
) -> None:
    """Conditions, one table for each kind, and whether they can be met."""
    print(machine.title)
    print("moment_x, moment_y: mass times centre of mass; inertia: about the origin of the link")
    for one in found:
        print(_conditions(one))
    if told is not None:
        print("\nBy the links' own masses, none of them lighter than now:\n")
        for answer in told.answers:
            print(answer.reason)


def _conditions(found: Conditions) -> str:
    subject = " and ".join(output.replace("_", " ") for output in found.outputs)
    verb = "are" if len(found.outputs) > 1 else "is"
    title = f"Conditions for which the {subject} {verb} {KINDS[found.kind]}"
    if not found.count:
        return f"\n{title}: none, it always is"
    rows: list[Row] = []
    for one, residual in zip(found.readings, found.residuals, strict=True):
        unit, scale = SHOWN[one.unit]
        rows.append((f"{one.text} = 0", number(scale * one.factor * float(residual)), unit))
    return table(title, ("", "now", ""), rows)


def print_added(added: Added) -> None:
    """First moments to be added, and what that makes of the centres of mass."""
    scale = max((abs(part) for pair in added.totals.values() for part in pair), default=0.0)
    rows: list[Row] = []
    for link, moment in added.moments.items():
        center = added.machine.links[link].center_of_mass or (0.0, 0.0)
        moments = [number(1e3 * part, 1e3 * scale) for part in (*moment, *added.totals[link])]
        size = max(map(abs, center))
        rows.append((link, *moments, *(number(1e3 * part, 1e3 * size) for part in center)))
    header = ("", "added x", "added y", "then x", "then y", "center x mm", "center y mm")
    title = "Least first moments that make the shaking force zero, kg mm, in each link's axes"
    print(table(title, header, rows))


def print_sensitivities(found: Sensitivities, zero: float = 0.0) -> None:
    """What each parameter does to an output, the largest first; crank angles from `zero`, rad."""
    title, unit = output_named(found.output).capitalize(), unit_of(found.output)
    print(found.machine.title)
    if zero:
        print(f"crank angles from {angle(zero)} deg")
    rows = [_sensitivity(one, zero, found.turns) for one in found.ranked]
    header = ("", f"RMS {unit}", "per", f"1 %: RMS {unit}", "no effect at deg")
    print(table(f"{title}: effect of each parameter, at constant crank speed", header, rows))
    print(
        "\n1 %: of the link's mass or inertia, or its centre of mass moved by 1 % of the machine's "
        "size"
    )
    still = [one.name for one in found.by_name.values() if not one.has_effect]
    if still:
        print(f"no effect at any crank angle: {', '.join(still)}")


def _sensitivity(one: Sensitivity, zero: float, turns: int) -> Row:
    unit, size = CHANGES[one.change]
    shifted = np.sort(np.mod(one.no_effect_at - zero, 2 * np.pi * turns))
    places = ", ".join(f"{degrees(at):.1f}" for at in shifted) or "never"
    return one.name, number(size * one.rms), unit, number(one.percent), places
