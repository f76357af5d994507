"""What can be told of a file, computed when it is asked for; and its pictures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError
from equipoise.mechanism.parts.run_plans import RunPlan
from equipoise.present.composition import build
from equipoise.present.findings import Findings, ToolFindings, find
from equipoise.present.pictures import SECTIONS, ReportPicture, each, pictures
from equipoise.quantities import PER_RPM
from equipoise.results.blocks import SvgPicture
from equipoise.running.run_results import Run
from support.refusals import refused
from surface.running import example_text


def of(name: str, **options: float) -> Findings:
    place = find(name, **options)  # type: ignore[arg-type]
    assert isinstance(place, Findings)
    return place


def massless(folder: Path) -> Path:
    lines = example_text("yamashita-rig").splitlines(keepends=True)
    masses = ("mass =", "center_of_mass =", "inertia =")
    start = lines.index("[support]\n")
    kept = [line for line in lines[:start] if not line.startswith(masses)]
    path = folder / "light.toml"
    path.write_text("".join([*kept, *lines[start:]]), encoding="utf-8")
    return path


def test_findings_are_those_of_the_functions() -> None:
    result = of("yamashita-rig", speed=15.0)
    assert result.machine.drive.speed == 15.0
    assert result.file == "yamashita-rig" and "schema = 1" in result.text
    force = eq.analyze(result.machine).forces.shaking_force
    np.testing.assert_array_equal(result.analysis.forces.shaking_force.value, force.value)
    response, sweep = result.response, result.sweep
    assert response is not None and sweep is not None and result.modes is not None
    at = sweep.gauges["gauge"].peak_to_peak
    beside = np.interp(15.0, sweep.speed, at)
    assert float(response.gauges["gauge"].displacement.peak_to_peak) == pytest.approx(beside, 0.02)
    assert result.modes.modes[0].natural_frequency == pytest.approx(12.434, abs=1e-3)
    for helped in (result, of("kim-chung-c")):
        assert helped.balanced is not None
        assert helped.after is not None and helped.after.machine == helped.balanced.machine
    kept = of("class-three")
    assert kept.balanced is not None and kept.balanced.tried and kept.after is None
    assert result.planting is None and result.notes == ()


def test_what_cannot_be_found_is_reported_and_the_rest_is_there(tmp_path: Path) -> None:
    result = of(str(massless(tmp_path)))
    assert result.analysis.solved is None
    parts = [note.split(":")[0] for note in result.notes]
    assert parts == ["vibration", "natural frequencies", "balance"]
    names = {picture.section for picture in pictures(result)}
    assert names == {"model", "motion"}


@cache
def pictured(name: str) -> list[ReportPicture]:
    return pictures(of(name))


@pytest.mark.exhaustive(but=["yamashita-rig-some0", "four-row-transplanter-some1"])
@pytest.mark.parametrize(
    ("name", "some"),
    [
        ("yamashita-rig", {"linkage", "polar", "mode-1", "resonance-map"}),
        ("four-row-transplanter", {"spectrum", "phases", "rows", "joint-polars"}),
        ("transplanter", {"path", "ratio-rocker", "tip-velocity-x", "soil-torque"}),
        ("kim-chung-c", {"balanced-polar", "changes"}),
        ("two-motor-mixer", {"run"}),
    ],
)
def test_pictures_have_a_place_a_caption_and_a_name_of_their_own(name: str, some: set[str]) -> None:
    every = pictured(name)
    places = [SECTIONS.index(picture.section) for picture in every]
    assert places == sorted(places)
    for picture in every:
        assert picture.chart.caption.endswith(".") and picture.chart.caption[0].isupper()
    names = [picture.name for picture in every]
    assert len(names) == len({*names}) and some <= {*names}


def test_a_run_on_a_support_has_pictures_of_gauges_and_mounts() -> None:
    """Each with a name and a caption of its own, below a heading that is true of it."""
    machine = eq.load("yamashita-rig")
    place = find(replace(machine, run=RunPlan(duration=0.02, speed=0.0, support=True)))
    assert isinstance(place, Findings)
    shown = [*each(place, sections=("run",))]
    assert [picture.name for picture in shown] == ["run", "run-gauges", "run-mounts"]
    assert len({picture.chart.caption for picture in shown}) == 3
    (section,) = [item for item in build(place).sections if item.name == "run"]
    assert section.title == "Run"


def test_a_report_has_the_run_that_the_file_asks_for() -> None:
    result = of("cutter-bar")
    run = result.run
    assert isinstance(run, Run)
    assert (run.end.kind, result.notes) == ("standstill", ())
    report = build(result)
    (section,) = [item for item in report.sections if item.name == "run"]
    speed, time = max(run.crank_speed) / PER_RPM, run.end.time
    assert section.headline == f"Speed up to {speed:.4g} rpm, stands still after {time:.4g} s"
    (verdict,) = run.headline()
    assert section.blocks[0] == verdict
    appendix = [item for item in report.appendix if item.name == "run"]
    shown = [block for part in (section, *appendix) for block in part.blocks]
    (picture,) = [block for block in shown if isinstance(block, SvgPicture)]
    assert picture.name == "run"
    assert [block for block in run.blocks() if block not in shown] == []
    assert of("yamashita-1").run is None


def test_what_comes_later_is_not_computed() -> None:
    result = of("yamashita-rig")
    first = next(iter(each(result)))
    assert first.name == "linkage" and first.chart.name == "linkage"
    assert not {"response", "sweep", "balanced"} & vars(result).keys()


# Another speed of other results: tests/surface/test_tool.py.
@pytest.mark.exhaustive
def test_a_tool_is_found_at_another_speed() -> None:
    place = find("pole-saw", speed=700.0)
    assert isinstance(place, ToolFindings)
    assert place.tool.operation is not None and place.tool.operation.speed == 700.0
    assert place.modes is not None and place.exposure is not None and place.design is None
    assert place.transmission is not None and place.notes == ()
    assert [p.name for p in pictures(place)][:2] == ["side", "side-modes"]


def test_a_study_is_refused() -> None:
    with refused(EquipoiseError, place="study-of-lengths.toml"):
        find("study-of-lengths")
