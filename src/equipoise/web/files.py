"""Files of a page: those that it can keep, and the model file that its server was started with.

A page can download the model, its signals, its report and pictures; the only file that it may write
is the one that the server was started with.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from hashlib import sha256
from threading import Lock
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import LANGUAGES, Note, capital, speaking, to_say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.charts import Chart
from equipoise.schema.documents import dumps, load
from equipoise.schema.files import FileError, printable, read_text, to_csv, write
from equipoise.schema.models import AdjacentFiles, parts_of, taken_along
from equipoise.web.deferred import responded
from equipoise.web.design import Design
from equipoise.web.documents import played
from equipoise.web.edits import Computed, solved
from equipoise.web.messages import Message
from equipoise.web.replies import Reply

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool


SAME = {
    "polar": "polar",
    "path": "curves",
    "shaking_force": "force",
    "shaking_moment": "moment",
    "rocking_moment": "moment",
    "drive_torque": "torque",
    "drive_force": "torque",
    "spectrum": "spectrum",
    "joint": "joints",
}
"""Chart of the page -> picture of an analysis that shows the same."""
drawing = Lock()
"""Matplotlib draws one picture after the other."""
SECONDS = 2.0
"""That a turn of the crank takes in a film."""


def chart_of(computed: Computed, name: str, choice: str) -> Chart:
    """The picture of a chart of the page.

    choice : what is chosen in it.

    Raises
    ------
    UsageError : there is no such chart.
    EquipoiseError : it cannot be drawn of this machine.
    """
    machine, analysis = computed.analysis.machine, computed.analysis
    if name == "response":
        from equipoise.figures.vibration import response_charts

        return _named(response_charts(responded(computed)), f"gauge-{choice}")
    if name == "sweep":
        from equipoise.figures.vibration import sweep_charts
        from equipoise.vibration.forced import sweep_speed
        from equipoise.vibration.linear import around

        speeds = around(machine.drive, machine.drive.speed)
        return _named(sweep_charts(sweep_speed(machine, *speeds)), "response")
    if name.startswith(("stress-", "haigh-")):
        from equipoise.figures.link_strength import link_charts

        return _named({chart.name: chart for chart in link_charts(analysis)}, name)
    if name.startswith("run."):
        return _named(_charts_of_run(computed), name)
    if name in SAME:
        from equipoise.figures.analysis import analysis_charts

        return _named(analysis_charts(analysis), SAME[name])
    return _over_crank(computed, choice)


def _charts_of_run(computed: Computed) -> dict[str, Chart]:
    """Each panel of the charts of a machine's run as a chart, by its name on the page."""
    from equipoise.web.result_blocks import panel_name
    from equipoise.web.runs import run_of

    return {
        panel_name("run", item, number): replace(item, panels=(panel,))
        for item in run_of(computed).charts().values()
        for number, panel in enumerate(item.panels)
    }


def _named(pictures: Mapping[str, Chart], name: str) -> Chart:
    if name not in pictures:
        raise UsageError(unknown(name, pictures, "picture"))
    return pictures[name]


def _over_crank(computed: Computed, output: str) -> Chart:
    """An output over the crank angle; of all rows together where it is only there."""
    from equipoise.figures.chart_parts import ALL
    from equipoise.figures.forces import over_crank
    from equipoise.mechanism.parts.balance import ROWS
    from equipoise.results.outputs import TOTALS

    outputs = computed.analysis.outputs
    item = outputs[f"{ROWS}{output}" if f"{ROWS}{output}" in outputs else output]
    label = item.label()
    what = [(label, item.dimension, {ALL: item.values_to_draw})]
    total = item.name if item.group in TOTALS else ""
    return replace(over_crank(computed.analysis, "output", capital(label), what, total), keys=())


def linkage_at(computed: Computed, sample: int) -> Chart:
    """The drawing at a sample of the crank angle.

    Raises
    ------
    UsageError : there is no such sample.
    """
    from equipoise.figures.linkage import linkage

    angles = computed.motion.crank_angle
    if not 0 <= sample < len(angles):
        raise UsageError(
            Note(
                "got {sample} as sample of the crank angle; give 0 to {last}",
                sample=sample,
                last=len(angles) - 1,
            )
        )
    return linkage(computed.analysis, [float(angles[sample])])


