"""The live page as a folder for any web host: it computes in the reader's browser.

index.html equipoise.js equipoise.css    the page
worker.js service.js site.json           Python in a worker; what is kept for use offline
runtime/                                 Python in WebAssembly (Pyodide)
wheels/                                  this package, and those that it needs
docs/                                    the documentation, where it is given

Many hosts compress nothing, so most of what is loaded first lies there as `NAME.gzip`, and the
worker unpacks it.  Texts of other languages than English have a wheel each, which is loaded when
the language is first spoken.  Modules that are imported before a machine moves lie there as
bytecode, where Node and NumPy's wheel are there to make it.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import os
import re
import shutil
import stat
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from importlib import resources
from importlib.metadata import Distribution, distribution
from io import BytesIO
from pathlib import Path
from typing import Any

from equipoise import __version__
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.folders import Folder, LinkError
from equipoise.i18n import Note
from equipoise.i18n.languages import ENDING, KNOWN, ORIGINAL, head_of, package_of
from equipoise.web.bytecode import bytecode, in_place, is_published
from equipoise.web.documents import MAKE, document

RUNTIME = "314.0.3"
"""Version of the npm package `pyodide` that the page was tried with."""
LOADER = "pyodide.mjs"
"""The script that the worker imports from its place; it is handed the other one."""
RUNTIME_FILES = (LOADER, "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip")
PACKED = ".gzip"
"""Ending of compressed files, which no host takes for a way of sending the file itself."""
LOCK = "pyodide-lock.json"
FIRST = ("numpy",)
"""Packages of the runtime without which no machine can be opened."""
LATER = ("scipy", "clarabel", "matplotlib", "jinja2")
"""Those that are loaded when something needs them: balances and modes, pictures, reports."""
UNUSED = re.compile(r"\.(pyi|h|a|pc|ini|in|pxd|pyx)$|/tests/|/_pyinstaller/|/include/|/_examples/")
"""Files of wheels that are for who compiles against a package, checks its types or tests it.  All
modules stay: SciPy asks NumPy for each of its names."""
COMMAND = "equipoise_command.py"
"""The module of the package that stands beside it."""
CATALOGUES = "equipoise/i18n/"
"""Folder of the package with a catalogue of each language, `CODE.toml`."""
PURE = ("lazy-loader", "tomli-w")
"""Packages of pure Python that are imported from the beginning, besides this one."""
PAGE = ("equipoise.js", "equipoise.css", "worker.js", "service.js", "THIRD-PARTY.txt")
ALWAYS = (*PAGE[:3], "site.json")
"""Those that every reader loads at once, besides what lies there compressed."""
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

    folder : where it stands.  first : bytes of the first load from a host that compresses nothing.
    missing : packages that come from where the runtime's packages are published when they are
        needed, since no wheel of them was given.
    compiled : how many modules lie there as bytecode.
    """

    folder: Path
    first: int
    missing: tuple[str, ...]
    compiled: int


def write_site(
    folder: str | os.PathLike[str],
    runtime: str | os.PathLike[str],
    wheels: str | os.PathLike[str] | None = None,
    docs: str | os.PathLike[str] | None = None,
    node: str | None = None,
) -> Site:
    """Write the page as a folder that a web host can serve.

    Parameters
    ----------
    folder : that is written; it must not exist, be empty, or hold an earlier site.
    runtime : the folder of the npm package `pyodide`.
    wheels : folder with wheels of the runtime's packages; each is checked against the hash in the
        runtime's lock file.
    docs : the documentation as HTML, which becomes the site's `docs`.
    node : the command of Node, by which what the first machine needs is compiled if NumPy's wheel
        is given and the runtime is as published; the browser compiles it otherwise.

    Raises
    ------
    UsageError : the runtime is of another version, a wheel is damaged, the folder holds something
        else, a link stands where a file is to be copied, Node failed, or the page has not been
        built.
    """
    target, source = Path(os.path.abspath(folder)), Path(runtime)
    lock, about_runtime = _lock_of(source)
    static = Path(__file__).parent / "static"
    if not all((static / name).is_file() for name in PAGE):
        raise UsageError(MAKE)
    if docs is not None and not (Path(docs) / "index.html").is_file():
        raise UsageError(Note("{docs} has no index.html; build the documentation first", docs=docs))
    _check_free(target, folder)
    files = {**about_runtime, LOCK: _read(source, LOCK)}
    compiler = partial(bytecode, node, files) if node and is_published(files) else None
    given = None if wheels is None else Path(wheels)
    content = _SiteContent.of(lock, about_runtime, given, compiler)
    target.parent.mkdir(parents=True, exist_ok=True)
    # A new folder of a name that nobody knows: no link can have been put in its place.
    fresh = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        fresh.chmod(0o755)
        (fresh / "runtime").mkdir()
        (fresh / "wheels").mkdir()
        for name in PAGE:
            shutil.copyfile(static / name, fresh / name)
        content.write(fresh)
        if docs is not None:
            _copy(Folder.at(docs), fresh / "docs")
            _link_page(fresh / "docs")
        (fresh / "site.json").write_text(json.dumps(content.about), encoding="utf-8")
        first = content.first + sum((fresh / name).stat().st_size for name in ALWAYS)
        body = BODY.format(size=first / 1e6, build=_build_of(fresh))
        head = HEAD if docs is None else f'{HEAD}<link rel="help" href="docs/index.html">'
        html = document(head, body, policy=POLICY)
        (fresh / "index.html").write_text(html, encoding="utf-8")
        shutil.rmtree(target, ignore_errors=True)
        fresh.rename(target)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    return Site(target, first, content.missing, content.compiled)


