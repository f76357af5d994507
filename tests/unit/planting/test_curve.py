"""Figures of the whole curve, by many samples of it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.planting.summary import PlantingFigures, plant
from unit.planting.build import (
    EXAMPLES,
    TURN,
    Array,
    apart,
    cycle,
    planetary,
    planetary_tip,
    spinner,
    tip_at,
    twice,
)

MACHINES: dict[str, Any] = {
    **{name: lambda name=name: eq.load(name) for name in EXAMPLES},
    "speeding up": lambda: eq.load("kim-chung-a").with_drive(acceleration=150.0),
    "slowing down": lambda: eq.load("kim-chung-c").with_drive(acceleration=200.0),
    "backward": lambda: eq.load("kim-chung-c").with_planting(travel="backward"),
    "twice": twice,
}
every_machine = pytest.mark.parametrize("name", MACHINES)
WITHIN = 1e-7
"""Of 20000 samples a turn, one lies within (half a step)^2 of an extreme."""


@cache
def found(name: str) -> PlantingFigures:
    return plant(MACHINES[name]())


@cache
def sampled(name: str) -> tuple[Array, Any]:
    theta = cycle(MACHINES[name]())
    return theta, tip_at(MACHINES[name](), theta)


@every_machine
def test_size_and_length(name: str) -> None:
    figures, (_, tip) = found(name), sampled(name)
    assert figures["curve.width"] == pytest.approx(np.ptp(tip.x), rel=WITHIN)
    assert figures["curve.height"] == pytest.approx(np.ptp(tip.y), rel=WITHIN)
    assert figures["curve.length"] == pytest.approx(np.sum(np.abs(np.diff(tip.place))), rel=WITHIN)
    lift = tip.y.max() - figures["surface"]
    assert figures["curve.lift"] == pytest.approx(lift, rel=WITHIN)
    assert figures["curve.height"] == pytest.approx(
        figures["curve.lift"] + figures["soil.depth"], rel=1e-12
    )


@pytest.mark.parametrize("which", ["max", "min"])
@pytest.mark.parametrize("what", ["speed", "acceleration"])
@every_machine
def test_extremes(name: str, what: str, which: str) -> None:
    figures, (theta, tip) = found(name), sampled(name)
    part = "velocity" if what == "speed" else "acceleration_vector"
    sizes = np.abs(getattr(tip, part))
    k = int(getattr(np, f"arg{which}")(sizes))
    value, at, towards = (
        figures[f"{which}_{what}.{key}"] for key in ("value", "crank_angle", "direction")
    )
    sign = 1 if which == "max" else -1
    assert sign * (value - sizes[k]) >= -1e-12 * value
    assert value == pytest.approx(sizes[k], rel=1e-5 if which == "min" else WITHIN)
    assert apart(at, theta[k]) < TURN / 20_000
    there = getattr(tip_at(figures.machine, at), part)[0]
    assert abs(there) == pytest.approx(value, rel=1e-12)
    assert apart(np.angle(there), towards) < 1e-11


@every_machine
def test_ratios_of_angular_velocities(name: str) -> None:
    figures = found(name)
    motion = eq.move(figures.machine, sampled(name)[0])
    others = [link for link in figures.machine.links if link != "crank"]
    assert {key.split(".")[1] for key in figures.figures if key.startswith("ratio")} == {*others}
    for link in others:
        ratio = motion.links[link].angular_velocity / figures["speed"]
        for which, sample in (("min", ratio.min()), ("max", ratio.max())):
            assert figures[f"ratio.{link}.{which}"] == pytest.approx(sample, abs=WITHIN)
            there = eq.move(figures.machine, [figures[f"ratio.{link}.{which}_at"]])
            assert there.links[link].angle_1[0] == pytest.approx(
                figures[f"ratio.{link}.{which}"], rel=1e-12
            )


@every_machine
def test_transmission_angle(name: str) -> None:
    """The nearer of the extremes of the four-bar to 0 or 180 deg."""
    figures = found(name)
    bar = eq.mechanism.four_bar(figures.machine)
    assert bar is not None
    assert bar.transmission_min is not None
    assert bar.transmission_max is not None
    nearest = min(bar.transmission_min, np.pi - bar.transmission_max)
    assert figures["transmission.min"] == pytest.approx(nearest, rel=1e-12)
    line = abs(complex(*figures.machine.frame["D"]) - complex(*figures.machine.frame["A"]))
    points = eq.move(figures.machine, [figures["transmission.min_at"]]).points
    gap = abs(points["B"].place[0] - points["D"].place[0])
    assert min(abs(gap - line - bar.b), abs(gap - abs(line - bar.b))) < 1e-6 * line


def test_a_crank_alone_has_neither_ratios_nor_transmission_angle() -> None:
    figures = plant(spinner())
    assert not any(name.startswith(("ratio", "transmission")) for name in figures.figures)


def test_a_curve_of_three_turns() -> None:
    """Against the sum of two rotating arms."""
    figures = plant(planetary(depth=0.08))
    theta = np.linspace(0.0, 3 * TURN, 200_001)
    places = planetary_tip(theta)
    assert figures["curve.height"] == pytest.approx(np.ptp(places.imag), rel=1e-8)
    assert figures["curve.width"] == pytest.approx(np.ptp(places.real), rel=1e-8)
    assert figures["curve.length"] == pytest.approx(np.sum(np.abs(np.diff(places))), rel=1e-8)
    assert 0 <= figures["highest.crank_angle"] < 3 * TURN
    assert planetary_tip(np.array([figures["highest.crank_angle"]])).imag[0] == pytest.approx(
        places.imag.max(), rel=1e-8
    )


# -- curvature -------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", ["curve", "ground"])
@every_machine
def test_smallest_radius(name: str, path: str) -> None:
    """No three neighbouring samples lie on a smaller circle, and those at its place on this one."""
    figures, (theta, tip) = found(name), sampled(name)
    drive = figures["forward_speed"] / figures["speed"] if path == "ground" else 0.0
    radius = figures[f"{path}.smallest_radius.value"]
    at = figures[f"{path}.smallest_radius.crank_angle"]
    assert np.min(circles(tip.place + drive * theta)) > radius * (1 - 1e-3)
    three = at + np.array([-1e-5, 0.0, 1e-5])
    there = tip_at(figures.machine, three).place + drive * three
    assert circles(there)[0] == pytest.approx(radius, rel=1e-3)


def circles(places: Array) -> Array:
    """Radius of the circle through each three places in a row."""
    a, b, c = places[:-2], places[1:-1], places[2:]
    area = np.abs((np.conj(b - a) * (c - a)).imag)
    return np.asarray(np.abs(a - b) * np.abs(b - c) * np.abs(c - a) / (2 * area))


def test_radius_of_a_circle_and_of_a_trochoid() -> None:
    """r for a tip on the crank; over ground (r - v/w)^2 / r at the slowest instant, if v < r w."""
    for speed in (10.0, -10.0):
        figures = plant(spinner(speed))
        assert figures["curve.smallest_radius.value"] == pytest.approx(0.1, rel=1e-12)
        assert figures["ground.smallest_radius.value"] == pytest.approx(0.04**2 / 0.1, rel=1e-12)


@pytest.mark.parametrize("forward", [1.01, 1.0001, 1.00001, 0.99999, 0.9999])
def test_radius_of_a_path_that_nearly_has_a_cusp(forward: float) -> None:
    """Between two samples, the tip all but stops over ground."""
    figures = plant(spinner(at=0.3, forward_speed=forward))
    radius = (0.1 - forward / 10) ** 2 / 0.1
    assert figures["ground.smallest_radius.value"] == pytest.approx(radius, rel=1e-6)
