"""Sweeps: the same store whatever happens on the way, and one sentence for whatever stops them."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.folders import Folder
from equipoise.studies import run
from equipoise.studies import store as storing
from equipoise.studies.outcomes import Progress, Tally
from equipoise.studies.run import chunk_of, resume, sweep
from equipoise.studies.store import Store, open_store
from equipoise.studies.study import Output, Study, samples
from support import studies
from support.chosen import EXHAUSTIVE, few
from support.refusals import has_value, refused
from support.studies import Formulas, contents, restore, short_study

STUDY = short_study()


@pytest.fixture(autouse=True)
def formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "evaluator", lambda study, threads: Formulas())


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files of a sweep of one thread that nothing stops."""
    path = tmp_path_factory.mktemp("undisturbed") / "s"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "evaluator", lambda study, threads: Formulas())
        sweep(STUDY, path, workers=1)
    return contents(path)


def after(chunks: int, act: Callable[[], None]) -> Callable[[Progress], None]:
    """Does something once so many chunks are stored."""

    def tell(progress: Progress) -> None:
        if progress.computed == 100 * chunks:
            act()

    return tell


def stop() -> None:
    raise KeyboardInterrupt


# -- the same bytes --------------------------------------------------------------------------------


def test_all_designs_are_computed_and_stored(tmp_path: Path) -> None:
    store = sweep(STUDY, tmp_path / "s", workers=2)
    values = samples(STUDY, 0, STUDY.size)
    (_, block), *_ = open_store(store.path).in_blocks()
    np.testing.assert_array_equal(block.values, values)
    np.testing.assert_array_equal(block.outcome.figures, Formulas()(values).figures)
    np.testing.assert_array_equal(block.outcome.reason, Formulas()(values).reason)


@pytest.mark.parametrize("workers", [2, 7])
def test_any_number_of_threads_gives_the_same_bytes(
    tmp_path: Path, undisturbed: dict[str, bytes], workers: int
) -> None:
    sweep(STUDY, tmp_path / "s", workers=workers)
    assert contents(tmp_path / "s") == undisturbed


def test_an_interrupted_sweep_keeps_its_chunks_and_goes_on_to_the_same_bytes(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    with pytest.raises(KeyboardInterrupt):
        sweep(STUDY, tmp_path / "s", workers=2, progress=after(4, stop))
    kept = contents(tmp_path / "s")
    assert len(open_store(tmp_path / "s").missing()) == 6
    texts: list[Progress] = []
    resume(tmp_path / "s", restore, workers=3, progress=texts.append)
    assert [progress.done for progress in texts] == [400, 500, 600, 700, 800, 900, 1000]
    assert contents(tmp_path / "s") == undisturbed
    assert kept.items() <= undisturbed.items()


# On every change: `test_the_end_may_come_at_any_file_of_a_chunk`, and `surface/test_sweep.py`.
@EXHAUSTIVE
def test_killed_processes_leave_a_store_that_ends_with_the_same_bytes(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    path = tmp_path / "s"
    for command, chunks in (("sweep", 3), ("resume", 6)):
        words = [sys.executable, str(studies.__file__), command, str(path)]
        roots = [str(Path(studies.__file__).parents[1]), *sys.path]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(roots)}
        with subprocess.Popen(words, env=environment) as process:
            while process.poll() is None and len(list(path.glob("reason/c/*"))) < chunks:
                time.sleep(0.001)
            process.kill()
        assert process.returncode == -signal.SIGKILL
        assert open_store(path).missing()
    resume(path, restore, workers=2)
    assert contents(path) == undisturbed


class Killed(BaseException):
    """As if the process ended at once: nothing is cleaned up."""


def killed_while_writing(path: Path, data: bytes) -> None:
    path.write_bytes(bytes(data)[: len(data) // 2])
    raise Killed


def killed_before_replacing(path: Path, data: bytes) -> None:
    path.with_name(f"{path.name}.partial").write_bytes(data)
    raise Killed


def killed_after_replacing(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    raise Killed


@pytest.mark.parametrize("file", few(range(7), {0, 6}))
@pytest.mark.parametrize(
    "end", [killed_while_writing, killed_before_replacing, killed_after_replacing]
)
def test_the_end_may_come_at_any_file_of_a_chunk(
    tmp_path: Path,
    undisturbed: dict[str, bytes],
    monkeypatch: pytest.MonkeyPatch,
    file: int,
    end: Callable[[Path, bytes], None],
) -> None:
    put, written = storing._put, []

    def put_or_end(folder: Folder, name: str, data: bytes) -> None:
        path = folder.path / name
        written.append(path)
        if len(written) == 1 + 2 * 7 + file:
            end(path.with_name(f"{name}.partial") if "while" in end.__name__ else path, data)
        put(folder, name, data)

    with monkeypatch.context() as patch:
        patch.setattr(storing, "_put", put_or_end)
        with pytest.raises(Killed):
            sweep(STUDY, tmp_path / "s", workers=1)
    whole = 3 if end is killed_after_replacing and file == 6 else 2
    assert len(open_store(tmp_path / "s").missing()) == 10 - whole
    resume(tmp_path / "s", restore, workers=1)
    assert contents(tmp_path / "s") == undisturbed


def test_a_finished_store_is_left_alone(
    tmp_path: Path, undisturbed: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep(STUDY, tmp_path / "s")
    monkeypatch.delattr(run, "evaluator")  # nothing is computed
    texts: list[Progress] = []
    resume(tmp_path / "s", restore, progress=texts.append)
    assert [(progress.done, progress.computed) for progress in texts] == [(1000, 0)]
    assert contents(tmp_path / "s") == undisturbed


# -- what stops a sweep ----------------------------------------------------------------------------


@contextmanager
def small_disk(folder: Path, size: str) -> Iterator[Path]:
    """A disk in memory, for those who may mount one."""
    folder.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    try:
        done = subprocess.run(words, capture_output=True, check=False).returncode == 0
    except OSError:
        done = False
    if not done:
        pytest.skip("no disk can be mounted here")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_full_disk_is_reported_and_nothing_is_lost(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    with small_disk(tmp_path / "disk", "400k") as disk:
        (disk / "ballast").write_bytes(bytes(200_000))
        with refused(UsageError, size=1000) as caught:
            sweep(STUDY, disk / "s", workers=2)
        kept = contents(disk / "s")
        stored = 10 - len(open_store(disk / "s").missing())
        assert 0 < stored < 10
        assert has_value(caught.value.note, "done", 100 * stored)
        assert f"equipoise resume {disk / 's'}" in str(caught.value)
        with refused(UsageError, size=1000):
            resume(disk / "s", restore)
        assert kept.items() <= contents(disk / "s").items()
        (disk / "ballast").unlink()
        resume(disk / "s", restore)
        assert contents(disk / "s") == undisturbed


def test_a_file_that_the_system_refuses_is_reported(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)

    def refuse() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, before[1]))

    try:
        with refused(UsageError, brief="file too large"):
            sweep(STUDY, tmp_path / "s", workers=1, progress=after(3, refuse))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    resume(tmp_path / "s", restore)
    assert contents(tmp_path / "s") == undisturbed


def test_a_folder_that_goes_is_reported_and_not_made_again(tmp_path: Path) -> None:
    def remove() -> None:
        shutil.rmtree(tmp_path / "s")

    with refused(UsageError, by="_store"):
        sweep(STUDY, tmp_path / "s", progress=after(2, remove))
    assert list(tmp_path.iterdir()) == []


def test_a_store_is_not_overwritten_and_nothing_is_computed_for_it(tmp_path: Path) -> None:
    (tmp_path / "s").write_text("mine")
    with refused(UsageError, place=str(tmp_path / "s"), target=str(tmp_path / "s")):
        sweep(STUDY, tmp_path / "s")
    assert (tmp_path / "s").read_text() == "mine"


def begun(path: Path) -> Store:
    with pytest.raises(KeyboardInterrupt):
        sweep(STUDY, path, progress=after(1, stop))
    return open_store(path)


def test_other_versions_do_not_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    versions = begun(tmp_path / "s").versions
    monkeypatch.setattr(run, "versions", lambda: {**versions, "scipy": "1.0"})
    with refused(UsageError, name="scipy", wanted=versions["scipy"], given="1.0"):
        resume(tmp_path / "s", restore)


def test_another_engine_does_not_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun(tmp_path / "s")
    monkeypatch.setattr(run, "evaluator", lambda study, threads: Formulas(engine="numpy"))
    with refused(UsageError, name="engine", wanted="numba", given="numpy"):
        resume(tmp_path / "s", restore)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"workers": 0}, {"workers": 0}),
        ({"workers": 2, "cluster": "tcp://127.0.0.1:9"}, {"by": "elsewhere"}),
        ({"cluster": "localhost"}, {"by": "_counted"}),
    ],
)
def test_what_cannot_be_asked_makes_no_store(
    tmp_path: Path, given, expected: dict[str, Any]
) -> None:
    with refused(UsageError, **expected):
        sweep(STUDY, tmp_path / "s", **given)
    assert not (tmp_path / "s").exists()


