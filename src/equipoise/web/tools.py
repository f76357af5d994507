"""A hand-held tool on the page: numbers by the paths of studies, what was done, what is shown."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cached_property

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.handheld.model import Tool
from equipoise.i18n import LANGUAGES, Note, localized, say
from equipoise.mechanism.checks import unknown
from equipoise.quantities import in_unit, parse, typeset
from equipoise.quantities.units import KINDS
from equipoise.schema.files import printable
from equipoise.schema.models import taken_along
from equipoise.schema.numbers import FileNumber, format_share, parse_share
from equipoise.schema.open_files import opened
from equipoise.schema.template import Template, named_parts
from equipoise.web.design import History, HistoryStep
from equipoise.web.files import NOT_OF_FILE, Disk
from equipoise.web.messages import JsonObject, Message, Setting
from equipoise.web.replies import Reply
from equipoise.web.tool_state import ToolFigures, tool_state

NOT_SHOWN = ("design.", "title", "description")
"""Begin paths of what only says what a design may change."""
SHOWN = 5
"""Significant digits of a number that is not typed."""


@dataclass(frozen=True, eq=False)
class ToolStep:
    """One state of a tool: numbers that are others than in the file, by path, SI units."""

    values: Mapping[str, float]
    tool: Tool

    @cached_property
    def figures(self) -> ToolFigures:
        """What is computed of it."""
        return ToolFigures(self.tool)


@dataclass
class ToolDesk:
    """A tool that is open on a page.

    name : of its file.  template : in which numbers are put.
    history : what was done.  preview : while a slider is held.
    disk : its file, if it can be saved.
    """

    name: str
    template: Template
    history: History[ToolStep]
    preview: ToolStep | None = None
    disk: Disk | None = None

    @property
    def first(self) -> ToolStep:
        """As it was opened, or the oldest that is kept."""
        return self.history.first

    @property
    def now(self) -> ToolStep:
        """As it is, but for a slider that is held."""
        return self.history.now.design

    @property
    def again(self) -> ToolDesk:
        """Desk of this tool for another page, as the tool was opened."""
        return ToolDesk(self.name, self.template, History(HistoryStep(self.first, "")))

    @classmethod
    def of(cls, name: str, template: Template) -> ToolDesk:
        """That of a file; the errors are those of its tool."""
        tool = template.base()
        if not isinstance(tool, Tool):
            raise UsageError(
                Note("{name}: got the file of a linkage; give that of a tool", name=name)
            )
        return cls(name, template, History(HistoryStep(ToolStep({}, tool), "")))

    # -- what a page may ask -----------------------------------------------------------------------

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer what can be asked of a tool; errors where it cannot."""
        if message.kind == "edit":
            self._edit(message)
        elif message.kind in ("undo", "redo"):
            undo = message.kind == "undo"
            self.history = self.history.undone() if undo else self.history.redone()
            self.preview = None
        elif message.kind == "download":
            yield self._download(message)
            return
        elif message.kind == "save":
            self._save()
        elif message.kind == "record":
            raise UsageError(
                Note(
                    "a record stands beside curves over the crank angle, and a tool has none; open "
                    "a linkage first"
                )
            )
        elif message.kind not in ("ready", "open"):
            raise UsageError(Note("{kind} is for linkages; a tool is open", kind=message.kind))
        yield self.reply(message.seq)
        if message.kind == "save" and self.disk is not None:
            yield self.disk.reply(message.seq, self.template.text)

    def _save(self) -> None:
        if self.disk is None:
            raise UsageError(Note(NOT_OF_FILE, name=self.name))
        self.disk.save(self.now.tool)

    def _edit(self, message: Message) -> None:
        commit, values = message.flag("commit", True), dict(self.now.values)
        for change in message.changes():
            if not isinstance(change, Setting):
                raise UsageError(Note("a tool has no joints to be dragged; set a number of it"))
            values[change.path] = self._value(change)
        try:
            tool_step = ToolStep(values, self._tool(values))
            _ = tool_step.figures.whole
        except (ModelError, UsageError):
            if not commit or self.preview is None:
                raise
            tool_step = self.preview  # the last place of a slider at which it could be
        if commit:
            self.history, self.preview = self.history.then(tool_step, message.label), None
        else:
            self.preview = tool_step

    def _value(self, change: Setting) -> float:
        """What a number is set to, SI units."""
        numbers = self._numbers()
        if change.path not in numbers:
            raise UsageError(unknown(change.path, numbers, "number of this tool"))
        number, typed = numbers[change.path], change.to
        if not isinstance(typed, str):
            return typed
        text = typed.strip()
        if number.dimension is not None:
            return parse(text, number.dimension)
        share = parse_share(text)
        try:
            return float(text) if share is None else share
        except ValueError:
            raise UsageError(
                Note("got {text!r}; give a plain number, such as 2", text=printable(text))
            ) from None

    def _tool(self, values: Mapping[str, float]) -> Tool:
        tool = self.template.machine(values)
        assert isinstance(tool, Tool)
        return tool

    def _download(self, message: Message) -> Reply:
        kind, language = message.text("kind"), message.text("language", "en")
        stem = self.name.removesuffix(".toml") or "tool"
        name, mime = f"{stem}.toml", "application/toml"
        text, files = taken_along(self.now.tool, name)
        if kind == "report":
            from equipoise.present.composition import report_page
            from equipoise.present.findings import ToolFindings

            if language not in LANGUAGES:
                raise UsageError(unknown(language, LANGUAGES, "language of reports"))
            tool_findings = ToolFindings(self.now.tool, text, name)
            text, name, mime = (
                report_page(tool_findings, language),
                f"{stem}-report.html",
                "text/html",
            )
        elif kind != "model":
            raise UsageError(
                Note("{kind}: that is there for linkages; of a tool, model or report", kind=kind)
            )
        statement: JsonObject = {"type": "file", "seq": message.seq, "name": name, "mime": mime}
        if kind == "model":
            statement["files"] = files
        return Reply(statement, text.encode())

    # -- values for replies ------------------------------------------------------------------------

    @property
    def shown(self) -> ToolStep:
        """What the page sees."""
        return self.preview or self.now

    def reply(self, seq: int | None) -> Reply:
        """Everything that the page shows of the tool."""
        content, data = tool_state(self.shown.figures, self.first.figures)
        head = {"type": "tool", "seq": seq, "name": self.name, "fields": [*self._fields()]}
        file = self.disk and self.disk.status(None if self.preview else self.now.tool)
        return Reply({**head, **self.history.content, "file": file, **content}, data)

    def _numbers(self) -> dict[str, FileNumber]:
        numbers = self.template.numbers()
        return {path: item for path, item in numbers.items() if not path.startswith(NOT_SHOWN)}

    def _fields(self) -> Iterator[JsonObject]:
        """Fields of the tool's numbers, with the keys of `fields` of a linkage."""
        values, length = self.shown.values, self.first.tool.shaft.length
        for path, number in self._numbers().items():
            value = float(values.get(path, number.value))
            usual = float(number.value)
            low, high = sorted((0.0, 2 * usual or 1.0))
            if path.endswith(".position"):
                low, high = 0.0, length
            group, known = _group(self.first.tool, path)
            text = {
                "path": path,
                "group": group,
                "heading": group,
                "label": localized(self.template.words(path, known=known)),
                "value": value,
                "min": min(low, value),
                "max": max(high, value),
                "step": (high - low) / 1000,
                "kind": "number",
            }
            yield {**text, **_written(number, value, self.template.unit(path))}


