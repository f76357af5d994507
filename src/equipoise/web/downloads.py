"""Files that a page can keep: the model, its signals, its report, pictures, a page that plays."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import LANGUAGES, speaking
from equipoise.mechanism.checks import unknown
from equipoise.schema.files import to_csv
from equipoise.schema.models import taken_along
from equipoise.web.edits import Computed
from equipoise.web.messages import Message
from equipoise.web.pictures import chart_of, drawing, film_of, linkage_at
from equipoise.web.played import played
from equipoise.web.replies import Reply

MIMES = {
    "toml": "application/toml",
    "csv": "text/csv",
    "html": "text/html",
    "gif": "image/gif",
    "svg": "image/svg+xml",
    "png": "image/png",
}
"""Type of a file by the end of its name."""
FORBIDDEN = re.compile(r'[\\/:*?"<>|]+')
"""What some system would not have in the name of a file."""


Replies = Callable[[str], Iterable[Reply]]
"""All that a page could be told of the design, in a language."""


def downloaded(
    computed: Computed, message: Message, replies: Replies
) -> tuple[dict[str, Any], bytes]:
    """Name and type of a file that a message asks for, and its bytes.

    The model comes with the texts of the tables that it names, by the names of their files.

    Raises
    ------
    UsageError : there is no such file or language.
    EquipoiseError : it cannot be made of this machine.
    """
    kind = message.text("kind")
    if kind not in (MODEL, *FILES, PLAYED):
        raise UsageError(unknown(kind, (MODEL, *FILES, PLAYED), "download"))
    options: dict[str, Any] = {}
    stem = FORBIDDEN.sub("-", computed.design.name.removesuffix(".toml")) or "machine"
    if kind == PLAYED:
        language = message.text("language", "en")
        end, data = "-played.html", played(computed, replies(language), language).encode()
    elif kind == MODEL:
        text, options["files"] = taken_along(computed.design.machine, f"{stem}.toml")
        end, data = ".toml", text.encode()
    else:
        end, data = FILES[kind](computed, message, stem)
    name = f"{stem}{end}"
    return {"name": name, "mime": MIMES[name.rpartition(".")[2]], **options}, data


NameAndBytes = tuple[str, bytes]
"""What follows the name of the machine in that of the file, and its bytes."""


def _csv(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return ".csv", to_csv(computed.analysis).encode()


def _report(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    from equipoise.present.composition import report_page
    from equipoise.present.findings import Findings

    language = message.text("language", "en")
    if language not in LANGUAGES:
        raise UsageError(unknown(language, LANGUAGES, "language of reports"))
    file, _ = taken_along(computed.design.machine, f"{stem}.toml")
    findings = Findings(computed.analysis.machine, file, f"{stem}.toml", swings=computed.swings)
    with drawing:
        text = report_page(findings, language)
    return "-report.html", text.encode()


def _film(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return ".gif", film_of(computed)


def _drawing(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return _rendered(linkage_at(computed, message.whole("at", 0)), "drawing", message)


def _chart(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    name, choice = message.text("chart"), message.text("choice", "")
    return _rendered(
        chart_of(computed, name, choice), choice if name == "output" else name, message
    )


def _rendered(picture: Any, name: str, message: Message) -> NameAndBytes:
    from equipoise.figures import render

    kind = message.text("format", "svg")
    if kind not in ("svg", "png"):
        raise UsageError(unknown(kind, ("svg", "png"), "format of pictures"))
    with drawing:
        data = render(picture, "png" if kind == "png" else "svg")
    return f"-{FORBIDDEN.sub('-', name.replace('.', '-'))}.{kind}", data


def _interactive(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    from equipoise.exchange.formats import Job
    from equipoise.web.interactive import export_bytes

    language = message.text("language", "en")
    if language not in LANGUAGES:
        raise UsageError(unknown(language, LANGUAGES, "language of pages"))
    with speaking(language):
        return "-interactive.html", export_bytes(Job(computed.analysis.machine)).encode()


FILES: dict[str, Callable[[Computed, Message, str], NameAndBytes]] = {
    "csv": _csv,
    "report": _report,
    "drawing": _drawing,
    "chart": _chart,
    "film": _film,
    "interactive": _interactive,
}
"""What there is."""
MODEL = "model"
"""Besides, the model with its tables."""
PLAYED = "played"
"""And a page in one file."""
