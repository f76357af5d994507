"""What a page is answered: values, arrays in one block of 32-bit floats, and refusals.

Most of a state stays from one move of a drag to the next.  To write it as JSON, and to read that,
takes longer in a browser than to compare it, so that a worker hands its page the changes
(`StateChanges`), from which `page/src/site/wire.ts` puts states together again.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Sequence
from dataclasses import field
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note, key_words, say, speaking, to_say
from equipoise.limits import out_of_memory
from equipoise.schema.topics import errors, known_topic, plain_page
from equipoise.signals import Array
from equipoise.web.messages import JsonObject, Message, message_of
from equipoise.web.tables import word_in_forms

LONGEST = 800
"""Signs of a sentence."""


CANCELLED = Note("cancelled; nothing was changed")


MISTAKE = Note("this went wrong inside the program, and nothing was changed; please report it")


BUSY = {
    "balance": to_say("balancing"),
    "run": to_say("running the machine"),
    "download": to_say("making the file"),
}
"""What is under way, by the kind of message that asks for it."""


LONG_FILES = ("report", "drawing", "chart", "film", "played")
"""Kinds of files that take longer than a moment."""


@dataclass(frozen=True)
class Reply:
    """What a page is sent: values for JSON, and a block of 32-bit floats or of a file."""

    content: dict[str, Any]
    buffer: bytes = b""


@dataclass
class FloatBlock:
    """Arrays one behind the other, as 32-bit floats, and where each begins.

    An array that is added under several names is there once.
    """

    places: dict[str, tuple[int, int]] = field(default_factory=dict)
    parts: list[Array] = field(default_factory=list)
    size: int = 0
    added: dict[int, tuple[Array, tuple[int, int]]] = field(default_factory=dict)

    def add(self, name: str, values: Array) -> None:
        """Add real (N,) values, or complex ones as (2 N,): x and y in turn."""
        if id(values) in self.added:
            self.places[name] = self.added[id(values)][1]
            return
        flat = np.ascontiguousarray(values).ravel()
        if np.iscomplexobj(flat):
            flat = flat.view(float)
        self.parts.append(flat)
        self.places[name] = (self.size, flat.size)
        self.added[id(values)] = values, self.places[name]  # which keeps the array, and so its id
        self.size += flat.size

    @property
    def placement(self) -> dict[str, list[int]]:
        """Offset and length of each array, in numbers."""
        return {name: list(place) for name, place in self.places.items()}

    @property
    def data(self) -> bytes:
        """All arrays, little-endian."""
        if not self.parts:
            return b""
        with np.errstate(over="ignore"):  # what no drawing could show
            return np.concatenate(self.parts, dtype="<f4", casting="unsafe").tobytes()


def refused(seq: int | None, error: EquipoiseError, language: str = "en") -> Reply:
    """Say why something cannot be done, in a language."""
    shortened = _shortened(error.message(language, lines=True), error.lines)
    content: dict[str, Any] = {"type": "refused", "seq": seq, "message": shortened}
    what = error
    if isinstance(error, ModelError):
        what = EquipoiseError(error.what)
        content |= {"path": error.where} if error.where else {}
    if topic := known_topic(error.topic):
        content["topic"] = topic
        content |= {"cure": plain_page(topic)} if topic in errors() else {}
    with key_words(word_in_forms):
        content["what"] = _shortened(what.message(language))
    return Reply(content)


def unexpected(error: Exception) -> UsageError:
    """The sentence for an error that nobody refuses: of memory that is used up, or of a mistake of
    the program.
    """
    if isinstance(error, MemoryError):
        return out_of_memory(error)
    return UsageError(
        Note(
            "{mistake} ({kind}: {error})",
            mistake=MISTAKE,
            kind=type(error).__name__,
            error=str(error),
        )
    )


def busy(message: Message, language: str) -> Reply | None:
    """Immediate reply to a question that takes long, also while it waits for others;
    None of one that takes a moment.
    """
    if message.kind not in BUSY:
        return None
    if message.kind == "download" and message.values.get("kind") not in LONG_FILES:
        return None
    with speaking(language):
        return Reply({"type": "busy", "seq": message.seq, "what": say(BUSY[message.kind])})


def completed(seq: int | None) -> Reply:
    """Say that a question has all its answers, also those that take longer."""
    return Reply({"type": "answered", "seq": seq})


def packed(reply: Reply) -> bytes:
    """A reply as one message: length of the header, header in JSON, then the block.

    Zeros fill the header up, so that the block begins at a multiple of four bytes.
    """
    header = json.dumps(reply.content, ensure_ascii=False, allow_nan=False).encode()
    filling = bytes(-len(header) % 4)
    return b"".join([struct.pack("<I", len(header)), header, filling, reply.buffer])


def _shortened(sentence: str, lines: Sequence[str] = ()) -> str:
    text = "\n".join([" ".join(sentence.split()), *lines])
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 200]} ... {text[-190:]}"


class Counterpart(Protocol):
    """What a page talks to."""

    @property
    def language(self) -> str:
        """That the reader speaks."""

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message."""

    @property
    def has_more(self) -> bool:
        """Whether deferred replies are due."""

    def deferred_replies(self) -> Iterator[Reply]:
        """Replies that take too long for every move of a drag."""


