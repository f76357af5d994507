"""An output that a result declares is in its JSON, tables and CSV, in studies and in the docs."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced
from equipoise.design.variables import Range, Variable
from equipoise.exposure.daily import Exposure
from equipoise.handheld.hand_exposure import ToolExposure, expose_tool
from equipoise.handheld.modes import ToolModes, vibrate_tool
from equipoise.handheld.sweep import ToolSweep, Transmission, sweep_tool
from equipoise.planting.summary import PlantingFigures
from equipoise.results.blocks import Table, Value
from equipoise.results.declaring import Declarations, ResultOutput, documented
from equipoise.results.result import Result
from equipoise.schema.files import csv_text, json_text
from equipoise.schema.template import Template
from equipoise.studies.commands import dimension_of
from equipoise.studies.evaluate import OneByOne
from equipoise.studies.study import Output, Sampling, Study
from equipoise.vibration.forced import GaugeCurve, Sweep, sweep_speed
from equipoise.vibration.free import FreeVibration, Transient
from equipoise.vibration.response import SIGNAL, GaugeSignals, Joint, MountForce, Response

ROOT = Path(__file__).parents[3] / "docs"
BEGIN, END = "<!-- declared {} -->\n", "<!-- end of declared {} -->\n"
TABLES: dict[str, tuple[str, Declarations]] = {
    "respond": ("output.md", Response.declared),
    "signal": ("output.md", SIGNAL),
    "speeds": ("output.md", Sweep.declared),
    "simulate": ("output.md", Transient.declared),
    "modes": ("output.md", FreeVibration.declared),
    "plant": ("output.md", PlantingFigures.declared),
    "balance": ("output.md", Balanced.declared),
    "tool-modes": ("tools.md", ToolModes.declared),
    "tool-respond": ("tools.md", ToolSweep.declared),
    "tool-exposure": ("tools.md", ToolExposure.declared),
    "exposure": ("exposure.md", Exposure.declared),
}
"""Tables of the documentation by name: their page, and the outputs that they list."""


# -- one declaration, everywhere -------------------------------------------------------------------


@dataclass(frozen=True)
class Case:
    """An output that is declared inside of a test.

    result : makes a result that has it, by the name of an example.
    declared : where it is declared, as `new`.  path : to it in JSON and studies.
    csv : column of the CSV file, with its unit.  series : attribute that it holds.
    of : command of a study that has it.
    page : table of the documentation that lists it.
    """

    result: Callable[[Any], Result]
    model: str
    declared: Declarations
    path: str
    csv: str = ""
    series: str = ""
    of: str = ""
    page: str = "respond"
    title: str = "Figures"


CASES = {
    "response": Case(eq.respond, "yamashita-rig", Response.declared, "new", of="respond"),
    "gauge": Case(
        eq.respond,
        "yamashita-rig",
        GaugeSignals.declared,
        "gauges.gauge.new",
        "gauges.gauge.new [N]",
        "displacement",
        of="respond",
        title="Gauges; RMS about the mean",
    ),
    "mount": Case(
        eq.respond,
        "yamashita-rig",
        MountForce.declared,
        "mounts.spring.new",
        "mounts.spring.new [N]",
        "force",
        of="respond",
        title="Mounts: force on the support, RMS about the mean; transmitted share of the shaking "
        "force",
    ),
    "joint": Case(
        lambda machine: eq.respond(machine, model="exact"),
        "yamashita-rig",
        Joint.declared,
        "joints.B.new",
        title="Largest force in each joint of the first row",
    ),
    "sweep": Case(
        lambda machine: sweep_speed(machine, "100 rpm", "120 rpm", speeds=3),
        "yamashita-rig",
        Sweep.declared,
        "new",
        "new [N]",
        "speed",
        page="speeds",
    ),
    "curve": Case(
        lambda machine: sweep_speed(machine, "100 rpm", "120 rpm", speeds=3),
        "yamashita-rig",
        GaugeCurve.declared,
        "gauges.gauge.new",
        "gauges.gauge.new [N]",
        "rms",
        page="speeds",
        title="",
    ),
    "modes": Case(eq.modes, "yamashita-rig", FreeVibration.declared, "new", page="modes"),
    "transient": Case(
        lambda machine: eq.simulate(machine, "0.1 s"),
        "yamashita-rig",
        Transient.declared,
        "new",
        "new [N]",
        "time",
        page="simulate",
    ),
}
CASES |= {
    "plant": Case(
        eq.plant, "kim-chung-a", PlantingFigures.declared, "new", of="plant", page="plant"
    ),
    "balance": Case(
        eq.balance, "balance-crank", Balanced.declared, "new", of="balance", page="balance"
    ),
    "tool modes": Case(
        vibrate_tool, "brush-cutter", ToolModes.declared, "new", of="tool", page="tool-modes"
    ),
    "tool sweep": Case(
        lambda tool: sweep_tool(tool, np.array([600.0, 700.0])),
        "brush-cutter",
        ToolSweep.declared,
        "new",
        "new [N]",
        "speed",
        of="tool",
        page="tool-respond",
    ),
    "transmission": Case(
        lambda tool: sweep_tool(tool, np.array([600.0, 700.0])),
        "brush-cutter",
        Transmission.declared,
        "transmission.belt.new",
        "belt.new [N]",
        "phase",
        of="tool",
        page="tool-respond",
        title="",
    ),
    "tool exposure": Case(
        lambda tool: expose_tool(tool, np.array([600.0, 700.0])),
        "brush-cutter",
        ToolExposure.declared,
        "new",
        of="tool",
        page="tool-exposure",
    ),
    "exposure": Case(
        lambda tool: expose_tool(tool, np.array([700.0])).days["rear-grip"],
        "brush-cutter",
        Exposure.declared,
        "new",
        page="exposure",
    ),
}
NEW = ResultOutput("quarter of a newton", "force", read=lambda _: 0.25, heading="largest")


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Case:
    """A case, while its output is declared."""
    actual = CASES[request.param]
    new = replace(NEW, column="new" if actual.csv else None, series=actual.series)
    monkeypatch.setitem(actual.declared, "new", new)  # type: ignore[arg-type]
    return actual


def at(values: Any, path: str) -> Any:
    for key in path.split("."):
        values = values[key]
    return values


def test_it_is_in_json(case: Case) -> None:
    values = json.loads(json_text(case.result(eq.load(case.model)).to_dict()))
    assert at(values, case.path) == 0.25


def test_it_is_in_csv(case: Case) -> None:
    if not case.csv:
        pytest.skip("no column is declared")
    header = csv_text(case.result(eq.load(case.model)).columns()).splitlines()[0].split(",")
    assert case.csv in header


def test_it_is_in_a_table(case: Case) -> None:
    if not case.title:
        pytest.skip("curves are drawn, not printed")
    blocks = case.result(eq.load(case.model)).blocks()
    (table,) = (block for block in blocks if isinstance(block, Table) and block.title == case.title)
    shown = [cell.value for row in table.rows for cell in row if isinstance(cell, Value)]
    heads = [column.label for column in table.columns] + [str(row[0]) for row in table.rows]
    assert 0.25 in shown and "largest" in heads


@pytest.mark.exhaustive(
    but=[
        "tool modes",
        "mount",
        "gauge",
        "response",
        "tool exposure",
        "balance",
        "modes",
        "transient",
        "sweep",
        "joint",
        "exposure",
        "curve",
    ]
)
def test_studies_have_it_and_know_its_dimension(case: Case) -> None:
    if not case.of:
        pytest.skip("no study runs that command")
    model = Template.load(case.model)
    assert dimension_of(model.base(), case.of, case.path) == "force"
    speed = "operation.speed" if case.of == "tool" else "drive.speed"
    own = model.number(speed)[0]
    vary = Variable(speed, Range(own, 1.1 * own), "angular speed")
    outputs = (Output("new", case.of, case.path, "force", make="smallest"),)
    study = Study("Study", model, (vary,), outputs, Sampling("sobol", 2))
    figures = OneByOne(study)(np.array([[own], [1.1 * own]])).figures
    np.testing.assert_array_equal(figures, [[0.25], [0.25]])


def test_it_is_documented(case: Case) -> None:
    rows = documented(TABLES[case.page][1]).splitlines()
    csv = "yes" if case.csv else ""
    key = case.path.replace(".gauge.", ".NAME.").replace(".spring.", ".NAME.")
    key = key.replace(".B.", ".NAME.").replace(".belt.", ".NAME.")
    assert f"| `{key}` | N | quarter of a newton | {csv} |" in rows


# -- documentation ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TABLES)
def test_the_documentation_has_all_of_them_and_nothing_else(name: str) -> None:
    page, declared = TABLES[name]
    after = (ROOT / page).read_text(encoding="utf-8").partition(BEGIN.format(name))[2]
    assert after.partition(END.format(name))[0].strip() == documented(declared).strip()


if __name__ == "__main__":  # write the tables of the documentation again
    for name, (page, declared) in TABLES.items():
        begin, end = BEGIN.format(name), END.format(name)
        text = (ROOT / page).read_text(encoding="utf-8")
        before, _, rest = text.partition(begin)
        after = rest.partition(end)[2]
        text = f"{before}{begin}{documented(declared)}{end}{after}"
        (ROOT / page).write_text(text, encoding="utf-8")
