"""How long a study takes, by a clock that goes with the designs that are computed."""

from __future__ import annotations

from typing import Any

import pytest

from equipoise.studies import estimate as module
from equipoise.studies.estimate import Estimate, estimate
from equipoise.studies.executors import Task
from equipoise.studies.run import Route
from unit.studies.samples import study


@pytest.mark.parametrize(
    ("each", "chunk", "processors", "computed", "seconds"),
    [
        (1e-5, 256, 2, 256, 1000 * 1e-5 / 2),  # a whole chunk
        (0.01, 256, 4, 256, 1000 * 0.01 / 4),
        (0.25, 256, 4, 8, 1000 * 0.25 / 4),  # more of it would take 16 s
        (9.0, 256, 4, 1, 1000 * 9.0 / 4),
        (0.2, 10, 1, 10, 1000 * 0.2),
        (0.1, 1000, 8, 8, 1000 * 0.1),  # one chunk keeps one processor busy
    ],
)
def test_from_as_much_of_a_chunk_as_is_quick(
    each: float,
    chunk: int,
    processors: int,
    computed: int,
    seconds: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, asked = [0.0], list[range]()

    def compute(packed: bytes, designs: range) -> Any:
        asked.append(designs)
        # the first one takes longer, as what is loaded and compiled does
        clock[0] += len(designs) * each + (100.0 if len(asked) == 1 else 0.0)

    route = Route(Task(compute, b""), False, "general", chunk)
    monkeypatch.setattr(module.Route, "of", lambda given: route)
    monkeypatch.setattr(module, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(module, "processors", lambda: processors)
    given = study(designs=1000)
    found = estimate(given)
    assert found == Estimate(
        computed,
        pytest.approx(1 / each),
        min(processors, -(-1000 // chunk)),
        pytest.approx(seconds),
    )
    assert asked[-1] == range(asked[0].start, asked[0].start + computed)
    assert asked[0].start % chunk == 0
    assert asked[0].start + computed <= given.size


def test_of_a_study_as_it_is() -> None:
    found = estimate(study(designs=100))
    assert found.designs > 0
    assert 0 < found.seconds < 100
    assert found.seconds == pytest.approx(100 / found.rate / found.workers)
