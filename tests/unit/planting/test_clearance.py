"""How close links come to soil and tray, against 20000 crank angles a turn."""

from __future__ import annotations

from functools import cache
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.tip import TipCurve, surface_of
from equipoise.planting.figures import clearances, distance
from equipoise.planting.stroke import soil_crossings
from unit.planting.build import Array, block, cycle, planetary, spinner, twice

MACHINES: dict[str, Any] = {
    "kim-chung-a": lambda: eq.load("kim-chung-a").with_planting(tray=((0.05, 0.03), (0.01, 0.0))),
    "kim-chung-b": lambda: eq.load("kim-chung-b").with_planting(tray=((-0.16, 0.05), (-0.15, 0.1))),
    "kim-chung-c": lambda: eq.load("kim-chung-c").with_planting(tray=((0.1, 0.1), (0.2, 0.1))),
    "deep": lambda: eq.load("kim-chung-a").with_planting(depth=0.15, tray=((0.3, 0.1), (0.2, 0.2))),
    "twice": lambda: twice(tray=((0.2, 0.0), (0.2, 0.1))),
    "three turns": lambda: planetary(tray=((0.11, 0.0), (0.12, 0.0))),
    "spinner": lambda: spinner(tray=((0.05, 0.1), (-0.1, 0.02))),
}  # fmt: skip
every_machine = pytest.mark.parametrize("name", MACHINES)


@cache
def curve_of(name: str) -> TipCurve:
    return TipCurve([MACHINES[name]()])


class Clearance(NamedTuple):
    value: float
    crank_angle: float


def clearances_from(ground: str, curve: TipCurve) -> dict[str, Clearance]:
    """Body -> its clearance from the soil or the tray."""
    found = clearances(curve, soil_crossings(curve)[0])
    begin, end = f"clearance.{ground}.", ".value"
    bodies = [
        name[len(begin) : -len(end)]
        for name in found
        if name.startswith(begin) and name.endswith(end)
    ]
    return {
        body: Clearance(*(float(found[f"{begin}{body}.{key}"][0]) for key in Clearance._fields))
        for body in bodies
    }


def soil_clearances(curve: TipCurve) -> dict[str, Clearance]:
    return clearances_from("soil", curve)


def tray_clearances(curve: TipCurve) -> dict[str, Clearance]:
    return clearances_from("tray", curve)


def outline(machine: eq.Machine, link: str) -> list[str]:
    """Points of a link but the tip."""
    assert machine.planting is not None
    return [point for point in machine.links[link].points if point != machine.planting.tip]


def near(found: Clearance, samples: Array, value_at: Any) -> None:
    """Compare with samples: none is smaller, and the crank angle told has the value told."""
    step = np.max(np.abs(np.diff(samples)))
    assert found.value - 1e-13 <= samples.min() <= found.value + step
    assert value_at(np.array([found.crank_angle]))[0] == pytest.approx(found.value, abs=1e-13)


@every_machine
def test_clearance_above_the_soil(name: str) -> None:
    machine = MACHINES[name]()
    theta = np.sort(np.abs(cycle(machine)))
    found = soil_clearances(curve_of(name))
    assert list(found) == [link for link in machine.links if outline(machine, link)]
    for link, clearance in found.items():

        def height(angles: Array, link: str = link) -> Any:
            points = eq.move(machine, angles).points
            lowest = np.min([points[point].y for point in outline(machine, link)], axis=0)
            return lowest - surface_of(machine)

        near(clearance, height(theta), height)


@every_machine
def test_clearance_from_the_tray(name: str) -> None:
    machine = MACHINES[name]()
    assert machine.planting is not None
    assert machine.planting.tray is not None
    start, stop = (complex(*end) for end in machine.planting.tray)
    theta = np.sort(np.abs(cycle(machine)))
    found = tray_clearances(curve_of(name))
    bodies = {link: outline(machine, link) for link in machine.links}
    bodies["tip P"] = ["P"]
    assert list(found) == [body for body, points in bodies.items() if points]
    for body, clearance in found.items():

        def gap(angles: Array, body: str = body) -> Any:
            motion = eq.move(machine, angles).points
            places = [motion[point].place for point in bodies[body]]
            lines = [*combinations(places, 2)] or [(places[0], places[0])]
            return np.min([between(a, b, start, stop) for a, b in lines], axis=0)

        near(clearance, gap(theta), gap)


def between(a: Array, b: Array, c: complex, d: complex) -> Array:
    """Distance of lines by another way: the closest of both lines' parameters, one by one.

    The distance is convex in both shares, so that its least value over the square lies where both
    slopes vanish or on one of the four sides, where one share is 0 or 1 and the other follows.
    """
    u, v, w = b - a, d - c, a - c
    gaps = []
    for share in (0.0, 1.0):
        gaps.append(np.abs(w + share * u - clipped(w + share * u, v) * v))
        gaps.append(np.abs(w - share * v + clipped(share * v - w, u) * u))
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = (np.conj(u) * v).imag
        s, t = (np.conj(v) * w).imag / turned, (np.conj(u) * w).imag / turned
    inside = (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return np.asarray(np.where(inside, 0.0, np.min(gaps, axis=0)))


def clipped(point: Any, along: Any) -> Any:
    """Share of a line from 0 along a vector that is closest to a point."""
    square = np.maximum(np.abs(along) ** 2, 1e-300)
    return np.clip((np.conj(along) * point).real / square, 0.0, 1.0)


def test_trays_are_met_and_missed() -> None:
    values = [
        found.value for name in MACHINES for found in tray_clearances(curve_of(name)).values()
    ]
    assert min(values) == 0.0
    assert max(values) > 0.05
    depths = [
        found.value for name in MACHINES for found in soil_clearances(curve_of(name)).values()
    ]
    assert min(depths) < 0 < max(depths)


def test_without_a_tray_there_is_no_clearance_from_it() -> None:
    assert tray_clearances(TipCurve([eq.load("kim-chung-a")])) == {}


def test_a_link_of_which_only_the_tip_is_known_is_left_out() -> None:
    assert list(soil_clearances(TipCurve([block()]))) == ["crank", "rod"]


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ((-1 + 1j, 1 + 1j), 1.0),
        ((3 + 4j, 5 + 9j), np.hypot(2, 4)),
        ((-1 - 1j, 1 + 1j), 0.0),
        ((2 + 0j, 3 + 0j), 1.0),
        ((0.5 + 0j, 3 + 0j), 0.0),
        ((0.5 + 2j, 0.5 + 0.25j), 0.25),
        ((0.5 + 2j, 0.5 + 2j), 2.0),
    ],
)
def test_distance_of_two_lines(line: tuple[complex, complex], wanted: float) -> None:
    """From the line from -1 to 1."""
    one, other = (np.array([end]) for end in line)
    assert distance(one, other, -1 + 0j, 1 + 0j)[0] == pytest.approx(wanted, abs=1e-15)
    assert distance(other, one, 1 + 0j, -1 + 0j)[0] == pytest.approx(wanted, abs=1e-15)
