"""The evaluator of a design problem: figures of designs, in threads or processes of this machine.

Both are a `concurrent.futures.Executor` behind a `Pool`, as is a cluster.  A `Runner` chooses among
them, and is all that a run sees of them.  What a chunk is does not depend on who computes it.

The processes are those of the standard library.  joblib's loky was measured beside them
(`benchmarks/pools.py`): it starts later and shares out small tasks faster, but its processes stay
with their memory when the work is over, and some seconds after Ctrl-C or the death of whoever
started them they were still there.

A search and an analysis of tolerances draw designs as they go on, and a map has them all.  Those
that compiled loops compute take microseconds, and the loops use all processors; the others are
shared out.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager, suppress
from functools import lru_cache, partial
from multiprocessing import get_context
from multiprocessing.connection import Connection
from time import monotonic
from types import ModuleType
from typing import Any, Generic, NamedTuple, Self, TypeVar

from equipoise.codegen.backends import processors
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.signals import Array

TRIES = 3
"""How often processes may die one after the other, with nothing finished in between."""
TICK = 1.0
"""Time between looks after the pool, s."""
DEAD = Note(
    "processes that compute died {tries} times in a row, perhaps for want of "
    "memory; give fewer workers",
    tries=TRIES,
)
Chunk = TypeVar("Chunk")
ResultT = TypeVar("ResultT")
MOST_PROCESSES = 61 if sys.platform == "win32" else 10_000


@dataclass(frozen=True)
class ChunkTask:
    """What is to be computed of a chunk.

    function : at the top level of a module, so that other processes find it; it is given `study`
        and a chunk, such as the numbers of its designs.
    study : as the bytes that go to other processes.
    """

    function: Callable[[bytes, Any], Any]
    study: bytes


class StoppedError(UsageError):
    """Nobody can go on computing; `str(error)` says why, and what would help."""


class Pool(ABC):
    """Somebody who computes chunks.

    room : how many chunks it is given at once.
    """

    room: int

    @abstractmethod
    def submit(self, chunk: Any) -> Future[Any]:
        """Begin to compute a chunk."""

    @abstractmethod
    def close(self) -> None:
        """Stop, and leave what is not finished."""

    @property
    def is_ready(self) -> bool:
        """Whether a chunk would be computed at once, and not after what computes has started."""
        return True

    def look(self) -> None:  # noqa: B027
        """See whether somebody is still at work; `StoppedError` if not.

        On this machine nobody leaves without being noticed.
        """

    def explained(self, error: Exception) -> StoppedError | None:
        """What ended the work on a chunk, if it is not the chunk itself, as it is here."""
        return None


def computed(
    pool: Pool, chunks: Iterable[Chunk], here: Callable[[Chunk], Any] | None = None
) -> Iterator[tuple[Chunk, Any]]:
    """Compute chunks, and give each with its result once it is finished.

    They come in any order, and few are under way at a time.  What was lost because a process died
    is begun again, which changes nothing in it.

    here : computes chunks in this process too, while the pool computes others.

    Raises
    ------
    StoppedError : nobody can compute them.
    """
    left, under_way = deque(chunks), dict[Future[Any], Chunk]()
    deaths, looked = 0, monotonic()
    while left or under_way:
        most_waiting = 0 if here is None else 1 if pool.is_ready else len(left)
        while len(left) > most_waiting and len(under_way) < pool.room:
            chunk = left.popleft()
            under_way[pool.submit(chunk)] = chunk
        if here is not None and left:
            chunk = left.popleft()
            yield chunk, here(chunk)
        finished, _ = wait(under_way, 0.0 if here and left else TICK, FIRST_COMPLETED)
        if monotonic() - looked > TICK:
            pool.look()
            looked = monotonic()
        for future in finished:
            chunk = under_way.pop(future)
            try:
                block = future.result()
            except BrokenExecutor as error:  # whatever else is under way is lost, too
                deaths += 1
                if deaths == TRIES:
                    raise StoppedError(DEAD) from error
                left.extend((chunk, *under_way.values()))
                under_way.clear()
                break
            except Exception as error:
                if (explained := pool.explained(error)) is None:
                    raise
                raise explained from error
            else:
                deaths = 0
                yield chunk, block


class Runner(Generic[Chunk, ResultT]):
    """Computes chunks; a context manager, which ends whoever computes them.

    Parameters
    ----------
    alone : computes a chunk in this process.
    make : makes the same in another process, to which it goes as bytes.
    workers : threads or processes; as many as this machine has processors if not given.
    threads : whether threads of this process are enough, since what computes holds no lock.
    helps : whether this process is one of the workers, and computes chunks while others do.
    elsewhere : begins a pool of others, such as a cluster, which is begun at once and takes the
        place of those of this machine.

    Raises
    ------
    UsageError : fewer than one worker; or as `elsewhere`.
    """

    def __init__(
        self,
        alone: Callable[[Chunk], ResultT],
        make: Callable[[], Callable[[Chunk], ResultT]],
        workers: int | None = None,
        *,
        threads: bool = False,
        helps: bool = False,
        elsewhere: Callable[[ChunkTask], Pool] | None = None,
    ) -> None:
        self.alone, self.make, self.threads = alone, make, threads and elsewhere is None
        self.helps = helps and elsewhere is None
        self.workers = processors() if workers is None else workers
        if self.workers < 1:
            raise UsageError(Note("got {workers} workers; give 1 or more", workers=self.workers))
        self.pool = None if elsewhere is None else elsewhere(self._task())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End whoever computes."""
        if self.pool is not None:
            self.pool.close()

    def begin(self) -> Pool:
        """The pool, begun where it is not yet."""
        if self.pool is None:
            kind = Threads if self.threads else Processes
            self.pool = kind(self._task(), self.workers - self.helps)
        return self.pool

    def each(self, chunks: Iterable[Chunk]) -> Iterator[tuple[Chunk, ResultT]]:
        """Chunks, each with its result; see `computed`."""
        return computed(self.begin(), chunks, self.alone if self.helps else None)

    def _task(self) -> ChunkTask:
        if self.threads:
            return ChunkTask(lambda _, chunk: self.alone(chunk), b"")
        return ChunkTask(_compute, pickle.dumps(self.make))


