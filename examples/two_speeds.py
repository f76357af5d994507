"""Compare two speeds: positions are solved once, forces follow.

Inertia grows with the square of the speed; weight and loads do not.
"""

import numpy as np

import equipoise as eq

forces = eq.analyze(eq.load("quick-return")).forces

print("rpm    shaking force N   force in D N   drive torque N m   power W (mean)")
for rpm in (30, 60, 120):
    at = forces.at(speed=rpm * np.pi / 30)
    print(
        f"{rpm:3d} {at.shaking_force.size.max():18.1f} {at.joints['D'].size.max():14.1f} "
        f"{abs(at.drive_torque).max():18.1f} {at.power.mean():16.1f}"
    )

print("largest part of the drive torque by cause at 120 rpm, N m")
for cause, part in at.split.by_cause("drive_torque").items():
    print(f"  {cause:<12} {abs(part).max():8.1f}")
