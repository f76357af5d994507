"""The search of geometry: it finds what is known, improves what is asked, and keeps limits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.design.requirements import Requirement
from equipoise.errors import UsageError
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.gears import closed
from equipoise.mechanism.parts.machine import FRAME
from equipoise.planting.blocks import fit_blocks
from equipoise.planting.search import Designs, Fit, PlantingProblem, fit_planting
from equipoise.results.blocks import Notes
from support.chosen import EXHAUSTIVE
from support.machines import make
from support.refusals import refused
from unit.planting.build import two_arms

FIGURES_OF_A = (
    "curve.height",
    "curve.width",
    "lowest.crank_angle",
    "entry.crank_angle",
    "exit.crank_angle",
    "soil.path_length_ground",
    "soil.ground_distance",
    "max_speed.value",
    "max_acceleration.value",
    "ratio.coupler.min",
    "ratio.rocker.min",
)
"""Of the paper's Table 2: enough to tell the seven numbers of a four-bar and its tip."""


@pytest.fixture(scope="module")
def figures_of_a() -> eq.planting.PlantingFigures:
    return eq.plant(eq.load("kim-chung-a"))


@EXHAUSTIVE
def test_mechanism_a_is_recovered_from_its_figures(
    figures_of_a: eq.planting.PlantingFigures,
) -> None:
    """Started from mechanism B, which is another machine and turns the other way.

    A population of a quarter of the usual one finds it too, in a third of the time.
    """
    goals = [Requirement(name, target=figures_of_a[name]) for name in FIGURES_OF_A]
    fit = fit_planting(eq.load("kim-chung-b"), goals, sense="either", seed=2, population=30)
    wanted, actual = eq.load("kim-chung-a"), fit.machine
    assert all(fit.met.values())
    assert actual.drive.speed == pytest.approx(wanted.drive.speed)
    assert actual.assembly == wanted.assembly
    places = [(actual.frame[p], wanted.frame[p]) for p in wanted.frame]
    for link in wanted.links:
        there, here = wanted.links[link].points, actual.links[link].points
        places += [(here[p], there[p]) for p in there]
    for got, want in places:
        assert got == pytest.approx(want, abs=1e-8)  # hundredths of a micrometre


@pytest.fixture(scope="module")
def calmer(figures_of_a: eq.planting.PlantingFigures) -> tuple[Fit, list[Requirement]]:
    """A with a smaller largest acceleration, while what planting needs stays within limits."""
    a = figures_of_a
    goals = [
        Requirement("max_acceleration.value", make="smallest"),
        Requirement("curve.height", at_least=0.98 * a["curve.height"]),
        Requirement("soil.hole_length", at_most=1.02 * a["soil.hole_length"]),
        Requirement("lowest.attitude", at_least=a["lowest.attitude"] - 0.1, at_most=-2.2),
        Requirement("max_speed.value", at_most=a["max_speed.value"]),
        Requirement("transmission.min", at_least=a["transmission.min"]),
    ]
    machine = eq.load("kim-chung-a")
    return fit_planting(machine, goals, seed=2, generations=20, population=25), goals


# Steps to a better machine fail in `test_a_machine_that_cannot_be_met_still_gives_the_nearest` too,
# and lost limits in `test_two_goals_of_one_figure`.
@EXHAUSTIVE
def test_a_stated_figure_becomes_better(calmer: tuple[Fit, list[Requirement]]) -> None:
    fit, _ = calmer
    assert fit.before is not None
    name = "max_acceleration.value"
    assert fit.after[name] < 0.8 * fit.before[name]


# Of the same search.
@EXHAUSTIVE
def test_no_other_figure_becomes_worse_than_its_limit(
    calmer: tuple[Fit, list[Requirement]],
) -> None:
    fit, goals = calmer
    for goal in goals:
        value = fit.after[goal.figure]
        assert goal.at_least is None or value >= goal.at_least
        assert goal.at_most is None or value <= goal.at_most


# Of the same search.
@EXHAUSTIVE
def test_the_result_is_a_machine_that_turns(calmer: tuple[Fit, list[Requirement]]) -> None:
    """Read from a file again, it has the figures that were told."""
    fit, _ = calmer
    again = eq.plant(eq.loads(eq.dumps(fit.machine)))
    assert again["max_acceleration.value"] == fit.after["max_acceleration.value"]
    assert eq.mechanism.assemble(fit.machine).cycle.turns == 1
    assert fit.machine.assembly == eq.load("kim-chung-a").assembly


