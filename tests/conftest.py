"""Laws and second routes with one seed on every change, and with more where they are asked for."""

from __future__ import annotations

import fcntl
import gc
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

from support import gallery

SEEDED = {Path(__file__).parent / room for room in ("laws", "secondroute")}
NAMED = re.compile(r"(.+):(\d+)")
"""A random machine by its kind and seed, such as ``slider_crank:3``."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Tell how many of the seeds of each law are tried."""
    parser.addoption(
        "--seeds", type=int, default=1, metavar="N", help="seeds of each law that are tried"
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the further seeds of a law, unless it was asked for by its name."""
    if any("::" in argument for argument in config.args):
        return
    seeds: defaultdict[tuple[str, ...], dict[str, None]] = defaultdict(dict)
    kept, left = [], []
    for item in items:
        place, seed = _seed_of(item)
        seeds[place].setdefault(seed)
        few = list(seeds[place]).index(seed) < config.getoption("--seeds")
        (kept if few or not seed else left).append(item)
    config.hook.pytest_deselected(items=left)
    items[:] = kept


def pytest_collection_finish() -> None:
    """Keep the collector of garbage from going through all tests again and again."""
    gc.collect()
    gc.freeze()


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Make the page of all pictures that tests have kept, once all workers have ended."""
    if not hasattr(session.config, "workerinput"):
        gallery.write_page()


@pytest.fixture(scope="session")
def site() -> Path:
    """The documentation site, which the first worker makes where it is not up to date."""
    top = Path(__file__).parents[1]
    (top / "build").mkdir(exist_ok=True)
    with (top / "build" / "docs.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        make = [sys.executable, str(top / "docs" / "site" / "make.py")]
        made = subprocess.run(make, capture_output=True, text=True, check=False)
    assert (made.returncode, made.stderr) == (0, "")
    return top / "build" / "docs"


def _seed_of(item: pytest.Item) -> tuple[tuple[str, ...], str]:
    """What is tried but for its seed, and the seed; empty for what has none."""
    params = getattr(item, "callspec", None)
    place, seed = [item.nodeid.partition("[")[0]], ""
    if params is None or item.path.parent not in SEEDED:
        return (*place, item.nodeid), seed
    for name, value in params.params.items():
        named = NAMED.fullmatch(value) if isinstance(value, str) else None
        seed += f" {value}" if name == "seed" else f" {named[2]}" if named else ""
        place.append("" if name == "seed" else named[1] if named else f"{name} {value!r}")
    return tuple(place), seed
