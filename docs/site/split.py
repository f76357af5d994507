"""A long page as one page for each of its parts, so that each can be read, linked and searched."""

from __future__ import annotations

import os
import re
from collections import Counter
from typing import NamedTuple

from docutils.nodes import make_id

HEADING = re.compile(r"^(#{2,5}) (.+)$", re.MULTILINE)
ANCHOR = re.compile(r'<a id="([\w-]+)"></a>')
CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?![a-z]+:|/)([^)#\s]*)(#[^)\s]*)?\)")


class Heading(NamedTuple):
    """A heading, what it is called in links, and where it begins."""

    level: int
    title: str
    slug: str
    start: int


def slug_of(title: str) -> str:
    """What a heading is called in links, as on GitHub."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def headings(text: str) -> list[Heading]:
    """The headings of a page below its first, but for comments in code that look the same."""
    code = [block.span() for block in CODE.finditer(text)]
    count: Counter[str] = Counter()
    headings = []
    for match in HEADING.finditer(text):
        if any(start < match.start() < end for start, end in code):
            continue
        slug = slug_of(match[2])
        unique = f"{slug}-{count[slug]}" if count[slug] else slug
        count[slug] += 1
        headings.append(Heading(len(match[1]), match[2], unique, match.start()))
    return headings


def split(pages: dict[str, str], page: str) -> dict[str, str]:
    """All pages, one of them split: it keeps what stands above its first heading of level two, and
    each such heading becomes a page in a folder of its name.

    Links to headings and anchors of the page go to the part that has them, from every page.
    """
    text, folder = pages[page], page.removesuffix(".md")
    every = headings(text)
    tops = [heading for heading in every if heading.level == 2]
    ends = [*(heading.start for heading in tops[1:]), len(text)]
    parts: dict[str, str] = {}
    home: dict[str, str] = {}
    for top, end in zip(tops, ends, strict=True):
        name = f"{folder}/{top.slug}.md"
        part = raised(text[top.start : end])
        parts[name] = part
        inner = [heading for heading in every if top.start < heading.start < end]
        home |= {top.slug: name, make_id(top.title): name}
        for here, there in zip(inner, headings(part), strict=True):
            home[here.slug] = home[make_id(here.title)] = f"{name}#{there.slug}"
        home |= {anchor: f"{name}#{anchor}" for anchor in ANCHOR.findall(part)}
    listed = "\n".join(f"/{folder}/{top.slug}" for top in tops)
    start = f"{text[: tops[0].start]}\n```{{toctree}}\n:maxdepth: 2\n\n{listed}\n```\n"
    moved = {name: relinked(body, name, name, page, home) for name, body in pages.items()}
    moved[page] = relinked(start, page, page, page, home)
    return moved | {name: relinked(part, name, page, page, home) for name, part in parts.items()}


def raised(part: str) -> str:
    """A part whose headings stand one level higher."""
    for heading in reversed(headings(part)):
        part = part[: heading.start] + part[heading.start + 1 :]
    return part


def relinked(text: str, name: str, written: str, page: str, home: dict[str, str]) -> str:
    """A text whose links to headings of the split page go to its parts.

    name : the page that it is now.  written : the page that its links are relative to.
    """

    def to(link: re.Match[str]) -> str:
        anchor = (link[2] or "").removeprefix("#")
        beside = os.path.join(os.path.dirname(written), link[1])
        target = os.path.normpath(beside) if link[1] else written
        if target == page and anchor:
            target, _, anchor = home[anchor].partition("#")
        elif name == written:
            return link[0]
        path = "" if target == name and anchor else os.path.relpath(target, os.path.dirname(name))
        return f"]({path}{'#' * bool(anchor)}{anchor})"

    return LINK.sub(to, text)
