"""What stands above parts and pictures of a report: lines made of figures of the machine."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typst
from PIL import Image

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures import standalone_svg
from equipoise.figures.analysis import analysis_charts
from equipoise.figures.paint import font_folder
from equipoise.figures.style import SMALL
from equipoise.i18n.languages import KNOWN
from equipoise.present import composition
from equipoise.present import pages as composed
from equipoise.present.cells import grid
from equipoise.present.checks import machine_blocks
from equipoise.present.composition import SHORT, build
from equipoise.present.findings import Findings, ToolFindings, find
from equipoise.present.headlines import (
    Shaking,
    acting,
    caused,
    circling,
    fastest,
    heaviest,
    kinematic,
    longest,
    ordered,
    peaked,
    pushed,
)
from equipoise.present.pages import ReportDocument, page, paired, pdf
from equipoise.present.pictures import each
from equipoise.present.summary import answers, tiles
from equipoise.quantities import brief
from equipoise.results.analysis_blocks import orders_table
from equipoise.results.blocks import SvgPicture, Table, Text, Value
from equipoise.results.machine_blocks import crank_angles_text
from equipoise.results.result import in_own_words
from support.chosen import EXHAUSTIVE, few, few_together
from support.findings import findings_of, report_of
from support.languages import COMPLETE


@cache
def document(name: str, language: str = "en", speed: float | None = None) -> ReportDocument:
    return report_of(name, language) if speed is None else build(find(name, speed=speed), language)


def drawn_of(text: ReportDocument) -> dict[str, SvgPicture]:
    both = (*text.sections, *text.appendix)
    blocks = [block for section in both for block in section.blocks]
    return {block.name: block for block in blocks if isinstance(block, SvgPicture)}


def test_the_share_of_an_order_is_that_of_the_force() -> None:
    analysis = eq.analyze(eq.load("yamashita-1"), 720)
    parts = (analysis.by_order[f"shaking_force.{axis}"] for axis in "xy")
    squares = np.sum([part.sizes**2 for part in parts], axis=0)
    share = squares[1] / np.sum(squares[1:])
    seen = drawn_of(document("yamashita-1"))["spectrum"].headline
    assert seen == f"{100 * share:.0f} % of the shaking force is order 1"


# Lines of other machines: tests/unit/present/test_same_numbers.py.
@pytest.mark.exhaustive
def test_lines_are_of_this_machine_at_this_speed() -> None:
    slow, fast = (
        {
            section.name: section.headline
            for section in document("yamashita-1", "en", speed).sections
        }
        for speed in (None, 40.0)
    )
    assert slow["forces"] == "Up to 23.2 N shakes the frame"
    assert slow["forces"] != fast["forces"] and slow["motion"] == fast["motion"]
    assert "70.9 N" in slow["joints"]
    assert slow["balance"] == "Shaking force, RMS: -41.0 %"
    (still,) = (
        item.headline for item in document("class-three").sections if item.name == "balance"
    )
    assert still == "Shaking force, RMS: leave the masses as they are"


@pytest.mark.parametrize(
    ("name", "length"), [("hydraulic-loader", "in a cycle"), ("four-stroke-engine", "in a turn")]
)
def test_a_turn_is_reported_only_where_a_crank_turns(name: str, length: str) -> None:
    """Of a cylinder's stroke the way of a whole cycle is told, there and back."""
    analysis = eq.analyze(eq.load(name), 72)
    text, places = longest(analysis), [point.place for point in analysis.motion.points.values()]
    way = max(float(np.sum(np.abs(place - np.roll(place, 1)))) for place in places)
    turns = analysis.motion.turns if length == "in a turn" else 1
    (size,) = re.findall(rf"([\d.]+) mm {length}", text)
    assert float(size) == pytest.approx(way / turns * 1e3, rel=5e-3)
    lines = [
        crank_angles_text(analysis),
        *(str(block) for block in machine_blocks(analysis.machine)),
    ]
    assert any(" turn" in line for line in lines) == (length == "in a turn")


