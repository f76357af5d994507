"""Forced vibration: closed forms of a rigid shaft, and figures against signals in time."""

from __future__ import annotations

from dataclasses import replace
from math import cos, cosh, pi, sin, sinh, sqrt
from typing import Any

import numpy as np
import pytest

from equipoise.errors import ModelError, ResponseError, UsageError
from equipoise.handheld.chain import NodePair, States
from equipoise.handheld.frequencies import natural_frequencies
from equipoise.handheld.model import Absorber, Excitation, Hand, Harness, Station, Tool
from equipoise.handheld.response import ToolResponse, _check_finite, respond_tool
from equipoise.handheld.shaft import Section, Shaft
from equipoise.handheld.sweep import speeds_between, sweep_tool
from support.conformance import compared
from support.refusals import refused
from support.sources import CLOSED_FORMS
from unit.handheld.samples import THEORIES, bare, both, random_tool, shaken

RIGID = Section(1e9, 2.0)
PLAIN = Section(1000.0, 2.0)
LENGTH = 1.5
SPEEDS = np.array([40.0, 150.0, 900.0])


# -- a rigid shaft ---------------------------------------------------------------------------------
# EI / L^3 is 1e5 times the springs and m w^2 L: 1e-6 of what a rigid shaft does and more near its
# resonance; 1e-4 is held.


def rigid() -> tuple[Tool, float]:
    """Make a rigid shaft whose springs and masses are all in its middle, so that it only heaves."""
    middle = Station(
        "middle",
        LENGTH / 2,
        mass=1.0,
        stiffness=both(500.0),
        damping=both(6.0),
        hand=Hand(0.4, both(900.0), both(20.0), hands=2),
        harness=Harness(both(300.0), both(9.0)),
    )
    tool = bare(middle, section=RIGID)
    return shaken(tool, Excitation("e", "middle", force=10.0, phase=0.3)), 3.0 + 1.0 + 0.8


def test_one_mass_on_springs_and_dampers() -> None:
    """10 N over k + c s + m s^2, and the force on each spring with its damper by itself."""
    tool, mass = rigid()
    response = respond_tool(tool, SPEEDS)
    s = 1j * SPEEDS
    moved = 10 * np.exp(0.3j) / (2600 + 55 * s + mass * s**2)
    np.testing.assert_allclose(response.displacement("middle")[0, 0], moved, rtol=1e-4)
    np.testing.assert_allclose(response.velocity("middle")[0, 0], moved * s, rtol=1e-4)
    np.testing.assert_allclose(response.acceleration("middle")[0, 0], moved * s**2, rtol=1e-4)
    assert np.all(response.displacement("middle")[1] == 0)
    forces = response.forces("middle")
    wanted = {
        "ground": 500 + 6 * s,
        "harness": 300 + 9 * s,
        "hand": 2 * (900 + 20 * s + 0.4 * s**2),
    }
    assert set(forces) == set(wanted)
    for part, stiffness in wanted.items():
        np.testing.assert_allclose(forces[part][0, 0], stiffness * moved, rtol=1e-4)


@compared(
    CLOSED_FORMS, "displacement, slope, moment under a force at its end", 1e-4, "free rigid shaft"
)
def test_a_free_rigid_shaft_under_a_force_at_its_end() -> None:
    """It heaves by F / (m s^2) and turns by F L / 2 / (I s^2), I = m L^2 / 12."""
    tool = bare(Station("end", 0.0), section=RIGID)
    response = respond_tool(shaken(tool, Excitation("e", "end", force=1.0)), 20.0)
    s2 = -400.0
    x = np.array([0.0, 0.4, 1.5])
    turning = -(LENGTH / 2) / (3.0 * LENGTH**2 / 12 * s2)
    wanted = 1 / (3.0 * s2) + turning * (x - LENGTH / 2)
    line = response.line(x)
    np.testing.assert_allclose(line.displacement[:, 0, 0, 0], wanted, rtol=1e-4)
    np.testing.assert_allclose(line.slope[:, 0, 0, 0], turning, rtol=1e-4)
    # The force drives what is right of x: V' = m s^2 w from -F at the left end.
    shear = -1 + 2.0 * s2 * (x * (1 / (3.0 * s2) - turning * LENGTH / 2) + turning * x**2 / 2)
    np.testing.assert_allclose(line.shear[:, 0, 0, 0], shear, atol=1e-4)


