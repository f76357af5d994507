"""The command `report`."""

from __future__ import annotations

from pathlib import Path

from surface.running import equipoise


def test_a_page_and_a_pdf() -> None:
    page = Path("yoke.html")
    done = equipoise("report", "scotch-yoke", "-o", page, "--pdf", "--speed", "100 rpm")
    assert done.status == 0 and done.out == ""
    assert done.err.splitlines() == [f"wrote {page}", f"wrote {page.with_suffix('.pdf')}"]
    text = page.read_text(encoding="utf-8")
    assert "driven at 100.0\xa0rpm" in text
    assert "equipoise report scotch-yoke --speed &#39;100 rpm&#39;" in text
    assert page.with_suffix(".pdf").read_bytes().startswith(b"%PDF")
