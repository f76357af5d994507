"""Bytecode of what a site's page imports before its first machine moves, or to balance it.

Compiling a module takes a browser far longer than loading its bytecode.  Only the runtime's own
Python writes bytecode that it can read, so it is started once in Node when a site is written: it
opens a machine as a page does, and compiles the modules that it has imported by then, and those
that balancing and running import.  They take the place of their sources, as both would be a longer
load.
"""

from __future__ import annotations

import hashlib
import io
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from equipoise.errors import UsageError
from equipoise.i18n import Note

OWN = "equipoise"
"""The package whose docstrings are kept, as descriptions of tables are taken from them."""
OPENED = '{"type": "open", "seq": 1, "example": "yamashita-1"}'
LONGEST = 300
"""s after which Node is given up: about twenty times as long as it takes."""
PUBLISHED = {
    "pyodide.mjs": "5cfc46f5dcbaf2a16f26e2363f441873eb424762609cc03db00d6a2ace4d00e5",
    "pyodide.asm.mjs": "1a9775427ef6e8abaa7db88ece0515422d1886915ae5c9093776410c865dfd8d",
    "pyodide.asm.wasm": "e7f8fac36f8bf11085309cbc5c829b3ec3057c18bf1d73b05a6741612d63cdbf",
    "python_stdlib.zip": "444c770dfd75a32097fc0a7d5c1413fd3140601f49c3a1f2e9af0376fcd124b4",
    "pyodide-lock.json": "c963d22858f6bcb8f41586a2142f03905ab370c88ea22a86a2736e95fac2a8f3",
}
"""Hashes of the files of the npm package `pyodide`."""
STDLIB = re.compile(r".*/python\d+\.zip/")
PACKAGES = re.compile(r".*/site-packages/")
PACKAGE = re.compile(r".*/site-packages/(\w+)/")


def find_node() -> str | None:
    """Return the command of Node, if it is installed."""
    return shutil.which("node")


def is_published(runtime: Mapping[str, bytes]) -> bool:
    """Whether the runtime's files are those that were published, so that Node may execute them.

    A browser shuts in what it executes; Node does not.  Wheels are checked against the lock file.
    """
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in runtime.items()}
    return hashes == PUBLISHED


def bytecode(node: str, runtime: Mapping[str, bytes], wheels: Iterable[bytes]) -> dict[str, bytes]:
    """Compile what is imported before the first machine moves.

    Parameters
    ----------
    node : the command of Node.
    runtime : files of the npm package `pyodide`, by name.
    wheels : what is unpacked into it.

    Returns
    -------
    bytecode by the path of its source in the standard library's archive, or in a wheel.

    Raises
    ------
    UsageError : Node failed.
    """
    script = Path(__file__).with_suffix(".mjs")
    with tempfile.TemporaryDirectory() as folder:
        out, files = Path(folder) / "out.zip", []
        for name, data in runtime.items():
            (Path(folder) / name).write_bytes(data)
        for number, wheel in enumerate(wheels):
            files.append(Path(folder) / f"{number}.zip")
            files[-1].write_bytes(wheel)
        failure = _failure_of([node, str(script), folder, str(out), *map(str, files)])
        if failure is not None:
            raise UsageError(
                Note(
                    "Node could not compile the modules of the site ({reason}); "
                    "give --no-compile to leave this to the browser",
                    reason=failure,
                )
            )
        with zipfile.ZipFile(out) as archive:
            return {name: archive.read(name) for name in archive.namelist()}


def _failure_of(command: list[str]) -> str | None:
    """Run a command, and return why it failed; None if it succeeded."""
    try:
        done = subprocess.run(
            command, capture_output=True, encoding="utf-8", errors="replace", check=False,
            timeout=LONGEST,
        )  # fmt: skip
    except OSError as error:
        return str(error)
    except subprocess.TimeoutExpired:
        return Note("no result after {time} s", time=LONGEST)
    if done.returncode == 0:
        return None
    last = next((line for line in done.stderr.splitlines()[::-1] if "Error" in line), "")
    return last[:200].strip() or Note("exit status {status}", status=done.returncode)


def in_place(
    files: Iterable[tuple[str, bytes]], compiled: Mapping[str, bytes]
) -> Iterator[tuple[str, bytes]]:
    """Files of an archive, with bytecode in place of the sources of which there is some."""
    for name, data in files:
        yield (f"{name}c", compiled[name]) if name in compiled else (name, data)


# -- in the runtime --------------------------------------------------------------------------------


def export_bytecode() -> bytes:
    """Open a machine, and return an archive of the bytecode of all modules imported by then, of
    what balancing and running import, and of all others of packages that lose their docstrings.
    """
    sys.dont_write_bytecode = True
    from equipoise.web.worker import Foreground

    page = Foreground()
    page.take(OPENED)
    while page.step() is not None:
        pass
    # Imported once there is a result to show, and no drag is answered meanwhile.
    from equipoise.web import balanced, runs

    del balanced, runs
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
        for place, source, name in _sources():
            archive.writestr(place, _bytecode_of(source, name))
    return out.getvalue()


def _sources() -> Iterator[tuple[str, bytes, str]]:
    """Of the modules that are compiled: path in its archive, source, and name of its file."""
    names = {str(getattr(module, "__file__", "")) for module in [*sys.modules.values()]}
    for name in sorted({*names, *_whole_packages(names)}):
        if not name.endswith(".py"):
            continue
        if inside := STDLIB.match(name):
            with zipfile.ZipFile(inside[0].rstrip("/")) as archive:
                place = name[inside.end() :]
                if place in archive.namelist():
                    yield place, archive.read(place), name
        elif inside := PACKAGES.match(name):
            yield name[inside.end() :], Path(name).read_bytes(), name


def _whole_packages(names: Iterable[str]) -> Iterator[str]:
    """Names of all files of the packages but this one of which some files are given."""
    folders = {match[0] for match in map(PACKAGE.match, names) if match and match[1] != OWN}
    for folder in folders:
        yield from map(str, Path(folder).rglob("*.py"))


def _bytecode_of(source: bytes, name: str) -> bytes:
    """The content of a `.pyc` file that is never compared with its source."""
    import importlib.util
    import marshal

    own = f"/{OWN}/" in name
    code = compile(source, name, "exec", dont_inherit=True, optimize=0 if own else 2)
    unchecked_hash = (1).to_bytes(4, "little")
    sign = importlib.util.source_hash(source)
    return importlib.util.MAGIC_NUMBER + unchecked_hash + sign + marshal.dumps(code)
