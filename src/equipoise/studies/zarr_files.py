"""The files of a store as Zarr reads them: out of a folder that is held open, through no link.

Zarr's own way opens files by their whole path, through whatever links there are.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterable
from typing import NoReturn

from zarr.abc.store import (
    ByteRequest,
    OffsetByteRequest,
    RangeByteRequest,
    Store,
    SuffixByteRequest,
)
from zarr.core.buffer import Buffer, BufferPrototype

from equipoise.folders import Folder


class FolderFiles(Store):
    """A Zarr store that is read only; `LinkError` where a part of a key is a link."""

    supports_writes = False
    supports_deletes = False
    supports_listing = False

    def __init__(self, folder: Folder) -> None:
        super().__init__(read_only=True)
        self.folder = folder

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FolderFiles) and other.folder is self.folder

    def __hash__(self) -> int:
        return hash(id(self.folder))

    async def get(
        self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """The bytes of a file, or some of them; None where there is no such file."""
        try:
            data = self.folder.read(key)
        except (FileNotFoundError, NotADirectoryError):
            return None
        return prototype.buffer.from_bytes(_part(data, byte_range))

    async def get_partial_values(
        self, prototype: BufferPrototype, key_ranges: Iterable[tuple[str, ByteRequest | None]]
    ) -> list[Buffer | None]:
        """As `get`, of several."""
        return [await self.get(key, prototype, part) for key, part in key_ranges]

    async def exists(self, key: str) -> bool:
        """Whether there is a file."""
        try:
            self.folder.read(key)
        except (FileNotFoundError, NotADirectoryError):
            return False
        return True

    async def set(self, key: str, value: Buffer) -> NoReturn:
        """Refused."""
        raise NotImplementedError(key)

    async def delete(self, key: str) -> NoReturn:
        """Refused."""
        raise NotImplementedError(key)

    async def _none(self) -> AsyncIterator[str]:
        return
        yield ""

    def list(self) -> AsyncIterator[str]:
        """Nothing: a store of Equipoise says itself what is in it."""
        return self._none()

    def list_prefix(self, prefix: str) -> AsyncIterator[str]:
        """Nothing."""
        return self._none()

    def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """Nothing."""
        return self._none()


def _part(data: bytes, wanted: ByteRequest | None) -> bytes:
    if isinstance(wanted, RangeByteRequest):
        return data[wanted.start : wanted.end]
    if isinstance(wanted, OffsetByteRequest):
        return data[wanted.offset :]
    if isinstance(wanted, SuffixByteRequest):
        return data[-wanted.suffix :]
    return data