def test_what_is_alike_everywhere_has_no_place_of_its_own() -> None:
    """Walkers whose throws cancel in part: a force of one size, and points that move alike."""
    analysis = eq.analyze(eq.load("straw-walker"), 72)
    assert (
        peaked(analysis, "shaking_force", "force") == "Shaking force: 62.0 N at every crank angle"
    )
    assert fastest(analysis) == "No point moves faster than 1.05 m/s"
    assert longest(analysis).startswith("No point goes farther than 314 mm")
    assert heaviest(analysis) == ""
    text = str([*analysis.blocks()])
    assert "carry it through" in text and "may flip" not in text and "rocker is" not in text


@pytest.mark.parametrize(
    ("across", "along", "words"),
    [(0.6, 1.0, "up and down"), (1.0, 0.5, "to and fro"), (1.0, 0.9, "in all directions")],
)
def test_a_force_acts_in_words_of_directions(across: float, along: float, words: str) -> None:
    turned = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)
    assert words in acting(across * np.cos(turned) + 1j * along * np.sin(turned))


def test_a_force_is_said_to_turn_only_where_it_does() -> None:
    """A circle encloses what it can; a Lissajous figure that comes back its own way, nothing."""
    turned = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
    circle, figure = np.exp(1j * turned), np.cos(turned) + 1j * np.sin(2 * turned)
    assert circling(circle) == pytest.approx(1.0, rel=1e-4)
    assert circling(figure) == pytest.approx(0.0, abs=1e-12)
    assert "turning with the crank" in acting(circle)
    assert acting(figure) == "The force acts in no direction more than in others"


def test_titles_name_no_column_that_is_not_there() -> None:
    """A cylinder's rockers have a dwell and no advantage over a crank's torque."""
    for name, there in (("hydraulic-loader", False), ("quick-return", True)):
        blocks = eq.analyze(eq.load(name), 72).blocks()
        (title,) = (
            block.title for block in blocks if isinstance(block, Table) and "dwell" in block.title
        )
        assert ("mechanical advantage" in title) is there


def test_a_gauge_without_motion_brings_no_orders_of_its_own() -> None:
    """With rows against each other nothing rolls: what rounding leaves of it is not listed."""
    machine = eq.load("riding-transplanter")
    rows = [
        replace(row, phase=phase)
        for row, phase in zip(machine.rows, (0, np.pi, np.pi, 0), strict=True)
    ]
    (table,) = (
        block
        for block in eq.respond(replace(machine, rows=tuple(rows))).blocks()
        if isinstance(block, Table) and block.title.startswith("Gauges by order")
    )
    shown = grid(table)
    for place in range(1, len(shown.heads)):
        assert {row[place].text for row in shown.rows} > {"0"}, shown.heads[place].label


def test_drives_that_only_swing_have_no_speed_in_rpm() -> None:
    """Their cranks go to and fro so many times a minute, in sentences and on all pictures."""
    findings = findings_of("pick-and-place")
    assert isinstance(findings, Findings)
    with in_own_words(findings.owner):
        texts = [picture.chart.what for picture in each(findings)]
        blocks = findings.analysis.headline(alone=True)
        texts += [block.text for block in blocks if isinstance(block, Text)]
    assert not [text for text in texts if "rpm" in text or "rad/s" in text]
    assert len([text for text in texts if "60 cycles a minute" in text]) > 5
    assert any("60.00 cycles a minute" in text for text in texts)


@pytest.mark.exhaustive(but=["yamashita-rig-en"])
@pytest.mark.parametrize(
    ("name", "language"),
    [
        *(("yamashita-rig", "en"), ("yamashita-rig", "ja")),
        pytest.param("brush-cutter", "ja", marks=EXHAUSTIVE),
        pytest.param("transplanter", "ko", marks=EXHAUSTIVE),
    ],
)
def test_a_caption_does_not_repeat_its_title(name: str, language: str) -> None:
    reported = document(name, language)
    drawn = drawn_of(reported)
    assert drawn
    for block in drawn.values():
        assert block.caption and not (block.headline and block.headline in block.caption)
        assert not block.headline.endswith((".", "。", ":", "："))
    seen = [block.headline for block in drawn.values() if block.headline]
    seen += [section.headline for section in reported.sections if section.headline]
    assert len(seen) > len(drawn) / 2


