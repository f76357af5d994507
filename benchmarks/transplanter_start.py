"""A start of `transplanter` from rest, over 30 turns of the crank to its steady speed.

A motor whose torque falls in a straight line from 20 N m at standstill to 0 at 1.2 times the speed
of the file turns the crank; weight, soil and springs act as in the file.  The peer is SciPy's
`DOP853` at a tolerance of 1e-9 on the equation of motion that `equipoise.run` makes, without what
that takes to make.  The time of `equipoise` has that too: the tables of the linkage over a turn.

Both print when the crank has turned 30 times, and `equipoise` the energy that is not accounted for.
The first line of times is processor time, which other work on the machine does not lengthen.
"""

from __future__ import annotations

import time
from dataclasses import replace
from math import pi
from statistics import median

from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.mechanism.parts.motors import Motor
from equipoise.running.run_results import Run
from timing import in_turn, report

TURNS, TOLERANCE, ROUNDS = 30, 1e-9, 3
STALL_TORQUE, NO_LOAD = 20.0, 1.2
"""N m; of the file's speed."""


def with_motor(machine: eq.Machine) -> eq.Machine:
    """The machine with a motor at its crank, whose curve holds as it is."""
    motor = Motor(NO_LOAD * machine.drive.speed, STALL_TORQUE, mean_speed="free")
    return replace(machine, drive=replace(machine.drive, motor=motor))


def by_equipoise(machine: eq.Machine) -> Run:
    """The run of 30 turns from rest."""
    return eq.run(machine, turns=TURNS, speed=0.0)


def by_scipy(run: Run) -> float:
    """Time at which the crank has turned 30 times, s, by the equation of a run."""
    equation, motor = run.equation, run.machine.drive.motor

    def rates(_: float, state: list[float]) -> tuple[float, float]:
        angle, speed = state
        torque = STALL_TORQUE * (1 - speed / motor.no_load_speed)
        inertia, slope, others = equation.at(float(angle), float(speed))
        return speed, (float(others.sum()) + torque - slope * speed**2 / 2) / inertia

    def left(_: float, state: list[float]) -> float:
        return state[0] - TURNS * 2 * pi

    left.terminal = True
    found = solve_ivp(rates, (0, 60), [0.0, 0.0], "DOP853", rtol=TOLERANCE, atol=TOLERANCE,
                      events=left)  # fmt: skip
    return float(found.t_events[0][0])


def main() -> None:
    """Run both in turn, and print what they give and how long they take."""
    machine = with_motor(eq.load("transplanter"))
    run, times = by_equipoise(machine), []
    for _ in range(ROUNDS):
        begin = time.process_time()
        by_equipoise(machine)
        times.append(time.process_time() - begin)
    print(f"equipoise  30 turns after {run.end.time:.9f} s, energy off by {run.energy_error:.1e}")
    print(f"SciPy      30 turns after {by_scipy(run):.9f} s")
    print(f"equipoise  {median(times):.3f} s of processor time")
    tasks = {"equipoise": lambda: by_equipoise(machine), "DOP853": lambda: by_scipy(run)}
    report(in_turn(tasks, ROUNDS), "DOP853", 1e-3, "ms")


if __name__ == "__main__":
    main()
