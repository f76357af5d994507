"""The page's own texts in the reader's language."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from equipoise.i18n import LANGUAGES, catalogue, say, speaking
from equipoise.i18n.counting import counted
from equipoise.i18n.languages import KNOWN
from equipoise.i18n.particles import rules
from equipoise.web.explained import explained

WORDS = "words.json"
"""Beside the bundle: the texts that its page says."""


def language_of(wishes: Sequence[str]) -> str:
    """The language that is spoken of those that a browser asks for, such as ``ja-JP``."""
    codes = (wish.lower().partition("-")[0] for wish in wishes)
    return next((code for code in codes if code in LANGUAGES), "en")


def wording_of(instead: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """What a page says of the machine that is open instead of what it says of others: texts by the
    English one, and what charts show; in the language that is spoken.

    instead : texts by the text for which they are said.
    """
    words = {text: say(instead[text]) for text in said_by_page() if text in instead}
    return {"words": words, "explained": explained() if instead else {}}


@cache
def said_by_page() -> tuple[str, ...]:
    """English texts that the page says; none where it is not bundled."""
    file = files("equipoise.web") / "static" / WORDS
    return tuple(json.loads(file.read_text(encoding="utf-8"))) if file.is_file() else ()


@cache
def words_of(language: str) -> dict[str, str]:
    """English text -> text in a language, of what the page says; only those that are translated."""
    known = catalogue(language)
    return {text: known[text] for text in said_by_page() if text in known}


def spoken_in(language: str) -> dict[str, Any]:
    """What a page has to know to speak a language."""
    with speaking(language):
        charts = explained()
    words = words_of(language)
    text = {"language": language, "languages": LANGUAGES, "words": words, "explained": charts}
    return text | speech_of(language)


def speech_of(language: str) -> dict[str, Any]:
    """What a page has to know of a language beside its texts: its decimal sign, its particles, and
    the forms of those texts that have some by a count.
    """
    forms = counted(language)
    own = {text: forms[text] for text in said_by_page() if text in forms}
    return {"decimal": KNOWN[language].decimal, "particles": rules(language), "forms": own}
