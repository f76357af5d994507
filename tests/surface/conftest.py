"""Every command is run in an empty folder of its own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which a test runs."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def with_progress() -> Iterator[None]:
    """Lines of progress, which are kept from other tests, are looked at."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("EQUIPOISE_PROGRESS", raising=False)
        yield