@compared(
    CLOSED_FORMS,
    "receptances of Bishop and Johnson at and across its ends",
    1e-09,
    "free elastic shaft",
)
def test_a_force_at_the_end_of_an_elastic_free_shaft() -> None:
    """Bishop and Johnson's receptances of a free beam: at its end and across it.

    alpha = F5 / (EI b^3 F3) there, F8 / (EI b^3 F3) at the other end, with b^4 = m w^2 / EI,
    F3 = cos cosh - 1, F5 = cos sinh - sin cosh and F8 = sin - sinh of b L.
    """
    tool = bare(Station("a", 0.0), Station("b", LENGTH), section=PLAIN)
    response = respond_tool(shaken(tool, Excitation("e", "a", force=1.0)), SPEEDS)
    for k, w in enumerate(SPEEDS):
        b = (2.0 * w**2 / 1000) ** 0.25
        x = b * LENGTH
        divisor = 1000 * b**3 * (cos(x) * cosh(x) - 1)
        here = -(cos(x) * sinh(x) - sin(x) * cosh(x)) / divisor
        there = (sin(x) - sinh(x)) / divisor
        assert response.displacement("a")[0, 0, k] == pytest.approx(here, rel=1e-9)
        assert response.displacement("b")[0, 0, k] == pytest.approx(there, rel=1e-9)


def test_an_absorber_takes_the_motion_of_its_station_away() -> None:
    """At its own frequency, but for what its damper takes."""
    own = 200.0
    station = Station("a", 0.6, absorber=Absorber(0.2, both(0.2 * own**2), both(1e-6)))
    tool = shaken(bare(station), Excitation("e", "a", force=5.0))
    result = respond_tool(tool, np.array([own, 0.9 * own]))
    still, beside = np.abs(result.displacement("a")[0, 0])
    assert still < 1e-6 * beside
    # What is fed in all goes into its damper.
    response = respond_tool(tool, own)
    assert response.power("a")["absorber"][0, 0] == pytest.approx(float(response.fed_in[0, 0]))


# -- ends, jumps and places ------------------------------------------------------------------------


def full_response(theory: str = "timoshenko") -> ToolResponse:
    return respond_tool(random_tool(3, theory), np.array([300.0, 700.0]))


@pytest.mark.parametrize("theory", THEORIES)
def test_places_of_stations(theory: str) -> None:
    response = full_response(theory)
    for station in response.tool.stations:
        line = response.line([station.position])
        wanted = response.displacement(station.name)
        np.testing.assert_allclose(line.displacement[0], wanted, atol=1e-12 * np.max(abs(wanted)))


def test_free_ends_carry_nothing() -> None:
    tool = bare(Station("a", 0.5), section=PLAIN)
    line = respond_tool(shaken(tool, Excitation("e", "a", force=1.0)), 300.0).line(
        [0.0, LENGTH, 0.5]
    )
    assert np.max(np.abs(line.shear[:2])) < 1e-10 * np.max(np.abs(line.shear))
    assert np.max(np.abs(line.moment[:2])) < 1e-10 * np.max(np.abs(line.moment))


def test_forces_that_are_not_there_are_not_reported() -> None:
    response = full_response()
    assert set(response.forces("front")) == {"hand"}
    assert set(response.forces("rear")) == {"hand", "harness"}
    assert set(response.forces("middle")) == {"ground"}
    assert response.forces("head") == {}
    assert set(response.power("middle")) == {"ground", "absorber"}
    assert set(response.power("engine")) == {"ground"}  # of its rotational damper


