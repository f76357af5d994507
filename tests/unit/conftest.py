"""Loops of designs are run by NumPy on every change, where no compiler is tested."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

COMPILED = {"test_backends.py", "test_loops.py", "test_loop_in_c.py", "test_executors.py"}
"""Files whose tests compile the loops; all do before a release."""


@pytest.fixture(scope="module", autouse=True)
def loops_by_numpy(request: pytest.FixtureRequest) -> Iterator[None]:
    """The same sources, which take seconds to compile and milliseconds to run for a few designs."""
    if request.config.getoption("--exhaustive") or request.path.name in COMPILED:
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
