"""Checks of what may be changed in a tool, and of what must be kept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.tools.places import places, unknown_station, wrong_range
from equipoise.tools.wishes import KEYS, MEASURES, OUTPUTS

if TYPE_CHECKING:
    from equipoise.tools.model import Tool
    from equipoise.tools.wishes import DesignLimit, DesignPlan, DesignVariable


def wrong_design(design: DesignPlan, tool: Tool) -> Iterator[ModelError]:
    """Everything that is wrong with a plan."""
    yield from wrong_range("design.speeds", design.speeds)
    if design.measure not in MEASURES:
        yield ModelError("design.measure", unknown(design.measure, MEASURES, "measure"))
    if not design.variables:
        yield ModelError("design.variables", "there is nothing to change; give at least one")
    if not tool.excitations:
        yield ModelError("design", "nothing shakes the tool; give [[excitations]]")
    if not tool.grips:
        yield ModelError("design", "no hand holds the tool; give a station a hand")
    for number, name in enumerate(design.hands, 1):
        yield from _not_held(f"design.hands[{number}]", name, tool)
    seen = set()
    for where, variable in places("design.variables", design.variables):
        yield from _wrong_variable(where, variable, tool)
        if (variable.station, variable.key) in seen:
            yield ModelError(where, f"{variable.name!r} is given twice; give one of both")
        seen.add((variable.station, variable.key))
    for where, limit in places("design.limits", design.limits):
        yield from _wrong_limit(where, limit, tool)


def _not_held(where: str, name: str, tool: Tool) -> Iterator[ModelError]:
    held = [station.name for station in tool.grips]
    if name not in held:
        yield ModelError(where, unknown(name, held, "station with a hand"))


def _wrong_variable(where: str, variable: DesignVariable, tool: Tool) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", variable.station, tool)
    if variable.key not in KEYS:
        yield ModelError(f"{where}.key", unknown(variable.key, KEYS, "key of a station"))
        return
    part, dot, _ = variable.key.partition(".")
    for station in tool.stations:
        if dot and station.name == variable.station and getattr(station, part) is None:
            yield ModelError(f"{where}.key", f"{station.name!r} has no {part}; give it one")
    if variable.low < 0:
        yield ModelError(f"{where}.from", f"got {variable.low:g} in SI units; give 0 or more")
    if variable.low >= variable.high:
        yield ModelError(
            f"{where}.to",
            f"got {variable.high:g} after from {variable.low:g} in SI units; give more than that",
        )
    length = tool.shaft.length
    if variable.key == "position" and variable.high > length:
        yield ModelError(
            f"{where}.to",
            f"got {variable.high:g} m, which is off the shaft; give at most {length:g} m",
        )


def _wrong_limit(where: str, limit: DesignLimit, tool: Tool) -> Iterator[ModelError]:
    if limit.output not in OUTPUTS:
        yield ModelError(f"{where}.output", unknown(limit.output, OUTPUTS, "output"))
        return
    if limit.at_most < 0 or (limit.at_most == 0 and limit.output != "added_mass"):
        least = "0 or more" if limit.output == "added_mass" else "more than 0"
        yield ModelError(f"{where}.at_most", f"got {limit.at_most:g} in SI units; give {least}")
    if limit.output == "added_mass":
        if limit.station is not None:
            yield ModelError(f"{where}.station", "added_mass is of the whole tool; leave it out")
    elif limit.station is None:
        yield ModelError(f"{where}.station", f"missing; give that of the {limit.output}")
    elif limit.output == "acceleration":
        yield from _not_held(f"{where}.station", limit.station, tool)
    else:
        touching = [one.name for one in tool.stations if one.hand or one.harness]
        if limit.station not in touching:
            sentence = unknown(limit.station, touching, "station with a hand or harness")
            yield ModelError(f"{where}.station", sentence)
