"""Strokes, dead positions, time ratios and dwells: closed forms, and dense sampling."""

from __future__ import annotations

from dataclasses import replace
from math import acos, asin, degrees, hypot, pi, radians, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.mechanism.kinematics.strokes import DeadPosition, Path, _turning, longest_dwell
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment
from equipoise.results.analysis_blocks import force_blocks
from support.chosen import DISTINCT, few
from support.conformance import compared
from support.refusals import refused
from support.sources import CLOSED_FORMS
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, heavy, machine, slider_crank

MACHINES = sorted(eq.examples("linkage"))


def offset_slider_crank(offset: float, speed: float = 10.0) -> eq.Machine:
    """A crank of 0.3 m and a rod of 1 m, whose guide runs beside the pivot."""
    given = slider_crank(drive=eq.Drive("crank", speed))
    guide = replace(given.sliders[0], through="G")
    frame = {**given.frame, "G": (0.0, offset)}
    return replace(given, frame=frame, sliders=(guide,))


# -- strokes and time ratios -----------------------------------------------------------------------


@compared(
    CLOSED_FORMS, "stroke, dead positions and time ratio by triangles", 1e-12, "offset slider-crank"
)
@pytest.mark.parametrize("offset", [0.0, 0.2, -0.45])
@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_an_offset_slider_crank(offset: float, speed: float) -> None:
    """Stroke and time ratio (180 + a) / (180 - a) by the triangles at both dead positions."""
    strokes = eq.analyze(offset_slider_crank(offset, speed), 8).strokes["piston on frame"]
    crank, rod = 0.3, 1.0
    near, far = sqrt((rod - crank) ** 2 - offset**2), sqrt((rod + crank) ** 2 - offset**2)
    assert (strokes.lowest, strokes.highest) == pytest.approx((near, far), abs=1e-13)
    assert strokes.stroke == pytest.approx(far - near, abs=1e-13)
    between = abs(asin(offset / (rod - crank)) - asin(offset / (rod + crank)))
    assert strokes.time_ratio == pytest.approx((pi + between) / (pi - between), rel=1e-12)
    assert strokes.rise + strokes.fall == pytest.approx(2 * pi)
    forwards = (strokes.highest_at - strokes.lowest_at) % (2 * pi)
    assert strokes.rise == pytest.approx(forwards if speed > 0 else 2 * pi - forwards)
    assert strokes.highest_at == pytest.approx(asin(offset / (rod + crank)) % (2 * pi), abs=1e-12)


@pytest.mark.parametrize("speed", [10.0, -10.0])
@pytest.mark.parametrize("phase", [0.0, 5.5])
def test_rests_are_distinguished_from_strokes(speed: float, phase: float) -> None:
    """A lever swung by segments: 120 deg ahead, a rest of 50, 150 back, a rest of 40."""
    parts = ((120, 140), (50, 140), (150, 100), (40, 100))
    segments = tuple(AngleSegment(radians(over), radians(to)) for over, to in parts)
    law = AngleLaw(start=radians(100), segments=segments, phase=phase)
    moved = crank_rocker().with_drive(speed=speed, motion=law)
    strokes = eq.analyze(moved, 8).strokes["rocker"]
    ways = (strokes.rise, strokes.highest_rest, strokes.fall, strokes.lowest_rest)
    forth, back = (120.0, 150.0) if speed > 0 else (150.0, 120.0)
    # a law that begins smoothly stands still to rounding a little before and after its rest
    assert np.degrees(ways) == pytest.approx((forth, 50, back, 40), abs=1e-3)
    assert strokes.time_ratio == pytest.approx(150 / 120, rel=1e-5)
    assert sum(ways) == pytest.approx(2 * pi, abs=1e-12)
    begin = degrees(strokes.highest_at - phase) % 360
    assert begin == pytest.approx(120, abs=1e-3)
    assert max(position.rest for position in strokes.dead_positions) == strokes.highest_rest


