"""Figures of the tip: of the whole curve, of the stay in the soil, and clearances."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.kinematics.tip import TipCurve, surface_of
from equipoise.planting.figures import clearances, tip_figures
from equipoise.planting.names import TURNING, dimension_of
from equipoise.planting.stroke import distance, soil_crossings
from equipoise.planting.summary import PlantingFigures, plant
from support.chosen import few
from unit.planting.build import (
    EXAMPLES,
    TURN,
    Array,
    apart,
    block,
    cycle,
    over_ground,
    planetary,
    planetary_tip,
    spinner,
    tip_at,
    twice,
)

NAMES = ("kim-chung-a", "kim-chung-b")
LENGTHS = {"soil.path_length_ground", "soil.path_length_machine"}
"""Sums over other panels: the designs' are equally long."""
SAMPLED = {"soil.max_acceleration.crank_angle"}
"""Found by ever closer samples, whose largest lies on a flat top."""


@cache
def designs(name: str) -> tuple[eq.Machine, ...]:
    """The machine and three with other lengths, another tip, sense, depth and forward speed."""
    machine = eq.load(name).with_planting(
        tray=((-0.3, -0.01), (0.3, 0.0)), acceleration_limit=90.0, soil_acceleration_limit=60.0
    )
    points = machine.links["coupler"].points
    x, y = points["P"]
    longer = machine.with_link("coupler", points={**points, "P": (1.02 * x, 0.97 * y)})
    reverse = longer.with_drive(speed=-20.0).with_planting(depth=0.025)
    a, d = machine.frame["A"], machine.frame["D"]
    shifted = replace(machine, frame={"A": a, "D": (d[0] + 0.001, d[1] - 0.002)})
    return machine, longer, reverse, shifted.with_planting(forward_speed=0.9)


@cache
def alone(name: str) -> list[PlantingFigures]:
    return [plant(machine) for machine in designs(name)]


def stack(name: str, wanted: Any = None) -> dict[str, Any]:
    curve = TipCurve(designs(name))
    return tip_figures(curve, *soil_crossings(curve), wanted=wanted)


@pytest.mark.exhaustive(but=["kim-chung-a"])
@pytest.mark.parametrize("name", NAMES)
def test_a_stack_of_designs_has_the_figures_of_each(name: str) -> None:
    result = stack(name)
    own = {"speed", "forward_speed", "hill_spacing", "planting_frequency"}
    assert set(result) == set(alone(name)[0].figures) - own
    for key, values in result.items():
        assert values.shape == (4,)
        for value, single in zip(values, alone(name), strict=True):
            if key.split(".")[-1] in TURNING:
                assert apart(value, single[key]) < (1e-6 if key in SAMPLED else 1e-11), key
                continue
            size = ".".join([*key.split(".")[:-1], "size"])
            scale = abs(single.figures.get(size, single[key])) + 1e-3
            assert abs(value - single[key]) < (1e-8 if key in LENGTHS else 1e-11) * scale, key


@pytest.mark.parametrize("name", NAMES)
def test_soil_crossings_are_entry_and_exit_of_the_deepest_stay(name: str) -> None:
    curve = TipCurve(designs(name))
    entry, leave = soil_crossings(curve)
    sense = np.sign(curve.speed[:, 0])
    assert np.all(sense * (leave - entry) > 0)
    for k, single in enumerate(alone(name)):
        assert apart(entry[k], single["entry.crank_angle"]) < 1e-13
        assert apart(leave[k], single["exit.crank_angle"]) < 1e-13
        assert abs(leave[k] - entry[k]) == pytest.approx(single["soil.crank_travel"], abs=1e-12)


# A tray that is missed: `test_trays_are_met_and_missed`.
@pytest.mark.exhaustive
def test_designs_that_do_not_enter_or_leave_have_no_crossings() -> None:
    """By a surface that the first tip never reaches, and the second, 0.3 m lower, never leaves."""
    machine = eq.load("kim-chung-a").with_planting(depth=None, surface=-0.2)
    points = machine.links["coupler"].points
    low = replace(machine, frame={k: (x, y - 0.5) for k, (x, y) in machine.frame.items()})
    good = replace(machine, frame={k: (x, y - 0.1) for k, (x, y) in machine.frame.items()})
    assert points["P"] == low.links["coupler"].points["P"]
    curve = TipCurve([machine, low, good])
    entry, leave = soil_crossings(curve)
    assert np.isnan(entry[:2]).all()
    assert np.isnan(leave[:2]).all()
    assert apart(entry[2], plant(good)["entry.crank_angle"]) < 1e-13
    figures = tip_figures(curve, entry, leave)
    assert np.isfinite(figures["curve.height"]).all()
    assert np.isnan(figures["entry.x"][:2]).all()
    assert figures["soil.crank_travel"][2] == pytest.approx(plant(good)["soil.crank_travel"])