def _compute(packed: bytes, chunk: Any) -> Any:
    """In another process: a chunk."""
    return _load_function(packed)(chunk)


def _make(packed: bytes) -> None:
    """In another process: make what computes, for chunks to come."""
    _load_function(packed)


@lru_cache(maxsize=2)
def _load_function(packed: bytes) -> Callable[[Any], Any]:
    """What computes, made once in a process."""
    compute: Callable[[Any], Any] = pickle.loads(packed)()
    return compute


# -- on this machine -------------------------------------------------------------------------------


class Threads(Pool):
    """Threads of this process, for what computes without Python's lock."""

    def __init__(self, task: ChunkTask, workers: int) -> None:
        self.task, self.room = task, workers + 1
        self.executor = ThreadPoolExecutor(workers)

    def submit(self, chunk: Any) -> Future[Any]:
        return self.executor.submit(self.task.function, self.task.study, chunk)

    def close(self) -> None:
        """Wait for the chunks that are under way; they do not take long."""
        self.executor.shutdown(cancel_futures=True)


class Processes(Pool):
    """Processes that are started for it, and started again when one of them dies; the first thing
    that they do is to make what computes.

    They end when the other end of a pipe closes: at once when the work is over or stopped, and also
    when this process is killed.
    """

    def __init__(self, task: ChunkTask, workers: int) -> None:
        self.task, self.workers = task, min(workers, MOST_PROCESSES)
        self.room = 2 * self.workers
        self._start()

    def _start(self) -> None:
        context = get_context("spawn")  # others have threads of libraries in them, half alive
        self.watched, self.pipe_end = context.Pipe(duplex=False)
        self.executor = ProcessPoolExecutor(self.workers, context, _begin, (self.watched,))
        with _apart():  # all are started, each by one of these
            self.started = [
                self.executor.submit(_make, self.task.study) for _ in range(self.workers)
            ]

    @property
    def is_ready(self) -> bool:
        """Whether one of them has made what computes."""
        return any(future.done() for future in self.started)

    def submit(self, chunk: Any) -> Future[Any]:
        try:
            return self._submitted(chunk)
        except BrokenExecutor:
            self.close()
            self._start()
            return self._submitted(chunk)

    def _submitted(self, chunk: Any) -> Future[Any]:
        with _apart():  # here is where processes are started
            return self.executor.submit(self.task.function, self.task.study, chunk)

    def close(self) -> None:
        """End the processes."""
        self.pipe_end.close()
        self.executor.shutdown(cancel_futures=True)
        self.watched.close()


@contextmanager
def _apart() -> Iterator[None]:
    """Start processes that neither run the user's script again nor ever hear Ctrl-C."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        if sys.platform == "win32":
            yield
        else:
            before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                yield
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)
    finally:
        sys.modules["__main__"] = script


def _begin(watched: Connection) -> None:
    """In a new process: end with the one that started it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where it could not be kept from hearing
    threading.Thread(target=_end_with, args=(watched,), daemon=True).start()


def _end_with(watched: Connection) -> None:
    with suppress(EOFError, OSError):
        watched.recv_bytes()
    os._exit(1)


FiguresT = TypeVar("FiguresT")
"""What is computed of some designs, in their order: an array (P, ...), or figures with reasons."""
Evaluate = Callable[[Array], FiguresT]
"""Computes designs (P, d), values in SI units."""
OnDesigns = Callable[[int], None]
"""Is called with the designs of a call that are computed so far."""

PATIENCE = 2.0
"""Time of computing alone after which processes are started, which takes them about as long, s; at
once where designs that are still to come take longer."""
EARLY = 400
"""Designs, or batches of them, that are to come from which processes start before the first design
is computed: one by one they take some milliseconds each, and processes need as long to start as
this one to import what the first needs."""
QUICK = 0.2
"""Time below which twice as many designs are computed alone before the clock is read again, s."""
SHARES = 3
"""Each part is what is left over this and the workers: parts become small towards the end, so that
all end at about the same time."""
HANDY = 0.05
"""Time of designs that are computed here though there are processes, s: to send them there and back
takes some milliseconds, and whoever descends asks for few at a time."""
PART = 1.0
"""Time that a part takes at most, s, so that progress is reported."""