@compared(CLOSED_FORMS, "strokes and time ratio by triangles", 1e-12, "quick-return")
def test_the_quick_return_of_a_shaper() -> None:
    """A lever in whose slot the crank pin runs stands at its ends square to the crank."""
    strokes = eq.analyze(eq.load("quick-return"), 8).strokes
    half = asin(80 / 200)
    ratio = (pi + 2 * half) / (pi - 2 * half)
    assert strokes["lever"].stroke == pytest.approx(2 * half, rel=1e-12)
    assert strokes["lever"].time_ratio == pytest.approx(ratio, rel=1e-12)
    ram = strokes["ram on frame"]
    assert ram.time_ratio == pytest.approx(ratio, rel=1e-12)
    assert ram.rise > ram.fall
    assert ram.stroke == pytest.approx(2 * 0.380 * 80 / 200, rel=1e-12)
    assert strokes["block on lever"].stroke == pytest.approx(2 * 0.080, rel=1e-12)
    assert strokes["block on lever"].least_advantage is None


@pytest.mark.parametrize("name", MACHINES)
def test_rockers_of_four_bars_against_their_triangles(name: str) -> None:
    analysis = eq.analyze(eq.load(name), 4)
    bar = analysis.four_bar
    if bar is None or bar.swing is None:
        return
    rocker = analysis.strokes[bar.rocker]
    assert rocker.stroke == pytest.approx(bar.swing, rel=1e-11)
    assert rocker.time_ratio == pytest.approx(bar.time_ratio, rel=1e-10)
    assert len(rocker.dead_positions) == 2


@pytest.mark.parametrize("name", few(MACHINES, DISTINCT))
def test_figures_of_every_example_against_dense_sampling(name: str) -> None:
    analysis = eq.analyze(eq.load(name), 36_000 if name != "class-three" else 3600)
    motion = analysis.motion
    for item, value in analysis.strokes.items():
        slides = value.kind == "slider"
        values = motion.sliders[item].travel if slides else motion.links[item].angle
        rate = motion.sliders[item].travel_1 if slides else motion.links[item].angle_1
        assert value.stroke == pytest.approx(np.ptp(values), rel=1e-5)
        assert value.stroke >= np.ptp(values) - 1e-12
        turns = np.count_nonzero(np.diff(np.sign(np.append(rate, rate[0]))) != 0)
        assert len(value.dead_positions) == turns or np.any(rate == 0)
        if value.least_advantage is not None:
            assert value.least_advantage == pytest.approx(1 / np.max(np.abs(rate)), rel=1e-6)
        angles = [dead.crank_angle for dead in value.dead_positions]
        there = eq.move(analysis.machine, angles)
        speeds = there.sliders[item].travel_1 if slides else there.links[item].angle_1
        np.testing.assert_allclose(speeds, 0, atol=1e-9 * np.max(np.abs(rate)))
        assert angles == sorted(angles)


def test_links_that_turn_fully_and_the_crank_have_no_stroke() -> None:
    assert "wheel" not in eq.analyze(eq.load("drag-link"), 8).strokes
    assert list(eq.analyze(crank_rocker(), 8).strokes) == ["rocker"]


def test_there_are_none_where_the_crank_cannot_turn() -> None:
    analysis = eq.analyze(four_bar(1.0, 0.9, 0.5, 0.55), [0.3])
    assert dict(analysis.strokes) == {}
    assert analysis.to_dict()["strokes"] == {}
    assert not [block for block in analysis.blocks() if "stroke" in getattr(block, "title", "")]


def test_turning_back_by_rounding_is_no_dead_position() -> None:
    angles = np.array([0.1, 2.0, 2.5, 4.0])
    result = _turning(angles, np.array([0.0, 1.0, 1.0 - 1e-14, 1.0]))
    assert [item.crank_angle for item in result] == [0.1, 4.0]
    kept = _turning(angles[::-1], np.array([1.0, 0.5, 0.9, 0.0]))
    assert kept[0] == DeadPosition(0.1, 0.0)
    assert len(kept) == 4