def film_of(computed: Computed) -> bytes:
    """The whole cycle as a GIF, the support too where it moves."""
    from equipoise.figures.film import gif
    from equipoise.figures.motion import followed
    from equipoise.figures.stage import in_a_turn, smooth
    from equipoise.figures.swing import moving
    from equipoise.results.analysis import analyze

    analysis = analyze(computed.analysis.machine, smooth(in_a_turn("gif", SECONDS)))
    with drawing:
        scene, _ = moving(analysis)
        return gif(scene, traced=followed(analysis.motion), seconds=SECONDS)


MIMES = {
    "toml": "application/toml",
    "csv": "text/csv",
    "html": "text/html",
    "gif": "image/gif",
    "svg": "image/svg+xml",
    "png": "image/png",
}
"""Type of a file by the end of its name."""
FORBIDDEN = re.compile(r'[\\/:*?"<>|]+')
"""What some system would not have in the name of a file."""


Replies = Callable[[str], Iterable[Reply]]
"""Every reply that a page could get on the design, in a language."""


def downloaded(
    computed: Computed, message: Message, replies: Replies
) -> tuple[dict[str, Any], bytes]:
    """Name and type of a file that a message asks for, and its bytes.

    The model comes with the texts of the tables that it names, by the names of their files.

    Raises
    ------
    UsageError : there is no such file or language.
    EquipoiseError : it cannot be made of this machine.
    """
    kind = message.text("kind")
    if kind not in (MODEL, *FILES, PLAYED):
        raise UsageError(unknown(kind, (MODEL, *FILES, PLAYED), "download"))
    options: dict[str, Any] = {}
    stem = FORBIDDEN.sub("-", computed.design.name.removesuffix(".toml")) or "machine"
    if kind == PLAYED:
        language = message.text("language", "en")
        end, data = "-played.html", played(computed, replies(language), language).encode()
    elif kind == MODEL:
        text, options["files"] = taken_along(computed.design.machine, f"{stem}.toml")
        end, data = ".toml", text.encode()
    else:
        end, data = FILES[kind](computed, message, stem)
    name = f"{stem}{end}"
    return {"name": name, "mime": MIMES[name.rpartition(".")[2]], **options}, data


NameAndBytes = tuple[str, bytes]
"""What follows the name of the machine in that of the file, and its bytes."""


