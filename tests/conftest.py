"""Laws and second routes with one seed on every change, and with more where they are asked for."""

from __future__ import annotations

import fcntl
import gc
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest
from _pytest.assertion import rewrite

from support import gallery
from support.chosen import DISTINCT

SEEDED = {Path(__file__).parent / room for room in ("laws", "secondroute", "crosscheck")}
PARAM = type(pytest.param())
BY_NUMPY = {"unit", "surface"}
"""Rooms whose tests run loops of designs by NumPy on every change."""
COMPILED = {"test_backends.py", "test_loops.py", "test_loop_in_c.py", "test_executors.py"} | {
    "test_sweep.py",
    "test_killed.py",
    "test_interrupted.py",
    "test_memory.py",
    "test_tolerance.py",
}
"""Files of them whose tests compile the loops."""
MANY = 8
"""Machines of one test, of which every change tries some."""
FRESH = 20_000
"""Objects after which garbage is looked for; 700, as usual, take a twentieth of a long run."""
NAMED = re.compile(r"(.+):(\d+)")
"""A random machine by its kind and seed, such as ``slider_crank:3``."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Tell how many of the seeds of each law are tried, and whether all of everything is."""
    parser.addoption(
        "--seeds", type=int, default=1, metavar="N", help="seeds of each law that are tried"
    )
    parser.addoption(
        "--exhaustive", action="store_true", help="also what only a release has to pass"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Draw fewer examples at random on every change than where tests are asked for."""
    _take_a_processor(config)
    from hypothesis import settings

    if not config.getoption("--exhaustive") and not _by_name(config):
        settings.register_profile("change", settings(), max_examples=20)
        settings.load_profile("change")
    _rewrite_share(config)


@pytest.hookimpl(tryfirst=True)
def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make no test of a further seed, or of what is exhaustive, unless it was asked for."""
    if _by_name(metafunc.config):
        return
    seeded = metafunc.definition.path.parent in SEEDED or "seed" in metafunc.fixturenames
    seeds = metafunc.config.getoption("--seeds") if seeded else None
    every = metafunc.config.getoption("--exhaustive")
    chosen = _but(metafunc.definition) is not None
    some = None if every or chosen else metafunc.definition.name
    marks = metafunc.definition.own_markers
    marks[:] = [
        _thinned(mark, seeds, every, some) if mark.name == "parametrize" else mark for mark in marks
    ]


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark what stands apart from `make test`: what needs a browser, or the site.

    Snippets of pages, which lie outside of this folder, are marked where they are collected.
    """
    if item.path.parent.name == "browser":
        item.add_marker("browser")
    elif "site" in getattr(item, "fixturenames", ()):
        item.add_marker("documentation")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out tests that are exhaustive, unless they were asked for."""
    if config.getoption("--exhaustive") or _by_name(config):
        return
    _know_all(items)
    left = [item for item in items if _is_left_out(item)]
    config.hook.pytest_deselected(items=left)
    items[:] = [item for item in items if not _is_left_out(item)]


@pytest.hookimpl(tryfirst=True)
def pytest_collection() -> None:
    """Look for no garbage while tests are collected: almost all that is made then is kept."""
    gc.disable()


def pytest_collection_finish() -> None:
    """Keep the collector of garbage from going through all tests again and again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(FRESH, 10, 10)
    gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Set aside what the tests of a file leave, which caches keep: each look for garbage that the
    package asks for would go through all of it again.
    """
    if nextitem is not None and nextitem.path != item.path:
        gc.collect()
        gc.freeze()


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Make the page of all pictures that tests have kept, once all workers have ended."""
    if not hasattr(session.config, "workerinput"):
        gallery.write_page()


@pytest.fixture(scope="module", autouse=True)
def loops_by_numpy(request: pytest.FixtureRequest) -> Iterator[None]:
    """Loops of designs are run by NumPy on every change, where no compiler is tested: the same
    sources, which take seconds to compile and milliseconds to run for a few designs.
    """
    room = request.path.relative_to(Path(__file__).parent).parts[0]
    if (
        request.config.getoption("--exhaustive")
        or room not in BY_NUMPY
        or request.path.name in COMPILED
    ):
        yield
        return
    from equipoise.codegen import backends

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(backends, "engine", lambda: "numpy")
        yield


@pytest.fixture
def compiled_loops(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loops are compiled, for a test that takes many steps in them."""
    from equipoise.codegen import backends

    monkeypatch.setattr(backends, "engine", lambda: "numba")


@pytest.fixture(scope="session")
def site(request: pytest.FixtureRequest) -> Path:
    """The documentation site, which the first worker makes where it is not up to date.

    On a change it is a draft, with the interactive file of each machine in one language.
    """
    top = Path(__file__).parents[1]
    (top / "build").mkdir(exist_ok=True)
    with (top / "build" / "docs.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        make = [sys.executable, str(top / "docs" / "site" / "make.py")]
        if not request.config.getoption("--exhaustive"):
            make.append("--draft")
        made = subprocess.run(make, capture_output=True, text=True, check=False)
    assert (made.returncode, made.stderr) == (0, "")
    return top / "build" / "docs"


def _take_a_processor(config: pytest.Config) -> None:
    """Keep a worker on a processor of its own, where there is one for each.

    Linear algebra then begins no further threads, nor do studies begin processes unless a test asks
    for them: beside other workers these take longer to begin than what they share out.
    """
    worker = getattr(config, "workerinput", None)
    if worker is None or not hasattr(os, "sched_setaffinity"):
        return
    processors = sorted(os.sched_getaffinity(0))
    if worker["workercount"] <= len(processors):
        number = int(worker["workerid"].removeprefix("gw"))
        os.sched_setaffinity(0, {processors[number]})


def _rewrite_share(config: pytest.Config) -> None:
    """Rewrite the assertions of some files, where workers would each rewrite all of a fresh clone.

    Each then finds what the others have written, and rewrites by itself what is not there yet.
    """
    worker = getattr(config, "workerinput", None)
    if worker is None or sys.dont_write_bytecode:
        return
    number, count = int(worker["workerid"].removeprefix("gw")), worker["workercount"]
    asked = [config.invocation_params.dir / argument for argument in config.args]
    files = sorted(Path(__file__).parent.rglob("test_*.py"))
    files = [file for file in files if any(item == file or item in file.parents for item in asked)]
    for file in files[number::count]:
        cached = rewrite.get_cache_dir(file) / f"{file.stem}{rewrite.PYC_TAIL}"
        if rewrite._read_pyc(file, cached) is None and rewrite.try_makedirs(cached.parent):
            written, code = rewrite._rewrite_test(file, config)
            rewrite._write_pyc(config.stash[rewrite.assertstate_key], code, written, cached)


def _by_name(config: pytest.Config) -> bool:
    """Whether tests were asked for by their names, which are tried whatever they are."""
    return any("::" in argument for argument in config.args)


def _but(item: pytest.Item | pytest.FunctionDefinition) -> Sequence[str] | None:
    """Values that are tried on every change of a test that is exhaustive otherwise."""
    mark = item.get_closest_marker("exhaustive")
    return mark.kwargs.get("but") if mark else None


def _values_of(item: pytest.Item) -> str:
    """The values of a test, as they stand in its name."""
    return item.name.partition("[")[2].removesuffix("]")


def _is_left_out(item: pytest.Item) -> bool:
    """Whether a test is left to a release."""
    marks = list(item.iter_markers("exhaustive"))
    return any(_values_of(item) not in mark.kwargs.get("but", ()) for mark in marks)


def _know_all(items: list[pytest.Item]) -> None:
    """Refuse values to be tried that a test does not have, or it would be left out unnoticed."""
    known = defaultdict[tuple[Path, str], set[str]](set)
    asked = dict[tuple[Path, str], Sequence[str]]()
    for item in items:
        test = item.path, item.name.partition("[")[0]
        known[test].add(_values_of(item))
        if but := _but(item):
            asked[test] = but
    for test, but in asked.items():
        if missing := set(but) - known[test]:
            raise pytest.UsageError(f"{test[0]}: {test[1]} is not tried on {sorted(missing)}")


@cache
def _machines() -> frozenset[str]:
    """Kinds of random machines, and bundled models."""
    from equipoise import examples
    from support import machines_cams
    from support.machines import KINDS
    from support.machines_redundant import REDUNDANT

    return frozenset({*KINDS, *REDUNDANT, *machines_cams.ALL, *examples("linkage")})


def _machine_of(value: Any) -> str:
    """Name of the machine that a test is tried on; empty for whatever else, such as formulas."""
    values = value.values if isinstance(value, PARAM) else value
    name = values if isinstance(values, str) else values[0] if isinstance(values, tuple) else None
    is_machine = isinstance(name, str) and re.split("[ :]", name)[0] in _machines()
    return str(name) if is_machine else ""


def _is_tried(law: str, name: str) -> bool:
    """Whether a test is tried on one of its many machines, other tests on others.

    A quarter of those that can do what no other can, and a twelfth of the rest.
    """
    return crc32(f"{law} {name}".encode()) % (4 if name in DISTINCT else 12) == 0


def _thinned(mark: pytest.Mark, seeds: int | None, every: bool, some: str | None) -> pytest.Mark:
    """A parametrisation without the values that are left out; of many, a named test takes some."""
    names, values, *rest = mark.args
    names = [name.strip() for name in names.split(",")] if isinstance(names, str) else names
    values, kept = list(values), list[int]()
    seen: defaultdict[tuple[str, ...], list[str]] = defaultdict(list)
    for k, value in enumerate(values):
        given, marks = (value.values, value.marks) if isinstance(value, PARAM) else (value, ())
        if not isinstance(value, PARAM) and len(names) == 1:
            given = (value,)
        if not every and any(item.name == "exhaustive" for item in marks):
            continue
        if seeds is not None:
            place, seed = _seed_of(dict(zip(names, given, strict=True)))
            if seed not in seen[place]:
                seen[place].append(seed)
            if seed and seen[place].index(seed) >= seeds:
                continue
        kept.append(k)
    if some is not None and len(kept) >= MANY:
        kept = _some(some, {k: _machine_of(values[k]) for k in kept})
    how = dict(mark.kwargs)
    ids = how.get("ids")
    if ids is not None and not callable(ids):
        how["ids"] = [item for k, item in enumerate(ids) if k in kept]
    return pytest.mark.parametrize(mark.args[0], [values[k] for k in kept], *rest, **how).mark


def _some(law: str, machines: dict[int, str]) -> list[int]:
    """Of the numbers of values, those that are tried, of which one at least is a machine's."""
    named = [k for k, name in machines.items() if name]
    if len(named) < MANY:
        return [*machines]
    tried = {k for k in named if _is_tried(law, machines[k])} or {named[0]}
    return [k for k, name in machines.items() if k in tried or not name]


def _seed_of(params: dict[str, Any]) -> tuple[tuple[str, ...], str]:
    """What is tried but for its seed, and the seed; empty for what has none."""
    place, seed = [], ""
    for name, value in params.items():
        named = NAMED.fullmatch(value) if isinstance(value, str) else None
        seed += f" {value}" if name == "seed" else f" {named[2]}" if named else ""
        place.append("" if name == "seed" else named[1] if named else f"{name} {value!r}")
    return tuple(place), seed
