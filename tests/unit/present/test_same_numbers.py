"""One figure is one number, wherever it is shown: cards, titles and tables against the JSON."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, replace
from functools import cache
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import comparison
from equipoise.cli.linkage import analyze as command
from equipoise.figures import forces as forces_charts
from equipoise.mechanism.parts.balance import Balance, Limit, Objective, Phases
from equipoise.present.cells import grid
from equipoise.present.findings import Findings, find
from equipoise.present.pages import page
from equipoise.present.summary import answers
from equipoise.quantities.numbers import in_unit
from equipoise.quantities.units import FACTORS
from equipoise.results.analysis import ANGLES, order_values
from equipoise.results.analysis_blocks import display_of_totals
from equipoise.results.blocks import Block, Facts, Many, ReportSection, SvgPicture, Table, Value
from equipoise.vibration.linear import nearest_loud
from equipoise.web.edits import solved
from equipoise.web.figures import figures_of
from equipoise.web.gallery import opened_example
from support.chosen import DISTINCT, few
from support.findings import findings_of, report_of

MACHINES = (
    *("cam-pusher", "four-stroke-engine", "hydraulic-loader", "riding-transplanter"),
    *("sieve", "twin-engine", "yamashita-rig"),
)
EXAMPLES = Path(eq.__file__).parent / "examples"
WITH_FORCES = sorted(
    file.stem
    for file in EXAMPLES.glob("*.toml")
    if (text := file.read_text("utf-8")).count("\n[drive]") and "\nmass = " in text
)


def leaves(values: Any) -> Iterator[Any]:
    if isinstance(values, Mapping):
        for value in values.values():
            yield from leaves(value)
    elif isinstance(values, list | tuple):
        for value in values:
            yield from leaves(value)
    elif values is not None:
        yield values


def sizes_of(result: Mapping[str, Any]) -> Iterator[np.ndarray]:
    """Signals, and the sizes of those that have two components."""
    for name, value in result.items():
        if isinstance(value, Mapping):
            yield from sizes_of(value)
            pairs = (("x", "y"), ("force_x", "force_y"), ("vx", "vy"), ("ax", "ay"))
            for pair in pairs:
                if all(isinstance(value.get(item), np.ndarray) for item in pair):
                    yield np.hypot(*(value[item] for item in pair))
                elif all(isinstance(result.get(f"{name}_{item}"), np.ndarray) for item in pair):
                    yield np.hypot(*(result[f"{name}_{item}"] for item in pair))
        elif isinstance(value, np.ndarray) and value.dtype.kind == "f":
            yield value


@cache
def numbers_in_json(name: str) -> np.ndarray:
    """Every number of what the commands print as JSON, sorted; of signals their figures."""
    findings = findings_of(name)
    assert isinstance(findings, Findings)
    given = [
        item.to_dict()
        for item in (
            findings.response,
            findings.sweep,
            findings.modes,
            findings.balanced,
            findings.planting,
        )
        if item is not None
    ]
    for entry in (findings, findings.after):
        if entry is not None:
            given += [entry.analysis.to_dict(split=True), order_values(entry.analysis, 20, 0.0)]
            given += [entry.response.to_dict()] if entry.response is not None else []
    numbers: list[float] = []
    theta = findings.analysis.crank_angle
    for signal in (item for values in given for item in sizes_of(values) if item.size):
        numbers += [np.min(signal), np.max(signal), np.mean(signal), np.sqrt(np.mean(signal**2))]
        numbers += [np.ptp(signal), np.max(np.abs(signal))]
        if signal.shape == theta.shape:
            for entry in (signal, np.abs(signal)):
                numbers += [*asdict(findings.analysis.motion.figures(entry)).values()]
        numbers += signal.ravel().tolist() if len(signal) < ANGLES else []
    numbers += [leaf for leaf in leaves(given) if isinstance(leaf, int | float)]
    machine = findings.machine
    per_order = abs(machine.drive.speed) / (2 * np.pi * findings.analysis.motion.turns)
    numbers += [*(per_order * np.arange(100)), machine.mass, machine.drive.speed, 0.0]
    if findings.balanced is not None:  # speeds for which the plan asks
        numbers += [
            speed for objective in findings.balanced.plan.objectives for speed in objective.speeds
        ]
    return np.unique(np.array(numbers))


def is_in_json(name: str, value: float, tolerance: float) -> bool:
    everything = numbers_in_json(name)
    k = np.searchsorted(everything, value)
    near = everything[max(k - 1, 0) : k + 1]
    return bool(np.any(np.abs(near - value) <= tolerance))


UNITS = sorted([*FACTORS, "kN m", "mN m", "mrad", "°", "µm", "m/s²", "rad/s²"], key=len)
NUMBER = re.compile(
    r"([−-]?[0-9]+(?:\.[0-9]+)?)(?: |\N{NO-BREAK SPACE})?("
    + "|".join(map(re.escape, reversed(UNITS)))
    + r")(?![\w/])"
)
SIGNS = {"°": "deg", "µm": "um", "m/s²": "m/s^2", "rad/s²": "rad/s^2"}


def quantities(text: str) -> Iterator[tuple[float, float]]:
    """Numbers with units in a text, and half of the last digit, in SI units."""
    for digits, unit in NUMBER.findall(text):
        factor = in_unit(SIGNS.get(unit, unit)).factor
        after = len(digits.partition(".")[2])
        yield float(digits.replace("−", "-")) / factor, 0.501 * 10**-after / factor


def shown_blocks(blocks: Iterable[Block | ReportSection]) -> Iterator[Block | ReportSection]:
    for block in blocks:
        yield block
        if isinstance(block, ReportSection):
            yield from shown_blocks(block.blocks)


DERIVED = (" goes farthest: ", "No point goes farther than ", " from the x axis")
"""In titles that say what follows from the signals of the JSON by more than a figure of one."""


@cache
def document(name: str) -> Any:
    return report_of(name)


@pytest.mark.exhaustive(but=["yamashita-rig", "hydraulic-loader"])
@pytest.mark.parametrize(
    "name", few(MACHINES, {*MACHINES} - {"riding-transplanter", "sieve", "four-stroke-engine"})
)
def test_every_number_of_cards_and_titles_is_in_the_json(name: str) -> None:
    made = document(name)
    texts = [f"{tile.value} {tile.unit}, {tile.note}" for tile in made.tiles]
    texts += [f"{tile.after} {tile.unit}" for tile in made.tiles if tile.after]
    blocks = [*shown_blocks(made.sections)]
    texts += [block.headline for block in blocks if isinstance(block, ReportSection | SvgPicture)]
    missing = {
        text
        for text in texts
        for value, half in quantities(text)
        if not is_in_json(name, value, half) and not any(part in text for part in DERIVED)
    }
    assert not missing
    assert sum(len([*quantities(text)]) for text in texts) > 8


def cells_of(table: Table) -> Iterator[tuple[str, Value]]:
    """Numbers of a table that have a dimension or a unit, with the words of their rows."""
    for row in table.rows:
        for column, cell in zip(table.columns, row, strict=True):
            values = cell.values if isinstance(cell, Many) else (cell,)
            for value in values:
                if isinstance(value, Value) and (value.dimension or column.dimension):
                    yield str(row[0]), value


@pytest.mark.parametrize("name", few(MACHINES, {*MACHINES} - {"riding-transplanter"}))
def test_every_number_of_tables_is_in_the_json(name: str) -> None:
    findings = findings_of(name)
    assert isinstance(findings, Findings)
    count = 0
    for table in findings.analysis.blocks():
        for row, value in cells_of(table) if isinstance(table, Table) else ():
            near = 1e-9 * max(abs(value.value), value.scale) + 1e-12
            assert is_in_json(name, value.value, near), (table.title, row, value)
            assert value.at is None or is_in_json(name, value.at, 1e-6), (table.title, row, value)
            count += 1
    assert count > 30


@pytest.mark.parametrize("name", few(MACHINES, {*MACHINES} - {"riding-transplanter"}))
def test_every_number_of_respond_and_balance_is_in_the_json(name: str) -> None:
    """Orders of modes, and places of rows across the machine, stand in tables alone."""
    findings = findings_of(name)
    assert isinstance(findings, Findings)
    results = [
        item for item in (findings.response, findings.sweep, findings.balanced) if item is not None
    ]
    tables = [block for result in results for block in result.blocks() if isinstance(block, Table)]
    for table in tables:
        for row, value in cells_of(table) if not table.title.startswith("Rows;") else ():
            near = 1e-9 * max(abs(value.value), value.scale) + 1e-12
            assert is_in_json(name, value.value, near), (table.title, row, value)
    assert results


@pytest.mark.parametrize("name", MACHINES)
def test_every_figure_of_the_page_is_in_the_json(name: str) -> None:
    """As a value, and as its card prints it."""
    shown = figures_of(solved(opened_example(name)).analysis)
    assert len(shown) >= 8
    for item in shown:
        if item["value"] is not None:
            value = item["value"]
            assert is_in_json(name, value, 1e-9 * abs(value) + 1e-12), item
            (printed,) = quantities(f"{item['text']} {item['unit']}")
            assert is_in_json(name, *printed), item


def same_as_analyzed(analysis: eq.Analysis, figures: Mapping[str, float | None]) -> int:
    """Figures by their paths against the summary of an analysis; how many there are in both."""
    count = 0
    for path, value in figures.items():
        output, _, measure = path.rpartition(".")
        if output not in analysis.summary or not hasattr(analysis.summary[output], measure):
            continue
        wanted = getattr(analysis.summary[output], measure)
        small = 1e-4 * analysis.summary[output].rms  # shown as 0 where it is next to nothing
        assert value == pytest.approx(wanted, rel=1e-9, abs=1e-12) or (
            value == 0.0 and abs(wanted) <= max(small, 1e-9)
        ), path
        count += 1
    return count


@pytest.mark.parametrize("name", few(WITH_FORCES, DISTINCT))
def test_other_surfaces_have_the_figures_of_analyze(name: str) -> None:
    machine = eq.load(name)
    analysis = eq.analyze(machine, acceleration=0.0)
    assert same_as_analyzed(analysis, comparison.figures_of(analysis)) > 8
    page = solved(opened_example(name)).analysis
    shown = {item["name"]: item["value"] for item in figures_of(page)}
    assert same_as_analyzed(page, shown) >= 8
    if machine.support is not None:
        torque = eq.respond(machine).to_dict()["drive"]["torque"]
        ends = {f"{analysis.whole('drive_torque')}.{end}": torque[end] for end in ("max", "min")}
        assert same_as_analyzed(analysis, ends) == 2


def test_the_exact_model_compares_with_the_forces_of_analyze() -> None:
    machine = eq.load("sieve")
    joints = eq.respond(machine, model="exact").joints
    summary = eq.analyze(machine, acceleration=0.0).summary
    for name, joint in joints.items():
        assert joint.on_ground == pytest.approx(summary[f"joints.{name}"].peak, rel=1e-12)


@pytest.mark.parametrize(
    "name",
    few(["balance-coupler", "riding-transplanter", "twin-engine"],
        {"balance-coupler", "twin-engine"}),
)  # fmt: skip
def test_what_balance_makes_small_is_what_analyze_says(name: str) -> None:
    """Peaks too, which the optimisation sees at more crank angles."""
    machine = eq.load(name)
    aims = (Objective("shaking_force", "peak"), Objective("drive_torque", "peak_to_peak"))
    limit = Limit(Objective("shaking_moment", "peak"), ratio=2.0)
    own = Balance(phases=Phases()) if machine.rows else machine.balance
    plan = replace(own, objectives=aims, limits=() if machine.rows else (limit,))
    balanced = eq.balance(machine, plan)
    reported, before, after = (
        balanced.to_dict(),
        *(eq.analyze(item, acceleration=0.0) for item in (machine, balanced.machine)),
    )
    for aim in aims:
        output = before.whole(aim.output)
        pair = [getattr(item.summary[output], aim.measure) for item in (before, after)]
        assert [*balanced.aims[aim]] == pytest.approx(pair, rel=1e-9)
        assert [*reported["objectives"][aim.name].values()] == pytest.approx(pair, rel=1e-9)
    if not machine.rows:
        used = after.summary[before.whole("shaking_moment")].peak
        assert reported["prices"][limit.name]["used"] == pytest.approx(used, rel=1e-9)


# -- one sampling, one sign, one unit, all rows ----------------------------------------------------


def test_every_surface_takes_the_same_crank_angles() -> None:
    assert Findings.__dataclass_fields__["angles"].default == ANGLES
    assert signature(command).parameters["angles"].default == ANGLES
    design = opened_example("cam-pusher")
    assert len(solved(design).analysis.crank_angle) == ANGLES


def test_the_crank_angle_of_a_peak_is_one() -> None:
    actual, made = findings_of("cam-pusher"), document("cam-pusher")
    at = eq.analyze(actual.machine).summary["drive_torque"].peak_at
    (note,) = (tile.note for tile in made.tiles if tile.label == "drive torque, peak")
    assert note == f"at crank angle {np.degrees(at):.1f}\N{DEGREE SIGN}"
    chart = forces_charts.torque(actual.analysis)
    assert note.split()[-1] in " ".join(mark.text for mark in chart.panels[0].marks)


def test_a_report_has_the_cam_and_the_spring_of_its_machine() -> None:
    """In the parts before the appendix, with the figures that the analysis has of them."""
    shown = [*shown_blocks(document("cam-pusher").sections)]
    cam, spring = (
        next(entry for entry in shown if isinstance(entry, Table) and entry.title.startswith(title))
        for title in ("Cams", "Springs")
    )
    analysis = findings_of("cam-pusher").analysis
    assert len(cam.rows) == len(analysis.machine.cams) == 1
    assert len(spring.rows) == len(analysis.machine.springs) == 1
    parts = next(entry for entry in shown if isinstance(entry, Facts) and "springs" in entry.title)
    assert {item.partition(":")[0] for item in parts.items} >= {"Cam", "Spring"}


def test_a_machine_without_a_crank_has_the_words_of_one_nowhere() -> None:
    """In no line of the report of a cylinder, on paper or on a screen, but in its own file."""
    made = document("hydraulic-loader")
    reported = replace(made, appendix=tuple(item for item in made.appendix if item.name != "file"))
    text = re.sub(r"<[^>]*>", " ", page(reported)).replace("\xa0", " ")
    assert "of the cycle" in text and "cycles a minute" in text
    wrong = r"crank angle|\brpm\b|drive pivot|turn of the crank|times a turn|once a turn"
    assert re.findall(wrong, text) == []


def test_a_peak_has_its_sign() -> None:
    (tile,) = (item for item in document("four-stroke-engine").tiles if "torque" in item.label)
    assert tile.value == "-153"
    page = eq.load("four-stroke-engine")
    analysis = eq.analyze(page)
    entries = figures_of(analysis)
    (text,) = (entry["text"] for entry in entries if entry["name"] == "drive_torque.peak")
    assert text == "\N{MINUS SIGN}153.2"


# Machines of several rows: the other tests of this file.
@pytest.mark.exhaustive
def test_cards_and_titles_speak_of_all_rows() -> None:
    actual, made = findings_of("riding-transplanter"), document("riding-transplanter")
    summary = actual.analysis.summary
    values = {tile.label: float(tile.value) for tile in made.tiles if tile.unit in ("N", "N m")}
    for what in ("shaking_force", "shaking_moment", "drive_torque"):
        figure = summary[f"rows.{what}"].signed_peak
        label = f"all rows: {what.replace('_', ' ')}, peak"
        assert values[label] == pytest.approx(figure, rel=5e-3)
        assert abs(figure) > 1.1 * summary[what].peak
    seen = {
        block.name: block.headline
        for block in shown_blocks(made.sections)
        if isinstance(block, SvgPicture)
    }
    assert f"{summary['rows.shaking_force'].peak:.1f} N" in seen["force"]
    assert f"{summary['rows.shaking_moment'].peak:.2f} N m" in seen["moment"]


def test_a_cam_is_called_a_cam() -> None:
    chart = next(iter(forces_charts.joints(findings_of("cam-pusher").analysis)))
    titles = [panel.title for panel in chart.panels]
    assert any(title.startswith("cam: ") for title in titles)
    assert not any("teeth" in title for title in titles)


# Resonances: tests/unit/vibration.
@pytest.mark.exhaustive
def test_of_resonances_the_loud_one_is_reported() -> None:
    """At 320 rpm a mode is met at 328 that adds 4 % of what the one at 255 does."""
    place = find("sieve", speed=320 * np.pi / 30)
    assert isinstance(place, Findings) and place.sweep is not None
    near = nearest_loud(place.sweep.resonances, place.machine.drive.speed)
    assert near.share == 1.0
    sentences = " ".join(s for answer in answers(place) for s in answer.sentences)
    assert "loud resonance is at 255 rpm" in sentences
    assert "keep away from 221.1 to 277.5 rpm" in sentences


@pytest.mark.parametrize("name", ["four-stroke-engine", "hydraulic-loader"])
def test_a_figure_has_one_unit_everywhere(name: str) -> None:
    """Large forces of joints and drives stand beside small ones of the frame."""
    actual, made = findings_of(name), document(name)
    analysis = actual.analysis
    units = {"force": display_of_totals(analysis, "shaking_force").name}
    (frame,) = (t for t in analysis.blocks() if isinstance(t, Table) and "frame" in t.title)
    rows = [cell.text for cell in (row[0] for row in grid(frame).rows)]
    assert any(item.endswith(units["force"]) for item in rows)
    card = next(tile for tile in made.tiles if "shaking force" in tile.label)
    assert card.unit == units["force"]
    panels = (*forces_charts.force(analysis).panels, *forces_charts.polar(analysis).panels)
    assert {panel.y.unit.name for panel in panels} == {units["force"]}
