"""The catalogues hold what is said, all of it and nothing else."""

from __future__ import annotations

import ast
import re
import runpy
from functools import cache
from pathlib import Path
from string import Formatter
from threading import Thread

import pytest

import equipoise
from equipoise.i18n import LANGUAGES, Note, catalogue, say, speaking
from equipoise.keys import (
    DirectionKind,
    Frozen,
    Key,
    KeyTable,
    Kind,
    Listing,
    Named,
    Number,
    OneOr,
    Planes,
    Point,
    Quantity,
    Tables,
    Whole,
    all_keys,
)
from equipoise.mechanism.assembly.joints import moving_links
from equipoise.schema.entries import entry_of, own_keys, tables_below
from equipoise.schema.file_numbers import plain_word
from equipoise.schema.open_files import document_of
from support.languages import COMPLETE
from support.syntax import nodes

SOURCES = Path(equipoise.__file__).parent
TOP = Path(__file__).parents[3]
TRANSLATED = sorted(set(LANGUAGES) - {"en"})
DEMANDED = sorted(set(COMPLETE) - {"en"})


@cache
def said() -> set[str]:
    """Texts of `say`, `to_say`, `Note` and `unknown` in the package; `to_say` has a plain text."""
    result = set()
    for path in SOURCES.rglob("*.py"):
        for node in nodes(path):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                first = node.args[0] if node.args else None
                if node.func.id in ("to_say", "with_meaning"):
                    assert isinstance(first, ast.Constant), f"{path}:{node.lineno}"
                if node.func.id == "with_meaning":  # a label and its meaning
                    result.update(arg.value for arg in node.args if isinstance(arg, ast.Constant))
                if node.func.id == "unknown" and len(node.args) > 2:  # what kind of name it is
                    first = node.args[2]
                if node.func.id == "needed" and len(node.args) > 1:  # what it is needed for
                    first = node.args[1]
                either = [first.body, first.orelse] if isinstance(first, ast.IfExp) else [first]
                if node.func.id in ("say", "to_say", "Note", "unknown", "needed", "lacking"):
                    result.update(item.value for item in either if isinstance(item, ast.Constant))
    return result


@cache
def words_of_keys() -> set[str]:
    """What numbers of files are called whose keys say nothing else."""
    result: set[str] = set()

    def look(kind: Kind, key: Key | None) -> None:
        if isinstance(kind, KeyTable):
            for value in all_keys(kind.type).values():
                look(value.kind, value)
        elif isinstance(kind, Tables | Named | Listing | OneOr | Planes):
            look(kind.item, key)
        elif (
            isinstance(kind, Quantity | Number | Whole | Point | DirectionKind) and key is not None
        ):
            result.update([] if key.word else [plain_word(key)])

    for document in ("linkage", "tool"):
        look(KeyTable(document_of(document)), None)
    return (result | words_of_forms()) - {"schema"}


def words_of_forms() -> set[str]:
    """What keys are called in the forms of the page and mean, and the tables that these are of."""
    result: set[str] = set()
    waiting: list[type[Frozen]] = [document_of("linkage")]
    seen = set(waiting)
    while waiting:
        of = waiting.pop()
        known = [*own_keys(of).values(), *tables_below(of).values()]
        result.update(plain_word(item) for item in known if not item.word or "{" in item.word)
        result.update(item.text for item in known)
        inner = {table.type for item in known if (table := entry_of(item.kind)) is not None}
        waiting += inner - seen
        seen |= inner
    return result


@cache
def words_of_the_page() -> set[str]:
    """What the live page says of its own, which stands in its TypeScript."""
    texts = runpy.run_path(str(TOP / "page" / "bundle.py"))["texts"]()
    assert len(texts) > 80
    return set(texts)


def placeholders(text: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(text) if name is not None}


@cache
def texts_of_all() -> frozenset[str]:
    return frozenset(said() | words_of_keys() | words_of_the_page())


@pytest.mark.parametrize("language", DEMANDED)
def test_every_text_is_translated_and_none_is_left_over(language):
    texts, held = texts_of_all(), catalogue(language)
    assert texts - held.keys() == set()
    assert held.keys() - texts == set()


@pytest.mark.parametrize("language", TRANSLATED)
def test_a_translation_has_the_values_of_its_text(language):
    held = catalogue(language)
    assert {text for text in held if placeholders(text) != placeholders(held[text])} == set()


def test_what_joins_two_parts_keeps_its_spaces_in_german():
    """As " and " does; Japanese and Korean have none."""
    held = catalogue("de")
    edges = [text for text in held if text != text.strip()]
    assert " and " in edges
    for text in edges:
        assert held[text].startswith(" ") == text.startswith(" "), text
        assert held[text].endswith(" ") == text.endswith(" "), text


def test_numbers_of_equations_stand_behind_words():
    """Nobody has the paper at hand: what it says is told, and where it says so in brackets."""
    numbered = {text for text in said() if re.search(r"(?<![Ai])\([1-9][0-9]?\)", text)}
    assert len(numbered) == 6
    for text in numbered:
        before, _, source = text.partition(" (")
        assert re.match(r"(equations?|conditions) \(", source) and "of Yamashita et al." in source
        assert len(before.split()) > 3


def test_a_sentence_in_a_sentence_is_said_in_the_same_language():
    """Whether the outer one is said at once or handed on."""
    links = moving_links(3)
    with speaking("de"):
        outer = Note("{links} of {mass} together", links=links, mass="6 kg")
        assert links.localized() != str(links)
        assert say(outer.template, **outer.values).startswith(links.localized())
        assert outer.localized().startswith(links.localized())


def test_a_language_is_spoken_inside_its_block_and_in_its_thread_only():
    heard = []
    with speaking("ko"):
        Thread(target=lambda: heard.append(say("Summary"))).start()
        heard.append(say("Summary"))
        with speaking("ja"):
            heard.append(say("Gravity ({value}) m/s²", value="0, −9.807"))
        heard.append(say("joint {name}", name="{B}"))
    heard.append(say("not in any catalogue {name}", name="B"))
    assert sorted(heard) == sorted(
        ["Summary", "요약", "重力加速度 (0, −9.807) m/s²", "조인트 {B}", "not in any catalogue B"]
    )
    with pytest.raises(KeyError, match="fr"), speaking("fr"):
        pass
