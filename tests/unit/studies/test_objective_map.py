"""An objective over two numbers, against balancing, single machines and Grashof's rule."""

from __future__ import annotations

from math import degrees, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError
from equipoise.studies.objective_map import Landscape, MachineVariants, SingleValues, landscape
from support.chosen import EXHAUSTIVE
from support.refusals import refused
from surface.running import example_text

RIPPLE = eq.balancing.Objective("shaking_force.y", "ripple")
"""U of Yamashita, Ichikawa and Mori (63), times the mass."""
COUPLER = "links.coupler.center_of_mass"
WEIGHT = "counterweights.crank"


TEMPLATE = eq.schema.Template.load


def over_coupler(count: int = 13) -> Landscape:
    """Their Fig. 9."""
    over = {
        f"{COUPLER}.x": np.linspace(-0.06, 0.06, count),
        f"{COUPLER}.y": np.linspace(-0.04, 0.08, count),
    }
    return landscape(TEMPLATE("yamashita-2"), over, RIPPLE)


def over_counterweight(
    count: int = 13,
    radius: float = 0.07,
    directions: tuple[float, float] = (0.0, 2 * pi),
    mass: float | None = 1.145,
) -> Landscape:
    """Their Fig. 12."""
    over = {
        f"{WEIGHT}.radius": np.linspace(0.0, radius, count),
        f"{WEIGHT}.direction": np.linspace(*directions, count),
    }
    given = {} if mass is None else {f"{WEIGHT}.mass": mass}
    return landscape(TEMPLATE("yamashita-1"), over, RIPPLE, given)


def lowest(result: Landscape) -> tuple[float, float]:
    row, column = np.unravel_index(np.nanargmin(result.values), result.values.shape)
    return result.x[column], result.y[row]


def test_fig_9_has_its_lowest_place_where_balancing_has_it() -> None:
    result = over_coupler()
    balanced = eq.balance(eq.load("balance-coupler"))
    best = balanced.machine.links["coupler"].center_of_mass
    ((before, after),) = balanced.objectives.values()
    assert result.best == pytest.approx(best, abs=1e-7)
    assert (result.least, result.before) == pytest.approx((after, before), rel=1e-9)
    assert result.start == pytest.approx((-0.045, -0.020))
    assert lowest(result) == pytest.approx(best, abs=0.01), "a step is 10 mm"
    assert np.min(result.values) >= result.least


def test_fig_12_has_its_lowest_place_where_the_paper_and_balancing_have_it() -> None:
    result = over_counterweight()
    radius, direction = result.best
    assert (1e3 * radius, degrees(direction) - 83) == pytest.approx((35.70, 111.02), abs=0.005)
    ((_, after),) = eq.balance(eq.load("balance-crank")).objectives.values()
    assert result.least == pytest.approx(after, rel=1e-9)
    assert lowest(result) == pytest.approx(result.best, abs=0.27), "steps of 6 mm and 30 deg"
    assert result.start is None


def test_each_point_is_what_an_analysis_of_that_machine_gives() -> None:
    """The quick way by inertial parameters, against machines one by one."""
    result = over_counterweight(5)
    crank = eq.load("yamashita-1").links["crank"]
    assert crank.mass is not None and crank.center_of_mass is not None and crank.inertia is not None
    place = result.x[2] * np.exp(1j * result.y[1])
    mass = crank.mass + 1.145
    center = (crank.mass * complex(*crank.center_of_mass) + 1.145 * place) / mass
    own = crank.inertia + crank.mass * abs(center - complex(*crank.center_of_mass)) ** 2
    machine = eq.load("yamashita-1").with_link(
        "crank",
        mass=mass,
        center_of_mass=(center.real, center.imag),
        inertia=own + 1.145 * abs(center - place) ** 2,
    )
    force = eq.analyze(machine, 720).forces.shaking_force.y
    assert result.values[1, 2] == pytest.approx(np.std(force), rel=1e-10)


@pytest.mark.parametrize(
    ("name", "objective"),
    [
        ("lee-kim-b", eq.balancing.Objective("shaking_moment", "peak", about="O4")),
        ("lee-kim-b", eq.balancing.Objective("joints.A", "peak", orders=(1, 2))),
        ("four-row-transplanter", eq.balancing.Objective("shaking_force", "rms")),
        ("spring-balanced-crank", eq.balancing.Objective("drive_torque", "area")),
    ],
)
def test_quick_and_slow_way_agree(name: str, objective: eq.balancing.Objective) -> None:
    from equipoise.balancing.problem import Problem

    model = TEMPLATE(name)
    over = {"links.coupler.mass": [0.3, 0.5, 0.9], "links.rocker.inertia": [1e-5, 4e-4]}
    result = landscape(model, over, objective)
    for row, inertia in enumerate(result.y):
        for column, mass in enumerate(result.x):
            machine: Any = model.machine(dict(zip(result.paths, (mass, inertia), strict=True)))
            value = Problem.value_of(machine, objective)
            assert result.values[row, column] == pytest.approx(value, rel=1e-9)


