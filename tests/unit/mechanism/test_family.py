"""Designs of one build side by side: solved together, and with numbers that are columns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.mechanism.assembly.family import (
    Family,
    _stacked_values,
    can_vary,
    invalid_designs,
    linkage_of,
    with_columns,
)
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.pitch_curves import law_of
from support.batches import every_dyad
from support.chosen import few
from support.designs import Array, Number, design, drawn, named, numbers_of, plain_of, reason_of
from support.machines import KINDS, make
from support.refusals import refused
from unit.mechanism.build import ORIGIN, body, four_bar, heavy, machine

WITHIN = 1e-13
"""Of the largest value: sums are taken in another order."""
THETA = np.linspace(0.1, 6.2, 17)


def designs_of(given: eq.Machine, count: int, seed: int = 0) -> list[eq.Machine]:
    """The machine and others with every point of the frame and of the links moved a little."""
    rng = np.random.default_rng(seed)
    result = [given]
    while len(result) < count:
        links = {
            name: replace(link, points={p: moved(place, rng) for p, place in link.points.items()})
            for name, link in given.links.items()
        }
        frame = {p: moved(place, rng) for p, place in given.frame.items()}
        result.append(replace(given, links=links, frame=frame))
    return result


def moved(place: tuple[float, float], rng: np.random.Generator) -> tuple[float, float]:
    x, y = np.array(place) * rng.uniform(0.97, 1.03, 2)
    return float(x), float(y)


def rows(count: int) -> np.ndarray:
    """Other crank angles for each machine, (P, K)."""
    return THETA + np.arange(count)[:, None] * 0.37


def same_as_alone(designs: Sequence[eq.Machine]) -> Family:
    """Compare every point and link of a stack with each machine by itself."""
    family = Family([eq.mechanism.assemble(design) for design in designs])
    theta = rows(len(designs))
    state = family.solve(theta)
    alone = [eq.move(design, row) for design, row in zip(designs, theta, strict=True)]
    for link, given in designs[0].links.items():
        for point in given.points:
            triple = family.point(state, link, point)
            for order, part in enumerate(("place", "place_1", "place_2")):
                want = np.array([getattr(motion.points[point], part) for motion in alone])
                close(triple[order], want)
        for order, part in enumerate(("angle_1", "angle_2")):
            want = np.array([getattr(motion.links[link], part) for motion in alone])
            close(family.rates(state, link)[order], want)
    return family


def close(result: np.ndarray, want: np.ndarray) -> None:
    assert result.shape == want.shape
    largest = float(np.max(np.abs(want))) or 1.0
    np.testing.assert_allclose(result, want, rtol=0, atol=WITHIN * largest)


@pytest.mark.parametrize("count", [1, 2, 9])
def test_crank_rockers(count: int) -> None:
    family = same_as_alone(designs_of(eq.load("kim-chung-b"), count))
    assert family.steps is not None


@pytest.mark.parametrize(
    "kind", ["slider_crank", "stephenson", "quick_return", "scotch_yoke", "v_twin"]
)
def test_other_linkages_of_dyads(kind: str) -> None:
    family = same_as_alone(designs_of(make(kind, 1).machine, 3))
    assert family.steps is not None


def test_gears_whose_turns_are_those_of_the_crank() -> None:
    family = same_as_alone(designs_of(eq.load("planetary-planting-arm"), 3))
    assert family.steps is not None


@pytest.mark.parametrize("given", [*map(eq.load, ("class-three", "geared-counterweight"))])
def test_what_has_a_cycle_of_its_own_is_solved_one_by_one(given: Machine) -> None:
    """The steps tell turns and poses of one machine."""
    family = same_as_alone(designs_of(given, 3))
    assert family.steps is None


def test_a_crank_alone() -> None:
    """Nothing but the drive is known, and its rates are those of the crank angle."""
    cranks = [machine({"A": ORIGIN}, {"crank": body(A=ORIGIN, P=(r, 0.1))}) for r in (0.1, 0.2)]
    family = same_as_alone(cranks)
    first, second = family.rates(family.solve(rows(2)), "crank")
    assert np.all(first == 1.0) and np.all(second == 0.0)
    assert family.margins(family.solve(rows(2))).shape == (2, len(THETA))


def test_numbers_are_squared_sines_of_transmission_angles() -> None:
    designs = designs_of(eq.load("kim-chung-a"), 4)
    family = Family([eq.mechanism.assemble(design) for design in designs])
    theta = rows(4)
    result = family.margins(family.solve(theta))
    for row, each, angles in zip(result, designs, theta, strict=True):
        points = eq.move(each, angles).points
        coupler, rocker = (points["C"].place - points[p].place for p in "BD")
        sine = (np.conj(coupler) * rocker).imag / np.abs(coupler * rocker)
        np.testing.assert_allclose(row, sine**2, atol=1e-13)


def test_a_design_that_stays_open_has_negative_numbers() -> None:
    """Frame 1, crank 0.35, coupler 0.9: a rocker of 0.3 is too short for parts of the turn."""
    good, bad = four_bar(1.0, 0.35, 0.9, 0.8), four_bar(1.0, 0.35, 0.9, 0.3)
    family = Family([eq.mechanism.assemble(good), eq.mechanism.assemble(bad)])
    theta = np.broadcast_to(np.linspace(0, 2 * np.pi, 90), (2, 90))
    numbers = family.margins(family.solve(theta))
    gap = np.abs(1.0 - 0.35 * np.exp(1j * theta[1]))
    reach = (gap < 0.9 + 0.3) & (gap > 0.9 - 0.3)
    assert np.all(numbers[0] > 0)
    assert 0 < np.count_nonzero(reach) < 90
    np.testing.assert_array_equal(numbers[1] > 0, reach)


def test_points_of_the_frame_may_differ_from_design_to_design() -> None:
    given = eq.load("kim-chung-a")
    shifted = replace(given, frame={p: (x + 1.0, y - 2.0) for p, (x, y) in given.frame.items()})
    family = Family([eq.mechanism.assemble(given), eq.mechanism.assemble(shifted)])
    place = family.point(family.solve(np.broadcast_to(THETA, (2, 17))), "coupler", "P")[0]
    np.testing.assert_allclose(place[1] - place[0], 1 - 2j, atol=1e-14)


CLOSE = 1e-13
GEARED = machine(
    {"A": (0.0, 0.0), "D": (3.0, 0.0), "W": (1.0, -3.0), "hook": (0.0, 20.0)},
    {
        "crank": heavy(A=(0.0, 0.0), B=(1.0, 0.0)),
        "coupler": heavy(B=(0.0, 0.0), C=(3.0, 0.0), P=(1.0, 1.0)),
        "rocker": heavy(D=(0.0, 0.0), C=(2.5, 0.0)),
        "weight": heavy(W=(0.0, 0.0)),
    },
    assembly={"C": "left"},
    gears=(Gear("rocker", "weight", -2.0),),
    springs=(eq.Spring("coupler", "P", "hook", 100.0, 0.5),),
)


def columns_of(numbers: Sequence[Number], values: Array) -> dict[str, Array]:
    return {number.path: values[:, k, None] for k, number in enumerate(numbers)}


def parameters(linkage: Linkage) -> Iterable[tuple[str, Any]]:
    """Every number of the steps, by the outputs of its step."""
    for step in (*linkage.motion, *linkage.forces):
        for k, value in enumerate(getattr(step, "parameters", ())):
            if not callable(value):  # the law of a coupling
                yield f"{step.outputs} {k}", value  # type: ignore[attr-defined]


def row_of(value: Any, k: int) -> Any:
    value = np.asarray(value)
    return value[k, 0] if value.ndim == 2 else value


def same_steps(base: Machine, numbers: Sequence[Number], values: Array) -> None:
    """Compare all numbers of all steps, and of the links, with those of each design's machine."""
    linkage = assemble(base)
    columned = with_columns(base, columns_of(numbers, values))
    assert not invalid_designs(columned, linkage, columns_of(numbers, values)).any()
    result = list(parameters(linkage_of(columned, linkage)))
    for k, row in enumerate(values):
        own = design(base, numbers, row)
        texts = list(parameters(assemble(own)))
        assert [name for name, _ in result] == [name for name, _ in texts]
        for (name, value), (_, wanted) in zip(result, texts, strict=True):
            apart = abs(row_of(value, k) - wanted)
            assert apart <= CLOSE * (1 + abs(wanted)), name
        same_values(plain_of(columned), plain_of(own), k)


