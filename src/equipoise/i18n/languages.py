"""The languages there are: one catalogue file each, of which the head says what is special to it.

A catalogue is a TOML file beside this one, called by the code of its language.  Its table
``[language]`` comes first, then ``[particles]`` where words change by the word before them, and
``[texts]`` last.  Only the lines of the first table are read to know which languages there are, so
that a page without a server can load the texts of a language when it is first spoken.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from functools import cache
from importlib import resources
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
