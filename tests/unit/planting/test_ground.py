"""Loops and cusps of the path over ground: closed forms, and lines between many samples."""

from __future__ import annotations

import tracemalloc
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import equipoise as eq
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.planting.figures import GroundPath, Loop
from equipoise.planting.summary import plant
from support.chosen import few
from unit.planting.build import Array, apart, over_ground, planetary, spinner, tip_at, twice

CROSSING: dict[str, Any] = {
    "kim-chung-a": lambda: eq.load("kim-chung-a"),
    "kim-chung-b": lambda: eq.load("kim-chung-b"),
    "kim-chung-c, slow": lambda: eq.load("kim-chung-c").with_planting(forward_speed=0.1),
    "kim-chung-c, backward": lambda: eq.load("kim-chung-c").with_planting(travel="backward"),
    "twice": lambda: twice(forward_speed=0.1),
    "three turns": planetary,
    "three turns clockwise": lambda: planetary(-20.0, forward_speed=0.2),
    "by hills": lambda: eq.load("kim-chung-b").with_planting(
        forward_speed=None, hill_spacing=0.12, units_per_turn=2
    ),
}  # fmt: skip


@cache
def path_of(name: str) -> GroundPath:
    return GroundPath(TipCurve([CROSSING[name]()]))


@cache
def loops_of(name: str) -> tuple[Loop, ...]:
    return path_of(name).loops()


def passes(name: str, count: int) -> tuple[Array, Array]:
    """Ways over two cycles, counted as time goes on, and places over ground."""
    path = path_of(name)
    way = np.linspace(0.0, 2 * path.curve.period, 2 * count + 1)
    machine = path.curve.machines[0]
    assert machine.planting is not None
    drive = machine.planting.forward(machine.drive.speed) / abs(machine.drive.speed)
    place = tip_at(machine, np.sign(machine.drive.speed) * way).place + drive * way
    return way, place


@pytest.mark.exhaustive(but=["three turns clockwise", "kim-chung-c, backward", "twice", "by hills"])
@pytest.mark.parametrize("name", CROSSING)
def test_every_crossing_by_lines_between_samples(name: str) -> None:
    """Each two of 700 lines a turn, the first in the first cycle and less than a cycle apart."""
    count = 700 * path_of(name).curve.turns
    way, place = passes(name, count)
    a, b = place[:-1], place[1:]
    actual = []
    for i in range(count):
        c, d = a[i + 2 : i + count], b[i + 2 : i + count]
        sides = [(np.conj(b[i] - a[i]) * (p - a[i])).imag > 0 for p in (c, d)]
        other = [(np.conj(d - c) * (p - c)).imag > 0 for p in (a[i], b[i])]
        hit = np.flatnonzero((sides[0] != sides[1]) & (other[0] != other[1]))
        actual += [(way[i], way[i + 2 + k]) for k in hit]
    loops = loops_of(name)
    assert len(loops) == len(actual)
    sense, period = path_of(name).sense, path_of(name).curve.period
    for loop, (first, second) in zip(loops, sorted(actual), strict=True):
        assert apart_in(period, loop.first, sense * first) < 0.02
        assert apart_in(period, loop.second, sense * second) < 0.02
        assert loop.way == pytest.approx(second - first, abs=0.03)


def apart_in(period: float, a: float, b: float) -> float:
    return float(abs((a - b + period / 2) % period - period / 2))


def test_some_paths_cross_themselves_often() -> None:
    counts = [len(loops_of(name)) for name in CROSSING]
    assert min(counts) == 1
    assert max(counts) > 3


@pytest.mark.parametrize("name", CROSSING)
def test_a_loop_comes_back_to_its_place(name: str) -> None:
    path = path_of(name)
    machine = path.curve.machines[0]
    drive = path.drive
    for loop in loops_of(name):
        assert 0 <= loop.first < path.curve.period
        way = path.sense * loop.first % path.curve.period + np.linspace(0.0, loop.way, 20_001)
        place = tip_at(machine, path.sense * way).place + drive * way
        assert abs(place[-1] - place[0]) < 1e-13
        assert loop.y == pytest.approx(place[0].imag, abs=1e-13)
        assert loop.height == pytest.approx(np.ptp(place.imag), rel=1e-6)
        assert loop.width == pytest.approx(np.ptp(place.real), rel=1e-6)
        area = np.sum(np.conj(place[:-1] - place[0]) * np.diff(place)).imag / 2
        assert loop.area == pytest.approx(abs(area), rel=1e-6)
        assert loop.in_soil == (loop.y < path.curve.surface[0])


