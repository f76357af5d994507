"""The command `balance`, and what else is asked of it, each question by a command of its own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from equipoise.cli.models import LinkageFile, PlannedFile, at_speed
from equipoise.cli.options import (
    CrankZero,
    LimitList,
    NewFile,
    Out,
    OutputList,
    Speed,
    count,
    error_in_option,
    size,
)
from equipoise.cli.outputs import Length, Outputs, Printed, check_new, write_model, wrote
from equipoise.cli.plan import Freed, plan_of, read_objective
from equipoise.cli.progress import counted
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, localized, say

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.exchange.formats import Job
    from equipoise.results.result import Result

app = App(name="balance")
MOST_POINTS, MOST_ROWS = 500, 64


@app.default
@command(Length, Outputs, long=True)
def balance(
    machine: PlannedFile,
    /,
    *,
    objective: OutputList = None,
    limit: LimitList = None,
    speed: Speed = None,
    freed: Freed = Freed(),
    out: Out = None,
    drawing: NewFile = None,
) -> CommandResult:
    """Optimal changes of a machine to reduce its shaking, with a proof of optimality.

    Parameters
    ----------
    machine
        Path of a model file, or the name of a bundled example.  Its table [balance] has the
        permitted changes and the objectives; the options below replace them.  Without permitted
        changes, remedies that can be built are tried.
    objective
        Objective: "shaking_force.y", "peak shaking_moment about D".  May be repeated.
    limit
        Limit on another output: "peak joints.B <= 120 N", "rms drive_torque <= 90 %",
        "added_mass <= 500 g".  May be repeated.
    out
        Write the balanced machine as a new model file.
    drawing
        Write a workshop drawing of each counterweight: name of a .pdf or .dxf file, or of an .svg
        file, which has outlines and holes without dimensions.
    """
    from equipoise.balancing import advice, optimisation

    machine = at_speed(machine, speed)
    if out is not None:
        check_new(machine, out)
    if drawing is not None:
        _check_drawing(drawing)
    plan = plan_of(machine, freed, objective, limit)
    with counted("step") as progress:
        solve = partial(optimisation.balance, progress=progress)
        if freed.any or objective or limit:
            machine = machine.with_balance(plan)
        frees = freed.any or ((objective or limit) and not plan.changes_nothing)
        stated = frees and plan.objectives  # else the advice finds which figure is large
        balanced = solve(machine, plan) if stated else advice.advise(machine, solve)
    for option, path in {"--out": out, "--drawing": drawing}.items():
        if path is not None and not balanced.helps:
            _refuse(balanced, option)
    sheets = None if drawing is None else _drawing_content(balanced, drawing)

    def save() -> Iterator[str]:
        if out is not None:
            yield from _save(balanced, out)
        if drawing is not None and sheets is not None:
            yield from _save_drawing(drawing, *sheets)

    headline = partial(balanced.headline, out=out)
    return replace(CommandResult.of(balanced), headline=headline, save=save)


def _refuse(balanced: Balanced, option: str) -> None:
    """Write no machine that is not better."""
    from equipoise.balancing.outcome import no_benefit_sentences

    if balanced.advice is not None:
        reason = next(no_benefit_sentences(balanced)).removesuffix(".")
        raise UsageError(
            at_place(
                option,
                Note("nothing is written: {reason}", reason=f"{reason[:1].lower()}{reason[1:]}"),
            )
        )


DRAWINGS = ("pdf", "dxf", "svg")
"""Formats that show parts to be cut."""


def _check_drawing(path: str) -> None:
    from equipoise.exchange.export import format_of

    with error_in_option("--drawing"):
        if format_of(path).name not in DRAWINGS:
            what = Note("got {path!r}; give a name that ends in .pdf, .dxf or .svg", path=path)
            raise UsageError(what)


def _drawing_content(balanced: Balanced, path: str) -> tuple[Job, str | bytes]:
    """A drawing's content, before anything is written, since there may be nothing to draw."""
    from equipoise.exchange.export import export_content, format_of

    with error_in_option("--drawing"):
        return export_content(balanced, format_of(path))


def _save_drawing(path: str, job: Job, data: str | bytes) -> Iterator[str]:
    from equipoise.schema.files import write

    write(path, data)
    yield from job.notes("drawing")
    yield wrote(path)


