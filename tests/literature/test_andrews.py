"""Andrews' squeezing mechanism: seven links set in motion by a constant torque, against a spring.

W. Schiehlen (ed.), "Multibody systems handbook" (1990), with the constants and the reference
solution of the test set for initial value problem solvers (F. Mazzia, C. Magherini, University of
Bari), in the example `squeezing-mechanism`.  The axes of links K1 to K7 are such that the test
set's coordinates beta, beta + Theta + pi, gamma, Phi + delta, delta, Omega + epsilon and epsilon
are their angles.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.running.run_results import Run

START = -0.0617138900142764496358948458001
"""beta at the start, rad; the linkage is at rest there."""
ANGLES = {"K3": 0.455279819163070380, "K5": 0.487364979543842550, "K7": 1.23054744454982119}
"""gamma, delta and epsilon at the start, rad."""
AT_E = {
    "E/K3": (199.17533, -29.75531),
    "E/K4": (23.06654, 31.45271),
    "E/K6": (22.64249, 11.61741),
}
"""Forces in the pins at E at 0.03 s, N, of another program, to their last digit."""


@cache
def andrews() -> Run:
    return eq.run(eq.load("squeezing-mechanism"), 0.03, angle=START)


def test_the_linkage_at_the_start() -> None:
    links = eq.move(andrews().machine, [START]).links
    actual = {name: float(links[name].angle[0]) for name in ANGLES}
    assert actual == pytest.approx(ANGLES, abs=1e-14)


def test_the_state_at_the_end() -> None:
    """Integrated at tolerances of 1e-11, of which a hundredfold is left after 0.03 s."""
    result = andrews()
    assert result.end.kind == "time"
    assert result.crank_angle[-1] == pytest.approx(15.81077119629904, rel=1e-9)
    assert result.crank_speed[-1] == pytest.approx(1139.920302151208, rel=1e-9)
    assert result.energy_error < 1e-9


def test_the_file_holds_its_own_run() -> None:
    """Without options, and each option in the place of what the file says."""
    machine = eq.load("squeezing-mechanism")
    run = eq.run(machine)
    assert run.end.kind == "time"
    assert run.end.time == 0.03
    assert run.crank_angle[-1] == pytest.approx(15.81077119629904, rel=1e-9)
    assert eq.run(machine, turns=0.5).turned == pytest.approx(0.5)
    assert eq.run(machine, 1e-3, angle=0.0).crank_angle[0] == 0.0


def test_forces_in_the_pins_at_the_end() -> None:
    """The drive's torque of an analysis in this state is the motor's."""
    result = andrews()
    angle, speed = float(result.crank_angle[-1]), float(result.crank_speed[-1])
    inertia, slope, torques = result.equation.at(angle, speed)
    acceleration = (float(np.sum(torques)) + 0.033 - slope * speed**2 / 2) / inertia
    forces = eq.forces(eq.move(result.machine, [angle], speed, acceleration))
    assert forces.drive_torque[0] == pytest.approx(0.033, abs=1e-9)
    for name, wanted in AT_E.items():
        force = forces.solved.contacts[name]
        # 200 N follow the square of a rate that is known to 1e-10; the last digit is 1e-5 N
        assert (force.x[0], force.y[0]) == pytest.approx(wanted, abs=5e-5), name