@pytest.mark.exhaustive
def test_the_same_seed_gives_the_same_result() -> None:
    machine = eq.load("kim-chung-c")
    goals = [Requirement("curve.width", target=0.1), Requirement("soil.depth", at_least=0.01)]
    few = {"generations": 1, "population": 5, "vary": {"tip.x": (-0.3, -0.1), "tip.y": (-0.2, 0)}}
    first, two, other = (fit_planting(machine, goals, seed=seed, **few) for seed in (3, 3, 4))
    assert first.machine == two.machine
    assert first.judged == two.judged
    assert first.machine != other.machine


def notes_of(fit: Fit) -> str:
    """Its notes."""
    actual = [block.notes for block in fit_blocks(fit) if isinstance(block, Notes)]
    return " ".join(str(note) for notes in actual for note in notes)


def test_what_is_as_small_as_resulted_is_not_called_proved() -> None:
    goals, vary = [Requirement("curve.height", make="smallest")], {"tip.x": (-0.2, -0.1)}
    fit = fit_planting(eq.load("kim-chung-a"), goals, vary, generations=2, population=6)
    assert (fit.to_dict()["solver"], fit.to_dict()["proved"]) == ("differential evolution", False)
    assert "the optimum is not proved" in notes_of(fit)


# What is called proved: `test_what_is_as_small_as_resulted_is_not_called_proved`.
@pytest.mark.exhaustive
def test_a_design_that_meets_every_target_is_proved() -> None:
    """By the figures of the new machine itself; a target out of reach is not met."""
    machine, few = eq.load("kim-chung-c"), {"generations": 20, "population": 15}
    wanted = {"curve.width": 0.1, "curve.height": 0.24}
    goals = [Requirement(name, target=value) for name, value in wanted.items()]
    fit = fit_planting(machine, goals, **few)
    figures = eq.plant(fit.machine)
    for name, value in wanted.items():
        assert figures[name] == pytest.approx(value, rel=1e-8)
    assert fit.to_dict()["proved"] is True
    assert "the optimum is not proved" not in notes_of(fit)
    few = {"generations": 2, "population": 6}
    far = fit_planting(machine, [Requirement("curve.width", target=9.0)], **few)
    assert far.to_dict()["proved"] is False


# Progress of searches: tests/unit/studies and tests/unit/handheld.
@pytest.mark.exhaustive
def test_progress_is_reported() -> None:
    texts: list[tuple[int, int, float]] = []
    goals = [Requirement("curve.width", target=0.1, tolerance=1e-9)]
    fit_planting(
        eq.load("kim-chung-c"),
        goals,
        vary={"tip.x": (-0.5, 0.5)},
        generations=6,
        population=8,
        progress=lambda *values: texts.append(values),
    )
    assert [generation for generation, _, _ in texts] == list(range(1, len(texts) + 1))
    assert {most for _, most, _ in texts} == {6}
    costs = [cost for _, _, cost in texts]
    assert costs == sorted(costs, reverse=True)


def test_a_machine_that_cannot_be_met_still_gives_the_nearest() -> None:
    """A curve of ten metres is out of reach; the result says so."""
    goals, vary = [Requirement("curve.height", target=10.0)], {"tip.x": (-1.0, 1.0)}
    fit = fit_planting(eq.load("kim-chung-a"), goals, vary, generations=3, population=5)
    assert fit.met == {"curve.height": False}
    assert fit.before is not None
    assert fit.after["curve.height"] > 4 * fit.before["curve.height"]
    assert fit.values == pytest.approx({"tip.x": -1.0})