def test_of_equal_extremes_the_first_is_reported() -> None:
    """A slider on a wheel that turns twice as fast as the crank is twice at each end."""
    links = {"crank": heavy(A=ORIGIN), "wheel": heavy(E=ORIGIN, B=(0.1, 0.0))}
    links |= {"rod": heavy(B=ORIGIN, C=(0.4, 0.0)), "piston": heavy(C=ORIGIN)}
    strokes = eq.analyze(
        machine(
            {"A": ORIGIN, "E": (0.5, 0.0)},
            links,
            gears=(eq.Gear("crank", "wheel", ratio=-2.0),),
            sliders=(eq.Slider("piston", "C", "frame", "E", 0.0),),
            assembly={"C": "forward"},
        ),
        8,
    ).strokes["piston on frame"]
    assert len(strokes.dead_positions) == 4
    assert degrees(strokes.highest_at) == pytest.approx(0.0, abs=1e-9)
    assert degrees(strokes.lowest_at) == pytest.approx(90.0)
    assert strokes.stroke == pytest.approx(0.2)
    assert (strokes.rise, strokes.fall) == pytest.approx((pi / 2, pi / 2))
    assert strokes.time_ratio == pytest.approx(1.0)


def test_over_many_turns_neighbouring_strokes_are_compared() -> None:
    """A four-bar behind gears does the same as without, while the crank turns so much more."""
    plain = eq.analyze(crank_rocker(), 8).strokes["rocker"]
    given = crank_rocker()
    links = {**given.links, "wheel": given.links["crank"]}
    links["crank"] = heavy(E=ORIGIN)
    frame = {**given.frame, "E": (0.0, -1.0)}
    gears = (eq.Gear("crank", "wheel", teeth=(13, 20)),)
    analysis = eq.analyze(replace(given, frame=frame, links=links, gears=gears), 8)
    assert analysis.motion.turns == 20
    first, more = analysis.strokes["rocker"], 20 / 13
    assert len(first.dead_positions) == 26
    assert first.stroke == pytest.approx(plain.stroke, rel=1e-9)
    assert first.time_ratio == pytest.approx(plain.time_ratio, rel=1e-9)
    assert (first.rise, first.fall) == pytest.approx(
        (more * plain.fall, more * plain.rise), rel=1e-9
    )
    assert first.dwell == pytest.approx(more * plain.dwell, rel=1e-5)
    assert first.least_advantage == pytest.approx(more * plain.least_advantage, rel=1e-9)


# -- dwells ----------------------------------------------------------------------------------------


def of_function(place: np.ndarray, count: int = 720) -> Path:
    """A path from the amplitudes of its orders -K to K, complex."""
    orders = np.arange(len(place)) - len(place) // 2
    theta = np.arange(count) * (2 * pi / count)
    waves = np.exp(1j * np.outer(theta, orders))
    return Path(waves @ place, waves @ (1j * orders * place), waves @ (-(orders**2) * place))


def brute(theta: np.ndarray, place: np.ndarray, tolerance: float) -> float:
    """Longest part of a cycle, by going on from each sample until one is too far from another."""
    count, best, last = len(place), 0, 0
    twice = np.concatenate([place, place])
    for first in range(count):
        last = max(last, first)
        while last + 1 < first + count:
            if np.any(np.abs(twice[first : last + 1] - twice[last + 1]) > tolerance):
                break
            last += 1
        best = max(best, last - first)
    return float(best * (theta[1] - theta[0]))


def test_between_samples_a_path_is_exact() -> None:
    rng = np.random.default_rng(5)
    amplitudes = rng.normal(size=9) + 1j * rng.normal(size=9)
    path, theta = of_function(amplitudes), rng.uniform(-10, 10, 50)
    exact = np.exp(1j * np.outer(theta, np.arange(9) - 4)) @ amplitudes
    np.testing.assert_allclose(path.at(theta), exact, atol=1e-12)


@pytest.mark.parametrize("share", [1e-4, 0.01, 0.3])
def test_the_dwell_of_a_cosine(share: float) -> None:
    """About an end: 2 acos(1 - 2 share); of both ends the first in the cycle is told."""
    result = longest_dwell(of_function(np.array([0.5, 0, 0.5])), 2 * share)
    assert result.angle == pytest.approx(2 * acos(1 - 2 * share), abs=2e-6)
    assert (result.begin + result.angle / 2) % (2 * pi) == pytest.approx(pi, abs=2e-6)


def test_the_dwell_of_a_circle_is_a_chord() -> None:
    path = of_function(np.array([0, 0, 2.0 + 0j]))
    assert longest_dwell(path, 1.0).angle == pytest.approx(2 * asin(0.25), abs=1e-6)
    assert longest_dwell(path, 4.1).angle == pytest.approx(2 * pi)
    assert longest_dwell(path, 3.9999).angle < 2 * pi


