"""A first look at a mechanism: type, motion of a traced point, forces on frame and drive."""

import numpy as np

import equipoise as eq

machine = eq.load("yamashita-1")
analysis = eq.analyze(machine)

bar = analysis.four_bar
swing, transmission = np.degrees([bar.swing, bar.transmission_min])
print(f"{machine.title}: {bar.type}")
print(f"rocker swings {swing:.1f} deg, smallest transmission angle {transmission:.1f} deg")

tip = analysis.motion.points["P"]
fastest = np.argmax(abs(tip.velocity))
print(f"tip path {1000 * np.ptp(tip.x):.0f} mm wide, {1000 * np.ptp(tip.y):.0f} mm high")
print(
    f"tip fastest at {np.degrees(analysis.crank_angle[fastest]):.0f} deg: "
    f"{abs(tip.velocity[fastest]):.2f} m/s"
)

for name, unit in (("shaking_force", "N"), ("shaking_moment", "N m"), ("drive_torque", "N m")):
    figures = analysis.summary[name]
    print(f"{name:<15} peak {figures.peak:6.2f} {unit} at {np.degrees(figures.peak_at):.0f} deg")
