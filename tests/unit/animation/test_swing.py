"""Supports that swing in moving pictures, held to the response that they are to show."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.animation import Moving, MovingGroup, animated_svg, laid_out
from equipoise.figures.stage import beyond
from equipoise.figures.swing import LARGEST, in_mode, swinging
from equipoise.mechanism.parts.support import unit_vector
from equipoise.symbols.carrier import MOUNT
from equipoise.symbols.scene import Scene
from equipoise.vibration.body import SupportBody
from support.refusals import refused

ON_MOUNTS = ("yamashita-rig", "sieve", "exudyn-slider-crank", "walking-transplanter")
COUNT = 240


@cache
def response(name: str) -> eq.vibration.Response:
    return eq.respond(eq.load(name))


@cache
def scene_of(name: str, factor: float | None = None) -> Scene:
    scene = Scene.of(eq.move(eq.load(name), COUNT))
    return swinging(scene, response(name), factor)


def printed_factor(scene: Scene) -> float:
    """The factor that the picture tells."""
    match = re.search(r"([\d.e+]+) times", scene.swing.captions[0])
    return float(match[1]) if match else 1.0


def through(part: MovingGroup, point: complex) -> np.ndarray:
    """Where a point of a part's own axes is, pixels, (K,)."""
    moves = part.moves
    local = point.real * moves.stretch + 1j * point.imag
    return moves.place + local * np.exp(1j * moves.angle)


def with_role(drawn: Moving, role: str) -> list[MovingGroup]:
    return [part for part in drawn.parts if any(stroke.role == role for stroke in part.strokes)]


@pytest.mark.parametrize("name", ON_MOUNTS)
def test_gauges_move_by_the_reported_factor_times_the_response(name: str) -> None:
    scene = scene_of(name)
    drawn, factor = laid_out(scene), printed_factor(scene)
    stage = drawn.stage
    at = stage.chosen % COUNT
    (part,) = with_role(drawn, "gauge")
    for label, gauge in scene.carrier.support.gauges.items():
        if gauge.point is None:
            continue
        place = complex(*gauge.point[:2])
        rest = stage.scale * place.conjugate()
        middles = [np.mean(stroke.points) for stroke in part.strokes if stroke.role == "gauge"]
        assert min(abs(middle - rest) for middle in middles) < 1e-6
        moved = (through(part, rest) - stage.at(place)) / stage.scale
        along = np.array(unit_vector(gauge.direction)[:2])
        read = along[0] * moved.real - along[1] * moved.imag
        signal = response(name).gauges[label].displacement
        wanted = factor * (signal.values(scene.crank_angle[at]) - signal.mean)
        reach = np.max(np.abs(wanted))
        angle = np.max(np.abs(scene.swing.angle))
        np.testing.assert_allclose(read, wanted, atol=1e-9 + angle * reach + angle**2 * 1.5)


def test_what_is_drawn_of_the_rig_is_not_what_is_drawn_of_its_linkage() -> None:
    low, high = scene_of("yamashita-rig").box
    rig = animated_svg(scene_of("yamashita-rig"), title="")
    alone = animated_svg(Scene.of(eq.move(eq.load("yamashita-1"), COUNT)), title="")
    assert "movement of the support" in rig and "movement of the support" not in alone
    swing = scene_of("yamashita-rig").swing
    tilt = np.ptp(swing.angle)
    assert tilt * 1.5 > 0.02 * (high - low).real  # 1.5 m from the pivot


@pytest.mark.parametrize("name", [*ON_MOUNTS, "riding-transplanter"])
def test_movement_is_seen_and_stays_in_the_picture(name: str) -> None:
    scene = scene_of(name)
    low, high = scene.box
    size = max((high - low).real, (high - low).imag)
    corners = [low, high, complex(low.real, high.imag), complex(high.real, low.imag)]
    reach = max(np.max(np.abs(scene.swung(corner) - corner)) for corner in corners)
    assert reach <= LARGEST * size * 1.01 or printed_factor(scene) == 1
    assert reach > 0.2 * LARGEST * size
    for factor in (None, 20.0):
        low, high = scene_of(name, factor).swept_box
        drawn = laid_out(scene_of(name, factor))
        for place in scene_of(name, factor).places.values():
            moved = drawn.stage.at(scene_of(name, factor).swung(place))
            assert np.all((moved.real >= 0) & (moved.real <= drawn.stage.width))
            assert np.all((moved.imag >= 0) & (moved.imag <= drawn.stage.height))


