"""What checks of models share: names of bodies and points, sizes and ranges of numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from equipoise.displays import brief, names_of
from equipoise.errors import ModelError, form_of, meant, unknown
from equipoise.i18n import Note, Worded
from equipoise.quantities import Dimension, Measured

__all__ = [
    "ALTERNATIVES",
    "FRAME",
    "LONGEST_NAME",
    "MODE",
    "MODES",
    "SIDES",
    "Bodies",
    "NamedItems",
    "Vector",
    "bodies_at",
    "check_kept",
    "form_of",
    "meant",
    "numbered",
    "positive",
    "too_many",
    "unknown",
    "unknown_body",
    "unknown_link",
    "unknown_point",
    "wrong_range",
    "wrong_speeds",
    "wrong_text",
]

FRAME = "frame"
MODE, MODES = "mode", ("parallel", "antiparallel")
"""How dyads that close four-bars of equal opposite sides go on through their change points."""
ALTERNATIVES = (("left", "right"), ("forward", "backward"), MODES)
SIDES = tuple(word for pair in ALTERNATIVES for word in pair)
Vector = tuple[float, float]
"""Components along x (forward) and y (up)."""
Bodies = Mapping[str, Mapping[str, Vector]]
"""Points by name of the frame and of every link, in their own axes."""

ValueT = TypeVar("ValueT")

LONGEST_NAME = 200
"""Far beyond any machine; they keep a file of nonsense from running for hours."""


class NamedItems(dict[str, ValueT]):
    """A dict that says which names there are when one is asked for that is not."""

    def __init__(self, kind: str, items: Iterable[tuple[str, ValueT]]) -> None:
        super().__init__(items)
        self.kind = kind

    def __repr__(self) -> str:
        return f"{{{names_of(f'{name!r}: {brief(value)}' for name, value in self.items())}}}"

    def __missing__(self, name: str) -> ValueT:
        raise KeyError(unknown(name, self, self.kind))


def bodies_at(bodies: Bodies) -> dict[str, list[str]]:
    """The bodies that have a point, by its name: two and more are pinned together there."""
    names: dict[str, list[str]] = {}
    for body, points in bodies.items():
        for point in points:
            names.setdefault(point, []).append(body)
    return names


def check_kept(where: str, old: Iterable[str], new: Any) -> None:
    """Refuse points that leave some of the old ones out, which nobody would notice."""
    lost = [item for item in old if item not in new] if new and isinstance(new, Mapping) else ()
    if lost:
        raise ModelError(
            where,
            Note(
                "{names} would be lost; give all points, or move one by with_point",
                names=", ".join(lost),
            ),
        )


def numbered(key: str, items: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Each of a list of tables with its place, numbered from 1."""
    return ((f"{key}[{number}]", item) for number, item in enumerate(items, 1))


def too_many(key: str, items: Sequence[Any] | Mapping[str, Any], most: int) -> Iterator[ModelError]:
    """Complain of a list that is far longer than that of any machine."""
    if len(items) > most:
        yield ModelError(
            key, Note("got {items}; at most {most} are computed with", items=len(items), most=most)
        )


def wrong_text(where: str, text: str) -> Iterator[ModelError]:
    """Complain of a title or name that cannot be printed."""
    if isinstance(text, Worded):
        for code, name in text.texts.items():
            yield from wrong_text(f"{where}.{code}", name)
    elif len(text) > LONGEST_NAME:
        yield ModelError(
            where,
            Note(
                "{text} characters; give at most {longest_name}",
                text=len(text),
                longest_name=LONGEST_NAME,
            ),
        )
    elif not text.isprintable():
        yield ModelError(where, Note("got {text!r}; give printable characters", text=text))


def positive(where: str, value: float | None, dimension: Dimension | None) -> Iterator[ModelError]:
    """Complain of a number, where it is given, that is not above 0."""
    if value is not None and value <= 0:
        given = Measured(value, dimension)
        yield ModelError(where, Note("got {value}; give more than 0", value=given))


def wrong_range(
    where: str, pair: Vector | None, dimension: Dimension | None = None, unit: str = ""
) -> Iterator[ModelError]:
    """Complain of a range, where it is given, that ends before it begins.

    unit : in which its ends are named where no file has them.
    """
    if pair is not None and pair[0] > pair[1]:
        low, high = (Measured(value, dimension, unit) for value in pair)
        yield ModelError(
            where, Note("got {low} to {high}; give the smaller one first", low=low, high=high)
        )


def wrong_speeds(where: str, speeds: Sequence[float]) -> Iterator[ModelError]:
    """Two speeds, the lower one first."""
    if len(speeds) != 2:
        yield ModelError(
            where, Note("got {speeds}; give the lowest and the highest speed", speeds=len(speeds))
        )
    elif not 0 < speeds[0] < speeds[1]:
        low, high = (Measured(speed, "angular speed", "rpm") for speed in speeds)
        yield ModelError(
            where,
            Note("got {low} to {high}; give two above 0, the lower one first", low=low, high=high),
        )


def unknown_link(where: str, name: str, bodies: Bodies) -> Iterator[ModelError]:
    """Complain of a name that no link has."""
    if name == FRAME or name not in bodies:
        yield ModelError(where, unknown(name, [body for body in bodies if body != FRAME], "link"))


def unknown_point(where: str, point: str, body: str, bodies: Bodies) -> Iterator[ModelError]:
    """Complain of a name that no point of a body has."""
    if point not in bodies[body]:
        yield ModelError(where, unknown(point, bodies[body], Note("point of {body}", body=body)))


def unknown_body(where: str, name: str, bodies: Bodies) -> Iterator[ModelError]:
    """Say that there is no such link, nor the frame, unless there is."""
    if name not in bodies:
        yield ModelError(where, unknown(name, bodies, "link"))
