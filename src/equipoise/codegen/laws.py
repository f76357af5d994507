"""Gears whose ratio varies in terms, at each design's own angles and with its own numbers.

Where whole turns of the gears' angles do not matter, rotations are multiplied; a running angle that
nothing asks for falls away.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import prod
from typing import Any

import numpy as np

from equipoise.codegen.followers import curve_value
from equipoise.codegen.terms import angle_of, rotation
from equipoise.codegen.trace import Trace, links_of
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Call, u
from equipoise.mechanism.formulas import rolling_kernels
from equipoise.mechanism.formulas.curves import Curve
from equipoise.mechanism.formulas.rolling import HalfAngle, PitchCurve, RatioTable, RatioWaves

MOST_PRODUCTS = 6
"""Power of a rotation up to which it is multiplied by itself."""


def trace_law(trace: Trace, step: Call, number: int) -> None:
    """How a gear turns whose ratio varies: the step of this number of the ``motion``."""
    _Law(trace, step, number).trace_gear()


class _Law:
    """A law in its place, and what of it each design has of its own.

    angle : of the driver, seen from the carrier, from the law's zero on.
    """

    def __init__(self, trace: Trace, step: Call, number: int) -> None:
        self.trace, self.number = trace, number
        self.driver, self.carrier, self.link = links_of(step)
        self.law: Any = step.parameters[0]
        driver, carrier = (trace.state[f"phi({one})"] for one in (self.driver, self.carrier))
        self.angle = driver - carrier - self.own("zero")

    def trace_gear(self) -> None:
        link, state = self.link, self.trace.state
        match self.law:
            case HalfAngle():
                y, ratio, bend = self._half_angle(self.law)
            case RatioWaves():
                y, ratio, bend = self._waves(self.law)
            case _:
                curve, begin = curve_of(self.law)
                y, ratio, bend = curve_value(self.trace, curve, self.angle - begin)
        offset = self.slot("offset", lambda found: _parameters(found, self.number)[1])
        state[f"phi({link})"] = state[f"phi({self.carrier})"] + y + offset
        state[f"ratio({link})"], state[f"bend({link})"] = ratio, bend
        rates = [state[name] for one in (self.driver, self.carrier) for name in u(one)[1:]]
        self.trace.put(u(link)[1:], rolling_kernels.followed(ratio, bend, *rates))  # type: ignore[no-untyped-call]

    def slot(self, what: str, read: Callable[[Linkage], Any], vector: bool = False) -> Any:
        return self.trace.slot(f"{what} of {self.link}", read, vector)

    def own(self, key: str) -> Any:
        """A number of the law."""
        return self.slot(key, lambda found: getattr(_parameters(found, self.number)[0], key))

    @property
    def once(self) -> Any:
        """exp(i x), with x counted from the law's zero."""
        driver, carrier = (self.trace.state[f"u({one})"] for one in (self.driver, self.carrier))
        zero = self.slot(
            "turned back", lambda found: np.exp(-1j * _parameters(found, self.number)[0].zero), True
        )
        return driver * carrier.conjugate() * zero

    def turned(self, lobes: int) -> Any:
        """exp(i lobes x), with x counted from the law's zero."""
        if lobes > MOST_PRODUCTS:
            return rotation(float(lobes) * self.angle)
        return prod([self.once] * (lobes - 1), start=self.once)

    def _half_angle(self, law: HalfAngle) -> tuple[Any, Any, Any]:
        lobes, mean = law.lobes, float(law.mean)
        numbers = mean, float(law.share), self.own("depth"), lobes
        whole, twice, ratio, bend = rolling_kernels.half_angle(self.turned(lobes), *numbers)  # type: ignore[no-untyped-call]
        (along,) = rolling_kernels.unit(whole)  # type: ignore[no-untyped-call]
        self._rotate(law, along, twice)
        return mean * self.angle + float(2 * law.share / lobes) * angle_of(along), ratio, bend

    def _rotate(self, law: HalfAngle, along: Any, twice: Any) -> None:
        """The rotation itself, where what swings is a product of others."""
        mean, times = float(law.mean), float(2 * law.share / law.lobes)
        if not times.is_integer() or abs(times) > MOST_PRODUCTS:
            return
        factors = [self.trace.state[f"u({self.carrier})"]]
        if mean.is_integer() and abs(mean) <= MOST_PRODUCTS and law.lobes <= MOST_PRODUCTS:
            factors += [_power(self.once, mean)] * abs(round(mean))
        else:
            factors.append(rotation(mean * self.angle))
        factors += [_power(twice, times)] * (abs(round(times)) // 2)
        factors += [_power(along, times)] * (round(times) % 2)

        def begun(found: Linkage) -> Any:
            return np.exp(1j * _parameters(found, self.number)[1])

        self.trace.state[f"u({self.link})"] = prod(factors, start=self.slot("begun", begun, True))
        self.trace.rotated.add(self.link)

    def _waves(self, law: RatioWaves) -> tuple[Any, Any, Any]:
        turn, wave, mean = self.turned(law.waves.lobes), 1.0, float(law.mean)
        levels: tuple[Any, ...] = (self.angle, 1.0, 0.0)
        for k, (_, _, order) in enumerate(law.waves.terms):
            pair = [
                self.slot(f"{key} {k + 1}", partial(_term, self.number, k, place))
                for place, key in enumerate(("cosine", "sine"))
            ]
            wave = wave * turn
            levels = rolling_kernels.series_term(*levels, wave, *pair, float(order))  # type: ignore[call-arg,no-untyped-call]
        y, ratio, bend = (mean * level for level in levels)
        return y, ratio, bend


def curve_of(law: RatioTable | PitchCurve) -> tuple[Curve, float]:
    """A law as a curve, and the angle at which this begins."""
    if isinstance(law, PitchCurve):
        return law.summed()
    curve, factor = law.table.spline, law.factor
    assert isinstance(curve, Curve)
    return Curve(curve.knots, factor * curve.powers, curve.waves), law.table.origin


def _parameters(found: Linkage, number: int) -> tuple[Any, ...]:
    """Law and offset."""
    step = found.motion[number]
    assert isinstance(step, Call)
    return step.parameters


def _term(number: int, k: int, place: int, found: Linkage) -> Any:
    """A cosine or sine of a series."""
    return [*_parameters(found, number)[0].waves.terms][k][place]


def _power(factor: Any, sign: float) -> Any:
    return factor if sign > 0 else factor.conjugate()
