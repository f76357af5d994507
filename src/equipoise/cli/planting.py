"""The commands `plant` and `plant fit`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from equipoise.cli.options import (
    Angle,
    File,
    Out,
    Speed,
    blaming,
    check_belonging,
    check_new,
    count,
    naming,
    sources_of,
)
from equipoise.cli.outputs import UNITS, Outputs, write_model
from equipoise.cli.progress import generations
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from equipoise.figures import Picture
    from equipoise.planting.summary import PlantingFigures

app = App(name="plant")
MOST = 999_999_999


@app.default
def plant(
    file: File,
    /,
    *,
    speed: Speed = None,
    crank_zero: Angle = None,
    angles: Annotated[int | None, count(0, MOST)] = None,
    units: Annotated[str, UNITS] = "",
    outputs: Outputs = Outputs(),
) -> None:
    """The path of a planting finger relative to machine and ground, and every figure of it.

    Parameters
    ----------
    file
        Path of a model file with a table [planting], or the name of a bundled example.
    speed
        Speed of the crank instead of the file's, such as "300 rpm".
    crank_zero
        Direction from which printed crank angles count, such as "90 deg"; else the x axis.
    angles
        With --csv: number of crank angles a turn, 360 if not given.
    """
    from equipoise.planting.summary import plant as read_off
    from equipoise.planting.summary import table
    from equipoise.present.cells import read_units
    from equipoise.schema.models import load_linkage

    check_belonging("--csv", outputs.csv is not None, angles=angles)
    machine = load_linkage(file)
    shown_in = read_units(units)
    outputs.check(sources_of(machine, file))
    with naming(file):
        figures = read_off(machine if speed is None else machine.with_drive(speed=speed))
        outputs.write(lambda: table(figures, 360 if angles is None else angles))
    outputs.give_result(figures, shown_in, zero=crank_zero or 0.0)


def _drawings(figures: PlantingFigures) -> Mapping[str, Picture]:
    from equipoise.figures.pictures import planting_pictures

    return planting_pictures(figures)


@app.command
def fit(
    file: File,
    targets: Annotated[str, Parameter(name="TARGETS", negative="")],
    /,
    *,
    out: Out = None,
    seed: int | None = None,
    speed: Speed = None,
    units: Annotated[str, UNITS] = "",
    outputs: Outputs = Outputs(),
) -> None:
    """Look for the geometry that meets targets and limits, and write it as a new model file.

    Parameters
    ----------
    file
        Path of a model file with a table [planting], or the name of a bundled example.
    targets
        A TOML file with what is wanted, and what may change.
    out
        The new model file; FILE-fit.toml beside you if not given.
    seed
        Of the random numbers, instead of the target file's.
    speed
        Speed of the crank instead of the file's, such as "300 rpm".
    """
    from equipoise.planting.goals import figure_names
    from equipoise.planting.search import fit_planting
    from equipoise.planting.summary import table
    from equipoise.present.cells import read_units
    from equipoise.schema.files import printable
    from equipoise.schema.models import load_linkage
    from equipoise.schema.targets import read_targets

    if seed is not None and seed < 0:
        raise UsageError(f"--seed: got {seed}; give 0 or more")
    machine = load_linkage(file)
    shown_in = read_units(units)
    new = out if out is not None else f"{Path(file).stem}-fit.toml"
    check_new(machine, new)
    outputs.check(sources_of(machine, file), [targets, new])
    machine = machine if speed is None else machine.with_drive(speed=speed)
    with naming(file):
        known = figure_names(machine)
    given = read_targets(targets, known)
    with naming(file), generations() as progress, blaming(printable(targets)):
        fitted = fit_planting(
            machine,
            given.goals,
            given.vary,
            given.sense,
            seed=given.seed if seed is None else seed,
            generations=given.generations,
            population=given.population,
            progress=progress,
        )
    origin = f"Geometry found by equipoise plant fit {Path(targets).name}, seed {fitted.seed}."
    write_model(fitted.machine, new, ", fitted", origin)
    outputs.write(lambda: table(fitted.after))
    outputs.draw(lambda: _drawings(fitted.after))
    outputs.show(fitted, shown_in)