BOTH = ("curve", "curve.smallest_radius")


@pytest.mark.exhaustive(but=["wanted1", "wanted3"])
@pytest.mark.parametrize("wanted", [BOTH, ("entry", "limits"), ("ratio", "soil"), ()])
def test_only_what_is_wanted(wanted: tuple[str, ...]) -> None:
    everything, some = stack("kim-chung-a"), stack("kim-chung-a", wanted)
    assert {name.split(".")[0] for name in some} == {item.split(".")[0] for item in wanted}
    assert some.keys() == {name for name in everything if name.split(".")[0] in wanted}
    for name, values in some.items():
        np.testing.assert_array_equal(values, everything[name])
    assert not any("radius" in name for name in stack("kim-chung-a", BOTH[:1]))


# -- kinds of quantities ---------------------------------------------------------------------------

KINDS = {
    "curve.height": "length",
    "curve.smallest_radius.value": "length",
    "curve.smallest_radius.crank_angle": "angle",
    "ground.smallest_radius.value": "length",
    "surface": "length",
    "hill_spacing": "length",
    "forward_speed": "speed",
    "speed": "angular speed",
    "lowest.x": "length",
    "lowest.crank_angle": "angle",
    "lowest.attitude": "angle",
    "entry.velocity.x": "speed",
    "entry.velocity.direction": "angle",
    "exit.ground_velocity.size": "speed",
    "exit.acceleration.y": "acceleration",
    "max_speed.value": "speed",
    "min_acceleration.value": "acceleration",
    "min_acceleration.direction": "angle",
    "ratio.coupler.min": None,
    "ratio.coupler.min_at": "angle",
    "transmission.min": "angle",
    "transmission.min_at": "angle",
    "soil.depth": "length",
    "soil.crank_travel": "angle",
    "soil.time": "time",
    "soil.hole_length": "length",
    "soil.max_acceleration.value": "acceleration",
    "limits.acceleration.limit": "acceleration",
    "limits.soil_acceleration.highest_speed": "angular speed",
}


@pytest.mark.parametrize(("name", "kind"), [*KINDS.items()])
def test_a_name_reports_the_kind_of_quantity(name: str, kind: str | None) -> None:
    assert dimension_of(name) == kind
    assert name in alone("kim-chung-a")[0].figures


SAMPLES = 20_001
"""Sums over chords and largest samples are right to the square of a step: some 1e-8."""
MACHINES: dict[str, Any] = {
    **{name: lambda name=name: eq.load(name) for name in EXAMPLES},
    "backward": lambda: eq.load("kim-chung-b").with_planting(travel="backward", finger_from="C"),
    "speeding up": lambda: eq.load("kim-chung-a").with_drive(acceleration=150.0),
    "twice": twice,
    "three turns": lambda: planetary(-20.0, depth=0.05),
    "spinner": lambda: spinner(depth=0.06),
}
every_machine = pytest.mark.parametrize("name", MACHINES)


@cache
def figures_of(name: str) -> PlantingFigures:
    return plant(MACHINES[name]())


def stay(figures: PlantingFigures) -> Array:
    """Crank angles from entry to exit, running on in the sense of the drive."""
    entry, sense = figures["entry.crank_angle"], np.sign(figures["speed"])
    travel = sense * (figures["exit.crank_angle"] - entry) % figures.curve.period
    return entry + sense * np.linspace(0.0, travel, SAMPLES)


