"""Changing a number of a station, frequencies against it, and the determinant's chart."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.errors import ModelError, UsageError
from equipoise.handheld.frequencies import natural_frequencies, scale_of
from equipoise.handheld.model import Hand, Impedance, Station, Tool, changed, number_of
from equipoise.handheld.modes import determinant_chart, vary_tool, without_damping
from equipoise.handheld.shaft import KEYS
from support.refusals import refused
from unit.handheld.samples import FULL, THEORIES, bare, both, random_tool, still


@pytest.mark.parametrize("key", KEYS)
def test_one_number_is_changed_and_nothing_else(key: str) -> None:
    tool = bare(FULL, Station("other", 1.0))
    result = changed(tool, "full", key, 0.37)
    assert number_of(result, "full", key) == 0.37
    owner, _, last = key.rpartition(".")
    before = getattr(FULL, owner) if owner else FULL
    after = getattr(result.station("full"), owner) if owner else result.station("full")
    value = getattr(after, last)
    assert value == (both(0.37) if isinstance(getattr(before, last), tuple) else 0.37)
    back = changed(result, "full", key, 1.0)
    assert number_of(back, "full", key) == 1.0
    for name in vars(after):
        if name != last:
            assert getattr(after, name) == getattr(before, name)
    assert result.station("other") == tool.station("other")
    assert result.shaft == tool.shaft


def test_a_number_of_a_pair_is_reported_of_the_vertical_plane() -> None:
    tool = bare(FULL)
    assert number_of(tool, "full", "stiffness") == 300
    assert number_of(tool, "full", "absorber.damping") == 1.5
    assert number_of(tool, "full", "harness.stiffness") == 110


def test_what_cannot_be_changed() -> None:
    tool = bare(Station("plain", 0.4), FULL)
    with refused(ModelError, "stations", given="nobody"):
        changed(tool, "nobody", "mass", 1.0)
    with refused(UsageError, given="colour"):
        changed(tool, "plain", "colour", 1.0)
    with refused(UsageError, key="absorber", name="plain"):
        changed(tool, "plain", "absorber.mass", 1.0)
    with refused(UsageError, key="harness", name="plain"):
        changed(tool, "plain", "harness.damping", 1.0)
    with refused(ModelError, "shaft.stations[1].position", length="1.5 m", position="7 m"):
        changed(tool, "plain", "position", 7.0)
    with refused(ModelError, "shaft.stations[1].mass", limit="0"):
        changed(tool, "plain", "mass", -1.0)


@pytest.mark.exhaustive(but=["position"])
@pytest.mark.parametrize("key", ["position", "absorber.stiffness"])
def test_frequencies_against_a_number(key: str) -> None:
    """Each as the changed tool has them, which finite elements prove in tests/secondroute."""
    tool, values = random_tool(3, "timoshenko"), [0.5, 0.7, 1.0]
    result = vary_tool(tool, "middle", key, np.array(values), 6)
    assert result.frequency.shape == result.parameter.shape == (2, len(values), 6)
    for k, value in enumerate(values):
        wanted = natural_frequencies(changed(tool, "middle", key, value), 6)
        np.testing.assert_array_equal(result.frequency[:, k], wanted)
    np.testing.assert_allclose(result.parameter**2 * scale_of(tool), result.frequency)
    content = result.to_dict()
    assert content["key"] == key
    np.testing.assert_array_equal(
        content["natural_frequencies_lateral"], result.frequency[1] / 2 / np.pi
    )
    np.testing.assert_array_equal(content["eigenvalues"], result.parameter[0])


# -- the determinant's chart -----------------------------------------------------------------------


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("seed", [1, 2])
def test_zeros_of_the_chart_are_the_natural_frequencies(theory: str, seed: int) -> None:
    """In each plane it changes its sign there and nowhere else, dampers or not."""
    tool = random_tool(seed, theory)
    highest = 12.0
    chart = determinant_chart(tool, highest, 4000)
    step = chart.parameter[1]
    assert chart.parameter[-1] == highest
    for plane in range(2):
        sign = np.sign(chart.value[plane])
        crossing = chart.parameter[:-1][sign[1:] != sign[:-1]]
        natural = np.sqrt(natural_frequencies(tool, 12)[plane] / scale_of(tool))
        wanted = natural[(natural > chart.parameter[0]) & (natural < highest)]
        assert len(crossing) == len(wanted) >= 4
        assert np.all((crossing <= wanted) & (wanted <= crossing + step))


def test_size_of_the_chart() -> None:
    """Its peaks are from log10 2 upward: 1 + the function over its smallest peak."""
    chart = determinant_chart(bare(Station("a", 0.3, stiffness=both(2e4))), 14.0, 3000)
    size = np.abs(chart.value[0])
    peaks = size[1:-1][(size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])]
    assert len(peaks) >= 2
    assert np.min(peaks) == pytest.approx(np.log10(2), rel=1e-9)


@pytest.mark.parametrize("highest", [0.0, -3.0, np.nan])
def test_no_chart(highest: float) -> None:
    with refused(UsageError, highest=str(highest)):
        determinant_chart(bare(), highest)


# -- without damping -------------------------------------------------------------------------------


@pytest.mark.parametrize("theory", THEORIES)
def test_without_damping(theory: str) -> None:
    tool = random_tool(5, theory)
    result: Tool = without_damping(tool)
    assert result == still(tool)
    assert tool.damped and not result.damped


def test_a_measured_hand_is_left_out() -> None:
    table = Impedance((1.0, 100.0), (10.0, 30.0), (-5.0, 5.0))
    tool = bare(Station("grip", 0.5, mass=1.0, hand=Hand(impedance=(table,))))
    assert without_damping(tool).station("grip").hand is None
    assert without_damping(tool).station("grip").mass == 1.0
