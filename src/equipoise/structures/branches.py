"""Exact response along a range of speeds, each started from its neighbour.

Where mounts let go, a machine may have two steady states at one speed: run up slowly it stays on
one of them, run down on the other.  So the range is then gone through both ways.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from equipoise.errors import ResponseError
from equipoise.mechanism.model import Machine
from equipoise.structures.exact import solve_exact
from equipoise.structures.response import Response
from equipoise.structures.table import range_shown

Progress = Callable[[int, int], None]
Answers = list[Response | None]

APPROACHES = ((1.0,), (0.8, 0.84, 0.88, 0.92, 0.96, 1.0), (1.2, 1.16, 1.12, 1.08, 1.04, 1.0))
"""Shares of a speed through which it is come to: at once, from below and from above."""
DIFFERENT = 1e-3
"""Share by which two steady states differ at least at some gauge."""


def follow_speeds(
    machine: Machine, speeds: list[float], drive: bool, progress: Progress
) -> tuple[Answers, list[str]]:
    """Response at every speed, the louder one where there are two; and what to say of that."""
    count = len(speeds)
    upward = _along(machine, speeds, drive, lambda done: progress(done, count))
    if not any(answer is None or _lifts_off(answer) for answer in upward):
        return upward, []
    downward = _along(machine, speeds[::-1], drive, lambda done: progress(count + done, 2 * count))
    louder, both = [], []
    for speed, up, down in zip(speeds, upward, downward[::-1], strict=True):
        ratio = _ratio(up, down)
        found = down if up is None or (down is not None and ratio > 1) else up
        louder.append(found or _patiently(machine, speed, drive))
        if up is not None and down is not None and abs(ratio - 1) > DIFFERENT:
            both.append((speed, min(ratio, 1 / ratio)))
    return louder, _told(both, count)


def respond_exact(machine: Machine, speed: float, drive: bool) -> Response:
    """Response by the exact equations; where mounts let go, the louder of what may be two.

    Raises
    ------
    ResponseError : no steady state was found.
    """
    support = machine.support
    if support is None or not any(mount.one_sided for mount in support.mounts.values()):
        return solve_exact(machine, speed, drive).response()
    found: list[Response] = []
    for reach in APPROACHES:
        speeds = [speed * share for share in reach]
        answers = _along(machine, speeds, drive, lambda done: None, brief=False)
        last = answers[-1]
        if last is not None and all(abs(_ratio(last, other) - 1) > DIFFERENT for other in found):
            found.append(last)
    if not found:
        return solve_exact(machine, speed, drive).response()
    louder = max(found, key=_loudness)
    notes = [_other(louder, other) for other in found if other is not louder]
    return replace(louder, notes=(*louder.notes, *notes))


def _loudness(answer: Response) -> float:
    """Sum of what the gauges read, for comparing answers of one machine."""
    return sum(float(gauge.displacement.peak_to_peak) for gauge in answer.gauges.values())


def _other(louder: Response, other: Response) -> str:
    share = 100 * _ratio(louder, other)
    return (
        f"another steady state at this speed shakes {share:.0f} % as much; which of them the "
        "machine takes depends on the speeds it comes from"
    )


def _along(
    machine: Machine,
    speeds: list[float],
    drive: bool,
    progress: Callable[[int], None],
    brief: bool = True,
) -> Answers:
    """Response at every speed, one after the other; None where no steady state was found."""
    answers: Answers = []
    near = None
    for speed in speeds:
        try:
            found = solve_exact(machine, speed, drive, near, patient=False)
        except ResponseError:
            near = None
            answers.append(None)
        else:
            near = found.found.orbit.at
            answers.append(found.response(brief))
        progress(len(answers))
    return answers


def _patiently(machine: Machine, speed: float, drive: bool) -> Response | None:
    """Response at a speed at which neither neighbour nor small motion leads to one."""
    try:
        return solve_exact(machine, speed, drive).response(brief=True)
    except ResponseError:
        return None


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
        f"two steady states at {len(both)} of {count} speeds, {range_shown(speeds)}; the louder "
        f"one is told, the other shakes down to {100 * least:.0f} % of it"
    ]