@pytest.mark.parametrize("name", ON_MOUNTS)
def test_struts_reach_from_the_support_to_a_ground_that_stands_still(name: str) -> None:
    scene = scene_of(name)
    drawn = laid_out(scene)
    length = MOUNT[0] * drawn.stage.unit
    mounts = [m for m in scene.carrier.support.mounts.values() if m.point is not None]
    struts = [part for part in with_role(drawn, "mount") if np.any(part.moves.stretch != 1)]
    assert len(struts) == len(mounts)
    for strut, mount in zip(struts, mounts, strict=True):
        assert np.ptp(through(strut, length).real) < 1e-6 > np.ptp(through(strut, length).imag)
        held = drawn.stage.at(scene.swung(complex(*mount.point[:2])))[drawn.stage.chosen % COUNT]
        np.testing.assert_allclose(through(strut, 0j), held, atol=1e-6)
    if scene.carrier.support.pivot is not None:
        assert np.ptp(abs(scene.swung(scene.carrier.reference))) < 1e-12


def test_the_tip_runs_along_its_path() -> None:
    drawn = laid_out(scene_of("yamashita-rig"), ["P"])
    (path,) = (s for part in drawn.parts for s in part.strokes if s.role == "trace")
    (part,) = with_role(drawn, "tip")
    (tip,) = (s for s in part.strokes if s.role == "tip")
    for place in through(part, complex(tip.points[0])):
        assert np.min(np.abs(path.points - place)) < 2


def test_what_moves_across_the_drawing_is_reported() -> None:
    captions = scene_of("riding-transplanter").swing.captions
    motion = response("riding-transplanter").motion
    roll = motion.values(np.linspace(0, 2 * np.pi, 721))[3]
    assert len(captions) == 2 and captions[1].startswith("across the drawing, not shown: sway ")
    assert f"roll {np.degrees(np.ptp(roll) / 2):.4g} deg" in captions[1]
    assert len(scene_of("sieve").swing.captions) == 1
    assert scene_of("sieve", 1.0).swing.captions == ("movement of the support to scale",)


def test_a_mode_swings_the_support_and_leaves_the_crank() -> None:
    free = eq.modes(eq.load("sieve"))
    for number, mode in enumerate(free.modes, 1):
        scene = in_mode(free, number)
        assert all(np.ptp(angle) == 0 for angle in scene.angles.values())
        assert scene.drive.sense == 0
        surge = np.fft.fft(scene.swing.place.real)[1] / np.fft.fft(scene.swing.angle)[1]
        assert surge == pytest.approx(mode.shape[0] / mode.shape[2], rel=1e-6, abs=1e-9)
        assert f"{mode.cycles_per_second:.4g} Hz" in scene.swing.captions[0]
        assert laid_out(scene).stage.closed
    for wrong in (0, 4):
        with refused(UsageError, count=3):
            in_mode(free, wrong)
    with refused(UsageError, across="sway and roll and yaw", number=1):
        in_mode(eq.modes(eq.load("riding-transplanter")), 1)


@pytest.mark.parametrize("model", ["moment", "torque", "coupled", "exact"])
def test_the_motion_of_a_response_is_what_gauges_read(model: str) -> None:
    machine = eq.load("sieve")
    result = eq.respond(machine, model=model)
    body = SupportBody(machine)
    for name, gauge in machine.support.gauges.items():
        read = replace(result.motion, amplitudes=body.row(gauge) @ result.motion.amplitudes)
        shown = result.gauges[name].displacement
        theta = np.linspace(0, 2 * np.pi, 50)
        off = np.abs(read.values(theta) - shown.values(theta))
        assert np.max(off) < (1e-5 if model == "exact" else 1e-12)


def test_names_of_gauges_stand_where_no_link_passes() -> None:
    for name in ("walking-transplanter", "riding-transplanter", "yamashita-rig"):
        drawn = laid_out(scene_of(name))
        carrier = scene_of(name).carrier
        named = carrier.named(carrier.support.gauges)
        names = [", ".join(names) for names in named.values()]
        (label,) = (label for label in drawn.labels if label.text in names)
        left, top, right, bottom = label.box(drawn.stage.size_of_type)
        x, y = drawn.stage.links.real, drawn.stage.links.imag
        passing = (x > left) & (x < right) & (y > top) & (y < bottom)
        assert np.mean(passing) < 0.01


def test_names_of_gauges_stand_beside_mounts() -> None:
    """The sieve's stood on the springs below its crank."""
    stage = laid_out(scene_of("sieve")).stage
    (label,) = (label for label in laid_out(scene_of("sieve")).labels if "stand" in label.text)
    left, top, right, bottom = label.box(stage.size_of_type)
    size = 40 * stage.unit  # of the sign of a mount
    for item in eq.load("sieve").support.mounts.values():
        at = complex(stage.at(complex(*item.point[:2])))
        beside = not (left - size < at.real < right + size and top - size < at.imag < bottom)
        assert beside, label


@pytest.mark.parametrize("width", [150, 440, 640])
def test_texts_are_whole_in_pictures_of_any_width(width: int) -> None:
    scene = scene_of("riding-transplanter")
    drawn = laid_out(scene, ["P"], width=width)
    lines = [line for line, _ in drawn.stage.lines if line]
    assert " ".join(lines[::-1]) == " ".join((*beyond(scene), *scene.swing.captions))
    assert set(lines) <= {label.text for label in drawn.labels}
