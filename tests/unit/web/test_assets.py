"""Script and style of the page, where they lie."""

from __future__ import annotations

import io
import sys
from types import ModuleType

import pytest

from equipoise.errors import UsageError
from equipoise.web import documents
from support.refusals import refused


def test_a_site_takes_them_from_beside_the_page(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    """Its own package has none, so that nothing is loaded twice."""
    monkeypatch.setattr(documents, "files", lambda name: tmp_path)
    with refused(UsageError, by="asset"):
        documents.assets()
    browser = ModuleType("pyodide.http")
    browser.open_url = lambda name: io.StringIO(f"of {name}")  # type: ignore[attr-defined]
    monkeypatch.setattr(sys, "platform", "emscripten")
    monkeypatch.setitem(sys.modules, "pyodide.http", browser)
    assert documents.assets() == {name: f"of {name}".encode() for name in documents.TYPES}
