"""Texts of a model that are written as markup: they are shown as they stand, and nothing else."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

import pytest

from support.hostile import hostile_text
from surface.running import equipoise, succeeded

OWN = {"equipoise-machine", "equipoise-states", "equipoise-page"}
"""Scripts of an interactive file."""


class Markup(HTMLParser):
    """What a browser would run, or load from elsewhere; and all texts."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.wrong: list[object] = []
        self.texts: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag in {"img", "iframe", "object", "embed"}:
            self.wrong.append(tag)
        if tag == "script" and given.get("id") not in OWN:
            self.wrong.append(given)
        for name, value in attrs:
            leads = name in {"href", "src", "xlink:href", "action", "data", "formaction", "srcdoc"}
            if name.startswith("on") or (leads and value and not value.startswith(("#", "data:"))):
                self.wrong.append((tag, name, value))

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


@pytest.fixture
def hostile() -> None:
    Path("model.toml").write_text(hostile_text(), encoding="utf-8")


@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize(
    ("words", "file"),
    [
        (("report", "model.toml", "-o", "page.html"), "page.html"),
        (("export", "model.toml", "-o", "machine.html"), "machine.html"),
        (("animate", "model.toml", "-o", "moving.svg"), "moving.svg"),
        (("plot", "model.toml", "--only", "linkage", "-o", "pictures"), "pictures/linkage.svg"),
    ],
)
def test_names_are_text(words: tuple[str, ...], file: str) -> None:
    succeeded(equipoise(*words))
    read = Markup(Path(file).read_text(encoding="utf-8"))
    assert read.wrong == []
    assert any("<script>window.x=1" in text for text in read.texts)