def test_only_what_may_vary_varies() -> None:
    vary = {"crank": (0.03, 0.04), "tip.y": (-0.2, 0.0)}
    goals = [Requirement("curve.height", target=0.26)]
    fit = fit_planting(eq.load("kim-chung-a"), goals, vary, generations=20, population=20)
    start, actual = eq.load("kim-chung-a"), fit.machine
    assert fit.met == {"curve.height": True}
    assert actual.frame == start.frame
    assert actual.links["rocker"] == start.links["rocker"]
    assert actual.links["coupler"].points["C"] == start.links["coupler"].points["C"]
    assert actual.links["coupler"].points["P"][0] == start.links["coupler"].points["P"][0]
    assert 0.03 <= actual.links["crank"].points["B"][0] <= 0.04
    assert set(fit.values) == set(vary)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"seed": -1}, {"by": "_check"}),
        ({"generations": 0}, {"by": "_check"}),
        ({"population": 4}, {"by": "_check"}),
        ({"vary": {"crnk": (0.1, 0.2)}}, {"place": "vary.crnk", "name": "crank", "given": "crnk"}),
        ({"vary": {"crank": (0.2, 0.1)}}, {"place": "vary.crank", "by": "_range"}),
        ({"vary": {"crank": (-0.2, 0.1)}}, {"place": "vary.crank", "by": "_range"}),
        ({"goals": []}, {"place": "goals"}),
        ({"goals": [Requirement("curve.height")]}, {"place": "curve.height"}),
        (
            {"goals": [Requirement("curve.heigth", target=1.0)]},
            {"place": "goals", "name": "curve.height", "given": "curve.heigth"},
        ),
    ],
)
def test_wrong_arguments(change: dict[str, object], expected: dict[str, Any]) -> None:
    arguments = {
        "goals": [Requirement("curve.height", target=0.25)],
        "generations": 1,
        "population": 5,
    }
    with refused(UsageError, **expected):
        fit_planting(eq.load("kim-chung-a"), **(arguments | change))  # type: ignore[arg-type]


def test_gears_on_other_links_are_refused() -> None:
    machine = make("geared_coupler", 1).machine
    machine = machine.with_planting(tip="P", forward_speed=0.3, surface=0.0)
    with refused(UsageError, by="_check"):
        fit_planting(machine, [Requirement("curve.height", target=0.25)])


# Arms on every change: `test_arms_stay_alike_whatever_the_shape_of_their_gears`.
@EXHAUSTIVE
def test_arms_on_gears_are_recovered() -> None:
    """Of two arms that are alike the tips move together, and phases of gears turn together."""
    wanted = two_arms()
    figures = eq.plant(wanted)
    names = ("curve.height", "curve.width", "lowest.crank_angle", "arms.Q.lowest.crank_angle")
    start = replace(
        wanted,
        gears=tuple(
            replace(gear, start=gear.start + (0.4 if k % 2 else 0.0))
            for k, gear in enumerate(wanted.gears)
        ),
    )
    vary = {"tip.x": (0.03, 0.07), "gears[2,4].start": (2.0, 3.2)}
    goals = [Requirement(name, target=figures[name]) for name in names]
    fit = fit_planting(start, goals, vary, generations=30, population=15)
    assert all(fit.met.values())
    for link, tip in (("planet", "P"), ("planet 2", "Q")):
        assert fit.machine.links[link].points[tip] == pytest.approx((0.05, 0.0), abs=1e-6)
    starts = [[gear.start for gear in machine.gears] for machine in (fit.machine, wanted)]
    assert starts[0] == pytest.approx(starts[1], abs=1e-6)


def test_shaking_is_that_of_analyze() -> None:
    machine = two_arms(np.radians(100))
    designs = Designs(machine, {"carrier.D,E.direction": (0.0, np.pi)})
    goals = [Requirement("shaking_force.rms", target=1.0, tolerance=1.0)]
    outcome = PlantingProblem(designs, goals).judge(np.array([designs.start, [2.0]]))
    for off, value in zip(outcome.off[:, 0], (designs.start, [2.0]), strict=True):
        force = eq.analyze(designs.build(value), 720).forces.shaking_force.size
        assert off + 1.0 == pytest.approx(np.sqrt(np.mean(force**2)), rel=1e-6)


