"""Andrews' squeezing mechanism from rest to 0.03 s, beside Radau IIA on its equations.

The peer is SciPy's `Radau`, the method of RADAU5, at a tolerance of 1e-8, on the equations of the
test set for initial value problems with the acceleration constraints (index 1): an angle a link,
the six equations that close the loops, and their multipliers.  They are written anew here, from the
masses and arms of the bundled model.  `equipoise.run` integrates to 1e-11 always, and its time
holds the table of the mechanism over a turn; the model is read and assembled anew in each round.

Both are held against the reference solution of the test set.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import equipoise as eq
from timing import in_turn, report

END, START = 0.03, -0.0617138900142764496358948458001
REFERENCE = np.array([15.81077119629904, 1139.920302151208])
"""beta, rad, and its rate, rad/s, at the end."""
TOLERANCE = 1e-8
ROUNDS = 5
LINKS = ("K1", "K2", "K3", "K4", "K5", "K6", "K7")
CHAINS = {
    "K1": [],
    "K2": [("K1", "F")],
    "K3": [],
    "K4": [("K5", "G")],
    "K5": [],
    "K6": [("K7", "H")],
    "K7": [],
}
"""Points by which each link hangs from the frame."""


class Equations:
    """M a = f + G' l with G a = -g, by the angles (7,) of all links.

    centers, pins : arms (B, 7), m, as complex numbers in the axes of each link: of the centres of
        mass, and of pin E as a point of K1-K2, K3, K5-K4 and K7-K6.
    """

    def __init__(self, machine: eq.Machine) -> None:
        self.links = [machine.links[name] for name in LINKS]
        self.mass = np.array([link.mass for link in self.links])
        self.inertia = np.diag([link.inertia for link in self.links])
        self.centers = np.array([self._arms(name) for name in LINKS])
        self.pins = np.array([self._arms(name, "E") for name in ("K2", "K3", "K4", "K6")])
        self.spring = machine.springs[0]
        self.hook = complex(*machine.frame["C"]) - complex(*machine.frame["B"])
        self.arm = complex(*self.links[2].points["D"])
        self.torque = machine.drive.motor.torque

    def _arms(self, name: str, point: str = "") -> np.ndarray:
        arms = np.zeros(len(LINKS), dtype=complex)
        for link, end in CHAINS[name]:
            arms[LINKS.index(link)] = complex(*self.links[LINKS.index(link)].points[end])
        own = self.links[LINKS.index(name)]
        arms[LINKS.index(name)] = complex(*(own.points[point] if point else own.center_of_mass))
        return arms

    def rates(self, _: float, state: np.ndarray) -> np.ndarray:
        """Rates (14,) by time of angles and their rates."""
        angle, rate = np.split(state, 2)
        turn = np.exp(1j * angle)
        ways, drift = self.centers * 1j * turn, self.centers @ (-turn * rate**2)
        mass = (ways.conj().T * self.mass @ ways).real + self.inertia
        force = -(ways.conj().T @ (self.mass * drift)).real
        arm = self.arm * turn[2]
        pull = self.hook - arm
        tension = self.spring.stiffness * (1 - self.spring.free_length / abs(pull))
        force[2] += tension * ((1j * arm).conjugate() * pull).real
        force[0] += self.torque
        loops = (self.pins[1:] - self.pins[0]) * 1j * turn
        closing = (self.pins[1:] - self.pins[0]) @ (turn * rate**2)
        slopes = np.concatenate([loops.real, loops.imag])
        right = np.concatenate([force, closing.real, closing.imag])
        matrix = np.block([[mass, slopes.T], [slopes, np.zeros((len(slopes), len(slopes)))]])
        return np.concatenate([rate, np.linalg.solve(matrix, right)[: len(angle)]])


def by_radau(machine: eq.Machine, start: np.ndarray) -> np.ndarray:
    """beta and its rate at the end, by Radau IIA."""
    state = np.concatenate([start, np.zeros(len(LINKS))])
    rates = Equations(machine).rates
    found = solve_ivp(rates, (0, END), state, "Radau", rtol=TOLERANCE, atol=TOLERANCE)
    return found.y[[0, len(LINKS)], -1]


def by_equipoise() -> np.ndarray:
    """beta and its rate at the end, by `equipoise.run`."""
    found = eq.run(eq.load("squeezing-mechanism"), END, angle=START)
    return np.array([found.crank_angle[-1], found.crank_speed[-1]])


def main() -> None:
    """Run both in turn, and print errors and times."""
    machine = eq.load("squeezing-mechanism")
    links = eq.move(machine, [START]).links
    start = np.array([float(links[name].angle[0]) for name in LINKS])
    tasks = {"equipoise": by_equipoise, "Radau IIA": lambda: by_radau(machine, start)}
    for name, task in tasks.items():
        angle, rate = np.abs(task() - REFERENCE) / REFERENCE
        print(f"{name:<10} off by {angle:.1e} of the angle and {rate:.1e} of its rate")
    report(in_turn(tasks, ROUNDS), "Radau IIA", 1e-3, "ms")


if __name__ == "__main__":
    main()
