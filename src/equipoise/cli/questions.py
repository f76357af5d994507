"""What `balance` tells besides: conditions, effects of parameters, arrangements of rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.cli.options import quantity, whole
from equipoise.cli.results import Wanted
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

MOST_ROWS = 64


def tell_conditions(machine: Machine, wanted: Wanted) -> None:
    """When the shaking force is zero or a pure sine, and whether mass can make it so."""
    from equipoise.balancing.linear_conditions import conditions
    from equipoise.balancing.physical_consistency import feasibility

    found = {kind: conditions(machine, kind) for kind in ("zero", "sine")}
    told = feasibility(machine)

    def show() -> None:
        from equipoise.terminal.conditions import print_conditions

        print_conditions(machine, found.values(), told)

    def values() -> dict[str, object]:
        return {name: one.to_dict() for name, one in found.items()} | {"verdict": told.to_dict()}

    wanted.give(None, dict, values, show)


def tell_sensitivities(
    machine: Machine, output: str, crank_zero: str | None, wanted: Wanted
) -> None:
    """What each link's mass, centre of mass and inertia does to an output."""
    from equipoise.balancing.sensitivity import sensitivities
    from equipoise.vibration.forced import check_moving

    zero = 0.0 if crank_zero is None else quantity("--crank-zero", crank_zero, "angle")
    check_moving(machine)
    try:
        found = sensitivities(machine, output)
    except UsageError as error:
        raise UsageError(f"--sensitivities: {error}") from error

    def show() -> None:
        from equipoise.terminal.conditions import print_sensitivities

        print_sensitivities(found, zero)

    wanted.give(None, dict, found.to_dict, show)


def tell_arrangements(machine: Machine, rows: str, spacing: str | None, wanted: Wanted) -> None:
    """Arrangements of rows in fixed phases, and what is left of the machine's forces."""
    from equipoise.balancing.patterns import patterns_for
    from equipoise.vibration.forced import check_moving

    count = whole("--arrangements", rows, 2, MOST_ROWS)
    apart = quantity("--spacing", "300 mm" if spacing is None else spacing, "length")
    if apart <= 0:
        raise UsageError(f"--spacing: got {spacing!r}; give a length of more than 0")
    check_moving(machine)
    found = patterns_for(count)

    def show() -> None:
        from equipoise.terminal.phases import print_patterns

        print_patterns(machine, count, apart)

    wanted.give(None, dict, lambda: {"patterns": [one.to_dict() for one in found]}, show)
