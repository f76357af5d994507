"""Charts of the live page: numbers on their axes, and any output that is looked for."""

from __future__ import annotations

import re

import numpy as np
from playwright.sync_api import expect

import equipoise as eq
from browser.live import Live

SHOWN = "yamashita-rig", "class-three", "transplanter", "stephenson-six-bar", "watt-six-bar"
AXES = """() => {
    const box = (one) => one.getBoundingClientRect();
    const apart = (all) => all.every((one, i) => all.slice(i + 1).every((other) =>
        box(one).right <= box(other).left + 1 || box(other).right <= box(one).left + 1 ||
        box(one).bottom <= box(other).top + 4 || box(other).bottom <= box(one).top + 4));
    return [...document.querySelectorAll(".charts figure")].flatMap((figure) => {
        if (!figure.checkVisibility() || !figure.querySelector(".canvas, .plane")) return [];
        const all = (selector) => [...figure.querySelectorAll(selector)];
        const polar = figure.ariaLabel.includes("polar");
        const across = figure.querySelector(".plane")
            ? all(".texts text[text-anchor=middle]:not(.crank)") : all(".numbers .x");
        const up = figure.querySelector(".plane")
            ? all(".texts text[text-anchor=start]") : all(".numbers .y");
        const axes = polar ? [across] : across.length || figure.querySelector(".plane")
            ? [across, up] : [up];
        return axes.map((texts) => [figure.ariaLabel, texts.length, apart(texts)]);
    });
}"""
"""Of each axis of each chart: whose it is, how many numbers it has, whether they stand apart."""
CLIPPED = """() => [...document.querySelectorAll(".charts figcaption")]
    .filter((one) => one.checkVisibility() && one.scrollWidth > one.clientWidth)
    .map((one) => one.innerText)"""
"""Headings of charts for which there is no room."""


def test_every_axis_has_three_numbers(live: Live) -> None:
    for name in SHOWN:
        live.page.get_by_role("combobox", name="Example").select_option(name)
        expect(live.page.get_by_role("heading", name=eq.load(name).title)).to_be_visible()
        if eq.load(name).support is not None:
            expect(live.page.get_by_text("against speed").first).to_be_visible()
        else:  # nor those of the machine before
            expect(live.page.get_by_text("against speed").first).to_be_hidden()
        for width in (400, 1280):
            live.page.set_viewport_size({"width": width, "height": 900})
            live.settled()
            live.page.wait_for_timeout(100)
            axes = live.page.evaluate(AXES)
            assert len(axes) > 8
            assert [one for one in axes if one[1] < 3 or not one[2]] == [], width
            assert live.page.evaluate(CLIPPED) == [], width


def test_the_chart_against_speed_stays(live: Live) -> None:
    """Whatever else is shown of the same machine."""
    page = live.page
    page.get_by_role("combobox", name="Example").select_option("yamashita-rig")
    chart = page.get_by_role("figure", name=re.compile("^Gauge against speed"))
    expect(chart).to_be_visible()
    page.get_by_role("combobox", name="Arrows at").select_option("C")
    expect(page.locator(".scales li")).to_have_count(3)
    live.settled()
    expect(chart).to_be_visible()
    live.button("Keep as variant").click()
    expect(page.get_by_role("region", name="Variants")).to_be_visible()
    live.settled()
    expect(chart).to_be_visible()
    page.get_by_role("combobox", name="Compare with").select_option("as it was opened")
    live.settled()
    expect(chart).to_be_visible()


def test_numbers_of_the_scale_lie_over_the_soil(live: Live) -> None:
    later = "document.querySelector('.linkage').compareDocumentPosition"
    assert live.page.evaluate(f"{later}(document.querySelector('.numbered'))") == 4
    assert live.page.locator(".numbered text").count() > 6


def test_any_output_is_drawn_over_the_crank_angle(live: Live) -> None:
    search = live.page.get_by_role("combobox", name="Any output over crank angle")
    search.fill("angle transm")  # words in any order
    search.press("Enter")
    chart = live.page.get_by_role("figure", name="Transmission angle at C")
    angle = np.degrees(eq.analyze(eq.load("yamashita-1")).motion.transmission["C"])
    told = f"from {np.min(angle):.3g} to {np.max(angle):.3g} °"
    expect(chart).to_have_attribute("aria-label", f"Transmission angle at C: {told}")
    search.fill("angle of crank")
    search.press("Enter")
    turning = live.page.get_by_role("figure", name=re.compile("^Angle of crank: from 0 to 360 °"))
    expect(turning).to_be_visible()  # it does not fall at its end
    search.fill("no such output")
    expect(live.page.get_by_text("No output has such a name")).to_be_visible()
    search.press("Enter")
    search.fill("velocity of P")
    live.page.get_by_role("listbox").get_by_role("option").first.click()
    expect(live.page.get_by_role("figure", name=re.compile("^Velocity of P:"))).to_be_visible()
    expect(chart).to_be_visible()
    live.button("Close chart of transmission angle at C").click()
    expect(chart).to_be_hidden()
