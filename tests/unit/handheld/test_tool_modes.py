"""Shapes, their nodes and their names: closed forms, and the finite elements' own."""

from __future__ import annotations

from math import cos, cosh, pi, sin, sinh, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.model import Absorber, Hand, Impedance, Station, Tool
from equipoise.handheld.modes import PlaneModes, _notes, vibrate_tool
from equipoise.handheld.shaft import Section
from support.sentences import notes_by
from unit.handheld.samples import HARD, THEORIES, bare, both, clamp, random_tool, reference, still

Array = np.ndarray[Any, Any]
PLAIN = Section(1000.0, 2.0)
LENGTH = 1.5


def free_shape(root: float, x: Array) -> Array:
    """Of a free beam, x from 0 to 1: cosh + cos less a share of sinh + sin, 1 at its ends."""
    share = (cosh(root) - cos(root)) / (sinh(root) - sin(root))
    rx = root * x
    return (np.cosh(rx) + np.cos(rx) - share * (np.sinh(rx) + np.sin(rx))) / 2


ROOTS = {2: 4.730040744862704, 3: 7.853204624095838, 4: 10.99560783800167}


@pytest.mark.parametrize("mode", ROOTS)
def test_shape_and_nodes_of_a_free_beam(mode: int) -> None:
    """1e-6: a load shakes 1e-9 beside the resonance, and other modes answer by 1e-8 of it.

    Nodes are zeros of the closed form; a cubic through places L / 400 apart is good to 1e-8 of L.
    """
    vibration = vibrate_tool(bare(section=PLAIN), 5)
    shape, root = vibration.planes[0].shapes[mode], ROOTS[mode]
    wanted = free_shape(root, vibration.places / LENGTH)
    np.testing.assert_allclose(np.sign(shape[0]) * shape, wanted, atol=1e-6)
    assert np.max(np.abs(shape)) == 1
    x = np.linspace(0, 1, 200)
    rising = np.flatnonzero(np.diff(np.sign(free_shape(root, x))))
    zeros = [brentq(lambda at: float(free_shape(root, at)), x[k], x[k + 1]) for k in rising]
    assert len(zeros) == mode
    assert vibration.planes[0].nodes[mode] / LENGTH == pytest.approx(zeros, abs=5e-8)


def test_nodes_are_where_the_shape_is_nothing() -> None:
    """Between any two neighbours it has one sign, and the line through them is at 0 there."""
    vibration = vibrate_tool(still(random_tool(2, "timoshenko")), 7)
    for plane in vibration.planes:
        for shape, nodes in zip(plane.shapes, plane.nodes, strict=True):
            assert np.interp(nodes, vibration.places, shape) == pytest.approx(0, abs=1e-3)
            signs = np.signbit(shape[np.searchsorted(nodes, vibration.places) % 2 == 0])
            assert np.all(signs == signs[0])


def test_a_node_near_an_end() -> None:
    """A free beam with a heavy left end: its node is all but there."""
    tool = bare(Station("heavy", 0.0, mass=3e4), section=PLAIN)
    nodes = vibrate_tool(tool, 3).planes[0].nodes[2]
    assert len(nodes) == 2
    assert 0 < nodes[0] < 2e-3


def elements_shape(tool: Tool, plane: int, mode: int, places: Array) -> Array:
    """Of finite elements, by what their answer a little above a resonance is more than below.

    Other modes answer alike on both sides, but for 3e-5 squared.
    """
    elements = reference(tool, plane, 192)
    frequency = elements.natural_frequencies(mode + 1)[mode] * np.array([1 + 3e-5, 1 - 3e-5])
    length = tool.shaft.length
    loads = [(0.123 * length, 1.0, 0.2), (length, 0.4, 0.03)]
    above, below = elements.response(frequency, loads).displacement(places)
    assert np.max(np.abs((above - below).imag)) == 0
    return np.asarray(_scaled((above - below).real))


def _scaled(shape: Array) -> Array:
    return np.asarray(shape / shape[np.argmax(np.abs(shape))])


@pytest.mark.exhaustive(but=["euler-bernoulli"])
@pytest.mark.parametrize("theory", THEORIES)
def test_shapes_of_finite_elements(theory: str) -> None:
    """2e-5: other modes by 3e-5 squared, some thousand times as loud, and the elements' error."""
    tool = still(random_tool(3, theory))
    vibration = vibrate_tool(tool, 6)
    few = np.arange(0, len(vibration.places), 20)
    for number, plane in enumerate(vibration.planes):
        for mode in (1, 3, 5):
            wanted = elements_shape(tool, number, mode, vibration.places[few])
            np.testing.assert_allclose(_scaled(plane.shapes[mode][few]), wanted, atol=2e-5)


