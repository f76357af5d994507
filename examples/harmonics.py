"""Orders of the vertical shaking force, and what a weight on the crank can do about the first.

A weight that turns with the crank makes a force of order 1 with a constant size.  It cannot take
away the first order in both directions, but it can in one.
"""

import numpy as np

import equipoise as eq

machine = eq.load("yamashita-1")
analysis = eq.analyze(machine)
force = analysis.forces.shaking_force

vertical = eq.signals.harmonics(force.y, 5)
print("order   vertical N   share of first")
for order in range(1, 6):
    size = abs(vertical[order])
    print(f"{order:5d} {size:12.2f} {size / abs(vertical[1]):12.2f}")

# A weight at the arm r (complex, in the crank's axes) exerts m r speed^2 outwards; upwards that is
# the real part of -i m r speed^2 exp(i theta).
needed = -vertical[1] / (-1j * analysis.motion.speed**2)  # m r, kg m
direction = np.degrees(np.angle(needed))
print(f"weight on the crank: {1e6 * abs(needed):.0f} g mm at {direction:.0f} deg from its x axis")

crank = machine.links["crank"]
weight, arm = 0.2, needed / 0.2
mass = crank.mass + weight
own = complex(*crank.center_of_mass)
center = (crank.mass * own + weight * arm) / mass
inertia = crank.inertia + crank.mass * abs(own - center) ** 2 + weight * abs(arm - center) ** 2
balanced = machine.with_link(
    "crank", mass=mass, center_of_mass=(center.real, center.imag), inertia=inertia
)
for name, model in (("before", machine), ("after", balanced)):
    summary = eq.analyze(model).summary
    print(
        f"{name:<7} peak to peak {summary['shaking_force.y'].peak_to_peak:5.1f} N vertical, "
        f"{summary['shaking_force.x'].peak_to_peak:5.1f} N horizontal"
    )
