"""How long is the hole that a planting finger opens, and what does the soil cost the drive?"""

from math import degrees

import equipoise as eq

machine = eq.load("transplanter")
figures = eq.plant(machine)

print(f"entry at {degrees(figures['entry.crank_angle']):.1f} deg of crank angle")
print(f"in the soil for {1e3 * figures['soil.time']:.0f} ms")
print(f"hole of {1e3 * figures['soil.hole_length']:.0f} mm at the surface")

assert figures.forces is not None
air, soil = figures.forces.compared()["drive_torque"]
print(f"peak of the drive torque: {air.peak:.2f} N m in the air, {soil.peak:.2f} N m in the soil")

for spacing in (0.12, 0.15, 0.18):
    other = eq.plant(machine.with_planting(forward_speed=None, hill_spacing=spacing))
    length = 1e3 * other["soil.hole_length"]
    print(f"hills {100 * spacing:.0f} cm apart: hole of {length:.0f} mm")
