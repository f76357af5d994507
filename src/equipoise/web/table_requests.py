"""What a page asks about the tables of the file: which there are, and to change them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import replace
from threading import Lock
from typing import Any, Protocol

from equipoise.quantities import clean, format_exact
from equipoise.web.edits import Computed
from equipoise.web.incomplete import Incomplete, plain_of, sketch_of, with_entry
from equipoise.web.messages import Entry, Message
from equipoise.web.replies import Reply
from equipoise.web.sketch import Sketch
from equipoise.web.tables import tables_of

LONGER = 0.1
"""By how much a stroke is longer at its other end, over what it is."""


class EntrySession(Protocol):
    """What answers need of a session."""

    lock: Lock

    def base(self) -> Computed | Incomplete:
        """What is, finished or not."""

    def go_to(self, computed: Computed | Incomplete, label: str) -> None:
        """Make another design the one that is."""

    def localized(self) -> AbstractContextManager[None]:
        """Inside, the reader's language is spoken, in the units of the file that is open."""

    def state_replies(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """Replies on the design that is shown."""


def stroked(sketch: Sketch, entry: Entry) -> Entry:
    """Entry as it is; but a drive that is to push, and has no stroke yet, gets one that begins
    as it is drawn: neither can be there without the other.
    """
    values, place = entry.values, entry.place
    if values is None or not (place == ("drive",) or place[:1] == ("drives",) == place[:-1]):
        return entry
    drives = (sketch.drive,) if len(place) == 1 else sketch.rest.get("drives", ())
    drive = dict(enumerate(drives)).get(0 if len(place) == 1 else int(place[1]))
    length = _pushed(sketch, values)
    if length is None or (drive is not None and drive.pushes):
        return entry
    ends = length, length + LONGER * (abs(length) or sketch.extent)
    texts = [format_exact(clean(end, "length"), "length") for end in ends]
    items: dict[str, Any] = {**values, "stroke": {"between": texts}}
    if values.get("link") in sketch.links:
        angle = clean(sketch.poses[str(values["link"])].angle, "angle")
        items.setdefault("start", format_exact(angle, "angle"))
    return replace(entry, values=items)


def _pushed(sketch: Sketch, values: Mapping[str, Any]) -> float | None:
    """Length of the cylinder, or travel of the sliding joint, that is to be driven, as drawn, m."""
    between, places = values.get("between"), sketch.places
    if isinstance(between, list) and len(between) == 2 and {*map(str, between)} <= places.keys():
        return abs(places[between[1]] - places[between[0]])
    named = (slider for slider in sketch.sliders if slider.name == values.get("slider"))
    return next((sketch.travel(item) for item in named), None)


def _tables(session: EntrySession, message: Message) -> Iterator[Reply]:
    with session.localized():
        tables = tables_of(plain_of(session.base()))
    yield Reply({"type": "tables", "seq": message.seq, **tables})


def _entry(session: EntrySession, message: Message) -> Iterator[Reply]:
    with session.lock, session.localized():
        base = session.base()
        entry = stroked(sketch_of(base, 0), message.entry())
        session.go_to(with_entry(base, entry), message.label)
    yield from session.state_replies(message.seq)


ASKED: dict[str, Callable[[EntrySession, Message], Iterator[Reply]]] = {
    "tables": _tables,
    "entry": _entry,
}
