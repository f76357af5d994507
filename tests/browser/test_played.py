"""Files that a page hands out: pictures, a film, and a page that plays without a server."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from browser.live import FITS, OVER_A_SOCKET, Live


def taken(live: Live, press: Callable[[], None]) -> tuple[str, bytes]:
    """Return name and bytes of the file that a button gives."""
    with live.page.expect_download() as coming:
        press()
    return coming.value.suggested_filename, coming.value.path().read_bytes()


def menu(live: Live, name: str) -> tuple[str, bytes]:
    live.page.get_by_text("Download", exact=True).click()
    return taken(live, live.button(name).click)


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_pictures_and_a_film_are_kept(live: Live) -> None:
    name, data = menu(live, "Drawing as SVG")
    assert name == "yamashita-1-drawing.svg"
    assert ElementTree.fromstring(data).tag.endswith("svg")
    assert Image.open(io.BytesIO(menu(live, "Drawing as PNG")[1])).format == "PNG"
    film = Image.open(io.BytesIO(menu(live, "Motion as GIF")[1]))
    assert film.format == "GIF" and film.n_frames > 20
    chart = live.page.get_by_role("figure", name="Drive torque: from")
    why = chart.get_by_role("button", name="Drive torque: what does it show?")
    why.click()
    expect(chart.get_by_text("keeps the crank at its speed")).to_be_visible()
    expect(why).to_have_attribute("aria-expanded", "true")
    assert live.findings() == []
    name, data = taken(live, chart.get_by_role("button", name="SVG").click)
    assert name == "yamashita-1-drive_torque.svg"
    assert b"torque" in data
    why.click()
    expect(chart.get_by_text("keeps the crank at its speed")).to_be_hidden()


def test_a_file_plays_without_a_server(
    live: Live, new_page: Callable[..., Page], tmp_path: Path
) -> None:
    live.type(live.field("crank mass"), "300 g")
    expect(live.button("Undo")).to_be_enabled()
    live.settled()
    figures = live.page.locator(".readings .value").all_inner_texts()
    path = tmp_path / "played.html"
    path.write_bytes(menu(live, "Page that plays without a server")[1])
    page = new_page(reduced_motion="no-preference")
    asked: list[str] = []
    page.on("request", lambda sent: asked.append(sent.url))
    page.set_content(path.read_text(encoding="utf-8"))
    there = Live(page)
    start = there.spot(there.joint("B"))
    page.wait_for_function(
        "y => y !== document.querySelector('[data-name=B]').getBoundingClientRect().y",
        arg=start[1] - 0.5,
    )
    there.button("Pause").click()
    expect(page.locator(".readings .value")).to_have_text(figures)
    expect(there.field("crank mass")).to_be_disabled()
    for name in ("Balance", "Keep as variant", "Choose underlay"):
        expect(there.button(name)).to_be_hidden()
    turned = page.locator(".transport").inner_text()
    page.keyboard.press(".")  # where nothing has the focus
    expect(page.locator(".transport")).not_to_have_text(turned)
    there.drag(there.joint("B"), (20, 0))
    reported = there.status("plays what was computed")
    reported.click()
    expect(reported).to_be_hidden()
    search = page.get_by_role("combobox", name="Any output over crank angle")
    search.fill("transmission angle at C")
    search.press("Enter")
    expect(page.get_by_role("figure").filter(has_text="Transmission angle at C")).to_be_visible()
    for width in (1280, 400):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(FITS) and there.findings() == []
    assert [url for url in asked if not url.startswith(("data:", "blob:"))] == []


@pytest.mark.exhaustive
def test_a_file_that_computes_shows_the_same(
    live: Live, new_page: Callable[..., Page], tmp_path: Path
) -> None:
    live.type(live.field("crank mass"), "300 g")
    live.settled()
    figures = live.page.locator(".readings").first.locator(".value").all_inner_texts()
    name, data = menu(live, "Page that computes without a server")
    assert name == "yamashita-1-interactive.html"
    page = new_page()
    page.set_content(data.decode())
    shown = page.locator(".readings .value").all_inner_texts()
    assert {text.lstrip("−") for text in figures} <= {*shown}
    mass = page.locator("input[aria-label='mass of the crank']")  # its group is closed
    assert mass.input_value() == "300"
