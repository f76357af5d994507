"""Lines for gears whose ratio varies, at each design's own angles and with its own numbers.

Where whole turns of the gears' angles do not matter, rotations are multiplied; a running angle that
nothing asks for falls away as the loop is compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.followers import write_curve
from equipoise.codegen.writer import Writer, links_of
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Call
from equipoise.mechanism.formulas.curves import Curve
from equipoise.mechanism.formulas.rolling import HalfAngle, PitchCurve, RatioTable, RatioWaves

MOST_PRODUCTS = 6
"""Power of a rotation up to which it is multiplied by itself."""


def write_law(writer: Writer, step: Call, number: int) -> None:
    """Write how a gear turns whose ratio varies: the step of this number of the ``motion``."""
    _Law(writer, step, number).write()


class _Law:
    """A law in its place, and what of it each design has of its own."""

    def __init__(self, writer: Writer, step: Call, number: int) -> None:
        self.writer, self.sheet, self.number = writer, writer.sheet, number
        self.driver, self.carrier, self.link = links_of(step)
        self.law: Any = step.parameters[0]

    def write(self) -> None:
        link, sheet = self.link, self.sheet
        x = f"phi({self.driver})", f"phi({self.carrier})"
        ends = " - ".join(map(self.writer.name, x))
        self.angle = sheet.put(f"seen({link})", f"{ends} - {self.own('zero')}")
        match self.law:
            case HalfAngle():
                y = self._half_angle(self.law)
            case RatioWaves():
                y = self._waves(self.law)
            case _:
                y = self._pieces()
        offset = self.slot("offset", lambda found: _parameters(found, self.number)[1])
        sheet.put(f"phi({link})", f"{self.writer.name(x[1])} + {y} + {offset}")
        inputs = [self.writer.name(f"{key}({link})") for key in ("ratio", "bend")]
        inputs += [
            self.writer.name(f"{key}({one})")
            for one in (self.driver, self.carrier)
            for key in ("w", "a")
        ]
        sheet.call("followed", inputs, (f"w({link})", f"a({link})"))

    def slot(self, what: str, read: Callable[[Linkage], Any], vector: bool = False) -> str:
        return self.sheet.slot(f"{what} of {self.link}", read, vector)

    def own(self, key: str) -> str:
        """A number of the law."""
        return self.slot(key, lambda found: getattr(_parameters(found, self.number)[0], key))

    def turned(self, lobes: int) -> str:
        """exp(i lobes x), with x counted from the law's zero."""
        writer, link = self.writer, self.link
        if lobes > MOST_PRODUCTS:
            return self.sheet.put(f"turned({link})", f"rotation({float(lobes)!r} * {self.angle})")
        driver, carrier = (writer.name(f"u({one})") for one in (self.driver, self.carrier))
        zero = self.slot(
            "turned back", lambda found: np.exp(-1j * _parameters(found, self.number)[0].zero), True
        )
        one = self.sheet.put(f"once({link})", f"{driver} * back({carrier}) * {zero}")
        return self.sheet.put(f"turned({link})", " * ".join([one] * lobes))

    def _half_angle(self, law: HalfAngle) -> str:
        sheet, link, lobes = self.sheet, self.link, law.lobes
        turned, whole = self.turned(lobes), f"whole({link})"
        numbers = [repr(float(law.mean)), repr(float(law.share)), self.own("depth"), repr(lobes)]
        outputs = (whole, f"twice({link})", f"ratio({link})", f"bend({link})")
        sheet.call("half_angle", [turned, *numbers], outputs)
        sheet.call("unit", [self.writer.name(whole)], (f"along({link})",))
        along, twice = (self.writer.name(f"{key}({link})") for key in ("along", "twice"))
        self._rotate(law, along, twice)
        factor = 2 * law.share / lobes
        return f"{float(law.mean)!r} * {self.angle} + {float(factor)!r} * angle_of({along})"

    def _rotate(self, law: HalfAngle, along: str, twice: str) -> None:
        """Write the rotation itself, where what swings is a product of others."""
        mean, times = float(law.mean), float(2 * law.share / law.lobes)
        if not times.is_integer() or abs(times) > MOST_PRODUCTS:
            return
        factors = [self.writer.name(f"u({self.carrier})")]
        if mean.is_integer() and abs(mean) <= MOST_PRODUCTS and law.lobes <= MOST_PRODUCTS:
            once = self.writer.name(f"once({self.link})")
            factors += [_power(once, mean)] * abs(round(mean))
        else:
            factors.append(f"rotation({mean!r} * {self.angle})")
        factors += [_power(twice, times)] * (abs(round(times)) // 2)
        factors += [_power(along, times)] * (round(times) % 2)

        def begun(found: Linkage) -> Any:
            return np.exp(1j * _parameters(found, self.number)[1])

        factors.append(self.slot("begun", begun, vector=True))
        self.sheet.put(f"u({self.link})", " * ".join(factors))
        self.writer.rotated.add(self.link)

    def _waves(self, law: RatioWaves) -> str:
        sheet, link, waves = self.sheet, self.link, law.waves
        turn, wave = self.turned(waves.lobes), ""
        levels = [self.angle, "1.0", "0.0"]
        for k, (_, _, order) in enumerate(waves.terms):
            pair = [
                self.slot(f"{key} {k + 1}", partial(_term, self.number, k, place))
                for place, key in enumerate(("cosine", "sine"))
            ]
            wave = sheet.put(f"wave {k + 1}({link})", f"{wave} * {turn}" if wave else turn)
            names = tuple(f"{level} {k + 1}({link})" for level in ("sum", "value", "slope"))
            sheet.call("series_term", [*levels, wave, *pair, f"{float(order)!r}"], names)
            levels = [self.writer.name(one) for one in names]
        mean = repr(float(law.mean))
        for key, level in zip(("ratio", "bend"), levels[1:], strict=True):
            sheet.put(f"{key}({link})", f"{mean} * {level}")
        return f"{mean} * {levels[0]}"

    def _pieces(self) -> str:
        """A law without a formula: pieces that all designs share."""
        curve, begin = curve_of(self.law)
        names = (f"way({self.link})", f"ratio({self.link})", f"bend({self.link})")
        write_curve(self.writer, curve, f"{self.angle} - {begin!r}", names)
        return self.writer.name(names[0])


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


def _power(factor: str, sign: float) -> str:
    return factor if sign > 0 else f"back({factor})"
