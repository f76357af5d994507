"""Threads, evaluator and a cluster compute the same chunks, also when some of them are killed."""

from __future__ import annotations

import json
import logging
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from equipoise.design import evaluator
from equipoise.design.evaluator import Processes, StoppedError, Threads, computed
from equipoise.errors import UsageError
from equipoise.mechanism.parts.balance import Objective
from equipoise.schema.studies import load_study
from equipoise.schema.template import Template
from equipoise.studies import clusters
from equipoise.studies.clusters import Cluster
from equipoise.studies.objective_map import landscape
from equipoise.studies.outcomes import DesignBlock
from equipoise.studies.searching import search
from equipoise.studies.study import Output, Sampling, samples
from support import studies
from support.chosen import few
from support.refusals import refused
from support.studies import Formulas, Orders, short_study

STUDY = short_study(sampling=Sampling("monte-carlo", 200))  # in no need of slow imports
CHUNKS = [range(start, start + 20) for start in range(0, 200, 20)]
TESTS = Path(studies.__file__).parents[1]


def check(result: list[tuple[range, DesignBlock]]) -> None:
    """Every chunk once, and as it has to be."""
    assert sorted(designs.start for designs, _ in result) == [chunk.start for chunk in CHUNKS]
    for designs, block in result:
        values = samples(STUDY, designs.start, len(designs))
        np.testing.assert_array_equal(block.values, values)
        np.testing.assert_array_equal(block.outcome.figures, Formulas()(values).figures)
        np.testing.assert_array_equal(block.outcome.reason, Formulas()(values).reason)


def gone(process: int, patience: float = 300.0) -> bool:
    """Whether a process ends in time."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if not psutil.pid_exists(process) or psutil.Process(process).status() == "zombie":
            return True
        time.sleep(0.02)
    return False


# -- on this machine -------------------------------------------------------------------------------


@pytest.mark.parametrize("workers", [1, 3])
def test_threads_compute_every_chunk(tmp_path: Path, workers: int) -> None:
    with closing(Threads(Orders(STUDY, tmp_path).task, workers)) as pool:
        check(list(computed(pool, CHUNKS)))


def test_few_chunks_are_under_way_at_a_time(tmp_path: Path) -> None:
    with closing(Threads(Orders(STUDY, tmp_path).task, 2)) as pool:
        for count, _ in enumerate(computed(pool, CHUNKS), 1):
            time.sleep(0.01)
            assert len(list(tmp_path.iterdir())) <= count + pool.room


# Designs at which processes always die: the test below.
@pytest.mark.exhaustive
def test_processes_that_die_are_replaced_and_their_chunks_computed_again(tmp_path: Path) -> None:
    orders = Orders(STUDY, tmp_path, deadly={40: 1, 160: 1})
    with closing(Processes(orders.task, 2)) as pool:
        check(list(computed(pool, CHUNKS)))
    assert len(orders.processes()) > 2
    assert all(map(gone, orders.processes()))


def test_designs_at_which_processes_always_die_end_the_sweep(tmp_path: Path) -> None:
    orders = Orders(STUDY, tmp_path, deadly={0: 99})
    with (
        closing(Processes(orders.task, 1)) as pool,
        refused(StoppedError, tries=evaluator.TRIES),
    ):
        list(computed(pool, CHUNKS[:1]))
    assert len(list(tmp_path.glob("0-*"))) == evaluator.TRIES


def test_processes_stop_at_once_when_they_are_closed(tmp_path: Path) -> None:
    orders = Orders(STUDY, tmp_path, pause=600.0)
    pool = Processes(orders.task, 2)
    pool.submit(CHUNKS[0])
    while not orders.processes():
        time.sleep(0.02)
    start = time.monotonic()
    pool.close()
    assert time.monotonic() - start < 60  # a tenth of what a chunk takes
    assert all(map(gone, orders.processes()))


IN_A_PROCESS = """
import sys
from contextlib import closing
from pathlib import Path
from equipoise.design.evaluator import Processes, computed
from support.studies import Orders, short_study
orders = Orders(short_study(200), Path(sys.argv[1]), pause=60.0)
with closing(Processes(orders.task, 2)) as pool:  # not below a question for __main__
    list(computed(pool, [range(20), range(20, 40)]))
"""


@pytest.mark.exhaustive(but=["9-2"])
@pytest.mark.parametrize("begun", few([0, 2], {2}))
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_processes_end_with_the_one_that_started_them(
    tmp_path: Path, number: int, begun: int
) -> None:
    (tmp_path / "script.py").write_text(IN_A_PROCESS)
    orders = Orders(STUDY, tmp_path)
    with subprocess.Popen(
        [sys.executable, "script.py", "."],
        cwd=tmp_path,
        env=environment(),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        started = psutil.Process(process.pid)
        while len(started.children()) < 3 or len(orders.processes()) < begun:
            time.sleep(0.001)  # two that compute, and what looks after resources for Python
        children = [child.pid for child in started.children()]
        if number == signal.SIGINT:  # the terminal sends it to all of them
            os.killpg(process.pid, number)
        else:
            process.kill()
        _, text = process.communicate(timeout=300)
    assert all(map(gone, children))
    if number == signal.SIGINT:
        assert text.count("Traceback") == 1  # that of the script itself
        assert text.endswith("KeyboardInterrupt\n")


# -- a cluster -------------------------------------------------------------------------------------


def environment(*folders: Path) -> dict[str, str]:
    roots = [*map(str, folders), str(TESTS), *sys.path]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(roots)}


@contextmanager
def started(*words: str, folders: tuple[Path, ...] = ()) -> Iterator[subprocess.Popen[bytes]]:
    """A process of Dask."""
    with subprocess.Popen(
        [sys.executable, "-m", "dask", *words],
        env=environment(*folders),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@contextmanager
def scheduler(folder: Path) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    file = folder / "scheduler.json"
    words = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    with started("scheduler", *words) as process:
        while not file.exists() or not file.read_text():
            time.sleep(0.02)
        yield json.loads(file.read_text())["address"], process


def worker(address: str, *folders: Path) -> Any:
    words = ["--nthreads", "1", "--no-nanny", "--no-dashboard"]
    return started("worker", address, *words, folders=folders)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Of a scheduler with one worker."""
    with scheduler(tmp_path_factory.mktemp("dask")) as (result, _), worker(result):
        yield result


