"""What the hands on a tool get, over a day and over a band of speeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exposure.spectra import weigh_signal
from equipoise.exposure.weighting import weighting
from equipoise.handheld import hand_exposure
from equipoise.handheld import response as reciprocal
from equipoise.handheld.chain import Dual, carry, solve
from equipoise.handheld.hand_exposure import (
    SpeedBand,
    expose_tool,
    grips,
    mean_over_band,
    tool_sensitivities,
    values_of,
    weighted_squares,
)
from equipoise.handheld.model import (
    Excitation,
    Hand,
    Impedance,
    Operation,
    Station,
    Tool,
    Work,
    changed,
    number_of,
)
from equipoise.handheld.response import ToolResponse, respond_tool
from equipoise.handheld.shaft import KEYS, Section, has_number
from support.refusals import refused
from unit.handheld.samples import THEORIES, bare, both, random_tool, shaken

Array = np.ndarray[Any, Any]
HOUR = 3600.0
SPEEDS = np.array([180.0, 420.0, 700.0])


def acceleration(response: ToolResponse, station: str, time: Array) -> Array:
    """Vertical and lateral (2, T), m/s2, at the first speed of a response."""
    amplitudes = response.acceleration(station)[..., 0]
    angles = np.multiply.outer(response.orders * response.speed[0], time)
    return np.real(np.einsum("pk,kt->pt", amplitudes, np.exp(1j * angles)))


def engine_and_blade() -> Tool:
    """Make a random tool that is shaken by a slider-crank besides."""
    tool = random_tool(1, "timoshenko")
    engine = Excitation("crank", "engine", linkage=eq.load("brush-cutter-engine"))
    return shaken(tool, engine, *tool.excitations)


@pytest.mark.parametrize("hertz", [40.0, 110.0])
def test_a_signal_of_whole_periods(hertz: float) -> None:
    """All orders are tenths, so that a second of a multiple of 10 Hz is whole periods of all.

    1e-9: nothing but rounding, where a record is exact.  Orders over 5 kHz are below 1e-6 of all.
    """
    time = np.arange(10000) / 10000
    response = respond_tool(engine_and_blade(), 2 * pi * hertz)
    for name, grip in grips(response).items():
        weighted = weigh_signal(time, acceleration(response, name, time), periodic=True)
        np.testing.assert_allclose(grip.a_hw[:, 0], weighted.a_hw, rtol=1e-9)
        assert grip.a_hv[0] == pytest.approx(weighted.a_hv, rel=1e-9)
        assert weighted.a_h is not None
        np.testing.assert_allclose(grip.acceleration[:, 0], weighted.a_h, rtol=1e-9)


def test_a_signal_as_it_is_measured() -> None:
    """Eight seconds at any speed, faded in and out: 0.1 % is what such a record reads to."""
    time = np.arange(80000) / 10000
    response = respond_tool(engine_and_blade(), 2 * pi * 87.3)
    for name, grip in grips(response).items():
        weighted = weigh_signal(time, acceleration(response, name, time))
        assert grip.a_hv[0] == pytest.approx(weighted.a_hv, rel=1e-3)


@pytest.mark.parametrize("theory", THEORIES)
def test_weighting_of_each_order(theory: str) -> None:
    """|Wh|^2 of the analog filters by s = i f, times half the square of the amplitude."""
    response = respond_tool(random_tool(2, theory), np.array([200.0, 700.0]))
    result = grips(response)["rear"]
    amplitude = response.acceleration("rear")
    passed = np.abs(weighting(response.frequency / (2 * pi)))
    wanted = np.sqrt(np.sum(np.abs(amplitude * passed) ** 2 / 2, axis=1))
    np.testing.assert_allclose(result.a_hw, wanted, rtol=1e-12)
    np.testing.assert_allclose(result.a_hv, np.hypot(*wanted), rtol=1e-12)


def test_squares_of_one_order() -> None:
    """At 16 Hz Wh is 0.896, as ISO 5349-1, Table A.2, has it; 1 mm is 10.1 m/s2 peak there."""
    w = 2 * pi * 10**1.2
    result = weighted_squares(np.array(w), np.array(1e-3j))
    assert np.real(result) == pytest.approx((0.896 * w**2 * 1e-3) ** 2 / 2, rel=1e-3)


# -- days ------------------------------------------------------------------------------------------


def worked(*work: Work, **operation: float) -> Tool:
    values = {"speed": 600.0, **operation}
    return replace(random_tool(3), operation=Operation(**values), work=work)


def a_hv(tool: Tool, speed: float, station: str) -> float:
    """By the response alone."""
    return float(grips(respond_tool(tool, speed))[station].a_hv[0])


def test_a_day_of_several_parts() -> None:
    """A(8)^2 is the sum of a_hv^2 T / 8 h; the worst hand is the one told."""
    work = (
        Work("mow", 600.0, 2 * HOUR),
        Work("walk", 300.0, 0.5 * HOUR),
        Work("cut", 700.0, 900.0),
    )
    tool = worked(*work)
    exposure = expose_tool(tool, np.array([400.0, 600.0]))
    a8 = {
        name: sqrt(sum(a_hv(tool, w.speed, name) ** 2 * w.duration for w in work) / (8 * HOUR))
        for name in ("front", "rear")
    }
    for name, wanted in a8.items():
        assert exposure.days[name].a8 == pytest.approx(wanted, rel=1e-12)
    assert a8["front"] != pytest.approx(a8["rear"], rel=1e-3)
    assert exposure.worst == max(a8, key=lambda name: a8[name])
    assert exposure.a8 == pytest.approx(max(a8.values()))


def test_a_duration_in_the_place_of_the_day() -> None:
    """So long at the working speed, whatever the file tells of work."""
    tool = worked(Work("mow", 300.0, 2 * HOUR))
    exposure = expose_tool(tool, np.array([400.0]), 4 * HOUR)
    for name in ("front", "rear"):
        wanted = a_hv(tool, 600.0, name) * sqrt(0.5)
        assert exposure.days[name].a8 == pytest.approx(wanted, rel=1e-12)


def test_idling_and_racing() -> None:
    """ISO 22867: the root of the mean of both squares, of each hand."""
    tool = worked(idling=290.0, racing=950.0)
    exposure = expose_tool(tool, np.array([400.0]))
    assert list(exposure.named) == ["working", "idling", "racing"]
    for name in ("front", "rear"):
        low, high = (a_hv(tool, speed, name) for speed in (290.0, 950.0))
        assert exposure.equivalents[name] == pytest.approx(sqrt((low**2 + high**2) / 2), rel=1e-12)
        assert exposure.named["idling"][name].a_hv[0] == pytest.approx(low, rel=1e-12)
    only = expose_tool(worked(idling=290.0), np.array([400.0]))
    assert only.equivalents == {}
    assert list(only.named) == ["working", "idling"]


def test_nothing_of_a_day() -> None:
    exposure = expose_tool(random_tool(3), np.array([400.0, 500.0]))
    assert (exposure.days, exposure.named, exposure.equivalents) == ({}, {}, {})
    assert exposure.worst is None and exposure.a8 is None


def test_over_the_range() -> None:
    """The hand that gets most at each speed by itself."""
    tool = random_tool(3)
    speeds = np.linspace(150, 900, 40)
    exposure = expose_tool(tool, speeds)
    each = np.array([grip.a_hv for grip in exposure.grips.values()])
    np.testing.assert_array_equal(exposure.a_hv, np.max(each, axis=0))
    assert len(set(np.argmax(each, axis=0))) == 2
    np.testing.assert_array_equal(exposure.speed, speeds)
    content = exposure.to_dict()
    for name, grip in exposure.grips.items():
        np.testing.assert_array_equal(content["hands"][name]["a_hw_lateral"], grip.a_hw[1])
        np.testing.assert_array_equal(
            content["hands"][name]["acceleration_vertical"], grip.acceleration[0]
        )
    assert content["a8"] is None


def test_two_hands_at_one_grip_are_reported_once() -> None:
    station = Station("grip", 0.5, hand=Hand(0.1, both(5e3), both(50.0), hands=2))
    tool = shaken(bare(Station("a", 0.0), station), Excitation("e", "a", unbalance=1e-3))
    assert list(expose_tool(tool, np.array([300.0])).grips) == ["grip"]


def test_refusals() -> None:
    cause = Excitation("e", "a", force=1.0)
    table = Impedance((50.0, 100.0), (10.0, 10.0), (0.0, 0.0))
    measured = Station("a", 0.1, hand=Hand(impedance=(table,)))
    for call in (expose_tool, SpeedBand):
        with refused(ModelError, "shaft.stations"):
            call(shaken(bare(Station("a", 0.1)), cause), SPEEDS)
        with refused(ModelError, "excitations"):
            call(shaken(random_tool(1)), SPEEDS)
        with refused(ModelError, "shaft.stations[1].hand.impedance", first=50.0, high=111.408):
            call(shaken(bare(measured), cause), SPEEDS)
    with refused(ModelError, "operation"):
        expose_tool(random_tool(1), np.array([300.0]), HOUR)


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
    return [
        (station.name, key) for station in tool.stations for key in KEYS if has_number(station, key)
    ]


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
    """As those of the tool itself, made of the same numbers.

    Without values both of a pair keep their own; with them they are alike.
    """
    tool = random_tool(1, theory)
    numbers, same = numbers_of(tool), alike(tool)
    for first, values in ((tool, None), (same, values_of(tool, numbers))):
        felt = SpeedBand(first, SPEEDS).felt(numbers, values, HELD)
        result = np.array([item.value for item in (*felt.hands.values(), *felt.forces.values())])
        np.testing.assert_allclose(result, squares(first), rtol=1e-10)
        assert (list(felt.hands), list(felt.forces)) == (["front", "rear"], list(HELD))
    assert np.max(np.abs(squares(same) / squares(tool) - 1)) > 0.01


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
    felt = SpeedBand(tool, SPEEDS).felt(numbers, values_of(tool, numbers), HELD)
    values = np.array([item.slopes for item in (*felt.hands.values(), *felt.forces.values())])
    assert values.shape == (5, len(numbers), 3)
    for k, (_, key) in enumerate(numbers):
        wanted = differences(tool, station, key)
        size = np.max(np.abs(wanted), axis=1)[:, None]
        assert np.min(size) > 0
        assert np.max(np.abs(values[:, k] - wanted) / size) < 1e-6, key


def test_slopes_of_many_numbers_are_those_of_each() -> None:
    """Places that vary together, too: what is between them is as long as both say."""
    tool = alike(random_tool(2, "timoshenko"))
    numbers = numbers_of(tool)
    band = SpeedBand(tool, SPEEDS)
    whole = band.felt(numbers, values_of(tool, numbers), HELD)
    for k in range(len(numbers)):
        first = band.felt([numbers[k]], values_of(tool, [numbers[k]]), HELD)
        for name, part in first.hands.items():
            np.testing.assert_allclose(whole.hands[name].slopes[k], part.slopes[0], rtol=1e-8)
        for name, part in first.forces.items():
            np.testing.assert_allclose(whole.forces[name].slopes[k], part.slopes[0], rtol=1e-8)


def test_slopes_cost_one_more_run_along_the_shaft(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many numbers there are."""
    runs: list[int] = []
    for module, run in ((hand_exposure, solve), (reciprocal, solve), (hand_exposure, carry)):

        def counted(*given: Any, run: Callable[..., Any] = run) -> Any:
            runs.append(1)
            return run(*given)

        monkeypatch.setattr(module, run.__name__, counted)
    tool = alike(random_tool(2))
    numbers = numbers_of(tool)
    SpeedBand(tool, SPEEDS).felt(numbers, values_of(tool, numbers), HELD)
    assert len(numbers) > 20 and len(runs) == 3


