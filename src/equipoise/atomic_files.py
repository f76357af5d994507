"""Files and folders that become whole: written beside their place, and moved there at the end.

What a killed process has left beside a place is removed when the next one writes there.  Of what is
written in a `transaction`, all takes its place in the end, or nothing where something goes wrong.
Into a folder that is `locked` no other process writes.  The folder of a place is held open
meanwhile.
"""

from __future__ import annotations

import os
import re
import socket
import stat
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from contextvars import ContextVar
from dataclasses import field
from pathlib import Path
from typing import BinaryIO

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.fence import check_link, check_written, hold_folder, holding, place_of
from equipoise.folders import Folder, reason
from equipoise.i18n import Note
from equipoise.interrupts import check, held_back

ENDING = ".tmp"


@contextmanager
def temporary_name(folder: Folder, name: str) -> Iterator[str]:
    """Yield a free name in a folder for what replaces a file there; nothing has it in the end."""
    clear_left_over(folder)
    begun = f".{name[:100]}.{_here()}-{os.getpid()}{ENDING}"
    folder.remove(begun)  # of a process that had this number, or planted there
    try:
        yield begun
    finally:
        folder.remove(begun)


@dataclass
class _Transaction:
    """What waits until all of it can be done.

    places : what is to take whose place, by folder and name.  folders : of these, by path.
    stack : of what goes in the end.
    """

    stack: ExitStack
    places: dict[tuple[Path, str], tuple[Folder, str]] = field(default_factory=dict)
    folders: dict[Path, Folder] = field(default_factory=dict)
    then: list[Callable[[], None]] = field(default_factory=list)

    def done(self) -> None:
        """Put all into its place, and then do the rest; called again, what is left of it."""
        check()
        for (path, name), (folder, begun) in [*self.places.items()]:
            del self.places[path, name]
            try:
                folder.rename(begun, name)
            except OSError as error:
                raise UsageError(
                    at_place(
                        path / name,
                        Note(
                            "the file cannot be written ({reason}); choose another place or name",
                            reason=reason(error),
                        ),
                    )
                ) from error
        while self.then:
            self.then.pop(0)()


_waiting: ContextVar[_Transaction | None] = ContextVar("_waiting", default=None)


@contextmanager
def transaction() -> Iterator[None]:
    """Inside, files are replaced and reported in the end: all of them, or none.

    A reader of the output who has seen enough does not keep files from being written.
    """
    stack = ExitStack()
    whole = _Transaction(stack)
    token = _waiting.set(whole)
    try:
        with holding():
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
def replaced(path: str | os.PathLike[str], *, links: bool = True) -> Iterator[BinaryIO]:
    """A file that takes the place of the one at a path once it is whole, with its permissions.

    links : whether the path may have links, the last one only within its folder.

    Raises
    ------
    UsageError, OSError, ValueError : as of `fence.place_of`, or it cannot be written.
    """
    folder, name = place_of(path, links=links)
    whole = _waiting.get()
    if whole is None:
        with temporary_name(folder, name) as begun:
            with _synced(folder, begun, like=name) as file:
                yield file
            folder.rename(begun, name)
        return
    folder = whole.folders.setdefault(folder.path, folder)  # few are open, of however many files
    begun = whole.stack.enter_context(temporary_name(folder, name))
    with _synced(folder, begun, like=name) as file:
        yield file
    whole.places[folder.path, name] = folder, begun


@contextmanager
def _synced(folder: Folder, name: str, like: str) -> Iterator[BinaryIO]:
    """A new file that is on the disk in the end; permissions are those of another, if there."""
    descriptor = folder.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    with open(descriptor, "wb") as file:
        before = folder.status(like)
        if before is not None and stat.S_ISREG(before.st_mode) and hasattr(os, "fchmod"):
            os.fchmod(descriptor, stat.S_IMODE(before.st_mode))
        yield file
        file.flush()
        os.fsync(file.fileno())


def make_folder(folder: str | os.PathLike[str]) -> None:
    """Make a folder, with all above it, where it is not there; gone again where nothing comes in.

    Raises
    ------
    UsageError : it lies beyond the fence.
    LinkError : it is a link that leads out of its folder.
    OSError : it cannot be made.
    """
    path, whole = Path(folder).absolute(), _waiting.get()
    check_written(path)
    check_link(path)
    missing = [parent for parent in (path, *path.parents) if not parent.exists()]
    os.makedirs(folder, exist_ok=True)
    hold_folder(path)
    if whole is not None:
        for item in reversed(missing):  # the innermost goes first
            whole.stack.callback(_remove_empty, item)


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


def clear_left_over(folder: Folder) -> None:
    """Remove what processes of this machine that live no more have begun in a folder."""
    begun = re.compile(rf"\..*\.{_here()}-([0-9]+){re.escape(ENDING)}", re.DOTALL)
    with suppress(OSError):
        for name, _ in list(folder.entries()):
            owner = begun.fullmatch(name)
            if owner and not _lives(int(owner[1])):
                folder.remove(name)


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
def locked(folder: Folder) -> Iterator[None]:
    """Hold the lock of a store.

    Raises
    ------
    UsageError : another process has it; the sentence names it.
    OSError : the folder cannot be written into, or its disk knows no locks, or the lock is a link.
    """
    # Files opened by Python are not handed down to processes that are started meanwhile.
    descriptor = folder.open(LOCK_FILE, os.O_RDWR | os.O_CREAT)
    try:
        try:
            _take(descriptor)
        except (BlockingIOError, PermissionError) as error:
            raise UsageError(
                at_place(
                    folder.path,
                    Note(
                        "{holder} is writing into this store; wait until it is done, or stop it",
                        holder=_holder(folder),
                    ),
                )
            ) from error
        _note(descriptor, f"process {os.getpid()} on {socket.gethostname()}")
        try:
            yield
        finally:
            _note(descriptor, "")
    finally:
        os.close(descriptor)


def _note(descriptor: int, text: str) -> None:
    """Write who holds a lock; not into a file that has other names too, where it is no lock."""
    if os.fstat(descriptor).st_nlink != 1:
        return
    with suppress(OSError):  # of a full disk, which is reported where it matters
        os.ftruncate(descriptor, 0)
        os.lseek(descriptor, 0, os.SEEK_SET)
        os.write(descriptor, text.encode())


def _holder(folder: Folder) -> str:
    try:
        return folder.read(LOCK_FILE).decode() or "another process"
    except (OSError, ValueError):
        return "another process"
