"""The pages of tutorials: each cell with what it gives, and a notebook that can be loaded."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from equipoise.schema.topics import errors, tables

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "tutorials").glob("*.ipynb"))


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_tutorial_is_a_page_with_what_its_cells_give(site: Path, file: Path) -> None:
    """The notebook in the repository has no outputs, so that none can be out of date."""
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] for cell in code)
    text = (site / "tutorials" / f"{file.stem}.html").read_text(encoding="utf-8")
    outputs = re.findall(r'<div class="cell-outputs" aria-live="polite">(.)', text)
    assert outputs == ["<"] * len(code)
    assert text.count('class="run-cell" hidden') == len(code)
    loaded = json.loads((site / "tutorials" / file.name).read_text(encoding="utf-8"))
    assert all(cell["outputs"] for cell in loaded["cells"] if cell["cell_type"] == "code")


def test_every_topic_has_an_address_that_leads_to_its_page(site: Path) -> None:
    """Which is a page of the site."""
    for topic in (*errors(), *tables()):
        text = (site / "explain" / f"{topic}.html").read_text(encoding="utf-8")
        page = re.findall(r'url=([^"]+)"', text)[0]
        target = (site / "explain" / page).resolve()
        assert target.is_file(), topic
        if topic in errors():
            assert f"<h1>{errors()[topic].title}<" in target.read_text(encoding="utf-8")