# Points against machines: `test_each_point_is_what_an_analysis_of_that_machine_gives`.
@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("name", "output", "measure"),
    [
        ("yamashita-1", "shaking_force", "peak"),
        pytest.param("quick-return", "drive_torque", "area", marks=EXHAUSTIVE),
        pytest.param("yamashita-1", "shaking_force.y", "ripple", marks=EXHAUSTIVE),
        pytest.param("yamashita-1", "drive_torque", "peak_to_peak", marks=EXHAUSTIVE),
        pytest.param("quick-return", "joints.A", "peak", marks=EXHAUSTIVE),
    ],
)
def test_many_machines_at_once_are_those_one_by_one(name: str, output: str, measure: Any) -> None:
    """More than are computed at a time, some of which nobody can build, with a counterweight."""
    of = eq.balancing.Objective(output, measure)
    link = next(iter(eq.load(name).links))
    paths = (f"links.{link}.mass", "counterweights.crank.direction")
    given = {"counterweights.crank.mass": 0.4, "counterweights.crank.radius": 0.03}
    x, y = np.linspace(-0.2, 0.6, 31), np.linspace(0.0, 6.0, 11)
    result = landscape(TEMPLATE(name), dict(zip(paths, (x, y), strict=True)), of, given)
    points = np.stack([item.ravel() for item in np.meshgrid(x, y)], axis=1)
    single = SingleValues(MachineVariants(TEMPLATE(name), given), of, paths)
    some = slice(3, None, 17)
    np.testing.assert_allclose(result.values.ravel()[some], single(points[some]), rtol=1e-9)
    assert np.array_equal(np.isnan(result.values), np.broadcast_to(x < 0, result.values.shape))


def test_a_map_of_masses_makes_no_machine_for_each_point(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    made = eq.schema.Template.machine

    def counted(self: Any, values: Any) -> Any:
        calls.append(values)
        return made(self, values)

    monkeypatch.setattr(eq.schema.Template, "machine", counted)
    over_coupler(100)
    assert len(calls) < 10


# A force in a contact that changes sides, and one that does not depend on which side bears.
@pytest.mark.exhaustive(but=["racks.sector to knife", "drive_torque"])
@pytest.mark.parametrize(
    "output", ["belts.shaft to crank.right", "racks.sector to knife", "joints.D", "drive_torque"]
)
def test_contacts_that_change_sides_are_those_of_each_machine(output: str, tmp_path: Path) -> None:
    """The knife's mass against the load on its rack decides which strand and which flank bears."""
    from equipoise.balancing.problem import Problem

    path = tmp_path / "chain.toml"
    text = example_text("knife-drive").replace('tension = "180 N"\n', "")
    path.write_text(text, encoding="utf-8")
    model, objective = TEMPLATE(str(path)), eq.balancing.Objective(output)
    over = {"links.knife.mass": [1.0, 8.0, 20.0], "links.knife.inertia": [1.0, 3.0]}
    result = landscape(model, over, objective)
    for row, inertia in enumerate(result.y):
        for column, mass in enumerate(result.x):
            machine: Any = model.machine(dict(zip(result.paths, (mass, inertia), strict=True)))
            value = Problem.value_of(machine, objective)
            assert result.values[row, column] == pytest.approx(value, rel=1e-9)


# Designs that fail among others: tests/unit/codegen/test_batch.py.
@pytest.mark.exhaustive
def test_what_cannot_turn_has_no_value() -> None:
    """Against Grashof: the crank turns where shortest and longest are less than the others."""
    over = {
        "links.crank.points.B.x": np.linspace(0.011, 0.081, 8),
        "links.coupler.points.C.x": np.linspace(0.041, 0.151, 8),
    }
    result = landscape(TEMPLATE("yamashita-1"), over, eq.balancing.Objective("shaking_force"))
    for row, coupler in enumerate(result.y):
        for column, crank in enumerate(result.x):
            bars = sorted([crank, coupler, 0.08, 0.088])
            turns = bars[0] + bars[3] < bars[1] + bars[2] and crank == bars[0]
            assert np.isnan(result.values[row, column]) != turns


ROCKER = {"links.rocker.mass": [1, 2]}
BAD: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "one number": ({"links.crank.mass": [1, 2]}, {"count": 1}),
    "unknown number": (
        {"links.crank.mas": [1, 2], **ROCKER},
        {"place": "links.crank.mas", "name": "links.crank.mass"},
    ),
    "unknown link": (
        {"counterweights.cran.mass": [1, 2], **ROCKER},
        {"place": "counterweights.cran.mass", "name": "crank"},
    ),
    "falling": ({"links.crank.mass": [2, 1], **ROCKER}, {"place": "links.crank.mass"}),
    "below nothing": (
        {"counterweights.crank.mass": [-1, 2], **ROCKER},
        {"place": "counterweights.crank.mass"},
    ),
    "set too": ({"links.coupler.mass": [1, 2], **ROCKER}, {"both": "links.coupler.mass"}),
    "never turns": (
        {"links.crank.points.B.x": [1, 2], **ROCKER},
        {"paths": "links.crank.points.B.x"},
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_drawn_is_reported(name: str) -> None:
    over, expected = BAD[name]
    with refused(EquipoiseError, **expected):
        landscape(TEMPLATE("yamashita-1"), over, RIPPLE, {"links.coupler.mass": 1.0})


def test_an_unknown_output_and_what_is_no_linkage_are_reported() -> None:
    over: Any = {"links.crank.mass": [1, 2], "links.rocker.mass": [1, 2]}
    with refused(EquipoiseError, given="shaking_forc", name="shaking_force"):
        landscape(TEMPLATE("yamashita-1"), over, eq.balancing.Objective("shaking_forc"))
    with refused(EquipoiseError, by="landscape"):
        landscape(eq.load("yamashita-1"), over, RIPPLE)  # type: ignore[arg-type]
    with refused(EquipoiseError, by="linkage_of"):
        landscape(TEMPLATE("pole-saw"), over, RIPPLE)


def test_a_counterweight_without_mass_is_no_map() -> None:
    with refused(EquipoiseError, mass="counterweights.crank.mass"):
        over_counterweight(5, mass=None)


def test_a_least_at_the_end_of_a_range_is_reported() -> None:
    assert over_counterweight().at_edge == []
    assert over_counterweight(5, 0.03, (3.0, 4.0)).at_edge == [f"{WEIGHT}.radius"]
