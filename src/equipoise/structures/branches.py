"""Exact response along a range of speeds, each started from its neighbour.

Where mounts let go, a machine may have two steady states at one speed: run up slowly it stays on
one of them, run down on the other.  So the range is then gone through both ways.
"""

from __future__ import annotations

from collections.abc import Callable

from equipoise.errors import ResponseError
from equipoise.mechanism.model import Machine
from equipoise.structures.exact import solve_exact
from equipoise.structures.response import Response

Progress = Callable[[int, int], None]
Answers = list[Response | None]

DIFFERENT = 1e-3
"""Share by which two steady states differ at least at some gauge."""


def follow_speeds(
    machine: Machine, speeds: list[float], drive: bool, progress: Progress
) -> tuple[Answers, list[str]]:
    """Response at every speed, the louder one where there are two; and what to say of that."""
    count = len(speeds)
    upward = _along(machine, speeds, drive, lambda done: progress(done, count))
    if drive or not any(_lifts_off(answer) for answer in upward):
        return upward, []
    downward = _along(machine, speeds[::-1], drive, lambda done: progress(count + done, 2 * count))
    louder, both = [], []
    for speed, up, down in zip(speeds, upward, downward[::-1], strict=True):
        ratio = _ratio(up, down)
        louder.append(down if up is None or (down is not None and ratio > 1) else up)
        if up is not None and down is not None and abs(ratio - 1) > DIFFERENT:
            both.append((speed, min(ratio, 1 / ratio)))
    return louder, _told(both, count)


def _along(
    machine: Machine, speeds: list[float], drive: bool, progress: Callable[[int], None]
) -> Answers:
    """Response at every speed, one after the other; None where no steady state was found."""
    answers: Answers = []
    near = None
    for speed in speeds:
        try:
            found = solve_exact(machine, speed, drive, near)
        except ResponseError:
            near = None
            answers.append(None)
        else:
            near = None if drive else found.found.orbit.at
            answers.append(found.response(brief=True))
        progress(len(answers))
    return answers


def _lifts_off(answer: Response | None) -> bool:
    return answer is not None and any(mount.lifts_off for mount in answer.mounts.values())


def _ratio(first: Response | None, second: Response | None) -> float:
    """How much more the second shakes, at the gauge where they differ most."""
    if first is None or second is None:
        return 1.0
    ratios = [1.0]
    for name, gauge in first.gauges.items():
        before = float(gauge.displacement.peak_to_peak)
        after = float(second.gauges[name].displacement.peak_to_peak)
        if before > 0 and after > 0:
            ratios.append(after / before)
    return max(ratios, key=lambda ratio: max(ratio, 1 / ratio))


def _told(both: list[tuple[float, float]], count: int) -> list[str]:
    if not both:
        return []
    speeds = [speed for speed, _ in both]
    least = min(ratio for _, ratio in both)
    return [
        f"two steady states at {len(both)} of {count} speeds, from {speeds[0]:.4g} to "
        f"{speeds[-1]:.4g} rad/s; the louder one is told, the other shakes down to "
        f"{100 * least:.0f} % of it"
    ]
