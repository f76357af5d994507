"""Loads along links on the page: those of their picture, which can be kept as it is."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import equipoise as eq
from equipoise.web.figures import CHARTS
from equipoise.web.replies import Reply
from equipoise.web.session import Session
from unit.figures.link_samples import engine, pictures
from unit.web.pages import ask
from unit.web.typed import misfits_of_reply


def strokes_of(session: Session) -> Reply:
    (reply,) = (item for item in session.deferred_replies() if item.content["type"] == "strokes")
    assert misfits_of_reply(reply.content) == []
    return reply


@pytest.fixture
def session() -> Session:
    session = Session()
    ask(session, "open", seq=1, name="engine.toml", text=eq.dumps(engine()))
    return session


def test_they_are_those_of_the_picture(session: Session) -> None:
    reply = strokes_of(session)
    block = np.frombuffer(reply.buffer, "<f4")
    arrays: dict[str, list[int]] = reply.content["arrays"]

    def values(name: str) -> np.ndarray[Any, Any]:
        begin, length = arrays[name]
        return block[begin : begin + length]

    charts = {chart["name"]: chart for chart in reply.content["charts"]}
    assert [*charts] == ["stress-crank", "haigh-crank", "stress-rod", "haigh-rod"]
    for name, chart in charts.items():
        if name.startswith("haigh-"):
            continue
        link = name.removeprefix("stress-")
        labels = [choice["label"] for choice in chart["choices"]]
        named = ("axial force", "shear force", "bending moment", "stress")
        assert labels == [f"{link}: {what}" for what in named]
        picture = pictures("engine")[name]
        place = picture.panels[0].lines[0].at
        assert chart["x"]["at"] == place and chart["x"]["unit"] == "mm"
        at = values(chart["x"]["array"])
        assert np.all(np.diff(at) >= 0)  # as the page draws them
        for panel, choice in zip(picture.panels, chart["choices"], strict=True):
            for curve, sent in zip(panel.curves, choice["curves"], strict=True):
                np.testing.assert_allclose(at, curve.x, atol=1e-6)
                size = np.max(np.abs(curve.y), initial=0.0)
                np.testing.assert_allclose(values(sent["array"]), curve.y, atol=1e-6 * size)


def test_cycles_of_stress_are_points_below_their_limits(session: Session) -> None:
    """Every cycle of the picture, at its mean, and limits as straight lines between theirs."""
    reply = strokes_of(session)
    block, arrays = np.frombuffer(reply.buffer, "<f4"), reply.content["arrays"]
    chart = next(entry for entry in reply.content["charts"] if entry["name"] == "haigh-rod")
    begin, length = arrays[chart["x"]["array"]]
    x = block[begin : begin + length]
    (panel,) = pictures("engine")["haigh-rod"].panels
    *limits, cycles = chart["choices"][0]["curves"]
    assert cycles["points"] and not any("points" in item for item in limits)
    at, length = arrays[cycles["array"]]
    values = block[at : at + length]
    sent = sorted((a, b) for a, b in zip(x, values, strict=True) if not np.isnan(b))
    assert np.array(sent) == pytest.approx(
        np.array(sorted((mark.x, mark.y) for mark in panel.marks)), rel=1e-6, abs=1.0
    )
    assert chart["x"]["at"] in {mark.x for mark in panel.marks}
    for limit, curve in zip(limits, panel.curves, strict=True):
        at, length = arrays[limit["array"]]
        values = block[at : at + length]
        assert np.all(np.isnan(values[(x < curve.x[0] - 10.0) | (x > curve.x[-1] + 10.0)]))
        there = ~np.isnan(values)
        assert np.count_nonzero(there) >= len(curve.x) - 1
        wanted = np.interp(x[there], curve.x, curve.y)
        reported = ~np.isnan(wanted)  # beside a gap 32-bit numbers of x may lie in it
        np.testing.assert_allclose(values[there][reported], wanted[reported], rtol=1e-5, atol=50.0)


def test_they_are_explained_and_can_be_kept(session: Session) -> None:
    for chart in strokes_of(session).content["charts"]:
        assert chart["name"].split("-")[0] in CHARTS
        choice = chart["choices"][0]["name"]
        replies = ask(session, "download", seq=2, kind="chart", chart=chart["name"], choice=choice)
        assert ElementTree.fromstring(replies[-1].buffer).tag.endswith("svg")


def test_a_machine_without_sections_has_none(session: Session) -> None:
    """It is told so, as the page keeps charts until then."""
    ask(session, "open", seq=2, example="yamashita-1")
    reply = strokes_of(session)
    assert reply.content["charts"] == [] and reply.content["arrays"] == {}
    assert reply.content["figures"]
