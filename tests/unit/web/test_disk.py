"""The file that a server was started with: written in place, and only as long as it is ours."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.web.desk import begun
from equipoise.web.files import on_disk
from equipoise.web.gallery import opened_file
from equipoise.web.session import Session
from surface.running import example_text
from unit.web.pages import ask, edit, refusal, state

CHANGE = {"set": "links.crank.mass", "text": "300 g"}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(example_text("yamashita-1"), encoding="utf-8")
    return path


def session_of(path: Path | str) -> Session:
    """What a page of `equipoise serve FILE` begins with."""
    session = Session()
    session.open(opened_file(path))
    session.disk = on_disk(str(path), session.shown.design.machine)
    return session


def test_a_file_is_saved_in_place(path: Path) -> None:
    session = session_of(path)
    base = session.hello().content["base"]
    assert base and state(ask(session, "ready")[1]).content["file"]["saved"]
    changed = edit(session, CHANGE).content
    assert changed["file"] == {"name": "mine.toml", "saved": False, "comments": True}
    after, reply = ask(session, "save", seq=1)
    assert reply.content["base"] == session.hello().content["base"] != base
    assert state(after).content["file"] == {"name": "mine.toml", "saved": True, "comments": False}
    own = eq.load("yamashita-1")
    assert eq.load(path) == own.with_link("crank", mass=0.3)
    assert eq.loads(reply.content["text"]) == own  # with what the steps began
    undone = state(ask(session, "undo")[0]).content
    assert (undone["steps"], undone["file"]["saved"]) == ([0, 1], False)


def test_what_somebody_else_wrote_is_not_lost(path: Path) -> None:
    session = session_of(path)
    edit(session, CHANGE)
    other = example_text("yamashita-2")
    path.write_text(other, encoding="utf-8")
    assert "by another page or program" in refusal(ask(session, "save"))
    assert path.read_text(encoding="utf-8") == other
    path.unlink()
    assert "moved or deleted" in refusal(ask(session, "save"))
    assert not path.exists()


def test_pages_do_not_write_over_each_other(path: Path) -> None:
    begin = begun(str(path))
    first, other = begin().session, begin().session
    edit(first, CHANGE)
    edit(other, {**CHANGE, "text": "150 g"})
    ask(first, "save")
    saved = path.read_text(encoding="utf-8")
    assert "by another page or program" in refusal(ask(other, "save"))
    assert path.read_text(encoding="utf-8") == saved
    ask(first, "undo")
    ask(first, "save")
    assert eq.load(path) == eq.load("yamashita-1")
    path.write_text(saved, encoding="utf-8")  # by a program of another kind
    again = begin().session
    assert again.shown.design.machine == eq.loads(saved)
    path.write_text("schema = 2", encoding="utf-8")
    assert begin().session.shown.design.machine == eq.load("yamashita-1")


def test_no_table_is_named_that_is_not_there(path: Path) -> None:
    session = session_of(path)
    values = {"link": "coupler", "table": "push.csv"}
    files = {"push.csv": "crank_angle [deg],torque [N m]\n0,1\n180,2\n360,1\n"}
    ask(session, "entry", label="", place="loads[1]", values=values, files=files)
    assert "the table 'push.csv' does not lie beside it" in refusal(ask(session, "save"))
    (model,) = ask(session, "download", kind="model")
    for name, text in model.content["files"].items():
        (path.parent / name).write_text(text, encoding="utf-8")
    ask(session, "save")
    assert eq.load(path) == session.shown.design.machine


def test_nothing_but_the_opened_file_is_written(path: Path) -> None:
    session = session_of(path)
    shown = state(ask(session, "open", example="drag-link")[0]).content
    assert shown["file"] is None
    assert "not opened from a file" in refusal(ask(session, "save"))
    begun = session_of(path)
    assert state(ask(begun, "open", new=True)[0]).content["file"] is None
    example = session_of("yamashita-1")
    assert "yamashita-1 was not opened from a file" in refusal(ask(example, "save"))
    again = session_of(path)
    text = example_text("watt-six-bar")  # what a page has kept of the same file
    kept = state(ask(again, "open", name="mine.toml", text=text, file=True)[0]).content
    assert kept["file"]["saved"] is False
    ask(again, "save")
    assert eq.load(path) == eq.load("watt-six-bar")


def test_what_was_done_goes_on_with_the_tables_of_the_file(tmp_path: Path) -> None:
    path, name = tmp_path / "engine.toml", "four-stroke-gas.csv"
    path.write_text(example_text("four-stroke-engine"), encoding="utf-8")
    table = files("equipoise").joinpath("examples", name).read_text(encoding="utf-8")
    (tmp_path / name).write_text(table, encoding="utf-8")
    session = begun(str(path))().session
    text = path.read_text(encoding="utf-8")
    kept = state(ask(session, "open", name="engine.toml", text=text, file=True)[0]).content
    assert kept["file"]["saved"]
    assert "is not known here" in refusal(ask(session, "open", name="engine.toml", text=text))
