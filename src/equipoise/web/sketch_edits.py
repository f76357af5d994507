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


def _point(sketch: Sketch, message: Message) -> Sketch:
    return with_point(sketch, message.spot("spot"), message.text("on", FRAME))


def _link(sketch: Sketch, message: Message) -> Sketch:
    return with_link(sketch, message.spot("from"), message.spot("to"))


def _slider(sketch: Sketch, message: Message) -> Sketch:
    spots = message.spot("from"), message.spot("to")
    return with_slider(sketch, *spots, message.optional("on"), message.optional("link"))


def _pin(sketch: Sketch, message: Message) -> Sketch:
    return pinned(sketch, message.text("point"), message.text("to"))


def _separate(sketch: Sketch, message: Message) -> Sketch:
    return separated(sketch, message.text("point"), message.optional("link"))


DELETED: Mapping[str, Callable[[Sketch, str], Sketch]] = {
    "point": without_point,
    "link": without_link,
    "slider": without_slider,
    **{table: partial(without_coupling, table) for table in coupling_kinds(Machine)},
}
"""What can be taken away, by its name."""


def _delete(sketch: Sketch, message: Message) -> Sketch:
    what = message.text("what")
    if what not in DELETED:
        raise UsageError(unknown(what, DELETED, "part that can be deleted"))
    return DELETED[what](sketch, message.text("name"))


def _drive(sketch: Sketch, message: Message) -> Sketch:
    """The crank; a bar that was drawn off the frame, and named after that, is called so too."""
    link = message.text("link")
    driven = with_drive(sketch, link)
    named_so = link == "coupler" and "crank" not in sketch.links
    return renamed(driven, "link", link, "crank") if named_so else driven


def _rename(sketch: Sketch, message: Message) -> Sketch:
    what = message.text("what")
    if what not in {"point", "link"}:
        raise UsageError(unknown(what, ("point", "link"), "part that can be renamed"))
    return renamed(sketch, what, message.text("name"), message.text("to"))


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
        lambda sketch, message: grounded(sketch, message.text("point")),
    ),
    "free": (
        to_say("free from the frame"),
        lambda sketch, message: freed(sketch, message.text("point")),
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


def sketch_after(sketch: Sketch, message: Message) -> tuple[Sketch, str]:
    """The sketch after an operation, and what the step is called.

    Raises
    ------
    UsageError : there is no such operation, or it cannot be done.
    """
    do = message.text("do")
    if do not in OPERATIONS:
        raise UsageError(unknown(do, OPERATIONS, "operation"))
    label, operation = OPERATIONS[do]
    named = message.values.get("name") or message.values.get("point") or message.values.get("link")
    text = say(label)
    return operation(sketch, message), f"{text} {named}" if isinstance(named, str) else text
