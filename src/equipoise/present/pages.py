"""A report as a page of HTML: its fonts, its colours, and plain values in its template."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import field
from functools import cache
from html import escape
from importlib import resources
from itertools import groupby
from typing import TYPE_CHECKING, Any

import jinja2
from markupsafe import Markup

import equipoise
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.figures.style import DIM, GRID, LOUD, POINTS, QUIET, STRETCH, STUBBLE
from equipoise.i18n import Note, decimals, say, speaking, spoken
from equipoise.i18n.languages import KNOWN
from equipoise.present.cells import CellText, noted, printed, printed_grid
from equipoise.present.terminal import Looks
from equipoise.quantities import Units, showing
from equipoise.results.blocks import Block, Emphasis, ReportSection, SvgPicture, Table
from equipoise.results.blocks import Text as RunningText
from equipoise.symbols.looks import DARK, LIGHT

if TYPE_CHECKING:
    import typst

LATIN = "DejaVu Sans"
"""The font of Western letters, which comes with Matplotlib: pages end alike on every computer."""
NO_TYPST = Note('a PDF needs Typst; install it by: pip install "equipoise[report]"')
LAST_WESTERN = "\u2e7f"
"""Signs after it are letters of East Asia, which not every computer has."""


def check_pdf(language: str) -> None:
    """Raise if something that a PDF needs is missing, before anything is computed."""
    families(language)


@cache
def installed() -> typst.Fonts:
    """All that this computer has, and those of Matplotlib."""
    try:
        import typst
    except ImportError as error:
        raise EquipoiseError(NO_TYPST) from error
    from equipoise.figures.paint import font_folder

    return typst.Fonts(font_paths=[font_folder()])


def families(language: str) -> list[str]:
    """Fonts that are there for a language, the best first."""
    there = set(installed().families())
    wanted = {code: item.fonts for code, item in KNOWN.items() if item.fonts}
    eastern = {code: [name for name in names if name in there] for code, names in wanted.items()}
    if language in eastern and not eastern[language]:
        raise UsageError(
            Note(
                "this computer has no font with {languages} letters, so that a PDF would "
                "show boxes; install one, such as {eastern} (fonts-noto-cjk), or write "
                "the report as .html",
                languages=KNOWN[language].name,
                eastern=wanted[language][0],
            )
        )
    order = sorted(eastern, key=lambda code: code != language)
    return [LATIN, *(name for code in order for name in eastern[code])]


def boxes(text: str) -> str:
    """Letters of East Asia in a text that no font of this computer has, each once."""
    from equipoise.figures.paint import fonts_for

    signs = frozenset(sign for sign in text if sign > LAST_WESTERN)
    return fonts_for(signs)[1] if signs else ""


NAMES = {color: name for name, color in LIGHT.items()} | {
    GRID: "grid",
    STUBBLE: "stubble",
    QUIET: "quiet",
    LOUD: "loud",
    STRETCH: "stretch",
    POINTS: "points",
    DIM: "dim",
}
"""Colour of a picture -> name of the page's property that takes its place."""
DARK_ONLY = {
    "grid": "#2b3138",
    "soil": "#332c20",
    "stubble": "#57492f",
    "earth": "#c9a774",
    "quiet": "#22272d",
    "loud": "#343b43",
    "stretch": "#6e4631",
    "points": "#4f86b5",
    "dim": "#525a63",
}

PRINTED_STRESS = "#8c3200"
"""Colour of words on paper that have to be seen: as the same red of pictures, they would be paler
than other words where a page is printed in grey."""


def colored(color: str) -> str:
    """A colour of a picture as the page has it."""
    return f"var(--linkage-{NAMES[color]},{color})" if color in NAMES else color


def colors(dark: bool) -> str:
    """The properties of a page, as a style sheet has them."""
    chosen = {**DARK, **DARK_ONLY} if dark else {**LIGHT, **{v: k for k, v in NAMES.items()}}
    return ";".join(f"--linkage-{name}:{color}" for name, color in chosen.items())


@dataclass(frozen=True)
class Tile:
    """One figure that is seen at once; `note` stands below it.

    after : the same after the change that helps most, where that makes it another.
    emphasis : why it stands out, if it does.
    """

    label: str
    value: str
    unit: str
    note: str = ""
    after: str = ""
    emphasis: Emphasis | None = None


@dataclass(frozen=True)
class SummaryAnswer:
    """A part of the summary: what it answers, and the answer in sentences.

    worse : those of the sentences that say what gets worse, which stand out.
    """

    question: str
    sentences: tuple[str, ...]
    worse: tuple[str, ...] = ()


