"""Studies that are killed at random moments: in the end the same bytes, and nothing left behind.

Set EQUIPOISE_KILLS to kill more often than twenty times.
"""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from support.studies import contents
from surface.running import command, equipoise, succeeded
from surface.studies import LENGTHS

KILLS = int(os.environ.get("EQUIPOISE_KILLS", "20"))
STORE, STUDY = Path("study.zarr"), Path("study.toml")
DESIGNS = 100_000


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, bytes], float]:
    """What is in a store that was never interrupted, and how long a process took for it, s."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / STUDY).write_text(_text(), encoding="utf-8")
    begun = time.monotonic()
    words = command("sweep", STUDY, "-o", STORE)
    subprocess.run(words, cwd=folder, check=True, capture_output=True)
    return contents(folder / STORE), time.monotonic() - begun


def _text() -> str:
    return LENGTHS.replace("designs = 200", f"designs = {DESIGNS}")


def test_killed_at_random(whole: tuple[dict[str, bytes], float]) -> None:
    STUDY.write_text(_text(), encoding="utf-8")
    expected, duration = whole
    random_moments, ended = random.Random(KILLS), 0
    for _ in range(KILLS):
        words = ("resume", STORE) if STORE.exists() else ("sweep", STUDY, "-o", STORE)
        process = subprocess.Popen(
            command(*words), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        try:
            _, err = process.communicate(timeout=random_moments.uniform(0.2, 1.0) * duration)
        except subprocess.TimeoutExpired:
            process.kill()
            _, err = process.communicate()
        assert b"Traceback" not in err
        if process.returncode == 0:
            ended += 1
            assert contents(STORE) == expected
            shutil.rmtree(STORE)
    succeeded(
        equipoise("resume", STORE) if STORE.exists() else equipoise("sweep", STUDY, "-o", STORE)
    )
    assert contents(STORE) == expected
    assert {path.name for path in Path().iterdir()} == {STUDY.name, STORE.name}
    assert ended < KILLS
