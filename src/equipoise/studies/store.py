"""A folder in which the designs of a study are stored, chunk by chunk: a Zarr group, version 3.

One array for each varied number and for each output (float64, NaN where there is none), and
`reason` (uint8, `UNKNOWN` where nothing is computed yet), all along one dimension, `design`.  A
chunk of an array is a file, which is written beside its place and put there whole, so that it is
there or not, at whatever moment the process ends.  A chunk of designs is done when the files of all
arrays are there.  Nothing in the folder depends on time, or on the order in which chunks come.

Each chunk ends in its checksum, by Zarr's codec crc32c, and `zarr.json` has one of what the store
says of itself.  No link in the folder is followed.
"""

from __future__ import annotations

import os
import platform
import stat
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from json import dumps, loads
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import equipoise
from equipoise.atomic_files import locked
from equipoise.codegen.figures import COMPUTED
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place, needed
from equipoise.fence import OutsideError, open_folder
from equipoise.folders import Folder, LinkError, reason
from equipoise.i18n import Note, to_say, worded
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.studies.outcomes import DesignBlock, Outcome
from equipoise.studies.study import Output

if TYPE_CHECKING:
    import zarr


MARK, LAYOUT = "equipoise_store", 2
"""What a folder says of itself, and how it is laid out; another number is another meaning of it."""
WITHOUT_CHECKSUMS = 1
"""The layout before, which is the same without checksums."""
ABOUT, CHECKSUM = "zarr.json", "checksum"
"""What the store says of itself, and the attribute of its checksum."""
CODEC = "crc32c"
"""Zarr's name of what puts a checksum behind each chunk, and looks at it when that is read."""
REASON, UNKNOWN = "reason", 255
"""Name of the array of reasons, and the one of designs that are not computed yet."""
NO_LINKS = to_say("{name} is a link, which no store has")
DAMAGED = Note("see whether the disk is there, or sweep anew")
BLOCK, NUMBERS = 65_536, 2**22
"""Designs that are read at once, or fewer where each has many numbers."""
ZSTD = 1
"""Level at which arrays are compressed, if they are."""


