"""One page: what it asks, what it is answered, and files to keep.

It knows nothing of how messages travel.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from threading import Lock
from typing import Any

from equipoise import __version__
from equipoise.errors import EquipoiseError, ModelError, UsageError, to_paste
from equipoise.i18n import LANGUAGES, said, say, speaking
from equipoise.mechanism.shown_units import units_of
from equipoise.quantities import display_rules, showing_by_default
from equipoise.schema.files import LARGEST
from equipoise.web.balanced import balanced, balanced_design, balanced_told, nothing_gained
from equipoise.web.design import Design
from equipoise.web.downloads import downloaded
from equipoise.web.drawn import (
    Drawn,
    changed,
    drawn,
    fields_of_sketch,
    finished,
    plain_of,
    seen,
    sketch_of,
    state_of_sketch,
    with_entry,
)
from equipoise.web.edits import Solved, settled, solved
from equipoise.web.fields import Scale, fields_of
from equipoise.web.history import History, Step
from equipoise.web.making import made
from equipoise.web.messages import MOST_LANGUAGES, Message
from equipoise.web.openings import opened_example, opened_text, titles
from equipoise.web.shaken import more, response_of
from equipoise.web.sketch import Sketch
from equipoise.web.state import first_of, state_of
from equipoise.web.tables import tables_of
from equipoise.web.words import language_of, words_of

LONGEST = 800
"""Signs of a sentence."""


@dataclass(frozen=True)
class Reply:
    """What a page is sent: values for JSON, and a block of 32-bit floats or of a file."""

    content: dict[str, Any]
    buffer: bytes = b""


@dataclass
class Session:
    """The state of one page.

    history : of its designs.  found : the one that is, computed, or drawn while it is unfinished.
    preview : what it is while something is dragged; each one starts from `found`.
    before : with which it is compared, if with any.
    scale : of the sliders.  more_told : the design of which `tell_more` has told.
    wanted : outputs that the page draws besides those that it always does.
    language : that its reader speaks.
    lock : held while a design takes the place of another, since balancing has a thread of its own.
    """

    history: History | None = None
    found: Solved | Drawn | None = None
    preview: Solved | Drawn | None = None
    before: Solved | None = None
    scale: Scale | None = None
    more_told: Solved | None = None
    wanted: tuple[str, ...] = ()
    language: str = "en"
    lock: Lock = field(default_factory=Lock)

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message; what takes long comes last, and may be left unasked."""
        try:
            yield from getattr(self, f"_{message.kind}")(message)
        except EquipoiseError as error:
            yield refused(message.seq, error)

    # -- what a page may ask -----------------------------------------------------------------------

    def _ready(self, message: Message) -> Iterator[Reply]:
        yield self.hello()
        if self.found is not None:
            yield from self._shown(message.seq)

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
        yield from self._shown(message.seq)

    def _edit(self, message: Message) -> Iterator[Reply]:
        commit, problem = message.flag("commit", True), None
        with self.lock, self._telling():
            base, found = self._current(), None
            try:
                found = changed(base, message.changes(), commit)
            except EquipoiseError as error:
                problem = error
            if found is None and commit:  # the last place of a drag at which it could be
                found = self.preview
            if found is not None and commit:
                found = settled(found) if isinstance(found, Solved) else found
                self._go(self._past.then(found.design, message.label), found)
            elif found is not None:
                self.preview = found
        if problem is not None:
            yield refused(message.seq, problem)
        if found is not None:
            yield from self._shown(message.seq)

    def _make(self, message: Message) -> Iterator[Reply]:
        with self.lock, self._telling():
            if message.text("do") == "new":
                sketch, label = Sketch(), "new machine"
            else:
                sketch, label = made(sketch_of(self._current(), message.whole("at", 0)), message)
            found = drawn(sketch)
            past = self.history
            step = Step(found.design, label)
            self._go(past.then(found.design, label) if past else History(step), found)
            self._measure(found)
        yield from self._shown(message.seq)

    def _tables(self, message: Message) -> Iterator[Reply]:
        with self._telling():
            told = tables_of(plain_of(self._current()))
        yield Reply({"type": "tables", "seq": message.seq, **told})

    def _entry(self, message: Message) -> Iterator[Reply]:
        with self.lock, self._telling():
            found = with_entry(self._current(), message.entry())
            self._go(self._past.then(found.design, message.label), found)
        yield from self._shown(message.seq)

    def _undo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.undone())
        yield from self._shown(message.seq)

    def _redo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.redone())
        yield from self._shown(message.seq)

    def _compare(self, message: Message) -> Iterator[Reply]:
        first = self._past.first
        on = message.flag("on", False)
        self.before = solved(first) if on and isinstance(first, Design) else None
        yield from self._shown(message.seq)

    def _outputs(self, message: Message) -> Iterator[Reply]:
        names = message.names()
        for name in names:
            _ = self._finished().analysis.outputs[name]
        self.wanted = names
        yield from self._shown(message.seq)

    def _balance(self, message: Message) -> Iterator[Reply]:
        base = self._finished()
        with self._telling():
            what = say("balancing")
        yield Reply({"type": "busy", "seq": message.seq, "what": what})
        found = balanced(base.design)
        with self._telling():
            nothing = nothing_gained(found)
        if nothing is not None:
            yield from self._shown(message.seq, nothing)
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
        yield from self._shown(message.seq)

    def _download(self, message: Message) -> Iterator[Reply]:
        language = message.text("language", "en")
        with self._telling():
            content, data = downloaded(self._finished(), message.text("kind"), language)
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
            self._go(History(Step(design, "")), found)
            self._measure(found)

    def _measure(self, found: Solved | Drawn) -> None:
        """What goes by the machine that is opened or made: ranges of sliders, outputs."""
        self.before = None
        if isinstance(found, Drawn):
            self.scale, self.wanted = Scale({}, found.design.extent, 1.0), ()
        else:
            machine = found.design.machine
            self.scale, self.wanted = Scale.of(found.design), first_of(machine)[1]

    @property
    def has_more(self) -> bool:
        """Whether there is more to tell of the design, which takes longer."""
        return isinstance(self.found, Solved) and self.shown is not self.more_told

    def tell_more(self) -> Iterator[Reply]:
        """What takes too long to be told at every move of a drag; ends when the design changes."""
        found = self.more_told = self.shown_machine
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
                units.enter_context(showing_by_default(units_of(self.shown.design)))
            yield

    @property
    def shown(self) -> Solved | Drawn:
        """What the page sees: what is dragged, or the design that is."""
        return self.preview or self._current()

    @property
    def shown_machine(self) -> Solved:
        """The same of a machine that is finished, or a `UsageError`."""
        return finished(self.shown)

    @property
    def _past(self) -> History:
        self._current()
        assert self.history is not None
        return self.history

    def _finished(self) -> Solved:
        return finished(self._current())

    def _current(self) -> Solved | Drawn:
        if self.found is None:
            raise UsageError("no machine is open; pick an example, or drop a model file")
        return self.found

    def _go(self, history: History, found: Solved | Drawn | None = None) -> None:
        """Show where a history has come to; nothing has changed where that cannot be computed."""
        self.found = found or seen(history.now.design)
        self.history, self.preview = history, None
        if self.before is not None and self.before.design is history.now.design:
            self.before = None  # nothing differs from itself

    def _shown(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """The design that is shown, and how its support is shaken; notes come before its own."""
        with self._telling():
            state = self._state(seq)
        state.content["notes"] = [*notes, *state.content["notes"]]
        yield state
        if isinstance(self.shown, Drawn):
            return
        with self._telling():
            shaken = response_of(self.shown_machine.design.machine)
        if shaken is not None:
            content, data = shaken
            yield Reply({"type": "response", "seq": seq, **content}, data)

    def _state(self, seq: int | None) -> Reply:
        assert self.scale is not None
        found, history = self.shown, self._past
        if isinstance(found, Drawn):
            numbers = fields_of_sketch(found.design)
            content, data = state_of_sketch(found)
        else:
            numbers = fields_of(found.design)
            content, data = state_of(found, self.before, self.wanted)
        fields = [self.scale.told(one) for one in numbers.values()]
        told = {"undo": history.undo, "redo": history.redo, "fields": fields}
        return Reply({"type": "state", "seq": seq, **told, **content}, data)


def refused(seq: int | None, error: Exception) -> Reply:
    """Say why something cannot be done."""
    content: dict[str, Any] = {"type": "refused", "seq": seq, "message": _shortened(str(error))}
    if isinstance(error, ModelError) and error.where:
        content |= {"path": error.where, "what": _shortened(error.what)}
    return Reply(content)


def _in_file(error: EquipoiseError, name: str) -> EquipoiseError:
    """The same error with the name of the file in front."""
    if isinstance(error, ModelError):
        return error.in_file(name)
    return UsageError(f"{name}: {error}")


def _shortened(text: str) -> str:
    sentence, *lines = to_paste(text)
    text = "\n".join([" ".join(sentence.split()), *lines])
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 200]} ... {text[-190:]}"
