"""Types of messages: what the page is sent holds to them, and TypeScript has the same ones."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, is_typeddict

import pytest

from equipoise.web.protocol import StateMessage
from equipoise.web.session import Session
from unit.web.pages import ask, opened, state

PAGE = Path(__file__).resolve().parents[3] / "page"


@pytest.fixture(scope="module")
def writer() -> ModuleType:
    """The script that writes the types."""
    spec = importlib.util.spec_from_file_location("page_messages", PAGE / "messages.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def misfits(writer: ModuleType, value: Any, hint: Any, place: str = "") -> Iterator[str]:
    """Places at which a value of JSON is not of a type."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        yield from misfits(writer, value, inner[0], place)
    elif origin in (Union, UnionType):
        yield from min(([*misfits(writer, value, item, place)] for item in inner), key=len)
    elif origin is Literal:
        yield from [] if value in inner else [f"{place}: {value!r}"]
    elif not isinstance(value, kind_of(hint)) or (isinstance(value, bool) and hint is not bool):
        yield f"{place}: {value!r}"
    elif is_typeddict(hint):
        yield from misfits_of_keys(writer, value, hint, place)
    elif origin is tuple and len(value) != len(inner):
        yield f"{place}: not {len(inner)} values"
    elif origin in (tuple, list):
        hints = inner if origin is tuple else inner * len(value)
        for number, (part, item) in enumerate(zip(value, hints, strict=True)):
            yield from misfits(writer, part, item, f"{place}[{number}]")
    elif origin is dict:
        for name, part in value.items():
            yield from misfits(writer, part, inner[1], f"{place}.{name}")


def kind_of(hint: Any) -> Any:
    """Class of the values that JSON gives for a type."""
    if is_typeddict(hint):
        return dict
    kinds = {tuple: list, float: (int, float)}
    origin = get_origin(hint) or hint
    return kinds.get(origin, origin)


def misfits_of_keys(writer: ModuleType, value: Any, of: Any, place: str) -> Iterator[str]:
    """Keys of an object that are missing, not declared, or of another type."""
    declared = {name: (item, required) for name, item, _, required in writer.fields(of)}
    yield from (f"{place}.{name}: not declared" for name in value if name not in declared)
    for name, (item, required) in declared.items():
        if name in value:
            yield from misfits(writer, value[name], item, f"{place}.{name}")
        elif required:
            yield f"{place}.{name}: missing"


def test_types_of_the_page_are_written_from_those_of_python(writer: ModuleType) -> None:
    assert writer.TARGET.read_text("utf-8") == writer.written(), "run python page/messages.py"


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
def test_states_of_machines_hold_to_their_type(writer: ModuleType, name: str) -> None:
    session, _ = opened(name)
    shown = state(ask(session, "outputs", seq=1, names=[])[0])
    content = json.loads(json.dumps(shown.content))
    assert [*misfits(writer, content, StateMessage)] == []


def test_states_with_all_that_can_be_asked_for_hold_to_their_type(writer: ModuleType) -> None:
    session, _ = opened("yamashita-1")
    point = {"type": "move", "move": "B", "to": [0.02, 0.03], "at": 40}
    shown = state(ask(session, "edit", seq=1, commit=True, label="edit", edits=[point])[0])
    assert shown.content["undo"] == "edit"
    shown = state(ask(session, "arrows", seq=2, point="P")[0])
    assert shown.content["arrows"]
    content = json.loads(json.dumps(shown.content))
    assert [*misfits(writer, content, StateMessage)] == []


def test_the_state_of_an_unfinished_machine_holds_to_its_type(writer: ModuleType) -> None:
    session = Session()
    (reply, *_) = [
        item for item in ask(session, "open", seq=1, new=True) if item.content["type"] == "state"
    ]
    content = json.loads(json.dumps(reply.content))
    assert content["status"]["finished"] is False
    assert [*misfits(writer, content, StateMessage)] == []


def test_keys_that_lack_or_are_too_many_are_seen(writer: ModuleType) -> None:
    session, _ = opened("yamashita-1")
    shown = state(ask(session, "outputs", seq=1, names=[])[0])
    content = json.loads(json.dumps(shown.content))
    del content["figures"][0]["label"]
    content["scene"]["signs"][0]["colour"] = "red"
    content["turns"] = "1"
    assert sorted(misfits(writer, content, StateMessage)) == [
        ".figures[0].label: missing",
        ".scene.signs[0].colour: not declared",
        ".turns: '1'",
    ]


def test_a_type_that_json_lacks_is_refused(writer: ModuleType) -> None:
    with pytest.raises(TypeError, match="complex"):
        writer.typescript(complex)
    assert writer.typescript(list[int | None]) == "(number | null)[]"
