"""What shakes a tool, by orders of its engine's speed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.errors import MassError
from equipoise.mechanism.dynamics import forces, massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import move
from equipoise.signals import Periodic
from equipoise.tools.model import Excitation, Tool

Array = np.ndarray[Any, Any]

ANGLES = 720
"""Crank angles in a turn from which a linkage's orders are taken."""
LEAST, MOST_ORDERS = 1e-6, 60
"""Share of the largest order below which one is left out, and how many are kept at most."""


@dataclass(frozen=True, eq=False)
class Shake:
    """One order of an excitation: the force Re (force * speed^power * exp(i order speed t)).

    order : events in a turn of the engine.
    force : complex (2,), vertical and lateral, N or N s2.
    power : 0 for a force that is the same at all speeds, 2 where it grows with their square.
    """

    name: str
    station: str
    order: float
    force: Array
    power: int

    def at(self, speed: Array) -> Array:
        """Complex amplitudes (2, S), N, at speeds (S,) of the engine, rad/s."""
        return np.asarray(self.force[:, None] * speed**self.power)


def shakes(tool: Tool) -> tuple[Shake, ...]:
    """All orders of all excitations.

    Raises
    ------
    MassError, MotionError : of a linkage that cannot turn or has no masses.
    """
    return tuple(shake for one in tool.excitations for shake in _shakes(one))


def _shakes(one: Excitation) -> Iterable[Shake]:
    if one.linkage is not None:
        yield from _of_linkage(one, one.linkage)
        return
    if one.unbalance is not None:
        force, power = one.unbalance * one.ratio**2 * _turning(one), 2
    else:
        assert one.force is not None
        ahead = np.exp(1j * one.phase)
        along = {"vertical": np.array([ahead, 0]), "lateral": np.array([0, ahead])}
        force, power = one.force * along.get(one.direction, _turning(one)), 0
    yield Shake(one.name, one.station, _order(abs(one.ratio)), force, power)


def _turning(one: Excitation) -> Array:
    """A force of 1 that turns with a shaft: lateral at its angle 0, vertical at a quarter turn."""
    forward = np.array([-1j, 1]) * np.exp(1j * one.phase)
    return np.asarray(forward if one.ratio > 0 else np.conj(forward))


def _order(order: float) -> float:
    """The order without the rounding by which a product of ratios may miss it."""
    return float(f"{order:.12g}")


def _of_linkage(one: Excitation, machine: Machine) -> Iterable[Shake]:
    """The shaking force by orders: minus the rate of change of momentum, of any speed squared."""
    force = unit_shaking_force(machine)
    backward = (one.ratio > 0) != (machine.drive.speed > 0)
    sizes = np.max(force.sizes, axis=0)
    largest = float(np.max(sizes[1:], initial=0.0))
    kept = [k for k in range(1, len(sizes)) if sizes[k] > LEAST * largest]
    for k in sorted(kept, key=lambda k: -sizes[k])[:MOST_ORDERS]:
        order = float(force.orders[k])
        amplitudes = force.amplitudes[:, k] * np.exp(1j * order * one.phase)
        both = np.conj(amplitudes) if backward else amplitudes
        size = one.ratio**2 * both
        yield Shake(one.name, one.station, _order(order * abs(one.ratio)), size, 2)


def unit_shaking_force(machine: Machine) -> Periodic:
    """Shaking force over speed squared (vertical, lateral), N s2, of a linkage at steady speed."""
    if lacking := massless(machine):
        raise MassError(lacking)
    from equipoise.mechanism.linkage import assemble

    turns = assemble(machine).cycle.turns
    motion = move(machine, ANGLES, 1.0, 0.0)
    force = forces(motion).shaking_force
    return Periodic.of(np.array([force.y, force.x]), turns)


def orders_of(all_shakes: Iterable[Shake]) -> Array:
    """Orders (K,) of what shakes, each once, rising."""
    return np.array(sorted({shake.order for shake in all_shakes}))


def loud(all_shakes: Sequence[Shake], speed: float, least: float) -> tuple[Shake, ...]:
    """Orders whose force at a speed, rad/s, is at least a share of the largest."""
    if not all_shakes:
        return ()
    sizes = [float(np.max(np.abs(shake.at(np.array([speed]))))) for shake in all_shakes]
    limit = least * max(sizes)
    return tuple(one for one, size in zip(all_shakes, sizes, strict=True) if size >= limit)
