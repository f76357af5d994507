"""The languages: a catalogue file each, words by a count, and particles by the word before them.

A catalogue is a TOML file beside this one, called by the code of its language.  Its table
``[language]`` comes first, then ``[particles]`` where words change by the word before them, and
``[texts]`` last.  Only the lines of the first table are read to know which languages there are, so
that a page without a server can load the texts of a language when it is first spoken.

Catalogues give both forms, as in ``{name}을(를)``; one is chosen when the name is filled in.  The
rules are the table ``[particles]`` of a catalogue, which the live page follows too
(`page/src/words.ts`).

A text with a count and a noun has one template in the code, in the plural: ``{count} designs``.
The English catalogue has its other forms, and names the placeholder on which they depend where that
is not ``count``; a catalogue of a language whose head has rules of plural gives a table of forms
in place of a text: ``{ one = "{count} Entwurf", other = "{count} Entwürfe" }``.
"""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Any

from equipoise.dataclass import dataclass

ENDING = ".toml"
ORIGINAL = "en"
"""The language in which texts are written."""


@dataclass(frozen=True)
class LanguageHead:
    """What the head of a catalogue says.

    Attributes
    ----------
    name : of the language, in the language.
    decimal : the sign before the decimals of a number that is shown; files have a point.
    plural : category of a count -> the condition for it, as in CLDR, such as ``n = 1``; every other
        count is ``other``.
    fonts : families with its letters, the best first; none where every font has them.
    drawing_font : of texts in a DXF drawing, as Windows has it; the usual one if empty.
    """

    name: str
    decimal: str = "."
    plural: Mapping[str, str] = field(default_factory=dict)
    fonts: tuple[str, ...] = ()
    drawing_font: str = ""


def _catalogues() -> Iterator[tuple[str, Any]]:
    """Code and file of each catalogue; English, in which texts are written, first."""
    files = {file.name: file for file in resources.files(__package__).iterdir()}
    codes = {name.removesuffix(ENDING) for name in files if name.endswith(ENDING)}
    for code in sorted(codes, key=lambda code: (code != ORIGINAL, code)):
        yield code, files[code + ENDING]


def head_of(lines: Iterable[str]) -> str:
    """The first table of a catalogue, as text."""
    head: list[str] = []
    for line in lines:
        if line.startswith("[") and head:
            break
        if line.startswith("[") or head:
            head.append(line)
    return "".join(head)


def _head(file: Any) -> LanguageHead:
    with file.open(encoding="utf-8") as text:
        head = tomllib.loads(head_of(text))["language"]
    return LanguageHead(**head | {"fonts": tuple(head.get("fonts", ()))})


KNOWN: Mapping[str, LanguageHead] = {code: _head(file) for code, file in _catalogues()}
"""Every language by its code, English first."""


@cache
def content(code: str) -> Mapping[str, Any]:
    """The whole catalogue of a language: its tables ``language``, ``particles`` and ``texts``.

    Raises
    ------
    ModuleNotFoundError : here is the head alone, and the package that it names has the texts.
    """
    file = resources.files(__package__) / f"{code}{ENDING}"
    tables: Mapping[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    if "texts" not in tables:
        raise ModuleNotFoundError(f"texts of {code!r} are not installed", name=package_of(code))
    return tables


def package_of(code: str) -> str:
    """The package of a site with the catalogue of a language."""
    return f"equipoise-{code}"


def rules(language: str) -> Mapping[str, Any] | None:
    """The rules of a language as plain values: ``forms`` of each particle by the sound before it,
    ``endings`` that give the sound of a word (the first that matches counts), ``closing``, the
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


BY, OTHER = "by", "other"
USUAL = "count"
"""The placeholder that a form goes by where the English catalogue names none."""
_RELATION = re.compile(r"n(?: % (\d+))? (!?=) ([\d.,]+)")


def category(language: str, count: int) -> str:
    """The category of a count, such as ``one``, by the rules in the head of a catalogue."""
    plural = KNOWN[language].plural
    return next((name for name, rule in plural.items() if _holds(rule, count)), OTHER)


def _holds(rule: str, count: int) -> bool:
    """Whether a rule of CLDR, such as ``n % 10 = 1 and n % 100 != 11``, holds for a whole count."""
    return any(
        all(_is_so(relation, count) for relation in either.split(" and "))
        for either in rule.split(" or ")
    )


def _is_so(relation: str, count: int) -> bool:
    match = _RELATION.fullmatch(relation.strip())
    if match is None:
        raise ValueError(f"{relation!r} is no rule of plural; such as 'n % 10 = 2..4' is one")
    divisor, sign, ranges = match.groups()
    rest = count % int(divisor) if divisor else count
    ends = (part.partition("..") for part in ranges.split(","))
    inside = any(int(low) <= rest <= int(high or low) for low, _, high in ends)
    return inside == (sign == "=")


@cache
def texts(language: str) -> Mapping[str, str]:
    """English text -> text in a language, in the form of a count that is ``other``."""
    return {
        text: translation if isinstance(translation, str) else translation.get(OTHER, text)
        for text, translation in content(language)["texts"].items()
    }


@cache
def counted(language: str) -> Mapping[str, Mapping[str, str]]:
    """English text -> its forms in a language by category, and at ``by`` the placeholder."""
    of = {
        text: translation.get(BY, USUAL)
        for text, translation in content("en")["texts"].items()
        if not isinstance(translation, str)
    }
    return {
        text: {OTHER: text, **translation, BY: of.get(text, USUAL)}
        for text, translation in content(language)["texts"].items()
        if not isinstance(translation, str)
    }


_NONE: Mapping[str, str] = MappingProxyType({})


def form_of(text: str, values: Mapping[str, Any], language: str) -> str | None:
    """The form of a text for the count among its values; None where it has no forms."""
    forms = counted(language).get(text, _NONE)
    if not forms:
        return None
    count = str(values.get(forms[BY], "")).strip()
    number = int(count) if count.isdecimal() else None
    name = OTHER if number is None else category(language, number)
    return forms.get(name, forms[OTHER])
