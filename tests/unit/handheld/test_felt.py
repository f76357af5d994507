"""Derivatives of what the hands get, against differences of the tool built again and again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from equipoise.errors import ModelError
from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.duals import Dual
from equipoise.handheld.exposed import Band, grips, mean_over_band, tool_sensitivities, values_of
from equipoise.handheld.model import Excitation, Hand, Impedance, Station, Tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.section import Section
from equipoise.handheld.studies import changed, has, number_of
from unit.handheld.samples import THEORIES, bare, both, random_tool

Array = np.ndarray[Any, Any]
SPEEDS = np.array([180.0, 420.0, 700.0])
HELD = ("front", "rear", "middle")
STEP = {
    "position": 5e-4,
    "mass": 0.02,
    "stiffness": 100.0,
    "damping": 1.0,
    "rotational_stiffness": 4.0,
    "rotational_damping": 0.05,
}
"""Of differences, where a number is 0; else 3e-3 of it, but for places."""


def numbers_of(tool: Tool) -> list[tuple[str, str]]:
    return [(one.name, key) for one in tool.stations for key in KEYS if has(one, key)]


def alike(tool: Tool) -> Tool:
    """The tool with both of each pair of numbers that can be varied as the vertical one."""
    for station, key in numbers_of(tool):
        tool = changed(tool, station, key, number_of(tool, station, key))
    return tool


def squares(tool: Tool, speed: Array = SPEEDS) -> Array:
    """a_hv^2 of both hands, then the mean square of the force at what is held: (5, S)."""
    response = respond_tool(tool, speed)
    rows = [grip.a_hv**2 for grip in grips(response).values()]
    for name in HELD:
        force: Any = sum(response.forces(name).values())
        rows.append(np.sum(np.abs(force) ** 2, axis=(0, 1)) / 2)
    return np.array(rows)


def slope(function: Callable[[float], Array], x: float, step: float, sides: Sequence[int]) -> Array:
    """Derivative of the polynomial through the values at x + step * sides."""
    powers = np.vander(np.array(sides, float), increasing=True).T
    weights = np.linalg.solve(powers, np.eye(len(sides))[1]) / step
    return np.asarray(sum(w * function(x + step * k) for w, k in zip(weights, sides, strict=True)))


def differences(tool: Tool, station: str, key: str) -> Array:
    """By seven values on both sides, or on that side where the number can go."""
    x = number_of(tool, station, key)
    step = STEP[key.rpartition(".")[2]]
    sides: Sequence[int] = range(-3, 4)
    if key == "position":
        inside = {"engine": range(7), "head": range(-6, 1), "front": range(-6, 1)}
        sides = inside.get(station, sides)
    elif x == 0:
        sides = range(7)
    else:
        step = 3e-3 * x
    return slope(lambda value: squares(changed(tool, station, key, value)), x, step, sides)


@pytest.mark.parametrize("theory", THEORIES)
def test_values(theory: str) -> None:
    """As those of the tool itself, made of the same numbers."""
    tool = alike(random_tool(1, theory))
    numbers = numbers_of(tool)
    felt = Band(tool, SPEEDS).felt(numbers, values_of(tool, numbers), HELD)
    found = np.array([one.value for one in (*felt.hands.values(), *felt.forces.values())])
    np.testing.assert_allclose(found, squares(tool), rtol=1e-10)
    assert list(felt.hands) == ["front", "rear"]
    assert list(felt.forces) == list(HELD)


@pytest.mark.parametrize("theory", THEORIES)
def test_values_of_the_tool_itself(theory: str) -> None:
    """Without values both of a pair keep their own."""
    tool = random_tool(1, theory)
    felt = Band(tool, SPEEDS).felt(numbers_of(tool), held=HELD)
    found = np.array([one.value for one in (*felt.hands.values(), *felt.forces.values())])
    np.testing.assert_allclose(found, squares(tool), rtol=1e-10)
    assert np.max(np.abs(squares(alike(tool)) / squares(tool) - 1)) > 0.01


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("station", ["engine", "front", "rear", "middle", "head"])
def test_slopes(theory: str, station: str) -> None:
    """Of every number of a station: its place at either end, on a border and between, and the rest.

    1e-6 of the largest of a row over the speeds: the sixth power of steps of 3e-3, and rounding of
    1e-13 of the squares, of which some hardly change with a number at all.  On a border the
    slope is that to the left.
    """
    tool = alike(random_tool(1, theory))
    numbers = [number for number in numbers_of(tool) if number[0] == station]
    felt = Band(tool, SPEEDS).felt(numbers, values_of(tool, numbers), HELD)
    found = np.array([one.slopes for one in (*felt.hands.values(), *felt.forces.values())])
    assert found.shape == (5, len(numbers), 3)
    for k, (_, key) in enumerate(numbers):
        wanted = differences(tool, station, key)
        size = np.max(np.abs(wanted), axis=1)[:, None]
        assert np.min(size) > 0
        assert np.max(np.abs(found[:, k] - wanted) / size) < 1e-6, key


def test_slopes_of_many_numbers_are_those_of_each() -> None:
    """Places that vary together, too: what is between them is as long as both say."""
    tool = alike(random_tool(2, "timoshenko"))
    numbers = numbers_of(tool)
    band = Band(tool, SPEEDS)
    whole = band.felt(numbers, values_of(tool, numbers), HELD)
    for k in (0, 6, 12, 20, 29):
        one = band.felt([numbers[k]], values_of(tool, [numbers[k]]), HELD)
        for name, part in one.hands.items():
            np.testing.assert_allclose(whole.hands[name].slopes[k], part.slopes[0], rtol=1e-8)
        for name, part in one.forces.items():
            np.testing.assert_allclose(whole.forces[name].slopes[k], part.slopes[0], rtol=1e-8)


def test_along_a_way_on_which_all_change() -> None:
    """The sum of all slopes along a random direction is the slope along it."""
    tool = alike(random_tool(3))
    numbers = [n for n in numbers_of(tool) if n != ("front", "position")]
    start = values_of(tool, numbers)
    rng = np.random.default_rng(6)
    way = rng.uniform(0.2, 1, len(start)) * np.where(start > 0, 0.02 * start, 0.0)
    way[[number == ("head", "position") for number in numbers].index(True)] *= -0.1

    def along(share: float) -> Array:
        other = tool
        for (station, key), value in zip(numbers, start + share * way, strict=True):
            other = changed(other, station, key, float(value))
        return squares(other)

    felt = Band(tool, SPEEDS).felt(numbers, start, HELD)
    parts = (*felt.hands.values(), *felt.forces.values())
    found = np.array([way @ one.slopes for one in parts])
    wanted = slope(along, 0.0, 0.5, range(7))
    np.testing.assert_allclose(found, wanted, atol=1e-6 * np.max(np.abs(wanted)))


def test_without_slopes() -> None:
    tool = random_tool(1)
    numbers = numbers_of(tool)
    values = values_of(tool, numbers)
    band = Band(tool, SPEEDS)
    plain, whole = (band.felt(numbers, values, HELD, slopes) for slopes in (False, True))
    for name, one in plain.hands.items():
        np.testing.assert_allclose(one.value, whole.hands[name].value, rtol=1e-13)
        assert one.slopes.shape == (0, 3)


def test_a_quiet_order_can_be_left_out() -> None:
    """Below a share of the largest force at the highest speed."""
    tool = bare(
        Station("a", 0.0),
        Station("grip", 0.5, hand=Hand(0.1, both(5e3), both(30.0))),
        section=Section(1000.0, 2.0),
    )
    causes = (
        Excitation("loud", "a", force=1.0),
        Excitation("quiet", "a", force=1e-4, ratio=2.0),
    )
    tool = replace(tool, excitations=causes)
    all_of, loud = (Band(tool, SPEEDS, least) for least in (0.0, 1e-3))
    assert all_of.orders.tolist() == [1, 2] and loud.orders.tolist() == [1]
    one = replace(tool, excitations=causes[:1])
    wanted = grips(respond_tool(one, SPEEDS))["grip"].a_hv ** 2
    felt = loud.felt([("a", "mass")], np.array([0.0]))
    np.testing.assert_allclose(felt.hands["grip"].value, wanted, rtol=1e-11)


def test_mean_over_the_band() -> None:
    """Trapezia between equally spaced speeds."""
    value = np.array([1.0, 4.0, 2.0, 8.0])
    slopes = np.array([[0.0, 1.0, 0.0, 2.0], [1.0, 1.0, 1.0, 1.0]])
    found = mean_over_band(Dual(value, slopes))
    assert found.value == pytest.approx(np.trapezoid(value) / 3)
    np.testing.assert_allclose(found.slopes[:, 0], [2 / 3, 1])


# -- sensitivities ---------------------------------------------------------------------------------


def worst(tool: Tool, speed: Array) -> float:
    """The largest RMS of a_hv over the band, of the hands."""
    found = grips(respond_tool(tool, speed))
    wide = speed[-1] - speed[0]
    return max(float(np.sqrt(np.trapezoid(grip.a_hv**2, speed) / wide)) for grip in found.values())


def shifted(tool: Tool, station: str, key: str, by: float) -> Tool:
    """The tool with a number larger, of a pair both by as much."""
    one = tool.station(station)
    *path, last = key.split(".")
    owner: Any = getattr(one, path[0]) if path else one
    old = getattr(owner, last)
    new = tuple(part + by for part in old) if isinstance(old, tuple) else old + by
    owner = replace(owner, **{last: new})
    return tool.with_station(station, **({path[0]: owner} if path else {last: new}))


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("same", [True, False], ids=["planes alike", "planes of their own"])
def test_sensitivities(theory: str, same: bool) -> None:
    """Of the worst hand's RMS over a band, of a pair by both together, where the tool is."""
    tool = random_tool(2, theory)
    if same:
        tool = alike(tool)
    speed = np.linspace(300, 500, 5)
    found = tool_sensitivities(tool, speed)
    assert list(found) == numbers_of(tool)
    for station, key in (
        ("rear", "position"),
        ("rear", "harness.stiffness"),
        ("rear", "harness.damping"),
        ("middle", "absorber.stiffness"),
        ("middle", "absorber.mass"),
        ("middle", "stiffness"),
        ("front", "mass"),
        ("front", "rotational_stiffness"),
    ):
        step = STEP["position"] if key == "position" else 3e-3 * number_of(tool, station, key)

        def of(by: float, station: str = station, key: str = key) -> Array:
            return np.array(worst(shifted(tool, station, key, by), speed))

        wanted = float(slope(of, 0.0, step, range(-3, 4)))
        assert found[station, key] == pytest.approx(wanted, rel=1e-6, abs=1e-9), key


