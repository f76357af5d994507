"""`equipoise site` with folders that a stranger has prepared: nothing of others is published."""

from __future__ import annotations

import gzip
import hashlib
import json
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest

from equipoise.web import site as site_module
from equipoise.web.bytecode import find_node
from equipoise.web.site import FIRST, LATER, LOADER, LOCK, RUNTIME, RUNTIME_FILES
from surface.running import Result, equipoise, refused, succeeded

SECRET = b"what nobody else may see"
WORDS = ("site", "-o", "out", "--runtime", "runtime", "--wheels", "wheels", "--docs", "docs")
PACKAGES = (*FIRST, *LATER)
FOR_DEVELOPERS = ("numpy/__init__.pyi", "numpy/tests/test_core.py", "numpy/_core/include/numpy.h")


def wheel() -> bytes:
    out = BytesIO()
    with zipfile.ZipFile(out, "w") as files:
        for name in ("numpy/__init__.py", "numpy/f2py/__init__.py", *FOR_DEVELOPERS):
            files.writestr(name, b"")
    return out.getvalue()


WHEEL = wheel()


def entry(name: str, data: bytes) -> dict[str, Any]:
    return {"file_name": name, "sha256": hashlib.sha256(data).hexdigest(), "depends": []}


@pytest.fixture(autouse=True)
def given(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A runtime, wheels and documentation of the right names, and a secret beside them."""
    static = folder / "package" / "static"
    for path in (folder / "runtime", folder / "wheels", folder / "docs" / "part", static):
        path.mkdir(parents=True)
    for name in site_module.PAGE:
        (static / name).write_bytes(b"")
    for name in RUNTIME_FILES:
        content = WHEEL if name.endswith(".zip") else name.encode()
        (folder / "runtime" / name).write_bytes(content)
    (folder / "runtime" / "package.json").write_text(json.dumps({"version": RUNTIME}))
    for name in ("numpy", "scipy"):
        (folder / "wheels" / f"{name}.whl").write_bytes(WHEEL)
    lock({name: entry(f"{name}.whl", WHEEL) for name in PACKAGES})
    (folder / "docs" / "index.html").write_text("<p>docs")
    (folder / "docs" / "part" / "page.html").write_text("<p>page")
    (folder / "secret").write_bytes(SECRET)
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "secret").write_bytes(SECRET)
    monkeypatch.setattr(site_module, "__file__", str(folder / "package" / "site.py"))
    monkeypatch.setattr(site_module, "_wheel", lambda dist: (f"{dist.name}.whl", b"own"))


def lock(packages: object) -> None:
    Path("runtime", LOCK).write_text(json.dumps({"packages": packages}))


def wrote_nothing(result: Result) -> str:
    sentence = refused(result)
    assert not Path("out").exists()
    assert not list(Path().glob(".out*"))
    return sentence


def test_a_site_is_written_from_them() -> None:
    succeeded(equipoise(*WORDS))
    assert Path("out/docs/part/page.html").read_text() == "<p>page"
    with zipfile.ZipFile(
        BytesIO(gzip.decompress(Path("out/wheels/numpy.whl.gzip").read_bytes()))
    ) as numpy:
        assert numpy.namelist() == ["numpy/__init__.py", "numpy/f2py/__init__.py"]
    assert Path("out/wheels/scipy.whl").read_bytes() == WHEEL
    assert Path("out/runtime", RUNTIME_FILES[0]).read_bytes() == RUNTIME_FILES[0].encode()
    about = json.loads(Path("out/site.json").read_text())
    assert "runtime/pyodide.asm.wasm" in about["packed"]
    for path in about["packed"]:  # and by no name under which a host would send something else
        assert gzip.decompress(Path("out", f"{path}.gzip").read_bytes())
        assert not Path("out", path).exists()
    entry = about["lock"]["packages"]["numpy"]
    assert (
        entry["sha256"]
        == hashlib.sha256(Path("out", f"{entry['file_name']}.gzip").read_bytes()).hexdigest()
    )
    succeeded(equipoise(*WORDS))  # in the place of the first


HAS_NODE = pytest.mark.skipif(find_node() is None, reason="Node is not installed")


@HAS_NODE
def test_node_executes_nothing_but_the_runtime_that_was_published(folder: Path) -> None:
    """A browser shuts in what it executes; Node would not."""
    script = "import { writeFileSync } from 'node:fs'; writeFileSync('executed', '')"
    Path("runtime", LOADER).write_text(script)
    assert "compiled modules" not in succeeded(equipoise(*WORDS))
    assert not Path("executed").exists()


@HAS_NODE
def test_what_node_cannot_compile_can_be_left_to_the_browser(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(site_module, "is_published", lambda _: True)
    sentence = wrote_nothing(equipoise(*WORDS))
    assert "Node could not compile the modules of the site (" in sentence
    assert "Error" in sentence and "--no-compile" in sentence
    succeeded(equipoise(*WORDS, "--no-compile"))


def test_a_node_that_fails_half_way_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither what it has written by then, nor a site without it."""
    node = Path("node").absolute()
    node.write_text('#!/bin/sh\necho half > "$3"\nprintf "Error: no space \\377" >&2\nexit 1\n')
    node.chmod(0o755)
    monkeypatch.setattr("equipoise.web.bytecode.find_node", lambda: str(node))
    monkeypatch.setattr(site_module, "is_published", lambda _: True)
    sentence = wrote_nothing(equipoise(*WORDS))
    assert "Node could not compile the modules of the site (Error: no space" in sentence


@pytest.mark.parametrize(
    ("place", "target"),
    [
        ("docs/leak.html", "secret"),
        ("docs/part/leak.html", "secret"),
        ("docs/more", "elsewhere"),
        ("wheels/numpy.whl", "secret"),
        (f"runtime/{RUNTIME_FILES[1]}", "secret"),
        (f"runtime/{LOCK}", "secret"),
        ("runtime/package.json", "secret"),
    ],
)
def test_no_link_is_published(folder: Path, place: str, target: str) -> None:
    path = folder / place
    path.unlink(missing_ok=True)
    path.symlink_to(folder / target)
    sentence = wrote_nothing(equipoise(*WORDS))
    assert "is a link" in sentence
    assert Path(place).name in sentence


@pytest.mark.parametrize(
    "change",
    [
        lambda packages: packages["numpy"].update(file_name="../secret"),
        lambda packages: packages["numpy"].update(file_name="/etc/passwd"),
        lambda packages: packages["numpy"].update(file_name=["numpy.whl"]),
        lambda packages: packages["numpy"].update(depends=7),
        lambda packages: packages["numpy"].pop("sha256"),
        lambda packages: packages.update(numpy=3),
        lambda packages: packages.pop("numpy"),
        lambda packages: packages["numpy"].update(depends=["another"]),
        lambda packages: packages["numpy"].update(depends=[["another"]]),
    ],
)
def test_a_lock_file_that_names_something_else_is_refused(
    change: Callable[[dict[str, Any]], object],
) -> None:
    packages: dict[str, Any] = {name: entry(f"{name}.whl", WHEEL) for name in PACKAGES}
    packages["numpy"]["sha256"] = hashlib.sha256(SECRET).hexdigest()
    change(packages)
    lock(packages)
    assert "pyodide" in wrote_nothing(equipoise(*WORDS))


def test_a_folder_with_something_else_stays_as_it_is(folder: Path) -> None:
    """A file that is called like one of a site does not make a site of a folder."""
    (folder / "out").mkdir()
    (folder / "out" / "site.json").write_text("{}")
    (folder / "out" / "thesis.tex").write_text("years")
    assert "holds something else" in refused(equipoise(*WORDS))
    assert (folder / "out" / "thesis.tex").read_text() == "years"
