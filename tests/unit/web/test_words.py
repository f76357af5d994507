"""The language of a page: which one is spoken, and what the server tells in it."""

from __future__ import annotations

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
