"""The command `report`."""

from __future__ import annotations

import os
import shlex
import sys
from typing import Annotated, Literal

from equipoise.cli.app import FILE, OUT, SIGNED, app
from equipoise.cli.options import check_result_file, naming, quantity
from equipoise.errors import UsageError

Language = Literal["en", "ja", "ko"]
"""As in `words`."""


@app.command
def report(
    file: Annotated[str, FILE],
    /,
    *,
    out: Annotated[str | None, OUT] = None,
    language: Language = "en",
    pdf: bool = False,
    speed: Annotated[str | None, SIGNED] = None,
) -> None:
    """One page that tells all of a linkage or a tool: summary, pictures, tables, before and after.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    out
        Name of the report, which ends in .html or .pdf; NAME-report.html beside you if not given.
    language
        English, Japanese or Korean.
    pdf
        Write a PDF beside the page too.
    speed
        Speed of the crank, or of the tool's engine, instead of the file's, such as "250 rpm".
    """
    paths = _paths(file, out, pdf)
    rate = None if speed is None else quantity("--speed", speed, "angular speed")
    from equipoise.present.composition import check, write_document
    from equipoise.schema.files import printable

    check(paths, language)
    from equipoise.present.composition import build
    from equipoise.present.findings import find

    found = find(file, speed=rate)
    with naming(file):
        document = build(found, language, _command(file, language, speed), together=True)
    write_document(document, paths)
    for path in paths:
        print(f"wrote {printable(path)}", file=sys.stderr)


def _paths(file: str, out: str | None, pdf: bool) -> list[str]:
    """The files that are wanted."""
    from equipoise.present.composition import kind_of

    if out is None:
        out = f"{os.path.basename(file).removesuffix('.toml')}-report.html"
    try:
        kind = kind_of(out)
    except UsageError as error:
        raise UsageError(f"--out: {error}") from error
    also = [f"{os.path.splitext(out)[0]}.pdf"] if pdf and kind == "html" else []
    for path in (out, *also):
        check_result_file("--out", path, [file])
    return [out, *also]


def _command(file: str, language: str, speed: str | None) -> str:
    """The command as it can be given again, wherever the report goes."""
    words = ["equipoise", "report", os.path.basename(file)]
    words += [] if language == "en" else ["--language", language]
    return shlex.join([*words, *([] if speed is None else ["--speed", speed])])