def test_without_slopes() -> None:
    tool = random_tool(1)
    numbers = numbers_of(tool)
    values = values_of(tool, numbers)
    band = SpeedBand(tool, SPEEDS)
    plain, whole = (band.felt(numbers, values, HELD, slopes) for slopes in (False, True))
    for name, value in plain.hands.items():
        np.testing.assert_allclose(value.value, whole.hands[name].value, rtol=1e-13)
        assert value.slopes.shape == (0, 3)


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
    tool = shaken(tool, *causes)
    all_of, loud = (SpeedBand(tool, SPEEDS, least) for least in (0.0, 1e-3))
    assert all_of.orders.tolist() == [1, 2] and loud.orders.tolist() == [1]
    first = shaken(tool, causes[0])
    wanted = grips(respond_tool(first, SPEEDS))["grip"].a_hv ** 2
    felt = loud.felt([("a", "mass")], np.array([0.0]))
    np.testing.assert_allclose(felt.hands["grip"].value, wanted, rtol=1e-11)


def test_mean_over_the_band() -> None:
    """Trapezia between equally spaced speeds."""
    value = np.array([1.0, 4.0, 2.0, 8.0])
    slopes = np.array([[0.0, 1.0, 0.0, 2.0], [1.0, 1.0, 1.0, 1.0]])
    result = mean_over_band(Dual(value, slopes))
    assert result.value == pytest.approx(np.trapezoid(value) / 3)
    np.testing.assert_allclose(result.slopes[:, 0], [2 / 3, 1])


