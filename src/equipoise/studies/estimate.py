"""How long a study takes, from a part of it."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING

from equipoise.codegen.backends import processors
from equipoise.studies.run import Route

if TYPE_CHECKING:
    from equipoise.studies.study import Study

MORE, LONGEST = 8, 4.0
"""So many times as many designs are computed next, unless that would take longer than this, s."""


@dataclass(frozen=True)
class Estimate:
    """What designs of a study take.

    designs : of one chunk that were computed.  rate : designs a second on one processor.
    workers : processors on which a sweep runs here.  seconds : for the whole study on these.
    """

    designs: int
    rate: float
    workers: int
    seconds: float


def estimate(study: Study) -> Estimate:
    """How long a sweep takes here, from the chunk in its middle, or as much of it as is quick.

    Raises
    ------
    ModelError : an output cannot be computed of any design.
    """
    route = Route.of(study)
    chunks = -(-study.size // route.chunk)
    begin = chunks // 2 * route.chunk
    most, count = min(route.chunk, study.size - begin), 1
    _timed(route, begin, 1)  # what is loaded and compiled at first is no part of a rate
    while True:
        seconds = _timed(route, begin, count)
        following = min(MORE * count, most)
        if following == count or following / count * seconds > LONGEST:
            break
        count = following
    workers = min(processors(), chunks)
    return Estimate(count, count / seconds, workers, study.size * seconds / (count * workers))


def _timed(route: Route, begin: int, count: int) -> float:
    """Time for some designs, s."""
    start = perf_counter()
    route.task.function(route.task.study, range(begin, begin + count))
    return max(perf_counter() - start, 1e-9)
