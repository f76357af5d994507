"""Machines to animate, each with its scene and the arrow of its shaking force."""

from __future__ import annotations

import equipoise as eq
from equipoise.figures.stage import Arrow
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene
from unit.figures.samples import three_turns


def analyzed(name: str, angles: int = 720) -> tuple[Analysis, Scene, Arrow]:
    return prepared(eq.analyze(eq.load(name), angles))


def prepared(found: Analysis) -> tuple[Analysis, Scene, Arrow]:
    arrow = Arrow(found.forces.about, found.forces.shaking_force.value)
    return found, Scene.of(found.motion), arrow


def of_three_turns(angles: int) -> Analysis:
    """A planetary arm whose tip is back after three turns."""
    return eq.analyze(three_turns(), angles)
