"""Whatever a page sends, it is answered with a state or with a sentence."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from equipoise.errors import UsageError
from equipoise.web.gallery import opened_example
from equipoise.web.messages import KINDS, read
from equipoise.web.server import packed
from equipoise.web.session import Session

NUMBERS = (0, 1, -1, 1e-3, -0.02, 0.05, 1e-9, 1e3, 1e29, -1e29, 1e31, 1e308)
TEXTS = ("0 mm", "5 mm", "-5 mm", "1e20 mm", "3 kg", "0 kg", "100 rpm", "0 rpm", "90 deg",
         "1e999 mm", "5 kg mm^2", "20 N/m", "", "5")  # fmt: skip
KEYS = (
    "type",
    "seq",
    "edits",
    "set",
    "move",
    "at",
    "to",
    "value",
    "commit",
    "name",
    "example",
    "on",
)
MACHINES = ("yamashita-1", "balance-spring", "planetary-planting-arm", "slider-crank-engine")

junk: st.SearchStrategy[Any] = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.sampled_from(KINDS) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(KEYS), inner),
    max_leaves=12,
)
fuzz = settings(
    max_examples=30, deadline=None, derandomize=True, database=None,
    suppress_health_check=list(HealthCheck),
)  # fmt: skip
OPENED = {name: opened_example(name) for name in MACHINES}


def answered(session: Session, text: str) -> list[dict[str, Any]]:
    """What is answered, which has to be fit to be sent."""
    try:
        message = read(text)
    except UsageError:
        return []
    replies = [*session.receive(message)]
    assert all(packed(reply) for reply in replies)
    for reply in replies:
        reported = reply.content.get("message", "-")
        assert 0 < len(reported) < 1000
        assert all(line.isprintable() for line in reported.splitlines())  # some are to be pasted
    return [reply.content for reply in replies]


@given(junk | st.fixed_dictionaries({"type": st.sampled_from(KINDS)}, optional={"edits": junk}))
@fuzz
def test_random_messages(message: Any) -> None:
    session = Session()
    session.open(OPENED["yamashita-1"])
    answered(session, json.dumps(message))


# Random making, and each value of tables as nonsense: the tests beside it.
@pytest.mark.exhaustive
@given(st.sampled_from(MACHINES), st.data())
@fuzz
def test_random_edits(name: str, data: st.DataObject) -> None:
    session, draw = Session(), data.draw
    session.open(OPENED[name])
    (_, shown) = answered(session, '{"type": "ready"}')
    for _ in range(draw(st.integers(1, 3))):
        field = draw(st.sampled_from(shown["fields"]))["path"]
        to = [draw(st.sampled_from(NUMBERS)), draw(st.sampled_from(NUMBERS))]
        at = draw(st.sampled_from((0, 100, 719, 720)))
        point, link = (
            draw(st.sampled_from(shown["scene"][kind])) for kind in ("movable", "mass_centers")
        )
        changes = [
            {"set": field, "value": to[0]},
            {"set": field, "text": draw(st.sampled_from(TEXTS))},
            {"move": point, "to": to, "at": at},
            {"move_mass": link, "to": to, "at": at},
        ]
        change = draw(st.sampled_from(changes))
        edit = {"type": "edit", "commit": draw(st.booleans()), "edits": [change]}
        replies = answered(session, json.dumps(edit))
        assert replies[0]["type"] in {"state", "refused"}
        shown = next((reply for reply in replies if reply["type"] == "state"), shown)


MAKING: dict[str, tuple[str, ...]] = {
    "point": ("spot", "on"),
    "link": ("from", "to"),
    "slider": ("from", "to"),
    "gears": ("driver", "driven"),
    "drive": ("link",),
    "pin": ("point", "to"),
    "separate": ("point",),
    "ground": ("point",),
    "free": ("point",),
    "delete": ("what",),
}
"""What a page does, with what it needs."""


def operation(scene: dict[str, Any], draw: Any) -> dict[str, Any]:
    """Something that is done to what is shown, with parts that there mostly are."""
    points = [*scene["frame"], *(item for body in scene["bodies"] for item in body["points"]), "Z"]
    links = [*(body["name"] for body in scene["bodies"]), "nothing"]
    do = draw(st.sampled_from([*MAKING]))
    spots = [{"point": draw(st.sampled_from(points))}]
    place = [draw(st.sampled_from(NUMBERS)), draw(st.sampled_from(NUMBERS))]
    spots += [{"place": place}, {"place": place, "on": draw(st.sampled_from([*links, "frame"]))}]
    asked: dict[str, Any] = {"type": "make", "do": do, "teeth": 20, "driven_teeth": 40, "number": 1}
    for key in MAKING[do]:
        if key in {"spot", "from"} or (key == "to" and do != "pin"):
            asked[key] = draw(st.sampled_from(spots))
        elif key == "what":
            what = draw(st.sampled_from(("point", "link", "slider", "gear")))
            asked |= {"what": what, "name": draw(st.sampled_from(points + links))}
        else:
            asked[key] = draw(st.sampled_from(points if key in {"point", "to"} else links))
    return asked


@given(st.sampled_from((*MACHINES, "")), st.data())
@fuzz
def test_random_making(name: str, data: st.DataObject) -> None:
    session = Session()
    if name:
        session.open(OPENED[name])
        (_, shown) = answered(session, '{"type": "ready"}')
    else:
        (shown,) = answered(session, '{"type": "open", "new": true}')
    for _ in range(data.draw(st.integers(1, 8))):
        replies = answered(session, json.dumps(operation(shown["scene"], data.draw)))
        assert replies[0]["type"] in {"state", "refused"}
        shown = replies[0] if replies[0]["type"] == "state" else shown
        assert isinstance(shown["status"]["mobility"], int) and shown["status"]["text"]