def test_a_cluster_computes_every_chunk_also_if_a_worker_is_killed_at_work(
    address: str, tmp_path: Path
) -> None:
    orders = Orders(STUDY, tmp_path, pause=0.2)
    with worker(address) as second, closing(Cluster(orders.task, address)) as pool:
        while pool.room < 4:
            time.sleep(0.05)
            pool.look()
        actual = []
        for done in computed(pool, CHUNKS):
            actual.append(done)
            if len(actual) == 3:
                assert second.pid in orders.processes()
                second.kill()
    check(actual)
    begun = [int(file.name.split("-")[0]) for file in tmp_path.iterdir()]
    assert len(begun) > len(set(begun)) == len(CHUNKS)  # at least one was lost, and begun again


def test_workers_with_other_versions_are_refused(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = clusters.versions()
    monkeypatch.setattr(clusters, "versions", lambda: {**here, "numpy": "1.0"})
    with (
        closing(Cluster(Orders(STUDY, tmp_path).task, address)) as pool,
        refused(StoppedError, name="numpy", given=here["numpy"], wanted="1.0"),
    ):
        list(computed(pool, CHUNKS))


def test_what_the_study_itself_raises_passes_through(address: str, tmp_path: Path) -> None:
    task = evaluator.ChunkTask(studies.refuse, b"")
    for pool in (Threads(task, 1), Cluster(task, address)):
        with closing(pool), refused(UsageError) as caught:
            list(computed(pool, CHUNKS[:1]))
        assert not isinstance(caught.value, StoppedError)


# A cluster computes a study in the test above.
@pytest.mark.exhaustive
def test_a_cluster_computes_for_a_search_and_a_map_too(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What no loop computes, bit for bit as here; the first designs are computed here, for time."""
    sent: list[Any] = []
    submit = Cluster.submit

    def counted(pool: Cluster, chunk: Any) -> Any:
        sent.append(chunk)
        return submit(pool, chunk)

    monkeypatch.setattr(Cluster, "submit", counted)
    monkeypatch.setattr(evaluator, "QUICK", 0.0)
    monkeypatch.setattr(evaluator, "HANDY", 0.0)
    some = load_study("study-of-balance")
    swing = Output("swing", "analyze", "strokes.rocker.stroke", make="smallest")
    some = replace(some, outputs=(swing,), sampling=replace(some.sampling, designs=32))
    results = [search(some, population=8, generations=2, cluster=item) for item in (None, address)]
    assert results[0].to_dict() == results[1].to_dict()
    assert (begun := len(sent)) > 0
    over = {"links.crank.points.B.x": [0.03, 0.035], "links.coupler.points.C.x": [0.1, 0.12]}
    model, of = Template.load("yamashita-1"), Objective("shaking_force")
    here, there = (landscape(model, over, of, cluster=item) for item in (None, address))
    assert np.array_equal(here.values, there.values)
    assert len(sent) > begun


def test_workers_of_this_machine_have_no_place_beside_a_cluster() -> None:
    study = load_study("study-of-balance")
    with refused(UsageError, by="elsewhere"):
        search(study, workers=2, cluster="tcp://127.0.0.1:9")


# Clusters at work are started before a release; the other refusals of executors stay.
@pytest.mark.exhaustive
def test_a_cluster_that_lacks_equipoise_or_goes_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "equipoise").mkdir()
    (tmp_path / "equipoise" / "__init__.py").write_text(
        'raise ModuleNotFoundError("No module named equipoise", name="equipoise")'
    )
    monkeypatch.setattr(clusters, "JOIN", 0.2)
    task = Orders(STUDY, tmp_path).task
    with scheduler(tmp_path) as (address, process):
        with refused(StoppedError, address=address):
            Cluster(task, address)
        monkeypatch.setattr(clusters, "JOIN", 20)
        with worker(address, tmp_path), closing(Cluster(task, address)) as pool:
            with refused(StoppedError, name="equipoise"):
                list(computed(pool, CHUNKS))
            process.kill()
            with refused(StoppedError, address=address):
                list(computed(pool, CHUNKS))
    assert capfd.readouterr() == ("", "")


# `test_what_cannot_be_asked_makes_no_store` of test_run.py is refused alike.
@pytest.mark.exhaustive
def test_no_scheduler_is_reported_in_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(clusters, "ANSWER", 0.5)
    task = Orders(STUDY, tmp_path).task
    pytest.importorskip("distributed")  # which gives its logger a level
    level = logging.getLogger("distributed").level
    with socket.create_server(("127.0.0.1", 0)) as silent:
        addresses = [f"tcp://127.0.0.1:{silent.getsockname()[1]}", "tcp://127.0.0.1:9", "here", ""]
        for address in addresses:
            with refused(StoppedError, address=address):
                Cluster(task, address)
    assert capfd.readouterr() == ("", "")
    assert logging.getLogger("distributed").level == level
