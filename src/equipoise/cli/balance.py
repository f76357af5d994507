"""The command `balance`."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal

from equipoise.cli.app import FILE, MANY, OUT, SIGNED, app
from equipoise.cli.options import check_belonging, check_new, naming, quantity, whole
from equipoise.cli.results import Kind, Wanted
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.pareto import Front
    from equipoise.mechanism.balance import Balance
    from equipoise.mechanism.model import Machine

MOST_POINTS = 500
Shape = Literal["any", "point", "disc", "ring", "sector"]


@app.command
def balance(
    file: Annotated[str, FILE],
    /,
    *,
    objective: Annotated[list[str] | None, MANY] = None,
    limit: Annotated[list[str] | None, MANY] = None,
    move_cm: Annotated[list[str] | None, MANY] = None,
    crank_counterweight: bool = False,
    counterweight: Annotated[list[str] | None, MANY] = None,
    geared_counterweight: str | None = None,
    ratio: Annotated[str | None, SIGNED] = None,
    pitch_radius: Annotated[str | None, SIGNED] = None,
    shape: Shape | None = None,
    radius: Annotated[str | None, SIGNED] = None,
    mass: Annotated[str | None, SIGNED] = None,
    at_most: Annotated[str | None, SIGNED] = None,
    thickness: Annotated[str | None, SIGNED] = None,
    material: str | None = None,
    phases: bool = False,
    speed: Annotated[str | None, SIGNED] = None,
    front: tuple[str, str] | None = None,
    points: Annotated[str | None, SIGNED] = None,
    conditions: bool = False,
    sensitivities: str | None = None,
    crank_zero: Annotated[str | None, SIGNED] = None,
    arrangements: Annotated[str | None, SIGNED] = None,
    spacing: Annotated[str | None, SIGNED] = None,
    out: Annotated[str | None, OUT] = None,
    json: bool = False,
    csv: str | None = None,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """What to change so that the machine shakes less, with proof that nothing better exists.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.  Its table [balance] says what may
        change and what is to become small; the options below take the place of it.
    objective
        What is to become small: "shaking_force.y", "peak shaking_moment about D".  May be repeated.
    limit
        What must be kept: "peak joints.B <= 120 N", "rms drive_torque <= 90 %",
        "added_mass <= 500 g".  May be repeated.
    move_cm
        Free the centre of mass of this link.  May be repeated.
    crank_counterweight
        Free a counterweight on the crank's axis.
    counterweight
        Free a counterweight on this link, about its pin in the frame, or its first point where it
        has none.  May be repeated.
    geared_counterweight
        Free a counterweight on a shaft geared to this link.
    ratio
        With --geared-counterweight: speed of the shaft over the link's, or a range "0.3, 2".
    pitch_radius
        With --geared-counterweight: of the gear on the link.
    shape
        Of counterweights: any distribution of mass, point, disc, ring or sector.
    radius
        Of the room that a counterweight has; the reach of its link if neither this nor a mass is
        given.
    mass
        Of a counterweight, where it is given.
    at_most
        Most mass of a counterweight.
    thickness
        Of the plate that discs, rings and sectors are cut from.
    material
        Of that plate, such as steel.
    phases
        Free the phases of [[rows]].
    speed
        Speed of the crank instead of the file's, such as "250 rpm".
    front
        Draw the trade-off between two objectives instead.
    points
        With --front: number of points, 21 if not given.
    conditions
        Print the conditions under which the shaking force is zero or a pure sine instead.
    sensitivities
        Print what each parameter does to this output instead, such as shaking_force.y.
    crank_zero
        With --sensitivities: direction from which crank angles count, such as "-83 deg"; else the
        x axis.
    arrangements
        Print named arrangements of this many rows, and what each leaves, instead.
    spacing
        With --arrangements: from row to row, 300 mm if not given.
    out
        Write the balanced machine as a new model file.
    json
        Print one JSON object in SI units, and nothing else.
    csv
        Write signals before and after, or the front, to this file.
    plot
        Draw before and after, or the front, into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.cli.questions import tell_arrangements, tell_conditions, tell_sensitivities
    from equipoise.cli.wishes import Freed, plan_of
    from equipoise.schema.models import load_linkage

    check_belonging("--front", front, points=points)
    check_belonging("--sensitivities", sensitivities, crank_zero=crank_zero)
    check_belonging("--arrangements", arrangements, spacing=spacing)
    machine = load_linkage(file)
    if speed is not None:
        machine = machine.with_drive(speed=quantity("--speed", speed, "angular speed"))
    wanted = Wanted(json, csv, plot, format)
    wanted.check(file, machine, [] if out is None else [out])
    if out is not None:
        check_new(machine, out)
    freed = Freed(
        move_cm,
        crank_counterweight,
        counterweight,
        geared_counterweight,
        phases,
        shape,
        radius,
        mass,
        at_most,
        thickness,
        material,
        ratio,
        pitch_radius,
    )
    _check_alone(
        {
            "--front": front,
            "--conditions": conditions or None,
            "--sensitivities": sensitivities,
            "--arrangements": arrangements,
        },
        {"--out": out, "--csv": csv, "--plot": plot, "--objective": objective, "--limit": limit}
        | dict.fromkeys(freed.given, "given"),
    )
    with naming(file):
        if conditions:
            tell_conditions(machine, wanted)
        elif arrangements is not None:
            tell_arrangements(machine, arrangements, spacing, wanted)
        elif sensitivities is not None:
            tell_sensitivities(machine, sensitivities, crank_zero, wanted)
        elif front is not None:
            count = 21 if points is None else whole("--points", points, 2, MOST_POINTS)
            plan = plan_of(machine, freed, None, limit)
            _trade(machine, plan, front, count, wanted)
        else:
            _balance(machine, plan_of(machine, freed, objective, limit), out, wanted)


