"""The documentation beside the live page: tutorials that run there, pages that errors lead to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page, expect

from browser.live import LONGEST, Live
from equipoise.web.site import write_site
from support.host import RUNTIME, WHEELS, hosting, lacks_runtime

IMPOSSIBLE = "200 mm"
"""A length of the crank with which it cannot turn."""


@pytest.fixture(scope="module")
def beside(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a site with the live page and the documentation."""
    if lacks_runtime():
        pytest.skip("the runtime and its wheels could not be fetched: make test fetches them")
    folder = tmp_path_factory.mktemp("beside") / "site"
    write_site(folder, RUNTIME, WHEELS, docs=site)
    with hosting(folder) as address:
        yield address


@pytest.mark.exhaustive
def test_a_cell_is_changed_and_run_in_the_page(context: BrowserContext, beside: str) -> None:
    """With all above it, by Python in the page; what fails leads to the page of its error."""
    page = context.new_page()
    page.goto(f"{beside}docs/tutorials/analyse-a-machine.html")
    cells = page.locator(".cell")
    changed = cells.nth(4)
    lines = ("lighter = eq.analyze(machine.with_link('coupler', mass=0.5))",
             "print(round(lighter.summary['shaking_force'].peak, 2))")  # fmt: skip
    changed.locator("pre").first.fill("\n".join(lines))
    changed.get_by_role("button", name="Run").click()
    expect(changed.locator(".cell-text")).to_have_text("16.74\n", timeout=LONGEST * 1000)
    expect(cells.nth(2).locator(".cell-text")).to_contain_text("peak 23.22 N at 261 deg")
    fails = cells.nth(6)
    fails.get_by_role("button", name="Run").click()
    expect(fails.locator(".cell-error")).to_contain_text("RangeError: the crank cannot turn fully")
    expect(fails.get_by_role("button", name="Run")).to_be_enabled()
    fails.get_by_role("link", name="What to do about it").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("The crank cannot turn fully")
    page.close()


@pytest.mark.exhaustive
def test_cells_have_no_buttons_in_a_file(context: BrowserContext, site: Path) -> None:
    """Where no Python is beside them; the notebook can be loaded, and errors have their link."""
    page = context.new_page()
    page.goto((site / "tutorials" / "analyse-a-machine.html").as_uri())
    expect(page.locator(".cell-outputs").first).to_be_visible()
    assert page.get_by_role("button", name="Run").count() == 0
    link = page.get_by_role("link", name="Download this notebook").get_attribute("href")
    assert link is not None and (site / "tutorials" / link).is_file()
    page.get_by_role("link", name="What to do about it").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("The crank cannot turn fully")
    page.close()


HELP = """() => document.head.insertAdjacentHTML(
    "beforeend", '<link rel="help" href="https://docs.example/index.html">')"""
"""What a site has whose documentation lies beside the live page."""


@pytest.mark.exhaustive
def test_an_error_on_the_live_page_leads_to_its_page(
    new_page: Callable[..., Page], address: str
) -> None:
    """Its text in a dialog, as in a notebook, or the documentation where that is there."""
    live = Live.open(new_page(), address)
    live.type(live.field("crank A to B"), IMPOSSIBLE)
    live.button("What to do about it").first.click()
    dialog = live.page.get_by_role("dialog", name="The crank cannot turn fully")
    expect(dialog).to_contain_text("motion = { between")
    assert live.findings() == []
    dialog.get_by_role("button", name="Close").click()
    expect(dialog).to_have_count(0)
    live.page.evaluate(HELP)
    live.type(live.field("crank A to B"), "201 mm")
    link = live.page.get_by_role("link", name="What to do about it").first
    where = "https://docs.example/explain/the-crank-cannot-turn-fully.html"
    expect(link).to_have_attribute("href", where)