def test_damped_shapes_are_shapes_of_free_motion() -> None:
    """Between stations EI (1 + i eta) w'''' = -rho A s^2 w: fourth differences of the shape.

    Five places 2.5 cm apart: their error is h^2 w''''''/6, some 1e-3 of it at these modes.
    """
    tool = bare(
        Station("a", 0.0, mass=1.0, stiffness=both(3e3), damping=both(40.0)),
        Station("b", 1.0, rotational_damping=both(2.0), stiffness=both(1e3)),
        section=PLAIN,
        loss_factor=0.05,
    )
    vibration = vibrate_tool(tool, 5)
    apart = 7
    step = vibration.places[apart]
    for mode in vibration.planes[0].damped:
        w = mode.shape[20 : 20 + 4 * apart + 1 : apart]
        fourth = np.array([1, -4, 6, -4, 1]) @ w / step**4
        wanted = -2.0 * mode.eigenvalue**2 / (1000 * (1 + 0.05j)) * w[2]
        if abs(mode.eigenvalue) > 100:
            assert fourth == pytest.approx(wanted, rel=3e-2)
        assert np.max(np.abs(mode.shape)) == pytest.approx(1, rel=1e-12)


def test_damped_shape_of_hysteresis_alone_is_that_without() -> None:
    """EI (1 + i eta) everywhere leaves the shapes as they are, and real."""
    still_found, actual = (vibrate_tool(bare(section=PLAIN, loss_factor=e), 4) for e in (0.0, 0.1))
    for k, mode in enumerate(actual.planes[0].damped):
        wanted = still_found.planes[0].shapes[2 + k]
        np.testing.assert_allclose(np.abs(mode.shape), np.abs(wanted), atol=1e-6)
        assert np.max(np.abs(mode.shape.imag)) < 1e-6


def test_without_damping_both_report_the_same() -> None:
    planes = vibrate_tool(still(random_tool(1)), 6).planes[1]
    for frequency, shape, mode in zip(planes.frequency, planes.shapes, planes.damped, strict=True):
        assert mode.eigenvalue == pytest.approx(1j * frequency)
        assert mode.damping_ratio == pytest.approx(0, abs=1e-12)
        np.testing.assert_allclose(np.abs(mode.shape), np.abs(shape), atol=1e-6)


# -- rigid motions ---------------------------------------------------------------------------------


def test_rigid_shapes() -> None:
    free = vibrate_tool(bare(), 3).planes[0]
    x = np.linspace(0, 1, 401)
    assert free.rigid == ("moves to and fro", "turns about its left end")
    np.testing.assert_allclose(free.shapes[0], np.ones(401))
    np.testing.assert_allclose(free.shapes[1], x, atol=1e-15)
    alike = vibrate_tool(bare(Station("a", 0.5, stiffness=both(9.0))), 1)
    assert alike.alike and alike.planes[0] is alike.planes[1]
    (turning,) = alike.planes[0].shapes
    np.testing.assert_allclose(turning, (LENGTH * x - 0.5), atol=1e-12)
    unlike = vibrate_tool(bare(Station("a", 0.5, stiffness=(9.0, 0.0))), 4)
    assert not unlike.alike
    assert [plane.rigid for plane in unlike.planes] == [("turns about 0.5 m",), free.rigid]


def test_an_absorber_that_floats() -> None:
    """Nothing holds its mass, and the shaft is at rest; it is told by its station."""
    station = Station("a", 0.5, absorber=Absorber(0.3, (0.0, 2e4)))
    planes = vibrate_tool(bare(station, section=PLAIN), 4).planes
    assert planes[0].rigid == (
        "moves to and fro",
        "turns about its left end",
        "absorber at a floats",
    )
    assert np.count_nonzero(planes[0].frequency == 0) == 3
    assert np.all(planes[0].shapes[2] == 0)
    assert planes[0].parameter[3] == pytest.approx(4.730040745, rel=1e-8)
    assert len(planes[1].rigid) == np.count_nonzero(planes[1].frequency == 0) == 2


def test_parameter() -> None:
    """lambda = (m omega^2 L^3 / EI)^(1/4) with the mass of the shaft."""
    planes = vibrate_tool(bare(section=PLAIN), 3).planes[0]
    assert planes.parameter == pytest.approx([0, 0, 4.730040745], rel=1e-8)
    omega = planes.frequency[2]
    assert planes.parameter[2] ** 4 == pytest.approx(3.0 * omega**2 * 1.5**3 / 1000)
    assert planes.cycles_per_second[2] == pytest.approx(omega / (2 * pi))


# -- what lies together ----------------------------------------------------------------------------


