"""What the search of the site looks through: every section and every public name, with its text.

A page that is opened as a file must not read others, so that the texts stand in one script,
``search/sections.js``, beside the library that ranks them.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.addnodes import desc, desc_signature
from sphinx.application import Sphinx

RANKING = Path(__file__).parents[2] / "page" / "node_modules" / "minisearch"
"""MiniSearch, which `page/bundle.py --tools` installs; without it the theme searches by pages."""
FOLDER = "search"
SIGNS = re.compile(r"\\[,;!]|[\\{}]")
"""Of formulas, of which the names are searched and read."""
Section = tuple[str, str, list[str], str]
"""Page, anchor, titles from the page's down to its own, text."""


def sections(page: str, doctree: nodes.document) -> Iterator[Section]:
    """Every section and described name of a page, each with the text that is in no further one."""
    for node in doctree.findall(lambda node: isinstance(node, nodes.section | desc)):
        above = [node]
        while above[0].parent is not None:
            above.insert(0, above[0].parent)
        titles = [title_of(outer) for outer in above if isinstance(outer, nodes.section | desc)]
        ids = node["ids"] or next((sign["ids"] for sign in node.findall(desc_signature)), [])
        top = node.parent is doctree
        yield page, "" if top or not ids else ids[0], titles, " ".join(texts(node))


def title_of(node: nodes.Element) -> str:
    """Heading of a section, or the name that is described."""
    if isinstance(node, desc):
        return str(next(iter(node.findall(desc_signature))).get("fullname", ""))
    return node.next_node(nodes.title).astext()


def texts(node: nodes.Element) -> Iterator[str]:
    """The paragraphs, cells and blocks of code of a section that are in no inner one."""
    for child in node.children:
        if isinstance(child, nodes.section | desc | nodes.title | desc_signature):
            continue
        if isinstance(child, nodes.TextElement):
            if not isinstance(child, nodes.comment | nodes.raw | nodes.math_block):
                words = (
                    SIGNS.sub("", text) if isinstance(text.parent, nodes.math) else text
                    for text in child.findall(nodes.Text)
                    if not isinstance(text.parent, nodes.raw)
                )
                yield " ".join(" ".join(words).split())
        elif isinstance(child, nodes.Element):
            yield from texts(child)


def collect(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Keep the sections of a page, and link its search to the script."""
    if doctree is not None:
        app.builder.sections[page] = list(sections(page, doctree))  # type: ignore[attr-defined]


def write(app: Sphinx, failure: Exception | None) -> None:
    """Write the texts of all pages, and the library."""
    if failure or not RANKING.exists():
        return
    folder = Path(app.outdir) / FOLDER
    folder.mkdir(exist_ok=True)
    pages: dict[str, list[Section]] = app.builder.sections  # type: ignore[attr-defined]
    every = [section for page in sorted(pages) for section in pages[page]]
    text = json.dumps(every, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    (folder / "sections.js").write_text(f"const SECTIONS = {text};\n", encoding="utf-8")
    shutil.copy(RANKING / "dist" / "umd" / "index.js", folder / "minisearch.js")
    shutil.copy(RANKING / "LICENSE.txt", folder / "minisearch-license.txt")


def setup(app: Sphinx) -> None:
    """Collect while pages are written, write at the end."""
    app.connect("builder-inited", lambda app: setattr(app.builder, "sections", {}))
    app.connect("html-page-context", collect)
    app.connect("build-finished", write)
