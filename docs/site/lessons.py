"""What each example teaches: the rows of the table in `docs/examples.md`, in any language."""

from __future__ import annotations

import re

TABLE = re.compile(r"^\|.*\n(?:\|.*\n)+", re.MULTILINE)


def lessons(text: str) -> dict[str, list[str]]:
    """The table of a page: what each example teaches and, in English, a command to try."""
    table = TABLE.search(text)
    assert table is not None, "the page has no table"
    rows = [row.strip("| ").split(" | ") for row in table[0].splitlines()[2:]]
    return {name: told for names, *told in rows for name in re.findall(r"`([\w-]+)`", names)}