@pytest.mark.parametrize("seed", range(6))
def test_dwells_of_random_paths_against_dense_sampling(seed: int) -> None:
    rng = np.random.default_rng(seed)
    amplitudes = rng.normal(size=7) + 1j * rng.normal(size=7)
    if seed % 2:  # to and fro
        amplitudes = amplitudes + amplitudes[::-1].conj()
    path, theta = of_function(amplitudes), np.arange(7200) * (2 * pi / 7200)
    size = hypot(np.ptp(path.place.real), np.ptp(path.place.imag))
    for share in (0.01, 0.1):
        angle = longest_dwell(path, share * size).angle
        assert angle == pytest.approx(brute(theta, path.at(theta), share * size), abs=2e-3)


@pytest.mark.parametrize("tolerance", [radians(0.2), radians(0.5), radians(2.0)])
def test_the_dwell_of_a_six_bar_against_dense_sampling(tolerance: float) -> None:
    """It is built to dwell: its output hardly moves over a third of a turn."""
    analysis = eq.analyze(eq.load("stephenson-six-bar"), 7200)
    angle = analysis.motion.links["output"].angle
    step = 2 * pi / 7200
    dwell = analysis.dwell("output", tolerance)
    assert dwell.angle == pytest.approx(brute(analysis.crank_angle, angle, tolerance), abs=2 * step)
    assert dwell.angle > radians(100)
    inside = (analysis.crank_angle - dwell.begin) % (2 * pi) < dwell.angle
    assert np.ptp(angle[inside]) <= tolerance * (1 + 1e-6)


def test_dwells_of_sliders_and_points() -> None:
    analysis = eq.analyze(eq.load("quick-return"), 8)
    ram = analysis.dwell("ram on frame", 0.5e-3)
    assert ram.angle == pytest.approx(analysis.dwell("F", 0.5e-3).angle, rel=1e-9)
    usual = analysis.dwell("ram on frame")
    assert usual.angle == pytest.approx(analysis.strokes["ram on frame"].dwell, rel=1e-12)
    assert usual.tolerance == pytest.approx(
        0.01 * analysis.strokes["ram on frame"].stroke, rel=1e-3
    )
    lever = analysis.dwell("lever")
    assert lever.angle == pytest.approx(analysis.strokes["lever"].dwell, abs=1e-4)
    assert list(analysis.dwells(1e-3)) == ["block on lever", "ram on frame", "E", "F"]
    assert "crank" not in analysis.dwells(0.01, "angle")


@pytest.mark.parametrize(
    ("name", "tolerance", "expected"),
    [
        ("levre", None, {"given": "levre", "name": "lever"}),
        ("lever", 0.0, {"tolerance": 0.0}),
        ("lever", float("nan"), {"by": "dwell"}),
    ],
)
def test_wrong_dwells(name: str, tolerance: float | None, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        eq.analyze(eq.load("quick-return"), 8).dwell(name, tolerance)


def test_what_rests_on_its_guide_has_no_stroke() -> None:
    machine = eq.load("four-stroke-engine")
    (slider,) = machine.sliders
    held = replace(machine, sliders=(replace(slider, on="crank"),)).with_drive(speed=31.52)
    assert not eq.analyze(held).strokes


def test_driven_links_that_swing_have_a_stroke_and_one_torque() -> None:
    """Of several drives the first too; a drive torque of the only one is told once."""
    analysis = eq.analyze(eq.load("pick-and-place"), 72)
    assert {"left crank", "right crank"} <= {*analysis.strokes}
    assert analysis.strokes["left crank"].stroke == pytest.approx(radians(50))
    alone = eq.analyze(eq.load("hydraulic-loader"), 72)
    assert alone.strokes["boom"].stroke == pytest.approx(alone.strokes["bar"].stroke)
    crank = eq.load("yamashita-1")
    machine = replace(crank, drive=replace(crank.drive, motion=AngleLaw(between=(0.5, 1.2))))
    labels = [row[0] for row in next(force_blocks(eq.analyze(machine, 72))).rows]
    assert [name for name in labels if name.startswith("drive torque")] == ["drive torque"]
