"""A slider-crank run up from rest by a constant torque, beside Exudyn at the same accuracy.

The peer is Exudyn's Newmark method with constraints on velocities, as in `exudyn_slider_crank.py`,
on the machine of `tests/support/exudyn_model.py` with its frame held.  Errors are those of the
crank's angle at the end, over the angle that it has turned, against Exudyn itself with its steps
extrapolated to none (Richardson, order 2), which shares nothing with this package.  Exudyn gets
twice as many steps until it is as accurate as `WANTED`; a run of Equipoise is far more accurate,
and is not made coarser.  Times are of the processor, the least of several rounds.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import equipoise as eq
from equipoise.mechanism import Motor
from peers import required

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

with required("exudyn"):
    import exudyn
    from exudyn import itemInterface as item

    from support.exudyn_model import CRANK, MACHINE, TORQUE, Build, settings

DURATION, WANTED, ROUNDS = 1.0, 1e-7, 5


def by_exudyn(steps: int) -> tuple[float, float]:
    """Angle of the crank at the end, rad, and processor time of the solver, s."""
    built = Build((CRANK / 2, 0.0), 0.0)
    built.system.AddLoad(item.LoadCoordinate(markerNumber=built.turning, load=TORQUE))
    for freedom in range(2):
        built.hold(built.coordinate(built.frame_node, freedom))
    sensor = built.system.AddSensor(
        item.SensorMarker(
            markerNumber=built.turning,
            storeInternal=True,
            writeToFile=False,
            outputVariableType=exudyn.OutputVariableType.Coordinates,
        )
    )
    built.system.Assemble()
    begin = time.process_time()
    built.system.SolveDynamic(settings(DURATION, DURATION / steps, DURATION))
    spent = time.process_time() - begin
    return float(built.system.GetSensorStoredData(sensor)[-1, -1]), spent


def by_equipoise() -> float:
    """Angle of the crank at the end, rad."""
    first = replace(MACHINE.links["crank"], center_of_mass=(CRANK / 2, 0.0))
    rod = replace(MACHINE.links["rod"], center_of_mass=(0.0, 0.0))
    machine = replace(
        MACHINE, links={**MACHINE.links, "crank": first, "rod": rod}, support=None,
        balance=None, gravity=(0.0, 0.0),
    ).with_drive(motor=Motor(torque=TORQUE))  # fmt: skip
    return float(eq.run(machine, DURATION).crank_angle[-1])


def spent_by(task: Callable[[], object]) -> float:
    """Processor time of a task, s."""
    begin = time.process_time()
    task()
    return time.process_time() - begin


def main() -> None:
    steps = 2000
    coarse, fine = by_exudyn(32 * steps)[0], by_exudyn(64 * steps)[0]
    exact = fine + (fine - coarse) / 3
    own = by_equipoise()
    mine = min(spent_by(by_equipoise) for _ in range(ROUNDS))
    print(f"the crank turns {exact:.9f} rad in {DURATION} s")
    print(f"equipoise  error {abs(own / exact - 1):.1e}  {1e3 * mine:9.1f} ms")
    while True:
        angle, _ = by_exudyn(steps)
        missed = abs(angle / exact - 1)
        theirs = min(by_exudyn(steps)[1] for _ in range(ROUNDS if missed < WANTED else 1))
        print(
            f"exudyn     error {missed:.1e}  {1e3 * theirs:9.1f} ms  {steps} steps, "
            f"{theirs / mine:.1f} times as long"
        )
        if missed < WANTED:
            return
        steps *= 2


if __name__ == "__main__":
    main()
