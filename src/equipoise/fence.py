"""A folder outside of which no file is read or written, for who lets others name the files.

Whatever is opened by a name that somebody gave is opened here, so that the fence is asked, and so
that no link leads where nobody meant.
"""

from __future__ import annotations

import ntpath
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import field
from pathlib import Path

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.folders import Folder, LinkError
from equipoise.i18n import Note, to_say

OUTSIDE = Note("lies outside of the folder that is served; name another")
OUT = to_say("{name} is a link, which leads out of its folder")
LONGEST_NAME = 200
"""Characters of a refused name that the error repeats."""


@dataclass(frozen=True)
class Fence:
    """Files of one folder.

    folder : without symbolic links.  read_too : folders whose files are read besides.
    replaces : whether a file that is there may be written anew.  written : files that were written.
    """

    folder: Path
    read_too: Sequence[Path] = ()
    replaces: bool = False
    written: list[Path] = field(default_factory=list)

    def check_name(self, what: str, name: str) -> None:
        """Refuse a name that leads out of the folder; `what` it is the name of.

        Raises
        ------
        UsageError : it is absolute, goes up, or goes out by a symbolic link.
        """
        absolute = name.startswith(("/", "\\", "~")) or ntpath.isabs(name)
        shown = name[:LONGEST_NAME]
        if absolute or ".." in re.split(r"[\\/]", name):
            raise UsageError(
                at_place(
                    what,
                    Note(
                        "got {name!r}; name files from the folder that is served, without .. and "
                        "not from the root",
                        name=shown,
                    ),
                )
            )
        if _real(self.folder / name, (self.folder,)) is None:
            raise UsageError(
                at_place(
                    what,
                    Note(
                        "got {name!r}, which leads out of the folder that is served; name another",
                        name=shown,
                    ),
                )
            )


class OutsideError(Exception):
    """A file beyond the fence; `note` says so."""

    def __init__(self) -> None:
        super().__init__(OUTSIDE)
        self.note = OUTSIDE


def _real(path: str | os.PathLike[str], folders: Sequence[Path]) -> tuple[Path, str] | None:
    """The folder of some in which a path ends, and its name from there; None if in none."""
    try:
        real = Path(os.path.realpath(path))
    except (OSError, ValueError):  # a null character
        return None
    for folder in folders:
        if real.is_relative_to(folder):
            return folder, real.relative_to(folder).as_posix()
    return None


_fence: ContextVar[Fence | None] = ContextVar("_fence", default=None)


@contextmanager
def fenced(fence: Fence) -> Iterator[None]:
    """Inside, nothing beyond a fence is read or written, by whatever way it is named."""
    token = _fence.set(fence)
    try:
        yield
    finally:
        _fence.reset(token)


def may_be_replaced() -> bool:
    """Whether who named the files asked for those to be written anew that are there already."""
    fence = _fence.get()
    return fence is not None and fence.replaces


# -- opening what is read --------------------------------------------------------------------------


