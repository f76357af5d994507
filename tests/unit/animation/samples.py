"""Machines to animate, each with its scene and the arrow of its shaking force."""

from __future__ import annotations

from dataclasses import replace

import equipoise as eq
from equipoise.figures.stage import Arrow
from equipoise.results.analysis import Analysis
from equipoise.symbols.scene import Scene


def analyzed(name: str, angles: int = 720) -> tuple[Analysis, Scene, Arrow]:
    return prepared(eq.analyze(eq.load(name), angles))


def prepared(found: Analysis) -> tuple[Analysis, Scene, Arrow]:
    arrow = Arrow(found.forces.about, found.forces.shaking_force.value)
    return found, Scene.of(found.motion), arrow


def three_turns(angles: int) -> Analysis:
    """A planetary arm whose tip is back after three turns."""
    arm = eq.load("planetary-planting-arm")
    first, second = arm.gears
    return eq.analyze(replace(arm, gears=(first, replace(second, teeth=(40, 30)))), angles)
