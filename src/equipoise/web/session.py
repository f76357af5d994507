"""One page: what it asks, what it is answered, and files to keep.

It knows nothing of how messages travel.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import cache
from threading import Lock

from equipoise import __version__
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import LANGUAGES, said, say, speaking
from equipoise.mechanism.shown_units import units_of
from equipoise.quantities import display_rules, showing_by_default
from equipoise.schema.files import LARGEST, printable
from equipoise.schema.models import load_linkage, loads_linkage
from equipoise.schema.opening import examples, kind_of_text, opened
from equipoise.web.balanced import balanced, balanced_design, balanced_told, nothing_gained
from equipoise.web.design import Design, History, Step
from equipoise.web.downloads import downloaded
from equipoise.web.edits import Solved, edited, settled, solved
from equipoise.web.fields import Scale, fields_of
from equipoise.web.messages import MOST_LANGUAGES, Message
from equipoise.web.replies import Reply, refused
from equipoise.web.seen import ASKED, Seen
from equipoise.web.shaken import more, response_of
from equipoise.web.state import first_of, state_of
from equipoise.web.tables import entered, tables_of
from equipoise.web.words import language_of, words_of

TOOLS = "this is the file of a hand-held tool; `equipoise report` and `equipoise plot` show those"


@dataclass
class Session:
    """The state of one page.

    history : of its designs.  found : the one that is, computed.
    preview : what it is while something is dragged; each one starts from `found`.
    before : with which it is compared, if with any.
    scale : of the sliders.  more_told : the design of which `tell_more` has told.
    wanted : outputs that the page draws besides those that it always does.
    language : that its reader speaks.
    seen : what else the page shows.
    lock : held while a design takes the place of another, since balancing has a thread of its own.
    """

    history: History | None = None
    found: Solved | None = None
    preview: Solved | None = None
    before: Solved | None = None
    scale: Scale | None = None
    more_told: Solved | None = None
    wanted: tuple[str, ...] = ()
    language: str = "en"
    seen: Seen = field(default_factory=Seen)
    lock: Lock = field(default_factory=Lock)

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message; what takes long comes last, and may be left unasked."""
        try:
            if message.kind in ASKED:
                yield from ASKED[message.kind](self, message)
            else:
                yield from getattr(self, f"_{message.kind}")(message)
        except EquipoiseError as error:
            yield refused(message.seq, error)

    # -- what a page may ask -----------------------------------------------------------------------

    def _ready(self, message: Message) -> Iterator[Reply]:
        yield self.hello()
        if self.found is not None:
            yield from self.told(message.seq)

    def _speak(self, message: Message) -> Iterator[Reply]:
        self.language = language_of(message.names("languages", MOST_LANGUAGES))
        told = {"language": self.language, "languages": LANGUAGES, "words": words_of(self.language)}
        yield Reply({"type": "spoken", "seq": message.seq, **told})

    def _open(self, message: Message) -> Iterator[Reply]:
        if "example" in message.values:
            design = opened_example(message.text("example"))
        else:
            design = opened_text(message.text("name", "machine.toml"), message.text("text"))
        try:
            self.open(design)
        except EquipoiseError as error:
            raise _in_file(error, design.name) from error
        yield from self.told(message.seq)

    def _edit(self, message: Message) -> Iterator[Reply]:
        commit, problem = message.flag("commit", True), None
        with self.lock, self._telling():
            base, found = self.current(), None
            try:
                found = edited(base, message.changes())
            except EquipoiseError as error:
                problem = error
            if found is None and commit:  # the last place of a drag at which it could be
                found = self.preview
            if found is not None and commit:
                found = settled(found)
                self._go(self._past.then(found.design, message.label), found)
            elif found is not None:
                self.preview = found
        if problem is not None:
            yield refused(message.seq, problem)
        if found is not None:
            yield from self.told(message.seq)

    def _tables(self, message: Message) -> Iterator[Reply]:
        with self._telling():
            told = tables_of(self.current().design.own)
        yield Reply({"type": "tables", "seq": message.seq, **told})

    def _entry(self, message: Message) -> Iterator[Reply]:
        with self.lock, self._telling():
            found = settled(solved(entered(self.current().design, message.entry())))
            self._go(self._past.then(found.design, message.label), found)
        yield from self.told(message.seq)

    def _undo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.undone())
        yield from self.told(message.seq)

    def _redo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.redone())
        yield from self.told(message.seq)

    def _compare(self, message: Message) -> Iterator[Reply]:
        first = self._past.first
        self.before = solved(first) if message.flag("on", False) else None
        yield from self.told(message.seq)

    def _outputs(self, message: Message) -> Iterator[Reply]:
        names = message.names()
        for name in names:
            _ = self.current().analysis.outputs[name]
        self.wanted = names
        yield from self.told(message.seq)

    def _balance(self, message: Message) -> Iterator[Reply]:
        base = self.current()
        with self._telling():
            what = say("balancing")
        yield Reply({"type": "busy", "seq": message.seq, "what": what})
        found = balanced(base.design)
        with self._telling():
            nothing = nothing_gained(found)
        if nothing is not None:
            yield from self.told(message.seq, nothing)
            return
        after = solved(balanced_design(base.design, found))
        with self._telling():
            told = balanced_told(base, after, found)
        with self.lock:
            if self.found is not base:
                raise UsageError("the machine was changed while it was balanced; balance it again")
            self._go(self._past.then(after.design, "balance"), after)
            self.before = base
        yield Reply({"type": "balanced", "seq": message.seq, **told})
        yield from self.told(message.seq)

    def _download(self, message: Message) -> Iterator[Reply]:
        language = message.text("language", "en")
        with self._telling():
            content, data = downloaded(self.current(), message.text("kind"), language)
        yield Reply({"type": "file", "seq": message.seq, **content}, data)

    # -- its state ---------------------------------------------------------------------------------

    def hello(self) -> Reply:
        """The first thing that a page is told."""
        return Reply(
            {
                "type": "hello",
                "version": __version__,
                "examples": [
                    {"name": name, "title": said(title)} for name, title in titles().items()
                ],
                "largest": LARGEST,
                "numbers": display_rules(),
                "machine": self.found is not None,
            }
        )

    def open(self, design: Design, found: Solved | None = None) -> None:
        """Begin with a design; what was done before is forgotten.

        found : the design, if it has been computed.
        """
        found = found or solved(design)
        with self.lock:
            self.scale = Scale.of(design)
            self._go(History(Step(design, "")), found)
            self.before, self.wanted = None, first_of(design.machine)[1]
            self.seen = self.seen.opening(found)

    def go_to(self, found: Solved, label: str) -> None:
        """Make a design that has been computed the one that is, as one step of undo."""
        self._go(self._past.then(found.design, label), found)

    @property
    def has_more(self) -> bool:
        """Whether there is more to tell of the design, which takes longer."""
        return self.found is not None and self.shown is not self.more_told

    def tell_more(self) -> Iterator[Reply]:
        """What takes too long to be told at every move of a drag; ends when the design changes."""
        found = self.more_told = self.shown
        told = more(found, lambda: self.shown is not found)
        while True:
            with self._telling():  # left where this waits: whoever goes on may be another thread
                one = next(told, None)
            if one is None:
                return
            content, data = one
            yield Reply({"seq": None, **content}, data)

    @contextmanager
    def _telling(self) -> Iterator[None]:
        """Inside, the reader's language is spoken, in the units of the file that is open."""
        with speaking(self.language), ExitStack() as units:
            if self.found is not None:
                units.enter_context(showing_by_default(units_of(self.shown.design.own)))
            yield

    @property
    def shown(self) -> Solved:
        """What the page sees: what is dragged, or the design that is."""
        return self.preview or self.current()

    @property
    def _past(self) -> History:
        self.current()
        assert self.history is not None
        return self.history

    def current(self) -> Solved:
        """The design that is; a `UsageError` where there is none."""
        if self.found is None:
            raise UsageError("no machine is open; pick an example, or drop a model file")
        return self.found

    def _go(self, history: History, found: Solved | None = None) -> None:
        """Show where a history has come to; nothing has changed where that cannot be computed."""
        found = found or solved(history.now.design)
        self.seen.last, self.found = self.found, found
        self.history, self.preview = history, None
        if self.before is not None and self.before.design is history.now.design:
            self.before = None  # nothing differs from itself

    def told(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """The design that is shown, and how its support is shaken; notes come before its own."""
        with self._telling():
            state = self._state(seq)
        state.content["notes"] = [*notes, *state.content["notes"]]
        yield state
        with self._telling():
            compared = [*self.seen.compared(None if self.preview else self.found)]
        yield from compared
        with self._telling():
            shaken = response_of(self.shown)
        if shaken is not None:
            content, data = shaken
            yield Reply({"type": "response", "seq": seq, **content}, data)

    def _state(self, seq: int | None) -> Reply:
        assert self.scale is not None
        found, history = self.shown, self._past
        seen, held = self.seen, None if self.preview is None else self.found
        content, data = state_of(
            found,
            seen.pale or self.before,
            self.wanted,
            against=seen.against(held),
            arrows_at=seen.arrows_at,
        )
        fields = [self.scale.told(one) for one in fields_of(found.design).values()]
        told = {"undo": history.undo, "redo": history.redo, "fields": fields}
        return Reply({"type": "state", "seq": seq, **told, **content}, data)


def _in_file(error: EquipoiseError, name: str) -> EquipoiseError:
    """The same error with the name of the file in front."""
    if isinstance(error, ModelError):
        return error.in_file(name)
    return UsageError(f"{name}: {error}")


@cache
def titles() -> dict[str, str]:
    """Titles of the bundled machines by name."""
    return examples("linkage")


def opened_example(name: str) -> Design:
    """A bundled machine."""
    if name not in titles():
        raise UsageError(f"there is no example of the name {printable(name)!r}")
    return Design(name, load_linkage(name))


def opened_file(path_or_name: str | os.PathLike[str]) -> Design:
    """A machine from its file, with the tables beside it, or an example."""
    file = opened(path_or_name)
    if kind_of_text(file.text) == "tool":
        raise ModelError("", TOOLS, file.source)
    machine = loads_linkage(file.text, file.source, file.folder)
    return Design(printable(os.path.basename(path_or_name)), machine)


def opened_text(name: str, text: str) -> Design:
    """A machine from the text of a model file."""
    shown = printable(name)
    if kind_of_text(text) == "tool":
        raise ModelError("", TOOLS, shown)
    return Design(shown, loads_linkage(text.removeprefix("\ufeff"), shown))
