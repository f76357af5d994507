"""Free vibration of a machine on its support, and the crank speeds at which it would resound."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import copysign, sqrt
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import MassError, ModelError
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.vibration.body import MISSING
from equipoise.vibration.forced import usual_step
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.response import Mode, Values

QUIET = 1e-3
"""Share of the loudest resonance at every gauge below which one is not told."""
LEAST_DAMPING = 1e-4
"""Damping ratio below which modes are compared as if they had it."""
AMPLIFIED = 3.0
"""A speed is to be kept away from where the mode amplifies the order more often than this."""


@dataclass(frozen=True)
class Resonance:
    """One order that meets one mode.

    speed : of the crank, rad/s.  order : events in a turn.  mode : its number, from 1.
    frequency : of the mode, rad/s.
    share : amplitude at the gauge that this resonance shakes most, over the largest there.
    avoid : speeds between which the mode amplifies this order more than three times, the slower one
        first; None where its damping never lets it.
    """

    speed: float
    order: float
    mode: int
    frequency: float
    share: float
    avoid: tuple[float, float] | None

    def to_dict(self) -> dict[str, Any]:
        """In SI units."""
        return {**vars(self), "avoid": None if self.avoid is None else list(self.avoid)}


def resonances(linear: Linear, slowest: float, fastest: float) -> list[Resonance]:
    """Resonances between two speeds of the crank of the same sign, rad/s; the fastest first.

    Those whose order the linkages do not excite in that mode are left out.
    """
    found: list[tuple[float, float, int, Mode]] = []
    low, high = sorted((abs(slowest), abs(fastest)))
    orders = linear.wrench(high).orders[1:]
    for number, mode in enumerate(linear.modes, 1):
        rate = mode.natural_frequency
        # The ends belong to the range, whatever rounding says.
        inside = (rate >= orders * low * (1 - 1e-12)) & (rate <= orders * high * (1 + 1e-12))
        found += [
            (copysign(rate / order, fastest), order, number, mode)
            for order in map(float, orders[inside & mode.swings])
        ]
    loud = _loudness(linear, found)
    return sorted(
        (
            Resonance(speed, order, number, mode.natural_frequency, share, _avoid(speed, mode))
            for (speed, order, number, mode), share in zip(found, loud, strict=True)
            if share >= QUIET
        ),
        key=lambda resonance: -abs(resonance.speed),
    )


def _loudness(linear: Linear, found: list[tuple[float, float, int, Mode]]) -> list[float]:
    """Amplitude of each resonance at the gauge where it is loudest beside the others there."""
    rows = np.array([linear.body.row(g)[linear.body.free] for g in gauges_of(linear.body).values()])
    amplitudes = np.zeros((len(found), len(rows)))
    for k, (speed, order, _, mode) in enumerate(found):
        wrench = linear.wrench(speed)
        n = round(order * wrench.turns)
        if n < wrench.amplitudes.shape[1]:
            force = abs(mode.shape @ wrench.amplitudes[:, n])
            inertia = abs(mode.shape @ linear.mass @ mode.shape)
            damping = max(abs(mode.damping_ratio), LEAST_DAMPING)
            size = force / (2 * damping * mode.natural_frequency**2 * inertia)
            amplitudes[k] = np.abs(rows @ mode.shape) * size
    largest = np.max(amplitudes, axis=0, initial=0.0)
    shares = np.divide(amplitudes, largest, out=np.zeros_like(amplitudes), where=largest > 0)
    return [float(share) for share in np.max(shares, axis=1, initial=0.0)]


def _avoid(speed: float, mode: Mode) -> tuple[float, float] | None:
    """Where (1 - r^2)^2 + (2 D r)^2 < 1 / amplified^2, with r the frequency over the mode's."""
    damping = mode.damping_ratio
    half = 1 - 2 * damping**2
    inner = half**2 - 1 + 1 / AMPLIFIED**2
    if inner <= 0 or half <= 0:
        return None
    low, high = half - sqrt(inner), half + sqrt(inner)
    return (speed * sqrt(max(low, 0.0)), speed * sqrt(high))


@dataclass(frozen=True, eq=False, repr=False)
class FreeVibration(Result):
    """Modes of a machine on its support, standing in the mean of a turn.

    linear : the machine as a linear system.  modes : by frequency.
    preloads : force (N) or torque (N m) of each mount at rest.
    """

    shown_in: ClassVar[str] = "vibration.sweep_blocks"
    records: ClassVar[str] = "modes"

    linear: Linear
    modes: tuple[Mode, ...]
    preloads: Mapping[str, float]

    @property
    def machine(self) -> Machine:
        return self.linear.body.machine

    @property
    def coordinates(self) -> tuple[str, ...]:
        """What the parts of a shape belong to: displacements and rotations of the support."""
        return self.linear.body.support.coordinates

    @cached_property
    def gauges(self) -> Mapping[str, Array]:
        """What each gauge reads of each mode's shape, complex (modes,)."""
        body = self.linear.body
        shapes = np.array([mode.shape for mode in self.modes]).reshape(-1, len(body.free))
        return {n: shapes @ body.row(gauge)[body.free] for n, gauge in gauges_of(body).items()}

    def to_dict(self) -> Values:
        """The machine-readable output, in SI units; shapes as real and imaginary parts."""
        modes = []
        for number, mode in enumerate(self.modes):
            read = {n: [v[number].real, v[number].imag] for n, v in self.gauges.items()}
            modes.append({**mode.to_dict(), "gauges": read})
        return {
            "title": self.machine.title,
            "model": self.linear.excitation.step,
            "coordinates": list(self.coordinates),
            "modes": modes,
            "mass": self.linear.mass,
            "damping": self.linear.damping,
            "stiffness": self.linear.stiffness,
            "preloads": dict(self.preloads),
        }


def modes(machine: Machine, model: str | None = None) -> FreeVibration:
    """Natural frequencies, damping and shapes of a machine on its support.

    Parameters
    ----------
    model : ``linear`` or ``torque``, for the linkages' mass at the drive's pivot, or ``moment``,
        for it spread as in the mean of a turn; what `respond` takes where not given.

    Raises
    ------
    ModelError : there is no support, or its mounts do not hold it.
    MassError, MotionError, UsageError.
    """
    if machine.support is None:
        raise ModelError("support", MISSING)
    if missing := massless(machine):
        raise MassError(missing)
    linear = Linear.of(machine, usual_step(machine, model))
    return FreeVibration(linear, linear.modes, linear.rest.preload)
