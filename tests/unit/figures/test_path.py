"""The path of a planting finger, relative to the machine and over ground."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.path import path_figure
from equipoise.figures.paths import Paths
from equipoise.figures.pictures import drawn
from equipoise.planting.summary import plant
from unit.figures.samples import (
    BUNDLED,
    read_off,
    words,
)


def test_both_paths_are_drawn_to_one_scale() -> None:
    for name in BUNDLED:
        for axes in drawn(path_figure, read_off(name)).axes:
            (x0, y0), (x1, y1) = axes.transData.transform([(0, 0), (1, 1)])
            assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-9)
        machine, ground = drawn(path_figure, read_off(name)).axes
        assert machine.get_ylim() == ground.get_ylim()
        left, right = (axes.transData.transform([(0, 0), (1, 0)]) for axes in (machine, ground))
        assert np.ptp(left[:, 0]) == pytest.approx(np.ptp(right[:, 0]), rel=1e-9)


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
    figure = drawn(path_figure, still)
    assert len(figure.axes) == 1
    assert "over ground" not in words(figure)
    assert len(drawn(path_figure, read_off("kim-chung-a")).axes) == 2


def test_matplotlib_waits_until_it_is_needed() -> None:
    program = (
        "import sys, equipoise as eq, equipoise.cli\n"
        "from equipoise.planting.summary import plant\n"
        "plant(eq.load('kim-chung-a'))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
        "import equipoise.figures.planting\n"
        "from equipoise.figures import render\n"
        "analysis = eq.analyze(eq.load('kim-chung-a'))\n"
        "from equipoise.figures.analysis import curves\n"
        "assert render(curves(analysis)).startswith(b'<svg')\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
