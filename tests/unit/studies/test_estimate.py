"""How long a study takes, by a clock that goes with the designs that are computed."""

from __future__ import annotations

import pytest

from equipoise.studies import outcomes
from equipoise.studies.outcomes import Estimate, estimated


@pytest.mark.parametrize(
    ("each", "chunk", "processors", "computed", "seconds"),
    [
        (1e-5, 256, 2, 256, 1000 * 1e-5 / 2),  # a whole chunk
        (0.002, 256, 4, 256, 1000 * 0.002 / 4),
        (0.1, 256, 4, 8, 1000 * 0.1 / 4),  # more of it would take 6 s
        (9.0, 256, 4, 1, 1000 * 9.0 / 4),
        (0.05, 10, 1, 10, 1000 * 0.05),
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

    def compute(designs: range) -> None:
        asked.append(designs)
        # the first one takes longer, as what is loaded and compiled does
        clock[0] += len(designs) * each + (100.0 if len(asked) == 1 else 0.0)

    monkeypatch.setattr(outcomes, "perf_counter", lambda: clock[0])
    result = estimated(compute, 1000, chunk, processors)
    workers = min(processors, -(-1000 // chunk))
    assert result == Estimate(computed, pytest.approx(1 / each), workers, pytest.approx(seconds))
    assert asked[-1] == range(asked[0].start, asked[0].start + computed)
    assert asked[0].start % chunk == 0
    assert asked[0].start + computed <= 1000
