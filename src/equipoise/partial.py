"""Files and folders on their way to be whole: made beside their place, and put there at the end.

What a process that was killed has left beside a place goes when the next one writes there.
"""

from __future__ import annotations

import os
import shutil
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

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
