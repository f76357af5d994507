"""How a driven link moves over the crank angle: its motion law written anew, as it is printed."""

from __future__ import annotations

from math import cos, pi, sin

from scipy.interpolate import make_interp_spline

from equipoise.mechanism.parts.laws import SPLINES, AngleLaw, LengthLaw
from equipoise.mechanism.parts.machine import Drive, FurtherDrive

Rates = tuple[float, float, float]
"""A value and its first and second derivative."""


def modified_sine(x: float) -> Rates:
    """A sine of acceleration in three parts, each from rest or to rest at the ends of the way."""
    scale = 1 / (4 + pi)
    if 1 / 8 < x < 7 / 8:
        turned = (pi + 4 * pi * x) / 3
        return (
            scale * (2 + pi * x - 9 / 4 * sin(turned)),
            scale * pi * (1 - 3 * cos(turned)),
            scale * 4 * pi**2 * sin(turned),
        )
    lifted = 0 if x <= 1 / 8 else 4
    return (
        scale * (lifted + pi * x - sin(4 * pi * x) / 4),
        scale * pi * (1 - cos(4 * pi * x)),
        scale * 4 * pi**2 * sin(4 * pi * x),
    )


FORMULAS = {
    "cycloidal": lambda x: (
        x - sin(2 * pi * x) / (2 * pi), 1 - cos(2 * pi * x), 2 * pi * sin(2 * pi * x)
    ),
    "harmonic": lambda x: (
        (1 - cos(pi * x)) / 2, pi / 2 * sin(pi * x), pi**2 / 2 * cos(pi * x)
    ),
    "3-4-5": lambda x: (
        10 * x**3 - 15 * x**4 + 6 * x**5, 30 * x**2 * (1 - x) ** 2, 60 * x * (1 - x) * (1 - 2 * x)
    ),
    "modified sine": modified_sine,
}  # fmt: skip
"""Laws from 0 to 1, as of Norton, Cam Design and Manufacturing Handbook."""


def driven(drive: Drive | FurtherDrive, crank_angle: float) -> Rates:
    """Return a driven link's angle and its derivatives by crank angle."""
    if drive.motion is not None:
        return followed(drive.motion, crank_angle)
    if isinstance(drive, Drive):
        return crank_angle, 1.0, 0.0
    return drive.start + drive.ratio * crank_angle, drive.ratio, 0.0


def followed(law: AngleLaw | LengthLaw, crank_angle: float) -> Rates:
    """Return what a motion law tells at a crank angle, segment by segment."""
    period = 2 * pi * law.turns
    cycles, since = divmod(crank_angle - law.phase, period)
    if law.between is not None:
        low, high = law.between
        rate = 2 * pi / period
        half, turned = (high - low) / 2, rate * since
        return (
            low + half * (1 - cos(turned)), half * rate * sin(turned), half * rate**2 * cos(turned)
        )  # fmt: skip
    if law.values:
        knots = [*law.crank_angles, law.crank_angles[0] + period]
        through = make_interp_spline(
            knots, [*law.values, law.values[0]], SPLINES[law.spline], bc_type="periodic"
        )
        x = knots[0] + (since - knots[0]) % period
        return float(through(x)), float(through(x, 1)), float(through(x, 2))
    gained = cycles * (law.segments[-1].to - law.start)
    before = law.start
    for segment in law.segments[:-1]:
        if since < segment.over:
            break
        since, before = since - segment.over, segment.to
    else:
        segment = law.segments[-1]
    way, over = segment.to - before, segment.over
    value, first, second = FORMULAS[segment.law](since / over)
    return gained + before + way * value, way * first / over, way * second / over**2