@dataclass(frozen=True)
class _SiteContent:
    """The runtime and the packages of a site.

    plain, packed : files as they are, and compressed ones without their ending, by path.
    texts : those of the compressed ones that are loaded when their language is spoken.
    about : what the worker reads of them.  compiled : how many modules are bytecode.
    """

    plain: dict[str, bytes]
    packed: dict[str, bytes]
    texts: dict[str, bytes]
    about: dict[str, Any]
    compiled: int

    @classmethod
    def of(
        cls,
        lock: dict[str, Any],
        runtime: dict[str, bytes],
        wheels: Path | None,
        compiler: Callable[[list[bytes]], dict[str, bytes]] | None,
    ) -> _SiteContent:
        """With the runtime's files by name, a folder of wheels, and what makes bytecode of them."""
        packages, plain = _packages(lock, wheels)
        needed = _lean(packages, plain)
        own = dict(_wheel(distribution(name)) for name in ("equipoise", *PURE))
        complete = len(needed) == len(FIRST)
        compiled = compiler([*needed.values(), *own.values()]) if compiler and complete else {}
        packed = {path: _packed(_compiled(data, compiled)) for path, data in needed.items()}
        for entry in (packages[name] for name in FIRST):
            if entry["file_name"] in packed:
                entry["sha256"] = hashlib.sha256(packed[entry["file_name"]]).hexdigest()
        for name, data in own.items():
            packed[f"wheels/{name}"] = _packed(_compiled(data, compiled))
        spoken, texts = _texts()
        packages |= spoken
        for name, data in runtime.items():
            if name == LOADER:
                plain[f"runtime/{name}"] = data
            else:
                packed[f"runtime/{name}"] = _packed(_solid(name, data, compiled))
        about = {
            "runtime": "runtime/",
            "own": [f"wheels/{name}" for name in own],
            "packed": sorted([*packed, *texts]),
            "first": FIRST,
            "lock": {**lock, "packages": packages},
        }
        return cls(plain, packed, texts, about, len(compiled))

    def write(self, folder: Path) -> None:
        """Write the files, whose folders are there."""
        for path, data in self.plain.items():
            (folder / path).write_bytes(data)
        for path, data in (self.packed | self.texts).items():
            (folder / f"{path}{PACKED}").write_bytes(data)

    @property
    def first(self) -> int:
        """Bytes that are loaded before the first machine moves."""
        return sum(map(len, self.packed.values())) + len(self.plain[f"runtime/{LOADER}"])

    @property
    def missing(self) -> tuple[str, ...]:
        """Packages that the page may need, of which there is no wheel."""
        packages = self.about["lock"]["packages"]
        return tuple(sorted(name for name in packages if "/" not in packages[name]["file_name"]))


NEEDS_PAGE = re.compile(r'(<\w+ [^>]*class="(?:open-page|run-cell|runs-here)") hidden')
"""In the documentation, an element that is of use beside the live page only."""


def _link_page(docs: Path) -> None:
    """Show what opens machines of a gallery in the live page, and runs the cells of tutorials."""
    for page in (*docs.rglob("examples.html"), *docs.glob("tutorials/*.html")):
        text = NEEDS_PAGE.sub(r"\1", page.read_text(encoding="utf-8"))
        page.write_text(text, encoding="utf-8")


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
    """Entries of the lock file that the page may need, and the wheels that are given, by path."""
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
        entry["file_name"] = f"wheels/{file}"
        local[entry["file_name"]] = data
    return entries, local


