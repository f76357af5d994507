"""Planting obeys the laws of motion, and does the same however it is described.

Soil takes power and momentum as any force does; a mirror image, other units, other axes of a link
or the crank turned the other way change figures only as their kind of quantity says.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.dynamics.loads import soil_force
from equipoise.mechanism.parts.field import Planting, Soil, SoilTable
from equipoise.planting.names import TURNING, dimension_of
from equipoise.planting.summary import PlantingFigures, plant, table
from laws import transforms
from laws.subjects import along, gravity_power, kinetic_power, load_power, spring_power
from laws.transforms import Units
from support.chosen import few
from support.machines import make

SOIL = Soil(4.0, 150.0, 3.0, 60.0, SoilTable((0.0, 0.02, 0.05), (1.0, 6.0, 5.0)))
TRAY = ((-0.3, -0.01), (0.3, 0.0))
EXAMPLES = ("kim-chung-a", "kim-chung-b", "kim-chung-c")
SUBJECTS = (*EXAMPLES, "planetary-planting-arm", "watt:0", "stephenson:3", "geared_coupler:1")
"""Bundled machines, and random ones with loads and an accelerated crank."""
SLACK = {"curve.length": 1e-6, "soil.path_length_machine": 1e-6, "tray": 1e-5}
"""Lengths converge slowly near a cusp; where the tip passes the tray, its distance is rounding."""


@cache
def subject(name: str) -> eq.Machine:
    """A machine with soil, the lowest third of its tip's path below the surface."""
    kind, _, seed = name.partition(":")
    machine = make(kind, int(seed)).machine if seed else eq.load(name)
    link = list(machine.links)[-1]
    tip = "P" if any("P" in body.points for body in machine.links.values()) else next(
        point for point in machine.links[link].points if point not in machine.frame
    )  # fmt: skip
    heights = eq.move(machine, 720).points[tip].y
    depth = float(np.ptp(heights)) / 3
    values = Planting(tip=tip, forward_speed=0.7, depth=depth, travel="backward", soil=SOIL)
    return replace(machine, planting=values)


# -- power and momentum ----------------------------------------------------------------------------


@pytest.mark.parametrize("acceleration", [0.0, 90.0])
@pytest.mark.parametrize("name", SUBJECTS)
def test_power_fed_in_is_gained_or_left_in_the_soil(name: str, acceleration: float) -> None:
    """The soil's share is its force times the tip's velocity relative to the machine's frame."""
    forces = eq.analyze(subject(name), 180, acceleration=acceleration).forces
    assert forces.motion.machine.planting is not None
    tip = forces.motion.points[forces.motion.machine.planting.tip]
    *loads, soil = load_power(forces)
    peak_of_soil = np.max(np.abs(soil))
    assert peak_of_soil > 0
    again = along(tip.velocity, soil_force(forces.motion))
    np.testing.assert_allclose(again, soil, rtol=0, atol=1e-12 * peak_of_soil)
    rows = [*kinetic_power(forces), *-gravity_power(forces), *(-load for load in loads), -soil]
    rows = [*rows, *-spring_power(forces)]
    peak = np.max(np.sum(np.abs(rows), axis=0) + np.abs(forces.power))
    np.testing.assert_allclose(forces.power, np.sum(rows, axis=0), rtol=0, atol=1e-12 * peak)


