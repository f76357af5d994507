"""Move the centre of mass of a link, look at the effect, and save the better machine."""

from pathlib import Path
from tempfile import TemporaryDirectory

import equipoise as eq

machine = eq.load("yamashita-2")
print("coupler's centre of mass, mm     peak shaking force, N")

best = machine
for x in (-0.045, -0.030, -0.015, 0.0):
    changed = machine.with_link("coupler", center_of_mass=(x, 0.0))
    peak = eq.analyze(changed).summary["shaking_force"].peak
    print(f"({1000 * x:5.0f}, 0) {peak:36.2f}")
    if peak < eq.analyze(best).summary["shaking_force"].peak:
        best = changed

with TemporaryDirectory() as folder:
    file = Path(folder) / "better.toml"
    eq.save(best, file)
    print(f"{file.name}: {len(file.read_text().splitlines())} lines")
    assert eq.load(file) == best
