"""The bundled machines as a page offers them."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.i18n import localized, speaking
from equipoise.web.gallery import SAMPLES, titles
from equipoise.web.session import Session
from support.chosen import few
from unit.web.pages import State, ask


@pytest.mark.exhaustive(but=["ja"])
@pytest.mark.parametrize("language", few(["en", "ja", "ko"], {"en", "ja"}))
def test_every_machine_is_offered_with_a_picture_and_a_sentence(language: str) -> None:
    session = Session()
    ask(session, "speak", languages=[language])
    *offered, end = ask(session, "gallery", seq=1)
    assert end.content == {"type": "gallery", "seq": 1}
    assert sorted(reply.content["name"] for reply in offered) == sorted(titles())
    for reply in offered:
        text, machine = reply.content, eq.load(reply.content["name"])
        with speaking(language):
            assert text["title"] == localized(machine.title)
            assert text["line"] and text["line"][:8] == localized(machine.description).lstrip()[:8]
        assert not set(text["line"]) & set("()（）")
        assert text["scene"]["signs"]
    asking = [eq.load(reply.content["name"]).balance is not None for reply in offered]
    assert asking == sorted(asking)  # who only asks how to balance another comes last


def test_the_picture_is_where_nothing_hides() -> None:
    replies = ask(Session(), "gallery", seq=1)
    (first,) = [reply for reply in replies if reply.content.get("name") == "yamashita-1"]
    shown = State(first.content, np.frombuffer(first.buffer, "<f4"))
    motion = eq.analyze(eq.load("yamashita-1"), SAMPLES).motion
    assert 0 <= first.content["at"] < SAMPLES
    np.testing.assert_allclose(shown.place("C"), motion.points["C"].place, atol=1e-6)
