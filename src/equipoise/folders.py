"""Folders that are held open: files in them are reached by name, and never through a link.

Where the system can open a file relative to an open folder, nobody can exchange a folder on the way
between a check and its use.  Elsewhere (Windows) each part of the way is looked at just before.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import sys
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from equipoise.i18n import Note, to_say

RELATIVE = {os.open, os.mkdir, os.unlink, os.rename, os.stat, os.rmdir} <= os.supports_dir_fd
"""Whether the system opens files relative to an open folder."""
_BINARY = getattr(os, "O_BINARY", 0)
_WAY = getattr(os, "O_PATH", os.O_RDONLY)
"""How a folder on the way is opened: with O_PATH it need not be readable, only passable."""
NOWHERE = Note("the current folder does not exist any more")
NOT_FOLLOWED = to_say("{name} is a link, and links are not followed here")


def is_nowhere() -> bool:
    """Whether the current folder was deleted."""
    try:
        os.getcwd()
    except OSError:
        return True
    return False


class LinkError(OSError):
    """There is a link where none is followed; `note` says so.

    sentence : template of the note, about ``{name}``.
    """

    def __init__(self, name: str, sentence: str = NOT_FOLLOWED) -> None:
        self.note = Note(sentence, name=name)
        super().__init__(errno.ELOOP, str(self.note))


def reason(error: Exception) -> Note | str:
    """Say briefly why the system refused: in its own words, but for what is refused here."""
    if isinstance(error, LinkError):
        return error.note
    if isinstance(error, FileNotFoundError) and is_nowhere():
        return NOWHERE
    if error.args and isinstance(error.args[0], Note):
        return error.args[0]
    message = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return message[:1].lower() + message[1:]  # names in it stay as they are


class Folder:
    """A folder that is held open until nobody holds this value any more.

    Names are those of what lies in it, with ``/`` between their parts.

    Raises
    ------
    LinkError : a part of the name is a symbolic link (or a junction of Windows).
    ValueError : a name leads up, or is no name.
    OSError : as the system has it.
    """

    path: Path
    """Where it was opened; for messages, and for systems that cannot hold it open."""

    def __init__(self, path: Path, descriptor: int | None) -> None:
        self.path, self._descriptor = path, descriptor
        if descriptor is not None:
            weakref.finalize(self, os.close, descriptor)

    @classmethod
    def at(cls, path: str | os.PathLike[str]) -> Folder:
        """Open a folder, through links where its own path has some."""
        where = Path(path)
        if RELATIVE:
            return cls(where, os.open(where, _WAY | os.O_DIRECTORY))
        if not where.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(where))
        return cls(where, None)

    @classmethod
    def without_links(cls, path: Path) -> Folder:
        """Open a folder by an absolute path of which no part may be a link."""
        root = Path(path.anchor)
        return cls.at(root).folder(path.relative_to(root).as_posix())

    def folder(self, name: str) -> Folder:
        """A folder in it; itself for ``.``."""
        if name == ".":
            return self
        below = self
        for part in _parts(name):
            below = below._below(part)
        return below

    def _below(self, name: str) -> Folder:
        path = self.path / name
        if self._descriptor is None:
            self._check(name)
            return Folder.at(path)
        flags = _WAY | os.O_DIRECTORY | os.O_NOFOLLOW
        with self._link_named(name):
            return Folder(path, os.open(name, flags, dir_fd=self._descriptor))

    def open(self, name: str, flags: int, mode: int = 0o666) -> int:
        """Open a file in it; returns its descriptor."""
        *way, last = _parts(name)
        above = self.folder("/".join(way) or ".")
        if above._descriptor is None:
            above._check(last)
            return os.open(above.path / last, flags | _BINARY, mode)
        with above._link_named(last):
            return os.open(last, flags | os.O_NOFOLLOW, mode, dir_fd=above._descriptor)

    def read(self, name: str) -> bytes:
        """Content of a regular file in it."""
        # O_NONBLOCK: opening a pipe that nobody writes to would otherwise wait.
        descriptor = self.open(name, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        with open(descriptor, "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise OSError(Note("{name} is no regular file", name=name))
            return file.read()

    def entries(self) -> Iterator[tuple[str, os.stat_result]]:
        """What lies in it: name, and what it is; of a link what the link is."""
        if self._descriptor is None:
            with os.scandir(self.path) as scandir:
                yield from ((item.name, item.stat(follow_symlinks=False)) for item in scandir)
            return
        readable = os.open(".", os.O_RDONLY | os.O_DIRECTORY, dir_fd=self._descriptor)
        try:
            with os.scandir(readable) as scandir:
                yield from ((item.name, item.stat(follow_symlinks=False)) for item in scandir)
        finally:
            os.close(readable)

    # -- changing ----------------------------------------------------------------------------------

    def make(self, name: str) -> Folder:
        """Make a folder in it, where nothing is of this name."""
        if self._descriptor is None:
            (self.path / name).mkdir()
        else:
            os.mkdir(name, dir_fd=self._descriptor)
        return self.folder(name)

    def subfolder(self, name: str) -> Folder:
        """A folder in it, made where there is none."""
        with suppress(FileExistsError):
            return self.make(name)
        return self.folder(name)

    def put(self, name: str, data: bytes) -> None:
        """Write a new file in it; an error leaves none."""
        descriptor = self.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
        try:
            with open(descriptor, "wb") as file:
                file.write(data)
        except OSError:
            self.remove(name)
            raise

    def rename(self, name: str, new: str) -> None:
        """Give what lies in it another name, in whose place a file goes, a link for itself too."""
        if self._descriptor is None:
            os.replace(self.path / name, self.path / new)
        else:
            os.replace(name, new, src_dir_fd=self._descriptor, dst_dir_fd=self._descriptor)

    def remove(self, name: str) -> None:
        """Remove what lies in it, with all that is in it, if there; of a link the link."""
        status = self.status(name)
        if status is None:
            return
        with suppress(OSError):
            if not stat.S_ISDIR(status.st_mode):
                if self._descriptor is None:
                    (self.path / name).unlink()
                else:
                    os.unlink(name, dir_fd=self._descriptor)
            elif self._descriptor is not None:
                shutil.rmtree(name, ignore_errors=True, dir_fd=self._descriptor)
            elif not _is_link(status):
                shutil.rmtree(self.path / name, ignore_errors=True)

    # -- links -------------------------------------------------------------------------------------

    def status(self, name: str) -> os.stat_result | None:
        """What something in it is, of a link the link; None where it is not there."""
        with suppress(OSError):
            if self._descriptor is None:
                return os.lstat(self.path / name)
            return os.stat(name, dir_fd=self._descriptor, follow_symlinks=False)
        return None

    def has_link(self, name: str) -> bool:
        """Whether what is of this name in it is a link."""
        status = self.status(name)
        return status is not None and _is_link(status)

    def _check(self, name: str) -> None:
        if self.has_link(name):
            raise LinkError(name)

    @contextmanager
    def _link_named(self, name: str) -> Iterator[None]:
        """Distinguish a link from other reasons: systems report it in different ways."""
        try:
            yield
        except OSError:
            self._check(name)
            raise


def _is_link(status: os.stat_result) -> bool:
    if stat.S_ISLNK(status.st_mode):
        return True
    return sys.platform == "win32" and status.st_reparse_tag == stat.IO_REPARSE_TAG_MOUNT_POINT


def _parts(name: str) -> list[str]:
    parts = name.split("/")
    for part in parts:
        if part in {"", ".", ".."} or "\0" in part or (not RELATIVE and set(part) & set("\\:")):
            raise ValueError(Note("{name!r:.60} is not the name of a file in a folder", name=name))
    return parts
