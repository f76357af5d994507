"""What the constants of a decay amount to, with confidence intervals by propagated covariance."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from equipoise.measured.record import Kind

Array = np.ndarray[Any, Any]

STEP = 1e-30
"""Of complex differences, which do not cancel."""


@dataclass(frozen=True)
class Quantity:
    """A value with the ends of its confidence interval, None where nothing is known of them."""

    value: float
    low: float | None = None
    high: float | None = None

    @property
    def includes_zero(self) -> bool:
        """Whether it cannot be told from zero; false where the interval is not known."""
        return self.low is not None and self.high is not None and self.low <= 0 <= self.high

    def apart_from(self, other: Quantity) -> bool:
        """Whether the two intervals have nothing in common; false where one is not known."""
        if self.low is None or self.high is None or other.low is None or other.high is None:
            return False
        return self.high < other.low or other.high < self.low

    def to_dict(self) -> dict[str, float | None]:
        """Plain data."""
        return {"value": self.value, "low": self.low, "high": self.high}


@dataclass(frozen=True, eq=False)
class Constants:
    """Constants of a decay as a method finds them.

    damped : beta, damped angular frequency, rad/s.
    loss : -ln n, where n is the slope of the line of half-swings.
    friction : Coulomb friction over stiffness, m or rad.
    covariance : (3, 3) of the three, or None.
    factor : half-width of a confidence interval over the standard error, Student's t.
    """

    damped: float
    loss: float
    friction: float
    covariance: Array | None
    factor: float

    def quantities(self, kind: Kind, stiffness: float | None) -> dict[str, Quantity]:
        """Every quantity by name, in SI units; see `_quantities`."""
        point = np.array([self.damped, self.loss, self.friction])
        values = _quantities(point.astype(complex), kind, stiffness)
        slopes = [_quantities(point + 1j * STEP * row, kind, stiffness) for row in np.eye(3)]
        found = {}
        for name, value in values.items():
            gradient = np.array([slope[name].imag for slope in slopes]) / STEP
            found[name] = self._interval(value.real, gradient)
        return found

    def line(self) -> dict[str, Quantity]:
        """Slope n and intercept m of the line of half-swings."""
        n = float(np.exp(-self.loss))
        slope = self._interval(n, np.array([0.0, -n, 0.0]))
        rise = np.array([0.0, 2 * self.friction * n, -2 * (1 + n)])
        return {"slope": slope, "intercept": self._interval(-2 * self.friction * (1 + n), rise)}

    def _interval(self, value: float, gradient: Array) -> Quantity:
        value = float(value)
        if self.covariance is None:
            return Quantity(value)
        variance = float(gradient @ self.covariance @ gradient)
        half = self.factor * max(0.0, variance) ** 0.5
        return Quantity(value, value - half, value + half)


def _quantities(point: Array, kind: Kind, stiffness: float | None) -> dict[str, Any]:
    """(60) to (62) of Yamashita, Ichikawa and Mori; complex numbers carry derivatives.

    point : beta (rad/s), -ln n, d (m or rad).
    """
    damped, loss, friction = point
    natural = damped * np.sqrt(1 + (loss / pi) ** 2)
    rate = damped * loss / pi
    found = {
        "damped_angular_frequency": damped,
        "natural_angular_frequency": natural,
        "damped_frequency": damped / (2 * pi),
        "natural_frequency": natural / (2 * pi),
        "damping_ratio": rate / natural,
        "logarithmic_decrement": 2 * loss,
        "decay_rate": rate,
        "coulomb_displacement": friction,
    }
    if stiffness is not None:
        inertia = stiffness / natural**2
        names = NAMES[kind]
        found |= {
            names[0]: inertia,
            "viscous_damping": 2 * rate * inertia,
            names[1]: stiffness * friction,
        }
    return found


NAMES: dict[Kind, tuple[str, str]] = {
    "length": ("mass", "coulomb_force"),
    "angle": ("inertia", "coulomb_torque"),
}
"""What inertia and friction are called."""


def student(confidence: float, free: float) -> float:
    """Half-width of a two-sided interval over the standard error."""
    from scipy.stats import t

    return float(t.ppf(0.5 + confidence / 2, free))
