"""What a notebook's reader meets first: lines, pictures, tables, and quantities given as text."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.refusals import refused

FOUR_BAR = eq.load("yamashita-1")
RIG = eq.load("yamashita-rig")
RPM = np.pi / 30


# -- a line ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["yamashita-1", "rotary-transplanter", "twin-engine"])
def test_what_is_large_is_one_line(name: str) -> None:
    """With a name or a size for what it holds; none prints its arrays."""
    machine = eq.load(name)
    analysis = eq.analyze(machine)
    motion, forces = analysis.motion, analysis.forces
    for value in (machine, motion, forces):
        line = repr(value)
        assert machine.title in line and len(line) < 200 and "\n" not in line
    assert "rpm" in repr(machine) and f"{len(motion.crank_angle)} crank angles" in repr(motion)
    for value in (motion.linkage, motion.links, motion.points, forces.joints, forces.split,
                  analysis.by_order, analysis.summary, eq.mechanism.regressor(motion),
                  *motion.points.values(), *forces.joints.values()):  # fmt: skip
        assert len(repr(value)) < 500 and "\n" not in repr(value), type(value)
    point, joint = next(iter(motion.points.values())), next(iter(forces.joints))
    assert repr(point).startswith(f"PointMotion(place=array{point.x.shape}")
    assert repr(forces.joints).startswith(f"{{{joint!r}: JointForce")


# -- a notebook ------------------------------------------------------------------------------------


def picture_in(html: str) -> str:
    (data,) = re.findall(r'src="data:image/svg\+xml;base64,([^"]+)"', html)
    return base64.b64decode(data).decode()


def test_a_machine_without_a_crank_has_cycles_in_its_line() -> None:
    machine = eq.load("hydraulic-loader")
    for value in (machine, eq.move(machine, 90)):
        assert "6.000 cycles a minute" in repr(value)
        assert "rpm" not in repr(value) and "crank" not in repr(value)


@pytest.mark.parametrize("angles", [24, [0.0, 0.3]])
def test_a_notebook_draws_a_machine_and_its_motion_and_tabulates_forces(angles: Any) -> None:
    motion = eq.move(FOUR_BAR, angles)
    machine, moved, exerted = (item._repr_html_() for item in (FOUR_BAR, motion, eq.forces(motion)))
    for html in (machine, moved):
        assert picture_in(html).startswith("<svg") or "<svg" in picture_in(html)[:200]
    assert "Links; places in the axes of each link" in machine
    assert "Links: angle, angular velocity and acceleration" in moved
    assert "On frame and drive" in exerted and "<table" in exerted
    assert all(FOUR_BAR.title in html for html in (machine, moved, exerted))


def test_a_notebook_shows_a_machine_that_cannot_turn() -> None:
    """Swinging where it can; without a picture, and with the reason, where nothing joins it."""
    short = FOUR_BAR.with_point("coupler", "C", (0.06, 0.0))
    assert "<svg" in picture_in(short._repr_html_())[:200]
    apart = FOUR_BAR.with_point("frame", "D", (5.0, 0.0))
    html = apart._repr_html_()
    assert "<img" not in html and "Links; places in the axes" in html
    with pytest.raises(eq.EquipoiseError) as caught:
        eq.move(apart)
    assert caught.value.message().partition(";")[0][:40] in unescape(html)


def test_a_notebook_shows_a_tool() -> None:
    assert "<table" in eq.load("brush-cutter")._repr_html_()
    assert repr(eq.load("brush-cutter")) == "<Tool 'Brush cutter with loop handle'>"


# -- pictures --------------------------------------------------------------------------------------


def test_plot_gives_a_figure_that_a_notebook_shows() -> None:
    analysis = eq.analyze(FOUR_BAR, 90)
    figure = analysis.plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert analysis.pictures[0] == "linkage" and "torque" in analysis.pictures
    before = figure._repr_png_()
    figure.axes[0].text(10, 10, "mine")
    assert figure._repr_png_() != before  # what is shown is the figure as it is
    with refused(eq.EquipoiseError, name="torque", given="torqe"):
        analysis.plot("torqe")


def test_plot_draws_into_axes() -> None:
    """All inside of these, as large as fits, and nothing in others."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4))
    canvas = FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    right.plot([0, 1], [0, 1])
    assert eq.analyze(FOUR_BAR, 90).plot("torque", ax=left) is figure
    canvas.draw()
    assert len(right.lines) == 1 and not right.texts
    room = left.get_window_extent(canvas.get_renderer())
    for text in left.texts:
        box = text.get_window_extent(canvas.get_renderer())
        # letters of another size than those that the layout measured may be a pixel wider
        assert room.x0 - 2 <= box.x0 and box.x1 <= room.x1 + 2, text
        assert room.y0 - 2 <= box.y0 and box.y1 <= room.y1 + 2, text
    assert {"drive torque, N m"} <= {text.get_text() for text in left.texts}


# -- quantities as text ----------------------------------------------------------------------------