def momentum(tool: Tool, places: Array, item: Array, other: Array) -> float:
    """Of one shape in another: all masses that move with the shaft, no inertia."""
    total = 2.0 * float(np.trapezoid(item * other, places))
    for station in tool.stations:
        mass = station.mass + (station.hand.hands * station.hand.mass if station.hand else 0.0)
        at = int(np.argmin(np.abs(places - station.position)))
        total += mass * float(item[at] * other[at])
    return total


@pytest.mark.parametrize("hand", [None, Hand(2.0, hands=2)], ids=["no hand", "hand"])
def test_two_modes_at_one_frequency_share_no_momentum(hand: Hand | None) -> None:
    """The halves of a shaft that is held in its middle, each with 4 kg at its end.

    Trapezia between 401 places: 1e-4 of the momentum.
    """
    left = Station("left", 0.0, mass=4.0) if hand is None else Station("left", 0.0, hand=hand)
    right = Station("right", LENGTH, mass=4.0)
    tool = bare(left, right, clamp("vice", LENGTH / 2), section=PLAIN)
    vibration = vibrate_tool(tool, 4)
    plane = vibration.planes[0]
    for k in (0, 2):
        assert plane.frequency[k + 1] / plane.frequency[k] - 1 < 1e-8
        first, other = plane.shapes[k : k + 2]
        shared = momentum(tool, vibration.places, first, other)
        own = momentum(tool, vibration.places, first, first) * momentum(
            tool, vibration.places, other, other
        )
        assert abs(shared) < 1e-3 * sqrt(own)


def test_absorbers_that_swing_against_each_other_leave_the_shaft_at_rest() -> None:
    """Two equal ones at one place: nothing moves the shaft at their own frequency."""
    pair = [Station(name, 0.5, absorber=Absorber(0.3, both(2e4))) for name in "ab"]
    planes = vibrate_tool(bare(*pair), 6).planes[0]
    own = int(np.argmin(np.abs(planes.frequency - sqrt(2e4 / 0.3))))
    assert planes.frequency[own] == pytest.approx(sqrt(2e4 / 0.3), rel=1e-9)
    assert np.max(np.abs(planes.shapes[own])) < 1e-6


# -- the whole -------------------------------------------------------------------------------------


def test_notes() -> None:
    table = Impedance((1.0, 100.0), (10.0, 30.0), (-5.0, 5.0))
    measured = bare(Station("grip", 0.5, hand=Hand(impedance=(table,))))
    (note,) = vibrate_tool(measured, 3).notes
    assert notes_by(_notes, [note], name="grip")
    assert vibrate_tool(random_tool(1), 3).notes == ()


def test_as_plain_values() -> None:
    vibration = vibrate_tool(random_tool(4), 4)
    content = vibration.to_dict()
    for name, plane in zip(("vertical", "lateral"), vibration.planes, strict=True):
        part = content["planes"][name]
        np.testing.assert_array_equal(part["natural_frequencies"], plane.frequency / (2 * pi))
        np.testing.assert_array_equal(part["shapes"], plane.shapes)
        assert part["rigid"] == list(plane.rigid)
        assert [mode["eigenvalue"] for mode in part["damped"]] == [
            [mode.eigenvalue.real, mode.eigenvalue.imag] for mode in plane.damped
        ]
    np.testing.assert_array_equal(
        content["natural_frequencies"], content["planes"]["vertical"]["natural_frequencies"]
    )


@pytest.mark.parametrize("number", [1, 2, 3])
def test_few_modes(number: int) -> None:
    """Rigid ones alone, too; with damping all are told up to between this and the next."""
    plane: PlaneModes = vibrate_tool(bare(section=PLAIN), number).planes[0]
    assert len(plane.frequency) == len(plane.shapes) == len(plane.nodes) == number
    assert len(plane.damped) == max(0, number - 2)


def test_held_ends_stand_still() -> None:
    """Pins of 1e15 N/m: a sine, with no false nodes at its ends but for what rounding makes."""
    ends = [Station(n, x, stiffness=both(HARD)) for n, x in (("a", 0.0), ("b", LENGTH))]
    vibration = vibrate_tool(bare(*ends, section=PLAIN), 3)
    for k, shape in enumerate(vibration.planes[0].shapes, 1):
        wanted = np.sin(k * pi * vibration.places / LENGTH)
        np.testing.assert_allclose(np.abs(shape), np.abs(wanted), atol=1e-4)  # of the 401 places
        nodes = vibration.planes[0].nodes[k - 1]
        inner = nodes[(nodes > 1e-6) & (nodes < LENGTH - 1e-6)]
        assert inner == pytest.approx(LENGTH * np.arange(1, k) / k, abs=1e-7)
    assert scale_of(vibration.tool) > 0
