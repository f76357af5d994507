"""From a model file to a report on disk."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

from equipoise.errors import UsageError
from equipoise.i18n import LANGUAGES

if TYPE_CHECKING:
    from equipoise.report.document import Document

KINDS = {".html": "html", ".htm": "html", ".pdf": "pdf"}


def kind_of(out: str | os.PathLike[str]) -> str:
    """What a report becomes, by the end of its name: ``html`` or ``pdf``."""
    _, end = os.path.splitext(out)
    if end.lower() not in KINDS:
        raise UsageError(f"got {os.fspath(out)!r}; give a name that ends in .html or .pdf")
    return KINDS[end.lower()]


def report(
    path_or_name: str | os.PathLike[str],
    *outs: str | os.PathLike[str],
    language: str = "en",
    speed: float | None = None,
    command: str = "",
) -> None:
    """Write a report of a model file, or of a bundled example by its name.

    Parameters
    ----------
    outs : files to write, pages as ``.html`` or PDF as ``.pdf`` by the ends of their names.
    language : ``en``, ``ja`` or ``ko``.
    speed : of the crank, or of the tool's engine, rad/s; the file's where not given.
    command : that makes the report again, told at its end.

    Raises
    ------
    ModelError, MobilityError, MotionError : the file is wrong, or its linkage cannot turn.
    UsageError : a file cannot be written, there is no such language, or no font for it.
    EquipoiseError : a PDF is wanted, and Typst is not installed.
    """
    check(outs, language)
    from equipoise.report.build import build
    from equipoise.report.findings import find

    found = find(path_or_name, speed=speed)
    write_document(build(found, language, command, together=True), outs)


def check(outs: Iterable[str | os.PathLike[str]], language: str) -> None:
    """Tell what is wrong with these names, or missing, before anything is computed."""
    if language not in LANGUAGES:
        raise UsageError(f"language: got {language!r}; give one of {', '.join(LANGUAGES)}")
    if "pdf" in {kind_of(out) for out in outs}:
        from equipoise.report.pdf import check_pdf

        check_pdf(language)


def write_document(document: Document, outs: Iterable[str | os.PathLike[str]]) -> None:
    """Write a document as each of these files."""
    for out in outs:
        if kind_of(out) == "pdf":
            from equipoise.report.pdf import pdf

            _write(out, pdf(document))
        else:
            from equipoise.report.page import page

            _write(out, page(document).encode())


def _write(out: str | os.PathLike[str], data: bytes) -> None:
    from equipoise.schema.output import write_all

    write_all(os.path.dirname(out) or ".", {os.path.basename(out): data})