# -- what is asked for -----------------------------------------------------------------------------


def test_speeds_are_each_by_itself() -> None:
    tool = random_tool(1)
    whole = respond_tool(tool, SPEEDS)
    assert whole.frequency.shape == (len(whole.orders), 3)
    for k, speed in enumerate(SPEEDS):
        first = respond_tool(tool, float(speed))
        np.testing.assert_allclose(
            whole.displacement("rear")[..., k], first.displacement("rear")[..., 0], rtol=1e-10
        )
        assert first.speed == [speed]


@pytest.mark.parametrize("speed", [0.0, -3.0, np.nan, np.inf, [], [1.0, 0.0], [[1.0]]])
def test_speeds_that_cannot_be(speed: Any) -> None:
    with refused(UsageError, by="checked_speeds"):
        respond_tool(random_tool(1), speed)


def test_what_is_not_there() -> None:
    response = full_response()
    for call in (response.displacement, response.velocity, response.forces, response.power):
        with refused(ModelError, "stations", given="nobody"):
            call("nobody")
    for place in (-0.01, 99.0):
        with refused(UsageError, length=1.68645):
            response.line([0.1, place])
    with refused(ModelError, "excitations"):
        respond_tool(bare(), 10.0)


# -- a range of speeds -----------------------------------------------------------------------------


def test_root_mean_squares() -> None:
    """Against a signal in time over whole periods of all orders: speeds in tenths.

    All orders are tenths of the speed, so that 10 turns are a period of all.
    """
    tool = random_tool(2, "timoshenko")
    swept = sweep_tool(tool, np.array([400.0, 650.0]))
    response = swept.required_response
    places = [0.2, 0.9]
    actual, line = swept.places(places), response.line(places)
    for k, speed in enumerate(swept.speed):
        angle = 2 * pi * 10 * np.arange(2000) / 2000
        turning = np.exp(1j * np.multiply.outer(response.orders, angle))  # (K, T)
        w = response.frequency[:, k, None]
        for name, factor, part in (
            ("displacement", 1, line.displacement),
            ("velocity", 1j * w, line.displacement),
            ("acceleration", -(w**2), line.displacement),
            ("moment", 1, line.moment),
        ):
            signal = np.real(np.sum(part[..., k, None] * factor * turning, axis=2))  # (X, 2, T)
            wanted = np.sqrt(np.mean(np.sum(signal**2, axis=1), axis=1))
            np.testing.assert_allclose(getattr(actual, name)[:, k], wanted, rtol=1e-9)
        force = np.real(np.sum(response.forces("rear")["hand"][..., k, None] * turning, axis=1))
        wanted = sqrt(np.mean(np.sum(force**2, axis=0)))
        assert swept.force("rear")["hand"][k] == pytest.approx(wanted, rel=1e-9)
        assert speed in (400, 650)


def test_largest_moment() -> None:
    """Nowhere is there more: not between the places that are looked at, nor beside a station.

    3e-4: a peak between two of 201 places, and what jumps at a station within 1e-9 m of it.
    """
    tool = random_tool(4)
    swept = sweep_tool(tool, np.array([200.0, 500.0, 800.0]))
    moment, place = swept.largest_moment
    length = tool.shaft.length
    beside = [station.position + side for station in tool.stations for side in (-1e-9, 0.0, 1e-9)]
    places = np.clip([*np.linspace(0, length, 1501), *beside], 0, length)
    assert np.all(swept.places(places).moment <= moment * (1 + 3e-4))
    for k in range(3):
        assert swept.places([place[k]]).moment[0, k] == pytest.approx(moment[k], rel=1e-12)


def test_power_over_a_range() -> None:
    swept = sweep_tool(random_tool(4), np.array([200.0, 500.0]))
    whole = swept.required_response.power("rear")
    for part, power in swept.power("rear").items():
        np.testing.assert_allclose(power, np.sum(whole[part], axis=0))


