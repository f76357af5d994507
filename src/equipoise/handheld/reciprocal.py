"""Derivatives of what a tool answers by its numbers, from its answers to unit forces.

With K the dynamic stiffness of shaft and stations, K u = F, and K v = e under a unit force where a
hand holds.  K is symmetric, so the motion v . F of that hand has the derivative -v . K' u by any
number: all of them together cost one more run along the shaft for each hand.

K' of what sits at a station is that of its own stiffness.  A position lengthens the segment on its
left and shortens that on its right.  The shaft's energy is the stationary value of the integral of

    V (w' - theta) + M theta' - V^2 / 2 kGA - M^2 / 2 EI + s^2 (rho A w^2 + rho I theta^2) / 2

in which the length of a segment scales everything but the derivatives.  So v . K' u by a length is
the rest, as a product of both answers; it is the same all along the segment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.handheld.chain import CondensedStiffness, NodePair, States, solve
from equipoise.handheld.duals import Dual, value_of
from equipoise.handheld.layout import HarmonicField, Layout
from equipoise.signals import Array

Number = tuple[str, str]
"""Station and key of a number of the tool."""


class Reciprocal:
    """A field and its derivatives by numbers (P,), which its layout must know as changed.

    carried : the stiffness that the field was solved with.
    watched : stations whose motion is asked for.
    """

    def __init__(
        self,
        field: HarmonicField,
        carried: CondensedStiffness,
        watched: Sequence[str],
        numbers: Sequence[Number],
    ) -> None:
        self.field, self.carried, self.numbers = field, carried, numbers
        self.row = {name: k for k, name in enumerate(dict.fromkeys(watched))}

    def moved(self, name: str) -> Dual:
        """Displacement (2, F) of a watched station, m."""
        across = self.field.states.motion[self.field.layout.node_of[name]].across
        if not self.numbers:
            return Dual(across, np.empty((0, *across.shape)))
        return Dual(across, self._slopes[:, self.row[name]])

    def holding(self, name: str) -> Dual:
        """Force over displacement (2, F) on all that holds a station, N/m."""
        station, field = self.field.layout.tool.station(name), self.field
        value = sum(field.layout.on_body(station, field.s).values())
        slopes = np.zeros((len(self.numbers), *np.shape(value)), complex)
        for k, number in enumerate(self.numbers):
            stiffness: Any = sum(self._along(number).on_body(station, field.s).values())
            if isinstance(stiffness, Dual):
                slopes[k] = stiffness.slopes[0]
        return Dual(value, slopes)

    @cached_property
    def _unit(self) -> States:
        """Answers (U, 2, F) to a force of 1 N on each watched station."""
        layout = self.field.layout
        loads: list[NodePair | None] = [None] * len(layout.nodes)
        for name in self.row:
            node = layout.node_of[name]
            force = np.zeros((len(self.row), 1, 1))
            force[[k for item, k in self.row.items() if layout.node_of[item] == node]] = 1.0
            loads[node] = NodePair(force, 0.0)
        return solve(self.carried, loads)

    @cached_property
    def _slopes(self) -> Array:
        """Of the motion of each watched station by each number, (P, U, 2, F)."""
        return np.array([self._by(*number) for number in self.numbers])

    def _by(self, name: str, key: str) -> Array:
        """By one number, (U, 2, F)."""
        layout, s = self.field.layout, self.field.s
        node = layout.node_of[name]
        if key == "position":
            return self._lengthened(node) - self._lengthened(node - 1)
        sits = [layout.tool.station(name)]
        stiffness = self._along((name, key)).sitting(sits, s, s * s, self.field.kind)
        unit, own = self._unit.motion[node], self.field.states.motion[node]
        values = np.zeros((len(self.row), *own.across.shape), complex)
        for part, item, other in zip(stiffness, unit, own, strict=True):
            if isinstance(part, Dual):
                values -= part.slopes[0] * item * other
        return values

    def _lengthened(self, k: int) -> Array:
        """v . K' u by the length of a cell, (U, 2, F)."""
        layout, s = self.field.layout, self.field.s
        beam = layout.beam([layout.cells[k]], s * s, self.field.kind)
        flexibility, shear, mass, rotary = (part[0] for part in beam)
        (w, t), (v, m) = self._unit.motion[k], self._unit.force[k]
        (w_u, t_u), (v_u, m_u) = self.field.states.motion[k], self.field.states.force[k]
        bent = v * t_u + t * v_u + v * (shear * v_u) + m * (flexibility * m_u)
        return np.asarray(w * (mass * w_u) + t * (rotary * t_u) - bent)

    def _along(self, number: Number) -> Layout:
        """The layout with a derivative by a number, for what sits on the shaft."""
        layout = self.field.layout
        value = np.asarray(value_of(layout.changed[number]))
        own = Dual(value, np.ones((1, 1, 1)))
        return replace(layout, changed={**layout.changed, number: own})
