"""What is seen in a picture of vibration on a support, in one line; as `headlines`."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import say
from equipoise.mechanism.outputs.spoken import named
from equipoise.present.shaking import largest_of
from equipoise.quantities import PER_RPM, brief, percent, told
from equipoise.results.outputs import shown_in
from equipoise.vibration.resonance import nearest_loud

if TYPE_CHECKING:
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Response
    from equipoise.vibration.sweep import Sweep


def first_gauge(response: Response | None) -> str:
    """How far the support moves at the first gauge."""
    name = next(iter(response.gauges), "") if response is not None else ""
    return moved(response, name) if response is not None and name else ""


def moved(response: Response, name: str) -> str:
    """How far the support moves at a gauge."""
    gauge = response.gauges[name]
    size = float(gauge.displacement.peak_to_peak)
    unit = shown_in("rad" if gauge.rotation else "m", [size])
    swing = unit.with_unit(unit.text(size, digits=3))
    return say("Gauge {gauge} moves by {size} peak to peak", gauge=named(name), size=swing)


def loudest_gauge(response: Response) -> str:
    """The loudest order at the gauge that is told first."""
    name, gauge = next(iter(response.gauges.items()))
    squares = gauge.displacement.sizes**2
    squares[0] = 0.0
    top = int(np.argmax(squares))
    return say(
        "{share} % of what gauge {gauge} reads is order {order}",
        share=percent(squares[top] / (np.sum(squares) or 1.0)),
        gauge=named(name),
        order=f"{top / response.turns:.4g}",
    )


def mounted(response: Response) -> str:
    """Which mount carries most."""
    forces = {
        name: max(abs(mount.largest), abs(mount.smallest))
        for name, mount in response.mounts.items()
        if not mount.torsional
    }
    name, peak = largest_of(forces)
    size = told(peak, "force", digits=3)
    return (
        say("Mount {name} carries most: up to {peak}", name=named(name), peak=size) if name else ""
    )


def driven(response: Response) -> str:
    """Between which torques the drive swings."""
    torque = response.drive.torque_figures
    low, high = (told(end, "torque", digits=3) for end in (torque.min, torque.max))
    return say("The drive torque swings between {low} and {high}", low=low, high=high)


def resonant(sweep: Sweep, quantity: str) -> str:
    """At which speed the displacement of the first gauge has its highest peak."""
    name, tops = next(iter(sweep.peaks.items()), ("", []))
    if not tops or quantity != "displacement":
        return ""
    rpm = brief(abs(tops[0][0]) / PER_RPM)
    return say("Gauge {gauge} swings most at {speed} rpm", gauge=named(name), speed=rpm)


def met(sweep: Sweep, speed: float) -> str:
    """Which loud resonance is nearest to the speed of the machine."""
    if not sweep.resonances:
        return say("No order meets a mode at these speeds")
    resonance = nearest_loud(sweep.resonances, speed)
    return say(
        "The nearest loud resonance is at {speed} rpm: order {order} meets mode {mode}",
        speed=brief(abs(resonance.speed) / PER_RPM),
        order=f"{resonance.order:.4g}",
        mode=resonance.mode,
    )


def swung(free: FreeVibration, number: int) -> str:
    """Frequency of a mode, and the speed at which once a turn meets it."""
    rate = free.modes[number - 1].natural_frequency
    values = {"mode": number, "frequency": brief(rate / (2 * pi)), "speed": brief(rate / PER_RPM)}
    if not rate:
        return say("Mode {mode} is free, without a spring", mode=number)
    return say(
        "Mode {mode} swings at {frequency} Hz, which is once a turn at {speed} rpm", **values
    )
