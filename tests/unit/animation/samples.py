"""Machines to animate, each with its scene and the arrow of its shaking force."""

from __future__ import annotations

import numpy as np

import equipoise as eq
from equipoise.figures.stage import ForceArrow
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene, clear_angle
from unit.figures.samples import three_turns


def analyzed(name: str, angles: int = 720) -> tuple[Analysis, Scene, ForceArrow]:
    return prepared(eq.analyze(eq.load(name), angles))


def prepared(result: Analysis) -> tuple[Analysis, Scene, ForceArrow]:
    arrow = ForceArrow(result.forces.about, result.forces.shaking_force.value)
    return result, Scene.of(result.motion), arrow


def shown(scene: Scene, values: np.ndarray, frames: int) -> np.ndarray:
    """Those of values over all crank angles that a picture with so many frames shows, in order."""
    return np.roll(values, -clear_angle(scene))[:: len(values) // frames]


def of_three_turns(angles: int) -> Analysis:
    """A planetary arm whose tip is back after three turns."""
    return eq.analyze(three_turns(), angles)
