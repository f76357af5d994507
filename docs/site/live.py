"""Interactive files of the bundled machines, one in each language of the gallery.

``live/ja/yamashita-1.html`` stands beside the pages, and is opened from there.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from equipoise import EquipoiseError, examples, export, load

FRAMED = ("en", "yamashita-1")
"""Language and machine of the file in a frame of the first page."""


def write_live(into: Path, languages: Iterable[str], *, draft: bool) -> dict[str, set[str]]:
    """Write the files of all machines that can be such a file; returns their names by language.

    Where the page has not been built there are none, and the gallery has no links to them.

    draft : each machine in one of the languages, which take turns, and the one of the first page.
    """
    names: dict[str, set[str]] = {language: set() for language in languages}
    for language in names:
        (into / "live" / language).mkdir(parents=True)
    for number, name in enumerate(examples("linkage")):
        machine = load(name)
        for place, language in enumerate(names):
            in_turn = number % len(names) == place or (language, name) == FRAMED
            if draft and not in_turn:
                continue
            try:
                export(machine, into / "live" / language / f"{name}.html", language=language)
            except EquipoiseError:
                break  # of this machine no script can be written
            names[language].add(name)
    return names
