"""A folder outside of which no file is read or written, for who lets others name the files."""

from __future__ import annotations

import ntpath
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from equipoise.errors import UsageError


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
        shown = f"{what}: got {name[:200]!r}"
        absolute = name.startswith(("/", "\\", "~")) or ntpath.isabs(name)
        if absolute or ".." in re.split(r"[\\/]", name):
            raise UsageError(
                f"{shown}; name files from the folder that is served, without .. and not from the "
                "root"
            )
        if not _lies_in(self.folder / name, (self.folder,)):
            raise UsageError(f"{shown}, which leads out of the folder that is served; name another")


def _lies_in(path: str | os.PathLike[str], folders: Sequence[Path]) -> bool:
    try:
        real = Path(os.path.realpath(path))
    except (OSError, ValueError):  # a null character
        return False
    return any(real.is_relative_to(folder) for folder in folders)


_fence: ContextVar[Fence | None] = ContextVar("_fence", default=None)


@contextmanager
def fenced(fence: Fence) -> Iterator[None]:
    """Inside, nothing beyond a fence is read or written, by whatever way it is named."""
    token = _fence.set(fence)
    try:
        yield
    finally:
        _fence.reset(token)


def may_be_read(path: str | os.PathLike[str]) -> bool:
    """Whether a file lies on this side of the fence, if there is one."""
    fence = _fence.get()
    return fence is None or _lies_in(path, (fence.folder, *fence.read_too))


def may_be_replaced() -> bool:
    """Whether who named the files asked for those to be written anew that are there already."""
    fence = _fence.get()
    return fence is not None and fence.replaces


def check_written(path: Path) -> None:
    """Note that a file or a folder is written, where it may be.

    Raises
    ------
    UsageError : it lies beyond the fence, or is there already and is not to be replaced.
    """
    fence = _fence.get()
    if fence is None:
        return
    if not _lies_in(path, (fence.folder,)):
        raise UsageError(f"{path.name}: lies outside of the folder that is served; name another")
    if not path.is_dir():
        if path.exists() and not fence.replaces:
            raise UsageError(
                f"{path.name}: is there already; choose another name, or give overwrite"
            )
        fence.written.append(path)
