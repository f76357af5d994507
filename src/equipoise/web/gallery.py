"""The bundled machines as a page offers them: what each is, and its drawing, small and moving."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

from equipoise.i18n import said
from equipoise.results.analysis import analyze
from equipoise.symbols.clear import clear_angle
from equipoise.symbols.scene import Scene
from equipoise.web.block import FloatBlock, Values
from equipoise.web.drawing import moves_of, stage_of
from equipoise.web.kinds import search_words, section_of, sections
from equipoise.web.openings import opened_example, titles

SAMPLES = 36
"""In a turn of the crank."""
ASIDE = re.compile(r"\s*[(（][^()（）]*[)）]")
"""What a description says in brackets."""
END = re.compile(r"(?<=。)|(?<=[^A-Z]\.)\s+")
"""Where a sentence ends, but not after an initial."""


def pictured() -> Iterator[tuple[Values, bytes]]:
    """Every machine, by kind: title, first sentence, kind and words to search in the reader's
    language, drawing and arrays.
    """
    machines = {name: opened_example(name).machine for name in titles()}
    headings = sections()
    for name, machine in sorted(machines.items(), key=lambda item: section_of(item[1])):
        drawing, data = _thumbnail(name)
        text = ASIDE.sub("", " ".join(said(machine.description).split()))
        line = END.split(text, maxsplit=1)[0]
        statement = {"name": name, "title": said(machine.title), "line": line}
        statement["kind"] = headings[section_of(machine)]
        statement["words"] = f"{search_words(machine)} {text}"
        yield {**statement, **drawing}, data


@cache
def _thumbnail(name: str) -> tuple[Values, bytes]:
    """What does not depend on the language.

    at : sample at which nothing hides anything else, where a picture stands still.
    """
    scene = Scene.of(analyze(opened_example(name).machine, SAMPLES).motion)
    block = FloatBlock()
    moves_of(scene, block)
    text = {"at": clear_angle(scene), "scene": stage_of(scene, ()), "arrays": block.told}
    return text, block.data
