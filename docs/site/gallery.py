"""The gallery: every bundled example with a picture that moves, what it is and what it teaches.

Title and description are those of the example's file.  What it teaches, and what to try, is a row
of the table in `docs/examples.md`, and of those in other languages in the folders beside it.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping
from functools import cache
from typing import Any, NamedTuple

from lessons import TABLE, lessons
from pictures import command_of

from equipoise.i18n import speaking
from equipoise.schema.open_files import bundled, kind_of
from equipoise.web import gallery as kinds
from equipoise.web.gallery import opened_example


class Words(NamedTuple):
    """What a card says in a language, and what stands between that and the rest.

    others : headings of tools and of studies, which the live page has no gallery of.
    """

    teaches: str
    picture: str
    to_try: str
    live: str
    page: str
    others: tuple[str, str]
    colon: str = ": "


WORDS = {
    "en": Words(
        "What it teaches",
        "The picture",
        "To try",
        "open live",
        "open in the live page",
        ("Hand-held tools", "Studies"),
    ),
    "ja": Words(
        "学べること",
        "図を作るコマンド",
        "試すコマンド",
        "動かして開く",
        "ライブページで開く",
        ("手持ち工具", "スタディ"),
        "：",
    ),
    "ko": Words(
        "배울 수 있는 것",
        "그림을 만드는 명령",
        "해 볼 명령",
        "움직이며 열기",
        "라이브 페이지에서 열기",
        ("손공구", "스터디"),
    ),
}


@cache
def section_of_machine(name: str) -> int:
    """Which section of the gallery a bundled machine is in."""
    return kinds.section_of(opened_example(name).machine)


def section_of(name: str, content: Mapping[str, Any]) -> int:
    """Which heading of the page an example of linkages, tools or studies stands below."""
    kind = kind_of(content)
    if kind == "linkage":
        return section_of_machine(name)
    return len(kinds.sections()) + ("tool", "study").index(kind)


def grid(language: str, contents: Mapping[str, Mapping[str, Any]]) -> str:
    """Thumbnails by kind, each of which leads to its example below."""
    parts = []
    with speaking(language):
        headings = (*kinds.sections(), *WORDS[language].others)
    for at, kind in enumerate(headings):
        parts += [f"## {kind}", "::::{grid} 2 3 4 4", ":gutter: 2"]
        for name, content in contents.items():
            if section_of(name, content) == at:
                title = plain(content["title"][language])
                parts += [
                    f"\n:::{{grid-item-card}} {title}",
                    f":img-top: /moving/{content.get('model', name)}.svg",
                    f":link: {language}-{name}\n:link-type: ref\n:::",
                ]
        parts += ["::::\n"]
    return "\n".join(parts)


def plain(text: str) -> str:
    """A text in Markdown where nothing means more than it says."""
    return re.sub(r"[\\`*_\[\]<>]", r"\\\g<0>", text)


def opened(language: str, name: str, live: Collection[str]) -> str:
    """Links that open an example: its interactive file, and the live page where there is one.

    The live page is beside the documentation on a site only, which then shows its link.
    """
    words, top = WORDS[language], "" if language == "en" else "../"
    file = f'<a class="open-live" href="{top}live/{language}/{name}.html">{words.live}</a>'
    page = f'<a class="open-page" hidden href="{top}../#example={name}">{words.page}</a>'
    return f"{file} {page}" if name in live else page


def card(
    language: str,
    name: str,
    content: Mapping[str, Any],
    lesson: str,
    to_try: str,
    live: Collection[str],
) -> str:
    """What there is to say of one example; `lesson` and `to_try` are Markdown."""
    words = WORDS[language]
    picture = f"/moving/{content.get('model', name)}.svg"  # of a study, its model
    title = plain(content["title"][language])
    description = content.get("description", {}).get(language, "")  # studies have none
    told = {
        f"`{name}`": plain(description.strip()),
        f"**{words.teaches}**": lesson,
        f"**{words.picture}**": f"`equipoise {command_of(picture)}`",
        f"**{words.to_try}**": to_try,
    }
    label = f"({language}-{name})="
    heads = [f"{label}\n### {title}", f"![{title}]({picture})", opened(language, name, live)]
    parts = [f"{head}{words.colon}{text}".rstrip(f" {words.colon}") for head, text in told.items()]
    return "\n\n".join([*heads, *parts, ""])


def gallery(pages: Mapping[str, str], live: Mapping[str, Collection[str]]) -> dict[str, str]:
    """Put cards in the place of each page's table.

    pages : language -> text.  live : language -> examples that have an interactive file in it.
    """
    contents = {name: tomllib.loads(file.read_text("utf-8")) for name, file in bundled().items()}
    english = lessons(pages["en"])
    done = {}
    for language, text in pages.items():
        cards = [
            card(language, name, contents[name], told[0], english[name][1], live[language])
            for name, told in lessons(text).items()
        ]
        before, after = TABLE.split(text)
        shown = {name: contents[name] for name in lessons(text)}
        parts = [before, grid(language, shown), f"## {WORDS[language].teaches}\n", *cards, after]
        done[language] = "\n".join(parts)
    return done
