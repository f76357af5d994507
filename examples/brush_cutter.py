"""What a brush cutter does to the hands, and where its front handle had better be."""

import numpy as np

import equipoise as eq

RPM = np.pi / 30

tool = eq.schema.load_tool("brush-cutter")
modes = eq.handheld.vibrate_tool(tool, 6)
print(
    "natural frequencies, 1/min:", *(f"{60 * hz:.0f}" for hz in modes.planes[0].cycles_per_second)
)

band = np.linspace(7000, 8000, 101) * RPM
print("\nfront handle at, mm    a_hv there, m/s2    at the rear grip, m/s2")
for place in (0.45, 0.55, 0.65):
    moved = tool.with_station("front-handle", position=place)
    grips = eq.handheld.expose_tool(moved, band).grips
    worst = {name: float(np.max(grip.a_hv)) for name, grip in grips.items()}
    print(f"{1000 * place:20.0f} {worst['front-handle']:19.2f} {worst['rear-grip']:25.2f}")

day = eq.handheld.expose_tool(tool, band)
print(f"\nA(8) = {day.a8:.2f} m/s2 at the {day.worst}, {day.days[day.worst].verdict}")
