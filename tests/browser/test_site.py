"""The documentation site, opened as files: search in three languages, and what all can read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from browser.live import FITS, Live
from browser.test_looks import SCHEMES, WIDTHS


@pytest.fixture
def page(browser: Browser, site: Path) -> Iterator[Page]:
    """A page that may read the site's files, and nothing else."""
    context = browser.new_context(reduced_motion="reduce")
    wrong: list[str] = []
    context.on("request", lambda sent: sent.url.startswith("file:") or wrong.append(sent.url))
    context.on("weberror", lambda error: wrong.append(str(error.error)))
    yield context.new_page()
    context.close()
    assert wrong == []


SOUGHT = {
    "counterweight": "Balancing",
    "カウンタウェイト": "最初の1時間",
    "固有振動": "最初の1時間",
    "균형추": "처음 한 시간",
}
"""Words, and a page on which each is found."""


def test_the_search_finds_a_word(page: Page, site: Path) -> None:
    """Typed into the box of the first page; backwards it is nowhere."""
    both = [(word, found, 1) for word, found in SOUGHT.items()]
    page.goto((site / "index.html").as_uri())
    for typed, found, pages in (*both, *((word[::-1], found, 0) for word, found, _ in both)):
        page.get_by_role("textbox", name="Search").fill(typed)
        page.keyboard.press("Enter")
        expect(page.get_by_role("heading", name="Search Results")).to_be_visible()
        links = page.locator("#search-results").get_by_role("link", name=found, exact=True)
        expect(links).to_have_count(pages)


KINDS = (
    "index.html",
    "first-machine.html",
    "displacement-matrices.html",
    "decay.html",
    "ko/examples.html",
    "api/equipoise.measured.html",
    "search.html?q=counterweight",
)


def test_a_page_of_each_kind(page: Page, site: Path) -> None:
    """Nothing serious is found by axe, and nothing has to be moved from side to side."""
    for name in KINDS:
        for width, scheme in zip(WIDTHS, SCHEMES, strict=True):
            page.set_viewport_size({"width": width, "height": 900})
            page.emulate_media(color_scheme=scheme)
            page.goto(f"{site.as_uri()}/{name}")
            assert page.evaluate(FITS), name
            assert Live(page).findings() == [], name
