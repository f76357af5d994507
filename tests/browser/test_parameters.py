"""Named parameters on the page: typed as other numbers, and followed by what names them."""

from __future__ import annotations

import tomllib

import pytest
from playwright.sync_api import expect

import equipoise as eq
from browser.live import Live
from unit.schema.test_parameters import FOUR_BAR


@pytest.mark.exhaustive
def test_numbers_follow_a_parameter_and_the_file_keeps_their_expressions(live: Live) -> None:
    live.drop("mine.toml", FOUR_BAR)
    mass, weight = live.field("rod mass"), live.field("parameters weight")
    expect(mass).to_have_value("200 g")
    live.type(weight, "300 g")
    expect(mass).to_have_value("300 g")
    live.type(mass, "weight/2 + 10 g")
    expect(mass).to_have_value("=weight/2 + 10 g")  # as long as it has the focus
    mass.blur()
    expect(mass).to_have_value("160 g")
    live.type(live.field("parameters crank"), "32 mm")
    live.settled()
    _, text = live.download("Download model")
    content = tomllib.loads(text)
    assert content["links"]["rod"]["mass"] == "=weight/2 + 10 g"
    assert content["frame"]["points"]["D"] == ["=base", "0 mm"]
    machine = eq.loads(text)
    assert (machine.frame["D"], machine.links["rod"].mass) == ((0.128, 0.0), 0.16)
    live.type(mass, "2*wieght")
    expect(live.page.get_by_text("no parameter is called 'wieght'").first).to_be_visible()
