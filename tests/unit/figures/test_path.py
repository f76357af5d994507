"""The path of a planting finger, relative to the machine and over ground."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.path import Paths, path
from equipoise.planting.summary import plant
from unit.figures.samples import (
    BUNDLED,
    read_off,
    words,
)
from unit.figures.test_pictures import views


def test_both_paths_are_drawn_to_one_scale() -> None:
    for name in BUNDLED:
        machine, ground = views(path(read_off(name)))
        assert (machine.y.low, machine.y.high) == pytest.approx((ground.y.low, ground.y.high))
        scales = [
            scale.length / (scale.high - scale.low)
            for view in (machine, ground)
            for scale in (view.x, view.y)
        ]
        assert scales == pytest.approx([scales[0]] * 4)


@pytest.mark.parametrize("name", BUNDLED)
def test_paths_are_the_motion(name: str) -> None:
    machine = eq.load(name)
    paths, figures = Paths(read_off(name)), read_off(name)
    place = eq.move(machine, paths.sense * paths.ways).points["P"].place
    time = paths.ways / abs(machine.drive.speed)
    ground = place + 0.6 * time
    drawn_there = paths.over_ground(paths.ways)
    np.testing.assert_allclose(drawn_there.imag, ground.imag, atol=1e-12)
    np.testing.assert_allclose(np.diff(drawn_there), np.diff(ground), atol=1e-12)
    lowest = drawn_there[np.argsort(drawn_there.imag)]
    near_hill = np.minimum(abs(lowest[:2].real), abs(lowest[:2].real - figures["hill_spacing"]))
    assert np.all(near_hill < 2e-3)
    for cross in paths.crossings():
        assert np.sum(np.abs(drawn_there - cross) < 2e-3) >= 2


def test_without_travel_there_is_no_ground_panel() -> None:
    still = plant(eq.load("kim-chung-a").with_planting(forward_speed=0.0))
    chart = path(still)
    assert len(chart.panels) == 1
    assert "over ground" not in words(chart)
    assert len(path(read_off("kim-chung-a")).panels) == 2


def test_the_machine_is_drawn_at_the_lowest_point() -> None:
    figures = read_off("kim-chung-a")
    motion = eq.move(figures.machine, [figures["lowest.crank_angle"]])
    pins = [one.places[0] for one in path(figures).panels[0].signs if one.role in ("pin", "dot")]
    for point in motion.points.values():
        assert np.min(np.abs(np.array(pins) - point.place[0])) < 1e-12


def test_matplotlib_waits_until_it_is_needed() -> None:
    program = (
        "import sys, equipoise as eq, equipoise.cli\n"
        "from equipoise.planting.summary import plant\n"
        "plant(eq.load('kim-chung-a'))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
        "import equipoise.figures.planting\n"
        "from equipoise.figures import render\n"
        "analysis = eq.analyze(eq.load('kim-chung-a'))\n"
        "from equipoise.figures.points import curves\n"
        "from equipoise.figures.linkage import linkage\n"
        "assert all(render(draw(analysis)).startswith(b'<svg') for draw in (curves, linkage))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