def test_the_name_of_the_machine_stands_above_the_report_and_on_no_picture() -> None:
    reported = document("yamashita-rig")
    assert all(reported.title not in block.svg for block in drawn_of(reported).values())
    html = page(replace(reported, animation="", appendix=()))
    assert html.count(reported.title) == 2  # of the page, and above it


def shape(name: str, wide: bool) -> SvgPicture:
    return SvgPicture(name, "", "", wide=wide)


def test_pictures_stand_in_pairs() -> None:
    drawn = [shape(name, name.isupper()) for name in "aBcDefg"]
    rows = ["".join(item.name for item in row) for row in paired(drawn)]
    assert rows == ["B", "ac", "D", "ef", "g"]
    assert paired([]) == []


@pytest.mark.parametrize(
    "name", few(["yamashita-1", "brush-cutter", "cam-pusher"], {"yamashita-1", "brush-cutter"})
)
def test_long_tables_stand_in_the_appendix_and_none_is_lost(name: str) -> None:
    actual, text = findings_of(name), document(name)
    in_sections = [b for s in text.sections for b in s.blocks if isinstance(b, Table)]
    behind = [b for s in text.appendix for b in s.blocks if isinstance(b, Table)]
    assert all(len(table.rows) <= SHORT for table in in_sections)
    assert behind and all(len(table.rows) > SHORT or table.detail for table in behind)
    html = page(text)
    assert html.count("<details>") == len(text.appendix)
    assert html.count("<table") >= len([*in_sections, *behind])
    if isinstance(actual, Findings):
        titles = {table.title for table in (*in_sections, *behind)}
        results = (actual.analysis, *([actual.balanced] if actual.helped else []))
        wanted = [b.title for result in results for b in result.blocks() if isinstance(b, Table)]
        assert wanted and set(wanted) <= titles


@pytest.mark.exhaustive(but=["yamashita-rig", "brush-cutter"])
@pytest.mark.parametrize("name", ["yamashita-rig", "brush-cutter", "straw-walker"])
def test_details_stand_in_the_appendix_and_no_picture_is_lost(name: str) -> None:
    reported = document(name)
    first, behind = (
        [b.name for s in part for b in s.blocks if isinstance(b, SvgPicture)]
        for part in (reported.sections, reported.appendix)
    )
    assert len(first) <= len(behind) + 1
    assert sorted([*first, *behind]) == sorted(item.name for item in each(findings_of(name)))
    later = ("mode", "balanced", "hodograph", "joint", "resonance-map")
    assert not [item for item in first if item.startswith(later)]
    tried = [b.title for s in reported.sections for b in s.blocks if isinstance(b, Table)]
    assert not [title for title in tried if title.startswith("Candidates for reducing")]


@pytest.mark.exhaustive(but=["yamashita-rig-9", "yamashita-1-7"])
@pytest.mark.parametrize(
    ("name", "most"), [("yamashita-1", 7), ("yamashita-rig", 9), ("stephenson-six-bar", 7)]
)
def test_a_report_is_read_on_a_few_pictures(name: str, most: int) -> None:
    """Of each part those that show what its line says; a part without one has its line alone."""
    reported = document(name)
    shown = [b for s in reported.sections for b in s.blocks if isinstance(b, SvgPicture)]
    assert len(reported.without_drawing(shown)) <= most
    assert [*dict.fromkeys(s.name for s in reported.sections)][:4] == [
        *("model", "motion", "forces", "joints"),
    ]
    (joints,) = (s for s in reported.sections if s.name == "joints")
    assert joints.headline and reported.appendix_contents("joints").startswith(
        "Pictures in the appendix: "
    )


