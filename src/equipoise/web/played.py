"""A page in one file that plays a machine without a server: what a page was told, and the page."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterator
from html import escape
from typing import Any

from equipoise.i18n import said, speaking
from equipoise.web.edits import Solved
from equipoise.web.messages import message_of
from equipoise.web.replies import Reply
from equipoise.web.server import assets
from equipoise.web.session import Session
from equipoise.web.state import first_of

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'"
)
"""Nothing is loaded, and nothing is sent, wherever the file is opened."""
HTML = """<!doctype html>
<html lang="{language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="content-security-policy" content="{policy}">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<main id="equipoise-live" data-played="equipoise-played"></main>
<script type="application/json" id="equipoise-played">{told}</script>
<script type="module">{script}</script>
</body>
</html>
"""


def played(found: Solved, language: str) -> str:
    """The HTML file.

    Raises
    ------
    UsageError : the page has not been built.
    """
    built = assets()
    told = {
        "replies": [_written(reply) for reply in _conversation(found, language)],
        "wanted": first_of(found.design.machine)[1],
    }
    with speaking(language):
        title = said(found.design.machine.title) or found.design.name
    return HTML.format(
        language=language,
        policy=POLICY,
        title=escape(title),
        style=built["equipoise.css"].decode().replace("</", "<\\/"),
        told=json.dumps(told, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"),
        script=built["equipoise.js"].decode().replace("</script", "<\\/script"),
    )


def _conversation(found: Solved, language: str) -> Iterator[Reply]:
    """What a page would be told that asks for everything about a machine."""
    session = Session()
    session.open(found.design, found)
    session.wanted = tuple(one.name for one in found.analysis.outputs)
    yield from session.receive(message_of({"type": "speak", "languages": [language]}))
    yield from session.receive(message_of({"type": "ready"}))
    yield from session.tell_more()


def _written(reply: Reply) -> list[Any]:
    return [reply.content, b64encode(reply.buffer).decode()]
