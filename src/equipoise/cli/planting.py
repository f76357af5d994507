"""The commands `plant` and `plant fit`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from equipoise.cli.options import (
    CrankZero,
    Out,
    PlantingFile,
    ShownIn,
    Speed,
    blaming,
    check_belonging,
    count,
    linkage_of,
    naming,
)
from equipoise.cli.outputs import Outputs, check_new, sources_of, write_model
from equipoise.cli.progress import generations
from equipoise.errors import UsageError

app = App(name="plant")
MOST = 999_999_999


@app.default
def plant(
    file: PlantingFile,
    /,
    *,
    speed: Speed = None,
    crank_zero: CrankZero = None,
    angles: Annotated[int | None, count(0, MOST)] = None,
    units: ShownIn = None,
    outputs: Outputs = Outputs(),
) -> None:
    """The path of a planting finger relative to machine and ground, and every figure of it.

    Parameters
    ----------
    angles
        With --csv: number of crank angles a turn, 360 if not given.
    """
    from equipoise.planting.summary import plant as read_off
    from equipoise.planting.summary import table

    check_belonging("--csv", outputs.csv is not None, angles=angles)
    machine = linkage_of(file)
    outputs.check(sources_of(machine, file))
    with naming(file):
        figures = read_off(machine if speed is None else machine.with_drive(speed=speed))
        outputs.write(lambda: table(figures, 360 if angles is None else angles))
    outputs.draw_result(figures)
    outputs.show(figures, units, zero=crank_zero or 0.0)


@app.command
def fit(
    file: PlantingFile,
    targets: Annotated[str, Parameter(name="TARGETS")],
    /,
    *,
    out: Out = None,
    seed: int | None = None,
    speed: Speed = None,
    units: ShownIn = None,
    outputs: Outputs = Outputs(),
) -> None:
    """Look for the geometry that meets targets and limits, and write it as a new model file.

    Parameters
    ----------
    targets
        A TOML file with what is wanted, and what may change.
    out
        The new model file; FILE-fit.toml beside you if not given.
    seed
        Of the random numbers, instead of the target file's.
    """
    from equipoise.planting.goals import figure_names
    from equipoise.planting.search import fit_planting
    from equipoise.planting.summary import table
    from equipoise.schema.files import printable
    from equipoise.schema.targets import read_targets

    if seed is not None and seed < 0:
        raise UsageError(f"--seed: got {seed}; give 0 or more")
    machine = linkage_of(file)
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
            given.search.crank,
            seed=given.search.seed if seed is None else seed,
            generations=given.search.generations,
            population=given.search.population,
            progress=progress,
        )
    origin = f"Geometry found by equipoise plant fit {Path(targets).name}, seed {fitted.seed}."
    write_model(fitted.machine, new, ", fitted", origin)
    outputs.write(lambda: table(fitted.after))
    outputs.draw_result(fitted.after)
    outputs.show(fitted, units)
