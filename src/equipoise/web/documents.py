"""HTML documents of the live page: the head that all of them have, and what stands in one file."""

from __future__ import annotations

import json
from html import escape
from typing import Any

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
