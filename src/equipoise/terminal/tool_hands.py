"""What `equipoise tool` prints of the hands: what they get, what to change, and what does most."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from equipoise.handheld.design_plan import KEYS
from equipoise.terminal.exposure import print_exposure
from equipoise.terminal.tables import Row, number, table
from equipoise.terminal.tool import in_units, unbounded
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    from equipoise.handheld.design import Before, ToolDesign
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.model import Tool


def print_tool_exposure(found: ToolExposure, units: Units) -> None:
    """Weighted acceleration of every hand, and the day of the one that gets most."""
    print(_hands(found, units))
    low, high = (int(k) for k in (np.argmin(found.a_hv), np.argmax(found.a_hv)))
    unit, acceleration = units.name("angular speed"), units.name("acceleration")
    told = [
        f"{units.shown(float(found.a_hv[k]), 'acceleration')} {acceleration} at "
        f"{units.shown(float(found.speed[k]), 'angular speed')} {unit}"
        for k in (low, high)
    ]
    print(f"\nworst hand over this range: a_hv from {told[0]} to {told[1]}")
    print("along the shaft nothing moves in bending, so a_hv has two axes")
    for line in unbounded(found.response.tool):
        print(line)
    if found.worst is None:
        print("there is no daily exposure without work; add [[work]], or give --duration")
        return
    print(f"\nA day at {found.worst}, the hand that gets most")
    print_exposure((), (), found.days[found.worst])


def _hands(found: ToolExposure, units: Units) -> str:
    """At the speeds that the file names: a_hv, with idling and racing as one value."""
    rows: list[Row] = []
    for name, grip in found.grips.items():
        for what, part in found.named.items():
            vertical, lateral = (float(value) for value in part[name].a_hw[:, 0])
            plain = float(np.sqrt(np.sum(part[name].acceleration[:, 0] ** 2)))
            values = (plain, vertical, lateral, float(part[name].a_hv[0]))
            rows.append((name, what, *(units.shown(value, "acceleration") for value in values)))
        if name in found.equivalents:
            value = units.shown(found.equivalents[name], "acceleration")
            rows.append((name, "idling and racing, ISO 22867", "", "", "", value))
        k = int(np.argmax(grip.a_hv))
        top = f"most, at {units.shown(float(found.speed[k]), 'angular speed')}"
        rows.append((name, top, "", "", "", units.shown(float(grip.a_hv[k]), "acceleration")))
    header = (
        "",
        f"engine, {units.name('angular speed')}",
        "unweighted",
        "vertical",
        "lateral",
        "a_hv",
    )
    unit = units.name("acceleration")
    title = f"Acceleration of the hands, RMS, weighted by Wh of ISO 5349-1, {unit}"
    return table(title, header, rows, words=2)


def print_design(found: ToolDesign, units: Units) -> None:
    """What to change, and what that brings: before and after."""
    rows: list[Row] = []
    for row, edge in zip(found.variables, found.edges, strict=True):
        scale, unit = _of_dimension(row.dimension, units)
        told = f"{edge} that it may be" if edge else ""
        rows.append((row.name, unit, *_before_after(row, scale), told))
    for row in found.figures:
        scale, unit = _of_dimension(row.dimension, units)
        rows.append((row.name, unit, *_before_after(row, scale), ""))
    low, high = (units.shown(float(found.speed[k]), "angular speed") for k in (0, -1))
    title = f"What to change, and what that brings at {low} to {high} {units.name('angular speed')}"
    print(table(title, ("", "", "before", "after", "change", ""), rows, words=2))
    for line in unbounded(found.tool):
        print(f"\n{line}")
    print(
        f"\n{found.arrived} of {found.searches} searches from places spread over the whole room "
        "came to this design"
    )


def _before_after(row: Before, scale: float) -> tuple[str, str, str]:
    change = f"{100 * (row.after / row.before - 1):+.1f} %" if row.before else ""
    return number(row.before * scale), number(row.after * scale), change


def _of_dimension(dimension: str, units: Units) -> tuple[float, str]:
    key = next((key for key, one in KEYS.items() if one == dimension), None)
    if key is not None:
        return in_units(key, units)
    return units.value(1.0, dimension), units.name(dimension)  # type: ignore[arg-type]


def print_sensitivities(
    found: Mapping[tuple[str, str], float], tool: Tool, ends: tuple[float, float], units: Units
) -> None:
    """What each number of the tool does to the hands over a band of speeds, the strongest first."""
    from equipoise.handheld.studies import number_of

    rows = []
    for (station, key), slope in found.items():
        scale, unit = in_units(key, units)
        value = number_of(tool, station, key)
        step = 0.01 * (tool.shaft.length if key == "position" else value)
        rows.append((abs(slope * step), station, key, unit, value * scale, slope * step))
    rows = sorted((row for row in rows if row[0] > 0), reverse=True)
    lines = [
        (station, key, unit, number(value), f"{1000 * effect:+.3g}")
        for _, station, key, unit, value, effect in rows
    ]
    low, high = (units.shown(end, "angular speed") for end in ends)
    title = (
        "What 1 % more of each number (of a position, 1 % of the shaft) does to a_hv of the worst "
        f"hand, RMS over {low} to {high} {units.name('angular speed')}"
    )
    print(table(title, ("", "", "", "now", "mm/s^2"), lines, words=3))
