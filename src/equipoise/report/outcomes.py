"""The summary of what a linkage does to its support and in the field, in plain words."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from equipoise.i18n import say
from equipoise.report.findings import Findings
from equipoise.report.numbers import PER_RPM, angle, brief
from equipoise.results.naming import scaled


def vibration_told(found: Findings) -> Iterator[str]:
    """What the gauges read, and the nearest resonance."""
    response = found.response
    if response is None:
        return
    for name, gauge in response.gauges.items():
        scale, unit = scaled("rad" if gauge.rotation else "m")
        yield say(
            "The gauge {gauge} moves by {size} {unit} peak to peak at {speed} rpm.",
            gauge=name,
            size=brief(float(gauge.displacement.peak_to_peak) * scale),
            unit=unit,
            speed=brief(abs(response.speed) / PER_RPM),
        )
    if found.sweep is None or not found.sweep.resonances:
        return
    nearest = min(found.sweep.resonances, key=lambda one: abs(abs(one.speed / response.speed) - 1))
    told = {
        "order": f"{nearest.order:.4g}",
        "mode": nearest.mode,
        "frequency": brief(nearest.frequency / (2 * pi)),
        "speed": brief(abs(nearest.speed) / PER_RPM),
    }
    yield say(
        "The nearest resonance is at {speed} rpm, where order {order} meets mode {mode} "
        "({frequency} Hz).",
        **told,
    )
    if nearest.avoid is not None and _within(abs(response.speed), nearest.avoid):
        low, high = sorted(abs(end) / PER_RPM for end in nearest.avoid)
        yield say(
            "The crank turns at a speed that is to be avoided: between {low} and {high} rpm this "
            "resonance amplifies more than three times.",
            low=brief(low),
            high=brief(high),
        )


def _within(value: float, ends: tuple[float, float]) -> bool:
    low, high = sorted(map(abs, ends))
    return low <= value <= high


def planting_told(found: Findings) -> Iterator[str]:
    """Depth, entry and exit, hills, speed of the tip."""
    if found.planting is None:
        return
    get = found.planting.figures.get

    def told(name: str, scale: float = 1.0) -> str:
        return brief((get(name) or 0.0) * scale)

    yield say(
        "The tip of the finger goes {depth} mm into the soil; it enters at a crank angle of "
        "{entry}° and leaves at {exit}°.",
        depth=told("soil.depth", 1e3),
        entry=angle(get("entry.crank_angle") or 0.0),
        exit=angle(get("exit.crank_angle") or 0.0),
    )
    if get("hill_spacing"):
        yield say(
            "Hills are {spacing} mm apart; the hole at the surface is {hole} mm long.",
            spacing=told("hill_spacing", 1e3),
            hole=told("soil.hole_length", 1e3),
        )
    yield say(
        "The tip moves at up to {speed} m/s relative to the machine.",
        speed=told("max_speed.value"),
    )
