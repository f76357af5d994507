"""Workers of a Dask scheduler, who compute chunks as processes of this machine do."""

from __future__ import annotations

import asyncio
import logging
import pickle
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from socket import gethostname
from time import monotonic, sleep
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.design.evaluator import DEAD, ChunkTask, Pool, StoppedError
from equipoise.errors import UsageError, needed
from equipoise.i18n import Note
from equipoise.studies.store import brief, versions

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

    def __init__(self, task: ChunkTask, address: str) -> None:
        self.task, self.address = task, address
        self.rpc = needed("distributed.core", "a cluster").rpc
        self.last_contact = monotonic()
        with ExitStack() as exitstack:
            exitstack.enter_context(_quiet())
            while not self._counted():
                sleep(0.2)
            distributed = needed("distributed", "a cluster")
            with warnings.catch_warnings():  # of versions, which each chunk looks after
                warnings.simplefilter("ignore")
                client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
            exitstack.callback(client.close)
            self.executor = client.get_executor(pure=False)
            self.open_contexts = exitstack.pop_all()

    def submit(self, chunk: Any) -> Future[Any]:
        call = Call(_compute, (versions(), self.task.function, self.task.study, chunk))
        future: Future[Any] = self.executor.submit(pickle.loads, pickle.dumps(call))
        return future

    def look(self) -> None:
        with suppress(SilentError):  # if it has gone for good, the chunks under way fail
            self._counted()

    def _counted(self) -> int:
        """Threads of all workers; there is room for twice as many chunks, so that none waits."""
        try:
            with ThreadPoolExecutor(1) as aside:  # a notebook has a loop in this thread
                result = aside.submit(asyncio.run, self._identity()).result()
        except Exception as error:  # whatever may listen there
            raise SilentError(
                Note(
                    "no Dask scheduler answers at {address} ({brief}); see whether it runs, "
                    "and whether a firewall is between",
                    address=self.address,
                    brief=brief(error),
                )
            ) from error
        threads: int = result["total_threads"]
        self.room = max(1, 2 * threads)
        if threads:
            self.last_contact = monotonic()
        elif monotonic() - self.last_contact > JOIN:
            raise StoppedError(
                Note(
                    "the Dask scheduler at {address} has no workers; start some by: dask "
                    "worker {address}",
                    address=self.address,
                )
            )
        return threads

    async def _identity(self) -> dict[str, Any]:
        """What the scheduler says of itself."""
        async with asyncio.timeout(ANSWER), self.rpc(self.address) as scheduler:
            values: dict[str, Any] = await scheduler.identity()
        return values

    def close(self) -> None:
        """Leave what is not finished, and the cluster to others."""
        self.executor.shutdown(wait=False)
        self.open_contexts.close()

    def explained(self, error: Exception) -> StoppedError | None:
        if isinstance(error, ModuleNotFoundError):
            return StoppedError(
                Note(
                    "a worker of the cluster has no {name}; install the same on all hosts",
                    name=error.name,
                )
            )
        if isinstance(error, CancelledError):
            return StoppedError(
                Note("the Dask scheduler at {address} has gone", address=self.address)
            )
        killed = needed("distributed", "a cluster").KilledWorker
        return StoppedError(DEAD) if isinstance(error, killed) else None


def elsewhere(address: str | None, workers: int | None) -> Callable[[ChunkTask], Pool] | None:
    """What begins a cluster at an address; None where this machine computes.

    Raises
    ------
    UsageError : workers of this machine are given, too.
    """
    if address is None:
        return None
    if workers is not None:
        raise UsageError(Note("workers are those of this machine; leave them out with a cluster"))
    return lambda task: Cluster(task, address)


@dataclass(frozen=True)
class Call:
    """A function and its arguments; reading it from its bytes calls it.

    What Dask cannot read ends a worker.  It can read bytes, wherever nothing else is installed, and
    errors after that are reported.
    """

    function: Callable[..., Any]
    arguments: tuple[Any, ...]

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return self.function, self.arguments


def _compute(
    wanted: dict[str, str], function: Callable[[bytes, Any], Any], study: bytes, chunk: Any
) -> Any:
    """On a worker: compute a chunk, if it has the versions of whoever asks."""
    for name, version in versions().items():
        if version != wanted.get(name):
            raise StoppedError(
                Note(
                    "the worker on {host} has {name} {given}, and whoever asks it has "
                    "{wanted}; install the same on all hosts",
                    host=gethostname(),
                    name=name,
                    given=version,
                    wanted=wanted.get(name),
                )
            )
    return function(study, chunk)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the libraries from logging what an error reports in a sentence."""
    levels = {log: log.level for log in map(logging.getLogger, LOGS)}
    for log in levels:
        log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for log, level in levels.items():
            log.setLevel(level)
