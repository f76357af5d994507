"""A store of a study on the live page: brushed in two pictures, its designs opened as machines."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, expect

import equipoise as eq
from browser.live import AXE, FITS, SCREENSHOTS, Live
from equipoise.studies import sweep
from support.chromium import serving
from unit.web.test_stores import STUDY

LONG = f"{'a_name_that_cannot_be_broken_' * 3}.zarr"


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a server with a store."""
    path: Path = tmp_path_factory.mktemp("studies") / "lengths.zarr"
    sweep(eq.loads(STUDY), path, workers=1)
    long = path.with_name(LONG)
    long.mkdir()
    shutil.copy(path / "zarr.json", long)
    with serving(str(path)) as address:
        yield address


def count(text: Locator) -> int:
    match = re.search(r"(\d+) within the ranges", text.inner_text())
    return int(match[1]) if match else -1


def test_designs_are_brushed_and_opened(browser: Browser, store: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(store)
    texts = page.get_by_role("status").filter(has_text="designs are drawn")
    expect(texts).to_contain_text("64 of 64 designs are drawn")
    expect(page.get_by_text(re.compile(r"\d+ × does not turn fully"))).to_be_visible()
    lines = page.get_by_role("img", name="Designs from axis to axis").locator("svg")
    points = page.get_by_role("img", name="Designs over two columns").locator("svg")
    assert lines.locator(".own").count() == points.locator(".own").count() == 1
    box = lines.bounding_box()
    assert box
    x, y = box["x"] + 46, box["y"]
    page.mouse.move(x, y + 150)
    page.mouse.down()
    page.mouse.move(x, y + 288, steps=5)
    page.mouse.up()
    expect(texts).to_contain_text("within the ranges")
    first = count(texts)
    assert 0 < first < 64
    typed = page.get_by_role("textbox", name=re.compile("^length A–B of the crank, to"))
    typed.fill("30")
    typed.press("Enter")
    expect(points.locator(".range")).to_have_count(1)  # brushed in the other picture as well
    assert 0 < count(texts) < first
    page.get_by_role("button", name="All designs").click()
    for name, end in (("^length A–B of the crank, to", "60"), ("^speed of the drive, from", "110")):
        limit = page.get_by_role("textbox", name=re.compile(name, re.IGNORECASE))
        limit.fill(end)
        limit.press("Enter")
    expect(texts).to_contain_text("within the ranges")
    rows = page.locator(".scrolled tbody tr")
    listed = [
        (item.get_attribute("class"), item.locator("td").last.inner_text()) for item in rows.all()
    ]
    kinds = [kind for kind, _ in listed]
    assert len(listed) == 12 and kinds == sorted(kinds, key=["kept", "beyond"].index)
    for kind in {*kinds}:
        forces = [float(force) for item, force in listed if item == kind]
        assert forces == sorted(forces)
    typed.fill("wide")
    typed.press("Enter")
    expect(page.get_by_text("got “wide”; give a number")).to_be_visible()
    page.get_by_role("button", name="All designs").click()
    expect(texts).not_to_contain_text("within the ranges")
    page.evaluate(AXE.read_text(encoding="utf-8"))
    result = page.evaluate("axe.run(document, {resultTypes: ['violations']})")["violations"]
    assert [item for item in result if item["impact"] in {"serious", "critical"}] == []
    page.screenshot(path=SCREENSHOTS / "study.png")
    page.set_viewport_size({"width": 400, "height": 900})
    page.wait_for_function(f"() => {FITS}")
    page.set_viewport_size({"width": 1280, "height": 900})
    page.wait_for_timeout(200)
    frame = points.bounding_box()
    assert frame
    for step in range(600):  # until a design is under the pointer
        across, up = divmod(step, 24)
        page.mouse.move(frame["x"] + 60 + 20 * across, frame["y"] + 12 + 10 * up)
        if points.locator(".hovered").count():
            break
    expect(page.get_by_text(re.compile(r"^design \d+ · ")).first).to_be_visible()
    page.mouse.down()
    page.mouse.up()
    live = Live(page)
    expect(live.joint("B")).to_be_visible()
    expect(page.get_by_role("combobox", name="Example")).to_have_value(re.compile("lengths.zarr "))
    page.get_by_role("button", name="Designs of the study").click()
    expect(texts).to_be_visible()
    page.get_by_role("button", name=re.compile("^Open design")).first.click()
    expect(live.joint("B")).to_be_visible()
    page.reload()
    expect(live.joint("B")).to_be_visible()
    expect(page.get_by_role("combobox", name="Example")).to_have_value(re.compile("lengths.zarr "))
    page.get_by_role("button", name="Open", exact=True).click()
    long = page.get_by_role("button", name=LONG)
    page.set_viewport_size({"width": 400, "height": 800})
    expect(long).to_be_visible()
    dialog = page.get_by_role("dialog", name="Open a machine")
    assert dialog.evaluate("one => one.scrollWidth <= one.clientWidth")
    page.set_viewport_size({"width": 1280, "height": 900})
    page.get_by_role("button", name="lengths.zarr", exact=True).click()
    expect(texts).to_be_visible()
    page.get_by_role("button", name="Open", exact=True).click()
    page.get_by_role("button", name="New machine").click()
    expect(page.get_by_text("nothing moves yet")).to_be_visible()
    expect(page.get_by_text("appear here as soon as")).to_have_count(2)
    assert wrong == []
    page.close()
