"""Scripts of machines under Node: nanoseconds a state with all joint forces.

python benchmarks/scripts.py
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import equipoise as eq
from equipoise.codegen.other_languages import javascript
from equipoise.mechanism.assembly.linkage import assemble

MACHINES = ("yamashita-1", "watt-six-bar", "slider-crank-engine", "quick-return",
            "geared-counterweight", "lee-kim-a", "spring-balanced-crank",
            "stephenson-six-bar")  # fmt: skip
ANGLES, ROUNDS, LIMIT = 360, 400, 150.0
RUN = """
const {{ design, grid, angles, count }} = {given};
const numbers = Float64Array.from(design), rows = Float64Array.from(grid);
const out = new Float64Array(count * angles);
let best = Infinity;
for (let round = 0; round < {rounds}; round++) {{
    const begin = process.hrtime.bigint();
    states(numbers, rows, angles, out);
    best = Math.min(best, Number(process.hrtime.bigint() - begin));
}}
console.log(best / angles);
"""


def signals(machine: eq.Machine) -> list[str]:
    """Forces on frame and drive, and in all joints."""
    names = [one.name for one in eq.analyze(machine, 4).outputs.arrays]
    frame = ["shaking_force.x", "shaking_force.y", "shaking_moment", "drive_torque"]
    return frame + [name for name in names if name.endswith((".force_x", ".force_y"))]


def nanoseconds(machine: eq.Machine, folder: Path) -> tuple[int, float]:
    """Number of signals, and the best time of a state."""
    linkage = assemble(machine)
    script = javascript(linkage, signals(machine))
    theta = np.arange(ANGLES) * (2 * np.pi / ANGLES)
    given = {"angles": ANGLES, "count": len(script.names)}
    given["design"] = script.numbers(linkage).tolist()
    given["grid"] = script.grid(theta).ravel().tolist()
    path = folder / "states.js"
    path.write_text(script.text + RUN.format(given=json.dumps(given), rounds=ROUNDS))
    done = subprocess.run(["node", str(path)], check=True, capture_output=True, text=True)
    return len(script.names), float(done.stdout)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        for machine in MACHINES:
            count, time = nanoseconds(eq.load(machine), Path(name))
            over = "" if time <= LIMIT else f"  over {LIMIT:g}"
            print(f"{machine:<24} {count:3d} signals  {time:6.1f} ns a state{over}")
