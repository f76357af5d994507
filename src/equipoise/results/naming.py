"""Outputs, measures and causes in words."""

from __future__ import annotations

from math import pi

from equipoise.i18n import say, to_say
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.outputs import declared
from equipoise.results.outputs import unit_of

RPM = 30 / pi
MEASURES = {
    "rms": to_say("RMS"),
    "ripple": to_say("RMS about the mean"),
    "peak": to_say("peak"),
    "peak_to_peak": to_say("peak to peak"),
    "area": to_say("area in a turn"),
}
CAUSES = {
    "translation": to_say("inertia of the centres of mass"),
    "rotation": to_say("inertia of rotation"),
    "weight": to_say("weight"),
    "load": to_say("loads"),
    "spring": to_say("springs"),
}
SCALES = {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "kg": (1e3, "g")}
"""SI unit -> factor and unit that is shown."""


def output_named(name: str, rows: int = 1) -> str:
    """An output, such as ``joints.A``, in words.

    rows : of the machine; where there are several, outputs are of one row if they do not say so.
    """
    first, _, rest = name.partition(".")
    found = declared(name)
    if found is not None:
        return found[0].say(found[1], rows > 1)
    return say("all rows: {what}", what=output_named(rest)) if first == "rows" else name


def objective_named(one: Objective, rows: int = 1) -> str:
    """What is to become small, in words."""
    of_joint = one.output.startswith(("joints.", "gauges."))
    output = one.output if rows < 2 or of_joint else f"rows.{one.output}"
    words = [output_named(output), say(MEASURES[one.measure])]
    if one.about:
        words.append(say("about {point}", point=one.about))
    if one.orders:
        words.append(say("order {orders}", orders=", ".join(f"{order:g}" for order in one.orders)))
    if one.speeds:
        speeds = ", ".join(f"{speed * RPM:.4g}" for speed in one.speeds)
        words.append(say("at {speeds} rpm", speeds=speeds))
    return say(", ").join(words)


def unit_of_measure(output: str, measure: str) -> str:
    """SI unit of a figure that is told before and after."""
    return "J" if measure == "area" else unit_of(output)


def scaled(unit: str) -> tuple[float, str]:
    """Factor and shown unit of an SI unit."""
    return SCALES.get(unit, (1.0, unit))