def same_values(got: Any, wanted: Any, k: int) -> None:
    """Compare nested values; k : row of the columns."""
    if isinstance(wanted, dict):
        assert got.keys() == wanted.keys()
        for key in wanted:
            same_values(got[key], wanted[key], k)
    elif isinstance(wanted, list):
        for item, other in zip(got, wanted, strict=True):
            same_values(item, other, k)
    elif wanted is None:
        assert got is None
    else:
        assert row_of(got, k) == pytest.approx(wanted, rel=CLOSE, abs=1e-15)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("polar", [False, True], ids=["xy", "polar"])
def test_steps_of_random_machines(kind: str, polar: bool) -> None:
    base = make(kind, 4).machine
    numbers = numbers_of(base, 1e-3, polar)
    same_steps(base, numbers, drawn(numbers, 3, 1))


@pytest.mark.parametrize("polar", [False, True], ids=["xy", "polar"])
def test_all_numbers_of_every_dyad(polar: bool) -> None:
    numbers = numbers_of(every_dyad(), 1e-3, polar)
    same_steps(every_dyad(), numbers, drawn(numbers, 3, 1))


@pytest.mark.exhaustive(but=["polar"])
@pytest.mark.parametrize("polar", [False, True], ids=["xy", "polar"])
def test_each_number_alone(polar: bool) -> None:
    for base in (GEARED, make("scotch_yoke", 1).machine):
        for number in numbers_of(base, 1e-3, polar):
            assert can_vary(base, number.path)
            same_steps(base, [number], drawn([number], 1, 1))


