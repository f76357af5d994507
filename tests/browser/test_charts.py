"""Charts of the live page: numbers on their axes, and any output that is looked for."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import expect

import equipoise as eq
from browser.live import SCREENSHOTS, Live
from unit.figures.link_samples import engine

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


ROUND = """schema = 1
title = "Round"
gravity = ["0 m/s^2", "0 m/s^2"]
[frame]
points.A = ["0 mm", "0 mm"]
[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["40 mm", "0 mm"]
mass = "1 kg"
center_of_mass = ["20 mm", "0 mm"]
inertia = "1 kg mm^2"
[drive]
link = "crank"
speed = "60 rpm"
"""
"""A crank alone: neither a moment about its pivot nor a torque."""


@pytest.mark.exhaustive
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
            assert [axis for axis in axes if axis[1] < 3 or not axis[2]] == [], width
            assert live.page.evaluate(CLIPPED) == [], width


@pytest.mark.exhaustive
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


INSIDE = """one => {
    const box = one.getBoundingClientRect();
    const side = one.closest(".side").getBoundingClientRect();
    return box.top >= Math.max(0, side.top) - 1 && box.height > 50 &&
        box.bottom <= Math.min(innerHeight, side.bottom) + 1;
}"""
"""Whether something is seen whole, in the window and in what scrolls there."""


@pytest.mark.exhaustive
def test_outputs_are_listed_within_the_window(live: Live) -> None:
    """Those that are meant first; and Tab goes on to what comes after the box."""
    page = live.page
    search = page.get_by_role("combobox", name="Any output over crank angle")
    result = page.get_by_role("listbox", name="Any output over crank angle")
    for block in ("end", "start"):
        search.evaluate("(one, block) => { one.blur(); one.scrollIntoView({ block }); }", block)
        search.focus()
        expect(result).to_be_visible()
        assert result.evaluate(INSIDE), block
    search.fill("velocity P")
    search.press("Enter")
    expect(page.get_by_role("figure", name=re.compile("^Velocity of P:"))).to_be_visible()
    search.fill("force")
    expect(result).to_be_visible()  # what scrolls would be a stop of its own
    search.press("Tab")
    assert page.evaluate("document.activeElement.getAttribute('role')") != "listbox"
    assert page.evaluate("document.activeElement.matches('button')")


def test_every_chart_asks_what_it_shows_by_its_own_name(live: Live) -> None:
    asks = live.page.locator(".charts figure:visible .why")
    names = [item.get_attribute("aria-label") for item in asks.all()]
    assert len(names) > 6 and len(set(names)) == len(names)
    live.button("Shaking moment: what does it show?").click()
    expect(live.page.locator(".explained:visible")).to_have_count(1)


@pytest.mark.exhaustive
def test_a_dwell_fills_its_chart(live: Live) -> None:
    """Its angle is far from zero, which is left out; bars and what comes near zero begin there."""
    live.page.get_by_role("combobox", name="Example").select_option("stephenson-six-bar")
    expect(live.page.get_by_role("figure", name=re.compile("^Angle of output:"))).to_be_visible()
    live.settled()
    angle = np.degrees(eq.analyze(eq.load("stephenson-six-bar")).motion.links["output"].angle)
    ends = {}
    for name in ("Angle of output", "Shaking force, by order"):
        chart = live.page.get_by_role("figure", name=re.compile(f"^{name}:"))
        texts = chart.locator(".numbers .y").all_inner_texts()
        ends[name] = [float(text.replace("−", "-")) for text in texts]
    low, high = min(ends["Angle of output"]), max(ends["Angle of output"])
    assert np.ptp(angle) > 0.5 * (high - low)
    assert np.min(np.abs(angle)) > 0.6 * np.max(np.abs(angle))
    assert min(ends["Shaking force, by order"]) == 0


@pytest.mark.exhaustive
def test_charts_of_nothing_but_zero_take_no_room(live: Live) -> None:
    """They are named in a line; numbers of the crank angle stand below what is left."""
    page = live.page
    moment = page.get_by_role("figure", name=re.compile("^Shaking moment"))
    torque = page.get_by_role("figure", name=re.compile("^Drive torque"))
    expect(torque.locator(".numbers .x")).not_to_have_count(0)
    expect(moment.locator(".numbers .x")).to_have_count(0)
    live.drop("mass.toml", ROUND)
    expect(page.get_by_role("heading", name="Round")).to_be_visible()
    live.settled()
    expect(page.get_by_text("Zero at every crank angle: Shaking moment")).to_be_visible()
    expect(moment).to_be_hidden()
    expect(torque).to_be_hidden()
    force = page.get_by_role("figure", name=re.compile("^Shaking force: x"))
    expect(force.locator(".numbers .x")).not_to_have_count(0)
    page.get_by_role("combobox", name="Example").select_option("yamashita-1")
    expect(moment).to_be_visible()
    expect(page.get_by_text("Zero at every crank angle")).to_be_hidden()


def test_loads_along_links_are_drawn_while_they_have_a_section(live: Live) -> None:
    """What is chosen is drawn over the length of the link; another machine has no such chart."""
    page = live.page
    live.drop("engine.toml", eq.dumps(engine()))
    live.settled()
    along = page.get_by_role("combobox", name="Along rod")
    expect(along).to_be_visible()
    chart = page.locator("figure", has=along)
    expect(chart.locator(".numbers .x")).not_to_have_count(0)
    along.select_option(label="rod: stress")
    expect(chart.locator("figcaption")).to_contain_text("MPa, over mm")
    assert not page.evaluate(CLIPPED)
    chart.get_by_role("button", name=re.compile("what does it show")).click()
    expect(chart).to_contain_text("What a link bears along its length")
    page.get_by_role("combobox", name="Example").select_option("yamashita-1")
    expect(along).to_be_hidden()


@pytest.mark.exhaustive
def test_a_record_leaves_headings_whole(live: Live) -> None:
    whole, angle = eq.analyze(eq.load("yamashita-1")), np.arange(0.0, 360.0, 5.0)
    force = whole.forces.shaking_force.value[::5]
    rows = [f"{a},{f.real:.5f},{f.imag:.5f}" for a, f in zip(angle, force, strict=True)]
    head = "crank_angle [deg],shaking_force.x [N],shaking_force.y [N]"
    live.drop("run.csv", "\n".join([head, *rows]))
    expect(live.page.get_by_text("Record run.csv")).to_be_visible()
    for width in (1280, 400):
        live.page.set_viewport_size({"width": width, "height": 900})
        live.settled()
        assert live.page.evaluate(CLIPPED) == [], width
        chart = live.page.get_by_role("figure", name=re.compile("^Shaking force: x"))
        assert chart.locator(".entry").count() == 4
        chart.screenshot(path=SCREENSHOTS / f"record-{width}.png")


@pytest.mark.exhaustive
def test_numbers_without_end_stay_in_their_places(live: Live) -> None:
    """And what is more than the page's numbers hold is not drawn."""
    live.type(live.field("crank mass"), "1e30 kg")
    live.settled()
    live.page.screenshot(path=SCREENSHOTS / "large.png")
    paths = live.page.locator("svg path").evaluate_all(
        "all => all.map(one => one.getAttribute('d'))"
    )
    assert not [path for path in paths if path and ("Infinity" in path or "NaN" in path)]
    assert live.page.evaluate(CLIPPED) == []
    texts = live.page.locator(
        ".charts .numbers span, .charts .reading, .plane text"
    ).all_text_contents()
    assert max(map(len, texts)) < 14
    live.type(live.field("crank mass"), "1e45 kg")
    paths = live.page.locator("svg path").evaluate_all(
        "all => all.map(one => one.getAttribute('d'))"
    )
    assert not [path for path in paths if path and ("Infinity" in path or "NaN" in path)]


@pytest.mark.exhaustive
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
    text = f"from {np.min(angle):.3g} to {np.max(angle):.3g} °"
    expect(chart).to_have_attribute("aria-label", f"Transmission angle at C: {text}")
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
