"""The report as a page and as a PDF: whole, by itself, always the same, safe with any name."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from html.parser import HTMLParser

import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError, UsageError
from equipoise.figures import is_wide, paint
from equipoise.figures.style import LOOKS
from equipoise.present import pages
from equipoise.present.composition import build
from equipoise.present.findings import ToolFindings, find
from equipoise.present.pages import PRINTED_STRESS, boxed_in_pdf, colored, colors, page, pdf
from equipoise.present.pictures import pictures
from support.chosen import EXHAUSTIVE
from support.findings import findings_of, report_of
from support.refusals import refused
from surface.running import equipoise
from unit.figures.checks import lightness


class Page(HTMLParser):
    """Tags, names and references of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.refs: list[str] = []
        self.words: list[str] = []
        self.instead: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        for name, value in attrs:
            assert not name.startswith("on")
            if name == "id":
                self.ids.append(value)
            elif name == "aria-label":
                self.instead.append(value)
            elif name in ("href", "src", "xlink:href", "action", "data"):
                self.refs.append(value)
            elif "url(" in (value or ""):
                self.refs += [part.split(")")[0] for part in value.split("url(")[1:]]

    def handle_data(self, data):
        self.words.append(data)


@pytest.fixture(scope="module")
def rig_findings():
    return findings_of("yamashita-rig")


@pytest.fixture(scope="module")
def document(rig_findings):
    return build(rig_findings, "en", "equipoise report yamashita-rig")


@pytest.fixture(scope="module")
def html(document):
    return page(document)


def test_the_page_needs_nothing_but_itself(html):
    read = Page(html)
    assert not {"script", "iframe", "link", "object", "embed", "form", "img"} & set(read.tags)
    assert len(read.ids) == len(set(read.ids))
    assert {ref.removeprefix("#") for ref in read.refs} <= set(read.ids)
    assert "@import" not in html and "http://" not in html.replace("http://www.w3.org", "")


def test_the_page_holds_every_picture_and_the_model(rig_findings, html):
    read = Page(html)
    drawn = pictures(rig_findings)
    again = sum(is_wide(item.chart) for item in drawn)  # for a telephone
    assert read.tags.count("svg") == len(drawn) + again + 1  # the moving linkage
    words = " ".join(read.words)
    for part in (
        *(item.chart.what for item in drawn),
        rig_findings.machine.description,
        eq.__version__,
    ):
        assert part in words
    assert {item.chart.caption for item in drawn} <= set(read.instead)
    assert rig_findings.text.strip() in words
    assert "equipoise report yamashita-rig" in words


@EXHAUSTIVE  # On every change: `test_the_pdf_is_the_same_on_every_run`.
def test_it_is_the_same_on_every_run_in_another_language():
    text, again = (page(build(find("drag-link"), "ja")) for _ in range(2))
    assert text == again
    assert '<html lang="ja">' in text and "要約" in text and "Summary" not in text


# Reports of tools are drawn in tests/unit/present/test_findings.py.
@pytest.mark.exhaustive
def test_a_tool_has_its_report():
    findings = findings_of("brush-cutter")
    assert isinstance(findings, ToolFindings)
    shorter = ToolFindings(replace(findings.tool, design=None), findings.text, findings.file)
    document = build(shorter)
    text = " ".join(sentence for answer in document.summary for sentence in answer.sentences)
    worst = max(grip.a_hv[0] for grip in shorter.exposure.named["working"].values())
    assert f"a_hv of {worst:.2f}" in text.replace("\xa0", " ")
    assert {section.name for section in document.sections} == {"model", "tool"}
    assert {section.name for section in document.appendix} >= {"sources", "settings"}


