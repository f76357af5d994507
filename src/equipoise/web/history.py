"""What was done on a page, step by step: undo and redo."""

from __future__ import annotations

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.web.design import Design
from equipoise.web.sketch import Sketch

MOST_STEPS = 500


@dataclass(frozen=True)
class HistoryStep:
    """A design, and what was done to get there."""

    design: Design | Sketch
    label: str


@dataclass(frozen=True)
class History:
    """Steps in the order in which they were made; `now` stands between `past` and `future`."""

    now: HistoryStep
    past: tuple[HistoryStep, ...] = ()
    future: tuple[HistoryStep, ...] = ()

    @property
    def first(self) -> Design | Sketch:
        """The design that was opened, or the oldest that is kept."""
        return (*self.past, self.now)[0].design

    @property
    def undo(self) -> str | None:
        """What would be taken back."""
        return self.now.label if self.past else None

    @property
    def redo(self) -> str | None:
        """What would be done again."""
        return self.future[0].label if self.future else None

    def then(self, design: Design | Sketch, label: str) -> History:
        """One step more; what was taken back is forgotten."""
        return History(HistoryStep(design, label), (*self.past[1 - MOST_STEPS :], self.now))

    def undone(self) -> History:
        """One step back, or a `UsageError`."""
        if not self.past:
            raise UsageError(Note("there is nothing to undo"))
        return History(self.past[-1], self.past[:-1], (self.now, *self.future))

    def redone(self) -> History:
        """One step forth again, or a `UsageError`."""
        if not self.future:
            raise UsageError(Note("there is nothing to redo"))
        return History(self.future[0], (*self.past, self.now), self.future[1:])