@pytest.mark.exhaustive(but=["three turns", "backward", "kim-chung-a", "spinner"])
@every_machine
def test_travel_time_and_depth(name: str) -> None:
    figures, theta = figures_of(name), stay(figures_of(name))
    travel = abs(theta[-1] - theta[0])
    assert figures["soil.crank_travel"] == pytest.approx(travel, abs=1e-12)
    assert figures["soil.time"] == pytest.approx(travel / abs(figures["speed"]), rel=1e-12)
    lowest = tip_at(figures.machine, theta).y.min()
    assert figures["soil.depth"] == pytest.approx(figures["surface"] - lowest, abs=1e-8)


@every_machine
def test_lengths_by_chords(name: str) -> None:
    figures, theta = figures_of(name), stay(figures_of(name))
    machine = np.sum(np.abs(np.diff(tip_at(figures.machine, theta).place)))
    ground = over_ground(figures, theta)
    assert figures["soil.path_length_machine"] == pytest.approx(machine, rel=1e-7)
    assert figures["soil.path_length_ground"] == pytest.approx(
        np.sum(np.abs(np.diff(ground))), rel=1e-7
    )
    advance = (ground[-1] - ground[0]).real
    assert figures["soil.ground_advance"] == pytest.approx(advance, abs=1e-13)
    assert figures["soil.ground_distance"] == abs(figures["soil.ground_advance"])


@every_machine
def test_largest_acceleration_by_sampling(name: str) -> None:
    figures, theta = figures_of(name), stay(figures_of(name))
    sizes = np.abs(tip_at(figures.machine, theta).acceleration_vector)
    assert sizes.max() * (1 - 1e-12) <= figures["soil.max_acceleration.value"]
    assert figures["soil.max_acceleration.value"] == pytest.approx(sizes.max(), rel=1e-7)
    if name != "spinner":  # whose acceleration is the same everywhere
        at = figures["soil.max_acceleration.crank_angle"]
        assert apart(at, theta[np.argmax(sizes)]) < 1e-3
        assert abs(tip_at(figures.machine, at).acceleration_vector[0]) == pytest.approx(sizes.max())


def test_the_largest_acceleration_may_lie_where_the_tip_leaves() -> None:
    figures = figures_of("twice")
    leaving = figures["exit.acceleration.size"]
    assert figures["soil.max_acceleration.value"] == pytest.approx(leaving, rel=1e-12)
    assert leaving < figures["max_acceleration.value"] / 1.5


# -- the hole --------------------------------------------------------------------------------------


def cuts(figures: PlantingFigures, base: str) -> Array:
    """Places over ground at which the finger cuts the surface, while its foot is above."""
    theta = stay(figures)
    foot = eq.move(figures.machine, theta).points[base].place
    tip, level = tip_at(figures.machine, theta).place, figures["surface"]
    share = (level - tip.imag) / (foot.imag - tip.imag)
    x = over_ground(figures, theta).real + share * (foot - tip).real
    return np.asarray(x[foot.imag >= level])


