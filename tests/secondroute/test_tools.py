"""Hand-held tools by finite elements: frequencies, eigenvalues, forced motion, forces and power.

The elements know nothing of transfer matrices; the tool is told to them by its pieces and by what
sits at each station.  192 elements, whose results are extrapolated from three meshes, are good to
1e-9 at the tenth mode, and to 4e-8 where shear counts and a resonance is near.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from math import pi
from typing import Any

import numpy as np
import pytest

from equipoise.handheld.frequencies import natural_frequencies
from equipoise.handheld.model import Hand, Impedance, Tool
from equipoise.handheld.modes import vibrate_tool
from equipoise.handheld.response import ToolResponse, respond_tool
from equipoise.handheld.shaft import Theory
from support.beam_reference import Response
from support.conformance import compared
from support.sources import FINITE_ELEMENTS
from unit.handheld.samples import THEORIES, attached_of, random_tool, reference, still

Array = np.ndarray[Any, Any]
SPEEDS = np.array([170.0, 455.0, 820.0])
SUBJECTS = [(theory, seed) for theory in THEORIES for seed in (11, 12)]
subjects = pytest.mark.parametrize(("theory", "seed"), SUBJECTS)
planes = pytest.mark.parametrize("plane", [0, 1], ids=["vertical", "lateral"])


TOOLS = [f"tool {seed}, {theory}, both planes" for theory, seed in SUBJECTS]


@cache
def made(theory: Theory, seed: int) -> Tool:
    return random_tool(seed, theory)


@cache
def answered(theory: Theory, seed: int) -> ToolResponse:
    return respond_tool(made(theory, seed), SPEEDS)


@compared(FINITE_ELEMENTS, "ten natural frequencies", 1e-8, *TOOLS)
@subjects
@planes
def test_natural_frequencies(theory: Theory, seed: int, plane: int) -> None:
    tool = made(theory, seed)
    wanted = reference(tool, plane, 192).natural_frequencies(10)
    np.testing.assert_allclose(natural_frequencies(tool, 10)[plane], wanted, rtol=1e-8)


@pytest.mark.exhaustive(but=["vertical-timoshenko-11", "lateral-euler-bernoulli-11"])
@compared(FINITE_ELEMENTS, "eight eigenvalues with damping", 2e-9, *TOOLS)
@subjects
@planes
def test_eigenvalues(theory: Theory, seed: int, plane: int) -> None:
    """The first eight, and as many within the same radius."""
    tool = made(theory, seed)
    values = np.array([mode.eigenvalue for mode in vibrate_tool(tool, 10).planes[plane].damped])
    values = values[values.imag != 0]
    wanted = reference(tool, plane, 192).eigenvalues(8)
    np.testing.assert_allclose(values[:8], wanted, rtol=2e-9)


@compared(FINITE_ELEMENTS, "six eigenvalues with heavy damping", 1e-7, *TOOLS[::2])
@pytest.mark.parametrize("theory", THEORIES)
def test_eigenvalues_of_heavy_damping(theory: Theory) -> None:
    """Hands and belt ten times as hard to move as any are."""
    tool = made(theory, 11)
    stations = tuple(
        replace(
            station,
            damping=(12 * station.damping[0], 9 * station.damping[1]),
            hand=station.hand and replace(station.hand, damping=(600.0, 900.0)),
            harness=station.harness and replace(station.harness, damping=(400.0, 300.0)),
        )
        for station in tool.stations
    )
    heavy = replace(tool, stations=stations)
    reported = vibrate_tool(heavy, 10)
    for plane in range(2):
        values = np.array([mode.eigenvalue for mode in reported.planes[plane].damped])
        values = values[values.imag != 0]
        wanted = reference(heavy, plane, 192).eigenvalues(6)
        np.testing.assert_allclose(values[:6], wanted, rtol=1e-7)
        assert np.max(-values.real / np.abs(values)) > 0.3


def elements(result: ToolResponse, plane: int) -> Iterator[tuple[int, int, Response]]:
    """Order, speed and what finite elements answer to all that shakes in a plane at that order."""
    tool = result.tool
    subject = reference(tool, plane, 192)
    for k, order in enumerate(result.orders):
        for i, speed in enumerate(result.speed):
            forces = [
                (tool.station(shake.station).position, shake.at(np.array([speed]))[plane, 0], 0.0)
                for shake in result.shakes
                if shake.order == order and shake.force[plane] != 0
            ]
            yield k, i, subject.response([order * speed], forces)


def close(result: Array, wanted: Array, tolerance: float = 1e-7) -> None:
    """Beside the largest of those wanted."""
    np.testing.assert_allclose(result, wanted, rtol=0, atol=tolerance * np.max(np.abs(wanted)))


@pytest.mark.exhaustive(but=["vertical-euler-bernoulli-11", "lateral-timoshenko-11"])
@compared(FINITE_ELEMENTS, "displacement, slope, bending moment", 1e-7, *TOOLS)
@subjects
@planes
def test_motion_and_moment_anywhere(theory: Theory, seed: int, plane: int) -> None:
    """Displacement, slope of the section and bending moment, just right of where it jumps."""
    result = answered(theory, seed)
    tool = result.tool
    stations = [station.position for station in tool.stations[:-1]]
    places = np.array([*stations, *(tool.shaft.length * np.array([0.03, 0.37, 0.58, 0.77, 0.97]))])
    line = result.line(places)
    for k, i, exact in elements(result, plane):
        close(line.displacement[:, plane, k, i], exact.displacement(places)[0])
        close(line.slope[:, plane, k, i], exact.slope(places)[0])
        close(line.moment[:, plane, k, i], exact.bending_moment(places, "right")[0])
        ends = [station.position for station in tool.stations]
        moved = np.array(
            [result.displacement(station.name)[plane, k, i] for station in tool.stations]
        )
        close(moved, exact.displacement(ends)[0])


@compared(FINITE_ELEMENTS, "forces on ground and body", 1e-7, *TOOLS)
@subjects
@planes
def test_forces_on_the_ground_and_the_body(theory: Theory, seed: int, plane: int) -> None:
    """Of all springs and dampers of a station; what its hands weigh is left out."""
    result = answered(theory, seed)
    for k, i, exact in elements(result, plane):
        ground = exact.ground_force()[0]
        texts = []
        for station in result.tool.stations:
            forces = result.forces(station.name)
            total = sum(force[plane, k, i] for force in forces.values())
            if station.hand is not None:
                mass = station.hand.hands * station.hand.mass
                total -= mass * result.acceleration(station.name)[plane, k, i]
            texts.append(total)
        close(np.array(texts), ground)


@compared(FINITE_ELEMENTS, "power fed in and lost", 2e-7, *TOOLS)
@subjects
def test_power(theory: Theory, seed: int) -> None:
    """What is fed in, what the shaft's material takes, and what each damper takes; both planes."""
    result = answered(theory, seed)
    shape = result.frequency.shape
    fed_in, shaft = np.zeros(shape), np.zeros(shape)
    names = [station.name for station in result.tool.stations]
    dampers, absorbers = (np.zeros((len(names), *shape)) for _ in range(2))
    for plane in range(2):
        for k, i, exact in elements(result, plane):
            if not np.any(exact.displacement([0.0])):
                continue  # nothing shakes in this plane at this order
            power = exact.power()
            fed_in[k, i] += power["fed_in"][0]
            shaft[k, i] += power["shaft"][0]
            dampers[:, k, i] += power["damper"][0] + power["rotational_damper"][0]
            absorbers[:, k, i] += power["absorber"][0]
    np.testing.assert_allclose(result.fed_in, fed_in, rtol=2e-7)
    np.testing.assert_allclose(result.lost_in_shaft, shaft, rtol=2e-7)
    for name, by_dampers, by_absorber in zip(names, dampers, absorbers, strict=True):
        reported = result.power(name)
        absorbed = reported.pop("absorber", np.zeros(shape))
        np.testing.assert_allclose(sum(reported.values(), np.zeros(shape)), by_dampers, rtol=2e-7)
        np.testing.assert_allclose(absorbed, by_absorber, rtol=2e-7)


