"""A rotary transplanter by closed forms, without a line of Equipoise.

Equal ellipses that turn about a focus roll on each other as an antiparallelogram moves: halves of
their angles have tangents in a constant ratio.  An arm sits on a planet that an idler turns, which
rolls on a sun that stands still; sun, idler and planet are such ellipses.  What shakes the frame is
the change of momentum and of angular momentum, taken off their Fourier series in the crank angle.
SI units, angles in rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

TURN = 2 * np.pi
CYCLE = np.arange(256) * (TURN / 256)
Array = NDArray[Any]


def rolled(x: Array, eccentricity: float) -> Array:
    """Angle of the driven ellipse; at 0 the driver's shortest radius meets its longest."""
    whole = np.round(x / TURN)
    half = np.tan((x - TURN * whole) / 2) * (1 - eccentricity) / (1 + eccentricity)
    return np.asarray(-2 * np.arctan(half) - TURN * whole)


@dataclass(frozen=True)
class Body:
    """Mass, centre of mass from the link's origin in its axes, and moment of inertia about it."""

    mass: float
    center: complex
    inertia: float


@dataclass(frozen=True)
class Arm:
    """Axes of idler and planet on the carrier, and what meshes how.

    sun, idler : angle of the driver, seen from the carrier, at which its shortest radius points to
        the driven gear.  starts : angles of idler and planet in the frame at crank angle 0.
    """

    axes: tuple[complex, complex]
    sun: float
    idler: float
    starts: tuple[float, float]
    tip: complex


@dataclass(frozen=True)
class Rotary:
    """A carrier that turns about 0, with equal arms."""

    eccentricity: float
    arms: Sequence[Arm]
    carrier: Body
    wheel: Body
    finger: Body

    def angles(self, arm: Arm, theta: Array) -> tuple[Array, Array]:
        """Angles of idler and planet in the frame."""

        def turned(x: Array, still: float, phase: float) -> Array:
            e = self.eccentricity
            return rolled(x - phase, e) - rolled(np.array(still - phase), e)

        idler = turned(-theta, 0.0, arm.sun) + arm.starts[0]
        planet = turned(idler, arm.starts[0], arm.idler) + arm.starts[1]
        return theta + idler, theta + planet

    def tip(self, arm: Arm, theta: Array) -> Array:
        """Place of the tip."""
        turn = np.exp(1j * self.angles(arm, theta)[1])
        return np.asarray(arm.axes[1] * np.exp(1j * theta) + arm.tip * turn)

    def moving(self, theta: Array) -> list[tuple[Body, Array, Array]]:
        """Every body with the place of its origin and its angle."""
        actual = [(self.carrier, 0j * theta, theta)]
        for arm in self.arms:
            bodies = (self.wheel, self.finger)
            for body, axis, angle in zip(bodies, arm.axes, self.angles(arm, theta), strict=True):
                actual.append((body, axis * np.exp(1j * theta), angle))
        return actual

    def shaking(self, speed: float) -> tuple[Array, Array]:
        """Force, complex, and moment about the pivot, at `CYCLE`, of a crank that turns evenly."""
        momentum, spin = np.zeros(len(CYCLE), complex), np.zeros(len(CYCLE))
        for body, origin, angle in self.moving(CYCLE):
            center = origin + body.center * np.exp(1j * angle)
            rate = slope(center)
            turns = np.round((angle[-1] - angle[0]) / TURN)
            turning = slope(angle - turns * CYCLE).real + turns
            momentum += body.mass * rate * speed
            spin += (body.mass * (np.conj(center) * rate).imag + body.inertia * turning) * speed
        return -slope(momentum) * speed, -slope(spin).real * speed


def slope(values: Array) -> Array:
    """Derivative by crank angle of a function over one turn, off its Fourier series."""
    orders = np.fft.fftfreq(len(values), 1 / len(values))
    return np.asarray(np.fft.ifft(1j * orders * np.fft.fft(values)))
