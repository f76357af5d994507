"""Force on the body over the force that shakes: by finite elements, its zeros and its minima."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np
import pytest

from equipoise.errors import ModelError, UsageError
from equipoise.handheld.frequencies import natural_frequencies
from equipoise.handheld.model import Excitation, Hand, Harness, Station, Tool
from equipoise.handheld.shaft import Section, Shaft
from equipoise.handheld.sweep import source_of, transmit
from support.refusals import refused
from unit.handheld.samples import THEORIES, attached_of, bare, both, random_tool, reference, still

Array = np.ndarray[Any, Any]
KGF = 9.80665


def brush_cutter(damping: float = 0.0) -> Tool:
    """Make the machine of company K of Nagamine and Irie, section 3.3, from its printed numbers."""
    length, weight = 1.544, 3.56
    stations = (
        Station("engine", 0.0, mass=2.20 * weight),
        Station("belt", 0.166 * length, harness=Harness(both(47.4 * KGF * 100))),
        Station(
            "handle",
            0.266 * length,
            mass=0.416 * weight,
            hand=Hand(stiffness=both(51 * KGF * 100), damping=both(damping), hands=2),
        ),
        Station("cutter", length, mass=0.291 * weight),
    )
    shaft = Shaft(length, Section(100 * KGF, weight / length))
    return Tool("K", shaft, stations, (Excitation("e", "engine", force=100.0),))


SPEEDS = np.linspace(1000, 9000, 600) * pi / 30


@pytest.mark.parametrize("theory", THEORIES)
def test_all_that_holds_a_station_counts(theory: str) -> None:
    """Hand with its mass, harness and ground, in each plane under a force in that plane."""
    tool = random_tool(4, theory)
    speeds = np.array([150.0, 420.0, 900.0])
    transmission = transmit(tool, speeds, "head")
    for plane in range(2):
        elements = reference(tool, plane, 192).response(speeds, [(tool.shaft.length, 1.0, 0.0)])
        for station, attached in zip(tool.stations, attached_of(tool, plane), strict=True):
            if station.name not in transmission.stations:
                continue
            moved = elements.displacement([station.position])[:, 0]
            mass = station.hand.hands * station.hand.mass if station.hand else 0.0
            force = attached.stiffness + 1j * speeds * attached.damping - speeds**2 * mass
            ratio = transmission.stations[station.name].ratio[plane]
            np.testing.assert_allclose(ratio, force * moved, rtol=1e-6)
    assert set(transmission.stations) == {"front", "rear", "middle"}


def test_zeros_of_the_undamped_tool() -> None:
    """The ratio is real and changes its sign at resonances and at quiet speeds alone."""
    tool = brush_cutter()
    transmission = transmit(tool, SPEEDS)
    natural = natural_frequencies(tool, 12)[0]
    for station in transmission.stations.values():
        assert np.max(np.abs(station.ratio.imag)) == 0
        quiet = station.quiet[0][station.lowest[0] < 1e-5]
        sign = np.sign(station.ratio[0].real)
        turning = np.flatnonzero(sign[1:] != sign[:-1])
        expected = sorted(
            [w for w in natural if SPEEDS[0] < w < SPEEDS[-1]] + [float(w) for w in quiet]
        )
        assert len(turning) == len(expected)
        for k, place in zip(turning, expected, strict=True):
            assert SPEEDS[k] <= place <= SPEEDS[k + 1]
        assert quiet.size >= 1


def test_where_the_force_acts_there_is_one_zero_between_two_resonances() -> None:
    """Foster: zeros of what moves at the place of the force alternate with the poles."""
    tool = still(brush_cutter())
    speeds = np.linspace(5, 2500, 4000)
    (_, quiet) = _between(tool, speeds)
    natural = natural_frequencies(tool, 30)[0]
    inside = natural[(natural > speeds[0]) & (natural < speeds[-1])]
    for low, high in pairwise(inside):
        assert np.sum((quiet > low) & (quiet < high)) == 1


def _between(tool: Tool, speeds: Array) -> tuple[Array, Array]:
    first = transmit(tool, speeds, "handle").stations["handle"]
    return first.size, first.quiet[0][first.lowest[0] < 1e-3]


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("seed", [1, 5])
def test_quiet_speeds_are_minima(theory: str, seed: int) -> None:
    """Closer sampling finds nothing lower around them, and the curve rises to both sides."""
    tool = random_tool(seed, theory)
    speeds = np.linspace(100, 1500, 300)
    transmission = transmit(tool, speeds)
    step = speeds[1] - speeds[0]
    count = 0
    for name, value in transmission.stations.items():
        for plane in range(2):
            for quiet, lowest in zip(value.quiet[plane], value.lowest[plane], strict=True):
                near = quiet + step * np.linspace(-0.9, 0.9, 181)
                size = transmit(tool, near).stations[name].size[plane]
                assert np.min(size) >= lowest * (1 - 1e-9)
                assert size[0] > lowest and size[-1] > lowest
                at = transmit(tool, np.array([quiet])).stations[name].size[plane, 0]
                assert at == pytest.approx(lowest, rel=1e-6)
                count += 1
    assert count >= 4


def test_source() -> None:
    tool = brush_cutter()
    assert source_of(tool) == "engine"
    assert source_of(replace(tool, excitations=(Excitation("e", "cutter", force=1.0),))) == "cutter"
    assert source_of(replace(tool, excitations=())) == "engine"
    assert source_of(bare(Station("b", 1.0), Station("a", 0.2))) == "a"
    with refused(ModelError, "shaft.stations"):
        source_of(bare())


def test_what_shakes_does_not_matter() -> None:
    """It is under a unit force; the tool's own excitations only name the place."""
    tool = brush_cutter()
    other = replace(tool, excitations=(Excitation("e", "engine", unbalance=0.1, ratio=-3.0),))
    first, two = (transmit(each, SPEEDS[:5]).stations["handle"].ratio for each in (tool, other))
    np.testing.assert_array_equal(first, two)


def test_refusals() -> None:
    with refused(ModelError, "shaft.stations"):
        transmit(bare(Station("a", 0.5, mass=1.0)), SPEEDS)
    with refused(UsageError, by="checked_speeds"):
        transmit(brush_cutter(), np.array([-1.0]))
    with refused(ModelError, "stations", given="nobody"):
        transmit(brush_cutter(), SPEEDS, "nobody")


def test_as_plain_values() -> None:
    transmission = transmit(random_tool(2), SPEEDS[:50])
    content = transmission.to_dict()
    assert content["source"] == "engine"
    for name, value in transmission.stations.items():
        part = content["transmission"][name]
        np.testing.assert_array_equal(part["ratio"], np.abs(value.ratio[0]))
        np.testing.assert_array_equal(part["ratio_lateral"], np.abs(value.ratio[1]))
        np.testing.assert_array_equal(part["phase_lateral"], np.angle(value.ratio[1]))
        np.testing.assert_array_equal(part["quiet_speeds_lateral"], value.quiet[1])