def test_these_tools_differ_in_their_planes() -> None:
    """Else half of what is above would prove nothing."""
    for theory, seed in SUBJECTS:
        tool = made(theory, seed)
        first, second = (attached_of(tool, plane) for plane in range(2))
        assert first != second
        assert not tool.alike
        assert len(tool.shaft.pieces) == 4
        frequency = natural_frequencies(still(tool), 4)
        assert np.all(np.abs(frequency[0] / frequency[1] - 1) > 1e-4)


# -- a hand by its table ---------------------------------------------------------------------------


def measured(tool: Tool, rows: int) -> Tool:
    """The tool with its hands told by tables from 10 to 300 Hz: c + i (w m - k / w)."""
    hertz = np.linspace(10, 300, rows)
    w = 2 * pi * hertz
    stations = []
    for station in tool.stations:
        hand = station.hand
        if hand is not None:
            tables = tuple(
                Impedance(
                    tuple(hertz.tolist()),
                    (hand.damping[plane],) * rows,
                    tuple((w * hand.mass - hand.stiffness[plane] / w).tolist()),
                )
                for plane in range(2)
            )
            station = replace(station, hand=Hand(impedance=tables, hands=hand.hands))  # noqa: PLW2901
        stations.append(station)
    return replace(tool, stations=tuple(stations))


@pytest.mark.parametrize("theory", THEORIES)
def test_a_hand_by_its_table(theory: Theory) -> None:
    """As the mass, spring and damper from which the table comes.

    Straight lines between rows h Hz apart miss k / w by h^2 / 8 of its curvature k / (pi f^3): in
    20 kN/m at 16 Hz, where the slowest order is, 1e-3 h^2 of 300 N s/m.  With half of h a quarter
    of that is left.
    """
    tool = made(theory, 12)
    wanted = answered(theory, 12)
    away = []
    for rows in (1451, 2901, 5801):
        response = respond_tool(measured(tool, rows), SPEEDS)
        for name in ("front", "rear"):
            first, other = (each.forces(name)["hand"] for each in (response, wanted))
            close(first, other, 1e-3 * (290 / (rows - 1)) ** 2)
        moved, still_wanted = (each.displacement("front") for each in (response, wanted))
        away.append(np.max(np.abs(moved - still_wanted)))
    assert away[0] / away[1] == pytest.approx(4, rel=0.5)
    assert away[1] / away[2] == pytest.approx(4, rel=0.5)
