"""The live page as a folder for any web host: it computes in the reader's browser.

index.html equipoise.js equipoise.css    the page
worker.js service.js site.json           Python in a worker; what is kept for use offline
runtime/                                 Python in WebAssembly (Pyodide)
wheels/                                  this package, and those that it needs
docs/                                    the documentation, where it is given
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import stat
import tempfile
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import Distribution, distribution
from io import BytesIO
from pathlib import Path
from typing import Any

from equipoise import __version__
from equipoise.errors import UsageError
from equipoise.folders import Folder, LinkError
from equipoise.i18n import Note
from equipoise.web.assets import MAKE
from equipoise.web.documents import document

RUNTIME = "314.0.3"
"""Version of the npm package `pyodide` that the page was tried with."""
RUNTIME_FILES = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip")
LOCK = "pyodide-lock.json"
FIRST = ("numpy",)
"""Packages of the runtime without which no machine can be opened."""
LATER = ("scipy", "clarabel", "matplotlib", "jinja2")
"""Those that are loaded when something needs them: balances and modes, pictures, reports."""
COMMAND = "equipoise_command.py"
"""The module of the package that stands beside it."""
PURE = ("lazy-loader", "tomli-w")
"""Packages of pure Python that are imported from the beginning, besides this one."""
PAGE = ("equipoise.js", "equipoise.css", "worker.js", "service.js", "THIRD-PARTY.txt")
GIVEN = ("words.json", "interactive.js", "interactive.css")
"""Files of the page that Python hands out: in its language, and as an interactive page."""
EPOCH = (1980, 1, 1, 0, 0, 0)
"""Of files in wheels, so that the same sources give the same bytes."""
POLICY = (
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
    "img-src 'self' data: blob:; connect-src 'self' https:; worker-src 'self'; base-uri 'none'"
)
HEAD = """<meta name="description" content="Draw a linkage, and see how it moves and shakes.">
<link rel="stylesheet" href="equipoise.css">"""
BODY = """<p id="equipoise-status" role="status">Loading {size:.0f} MB, kept for the next time.</p>
<main id="equipoise-live" data-worker="worker.js" data-service="service.js?build={build}"></main>
<noscript>This page needs JavaScript.</noscript>
<script type="module" src="equipoise.js"></script>"""


@dataclass(frozen=True)
class Site:
    """What has been written.

    folder : where it stands.  first : bytes of the first load, compressed as web hosts do.
    missing : packages that come from where the runtime's packages are published when they are
        needed, since no wheel of them was given.
    """

    folder: Path
    first: int
    missing: tuple[str, ...]


def write_site(
    folder: str | os.PathLike[str],
    runtime: str | os.PathLike[str],
    wheels: str | os.PathLike[str] | None = None,
    docs: str | os.PathLike[str] | None = None,
) -> Site:
    """Write the page as a folder that a web host can serve.

    Parameters
    ----------
    folder : that is written; it must not exist, be empty, or hold an earlier site.
    runtime : the folder of the npm package `pyodide`.
    wheels : folder with wheels of the runtime's packages; each is checked against the hash in the
        runtime's lock file.
    docs : the documentation as HTML, which becomes the site's `docs`.

    Raises
    ------
    UsageError : the runtime is of another version, a wheel is damaged, the folder holds something
        else, a link stands where a file is to be copied, or the page has not been built.
    """
    target, source = Path(os.path.abspath(folder)), Path(runtime)
    lock, about_runtime = _lock_of(source)
    packages, local = _packages(lock, None if wheels is None else Path(wheels))
    own = {name: _wheel(distribution(name)) for name in ("equipoise", *PURE)}
    static = Path(__file__).parent / "static"
    if not all((static / name).is_file() for name in PAGE):
        raise UsageError(MAKE)
    if docs is not None and not (Path(docs) / "index.html").is_file():
        raise UsageError(Note("{docs} has no index.html; build the documentation first", docs=docs))
    _check_free(target, folder)
    target.parent.mkdir(parents=True, exist_ok=True)
    # A new folder of a name that nobody knows: no link can have been put in its place.
    fresh = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        fresh.chmod(0o755)
        (fresh / "runtime").mkdir()
        (fresh / "wheels").mkdir()
        for name in PAGE:
            shutil.copyfile(static / name, fresh / name)
        for name, data in about_runtime.items():
            (fresh / "runtime" / name).write_bytes(data)
        for name, data in (*own.values(), *local.items()):
            (fresh / "wheels" / name).write_bytes(data)
        if docs is not None:
            _copy(Folder.at(docs), fresh / "docs")
            _link_page(fresh / "docs")
        about = {
            "runtime": "runtime/",
            "own": [f"wheels/{name}" for name, _ in own.values()],
            "first": FIRST,
            "lock": {**lock, "packages": packages},
        }
        (fresh / "site.json").write_text(json.dumps(about), encoding="utf-8")
        first = _first_load(fresh, about)
        body = BODY.format(size=first / 1e6, build=_build_of(fresh))
        head = HEAD if docs is None else f'{HEAD}<link rel="help" href="docs/index.html">'
        html = document(head, body, policy=POLICY)
        (fresh / "index.html").write_text(html, encoding="utf-8")
        shutil.rmtree(target, ignore_errors=True)
        fresh.rename(target)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    missing = [name for name, package in packages.items() if "/" not in package["file_name"]]
    return Site(target, first, tuple(sorted(missing)))


NEEDS_PAGE = re.compile(r'(<\w+ [^>]*class="(?:open-page|run-cell|runs-here)") hidden')
"""In the documentation, an element that is of use beside the live page only."""


def _link_page(docs: Path) -> None:
    """Show what opens machines of a gallery in the live page, and runs the cells of tutorials."""
    for page in (*docs.rglob("examples.html"), *docs.glob("tutorials/*.html")):
        shown = NEEDS_PAGE.sub(r"\1", page.read_text(encoding="utf-8"))
        page.write_text(shown, encoding="utf-8")


OWN = {*PAGE, "index.html", "site.json", "runtime", "wheels", "docs"}
"""What lies in a site."""


def _check_free(target: Path, folder: object) -> None:
    """Refuse to write over anything but an earlier site."""
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise UsageError(Note("{folder} is no folder; give another by -o", folder=folder))
    there = {path.name for path in target.iterdir()} if target.is_dir() else set[str]()
    if there and not ("site.json" in there and there <= OWN):
        raise UsageError(
            Note("{folder} holds something else than a site; give another by -o", folder=folder)
        )


# -- what is given ---------------------------------------------------------------------------------


def _read(folder: Path, name: str) -> bytes:
    """A file of a folder that is given, which is published: no link shows others what it leads to.

    Raises
    ------
    UsageError : it is a link.
    """
    try:
        return Folder.at(folder).read(name)
    except LinkError as error:
        raise _is_link(folder / name) from error


def _copy(docs: Folder, to: Path) -> None:
    """Copy a folder with all that is in it; errors as of `_read`."""
    to.mkdir()
    for name, status in docs.entries():
        if stat.S_ISLNK(status.st_mode):
            raise _is_link(docs.path / name)
        if stat.S_ISDIR(status.st_mode):
            _copy(docs.folder(name), to / name)
        elif stat.S_ISREG(status.st_mode):
            (to / name).write_bytes(docs.read(name))


def _is_link(path: Path) -> UsageError:
    return UsageError(
        Note(
            "{path} is a link, and nothing is published through links; put the file itself there",
            path=path,
        )
    )


def _lock_of(runtime: Path) -> tuple[dict[str, Any], dict[str, bytes]]:
    """The runtime's lock file: names, files and hashes of its packages; and the runtime's files."""
    how = Note(
        "{runtime} is not the npm package pyodide {version}; get it by `npm install "
        "pyodide@{version}`, and give --runtime node_modules/pyodide",
        runtime=runtime,
        version=RUNTIME,
    )
    try:
        about = json.loads(_read(runtime, "package.json"))
        lock: dict[str, Any] = json.loads(_read(runtime, LOCK))
        known = about["version"] == RUNTIME and all(map(_is_entry, lock["packages"].values()))
        files = {name: _read(runtime, name) for name in RUNTIME_FILES}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        known = False
    if not known:
        raise UsageError(how)
    return lock, files


def _is_entry(entry: dict[str, Any]) -> bool:
    """Whether a package of the lock file has what is read of it, and a file of a plain name."""
    file, packages = entry["file_name"], entry["depends"]
    plain = isinstance(file, str) and Path(file).name == file and "\\" not in file
    listed = isinstance(packages, list) and all(isinstance(name, str) for name in packages)
    return plain and listed and isinstance(entry["sha256"], str)


def _packages(
    lock: Mapping[str, Any], wheels: Path | None
) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Entries of the lock file that the page may need, and the wheels that are given for them."""
    entries: dict[str, Any] = {}
    wanted = [*FIRST, *LATER]
    while wanted:
        name = wanted.pop()
        if name not in entries:
            if name not in lock["packages"]:
                raise UsageError(Note("{file} has no package {name!r}", file=LOCK, name=name))
            entries[name] = dict(lock["packages"][name])
            wanted += entries[name]["depends"]
    local = {}
    for entry in entries.values():
        file = entry["file_name"]
        if wheels is None or not (wheels / file).is_file():
            continue
        data = _read(wheels, file)
        if hashlib.sha256(data).hexdigest() != entry["sha256"]:
            raise UsageError(
                Note("{file} is damaged: its hash is not that of the lock file", file=wheels / file)
            )
        local[file] = data
        entry["file_name"] = f"wheels/{file}"
    return entries, local


