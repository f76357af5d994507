"""Instants of a stroke: stays in the soil, release, pick-up, and what the tip does then."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.planting.stroke import Visit, direction, visits
from equipoise.planting.summary import PlantingFigures, plant
from support.chosen import few
from unit.planting.build import (
    EXAMPLES,
    TURN,
    Array,
    apart,
    block,
    cycle,
    planetary,
    spinner,
    tip_at,
    twice,
)

MACHINES = {
    **{name: eq.load(name) for name in EXAMPLES},
    "backward": eq.load("kim-chung-b").with_planting(travel="backward"),
    "high": eq.load("kim-chung-a").with_planting(depth=None, surface=0.05),
    "twice": twice(),
    "twice clockwise": twice(-12.0),
    "three turns": planetary(depth=0.03),
    "three turns twice": planetary(depth=0.05),
    "three turns thrice": planetary(depth=0.1),
    "three turns clockwise": planetary(-20.0, depth=0.12),
    "three turns, two merged": planetary(depth=0.15),
}
STAYS = [1, 1, 1, 1, 1, 2, 2, 1, 2, 3, 3, 2]


def visits_of(machine: eq.Machine) -> tuple[Visit, ...]:
    return visits(TipCurve([machine]))


def by_sampling(machine: eq.Machine) -> tuple[float, list[tuple[float, float]]]:
    """Period, and entry and exit of every stay from many samples over two cycles, in time."""
    theta = cycle(machine)
    period = float(abs(theta[-1]))
    twofold = np.concatenate([theta[:-1], theta + theta[-1]])
    below = tip_at(machine, twofold).y < TipCurve([machine]).surface[0]
    entries = twofold[1:][below[1:] & ~below[:-1]]
    exits = twofold[1:][~below[1:] & below[:-1]]
    sense = np.sign(machine.drive.speed)
    pairs = [(entry, exits[sense * exits > sense * entry]) for entry in entries]
    return period, [(e, float(x[0])) for e, x in pairs if abs(e) <= period and x.size]


@pytest.mark.parametrize(("name", "count"), [*zip(MACHINES, STAYS, strict=True)])
def test_every_stay_by_sampling(name: str, count: int) -> None:
    machine = MACHINES[name]
    period, wanted = by_sampling(machine)
    got = visits_of(machine)
    assert len(got) == len(wanted) == count
    step = TURN / 20_000
    for visit in got:
        ways = [abs((visit.entry - e + period / 2) % period - period / 2) for e, _ in wanted]
        entry, leave = wanted[int(np.argmin(ways))]
        assert min(ways) <= step
        assert abs((visit.exit - visit.entry) - (leave - entry)) <= 2 * step


@pytest.mark.parametrize("name", MACHINES)
def test_ends_lie_on_the_surface_and_the_deepest_point_between(name: str) -> None:
    machine = MACHINES[name]
    sense = np.sign(machine.drive.speed)
    level = TipCurve([machine]).surface[0]
    depths = []
    for visit in visits_of(machine):
        ends = tip_at(machine, [visit.entry, visit.exit])
        np.testing.assert_allclose(ends.y, level, atol=1e-14)
        assert ends.vy[0] < 0 < ends.vy[1]
        assert sense * visit.exit > sense * visit.entry
        inside = np.linspace(visit.entry, visit.exit, 5001)[1:-1]
        heights = tip_at(machine, inside).y
        assert np.all(heights < level)
        assert visit.depth == pytest.approx(level - heights.min(), abs=1e-7)
        assert tip_at(machine, visit.deepest).y[0] == pytest.approx(level - visit.depth, abs=1e-15)
        assert np.min(np.abs(inside - visit.deepest - period_of(machine, inside, visit))) < 2e-3
        depths.append(visit.depth)
    assert depths == sorted(depths, reverse=True)


def period_of(machine: eq.Machine, inside: Array, visit: Visit) -> Any:
    """Whole cycles from the deepest point, told within one, to each crank angle of the stay."""
    period = TURN * eq.mechanism.assemble(machine).cycle.turns
    return period * np.round((inside - visit.deepest) / period)


@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("name", ["kim-chung-a", "kim-chung-b"])
def test_a_shallow_stay_is_not_missed(name: str, depth: float) -> None:
    """About its bottom the path is a parabola: half the travel is the root of twice the depth."""
    machine = eq.load(name).with_planting(depth=depth)
    (visit,) = visits_of(machine)
    half = np.sqrt(2 * depth / tip_at(machine, visit.deepest).place_2.imag[0])
    assert visit.depth == pytest.approx(depth, rel=1e-6)
    assert abs(visit.exit - visit.entry) == pytest.approx(2 * half, rel=0.02)


def test_a_stay_may_pass_crank_angle_0() -> None:
    """The tip on the crank lies lowest at crank angle 0."""
    for speed, side in ((10.0, -1), (-10.0, 1)):
        (visit,) = visits_of(spinner(speed, at=-np.pi / 2))
        half = np.arccos(0.6)
        assert apart(visit.entry, side * half) < 1e-14
        assert apart(visit.exit, -side * half) < 1e-14
        assert apart(visit.deepest, 0.0) < 1e-14


@pytest.mark.parametrize("speed", [10.0, -10.0])
@pytest.mark.parametrize("surface", [0.0, -0.05, 0.05])
def test_an_end_of_a_stay_at_crank_angle_0(surface: float, speed: float) -> None:
    """The tip passes the surface just where a cycle ends and the next begins."""
    half = np.arccos(-surface / 0.1)
    for side in (half, -half):
        machine = spinner(speed, at=-np.pi / 2 - side, depth=None, surface=surface)
        (visit,) = visits_of(machine)
        assert abs(visit.exit - visit.entry) == pytest.approx(2 * half, abs=1e-12)
        assert min(apart(visit.entry, 0.0), apart(visit.exit, 0.0)) < 1e-12


# -- no stay ---------------------------------------------------------------------------------------


def refusal(machine: eq.Machine) -> ModelError:
    with pytest.raises(ModelError) as caught:
        plant(machine)
    return caught.value


REFUSED = (
    (
        {"depth": None, "surface": -0.12},
        "surface: got -120 mm; the tip P never reaches the soil, its lowest point is at -100 mm; "
        "give a surface above that",
    ),
    (
        {"depth": 0.25},
        "depth: got 250 mm; the tip P never leaves the soil, its path is 200 mm high; give a depth "
        "below that",
    ),
    (
        {"depth": None, "surface": 0.13},
        "surface: got 130 mm; the tip P never leaves the soil, it is at 100 mm at most; give a "
        "surface below that",
    ),
)


@pytest.mark.parametrize(("planting", "sentence"), REFUSED)
def test_a_tip_that_never_reaches_or_leaves_the_soil(
    planting: dict[str, Any], sentence: str
) -> None:
    assert str(refusal(spinner(**planting))) == f"planting.{sentence}"


def test_a_tip_that_comes_down_to_the_surface_does_not_reach_it() -> None:
    assert refusal(spinner(depth=None, surface=-0.1 - 1e-9)).where == "planting.surface"


@pytest.mark.parametrize("planting", [{"depth": 0.2}, {"depth": None, "surface": 0.1}])
def test_a_tip_that_comes_up_to_the_surface_does_not_leave_the_soil(
    planting: dict[str, Any],
) -> None:
    assert "never leaves the soil" in refusal(spinner(**planting)).what


def test_a_tip_that_stands_still_has_no_stay() -> None:
    """The pivots belong to links too."""
    error = refusal(eq.load("kim-chung-a").with_planting(tip="D"))
    assert error.what.startswith(
        "got 40 mm; the tip D never leaves the soil, its path is 0 mm high"
    )


TRAYS = {
    "kim-chung-a": ((-0.24, -0.02), (-0.1, 0.03)),
    "kim-chung-b": ((0.25, 0.02), (0.1, 0.0)),
    "kim-chung-c": ((0.15, 0.0), (0.32, 0.02)),
    "half the curve": ((0.1, 0.0), (0.16, 0.02)),
    "twice": ((-0.1, -0.112), (0.2, -0.108)),
    "three turns": ((-0.2, 0.01), (0.2, 0.02)),
    "three turns clockwise": ((0.0, 0.01), (0.2, 0.02)),
}


def machine_of(name: str) -> eq.Machine:
    others = {
        "half the curve": lambda: eq.load("kim-chung-b"),
        "twice": twice,
        "three turns": planetary,
        "three turns clockwise": lambda: planetary(-20.0, depth=0.1),
    }
    machine = others[name]() if name in others else eq.load(name)
    return machine.with_planting(tray=TRAYS[name])


@cache
def instants_of(name: str) -> PlantingFigures:
    return plant(machine_of(name))


def sampled_instants(machine: eq.Machine) -> list[float]:
    """Crank angles within one cycle at which the tip passes the tray's edge, rising."""
    assert machine.planting is not None
    assert machine.planting.tray is not None
    start, stop = (complex(*end) for end in machine.planting.tray)
    theta = np.sort(np.abs(cycle(machine)))
    places = (tip_at(machine, theta).place - start) / (stop - start)
    k = np.flatnonzero((places.imag[1:] > 0) != (places.imag[:-1] > 0))
    middles = (places.real[1:] + places.real[:-1])[k] / 2
    return [float(x) for x in theta[k][(middles >= 0) & (middles <= 1)]]


