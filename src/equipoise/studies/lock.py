"""One process at a time writes into a store; whoever comes second is told who was first.

The lock is one of the operating system on a file in the store.  It goes with the process that holds
it, however that ends, so that no lock is ever left behind.
"""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from equipoise.errors import UsageError

NAME = ".lock"
"""Of the file; empty while nobody holds it."""

if sys.platform == "win32":
    import msvcrt

    BEHIND = 1_000_000
    """What is locked: a byte behind the text, which others could not read otherwise."""

    def _take(descriptor: int) -> None:
        os.lseek(descriptor, BEHIND, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a store.

    Raises
    ------
    UsageError : another process has it; the sentence names it.
    OSError : the folder cannot be written into, or its disk knows no locks.
    """
    # Files opened by Python are not handed down to processes that are started meanwhile.
    descriptor = os.open(folder / NAME, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            _take(descriptor)
        except (BlockingIOError, PermissionError) as error:
            raise UsageError(
                f"{folder}: {_holder(folder)} is writing into this store; wait until it is done, "
                "or stop it"
            ) from error
        with suppress(OSError):  # of a full disk, which will be told of where it matters
            os.ftruncate(descriptor, 0)
            os.lseek(descriptor, 0, os.SEEK_SET)
            os.write(descriptor, f"process {os.getpid()} on {socket.gethostname()}".encode())
        try:
            yield
        finally:
            with suppress(OSError):
                os.ftruncate(descriptor, 0)
    finally:
        os.close(descriptor)


def _holder(folder: Path) -> str:
    try:
        return (folder / NAME).read_text("utf-8") or "another process"
    except (OSError, ValueError):
        return "another process"
