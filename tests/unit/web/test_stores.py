"""A store of a study on a page without a browser: columns, kinds of designs, machines of them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.schema.study_units import machine_of
from equipoise.studies import best, open_store, sweep
from equipoise.web import stores
from equipoise.web.desk import begun
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from surface.running import example_text

STUDY = """
schema = 1
title = "Lengths"
model = "yamashita-1"

[[vary]]
path = "links.crank.points.B.x"
range = ["10 mm", "80 mm"]

[[vary]]
path = "drive.speed"
range = ["100 rpm", "200 rpm"]

[sampling]
method = "sobol"
designs = 64

[[outputs]]
name = "force"
value = "shaking_force.rms"
make = "smallest"
at_most = "20 N"
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies")
    study = eq.loads(STUDY)
    sweep(study, folder / "lengths.zarr", workers=1)
    return str(folder / "lengths.zarr")


def ask(desk, asked, /, **values):
    """The answers to a message, which goes by way of JSON."""
    return [*desk.receive(message_of(json.loads(json.dumps({"type": asked, "seq": 1, **values}))))]


def column(reply, name):
    offset, length = reply.content["arrays"][name]
    return np.frombuffer(reply.buffer, "<f4")[offset : offset + length].astype(float)


def test_a_store_is_reported_design_by_design(path) -> None:
    desk = begun(path)()
    hello, reply = ask(desk, "ready")
    assert hello.content["machine"] and hello.content["study"] == "lengths.zarr"
    content = reply.content
    assert json.dumps(content, allow_nan=False)
    assert [entry["kind"] for entry in content["columns"]] == ["number", "number", "output"]
    assert [entry["unit"] for entry in content["columns"]] == ["mm", "rpm", "N"]
    block = open_store(path).read(range(64))
    reasons = block.outcome.reason
    np.testing.assert_array_equal(column(reply, "number"), np.arange(64))
    np.testing.assert_array_equal(column(reply, "reason") == 0, reasons == 0)
    lengths = column(reply, "column.links.crank.points.B.x")
    np.testing.assert_allclose(lengths, block.values[:, 0], rtol=1e-6)
    inside = (reasons == 0) & (block.outcome.figures[:, 0] <= 20)
    np.testing.assert_array_equal(column(reply, "kept") == 1, inside)
    assert 0 < content["kept"] == np.sum(inside) < content["computed"] < content["size"] == 64
    assert sum(entry["count"] for entry in content["refused"]) == 64 - content["computed"]
    assert content["best"] == best(open_store(path), 50).designs.tolist()
    force = eq.analyze(eq.load("yamashita-1")).forces.shaking_force.value
    rms = np.sqrt(np.mean(np.abs(force) ** 2))
    assert content["own"][2] == pytest.approx(rms, rel=1e-6)


LIMITED = """
[[outputs]]
name = "moment"
value = "shaking_moment.rms"
at_most = "1 N mm"
"""


@pytest.mark.parametrize("aim", ['make = "smallest"', ""])
def test_designs_nearest_to_limits_come_first_where_none_keeps_them_all(tmp_path, aim) -> None:
    """Two limits, of which one cannot be kept; with an aim and without."""
    text = STUDY.replace('make = "smallest"', aim).replace("designs = 64", "designs = 16")
    sweep(eq.loads(text + LIMITED), tmp_path / "two.zarr", workers=1)
    reply = ask(begun(str(tmp_path / "two.zarr"))(), "ready")[1]
    good = column(reply, "reason") == 0
    numbers = column(reply, "number")[good]
    assert not column(reply, "kept").any()
    over = {"force": 20.0, "moment": 1e-3}
    lacking = sum(
        np.maximum(column(reply, f"column.{name}")[good] / most - 1, 0)
        for name, most in over.items()
    )
    assert reply.content["best"] == numbers[np.argsort(lacking)].tolist()


def test_a_design_is_opened_as_a_machine_and_left_again(path) -> None:
    desk = begun(path)()
    chosen = ask(desk, "ready")[1].content["best"][0]
    (state,) = (
        item for item in ask(desk, "design", number=chosen) if item.content["type"] == "state"
    )
    assert state.content["name"] == f"lengths.zarr {chosen}"
    assert desk.session.shown.design.machine == machine_of(open_store(path), chosen)
    assert ask(desk, "edit", edits=[{"set": "drive.speed", "text": "90 rpm"}])[0].content["undo"]
    assert ask(desk, "study")[0].content["type"] == "study"
    refused = ask(desk, "undo")[0].content
    assert refused["message"] == "a study is open; choose one of its designs first"
    assert ask(desk, "open", example="class-three")[0].content["name"] == "class-three"
    again = ask(desk, "ready")
    assert (again[0].content["study"], again[1].content["type"]) == ("lengths.zarr", "state")


def test_what_cannot_be_opened_is_reported(path, tmp_path) -> None:
    desk = begun(path)()
    content = ask(desk, "ready")[1]
    failed = int(np.flatnonzero(column(content, "reason"))[0])
    assert "choose another" in ask(desk, "design", number=failed)[0].content["message"]
    assert "has 64 designs" in ask(desk, "design", number=64)[0].content["message"]
    other = begun("yamashita-1")()
    assert "give one to `equipoise serve`" in ask(other, "study")[0].content["message"]
    with pytest.raises(UsageError):
        begun(str(tmp_path))


def test_stores_of_the_folder_are_opened_by_their_names_alone(path, tmp_path, monkeypatch) -> None:
    folder = Path(path).parent
    monkeypatch.chdir(folder)
    (folder / "other").mkdir()
    (folder / "link.zarr").symlink_to(path)
    desk = begun(None)()
    (listed,) = ask(desk, "stores")
    assert (listed.content["folder"], listed.content["names"]) == (folder.name, ["lengths.zarr"])
    for name in ("../" + Path(path).name, str(path), "other", "link.zarr", ""):
        content = ask(desk, "study", store=name)[0].content["message"]
        assert (
            content == f"{folder.name} has no store of the name {name!r}; choose one that is listed"
        )
    (shown,) = ask(desk, "study", store="lengths.zarr")
    assert shown.content["type"] == "study" and ask(desk, "ready")[0].content["study"]
    again = begun(None)()  # as after a reload
    content = ask(again, "design", number=shown.content["best"][0], store="lengths.zarr")[0]
    assert content.content["name"] == f"lengths.zarr {shown.content['best'][0]}"
    model = folder / "model.toml"
    model.write_text(example_text("yamashita-1"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert ask(begun(None)(), "stores")[0].content["names"] == []
    assert ask(begun(str(model))(), "stores")[0].content["names"] == ["lengths.zarr"]
    assert ask(Session(), "stores")[0].content["folder"] is None


def test_of_many_designs_some_are_drawn_and_the_best_among_them(path, monkeypatch) -> None:
    monkeypatch.setattr(stores, "MOST", 20)
    reply = ask(begun(path)(), "ready")[1]
    drawn = column(reply, "number")
    assert 20 <= len(drawn) <= 64 and reply.content["drawn"] == len(drawn)
    assert {*reply.content["best"]} <= {*drawn.astype(int).tolist()}
