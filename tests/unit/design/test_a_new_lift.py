"""A lift of one's own is one function; studies, searches and the search of geometry take it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.design import evaluator as processes
from equipoise.design.lifts import LIFTS, Draft, Lift, lift_named, with_lifts
from equipoise.design.requirements import Requirement
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.search import Designs
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator
from equipoise.web.stores import StoreDesk
from support.refusals import refused


def heavier(machine: Machine, scale: float) -> Machine:
    links = {
        name: replace(link, mass=link.mass and link.mass * scale)
        for name, link in machine.links.items()
    }
    return replace(machine, links=links)


def _scales(machine: Machine) -> Iterator[Lift]:
    """How many times as heavy all links are as they were, without a number in the file."""

    def put(draft: Draft, value: float) -> None:
        draft.machine = heavier(draft.machine, value)

    yield Lift("mass_scale", 1.0, 0.5, 2.0, None, put)


@pytest.fixture
def scaled() -> Iterator[None]:
    LIFTS.append(_scales)
    yield
    LIFTS.remove(_scales)


def study(*variables: eq.design.Variable, designs: int = 8) -> eq.studies.Study:
    return eq.studies.Study(
        title="",
        model=Template.load("yamashita-1"),
        vary=variables,
        outputs=(eq.studies.Output("shaking_force.y.rms", make="smallest"),),
        sampling=eq.studies.Sampling("sobol", designs),
    )


def test_studies_and_searches_take_a_lift_of_ones_own(scaled: None) -> None:
    first = eq.design.Variable("mass_scale", eq.design.Range(0.5, 2.0))
    asked = study(first, designs=40)
    base = eq.load("yamashita-1")
    values = np.array([[0.5], [2.0]])
    summaries = (eq.analyze(heavier(base, scale)).summary for scale in (0.5, 2.0))
    heavy = [summary["shaking_force.y"].rms for summary in summaries]
    np.testing.assert_allclose(evaluator(asked)(values).figures[:, 0], heavy, rtol=1e-3)
    searched = eq.studies.search(asked, population=8, generations=5)
    assert searched.values[0, 0] == pytest.approx(0.5, abs=0.06)
    assert searched.machine().links["crank"].mass < base.links["crank"].mass


def test_a_search_varies_it_around_balance(scaled: None) -> None:
    """Each design is balanced by the plan of its file: what is left is least where links are
    lightest, since force goes with their mass.
    """
    asked = eq.studies.Study(
        title="",
        model=Template.load("balance-crank"),
        vary=(eq.design.Variable("mass_scale", eq.design.Choices((0.5, 1.0, 1.5))),),
        outputs=(eq.studies.Output("after.shaking_force.y.rms", "balance", make="smallest"),),
        sampling=eq.studies.Sampling("sobol", 8),
    )
    searched = eq.studies.search(asked, population=8, generations=1, workers=1)
    assert searched.proof is not None and searched.values[0, 0] == 0.5
    machine = heavier(eq.load("balance-crank"), 0.5)
    after = eq.balance(machine).after["shaking_force.y.rms"]
    assert searched.figures[0, 0] == pytest.approx(after, rel=1e-6)


def test_the_page_opens_designs_of_it_as_machines(
    scaled: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processes, "Processes", processes.Threads)  # others know nothing of it
    first = eq.design.Variable("mass_scale", eq.design.Range(0.5, 2.0))
    eq.studies.sweep(study(first), tmp_path / "scaled.zarr", workers=1)
    desk = StoreDesk.load(str(tmp_path / "scaled.zarr"))
    content = desk.reply(1).content
    assert [column["name"] for column in content["columns"]] == [
        "mass_scale",
        "shaking_force.y.rms",
    ]
    scale = desk.store.read(range(3, 4)).values[0, 0]
    assert desk.model(3).mass == pytest.approx(scale * eq.load("yamashita-1").mass)


def test_the_search_of_geometry_takes_it_too(scaled: None) -> None:
    machine = eq.load("kim-chung-a")
    designs = Designs(machine, {"mass_scale": (0.5, 2.0), "crank": (0.03, 0.05)})
    assert [variable.path for variable in designs.variables] == ["mass_scale", "crank"]
    made = designs.build([2.0, 0.04])
    points = made.links["crank"].points
    assert np.ptp(list(points.values()), axis=0) == pytest.approx([0.04, 0.0], abs=1e-12)
    assert made.mass == pytest.approx(2 * machine.mass)


def test_a_study_varies_the_length_of_a_link() -> None:
    """As that of the file's own numbers, of which it moves two where the link lies aslant."""
    template = Template.load("yamashita-1")
    lift = lift_named(template.base(), "crank")
    assert lift is not None
    assert template.number("crank") == (lift.start, "length")
    asked = study(
        eq.design.Variable("crank", eq.design.Range(0.03, 0.036)),
        eq.design.Variable("links.crank.mass", eq.design.Range(0.1, 0.2)),
    )
    values = np.array([[0.031, 0.15], [0.035, 0.12]])
    figures = evaluator(asked)(values).figures[:, 0]
    for (length, mass), got in zip(values, figures, strict=True):
        machine = eq.load("yamashita-1").with_link("crank", mass=float(mass))
        longer = with_lifts(machine, [(lift_named(machine, "crank"), length)])
        points = longer.links["crank"].points
        assert np.hypot(*np.subtract(points["B"], points["A"])) == pytest.approx(length)
        assert got == pytest.approx(eq.analyze(longer).summary["shaking_force.y"].rms, rel=1e-3)


def test_a_map_is_over_lifts_too() -> None:
    template = Template.load("yamashita-1")
    over = {"crank": [0.032, 0.035], "links.crank.mass": [0.1, 0.2]}
    landscape = eq.studies.landscape(template, over, eq.balancing.Objective("shaking_force.y"))
    longer = template.machine({"crank": 0.035, "links.crank.mass": 0.1})
    wanted = eq.analyze(longer).summary["shaking_force.y"].rms  # type: ignore[arg-type]
    assert wanted == pytest.approx(landscape.values[0, 1], rel=1e-6) or wanted == pytest.approx(
        landscape.values[1, 0], rel=1e-6
    )


def test_what_is_no_number_is_refused_as_before() -> None:
    with refused(
        eq.EquipoiseError, "links.krank.mass", name="links.crank.mass", given="links.krank.mass"
    ):
        Template.load("yamashita-1").number("links.krank.mass")


# -- requirements ----------------------------------------------------------------------------------


def test_limits_of_outputs_and_of_goals_are_the_same() -> None:
    values = np.array([0.9, 1.0, 1.5, 2.0, 2.1, np.nan])
    wanted = [False, True, True, True, False, False]
    assert (
        Requirement("curve.height", at_least=1.0, at_most=2.0).satisfied(values).tolist() == wanted
    )
    output = eq.studies.Output("shaking_force.y.rms", at_least=1.0, at_most=2.0)
    assert output.requirement.satisfied(values).tolist() == wanted
    assert Requirement("curve.height").is_fact
    assert not output.requirement.is_fact


def test_an_angle_of_a_cycle_of_several_turns_does_not_come_round() -> None:
    late = np.array([0.5 + 2 * np.pi])
    assert Requirement("entry.crank_angle", at_most=1.0).satisfied(late)[0]
    assert not eq.studies.Output("drive_torque.max_at", at_most=1.0).requirement.satisfied(late)[0]
