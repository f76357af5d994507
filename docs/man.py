"""Writes the page of `man equipoise` to build/man, from the help of all commands."""

from __future__ import annotations

import re
from pathlib import Path

from docutils.core import publish_string
from docutils.writers.manpage import Writer

from equipoise import __version__
from equipoise.cli import app

PAGE = Path(__file__).parents[1] / "build" / "man" / "equipoise.1"


def page() -> bytes:
    """The page as groff reads it: what the program is, then a section for each command."""
    _ = app.resolved_commands()  # which have no help before
    text = app.generate_docs("rst", usage_name="equipoise").replace(f"\n{app.help}\n", "", 1)
    rule, line = "=" * len("equipoise"), "-" * len(app.help)
    title = f"{rule}\nequipoise\n{rule}\n\n{line}\n{app.help}\n{line}\n\n"
    about = f":Manual section: 1\n:Version: {__version__}\n\n"
    body = re.sub(r"\.\. contents::.*?\n\n", "", text[text.index("::\n") :], flags=re.DOTALL)
    settings = {"report_level": 2, "halt_level": 2}
    made: bytes = publish_string(title + about + body, writer=Writer(), settings_overrides=settings)
    return made


if __name__ == "__main__":
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_bytes(page())