@pytest.mark.exhaustive(but=["twice", "kim-chung-a"])
@pytest.mark.parametrize("name", few(TRAYS, {"kim-chung-a", "three turns clockwise", "twice"}))
def test_every_crossing_of_the_tray(name: str) -> None:
    machine = machine_of(name)
    wanted = sampled_instants(machine)
    got = instants_of(name).tray_crossings
    assert 0 < len(got) == len(wanted)
    np.testing.assert_allclose(got, wanted, atol=TURN / 20_000)
    start, stop = (complex(*end) for end in TRAYS[name])
    share = (tip_at(machine, got).place - start) / (stop - start)
    np.testing.assert_allclose(share.imag, 0, atol=1e-13)


# Which says something of the tests above alone.
@pytest.mark.exhaustive
def test_some_tray_is_passed_more_than_twice_and_some_once() -> None:
    counts = [len(instants_of(name).tray_crossings) for name in TRAYS]
    assert max(counts) > 2
    assert min(counts) == 1


def last_before_entry(figures: PlantingFigures) -> float:
    """The crossing from which the way to the entry is the shortest."""
    sense = np.sign(figures["speed"])
    ways = [sense * (figures["entry.crank_angle"] - angle) % figures.curve.period
            for angle in figures.tray_crossings]  # fmt: skip
    return figures.tray_crossings[int(np.argmin(ways))]


