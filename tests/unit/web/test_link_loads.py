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
    (reply,) = (item for item in session.tell_more() if item.content["type"] == "strokes")
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
    assert [*charts] == ["stress-crank", "stress-rod"]
    for name, chart in charts.items():
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
