"""A hand-held tool on a page without a browser: what it is told and what can be asked."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.handheld.modes import vibrate_tool
from equipoise.i18n import localized, speaking
from equipoise.web.desk import PageBackend, begun
from equipoise.web.messages import message_of
from equipoise.web.tools import tool_of_file
from support.chosen import few
from surface.running import TOOLS, example_text

PATH = "shaft.outer_diameter"
OWN = """mass = "150 g"
stiffness = { vertical = "9 kN/m", lateral = "7 kN/m" }
damping = "90 N s/m"
"""
HELD = example_text("brush-cutter").replace(OWN, 'impedance = "hand.csv"\n')
HAND = "frequency [Hz],resistance [N s/m],reactance [N s/m]\n1,90,-1400\n5000,90,-1\n"


def ask(desk: PageBackend, asked: str, /, **values):
    """The answers to a message, which goes by way of JSON."""
    message = message_of(json.loads(json.dumps({"type": asked, "seq": 1, **values})))
    return [*desk.receive(message)]


def shown(replies):
    """What the page is told of the tool."""
    (actual,) = [reply for reply in replies if reply.content["type"] == "tool"]
    assert json.dumps(actual.content, allow_nan=False)
    return actual.content


def figures(content):
    return {entry["name"]: entry for entry in content["figures"]}


def setting(desk: PageBackend, text: str, commit=True, path=PATH):
    edits = [{"set": path, "text": text}]
    return ask(desk, "edit", commit=commit, label=path, edits=edits)


@pytest.mark.exhaustive(but=["nagamine-irie"])
@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_is_reported_from_the_side_with_its_modes(name) -> None:
    desk = begun(name)()
    hello, reply = ask(desk, "ready")
    assert hello.content["machine"]
    assert {entry["name"] for entry in hello.content["tools"]} == set(TOOLS)
    content, tool = reply.content, eq.load(name)
    assert [entry["name"] for entry in content["scene"]["stations"]] == [
        s.name for s in tool.stations
    ]
    assert content["along"][-1] == tool.shaft.length
    modes = vibrate_tool(tool)
    elastic = [f for f in modes.planes[0].cycles_per_second if f > 0]
    views = [entry for entry in content["views"] if entry["name"].startswith("mode ")]
    assert len(views) == 4
    for view, frequency in zip(views, elastic, strict=False):
        assert f"{frequency:.4g} Hz" in view["name"]
        shape = np.array(view["shape"]).view(complex)
        assert np.max(np.abs(shape)) == pytest.approx(0.05 * tool.shaft.length, rel=1e-3)
    total_mass = float(figures(content)["mass"]["texts"][1])
    assert total_mass == pytest.approx(tool.mass, rel=1e-3)
    assert {entry["path"].partition(".")[0] for entry in content["fields"]} >= {
        "shaft",
        "operation",
    }


def test_numbers_are_set_by_the_paths_of_studies_and_figures_reported_before_and_after() -> None:
    desk = begun("brush-cutter")()
    start = shown(ask(desk, "ready"))
    assert start["before"] is None
    dragged = shown(setting(desk, "27 mm", commit=False))
    after = shown(setting(desk, "30 mm"))
    assert dragged["undo"] is None and after["undo"] == PATH
    wanted = eq.loads(
        example_text("brush-cutter").replace('outer_diameter = "26 mm"', 'outer_diameter = "30 mm"')
    )
    mass = figures(after)["mass"]
    assert mass["before"] == pytest.approx(eq.load("brush-cutter").mass)
    assert mass["after"] == pytest.approx(wanted.mass)
    lowest = figures(after)["vertical.4"]
    assert lowest["after"] == pytest.approx(vibrate_tool(wanted).planes[0].cycles_per_second[3])
    assert after["scene"]["tubes"][0][2] == 0.03 and after["before"]["tubes"][0][2] == 0.026
    assert [name for name in after["arrays"] if name.startswith("before.a_hv.")]
    (field,) = [item for item in after["fields"] if item["path"] == PATH]
    assert (field["text"], field["label"]) == ("30 mm", "outer diameter")
    (file,) = ask(desk, "download", kind="model")
    assert eq.loads(file.buffer.decode()) == wanted
    undone = shown(ask(desk, "undo"))
    assert figures(undone)["mass"]["after"] == mass["before"] and undone["redo"] == PATH
    assert figures(shown(ask(desk, "redo")))["mass"]["after"] == mass["after"]


@pytest.fixture(scope="module")
def desk() -> PageBackend:
    """A page with a tool, of which nothing that is asked may change anything."""
    return begun("brush-cutter")()


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("edit", {"edits": [{"set": PATH, "text": "20 mm"}]}), "got 23 mm inside of 20 mm"),
        (("edit", {"edits": [{"set": PATH, "text": "wide"}]}), "got 'wide'"),
        (("edit", {"edits": [{"set": "shaft.colour", "text": "1"}]}), "shaft.colour"),
        (("edit", {"edits": [{"move": "A", "to": [0, 0]}]}), "no joints to be dragged"),
        (("balance", {}), "balance is for linkages; a tool is open"),
        (("record", {"text": "x"}), "a record stands beside curves over the crank angle, and a"),
        (("undo", {}), "there is nothing to undo"),
        (("download", {"kind": "csv"}), "of a tool, model or report"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_changes(desk: PageBackend, asked, said) -> None:
    before = figures(shown(ask(desk, "ready")))
    (refused,) = ask(desk, asked[0], **asked[1])
    assert refused.content["type"] == "refused" and said in refused.content["message"]
    assert figures(shown(ask(desk, "ready"))) == before


# A machine after a tool: `test_a_new_machine_takes_the_place_of_a_tool` of test_sketch.py.
@pytest.mark.exhaustive
def test_tools_and_machines_are_opened_in_turn() -> None:
    desk = begun("yamashita-1")()
    assert shown(ask(desk, "open", example="pole-saw"))["name"] == "pole-saw"
    assert not desk.has_more
    text = example_text("nagamine-irie")
    assert shown(ask(desk, "open", name="mine.toml", text=text))["name"] == "mine.toml"
    wrong = text.replace('"1.544 m"', '"-1 m"')
    assert ask(desk, "open", name="bad.toml", text=wrong)[0].content["type"] == "refused"
    assert shown(ask(desk, "ready"))["name"] == "mine.toml"
    machine = ask(desk, "open", example="yamashita-rig")[0].content
    assert (machine["type"], machine["name"]) == ("state", "yamashita-rig")
    assert desk.tool is None and desk.has_more
    spoken = ask(desk, "speak", languages=["ja"])[0].content
    assert spoken["language"] == "ja"
    reported = shown(ask(desk, "open", example="pole-saw"))
    assert figures(reported)["mass"]["label"] != "mass of the tool"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A tool that is held by hands whose impedance was measured."""
    path = tmp_path / "mine.toml"
    path.write_text(HELD, encoding="utf-8")
    path.with_name("hand.csv").write_text(HAND, encoding="utf-8")
    return path