@dataclass(frozen=True, eq=False, repr=False)
class Store(Result):
    """A store that has been opened.

    size : number of designs.  chunk : of those that are stored together; the last may be fewer.
    numbers : paths of the varied numbers.  outputs : names of the outputs.
    units : of numbers and outputs, by name, where they are known.
    wishes : outputs of the study, with their limits.
    texts : of the study, from which `equipoise.schema.studies.restore` makes it again.
    engine : what computes the designs.  versions : that it was computed with, by name.
    arrays : of numbers, of outputs, and of reasons, in this order, by name.
    folder : held open.
    """

    path: Path
    size: int
    chunk: int
    numbers: tuple[str, ...]
    outputs: tuple[str, ...]
    units: Mapping[str, str]
    wishes: tuple[Output, ...]
    texts: Mapping[str, str]
    engine: str
    versions: Mapping[str, str]
    arrays: Mapping[str, zarr.Array[Any]]
    folder: Folder

    blocks_in = "studies.blocks.store_blocks"

    @property
    def title(self) -> str:
        """Of the study."""
        return worded(loads(self.texts["study"])["title"])

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.size // self.chunk)

    def designs(self, chunk: int) -> range:
        """Numbers of the designs in a chunk."""
        return range(chunk * self.chunk, min((chunk + 1) * self.chunk, self.size))

    def missing(self) -> list[int]:
        """Chunks that are not stored, in order."""
        with as_usage_error(self.path, Note("cannot be read"), DAMAGED):
            done = set.intersection(*(_files(self.folder, name) for name in self.arrays))
        return [chunk for chunk in range(self.chunks) if chunk not in done]

    # -- reading -----------------------------------------------------------------------------------

    def read(self, designs: range) -> DesignBlock:
        """Designs that follow each other; those not stored have NaN and the reason `UNKNOWN`.

        Raises
        ------
        DamagedError : a chunk is not what was stored.
        UsageError : they cannot be read.
        """
        values = np.empty((len(designs), len(self.numbers)))
        figures = np.empty((len(designs), len(self.outputs)))
        for table, names in ((values, self.numbers), (figures, self.outputs)):
            for column, name in enumerate(names):
                table[:, column] = self._column(name, designs)
        block = DesignBlock(values, Outcome(figures, self._column(REASON, designs)))
        self._check_whole(designs, block)
        return block

    def _check_whole(self, designs: range, block: DesignBlock) -> None:
        """Refuse chunks of which a part was lost, which Zarr reads as never stored."""
        reason = block.outcome.reason
        known = reason != UNKNOWN
        chunk = np.arange(designs.start, designs.stop) // self.chunk
        half_known = np.isin(chunk, chunk[known]) & ~known
        lost = {REASON: half_known}
        lost |= dict(zip(self.numbers, (np.isnan(block.values) & known[:, None]).T, strict=True))
        figures = np.isnan(block.outcome.figures) & (reason == COMPUTED)[:, None]
        lost |= dict(zip(self.outputs, figures.T, strict=True))
        for name, where in lost.items():
            if where.any():
                part = self.designs(int(chunk[where][0]))
                raise DamagedError(self, name, part)

    def _column(self, name: str, designs: range) -> Array:
        with as_usage_error(self.path, Note("cannot be read"), DAMAGED):
            try:
                return np.asarray(self.arrays[name][designs.start : designs.stop])
            except (OSError, MemoryError):
                raise
            except Exception as error:  # of any codec
                for chunk in range(designs.start // self.chunk, self.chunks):
                    part = self.designs(chunk)
                    if part != designs and part.start < designs.stop:
                        self._column(name, part)  # which of several it is
                raise DamagedError(self, name, designs) from error

    def in_blocks(self) -> Iterator[tuple[int, DesignBlock]]:
        """All designs, some ten thousand at a time, each time with the number of the first."""
        most = min(BLOCK, NUMBERS // len(self.arrays))
        step = self.chunk * max(1, most // self.chunk)
        for start in range(0, self.size, step):
            yield start, self.read(range(start, min(start + step, self.size)))

    # -- writing -----------------------------------------------------------------------------------

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Keep other processes from writing, and clear away what one that was killed left over.

        Raises
        ------
        UsageError : another process is writing, or nobody can.
        """
        with ExitStack() as exitstack:
            with as_usage_error(self.path, Note("cannot be written"), Note("make it writable")):
                exitstack.enter_context(locked(self.folder))
                for name in self.arrays:
                    chunks = _chunks_of(self.folder, name)
                    for left_over, _ in list(chunks.entries()):
                        if left_over.endswith(PARTIAL):
                            chunks.remove(left_over)
            yield

    def write(self, designs: range, block: DesignBlock) -> None:
        """Store the designs of a chunk; they count for nothing until all of them are there.

        Raises
        ------
        OSError : the disk is full, or the folder has gone.
        """
        columns = [*block.values.T, *block.outcome.figures.T, block.outcome.reason]
        chunk = designs.start // self.chunk
        for (name, array), column in zip(self.arrays.items(), columns, strict=True):
            _put(_chunks_of(self.folder, name), str(chunk), _encoded(array, column))


class DamagedError(UsageError):
    """Designs of a store are not what was stored: a disk that fails, or somebody changed them."""

    def __init__(self, store: Store, name: str, designs: range) -> None:
        super().__init__(
            at_place(
                store.path,
                Note(
                    "{name} of designs {start} to {stop} was damaged; compute again what was "
                    "by: equipoise resume {path}",
                    name=name,
                    start=designs.start,
                    stop=designs.stop - 1,
                    path=store.path,
                ),
            )
        )


PARTIAL = ".partial"


def _chunks_of(folder: Folder, name: str) -> Folder:
    """Where the chunks of an array are."""
    return folder.folder(f"{name}/c")


def _encoded(array: zarr.Array[Any], column: Array) -> bytes:
    """A chunk of an array as the bytes of its file; the last one is filled up.

    Zarr's own way to there goes through an event loop in another thread, and takes four times as
    long as all the rest.
    """
    whole = np.ascontiguousarray(column, array.dtype.newbyteorder("<"))
    if len(whole) < array.chunks[0]:
        whole = np.pad(whole, (0, array.chunks[0] - len(whole)), constant_values=array.fill_value)
    data = whole.tobytes()
    for codec in _codecs(array):
        if codec == CODEC:
            data += _crc32c(data).to_bytes(4, "little")
        else:
            data = needed("numcodecs", "a store").Zstd(level=ZSTD).encode(data)
    return data


def _put(folder: Folder, name: str, data: bytes) -> None:
    """Write a file beside its place, and put it there once it is whole."""
    partial = f"{name}{PARTIAL}"
    folder.put(partial, data)
    try:
        folder.rename(partial, name)
    except OSError:
        folder.remove(partial)
        raise


def _files(folder: Folder, name: str) -> set[int]:
    """Chunks of an array that have a file; an empty one was cut off by a failure of the power."""
    numbers = set()
    try:
        for chunk, status in _chunks_of(folder, name).entries():
            if chunk.isdecimal() and stat.S_ISLNK(status.st_mode):
                raise LinkError(f"{name}/c/{chunk}", NO_LINKS)
            if chunk.isdecimal() and status.st_size:
                numbers.add(int(chunk))
    except FileNotFoundError:
        return set()
    return numbers


@cache
def versions() -> dict[str, str]:
    """What the last digit of a figure may depend on."""
    result = {"equipoise": equipoise.__version__}
    for library in ("numpy", "scipy", "numba"):
        try:
            result[library] = version(library)
        except PackageNotFoundError:
            result[library] = "none"
    python = ".".join(map(str, sys.version_info[:2]))
    return {**result, "python": python, "processor": platform.machine()}


def open_store(path: str | os.PathLike[str]) -> Store:
    """Open a store; nothing but names and sizes is read.

    Raises
    ------
    UsageError : there is none at `path`, or it is none that this version can read.
    """
    zarr = needed("zarr", "a store")
    path = Path(path)
    if not os.path.lexists(path):
        raise UsageError(
            at_place(path, Note("there is no such store; make it by: equipoise sweep"))
        )
    if path.is_file():
        raise UsageError(
            at_place(
                path, Note("a store is a folder; of a study file it is made by: equipoise sweep")
            )
        )
    try:
        folder = open_folder(path)
        group = zarr.open_group(_files_of(folder), mode="r", zarr_format=3)
        layout = group.attrs[MARK]
        if layout in (WITHOUT_CHECKSUMS, LAYOUT):
            return _opened(path, folder, group)
    except OutsideError as error:
        raise UsageError(at_place(path, error.note)) from error
    except zarr.errors.GroupNotFoundError as error:  # whose words name an object of the code
        none = Note("is no store of Equipoise; give the folder that equipoise sweep has made")
        raise UsageError(at_place(path, none)) from error
    except Exception as error:  # Zarr and its codecs raise anything where a file is damaged
        raise UsageError(
            at_place(
                path,
                Note(
                    "is no store of Equipoise, or one that was damaged ({brief}); give the "
                    "folder that equipoise sweep has made, or sweep anew",
                    brief=brief(error),
                ),
            )
        ) from error
    raise UsageError(
        at_place(
            path,
            Note(
                "was made by another version of Equipoise, with layout {layout}, "
                "and this one reads layout {own}; install the version that made it, "
                "or sweep anew",
                layout=f"{layout!r:.40}",
                own=LAYOUT,
            ),
        )
    )


def _opened(path: Path, folder: Folder, group: Any) -> Store:
    """The store of a group whose parts agree; `ValueError` and the like where they do not."""
    about: Mapping[str, Any] = group.attrs
    texts, made_with = _texts(about["study"]), _texts(about["versions"])
    study = loads(texts["study"])
    wishes = tuple(Output(**item) for item in study["outputs"])
    numbers, outputs = tuple(item["path"] for item in study["vary"]), tuple(w.name for w in wishes)
    arrays = {name: group[name] for name in (*numbers, *outputs, REASON)}
    size, chunk = arrays[REASON].shape[0], arrays[REASON].chunks[0]
    if any((a.shape, a.chunks) != ((size,), (chunk,)) for a in arrays.values()):
        raise ValueError(Note("its arrays differ in their number of designs or in their chunks"))
    agreed = {"chunk": chunk, "numbers": [*numbers], "outputs": [*outputs]}
    agreed["title"] = worded(study["title"])
    for name, wanted in agreed.items():
        if about[name] != wanted:
            sentence = "{name}: got {given!r:.60}, and its study has {wanted!r:.60}"
            raise ValueError(Note(sentence, name=name, given=about[name], wanted=wanted))
    designs = study["sampling"]["designs"]
    if designs not in (None, size):
        sentence = "it has places for {size} designs, and its study has {designs!r:.60}"
        raise ValueError(Note(sentence, size=size, designs=designs))
    for wish in wishes:
        if any(wish.wrong_asks()):
            raise ValueError(
                Note("output {name} has no limits or aims that can be read", name=wish.name)
            )
    content = loads(folder.read(ABOUT))
    if about[MARK] == LAYOUT or CHECKSUM in about:
        if about[CHECKSUM] != checksum_of(content):
            raise ValueError(Note("{name} is not as it was written", name=ABOUT))
        if not all(CODEC in _codecs(array) for array in arrays.values()):
            raise ValueError(Note("its chunks have no checksums"))
    return Store(
        path=path,
        size=size,
        chunk=chunk,
        numbers=numbers,
        outputs=outputs,
        units={n: str(a.attrs["units"]) for n, a in arrays.items() if "units" in a.attrs},
        wishes=wishes,
        texts=texts,
        engine=str(about["engine"]),
        versions=made_with,
        arrays=arrays,
        folder=folder,
    )


def _files_of(folder: Folder) -> Any:
    from equipoise.studies.zarr_files import FolderFiles

    return FolderFiles(folder)


def _codecs(array: zarr.Array[Any]) -> list[str]:
    """Names of what makes the bytes of a file of those of a chunk, in this order."""
    codecs: Sequence[Any] = array.compressors
    return [str(codec.to_dict()["name"]) for codec in codecs]


def checksum_of(content: Mapping[str, Any]) -> int:
    """The checksum of what a store says of itself, as in `zarr.json`, but for this number."""
    about = {key: value for key, value in content["attributes"].items() if key != CHECKSUM}
    return _crc32c(dumps({**content, "attributes": about}, sort_keys=True).encode())


def _crc32c(data: bytes) -> int:
    return int(needed("google_crc32c", "a store").value(data))


def _texts(packed: str) -> dict[str, str]:
    """Texts by name, from JSON."""
    texts = loads(packed)
    if not all(isinstance(text, str) for text in texts.values()):
        raise ValueError(Note("what is kept of the study or of the versions is no text"))
    return dict(texts)


@contextmanager
def as_usage_error(
    path: Path,
    what: Note,
    advice: Note,
    caught: tuple[type[Exception], ...] = (OSError, ValueError),
) -> Iterator[None]:
    """Make one sentence of what the system says."""
    try:
        yield
    except LinkError as error:
        raise UsageError(
            at_place(
                path,
                Note(
                    "{what} ({brief}); put what it leads to in its place, if you trust it",
                    what=what,
                    brief=brief(error),
                ),
            )
        ) from error
    except caught as error:
        raise UsageError(
            at_place(
                path,
                Note("{what} ({brief}); {advice}", what=what, brief=brief(error), advice=advice),
            )
        ) from error


LONGEST = 200
"""Characters at most of an error that are kept."""


def brief(error: Exception) -> Note | str:
    """Say briefly what went wrong."""
    words = reason(error)
    if isinstance(words, Note):
        return words
    return words.splitlines()[0].rstrip(".")[:LONGEST] if words else type(error).__name__
