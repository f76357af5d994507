"""The command `plant`."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from equipoise.cli.app import FILE, SIGNED, app
from equipoise.cli.options import (
    check_belonging,
    check_folder,
    check_new,
    check_target,
    naming,
    quantity,
)
from equipoise.cli.results import Kind, draw, write_csv
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine
    from equipoise.planting.search import Fit
    from equipoise.planting.summary import PlantingFigures


@app.command
def plant(
    file: Annotated[str, FILE],
    /,
    *,
    speed: Annotated[str | None, SIGNED] = None,
    units: str = "",
    crank_zero: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    csv: str | None = None,
    angles: Annotated[str | None, SIGNED] = None,
    plot: str | None = None,
    format: Kind | None = None,
    fit: str | None = None,
    out: str | None = None,
    seed: Annotated[int | None, SIGNED] = None,
) -> None:
    """The path of a planting finger relative to machine and ground, and every figure of it.

    Parameters
    ----------
    file
        Path of a model file with a table [planting], or the name of a bundled example.
    speed
        Speed of the crank instead of the file's, such as "300 rpm".
    units
        Units of the printed tables where they are not to be cm, m/s and m/s^2: "mm, km/h, gn".
    crank_zero
        Direction from which printed crank angles count, such as "90 deg"; else the x axis.
    json
        Print one JSON object in SI units, and nothing else.
    csv
        Write tip and centre of mass relative to machine and ground to this file.
    angles
        With --csv: number of crank angles a turn, 360 if not given.
    plot
        Draw path, velocities, accelerations and ratios into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    fit
        Look for the geometry that meets the targets and limits in this TOML file.
    out
        With --fit: write the new model file here; else beside you, called FILE-fit.toml.
    seed
        With --fit: seed of the random numbers instead of the target file's.
    """
    from equipoise.planting.summary import plant as read_off
    from equipoise.schema.models import load_linkage
    from equipoise.terminal.units import Units

    check_belonging("--csv", csv, angles=angles)
    check_belonging("--plot", plot, format=format)
    check_belonging("--fit", fit, out=out, seed=seed)
    if fit is not None and crank_zero is not None:
        raise UsageError("--crank-zero has no place in what --fit prints; leave it out")
    if seed is not None and seed < 0:
        raise UsageError(f"--seed: got {seed}; give 0 or more")
    machine = load_linkage(file)
    shown_in = Units.read(units)
    zero = 0.0 if crank_zero is None else quantity("--crank-zero", crank_zero, "angle")
    if speed is not None:
        machine = machine.with_drive(speed=quantity("--speed", speed, "angular speed"))
    new = None if fit is None else _new_file(machine, file, out)
    if csv is not None:
        check_target("--csv", csv, file, machine, [name for name in (fit, new) if name])
    if plot is not None:
        check_folder("--plot", plot)
    rows = _count(angles)
    fitted = None if fit is None or new is None else _fit(machine, file, fit, new, seed)
    with naming(file):
        figures = read_off(machine) if fitted is None else fitted.after
        if csv is not None:
            _write_csv(figures, csv, rows)
    if plot is not None:
        _draw(figures, plot, format or "svg")
    if json:
        from equipoise.schema.output import json_text

        print(json_text((figures if fitted is None else fitted).to_dict()))
    elif fitted is not None:
        from equipoise.terminal.fit import print_fit

        print_fit(fitted, shown_in)
    else:
        from equipoise.terminal.planting import print_planting

        print_planting(figures, shown_in, zero)


def _write_csv(figures: PlantingFigures, path: str, angles: int) -> None:
    from equipoise.planting.summary import table

    write_csv(table(figures, angles), path)


def _draw(figures: PlantingFigures, folder: str, kind: Kind) -> None:
    from equipoise.plotting.planting import drawings

    draw(drawings(figures), folder, kind)


def _count(angles: str | None) -> int:
    if angles is None:
        return 360
    if not re.fullmatch("[+-]?[0-9]{1,9}", angles):
        raise UsageError(f"--angles: got {angles!r}; give a whole number, such as 360")
    return int(angles)


def _new_file(machine: Machine, file: str, out: str | None) -> str:
    """Where the design that is found will be written; told before the search, not after it."""
    new = out if out is not None else f"{Path(file).stem}-fit.toml"
    check_new(machine, new)
    return new


def _fit(machine: Machine, file: str, targets: str, new: str, seed: int | None) -> Fit:
    """Search, and write the design that was found as a new model file."""
    from equipoise.cli.progress import told
    from equipoise.planting.goals import figure_names
    from equipoise.planting.search import fit_planting
    from equipoise.schema.files import printable
    from equipoise.schema.models import files_of, save
    from equipoise.schema.targets import read_targets

    with naming(file):
        known = figure_names(machine)
    given = read_targets(targets, known)
    with naming(file), told() as progress:
        try:
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
        except UsageError as error:
            raise UsageError(f"{printable(targets)}: {error}") from error
    save(_told_of(fitted, targets), new)
    written = " and ".join(map(printable, files_of(machine, new)))
    print(f"wrote {written}", file=sys.stderr)
    return fitted


def _told_of(fitted: Fit, targets: str) -> Machine:
    """The machine that was found, with where it comes from in title and description."""
    origin = f"Geometry found by equipoise plant --fit {Path(targets).name}, seed {fitted.seed}."
    machine = fitted.machine
    description = f"{origin} Started from: {machine.description}".removesuffix("Started from: ")
    return replace(machine, title=f"{machine.title}, fitted", description=description.strip())
