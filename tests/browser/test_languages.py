"""The page in the language of its reader."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from browser.live import FITS, Live
from equipoise.i18n import catalogue, say, speaking


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


OPENED = (
    "drag-link",
    "class-three",
    "balance-spring",
    "yamashita-2",
    "planetary-planting-arm",
    "cam-pusher",
)


@pytest.mark.exhaustive
def test_korean_particles_go_by_the_name_before_them(
    new_page: Callable[..., Page], address: str
) -> None:
    """As they do where Python says the sentence; and keys are called as they are labelled."""
    page, ko = new_page(locale="ko-KR"), catalogue("ko")
    live = Live.open(page, address)
    live.drag(page.locator("[data-kind=point][data-name=B]"), (12, 0))
    asked = page.get_by_role("dialog").filter(has_text="yamashita-1")
    for name in OPENED:
        page.get_by_role("combobox", name=ko["Example"]).select_option(name)
        with speaking("ko"):
            reported = say(
                "Opening {name} discards the changes to {machine} and everything that can be "
                "undone.",
                name=name,
                machine="yamashita-1",
            )
        assert "(" not in reported
        expect(asked).to_contain_text(reported)
        asked.get_by_role("button", name=ko["Cancel"]).click()
    page.keyboard.press("?")
    keys = page.get_by_role("dialog", name=ko["Keys"]).locator("kbd").all_inner_texts()
    assert "Delete" in keys and ko["Delete"] not in keys


@pytest.mark.exhaustive
def test_a_loader_has_cycles_and_no_crank_angles(live: Live) -> None:
    """What the page itself says goes by the machine that is open, and back again."""
    page = live.page
    finder = page.locator(".finder input").last
    expect(finder).to_have_attribute("aria-label", "Any output over crank angle")
    for name, called in (
        ("hydraulic-loader", "Any output over the cycle"),
        ("yamashita-1", "Any output over crank angle"),
    ):
        page.get_by_role("combobox", name="Example").select_option(name)
        live.settled()
        expect(page.get_by_role("combobox", name=called)).to_be_visible()
        why = page.get_by_role("button", name="Shaking force, polar: what does it show?")
        why.click()
        shown = page.locator(".explained:visible p").first
        expect(shown).to_contain_text("cycle" if "cycle" in called else "crank")
        why.click()
