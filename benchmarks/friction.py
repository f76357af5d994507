"""What friction costs an analysis: processor time with all pins and sliders rubbing, over that
without, of each bundled machine that can have friction; in turn, the median of the rounds.  Warm,
the same machine is analysed again and again; cold, each time one of which nothing is known yet, as
its frame is elsewhere by some nanometres.

    python benchmarks/friction.py [NAME ...]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import replace
from statistics import median

import equipoise as eq
from equipoise.errors import EquipoiseError
from equipoise.mechanism import JointProperties

ROUNDS = 7
COEFFICIENT, RADIUS = 0.02, 0.005


def rubbing(machine: eq.Machine) -> eq.Machine:
    """The machine with its own friction, or with some in every pin and slider."""
    if machine.rubs:
        return machine
    sliders = {slider.name for slider in machine.sliders}
    joints = [
        JointProperties(
            f"joints.{name}",
            friction=COEFFICIENT,
            radius=None if name in sliders else RADIUS,
        )
        for name in eq.analyze(machine, [0.0]).forces.joints
        if name not in machine.riders
    ]
    return replace(machine, joints=tuple(joints))


def changed(machine: eq.Machine, number: int) -> eq.Machine:
    """The machine with its frame shifted by 1e-9 m a number."""
    shift = 1e-9 * number
    return replace(machine, frame={name: (x + shift, y) for name, (x, y) in machine.frame.items()})


def processor_time(task: Callable[[], object]) -> float:
    """Seconds of the processor that a task takes."""
    begin = time.process_time()
    task()
    return time.process_time() - begin


def main(names: list[str]) -> None:
    """Print both times in ms, their ratio warm and cold, a line a machine."""
    ratios, cold = [], []
    for name in names:
        try:
            machine = eq.load(name)
            if not isinstance(machine, eq.Machine):
                continue
            free, rubbed = machine.without_friction(), rubbing(machine)
            tasks = [lambda one=one: eq.analyze(one).summary for one in (free, rubbed)]
            rounds = [[processor_time(task) for task in tasks] for _ in range(ROUNDS + 1)][1:]
            firsts = [
                [processor_time(lambda one=one: eq.analyze(one).summary)
                 for one in (changed(free, k), changed(rubbed, k + ROUNDS))]
                for k in range(1, ROUNDS + 1)
            ]  # fmt: skip
        except EquipoiseError as error:
            print(f"{name:<28} {error}"[:110])
            continue
        without, friction = (1e3 * median(times) for times in zip(*rounds, strict=True))
        ratios.append(median(b / a for a, b in rounds))
        cold.append(median(b / a for a, b in firsts))
        joints = len(eq.analyze(rubbed).forces.frictions)
        line = f"{name:<28} {without:7.1f} {friction:7.1f} x {ratios[-1]:5.2f}"
        line += f", cold x {cold[-1]:5.2f}  {joints} joints"
        print(line, flush=True)
    for name, each in (("warm", ratios), ("cold", cold)):
        count = sum(ratio <= 3 for ratio in each)
        print(f"{name}: median {median(each):.2f}, {count} of {len(each)} at most 3")


if __name__ == "__main__":
    main(sys.argv[1:] or list(eq.examples()))
