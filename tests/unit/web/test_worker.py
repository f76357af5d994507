"""The page in a browser's workers: one reply a step, long work apart, and packages when needed."""

from __future__ import annotations

import json
from itertools import count
from typing import Any
from unittest.mock import Mock

import pytest

from equipoise.i18n import catalogue
from equipoise.web import worker
from equipoise.web.worker import Background, Foreground
from unit.web.pages import unpacked


def texts(page: Foreground) -> list[dict[str, Any]]:
    """All that the first worker says until it rests."""
    heard = []
    while (reply := page.step()) is not None:
        heard.append(unpacked(reply)[0])
    return heard


SEQ = count(7)


def asked(page: Foreground, what: str, **values: Any) -> list[dict[str, Any]]:
    page.take(json.dumps({"type": what, "seq": next(SEQ), **values}))
    return texts(page)


def kinds(replies: list[dict[str, Any]]) -> list[str]:
    return [reply["type"] for reply in replies]


def done_beside(page: Foreground) -> list[dict[str, Any]]:
    """Compute the tasks as the second worker does; all that the page is told of them."""
    heard = []
    while page.tasks:
        beside = Background()
        beside.begin(memoryview(page.tasks.popleft()))
        while (step := beside.step()) is not None:
            kind, data = step
            if kind == "result":
                page.result_of_task(memoryview(data))
                break
            if page.wants_reply():
                heard.append(unpacked(data)[0])
        heard += texts(page)
    return heard


MASS = {"set": "links.crank.mass", "text": "300 g"}


@pytest.fixture
def page() -> Foreground:
    return shown("balance-crank")


def shown(example: str) -> Foreground:
    """A page with a machine, of which all is told that follows from it."""
    page = Foreground()
    asked(page, "open", example=example)
    page.rest()
    done_beside(page)
    return page


def test_a_page_is_answered_and_what_follows_is_computed_beside() -> None:
    page = Foreground()
    assert kinds(asked(page, "ready")) == ["hello", "answered"]
    assert kinds(asked(page, "open", example="transplanter")) == ["state"]
    page.rest()
    assert kinds(done_beside(page)) == ["strokes", "planting", "answered"]
    page.rest()
    assert not page.tasks


def test_an_edit_that_was_only_tried_makes_way(page: Foreground) -> None:
    for mass in ("300 g", "310 g", "320 g"):
        edit = {"set": "links.crank.mass", "text": mass}
        page.take(json.dumps({"type": "edit", "seq": next(SEQ), "commit": False, "edits": [edit]}))
    assert kinds(texts(page)).count("state") == 1
    assert page.desk.session.shown.design.machine.links["crank"].mass == pytest.approx(0.32)


def test_a_balance_is_computed_beside_while_the_page_answers(page: Foreground) -> None:
    assert kinds(asked(page, "balance")) == ["busy"]
    assert "state" in kinds(asked(page, "outputs", names=["drive_torque"]))
    reported = kinds(done_beside(page))
    assert reported[:2] == ["balanced", "state"]
    assert page.desk.session.history is not None
    assert page.desk.session.history.undo == "balance"


def test_a_balance_of_a_machine_that_was_changed_is_refused(page: Foreground) -> None:
    asked(page, "balance")
    asked(page, "edit", label="mass", edits=[MASS])
    (refusal,) = [item for item in done_beside(page) if item["type"] == "refused"]
    assert "was changed while it was balanced" in refusal["message"]


def test_a_run_is_computed_beside_of_the_design_that_was_shown(page: Foreground) -> None:
    assert kinds(asked(page, "run")) == ["busy"]
    shown = asked(page, "outputs", names=["drive_torque"])[0]
    (run,) = [item for item in done_beside(page) if item["type"] == "run"]
    assert run["design"] == page.desk.session.number_of(page.desk.session.current()) > 0
    assert shown["type"] == "state"
    asked(page, "run")
    asked(page, "edit", label="mass", edits=[MASS])
    (old,) = [item for item in done_beside(page) if item["type"] == "run"]
    assert old["design"] == run["design"]
    assert old["design"] != page.desk.session.number_of(page.desk.session.current())


