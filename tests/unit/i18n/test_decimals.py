"""The decimal sign of a language, in everything that is shown; files keep the point."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.exchange.export import export
from equipoise.i18n import LANGUAGES, Note, decimals, number_list, say, speaking
from equipoise.i18n.languages import KNOWN
from equipoise.present import html_of
from equipoise.present.pages import page
from equipoise.quantities import typeset
from equipoise.results.charts import four_digits
from equipoise.schema.documents import dumps
from equipoise.schema.template import Template
from support.findings import report_of
from support.interactive import block

POINTED = r"(?<![\w.])\d+\.\d+(?![\w.])"
COMMAS = [code for code in LANGUAGES if KNOWN[code].decimal == ","]

POINT, COMMA = ["−3.5°", "1.5×10⁻⁴", "−0.25"], ["−3,5°", "1,5×10⁻⁴", "−0,25"]


@pytest.fixture(params=COMMAS)
def language(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_numbers_in_sentences_have_the_sign_of_the_language() -> None:
    note = Note("{a} and {b:.2f}, {c}", a="-3.5 mm", b=1.25, c="1.5e-04")
    inner = Note("{sentence} ({unit})", sentence=note, unit="0.1 N")
    assert str(inner) == "-3.5 mm and 1.25, 1.5e-04 (0.1 N)"
    with speaking("de"):
        assert str(inner) == "-3.5 mm and 1.25, 1.5e-04 (0.1 N)"
        assert inner.localized() == "-3,5 mm and 1,25, 1,5e-04 (0,1 N)"
    with speaking("ja"):
        assert inner.localized() == str(inner)


def test_names_and_what_is_to_be_typed_keep_their_point() -> None:
    with speaking("de"):
        assert say('give "{a}", not {b}', a="1.5 mm", b="2.5 mm") == 'give "1.5 mm", not 2,5 mm'
        assert say("„{name}“ and {name!r}", name="rod 1.5") == "„rod 1.5“ and 'rod 1.5'"
        reported = say(
            "{file}, {version}, {joint}", file="a.1.5.toml", version="1.2.3", joint="P1.5"
        )
        assert reported == "a.1.5.toml, 1.2.3, P1.5"
        assert say("{what}", what=say('in "{a}"', a="0.5 mm")) == 'in "0.5 mm"'


def test_axes_and_print_have_it() -> None:
    with speaking("de"):
        assert (decimals("−3.5°"), typeset("1.5e-04"), four_digits(-0.25)) == (
            "−3,5°",
            "1,5×10⁻⁴",
            "−0,25",
        )
    assert (decimals("−3.5°"), typeset("1.5e-04"), four_digits(-0.25)) == (
        "−3.5°",
        "1.5×10⁻⁴",
        "−0.25",
    )


def visible(html: str) -> str:
    """What a reader sees of a page: no styles, scripts, code and attributes."""
    html = re.sub(r"(?s)<(style|script|code|pre)\b.*?</\1>", " ", html)
    return re.sub(r"<[^>]*>", " ", html)


def test_a_report_has_it_in_tables_tiles_and_pictures(language: str) -> None:
    text = visible(page(report_of("yamashita-rig", language)).partition("</header>")[2])
    assert len(re.findall(r"\d,\d", text)) > 300
    assert re.findall(rf".{{30}}{POINTED}.{{9}}", text) == []


def test_tables_of_a_result_have_it(language: str) -> None:
    analysis = eq.analyze(eq.load("yamashita-1"))
    with speaking(language):
        text = visible(html_of(analysis))
    assert len(re.findall(r"\d,\d", text)) > 100 and re.findall(POINTED, text) == []


def test_files_keep_the_point(language: str) -> None:
    analysis = eq.analyze(eq.load("yamashita-1"))
    plain, model = repr(analysis.to_dict()), dumps(analysis.machine)
    with speaking(language):
        again = eq.analyze(eq.load("yamashita-1"))
        assert repr(again.to_dict()) == plain
        assert dumps(again.machine) == model


# Reports have it in tables, tiles and pictures: the test above.
@pytest.mark.exhaustive
def test_a_workshop_drawing_has_it(language: str, tmp_path: Path) -> None:
    import ezdxf

    thick = {"links.shaft.bodies[1].thickness": 12.5e-3}  # weights of a plan have whole sizes
    export(Template.load("knife-drive").machine(thick), tmp_path / "a.dxf", language=language)
    drawing = ezdxf.read(io.StringIO((tmp_path / "a.dxf").read_text(encoding="utf-8")))
    texts = [text.dxf.text for text in drawing.modelspace().query("TEXT")]
    assert any(re.search(r"\d,\d", text) for text in texts)
    assert [text for text in texts if re.search(POINTED, text)] == []
    signs = {item.override().get("dimdsep") for item in drawing.modelspace().query("DIMENSION")}
    assert signs == {ord(",")}


def test_an_interactive_file_has_it(language: str, tmp_path: Path) -> None:
    export(eq.load("yamashita-1"), tmp_path / "a.html", language=language)
    html = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert json.loads(block(html, "machine"))["decimal"] == ","


def test_numbers_of_a_list_stand_apart_where_they_have_commas():
    assert number_list(["2.34", "6.97"]) == "2.34, 6.97"
    with speaking("de"):
        assert number_list(["2,34", "6,97"]) == "2,34; 6,97"
