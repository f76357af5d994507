"""The gallery: every bundled example with a picture that moves, what it is and what it teaches.

Title and description are those of the example's file.  What it teaches, and what to try, is a row
of the table in `docs/examples.md`, and of those in other languages in the folders beside it.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

from equipoise.cli import run
from equipoise.schema.opening import bundled, kind_of

FOLDER = "moving"
"""Where the pictures are."""
TABLE = re.compile(r"^\|.*\n(?:\|.*\n)+", re.MULTILINE)


class Words(NamedTuple):
    """What a card says in a language, and what stands between that and the rest."""

    teaches: str
    picture: str
    to_try: str
    colon: str = ": "


WORDS = {
    "en": Words("What it teaches", "The picture", "To try"),
    "ja": Words("学べること", "図を作るコマンド", "試すコマンド", "："),
    "ko": Words("배울 수 있는 것", "그림을 만드는 명령", "해 볼 명령"),
}


def plain(text: str) -> str:
    """A text in Markdown where nothing means more than it says."""
    return re.sub(r"[\\`*_\[\]<>]", r"\\\g<0>", text)


def lessons(text: str) -> dict[str, list[str]]:
    """The table of a page: what each example teaches and, in English, a command to try."""
    table = TABLE.search(text)
    assert table is not None, "the page has no table"
    rows = [row.strip("| ").split(" | ") for row in table[0].splitlines()[2:]]
    return {name: told for names, *told in rows for name in re.findall(r"`([\w-]+)`", names)}


def drawing(name: str, content: Mapping[str, Any]) -> tuple[list[str], str]:
    """The command that draws an example, and the picture that it writes; content : of its file."""
    kind = kind_of(content)
    if kind == "tool":
        return ["plot", name, "--only", "side-modes", "-o", name], f"{name}/side-modes.svg"
    drawn = content["model"] if kind == "study" else name
    return ["animate", drawn, "--force", "-o", f"{drawn}.svg"], f"{drawn}.svg"


def card(language: str, name: str, content: Mapping[str, Any], lesson: str, to_try: str) -> str:
    """What there is to say of one example; `lesson` and `to_try` are Markdown."""
    words = WORDS[language]
    command, picture = drawing(name, content)
    title = plain(content["title"][language])
    description = content.get("description", {}).get(language, "")  # studies have none
    told = {
        f"`{name}`": plain(description.strip()),
        f"**{words.teaches}**": lesson,
        f"**{words.picture}**": f"`equipoise {' '.join(command)}`",
        f"**{words.to_try}**": to_try,
    }
    heads = [f"## {title}", f"![{title}](/{FOLDER}/{picture})"]
    parts = [f"{head}{words.colon}{text}".rstrip(f" {words.colon}") for head, text in told.items()]
    return "\n\n".join([*heads, *parts, ""])


def gallery(pages: Mapping[str, str], into: Path) -> dict[str, str]:
    """Draw the examples into a folder, and put cards in the place of each page's table.

    pages : language -> text.
    """
    contents = {name: tomllib.loads(file.read_text("utf-8")) for name, file in bundled().items()}
    draw({" ".join(drawing(*one)[0]) for one in contents.items()}, into / FOLDER)
    english = lessons(pages["en"])
    done = {}
    for language, text in pages.items():
        cards = [
            card(language, name, contents[name], told[0], english[name][1])
            for name, told in lessons(text).items()
        ]
        before, after = TABLE.split(text)
        done[language] = "\n".join([before, *cards, after])
    return done


def draw(commands: set[str], into: Path) -> None:
    """Run the commands in a folder.

    Raises
    ------
    RuntimeError : one does not do what it should.
    """
    into.mkdir(parents=True, exist_ok=True)
    told = StringIO()
    with chdir(into), redirect_stdout(told), redirect_stderr(told):
        for command in sorted(commands):
            if run(command.split()):
                raise RuntimeError(f"equipoise {command}: {told.getvalue()}")
