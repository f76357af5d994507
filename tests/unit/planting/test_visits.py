"""Stays in the soil: all of them, in the sense of time, or one sentence on why there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.stroke import Visit, visits
from equipoise.planting.summary import plant
from unit.planting.build import (
    EXAMPLES,
    TURN,
    Array,
    apart,
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


def found(machine: eq.Machine) -> tuple[Visit, ...]:
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
    got = found(machine)
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
    for visit in found(machine):
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
    (visit,) = found(machine)
    half = np.sqrt(2 * depth / tip_at(machine, visit.deepest).place_2.imag[0])
    assert visit.depth == pytest.approx(depth, rel=1e-6)
    assert abs(visit.exit - visit.entry) == pytest.approx(2 * half, rel=0.02)


def test_a_stay_may_pass_crank_angle_0() -> None:
    """The tip on the crank lies lowest at crank angle 0."""
    for speed, side in ((10.0, -1), (-10.0, 1)):
        (visit,) = found(spinner(speed, at=-np.pi / 2))
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
        (visit,) = found(machine)
        assert abs(visit.exit - visit.entry) == pytest.approx(2 * half, abs=1e-12)
        assert min(apart(visit.entry, 0.0), apart(visit.exit, 0.0)) < 1e-12


# -- no stay ---------------------------------------------------------------------------------------


def refusal(machine: eq.Machine) -> ModelError:
    with pytest.raises(ModelError) as caught:
        plant(machine)
    return caught.value


def test_a_tip_that_never_reaches_the_soil() -> None:
    error = refusal(spinner(depth=None, surface=-0.12))
    assert error.where == "planting.surface"
    assert error.what == (
        "got -120 mm; the tip P never reaches the soil, its lowest point is at -100 mm; give a "
        "surface above that"
    )
    assert refusal(spinner(depth=None, surface=-0.1 - 1e-9)).where == "planting.surface"


def test_a_tip_that_never_leaves_the_soil_by_depth() -> None:
    error = refusal(spinner(depth=0.25))
    assert error.where == "planting.depth"
    assert error.what == (
        "got 250 mm; the tip P never leaves the soil, its path is 200 mm high; give a depth below "
        "that"
    )


def test_a_tip_that_never_leaves_the_soil_by_surface() -> None:
    error = refusal(spinner(depth=None, surface=0.13))
    assert error.where == "planting.surface"
    assert error.what == (
        "got 130 mm; the tip P never leaves the soil, it is at 100 mm at most; give a surface "
        "below that"
    )


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
