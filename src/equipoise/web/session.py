"""The session of a page: what it asks of a machine, and what it is answered.

It knows nothing of how messages travel.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import field
from threading import Lock
from typing import TYPE_CHECKING

from equipoise import __version__
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError, at_place
from equipoise.i18n import Note, localized, say, speaking, wording
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import units_of
from equipoise.quantities import display_rules, showing_by_default
from equipoise.results.result import words_of
from equipoise.schema.documents import dumps
from equipoise.schema.files import LARGEST
from equipoise.schema.template import named_parts
from equipoise.signals import Array
from equipoise.web.deferred import deferred_replies, response_of
from equipoise.web.design import Design, History, HistoryStep, PageDraft
from equipoise.web.documents import language_of, spoken_in, wording_of
from equipoise.web.edits import Computed, computed, edited, settled, solved, with_entry
from equipoise.web.fields import Scale, fields_of
from equipoise.web.figures import figures_of
from equipoise.web.files import NOT_OF_FILE, Disk, downloaded
from equipoise.web.gallery import opened_example, opened_text, pictured, titles, tool_titles
from equipoise.web.measured_records import MeasuredSignals, record_of_text
from equipoise.web.messages import MOST_LANGUAGES, MOST_OUTPUTS, SLOW, JsonObject, Message
from equipoise.web.replies import Reply, refused
from equipoise.web.sketch import Sketch
from equipoise.web.state import first_of, spectra_of, state_of
from equipoise.web.structure_edits import lost, sketch_after
from equipoise.web.tables import tables_of
from equipoise.web.view_state import ViewState, points_of, signals_without_chart

if TYPE_CHECKING:
    from equipoise.web.balanced import Balancing

NO_STORE = Note("no store of a study is open; give one to `equipoise serve`")
OF_VARIANTS = ("pin", "rename", "drop", "go", "against")
"""What can be done with designs that are kept."""


@dataclass
class Session:
    """The state of one page.

    history : of its designs.
    current_state : the present design, computed as far as it can be.
    preview : what it is while something is dragged; each one starts from `current_state`.
    before : with which it is compared, if with any.
    scale : of the sliders.
    deferred_sent : the design whose `deferred_replies` the page has, and that it was compared with.
    response_sent : the design whose response the page has, and the record drawn beside it.
    wanted : outputs that the page draws besides those that it always does.
    language : that its reader speaks.  disk : the file that is open, if it can be saved.
    view_state : what else the page shows.
    brief : whether states of a machine have the figures, numbers and spectra of the last one that
        was not brief, as in a drag, where a page draws at every move, and writes more seldom.
    written : those figures and numbers; None where the machine was unfinished.
    spectra : amplitudes by order, of the machine that `written` is about.
    numbered : the design that was shown last, and how many were shown until then.
    before_change : called before a question that takes long changes the design, in the thread that
        answers it; from then on it cannot be cancelled.
    lock : held while a design takes the place of another, since balancing has a thread of its own.
    """

    history: History[PageDraft] | None = None
    current_state: Computed | None = None
    preview: Computed | None = None
    before: Computed | None = None
    scale: Scale | None = None
    deferred_sent: tuple[Computed | None, Computed | None] = (None, None)
    response_sent: tuple[Computed | None, MeasuredSignals | None] = (None, None)
    wanted: tuple[str, ...] = ()
    language: str = "en"
    disk: Disk | None = None
    view_state: ViewState = field(default_factory=ViewState)
    brief: bool = False
    written: JsonObject | None = None
    spectra: Mapping[str, Array] = field(default_factory=dict)
    numbered: tuple[Computed | None, int] = (None, 0)
    before_change: Callable[[], None] = field(default=lambda: None)
    lock: Lock = field(default_factory=Lock)

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message; what takes long comes last, and may be left unasked."""
        good = self.history, self.current_state, self.preview
        try:
            yield from getattr(self, f"_{message.kind}")(message)
        except EquipoiseError as error:
            yield refused(message.seq, error, self.language)
        except Exception:  # a mistake of the program; a design without replies must not stay
            if message.kind not in SLOW:  # beside which other steps are made
                self.history, self.current_state, self.preview = good
            raise

    # -- what a page may ask -----------------------------------------------------------------------

    def _ready(self, message: Message) -> Iterator[Reply]:
        yield self.hello()
        self.response_sent = None, None  # a page that begins has nothing
        if self.current_state is not None:
            yield from self.state_replies(message.seq)

    def _balance(self, message: Message) -> Iterator[Reply]:
        base = self.current()
        yield from self.adopted(base, self.balancing(base, message), message)

    def balancing(self, base: Computed, message: Message) -> Balancing:
        """Balance a design, and show nothing yet; errors as of `balance`."""
        from equipoise.web.balanced import balancing_of

        return balancing_of(base, message.flag("hold", False), self.localized)

    def adopted(self, base: Computed, balancing: Balancing, message: Message) -> Iterator[Reply]:
        """Show a balanced design as the next step.

        Raises
        ------
        UsageError : the machine is no longer `base`.
        """
        if balancing.design is None:
            yield from self.state_replies(message.seq, *filter(None, [balancing.nothing]))
            return
        after = solved(balancing.design)
        self.before_change()
        with self.lock:
            if self.current_state is not base:
                raise UsageError(
                    Note("the machine was changed while it was balanced; balance it again")
                )
            self.go_to(after, "balance")
            self.before = base
        yield Reply({"type": "balanced", "seq": message.seq, **balancing.content})
        yield from self.state_replies(message.seq)

    def _run(self, message: Message) -> Iterator[Reply]:
        yield self.run_reply(self.current(), message)

    def run_reply(self, base: Computed, message: Message) -> Reply:
        """Run a design as its file has it.

        Raises
        ------
        UsageError : the machine is no longer `base`; others as of `run`.
        """
        from equipoise.web.runs import CHANGED, run_message, run_of

        def progress(turns: int, most: int) -> None:
            if self.current_state is not base:
                raise UsageError(CHANGED)

        result = run_of(base, progress)
        with self.localized():
            content, data = run_message(result, base)
        head = {"type": "run", "seq": message.seq, "design": self.number_of(base)}
        return Reply({**head, **content}, data)

    def _cancel(self, message: Message) -> Iterator[Reply]:
        yield from ()  # a server acts on it at once; elsewhere nothing is computed any more

    def _speak(self, message: Message) -> Iterator[Reply]:
        language = language_of(message.names("languages", MOST_LANGUAGES))
        spoken = spoken_in(language)  # its texts may have to be loaded first, or cannot be
        self.language = language
        yield Reply({"type": "spoken", "seq": message.seq, **spoken})

    def _open(self, message: Message) -> Iterator[Reply]:
        design: PageDraft
        disk = self.disk if message.flag("file", False) else None
        if message.flag("new", False):
            design = Sketch()
        elif "example" in message.values:
            design = opened_example(message.text("example"))
        else:
            tables = {} if disk is None else named_parts(disk.model)[1]
            name, text = message.text("name", "machine.toml"), message.text("text")
            design = opened_text(name, text, message.files, tables)
        try:
            self.open(design)
        except EquipoiseError as error:
            raise _in_file(error, design.name) from error
        self.disk = disk
        yield from self.state_replies(message.seq)

    def _edit(self, message: Message) -> Iterator[Reply]:
        commit, problem = message.flag("commit", True), None
        with self.lock, self.localized():
            base, preview = self.base(), None
            try:
                preview = edited(base, message.changes(), self.preview, commit)
            except EquipoiseError as error:
                problem = error
            if preview is None and commit:  # the last place of a drag at which it could be
                preview = self.preview
            if preview is not None and commit:
                preview = settled(preview)
                self._go(self._past.then(preview.design, message.label), preview)
            elif preview is not None:
                self.preview = preview
        if problem is not None:
            yield refused(message.seq, problem, self.language)
        if preview is not None:
            yield from self.state_replies(message.seq)

    def _make(self, message: Message) -> Iterator[Reply]:
        with self.lock, self.localized():
            base = self.base().sketch(message.whole("at", 0))
            sketch, label = sketch_after(base, message)
            result = computed(sketch)
            self._go(self._past.then(result.design, label), result)
            self._measure(result, False)
            named = message.text("do") == "delete" and message.text("what") in ("point", "link")
            notes = [*lost(base, sketch)] if named else []
        yield from self.state_replies(message.seq, *notes)

    def _undo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.undone())
        yield from self.state_replies(message.seq)

    def _redo(self, message: Message) -> Iterator[Reply]:
        with self.lock:
            self._go(self._past.redone())
        yield from self.state_replies(message.seq)

    def _compare(self, message: Message) -> Iterator[Reply]:
        first = self._past.first
        before = computed(first) if message.flag("on", False) else None
        self.before = before if before and before.finished else None
        yield from self.state_replies(message.seq)

    def _outputs(self, message: Message) -> Iterator[Reply]:
        names = message.names()
        for name in names:
            _ = self.current().analysis.outputs[name]
        self.wanted = names
        yield from self.state_replies(message.seq)

    def _tables(self, message: Message) -> Iterator[Reply]:
        with self.localized():
            tables = tables_of(self.base().design.own)
        yield Reply({"type": "tables", "seq": message.seq, **tables})

    def _entry(self, message: Message) -> Iterator[Reply]:
        with self.lock, self.localized():
            self.go_to(with_entry(self.base(), message.entry()), message.label)
        yield from self.state_replies(message.seq)

    # -- its files, and those that it is offered ---------------------------------------------------

    def _save(self, message: Message) -> Iterator[Reply]:
        current = self.current()
        if self.disk is None:
            raise UsageError(Note(NOT_OF_FILE, name=current.design.name))
        first = self._past.first
        text = dumps(first.machine) if isinstance(first, Design) else self.disk.text
        self.disk.save(current.design.machine)
        yield from self.state_replies(message.seq)
        yield self.disk.reply(message.seq, text)

    def _download(self, message: Message) -> Iterator[Reply]:
        current = self.current()

        def everything(language: str) -> Iterator[Reply]:
            """Every reply that a page could get on the design, in a language."""
            other = Session()
            other.open(current.design, current)
            other.wanted = tuple(output.name for output in current.analysis.outputs)
            yield from other.receive(Message("speak", None, {"languages": [language]}))
            yield from other.receive(Message("ready", None, {}))
            yield from other.deferred_replies()

        with self.localized():
            content, data = downloaded(current, message, everything)
        yield Reply({"type": "file", "seq": message.seq, **content}, data)

    def _gallery(self, message: Message) -> Iterator[Reply]:
        pictures = pictured()
        while True:
            with self.localized():  # left where this waits: whoever goes on may be another thread
                picture = next(pictures, None)
            if picture is None:
                break
            content, data = picture
            yield Reply({"type": "pictured", "seq": message.seq, **content}, data)
        yield Reply({"type": "gallery", "seq": message.seq})

    def _stores(self, message: Message) -> Iterator[Reply]:
        """Without a server there are none."""
        yield Reply({"type": "stores", "seq": message.seq, "folder": None, "names": []})

    def _study(self, message: Message) -> Iterator[Reply]:
        """Nothing that is asked of a store is here."""
        raise UsageError(NO_STORE)

    _design = _study

    # -- what is shown besides the machine ---------------------------------------------------------

    def _arrows(self, message: Message) -> Iterator[Reply]:
        """Show arrows at a point, or at none."""
        point = message.text("point", "") or None
        points = points_of(self.shown.analysis)
        if point is not None and point not in points:
            raise UsageError(unknown(point, points, "point"))
        self.view_state.arrows_at = point
        yield from self.state_replies(message.seq)

    def _variant(self, message: Message) -> Iterator[Reply]:
        """Keep the design, or do something with one that is kept."""
        doing, view = message.text("do"), self.view_state
        with self.lock:
            if doing == "pin":
                view.variants = view.variants.pinned(self.current())
            elif doing == "rename":
                view.variants = view.variants.renamed(message.text("name"), message.text("to"))
            elif doing == "drop":
                view.variants = view.variants.without(message.text("name"))
            elif doing == "against":
                view.variants = view.variants.with_comparison(message.text("to"))
            elif doing == "go":
                name = message.text("name")
                self.go_to(view.variants.of(name), say("go to {name}", name=name))
            else:
                raise UsageError(unknown(doing, OF_VARIANTS, "thing to do with a variant"))
        yield from self.state_replies(message.seq)

    def _record(self, message: Message) -> Iterator[Reply]:
        """Draw a record beside the machine's own signals, or none where it has no text."""
        text, record = message.text("text", ""), None
        if text:
            record = record_of_text(message.text("name", "record.csv"), text)
            wanted = (*self.wanted, *signals_without_chart(record, self.shown))
            self.wanted = tuple(dict.fromkeys(wanted))[-MOST_OUTPUTS:]
        self.view_state.record = record
        yield from self.state_replies(message.seq)

    # -- its state ---------------------------------------------------------------------------------

    def hello(self) -> Reply:
        """The first reply to a page."""
        return Reply(
            {
                "type": "hello",
                "version": __version__,
                "examples": self._titled(titles()),
                "tools": self._titled(tool_titles()),
                "largest": LARGEST,
                "numbers": display_rules(),
                "machine": self.current_state is not None,
                "base": "" if self.disk is None else self.disk.base,
            }
        )

    def _titled(self, titles: dict[str, str]) -> list[JsonObject]:
        with speaking(self.language):
            return [{"name": name, "title": localized(title)} for name, title in titles.items()]

    def open(self, design: PageDraft, result: Computed | None = None) -> None:
        """Begin with a design, or with a sketch; what was done before is forgotten.

        result : the design, if it has been computed.
        """
        first = result or computed(design)
        with self.lock:
            self._go(History(HistoryStep(design, "")), first)
            self._measure(first, True)

    def _measure(self, computed: Computed, new: bool) -> None:
        """What goes by the build of a machine: ranges of sliders, and outputs that are drawn.

        new : whether it has nothing to do with the one before.
        """
        self.before = None
        self.scale = Scale.of(computed.design)
        if new:
            self.view_state = self.view_state.opening(computed if computed.finished else None)
        if computed.finished and (new or not self.wanted):
            self.wanted = first_of(computed.design.machine)[1]

    def go_to(self, computed: Computed, label: str) -> None:
        """Make a design that has been computed the one that is, as one step of undo."""
        self._go(self._past.then(computed.design, label), computed)

    @property
    def has_more(self) -> bool:
        """Whether deferred replies on the design are due."""
        text, against = self.deferred_sent
        if self.current_state is None or not self.current_state.finished:
            return False
        return self.view is not text or self._against is not against

    def deferred_replies(self) -> Iterator[Reply]:
        """Replies that take too long for every move of a drag; they end when the design changes."""
        wanted = self.deferred_request()
        if wanted is None:
            return
        result, against, sweep = wanted
        text = deferred_replies(result, against, sweep, lambda: self.view is not result)
        while True:
            with self.localized():  # left where this waits: whoever goes on may be another thread
                item = next(text, None)
            if item is None:
                return
            content, data = item
            yield Reply({"seq": None, **content}, data)

    def deferred_request(self) -> tuple[Computed, Computed | None, bool] | None:
        """What `deferred_replies` is about to compute, from then on known as computed.

        Returns
        -------
        The design, the one that figures are compared with, and whether the response over speed is
        wanted; None where the design is unfinished by now.
        """
        view = self.view
        if not view.finished:
            return None
        sweep, against = self.deferred_sent[0] is not view, self._against
        self.deferred_sent = view, against
        return view, against, sweep

    @contextmanager
    def localized(self) -> Iterator[None]:
        """Context in the reader's language and in the units of the open file."""
        with speaking(self.language), ExitStack() as units:
            if self.current_state is not None:
                units.enter_context(showing_by_default(units_of(self.view.design)))
                units.enter_context(wording(words_of(self._machine)))
            yield

    @property
    def _machine(self) -> Machine | None:
        """The machine that is seen, where it is finished."""
        return self.view.design.machine if self.view.finished else None

    @property
    def view(self) -> Computed:
        """What the page sees: what is dragged, or the design that is."""
        return self.preview or self.base()

    @property
    def shown(self) -> Computed:
        """Shown machine if it is finished, else a `UsageError`."""
        return self.view.checked()

    @property
    def _past(self) -> History[PageDraft]:
        self.base()
        assert self.history is not None
        return self.history

    def base(self) -> Computed:
        """What is, finished or not; a `UsageError` where there is nothing."""
        if self.current_state is None:
            raise UsageError(Note("no machine is open; pick an example, or drop a model file"))
        return self.current_state

    def current(self) -> Computed:
        """The design that is, or a `UsageError` where it is not finished."""
        return self.base().checked()

    def _go(self, history: History[PageDraft], result: Computed | None = None) -> None:
        """Show where a history has come to; nothing has changed where that cannot be computed."""
        result = result or computed(history.now.design)
        self.view_state.last = last = (
            self.current_state if self.current_state and self.current_state.finished else None
        )
        if last is not None and last.design is not result.design:
            last.design.forget()
        self.current_state = result
        self.history, self.preview = history, None
        if self.before is not None and self.before.design is history.now.design:
            self.before = None  # nothing differs from itself

    def state_replies(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """The design that is shown, and how its support is shaken; notes come before its own."""
        with self.localized():
            state = self._state(seq)
        state.content["notes"] = [*notes, *state.content["notes"]]
        yield state
        if not self.view.finished:
            return
        with self.localized():
            compared = [*self.view_state.compared(None if self.preview else self.current())]
        yield from compared
        yield from self._response(seq)

    def _response(self, seq: int | None) -> Iterator[Reply]:
        """How the support is shaken, where the page has that of another design.

        It has no response over speed, which takes longer; the page loses the one that it has, so
        that `deferred_replies` has to send it again.
        """
        now, before = (self.shown, self.view_state.record), self.response_sent
        if now[0] is before[0] and now[1] is before[1]:
            return
        with self.localized():
            response = response_of(self.shown)
        self.response_sent, self.deferred_sent = now, (None, None)
        if response is not None:
            content, data = response
            yield Reply({"type": "response", "seq": seq, **content}, data)

    def _state(self, seq: int | None) -> Reply:
        assert self.scale is not None
        view = self.view
        last = self.written if self.brief and view.finished else None
        if view.finished:
            self.spectra = spectra_of(view.analysis, self.spectra if last else None)
        content, data = self._state_of(view)
        content |= last or self._numbers_of(view)
        file = self.disk and self.disk.status(None if self.preview else self._machine)
        content["wording"] = wording_of(words_of(self._machine))
        if self.numbered[0] is not view:
            self.numbered = view, self.numbered[1] + 1
        content["design"] = self.number_of(view)
        text = {"type": "state", "seq": seq, **self._past.content, "file": file}
        return Reply({**text, **content}, data)

    def number_of(self, result: Computed) -> int:
        """By which a page knows that it shows a design; 0 of one that it does not show."""
        newest, number = self.numbered
        return number if newest is result else 0

    def _numbers_of(self, computed: Computed) -> JsonObject:
        """The part of a state that a page writes: figures, and the numbers of the machine."""
        assert self.scale is not None
        against = self._against or self.view_state.pale or self.before
        figures = []
        if computed.finished:
            figures = figures_of(computed.analysis, against.analysis if against else None)
        fields = fields_of(computed.design).values()
        numbers = {
            "figures": figures,
            "fields": [self.scale.field_message(item) for item in fields],
        }
        self.written = numbers if computed.finished else None
        return numbers

    def _state_of(self, computed: Computed) -> tuple[JsonObject, bytes]:
        view = self.view_state
        return state_of(
            computed,
            self.spectra,
            view.pale or self.before,
            self.wanted,
            against=self._against,
            arrows_at=view.arrows_at,
            record=view.record,
        )

    @property
    def _against(self) -> Computed | None:
        """The design that figures are compared with, if any."""
        state = self.current_state if self.preview is not None else None
        current = state if state and state.finished else None
        return self.view_state.against(current) or self.before


def _in_file(error: EquipoiseError, name: str) -> EquipoiseError:
    """Copy of the error with the name of the file in front."""
    if isinstance(error, ModelError):
        return error.in_file(name)
    return UsageError(at_place(name, error.note)).with_paste(error.paste)
