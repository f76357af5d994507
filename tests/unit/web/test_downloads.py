"""What a page can keep beside its model: pictures of every chart, and a page that plays."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from importlib import import_module
from typing import Any
from unittest.mock import Mock
from xml.etree import ElementTree

import pytest

import equipoise as eq
from equipoise.i18n import catalogue
from equipoise.mechanism.parts.run_plans import RunPlan
from equipoise.schema.models import text_of
from equipoise.web import documents as played_module
from equipoise.web import interactive as interactive_module
from equipoise.web.figures import CHARTS
from equipoise.web.gallery import titles
from equipoise.web.replies import Reply
from equipoise.web.session import Session
from support.machines_strokes import named
from unit.figures.link_samples import engine
from unit.web.pages import ask, opened, refusal


def kept(session: Session, **values: Any) -> Reply:
    """The file that is answered."""
    (file,) = ask(session, "download", seq=1, **values)
    assert file.content["type"] == "file", file.content
    return file


def charts_of(session: Session) -> dict[str, list[str]]:
    """Choices of every chart that a page is told of, by its name."""
    texts = [*session.state_replies(None), *session.deferred_replies()]
    if session.base().finished and session.current().design.machine.run is not None:
        texts += ask(session, "run", seq=1)
    charts = [chart for reply in texts for chart in reply.content.get("charts", [])]
    return {chart["name"]: [item["name"] for item in chart["choices"]] for chart in charts}


def explanation_of(chart: str) -> str:
    """Name of the explanation of a chart, as a page finds it."""
    return chart if chart in CHARTS else re.split(r"-|\.\d", chart)[0]


def running_on_its_support() -> Session:
    machine = replace(eq.load("balance-rig"), run=RunPlan(duration=0.1, support=True))
    session = Session()
    ask(session, "open", seq=1, name="rig.toml", text=eq.dumps(machine))
    return session


EXPLAINED = ["yamashita-rig", "four-row-transplanter", "stephenson-six-bar", "cutter-bar"]


@pytest.mark.exhaustive(but=EXPLAINED[1:])
@pytest.mark.parametrize("name", EXPLAINED)
def test_every_chart_is_explained_and_can_be_kept(name: str) -> None:
    session, _ = opened(name)
    charts = charts_of(session) | {"polar": [""], "path": [""], "output": ["links.crank.angle"]}
    assert {*map(explanation_of, charts)} <= CHARTS.keys()
    if name == "stephenson-six-bar":
        del charts["output"]
    for chart, choices in charts.items():
        file = kept(session, kind="chart", chart=chart, choice=choices[0])
        assert ElementTree.fromstring(file.buffer).tag.endswith("svg"), chart
        assert re.search(r"-\w[\w-]*\.svg$", file.content["name"])


# Charts are explained and kept: the test above.
@pytest.mark.exhaustive
def test_every_explanation_is_of_a_chart() -> None:
    session = Session()
    ask(session, "open", seq=1, name="engine.toml", text=eq.dumps(engine()))
    charts = charts_of(session) | charts_of(running_on_its_support())
    actual = {"polar", "path", "output", *map(explanation_of, charts)}
    for name in titles():
        if actual != CHARTS.keys():
            actual |= {*map(explanation_of, charts_of(opened(name)[0]))}
    assert actual == CHARTS.keys()


def test_gauges_and_mounts_of_a_run_are_named_and_explained(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """And the machine runs once, however many charts are kept."""
    module = import_module("equipoise.running.run")
    run = Mock(wraps=module.run)
    monkeypatch.setattr(module, "run", run)
    session = running_on_its_support()
    (reply,) = ask(session, "run", seq=2)
    charts = {chart["name"]: chart["choices"][0]["label"] for chart in reply.content["charts"]}
    assert {*map(explanation_of, charts)} <= CHARTS.keys()
    of_support = ["run.gauges.0", "run.mounts.0", "run.mounts.1"]
    assert [name for name in charts if name not in ("run.speed.0", "run.speed.1")] == of_support
    for name, what in zip(of_support, ("gauge", "spring", "bearing"), strict=True):
        assert charts[name].startswith(f"{what}: ")
        kept(session, kind="chart", chart=name)
    run.assert_called_once()


def test_what_cannot_be_drawn_is_refused() -> None:
    session, _ = opened("yamashita-1")
    for text, values in {
        "run.speed.7": {"kind": "chart", "chart": "run.speed.7"},
        "no.such": {"kind": "chart", "chart": "polr", "choice": "no.such"},
        "format of pictures": {"kind": "drawing", "format": "bmp"},
        "sample of the crank angle": {"kind": "drawing", "at": 720},
        "no download": {"kind": "film2"},
    }.items():
        assert text in refusal(ask(session, "download", seq=1, **values)[-1:])


def test_a_page_that_plays_holds_all_that_was_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    built = {"equipoise.js": b'"</script>"', "equipoise.css": b"a{}"}
    monkeypatch.setattr(played_module, "assets", lambda: built)
    session, _ = opened("yamashita-rig")
    page = kept(session, kind="played", language="ko").buffer.decode()
    assert page.count("</script>") == 2
    reported = json.loads(re.search(r'id="equipoise-played">(.*?)</script>', page, re.S)[1])  # type: ignore[index]
    kinds = [content["type"] for content, _ in reported["replies"]]
    assert kinds[:3] == ["spoken", "hello", "state"] and kinds.count("response") == 2
    state = reported["replies"][2][0]
    assert {f"output.{item['name']}" for item in state["outputs"]} <= state["arrays"].keys()
    assert reported["replies"][0][0]["language"] == "ko"


def test_a_page_that_computes_is_that_of_export(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the machine as it has been changed; one of which there is no script is refused."""
    monkeypatch.setattr(interactive_module, "asset", lambda name: f"/* {name} */ RMS")
    session, _ = opened("yamashita-1")
    edit = {"edits": [{"set": "links.crank.mass", "value": 0.5}], "commit": True, "label": "x"}
    ask(session, "edit", seq=2, **edit)
    (file,) = ask(session, "download", seq=3, kind="interactive", language="ko")
    page = file.buffer.decode()
    held = json.loads(re.search(r'id="equipoise-machine">(.*?)</script>', page, re.S)[1])  # type: ignore[index]
    fields = {field["path"]: field for field in held["fields"]}
    assert fields["links.crank.mass"]["value"] == 0.5
    assert held["language"] == "ko" and held["words"]["RMS"] == catalogue("ko")["RMS"]
    text = text_of(replace(named("pushed geared_coupler:0").machine, loads=()), {})
    ask(session, "open", name="machine.toml", text=text)
    said = refusal(ask(session, "download", seq=1, kind="interactive")[-1:])
    assert "an interactive page computes in the browser" in said
    said = refusal(ask(session, "download", seq=2, kind="interactive", language="xx")[-1:])
    assert "language of pages" in said


def test_a_model_comes_with_its_tables() -> None:
    session, _ = opened("four-stroke-engine")
    (file,) = ask(session, "download", kind="model")
    text, files = file.buffer.decode(), file.content["files"]
    again = Session()
    ask(again, "open", name="there.toml", text=text, files=files)
    assert again.shown.design.machine == session.shown.design.machine