def _save(balanced: Balanced, out: str) -> list[str]:
    """Write the new machine, with what was changed in its description."""
    from equipoise.balancing.workshop import sentences

    def origin() -> str:
        lines = (line for change in balanced.changes for line in sentences(change))
        changes = " ".join(say("{sentence}.", sentence=line) for line in lines)
        return say("Changed by equipoise balance: {changes}", changes=changes)

    return write_model(balanced.machine, out, Note(", balanced"), origin)


@app.command
@command(Outputs, long=True)
def trade_off(
    machine: PlannedFile,
    first: Annotated[str, Parameter(name="FIRST")],
    second: Annotated[str, Parameter(name="SECOND")],
    /,
    *,
    points: Annotated[int, count(2, MOST_POINTS)] = 21,
    limit: LimitList = None,
    speed: Speed = None,
    freed: Freed = Freed(),
) -> Result:
    """Pareto front of two objectives, point by point.

    Parameters
    ----------
    machine
        Path of a model file, or the name of a bundled example.  Its table [balance] has the
        permitted changes; the options below replace them.
    first
        Objective: "shaking_force.y", "peak shaking_moment about D".
    second
        Second objective.
    points
        Number of points.
    limit
        Limit on another output: "peak joints.B <= 120 N".  May be repeated.
    """
    from equipoise.balancing import pareto

    machine = at_speed(machine, speed)
    plan = plan_of(machine, freed, None, limit)
    objectives = read_objective("FIRST", first), read_objective("SECOND", second)
    with counted("point") as progress:
        return pareto.trade_off(machine, *objectives, plan, points, progress)


@app.command
@command(Printed, long=True)
def conditions(machine: LinkageFile, /, *, speed: Speed = None) -> CommandResult:
    """Conditions for a shaking force of zero or a pure sine, and whether masses can meet them."""
    from equipoise.balancing import linear_conditions as balancing
    from equipoise.balancing.physical_consistency import feasibility

    driven = at_speed(machine, speed)
    by_name = {kind: balancing.conditions(driven, kind) for kind in balancing.KINDS}
    able = feasibility(driven)
    return CommandResult(
        lambda: balancing.conditions_blocks(
            *by_name.values(), verdict=[localized(answer.reason) for answer in able.answers]
        ),
        lambda: {
            **{kind: item.to_dict() for kind, item in by_name.items()},
            "verdict": able.to_dict(),
        },
    )


@app.command
@command(Printed, long=True)
def sensitivities(
    machine: LinkageFile,
    output: Annotated[str, Parameter(name="OUTPUT")],
    /,
    *,
    crank_zero: CrankZero = None,
    speed: Speed = None,
) -> CommandResult:
    """Sensitivity of an output to mass, centre of mass and inertia of each link.

    Parameters
    ----------
    output
        Such as shaking_force.y.
    """
    from equipoise.balancing import sensitivity
    from equipoise.vibration.forced import check_moving

    machine = at_speed(machine, speed)
    check_moving(machine)
    with error_in_option("OUTPUT"):
        result = sensitivity.sensitivities(machine, output)
    return CommandResult.of(result, zero=crank_zero or 0.0)


@app.command
@command(Printed, long=True)
def arrangements(
    machine: LinkageFile,
    rows: Annotated[int, count(2, MOST_ROWS, "ROWS")],
    /,
    *,
    spacing: Annotated[
        float, size("length", "give a length of more than 0"), Parameter(show_default=False)
    ] = 0.3,
    speed: Speed = None,
) -> CommandResult:
    """Named arrangements of rows in fixed phases, and the remaining forces of each.

    Parameters
    ----------
    rows
        Number of linkages side by side.
    spacing
        Distance from row to row.  Default: 300 mm.
    """
    from equipoise.balancing.patterns import pattern_blocks, patterns_for
    from equipoise.vibration.forced import check_moving

    driven = at_speed(machine, speed)
    check_moving(driven)
    return CommandResult(
        lambda: pattern_blocks(driven, rows, spacing),
        lambda: {"patterns": [pattern.to_dict() for pattern in patterns_for(rows)]},
    )