def answers(to: Counterpart, content: object) -> Iterator[Reply]:
    """All replies to a message, as it was read from JSON; what takes longer comes last.

    This is all that a transport needs that is no server: it hands `Reply.content` over as an object
    and `Reply.buffer` as bytes, or both as `replies.packed` writes them.
    """
    try:
        message = message_of(content)
    except EquipoiseError as error:
        yield refused(None, error)
        return
    if (begun := busy(message, to.language)) is not None:
        yield begun
    yield from to.receive(message)
    if message.preview:
        return
    if to.has_more:
        yield from to.deferred_replies()
    yield completed(message.seq)


ALWAYS = ("type", "seq")
"""Keys by which a message is known; they are never left out."""


MOST = 0.5
"""Share of a list that may differ; beyond it the list is sent as a whole."""


class StateChanges:
    """Leaves out of each state what the page has from the one before."""

    def __init__(self) -> None:
        self._last: JsonObject = {}

    def of(self, reply: Reply) -> Reply:
        """A reply as it is sent: of a state the changes, of all else the whole."""
        if reply.content["type"] != "state":
            return reply
        last, self._last = self._last, reply.content
        always = {key: reply.content[key] for key in ALWAYS}
        return Reply(always | changes(last, reply.content), reply.buffer)


def changes(before: JsonObject, now: JsonObject) -> JsonObject:
    """The keys of `now` that differ, and what of the others there is to do.

    same : keys whose values are those of before.
    items : by the key of a list, the numbers of items that differ, each with the new one.
    inside : by the key of an object, its changes.
    """
    result: JsonObject = {}
    same, items, inside = list[str](), JsonObject(), JsonObject()
    for key, value in now.items():
        old = before.get(key)
        if key in before and (old is value or old == value):
            same.append(key)
        elif isinstance(value, dict) and isinstance(old, dict) and old:
            inside[key] = changes(old, value)
        elif (differing := _differing(old, value)) is not None:
            items[key] = differing
        else:
            result[key] = value
    return {"since": {"same": same, "items": items, "inside": inside}, **result}


def _differing(old: object, value: object) -> list[list[Any]] | None:
    """Items of a list that differ, with their numbers; None where it is sent as a whole."""
    if not (isinstance(value, list) and isinstance(old, list) and len(old) == len(value)):
        return None
    pairs = enumerate(zip(old, value, strict=True))
    result = [[number, item] for number, (other, item) in pairs if other != item]
    return result if len(result) <= MOST * len(value) else None
