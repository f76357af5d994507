"""Who opens the page for the first time: what there is, what it is for, where things are."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

import equipoise as eq
from browser.live import FITS, LONGEST, SCREENSHOTS, Live
from support.chromium import serving

STEPS = ("Drag a joint", "Turn the crank", "Press Balance", "See the reduction", "Share it")


def test_an_empty_page_shows_what_there_is_to_open(free_page: Page) -> None:
    page = free_page
    page.set_viewport_size({"width": 400, "height": 800})
    with serving() as address:
        page.goto(address)
        gallery = page.get_by_role("dialog", name="Open a machine")
        expect(gallery).to_contain_text("how a linkage moves")
        cards = gallery.locator(".card")
        expect(cards).to_have_count(len(eq.examples("linkage")))
        expect(gallery.get_by_text("Drawing the examples")).to_be_hidden()
        page.screenshot(path=SCREENSHOTS / "gallery-400.png")
        page.set_viewport_size({"width": 1280, "height": 900})
        page.screenshot(path=SCREENSHOTS / "gallery-1280.png")
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
            assert Live(page).findings() == []
        gallery.get_by_role("searchbox").fill("quick lever ram")  # in title and description
        expect(cards.filter(visible=True)).to_have_count(1)
        cards.filter(visible=True).press("Enter")
        expect(page.get_by_role("heading", name=eq.load("quick-return").title)).to_be_visible()
        expect(gallery).to_be_hidden()


@pytest.mark.exhaustive
def test_the_tour_is_taken_by_keyboard_alone(new_page: Callable[..., Page], address: str) -> None:
    live = Live.open(new_page(viewport={"width": 400, "height": 800}), address)
    page, keyboard = live.page, live.page.keyboard
    offer = page.get_by_role("button", name="Take the tour")
    expect(offer).to_be_visible()
    offer.focus()
    keyboard.press("Enter")
    tour = page.get_by_role("dialog", name="Tour")
    for number, step in enumerate(STEPS):
        expect(tour).to_contain_text(f"{step} · {number + 1} of {len(STEPS)}")
        assert page.locator(".toured").count() == (0 if step == STEPS[3] else 1)  # no balance yet
        if number == 0:
            assert page.evaluate(FITS) and live.findings() == []
        keyboard.press("Enter")
    expect(tour).to_be_hidden()
    page.reload()
    expect(live.joint("B")).to_be_visible()
    expect(offer).to_be_hidden()
    keyboard.press("?")
    page.get_by_role("dialog", name="Keys").get_by_role("button", name="Take the tour").press(
        "Enter"
    )
    expect(tour).to_contain_text(STEPS[0])
    keyboard.press("ArrowRight")
    expect(tour).to_contain_text(STEPS[1])
    keyboard.press("ArrowLeft")
    expect(tour).to_contain_text(STEPS[0])
    keyboard.press("Escape")
    expect(tour).to_be_hidden()


def test_the_tour_lets_one_drag_balance_and_share(
    new_page: Callable[..., Page], address: str
) -> None:
    """Each step goes on by itself once its thing is done."""
    live = Live.open(new_page(viewport={"width": 1280, "height": 900}), address)
    page = live.page
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Take the tour").click()
    tour = page.get_by_role("dialog", name="Tour")
    live.drag(live.joint("P"), (-12, 9))
    expect(tour).to_contain_text(STEPS[1])
    page.get_by_role("button", name="Play").click()
    expect(tour).to_contain_text(STEPS[2])
    page.screenshot(path=SCREENSHOTS / "tour-1280.png")
    page.get_by_role("button", name="Balance", exact=True).click()
    # A worker loads SciPy first, in a second Python.
    expect(tour).to_contain_text(STEPS[3], timeout=2 * LONGEST * 1000)
    expect(tour).to_contain_text(re.compile(r"Shaking force.*: [\d.]+ → [\d.]+ N"))
    expect(page.locator(".toured")).to_have_attribute("aria-label", "Balancing")
    page.screenshot(path=SCREENSHOTS / "tour-balanced-1280.png")
    page.get_by_role("button", name="Keep", exact=True).click()
    expect(tour).to_contain_text(STEPS[4])
    page.get_by_label("Download", exact=True).click()
    page.get_by_role("button", name="Copy link").click()
    expect(tour).to_be_hidden()
    expect(page.get_by_text("The link is copied").first).to_be_visible()


@pytest.mark.exhaustive
def test_two_fingers_zoom_and_pan(new_page: Callable[..., Page], address: str) -> None:
    live = Live.open(new_page(has_touch=True), address)
    line = live.page.context.new_cdp_session(live.page)
    before = [live.spot(live.joint(name)) for name in "AD"]
    board = live.page.locator(".board").first.bounding_box()
    assert board
    x, y = board["x"] + 60, board["y"] + board["height"] - 90

    def touch(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": a, "y": b, "id": i} for i, (a, b) in enumerate(places)]
        line.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (x, y))
    touch("touchStart", (x, y), (x + 50, y))
    for step in range(1, 11):  # apart to twice the distance, and both 30 px up
        touch("touchMove", (x - 2.5 * step, y - 3 * step), (x + 50 + 2.5 * step, y - 3 * step))
    touch("touchEnd")
    after = [live.spot(live.joint(name)) for name in "AD"]
    apart = [abs(complex(*item[0]) - complex(*item[1])) for item in (before, after)]
    assert abs(apart[1] / apart[0] - 2) < 0.1
    fixed = complex(x + 25, y)
    moved = complex(*after[0]) - (fixed - 30j + 2 * (complex(*before[0]) - fixed))
    assert abs(moved) < 8
    expect(live.button("Undo")).to_be_disabled()


@pytest.mark.exhaustive
def test_an_edit_while_examples_are_drawn_is_reported_to_its_end(live: Live) -> None:
    live.page.get_by_role("button", name="Open", exact=True).click()
    expect(live.page.get_by_role("dialog", name="Open a machine")).to_be_visible()
    live.page.keyboard.press("Escape")
    live.joint("B").press("ArrowRight")
    live.settled()
    assert not live.button("Undo").is_disabled()
    live.button("Undo").click()
    live.joint("B").press("ArrowRight")  # answered long before the key has rested
    live.settled()
    assert not live.button("Undo").is_disabled()
