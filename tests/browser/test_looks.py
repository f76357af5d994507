"""What everyone can read: findings of axe, narrow screens, dark screens; page and report."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

import equipoise as eq
from browser.live import FITS, SCREENSHOTS, Live
from equipoise.present.composition import report_page
from support.chosen import few, few_together
from support.findings import findings_of
from surface.running import equipoise, succeeded

WIDTHS = (1280, 400)
SCHEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")


TOPS = "() => [...document.querySelectorAll('#forces figure')].map(one => one.offsetTop)"
"""Where the pictures of the forces begin."""

CLIPPED = """() => [...document.querySelectorAll(".equipoise *:not(.unseen)")]
    .filter((part) => part.checkVisibility() && part.clientWidth)
    .filter((part) => part.matches("input") || getComputedStyle(part).overflowX !== "visible")
    .filter((part) => part.scrollWidth > part.clientWidth + 1)
    .map((part) => part.outerHTML.slice(0, 200))"""
"""What holds more than it shows."""


def brightness(seen: Page | Locator) -> float:
    """Return how bright a page, or a part of it, is as it is seen, 0 to 255."""
    return float(np.mean(Image.open(io.BytesIO(seen.screenshot())).convert("L")))


@pytest.mark.parametrize("schemes", few([SCHEMES, SCHEMES[::-1]], {SCHEMES}), ids="-".join)
def test_the_page(live: Live, schemes: tuple[Literal["light", "dark"], ...]) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("balance-crank")
    live.button("Balance").click()
    expect(live.button("Take back")).to_be_visible()
    for width, scheme in zip(WIDTHS, schemes, strict=True):
        live.page.set_viewport_size({"width": width, "height": 900})
        live.settled()
        live.page.emulate_media(color_scheme=scheme)
        live.page.screenshot(path=SCREENSHOTS / f"page-{width}-{scheme}.png", full_page=True)
        assert live.page.evaluate(FITS)
        assert live.page.evaluate(CLIPPED) == []
        assert (brightness(live.page) > 128) == (scheme == "light")
        assert live.findings() == []


@pytest.mark.exhaustive
def test_a_sign_of_waiting_stands_still_where_less_motion_is_wanted(live: Live) -> None:
    """A bar at the upper edge, which runs to and fro for everybody else."""
    moving = """() => ["data-waiting", "data-busy"].map((sign) => {
        const part = document.querySelector(sign === "data-busy" ? ".bar" : ".equipoise");
        part.toggleAttribute(sign, true);
        const bar = document.querySelector(".bar");
        const { width } = getComputedStyle(bar, "::after");
        const whole = parseFloat(width) > 0.9 * bar.clientWidth;
        const running = bar.getAnimations({ subtree: true }).length;
        part.toggleAttribute(sign, false);
        return [running, whole];
    })"""
    assert live.page.evaluate(moving) == [[0, True], [0, True]]
    live.page.emulate_media(reduced_motion="no-preference")
    assert live.page.evaluate(moving) == [[1, False], [1, False]]


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("width", "height"),
    few_together([(600, 900), (400, 900), (400, 420), (1280, 380)], {(400, 420)}),
)
def test_the_menu_of_downloads_is_seen_whole(live: Live, width: int, height: int) -> None:
    """Or it scrolls, where the window is too low for all of it."""
    live.page.set_viewport_size({"width": width, "height": height})
    live.page.get_by_title("Download", exact=True).click()
    box = live.page.locator(".menu .sheet").bounding_box()
    assert box and box["x"] >= 0 and box["x"] + box["width"] <= width
    last = live.button("Copy link")
    last.scroll_into_view_if_needed()
    seen = last.bounding_box()
    assert seen and seen["y"] + seen["height"] <= height
    live.page.screenshot(path=SCREENSHOTS / f"menu-{width}-{height}.png")


@pytest.mark.exhaustive
def test_a_side_view_is_as_dark_as_the_page(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("twin-engine")
    across = live.page.get_by_role("img", name="The planes of links")
    for width, scheme in zip(WIDTHS, SCHEMES, strict=True):
        live.page.set_viewport_size({"width": width, "height": 900})
        live.page.emulate_media(color_scheme=scheme)
        expect(across).to_be_visible()
        live.settled()
        assert live.page.evaluate(CLIPPED) == []
        assert (brightness(across) > 128) == (scheme == "light")


A_REMEDY, NOTHING = "kim-chung-c", "yamashita-1"
"""What reports advise."""


@pytest.mark.parametrize("name", few([A_REMEDY, NOTHING], {NOTHING}))
def test_a_report(name: str, new_page: Callable[..., Page], tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    succeeded(equipoise("report", name, "-o", path))
    page = new_page()
    page.set_content(path.read_text(encoding="utf-8"))
    for width, scheme in zip(WIDTHS, SCHEMES, strict=True):
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        page.screenshot(path=SCREENSHOTS / f"report-{width}-{scheme}.png", full_page=True)
        assert page.evaluate(FITS)
        assert (brightness(page) > 128) == (scheme == "light")
        assert Live(page).findings() == []
        tops = page.evaluate(TOPS)
        assert (tops[0] == tops[1]) == (width == max(WIDTHS))  # in pairs, or one below the other
    part = "#more-balance" if name == A_REMEDY else "#more-forces"
    appendix = page.locator(f"{part} table").last
    expect(appendix).not_to_be_visible()
    page.emulate_media(media="print")
    expect(appendix).to_be_visible()
    page.emulate_media(media="screen")
    page.locator(f"a[href='{part}']").click()
    expect(appendix).to_be_visible()


PARTS = """() => [document.querySelector("#appendix").offsetTop,
    document.documentElement.scrollHeight]"""
"""Where the appendix begins, and where the page ends."""


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "name",
    few(
        (*eq.examples("linkage"), *eq.examples("tool")),
        {"straw-walker"},
    ),
)
def test_reports_are_short_and_fit(name: str, new_page: Callable[..., Page]) -> None:
    """What stands before the appendix is less than half of the page; no table is to be moved from
    side to side, and the machine is on the first screen.
    """
    page = new_page()
    page.set_content(report_page(findings_of(name)))
    for width in (1280, 400):
        page.set_viewport_size({"width": width, "height": 900})
        page.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
        assert page.evaluate(FITS)
        main, whole = page.evaluate(PARTS)
        assert width == 400 or main < whole / 2
        wide = page.locator(".scroll:has(table)").evaluate_all(
            "all => all.filter(one => one.scrollWidth > one.clientWidth + 1).length"
        )
        assert wide == 0
        ends = page.locator(".drawings svg:visible").evaluate_all(
            "all => all.map(one => one.getBoundingClientRect().right)"
        )
        assert len(ends) > 3 and max(ends) <= width
        machine = page.locator(".animation").bounding_box()
        assert machine is not None and machine["y"] < 900


@pytest.mark.exhaustive
def test_drawings_of_a_tool_are_seen_whole(new_page: Callable[..., Page], tmp_path: Path) -> None:
    """On a narrow screen too; none is to be moved from side to side."""
    path = tmp_path / "report.html"
    succeeded(equipoise("report", "brush-cutter", "-o", path))
    page = new_page(viewport={"width": 400, "height": 900})
    page.set_content(path.read_text(encoding="utf-8"))
    ends = page.locator("main > section > .drawings svg").evaluate_all(
        "all => all.map(one => one.getBoundingClientRect().right)"
    )
    assert len(ends) > 3 and max(ends) <= 400
