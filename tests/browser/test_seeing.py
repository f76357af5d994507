"""Arrows at a point, a support that moves, variants: as they are seen on the page."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import equipoise as eq
from browser.live import SCREENSHOTS, Live

ENDS = """kind => [...document.querySelectorAll(`.linkage .arrows .${kind}`)].map(one => {
    const path = (part) => one.querySelector(part).getAttribute("d");
    const numbers = (part) => path(part).match(/-?[\\d.]+/g).map(Number);
    return [numbers(".shaft").slice(0, 2), numbers(".head").slice(0, 2)];
})"""
"""Of arrows of a kind, where they begin and end, pixels."""
SCALE = """kind => {
    const items = [...document.querySelectorAll(".scales li")];
    const item = items.find(one => one.querySelector("." + kind));
    const [, x] = item.querySelector(".shaft").getAttribute("d").match(/H(-?[\\d.]+)/);
    return [item.textContent, Number(x) + 9];
}"""
"""What is told of the scale of a kind, and how long it is drawn, pixels."""


def arrow_and_scale(page: Page, kind: str) -> tuple[complex, float]:
    """Return the first arrow of a kind as it is to be read from its scale, and its unit's size."""
    [[x0, y0], [x1, y1]] = page.evaluate(ENDS, kind)[0]
    text, length = page.evaluate(SCALE, kind)
    (value,) = re.findall(r"([\d.]+)\xa0", text)
    return complex(x1 - x0, y0 - y1) * float(value) / length, float(value)


@pytest.mark.exhaustive
def test_arrows_are_as_long_as_their_scale_reports(live: Live) -> None:
    page = live.page
    page.get_by_role("combobox", name="Arrows at").select_option("C")
    page.get_by_role("slider", name="Crank angle").fill("200")
    expect(page.locator(".scales li")).to_have_count(3)
    live.settled()
    live.painted()
    whole = eq.analyze(eq.load("yamashita-1"))
    point = whole.motion.points["C"]
    for kind, values in {
        "velocity": point.velocity,
        "acceleration": point.acceleration_vector,
        "force": whole.forces.joints["C"].value,
    }.items():
        seen, scale = arrow_and_scale(page, kind)
        assert seen == pytest.approx(complex(values[200]), abs=0.03 * scale + 0.02 * abs(seen))
    page.get_by_role("checkbox", name="force").uncheck()
    expect(page.locator(".scales li")).to_have_count(2)


@pytest.mark.exhaustive
def test_variants_are_drawn_pale_and_compared(live: Live) -> None:
    page = live.page
    live.button("Keep as variant").click()
    table = page.get_by_role("region", name="Variants")
    expect(table).to_be_visible()
    live.type(live.field("crank mass"), "0.1 kg")
    row = table.get_by_role("row").filter(has_text="Mass of the links")
    expect(row.locator(".best")).to_have_count(1)
    live.drag(live.joint("B"), (15, -6))
    pale = page.locator(".linkage .pale .body").first.bounding_box()
    now = page.locator(".linkage .signs .body").first.bounding_box()
    assert pale and now and pale["width"] != pytest.approx(now["width"], abs=0.5)
    chart = page.get_by_role("figure", name="Path", exact=True)
    drawn = [
        page.locator(f".linkage .{text} .path").first.bounding_box() for text in ("pale", "paths")
    ]
    drawn += [chart.locator(f".{text}").bounding_box() for text in ("before", "now")]
    assert all(drawn) and len({round(item["width"], 1) for item in drawn if item}) == len(drawn)
    expect(page.locator(".readings .was").first).not_to_be_empty()
    name = table.get_by_role("textbox", name="Name of variant A")
    name.fill("as built")
    name.press("Enter")
    expect(page.get_by_role("combobox", name="Compare with")).to_contain_text("as built")
    live.button("Go to as built").click()
    expect(live.field("crank mass")).to_have_value("199 g")
    assert live.findings() == []
    live.button("Delete as built").click()
    expect(table).to_be_hidden()
    expect(page.locator(".linkage .pale .body")).to_have_count(0)


def test_a_support_moves_at_work_and_in_its_modes(live: Live) -> None:
    page = live.page
    page.get_by_role("combobox", name="Example").select_option("sieve")
    support = page.get_by_role("combobox", name="Support")
    expect(support.locator("option")).to_have_count(2 + len(eq.modes(eq.load("sieve")).modes))
    expect(
        page.get_by_text(re.compile("movement of the support .+ times as large"))
    ).to_be_visible()
    spring = page.locator(".linkage .ground .piece").nth(2)
    crank, places = page.get_by_role("slider", name="Crank angle"), []
    for sample in (0, 90, 180):
        crank.fill(str(sample))
        live.painted()
        places.append(live.spot(live.joint("L")))
    assert np.ptp(places, axis=0).max() > 3  # a point of the frame, as the support carries it
    stretched = spring.get_attribute("transform")
    support.select_option("at rest")
    at_rest = live.spot(live.joint("L"))
    expect(spring).not_to_have_attribute("transform", stretched or "")
    support.select_option(index=2)
    expect(page.get_by_text("the crank stands still")).to_be_visible()
    crank.fill("45")
    live.painted()
    first = live.spot(live.joint("L"))
    crank.fill("225")  # half a swing later
    live.painted()
    other = live.spot(live.joint("L"))
    assert np.hypot(first[0] - other[0], first[1] - other[1]) > 2
    middle = (np.array(first) + np.array(other)) / 2
    assert middle == pytest.approx(at_rest, abs=2)


@pytest.mark.exhaustive
def test_the_path_of_a_link_s_own_point_is_seen_on_the_link(live: Live) -> None:
    """A path is drawn over the links, which are not transparent."""
    order = "document.querySelector('.linkage .signs').compareDocumentPosition"
    assert live.page.evaluate(f"{order}(document.querySelector('.linkage .paths'))") == 4
    live.joint("P").focus()
    live.page.locator(".board:visible").screenshot(path=SCREENSHOTS / "coupler-curve.png")


@pytest.mark.exhaustive
def test_a_record_is_drawn_beside_the_model(live: Live) -> None:
    angle = np.arange(0.0, 360.0, 5.0)
    whole = eq.analyze(eq.load("yamashita-1"))
    torque = 1.2 * whole.forces.drive_torque[::5]
    rows = [f"{a},{t:.6f}" for a, t in zip(angle, torque, strict=True)]
    live.drop("run.csv", "\n".join(["crank_angle [deg],drive torque [N m]", *rows]))
    page = live.page
    expect(page.get_by_text("Record run.csv; drive torque: RMS measured")).to_be_visible()
    chart = page.get_by_role(
        "figure", name=re.compile("^Drive torque: model from .*; measured from")
    )
    expect(chart).to_be_visible()
    live.drop("bad.csv", "place [m],drive torque [N m]\n1,2\n")
    expect(live.status("bad.csv, line 1: got 'place [m]'")).to_be_visible()
    page.reload()
    expect(page.get_by_text("Record run.csv; drive torque: RMS measured")).to_be_visible()
    live.button("Remove the record").click()
    expect(chart).to_be_hidden()
