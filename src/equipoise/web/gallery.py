"""The bundled machines as a page offers them, by kind, and opening them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note, capital, localized, say, speaking, to_say
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.links import Slider
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.analysis import analyze
from equipoise.schema.files import printable
from equipoise.schema.models import HeldFiles, load_linkage, loads_linkage, machine_of
from equipoise.schema.open_files import content_of, examples, in_file, kind_of_text, opened
from equipoise.symbols.scene import Scene, clear_angle
from equipoise.web.design import Design
from equipoise.web.drawing import moves_of, stage_of
from equipoise.web.messages import JsonObject, Message
from equipoise.web.replies import FloatBlock

BARS = {
    4: to_say("four-bar linkage"),
    6: to_say("six-bar linkage"),
    8: to_say("eight-bar linkage"),
}
"""Linkages without sliding joints by the number of their bars, the frame among them."""


def sections(of: type[Machine] = Machine) -> tuple[str, ...]:
    """Return the headings of the gallery in their order, in the language that is spoken.

    of : class of machines whose kinds of couplings have a section of their own.
    """
    coupled = say(", ").join(say(kind.group) for kind in coupling_kinds(of).values())
    return (
        say("Planting mechanisms"),
        say("Linkages"),
        capital(coupled),
        say("Machines on mounts"),
        say("Machines to balance"),
    )


def section_of(machine: Machine) -> int:
    """Return which of `sections` a machine is in; of several the last."""
    fits = (
        machine.planting is not None,
        True,
        bool(machine.couplings),
        machine.support is not None,
        machine.balance is not None,
    )
    others = [index for index, fit in enumerate(fits) if fit and index != 1]
    return max(others, default=1)


def search_words(machine: Machine) -> str:
    """Return the words that a machine is found by beside its title and description, in English and
    in the language that is spoken.
    """
    spoken = [*_features(machine)]
    with speaking("en"):
        english = [*_features(machine)]
    return " ".join(dict.fromkeys((*spoken, *english)))


def _features(machine: Machine) -> Iterator[str]:
    """What a machine has, and what it is by its build, in the language that is spoken."""
    yield sections(type(machine))[section_of(machine)]
    couplings = bool(machine.couplings)
    bars = BARS.get(len(machine.links) + 1)
    if bars is not None and not machine.sliders and not couplings:
        yield say(bars)
    if machine.sliders:
        yield say(Slider.group)
    if len(machine.sliders) == 1 and len(machine.links) == 3 and not couplings:
        yield say("slider-crank")
    for table, kind in part_kinds(type(machine)).items():
        if getattr(machine, table):
            yield say(kind.group)
    for drive in machine.driven:
        if drive.group:
            yield say(drive.group)
    if machine.support is not None:
        yield say("mounts and gauges")
    if machine.rows:
        yield say("several rows")


NO_FILES: Mapping[str, str] = MappingProxyType({})
NO_TABLES: Mapping[tuple[str, str], Any] = MappingProxyType({})
TOOLS = Note(
    "this is the file of a hand-held tool; give that of a linkage, or `equipoise serve` it"
)


def titles() -> dict[str, str]:
    """Titles of the bundled machines by name."""
    return examples("linkage")


def tool_titles() -> dict[str, str]:
    """Titles of the bundled tools by name."""
    return examples("tool")


def opened_example(name: str) -> Design:
    """A bundled machine."""
    if name not in titles():
        raise UsageError(Note("there is no example of the name {name!r}", name=printable(name)))
    return Design(name, load_linkage(name))


def opened_file(path_or_name: str | os.PathLike[str]) -> Design:
    """A machine from its file, with the tables beside it, or an example."""
    file = opened(path_or_name)
    if kind_of_text(file.text) == "tool":
        raise ModelError("", TOOLS, file.source)
    machine = loads_linkage(file.text, file.source, file.folder)
    return Design(printable(os.path.basename(path_or_name)), machine)


def opened_text(
    name: str,
    text: str,
    files: Mapping[str, str] = NO_FILES,
    tables: Mapping[tuple[str, str], Any] = NO_TABLES,
) -> Design:
    """A machine from the text of a model file.

    files : texts of the CSV files that it names.  tables : others that there are.
    """
    place = printable(name)
    if kind_of_text(text) == "tool":
        raise ModelError("", TOOLS, place)
    with in_file(place):
        content = content_of(text.removeprefix("\ufeff"), "linkage")
        return Design(place, machine_of(content, HeldFiles(tables, files)))


def wants_tool(message: Message) -> bool:
    """Whether a message of the kind `open` wants a tool, rather than a machine."""
    if "example" in message.values:
        return message.text("example") in tool_titles()
    return not message.flag("new", False) and kind_of_text(message.text("text")) == "tool"


SAMPLES = 36
"""In a turn of the crank."""
ASIDE = re.compile(r"\s*[(（][^()（）]*[)）]")
"""What a description says in brackets."""
END = re.compile(r"(?<=。)|(?<=[^A-Z]\.)\s+")
"""Where a sentence ends, but not after an initial."""


def pictured() -> Iterator[tuple[JsonObject, bytes]]:
    """Every machine, by kind: title, first sentence, kind and words to search in the reader's
    language, drawing and arrays.
    """
    machines = {name: opened_example(name).machine for name in titles()}
    headings = sections()
    for name, machine in sorted(machines.items(), key=lambda item: section_of(item[1])):
        drawing, data = _thumbnail(name)
        text = ASIDE.sub("", " ".join(localized(machine.description).split()))
        line = END.split(text, maxsplit=1)[0]
        statement = {"name": name, "title": localized(machine.title), "line": line}
        statement["kind"] = headings[section_of(machine)]
        statement["words"] = f"{search_words(machine)} {text}"
        yield {**statement, **drawing}, data


@cache
def _thumbnail(name: str) -> tuple[JsonObject, bytes]:
    """What does not depend on the language.

    at : sample at which nothing hides anything else, where a picture stands still.
    """
    scene = Scene.of(analyze(opened_example(name).machine, SAMPLES).motion)
    block = FloatBlock()
    moves_of(scene, block)
    text = {"at": clear_angle(scene), "scene": stage_of(scene, ()), "arrays": block.placement}
    return text, block.data