@pytest.mark.parametrize("name", ["yamashita-1", "brush-cutter"])
def test_the_first_page_of_the_pdf_has_the_machine(name: str) -> None:
    source = composed._source(document(name))
    first = source.index("image(bytes(")
    assert first < source.index("\n= #", source.index("= #") + 1)
    drawing = document(name).drawing
    assert drawing is not None and source.count(composed._text(drawing.svg)) == 1


FOOT = 0.935
"""Above the footer, of the height of a page."""


@pytest.mark.exhaustive(but=["yamashita-rig", "jansen-leg"])
@pytest.mark.parametrize(
    "name",
    few(
        (*eq.examples("linkage"), *eq.examples("tool")),
        {"nagamine-irie", "hydraulic-loader", "yamashita-rig", "jansen-leg", "twin-engine"},
    ),
)
def test_no_quarter_of_the_first_page_is_empty(name: str) -> None:
    first, *_ = empty(name)
    assert first < 0.25


def empty(name: str) -> list[float]:
    """Share of the height of each page of a report that is empty at its foot."""
    pages = typst.compile(
        composed._source(document(name)).encode(),
        font_paths=composed.installed(),
        format="png",
        ppi=30,
    )
    whole = [np.asarray(Image.open(BytesIO(page)).convert("L")) for page in pages]
    ends = [
        np.flatnonzero(np.any(page[: int(FOOT * len(page))] < 200, axis=1))[-1] for page in whole
    ]
    return [1 - end / (FOOT * len(page)) for end, page in zip(ends, whole, strict=True)]


@pytest.mark.parametrize(
    "name",
    few(
        (*eq.examples("linkage"), *eq.examples("tool")),
        {"brush-cutter", "twin-engine"},
    ),
)
def test_no_third_of_a_page_is_empty_but_of_the_last(name: str) -> None:
    *pages, _ = empty(name)
    assert max(pages) < 1 / 3, pages


def pages_of(labels: dict[str, int], *source: str) -> dict[str, list[int]]:
    """Pages on which what has these labels stands, set as a report is."""
    style = composed._source(document("yamashita-1")).partition("#block(below: 0.9em, text(18pt")[0]
    every = "".join(f"<{label}>, " for label in labels)
    where = f"""#let page_of(found) = found.location().page()
#context [#metadata(({every}).map(what => query(what).map(page_of))) <pages>]"""
    text = "\n".join((style, *source, where))
    asked = typst.query(text.encode(), "<pages>", field="value", one=True)
    values = dict(zip(labels, json.loads(asked), strict=True))
    assert {label: len(pages) for label, pages in values.items()} == labels
    return values


@pytest.mark.parametrize("heading", ['#topic("Part")\n= Name', "= Name", "== Name"])
@pytest.mark.parametrize("kind", ["whole", "prose"])
def test_no_heading_stands_alone_at_the_foot_of_a_page(heading: str, kind: str) -> None:
    """Wherever on a page it comes to stand, what follows stands on the same page."""
    lines = "\n\n".join(f"line {number}" for number in range(4))
    parts = (
        f"#pagebreak(weak: true)\n#v({high}pt)\n"
        f'#flow((("head", [\n{heading} <head>\n]), ("{kind}", [#lines <after>])))'
        for high in range(600, 750, 4)
    )
    count = len(range(600, 750, 4))
    own = f"#let lines = block(breakable: false)[{lines}]"
    pages = pages_of({"head": count, "after": count}, own, *parts)
    assert len({*pages["head"]}) > count // 2
    assert pages["head"] == pages["after"]


def test_what_has_room_comes_before_a_picture_that_has_none() -> None:
    """Of the same section."""
    parts = (
        '("head", [= Name])',
        '("whole", [#rect(height: 500pt) <first>])',
        '("whole", [#rect(height: 400pt) <second>])',
        '("prose", [a sentence <sentence>])',
        '("head", [= Other <other>])',
    )
    labels = dict.fromkeys(("first", "second", "sentence"), 1)
    pages = pages_of(labels, f"#flow(({', '.join(parts)},))")
    assert pages == {"first": [1], "second": [2], "sentence": [1]}


