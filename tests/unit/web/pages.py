"""A page without a browser: what it sends and what it is answered."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.web.gallery import opened_example
from equipoise.web.messages import message_of
from equipoise.web.replies import Reply
from equipoise.web.session import Session
from unit.web.typed import misfits_of_reply

Array = np.ndarray[Any, Any]
Content = dict[str, Any]


@dataclass
class State:
    """What a page knows of a machine."""

    content: Content
    block: Array

    def array(self, name: str) -> Array:
        offset, length = self.content["arrays"][name]
        return self.block[offset : offset + length].astype(float)

    def vector(self, name: str) -> Array:
        """Complex (N,)."""
        return self.array(name).view(complex)

    def place(self, point: str) -> Array:
        return self.vector(f"place.{point}")

    def field(self, path: str) -> Content:
        (actual,) = [entry for entry in self.content["fields"] if entry["path"] == path]
        return actual

    def figure(self, name: str) -> Content:
        (actual,) = [entry for entry in self.content["figures"] if entry["name"] == name]
        return actual


def state(reply: Reply) -> State:
    assert reply.content["type"] == "state", reply.content
    return State(reply.content, np.frombuffer(reply.buffer, "<f4"))


def opened(name: str) -> tuple[Session, State]:
    """A session of an example, and its first state."""
    session = Session()
    session.open(opened_example(name))
    return session, state(ask(session, "ready")[1])


def ask(session: Session, asked: str, /, **values: Any) -> list[Reply]:
    """The answers to a message, which goes by way of JSON; each has to hold to its type."""
    replies = [*session.receive(message_of(json.loads(json.dumps({"type": asked, **values}))))]
    for reply in replies:
        content = json.loads(json.dumps(reply.content))
        if values.get("seq") is None and content.get("seq", 0) is None:
            content["seq"] = 0  # a page numbers what it asks
        assert misfits_of_reply(content) == []
    return replies


def edit(session: Session, *edits: Content, commit: bool = True, label: str = "edit") -> State:
    return state(ask(session, "edit", seq=1, commit=commit, label=label, edits=edits)[0])


def refusal(replies: list[Reply]) -> str:
    """The sentence with which something is refused."""
    content = replies[0].content
    assert content["type"] == "refused", content
    assert all(line.isprintable() for line in content["message"].split("\n"))
    return str(content["message"])


def move(point: str, to: complex, at: int) -> Content:
    return {"move": point, "to": [to.real, to.imag], "at": at}


def counterweight(*texts: str) -> list[Content]:
    """The edits that give the crank a counterweight."""
    keys = ("mass", "radius", "direction")
    return [
        {"set": f"counterweights.crank.{key}", "text": text}
        for key, text in zip(keys, texts, strict=True)
    ]


def unpacked(data: bytes) -> tuple[Content, bytes]:
    """Header and block of a message of the server."""
    (length,) = struct.unpack_from("<I", data)
    begin = -(-(4 + length) // 4) * 4
    return json.loads(data[4 : 4 + length]), data[begin:]
