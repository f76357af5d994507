"""A report as plain values: what is said and shown, whatever it becomes, a page or a PDF."""

from __future__ import annotations

from dataclasses import dataclass

from equipoise.results.blocks import Section


@dataclass(frozen=True)
class Tile:
    """One figure that is seen at once; `note` stands below it."""

    label: str
    value: str
    unit: str
    note: str = ""


@dataclass(frozen=True)
class Answer:
    """A part of the summary: what it answers, and the answer in sentences."""

    question: str
    sentences: tuple[str, ...]


@dataclass(frozen=True)
class Document:
    """A whole report.

    language : its code.  subtitle : what runs, how fast.  animation : SVG, empty where none moves.
    """

    language: str
    title: str
    subtitle: str
    description: str
    tiles: tuple[Tile, ...]
    summary: tuple[Answer, ...]
    animation: str
    sections: tuple[Section, ...]