# -- chunks and progress ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("study", "compiled", "chunk"),
    [
        (short_study(10**7, 65_536), True, 65_536),
        (short_study(10**6, 65_536), True, 62_500),
        (short_study(65_536, 65_536), True, 8192),
        (short_study(500, 65_536), True, 500),
        (short_study(10**7, outputs=[Output(f"o{k}") for k in range(509)], chunk=0), True, 8192),
        (short_study(10**6, 65_536), False, 256),
        (short_study(1000, 65_536), False, 16),
        (short_study(10, 65_536), False, 1),
    ],
)
def test_slow_designs_have_small_chunks(study: Study, compiled: bool, chunk: int) -> None:
    assert chunk_of(study, compiled) == chunk


def test_progress_reports_failures_and_the_best_that_keeps_the_limits(tmp_path: Path) -> None:
    texts: list[Progress] = []
    sweep(STUDY, tmp_path / "s", progress=texts.append)
    outcome = Formulas()(samples(STUDY, 0, 1000))
    area, _, energy = outcome.figures[(outcome.reason == 0) & (outcome.figures[:, 0] >= 0.0045)].T
    last = texts[-1]
    assert last.best == {"area": area.min(), "energy": energy.max()}
    assert last.failures == {
        "does not assemble": np.sum(outcome.reason == 1),
        "does not turn fully": np.sum(outcome.reason == 2),
    }
    assert (last.total, last.done, last.computed, last.left) == (1000, 1000, 1000, 0)
    assert (texts[0].done, texts[0].rate, texts[0].left, texts[0].best) == (0, None, None, {})


def test_rate_and_time_left_are_those_of_the_last_minute(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 0.0
    monkeypatch.setattr("equipoise.studies.outcomes.monotonic", lambda: now)
    sweep(STUDY, tmp_path / "s")
    chunk = open_store(tmp_path / "s").read(range(100))
    tally = Tally(STUDY.outputs, 1_000_000)
    tally.add(chunk, computed=False)
    for count in range(200):
        now += 10.0 if count < 100 else 1.0
        tally.add(chunk, computed=True)
    progress = tally.progress()
    assert progress.rate == pytest.approx(100.0)
    assert progress.left == pytest.approx((1_000_000 - 20_100) / 100)
    assert progress.seconds == 1100
