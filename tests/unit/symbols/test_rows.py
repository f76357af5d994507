"""Rows side by side in one drawing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.animation import animated_svg
from equipoise.figures.linkage import linkage
from equipoise.figures.stage import row_legend
from equipoise.mechanism.parts.support import Row
from equipoise.symbols.pieces import pieces, placed
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape


def scene_of(*rows: Row) -> tuple[Scene, Any]:
    machine = replace(eq.load("four-row-transplanter").with_balance(None), rows=rows)
    motion = eq.analyze(machine, 72).motion
    return Scene.of(motion).with_rows(motion), motion


def pale(scene: Scene, k: int) -> list[Shape]:
    return [shape for shape in placed(scene, pieces(scene), k) if shape.role == "row"]


def test_a_row_is_where_the_linkage_is_a_phase_later() -> None:
    scene, motion = scene_of(Row(), Row(phase=np.pi / 2), Row(phase=np.pi / 2, lateral=0.3))
    shapes = pale(scene, 5)
    later = {name: point.place[5 + 18] for name, point in motion.points.items()}
    corners = [[*body.outline] for body in scene.bodies if len(body.outline) > 1]
    assert len(shapes) == len(corners)  # rows 2 and 3 cover each other
    for shape, names in zip(shapes, corners, strict=True):
        np.testing.assert_allclose(shape.places, [later[name] for name in names], atol=1e-12)
    assert row_legend(scene) == ["row 1: as drawn; rows 2, 3: pale, 90° ahead"]


def test_a_row_beside_the_linkage_is_drawn_there_and_makes_room() -> None:
    scene, _ = scene_of(Row(), Row(offset=(0.1, 0.02)))
    alone = scene_of(Row(), Row())[0]
    (crank, *_), own = pale(scene, 0), alone.places["A"][0]
    assert crank.places[0] == pytest.approx(own + 0.1 + 0.02j)
    assert scene.box[1].real == pytest.approx(alone.box[1].real + 0.1)
    assert row_legend(scene) == ["row 1: as drawn; row 2: pale"]


def test_a_row_far_away_is_reported_and_not_drawn() -> None:
    scene, _ = scene_of(Row(), Row(phase=np.pi, offset=(3.0, 0.0)))
    assert pale(scene, 0) == [] and scene.box == scene_of(Row(), Row())[0].box
    assert row_legend(scene) == ["row 1: as drawn; row 2: beside the drawing, 180° ahead"]


def test_pictures_and_animations_report_rows() -> None:
    analysis = eq.analyze(eq.load("riding-transplanter"), 72)
    chart = linkage(analysis)
    assert "rows 1, 3: as drawn; rows 2, 4: pale, 180° ahead" in chart.words
    assert "rows 2, 4" in {mark.text for mark in chart.panels[0].marks}
    scene = Scene.of(analysis.motion).with_rows(analysis.motion)
    assert 'class="row"' in animated_svg(scene, title="rows", frames=12)
    alone = eq.analyze(eq.load("yamashita-1"), 72).motion
    scene = Scene.of(alone)
    assert scene.with_rows(alone) is scene
