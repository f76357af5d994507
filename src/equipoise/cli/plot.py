"""The command `plot`."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.app import FILE, MANY, OUT, SIGNED, app
from equipoise.cli.options import (
    check_belonging,
    check_folder,
    ends_of_range,
    naming,
    quantity,
    whole,
)
from equipoise.cli.results import Kind
from equipoise.errors import ModelError, UsageError

if TYPE_CHECKING:
    import numpy as np

    from equipoise.present.pictures import Picture
    from equipoise.studies.design_space import Model

POINTS, MOST_POINTS = 51, 400
"""Values of each number of a map."""
OVER = '"links.crank.mass = 100 g : 500 g"'
SET = '"links.crank.mass = 300 g"'
GIVEN = re.compile(r"(?P<path>[^=]+)=(?P<value>.+)", re.DOTALL)


@app.command
def plot(
    file: Annotated[str, FILE],
    /,
    *,
    out: Annotated[str | None, OUT] = None,
    format: Kind = "svg",
    only: Annotated[list[str] | None, MANY] = None,
    at: Annotated[str | None, SIGNED] = None,
    speed: Annotated[str | None, SIGNED] = None,
    over: Annotated[list[str] | None, MANY] = None,
    of: str | None = None,
    set: Annotated[list[str] | None, MANY] = None,
    points: Annotated[str | None, SIGNED] = None,
) -> None:
    """Every picture of a linkage or a tool: motion, forces, vibration, balance.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    out
        Folder for the pictures; FILE-pictures beside you if not given.
    format
        Kind of the pictures.
    only
        Draw this picture, by its name, and no other.  May be repeated.
    at
        Crank angles at which the linkage is drawn, such as "0 deg, 45 deg".
    speed
        Speed of the crank, or of the tool's engine, instead of the file's, such as "250 rpm".
    over
        Draw a map over this number instead: "links.crank.mass = 100 g : 500 g", or of a
        counterweight "counterweights.crank.radius = 0 mm : 60 mm".  To be given twice.
    of
        With --over: what the map tells, such as "rms shaking_force.y".
    set
        With --over: a number that is set first, "counterweights.crank.mass = 1 kg".  May be
        repeated.
    points
        With --over: values of each number, 51 if not given.
    """
    check_belonging("--over", over, of=of, set=set, points=points)
    folder = _default_folder(file) if out is None else out
    check_folder("--out", folder)
    if over is not None:
        for name, value in (("--only", only), ("--at", at)):
            if value is not None:
                raise UsageError(f"{name} has no use for --over; leave it out")
        _map(file, over, of, set or (), speed, points, folder, format)
        return
    angles = None if at is None else _angles(at)
    rate = None if speed is None else quantity("--speed", speed, "angular speed")
    _pictures(file, only, angles, rate, folder, format)


def _default_folder(file: str) -> str:
    name = os.path.basename(file)
    return f"{name.removesuffix('.toml')}-pictures"


def _angles(text: str) -> list[float]:
    parts = [part.strip() for part in text.split(",")]
    if not 1 <= len(parts) <= 12:
        raise UsageError(f"--at: got {len(parts)} crank angles; give 1 to 12")
    return [quantity("--at", part, "angle") for part in parts]


# -- all pictures ----------------------------------------------------------------------------------


def _pictures(
    file: str,
    only: Sequence[str] | None,
    at: Sequence[float] | None,
    speed: float | None,
    folder: str,
    kind: Kind,
) -> None:
    from equipoise.plotting.style import render
    from equipoise.present.findings import ToolFindings, find
    from equipoise.schema.output import write_all

    found = find(file, speed=speed)
    if at is not None and isinstance(found, ToolFindings):
        raise UsageError("--at: a tool has no crank angles; leave it out")
    with naming(file):
        from equipoise.present.pictures import each

        chosen = _chosen(each(found, at), only)
        for picture in chosen:
            name = f"{picture.name}.{kind}"
            write_all(folder, {name: render(picture.draw(), kind)})
            print(f"{os.path.join(folder, name)}  {picture.caption}")
    for part, why in found.failed.items():
        print(f"{part}: left out, {why}", file=sys.stderr)
    _tell(len(chosen), folder)


def _chosen(pictures: Iterable[Picture], only: Sequence[str] | None) -> list[Picture]:
    """Those that are wanted; what comes after the last of them is not computed."""
    if only is None:
        return list(pictures)
    from equipoise.mechanism.checks import unknown

    found: dict[str, Picture] = {}
    for picture in pictures:
        found[picture.name] = picture
        if found.keys() >= {*only}:
            return [found[name] for name in dict.fromkeys(only)]
    missing = next(name for name in only if name not in found)
    raise UsageError(f"--only: {unknown(missing, found, 'picture')}")


def _tell(count: int, folder: str) -> None:
    pictures = "1 picture" if count == 1 else f"{count} pictures"
    print(f"wrote {pictures} to {folder}", file=sys.stderr)


# -- a map -----------------------------------------------------------------------------------------


def _map(
    file: str,
    over: Sequence[str],
    of: str | None,
    given: Sequence[str],
    speed: str | None,
    points: str | None,
    folder: str,
    kind: Kind,
) -> None:
    from equipoise.cli.progress import counted
    from equipoise.cli.results import draw
    from equipoise.cli.wishes import read_objective
    from equipoise.plotting.landscape import drawings, told
    from equipoise.schema.template import Template
    from equipoise.studies.objective_map import landscape

    if len(over) != 2:
        count = "once" if len(over) == 1 else f"{len(over)} times"
        raise UsageError(f"--over: given {count}; a map is over two numbers, give it twice")
    if of is None:
        raise UsageError('--of: missing; say what the map tells, such as --of "rms shaking_force"')
    each = POINTS if points is None else whole("--points", points, 5, MOST_POINTS)
    objective = read_objective("--of", of)
    model = Template.load(file)
    if model.kind == "tool":
        raise UsageError("--over: a map is of a linkage; use `equipoise tool --vary` for a tool")
    ranges = dict(_range(model, text, each) for text in over)
    if len(ranges) < 2:
        raise UsageError(f"--over: got {next(iter(ranges))} twice; give two numbers")
    numbers = dict(_number(model, text) for text in given)
    if speed is not None:
        numbers["drive.speed"] = quantity("--speed", speed, "angular speed")
    with naming(file), counted("machine") as progress:
        found = landscape(model, ranges, objective, numbers, progress)
    pictures = drawings(found)
    draw(pictures, folder, kind)
    for name in pictures:
        print(os.path.join(folder, f"{name}.{kind}"))
    edge = [f"; {path} is at an end of its range" for path in found.at_edge]
    print(told(found) + "".join(edge))


def _range(model: Model, text: str, count: int) -> tuple[str, np.ndarray[Any, Any]]:
    """A path and its values from a text such as ``links.crank.mass = 100 g : 500 g``."""
    import numpy as np

    path, values = _split("--over", text, OVER)
    ends = ends_of_range(values)
    if len(ends) != 2:
        raise UsageError(f"--over: got {text!r}; give a number and its range, such as {OVER}")
    low, high = (_read(model, "--over", path, end) for end in ends)
    if not low < high:
        raise UsageError(f"--over: got {text!r}; give a range, the smaller value first")
    return path, np.linspace(low, high, count)


def _number(model: Model, text: str) -> tuple[str, float]:
    path, value = _split("--set", text, SET)
    return path, _read(model, "--set", path, value)


def _split(option: str, text: str, example: str) -> tuple[str, str]:
    match = GIVEN.fullmatch(text)
    if match is None:
        raise UsageError(f"{option}: got {text!r}; give such as {example}")
    return match["path"].strip(), match["value"].strip()


def _read(model: Model, option: str, path: str, text: str) -> float:
    """A value of a number of the model, SI units."""
    from equipoise.studies.objective_map import dimension

    try:
        kind = dimension(model, path)
    except ModelError as error:
        raise UsageError(f"{option}: {error.what}") from error
    if kind is not None:
        return quantity(option, text, kind)
    try:
        return float(text)
    except ValueError:
        raise UsageError(f"{option}: got {text!r} for {path}; give a plain number") from None