def test_base_stays_as_it_is() -> None:
    before = plain_of(GEARED)
    numbers = numbers_of(GEARED)
    with_columns(GEARED, columns_of(numbers, drawn(numbers, 3, 1)))
    assert plain_of(GEARED) == before


# -- polar parts -----------------------------------------------------------------------------------

A, B = "links.crank.points.A", "links.crank.points.B"
FOUR = four_bar(3.0, 1.0, 3.0, 2.5)


@pytest.mark.parametrize(
    "paths",
    [
        (f"{B}.distance", f"{B}.direction"),
        (f"{B}.direction", f"{B}.distance"),
        (f"{A}.distance", f"{A}.direction"),
        (f"{A}.direction", f"{A}.distance"),
        (f"{A}.direction", f"{B}.x", f"{A}.distance", f"{B}.y"),
    ],
)
def test_polar_parts_in_any_order(paths: tuple[str, ...]) -> None:
    """The origin too, whose own distance is 0, goes where distance and direction say."""
    numbers = named(FOUR, *paths)
    values = {"distance": 0.3, "direction": 0.7, "x": 1.1, "y": 0.2}
    row = np.array([[values[path.rpartition(".")[2]] for path in paths]])
    same_steps(FOUR, numbers, row)


def test_direction_of_the_origin_alone_does_nothing() -> None:
    same_steps(FOUR, named(FOUR, f"{A}.direction"), np.array([[0.5], [-2.0]]))


# -- what cannot be a column -----------------------------------------------------------------------

MASSLESS = machine(
    {"A": (0.0, 0.0)}, {"crank": eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)})}
)  # fmt: skip


@pytest.mark.parametrize(
    "path",
    [
        "links.nothing.mass",
        "links.crank.points.Z.x",
        "links.crank.points.B.z",
        "links.crank.points.B",
        "links.crank.points.B[1]",
        "frame.points.Z.y",
        "frame.A.x",
        "sliders[0].angle",
        "sliders[1].angle",
        "gears[1].start",
        "springs[1].stiffness",
        "drive.flywheel",
        "drive",
        "gravity",
        "gravity.distance.x",
        "loads[1].force.x",
        "title",
        "",
    ],
)
def test_no_such_column(path: str) -> None:
    assert not can_vary(FOUR, path)
    with refused(UsageError, paths=path):
        with_columns(FOUR, {path: np.ones((1, 1))})


@pytest.mark.parametrize("key", ["mass", "inertia", "center_of_mass.x", "center_of_mass.direction"])
def test_no_mass_to_vary(key: str) -> None:
    assert not can_vary(MASSLESS, f"links.crank.{key}")
    assert can_vary(MASSLESS, "links.crank.points.B.x")


def test_names_that_look_like_paths() -> None:
    links = {
        "points": heavy(A=(0.0, 0.0), mass=(1.0, 0.0)),
        "coupler.1": heavy(mass=(0.0, 0.0), center_of_mass=(3.0, 0.0)),
        "links rod": heavy(D=(0.0, 0.0), center_of_mass=(2.5, 0.0)),
    }
    base = machine(
        {"A": (0.0, 0.0), "D": (3.0, 0.0)},
        links,
        assembly={"center_of_mass": "left"},
        drive=eq.Drive("points", 3.0),
    )
    numbers = numbers_of(base, 1e-3)
    same_steps(base, numbers, drawn(numbers, 2, 1))