@pytest.mark.parametrize("speed", [10.0, -10.0])
@pytest.mark.parametrize("at", few([0.0, 0.3], {0.3}))
@pytest.mark.parametrize("forward", [0.3, 0.6, 0.9, 0.99, 0.999])
def test_loop_of_a_trochoid(forward: float, at: float, speed: float) -> None:
    """Half the way s between the passes solves sin s = k s, k = v / (r omega); r = 0.1 m.

    Down to k = 0.25 there is one loop a turn, about the slowest place: y = +-r cos s at the
    crossing, and r (1 - cos s) high.
    """
    path = GroundPath(TipCurve([spinner(speed, at=at, forward_speed=forward)]))
    (loop,) = path.loops()
    half = brentq(lambda s: np.sin(s) / s - forward, 1e-9, np.pi, xtol=1e-15)
    side = np.sign(speed)
    assert loop.way == pytest.approx(2 * half, abs=1e-9)
    middle = loop.first + side * half
    assert apart(middle, side * np.pi / 2 - at) < 1e-9
    assert loop.y == pytest.approx(side * 0.1 * np.cos(half), abs=1e-12)
    assert loop.height == pytest.approx(0.1 * (1 - np.cos(half)), rel=1e-7)
    widest = np.arccos(forward)
    assert loop.width == pytest.approx(0.2 * (np.sin(widest) - forward * widest), rel=1e-6)
    area = half + np.sin(half) * np.cos(half) - 2 * np.sin(half) ** 2 / half
    assert loop.area == pytest.approx(0.01 * area, rel=1e-6)


@pytest.mark.parametrize("speed", [10.0, -10.0])
@pytest.mark.parametrize("at", few([0.0, 0.3, 1.0, -2.0], {0.3, -2.0}))
@pytest.mark.parametrize("travel", ["forward", "backward"])
def test_a_cusp_is_no_loop(travel: Any, at: float, speed: float) -> None:
    """At v = r omega the tip stands still once a turn, wherever the crank angle counts from."""
    machine = spinner(speed, at=at, forward_speed=1.0, travel=travel)
    path = GroundPath(TipCurve([machine]))
    (cusp,) = path.cusps()
    top = np.pi / 2 if (travel == "forward") == (speed > 0) else -np.pi / 2
    assert apart(cusp, top - at) < 1e-7
    assert path.loops() == ()


@pytest.mark.parametrize("forward", [1.001, 1.5])
def test_a_slow_tip_neither_loops_nor_stops(forward: float) -> None:
    path = GroundPath(TipCurve([spinner(at=0.3, forward_speed=forward)]))
    assert path.loops() == ()
    assert path.cusps() == ()


# Crossings of fewer turns: `test_every_crossing_by_lines_between_samples`.
@pytest.mark.exhaustive
def test_a_path_that_crosses_itself_often_is_followed_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A slow machine with a cycle of many turns; not each crossing by itself, which takes long."""
    path = GroundPath(TipCurve([planetary(teeth=29, forward_speed=0.05)]))
    calls = []
    at = TipCurve.at

    def counted(curve: TipCurve, theta: Array) -> Any:
        calls.append(theta.size)
        return at(curve, theta)

    monkeypatch.setattr(TipCurve, "at", counted)
    loops = path.loops()
    assert len(loops) > 500
    assert len(calls) < len(loops)
    first, way = np.array([[loop.first, loop.way] for loop in loops]).T
    ends = path.place(np.stack([first, first + way], axis=-1))
    np.testing.assert_allclose(ends[:, 0], ends[:, 1], atol=1e-12)
    assert len({*zip(first.round(8), way.round(8), strict=True)}) == len(loops)


def test_a_machine_at_rest_has_no_path_over_ground() -> None:
    path = GroundPath(TipCurve([eq.load("kim-chung-b").with_planting(forward_speed=0.0)]))
    assert path.loops() == ()
    assert path.cusps() == ()


def test_a_crossing_below_the_surface_is_in_the_soil() -> None:
    """The spinner's path crosses itself at y = -8.9 mm."""
    for surface, below in ((-0.005, True), (-0.015, False)):
        machine = spinner(depth=None, surface=surface)
        (loop,) = GroundPath(TipCurve([machine])).loops()
        assert loop.in_soil is below


def test_memory_grows_with_the_slow_places_and_not_with_their_square() -> None:
    """A tip that circles has thousands where the machine rests and its cycle takes many turns."""
    path = GroundPath(TipCurve([eq.load("kim-chung-a")]))
    path.slow = np.linspace(0.0, 6.28, 300)
    tracemalloc.start()
    path.breaks(1.0, 2.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 300 * 3 * 30 * 8 * 10


def test_paths_over_ground_begin_where_the_machine_is_at_crank_angle_0() -> None:
    figures = plant(eq.load("kim-chung-b"))
    path = GroundPath(figures.curve)
    way = np.array([0.0, 1.0, 7.0])
    wanted = over_ground(figures, path.sense * way)
    np.testing.assert_allclose(path.place(way[None])[0], wanted, atol=1e-14)
