"""What work has become of: losses of joints, and how far the balance of energy is from closed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from equipoise.running.drivers import Driver
from equipoise.running.electric import Electric
from equipoise.running.friction import FRICTION
from equipoise.signals import Array

Circuits = Iterable[tuple[Driver, Electric, Array]]
"""Of each direct-current motor its driver, its circuit, and its work (M,) on the machine, J."""


def losses_apart(
    works: Mapping[str, Array], joints: Iterable[str]
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Works (M,), J, in which the friction of all joints is one, and the energy that each joint has
    taken.

    works : of all that acts; of friction in joints by ``friction.JOINT``.
    """
    works = dict(works)
    rubbed = {name: works.pop(f"{FRICTION}.{name}") for name in joints}
    if rubbed:
        works[FRICTION] = np.sum([*rubbed.values()], axis=0)
    return works, {name: -work for name, work in rubbed.items()}


def energy_error(energy: Array, works: Iterable[Array], circuits: Circuits) -> float:
    """Largest difference of kinetic energy (M,), J, and works done, or of what the supply of a
    motor gave and what became of it, over the largest of them all.
    """
    each = np.array([*works]).reshape(-1, len(energy))
    worst = float(np.max(np.abs(energy - energy[0] - np.sum(each, axis=0))))
    size = max(float(np.max(energy)), float(np.max(np.abs(each), initial=0.0)))
    for driver, circuit, work in circuits:
        stored = driver.stored(circuit.current)
        missing = circuit.supply - circuit.heat - (stored - stored[0]) - work
        worst = max(worst, float(np.max(np.abs(missing))))
        size = max(size, float(np.max(np.abs(circuit.supply))))
    return worst / size if size else 0.0
