"""The page of all commands, as their help tells them."""

from __future__ import annotations

import re


def commands() -> str:
    """The page."""
    from equipoise.cli import app

    _ = app.resolved_commands()  # which have no help before
    text = app.generate_docs(output_format="markdown")
    text = re.sub(r"\n## Table of Contents\n.*?(?=\n\*\*Commands)", "", text, flags=re.DOTALL)
    text = re.sub(r" *\*\[default: False\]\*", "", text)
    return text.replace("# equipoise\n", "# Commands\n", 1)
