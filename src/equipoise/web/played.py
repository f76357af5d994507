"""A page in one file that plays a machine without a server: what a page was told, and the page."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterable
from html import escape
from typing import Any

from equipoise.i18n import said, speaking
from equipoise.web.assets import assets
from equipoise.web.edits import Solved
from equipoise.web.replies import Reply
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


def played(found: Solved, replies: Iterable[Reply], language: str) -> str:
    """The HTML file.

    replies : all that a page could be told of the machine.

    Raises
    ------
    UsageError : the page has not been built.
    """
    built = assets()
    told = {
        "replies": [_written(reply) for reply in replies],
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


def _written(reply: Reply) -> list[Any]:
    return [reply.content, b64encode(reply.buffer).decode()]