def _csv(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return ".csv", to_csv(computed.analysis).encode()


def _report(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    from equipoise.present.composition import report_page
    from equipoise.present.findings import Findings

    language = message.text("language", "en")
    if language not in LANGUAGES:
        raise UsageError(unknown(language, LANGUAGES, "language of reports"))
    file, _ = taken_along(computed.design.machine, f"{stem}.toml")
    findings = Findings(computed.analysis.machine, file, f"{stem}.toml", swings=computed.swings)
    with drawing:
        text = report_page(findings, language)
    return "-report.html", text.encode()


def _film(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return ".gif", film_of(computed)


def _drawing(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    return _rendered(linkage_at(computed, message.whole("at", 0)), "drawing", message)


def _chart(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    name, choice = message.text("chart"), message.text("choice", "")
    return _rendered(
        chart_of(computed, name, choice), choice if name == "output" else name, message
    )


def _rendered(picture: Any, name: str, message: Message) -> NameAndBytes:
    from equipoise.figures import render

    kind = message.text("format", "svg")
    if kind not in ("svg", "png"):
        raise UsageError(unknown(kind, ("svg", "png"), "format of pictures"))
    with drawing:
        data = render(picture, "png" if kind == "png" else "svg")
    return f"-{FORBIDDEN.sub('-', name.replace('.', '-'))}.{kind}", data


def _interactive(computed: Computed, message: Message, stem: str) -> NameAndBytes:
    from equipoise.exchange.export import export_content
    from equipoise.exchange.formats import FORMATS

    language = message.text("language", "en")
    if language not in LANGUAGES:
        raise UsageError(unknown(language, LANGUAGES, "language of pages"))
    with speaking(language):
        _, page = export_content(computed.analysis.machine, FORMATS["html"])
    assert isinstance(page, str)
    return "-interactive.html", page.encode()


FILES: dict[str, Callable[[Computed, Message, str], NameAndBytes]] = {
    "csv": _csv,
    "report": _report,
    "drawing": _drawing,
    "chart": _chart,
    "film": _film,
    "interactive": _interactive,
}
"""What there is."""
MODEL = "model"
"""Besides, the model with its tables."""
PLAYED = "played"
"""And a page in one file."""


NOT_OF_FILE = to_say("{name} was not opened from a file; download the model instead")
COMMENT = re.compile(r"^\s*#|\s#\s", re.MULTILINE)


@dataclass
class Disk:
    """A model file as it was last read or written.

    Each page has one of its own, so that none writes over what another one has saved.

    path : of the file.  place : where that was when it was opened, without links.
    text : what it holds.  model : that is in it.
    lock : held while it is written, since pages share the file.
    """

    path: str
    place: str
    text: str
    model: Machine | Tool
    lock: Lock = field(default_factory=Lock)

    @property
    def name(self) -> str:
        """Base name of the file, printable."""
        return printable(os.path.basename(self.path))

    @property
    def base(self) -> str:
        """A short sign of what the file holds, by which a page knows what its steps began with."""
        return sha256(self.text.encode()).hexdigest()[:16]

    @property
    def has_comments(self) -> bool:
        """Whether saving would lose comments, which a model does not hold."""
        return COMMENT.search(self.text) is not None

    def status(self, model: Machine | Tool | None) -> dict[str, Any]:
        """Name of the file, and whether it has exactly this model; None is an unfinished model."""
        return {"name": self.name, "saved": self.model == model, "comments": self.has_comments}

    def reply(self, seq: int | None, text: str) -> Reply:
        """The reply that a file is saved; `text` is the model that the page's steps began with."""
        saved = {"name": self.name, "base": self.base, "text": text}
        return Reply({"type": "saved", "seq": seq, **saved})

    def now(self) -> Disk:
        """File for another page, with what it holds by now, where that is of its kind."""
        text = self._on_disk()
        if text is None or text == self.text:
            return replace(self)
        try:
            model = load(self.path)
            if isinstance(model, Machine):
                solved(Design(self.name, model))
            else:
                from equipoise.web.tool_state import ToolFigures

                _ = ToolFigures(model).whole
        except EquipoiseError:
            return replace(self)
        return (
            replace(self, text=text, model=model)
            if type(model) is type(self.model)
            else replace(self)
        )

    def save(self, model: Machine | Tool) -> None:
        """Put a model in the place of what the file holds.

        Raises
        ------
        UsageError : somebody else has changed the file meanwhile, or it cannot be written, or
            lacks a table beside it.
        ModelError : it has what no file can represent.
        """
        text = dumps(model)
        with self.lock:
            if not os.path.lexists(self.place):
                raise UsageError(
                    Note(
                        "{name}: the file was moved or deleted since it was opened here; download "
                        "the model to keep it",
                        name=self.name,
                    )
                )
            if self._on_disk() != self.text:
                raise UsageError(
                    Note(
                        "{name}: the file was changed since it was opened here, by another page or "
                        "program; download the model to keep this one, or load the page again to "
                        "see that one",
                        name=self.name,
                    )
                )
            self._check_tables(model)
            write(self.place, text, links=False)
            self.text, self.model = text, model

    def _check_tables(self, model: Machine | Tool) -> None:
        """Nothing but the model file is written: its tables have to lie beside it."""
        for part in parts_of(model):
            try:
                on_disk = AdjacentFiles(os.path.dirname(self.path)).read(part.sort, part.file)
            except EquipoiseError:
                on_disk = None
            if on_disk != part.value:
                raise UsageError(
                    Note(
                        "{name}: the table {table!r} does not lie beside it as it is here; put it "
                        "there, or download the model with its tables",
                        name=self.name,
                        table=printable(part.file),
                    )
                )

    def _on_disk(self) -> str | None:
        """What the file holds now; None where it cannot be read."""
        try:
            return read_text(self.place, within=os.path.dirname(self.place))
        except FileError:
            return None


def on_disk(path_or_name: str, model: Machine | Tool) -> Disk | None:
    """The file that a model was read from; None of a bundled example."""
    if not os.path.isfile(path_or_name):
        return None
    path, place = os.path.abspath(path_or_name), os.path.realpath(path_or_name)
    return Disk(path, place, read_text(place), model)
