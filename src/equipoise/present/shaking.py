"""The shaking force of all rows together: its size, its loudest order, where it acts."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.quantities import angle
from equipoise.signals import Array, Figures, harmonics

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.present.findings import Findings
    from equipoise.results.analysis import Analysis


NOTHING = 1e-9
"""Over the largest size of a signal: what is smaller is rounding."""


@dataclass(frozen=True, eq=False)
class Shaking:
    """The shaking force of all rows together.

    force : complex (N,), N, at the crank angles of a motion over a whole cycle.
    """

    machine: Machine
    motion: Motion
    force: Array

    @classmethod
    def of(cls, findings: Findings) -> Shaking:
        """From the analysis; what is rounding is 0."""
        analysis = findings.analysis.resolved
        force = analysis.together.get("shaking_force", analysis.forces.shaking_force.value)
        parts = analysis.forces.split.by_link("shaking_force").values()
        scale = max(float(np.max(np.abs(part))) for part in parts)
        scale = max(scale, analysis.summary["frame_force"].peak)
        if np.max(np.abs(force)) <= NOTHING * scale:
            force = np.zeros_like(force)
        return cls(findings.machine, analysis.motion, force)

    @cached_property
    def size(self) -> Figures:
        """Figures of its size."""
        return self.motion.figures(np.abs(self.force))

    @property
    def over_weight(self) -> float:
        """Peak over the weight of the links; 0 without gravity."""
        weight = self.machine.mass * hypot(*self.machine.gravity)
        return self.size.peak / (weight * max(1, len(self.machine.rows))) if weight else 0.0

    @cached_property
    def loudest(self) -> tuple[float, float]:
        """Order with the largest share of the mean square, the mean left out, and that share."""
        parts = (self.force.real, self.force.imag)
        if self.motion.sampling is None:
            orders = [harmonics(part) for part in parts]
        else:
            orders = [self.motion.periodic(part).amplitudes for part in parts]
        squares = np.sum(np.abs(orders) ** 2, axis=0)
        squares[0] = 0.0
        top = int(np.argmax(squares))
        return top / self.motion.turns, float(squares[top] / (np.sum(squares) or 1.0))


def direction(force: Array) -> tuple[float, float]:
    """Along which most of the mean square of a force (N,), complex, acts, and that share.

    In rad, from 0 to less than pi.
    """
    parts = np.vstack([force.real, force.imag])
    values, vectors = np.linalg.eigh(parts @ parts.T)
    share = float(values[1] / (np.sum(values) or 1.0))
    x, y = vectors[:, 1]
    return float(np.arctan2(y, x) % pi), share


STRETCHED, ROUND = 0.8, 0.6
"""Share of the mean square along one direction: from where, and up to where, it is called so."""


def acting(force: Array) -> str:
    """The way in which a force (N,), complex, acts, as a title has it."""
    way, share = direction(force)
    if share <= ROUND:
        return say("The force acts in all directions alike, turning with the crank")
    if share >= STRETCHED and abs(sin(way)) > cos(pi / 6):
        return say("The force acts mostly up and down")
    if share >= STRETCHED and abs(cos(way)) > cos(pi / 6):
        return say("The force acts mostly to and fro")
    return say("The force acts mostly along {angle} from the x axis", angle=angle(way))


def largest_joint(analysis: Analysis) -> tuple[str, Figures]:
    """The joint whose force is the largest, and figures of that force."""
    by_name = {name: analysis.summary[f"joints.{name}"] for name in analysis.forces.joints}
    name = max(by_name, key=lambda name: by_name[name].peak)
    return name, by_name[name]


def largest_of(sizes: Mapping[str, float]) -> tuple[str, float]:
    """Name and size of the largest of some; of equal ones the first."""
    top = max(sizes.values(), default=0.0)
    name = next((name for name, size in sizes.items() if size >= (1 - NOTHING) * top), "")
    return name, top
