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
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What is in a store that was never interrupted."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / STUDY).write_text(_text(), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        process = forked("sweep", STUDY, "-o", STORE)
        process.join()
    assert process.exitcode == 0
    return contents(folder / STORE)


def _text() -> str:
    return LENGTHS.replace("designs = 200", f"designs = {DESIGNS}")


def _chunks() -> int:
    """How many files of designs the store holds, with those that are being written."""
    return sum(1 for _ in STORE.glob("*/c/*"))


def test_killed_at_random(whole: dict[str, bytes]) -> None:
    """Each time after some more files, however fast the machine is, and a moment more."""
    STUDY.write_text(_text(), encoding="utf-8")
    of_all = len({Path(name).parts[:3] for name in whole if "c" in Path(name).parts})
    chance, ended = random.Random(KILLS), 0
    for _ in range(KILLS):
        words = ("resume", STORE) if STORE.exists() else ("sweep", STUDY, "-o", STORE)
        until = _chunks() + chance.randrange(of_all // 2)
        process = forked(*words)
        while process.is_alive() and _chunks() < until:
            time.sleep(0.001)
        time.sleep(chance.uniform(0.0, 0.02))
        process.kill()
        process.join()
        assert "Traceback" not in Path("err").read_text()
        if process.exitcode == 0:
            ended += 1
            assert contents(STORE) == whole
            shutil.rmtree(STORE)
    succeeded(
        equipoise("resume", STORE) if STORE.exists() else equipoise("sweep", STUDY, "-o", STORE)
    )
    assert contents(STORE) == whole
    assert {path.name for path in Path().iterdir()} == {STUDY.name, STORE.name, "err"}
    assert ended < KILLS
