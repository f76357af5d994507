"""What hands get: against signals in time that are weighted, and days summed up by hand."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exposure.spectra import weigh_signal
from equipoise.exposure.weighting import weighting
from equipoise.handheld.exposed import expose_tool, grips, weighted_squares, working_speed
from equipoise.handheld.model import Excitation, Hand, Operation, Station, Tool, Work
from equipoise.handheld.response import ToolResponse, respond_tool
from unit.handheld.samples import THEORIES, bare, both, random_tool

Array = np.ndarray[Any, Any]
HOUR = 3600.0


def acceleration(response: ToolResponse, station: str, time: Array) -> Array:
    """Vertical and lateral (2, T), m/s2, at the first speed of a response."""
    amplitudes = response.acceleration(station)[..., 0]
    angles = np.multiply.outer(response.orders * response.speed[0], time)
    return np.real(np.einsum("pk,kt->pt", amplitudes, np.exp(1j * angles)))


def engine_and_blade() -> Tool:
    """Make a random tool that is shaken by a slider-crank besides."""
    tool = random_tool(1, "timoshenko")
    engine = Excitation("crank", "engine", linkage=eq.load("brush-cutter-engine"))
    return replace(tool, excitations=(engine, *tool.excitations))


@pytest.mark.parametrize("hertz", [40.0, 110.0])
def test_a_signal_of_whole_periods(hertz: float) -> None:
    """All orders are tenths, so that a second of a multiple of 10 Hz is whole periods of all.

    1e-9: nothing but rounding, where a record is exact.  Orders over 5 kHz are below 1e-6 of all.
    """
    time = np.arange(10000) / 10000
    response = respond_tool(engine_and_blade(), 2 * pi * hertz)
    for name, grip in grips(response).items():
        found = weigh_signal(time, acceleration(response, name, time), periodic=True)
        np.testing.assert_allclose(grip.a_hw[:, 0], found.a_hw, rtol=1e-9)
        assert grip.a_hv[0] == pytest.approx(found.a_hv, rel=1e-9)
        assert found.a_h is not None
        np.testing.assert_allclose(grip.acceleration[:, 0], found.a_h, rtol=1e-9)


def test_a_signal_as_it_is_measured() -> None:
    """Eight seconds at any speed, faded in and out: 0.1 % is what such a record reads to."""
    time = np.arange(80000) / 10000
    response = respond_tool(engine_and_blade(), 2 * pi * 87.3)
    for name, grip in grips(response).items():
        found = weigh_signal(time, acceleration(response, name, time))
        assert grip.a_hv[0] == pytest.approx(found.a_hv, rel=1e-3)


@pytest.mark.parametrize("theory", THEORIES)
def test_weighting_of_each_order(theory: str) -> None:
    """|Wh|^2 of the analog filters by s = i f, times half the square of the amplitude."""
    response = respond_tool(random_tool(2, theory), np.array([200.0, 700.0]))
    found = grips(response)["rear"]
    amplitude = response.acceleration("rear")
    passed = np.abs(weighting(response.frequency / (2 * pi)))
    wanted = np.sqrt(np.sum(np.abs(amplitude * passed) ** 2 / 2, axis=1))
    np.testing.assert_allclose(found.a_hw, wanted, rtol=1e-12)
    np.testing.assert_allclose(found.a_hv, np.hypot(*wanted), rtol=1e-12)


def test_squares_of_one_order() -> None:
    """At 16 Hz Wh is 0.896, as ISO 5349-1, Table A.2, has it; 1 mm is 10.1 m/s2 peak there."""
    w = 2 * pi * 10**1.2
    found = weighted_squares(np.array(w), np.array(1e-3j))
    assert np.real(found) == pytest.approx((0.896 * w**2 * 1e-3) ** 2 / 2, rel=1e-3)


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
    found = expose_tool(tool, np.array([400.0, 600.0]))
    a8 = {
        name: sqrt(sum(a_hv(tool, w.speed, name) ** 2 * w.duration for w in work) / (8 * HOUR))
        for name in ("front", "rear")
    }
    for name, wanted in a8.items():
        assert found.days[name].a8 == pytest.approx(wanted, rel=1e-12)
    assert a8["front"] != pytest.approx(a8["rear"], rel=1e-3)
    assert found.worst == max(a8, key=lambda name: a8[name])
    assert found.a8 == pytest.approx(max(a8.values()))


def test_a_duration_in_the_place_of_the_day() -> None:
    """So long at the working speed, whatever the file tells of work."""
    tool = worked(Work("mow", 300.0, 2 * HOUR))
    found = expose_tool(tool, np.array([400.0]), 4 * HOUR)
    for name in ("front", "rear"):
        wanted = a_hv(tool, 600.0, name) * sqrt(0.5)
        assert found.days[name].a8 == pytest.approx(wanted, rel=1e-12)


def test_idling_and_racing() -> None:
    """ISO 22867: the root of the mean of both squares, of each hand."""
    tool = worked(idling=290.0, racing=950.0)
    found = expose_tool(tool, np.array([400.0]))
    assert list(found.named) == ["working", "idling", "racing"]
    for name in ("front", "rear"):
        low, high = (a_hv(tool, speed, name) for speed in (290.0, 950.0))
        assert found.equivalents[name] == pytest.approx(sqrt((low**2 + high**2) / 2), rel=1e-12)
        assert found.named["idling"][name].a_hv[0] == pytest.approx(low, rel=1e-12)
    only = expose_tool(worked(idling=290.0), np.array([400.0]))
    assert only.equivalents == {}
    assert list(only.named) == ["working", "idling"]


def test_nothing_of_a_day() -> None:
    found = expose_tool(random_tool(3), np.array([400.0, 500.0]))
    assert (found.days, found.named, found.equivalents) == ({}, {}, {})
    assert found.worst is None and found.a8 is None


def test_over_the_range() -> None:
    """The hand that gets most at each speed by itself."""
    tool = random_tool(3)
    speeds = np.linspace(150, 900, 40)
    found = expose_tool(tool, speeds)
    each = np.array([grip.a_hv for grip in found.grips.values()])
    np.testing.assert_array_equal(found.a_hv, np.max(each, axis=0))
    assert len(set(np.argmax(each, axis=0))) == 2
    np.testing.assert_array_equal(found.speed, speeds)
    told = found.to_dict()
    for name, grip in found.grips.items():
        np.testing.assert_array_equal(told["hands"][name]["a_hw_lateral"], grip.a_hw[1])
        np.testing.assert_array_equal(
            told["hands"][name]["acceleration_vertical"], grip.acceleration[0]
        )
    assert told["a8"] is None


def test_two_hands_at_one_grip_are_told_once() -> None:
    station = Station("grip", 0.5, hand=Hand(0.1, both(5e3), both(50.0), hands=2))
    tool = replace(
        bare(Station("a", 0.0, mass=2.0), station),
        excitations=(Excitation("e", "a", unbalance=1e-3),),
    )
    assert list(expose_tool(tool, np.array([300.0])).grips) == ["grip"]


def test_refusals() -> None:
    no_hand = replace(bare(Station("a", 0.0)), excitations=(Excitation("e", "a", force=1.0),))
    with pytest.raises(ModelError, match="no hand holds the tool"):
        expose_tool(no_hand, np.array([300.0]))
    with pytest.raises(ModelError, match="nothing shakes the tool"):
        expose_tool(replace(random_tool(1), excitations=()), np.array([300.0]))
    with pytest.raises(ModelError, match=r"operation: missing; add the table \[operation\]"):
        expose_tool(random_tool(1), np.array([300.0]), HOUR)
    with pytest.raises(ModelError, match="operation"):
        working_speed(random_tool(1))
    assert working_speed(worked()) == 600.0
