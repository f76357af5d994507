"""What may be changed in a tool so that the hands feel less, and what must be kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.handheld.shaft import places
from equipoise.handheld.station import Station
from equipoise.keys import Frozen
from equipoise.mechanism.checks import unknown

Measure = Literal["rms", "peak"]
MEASURES: tuple[Measure, ...] = ("rms", "peak")
"""Root of the mean square over the speeds of the band, and the largest."""

KEYS = {
    "position": "length",
    "mass": "mass",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
    "harness.stiffness": "stiffness",
    "harness.damping": "damping",
    "absorber.mass": "mass",
    "absorber.stiffness": "stiffness",
    "absorber.damping": "damping",
}
"""Numbers of a station that a design may change, each with its dimension."""

OUTPUTS = {"acceleration": "acceleration", "force": "force", "added_mass": "mass"}
"""What can be limited: the weighted acceleration of a hand's station and the force on the body at a
station, root of the mean square over time, at the worst speed of the band; mass that is added."""


@dataclass(frozen=True)
class DesignVariable(Frozen):
    """A number of a station that may be anything from `low` to `high`, in SI units.

    key : one of `KEYS`; of a pair of numbers both become the same.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("station", "key"), "text"),
        **dict.fromkeys(("low", "high"), "number"),
    }

    station: str
    key: str
    low: float
    high: float

    @property
    def name(self) -> str:
        """Such as ``belt harness.stiffness``."""
        return f"{self.station} {self.key}"


@dataclass(frozen=True)
class DesignLimit(Frozen):
    """Something that must not become larger, in SI units.

    output : one of `OUTPUTS`.
    station : of an acceleration or force.
    """

    shapes: ClassVar[dict[str, str]] = {
        "output": "text",
        "station": "text?",
        "at_most": "number",
    }

    output: str
    at_most: float
    station: str | None = None


@dataclass(frozen=True)
class DesignPlan(Frozen):
    """The weighted acceleration of the hands over a band of speeds is to be as small as it can be.

    speeds : lowest and highest speed of the engine, rad/s.
    variables : what may be changed.
    limits : what must be kept.
    measure : over the speeds of the band; over several hands it is that of the worst.
    hands : stations whose acceleration counts; all that are held if empty.
    """

    shapes: ClassVar[dict[str, str]] = {
        "speeds": "pair",
        **dict.fromkeys(("variables", "limits"), "list"),
        "measure": "text",
        "hands": "names",
    }

    speeds: tuple[float, float]
    variables: tuple[DesignVariable, ...]
    limits: tuple[DesignLimit, ...] = ()
    measure: Measure = "rms"
    hands: tuple[str, ...] = ()


def unknown_station(where: str, name: str, stations: Sequence[Station]) -> Iterator[ModelError]:
    """A name that no station has."""
    names = [station.name for station in stations]
    if name not in names:
        yield ModelError(where, unknown(name, names, "station"))


def wrong_range(where: str, speeds: Sequence[float]) -> Iterator[ModelError]:
    """Two speeds, the lower one first."""
    if len(speeds) != 2:
        yield ModelError(where, f"got {len(speeds)}; give the lowest and the highest speed")
    elif not 0 < speeds[0] < speeds[1]:
        low, high = speeds
        yield ModelError(
            where, f"got {low:g} to {high:g} rad/s; give two above 0, the lower one first"
        )


def wrong_design(
    design: DesignPlan, stations: Sequence[Station], length: float, shaken: bool
) -> Iterator[ModelError]:
    """Everything that is wrong with a plan for a tool.

    length : of its shaft, m.  shaken : whether anything shakes it.
    """
    held = [one.name for one in stations if one.hand is not None]
    yield from wrong_range("design.speeds", design.speeds)
    if design.measure not in MEASURES:
        yield ModelError("design.measure", unknown(design.measure, MEASURES, "measure"))
    if not design.variables:
        yield ModelError("design.variables", "there is nothing to change; give at least one")
    if not shaken:
        yield ModelError("design", "nothing shakes the tool; give [[excitations]]")
    if not held:
        yield ModelError("design", "no hand holds the tool; give a station a hand")
    for number, name in enumerate(design.hands, 1):
        yield from _not_held(f"design.hands[{number}]", name, held)
    seen = set()
    for where, variable in places("design.variables", design.variables):
        yield from _wrong_variable(where, variable, stations, length)
        if (variable.station, variable.key) in seen:
            yield ModelError(where, f"{variable.name!r} is given twice; give one of both")
        seen.add((variable.station, variable.key))
    for where, limit in places("design.limits", design.limits):
        yield from _wrong_limit(where, limit, stations, held)


def _not_held(where: str, name: str, held: Sequence[str]) -> Iterator[ModelError]:
    if name not in held:
        yield ModelError(where, unknown(name, held, "station with a hand"))


def _wrong_variable(
    where: str, variable: DesignVariable, stations: Sequence[Station], length: float
) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", variable.station, stations)
    if variable.key not in KEYS:
        yield ModelError(f"{where}.key", unknown(variable.key, KEYS, "key of a station"))
        return
    part, dot, _ = variable.key.partition(".")
    for station in stations:
        if dot and station.name == variable.station and getattr(station, part) is None:
            yield ModelError(f"{where}.key", f"{station.name!r} has no {part}; give it one")
    if variable.low < 0:
        yield ModelError(f"{where}.from", f"got {variable.low:g} in SI units; give 0 or more")
    if variable.low >= variable.high:
        yield ModelError(
            f"{where}.to",
            f"got {variable.high:g} after from {variable.low:g} in SI units; give more than that",
        )
    if variable.key == "position" and variable.high > length:
        yield ModelError(
            f"{where}.to",
            f"got {variable.high:g} m, which is off the shaft; give at most {length:g} m",
        )


def _wrong_limit(
    where: str, limit: DesignLimit, stations: Sequence[Station], held: Sequence[str]
) -> Iterator[ModelError]:
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
        yield from _not_held(f"{where}.station", limit.station, held)
    else:
        touching = [one.name for one in stations if one.hand or one.harness]
        if limit.station not in touching:
            sentence = unknown(limit.station, touching, "station with a hand or harness")
            yield ModelError(f"{where}.station", sentence)