# -- refusals --------------------------------------------------------------------------------------


def test_refusals() -> None:
    with pytest.raises(ModelError, match="no hand holds the tool"):
        Band(bare(Station("a", 0.1)), SPEEDS)
    held = bare(Station("a", 0.1, hand=Hand(0.2)))
    with pytest.raises(ModelError, match="nothing shakes the tool"):
        Band(held, SPEEDS)
    table = Impedance((50.0, 100.0), (10.0, 10.0), (0.0, 0.0))
    measured = bare(Station("a", 0.1, hand=Hand(impedance=(table,))))
    shaken = replace(measured, excitations=(Excitation("e", "a", force=1.0),))
    with pytest.raises(ModelError, match="50 Hz to 100 Hz"):
        Band(shaken, SPEEDS)


def test_a_measured_hand() -> None:
    """Its table does not vary, but all else does."""
    table = Impedance((1.0, 30.0, 200.0), (40.0, 60.0, 90.0), (-90.0, 10.0, 80.0))
    tool = bare(
        Station("a", 0.0, mass=2.0),
        Station("grip", 0.5, mass=0.3, hand=Hand(impedance=(table,), hands=2)),
        Station("b", 1.2, stiffness=both(3e3)),
    )
    tool = replace(tool, excitations=(Excitation("e", "a", unbalance=1e-3),))
    for key in ("mass", "position"):
        numbers = [("grip", key)]
        felt = Band(tool, SPEEDS).felt(numbers, values_of(tool, numbers), ["grip"])

        def of(value: float, key: str = key) -> Array:
            response = respond_tool(changed(tool, "grip", key, value), SPEEDS)
            force = response.forces("grip")["hand"]
            return np.array(
                [grips(response)["grip"].a_hv ** 2, np.sum(np.abs(force) ** 2, axis=(0, 1)) / 2]
            )

        wanted = slope(of, number_of(tool, "grip", key), 1e-3, range(-3, 4))
        for one, other in zip((felt.hands["grip"], felt.forces["grip"]), wanted, strict=True):
            np.testing.assert_allclose(one.slopes[0], other, rtol=1e-6)
