"""Several arms of one drive: figures of each, hills of all, soil on every tip."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.figures.planting import Paths, tips, torque
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.parts.field import PlantingArm, Soil
from equipoise.planting.figures import machine_figures
from equipoise.planting.names import TURNING, dimension_of, figure_named
from equipoise.planting.stroke import nearly_alike
from equipoise.planting.summary import PlantingFigures, plant, table
from support.chosen import few
from support.refusals import refused
from support.sentences import notes_by
from unit.planting.build import TURN, apart, planetary, two_arms

SOIL = Soil(resistance=3.0, per_depth=200.0)


@cache
def figures_with_arms(ahead: float = np.pi) -> PlantingFigures:
    return plant(two_arms(ahead))


@pytest.mark.parametrize("ahead", [np.pi, 2.0])
def test_the_second_arm_does_the_same_later(ahead: float) -> None:
    """At crank angles that are less by the angle that it is ahead on the carrier."""
    first, second = figures_with_arms(ahead).arms
    groups = ("curve", "soil", "entry", "lowest", "exit")
    names = [name for name in second.figures if name.startswith(groups)]
    names.remove("curve.smallest_radius.crank_angle")  # an ellipse has two such places
    assert len(names) > 40
    for name in names:
        if name.endswith("crank_angle"):
            assert apart(first[name] - ahead, second[name]) < 1e-6, name
        elif name.rpartition(".")[2] in TURNING:
            assert apart(first[name], second[name]) < 1e-9, name
        else:
            assert second[name] == pytest.approx(first[name], rel=1e-9, abs=1e-12), name
        assert figures_with_arms(ahead)[f"arms.Q.{name}"] == second[name]


def test_the_first_arm_is_as_it_is_alone() -> None:
    """But for hills, and the carrier, which has become longer."""
    alone = plant(planetary(teeth=20))
    for name, value in alone.figures.items():
        if name not in ("hill_spacing", "planting_frequency") and ".carrier." not in name:
            assert figures_with_arms()[name] == value, name
    assert figures_with_arms()["hill_spacing"] == pytest.approx(alone["hill_spacing"] / 2)
    assert figures_with_arms()["planting_frequency"] == pytest.approx(
        alone["planting_frequency"] * 2
    )


@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_hills_are_as_far_apart_as_the_arms(speed: float) -> None:
    """An arm 150 deg ahead plants 150 / 360 of the row earlier, whichever way the carrier turns."""
    figures = plant(two_arms(np.radians(150), speed))
    row = 0.5 * TURN / 20.0
    assert figures["hills.smallest_distance"] == pytest.approx(row * 150 / 360)
    assert figures["hills.largest_distance"] == pytest.approx(row * 210 / 360)
    assert figures["hill_spacing"] == pytest.approx(row / 2)


def test_hills_follow_the_instants_at_which_seedlings_are_let_go() -> None:
    """Where these differ by half a turn and the places relative to the machine by nothing."""
    lowest = figures_with_arms()["lowest.crank_angle"]
    arms = (PlantingArm("Q", release=lowest - np.pi + 0.3),)
    figures = plant(two_arms(release=lowest, arms=arms))
    later = figures["arms.Q.release.x"] - figures["release.x"]
    row = 0.5 * TURN / 20.0
    other = (row / 2 + 0.3 * row / TURN + later) % row
    assert figures["hills.smallest_distance"] == pytest.approx(min(other, row - other))


def test_hills_of_other_units_are_not_reported() -> None:
    assert "hills.smallest_distance" not in plant(two_arms(units_per_turn=2)).figures
    still = plant(two_arms(forward_speed=0.0))
    assert "hills.smallest_distance" not in still.figures
    assert list(map(str, still.notes)).count(str(still.notes[0])) == 1


def test_hill_spacing_sets_the_speed_of_the_machine() -> None:
    machine = two_arms(forward_speed=None, hill_spacing=0.16)
    assert plant(machine)["forward_speed"] == pytest.approx(2 * 0.16 * 20.0 / TURN)


def test_soil_acts_on_every_tip() -> None:
    """Half a turn later the other arm has the force of the first."""
    machine = two_arms(soil=SOIL)
    both = eq.analyze(machine, 360).forces.frame_force.value
    dry = eq.analyze(machine.with_planting(soil=None), 360).forces.frame_force.value
    first = eq.analyze(machine.with_planting(arms=()), 360).forces.frame_force.value - dry
    assert np.any(first)
    np.testing.assert_allclose(
        both - dry, first + np.roll(first, 180), atol=1e-12 * np.max(abs(both))
    )


def with_start(machine: eq.Machine, start: float, **shape: float) -> eq.Machine:
    """The last of the gears starts elsewhere, deg; numbers of its shape."""
    *others, last = machine.gears
    assert last.shape is not None
    last = replace(last, start=np.radians(start), shape=replace(last.shape, **shape))
    return replace(machine, gears=(*others, last))


# Arms are told their starts by the other tests of this file.
@pytest.mark.exhaustive
@pytest.mark.parametrize("begun", few([-45.0, 10.0], {-45.0}))
def test_an_arm_that_only_starts_elsewhere_gets_its_start(begun: float) -> None:
    rotary = eq.load("rotary-transplanter")
    shapes = [replace(gear.shape, eccentricity=0.15) for gear in rotary.gears if gear.shape]
    gears = tuple(replace(g, shape=s) for g, s in zip(rotary.gears, shapes, strict=True))
    machine = with_start(replace(rotary, gears=gears), begun)
    deep = machine.with_planting(depth=0.15)
    values = {"link": "arm 2", "mate": "arm 1", "number": 4}
    (note,) = notes_by(nearly_alike, plant(deep).notes, "start", **values)
    alike = plant(with_start(machine, note.values["start"]))
    assert not notes_by(nearly_alike, alike.notes, "start", "link", "mate", "number")
    assert alike["arms.Q.curve.height"] == pytest.approx(alike["curve.height"], abs=1e-7)


def test_an_arm_that_turns_otherwise_gets_no_start() -> None:
    machine = with_start(eq.load("rotary-transplanter"), -44.0, eccentricity=0.1)
    assert not notes_by(nearly_alike, plant(machine).notes, "start", "link", "mate", "number")


def test_a_depth_that_one_arm_misses_is_refused_with_the_start_that_is_wrong() -> None:
    machine = with_start(eq.load("rotary-transplanter"), 100.0).with_planting(depth=0.01)
    with refused(
        ModelError, "planting.depth", tip="Q", link="arm 2", mate="arm 1", start=-44.98706
    ):
        plant(machine)


def test_the_deepest_tip_reports_where_the_surface_is() -> None:
    machine = two_arms()
    longer = machine.with_point("planet 2", "Q", (0.06, 0.0))
    figures = plant(longer)
    assert figures["arms.Q.soil.depth"] == pytest.approx(0.03)
    assert figures["soil.depth"] < 0.03
    with refused(ModelError, "planting.depth", tip="P", higher="10 mm"):
        plant(longer.with_planting(depth=0.005))


def test_as_plain_data() -> None:
    content = figures_with_arms().to_dict()
    assert json.loads(json.dumps(content, allow_nan=False)) == content
    second = content["arms"]["Q"]
    assert (content["tip"], second["tip"], second["finger_from"]) == ("P", "Q", "E")
    assert second["entry"]["crank_angle"] == figures_with_arms()["arms.Q.entry.crank_angle"]
    assert [len(item["visits"]) for item in (content, second)] == [1, 1]
    assert "hill_spacing" in content
    assert "hill_spacing" not in second


def test_figures_of_many_designs_are_those_of_one() -> None:
    curve = TipCurve([two_arms(), two_arms(2.0)])
    many = machine_figures(curve)
    for name in ("hills.smallest_distance", "arms.Q.entry.crank_angle", "arms.Q.soil.time"):
        assert many[name] == pytest.approx(
            [figures_with_arms()[name], figures_with_arms(2.0)[name]], rel=1e-9
        )


def test_what_they_are_called() -> None:
    assert dimension_of("arms.Q.soil.time") == "time"
    assert dimension_of("arms.a.b.curve.height") == "length"
    assert figure_named("arms.Q.entry.velocity.size") == "velocity at entry, tip Q"


def test_it_shows_both() -> None:
    texts = [block.text for block in figures_with_arms().blocks() if block.kind == "text"]
    assert any(text.startswith("tip Q on planet 2, finger from E") for text in texts)
    tables = {block.title: block for block in figures_with_arms().blocks() if block.kind == "table"}
    assert sum(title.startswith("Tip Q. ") for title in tables) >= 2
    path = tables["Path of the tip"]
    assert [column.label for column in path.columns] == ["", "tip P", "tip Q"]
    clear = tables["Smallest clearance of links, the tip left out, at crank angle"]
    assert "planet 2" in [row[0] for row in clear.rows]


def test_its_table_has_columns_of_each() -> None:
    columns = {name: values for name, _, values in table(figures_with_arms(), 36)}
    np.testing.assert_allclose(columns["tip Q.y"], np.roll(columns["tip.y"], -18), atol=1e-12)


def test_pictures() -> None:
    figures = plant(two_arms(soil=SOIL))
    paths = Paths(figures)
    over = paths.over_ground(paths.ways, 1) - paths.over_ground(paths.ways, 0)
    own = paths.on_machine(paths.ways, 1) - paths.on_machine(paths.ways, 0)
    np.testing.assert_allclose(over, own, atol=1e-12)
    names = [chart.name for chart in tips(figures)]
    assert {"velocity", "velocity-Q", "acceleration-x-Q"} <= {*names}
    (panel,) = torque(figures).panels
    assert len(panel.bands) == len(figures.visits) + len(figures.further[0].visits)
    assert [curve.label for curve in paths.of_further_arms(over_ground=True)] == ["path of Q"]


@pytest.mark.parametrize(
    ("arm", "where", "expected"),
    [
        (PlantingArm("P"), ".tip", {"tip": "P"}),
        (PlantingArm("Z"), ".tip", {"given": "Z"}),
        (PlantingArm("Q", finger_from="P"), ".finger_from", {"link": "planet 2", "given": "P"}),
    ],
)
def test_wrong_arms(arm: PlantingArm, where: str, expected: dict[str, str]) -> None:
    machine = two_arms()
    with refused(ModelError, f"planting.arms[1]{where}", **expected):
        replace(machine, planting=replace(machine.planting, arms=(arm,)))
