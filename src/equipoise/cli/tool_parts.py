"""The answers of `tool`: each as plain values, as tables, as columns and as pictures."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

from equipoise.cli.options import quantity
from equipoise.cli.results import Columns, Kind, draw, write_csv
from equipoise.cli.tool_asked import Asked
from equipoise.errors import ModelError, UsageError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

VARY = re.compile(r"(?P<station>\S.*?)\s+(?P<key>\S+)\s*=\s*(?P<low>[^:]*\S)\s*:\s*(?P<high>.*\S)")
VALUES, BAND = 81, 201
"""Values of a number that is varied; speeds over which sensitivities are told."""


@dataclass(frozen=True)
class Part:
    """One answer; pictures are made when they are asked for."""

    values: Callable[[], Mapping[str, Any]]
    show: Callable[[], None]
    drawings: Callable[[], Mapping[str, Figure]]
    columns: Callable[[], Columns] | None = None


@contextmanager
def _blaming(option: str) -> Iterator[None]:
    """Put the option in front of what turns out wrong with what it asks for."""
    try:
        yield
    except (ModelError, UsageError) as error:
        raise UsageError(f"{option}: {error}") from error


def _pictures() -> ModuleType:
    """The pictures of tools; Matplotlib is imported when the first is drawn, not before."""
    from equipoise.plotting import tool

    return tool


def _of_modes(asked: Asked) -> Part:
    found = asked.modes

    def show() -> None:
        from equipoise.terminal.tool import print_modes

        print_modes(found, asked.units)

    def drawings() -> Mapping[str, Figure]:
        from equipoise.handheld.studies import determinant_chart

        highest = 1.1 * float(found.planes[0].parameter[-1])
        chart = determinant_chart(asked.tool, highest)
        drawn: dict[str, Figure] = _pictures().mode_drawings(found)
        drawn |= _pictures().determinant_drawings(chart, found)
        return drawn

    return Part(found.to_dict, show, drawings)


def _of_speeds(asked: Asked) -> Part:
    from equipoise.handheld.sweep import sweep_tool

    length = asked.tool.shaft.length
    for place in asked.places:
        if not 0 <= place <= length:
            raise UsageError(
                f"--at: got {place:g} m, off the shaft; give places from 0 to {length:g} m"
            )
    found = sweep_tool(asked.tool, asked.range, asked.places)

    def show() -> None:
        from equipoise.terminal.tool import print_sweep

        print_sweep(found, asked.units)

    def drawings() -> Mapping[str, Figure]:
        drawn: dict[str, Figure] = {}
        if found.transmissions is not None:
            drawn |= _pictures().transmission_drawings(found.transmissions, asked.modes)
        if found.response is not None:
            drawn |= _pictures().response_drawings(found.response)
        return drawn

    return Part(found.to_dict, show, drawings, found.columns)


def _of_hands(asked: Asked) -> Part:
    from equipoise.handheld.exposed import expose_tool

    duration = None
    if asked.duration is not None:
        duration = quantity("--duration", asked.duration, "time")
        if not 0 < duration <= 86_400:
            raise UsageError(
                f"--duration: got {asked.duration!r}; give more than 0 and at most 24 h a day"
            )
    found = expose_tool(asked.tool, asked.range, duration)

    def show() -> None:
        from equipoise.terminal.tool_hands import print_tool_exposure

        print_tool_exposure(found, asked.units)

    return Part(found.to_dict, show, lambda: _pictures().exposure_drawings(found))


def _of_variation(asked: Asked) -> Part:
    import numpy as np

    from equipoise.handheld.design_plan import KEYS
    from equipoise.handheld.studies import check_key, vary_tool

    text = asked.vary or ""
    match = VARY.fullmatch(text.strip())
    if match is None:
        raise UsageError(
            f"--vary: got {text!r}; give a station, one of its numbers and a range, such as "
            '"harness position = 0 mm : 400 mm"'
        )
    station, key = match["station"], match["key"]
    with _blaming("--vary"):
        check_key(asked.tool.station(station), key)
    if key.endswith("damping"):
        raise UsageError(
            f"--vary: got {key!r}, which natural frequencies without damping do not feel; vary "
            "another number"
        )
    low, high = (quantity("--vary", match[end], KEYS[key]) for end in ("low", "high"))
    if not low < high:
        raise UsageError(f"--vary: got {text!r}; give a range, the smaller value first")
    values = np.linspace(low, high, VALUES)
    with _blaming("--vary"):
        found = vary_tool(asked.tool, station, key, values, asked.count)

    def show() -> None:
        from equipoise.terminal.tool import print_variation

        print_variation(found, asked.units)

    return Part(
        lambda: {"variation": found.to_dict()},
        show,
        lambda: _pictures().variation_drawings(found),
    )


def _of_sensitivities(asked: Asked) -> Part:
    import numpy as np

    from equipoise.handheld.exposed import tool_sensitivities

    design = asked.tool.design
    given = asked.respond is None and design is not None
    ends = design.speeds if given and design is not None else asked.ends
    found = tool_sensitivities(asked.tool, np.linspace(*ends, BAND))

    def show() -> None:
        from equipoise.terminal.tool_hands import print_sensitivities

        print_sensitivities(found, asked.tool, ends, asked.units)

    def values() -> Mapping[str, Any]:
        told: dict[str, dict[str, float]] = {}
        for (station, key), slope in found.items():
            told.setdefault(station, {})[key] = slope
        return {"sensitivities": told}

    return Part(values, show, dict)


def _of_design(asked: Asked) -> Part:
    found = asked.better

    def show() -> None:
        from equipoise.terminal.tool_hands import print_design

        print_design(found, asked.units)

    return Part(
        lambda: {"design": found.to_dict()}, show, lambda: _pictures().design_drawings(found)
    )


PARTS: dict[str, Callable[[Asked], Part]] = {
    "modes": _of_modes,
    "respond": _of_speeds,
    "exposure": _of_hands,
    "vary": _of_variation,
    "sensitivities": _of_sensitivities,
    "design": _of_design,
}
"""By what each answer is called."""


def give(
    asked: Asked,
    parts: Sequence[Part],
    json: bool,
    csv: str | None,
    plot: str | None,
    kind: Kind,
    out: str | None,
) -> None:
    """Write the files that are wanted, then print."""
    if out is not None:
        _save(asked, out)
    if csv is not None:
        for part in parts:
            if part.columns is not None:
                write_csv(part.columns(), csv)
    if plot is not None:
        drawn: dict[str, Figure] = {}
        for part in parts:
            drawn |= part.drawings()
        if not drawn:
            raise UsageError("--plot: sensitivities have no picture; leave it out")
        draw(drawn, plot, kind)
    if json:
        from equipoise.schema.output import json_text

        values: dict[str, Any] = {"title": asked.tool.title}
        for part in parts:
            values |= part.values()
        print(json_text(values))
        return
    from equipoise.terminal.tool import print_tool

    print_tool(asked.tool, asked.units)
    for part in parts:
        part.show()


def _save(asked: Asked, out: str) -> None:
    from equipoise.schema.models import save

    save(asked.better.better, out)
    print(f"wrote {out}; next: equipoise tool {out}", file=sys.stderr)
