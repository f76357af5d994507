"""The page of all commands, as their help tells them."""

from __future__ import annotations

import re


def commands() -> str:
    """The page."""
    from equipoise.cli import COMMANDS, app

    for name in COMMANDS:  # each is imported when it is asked for
        _ = app[name]
    text = app.generate_docs(output_format="markdown")
    text = re.sub(r"\n## Table of Contents\n.*?(?=\n\*\*Commands)", "", text, flags=re.DOTALL)
    text = re.sub(r" *\*\[default: False\]\*", "", text)
    return text.replace("# equipoise\n", "# Commands\n", 1)
