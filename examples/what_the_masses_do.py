"""Regressor and base parameters: which masses count, and an optimum without a search.

The shaking force is linear in the masses, so the counterweight on the crank that makes its mean
square smallest is the solution of a least-squares problem.
"""

import numpy as np

import equipoise as eq

machine = eq.load("lee-kim-b")
print("shaking force depends on these combinations only:")
print(eq.mechanism.base_parameters(machine, ["shaking_force"]))

found = eq.mechanism.regressor(eq.move(machine))
names = [f"{link}.{quantity}" for link, quantity in found.parameters]
free = [names.index("crank.moment_x"), names.index("crank.moment_y")]

force = found.values @ found.shaking_force
rows = found.shaking_force[free].T
step, *_ = np.linalg.lstsq(
    np.concatenate([rows.real, rows.imag]), -np.concatenate([force.real, force.imag]), rcond=None
)
values = found.values.copy()
values[free] += step

print("first moment of the crank, g mm    RMS shaking force, N")
for parameters in (found.values, values):
    force = parameters @ found.shaking_force
    x, y = 1e6 * parameters[free]
    print(f"({x:7.0f}, {y:7.0f}) {np.sqrt(np.mean(abs(force) ** 2)):22.2f}")
