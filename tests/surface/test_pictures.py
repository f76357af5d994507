"""The pictures of README and other pages: small, and of the product as it is."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import pytest

import equipoise as eq

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "pictures"
MAKE = runpy.run_path(str(PICTURES / "make.py"))
STALE = "stale; run `make pictures`"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_pages_show_all_of_them_and_they_are_small() -> None:
    """README those that it begins with."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    pages = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").glob("*.md"))
    shown = {*re.findall(r"\]\(pictures/([\w.]+)\)", pages)}
    shown |= {*re.findall(r"docs/pictures/([\w.]+)", readme)}
    there = {file.name for file in PICTURES.iterdir() if file.suffix in (".svg", ".png")}
    assert shown == there
    assert sum((PICTURES / name).stat().st_size for name in there) < 1_000_000


HOW_TO = re.compile(r"^## How to\n(.*?)^## ", re.MULTILINE | re.DOTALL)
WITHOUT = {"../src/equipoise/errors.md"}
"""A page of sentences, which are of no one machine."""


def test_every_page_on_how_to_do_something_has_a_picture() -> None:
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    listed = re.findall(r"\(([\w./]+\.md)\)", HOW_TO.findall(index)[0])
    assert len(listed) > 12 and {*listed} >= WITHOUT
    pages = {name: (ROOT / "docs" / name).read_text(encoding="utf-8") for name in listed}
    assert [name for name, text in pages.items() if "![" not in text] == [*WITHOUT]


IN_PYTHON_ALONE = {"python.md", "programs.md"}
"""A page on Python, and one on servers."""


def test_every_page_on_how_to_do_something_has_a_command_and_the_same_in_python() -> None:
    """Which stand side by side on the site."""
    site = runpy.run_path(str(ROOT / "docs" / "site" / "make.py"))
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    listed = {*re.findall(r"\(([\w./]+\.md)\)", HOW_TO.findall(index)[0])} - WITHOUT
    pages = {name: (ROOT / "docs" / name).read_text(encoding="utf-8") for name in listed}
    alone = {name for name, text in pages.items() if not site["TWO_WAYS"].search(text)}
    assert alone == IN_PYTHON_ALONE


def test_every_recipe_has_a_picture_and_is_reported_in_python_too() -> None:
    """With the lines of the file, or the command, before them."""
    text = (ROOT / "docs" / "recipes.md").read_text(encoding="utf-8")
    recipes = text.split("\n## ")[1:]
    assert len(recipes) > 12
    for recipe in recipes:
        blocks = re.findall(r"^```(\w+)$", recipe, re.MULTILINE)
        assert "](/" in recipe and "python" in blocks, recipe[:40]
        assert blocks[0] in ("toml", "console", "bash"), recipe[:40]


def test_readme_is_short_and_begins_with_what_balancing_gains() -> None:
    """Its numbers are those of the result."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 120
    result = eq.balance(eq.load(MAKE["BALANCED"]))
    ((before, after),) = result.objectives.values()
    (change,) = result.to_dict()["changes"]
    mass = round(1e3 * change["mass"])
    assert f"a counterweight of {mass} g on the crank" in text
    share = 100 * (1 - after / before)
    assert f"reduces the vertical force (RMS) of a rice planter by {share:.0f} %" in text
    steps = ("balanced.svg", "linkage.svg", "pip install", "open the live page", "## An example")
    places = [text.index(step) for step in steps]
    assert places == sorted(places)


@pytest.mark.exhaustive(but=["linkage"])
@pytest.mark.parametrize("name", ["linkage", "balanced"])
def test_drawings_are_as_they_would_be_now(name: str) -> None:
    """The same text, and the same numbers but for the last digit, which processors round."""
    kept = (PICTURES / f"{name}.svg").read_text(encoding="utf-8")
    fresh = MAKE[name]()
    assert NUMBER.sub("#", kept) == NUMBER.sub("#", fresh), STALE
    numbers = ([float(n) for n in NUMBER.findall(text)] for text in (kept, fresh))
    assert next(numbers) == pytest.approx(next(numbers), abs=0.11, rel=1e-3), STALE


# A page that has changed: tests/browser; drawings are compared below.
@pytest.mark.exhaustive
def test_screenshots_are_of_what_there_is() -> None:
    kept = json.loads((PICTURES / "sources.json").read_text(encoding="utf-8"))
    assert kept == MAKE["sources"](), STALE
