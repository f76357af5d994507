"""The page in the language of its reader."""

from __future__ import annotations

from collections.abc import Callable

from playwright.sync_api import Page, expect

from browser.live import FITS, Live
from equipoise.i18n import catalogue


def test_the_browser_s_language_is_spoken_until_another_is_chosen(
    new_page: Callable[..., Page], address: str
) -> None:
    """The choice stays when the page is loaded again; what was done stays too."""
    page = new_page(locale="ja-JP", viewport={"width": 400, "height": 900})
    live = Live.open(page, address)
    ja, ko = catalogue("ja"), catalogue("ko")
    assert page.evaluate("document.documentElement.lang") == "ja"
    expect(page.get_by_role("button", name=ja["Undo"])).to_be_visible()
    expect(page.get_by_role("rowheader", name=ja["Shaking force"], exact=True)).to_be_visible()
    assert page.evaluate(FITS)
    assert live.findings() == []
    page.get_by_role("combobox", name=ja["Language"], exact=True).select_option("ko")
    expect(page.get_by_role("button", name=ko["Undo"])).to_be_visible()
    assert page.evaluate(FITS)
    page.reload()
    expect(page.get_by_role("rowheader", name=ko["Shaking force"], exact=True)).to_be_visible()
    assert page.evaluate("document.documentElement.lang") == "ko"