def test_a_high_picture_that_has_no_room_goes_on_by_rows() -> None:
    """On the next page; what has room whole comes before.  Where it has room, it is drawn whole."""
    rows = "".join(f"rect(height: 150pt)[#[] <row-{number}>], " for number in range(4))
    high = f'("rows", ([#rect(height: 600pt) <whole>], ({rows})))'
    low = '("whole", [#rect(height: 20pt) <low>])'
    labels = {"whole": 0, "row-0": 1, "row-1": 1, "row-2": 1, "row-3": 1, "low": 1}
    pages = pages_of(labels, f'#flow((("whole", rect(height: 300pt)), {high}, {low}))')
    assert [*pages.values()] == [[], [1], [1], [2], [2], [1]]
    alone = {"whole": 1, "row-0": 0, "low": 1}
    assert [*pages_of(alone, f"#flow(({high}, {low}))").values()] == [[1], [], [1]]


def test_a_pair_that_has_no_room_is_parted_and_a_high_one_goes_on_by_rows() -> None:
    """Rows stand below each other, then in the next column; not under another picture."""
    rows = "".join(f"rect(height: 150pt)[#[] <row-{number}>], " for number in range(3))
    low = "([#rect(height: 200pt) <low>], ())"
    pair = f'("pair", ([#rect(height: 450pt) <both>], ({low}, (rect(height: 450pt), ({rows})))))'
    labels = {"both": 0, "low": 1, "row-0": 1, "row-1": 1, "row-2": 1}
    pages = pages_of(labels, f'#flow((("whole", rect(height: 350pt)), {pair}))')
    assert [*pages.values()] == [[], [1], [1], [1], [2]]
    labels = {"both": 1, "low": 0, "row-0": 0}
    assert [*pages_of(labels, f"#flow(({pair},))").values()] == [[1], [], []]


def test_rows_of_a_high_picture_are_drawn_like_the_whole() -> None:
    """With all panels once, each as large as in the whole; drawings are not parted."""
    parted = {b.name: b for b in drawn_of(document("twin-engine")).values() if b.rows}
    assert {"joints", "joint-polars"} <= {*parted} and "modes" not in parted
    for block in parted.values():
        titles = re.findall(r">([^<>]+: [^<>]+ on [^<>]+)</text>", block.svg)
        assert len(block.rows) > 1 and bool(titles) == block.name.startswith("joint"), block.name
        each_row = [title for svg in block.rows for title in titles if f">{title}</text>" in svg]
        assert sorted(each_row) == sorted(titles), block.name
        # in the scale of the whole, beside which some are drawn larger
        larger = re.compile(r">(drawn [0-9.]+ times as large)<")
        each_row = [text for svg in block.rows for text in larger.findall(svg)]
        assert sorted(each_row) == sorted(larger.findall(block.svg)), block.name


@pytest.mark.exhaustive
def test_wide_pictures_are_drawn_for_telephones_too() -> None:
    """With every panel, half as wide."""
    for name in ("twin-engine", "riding-transplanter"):
        blocks = drawn_of(document(name)).values()
        assert {bool(block.narrow) for block in blocks if not block.wide} == {False}
        for block in (block for block in blocks if block.wide):
            assert float(re.findall(r'viewBox="0 0 ([\d.]+)', block.narrow)[0]) < 300, block.name
            titles = re.findall(r">([^<>]+: [^<>]+ on [^<>]+|from [^<>]+)</text>", block.svg)
            assert all(f">{title.split()[0]}" in block.narrow for title in titles), block.name