@pytest.mark.parametrize("name", TRAYS)
def test_pick_up_is_the_last_crossing_before_entry(name: str) -> None:
    figures = instants_of(name)
    assert figures["pick_up.crank_angle"] == pytest.approx(last_before_entry(figures), abs=1e-12)
    tip = tip_at(figures.machine, figures["pick_up.crank_angle"])
    assert figures["pick_up.x"] == pytest.approx(tip.x[0], abs=1e-14)


@pytest.mark.exhaustive(but=["1e-05-0.1-1.997", "-1e-05-0.1-2.001"])
@pytest.mark.parametrize("crank_angle", [1.997, 2.001])
@pytest.mark.parametrize("slant", few([1.5, 0.1], {0.1}))
@pytest.mark.parametrize("beyond", [1e-5, -1e-5])
def test_an_edge_that_ends_beside_the_path(crank_angle: float, slant: float, beyond: float) -> None:
    """A tray 50 mm long, at a slant to the path, that ends this far (m) beyond it or before it."""
    machine = eq.load("kim-chung-a")
    tip = tip_at(machine, crank_angle)
    along = tip.place_1[0] / abs(tip.place_1[0]) * np.exp(1j * slant)
    ends = [tip.place[0] - 0.05 * along, tip.place[0] + beyond * along]
    tray = [(end.real, end.imag) for end in ends]
    figures = plant(machine.with_planting(tray=tray))
    assert (len(figures.tray_crossings) > 0) == ("pick_up.crank_angle" in figures.figures)
    assert any(apart(c, crank_angle) < 1e-9 for c in figures.tray_crossings) == (beyond > 0)
    if figures.tray_crossings:
        assert apart(figures["pick_up.crank_angle"], last_before_entry(figures)) < 1e-9


# Edges that end beside the path: the tests above.
@pytest.mark.exhaustive
@pytest.mark.parametrize("back", few([6.0, 40.0], {40.0}))
def test_a_short_edge_passed_once_in_many_turns(back: float) -> None:
    """The line through it is crossed at every turn, the edge only long before the tip enters."""
    machine = planetary(teeth=35)
    entry = plant(machine)["entry.crank_angle"]
    tip = tip_at(machine, entry - back)
    across = 0.004j * tip.place_1[0] / abs(tip.place_1[0])
    ends = [tip.place[0] - across, tip.place[0] + across]
    figures = plant(machine.with_planting(tray=[(end.real, end.imag) for end in ends]))
    assert figures.curve.turns == 7
    assert len(figures.tray_crossings) == 1
    wanted = (entry - back) % figures.curve.period
    assert figures["pick_up.crank_angle"] == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_a_tray_passed_at_crank_angle_0(speed: float) -> None:
    figures = plant(spinner(speed, tray=((0.05, 0.0), (0.15, 0.0))))
    (crossing,) = figures.tray_crossings
    assert apart(crossing, 0.0) < 1e-14
    assert apart(figures["pick_up.crank_angle"], 0.0) < 1e-14


