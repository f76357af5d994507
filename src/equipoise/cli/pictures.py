"""The commands `plot` and `plot map`."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from equipoise.cli.models import ModelFile
from equipoise.cli.options import (
    AnySpeed,
    Computers,
    NameList,
    Speed,
    TextList,
    count,
    ends_of_range,
    error_in_option,
    quantities,
    quantity,
    read_by,
    refuse_idle,
    wants,
)
from equipoise.cli.outputs import Pictures, write_pictures, wrote_pictures
from equipoise.cli.plan import read_objective
from equipoise.cli.progress import counted
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, localized, say
from equipoise.mechanism.checks import unknown

if TYPE_CHECKING:
    import numpy as np

    from equipoise.present.pictures import ReportPicture
    from equipoise.studies.study import Model

app = App(name="plot")
MOST_ANGLES = 12
POINTS, MOST_POINTS = 51, 1000
"""Values of each number of a map."""
RANGE = '"links.crank.mass = 100 g : 500 g"'
NUMBER = '"links.crank.mass = 300 g"'
GIVEN = re.compile(r"(?P<path>[^=]+)=(?P<value>.+)", re.DOTALL)


# -- pictures --------------------------------------------------------------------------------------


def _crank_angles(option: str, text: str) -> list[float]:
    count = text.count(",") + 1
    if count > MOST_ANGLES:
        raise UsageError(
            at_place(
                option,
                Note(
                    "got {count} crank angles; give 1 to {most_angles}",
                    count=count,
                    most_angles=MOST_ANGLES,
                ),
            )
        )
    return quantities(option, text, "angle")


@app.default
@command(Pictures)
def plot(
    file: ModelFile,
    /,
    *,
    only: NameList = None,
    output: NameList = None,
    at: Annotated[Any, read_by(_crank_angles, '"0 deg, 45 deg"')] = None,
    speed: AnySpeed = None,
    pictures: Pictures,
) -> CommandResult:
    """Save plots of a linkage or a tool: motion, forces, vibration, balance.

    Parameters
    ----------
    only
        Save this plot only, by its name.  May be repeated.
    output
        Plot this output over crank angle instead, such as "points.P.vx".  May be repeated.
    at
        Crank angles at which the linkage is drawn.
    """
    from equipoise.figures import render
    from equipoise.present.findings import ToolFindings, find
    from equipoise.present.pictures import each
    from equipoise.schema.files import write_all

    folder, kind = pictures.of(file), pictures.format
    result = find(file, speed=speed, swings=True)
    if isinstance(result, ToolFindings):
        refuse_idle(Note("a tool has no crank angles"), at=at, output=output)
    written = list[str]()
    with pictures.showing(result.owner):
        chosen = _outputs(result, output) if output else _chosen(each(result, at), only)
        for picture in chosen:
            name = f"{picture.name}.{kind}"
            write_all(folder, {name: render(picture.chart, kind)})
            written.append(f"{os.path.join(folder, name)}  {say(picture.chart.caption)}")
    swings = getattr(result, "swings", None)
    notes = [] if swings is None else [say("note: {note}", note=localized(swings))]
    notes += [
        say("{part}: left out, {why}", part=part, why=localized(why))
        for part, why in result.failed.items()
    ]
    return CommandResult(
        lines=lambda: written,
        save=lambda: [*notes, wrote_pictures(len(chosen), folder)],
    )


def _outputs(result: Any, names: Sequence[str]) -> list[ReportPicture]:
    """Outputs over crank angle, in one picture."""
    from equipoise.figures.motion import outputs_chart
    from equipoise.present.pictures import ReportPicture

    with error_in_option("--output"):
        chart = outputs_chart(result.analysis, list(dict.fromkeys(names)))
    return [ReportPicture(chart, "motion")]


def _chosen(pictures: Iterable[ReportPicture], only: Sequence[str] | None) -> list[ReportPicture]:
    """Those that are wanted; what comes after the last of them is not computed."""
    if only is None:
        return list(pictures)
    by_name: dict[str, ReportPicture] = {}
    for picture in pictures:
        by_name[picture.name] = picture
        if by_name.keys() >= {*only}:
            return [by_name[name] for name in dict.fromkeys(only)]
    missing = next(name for name in only if name not in by_name)
    raise UsageError(at_place("--only", unknown(missing, by_name, "picture")))


@app.command(name="map")
@command(Pictures, long=True)
def landscape(
    file: ModelFile,
    first: Annotated[str, Parameter(name="FIRST")],
    second: Annotated[str, Parameter(name="SECOND")],
    output: Annotated[str, Parameter(name="OUTPUT")],
    /,
    *,
    set: Annotated[TextList, wants("NUMBER=VALUE")] = None,
    points: Annotated[int, count(5, MOST_POINTS)] = POINTS,
    speed: Speed = None,
    computers: Computers = Computers(),
    pictures: Pictures,
) -> CommandResult:
    """An output over two numbers of a machine.

    Parameters
    ----------
    first
        A number and its range, "links.crank.mass = 100 g : 500 g", or of a counterweight
        "counterweights.crank.radius = 0 mm : 60 mm".
    second
        Another.
    output
        Output of the map, such as "rms shaking_force.y".
    set
        A number to set first, "counterweights.crank.mass = 1 kg".  May be repeated.
    points
        Values of each number.
    """
    from equipoise.figures.studies import landscape as drawn_map
    from equipoise.figures.studies import optimum_text
    from equipoise.schema.template import Template
    from equipoise.studies import objective_map as studies

    folder = pictures.of(file)
    objective = read_objective("OUTPUT", output)
    model = Template.load(file)
    if model.kind == "tool":
        raise UsageError(Note("a map is of a linkage; use `equipoise tool vary` for a tool"))
    both = [_range(model, *pair, points) for pair in (("FIRST", first), ("SECOND", second))]
    if both[0][0] == both[1][0]:
        raise UsageError(
            at_place("SECOND", Note("got {both} twice; give two numbers", both=both[0][0]))
        )
    numbers = dict(_number(model, text) for text in set or ())
    if speed is not None:
        numbers["drive.speed"] = speed
    with counted("machine") as progress:
        result = studies.landscape(
            model, dict(both), objective, numbers, progress, **vars(computers)
        )
    with pictures.showing(model.base()):
        lines = write_pictures({"landscape": drawn_map(result)}, folder, pictures.format)
        written = os.path.join(folder, f"landscape.{pictures.format}"), optimum_text(result)
    return CommandResult(lines=lambda: written, save=lambda: lines)


def _range(model: Model, option: str, text: str, count: int) -> tuple[str, np.ndarray[Any, Any]]:
    """A path and its values from a text such as ``links.crank.mass = 100 g : 500 g``."""
    import numpy as np

    path, values = _split(option, text, RANGE)
    ends = ends_of_range(values)
    if len(ends) != 2:
        raise UsageError(
            at_place(
                option,
                Note(
                    "got {text!r}; give a number and its range, such as {range}",
                    text=text,
                    range=RANGE,
                ),
            )
        )
    low, high = (_read(model, option, path, end) for end in ends)
    if not low < high:
        raise UsageError(
            at_place(option, Note("got {text!r}; give a range, the smaller value first", text=text))
        )
    return path, np.linspace(low, high, count)


def _number(model: Model, text: str) -> tuple[str, float]:
    path, value = _split("--set", text, NUMBER)
    return path, _read(model, "--set", path, value)


def _split(option: str, text: str, example: str) -> tuple[str, str]:
    match = GIVEN.fullmatch(text)
    if match is None:
        raise UsageError(
            at_place(
                option, Note("got {text!r}; give such as {example}", text=text, example=example)
            )
        )
    return match["path"].strip(), match["value"].strip()


def _read(model: Model, option: str, path: str, text: str) -> float:
    """A value of a number of the model, SI units."""
    from equipoise.studies.objective_map import number_description

    try:
        kind, _ = number_description(model, path)
    except ModelError as error:
        raise UsageError(at_place(option, error.what)) from error
    if kind is not None:
        return quantity(option, text, kind)
    try:
        return float(text)
    except ValueError:
        raise UsageError(
            at_place(
                option, Note("got {text!r} for {path}; give a plain number", text=text, path=path)
            )
        ) from None