# -- sensitivities ---------------------------------------------------------------------------------


def worst(tool: Tool, speed: Array) -> float:
    """The largest RMS of a_hv over the band, of the hands."""
    result = grips(respond_tool(tool, speed))
    wide = speed[-1] - speed[0]
    return max(float(np.sqrt(np.trapezoid(grip.a_hv**2, speed) / wide)) for grip in result.values())


def shifted(tool: Tool, station: str, key: str, by: float) -> Tool:
    """The tool with a number larger, of a pair both by as much."""
    first = tool.station(station)
    *path, last = key.split(".")
    owner: Any = getattr(first, path[0]) if path else first
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
    sensitivities = tool_sensitivities(tool, speed)
    assert list(sensitivities) == numbers_of(tool)
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
        assert sensitivities[station, key] == pytest.approx(wanted, rel=1e-6, abs=1e-9), key


def test_a_measured_hand() -> None:
    """Its table does not vary, but all else does."""
    table = Impedance((1.0, 30.0, 200.0), (40.0, 60.0, 90.0), (-90.0, 10.0, 80.0))
    tool = bare(
        Station("a", 0.0, mass=2.0),
        Station("grip", 0.5, mass=0.3, hand=Hand(impedance=(table,), hands=2)),
        Station("b", 1.2, stiffness=both(3e3)),
    )
    tool = shaken(tool, Excitation("e", "a", unbalance=1e-3))
    for key in ("mass", "position"):
        numbers = [("grip", key)]
        felt = SpeedBand(tool, SPEEDS).felt(numbers, values_of(tool, numbers), ["grip"])

        def of(value: float, key: str = key) -> Array:
            response = respond_tool(changed(tool, "grip", key, value), SPEEDS)
            force = response.forces("grip")["hand"]
            return np.array(
                [grips(response)["grip"].a_hv ** 2, np.sum(np.abs(force) ** 2, axis=(0, 1)) / 2]
            )

        wanted = slope(of, number_of(tool, "grip", key), 1e-3, range(-3, 4))
        for item, other in zip((felt.hands["grip"], felt.forces["grip"]), wanted, strict=True):
            np.testing.assert_allclose(item.slopes[0], other, rtol=1e-6)
