"""What a page talks to: the session of a machine, or a tool that has been opened in its place."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, speaking
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import units_of
from equipoise.quantities import showing_by_default
from equipoise.schema.files import printable
from equipoise.schema.open_files import kind_of_text, opened
from equipoise.web.design import Design
from equipoise.web.edits import solved
from equipoise.web.files import on_disk
from equipoise.web.gallery import opened_file, wants_tool
from equipoise.web.messages import Message
from equipoise.web.replies import Reply, refused
from equipoise.web.session import NO_STORE, Session

if TYPE_CHECKING:
    from equipoise.web.stores import StoreDesk
    from equipoise.web.tools import ToolDesk

ALWAYS = ("speak", "gallery")
"""What has nothing to do with what is open."""
OF_STORE = ("ready", "study", "design")
"""What is asked of a store."""


@dataclass
class PageBackend:
    """The counterpart of a page.

    session : of its machine.  tool : that is open instead, if any.
    store : of a study.  studied : whether it is what is shown.
    folder : in which stores are looked for, by their names; none where there is no server.
    """

    session: Session = field(default_factory=Session)
    tool: ToolDesk | None = None
    store: StoreDesk | None = None
    studied: bool = False
    folder: Path | None = None

    def hello(self) -> Reply:
        """The first reply to a page."""
        reply = self.session.hello()
        reply.content["machine"] |= self.tool is not None or self.studied
        reply.content["base"] = reply.content["base"] or self._name
        reply.content["study"] = None if self.store is None else self.store.name
        return reply

    @property
    def _name(self) -> str:
        """Of what is open; empty where nothing is."""
        if self.studied:
            return "" if self.store is None else self.store.name
        if self.tool is not None:
            return self.tool.name
        return "" if self.session.current_state is None else self.session.current_state.design.name

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message; what takes long comes last, and may be left unasked."""
        if message.kind in ALWAYS:
            yield from self.session.receive(message)
            return
        if message.kind == "stores":
            yield self._stores(message)
            return
        try:
            self._turn_to(message)
            replies = [] if self._of_session else [*self._answers(message)]
        except EquipoiseError as error:
            yield refused(message.seq, error, self.session.language)
            return
        if self._of_session and message.kind == "design":
            yield from self.session.state_replies(message.seq)
        elif self._of_session:
            for reply in self.session.receive(message):
                yield self.hello() if reply.content["type"] == "hello" else reply
        yield from replies

    @property
    def _of_session(self) -> bool:
        """Whether what is shown is a machine, or nothing."""
        return self.tool is None and not self.studied

    def _turn_to(self, message: Message) -> None:
        """Open what a message wants to be open."""
        if message.kind == "open":
            self.tool, self.studied = self._tool_asked(message), False
        if message.kind not in ("study", "design"):
            return
        self.store = self._store_of(message.optional("store"))
        if message.kind == "study":
            self.studied = True
            return
        number = message.whole("number", 0)
        model, name = self.store.model(number), f"{self.store.name} {number}"
        if isinstance(model, Machine):
            self.session.open(Design(name, model))
            self.tool = None
        else:
            from equipoise.schema.template import Template
            from equipoise.web.tools import ToolDesk

            self.tool = ToolDesk.of(name, Template.of(model))
        self.session.disk, self.studied = None, False

    def _tool_asked(self, message: Message) -> ToolDesk | None:
        """The tool that is to be opened, if any."""
        if not wants_tool(message):
            return None
        from equipoise.web.tools import tool_asked

        return tool_asked(message, self.session.disk)

    def _stores(self, message: Message) -> Reply:
        """Stores that the page may open."""
        from equipoise.web.stores import stores_in

        names = [] if self.folder is None else stores_in(self.folder)
        folder = None if self.folder is None else printable(self.folder.name)
        return Reply({"type": "stores", "seq": message.seq, "folder": folder, "names": names})

    def _store_of(self, name: str | None) -> StoreDesk:
        """The store that is open, or another one of the folder, by nothing but its name there."""
        from equipoise.web.stores import StoreDesk, stores_in

        if self.store is not None and name in (None, self.store.name):
            return self.store
        if name is None or self.folder is None:
            raise UsageError(NO_STORE)
        if name not in stores_in(self.folder):
            raise UsageError(
                Note(
                    "{folder} has no store of the name {name!r}; choose one that is listed",
                    folder=printable(self.folder.name),
                    name=printable(name),
                )
            )
        return StoreDesk.load(str(self.folder / name))

    def _answers(self, message: Message) -> Iterator[Reply]:
        """What a store or a tool answers."""
        if message.kind == "ready":
            yield self.hello()
        with self._localized():
            if self.tool is not None and not self.studied:
                replies = [*self.tool.receive(message)]
            elif self.store is None or message.kind not in OF_STORE:
                raise UsageError(Note("a study is open; choose one of its designs first"))
            else:
                replies = [self.store.reply(message.seq)]
        yield from replies

    @property
    def language(self) -> str:
        """That the reader speaks."""
        return self.session.language

    @property
    def has_more(self) -> bool:
        """Whether deferred replies are due."""
        return self._of_session and self.session.has_more

    def deferred_replies(self) -> Iterator[Reply]:
        """Replies that take too long for every move of a drag."""
        return self.session.deferred_replies()

    def _localized(self) -> AbstractContextManager[object]:
        """Context in the reader's language and in the units of the open file."""
        inside = ExitStack()
        inside.enter_context(speaking(self.session.language))
        if self.tool is not None and not self.studied:
            inside.enter_context(showing_by_default(units_of(self.tool.now.tool)))
        return inside


def begun(file: str | None) -> Callable[[], PageBackend]:
    """Makes the counterparts of pages that begin with a file, or with nothing.

    Raises
    ------
    EquipoiseError : what is in the file cannot be computed.
    """
    from equipoise.web.stores import StoreDesk, is_store
    from equipoise.web.tools import tool_of_file

    there = file is not None and os.path.exists(file)
    folder = Path(os.path.abspath(file)).parent if there and file else Path.cwd()
    if file is None:
        return lambda: PageBackend(folder=folder)
    if is_store(file):
        store = StoreDesk.load(file)
        return lambda: PageBackend(Session(), store=store, studied=True, folder=folder)
    if kind_of_text(opened(file).text) == "tool":
        tool = tool_of_file(file)
        _ = tool.first.figures.whole
        file_on_disk = on_disk(file, tool.first.tool)

        def begin_tool() -> PageBackend:
            own = file_on_disk and file_on_disk.now()
            again = (
                tool.again if own is None or own.text == tool.template.text else tool_of_file(file)
            )
            again.disk = own
            return PageBackend(Session(disk=own), again, folder=folder)

        return begin_tool
    first = Session()
    first.open(opened_file(file))
    disk = on_disk(file, first.shown.design.machine)

    def begin() -> PageBackend:
        own = disk and disk.now()
        session = Session(disk=own)
        result = first.shown
        if disk is not None and own is not None and own.text != disk.text:
            assert isinstance(own.model, Machine)
            result = solved(Design(result.design.name, own.model))
        session.open(result.design, result)
        return PageBackend(session, folder=folder)

    return begin
