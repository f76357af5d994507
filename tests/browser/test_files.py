"""Machines come in as examples and files, and go out as files; what is no machine is refused."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from playwright.sync_api import expect

import equipoise as eq
from browser.live import Live
from surface.running import example_text

BAD = {
    "no model": ("notes.toml", "this is no model", "notes.toml"),
    "wrong unit": (
        "unit.toml",
        example_text("yamashita-1").replace('"199 g"', '"199 mm"'),
        "links.crank.mass",
    ),
    "huge": ("huge.toml", "# " * 100, "MB"),
}


def test_an_example_is_picked(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("quick-return")
    expect(live.page.get_by_role("heading", name=eq.load("quick-return").title)).to_be_visible()
    assert live.machine() == eq.load("quick-return")


def test_a_file_is_dropped(live: Live) -> None:
    live.drop("mine.toml", example_text("watt-six-bar"))
    expect(live.page.get_by_role("combobox", name="Example")).to_have_value("mine.toml")
    assert live.machine() == eq.load("watt-six-bar")


@pytest.mark.parametrize("bad", BAD)
def test_what_is_no_machine_is_refused_with_a_sentence(live: Live, bad: str) -> None:
    name, text, told = BAD[bad]
    live.drop(name, text, 100_000 if bad == "huge" else 1)
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
