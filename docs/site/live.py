"""Interactive files of the bundled machines, one in each language of the gallery.

``live/ja/yamashita-1.html`` stands beside the pages, and is opened from there.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from equipoise import EquipoiseError, examples, export, load


def write_live(into: Path, languages: Iterable[str]) -> set[str]:
    """Write the files of all machines that can be such a file; returns their names.

    Where the page has not been built there are none, and the gallery has no links to them.
    """
    names = set()
    for language in languages:
        folder = into / "live" / language
        folder.mkdir(parents=True)
        for name in examples("linkage"):
            try:
                export(load(name), folder / f"{name}.html", language=language)
            except EquipoiseError:
                continue  # of this machine no script can be written
            names.add(name)
    return names
