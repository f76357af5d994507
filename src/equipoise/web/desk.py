"""What a page talks to: the session of a machine, or a tool that has been opened in its place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field

from equipoise.errors import EquipoiseError
from equipoise.i18n import speaking
from equipoise.mechanism.shown_units import units_of
from equipoise.quantities import showing_by_default
from equipoise.schema.opening import kind_of_text, opened
from equipoise.web.disk import on_disk
from equipoise.web.messages import Message
from equipoise.web.openings import opened_file
from equipoise.web.replies import Reply, refused
from equipoise.web.session import Session
from equipoise.web.tools import ToolDesk, tool_asked, tool_of_file

ALWAYS = ("speak", "gallery")
"""What has nothing to do with what is open."""


@dataclass
class Desk:
    """The counterpart of a page.

    session : of its machine.  tool : that is open instead, if any.
    """

    session: Session = field(default_factory=Session)
    tool: ToolDesk | None = None

    def hello(self) -> Reply:
        """The first thing that a page is told."""
        reply = self.session.hello()
        reply.content["machine"] |= self.tool is not None
        return reply

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message; what takes long comes last, and may be left unasked."""
        try:
            if message.kind == "open":
                self.tool = tool_asked(message)
        except EquipoiseError as error:
            yield refused(message.seq, error, self.session.language)
            return
        if self.tool is None or message.kind in ALWAYS:
            yield from self.session.receive(message)
            return
        if message.kind == "ready":
            yield self.hello()
        try:
            with self._telling():
                replies = [*self.tool.receive(message)]
        except EquipoiseError as error:
            replies = [refused(message.seq, error, self.session.language)]
        yield from replies

    @property
    def has_more(self) -> bool:
        """Whether there is more to tell, which takes longer."""
        return self.tool is None and self.session.has_more

    def tell_more(self) -> Iterator[Reply]:
        """What takes too long to be told at every move of a drag."""
        return self.session.tell_more()

    def _telling(self) -> AbstractContextManager[object]:
        """Inside, the reader's language is spoken, in the units of the file that is open."""
        inside = ExitStack()
        inside.enter_context(speaking(self.session.language))
        if self.tool is not None:
            inside.enter_context(showing_by_default(units_of(self.tool.now.tool)))
        return inside


def begun(file: str | None) -> Callable[[], Desk]:
    """Makes the counterparts of pages that begin with a file, or with nothing.

    Raises
    ------
    EquipoiseError : what is in the file cannot be computed.
    """
    if file is None:
        return Desk
    if kind_of_text(opened(file).text) == "tool":
        tool = tool_of_file(file)
        _ = tool.first.figures.whole
        return lambda: Desk(Session(), tool.again)
    first = Session()
    first.open(opened_file(file))
    disk = on_disk(file, first.shown)

    def begin() -> Desk:
        session = Session(disk=disk)
        found = first.shown if disk is None else disk.found
        session.open(found.design, found)
        return Desk(session)

    return begin
