"""What presses in plain bearings, and how much it warms them, over the states of a duty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say
from equipoise.mechanism.dynamics.forces import Forces, WorkingState
from equipoise.mechanism.kinematics.strokes import figure
from equipoise.signals import Figures


@dataclass(frozen=True)
class PlainBearingDuty:
    """Figures of a plain bearing over the crank angles of an analysis, or those of all duty states.

    pressure : largest force over width times diameter, Pa.
    pressure_speed : largest pressure times sliding speed, Pa m/s.
    pressure_at, pressure_speed_at : crank angles of these, rad; None where they do not vary.
    mean_pressure_speed : mean of that over the operating time, Pa m/s.
    """

    pressure: float = figure(to_say("largest pressure"), "modulus")
    pressure_at: float | None = figure(to_say("largest pressure at crank angle"), "angle")
    pressure_speed: float = figure(to_say("largest pressure times speed"), "pressure times speed")
    pressure_speed_at: float | None = figure(
        to_say("largest pressure times speed at crank angle"), "angle"
    )
    mean_pressure_speed: float = figure(
        to_say("pressure times speed in the mean"), "pressure times speed"
    )

    def to_dict(self) -> dict[str, Any]:
        """As plain data in SI units."""
        return dict(vars(self))


def plain_bearing_duties(forces: Forces) -> Mapping[str, PlainBearingDuty]:
    """Figures of plain bearings by joint: over all duty states of the machine where the crank is
    turned evenly over a whole cycle, else over these forces alone.
    """
    steady = forces.motion.is_steady_cycle
    states = forces.working_states if steady else (WorkingState(1.0, forces),)
    return {name: _over(states, name) for name in forces.plain_bearings}


def _over(states: Sequence[WorkingState], name: str) -> PlainBearingDuty:
    """The largest of all states, and the mean by their shares of the time."""
    bearings = [(state, state.forces.plain_bearings[name]) for state in states]
    pressures, speeds = (
        [state.forces.motion.figures(getattr(item, signal)) for state, item in bearings]
        for signal in ("pressure", "pressure_speed")
    )
    pressure, warming = (max(each, key=lambda item: item.max) for each in (pressures, speeds))
    mean = sum(state.share * item.mean for (state, _), item in zip(bearings, speeds, strict=True))
    return PlainBearingDuty(
        pressure.max, _angle_of_largest(pressure), warming.max, _angle_of_largest(warming), mean
    )


def _angle_of_largest(figures: Figures) -> float | None:
    """Crank angle of the largest value, rad; None where it is as large everywhere."""
    return None if figures.is_constant() else figures.max_at