def test_columns_are_the_values() -> None:
    tool = random_tool(1)
    swept = sweep_tool(tool, np.array([200.0, 500.0, 510.0]))
    columns = {name: (unit, values) for name, unit, values in swept.columns()}
    assert all(np.shape(values) == (3,) for _, values in columns.values())
    content = swept.to_dict()
    for name in ("engine", "front", "rear", "middle", "head"):
        station = content["stations"][name]
        for key, unit in (
            ("displacement", "m"),
            ("velocity", "m/s"),
            ("acceleration", "m/s^2"),
            ("moment", "N m"),
        ):
            assert columns[f"{name}.{key}"][0] == unit
            np.testing.assert_array_equal(columns[f"{name}.{key}"][1], station[key])
        for part, force in station["forces"].items():
            np.testing.assert_array_equal(columns[f"{name}.force_{part}"][1], force)
        for part, power in station["power"].items():
            np.testing.assert_array_equal(columns[f"{name}.power_{part}"][1], power)
    assert columns["rear.transmission_lateral"][0] == "1"


def test_nothing_to_sweep() -> None:
    with refused(ModelError, "shaft"):
        sweep_tool(bare(), SPEEDS)
    held = sweep_tool(bare(Station("a", 0.5, stiffness=both(9e3))), SPEEDS)
    assert held.response is None
    with refused(ModelError, "excitations"):
        held.places([0.1])
    free = sweep_tool(shaken(bare(Station("a", 0.5)), Excitation("e", "a", force=1.0)), SPEEDS)
    assert free.transmissions is None


def test_speeds_between() -> None:
    """Equally spaced ones, and more about each resonance of the loud orders, none outside."""
    tool = Tool(
        "loud",
        Shaft(LENGTH, PLAIN),
        (Station("a", 0.0, stiffness=both(2e3)), Station("b", 1.2, stiffness=both(2e3))),
        (Excitation("e", "a", force=1.0), Excitation("second", "b", force=0.5, ratio=2.0)),
    )
    low, high = 50.0, 400.0
    result = speeds_between(tool, low, high, 30)
    assert np.all((result >= low) & (result <= high)) and np.all(np.diff(result) > 0)
    assert set(np.linspace(low, high, 30)) <= set(result)
    natural = natural_frequencies(tool, 5)[0]
    resonances = [*natural, *(natural / 2)]
    inside = [item for item in resonances if low < item < high]
    assert len(inside) >= 3
    for resonance in inside:
        near = np.abs(result / resonance - 1)
        assert np.sum(near < 0.011) >= 4


# -- a resonance without damping -------------------------------------------------------------------


def test_beside_a_resonance_without_damping() -> None:
    """However near, the answer is finite, and the nearer the larger."""
    tool = bare(Station("a", 0.0, stiffness=both(400.0)))
    tool = shaken(tool, Excitation("push", "a", force=1.0))
    omega = float(natural_frequencies(tool, 3)[0, 2])
    sizes = [
        abs(respond_tool(tool, omega * (1 + beside)).displacement("a")[0, 0, 0])
        for beside in (1e-3, 1e-6, 1e-9)
    ]
    assert sizes[1] / sizes[0] == pytest.approx(1e3, rel=0.01)
    assert sizes[2] / sizes[1] == pytest.approx(1e3, rel=0.01)


def test_on_a_resonance_without_damping() -> None:
    """What is not finite is no answer; told with speed and order."""
    tool = bare(Station("a", 0.0, stiffness=both(400.0)))
    tool = shaken(tool, Excitation("push", "a", force=1.0, ratio=2.0))
    response = respond_tool(tool, np.array([100.0, 150.0]))
    motion = [NodePair(pair.across.copy(), pair.turning) for pair in response.field.states.motion]
    motion[0].across[0, 1] = np.inf
    field = replace(response.field, states=States(motion, response.field.states.force))
    with refused(ResponseError, orders=2.0, speeds=1432.39):
        _check_finite(field, response.orders, response.speed)
