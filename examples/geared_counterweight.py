"""What a counterweight geared to the rocker does to the shaking moment (Lee and Kim, mechanism B).

Shaking energy is their measure: the area under the absolute shaking moment over a turn.
"""

from dataclasses import replace
from math import pi, radians

import numpy as np

import equipoise as eq


def measures(machine: eq.Machine) -> tuple[float, float]:
    moment = eq.analyze(machine).forces.shaking_moment
    return 2 * pi * np.mean(abs(moment)), np.max(abs(moment))


energy, peak = measures(eq.load("lee-kim-b"))
print(f"without counterweight:   {energy:5.2f} J, peak {peak:.2f} N m")

geared = eq.load("geared-counterweight")
results = []
for degrees in range(0, 360, 5):
    gear = replace(geared.gears[0], start=radians(degrees))
    results.append((*measures(replace(geared, gears=(gear,))), degrees))
best = min(results)
for energy, peak, degrees in (results[350 // 5], best, max(results)):
    print(f"start angle {degrees:3d} deg:     {energy:5.2f} J, peak {peak:.2f} N m")
