"""Studies that are killed at random moments: in the end the same bytes, and nothing left behind.

Set EQUIPOISE_KILLS to kill more often than eight times.
"""

from __future__ import annotations

import os
import random
import shutil
import time
from pathlib import Path

import pytest

from support.studies import contents
from surface.running import equipoise, forked, succeeded
from surface.studies import LENGTHS

KILLS = int(os.environ.get("EQUIPOISE_KILLS", "8"))
STORE, STUDY = Path("study.zarr"), Path("study.toml")
DESIGNS = 25_000


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, bytes], float]:
    """What is in a store that was never interrupted, and how long a process took for it, s."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / STUDY).write_text(_text(), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        forked("examples").join()  # what forks processes has imported everything then
        begun = time.monotonic()
        process = forked("sweep", STUDY, "-o", STORE)
        process.join()
    assert process.exitcode == 0
    return contents(folder / STORE), time.monotonic() - begun


def _text() -> str:
    return LENGTHS.replace("designs = 200", f"designs = {DESIGNS}")


def test_killed_at_random(whole: tuple[dict[str, bytes], float]) -> None:
    STUDY.write_text(_text(), encoding="utf-8")
    expected, duration = whole
    random_moments, ended = random.Random(KILLS), 0
    for _ in range(KILLS):
        words = ("resume", STORE) if STORE.exists() else ("sweep", STUDY, "-o", STORE)
        process = forked(*words)
        process.join(random_moments.uniform(0.1, 1.0) * duration)
        process.kill()
        process.join()
        assert "Traceback" not in Path("err").read_text()
        if process.exitcode == 0:
            ended += 1
            assert contents(STORE) == expected
            shutil.rmtree(STORE)
    succeeded(
        equipoise("resume", STORE) if STORE.exists() else equipoise("sweep", STUDY, "-o", STORE)
    )
    assert contents(STORE) == expected
    assert {path.name for path in Path().iterdir()} == {STUDY.name, STORE.name, "err"}
    assert ended < KILLS
