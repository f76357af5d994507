"""A page in one file that plays a machine without a server: what a page was told, and the page."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable
from typing import Any

from equipoise.i18n import said, speaking
from equipoise.web.assets import assets
from equipoise.web.documents import ALONE, data, document, script, style
from equipoise.web.edits import Computed
from equipoise.web.replies import Reply
from equipoise.web.state import first_of


def played(computed: Computed, replies: Iterable[Reply], language: str) -> str:
    """The HTML file.

    replies : all that a page could be told of the machine.

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
        title = said(computed.design.machine.title) or computed.design.name
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
