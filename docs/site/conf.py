"""How Sphinx makes the site of what `make.py` has laid out."""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

sys.path.insert(0, str(Path(__file__).parent))

import ziamath
from docutils.nodes import SkipNode, image
from latex2mathml.converter import convert
from search import Words
from sections import RANKING
from sphinx.util.logging import getLogger

import equipoise

if TYPE_CHECKING:
    from docutils import nodes
    from sphinx.application import Sphinx

FONT = "STIXTwoMath-Regular.ttf"
project = "Equipoise"
copyright = "The Equipoise authors"
release = version = equipoise.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "sphinx_design",
    "sections",
]
root_doc = "index"
smartquotes = False  # two hyphens begin an option, and quotes are typed
default_role = "code"
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types of annotations; links of pages are all looked for

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence"]
myst_heading_anchors = 5
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True

html_theme = "furo"
html_title = "Equipoise"
html_static_path = ["static", str(Path(ziamath.__file__).with_name("fonts") / FONT)]
copybutton_exclude = ".linenos, .gp, .go"  # of a session only what is typed
html_css_files = ["site.css"]
html_js_files = [("cells.js", {"defer": "defer"})]
templates_path = ["templates"] if RANKING.exists() else []
html_copy_source = html_show_sourcelink = html_show_sphinx = False
html_show_search_summary = False  # a page opened as a file must not read others
html_search_language = Words.lang
html_math_renderer = "mathml"
pygments_style, pygments_dark_style = "a11y-high-contrast-light", "a11y-high-contrast-dark"

LISTED = re.compile(r"^- \[([^\]]+)\]\(([\w./-]+)\.md\)", re.MULTILINE)
"""A page in the lists of `index.md`."""
ITEM = re.compile(r"^(\w[\w, ]*) : ")
"""In a docstring: what something is called, and what it is."""
NEXT_ITEM = re.compile(r"\.  (?=\w[\w, ]* : )")
"""Where another stands in the same line."""


def as_tree(app: Sphinx, docname: str, source: list[str]) -> None:
    """The lists of the first page, each with its heading, are the tree of the site."""
    if docname != root_doc:
        return
    for part in source[0].split("\n## ")[1:]:
        pages = "\n".join(f"{name} <{page}>" for name, page in LISTED.findall(part))
        caption = part.partition("\n")[0]
        source[0] += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{pages}\n```\n"


def as_tables(
    app: Sphinx, what: str, name: str, documented: Any, options: Any, lines: list[str]
) -> None:
    """Docstrings say ``name : meaning``, which is a row of a table, and nothing in them is markup
    but what is code.
    """
    written: list[str] = []
    in_table = False
    for line in NEXT_ITEM.sub(".\n", "\n".join(lines)).split("\n"):
        if line.startswith("---"):
            written[-1:] = [f".. rubric:: {written[-1]}", ""]
            in_table = False
        elif item := ITEM.match(line):
            written += [] if in_table else TABLE_OF_PARAMETERS
            written += [f"   * - ``{item[1]}``", f"     - {plain(line[item.end() :])}"]
            in_table = True
        elif in_table and (not line.strip() or line.startswith(" ")):
            written.append(f"       {plain(line.strip())}".rstrip())
        else:
            ends = in_table or (written and written[-1].startswith("    ") and line[:1].strip())
            written += [*[""] * bool(ends), plain(line)]
            in_table = False
    lines[:] = written


TABLE_OF_PARAMETERS = ["", ".. list-table::", "   :class: names", "   :widths: 1 3", ""]


def plain(line: str) -> str:
    """A line whose signs are no markup, but for what is code."""
    parts = line.split("`")
    parts[::2] = [re.sub(r"[*|]|_\b", r"\\\g<0>", part) for part in parts[::2]]
    return "`".join(parts)


SET = {
    r"<mo([^>]*)>(&#x0007C;)": r'<mo\1 lspace="0" rspace="0">\2',  # bars of an absolute value
    r"(&#x0003D;</mo>)<mo>(&#x0002B;|&#x02212;)": r'\1<mo form="prefix">\2',  # signs, not sums
    r"<msup>(<m[io]>[^<]*</m[io]>)<mi>(&#x0203[2-4];)</mi></msup>": (
        r'<mrow>\1<mo lspace="0" rspace="0">\2</mo></mrow>'  # primes stand high by themselves
    ),
}
"""What formulas need to be set well, as patterns in MathML."""


@cache
def mathml(tex: str, display: str) -> str:
    """A formula as browsers draw it themselves."""
    formula: str = convert(tex, display=display)
    for pattern, better in SET.items():
        formula = re.sub(pattern, better, formula)
    if re.search(r"\\|>&<", formula):
        getLogger(__name__).warning("not understood in a formula: %s", tex)
    return formula


def inline_math(self: Any, node: nodes.math) -> None:
    """Write a formula of a line."""
    self.body.append(mathml(node.astext(), "inline"))
    raise SkipNode


def block_math(self: Any, node: nodes.math_block) -> None:
    """Write a formula of its own."""
    self.body.append(f'<div class="math" tabindex="0">{mathml(node.astext(), "block")}</div>')
    raise SkipNode


def lazily(app: Sphinx, doctree: nodes.document) -> None:
    """Pictures are loaded where they come into sight: of the gallery all move."""
    for one in doctree.findall(image):
        one["loading"] = "lazy"


REACHED = {
    "<pre>": '<pre tabindex="0">',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
    'role="heading">': 'role="heading" aria-level="2">',
}
"""What is too wide is moved by keys too; headings of the tree have a level."""


CELL = re.compile(r"<td>|<td class")
ROW, HEAD = re.compile(r"<tr.*?</tr>", re.DOTALL), re.compile(r"<th[^>]*>(.*?)</th>", re.DOTALL)
TABLE = re.compile(r"<table class=\"docutils.*?</table>", re.DOTALL)
FEWEST, LONG = 4, 45
"""Columns from which on a row of a table is set as a list where a page is narrow; of three columns,
signs in a cell from which on it is, in the mean.
"""


def as_cards(found: re.Match[str]) -> str:
    """A table whose cells know their headings, for pages that are too narrow for its columns."""
    table = found[0]
    names = [re.sub(r"<[^>]*>", "", name).strip() for name in HEAD.findall(table)]
    signs = len(re.sub(r"<[^>]*>", "", table)) / max(table.count("<td"), 1)
    if len(names) < FEWEST - (signs > LONG):
        return table
    row = ROW.sub(lambda row: _named(row[0], names), table)
    return row.replace('class="docutils', 'class="many-columns docutils', 1)


def _named(row: str, names: list[str]) -> str:
    of = iter(names)
    return CELL.sub(lambda cell: f'<td data-name="{next(of, "")}"{cell[0][3:]}', row)


def reached(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Let keys and readers of screens reach all of a page, and tell its language."""
    folder = page.partition("/")[0]
    context["language"] = folder if folder in {"ja", "ko"} else "en"
    for part in {"body", "furo_navigation_tree"} & context.keys():
        for written, better in REACHED.items():
            context[part] = context[part].replace(written, better)
    if "body" in context:
        context["body"] = TABLE.sub(as_cards, context["body"])


def setup(app: Sphinx) -> None:
    """Tell Sphinx of what is made here."""
    app.add_search_language(Words)
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
    app.connect("source-read", as_tree)
    app.connect("autodoc-process-docstring", as_tables)
    app.connect("doctree-read", lazily)
    app.connect("html-page-context", reached, priority=900)  # after the theme's own
