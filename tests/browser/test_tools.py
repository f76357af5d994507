"""A hand-held tool on the live page: side view, modes, numbers, figures before and after."""

from __future__ import annotations

import re

from playwright.sync_api import expect

from browser.live import FITS, Live

FLAT = """() => [...document.querySelectorAll(".tool-side > g:not(.pale):not(.stations) > path")]
    .map(one => one.getAttribute("d")).join("")"""
"""Outline of the shaft as it is drawn."""


def test_a_tool_is_seen_and_changed(live: Live) -> None:
    page = live.page
    page.get_by_role("combobox", name="Example").select_option("brush-cutter")
    side = page.get_by_role("img", name=re.compile("front-handle 550.0 mm"))
    expect(side).to_be_visible()
    menu = page.locator("details.menu")
    menu.locator("summary").click()
    names = ["Download model", "Download report", "Copy link"]  # nothing that would be refused
    expect(menu.locator("button:visible")).to_have_text(names)
    page.keyboard.press("Escape")
    shown = page.get_by_role("combobox", name="What is shown")
    expect(shown.locator("option")).to_have_count(6)  # at rest, at work, four modes
    expect(page.get_by_text("displacement drawn")).to_be_visible()
    shown.select_option(index=0)
    rest = page.evaluate(FLAT)
    shown.select_option(index=4)
    expect(page.get_by_text("displacement drawn")).to_be_hidden()
    assert page.evaluate(FLAT) != rest
    page.get_by_role("button", name="Play").click()
    swinging = page.evaluate(FLAT)
    page.wait_for_function(f"was => ({FLAT})() !== was", arg=swinging)
    live.type(live.field("shaft outer diameter"), "30 mm")
    row = page.get_by_role("row").filter(has_text="Mass of the tool")
    expect(row).to_contain_text("+10.8 %")
    expect(page.locator(".tool-side .pale")).to_have_count(1)
    live.type(live.field("shaft outer diameter"), "20 mm")
    expect(page.get_by_text("got 23 mm inside of 20 mm")).to_be_visible()
    live.field("shaft outer diameter").press("Escape")
    slider = page.get_by_role("slider", name="engine mass slider")
    slider.focus()
    for _ in range(5):
        slider.press("ArrowLeft")
    expect(live.field("engine mass")).not_to_have_value("3.6 kg")
    for width in (1280, 400):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_function(f"() => {FITS}")
        assert live.findings() == []
    page.set_viewport_size({"width": 1280, "height": 900})
    page.get_by_role("combobox", name="Example").select_option("yamashita-1")
    question = page.get_by_role("dialog", name="Question")
    expect(question).to_contain_text("discards the changes to brush-cutter")
    question.get_by_role("button", name="Open").click()
    expect(live.joint("B")).to_be_visible()
    expect(side).to_be_hidden()
    page.get_by_role("combobox", name="Example").select_option("pole-saw")
    expect(page.get_by_role("img", name=re.compile("front-grip"))).to_be_visible()