def test_rows_are_drawn_for_a_pdf_alone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A page has room for every picture as a whole."""
    asked = []

    def built(*_: Any, by_rows: bool, **__: Any) -> ReportDocument:
        asked.append(by_rows)
        return document("yamashita-1")

    monkeypatch.setattr(composition, "build", built)
    monkeypatch.setattr(composition, "pdf", lambda _: b"")
    for outs in (["a.html"], ["a.html", "b.pdf"], ["b.pdf"]):
        eq.report("yamashita-1", *(tmp_path / out for out in outs))
    assert asked == [False, True, True]
    chart = analysis_charts(eq.analyze(eq.load("twin-engine"), 90))["joints"]
    assert len(standalone_svg(chart, by_rows=True).rows) > 1
    assert not standalone_svg(chart).rows


@pytest.mark.exhaustive(but=["twin-engine"])
@pytest.mark.parametrize("name", ["twin-engine", "balance-geared-a"])
def test_no_remark_on_the_appendix_begins_a_page(name: str) -> None:
    """It stands below the heading that it is about, which stays with what follows."""
    source = composed._source(document(name))
    heads = re.findall(r'\("head", \[(.*?)\]\),\n', source, re.DOTALL)
    remarks = source.count("Pictures in the appendix: ")
    assert 1 < remarks == sum("Pictures in the appendix: " in head for head in heads)


def test_pictures_of_half_the_width_fill_both_columns_of_a_page() -> None:
    """One that is too high for what is left waits for the next page, and a lower one does not."""
    heights = {"a": 300, "b": 500, "c": 350, "d": 300, "e": 200}
    drawn = "".join(f"([#rect(height: {high}pt) <{name}>], ()), " for name, high in heights.items())
    pages = pages_of(dict.fromkeys(heights, 1), f'#flow((("halves", ({drawn})),))')
    assert pages == {"a": [1], "b": [1], "c": [1], "d": [2], "e": [1]}


def test_no_part_of_the_appendix_is_a_heading_alone() -> None:
    """Its only picture may be the drawing that the first page has."""
    reported = document("hydraulic-loader")
    bare = [part for part in reported.appendix if not reported.without_drawing(part.blocks)]
    assert [part.name for part in bare] == ["model"]
    appendix = composed._source(reported).rpartition("\n= #")[2]
    titles = re.findall(r"== #(.*)\]\),\n", appendix)
    assert composed._text("Model") not in titles and composed._text("Motion") in titles


@pytest.mark.parametrize("name", ["yamashita-rig", "brush-cutter"])
def test_letters_of_pictures_can_be_read_on_paper(name: str) -> None:
    """The smallest are 7 points at least, beside each other and across the page."""
    half = 246.0  # points of a column of the PDF
    for block in drawn_of(document(name)).values():
        wide = float(re.findall(r'viewBox="0 0 ([0-9.]+) ', block.svg)[0])
        shown = float(composed._width(block.svg).removesuffix("pt")) if block.wide else half
        assert SMALL * shown / wide >= 7, block.name


def test_whether_a_limit_is_met_after_the_change_is_said() -> None:
    findings = findings_of("brush-cutter")
    assert isinstance(findings, ToolFindings) and findings.exposure_after is not None
    later = findings.exposure_after.a8
    text = " ".join(
        sentence for answer in document("brush-cutter").summary for sentence in answer.sentences
    )
    assert f"A(8) then amounts to {brief(later)} m/s² at " in text
    verdict = text.partition("A(8) then amounts to ")[2]
    assert ("above the limit value" in verdict) == (later > 5)
    tile = next(item for item in document("brush-cutter").tiles if item.label.endswith("A(8)"))
    assert tile.after == brief(later)


def test_a_time_is_the_same_wherever_it_stands() -> None:
    """A time until a limit is rounded down to minutes everywhere."""
    html = page(document("brush-cutter"))
    assert {*re.findall(r"after ([\d.]+)\s*min", html.replace("\xa0", " "))} == {"31"}
    findings = findings_of("brush-cutter")
    assert isinstance(findings, ToolFindings) and findings.exposure is not None
    printed = [str(block) for block in findings.exposure.headline(False)]
    assert not [text for text in printed if re.search(r"\d\.\d+ h", text)]
    assert any("action value after 31 min, the limit value after 2 h 7 min" in t for t in printed)


@pytest.mark.exhaustive(but=["yamashita-1"])
@pytest.mark.parametrize("name", ["yamashita-1", "stephenson-six-bar"])
def test_what_the_summary_says_is_not_said_again(name: str) -> None:
    reported = document(name)
    summary = {sentence for answer in reported.summary for sentence in answer.sentences}
    texts = [b.text for s in reported.sections for b in s.blocks if isinstance(b, Text)]
    assert any(item.startswith("Large here: ") for item in summary)
    assert summary.isdisjoint(texts)
    assert reported.verdict is not None  # nor is what stands above the summary
    assert not [item for item in (*summary, *texts) if reported.verdict.text in item]


# Pictures before and after: tests/unit/figures/test_balance_charts.py.
@pytest.mark.exhaustive
def test_what_helps_is_reported_before_and_after_at_once() -> None:
    findings = findings_of("kim-chung-c")
    assert isinstance(findings, Findings) and findings.after is not None
    shown = {tile.label: tile for tile in document("kim-chung-c").tiles}
    peak = shown["shaking force, peak"]
    later = findings.after.analysis.summary["shaking_force"].peak
    assert (peak.value, peak.after) == ("11.5", f"{later:.2f}")
    assert shown["shaking moment, peak"].after == ""  # is the same about the crank's pivot


@pytest.mark.exhaustive(but=["yamashita-rig-12"])
@pytest.mark.parametrize(
    ("name", "most"),
    few_together(
        [("drag-link", 7), ("yamashita-1", 9), ("yamashita-rig", 12)],
        {("drag-link", 7), ("yamashita-rig", 12)},
    ),
)
def test_the_pdf_is_short(name: str, most: int) -> None:
    """A remedy that is offered takes a page; about half of all pages are the appendix."""
    assert pages(pdf(document(name))) in range(2, most + 1)


def pages(data: bytes) -> int:
    return len(re.findall(rb"/Type ?/Page\b", data))


# Fonts of pages: the test below.
@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "name", few(["yamashita-1", "yamashita-rig", "brush-cutter"], {"yamashita-rig"})
)
def test_pages_end_alike_whatever_fonts_a_computer_has(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As without fonts of its own, above all without Japanese and Korean ones."""
    whole = pdf(document(name))
    alone = typst.Fonts(include_system_fonts=False, font_paths=[font_folder()])
    monkeypatch.setattr(composed, "installed", lambda: alone)
    assert pages(pdf(document(name))) == pages(whole)
    assert composed.families("en") == ["DejaVu Sans"]


