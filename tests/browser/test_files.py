"""Machines come in as examples and files, and go out as files; what is no machine is refused."""

from __future__ import annotations

import csv
import io

import numpy as np
from playwright.sync_api import expect

import equipoise as eq
from browser.live import Live
from surface.running import example_text

BAD = (
    ("notes.toml", "this is no model", "notes.toml"),
    ("unit.toml", example_text("yamashita-1").replace('"199 g"', '"199 mm"'), "links.crank.mass"),
    ("huge.toml", "# " * 100, "MB"),
)
"""Names and texts of files, and what is told of them."""


def test_an_example_is_picked_and_a_file_dropped(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("quick-return")
    expect(live.page.get_by_role("heading", name=eq.load("quick-return").title)).to_be_visible()
    assert live.machine() == eq.load("quick-return")
    live.drop("mine.toml", example_text("watt-six-bar"))
    expect(live.page.get_by_role("combobox", name="Example")).to_have_value("mine.toml")
    assert live.machine() == eq.load("watt-six-bar")


def test_what_is_no_machine_is_refused_with_a_sentence(live: Live) -> None:
    for name, text, told in BAD:
        live.drop(name, text, 100_000 if name == "huge.toml" else 1)
        expect(live.told(told)).to_be_visible()
    assert live.machine() == eq.load("yamashita-1")


def test_signals_and_report_are_given_as_files(live: Live) -> None:
    name, text = live.download("Download CSV")
    assert name.endswith(".csv")
    rows = list(csv.reader(io.StringIO(text)))
    force = eq.analyze(eq.load("yamashita-1"), 720).forces.shaking_force
    column = next(n for n, head in enumerate(rows[0]) if head.startswith("shaking_force.x"))
    read = np.array([float(row[column]) for row in rows[1:]])
    np.testing.assert_allclose(read, force.x, rtol=1e-9, atol=1e-9)
    name, text = live.download("Download report")
    assert name.endswith(".html")
    assert eq.load("yamashita-1").title in text