def test_nothing_in_a_picture_stays_bright_on_a_dark_page():
    """Pale areas and lines of all roles have a colour of their own there, and a darker one."""
    dark = dict(part.split(":") for part in colors(dark=True).removeprefix("--").split(";--"))
    pale = {
        color
        for look in LOOKS.values()
        for color in (look.fill, look.color)
        if color and lightness(color) > 70
    }
    assert pale
    for color in pale:
        name = colored(color).removeprefix("var(--").partition(",")[0]
        assert lightness(dark[name]) < 60, color


EVIL = 'A <script>alert("x")</script> & #image("/etc/passwd") \\ {{ 1 }} $x$ `'


def test_names_are_never_read_as_markup(document):
    evil = replace(document, title=EVIL, description=EVIL, animation="")
    read = Page(page(evil))
    assert "script" not in read.tags and EVIL in read.words
    assert pdf(evil).startswith(b"%PDF")


def test_the_pdf_is_the_same_on_every_run(document):
    made = pdf(document)
    assert made == pdf(document)
    assert made.startswith(b"%PDF") and len(made) > 50_000


def test_missing_fonts_and_a_missing_extra_are_reported(monkeypatch, tmp_path):
    class Latin:
        def families(self):
            return ["DejaVu Sans"]

    monkeypatch.setattr(pages, "installed", Latin)
    with refused(UsageError, languages="한국어"):
        eq.report("scotch-yoke", tmp_path / "report.pdf", language="ko")
    monkeypatch.undo()
    pages.installed.cache_clear()
    monkeypatch.setitem(sys.modules, "typst", None)
    with refused(EquipoiseError, by="installed"):
        eq.report("scotch-yoke", tmp_path / "report.pdf")
    assert not list(tmp_path.iterdir())


# Letters of fonts: tests/unit/present/test_headlines.py.
@pytest.mark.exhaustive
def test_letters_that_no_font_has_are_reported_of_a_pdf(document, monkeypatch, tmp_path):
    """An English report has Japanese and Korean in its sources and in the file that it tells."""
    monkeypatch.setattr(paint, "fonts_for", lambda signs: ((), "".join(sorted(signs))))
    assert set("山下市川") <= set(boxed_in_pdf(document))
    assert not set("shaking é°²") & set(boxed_in_pdf(document))
    printed = equipoise("report", "scotch-yoke", "--out", tmp_path / "report.html", "--pdf").err
    assert printed.count("note: no font has ") == 1 and "or read the report as .html" in printed
    monkeypatch.setattr(paint, "fonts_for", lambda signs: ((), ""))
    assert boxed_in_pdf(document) == ""


def test_other_names_and_languages_are_refused(tmp_path):
    with refused(UsageError, by="kind_of"):
        eq.report("scotch-yoke", tmp_path / "report.docx")
    with refused(UsageError, names="en, de, ja, ko"):
        eq.report("scotch-yoke", tmp_path / "report.html", language="fr")


# Colours of pictures in grey: tests/unit/figures.
@pytest.mark.exhaustive
def test_words_that_have_to_be_seen_are_dark_in_grey_print():
    ink, gray = lightness("#1a1a1a"), lightness("#4d5359")
    assert ink < lightness(PRINTED_STRESS) < gray
    assert f".strong{{color:{PRINTED_STRESS}}}" in page(report_of("brush-cutter"))


def test_no_text_of_a_report_on_paper_is_too_small_to_read(document):
    """But in pictures, which have sizes of their own; so are the model's lines."""
    style = pages._source(document).partition("#halves(")[0]
    sizes = [float(size) for size in re.findall(r"text\((?:size: )?([\d.]+)pt", style)]
    assert len(sizes) > 5 and min(sizes) >= 6
    assert "#show raw: set text(6pt)" in style and "pt, raw(" not in pages._source(document)


def test_names_of_sections_stand_with_what_follows_where_a_page_is_printed(html):
    """Nothing in a heading or behind one that can be folded begins a new sheet of paper."""
    printed = html.partition("@media print")[2]
    assert "h2{break-inside:avoid}" in printed
    assert "summary{break-after:avoid}" in printed