def _group(tool: Tool, path: str) -> tuple[str, int]:
    """The heading that a number belongs under, and how many tables of its path that names."""
    parts = path.replace("[", ".").replace("]", "").split(".")
    if parts[:2] == ["shaft", "stations"]:
        return tool.stations[int(parts[2]) - 1].name, 2
    if parts[0] == "excitations":
        excitation = tool.excitations[int(parts[1]) - 1]
        return excitation.name or excitation.file or excitation.station, 1
    if parts[0] == "work":
        return tool.work[int(parts[1]) - 1].name, 1
    return (say("shaft"), 1) if parts[0] == "shaft" else (parts[0], 0)


def _written(number: FileNumber, value: float, unit: str) -> JsonObject:
    """A number in the unit of its file: as it is typed, and as it is read."""
    if number.share:
        text = format_share(value)
        return {"text": text, "shown": text, "unit": "%", "factor": 100.0}
    if number.dimension is None:
        text = f"{value:.{SHOWN}g}"
        return {"text": repr(value), "shown": typeset(text), "unit": "", "factor": 1.0}
    unit_display = in_unit(unit or KINDS[number.dimension].printed[0])
    text = f"{unit_display.factor * value:.12g} {unit_display.unit}"
    read = unit_display.with_unit(typeset(f"{unit_display.factor * value:.{SHOWN}g}"))
    return {"text": text, "shown": read, "unit": unit_display.unit, "factor": unit_display.factor}


def tool_asked(message: Message, disk: Disk | None) -> ToolDesk:
    """The tool that a message of the kind `open` wants, where it `wants_tool`.

    disk : the file that the page began with.
    """
    if "example" in message.values:
        return tool_of_file(message.text("example"))
    text = message.text("text")
    own = disk if message.flag("file", False) else None
    known = None if own is None else named_parts(own.model)[1]
    name = printable(message.text("name", "tool.toml"))
    template = Template(text.removeprefix("\ufeff"), name, known=known, texts=message.files)
    tool = ToolDesk.of(name, template)
    tool.disk = own
    return tool


def tool_of_file(path_or_name: str | os.PathLike[str]) -> ToolDesk:
    """The tool of a file, with the tables beside it, or of an example."""
    name = printable(os.path.basename(path_or_name))
    return ToolDesk.of(name, Template.of_opened(opened(path_or_name)))