# What a search takes for shaking: the test above; that it becomes less, as of other figures.
@EXHAUSTIVE
def test_shaking_is_kept_small() -> None:
    """It is that of `analyze`, and falls where the second arm moves against the first."""
    machine = two_arms(np.radians(100))
    vary = {"carrier.D,E.direction": (0.0, np.pi)}
    goals = [Requirement("shaking_force.rms", make="smallest")]
    fit = fit_planting(machine, goals, vary, generations=3, population=5)
    analysis = eq.analyze(fit.machine, 720)
    force = analysis.forces.shaking_force.size
    assert fit.after.get("shaking_force.rms") == pytest.approx(np.sqrt(np.mean(force**2)))
    assert fit.after.get("shaking_force.peak") == pytest.approx(np.max(force), rel=1e-4)
    moment, torque = analysis.forces.shaking_moment, analysis.forces.drive_torque
    assert fit.after.get("shaking_moment.rms") == pytest.approx(np.sqrt(np.mean(moment**2)))
    assert fit.after.get("drive_torque.rms") == pytest.approx(np.sqrt(np.mean(torque**2)))
    assert fit.before.get("shaking_force.rms") > 2 * fit.after.get("shaking_force.rms")
    content = fit.to_dict()["goals"][0]
    assert content["after"] == fit.after.get("shaking_force.rms") < content["before"]


def test_no_design_that_plants() -> None:
    """Lengths between which no crank can turn."""
    vary = {"crank": (0.2, 0.21)}
    goals = [Requirement("curve.height", target=0.2)]
    with refused(UsageError, by="_best"):
        fit_planting(eq.load("kim-chung-a"), goals, vary, generations=2, population=6)


def test_designs_put_values_where_they_are_named() -> None:
    machine = eq.load("kim-chung-a")
    designs = Designs(machine, sense="clockwise")
    names = [variable.path for variable in designs.variables]
    assert names == ["frame", "crank", "coupler", "rocker", "ground_angle", "tip.x", "tip.y"]
    built = designs.build([0.09, 0.03, 0.08, 0.07, 0.4, -0.2, 0.05])
    assert complex(*built.frame["D"]) == pytest.approx(0.09 * np.exp(0.4j))
    assert built.frame["A"] == machine.frame["A"]
    assert built.links["crank"].points["B"] == (0.03, 0.0)
    assert built.links["coupler"].points["C"] == (0.08, 0.0)
    assert built.links["coupler"].points["P"] == (-0.2, 0.05)
    assert built.links["rocker"].points["C"] == (0.07, 0.0)
    assert built.drive.speed == -machine.drive.speed
    start = designs.build(designs.start)
    assert start.frame["D"] == pytest.approx(machine.frame["D"], abs=1e-15)


def test_coordinates_of_any_point_can_vary() -> None:
    designs = Designs(eq.load("kim-chung-a"), {"coupler.C.y": (-0.1, 0.1), "frame.D.x": (0, 0.1)})
    built = designs.build([0.02, 0.03])
    assert built.links["coupler"].points["C"] == (0.075, 0.02)
    assert built.frame["D"] == pytest.approx((0.03, -0.075))


