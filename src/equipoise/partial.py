"""Files and folders on their way to be whole: made beside their place, and put there at the end.

What a process that was killed has left beside a place goes when the next one writes there.  Of what
is written `together`, all takes its place in the end, or nothing where something goes wrong.  Into
a folder that is `locked` no other process writes.
"""

from __future__ import annotations

import os
import shutil
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from equipoise.errors import UsageError
from equipoise.fence import check_written
from equipoise.interrupts import check, held_back

ENDING = ".tmp"


@contextmanager
def beside(target: Path) -> Iterator[Path]:
    """A free path beside a target, for what takes the target's place; gone in the end, if there.

    target : no symbolic link.
    """
    clear_left_over(target.parent)
    begun = target.with_name(f".{target.name[:100]}.{_here()}-{os.getpid()}{ENDING}")
    try:
        yield begun
    finally:
        _remove(begun)


@dataclass
class _Together:
    """What waits until all of it can be done.

    places : what is to take whose place.  stack : of what goes in the end.
    """

    stack: ExitStack
    places: dict[Path, Path] = field(default_factory=dict)
    then: list[Callable[[], None]] = field(default_factory=list)

    def done(self) -> None:
        check()
        for begun, target in self.places.items():
            try:
                os.replace(begun, target)
            except OSError as error:
                what = f"the file cannot be written ({(error.strerror or '').lower()})"
                raise UsageError(f"{target}: {what}; choose another place or name") from error
        for act in self.then:
            act()


_waiting: ContextVar[_Together | None] = ContextVar("_waiting", default=None)


@contextmanager
def together() -> Iterator[None]:
    """What is put into its place, and told of it, meanwhile: in the end all of it, or nothing.

    A reader of the output who has seen enough does not keep files from being written.
    """
    stack = ExitStack()
    whole = _Together(stack)
    token = _waiting.set(whole)
    try:
        yield
        with held_back():
            whole.done()
    except BrokenPipeError:
        with held_back():
            whole.done()
        raise
    finally:
        with held_back():
            _waiting.reset(token)
            stack.close()


@contextmanager
def replaced(target: Path) -> Iterator[Path]:
    """A free path beside a target, for a file that takes its place once it is whole."""
    check_written(target)
    whole = _waiting.get()
    if whole is None:
        with beside(target) as begun:
            yield begun
            os.replace(begun, target)
        return
    begun = whole.stack.enter_context(beside(target))
    yield begun
    whole.places[begun] = target


def made(folder: str | os.PathLike[str]) -> None:
    """Make a folder, with all above it, where it is not there; gone again where nothing comes in.

    Raises
    ------
    OSError : it cannot be made.
    """
    path, whole = Path(folder).absolute(), _waiting.get()
    missing = [one for one in (path, *path.parents) if not one.exists()]
    os.makedirs(folder, exist_ok=True)
    if whole is not None:
        for one in reversed(missing):  # the innermost goes first
            whole.stack.callback(_remove_empty, one)


def afterwards(act: Callable[[], None]) -> None:
    """Do something once everything is in its place; at once where nothing waits."""
    whole = _waiting.get()
    if whole is None:
        act()
    else:
        whole.then.append(act)


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):
        folder.rmdir()


def clear_left_over(folder: Path) -> None:
    """Remove what processes of this machine that live no more have begun in a folder."""
    with suppress(OSError):
        for path in folder.glob(f".*.{_here()}-*{ENDING}"):
            owner = path.name.removesuffix(ENDING).rpartition("-")[2]
            if owner.isdecimal() and not _lives(int(owner)):
                _remove(path)


def _here() -> str:
    """Name of the machine: folders may be shared, and numbers of processes are those of one."""
    name = socket.gethostname()
    return "".join(sign if sign.isalnum() else "_" for sign in name)[:40] or "here"


def _lives(process: int) -> bool:
    if sys.platform == "win32":  # where asking for a process would end it
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


# -- one writer at a time --------------------------------------------------------------------------

LOCK_FILE = ".lock"
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
    descriptor = os.open(folder / LOCK_FILE, os.O_RDWR | os.O_CREAT, 0o666)
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
        return (folder / LOCK_FILE).read_text("utf-8") or "another process"
    except (OSError, ValueError):
        return "another process"