class DesignSlice(NamedTuple):
    """Some of the designs that are computed together.

    begin : place of the first among them.
    values : (P, d), SI units.
    """

    begin: int
    values: Array


class PooledEvaluator(Generic[FiguresT]):
    """Computes designs; a context manager, which ends its processes.

    Parameters
    ----------
    alone : computes designs here.
    make : makes the same in another process, to which it goes as bytes.
    join : what several parts give, one after the other, as one.
    workers : processes, this one among them; as many as this machine has processors if not given.
    shared : whether processes help at all; not where loops use all processors.
    batch_size : designs that are sent together where there are as many for each process: those that
        one run of arrays computes take longer in small parts.
    expected : designs that are to come, in all calls, if that is known; at most so many.
    elsewhere : begins a pool of others that compute instead, such as a cluster, once it is known
        how long a design takes.

    Raises
    ------
    UsageError : fewer than one worker; or as `elsewhere`.
    """

    def __init__(
        self,
        alone: Evaluate[FiguresT],
        make: Callable[[], Evaluate[FiguresT]],
        join: Callable[[Sequence[FiguresT]], FiguresT],
        workers: int | None = None,
        *,
        shared: bool = True,
        batch_size: int = 1,
        expected: int = 0,
        elsewhere: Callable[[ChunkTask], Pool] | None = None,
    ) -> None:
        self.alone, self.join = alone, join
        self.batch_size, self.expected = batch_size, expected
        self.runner: Runner[DesignSlice, FiguresT] = Runner(
            lambda part: alone(part.values),
            partial(_of_parts, make),
            workers,
            helps=True,
            elsewhere=elsewhere,
        )
        self.shared = elsewhere is not None or (self.runner.workers > 1 and shared)
        self.patience = PATIENCE if elsewhere is None else QUICK
        self.spent, self.count, self.step, self.begun = 0.0, 0, 1, False
        self.later = 0.0, 0  # time and designs after the first part
        if self.shared and expected >= EARLY * batch_size:
            self.runner.begin()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End its processes."""
        self.runner.close()

    @property
    def is_shared_out(self) -> bool:
        """Whether others compute, since computing alone has taken long or would."""
        return self.shared and self.count > 0 and (self.begun or self.spent > self.patience)

    def __call__(self, values: Array, progress: OnDesigns | None = None) -> FiguresT:
        """What is computed of designs (P, d), SI units, in their order.

        Raises
        ------
        UsageError : processes die, such as for want of memory.
        """
        if not self.shared and progress is None:
            return self.alone(values)
        report = progress or (lambda _: None)
        if self.is_shared_out and self.each * len(values) < HANDY:
            return self._computed_alone(values, len(values))
        outcomes, begin = [], 0
        while begin < len(values) and not self.is_shared_out:
            part = values[begin : begin + self.step]
            outcomes.append(self._computed_alone(part, len(values) - begin))
            begin += len(part)
            report(begin)
        if begin < len(values):
            outcomes += self._shared_out(values[begin:], lambda k: report(begin + k))
        return self.join(outcomes)

    @property
    def each(self) -> float:
        """Time that a design takes in the mean, s."""
        seconds, count = self.later if self.later[1] else (self.spent, self.count)
        return seconds / count

    def _computed_alone(self, part: Array, left: int) -> FiguresT:
        """Compute a part of the designs that are left of a call, and see whether others are to."""
        start = monotonic()
        outcome = self.alone(part)
        took = monotonic() - start
        if took < QUICK and not self.is_shared_out:
            self.step *= 2
        is_first, self.count = not self.count, self.count + len(part)
        self.spent += took
        if not is_first:  # that part took as long as all that is imported for it
            self.later = self.later[0] + took, self.later[1] + len(part)
            to_come = max(left - len(part), self.expected - self.count)
            is_long = self.spent > QUICK and self.each * to_come > PATIENCE
            self.begun = self.begun or is_long or self.runner.pool is not None
        return outcome

    def _shared_out(self, values: Array, report: OnDesigns) -> list[FiguresT]:
        self.begun = True
        result, done = {}, 0
        for part, outcome in self.runner.each(self._parts(values)):
            result[part.begin] = outcome
            done += len(part.values)
            report(done)
        return [result[start] for start in sorted(result)]

    def _parts(self, values: Array) -> Iterator[DesignSlice]:
        """Designs in parts, the first ones large."""
        workers, begin = self.runner.workers, 0
        least = min(self.batch_size, -(-len(values) // workers))
        most = max(1, int(PART / max(self.each, 1e-9)))
        while begin < len(values):
            size = max(least, min(most, -(-(len(values) - begin) // (SHARES * workers))))
            yield DesignSlice(begin, values[begin : begin + size])
            begin += size


def _of_parts(make: Callable[[], Evaluate[Any]]) -> Callable[[DesignSlice], Any]:
    """In another process: what computes parts."""
    evaluate = make()
    return lambda part: evaluate(part.values)