def test_a_tray_out_of_reach_gives_no_pick_up() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(tray=((0.0, 0.0), (0.1, 0.0))))
    assert figures.tray_crossings == ()
    assert not any(name.startswith("pick_up") for name in figures.figures)
    assert "the tip never passes the tray's edge, so that it picks up nothing" in map(
        str, figures.notes
    )


def test_a_geared_arm_that_misses_its_tray() -> None:
    """Nothing is solved at a crank angle that does not exist: a warning would reach the user."""
    figures = plant(planetary(tray=((1.0, 1.0), (1.0, 2.0))))
    assert figures.tray_crossings == ()
    assert not any(name.startswith("pick_up") for name in figures.figures)


# -- release ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_seedlings_are_released_at_the_lowest_point_unless_said_otherwise(name: str) -> None:
    figures = plant(eq.load(name))
    keys = [key.removeprefix("lowest.") for key in figures.figures if key.startswith("lowest.")]
    assert len(keys) > 10
    for key in keys:
        assert figures[f"release.{key}"] == figures[f"lowest.{key}"]


@pytest.mark.parametrize("release", [1.0, 1.0 + TURN, 1.0 - 3 * TURN])
def test_release_at_a_crank_angle(release: float) -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(release=release))
    assert figures["release.crank_angle"] == pytest.approx(1.0, abs=1e-13)
    tip = tip_at(figures.machine, 1.0)
    assert figures["release.x"] == pytest.approx(tip.x[0], abs=1e-13)
    assert figures["release.velocity.y"] == pytest.approx(tip.vy[0], abs=1e-12)


# -- what the tip does -----------------------------------------------------------------------------

INSTANTS = ("entry", "lowest", "exit", "highest", "release", "pick_up")


@pytest.mark.parametrize(("travel", "acceleration"), [("forward", 0.0), ("backward", 120.0)])
@pytest.mark.parametrize(
    "name", few(TRAYS, {"kim-chung-a", "three turns clockwise", "half the curve"})
)
def test_vectors_at_each_instant(name: str, travel: Any, acceleration: float) -> None:
    figures = instants_of(name)
    if travel == "backward":
        machine = machine_of(name).with_planting(travel=travel)
        figures = plant(machine.with_drive(acceleration=acceleration))
    forward = figures["forward_speed"]
    assert (forward > 0) == (travel == "forward")
    for instant in INSTANTS:
        motion = eq.move(figures.machine, [figures[f"{instant}.crank_angle"]])
        tip = motion.points["P"]
        assert figures[f"{instant}.x"] == pytest.approx(tip.x[0], abs=1e-13)
        assert figures[f"{instant}.y"] == pytest.approx(tip.y[0], abs=1e-13)
        for vector, value in (
            ("velocity", tip.velocity[0]),
            ("acceleration", tip.acceleration_vector[0]),
            ("ground_velocity", tip.velocity[0] + forward),
        ):
            got = {k: figures[f"{instant}.{vector}.{k}"] for k in ("x", "y", "size", "direction")}
            within = 1e-11 * (abs(value) + 1)
            assert complex(got["x"], got["y"]) == pytest.approx(value, abs=within)
            assert got["size"] == pytest.approx(abs(value), abs=within)
            assert apart(got["direction"], np.angle(value)) < 1e-9


@pytest.mark.parametrize("base", ["B", "C"])
def test_attitude_is_the_direction_of_the_finger(base: str) -> None:
    figures = plant(eq.load("kim-chung-b").with_planting(finger_from=base))
    for instant in INSTANTS[:-1]:
        points = eq.move(figures.machine, [figures[f"{instant}.crank_angle"]]).points
        finger = points["P"].place[0] - points[base].place[0]
        assert apart(figures[f"{instant}.attitude"], np.angle(finger)) < 1e-13


def test_without_another_point_there_is_no_finger() -> None:
    """A block in a vertical guide, whose one point is the tip: it has neither attitude nor hole."""
    figures = plant(block())
    assert not any(name.endswith("attitude") for name in figures.figures)
    assert "soil.hole_length" not in figures.figures
    assert figures.to_dict()["finger_from"] is None
    assert not any("finger" in str(note) for note in figures.notes)


def test_directions_of_level_vectors_are_not_turned_round_by_rounding() -> None:
    given = np.array([-1 - 1e-16j, -1 + 1e-16j, 1 - 1e-16j, -1j, 1 + 1j, 0])
    wanted = [np.pi, np.pi, 0.0, -np.pi / 2, np.pi / 4, 0.0]
    np.testing.assert_array_equal(direction(given), wanted)