def _lean(packages: Mapping[str, dict[str, Any]], given: dict[str, bytes]) -> dict[str, bytes]:
    """Wheels of those that are needed first, without what only developers use, by path.

    They are taken out of the wheels that are given; their hashes become those of what will lie in
    the site, by which the browser checks what it loads.
    """
    lean = {}
    for name in FIRST:
        path = packages[name]["file_name"]
        data = given.pop(path, None)
        if data is not None:
            files = _in_archive(data)
            lean[path] = _stored((file, read) for file, read in files if not UNUSED.search(file))
    return lean


def _in_archive(data: bytes) -> Iterator[tuple[str, bytes]]:
    with zipfile.ZipFile(BytesIO(data)) as wheel:
        for name in wheel.namelist():
            yield name, wheel.read(name)


def _stored(files: Iterable[tuple[str, bytes]]) -> bytes:
    """A wheel of files as they are, since all of them together are compressed better."""
    out = BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as wheel:
        for name, data in files:
            wheel.writestr(zipfile.ZipInfo(name, EPOCH), data)
    return out.getvalue()


def _solid(name: str, data: bytes, compiled: Mapping[str, bytes]) -> bytes:
    """A file of the runtime; of an archive, its files as they are, or as bytecode."""
    return _compiled(_stored(_in_archive(data)), compiled) if name.endswith(".zip") else data


def _compiled(archive: bytes, compiled: Mapping[str, bytes]) -> bytes:
    """An archive of files as they are, with bytecode in place of sources of which there is some."""
    return _stored(in_place(_in_archive(archive), compiled)) if compiled else archive


def _packed(data: bytes) -> bytes:
    return gzip.compress(data, 9, mtime=0)


def _texts() -> tuple[dict[str, Any], dict[str, bytes]]:
    """Packages with the catalogues of languages, as the lock file has them, and their wheels."""
    entries, packed = {}, {}
    catalogues = resources.files("equipoise.i18n")
    for code in KNOWN:
        if code == ORIGINAL:
            continue
        name, catalogue = package_of(code), CATALOGUES + code + ENDING
        data = (catalogues / f"{code}{ENDING}").read_bytes()
        file, wheel = _wheel_of(name, __version__, [(catalogue, data)])
        path = f"wheels/{file}"
        packed[path] = _packed(wheel)
        entries[name] = {
            "name": name,
            "version": __version__,
            "file_name": path,
            "sha256": hashlib.sha256(packed[path]).hexdigest(),
            "install_dir": "site",
            "package_type": "package",
            "unvendored_tests": False,
            "imports": [],
            "depends": [],
        }
    return entries, packed


def _wheel(dist: Distribution) -> tuple[str, bytes]:
    """An installed package of pure Python as a wheel: its file's name and bytes."""
    name = dist.metadata["Name"]
    return _wheel_of(name, dist.version, _files_of(name.lower(), dist))


def _wheel_of(name: str, version: str, files: Iterable[tuple[str, bytes]]) -> tuple[str, bytes]:
    """A wheel of pure Python: its file's name and bytes."""
    stem = f"{name.replace('-', '_').lower()}-{version}"
    info = f"{stem}.dist-info"
    metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
    about = "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    own = (("METADATA", metadata), ("WHEEL", about), ("RECORD", ""))
    described = ((f"{info}/{file}", text.encode()) for file, text in own)
    return f"{stem}-py3-none-any.whl", _stored([*files, *described])


def _files_of(name: str, dist: Distribution) -> Iterable[tuple[str, bytes]]:
    """Files of an installed package, without bytecode and the page's own script; of catalogues of
    other languages than English the head alone.
    """
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
            is_head = place.startswith(CATALOGUES) and place.endswith(ENDING)
            is_head = is_head and path.stem != ORIGINAL
            yield place, _head_of(path) if is_head else path.read_bytes()


def _head_of(catalogue: Path) -> bytes:
    with catalogue.open(encoding="utf-8") as lines:
        return head_of(lines).encode()


def _build_of(folder: Path) -> str:
    """A sign of everything in a site that the page loads."""
    total = hashlib.sha256(__version__.encode())
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "docs" not in path.relative_to(folder).parts[:1]:
            total.update(path.read_bytes())
    return total.hexdigest()[:16]
