"""Pictures of planting machines: which there are, what they draw, and that files are the same."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from math import degrees, tau
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

import equipoise as eq
from equipoise.figures.paths import Paths
from equipoise.planting.summary import plant
from equipoise.plotting.planting import drawings
from equipoise.plotting.stay import soil_spans
from equipoise.plotting.style import render
from unit.plotting.samples import (
    BUNDLED,
    SOIL,
    drawn,
    read_off,
    words,
)

DRY = [
    *("path", "ratio-coupler", "ratio-rocker"),
    *("velocity", "velocity-x", "velocity-y"),
    *("acceleration", "acceleration-x", "acceleration-y"),
]


def line_of(figure: Figure) -> tuple[np.ndarray, np.ndarray]:
    """The longest line drawn."""
    lines = (line for axes in figure.axes for line in axes.get_lines())
    line = max(lines, key=lambda found: len(found.get_xdata()))
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def test_names_in_order() -> None:
    assert list(drawings(plant(eq.load("kim-chung-a")))) == DRY
    assert list(drawn("kim-chung-a")) == [*DRY, "torque", "joints"]


def test_names_do_for_files() -> None:
    base = eq.load("kim-chung-a")
    names = {"crank": "crank", "coupler": 'a/b:"*', "rocker": "A_b_?" + "x" * 90}
    links = {names[name]: link for name, link in base.links.items()}
    found = list(drawings(plant(replace(base, links=links))))
    assert found[1] == "ratio-a_b___"
    assert len(found[2]) == 60
    twins = {"crank": "crank", "coupler": "a/b", "rocker": "A|b"}
    links = {twins[name]: link for name, link in base.links.items()}
    assert list(drawings(plant(replace(base, links=links))))[1:3] == ["ratio-a_b", "ratio-A_b-2"]


@pytest.mark.parametrize("kind", ["svg", "png", "pdf"])
def test_the_same_bytes_on_every_run(kind: str) -> None:
    again = drawings(plant(eq.load("kim-chung-a").with_planting(soil=SOIL)))
    names = ("path", "torque", "joints") if kind == "pdf" else drawn("kim-chung-a")
    for name in names:
        figure = drawn("kim-chung-a")[name]
        file = render(figure, kind)
        assert file == render(figure, kind) == render(again[name], kind), name
        for stamp in (b"Date", b"dc:date", b"matplotlib.org", b"Matplotlib", b"Software"):
            assert stamp not in file, (name, stamp)


def test_the_same_bytes_in_another_process() -> None:
    program = (
        "import equipoise as eq, hashlib\n"
        "from equipoise.planting.summary import plant\n"
        "from equipoise.plotting.planting import drawings\n"
        "from equipoise.plotting.style import render\n"
        "path = drawings(plant(eq.load('kim-chung-b')))['path']\n"
        "print(hashlib.sha256(render(path, 'svg')).hexdigest())\n"
    )
    runs = {
        subprocess.run(
            [sys.executable, "-c", program],
            capture_output=True,
            check=True,
            env={**os.environ, "PYTHONHASHSEED": seed},
        ).stdout
        for seed in ("1", "2")
    }
    assert len(runs) == 1 and runs != {b""}


def test_the_users_settings_do_not_matter() -> None:
    path = render(drawn("kim-chung-a")["path"], "svg")
    with matplotlib.rc_context({"font.size": 30, "axes.grid": False, "svg.fonttype": "path"}):
        before = dict(matplotlib.rcParams)
        assert render(drawings(read_off("kim-chung-a"))["path"], "svg") == path
        assert dict(matplotlib.rcParams) == before


def test_files_are_what_they_say() -> None:
    for name, figure in drawn("kim-chung-b").items():
        root = ElementTree.fromstring(render(figure, "svg"))
        assert root.tag == "{http://www.w3.org/2000/svg}svg", name
    assert render(drawn("kim-chung-b")["path"], "png").startswith(b"\x89PNG")
    assert render(drawn("kim-chung-b")["path"], "pdf").startswith(b"%PDF")


@pytest.mark.parametrize("name", BUNDLED)
def test_lines_are_the_motion(name: str) -> None:
    motion = eq.move(eq.load(name), 720)
    tip = motion.points["P"]
    expected = {
        "velocity": np.abs(tip.velocity),
        "velocity-x": tip.vx,
        "velocity-y": tip.vy,
        "acceleration": np.abs(tip.acceleration_vector),
        "acceleration-x": tip.ax,
        "acceleration-y": tip.ay,
        "ratio-coupler": motion.links["coupler"].angle_1,
        "ratio-rocker": motion.links["rocker"].angle_1,
    }
    for key, values in expected.items():
        x, y = line_of(drawn(name)[key])
        np.testing.assert_allclose(x, np.append(np.degrees(motion.crank_angle), 360), atol=1e-12)
        size = np.max(np.abs(values))
        np.testing.assert_allclose(y, np.append(values, values[0]), atol=1e-12 * size)


def test_a_drive_that_gathers_speed() -> None:
    machine = eq.load("kim-chung-b").with_drive(acceleration=40.0)
    vector = eq.move(machine, 720).points["P"].acceleration_vector
    for key, values in (("acceleration", np.abs(vector)), ("acceleration-y", vector.imag)):
        figure = drawings(plant(machine))[key]
        np.testing.assert_allclose(line_of(figure)[1][:-1], values, rtol=0, atol=1e-9)
        assert f"{np.max(values):.3g}" in words(figure)


def test_torque_and_joints_are_the_forces() -> None:
    found = read_off("kim-chung-c").forces
    assert found is not None
    air, soil = drawn("kim-chung-c")["torque"].axes[0].get_lines()[:2]
    np.testing.assert_array_equal(air.get_ydata()[:-1], found.in_air.drive_torque)
    np.testing.assert_array_equal(soil.get_ydata()[:-1], found.in_soil.drive_torque)
    assert air.get_linestyle() != soil.get_linestyle() == "-"
    panels = drawn("kim-chung-c")["joints"].axes
    for axes, (name, joint) in zip(panels, found.in_soil.joints.items(), strict=True):
        assert axes.get_title(loc="left").startswith(f"{name}: ")
        np.testing.assert_array_equal(axes.get_lines()[1].get_ydata()[:-1], joint.size)


def test_extremes_are_the_figures() -> None:
    figures = read_off("kim-chung-a")
    for picture, key in (("velocity", "speed"), ("acceleration", "acceleration")):
        told = words(drawn("kim-chung-a")[picture])
        for which in ("max", "min"):
            value = figures[f"{which}_{key}.value"]
            at = degrees(figures[f"{which}_{key}.crank_angle"])
            assert f"{value:.4g} at {at:.1f}°" in told
    told = words(drawn("kim-chung-a")["ratio-coupler"])
    assert f"\N{MINUS SIGN}{-figures['ratio.coupler.min']:.4g} at " in told


def test_entry_lowest_and_exit_are_told() -> None:
    for name in BUNDLED:
        told = words(drawn(name)["velocity"])
        for event in ("entry", "lowest", "exit"):
            angle = degrees(read_off(name)[f"{event}.crank_angle"])
            assert f"{angle:.1f}°" in told and event in told
        assert ("right to left" in told) == (name != "kim-chung-a")


@pytest.mark.parametrize("turned", np.radians([0, 40, 80, 120, 160, 200, 240, 280, 320]))
@pytest.mark.parametrize("name", BUNDLED)
def test_the_stay_in_the_soil_is_shaded(name: str, turned: float) -> None:
    """Also where it passes 360 deg: the same machine with the axes of its crank turned."""
    machine = eq.load(name)
    back = np.exp(-1j * turned)
    points = {
        point: ((z := complex(*place) * back).real, z.imag)
        for point, place in machine.links["crank"].points.items()
    }
    figures = plant(machine.with_link("crank", points=points))
    spans = soil_spans(figures)
    assert sum(high - low for low, high in spans) == pytest.approx(figures["soil.crank_travel"])
    theta = np.linspace(0, tau, 721)[:-1] + 1e-3
    shaded = np.any([(theta > low) & (theta < high) for low, high in spans], axis=0)
    below = figures.curve.height(theta[None])[0] < figures["surface"]
    np.testing.assert_array_equal(shaded, below)


def test_both_paths_are_drawn_to_one_scale() -> None:
    for name in BUNDLED:
        for axes in drawn(name)["path"].axes:
            (x0, y0), (x1, y1) = axes.transData.transform([(0, 0), (1, 1)])
            assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-9)
        machine, ground = drawn(name)["path"].axes
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
    figure = drawings(still)["path"]
    assert len(figure.axes) == 1
    assert "over ground" not in words(figure)
    assert len(drawn("kim-chung-a")["path"].axes) == 2


def test_matplotlib_waits_until_it_is_needed() -> None:
    program = (
        "import sys, equipoise as eq, equipoise.cli\n"
        "from equipoise.planting.summary import plant\n"
        "plant(eq.load('kim-chung-a'))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
        "import equipoise.plotting.planting\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
