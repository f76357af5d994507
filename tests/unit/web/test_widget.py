"""The same page as a widget of a notebook."""

from __future__ import annotations

import sys
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.web import documents, notebook
from support.refusals import refused

BUILT = {"equipoise.js": b"export default {}", "equipoise.css": b".equipoise {}"}


def test_a_widget_answers_as_the_server_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "assets", lambda: BUILT)
    widget = eq.view(eq.load("yamashita-1"))
    assert widget._esm == "export default {}"
    sent: list[tuple[dict[str, Any], list[bytes]]] = []
    monkeypatch.setattr(widget, "send", lambda content, buffers: sent.append((content, buffers)))
    widget._handle_custom_msg({"type": "ready", "seq": 1}, [])
    change = {"set": "links.crank.mass", "text": "100 g"}
    widget._handle_custom_msg({"type": "edit", "seq": 2, "edits": [change]}, [])
    widget._handle_custom_msg("nonsense", [])
    kinds = [content["type"] for content, _ in sent]
    assert kinds.count("strokes") == 2
    rest = {"strokes", "answered"}
    hello, first, second, refused = (item for item in sent if item[0]["type"] not in rest)
    assert hello[0]["type"] == "hello"
    assert len(first[1][0]) == 4 * max(sum(place) for place in first[0]["arrays"].values())
    assert (second[0]["seq"], second[0]["undo"]) == (2, "edit")
    assert refused[0]["type"] == "refused"
    assert widget.machine == eq.load("yamashita-1").with_link("crank", mass=0.1)
    widget.close()


def test_what_is_missing_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(documents, "files", lambda _: __import__("pathlib").Path("nowhere"))
    with refused(UsageError, by="asset"):
        eq.view("yamashita-1")
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "equipoise.web.notebook")
    with refused(UsageError, by="view"):
        eq.view("yamashita-1")
