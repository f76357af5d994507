"""What may be changed in a tool so that the hands feel less, and what must be kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from equipoise.keys import Frozen

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
