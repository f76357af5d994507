"""Figures of many designs at once are those of each alone."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.figures import tip_figures
from equipoise.planting.goals import TURNING, dimension_of
from equipoise.planting.stroke import soil_crossings
from equipoise.planting.summary import PlantingFigures, plant
from unit.planting.build import apart

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


@pytest.mark.parametrize("name", NAMES)
def test_a_stack_of_designs_has_the_figures_of_each(name: str) -> None:
    found = stack(name)
    own = {"speed", "forward_speed", "hill_spacing", "planting_frequency"}
    assert set(found) == set(alone(name)[0].figures) - own
    for key, values in found.items():
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
    found = tip_figures(curve, entry, leave)
    assert np.isfinite(found["curve.height"]).all()
    assert np.isnan(found["entry.x"][:2]).all()
    assert found["soil.crank_travel"][2] == pytest.approx(plant(good)["soil.crank_travel"])


@pytest.mark.parametrize("wanted", [("curve",), ("entry", "limits"), ("ratio", "soil"), ()])
def test_only_what_is_wanted(wanted: tuple[str, ...]) -> None:
    everything, some = stack("kim-chung-a"), stack("kim-chung-a", wanted)
    assert {name.split(".")[0] for name in some} == {*wanted}
    assert some.keys() == {name for name in everything if name.split(".")[0] in wanted}
    for name, values in some.items():
        np.testing.assert_array_equal(values, everything[name])


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
def test_a_name_tells_the_kind_of_quantity(name: str, kind: str | None) -> None:
    assert dimension_of(name) == kind
    assert name in alone("kim-chung-a")[0].figures