SAME: dict[str, tuple[Callable[[], Any], Callable[[], Any]]] = {
    "analyze": (
        lambda: eq.analyze(FOUR_BAR, 12, "300 rpm", "2 rad/s^2").forces.drive_torque,
        lambda: eq.analyze(FOUR_BAR, 12, 300 * RPM, 2.0).forces.drive_torque,
    ),
    "at": (
        lambda: eq.forces(eq.move(FOUR_BAR, 12)).at("300 rpm").drive_torque,
        lambda: eq.forces(eq.move(FOUR_BAR, 12)).at(300 * RPM).drive_torque,
    ),
    "respond": (
        lambda: eq.respond(RIG, "150 rpm").gauges["gauge"].displacement.amplitudes,
        lambda: eq.respond(RIG, 150 * RPM).gauges["gauge"].displacement.amplitudes,
    ),
    "sweep_speed": (
        lambda: eq.vibration.sweep_speed(RIG, "100 rpm", "200 rpm", speeds=5).speed,
        lambda: eq.vibration.sweep_speed(RIG, 100 * RPM, 200 * RPM, speeds=5).speed,
    ),
    "simulate": (
        lambda: eq.simulate(RIG, "0.2 s", "100 rpm").gauges["gauge"],
        lambda: eq.simulate(RIG, 0.2, 100 * RPM).gauges["gauge"],
    ),
    "plant": (
        lambda: eq.plant(eq.load("transplanter"), "100 rpm")["max_acceleration.value"],
        lambda: eq.plant(eq.load("transplanter"), 100 * RPM)["max_acceleration.value"],
    ),
    "arranged": (
        lambda: eq.balancing.arranged(FOUR_BAR, "2 opposed", "300 mm").rows[1].lateral,
        lambda: eq.balancing.arranged(FOUR_BAR, "2 opposed", 0.3).rows[1].lateral,
    ),
    "keys": (
        lambda: FOUR_BAR.with_drive(speed="300 rpm").with_link("crank", mass="199 g"),
        lambda: FOUR_BAR.with_drive(speed=300 * RPM).with_link("crank", mass=0.199),
    ),
    "places": (
        lambda: FOUR_BAR.with_point("crank", "B", ("40 mm", 0)),
        lambda: FOUR_BAR.with_point("crank", "B", (0.04, 0.0)),
    ),
    "parts": (
        lambda: eq.Slider("piston", "C", "frame", "A", direction="90 deg"),
        lambda: eq.Slider("piston", "C", "frame", "A", direction=np.pi / 2),
    ),
    "mounts": (
        lambda: eq.Mount(point=("-30 mm", "0 mm"), stiffness="40 kN/m", damping=60.0),
        lambda: eq.Mount(point=(-0.03, 0.0), stiffness=4e4, damping=60.0),
    ),
}


@pytest.mark.exhaustive(
    but=["analyze", "arranged", "at", "keys", "parts", "mounts", "places", "respond", "simulate"]
)
@pytest.mark.parametrize("name", SAME)
def test_a_text_with_a_unit_is_the_same_number(name: str) -> None:
    """To the last digit or two: a text is rounded once, a product twice."""
    by_text, by_number = (make() for make in SAME[name])
    if isinstance(by_text, eq.Machine):
        by_text, by_number = (
            eq.analyze(item, 12).forces.drive_torque for item in (by_text, by_number)
        )
    if isinstance(by_text, eq.Slider | eq.Mount):
        assert by_text == by_number
    else:
        np.testing.assert_allclose(by_text, by_number, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (lambda: eq.analyze(FOUR_BAR, speed="300"), {"given": "'300'"}),
        (lambda: eq.respond(RIG, "3 mm"), {"given": "'3 mm'"}),
        (
            lambda: FOUR_BAR.with_link("crank", mass="1,5 kg"),
            {"place": "links.crank.mass", "given": "'1,5 kg'"},
        ),
        (lambda: eq.Link({"A": ("0 mm", "0")}), {"place": "points", "given": "'0'"}),
        (lambda: eq.vibration.sweep_speed(RIG, "1 rpm", "x"), {"given": "'x'"}),
    ],
)
def test_a_wrong_text_is_refused_with_its_argument(
    make: Callable[[], Any], expected: dict[str, Any]
) -> None:
    with refused(eq.EquipoiseError, **expected):
        make()


# -- what else is looked for -----------------------------------------------------------------------


# Reports of files: tests/surface/test_report.py.
@pytest.mark.exhaustive
def test_a_machine_is_reported_as_its_file_is(tmp_path: Path) -> None:
    """The page is the same but for the name that the file has."""
    path = tmp_path / "made.toml"
    eq.save(FOUR_BAR, path)
    eq.report(path, tmp_path / "file.html")
    eq.report(FOUR_BAR, tmp_path / "machine.html")
    by_file, by_machine = (
        (tmp_path / f"{name}.html").read_text(encoding="utf-8") for name in ("file", "machine")
    )
    assert by_file.replace("made.toml", FOUR_BAR.title) == by_machine
    faster = tmp_path / "faster.html"
    eq.report(FOUR_BAR, faster, speed="300 rpm")
    assert "300" in faster.read_text(encoding="utf-8")


def test_a_report_of_a_machine_that_has_no_file_needs_a_name() -> None:
    with refused(eq.EquipoiseError, place="report"):
        eq.report(FOUR_BAR)


def test_dir_shows_what_is_public() -> None:
    assert dir(eq.signals) == sorted(eq.signals.__all__)