@pytest.mark.exhaustive(but=["ko"])
@pytest.mark.parametrize("language", [code for code in KNOWN if KNOWN[code].fonts])
def test_eastern_letters_are_of_a_font_that_has_them(language: str) -> None:
    try:
        wanted = composed.families(language)[1]
    except UsageError:
        pytest.skip("this computer has none")
    names = re.findall(rb"/FontName ?/[A-Z]+\+([\w-]+)", pdf(document("yamashita-1", language)))
    assert any(wanted.replace(" ", "").lower() in name.decode().lower() for name in names)


@pytest.mark.exhaustive(but=["ko", "en"])
@pytest.mark.parametrize("language", COMPLETE)
def test_names_of_the_file_are_distinguished_from_words(language: str) -> None:
    seen = drawn_of(document("yamashita-rig", language))["gauge-gauge"].headline
    assert {"en": "“gauge”", "de": "„gauge“", "ja": "「gauge」", "ko": "‘gauge’"}[language] in seen


def test_what_the_hands_get_is_called_by_words() -> None:
    reported = document("brush-cutter", "ja")
    assert "合成値" in drawn_of(reported)["exposure"].svg
    summary = document("yamashita-rig").summary
    sentences = [sentence for answer in summary for sentence in answer.sentences]
    assert any(sentence.startswith("“gauge”: the support moves by") for sentence in sentences)


