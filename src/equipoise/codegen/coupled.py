"""Lines for couplings: links whose angle follows from those of two others.

Where the crank angle alone tells the angles of driver and carrier, it tells the driven link's too,
up to the angle at which each design starts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.writer import Writer, links_of
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, Call
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.machine import FRAME

Turning = Callable[[Array], tuple[Any, Any, Any]]
"""Angle of a link at crank angles (N,), rad, and its two derivatives by them."""


def told_by_crank(writer: Writer) -> dict[str, Turning]:
    """Links whose angle the crank angle alone tells: those driven, and what couplings add."""
    found: dict[str, Turning] = {FRAME: lambda theta: (0.0 * theta, 0.0, 0.0)}
    found |= {drive.link: drive.turned for drive in writer.machine.driven}
    for step in writer.linkage.motion:
        if isinstance(step, Call) and step.outputs[0].startswith("phi("):
            driver, carrier, driven = links_of(step)
            if {driver, carrier} <= found.keys() and driven not in writer.loose:
                found[driven] = partial(_followed, step, found[driver], found[carrier])
    return found


def _followed(step: Call, driver: Turning, carrier: Turning, theta: Array) -> tuple[Any, ...]:
    return step.kernel(*driver(theta), *carrier(theta), *step.parameters)


def write_coupling(writer: Writer, step: Call) -> None:
    """Write a coupling that need not be counted on, or one with a law."""
    driver, carrier, link = links_of(step)
    even = step.kernel is kernels.gear and {driver, carrier} <= writer.orders.keys()
    if even and not writer.counted:
        _write_uniform(writer, step)
        return
    sheet, told = writer.sheet, told_by_crank(writer)
    parts = {"angle": 0, "first": 1, "second": 2}
    angle, first, second = (
        sheet.row(f"{name}({link})", partial(_part, told[link], place))
        for name, place in parts.items()
    )
    start = _coupling(writer.linkage, link).start
    if writer.counted:
        put_off = sheet.slot(f"start({link})", lambda found: _coupling(found, link).start - start)
        sheet.put(f"phi({link})", f"{angle} + {put_off}")
    else:
        turn = sheet.slot(
            f"start({link})",
            lambda found: np.exp(1j * (_coupling(found, link).start - start)),
            vector=True,
        )
        cos, sin = (
            sheet.row(f"{wave.__name__}({link})", partial(_wave, wave, told[link]))
            for wave in (np.cos, np.sin)
        )
        sheet.put(f"u({link})", f"({cos} + 1j * {sin}) * {turn}")
    sheet.put(f"w({link})", first)
    sheet.put(f"a({link})", second)


def write_rolled(writer: Writer, step: Call, number: int) -> None:
    """Write where gears of varying ratio touch: the step of this number of the ``forces``."""
    name = step.outputs[0].removeprefix("lever(")[:-1]
    link = next(one.driven for one in writer.machine.couplings if one.name == name)
    if link in writer.loose:
        ratio, bend = (writer.name(f"{what}({link})") for what in ("ratio", "bend"))
    else:
        law, told = step.parameters[0], told_by_crank(writer)
        driver, carrier = (told[angle.removeprefix("phi(")[:-1]] for angle in step.inputs)
        ratio, bend = (
            writer.sheet.row(f"{what}({name})", partial(_of_law, law, place, driver, carrier))
            for place, what in ((1, "ratio"), (2, "bend"))
        )
    centres = writer.sheet.slot(f"centres({name})", partial(_centres, number), vector=True)
    lever, slope = step.outputs
    writer.sheet.put(lever, f"{centres} * (1 / (1 - {ratio}))")
    writer.sheet.put(slope, f"pitch_slope({ratio}, {bend})")


def _centres(number: int, found: Linkage) -> Any:
    step = found.forces[number]
    assert isinstance(step, Call)
    return step.parameters[1]


def _part(turning: Turning, place: int, theta: Array) -> Array:
    return np.asarray(turning(theta)[place] + 0.0 * theta)


def _wave(wave: Callable[[Any], Any], turning: Turning, theta: Array) -> Array:
    return np.asarray(wave(turning(theta)[0]))


def _of_law(law: Any, place: int, driver: Turning, carrier: Turning, theta: Array) -> Array:
    return np.asarray(law(driver(theta)[0] - carrier(theta)[0])[place])


def _coupling(found: Linkage, link: str) -> Coupling:
    return next(one for one in found.machine.couplings if one.driven == link)


def _write_uniform(writer: Writer, step: Call) -> None:
    """A gear whose driver and carrier turn in proportion to the crank does so too.

    Its rotation is a cosine and sine of a multiple of the crank angle, known for all designs.
    """
    sheet = writer.sheet
    driver, carrier, link = links_of(step)
    order = _follows(step, writer.orders[driver], writer.orders[carrier], 0.0)
    writer.orders[link] = order
    start = sheet.slot(f"start({link})", lambda found: np.exp(1j * _start(found, link)), True)
    sheet.put(f"u({link})", f"{writer.turned(order)} * {start}")
    sheet.put(f"w({link})", repr(order))
    sheet.put(f"a({link})", "0.0")


def _follows(step: Call, driver: Any, carrier: Any, offset: Any) -> Any:
    """What the step makes of driver's and carrier's angle (or order, without an offset)."""
    ratio = step.parameters[0]
    angle, *_ = step.kernel(driver, 0.0, 0.0, carrier, 0.0, 0.0, ratio, offset)
    return angle


def _start(found: Linkage, link: str) -> Any:
    """Angle of a link at crank angle 0, of links that turn in proportion to the crank."""
    for step in found.motion:
        if isinstance(step, Call) and step.kernel is kernels.gear:
            driver, carrier, driven = links_of(step)
            if driven == link:
                offset = step.parameters[1]
                return _follows(step, _start(found, driver), _start(found, carrier), offset)
    return 0.0
