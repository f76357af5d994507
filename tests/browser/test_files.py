"""Machines come in as examples and files, and go out as files; what is no machine is refused."""

from __future__ import annotations

import csv
import io
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

import equipoise as eq
from browser.live import LONGEST, OVER_A_SOCKET, Live
from surface.running import example_text

PICKED = {
    "straw-walker": "F2",
    "rotary-transplanter": "P",
    "hydraulic-loader": "C",
    "cam-pusher": "C",
}
BAD = (
    ("notes.toml", "this is no model", "notes.toml"),
    ("unit.toml", example_text("yamashita-1").replace('"199 g"', '"199 mm"'), "links.crank.mass"),
    ("huge.toml", "# " * 100, "MB"),
)
"""Names and texts of files, and what is told of them."""


def test_examples_are_picked_changed_and_restored(live: Live) -> None:
    """Joints too many, gears of varying ratio, a cylinder, a cam."""
    readings = live.page.locator(".readings .value:visible")
    for name, point in PICKED.items():
        live.page.get_by_role("combobox", name="Example").select_option(name)
        title = eq.load(name).title
        expect(live.page.get_by_role("heading", name=str(title), exact=True)).to_be_visible()
        live.settled()
        before = readings.all_inner_texts()
        live.joint(point).press("ArrowRight")
        expect(readings).not_to_have_text(before)
        live.button("Undo").click()
        expect(readings).to_have_text(before)


def test_a_file_is_dropped_and_one_with_its_table(live: Live) -> None:
    live.drop("mine.toml", example_text("watt-six-bar"))
    expect(live.page.get_by_role("combobox", name="Example")).to_have_value("mine.toml")
    assert live.machine() == eq.load("watt-six-bar")
    model, table = "four-stroke-engine.toml", "four-stroke-gas.csv"
    live.drop(model, example_text("four-stroke-engine"))
    expect(live.status(f"got '{table}', which is not known here")).to_be_visible()
    text = (files(eq) / "examples" / table).read_text("utf-8")
    live.drop(model, example_text("four-stroke-engine"), beside=(table, text))
    expect(live.page.get_by_role("combobox", name="Example")).to_have_value(model)
    live.settled()
    assert live.status("not known here").count() == 0


@pytest.mark.exhaustive
def test_what_is_no_machine_is_refused_with_a_sentence(live: Live) -> None:
    for name, text, reported in BAD:
        live.drop(name, text, 100_000 if name == "huge.toml" else 1)
        expect(live.status(reported)).to_be_visible()
    assert live.machine() == eq.load("yamashita-1")


def test_signals_are_given_as_a_file(live: Live) -> None:
    name, text = live.download("Download CSV")
    assert name.endswith(".csv")
    rows = list(csv.reader(io.StringIO(text)))
    force = eq.analyze(eq.load("yamashita-1")).forces.shaking_force
    column = next(n for n, head in enumerate(rows[0]) if head.startswith("shaking_force.x"))
    read = np.array([float(row[column]) for row in rows[1:]])
    np.testing.assert_allclose(read, force.x, rtol=1e-9, atol=1e-9)


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_a_report_is_given_as_a_file(live: Live) -> None:
    name, text = live.download("Download report")
    assert name.endswith(".html")
    assert eq.load("yamashita-1").title in text


WATCH = """(slider) => {
    window.shown = [];
    const note = () => window.shown.push(slider.getAttribute("aria-valuetext"));
    new MutationObserver(note).observe(slider, { attributeFilter: ["aria-valuetext"] });
}"""


@pytest.mark.exhaustive
@pytest.mark.parametrize("what", ["cycle", "run"])
def test_drawing_and_charts_are_recorded_as_a_video(live: Live, what: str, tmp_path: Path) -> None:
    """One cycle, or the run that is played; the machine stands where it stood before."""
    page, name = live.page, "yamashita-1"
    slider = page.get_by_role("slider", name="Crank angle")
    if what == "run":
        name = "cutter-bar"
        page.get_by_role("combobox", name="Example").select_option(name)
        live.settled()
        live.button("Run").click()
        slider = page.get_by_role("slider", name="Time of the run", exact=True)
        expect(slider).to_be_visible(timeout=LONGEST * 1000)
    slider.fill("30")
    slider.evaluate(WATCH)
    page.get_by_label("Download", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Drawing and charts as video").click()
    assert download.value.suggested_filename == f"{name}.webm"
    path = tmp_path / "video.webm"
    download.value.save_as(path)
    video = path.read_bytes()
    assert video.startswith(b"\x1a\x45\xdf\xa3") and b"V_VP" in video[:4096]  # Matroska, VP8 or 9
    clusters = video.count(b"\x1f\x43\xb6\x75")
    assert clusters >= 1 and len(video) > 20_000
    expect(slider).to_have_value("30")
    shown = page.evaluate("window.shown")
    assert len({*shown}) > 2
    assert shown[0] == ("0.000 s after the start" if what == "run" else "0.0 degrees")
    if what == "run":  # and nothing is handed out of what is half a run and half a cycle
        page.get_by_label("Download", exact=True).click()
        page.get_by_role("button", name="Drawing and charts as video").click()
        page.get_by_role("button", name="Back to the cycle").click()
        expect(live.status("The recording was ended")).to_be_visible()