def test_a_force_that_cancels_but_for_rounding_is_none(tmp_path: Path) -> None:
    bars = [
        f'[links.bar{k}]\npoints.B{k} = ["0 mm", "0 mm"]\npoints.C{k} = ["80 mm", "30 mm"]\n'
        'mass = "2 kg"\ncenter_of_mass = ["10 mm", "-80 mm"]\ninertia = "0.03 kg m^2"\n'
        for k in range(3)
    ]
    turns = [
        f'[links.{link}]\npoints.{pin} = ["0 mm", "0 mm"]\nmass = "6 kg"\n'
        'center_of_mass = ["0 mm", "0 mm"]\ninertia = "0.5 kg m^2"\n'
        + "".join(
            f'points.{way}{k} = {{ distance = "400 mm", direction = "{120 * k} deg" }}\n'
            for k in range(3)
        )
        for link, pin, way in (("spider", "A", "B"), ("guide", "E", "C"))
    ]
    frame = 'schema = 1\ntitle = "reel"\ndrive = { link = "spider", speed = "40 rpm" }\n'
    frame += '[frame]\npoints.A = ["0 mm", "0 mm"]\npoints.E = ["80 mm", "30 mm"]\n'
    (tmp_path / "reel.toml").write_text("".join([frame, *turns, *bars]))
    place = find(tmp_path / "reel.toml")
    assert isinstance(place, Findings)
    for _, _, x, *_ in orders_table(place.analysis).rows:
        assert isinstance(x, Value) and brief(x.value, x.scale) == "0"
    assert not np.any(Shaking.of(place).force)
    texts = [sentence for answer in answers(place) for sentence in answer.sentences]
    assert any("does not shake its frame by any force" in item for item in texts)
    assert not any("comes from" in item for item in texts)
    assert (pushed(place), ordered(place), caused(place.analysis)) == ("", "", "")
    tile = next(item for item in tiles(place) if item.label == "shaking force, peak")
    assert (tile.value, tile.note) == ("0", "")


@pytest.mark.exhaustive(but=["yamashita-rig", "brush-cutter"])
@pytest.mark.parametrize("name", ["yamashita-rig", "brush-cutter", "cam-pusher"])
def test_every_picture_is_listed_in_the_documentation(name: str) -> None:
    """By its name, or by what such names begin with, as `gauge-NAME`."""
    text = (Path(eq.__file__).parents[2] / "docs" / "figures.md").read_text(encoding="utf-8")
    listed = re.findall(r"`([\w-]+)`", text.partition("## Which pictures")[2].partition("## ")[0])
    begins = tuple(
        re.sub("(NAME|LINK|1)$", "", item) for item in listed if re.search("[A-Z1]$", item)
    )
    for picture in each(findings_of(name)):
        own = re.sub(r"-(lateral|\d+)$", "", picture.name)
        assert own in listed or picture.name.startswith(begins), picture.name


def test_a_transmission_angle_is_the_same_number_wherever_the_first_page_has_it() -> None:
    reported = document("jansen-leg")
    assert reported.verdict is not None
    first = [
        reported.verdict.text,
        *(sentence for answer in reported.summary for sentence in answer.sentences),
    ]
    values = [re.findall(r"Transmission angle at E[^:]*: ([\d.]+)°", line) for line in first]
    assert len([*filter(None, values)]) > 1
    assert len({value for each in values for value in each}) == 1


def test_a_transmission_angle_reaches_its_ends_between_the_samples() -> None:
    """A parallelogram goes through 0 and 180 deg; the picture and the table say so alike."""
    findings = findings_of("straw-walker")
    assert isinstance(findings, Findings)
    line = kinematic(findings.analysis, "kinematics-transmission")
    assert line == "The transmission angle stays between 0.0° and 180.0°"


@pytest.mark.exhaustive(but=["flap-folder-A: Gestell auf crank"])
@pytest.mark.parametrize(
    ("name", "joint"),
    [("flap-folder", "A: Gestell auf crank"), ("rotary-transplanter", "auf Gestell")],
)
def test_the_frame_is_called_so_in_the_language_of_the_report(name: str, joint: str) -> None:
    """In tables, in sentences on parts, on how gears are built up and above the forces of joints,
    but not in the file.
    """
    text = page(document(name, "de"))
    text = re.sub(r"<(style|script|pre)\b.*?</\1>", "", text, flags=re.DOTALL)
    words = re.sub(r"<[^>]+>", "\n", text)
    assert joint in words
    assert not re.findall(r".*\bframe\b.*", words)
