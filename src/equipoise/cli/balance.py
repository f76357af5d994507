"""The command `balance`, and what else is asked of it, each question by a command of its own."""

from __future__ import annotations

from contextlib import nullcontext
from functools import partial
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from equipoise.cli.models import linkage_of
from equipoise.cli.options import (
    CrankZero,
    File,
    Goals,
    Limits,
    Out,
    Speed,
    blaming,
    count,
    naming,
    size,
)
from equipoise.cli.outputs import Length, Outputs, Printed, check_new, sources_of, write_model
from equipoise.cli.plan import Freed, plan_of, read_objective
from equipoise.cli.progress import counted
from equipoise.errors import UsageError
from equipoise.i18n import Note, say

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced

app = App(name="balance")
MOST_POINTS, MOST_ROWS = 500, 64


@app.default
def balance(
    file: Annotated[str, Parameter(name="FILE")],
    /,
    *,
    objective: Goals = None,
    limit: Limits = None,
    speed: Speed = None,
    freed: Freed = Freed(),
    out: Out = None,
    length: Length = Length(),
    outputs: Outputs = Outputs(),
) -> None:
    """What to change so that the machine shakes less, with proof that nothing better exists.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.  Its table [balance] says what may
        change and what is to become small; the options below take the place of it.  Without either,
        remedies that can be built are tried.
    objective
        What is to become small: "shaking_force.y", "peak shaking_moment about D".  May be repeated.
    limit
        What must be kept: "peak joints.B <= 120 N", "rms drive_torque <= 90 %",
        "added_mass <= 500 g".  May be repeated.
    out
        Write the balanced machine as a new model file.
    """
    from equipoise.balancing import advice, optimisation

    machine = linkage_of(file, speed)
    outputs.check(sources_of(machine, file), [out])
    if out is not None:
        check_new(machine, out)
    with naming(file):
        plan = plan_of(machine, freed, objective, limit)
        with counted("step") as progress:
            solve = partial(optimisation.balance, progress=progress)
            asked = freed.any or objective or limit
            found = solve(machine, plan) if asked else advice.advise(machine, solve)
        if out is not None and not found.helps:
            _refuse(found)
        outputs.write(found.columns)
        outputs.draw_result(found)
        if out is not None:  # after tables and pictures, which may fail
            _save(found, out)
        length.show(found, outputs)


def _refuse(found: Balanced) -> None:
    """Write no machine that is not better."""
    from equipoise.balancing.outcome import nothing_told

    if found.advice is not None:
        told = next(nothing_told(found)).removesuffix(".")
        raise UsageError(f"--out: nothing is written: {told[:1].lower()}{told[1:]}")


def _save(found: Balanced, out: str) -> None:
    """Write the new machine, with what was changed in its description."""
    from equipoise.balancing.workshop import sentences

    def origin() -> str:
        lines = (line for change in found.changes for line in sentences(change))
        changes = " ".join(say("{sentence}.", sentence=line) for line in lines)
        return say("Changed by equipoise balance: {changes}", changes=changes)

    write_model(found.machine, out, Note(", balanced"), origin)


@app.command
def trade_off(
    file: Annotated[str, Parameter(name="FILE")],
    first: Annotated[str, Parameter(name="FIRST")],
    second: Annotated[str, Parameter(name="SECOND")],
    /,
    *,
    points: Annotated[int, count(2, MOST_POINTS)] = 21,
    limit: Limits = None,
    speed: Speed = None,
    freed: Freed = Freed(),
    outputs: Outputs = Outputs(),
) -> None:
    """The best that can be had of two objectives at once: their Pareto front, point by point.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.  Its table [balance] says what may
        change; the options below take the place of it.
    first
        What is to become small: "shaking_force.y", "peak shaking_moment about D".
    second
        What is to become small besides.
    points
        Number of points.
    limit
        What must be kept: "peak joints.B <= 120 N".  May be repeated.
    """
    from equipoise.balancing import pareto

    machine = linkage_of(file, speed)
    outputs.check(sources_of(machine, file))
    with naming(file):
        plan = plan_of(machine, freed, None, limit)
        one, other = read_objective("FIRST", first), read_objective("SECOND", second)
        with counted("point") as progress:
            found = pareto.trade_off(machine, one, other, plan, points, progress)
        outputs.give(found)


@app.command
def conditions(file: File, /, *, speed: Speed = None, outputs: Printed = Printed()) -> None:
    """When the shaking force is zero or a pure sine, and whether mass can make it so."""
    from equipoise.balancing import linear_conditions as balancing
    from equipoise.balancing.linear_conditions import conditions_blocks
    from equipoise.balancing.physical_consistency import feasibility

    machine = linkage_of(file, speed)
    # conditions are told in words when they are found; those of the JSON object are in SI units
    shown = nullcontext() if outputs.json else outputs.showing(machine)
    with naming(file), shown:
        found = {kind: balancing.conditions(machine, kind) for kind in ("zero", "sine")}
        values = {kind: one.to_dict() for kind, one in found.items()}
        told = feasibility(machine)
        outputs.print(
            machine,
            lambda: values | {"verdict": told.to_dict()},
            lambda: conditions_blocks(
                *found.values(), verdict=[one.reason for one in told.answers]
            ),
        )


@app.command
def sensitivities(
    file: File,
    output: Annotated[str, Parameter(name="OUTPUT")],
    /,
    *,
    crank_zero: CrankZero = None,
    speed: Speed = None,
    outputs: Printed = Printed(),
) -> None:
    """What each link's mass, centre of mass and inertia does to an output.

    Parameters
    ----------
    output
        Such as shaking_force.y.
    """
    from equipoise.balancing import sensitivity
    from equipoise.vibration.forced import check_moving

    machine = linkage_of(file, speed)
    with naming(file):
        check_moving(machine)
        with blaming("OUTPUT"):
            found = sensitivity.sensitivities(machine, output)
    outputs.show(found, zero=crank_zero or 0.0)


@app.command
def arrangements(
    file: File,
    rows: Annotated[int, count(2, MOST_ROWS, "ROWS")],
    /,
    *,
    spacing: Annotated[
        float, size("length", "give a length of more than 0"), Parameter(show_default=False)
    ] = 0.3,
    speed: Speed = None,
    outputs: Printed = Printed(),
) -> None:
    """Named arrangements of so many rows in fixed phases, and what each leaves of the forces.

    Parameters
    ----------
    rows
        How many linkages stand side by side.
    spacing
        From row to row, 300 mm if not given.
    """
    from equipoise.balancing.patterns import pattern_blocks, patterns_for
    from equipoise.vibration.forced import check_moving

    machine = linkage_of(file, speed)
    with naming(file):
        check_moving(machine)
        outputs.print(
            machine,
            lambda: {"patterns": [one.to_dict() for one in patterns_for(rows)]},
            lambda: pattern_blocks(machine, rows, spacing),
        )
