"""Couplings in terms: links whose angle follows from those of two others.

Where the crank angle alone tells the angles of driver and carrier, it tells the driven link's too,
up to the angle at which each design starts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.terms import rotation
from equipoise.codegen.trace import Array, Trace, links_of
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Call, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.machine import FRAME

Turning = Callable[[Array], tuple[Any, Any, Any]]
"""Angle of a link at crank angles (N,), rad, and its two derivatives by them."""


def known_by_crank(trace: Trace) -> dict[str, Turning]:
    """Links whose angle the crank angle alone tells: those driven, and what couplings add."""
    turnings: dict[str, Turning] = {FRAME: lambda theta: (0.0 * theta, 0.0, 0.0)}
    turnings |= {drive.link: drive.turned for drive in trace.machine.driven}
    for step in trace.linkage.motion:
        if isinstance(step, Call) and step.outputs[0].startswith("phi("):
            driver, carrier, driven = links_of(step)
            if {driver, carrier} <= turnings.keys() and driven not in trace.loose:
                turnings[driven] = partial(_followed, step, turnings[driver], turnings[carrier])
    return turnings


def _followed(step: Call, driver: Turning, carrier: Turning, theta: Array) -> tuple[Any, ...]:
    return step.kernel(*driver(theta), *carrier(theta), *step.parameters)


def trace_coupling(trace: Trace, step: Call) -> None:
    """A coupling that need not be counted on, or one with a law."""
    driver, carrier, link = links_of(step)
    even = step.kernel is kernels.gear and {driver, carrier} <= trace.orders.keys()
    if even and not trace.counted:
        _trace_uniform(trace, step)
        return
    turning = known_by_crank(trace)[link]
    angle, first, second = (
        trace.row(f"{name}({link})", partial(_part, turning, place))
        for place, name in enumerate(("angle", "first", "second"))
    )
    start = _coupling(trace.linkage, link).start
    if trace.counted:
        put_off = trace.slot(f"start({link})", lambda found: _coupling(found, link).start - start)
        trace.state[f"phi({link})"] = angle + put_off
    else:
        turn = trace.slot(
            f"start({link})",
            lambda found: np.exp(1j * (_coupling(found, link).start - start)),
            vector=True,
        )
        trace.state[f"u({link})"] = rotation(angle) * turn
    trace.put(u(link)[1:], (first, second))


def trace_rolled(trace: Trace, step: Call, number: int) -> None:
    """Where gears of varying ratio touch: the step of this number of the ``forces``."""
    name = step.outputs[0].removeprefix("lever(")[:-1]
    link = next(one.driven for one in trace.machine.couplings if one.name == name)
    if link in trace.loose:
        ratio, bend = (trace.state[f"{what}({link})"] for what in ("ratio", "bend"))
    else:
        law, turnings = step.parameters[0], known_by_crank(trace)
        driver, carrier = (turnings[angle.removeprefix("phi(")[:-1]] for angle in step.inputs)
        ratio, bend = (
            trace.row(f"{what}({name})", partial(_of_law, law, place, driver, carrier))
            for place, what in ((1, "ratio"), (2, "bend"))
        )
    centres = trace.slot(f"centres({name})", partial(_centres, number), vector=True)
    lever, slope = step.outputs
    trace.state[lever] = centres * (1 / (1 - ratio))
    trace.state[slope] = kernels.pitch_slope(ratio, bend)


def _centres(number: int, found: Linkage) -> Any:
    step = found.forces[number]
    assert isinstance(step, Call)
    return step.parameters[1]


def _part(turning: Turning, place: int, theta: Array) -> Array:
    return np.asarray(turning(theta)[place] + 0.0 * theta)


def _of_law(law: Any, place: int, driver: Turning, carrier: Turning, theta: Array) -> Array:
    return np.asarray(law(driver(theta)[0] - carrier(theta)[0])[place])


def _coupling(found: Linkage, link: str) -> Coupling:
    return next(one for one in found.machine.couplings if one.driven == link)


def _trace_uniform(trace: Trace, step: Call) -> None:
    """A gear whose driver and carrier turn in proportion to the crank does so too.

    Its rotation is a cosine and sine of a multiple of the crank angle, known for all designs.
    """
    driver, carrier, link = links_of(step)
    order = _follows(step, trace.orders[driver], trace.orders[carrier], 0.0)
    trace.orders[link] = order
    start = trace.slot(f"start({link})", lambda found: np.exp(1j * _start(found, link)), True)
    trace.put(u(link), (trace.turned(order) * start, order, 0.0))


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
