"""XML of others: read with limits, without entities, and with numbers that are numbers."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from equipoise.errors import ModelError, at_place
from equipoise.i18n import Note

DEEPEST, MOST = 100, 200_000
"""Elements inside of each other, and in all; no file of a linkage comes near."""
HUGE = 1e12
"""Beyond which a number is none of a machine."""


def tree_of(text: str) -> Element:
    """The root of a document, whose names have lost their namespaces.

    Raises
    ------
    ModelError : it is no XML, declares entities, or is too large or too deep.
    """
    builder, open_now, count = TreeBuilder(), 0, 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal open_now, count
        open_now, count = open_now + 1, count + 1
        if open_now > DEEPEST or count > MOST:
            raise ModelError(
                "",
                Note(
                    "the XML has more than {deepest} elements inside of each other, or more "
                    "than {most:,} in all",
                    deepest=DEEPEST,
                    most=MOST,
                ),
            )
        builder.start(bare(name), {bare(key): value for key, value in attributes.items()})

    def end(name: str) -> None:
        nonlocal open_now
        open_now -= 1
        builder.end(bare(name))

    parser = expat.ParserCreate("utf-8", namespace_separator=" ")
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = _no_entities
    try:
        parser.Parse(text.encode("utf-8"), True)
    except expat.ExpatError as error:
        what = expat.ErrorString(error.code) or Note("it cannot be read")
        raise ModelError(
            "",
            Note(
                "line {lineno}: no XML ({what}); give a whole file", lineno=error.lineno, what=what
            ),
        ) from error
    return builder.close()


def _no_entities(*_: object) -> None:
    raise ModelError(
        "", Note("the XML declares entities, which are not read; give a file without them")
    )


def bare(name: str) -> str:
    """A name without its namespace."""
    return name.rpartition(" ")[2]


def called(element: Element) -> str:
    """An element in an error: its tag and, where it has one, its name."""
    name = element.get("name")
    return f"{element.tag} {name!r}" if name else element.tag


def numbers(
    element: Element, key: str, default: str | None = None, count: tuple[int, ...] = ()
) -> tuple[float, ...]:
    """Numbers of an attribute with spaces between.

    default : where it is not given.  count : how many there may be, where that matters.

    Raises
    ------
    ModelError : it is missing, no number, not finite, or there are too few or too many.
    """
    text = element.get(key, default)
    if text is None:
        raise ModelError(called(element), Note("missing; give {key}", key=key))
    items = [*_floats(text.replace(",", " "))]
    wanted = " or ".join(map(str, count))
    if None in items or (count and len(items) not in count):
        given = text if len(text) <= 60 else f"{text[:57]}..."
        what = Note("{count} numbers", count=wanted) if count else Note("numbers")
        raise ModelError(
            called(element),
            at_place(key, Note("got {given!r}; give {what}", given=given, what=what)),
        )
    return tuple(item for item in items if item is not None)


def number(element: Element, key: str, default: str | None = None) -> float:
    """One number of an attribute; errors as of `numbers`."""
    return numbers(element, key, default, (1,))[0]


def _floats(text: str) -> Iterator[float | None]:
    for part in text.split():
        try:
            value = float(part)
        except ValueError:
            yield None
        else:
            yield value if isfinite(value) and abs(value) < HUGE else None
