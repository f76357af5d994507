"""Modules that need a package of which a benchmark can do without, or which it cannot run without.

Not every package that is compared with comes for every processor, system and version of Python, and
the benchmarks after one that lacks its package are to run all the same.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

INSTALLING = 'to install it: pip install --editable ".[test,bench]"'


def optional(module: str, package: str) -> Any:
    """A module, or None where the package that it imports is not installed, which is printed."""
    try:
        return import_module(module)
    except ModuleNotFoundError as missing:
        if not _is_of(missing, package):
            raise
        print(f"{package} is not installed and is left out; {INSTALLING}")
        return None


@contextmanager
def required(package: str) -> Iterator[None]:
    """Around imports: where this package is not installed, the benchmark ends with a sentence."""
    try:
        yield
    except ModuleNotFoundError as missing:
        if not _is_of(missing, package):
            raise
        print(f"{package} is not installed, and nothing is measured without it; {INSTALLING}")
        sys.exit(0)


def _is_of(missing: ModuleNotFoundError, package: str) -> bool:
    return (missing.name or "").partition(".")[0] == package
