"""What a page is answered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from equipoise.errors import EquipoiseError, ModelError, to_paste

LONGEST = 800
"""Signs of a sentence."""


@dataclass(frozen=True)
class Reply:
    """What a page is sent: values for JSON, and a block of 32-bit floats or of a file."""

    content: dict[str, Any]
    buffer: bytes = b""


def refused(seq: int | None, error: EquipoiseError, language: str = "en") -> Reply:
    """Say why something cannot be done, in a language."""
    told = _shortened(error.told(language))
    content: dict[str, Any] = {"type": "refused", "seq": seq, "message": told}
    if isinstance(error, ModelError) and error.where:
        what = EquipoiseError(error.what).told(language)
        content |= {"path": error.where, "what": _shortened(what)}
    return Reply(content)


def _shortened(text: str) -> str:
    sentence, *lines = to_paste(text)
    text = "\n".join([" ".join(sentence.split()), *lines])
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 200]} ... {text[-190:]}"