# -- what no machine can have ----------------------------------------------------------------------


def refusals(paths: Sequence[str], values: Any) -> list[bool]:
    """Check that designs are refused where their own machine is, and tell which."""
    numbers = named(GEARED, *paths)
    values = np.array(values, float)
    columned = with_columns(GEARED, columns_of(numbers, values))
    result = invalid_designs(columned, assemble(GEARED), columns_of(numbers, values))
    assert list(result) == [reason_of(GEARED, numbers, row) == 4 for row in values]
    return list(result)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("links.coupler.mass", -1e-9),
        ("links.coupler.inertia", -1e-9),
        ("links.coupler.mass", 0.0),  # with the inertia that it has
        ("springs[1].stiffness", 0.0),
        ("springs[1].stiffness", -5.0),
        ("springs[1].free_length", -1e-3),
        ("gears[1].pressure_angle", -0.1),
        ("gears[1].pressure_angle", pi / 2),
        ("gears[1].pressure_angle", 2.0),
        ("links.crank.points.B.x", 0.0),
        ("links.crank.points.B.distance", 0.0),
        ("links.crank.points.A.x", 1.0),
    ],
)
def test_impossible_number(path: str, value: float) -> None:
    own = named(GEARED, path)[0].value
    assert refusals([path], [[own], [value], [own]]) == [False, True, False]


@pytest.mark.exhaustive(but=["nan"])
@pytest.mark.parametrize("value", few([nan, inf, -inf, 1e31, -1e31, 1e-31], [nan, inf, 1e-31]))
def test_not_a_number(value: float) -> None:
    numbers = numbers_of(GEARED)
    for number in numbers:
        assert refusals([number.path], [[number.value], [value]]) == [False, True], number.path


def test_several_numbers_together() -> None:
    paths = ["links.coupler.mass", "links.coupler.inertia", "frame.points.D.x", "frame.points.D.y"]
    rows = [[0, 0, 3, 0], [0, 1, 3, 0], [1, 0, 3, 0], [1, 1, 0, 0], [1, 1, 0, 3], [1, 1, 1, -3]]
    assert refusals(paths, rows) == [False, True, False, True, False, True]


def test_points_that_are_no_pins_may_lie_together() -> None:
    assert refusals(["links.coupler.points.P.x", "links.coupler.points.P.y"], [[0, 0]]) == [False]


ROWS = {"angle": (0.0, 1.0, 2.5, 4.0)}
SHAPES = {
    "elliptic": [{"eccentricity": 0.3}, {"eccentricity": 0.1, "phase": 1.0}],
    "limacon": [{"eccentricity": 0.3}, {"eccentricity": 0.2}],
    "eccentric": [{"eccentricity": 0.3}, {"eccentricity": 0.0, "phase": -2.0}],
    "ratio": [{"cosines": (0.3, 0.1)}, {"cosines": (0.2, 0.0), "phase": 1.0}],
    "radius": [{"cosines": (0.3,), "sines": (0.1,)}, {"cosines": (0.2,), "sines": (0.0,)}],
    "table of ratios": [
        {**ROWS, "ratio": (1.02, 1.31, 0.91, 0.8)}, {**ROWS, "ratio": (0.97, 1.36, 0.92, 0.8)}
    ],
    "table of radii": [
        {**ROWS, "radius": (0.3, 0.2, 0.2, 0.25)}, {**ROWS, "radius": (0.2, 0.2, 0.3, 0.25)}
    ],
    "other rows": [
        {"angle": (0.0, 1.0, 2.5), "radius": (0.3, 0.2, 0.2)}, {**ROWS, "radius": (0.2,) * 4}
    ],
}  # fmt: skip


@pytest.mark.parametrize("kind", SHAPES)
def test_laws_of_gears_side_by_side(kind: str) -> None:
    """Each design turns as by its own law; tables with other rows are taken one by one."""
    name = {"table of ratios": "ratio", "table of radii": "radius", "other rows": "radius"}
    laws = [
        law_of(GearShape(name.get(kind, kind), **given), -1.0)
        for given in (*SHAPES[kind], SHAPES[kind][0])
    ]
    theta = rows(len(laws)) * 3 - 9
    result = _stacked_values(tuple(laws))(theta)
    alone = [law(row) for law, row in zip(laws, theta, strict=True)]
    for values, want in zip(result, zip(*alone, strict=True), strict=True):
        np.testing.assert_allclose(values, np.array(want), atol=1e-13)
