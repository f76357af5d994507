"""Particles, whose form depends on the sound that the word before them ends in, as in Korean.

Catalogues give both forms, as in ``{name}을(를)``; one is chosen when the name is filled in.  The
rules are the table ``[particles]`` of a catalogue, which the live page follows too
(`page/src/particles.ts`).
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from equipoise.i18n.languages import content


def rules(language: str) -> Mapping[str, Any] | None:
    """The rules of a language as plain values: ``forms`` of each particle by the sound before it,
    ``endings`` by which a word tells its sound (the first that matches counts), ``closing``, the
    signs that may stand between the two, and ``reach``, how many signs before a particle are looked
    at.  None where a language has no particles.
    """
    return content(language).get("particles")


@cache
def _chooser(language: str) -> Callable[[str], str]:
    known = rules(language)
    if known is None:
        return str
    forms, closing, reach = known["forms"], known["closing"], known["reach"]
    every = re.compile("|".join(map(re.escape, forms)))
    endings = [(re.compile(pattern), sound) for pattern, sound in known["endings"]]

    def chosen(both: re.Match[str]) -> str:
        before = both.string[max(both.start() - reach, 0) : both.start()].rstrip(closing)
        word = unicodedata.normalize("NFD", before)
        sound = next((sound for ending, sound in endings if ending.search(word)), None)
        return both[0] if sound is None else str(forms[both[0]][sound])

    return lambda text: every.sub(chosen, text)


def with_particles(text: str, language: str) -> str:
    """A text in which every particle has one form; both stay where no rule knows the word."""
    return _chooser(language)(text)
