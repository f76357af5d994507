"""The command `report`, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import equipoise, refused


def test_a_page_and_a_pdf(tmp_path: Path) -> None:
    page = tmp_path / "yoke.html"
    done = equipoise("report", "scotch-yoke", "-o", page, "--pdf", "--speed", "100 rpm")
    assert done.status == 0 and done.out == ""
    assert done.err.splitlines() == [f"wrote {page}", f"wrote {page.with_suffix('.pdf')}"]
    text = page.read_text(encoding="utf-8")
    assert "driven at 100.0\xa0rpm" in text
    assert "equipoise report scotch-yoke --speed &#39;100 rpm&#39;" in text
    assert page.with_suffix(".pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["scotch-yoke", "-o", "report.docx"],
            "--out: got 'report.docx'; give a name that",
        ),
        (["scotch-yoke", "-o", "no/report.html"], "no/report.html: there is no such folder"),
        (["scotch-yoke", "--language", "fr"], '"en", "ja", "ko"'),
        (["study-of-lengths"], "this is a study"),
        (["nosuch"], "nosuch: there is no such file"),
    ],
)
def test_what_is_refused(words: list[str], said: str) -> None:
    assert said in refused(equipoise("report", *words))