def open_file(path: str | os.PathLike[str], within: str | os.PathLike[str] | None = None) -> int:
    """Open a file to be read; returns its descriptor.  A pipe that nobody writes to does not wait.

    Parameters
    ----------
    within : folder of which no link may lead out, for a name that stands in a file there.

    Raises
    ------
    OutsideError : it lies beyond the fence.
    LinkError : a link leads out of `within`.
    OSError, ValueError : it cannot be opened.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    roots = _readable_roots()
    if within is not None:
        base = _base(Path(path), Path(within))
        if (inside := _real(path, (base,))) is None:
            raise LinkError(os.path.basename(path), OUT)
        if roots is None:
            return _opened_in(inside, flags)
    if roots is None:
        return os.open(path, flags)
    pair = _real(path, roots)
    if pair is None:
        raise OutsideError
    return _opened_in(pair, flags)


def _opened_in(place: tuple[Path, str], flags: int) -> int:
    folder, name = place
    return os.open(folder, flags) if name == "." else Folder.at(folder).open(name, flags)


def _base(path: Path, folder: Path) -> Path:
    """The folder that a named file must not leave: its own where the name itself leads up."""
    below = path.is_relative_to(folder) and ".." not in path.relative_to(folder).parts
    return Path(os.path.realpath(folder if below else path.parent))


def open_folder(path: str | os.PathLike[str]) -> Folder:
    """Open a folder to be read; errors as `open_file`."""
    roots = _readable_roots()
    if roots is None:
        return Folder.at(path)
    pair = _real(path, roots)
    if pair is None:
        raise OutsideError
    folder, name = pair
    return Folder.at(folder).folder(name)


def _readable_roots() -> tuple[Path, ...] | None:
    fence = _fence.get()
    return None if fence is None else (fence.folder, *fence.read_too)


# -- opening where something is written ------------------------------------------------------------


_open_folders: ContextVar[dict[str, Folder] | None] = ContextVar("_held", default=None)


@contextmanager
def holding() -> Iterator[None]:
    """Inside, a folder for which a `place` was held once stays the same, whatever comes there."""
    if _open_folders.get() is not None:
        yield
        return
    token = _open_folders.set({})
    try:
        yield
    finally:
        _open_folders.reset(token)


def hold_place(path: str | os.PathLike[str]) -> None:
    """Hold open the folder in which something is to be written later, where folders are held.

    Raises
    ------
    OSError : the folder cannot be opened.
    """
    folders, above = _open_folders.get(), Path(path).absolute().parent
    if folders is not None and str(above) not in folders:
        folders[str(above)] = Folder.at(os.path.realpath(above))


def hold_folder(path: Path) -> None:
    """Hold open a folder into which something is to be written later, where folders are held.

    path : absolute.

    Raises
    ------
    UsageError, LinkError, OSError, ValueError : as of `place_of`.
    """
    folders = _open_folders.get()
    if folders is None or _fence.get() is not None or str(path) in folders:
        return  # a fence opens what is below its own folder, which is held already
    if path.name in {"", ".."}:
        folders[str(path)] = Folder.at(path)
    else:
        above, name = place_of(path)
        folders[str(path)] = above.folder(name)


def place_of(path: str | os.PathLike[str], *, links: bool = True) -> tuple[Folder, str]:
    """The folder in which a file or a folder is to be written, held open, and the name there.

    Parameters
    ----------
    links : whether the path may have links, the last one only within its folder; else it is
        absolute and has none.

    Raises
    ------
    UsageError : it lies beyond the fence, or is there already and is not to be replaced.
    LinkError : it is a link that leads out of its folder.
    OSError, ValueError : the folder cannot be opened.
    """
    given = Path(path)
    if not links:
        _note_written(given)
        return Folder.without_links(given.parent), given.name
    folder = (_open_folders.get() or {}).get(str(given.absolute().parent))
    if folder is not None and _fence.get() is None and not folder.has_link(given.name):
        return folder, given.name
    above = folder.path if folder is not None else Path(os.path.realpath(given.parent))
    target = Path(os.path.realpath(above / given.name))
    check_written(target)
    if not target.is_relative_to(above):
        raise LinkError(given.name, OUT)
    way = target.relative_to(above).parent.as_posix()
    fence = _fence.get()
    if fence is None:
        return (folder or Folder.at(above)).folder(way), target.name
    _note_written(target)
    way = target.parent.relative_to(fence.folder).as_posix()
    return Folder.at(fence.folder).folder(way), target.name


def check_written(path: Path) -> None:
    """Refuse a file or a folder that lies beyond the fence."""
    fence = _fence.get()
    if fence is not None and _real(path, (fence.folder,)) is None:
        raise UsageError(at_place(path.name, OUTSIDE))


def check_link(path: Path) -> None:
    """Raise `LinkError` where a path is a link that leads out of its folder."""
    above = os.path.realpath(path.parent)
    if path.is_symlink() and not Path(os.path.realpath(path)).is_relative_to(above):
        raise LinkError(path.name, OUT)


def _note_written(path: Path) -> None:
    """Note that a file or a folder is written, where it may be; errors as of `place_of`."""
    check_written(path)
    fence = _fence.get()
    if fence is None or path.is_dir():
        return
    if path.exists() and not fence.replaces:
        raise UsageError(
            at_place(path.name, Note("is there already; choose another name, or give overwrite"))
        )
    fence.written.append(path)
