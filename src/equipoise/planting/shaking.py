"""What inertia does to frame and drive of many designs at once, which a search may keep small."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.family import column
from equipoise.mechanism.assembly.steps import State, p, u
from equipoise.mechanism.dynamics.forces import inertia_moved, massless
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.tip import TipCurve, lowest_within
from equipoise.planting.stroke import Figures, acceleration_of_drive, whole_cycle
from equipoise.signals import Array

Signals = dict[str, Array]


def shaking(curve: TipCurve) -> Figures:
    """RMS and largest value of shaking force, shaking moment about the drive's pivot, and torque
    of the drive without loads, springs and soil; none where masses are missing.
    """
    if massless(curve.machines[0]):
        return {}
    parts = _Parts(curve)
    sampled = parts.signals(curve.grid.state)
    figures: Figures = {}
    for name, values in sampled.items():
        figures[f"{name}.rms"] = np.sqrt(np.mean(values**2, axis=1))
        figures[f"{name}.peak"] = _peak(curve, parts.of(name))
    return figures


def _peak(curve: TipCurve, signal: Callable[[Array], Array]) -> Array:
    samples = len(curve.theta) // 4 + 1
    return -lowest_within(lambda theta: -signal(theta), *whole_cycle(curve), samples=samples)[0]


class _Parts:
    """Inertia of every link about its anchor, as columns."""

    def __init__(self, curve: TipCurve) -> None:
        self.curve = curve
        self.links = {link: self._of(link) for link in curve.machines[0].links}
        self.gravity = column(complex(*machine.gravity) for machine in curve.machines)

    def _of(self, link: str) -> tuple[Array, ...]:
        """Mass, first moment and moment of inertia of a link, (P, 1) each."""
        anchor = self.curve.family.first.anchors[link]
        numbers = (inertia_moved(machine, link, anchor) for machine in self.curve.machines)
        return tuple(map(column, zip(*numbers, strict=True)))

    def of(self, name: str) -> Callable[[Array], Array]:
        """One of the signals."""
        return lambda theta: self.signals(self.curve.family.solve(theta))[name]

    def signals(self, state: State) -> Signals:
        """Sizes of force, moment and torque at the crank angles of a state, (P, K)."""
        curve, family = self.curve, self.curve.family
        pivot = state[f"p({family.first.pivot})"]
        speed2, acceleration = curve.speed**2, acceleration_of_drive(curve)
        shape = np.shape(state["theta"])
        force, moment, torque = np.zeros(shape, complex), np.zeros(shape), np.zeros(shape)
        for link, (mass, first, inertia) in self.links.items():
            place, p1, p2 = (state[name] for name in p(family.first.anchors[link]))
            rotation, w, a = (state[name] for name in u(link))
            pull: Any
            pull, turning = kernels.inertia_demand(
                p1, p2, rotation, w, a, speed2, acceleration, mass, first, inertia
            )
            carried, weight_moment = kernels.weight_demand(rotation, mass, first, self.gravity)
            force = force + pull
            moment = moment + turning + kernels.cross(place - pivot, pull)
            torque = torque + kernels.drive_torque(p1, w, pull + carried, turning + weight_moment)
        return {
            "shaking_force": np.abs(force),
            "shaking_moment": np.abs(moment),
            "drive_torque": np.abs(torque),
        }
