"""Who computes the chunks: threads of this process, processes of this machine, or a Dask cluster.

All three are a `concurrent.futures.Executor` behind a `Pool`, and `computed` is all that a run
sees of them.  What a chunk is does not depend on who computes it.
"""

from __future__ import annotations

import asyncio
import logging
import os
import pickle
import signal
import sys
import threading
import warnings
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from socket import gethostname
from time import monotonic, sleep
from types import ModuleType
from typing import Any, TypeVar

from equipoise.errors import UsageError, needed
from equipoise.studies.store import brief, versions

TRIES = 3
"""How often processes may die one after the other, with nothing finished in between."""
TICK = 1.0
"""Time between looks after the pool, s."""
DEAD = (
    f"processes that compute died {TRIES} times in a row, perhaps for want of memory; give fewer "
    "workers"
)
Chunk = TypeVar("Chunk")
MOST_PROCESSES = 61 if sys.platform == "win32" else 10_000


@dataclass(frozen=True)
class Task:
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

    def look(self) -> None:  # noqa: B027
        """See whether somebody is still at work; `StoppedError` if not.

        On this machine nobody leaves without being noticed.
        """

    def explained(self, error: Exception) -> StoppedError | None:
        """What ended the work on a chunk, if it is not the chunk itself, as it is here."""
        return None


def computed(pool: Pool, chunks: Iterable[Chunk]) -> Iterator[tuple[Chunk, Any]]:
    """Compute chunks, and give each with its result once it is finished.

    They come in any order, and few are under way at a time.  What was lost because a process died
    is begun again, which changes nothing in it.

    Raises
    ------
    StoppedError : nobody can compute them.
    """
    left, under_way = deque(chunks), dict[Future[Any], Chunk]()
    deaths, looked = 0, monotonic()
    while left or under_way:
        while left and len(under_way) < pool.room:
            chunk = left.popleft()
            under_way[pool.submit(chunk)] = chunk
        finished, _ = wait(under_way, TICK, FIRST_COMPLETED)
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


# -- on this machine -------------------------------------------------------------------------------


class Threads(Pool):
    """Threads of this process, for what computes without Python's lock."""

    def __init__(self, task: Task, workers: int) -> None:
        self.task, self.room = task, workers + 1
        self.executor = ThreadPoolExecutor(workers)

    def submit(self, chunk: Any) -> Future[Any]:
        return self.executor.submit(self.task.function, self.task.study, chunk)

    def close(self) -> None:
        """Wait for the chunks that are under way; they do not take long."""
        self.executor.shutdown(cancel_futures=True)


class Processes(Pool):
    """Processes that are started for it, and started again when one of them dies.

    They end when the other end of a pipe closes: at once when the work is over or stopped, and also
    when this process is killed.
    """

    def __init__(self, task: Task, workers: int) -> None:
        self.task, self.workers = task, min(workers, MOST_PROCESSES)
        self.room = 2 * self.workers
        self._start()

    def _start(self) -> None:
        context = get_context("spawn")  # others have threads of libraries in them, half alive
        self.watched, self.held = context.Pipe(duplex=False)
        self.executor = ProcessPoolExecutor(self.workers, context, _begin, (self.watched,))

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
        self.held.close()
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


ANSWER = 5.0
"""Time in which a scheduler has to answer, s."""
JOIN = 10.0
"""Time that a cluster may be without workers, s: those that died are started again."""
LOGS = ("distributed", "distributed.client", "tornado.application")


class SilentError(StoppedError):
    """No scheduler answers."""


class Cluster(Pool):
    """Workers of a Dask scheduler.

    Raises
    ------
    StoppedError : no scheduler answers at `address`, or it has no workers.
    """

    def __init__(self, task: Task, address: str) -> None:
        self.task, self.address = task, address
        self.rpc = needed("distributed.core", "a cluster").rpc
        self.seen = monotonic()
        with ExitStack() as held:
            held.enter_context(_quiet())
            while not self._counted():
                sleep(0.2)
            distributed = needed("distributed", "a cluster")
            with warnings.catch_warnings():  # of versions, which each chunk looks after
                warnings.simplefilter("ignore")
                client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
            held.callback(client.close)
            self.executor = client.get_executor(pure=False)
            self.held = held.pop_all()

    def submit(self, chunk: Any) -> Future[Any]:
        call = Call(_compute, (versions(), self.task.function, self.task.study, chunk))
        future: Future[Any] = self.executor.submit(pickle.loads, pickle.dumps(call))
        return future

    def look(self) -> None:
        with suppress(SilentError):  # if it has gone for good, the chunks under way will tell
            self._counted()

    def _counted(self) -> int:
        """Threads of all workers; there is room for twice as many chunks, so that none waits."""
        try:
            with ThreadPoolExecutor(1) as aside:  # a notebook has a loop in this thread
                found = aside.submit(asyncio.run, self._identity()).result()
        except Exception as error:  # whatever may listen there
            raise SilentError(
                f"no Dask scheduler answers at {self.address} ({brief(error)}); see whether it "
                "runs, and whether a firewall is between"
            ) from error
        threads: int = found["total_threads"]
        self.room = max(1, 2 * threads)
        if threads:
            self.seen = monotonic()
        elif monotonic() - self.seen > JOIN:
            raise StoppedError(
                f"the Dask scheduler at {self.address} has no workers; start some by: dask worker "
                f"{self.address}"
            )
        return threads

    async def _identity(self) -> dict[str, Any]:
        """What the scheduler says of itself."""
        async with asyncio.timeout(ANSWER), self.rpc(self.address) as scheduler:
            found: dict[str, Any] = await scheduler.identity()
        return found

    def close(self) -> None:
        """Leave what is not finished, and the cluster to others."""
        self.executor.shutdown(wait=False)
        self.held.close()

    def explained(self, error: Exception) -> StoppedError | None:
        if isinstance(error, ModuleNotFoundError):
            return StoppedError(
                f"a worker of the cluster has no {error.name}; install the same on all hosts"
            )
        if isinstance(error, CancelledError):
            return StoppedError(f"the Dask scheduler at {self.address} has gone")
        killed = needed("distributed", "a cluster").KilledWorker
        return StoppedError(DEAD) if isinstance(error, killed) else None


@dataclass(frozen=True)
class Call:
    """A function and its arguments; reading it from its bytes calls it.

    What Dask cannot read ends a worker.  It can read bytes, wherever nothing else is installed, and
    whatever goes wrong then is told.
    """

    function: Callable[..., Any]
    arguments: tuple[Any, ...]

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return self.function, self.arguments


def _compute(
    wanted: dict[str, str], function: Callable[[bytes, Any], Any], study: bytes, chunk: Any
) -> Any:
    """On a worker: compute a chunk, if it has the versions of whoever asks."""
    for name, found in versions().items():
        if found != wanted.get(name):
            raise StoppedError(
                f"the worker on {gethostname()} has {name} {found}, and whoever asks it has "
                f"{wanted.get(name)}; install the same on all hosts"
            )
    return function(study, chunk)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the libraries from writing about what is told in a sentence."""
    levels = {log: log.level for log in map(logging.getLogger, LOGS)}
    for log in levels:
        log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for log, level in levels.items():
            log.setLevel(level)