def _check_alone(questions: Mapping[str, object], others: Mapping[str, object]) -> None:
    """Options that ask another question stand alone; a front is drawn of what is free to change."""
    asked = [name for name, value in questions.items() if value is not None]
    if len(asked) > 1:
        raise UsageError(f"{asked[0]} and {asked[1]} answer different questions; give one of them")
    unused = ("--out", "--objective") if asked == ["--front"] else tuple(others)
    for name in unused:
        if asked and others[name] is not None:
            raise UsageError(f"{asked[0]} has no use for {name}; leave it out")


def _balance(machine: Machine, plan: Balance, out: str | None, wanted: Wanted) -> None:
    from equipoise.balancing.optimisation import balance as solve
    from equipoise.cli.progress import counted

    with counted("program") as progress:
        found = solve(machine, plan, progress)

    def save() -> None:  # after tables and pictures, which may fail
        if out is not None:
            _save(found, out)

    def show() -> None:
        from equipoise.terminal.balance import print_balanced

        save()
        print_balanced(found)

    def values() -> dict[str, object]:
        save()
        return found.to_dict()

    wanted.give(found.columns, lambda: _drawings(found), values, show)


def _drawings(found: Balanced | Front) -> Mapping[str, Figure]:
    from equipoise.plotting.balancing import drawings

    return drawings(found)


def _save(found: Balanced, out: str) -> None:
    """Write the new machine, with what was changed in its description."""
    from equipoise.schema.files import printable
    from equipoise.schema.models import files_of, save
    from equipoise.terminal.changes import told

    machine = found.machine
    changes = " ".join(f"{line.strip()}." for change in found.changes for line in told(change))
    start = f"Changed by equipoise balance: {changes} Started from: "
    text = f"{start}{machine.description}".removesuffix(" Started from: ")
    title = f"{machine.title.removesuffix(', balanced')}, balanced"
    save(replace(machine, title=title, description=text.strip()), out)
    written = " and ".join(map(printable, files_of(machine, out)))
    print(f"wrote {written}", file=sys.stderr)


def _trade(
    machine: Machine, plan: Balance, both: Sequence[str], points: int, wanted: Wanted
) -> None:
    from equipoise.balancing.pareto import trade_off
    from equipoise.cli.progress import counted
    from equipoise.cli.wishes import read_objective

    first, second = (read_objective("--front", text) for text in both)
    with counted("point") as progress:
        found = trade_off(machine, first, second, plan, points, progress)

    def show() -> None:
        from equipoise.terminal.balance import print_front

        print_front(found)

    wanted.give(found.columns, lambda: _drawings(found), found.to_dict, show)
