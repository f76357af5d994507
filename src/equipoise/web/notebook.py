"""The widget: a session, whose messages travel as a notebook's do."""

from __future__ import annotations

from collections.abc import Iterator

import anywidget
import traitlets

from equipoise.errors import EquipoiseError
from equipoise.mechanism.model import Machine
from equipoise.web.assets import assets
from equipoise.web.messages import message_of
from equipoise.web.replies import Reply, refused
from equipoise.web.session import Session


class View(anywidget.AnyWidget):
    """A machine in a notebook."""

    _esm = traitlets.Unicode().tag(sync=True)
    _css = traitlets.Unicode().tag(sync=True)

    def __init__(self, session: Session) -> None:
        built = assets()
        super().__init__(_esm=built["equipoise.js"].decode(), _css=built["equipoise.css"].decode())
        self._session = session
        self.on_msg(self._answer)

    @property
    def machine(self) -> Machine:
        """The machine as it has been changed by now."""
        return self._session.shown.design.machine

    def _answer(self, _: object, content: object, buffers: object) -> None:
        for reply in _replies(self._session, content):
            self.send(reply.content, [reply.buffer] if reply.buffer else [])


def _replies(session: Session, content: object) -> Iterator[Reply]:
    try:
        message = message_of(content)
    except EquipoiseError as error:
        yield refused(None, error)
        return
    yield from session.receive(message)
    if not message.preview and session.has_more:
        yield from session.tell_more()
