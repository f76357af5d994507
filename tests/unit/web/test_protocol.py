"""Types of messages: what the page is sent holds to them, and TypeScript has the same ones."""

from __future__ import annotations

import json
from typing import Any, get_args

import pytest

from equipoise.web.messages import KINDS
from equipoise.web.protocol import PageRequest, StateMessage
from equipoise.web.session import Session
from unit.web.pages import ask, opened, state
from unit.web.typed import declared_keys, misfits, misfits_of_reply, sent, writer


def test_types_of_the_page_are_written_from_those_of_python() -> None:
    assert writer().TARGET.read_text("utf-8") == writer().written(), "run python page/messages.py"


@pytest.mark.parametrize(
    "name",
    [
        "yamashita-1",
        "kim-chung-a",
        "four-row-transplanter",
        "yamashita-rig",
        "quick-return",
        "cam-pusher",
        "planetary-planting-arm",
    ],
)
def test_states_of_machines_hold_to_their_type(name: str) -> None:
    session, _ = opened(name)
    shown = state(ask(session, "outputs", seq=1, names=[])[0])
    content = json.loads(json.dumps(shown.content))
    assert [*misfits(content, StateMessage)] == []


def test_states_with_all_that_can_be_asked_for_hold_to_their_type() -> None:
    session, _ = opened("yamashita-1")
    point = {"type": "move", "move": "B", "to": [0.02, 0.03], "at": 40}
    shown = state(ask(session, "edit", seq=1, commit=True, label="edit", edits=[point])[0])
    assert shown.content["undo"] == "edit"
    shown = state(ask(session, "arrows", seq=2, point="P")[0])
    assert shown.content["arrows"]
    content = json.loads(json.dumps(shown.content))
    assert [*misfits(content, StateMessage)] == []


def test_the_state_of_an_unfinished_machine_holds_to_its_type() -> None:
    session = Session()
    (reply, *_) = [
        item for item in ask(session, "open", seq=1, new=True) if item.content["type"] == "state"
    ]
    content = json.loads(json.dumps(reply.content))
    assert content["status"]["finished"] is False
    assert [*misfits(content, StateMessage)] == []


def test_keys_that_lack_or_are_too_many_are_seen() -> None:
    session, _ = opened("yamashita-1")
    shown = state(ask(session, "outputs", seq=1, names=[])[0])
    content = json.loads(json.dumps(shown.content))
    del content["figures"][0]["label"]
    content["scene"]["signs"][0]["colour"] = "red"
    content["turns"] = "1"
    assert sorted(misfits(content, StateMessage)) == [
        ".figures[0].label: missing",
        ".scene.signs[0].colour: not declared",
        ".turns: '1'",
    ]


def test_a_type_that_json_lacks_is_refused() -> None:
    with pytest.raises(TypeError, match="complex"):
        writer().typescript(complex)
    assert writer().typescript(list[int | None]) == "(number | null)[]"


def test_a_page_can_ask_all_that_a_server_knows_and_nothing_else() -> None:
    kinds = {
        kind for item in get_args(PageRequest) for kind in get_args(declared_keys(item)["type"][0])
    }
    assert kinds == set(KINDS)


MASS = {"set": "links.crank.mass", "value": 0.2}
TORQUE_CHART = {"kind": "chart", "chart": "output", "choice": "drive_torque", "format": "svg"}


@pytest.mark.parametrize(
    ("asked", "values", "answers"),
    [
        ("speak", {"languages": ["ko"]}, {"spoken"}),
        ("open", {"example": "quick-return"}, {"state"}),
        ("open", {"new": True}, {"state"}),
        ("edit", {"commit": True, "label": "edit", "edits": [MASS]}, {"state"}),
        ("balance", {}, {"state", "balanced"}),
        ("run", {}, {"run"}),
        ("tables", {}, {"tables"}),
        ("download", {"kind": "model"}, {"file"}),
        ("download", TORQUE_CHART, {"file"}),
        ("arrows", {"point": "B"}, {"state"}),
        ("variant", {"do": "pin"}, {"variants"}),
        ("stores", {}, {"stores"}),
        ("outputs", {"names": ["drive_torque"]}, {"state"}),
        ("make", {"do": "nothing", "at": 0}, {"refused"}),
        ("design", {"number": 3, "store": "lengths.zarr"}, {"refused"}),
    ],
)
def test_questions_and_answers_hold_to_their_types(
    asked: str, values: dict[str, Any], answers: set[str]
) -> None:
    """`ask` looks at every answer; here the question is one that the page may send too."""
    question = {"type": asked, **values}
    of = [
        item for item in get_args(PageRequest) if asked in get_args(declared_keys(item)["type"][0])
    ]
    assert any([*misfits(question, item)] == [] for item in of)
    session, _ = opened("yamashita-1")
    kinds = {reply.content["type"] for reply in ask(session, asked, seq=1, **values)}
    assert answers <= kinds <= {*sent()}


def test_what_comes_later_holds_to_its_type() -> None:
    """The side, strokes, gauges, figures of planting and the response over speed."""
    kinds = set()
    for name in ("yamashita-rig", "kim-chung-a", "walking-transplanter"):
        session, _ = opened(name)
        for reply in session.deferred_replies():
            content = json.loads(json.dumps(reply.content))
            assert misfits_of_reply(content) == []
            kinds.add(content["type"])
    assert {"strokes", "gauges", "planting", "response"} <= kinds
