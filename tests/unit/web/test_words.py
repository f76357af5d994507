"""The language of a page: which one is spoken, and what the server tells in it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from equipoise.i18n import LANGUAGES, catalogue
from equipoise.results.result import OF_CYCLES
from equipoise.web.documents import said_by_page
from equipoise.web.gallery import opened_example
from support.chosen import few
from unit.web.pages import ask, opened, refusal, state


@pytest.mark.parametrize(
    ("wishes", "spoken"),
    [
        (["ja-JP", "en"], "ja"),
        (["fr", "KO"], "ko"),
        (["fr", "de-AT"], "de"),
        (["fr", "nl"], "en"),
        ([], "en"),
        (["en-GB", "ja"], "en"),
    ],
)
def test_the_first_language_there_is_is_spoken(wishes: list[str], spoken: str) -> None:
    session, _ = opened("yamashita-1")
    content = ask(session, "speak", seq=1, languages=wishes)[0].content
    assert (content["type"], content["language"]) == ("spoken", spoken)
    assert content["languages"] == LANGUAGES
    labels = {entry["signal"] for entry in state(ask(session, "ready")[1]).content["figures"]}
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


@pytest.mark.exhaustive(but=["transplanter", "yamashita-1"])
@pytest.mark.parametrize(
    "name",
    few(["yamashita-1", "transplanter", "sieve", "riding-transplanter"],
        {"yamashita-1", "transplanter", "sieve"}),
)  # fmt: skip
def test_what_a_page_is_sent_is_in_its_language(name: str) -> None:
    session, _ = opened(name)
    ask(session, "speak", languages=["ja"])
    machine = session.shown.design.machine
    held = {} if machine.support is None else {**machine.support.mounts, **machine.support.gauges}
    parts = {part for item in (*machine.links, *held) for part in (item, *item.split("_"))}
    names = parts | {part.capitalize() for part in parts}
    replies = [*session.state_replies(None), *session.deferred_replies()]
    contents = [reply.content for reply in replies]
    actual = [text for content in contents for text in english(content, names)]
    fields = next(item["fields"] for item in contents if "fields" in item)
    actual += [
        text for field in fields for text in english([field["heading"], field["label"]], names)
    ]
    assert actual == []


@pytest.mark.parametrize("language", few(["en", "ja", "ko"], {"ja"}))
def test_a_page_speaks_of_cycles_where_no_crank_turns(language: str) -> None:
    """As terminal, notebook and report do: a loader has no crank, whatever the page shows of it."""
    session, _ = opened("hydraulic-loader")
    ask(session, "speak", languages=[language])
    contents = [
        reply.content for reply in (*session.state_replies(None), *session.deferred_replies())
    ]
    (wording,) = (item["wording"] for item in contents if "wording" in item)
    cycle = {"en": "Any output over the cycle", "ja": "1周期の任意の出力"}
    if language in cycle:
        assert wording["words"]["Any output over crank angle"] == cycle[language]
    labels = [item["label"] for content in contents for item in content.get("fields", ())]
    texts = [*labels, *wording["words"].values(), *wording["explained"].values()]
    texts += [text for content in contents for text in english(content, set())]
    cranks = ("crank", "クランク", "크랭크")
    assert texts and not [text for text in texts if any(crank in text for crank in cranks)]
    turned = {text for text in said_by_page() if "crank angle" in text and text in OF_CYCLES}
    assert turned and turned <= wording["words"].keys()


def test_a_page_speaks_of_cranks_again_with_the_next_machine() -> None:
    session, _ = opened("hydraulic-loader")
    session.open(opened_example("yamashita-1"))
    (first, *_) = session.state_replies(None)
    assert first.content["wording"] == {"words": {}, "explained": {}}
    labels = {entry["label"] for entry in first.content["fields"]}
    assert "speed" in labels and "speed of the cycle" not in labels
