"""HTML documents of the live page, their script, style and texts."""

from __future__ import annotations

import json
import sys
from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from html import escape
from importlib.resources import files
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import LANGUAGES, Note, catalogue, localized, say, speaking
from equipoise.i18n.languages import KNOWN, counted, rules
from equipoise.web.additions import part_tools
from equipoise.web.edits import Computed
from equipoise.web.figures import explained
from equipoise.web.replies import Reply
from equipoise.web.state import first_of
from equipoise.web.tables import menu_items

TYPES = {"equipoise.js": "text/javascript", "equipoise.css": "text/css"}
"""Everything that there is, with its type."""
MAKE = Note(
    "the page has not been built; run `make page`, or `pip install -e .` "
    "where Node or a network is at hand"
)


def assets() -> dict[str, bytes]:
    """Script and style of the page, by name.

    Raises
    ------
    UsageError : they have not been built.
    """
    return {name: asset(name).encode() for name in TYPES}


def asset(name: str) -> str:
    """One of the files that have been built.

    Raises
    ------
    UsageError : it has not been built.
    """
    try:
        return (files("equipoise.web") / "static" / name).read_text(encoding="utf-8")
    except OSError:
        if sys.platform == "emscripten":  # a site has it beside the page, and not once more here
            from pyodide.http import open_url  # type: ignore[import-not-found]

            return str(open_url(name).read())
        raise UsageError(MAKE) from None


DOCUMENT = """<!doctype html>
<html lang="{language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
{head}
<title>{title}</title>
<link rel="icon" href="data:,">
</head>
<body>
{body}
</body>
</html>
"""
ALONE = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'"
)
"""Policy of a file that stands alone: nothing is loaded or sent, wherever it is opened."""


def document(
    head: str, body: str, *, policy: str = "", title: str = "Equipoise", language: str = "en"
) -> str:
    """An HTML document.

    head, body : what it has beside what all have, as HTML.
    policy : what it may load and send; empty where the server's headers say it.
    """
    if policy:
        head = f'<meta http-equiv="content-security-policy" content="{policy}">\n{head}'
    return DOCUMENT.format(language=language, title=escape(title), head=head, body=body)


def style(text: str) -> str:
    """A style sheet as an element, which nothing in it can end."""
    return "<style>{}</style>".format(text.replace("</", "<\\/"))


def script(text: str, attributes: str = 'type="module"') -> str:
    """A script as an element with these attributes, which nothing in it can end."""
    safe = text.replace("</script", "<\\/script")
    return f"<script {attributes}>{safe}</script>"


def data(name: str, values: Any) -> str:
    """Values as JSON in an element of that name, which nothing in them can end."""
    text = json.dumps(values, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>'


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
        tools = [tool.content for tool in part_tools()]
        text = {"explained": explained(), "part_tools": tools, "menu_items": [*menu_items()]}
    text |= {"language": language, "languages": LANGUAGES, "words": words_of(language)}
    return text | speech_of(language)


def speech_of(language: str) -> dict[str, Any]:
    """What a page has to know of a language beside its texts: its decimal sign, its particles, and
    the forms of those texts that have some by a count.
    """
    forms = counted(language)
    own = {text: forms[text] for text in said_by_page() if text in forms}
    return {"decimal": KNOWN[language].decimal, "particles": rules(language), "forms": own}


def played(computed: Computed, replies: Iterable[Reply], language: str) -> str:
    """The HTML file.

    replies : every reply that a page could get on the machine.

    Raises
    ------
    UsageError : the page has not been built.
    """
    built = assets()
    text = {
        "replies": [_written(reply) for reply in replies],
        "wanted": first_of(computed.design.machine)[1],
    }
    with speaking(language):
        title = localized(computed.design.machine.title) or computed.design.name
    body = (
        '<main id="equipoise-live" data-played="equipoise-played"></main>',
        data("equipoise-played", text),
        script(built["equipoise.js"].decode()),
    )
    return document(
        style(built["equipoise.css"].decode()),
        "\n".join(body),
        policy=ALONE,
        title=title,
        language=language,
    )


def _written(reply: Reply) -> list[Any]:
    return [reply.content, b64encode(reply.buffer).decode()]