@dataclass(frozen=True)
class ReportDocument:
    """A whole report.

    language : its code.  subtitle : what runs, how fast.  animation : SVG, empty where none moves.
    appendix : long tables and details of the sections, by their names, and the model file.
    lead : what stands above it.
    verdict : by what it is judged first; None where nothing is large or known.
    units : that are chosen, by dimension.
    drawing : of the whole machine, which the summary shows where nothing moves.
    """

    language: str
    title: str
    subtitle: str
    description: str
    tiles: tuple[Tile, ...]
    summary: tuple[SummaryAnswer, ...]
    animation: str
    sections: tuple[ReportSection, ...]
    appendix: tuple[ReportSection, ...] = ()
    lead: str = ""
    verdict: RunningText | None = None
    units: Units = field(default_factory=dict)
    drawing: SvgPicture | None = None

    def appendix_contents(self, section: str) -> str:
        """How much of a section stands in the appendix, in words; empty where nothing does."""
        own = [
            block
            for report_section in self.appendix
            if report_section.name == section
            for block in report_section.blocks
        ]
        tables, pictures = (sum(isinstance(b, kind) for b in own) for kind in (Table, SvgPicture))
        text = []
        if pictures:
            text.append(say("Pictures in the appendix: {count}", count=pictures))
        if tables:
            text.append(say("Tables in the appendix: {count}", count=tables))
        return say("; ").join(text)

    def without_drawing(
        self, blocks: Iterable[Block | ReportSection]
    ) -> list[Block | ReportSection]:
        """Blocks but for the drawing that the summary has."""
        return [block for block in blocks if block is not self.drawing]

    @contextmanager
    def spoken(self) -> Iterator[None]:
        """Inside, its language is spoken, and values are shown in its units."""
        with speaking(self.language), showing(self.units):
            yield


_COLOR = re.compile("#[0-9a-f]{6}(?=[;\"' ])")
_USED = re.compile(r'(?:url\(#|href="#)([^)"]+)')
_NAME = re.compile(r' id="([^"]*)"')
_SPACE = re.compile(r"\n\s*")
_FAMILY = re.compile('font-family: [^;"]*; ?')


def inlined(svg: str, name: str, title: str) -> str:
    """A picture as a part of a page.

    name : no other picture of the page has it.  title : what it shows, for those who cannot see.
    """
    head, body = svg[svg.index("<svg") :].split(">", 1)
    body = re.sub(r"<metadata>.*?</metadata>", "", body, count=1, flags=re.DOTALL)
    body = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", body, count=1, flags=re.DOTALL)
    body = body.replace("xlink:href", "href")
    body = _FAMILY.sub("", body)
    used = set(_USED.findall(body))
    body = _NAME.sub(lambda result: f' id="{name}-{result[1]}"' if result[1] in used else "", body)
    body = body.replace("url(#", f"url(#{name}-").replace('href="#', f'href="#{name}-')
    body = _COLOR.sub(lambda match: colored(match[0]), body)
    width, height = re.findall(r'viewBox="0 0 ([0-9.]+) ([0-9.]+)"', head)[0]
    opening = (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(title)}" '
        f'viewBox="0 0 {width} {height}" style="--wide:{float(width):.0f}pt">'
    )
    return _SPACE.sub(" ", f"{opening}{body}").strip()


def part_of_page(title: str, blocks: Iterable[Block | ReportSection], picture: str = "") -> str:
    """Blocks below a title as a part of a page that has no style of its own.

    picture : SVG above them, as an image, so that its names meet no other picture's.
    """
    template = _environment().get_template("notebook.html.j2")
    image = b64encode(picture.encode()).decode()
    return template.render(language=spoken(), title=title, blocks=(*blocks,), image=image)


def page(document: ReportDocument) -> str:
    """A document as HTML."""
    with document.spoken():
        template = _environment().get_template("report.html.j2")
        return template.render(
            document=document,
            labels=_labels(),
            style=Markup(text_of("report.css")),  # a file of this package
            light=Markup(colors(dark=False)),
            dark=Markup(colors(dark=True)),
            animation=Markup(document.animation),  # drawn by `animation`, with names escaped
        )


def _labels() -> dict[str, str]:
    """What stands on every report."""
    return {
        "contents": say("Contents"),
        "summary": say("Summary"),
        "still": say("Stop the motion"),
        "appendix": say("Appendix"),
        "made": say("Made by Equipoise {version}", version=equipoise.__version__),
    }


@cache
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(text_of), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals["stress"] = LIGHT["stress"]
    environment.filters |= {**FILTERS, "inlined": _inlined, "classes": _classes}
    return environment


