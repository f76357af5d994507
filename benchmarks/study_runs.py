"""Whole studies: first figures of a new process, a million designs stored, memory, a cluster."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median

import numpy as np

import equipoise as eq
from asked import Limit, Table, agree
from equipoise.codegen.backends import FOLDER, run_loop
from equipoise.codegen.batch import Batch, all_angles, designs_of, grid_of
from equipoise.codegen.figures import Figure
from equipoise.design.variables import Range, Variable
from equipoise.schema.template import Template
from equipoise.studies.run import sweep
from equipoise.studies.store import open_store
from equipoise.studies.study import Output, Sampling, Study, samples
from timing import in_turn

MACHINE = eq.load("yamashita-1")
ANGLES = 360
SIGNALS = ("shaking_force.y", "shaking_moment", "drive_torque")
VARIED = {
    "links.coupler.points.C.x": (0.065, 0.08),
    "links.rocker.points.C.x": (0.075, 0.085),
    "links.crank.points.B.x": (0.03, 0.035),
    "links.rocker.mass": (0.1, 0.3),
}
"""Path -> range, m and kg; all of these designs turn fully."""
MILLION = 1_000_000
MANY, ROOM = 10 * MILLION, 2048
"""Designs of a large study, and the memory that it may take, MiB."""
DENSE, ENOUGH = 3600, MILLION
"""Crank angles and designs of the study for a cluster: a chunk takes a worker half a second."""
CLOSE = 1e-12
FIRST_FIGURES = f"""
import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
wanted = [Figure(signal, "rms") for signal in {SIGNALS}]
Batch(eq.load("yamashita-1"), ["links.rocker.mass"], wanted, {ANGLES})([[0.2]])
"""


def designs(count: int) -> np.ndarray:
    """Values (P, 4) of the varied numbers."""
    low, high = np.transpose([*VARIED.values()])
    return low + (high - low) * np.random.default_rng(1).random((count, len(VARIED)))


def study_of(count: int, angles: int = ANGLES) -> Study:
    vary = tuple(Variable(path, Range(*limits)) for path, limits in VARIED.items())
    outputs = tuple(Output(f"{signal}.rms") for signal in SIGNALS)
    sampling = Sampling("sobol", count)
    return Study("lengths and a mass", Template.of(MACHINE), vary, outputs, sampling, angles=angles)


# -- first figures ---------------------------------------------------------------------------------


def first_call(table: Table) -> None:
    """New processes, from their start to the first figures, with and without compiled loops."""
    with tempfile.TemporaryDirectory() as place:
        known, new = Path(place, "known"), Path(place, "new")

        def figures(folder: Path, *, forget: bool) -> Callable[[], object]:
            def task() -> None:
                if forget:
                    shutil.rmtree(folder, ignore_errors=True)
                python("-c", FIRST_FIGURES, **{FOLDER: str(folder)})

            return task

        tasks = {
            "import numpy": lambda: python("-c", "import numpy"),
            "cached": figures(known, forget=False),
            "compiled": figures(new, forget=True),
        }
        times = in_turn(tasks, 7)
    table.value("first figures of a process, loop cached", times["cached"], "s", Limit(1.0))
    table.ratio("    / import numpy", times["cached"], times["import numpy"])
    table.value("first figures of a process, loop compiled", times["compiled"], "s")
    table.ratio("    / import numpy", times["compiled"], times["import numpy"])


def python(*arguments: str, **environment: str) -> str:
    """What a new process prints."""
    command = [sys.executable, *arguments]
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, env=os.environ | environment
    )
    return done.stdout


# -- stored ----------------------------------------------------------------------------------------


def stored(table: Table) -> None:
    """A million designs, drawn, computed and stored, beside the bare loop; both on two threads."""
    study = study_of(MILLION)
    values = samples(study, 0, MILLION)
    batch = Batch(MACHINE, study.paths, [Figure(signal, "rms") for signal in SIGNALS], ANGLES)
    numbers = designs_of(batch.source, batch.base, batch.paths, values).table
    grid = grid_of(batch.source, all_angles(ANGLES, 1))

    def bare() -> np.ndarray:
        with ThreadPoolExecutor(2) as pool:
            parts = pool.map(
                lambda part: run_loop(batch.source, part, grid), np.array_split(numbers, 16)
            )
            return np.concatenate(list(parts))

    with tempfile.TemporaryDirectory() as place:
        path = Path(place, "store")
        tasks = {
            "bare": bare,
            "sweep": lambda: sweep(study, path, workers=2),
            "clearing up": lambda: shutil.rmtree(path),
        }
        tasks["sweep"]()
        found = open_store(path).read(range(MILLION)).outcome.figures
        agree("a study, stored", found, np.sqrt(bare()[:, : len(SIGNALS)] / ANGLES), CLOSE)
        tasks["clearing up"]()
        times = in_turn(tasks, 7)
    rate = [MILLION / one / 1e6 for one in times["sweep"]]
    print(f"a million designs stored: {max(rate):.2f} million a second, median {median(rate):.2f}")
    table.ratio(
        "rate of a study, stored / bare loop, 2 threads",
        times["bare"],
        times["sweep"],
        Limit(0.7, at_most=False),
    )


def memory(table: Table) -> None:
    """Memory of a process that computes and stores many designs."""
    said = json.loads(python(__file__))
    what = f"memory of a study of {MANY / 1e6:g} million designs ({said['seconds']:.1f} s)"
    table.value(what, [said["peak"]], "MiB", Limit(ROOM))


def measure_memory() -> None:
    """In a process of its own: compute and store, and print time and largest memory."""
    from resource import RUSAGE_SELF, getrusage  # not on every system

    with tempfile.TemporaryDirectory() as place:
        begin = time.perf_counter()
        sweep(study_of(MANY), Path(place, "store"))
        seconds = time.perf_counter() - begin
    peak = getrusage(RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"seconds": seconds, "peak": peak}))


# -- more processes --------------------------------------------------------------------------------


def cluster(table: Table) -> None:
    """One and two Dask workers of one thread each, on this machine, by the same command.

    Where other programs want the processors too, the processor time of the busier worker tells how
    the work was shared.
    """
    study = study_of(ENOUGH, DENSE)
    busy: dict[int, list[float]] = {1: [], 2: []}
    with ExitStack() as held:
        place = Path(held.enter_context(tempfile.TemporaryDirectory()))
        started = {count: held.enter_context(workers(count, place)) for count in busy}

        def swept(count: int) -> Callable[[], object]:
            address, processes = started[count]

            def task() -> None:
                before = [processor_time(one) for one in processes]
                sweep(study, place / "store", cluster=address)
                after = [processor_time(one) for one in processes]
                busy[count].append(max(b - a for a, b in zip(before, after, strict=True)))
                shutil.rmtree(place / "store")

            return task

        times = in_turn({str(count): swept(count) for count in busy}, 3)
    limit = Limit(1.7, at_most=False)
    table.ratio(f"rate of two Dask workers / one, {DENSE} angles", times["1"], times["2"], limit)
    table.ratio("    processor time of one / of the busier of two", busy[1][1:], busy[2][1:])


def processor_time(process: subprocess.Popen[bytes]) -> float:
    """Processor time that a process has had so far, s."""
    import psutil  # comes with Dask

    spent = psutil.Process(process.pid).cpu_times()
    return float(spent.user + spent.system)


@contextmanager
def workers(count: int, place: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Address of a new scheduler, and its workers of one thread each."""
    told, host = place / f"scheduler-{count}.json", ["--host", "127.0.0.1", "--no-dashboard"]
    alone = ["--nthreads", "1", "--no-nanny", "--local-directory", str(place)]
    file = ["--scheduler-file", str(told)]
    with ExitStack() as held:
        held.enter_context(dask("scheduler", *host, "--port", "0", *file))
        started = [held.enter_context(dask("worker", *host, *alone, *file)) for _ in range(count)]
        while not (told.exists() and (found := told.read_text(encoding="utf-8"))):
            time.sleep(0.1)
        yield json.loads(found)["address"], started


@contextmanager
def dask(*arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A Dask process."""
    command = [sys.executable, "-m", "dask", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


if __name__ == "__main__":
    measure_memory()
