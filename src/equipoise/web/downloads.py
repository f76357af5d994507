"""Files that a page can keep: the model, its signals, its report."""

from __future__ import annotations

import re
from threading import Lock
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import LANGUAGES
from equipoise.mechanism.checks import unknown
from equipoise.schema.documents import dumps
from equipoise.schema.files import to_csv
from equipoise.web.edits import Solved

FILES = {
    "model": (".toml", "application/toml"),
    "csv": (".csv", "text/csv"),
    "report": (".html", "text/html"),
}
"""What there is, with the end of its name and its type."""
FORBIDDEN = re.compile(r'[\\/:*?"<>|]+')
"""What some system would not have in the name of a file."""
_drawing = Lock()
"""Matplotlib draws one picture after the other."""


def downloaded(found: Solved, what: str, language: str) -> tuple[dict[str, Any], bytes]:
    """Name and type of a file, and its bytes.

    Raises
    ------
    UsageError : there is no such file or language.
    EquipoiseError : it cannot be made of this machine.
    """
    if what not in FILES:
        raise UsageError(unknown(what, FILES, "download"))
    ending, mime = FILES[what]
    stem = FORBIDDEN.sub("-", found.design.name.removesuffix(".toml")) or "machine"
    name = f"{stem}-report{ending}" if what == "report" else f"{stem}{ending}"
    if what == "model":
        text = dumps(found.design.machine)
    elif what == "csv":
        text = to_csv(found.analysis)
    else:
        text = _report(found, f"{stem}.toml", language)
    return {"name": name, "mime": mime}, text.encode()


def _report(found: Solved, file: str, language: str) -> str:
    from equipoise.present.composition import report_page
    from equipoise.present.findings import Findings

    if language not in LANGUAGES:
        raise UsageError(unknown(language, LANGUAGES, "language of reports"))
    machine = found.design.machine
    with _drawing:
        return report_page(Findings(machine, dumps(machine), file), language)