@pytest.mark.exhaustive(but=["kim-chung-a-C", "kim-chung-b-B"])
@pytest.mark.parametrize("finger_from", ["B", "C"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_hole_by_sampling(name: str, finger_from: str) -> None:
    machine = eq.load(name).with_planting(finger_from=finger_from)
    figures = plant(machine)
    places = cuts(figures, finger_from)
    assert len(places) == SAMPLES
    assert figures["soil.hole_length"] == pytest.approx(np.ptp(places), rel=1e-7)
    assert figures["soil.hole_length"] >= np.ptp(places) * (1 - 1e-12)


def test_hole_of_a_finger_that_goes_all_below() -> None:
    """Its foot is 20 mm from the tip and 40 mm deep: the cut ends at a jump."""
    machine = eq.load("kim-chung-a")
    points = machine.links["coupler"].points
    up = np.array(points["B"]) - points["P"]
    near = np.array(points["P"]) + 0.02 * up / np.hypot(*up)
    machine = machine.with_link("coupler", points={**points, "K": tuple(map(float, near))})
    figures = plant(machine.with_planting(finger_from="K"))
    places = cuts(figures, "K")
    assert 1000 < len(places) < SAMPLES - 1000
    assert figures["soil.hole_length"] == pytest.approx(np.ptp(places), abs=3e-5)


def test_a_machine_at_rest_has_no_ground_figures_of_the_stay() -> None:
    moving, resting = figures_of("kim-chung-a"), plant(MACHINES["kim-chung-a"]().with_planting(
        forward_speed=0.0))  # fmt: skip
    missing = set(moving.figures) - set(resting.figures)
    assert {f"soil.{key}" for key in ("path_length_ground", "ground_advance", "ground_distance",
                                      "hole_length")} <= missing  # fmt: skip
    for key in ("crank_travel", "time", "depth", "path_length_machine", "max_acceleration.value"):
        assert resting[f"soil.{key}"] == pytest.approx(moving[f"soil.{key}"], rel=1e-13)


# -- limits ----------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["three turns--1"])
@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("name", few(["kim-chung-a", "twice", "three turns"], {"three turns"}))
def test_at_the_highest_speed_the_limit_is_just_met(name: str, sense: int) -> None:
    """One way round all of the path is held to its limit, the other way the stay in the soil."""
    limits = {"acceleration_limit": 80.0, "soil_acceleration_limit": 30.0}
    machine = MACHINES[name]().with_planting(**limits)
    limit, largest = {
        1: ("acceleration", "max_acceleration.value"),
        -1: ("soil_acceleration", "soil.max_acceleration.value"),
    }[sense]
    figures, wanted = plant(machine), limits[f"{limit}_limit"]
    assert figures[f"limits.{limit}.limit"] == wanted
    highest = figures[f"limits.{limit}.highest_speed"]
    assert plant(machine, speed=sense * highest)[largest] == pytest.approx(wanted, rel=1e-9)


def test_limits_leave_the_acceleration_of_the_drive_aside() -> None:
    machine = eq.load("kim-chung-a").with_planting(acceleration_limit=80.0)
    steady, rising = (plant(machine.with_drive(acceleration=a)) for a in (0.0, 150.0))
    name = "limits.acceleration.highest_speed"
    assert rising[name] == steady[name]
    assert rising["max_acceleration.value"] != steady["max_acceleration.value"]


def test_without_limits_there_are_none() -> None:
    assert not any(name.startswith("limits") for name in figures_of("kim-chung-a").figures)
    only = plant(eq.load("kim-chung-a").with_planting(soil_acceleration_limit=30.0))
    assert {name for name in only.figures if name.startswith("limits")} == {
        "limits.soil_acceleration.limit",
        "limits.soil_acceleration.highest_speed",
        "limits.soil_acceleration.highest_forward_speed",
    }


def test_a_limit_of_one_g_on_the_crank() -> None:
    """r omega^2 = g."""
    figures = plant(spinner(acceleration_limit=9.80665))
    highest = figures["limits.acceleration.highest_speed"]
    assert highest == pytest.approx(np.sqrt(98.0665), rel=1e-12)


FIELDS: dict[str, Any] = {
    "kim-chung-a": lambda: eq.load("kim-chung-a").with_planting(tray=((0.05, 0.03), (0.01, 0.0))),
    "kim-chung-b": lambda: eq.load("kim-chung-b").with_planting(tray=((-0.16, 0.05), (-0.15, 0.1))),
    "kim-chung-c": lambda: eq.load("kim-chung-c").with_planting(tray=((0.1, 0.1), (0.2, 0.1))),
    "deep": lambda: eq.load("kim-chung-a").with_planting(depth=0.15, tray=((0.3, 0.1), (0.2, 0.2))),
    "twice": lambda: twice(tray=((0.2, 0.0), (0.2, 0.1))),
    "three turns": lambda: planetary(tray=((0.11, 0.0), (0.12, 0.0))),
    "spinner": lambda: spinner(tray=((0.05, 0.1), (-0.1, 0.02))),
}  # fmt: skip
every_field = pytest.mark.parametrize("name", FIELDS)


@cache
def curve_of(name: str) -> TipCurve:
    return TipCurve([FIELDS[name]()])


class Clearance(NamedTuple):
    value: float
    crank_angle: float


def clearances_from(ground: str, curve: TipCurve) -> dict[str, Clearance]:
    """Body -> its clearance from the soil or the tray."""
    result = clearances(curve, soil_crossings(curve)[0])
    begin, end = f"clearance.{ground}.", ".value"
    bodies = [
        name[len(begin) : -len(end)]
        for name in result
        if name.startswith(begin) and name.endswith(end)
    ]
    return {
        body: Clearance(*(float(result[f"{begin}{body}.{key}"][0]) for key in Clearance._fields))
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


def near(result: Clearance, samples: Array, value_at: Any) -> None:
    """Compare with samples: none is smaller, and the crank angle told has the value told."""
    step = np.max(np.abs(np.diff(samples)))
    assert result.value - 1e-13 <= samples.min() <= result.value + step
    assert value_at(np.array([result.crank_angle]))[0] == pytest.approx(result.value, abs=1e-13)


@every_field
def test_clearance_above_the_soil(name: str) -> None:
    machine = FIELDS[name]()
    theta = np.sort(np.abs(cycle(machine)))
    result = soil_clearances(curve_of(name))
    assert list(result) == [link for link in machine.links if outline(machine, link)]
    for link, clearance in result.items():

        def height(angles: Array, link: str = link) -> Any:
            points = eq.move(machine, angles).points
            lowest = np.min([points[point].y for point in outline(machine, link)], axis=0)
            return lowest - surface_of(machine)

        near(clearance, height(theta), height)


@every_field
def test_clearance_from_the_tray(name: str) -> None:
    machine = FIELDS[name]()
    assert machine.planting is not None
    assert machine.planting.tray is not None
    start, stop = (complex(*end) for end in machine.planting.tray)
    theta = np.sort(np.abs(cycle(machine)))
    result = tray_clearances(curve_of(name))
    bodies = {link: outline(machine, link) for link in machine.links}
    bodies["tip P"] = ["P"]
    assert list(result) == [body for body, points in bodies.items() if points]
    for body, clearance in result.items():

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
        result.value for name in FIELDS for result in tray_clearances(curve_of(name)).values()
    ]
    assert min(values) == 0.0
    assert max(values) > 0.05
    depths = [
        result.value for name in FIELDS for result in soil_clearances(curve_of(name)).values()
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
    first, other = (np.array([end]) for end in line)
    assert distance(first, other, -1 + 0j, 1 + 0j)[0] == pytest.approx(wanted, abs=1e-15)
    assert distance(other, first, 1 + 0j, -1 + 0j)[0] == pytest.approx(wanted, abs=1e-15)


CURVES: dict[str, Any] = {
    **{name: lambda name=name: eq.load(name) for name in EXAMPLES},
    "speeding up": lambda: eq.load("kim-chung-a").with_drive(acceleration=150.0),
    "slowing down": lambda: eq.load("kim-chung-c").with_drive(acceleration=200.0),
    "backward": lambda: eq.load("kim-chung-c").with_planting(travel="backward"),
    "twice": twice,
}
every_curve = pytest.mark.parametrize("name", CURVES)
WITHIN = 1e-7
"""Of 20000 samples a turn, one lies within (half a step)^2 of an extreme."""


@cache
def read_off(name: str) -> PlantingFigures:
    return plant(CURVES[name]())


@cache
def sampled(name: str) -> tuple[Array, Any]:
    theta = cycle(CURVES[name]())
    return theta, tip_at(CURVES[name](), theta)


@pytest.mark.exhaustive(but=["kim-chung-c", "backward", "twice"])
@every_curve
def test_size_and_length(name: str) -> None:
    figures, (_, tip) = read_off(name), sampled(name)
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
@every_curve
def test_extremes(name: str, what: str, which: str) -> None:
    figures, (theta, tip) = read_off(name), sampled(name)
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


@every_curve
def test_ratios_of_angular_velocities(name: str) -> None:
    figures = read_off(name)
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


@every_curve
def test_transmission_angle(name: str) -> None:
    """The nearer of the extremes of the four-bar to 0 or 180 deg."""
    figures = read_off(name)
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
@every_curve
def test_smallest_radius(name: str, path: str) -> None:
    """No three neighbouring samples lie on a smaller circle, and those at its place on this one."""
    figures, (theta, tip) = read_off(name), sampled(name)
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


@pytest.mark.exhaustive(but=["0.99999", "1.01"])
@pytest.mark.parametrize("forward", [1.01, 1.0001, 1.00001, 0.99999, 0.9999])
def test_radius_of_a_path_that_nearly_has_a_cusp(forward: float) -> None:
    """Between two samples, the tip all but stops over ground."""
    figures = plant(spinner(at=0.3, forward_speed=forward))
    radius = (0.1 - forward / 10) ** 2 / 0.1
    assert figures["ground.smallest_radius.value"] == pytest.approx(radius, rel=1e-6)
