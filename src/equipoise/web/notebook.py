"""The widget: a session, whose messages travel as a notebook's do."""

from __future__ import annotations

import anywidget
import traitlets

from equipoise.mechanism.parts.machine import Machine
from equipoise.web.documents import assets
from equipoise.web.replies import answers
from equipoise.web.session import Session


class NotebookView(anywidget.AnyWidget):
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
        for reply in answers(self._session, content):
            self.send(reply.content, [reply.buffer] if reply.buffer else [])
