"""Operations on a machine that is made, as a page asks for them: each is one step of undo."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from equipoise.errors import UsageError
from equipoise.i18n import say, to_say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.web import cam_edits, coupling
from equipoise.web.additions import with_drive, with_link, with_point, with_slider
from equipoise.web.messages import Message
from equipoise.web.sketch import LISTS, Sketch
from equipoise.web.structure_edits import (
    TABLES,
    freed,
    grounded,
    pinned,
    renamed,
    separated,
    without_coupling,
    without_link,
    without_point,
    without_slider,
)

Operation = Callable[[Sketch, Message], Sketch]


def _point(sketch: Sketch, asked: Message) -> Sketch:
    return with_point(sketch, asked.spot("spot"), asked.text("on", FRAME))


def _link(sketch: Sketch, asked: Message) -> Sketch:
    return with_link(sketch, asked.spot("from"), asked.spot("to"))


def _slider(sketch: Sketch, asked: Message) -> Sketch:
    spots = asked.spot("from"), asked.spot("to")
    return with_slider(sketch, *spots, asked.optional("on"), asked.optional("link"))


def _pin(sketch: Sketch, asked: Message) -> Sketch:
    return pinned(sketch, asked.text("point"), asked.text("to"))


def _separate(sketch: Sketch, asked: Message) -> Sketch:
    return separated(sketch, asked.text("point"), asked.optional("link"))


DELETED: Mapping[str, Callable[[Sketch, str], Sketch]] = {
    "point": without_point,
    "link": without_link,
    "slider": without_slider,
    **{table: partial(without_coupling, table) for table in coupling_kinds(Machine)},
}
"""What can be taken away, by its name."""


def _delete(sketch: Sketch, asked: Message) -> Sketch:
    what = asked.text("what")
    if what not in DELETED:
        raise UsageError(unknown(what, DELETED, "part that can be deleted"))
    return DELETED[what](sketch, asked.text("name"))


def _drive(sketch: Sketch, asked: Message) -> Sketch:
    """The crank; a bar that was drawn off the frame, and named after that, is called so too."""
    link = asked.text("link")
    driven = with_drive(sketch, link)
    named_so = link == "coupler" and "crank" not in sketch.links
    return renamed(driven, "link", link, "crank") if named_so else driven


def _rename(sketch: Sketch, asked: Message) -> Sketch:
    what = asked.text("what")
    if what not in {"point", "link"}:
        raise UsageError(unknown(what, ("point", "link"), "part that can be renamed"))
    return renamed(sketch, what, asked.text("name"), asked.text("to"))


OPERATIONS: Mapping[str, tuple[str, Operation]] = {
    "point": (to_say("add a point"), _point),
    "link": (to_say("add a link"), _link),
    "slider": (to_say("add a slider"), _slider),
    **coupling.OPERATIONS,
    **cam_edits.OPERATIONS,
    "drive": (to_say("set the drive"), _drive),
    "pin": (to_say("pin"), _pin),
    "separate": (to_say("separate"), _separate),
    "ground": (
        to_say("pin to the frame"),
        lambda sketch, asked: grounded(sketch, asked.text("point")),
    ),
    "free": (
        to_say("free from the frame"),
        lambda sketch, asked: freed(sketch, asked.text("point")),
    ),
    "delete": (to_say("delete"), _delete),
    "rename": (to_say("rename"), _rename),
}
"""What a page may ask for, with what the step is called."""


def lost(before: Sketch, after: Sketch) -> Iterator[str]:
    """A sentence of tables that have gone with what they named."""
    lists = {"sliders": (before.sliders, after.sliders)}
    lists |= {key: (before.rest.get(key, ()), after.rest.get(key, ())) for key in LISTS}
    tables = [f"[[{key}]]" for key, (old, new) in lists.items() if len(new) < len(old)]
    tables += [f"[{key}]" for key in TABLES if before.rest.get(key) and not after.rest.get(key)]
    if tables:
        yield say("also deleted, because they refer to it: {tables}", tables=", ".join(tables))


def sketch_after(sketch: Sketch, asked: Message) -> tuple[Sketch, str]:
    """The sketch after an operation, and what the step is called.

    Raises
    ------
    UsageError : there is no such operation, or it cannot be done.
    """
    do = asked.text("do")
    if do not in OPERATIONS:
        raise UsageError(unknown(do, OPERATIONS, "operation"))
    label, operation = OPERATIONS[do]
    named = asked.values.get("name") or asked.values.get("point") or asked.values.get("link")
    text = say(label)
    return operation(sketch, asked), f"{text} {named}" if isinstance(named, str) else text