# Files of linkages are saved by the same function: tests/unit/web/test_server.py.
@pytest.mark.exhaustive
def test_the_file_of_a_tool_is_saved_in_place(path: Path) -> None:
    begin = begun(str(path))
    single, other = begin(), begin()
    assert shown(ask(single, "ready"))["file"] == {
        "name": path.name,
        "saved": True,
        "comments": True,
    }
    base = single.hello().content["base"]
    assert shown(setting(single, "30 mm"))["file"]["saved"] is False
    setting(other, "31 mm")
    reply, saved = ask(single, "save")
    assert shown([reply])["file"] == {"name": path.name, "saved": True, "comments": False}
    assert saved.content["base"] == single.hello().content["base"] != base
    assert eq.load(path) == single.tool.now.tool != other.tool.now.tool
    (refused,) = ask(other, "save")
    assert "by another page or program" in refused.content["message"]
    again = begin()
    assert again.tool.now.tool == single.tool.now.tool
    first = {"name": path.name, "text": saved.content["text"], "file": True}
    assert shown(ask(again, "open", **first))["file"]["saved"] is False
    ask(again, "save")
    assert eq.load(path).shaft == eq.load("brush-cutter").shaft
    (refused,) = ask(begun("pole-saw")(), "save")
    assert "pole-saw was not opened from a file" in refused.content["message"]


def test_a_tool_that_is_dropped_takes_its_tables_along() -> None:
    desk = begun(None)()
    asked = {"name": "mine.toml", "text": HELD}
    (refused,) = ask(desk, "open", **asked)
    assert "choose that file, or drop it together with the model" in refused.content["message"]
    assert shown(ask(desk, "open", **asked, files={"hand.csv": HAND}))["file"] is None
    setting(desk, "30 mm")
    (file,) = ask(desk, "download", kind="model")
    assert list(file.content["files"]) == ["hand.csv"]


@pytest.mark.parametrize("language", few(["en", "ja", "ko"], {"ja"}))
def test_numbers_do_not_say_again_what_their_heading_names(language):
    """In any language, whatever its words for what a number is of."""
    with speaking(language):
        tool = tool_of_file("brush-cutter")
        for field in shown([tool.reply(1)])["fields"]:
            if field["path"].startswith(("shaft.", "work", "excitations")):
                assert field["group"] not in field["label"].split()
                assert len(field["label"]) < len(localized(tool.template.words(field["path"])))