def test_a_design_is_computed_once_for_all_that_is_asked_of_it(
    page: Foreground, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As its run is, and another one is computed anew."""
    beside, designs = Background(), []
    solved = Mock(side_effect=worker.solved)
    monkeypatch.setattr(worker, "solved", solved)
    for kind in ("csv", "csv"):
        asked(page, "download", kind=kind)
    asked(page, "edit", label="mass", edits=[MASS])
    asked(page, "download", kind="csv")
    while page.tasks:
        beside.begin(memoryview(page.tasks.popleft()))
        while (step := beside.step()) is not None and step[0] != "result":
            designs.append(unpacked(step[1])[0]["type"])
    assert designs == ["file", "file", "file"]
    assert solved.call_count == 2


@pytest.mark.exhaustive(but=["run"])
@pytest.mark.parametrize("what", ["balance", "run"])
def test_what_takes_long_can_be_cancelled(page: Foreground, what: str) -> None:
    """Every question that was asked has its answer."""
    busy = [*asked(page, what), *asked(page, "run")]
    assert kinds(busy) == ["busy", "busy"]
    page.cancel()
    assert not page.tasks
    *refusals, last = texts(page)
    assert {refusal["message"] for refusal in refusals} == {"cancelled; nothing was changed"}
    assert [refusal["seq"] for refusal in refusals] == [item["seq"] for item in busy]
    assert last == {"type": "answered", "seq": busy[-1]["seq"]}
    assert kinds(asked(page, "edit", label="mass", edits=[MASS]))[0] == "state"


def test_what_follows_from_a_design_comes_after_a_cancel_all_the_same() -> None:
    """Where it was computed in the worker that has been ended."""
    page = shown("balance-rig")
    asked(page, "edit", label="mass", edits=[MASS])
    page.rest()
    assert len(page.tasks) == 1
    asked(page, "balance")
    page.cancel()
    texts(page)
    page.rest()
    assert {"response", "strokes"} <= {*kinds(done_beside(page))}


def test_downloads_come_from_beside(page: Foreground) -> None:
    assert asked(page, "download", kind="csv") == []
    (file, *_) = [item for item in done_beside(page) if item["type"] == "file"]
    assert file["name"].endswith(".csv")


def test_nonsense_and_mistakes_leave_the_page_alive(page: Foreground) -> None:
    page.take("[]")
    assert kinds(texts(page)) == ["refused"]
    assert kinds(asked(page, "study", store="x"))[0] == "refused"
    assert kinds(asked(page, "edit", label="mass", edits=[MASS]))[0] == "state"


def test_memory_that_is_used_up_is_a_sentence_here_and_beside(
    page: Foreground, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not a mistake of the program that is to be reported."""

    def large(*_: object) -> Any:
        raise MemoryError
        yield

    monkeypatch.setattr("equipoise.web.balanced.balancing_of", lambda *_: next(large()))
    asked(page, "balance")
    replies = done_beside(page)
    monkeypatch.setattr(page.desk, "receive", large)
    replies += asked(page, "edit", label="mass", edits=[MASS])
    reported = [reply["message"] for reply in replies if reply["type"] == "refused"]
    assert len(reported) == 2
    assert all(item.startswith("not enough memory: needs more, and ") for item in reported)


def test_a_package_is_asked_for_and_the_message_begun_again(
    page: Foreground, monkeypatch: pytest.MonkeyPatch
) -> None:
    receive = page.desk.receive

    def lacking(message: Any) -> Any:
        raise ModuleNotFoundError("no module", name="scipy.sparse")
        yield

    monkeypatch.setattr(page.desk, "receive", lacking)
    page.take(json.dumps({"type": "edit", "seq": next(SEQ), "label": "mass", "edits": [MASS]}))
    assert page.step() is None
    assert page.missing == "scipy"
    monkeypatch.setattr(page.desk, "receive", receive)
    assert kinds(texts(page))[0] == "state"
    monkeypatch.setattr(page.desk, "receive", lacking)
    page.lacks("scipy")
    (refusal,) = [item for item in asked(page, "undo") if item["type"] == "refused"]
    assert "this needs scipy" in refusal["message"]


def test_numbers_follow_a_drag_more_seldom_and_in_full_where_it_pauses(
    page: Foreground, monkeypatch: pytest.MonkeyPatch
) -> None:
    def dragged(text: str, **more: Any) -> dict[str, Any]:
        edit = {"set": "links.crank.mass", "text": text}
        return asked(page, "edit", label="mass", edits=[edit], **more)[0]

    def changed(reported: dict[str, Any]) -> set[str]:
        return {*reported, *reported["since"]["items"]} & {"fields", "figures"}

    numbers = {"fields", "figures"}
    monkeypatch.setattr(worker, "SELDOM", 0.0)
    assert changed(dragged("310 g", commit=False)) == numbers
    monkeypatch.setattr(worker, "SELDOM", float("inf"))
    moved = dragged("320 g", commit=False)
    assert not changed(moved)
    assert "arrays" in moved["since"]["same"]  # which are as long; the drawing is in them
    assert page.rest()
    (paused,) = [item for item in texts(page) if item["type"] == "state"]
    assert changed(paused) == numbers
    assert not page.rest()
    assert not changed(dragged("330 g", commit=False))
    assert changed(dragged("330 g")) == numbers
    assert not page.rest()


def without_texts(language: str) -> Any:
    raise ModuleNotFoundError(f"texts of {language!r} are not installed", name="equipoise-ja")


def test_a_language_is_spoken_once_its_texts_are_loaded(
    page: Foreground, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where they cannot be loaded the page goes on in the language that it speaks."""
    speak = json.dumps({"type": "speak", "seq": next(SEQ), "languages": ["ja-JP", "en"]})
    monkeypatch.setattr("equipoise.web.session.spoken_in", without_texts)
    page.take(speak)
    assert page.step() is None
    assert page.missing == "equipoise-ja"
    page.lacks("equipoise-ja")
    (refusal,) = [text for text in texts(page) if text["type"] == "refused"]
    assert "this needs equipoise-ja" in refusal["message"]
    assert asked(page, "undo")[0]["message"] == "there is nothing to undo"
    monkeypatch.undo()
    (spoken,) = [
        item for item in asked(page, "speak", languages=["ja-JP"]) if item["type"] == "spoken"
    ]
    assert spoken["words"]["Undo"] == catalogue("ja")["Undo"]
    assert asked(page, "undo")[0]["message"] == catalogue("ja")["there is nothing to undo"]
