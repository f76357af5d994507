"""The command `report`."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from support.chosen import few
from surface.running import equipoise, example_text, succeeded


def test_a_page_and_a_pdf() -> None:
    page = Path("yoke.html")
    done = equipoise("report", "scotch-yoke", "-o", page, "--pdf", "--speed", "100 rpm")
    assert done.status == 0 and done.out == ""
    texts = [line for line in done.err.splitlines() if not line.startswith("note: no font has")]
    assert texts == [f"wrote {page}", f"wrote {page.with_suffix('.pdf')}"]
    text = page.read_text(encoding="utf-8")
    assert "driven at 100.0\xa0rpm" in text
    assert "equipoise report scotch-yoke --speed &#39;100 rpm&#39;" in text
    assert page.with_suffix(".pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are Unicode elsewhere")
@pytest.mark.parametrize("name", few(["scotch-yoke", "pole-saw"], {"pole-saw"}))
def test_of_a_file_whose_name_is_no_text(name: str) -> None:
    Path("a\udcffb.toml").write_text(example_text(name), encoding="utf-8")
    assert succeeded(equipoise("report", "a\udcffb.toml", "-o", "x.html")) == ""
    text = Path("x.html").read_text(encoding="utf-8")
    assert "equipoise report &#39;a\\udcffb.toml&#39;" in text
    assert "from a\\udcffb.toml<" in text
