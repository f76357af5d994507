"""What a page is answered."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note, key_words, say, speaking, to_say
from equipoise.limits import out_of_memory
from equipoise.schema.topics import errors, known_topic, plain_page
from equipoise.web.forms import word_in_forms
from equipoise.web.messages import Message

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
    return Reply({"type": "told", "seq": seq})


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