@pytest.mark.parametrize("name", SUBJECTS)
def test_soil_pushes_on_the_frame_through_the_joints(name: str) -> None:
    machine = subject(name)
    wet = eq.analyze(machine, 180).forces
    dry = eq.analyze(machine.with_planting(soil=None), 180).forces
    force = soil_force(wet.motion)
    assert np.any(force)
    scale = np.max(np.abs(wet.frame_force.value))
    difference = wet.frame_force.value - dry.frame_force.value
    np.testing.assert_allclose(difference, force, rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(
        wet.shaking_force.value, dry.shaking_force.value, rtol=0, atol=1e-13 * scale
    )
    assert machine.planting is not None
    arm = wet.motion.points[machine.planting.tip].place - wet.about
    moment = wet.frame_moment - dry.frame_moment
    reach = scale * np.max(np.abs(arm)) + np.max(np.abs(wet.frame_moment))
    np.testing.assert_allclose(moment, along(1j * arm, force), rtol=0, atol=1e-12 * reach)


@pytest.mark.parametrize("name", SUBJECTS)
def test_soil_takes_energy_over_ground(name: str) -> None:
    """Against the ground its power is never positive."""
    motion = eq.move(subject(name), 180)
    assert motion.machine.planting is not None
    planting = motion.machine.planting
    over_ground = motion.points[planting.tip].velocity + planting.forward(motion.speed)
    assert np.max(along(over_ground, soil_force(motion))) <= 0


# -- the same in other words -----------------------------------------------------------------------


@cache
def example(name: str, travel: Any = "forward") -> eq.Machine:
    """A machine with everything that has figures."""
    return eq.load(name).with_planting(
        tray=TRAY, release=1.0, travel=travel, acceleration_limit=90.0, soil_acceleration_limit=50.0
    )


@cache
def read_off(name: str, travel: Any = "forward") -> PlantingFigures:
    return plant(example(name, travel))


def agree(got: PlantingFigures, want: dict[str, float], within: float = 1e-9) -> None:
    """Compare all figures, and all those of the loops, to a part of each vector or value."""
    figures = all_figures(got)
    assert figures.keys() == want.keys()
    for name, value in want.items():
        last = name.split(".")[-1]
        if last in TURNING:
            apart = turned_apart(name, figures[name], value)
            assert apart < max(within, 1e-7 if name.startswith("soil.max") else 0), name
            continue
        scale = abs(want.get(".".join([*name.split(".")[:-1], "size"]), value)) + 1e-4
        kind = "tray" if name.startswith("clearance.tray") else name
        assert abs(figures[name] - value) < SLACK.get(kind, within) * scale, name


def turned_apart(name: str, a: float, b: float) -> float:
    """Smallest angle between two; B's transmission angle is as bad half a turn further on."""
    turn = np.pi if name == "transmission.min_at" else 2 * np.pi
    return float(abs((a - b + turn / 2) % turn - turn / 2))


def all_figures(figures: PlantingFigures) -> dict[str, float]:
    loops = {
        f"loop{k}.{key}": getattr(loop, key)
        for k, loop in enumerate(sorted(figures.loops, key=lambda loop: loop.way))
        for key in ("way", "height", "width", "y")
    }
    of_links = ("clearance.", "crank_angle")  # these may tie
    plain = {
        name: value
        for name, value in figures.figures.items()
        if not (name.startswith(of_links[0]) and name.endswith(of_links[1]))
    }
    return {**plain, **loops}


@pytest.mark.exhaustive(but=["kim-chung-b-backward"])
@pytest.mark.parametrize("travel", ["forward", "backward"])
@pytest.mark.parametrize("name", few(EXAMPLES, {"kim-chung-b"}))
def test_mirror_image(name: str, travel: str) -> None:
    """In the y axis: x becomes -x, directions and crank angles become pi less themselves.

    The mirrored machine drives the other way, and its crank turns the other way; sizes stay.
    """
    want = {}
    for key, value in all_figures(read_off(name, travel)).items():
        last = key.split(".")[-1]
        if last in TURNING:
            want[key] = np.pi - value
        elif last in ("x", "ground_advance") or key in ("speed", "forward_speed"):
            want[key] = -value
        else:
            want[key] = value
    agree(plant(transforms.mirrored(example(name, travel))), want)


@pytest.mark.parametrize("travel", ["forward", "backward"])
@pytest.mark.parametrize("name", few(EXAMPLES, {"kim-chung-b"}))
def test_time_reversed(name: str, travel: str) -> None:
    """Crank and machine turned back: the tip leaves where it entered, with the opposite velocity.

    The path over ground is the same, traced from its end.
    """
    other = "backward" if travel == "forward" else "forward"
    machine = replace(example(name, travel), drive=eq.Drive("crank", -read_off(name)["speed"]))
    back = plant(machine.with_planting(travel=other))
    swap = {"entry": "exit", "exit": "entry"}
    want = {}
    for key, value in all_figures(read_off(name, travel)).items():
        first, _, rest = key.partition(".")
        velocity = "velocity." in key or first in ("max_speed", "min_speed")
        if velocity and key.endswith("direction"):
            value += np.pi  # noqa: PLW2901
        elif key in ("speed", "forward_speed", "soil.ground_advance") or (
            velocity and key.endswith((".x", ".y"))
        ):
            value = -value  # noqa: PLW2901
        want[".".join(filter(None, (swap.get(first, first), rest)))] = value
    figures = all_figures(back)
    for key in [key for key in want if key.startswith("pick_up")]:
        del want[key], figures[key]  # the tip may pass the tray another time before it enters
    assert figures.keys() == want.keys()
    agree(replace_figures(back, figures), want)


def replace_figures(figures: PlantingFigures, kept: dict[str, float]) -> PlantingFigures:
    own = {name: value for name, value in figures.figures.items() if name in kept}
    return replace(figures, figures=own)


@pytest.mark.parametrize(("lengths", "times"), [(0.01, 1.0), (25.4, 0.2)])
@pytest.mark.parametrize("name", few(EXAMPLES, {"kim-chung-b"}))
def test_every_figure_scales_as_its_kind_says(name: str, lengths: float, times: float) -> None:
    scaled = transforms.in_units(example(name), Units(lengths, 1, times))
    by_kind = {
        None: 1.0,
        "angle": 1.0,
        "length": lengths,
        "time": times,
        "frequency": 1 / times,
        "angular speed": 1 / times,
        "speed": lengths / times,
        "acceleration": lengths / times**2,
    }
    figures = plant(scaled).figures
    assert figures.keys() == read_off(name).figures.keys()
    for key, value in read_off(name).figures.items():
        factor = by_kind[dimension_of(key)]
        size = read_off(name).figures.get(".".join([*key.split(".")[:-1], "size"]), value)
        zoomed = key == "soil.max_acceleration.crank_angle" or key.startswith("clearance.")
        within = 1e-7 if zoomed else 1e-10
        off = abs(figures[key] / factor - value)
        off = turned_apart(key, figures[key], value) if key == "transmission.min_at" else off
        assert off < within * (abs(size) + 1e-3), key


@pytest.mark.exhaustive(but=["kim-chung-c"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_speed_with_hills_kept(name: str) -> None:
    """Velocities grow with speed, accelerations with its square; path and crank angles stay."""
    machine, factor = example(name).with_planting(forward_speed=None, hill_spacing=0.14), 3.0
    slow, speed = plant(machine), machine.drive.speed
    fast = plant(machine, speed=speed * factor)
    power = {"speed": 1, "angular speed": 1, "frequency": 1, "acceleration": 2, "time": -1}
    for key, value in slow.figures.items():
        kind = 0 if key.startswith("limits") else power.get(dimension_of(key) or "", 0)
        size = slow.figures.get(".".join([*key.split(".")[:-1], "size"]), value)
        zoomed = key == "soil.max_acceleration.crank_angle" or key.startswith("clearance.")
        within = 1e-7 if zoomed else 1e-10
        assert abs(fast[key] / factor**kind - value) < within * (abs(size) + 1e-3), key


@pytest.mark.parametrize("name", EXAMPLES)
def test_other_axes_of_the_links(name: str) -> None:
    """Shifted and turned at random, all but the drive link's, which carry the crank angle."""
    machine, rng = example(name), np.random.default_rng(7)
    for link in ("coupler", "rocker"):
        shift = complex(*rng.normal(size=2)) * 0.1
        machine = transforms.with_axes(machine, link, float(rng.uniform(-3, 3)), shift)
    agree(plant(machine), all_figures(read_off(name)))


@pytest.mark.exhaustive(but=["kim-chung-a"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_other_axes_of_the_crank(name: str) -> None:
    """Turned by 0.4 rad against its pin, it passes every place at a crank angle 0.4 smaller."""
    machine = transforms.with_axes(example(name), "crank", -0.4, 0j).with_planting(release=0.6)
    want = {}
    for key, value in all_figures(read_off(name)).items():
        turns = key.endswith(("crank_angle", "min_at", "max_at"))
        want[key] = value - 0.4 if turns else value
    agree(plant(machine), want)


@pytest.mark.parametrize("name", EXAMPLES)
def test_moving_the_frame(name: str) -> None:
    shift = 0.3 - 0.2j
    moved = transforms.shifted(example(name), shift)
    want = {}
    for key, value in all_figures(read_off(name)).items():
        first, _, last = key.partition(".")
        across = last == "x" and "." not in last
        up = key == "surface" or last == "y"
        want[key] = value + (shift.real if across else shift.imag if up else 0.0)
        assert first
    agree(plant(moved), want)


# -- derivatives -----------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["kim-chung-c-backward", "planetary-planting-arm-forward"])
@pytest.mark.parametrize("travel", ["forward", "backward"])
@pytest.mark.parametrize("name", [*EXAMPLES, "planetary-planting-arm"])
def test_columns_are_derivatives_of_each_other(name: str, travel: str) -> None:
    """Sixth-order differences in time, of 1440 places a turn: right to 1e-9 of the largest."""
    machine = replace(subject(name), planting=replace(subject(name).planting, travel=travel))  # type: ignore[type-var]
    figures = plant(machine.with_planting(soil=None))
    columns = {key: values for key, _, values in table(figures, 1440)}
    step = columns["time"][1]
    for point in ("tip", "center_of_mass"):
        for place, rate in (("x", "vx"), ("y", "vy"), ("vx", "ax"), ("vy", "ay")):
            slope = difference(columns[f"{point}.{place}"], step)
            largest = np.max(np.abs(columns[f"{point}.{rate}"]))
            np.testing.assert_allclose(slope, columns[f"{point}.{rate}"], atol=2e-9 * largest)
        ahead = columns[f"{point}.ground_x"]
        slope = difference(ahead - figures["forward_speed"] * columns["time"], step)
        np.testing.assert_allclose(
            slope + figures["forward_speed"], columns[f"{point}.ground_vx"], atol=1e-7
        )


def difference(values: Any, step: float) -> Any:
    """Derivative of a periodic signal from its six neighbours."""
    weights = {1: 45.0, 2: -9.0, 3: 1.0}
    total = sum(w * (np.roll(values, -k) - np.roll(values, k)) for k, w in weights.items())
    return total / (60 * step)