def _wheel(dist: Distribution) -> tuple[str, bytes]:
    """An installed package of pure Python as a wheel: its name and bytes."""
    name = dist.metadata["Name"].replace("-", "_").lower()
    stem = f"{name}-{dist.version}"
    info = f"{stem}.dist-info"
    out = BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for path, data in _files_of(name, dist):
            wheel.writestr(zipfile.ZipInfo(path, EPOCH), data, zipfile.ZIP_DEFLATED, 9)
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {dist.version}\n"
        about = "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        for file, text in (("METADATA", metadata), ("WHEEL", about), ("RECORD", "")):
            wheel.writestr(zipfile.ZipInfo(f"{info}/{file}", EPOCH), text)
    return f"{stem}-py3-none-any.whl", out.getvalue()


def _files_of(name: str, dist: Distribution) -> Iterable[tuple[str, bytes]]:
    """Files of an installed package, without bytecode and without the page's own script."""
    if name == "equipoise":  # which may be installed in place
        root = Path(__file__).parents[1]
        files = {p.relative_to(root.parent).as_posix(): p for p in root.rglob("*")}
        files[COMMAND] = root.parent / COMMAND
    else:
        files = {f.as_posix(): Path(str(dist.locate_file(f))) for f in dist.files or ()}
    for place, path in sorted(files.items()):
        left_out = "__pycache__" in place or place.startswith("equipoise/web/static/")
        given = place.rpartition("/static/")[2] in GIVEN
        if path.is_file() and ".dist-info/" not in place and (given or not left_out):
            yield place, path.read_bytes()


def _first_load(folder: Path, about: Mapping[str, Any]) -> int:
    """Bytes that a reader loads before the first machine moves, compressed as web hosts do."""
    import gzip

    first = {about["lock"]["packages"][name]["file_name"] for name in about["first"]}
    names = [*PAGE[:3], "site.json", *(f"runtime/{name}" for name in RUNTIME_FILES)]
    names += [*about["own"], *(name for name in first if "/" in name)]
    sizes = 0
    for name in names:
        data = (folder / name).read_bytes()
        sizes += min(len(data), len(gzip.compress(data, 6, mtime=0)))
    return sizes


def _build_of(folder: Path) -> str:
    """A sign of everything in a site that the page loads."""
    total = hashlib.sha256(__version__.encode())
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "docs" not in path.relative_to(folder).parts[:1]:
            total.update(path.read_bytes())
    return total.hexdigest()[:16]
