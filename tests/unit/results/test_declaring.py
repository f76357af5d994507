"""An output that is declared is found everywhere: nothing else lists outputs by hand."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError
from equipoise.figures import render
from equipoise.figures.motion import kinematics, outputs_chart
from equipoise.i18n import speaking
from equipoise.mechanism.outputs.declared import DECLARED, declared, declaring, output
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.present.composition import report_page
from equipoise.present.findings import Findings
from equipoise.results.blocks import Column, Table
from equipoise.results.outputs import (
    documented,
    documented_figures,
    documented_strokes,
    named_figures,
    unit_of,
)
from equipoise.schema.documents import dumps
from equipoise.schema.files import json_text, to_csv
from equipoise.studies.commands import dimension_of
from equipoise.web.gallery import opened_example
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from support.chosen import few
from support.printing import words
from support.refusals import refused

DOCS = Path(__file__).parents[3] / "docs" / "output.md"
BEGIN, END = "<!-- declared {} -->\n", "<!-- end of declared {} -->\n"
TABLES = {"outputs": documented, "strokes": documented_strokes} | {
    name: partial(documented_figures, of) for name, of in named_figures().items()
}
POWER = "drive_power"


def declare(linear: bool) -> None:
    """Declare the power of the drive, and whether it is linear in the masses."""
    loop = "{drive torque} * {speed}"
    output(POWER, "power", "drive power", linear=linear, loop=loop)(
        lambda result: result.forces.drive_torque * result.motion.speed
    )


@pytest.fixture
def power() -> Iterator[None]:
    """Inside, the power of the drive is declared."""
    with declaring():
        declare(True)
        yield


@pytest.fixture(params=[True, False], ids=["linear", "unknown"])
def linear(request: pytest.FixtureRequest) -> Iterator[bool]:
    """The same, and whether it is said to be linear."""
    with declaring():
        declare(request.param)
        yield request.param


def analysis_with() -> eq.Analysis:
    assert POWER in DECLARED
    return eq.analyze(eq.load("yamashita-1"), 90)


def test_names_mean_what_is_declared_now() -> None:
    """Meanings of names are kept, but no longer than what they were looked up in."""
    assert declared(POWER) is None
    for linear in (True, False):
        with declaring():
            assert declared(POWER) is None
            declare(linear)
            known = declared(POWER)
            assert known is not None and known[0].linear is linear
        assert declared(POWER) is None


def test_it_stands_among_plain_data(power: None) -> None:
    result = analysis_with()
    power = result.forces.power
    assert result.summary[POWER] == result.motion.figures(power)
    values = json.loads(json_text(result.to_dict()))
    np.testing.assert_allclose(values[POWER], power)
    assert values["summary"][POWER]["rms"] == pytest.approx(np.sqrt(np.mean(power**2)))
    header = to_csv(result).splitlines()[0].split(",")
    assert "drive_power [W]" in header


def test_it_stands_in_tables(power: None) -> None:
    pytest.importorskip("pandas"), pytest.importorskip("xarray")
    result = analysis_with()
    np.testing.assert_array_equal(result.to_frame()[f"{POWER} [W]"], result.forces.power)
    array = result.to_dataset()[POWER]
    assert array.attrs == {"units": "W", "long_name": "drive power"}


def test_it_is_printed() -> None:
    with declaring():
        output(POWER, "power", "drive power", ordered=True)(lambda result: result.forces.power)
        actual = analysis_with()
        tables = {block.title: block for block in actual.blocks() if isinstance(block, Table)}
        assert "drive power, W" in words(actual.blocks())
        assert tables["Amplitudes by order"].columns[-1] == Column("drive power", "power")
        *rest, last = (
            block for block in actual.blocks(orders=4, zero=0.0) if isinstance(block, Table)
        )
        assert last.title == "Drive power" and len(rest) == 6
        np.testing.assert_allclose(last.rows[1][3].value, actual.by_order[POWER].sizes[1])


@pytest.mark.parametrize(
    ("language", "title"),
    [
        ("en", "Shaking force along x"),
        ("ja", "起振力（x 方向）"),
        ("ko", "가진력(x 방향)"),
    ],
)
def test_headings_of_harmonics(language: str, title: str) -> None:
    analysis = eq.analyze(eq.load("yamashita-1"), 90)
    with speaking(language):
        tables = [
            block for block in analysis.blocks(orders=2, zero=0.0) if isinstance(block, Table)
        ]
    assert [item.rows[0][0] for item in tables] == ["0"] * 6 and tables[2].title == title


@pytest.mark.exhaustive(but=["ko"])
@pytest.mark.parametrize("language", few(["en", "ja", "ko"], {"en", "ko"}))
def test_it_stands_in_the_report(power: None, language: str) -> None:
    machine = eq.load("yamashita-1")
    text = report_page(Findings(machine, dumps(machine), "machine.toml"), language)
    assert ("drive power (en)" in text) == (language != "en")
    assert "drive power" in text


def test_it_can_be_drawn(power: None) -> None:
    picture = render(outputs_chart(analysis_with(), [POWER])).decode()
    assert "drive power" in picture


def test_the_page_draws_unasked_what_is_compared() -> None:
    """An output of which figures are told before and after has a chart and its numbers."""
    with declaring():
        output(POWER, "power", "drive power", compared=("rms", "peak"))(
            lambda result: result.forces.drive_torque * result.motion.speed
        )
        session = Session()
        session.open(opened_example("yamashita-1"))
        replies = [item.content for item in session.receive(message_of({"type": "ready"}))]
    (content,) = [reply for reply in replies if reply["type"] == "state"]
    (chart,) = [entry for entry in content["charts"] if entry["name"] == POWER]
    (choice,) = chart["choices"]
    assert (choice["label"], choice["unit"]) == ("Drive power", "W")
    assert choice["curves"][0]["array"] in content["arrays"]
    assert {entry["unit"] for entry in content["figures"] if entry["signal"] == "drive power"} == {
        "W"
    }


def test_the_page_offers_it_and_draws_it_when_asked(power: None) -> None:
    session = Session()
    session.open(opened_example("yamashita-1"))
    asked = message_of({"type": "outputs", "seq": 1, "names": [POWER, "points.P.vx"]})
    content = next(iter(session.receive(asked))).content
    offered = {entry["name"]: entry for entry in content["outputs"]}
    assert offered[POWER] == {
        "name": POWER,
        "label": "drive power",
        "group": "frame and drive",
        "winds": False,
        "unit": "W",
        "factor": 1.0,
    }
    assert {f"output.{POWER}", "output.points.P.vx"} <= content["arrays"].keys()
    assert "output.shaking_moment" not in content["arrays"]
    refused = message_of({"type": "outputs", "seq": 2, "names": ["drive_powers"]})
    content = next(iter(session.receive(refused))).content
    assert content["message"] == "no output is called 'drive_powers'; did you mean 'drive_power'?"


def test_studies_know_its_dimension(power: None) -> None:
    machine = analysis_with().machine
    for path in (POWER, f"summary.{POWER}.rms", f"{POWER}.peak_to_peak"):
        assert dimension_of(machine, "analyze", path) == "power"
    assert dimension_of(machine, "analyze", f"summary.{POWER}.max_at") == "angle"
    assert unit_of(POWER) == "W"


def test_balancing_takes_it_or_says_why_not(linear: bool) -> None:
    machine = eq.load("yamashita-1")
    plan = Balance(
        masses=(AddedMass("rocker", "D", Weight(radius=0.05, at_most=0.5)),),
        objectives=(Objective(POWER),),
    )
    if not linear:
        with refused(EquipoiseError, "balance.objectives[1].output"):
            eq.balance(machine, plan)
        return
    torque = Balance(masses=plan.masses, objectives=(Objective("drive_torque"),))
    actual, same = eq.balance(machine, plan), eq.balance(machine, torque)
    speed = abs(machine.drive.speed)
    for objective, other in zip(actual.objectives.values(), same.objectives.values(), strict=True):
        np.testing.assert_allclose(objective, np.array(other) * speed, rtol=1e-6)
    assert actual.units["rms of drive_power"] == "W"


# -- documentation ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TABLES)
def test_the_documentation_has_all_of_them_and_nothing_else(name: str) -> None:
    after = DOCS.read_text(encoding="utf-8").partition(BEGIN.format(name))[2]
    assert after.partition(END.format(name))[0].strip() == TABLES[name]().strip()


def test_a_new_one_comes_into_the_documentation(linear: bool) -> None:
    balance = ", balance" if linear else ""
    row = f"| `{POWER}` | W | drive power | masses | arrays, summary{balance}, compiled studies |"
    assert row in documented().splitlines()


# -- kinematic diagrams ----------------------------------------------------------------------------


def test_a_slider_crank_shows_its_stroke() -> None:
    analysis = eq.analyze(eq.load("slider-crank-engine"))
    (slider,) = analysis.machine.sliders
    travel = analysis.outputs[f"sliders.{slider.name}.travel"]
    places = analysis.motion.points[slider.point].place
    ends = places[np.argmax(travel.values)], places[np.argmin(travel.values)]
    assert travel.figures.peak_to_peak == pytest.approx(abs(ends[0] - ends[1]))


@pytest.mark.parametrize("name", sorted(eq.examples("linkage")))
def test_sliding_and_transmission_of_every_example(name: str) -> None:
    analysis = eq.analyze(eq.load(name), 360)
    step = 2 * np.pi / 360
    for motion in analysis.motion.sliders.values():
        slope = np.gradient(motion.travel, step)[2:-2] * analysis.motion.speed
        scale = np.max(np.abs(motion.velocity)) or 1.0
        np.testing.assert_allclose(slope, motion.velocity[2:-2], atol=5e-3 * scale)
    for angle in analysis.motion.transmission.values():
        assert np.all((angle >= 0) & (angle <= np.pi))
    if analysis.four_bar is not None and analysis.four_bar.transmission_min is not None:
        low, high = analysis.four_bar.transmission_min, analysis.four_bar.transmission_max
        angles: list[Any] = list(analysis.motion.transmission.values())
        assert any(
            np.min(item) >= low - 1e-9
            and np.max(item) <= high + 1e-9
            and np.ptp(item) > 0.9 * (high - low)
            for item in angles
        )


def test_everything_that_moves_has_its_diagrams() -> None:
    analysis = eq.analyze(eq.load("quick-return"), 90)
    drawn = {chart.name: chart for chart in kinematics(analysis)}
    names = ["transmission", *(slider.name for slider in analysis.machine.sliders)]
    names += [*analysis.machine.links, *(set(analysis.motion.points) - set(analysis.machine.frame))]
    assert set(drawn) == {f"kinematics-{name.replace(' ', '-')}" for name in names}
    titles = [panel.title for panel in drawn["kinematics-ram-on-frame"].panels]
    assert titles[0] == "travel of ram on frame, mm"


if __name__ == "__main__":  # write the tables of the documentation again
    for name, table in TABLES.items():
        begin, end = BEGIN.format(name), END.format(name)
        before, _, rest = DOCS.read_text(encoding="utf-8").partition(begin)
        after = rest.partition(end)[2]
        DOCS.write_text(f"{before}{begin}{table()}{end}{after}", encoding="utf-8")
