"""A study without mechanics: a model of three numbers, and figures that are short formulas.

Also what is wanted of those who compute it: to be slow, to die, to end at any moment.
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from equipoise.codegen.figures import NO_ASSEMBLY, NO_FULL_TURN
from equipoise.design.evaluator import ChunkTask
from equipoise.design.variables import Choices, Normal, Range, Variable
from equipoise.errors import UsageError
from equipoise.studies import run
from equipoise.studies.outcomes import DesignBlock, Outcome
from equipoise.studies.store import Store
from equipoise.studies.study import Output, Sampling, Study, from_plain, samples

Array = np.ndarray[Any, Any]
LENGTH, MASS, SPEED = "links.rod.length", "links.crank.mass", "drive.speed"


@dataclass(frozen=True)
class Numbers:
    """A model of some numbers, each with its dimension."""

    values: Mapping[str, tuple[float, str]] = field(
        default_factory=lambda: {
            LENGTH: (0.07, "length"),
            MASS: (0.2, "mass"),
            SPEED: (20.0, "angular speed"),
        }
    )
    kind: str = "linkage"

    def number(self, path: str) -> tuple[float, str | None]:
        return self.values[path]

    def words(self, path: str) -> str:
        return path

    def base(self) -> Any:
        return self

    def machine(self, values: Mapping[str, float]) -> Any:
        return self

    def texts(self) -> dict[str, str]:
        return {"numbers": json.dumps(dict(self.values))}


def short_study(designs: int = 1000, chunk: int = 100, **changes: Any) -> Study:
    """Three numbers, three figures; area is to become small within a limit, energy large."""
    given: dict[str, Any] = {
        "title": "Short formulas",
        "model": Numbers(),
        "vary": (
            Variable(LENGTH, Range(0.06, 0.08)),
            Variable(MASS, Choices((0.1, 0.2, 0.4))),
            Variable(SPEED, Normal(20.0, 1.0)),
        ),
        "outputs": (
            Output("area", at_least=0.0045, make="smallest"),
            Output("momentum", dimension="force"),
            Output("energy", dimension="energy", make="largest"),
        ),
        "sampling": Sampling("sobol", designs, seed=7),
        "chunk": chunk,
    }
    return Study(**{**given, **changes})


def restore(texts: Mapping[str, str]) -> Study:
    """The study that a store holds."""
    return from_plain(json.loads(texts["study"]), Numbers())


@dataclass
class Formulas:
    """Figures of designs (P, 3); some do not assemble, some do not turn fully."""

    compiled: bool = True
    engine: str = "numba"
    pause: float = 0.0

    def __call__(self, values: Array) -> Outcome:
        time.sleep(self.pause)
        length, mass, speed = values.T
        figures = np.column_stack([length**2, mass * length * speed, mass * (length * speed) ** 2])
        reason = np.where(length < 0.062, NO_ASSEMBLY, np.where(speed > 22, NO_FULL_TURN, 0))
        figures[reason != 0] = np.nan
        return Outcome(figures, reason.astype(np.uint8))


def filled(path: Path, study: Study, chunks: Iterable[int] = (0, 1, 2)) -> Store:
    """A new store of a study, with designs in some of its chunks."""
    store = run.create_store(path, study, study.chunk, "numba")
    for designs in map(store.designs, chunks):
        values = samples(study, designs.start, len(designs))
        store.write(designs, DesignBlock(values, Formulas()(values)))
    return store


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder, by its path."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


# -- tasks for other processes ---------------------------------------------------------------------


@dataclass(frozen=True)
class Orders:
    """What whoever computes a chunk has to do besides.

    folder : where each chunk leaves a file with the number of the process that begins it.
    pause : time that each takes, s.
    deadly : first designs of the chunks at which the process is killed, so many times.
    """

    study: Study
    folder: Path
    pause: float = 0.0
    deadly: Mapping[int, int] = field(default_factory=dict)

    @property
    def task(self) -> ChunkTask:
        return ChunkTask(obey, pickle.dumps(self))

    def processes(self) -> set[int]:
        """Numbers of the processes that have begun a chunk."""
        return {int(file.name.split("-")[1]) for file in self.folder.glob("*-*")}


def obey(packed: bytes, designs: range) -> DesignBlock:
    """Compute designs as ordered."""
    orders: Orders = pickle.loads(packed)
    before = len(list(orders.folder.glob(f"{designs.start}-*")))
    (orders.folder / f"{designs.start}-{os.getpid()}-{before}").touch()
    if before < orders.deadly.get(designs.start, 0):
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(orders.pause)
    values = samples(orders.study, designs.start, len(designs))
    return DesignBlock(values, Formulas()(values))


def refuse(packed: bytes, designs: range) -> DesignBlock:
    """As a study that cannot be computed."""
    raise UsageError(f"no study at {designs.start}")


def main(command: str, path: str) -> None:
    """In a process that is going to be killed: a sweep of the short study, or its resumption."""
    run.evaluator = lambda study, threads: Formulas(pause=0.02)
    if command == "sweep":
        run.sweep(short_study(), path, workers=2)
    else:
        run.resume(path, restore, workers=1)


if __name__ == "__main__":
    main(*sys.argv[1:])
