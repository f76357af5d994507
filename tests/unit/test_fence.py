"""A fence holds where files are read and written, whoever named them."""

from __future__ import annotations

from pathlib import Path

from equipoise.atomic_files import transaction
from equipoise.errors import UsageError
from equipoise.fence import Fence, fenced
from equipoise.schema.files import FileError, read_text, write
from support.refusals import refused


def test_files_beyond_a_fence(tmp_path: Path) -> None:
    folder, beyond = tmp_path / "folder", tmp_path / "folder too"
    for item in (folder, beyond):
        item.mkdir()
        (item / "there.txt").write_text("there")
    (folder / "way.txt").symlink_to(beyond / "there.txt")
    fence = Fence(folder)
    with fenced(fence), transaction():
        assert read_text(folder / "there.txt") == "there"
        for name in (beyond / "there.txt", folder / ".." / "folder too" / "there.txt"):
            with refused(FileError):
                read_text(name)
            with refused(UsageError, place="there.txt"):
                write(name, "new")
        with refused(UsageError, place="there.txt"):
            write(folder / "way.txt", "new")
        with refused(UsageError, place="there.txt"):
            write(folder / "there.txt", "new")
        write(folder / "new.txt", "new")
    assert fence.written == [folder / "new.txt"]
    with fenced(Fence(folder, (beyond,), replaces=True)):
        assert read_text(beyond / "there.txt") == "there"
        write(folder / "there.txt", "new")
    assert (beyond / "there.txt").read_text() == "there"
    assert (folder / "there.txt").read_text() == "new"
