"""The language of a page: which one is spoken, and what the server tells in it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from equipoise.i18n import LANGUAGES, catalogue
from unit.web.pages import ask, opened, refusal, state


@pytest.mark.parametrize(
    ("wishes", "spoken"),
    [
        (["ja-JP", "en"], "ja"),
        (["fr", "KO"], "ko"),
        (["fr", "de-AT"], "en"),
        ([], "en"),
        (["en-GB", "ja"], "en"),
    ],
)
def test_the_first_language_there_is_is_spoken(wishes: list[str], spoken: str) -> None:
    session, _ = opened("yamashita-1")
    told = ask(session, "speak", seq=1, languages=wishes)[0].content
    assert (told["type"], told["language"]) == ("spoken", spoken)
    assert told["languages"] == LANGUAGES
    labels = {one["signal"] for one in state(ask(session, "ready")[1]).content["figures"]}
    force = catalogue(spoken).get("shaking force", "shaking force")
    assert force in labels


def test_what_is_no_language_is_refused() -> None:
    session, _ = opened("yamashita-1")
    for wrong in ("ja", [1], ["ja"] * 51):
        assert "speak: languages" in refusal(ask(session, "speak", languages=wrong))
    assert session.language == "en"


NAMES = {
    "name",
    "array",
    "path",
    "link",
    "type",
    "x",
    "first",
    "of",
    "measure",
    "unit",
    "group",
    "title",
    "description",
}
"""Keys of messages whose values are no words for readers."""
APART = {"fields", "scene", "arrays", "status"}


def english(values: object, names: set[str]) -> Iterator[str]:
    """Texts for readers that hold a word of three Latin letters which is no name."""
    if isinstance(values, dict):
        for key, value in values.items():
            if key not in NAMES | APART:
                yield from english(value, names)
    elif isinstance(values, list):
        for value in values:
            yield from english(value, names)
    elif isinstance(values, str):
        words = set(re.findall(r"[A-Za-z][A-Za-z-]{2,}", values)) - names
        if words - {"RMS", "rad", "rpm", "mrad", "deg"}:
            yield values


@pytest.mark.parametrize("name", ["yamashita-1", "transplanter", "sieve", "riding-transplanter"])
def test_what_a_page_is_told_is_in_its_language(name: str) -> None:
    session, _ = opened(name)
    ask(session, "speak", languages=["ja"])
    machine = session.shown.design.machine
    held = {} if machine.support is None else {**machine.support.mounts, **machine.support.gauges}
    parts = {part for one in (*machine.links, *held) for part in (one, *one.split("_"))}
    names = parts | {part.capitalize() for part in parts}
    replies = [*session.told(None), *session.tell_more()]
    contents = [reply.content for reply in replies]
    found = [text for content in contents for text in english(content, names)]
    fields = next(one["fields"] for one in contents if "fields" in one)
    found += [text for one in fields for text in english([one["heading"], one["label"]], names)]
    assert found == []
