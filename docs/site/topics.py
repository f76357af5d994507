"""An address for each topic of `equipoise explain`, ``explain/TOPIC.html``, that leads to its page.

A program that knows the topic of an error has its page by that, whatever the pages are called.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from equipoise.schema.topics import errors, tables

FOLDER = "explain"
OF_FILES = {
    "linkage": "model-file.md",
    "tool": "model-file/file-of-a-tool.md",
    "study": "studies.md",
}
"""The pages of files, which tables without a page of their own are on."""
TOP = re.compile(r"(?:^\(.*\)=\n|^<a id=.*\n|\n)*# (.+)\n")
REDIRECTION = """<!DOCTYPE html>
<html lang="en"><meta charset="utf-8"><title>{topic}</title>
<meta http-equiv="refresh" content="0; url=../{page}"><a href="../{page}">{topic}</a></html>
"""


def page_of_each(pages: Mapping[str, str]) -> dict[str, str]:
    """The page of each topic, as ``errors/change-point.md``.  pages : Markdown by name."""
    tops = {top[1]: name for name, text in pages.items() if (top := TOP.match(text))}
    found = {topic: tops[error.title] for topic, error in errors().items()}
    for topic, table in tables().items():
        steps = topic.split(".")
        above = (".".join(steps[:count]) for count in range(len(steps), 0, -1))
        heads = (f"`{tables()[path].heading}`" for path in above if path in tables())
        found[topic] = next((tops[head] for head in heads if head in tops), OF_FILES[table.kind])
    return found


def write_topics(pages: Mapping[str, str], into: Path) -> None:
    """Write the addresses of all topics."""
    (into / FOLDER).mkdir(parents=True)
    for topic, name in page_of_each(pages).items():
        page = name.replace(".md", ".html")
        text = REDIRECTION.format(topic=topic, page=page)
        (into / FOLDER / f"{topic}.html").write_text(text, encoding="utf-8")