def test_designs_are_judged_without_following_their_cycle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also a single one: what cannot turn by a hair is a poor design, not an error."""
    problem = PlantingProblem(
        Designs(eq.load("kim-chung-a")), [Requirement("curve.height", target=0.25)]
    )

    def followed(linkage: Linkage) -> None:
        raise AssertionError

    monkeypatch.setattr(Linkage, "cycle", property(followed))
    outcome = problem.judge(problem.designs.start[None])
    assert outcome.cost[0] < 1.0
    assert outcome.worst[0] > 0.1


# Points that vary: `test_coordinates_of_any_point_can_vary`.
@pytest.mark.exhaustive
def test_a_tip_at_the_origin_of_its_link_can_vary() -> None:
    machine = eq.load("kim-chung-a")
    points = {
        name: np.subtract(place, (-0.1628, -0.1017))
        for name, place in machine.links["coupler"].points.items()
    }
    link = eq.Link(points={name: tuple(place) for name, place in points.items()})
    moved = replace(machine, links={**machine.links, "coupler": link})
    fit = fit_planting(
        moved, [Requirement("curve.height", target=0.26)], generations=20, population=20
    )
    assert fit.met == {"curve.height": True}


def test_two_goals_of_one_figure() -> None:
    goals = [Requirement("curve.height", at_least=0.26), Requirement("curve.height", at_most=0.2)]
    vary = {"tip.x": (-0.2, -0.1)}
    fit = fit_planting(eq.load("kim-chung-a"), goals, vary, generations=2, population=6)
    assert fit.met == {"curve.height": False}


# -- the shape of gears ----------------------------------------------------------------------------

ECCENTRICITY = "gears.shape.eccentricity"


def paths(machine: eq.Machine) -> list[np.ndarray]:
    motion = eq.move(machine, 72)
    return [motion.points[tip].place for tip in "PQ"]


def test_arms_stay_alike_whatever_the_shape_of_their_gears() -> None:
    """At crank angle 0 they are in different places, where the shape turns them differently."""
    designs = Designs(eq.load("rotary-transplanter"), {ECCENTRICITY: (0.0, 0.4)})
    first, second = paths(designs.build([0.12]))
    np.testing.assert_allclose(second, np.roll(first, 36), atol=1e-7)
    assert np.max(np.abs(first - paths(designs.machine)[0])) > 0.01


def test_an_arm_that_is_varied_alone_goes_its_own_way() -> None:
    vary = {ECCENTRICITY: (0.0, 0.4), "gears[4].start": (-1.0, 0.0)}
    designs = Designs(eq.load("rotary-transplanter"), vary)
    assert designs.build([0.2, -0.5]).gears[3].start == -0.5
    names = [variable.path for variable in Designs(designs.machine).variables]
    assert names == ["tip.x", "tip.y", ECCENTRICITY]


@EXHAUSTIVE
def test_the_eccentricity_of_gears_is_recovered() -> None:
    wanted = eq.load("rotary-transplanter")
    start = Designs(wanted, {ECCENTRICITY: (0.0, 0.4)}).build([0.1])
    goals = [Requirement("curve.height", target=eq.plant(wanted)["curve.height"])]
    vary = {ECCENTRICITY: (0.05, 0.3)}
    fit = fit_planting(start, goals, vary, generations=5, population=5)
    assert fit.values[ECCENTRICITY] == pytest.approx(0.2, abs=1e-6)
    shapes = [gear.shape.eccentricity for gear in fit.machine.gears if gear.shape is not None]
    assert shapes == [fit.values[ECCENTRICITY]] * 4


FREE = {
    "eccentric": ({"eccentricity": 0.2}, "gears.shape.eccentricity", (0.1, 0.3)),
    "limacon": ({"eccentricity": 0.2}, "gears.shape.eccentricity", (0.1, 0.3)),
    "ratio": (
        {"cosines": (-0.35, 0.05), "sines": (0.02,)}, "gears.shape.cosines[1]", (-0.4, -0.2)
    ),
    "radius": (
        {"angle": (0.0, 1.5, 3.0, 4.5), "radius": (0.021, 0.026, 0.031, 0.026)},
        "gears.shape.radius[3]", (0.026, 0.04),
    ),
}  # fmt: skip
"""Kinds of shape: what the wanted machine has, which number is looked for, and where."""


@pytest.mark.exhaustive(but=["limacon", "ratio"])
@pytest.mark.parametrize("kind", FREE)
def test_gears_of_any_shape_can_be_judged(kind: str) -> None:
    """A table is scaled so that its curves close, whatever a number of it becomes."""
    given, name, limits = FREE[kind]
    rotary = eq.load("rotary-transplanter")
    bodies = {FRAME: rotary.frame, **{key: link.points for key, link in rotary.links.items()}}
    gears = [
        closed(replace(gear, shape=GearShape(kind, phase=gear.shape.phase, **given)), bodies)
        for gear in rotary.gears
        if gear.shape is not None
    ]
    designs = Designs(replace(rotary, gears=tuple(gears)), {name: limits})
    values = np.append(designs.start, limits)[:, None]
    places = [eq.move(designs.build(row), 3600).points["P"].place for row in values]
    heights = [np.ptp(place.imag) for place in places]
    goals = [Requirement("curve.height", target=heights[0], tolerance=1.0)]
    outcome = PlantingProblem(designs, goals).judge(values)
    np.testing.assert_allclose(outcome.off[:, 0], np.array(heights) - heights[0], atol=1e-6)
    assert np.all(outcome.feasible) and len({round(height, 4) for height in heights}) == 3


@pytest.mark.parametrize(
    "name",
    ["gears[9].start", "gears.shape.sines[1]", "carrier.B,Z.x", "nothing.B.x", "gears[0].start"],
)
def test_numbers_that_there_are_not(name: str) -> None:
    with refused(UsageError, place=f"vary.{name}", given=name):
        Designs(eq.load("rotary-transplanter"), {name: (0.0, 1.0)})