def _classes(cell: CellText) -> Markup:
    names = [*(["strong"] if cell.emphasis else []), *([] if cell.number else ["word"])]
    return Markup(f' class="{" ".join(names)}"' if names else "")  # names of this package


def _inlined(svg: str, name: str, caption: str) -> Markup:
    return Markup(inlined(svg, name, caption))  # Matplotlib escapes its texts


def _runs(
    blocks: Iterable[Block | ReportSection],
) -> Iterator[tuple[str, list[Block | ReportSection]]]:
    """Neighbours of the same kind together."""
    for kind, members in groupby(blocks, key=lambda block: block.kind):
        yield kind, list(members)


def paired(pictures: Iterable[SvgPicture]) -> list[list[SvgPicture]]:
    """Pictures in rows: two of half a page's width each, or a wide one; in their order but for
    wide ones, which do not part two that stand side by side.
    """
    rows: list[list[SvgPicture]] = []
    waiting: list[SvgPicture] = []
    for item in pictures:
        row = [item] if item.wide else [*waiting, item]
        if item.wide or len(row) == 2:
            rows.append(row)
        waiting = waiting if item.wide else row[: len(row) % 2]
    return [*rows, waiting] if waiting else rows


def flowed(blocks: Iterable[Block | ReportSection]) -> Iterator[tuple[str, list[Any]]]:
    """Blocks of a kind together: a wide picture, or several of half a page's width each; one of
    these without a neighbour before tables is packed with them.
    """
    halves: list[SvgPicture] = []
    for kind, members in _runs(blocks):
        if kind == "drawn":
            for wide, rows in groupby(paired(members), key=lambda row: row[0].wide):  # type: ignore[arg-type]
                if halves:
                    yield "row", halves
                    halves = []
                if wide:
                    yield from (("row", row) for row in rows)
                else:
                    halves = [picture for row in rows for picture in row]
            continue
        lone = [halves.pop()] if kind == "table" and len(halves) % 2 else []
        if halves:
            yield "row", halves
            halves = []
        yield kind, [*lone, *members]
    if halves:
        yield "row", halves


NARROW = 3
"""Columns of a table that fits on a telephone; rows of wider ones are lists there."""
FILTERS: dict[str, Callable[..., Any]] = {
    "grid": printed_grid,
    "noted": noted,
    "paired": paired,
    "decimals": decimals,
    "printed": printed,
    "runs": _runs,
    "word": Looks(coloured=False).word,
    "narrow": lambda table: len(table.heads) <= NARROW,
}
"""Of templates, by the names that these have for them."""


def text_of(name: str) -> str:
    """A file beside this one."""
    return (resources.files("equipoise.present") / name).read_text(encoding="utf-8")


SHRUNK, PAGE, HALF = 0.95, 504.0, 338.0
"""Width of a picture over how it is drawn; points between the margins; height that fits twice."""
LEAST = 0.935
"""Scale below which its letters would be too small to read."""


def _source(document: ReportDocument) -> str:
    """A document as Typst reads it."""
    with document.spoken():
        of = {"labels": _labels(), "families": families(document.language)}
        return _template().render(document=document, **of)


def boxed_in_pdf(document: ReportDocument) -> str:
    """Letters of a document for which its PDF has boxes, as no font of this computer has them."""
    return boxes(_source(document))


def pdf(document: ReportDocument) -> bytes:
    """A document as PDF."""
    check_pdf(document.language)
    import typst

    try:
        content = typst.compile(
            _source(document).encode(), font_paths=installed(), format="pdf", timestamp=0
        )
    except typst.TypstError as error:
        raise EquipoiseError(
            Note("the PDF could not be set ({error})", error=str(error))
        ) from error
    assert isinstance(content, bytes)
    return content


@cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(autoescape=False, trim_blocks=True, lstrip_blocks=True)
    environment.globals["stress"] = PRINTED_STRESS
    environment.filters |= {**FILTERS, "flowed": flowed, "text": _text, "width": _width}
    return environment.from_string(text_of("report.typ.j2"))


def _width(svg: str) -> str:
    """Width of a picture on paper, where it is a little smaller than drawn."""
    size = re.search(r'viewBox="0 0 ([0-9.]+) ([0-9.]+)"', svg)
    if size is None:
        return "100%"
    width, height = map(float, size.groups())
    return f"{min(width * min(SHRUNK, max(HALF / height, LEAST)), PAGE):.1f}pt"


def _text(value: str) -> str:
    """A text as Typst has it between quotation marks, so that no sign of it is a command."""
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
