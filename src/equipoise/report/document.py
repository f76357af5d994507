"""A report as plain values: what is said and shown, whatever it becomes, a page or a PDF."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from equipoise.report.numbers import kept_together

Row = tuple[str, ...]


def _kept(value: Any) -> Any:
    if isinstance(value, str):
        return kept_together(value)
    return tuple(map(_kept, value)) if isinstance(value, tuple) else value


class _Told:
    """What is read in lines: no line ends between a number and its unit."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            object.__setattr__(self, name, _kept(value))


@dataclass(frozen=True)
class Paragraph(_Told):
    """Running text."""

    kind: ClassVar[str] = "paragraph"
    text: str


@dataclass(frozen=True)
class Points(_Told):
    """A list; `title` stands above it."""

    kind: ClassVar[str] = "points"
    title: str
    items: tuple[str, ...]


@dataclass(frozen=True)
class Table(_Told):
    """A table; its first `words` columns are words, the others numbers."""

    kind: ClassVar[str] = "table"
    title: str
    header: Row
    rows: tuple[Row, ...]
    words: int = 1


@dataclass(frozen=True)
class Drawing:
    """A picture as SVG."""

    kind: ClassVar[str] = "drawing"
    name: str
    caption: str
    svg: str


@dataclass(frozen=True)
class Listing:
    """Text as it stands in a file."""

    kind: ClassVar[str] = "listing"
    title: str
    text: str


Block = Paragraph | Points | Table | Drawing | Listing


@dataclass(frozen=True)
class Section:
    """A heading and what stands below it; `name` is its anchor."""

    name: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Tile(_Told):
    """One figure that is seen at once; `note` stands below it."""

    label: str
    value: str
    unit: str
    note: str = ""


@dataclass(frozen=True)
class Answer(_Told):
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
