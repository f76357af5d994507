"""docs/api.txt is what docs/api.py makes of the docstrings, with every public name."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

from unit.test_public_names import NAMES

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_fresh() -> None:
    page = runpy.run_path(str(DOCS / "api.py"))["page"]()
    assert page == (DOCS / "api.txt").read_text(encoding="utf-8"), "run python docs/api.py"
    matches = re.findall(r"(?m)^## (?:class )?[\w.]*\.(\w+)", page)
    assert {name.rpartition(".")[2] for name in NAMES} <= {*matches}
    assert len(matches) == len({*matches})
