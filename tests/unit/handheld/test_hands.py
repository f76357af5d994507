"""A hand known by a table: between its rows, and where it ends."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from equipoise.errors import ModelError
from equipoise.handheld.layout import check_coverage, impedance
from equipoise.handheld.model import Excitation, Hand, Impedance, Station, Tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.transmission import transmit
from unit.handheld.samples import bare, both

TABLE = Impedance((10.0, 20.0, 50.0), (60.0, 80.0, 50.0), (-130.0, -20.0, 40.0))
OTHER = Impedance((5.0, 100.0), (10.0, 200.0), (0.0, 95.0))


def at(*hertz: float) -> np.ndarray:
    return 2j * pi * np.array([hertz])


def held(*tables: Impedance, name: str = "") -> Tool:
    """Make a tool whose second station is a measured hand."""
    grip = Station("grip", 0.5, hand=Hand(impedance=tuple(replace(t, file=name) for t in tables)))
    tool = bare(Station("a", 0.0, mass=1.0), grip)
    return replace(tool, excitations=(Excitation("e", "a", unbalance=1e-3),))


def test_rows_and_between_them() -> None:
    """Real and imaginary part on straight lines."""
    found = impedance((TABLE,), at(10.0, 12.5, 20.0, 35.0, 50.0))
    wanted = [60 - 130j, 65 - 102.5j, 80 - 20j, 65 + 10j, 50 + 40j]
    np.testing.assert_allclose(found, [wanted, wanted], rtol=1e-13)


def test_a_table_for_each_plane() -> None:
    found = impedance((TABLE, OTHER), at(20.0, 24.0))
    np.testing.assert_allclose(found[0], [80 - 20j, 76 - 12j], rtol=1e-13)
    np.testing.assert_allclose(found[1], [40 + 15j, 48 + 19j], rtol=1e-13)
    planes = np.array([at(20.0)[0], at(24.0)[0]])
    np.testing.assert_allclose(impedance((TABLE, OTHER), planes)[:, 0], [80 - 20j, 48 + 19j])


def test_a_mass_a_spring_and_a_damper_as_a_table() -> None:
    """Z = c + i (w m - k / w) is a straight line in w but for k; then the force is Z v."""
    hertz = (10.0, 40.0, 80.0)
    table = Impedance(hertz, (30.0,) * 3, tuple(2 * pi * f * 0.4 for f in hertz))
    station = Station("grip", 0.5, hand=Hand(impedance=(table,), hands=2))
    source = Station("a", 0.0, mass=1.0)
    cause = (Excitation("e", "a", unbalance=1e-3),)
    measured = replace(bare(source, station), excitations=cause)
    known = replace(
        bare(source, Station("grip", 0.5, hand=Hand(0.4, both(0.0), both(30.0), hands=2))),
        excitations=cause,
    )
    speeds = 2 * pi * np.array([10.0, 33.0, 80.0])
    one, other = (respond_tool(tool, speeds) for tool in (measured, known))
    for name in ("a", "grip"):
        np.testing.assert_allclose(one.displacement(name), other.displacement(name), rtol=1e-11)
    np.testing.assert_allclose(one.forces("grip")["hand"], other.forces("grip")["hand"], rtol=1e-11)
    np.testing.assert_allclose(one.power("grip")["hand"], other.power("grip")["hand"], rtol=1e-9)


@pytest.mark.parametrize("ends", [(10.0, 50.0), (12.0, 13.0), (10.0 * (1 - 1e-10), 30.0)])
def test_covered(ends: tuple[float, float]) -> None:
    """Up to both ends, rounding included."""
    check_coverage(held(TABLE), 2 * pi * ends[0], 2 * pi * ends[1])


@pytest.mark.parametrize("ends", [(9.0, 20.0), (20.0, 51.0), (1.0, 99.0)])
def test_not_covered(ends: tuple[float, float]) -> None:
    """The sentence names the station, the table, its ends and what was asked for."""
    low, high = ends
    with pytest.raises(ModelError) as error:
        check_coverage(held(TABLE, name="hand.csv"), 2 * pi * low, 2 * pi * high)
    sentence = str(error.value)
    assert sentence.startswith("shaft.stations[2].hand.impedance: the table hand.csv reaches from ")
    assert "from 10 Hz to 50 Hz" in sentence
    assert f"but {low:.4g} Hz to {high:.4g} Hz are asked for" in sentence
    assert "measure the rest too, or ask for speeds whose orders lie within the table" in sentence


def test_each_table_must_cover() -> None:
    check_coverage(held(OTHER), 2 * pi * 6, 2 * pi * 90)
    with pytest.raises(ModelError, match="from 10 Hz to 50 Hz"):
        check_coverage(held(OTHER, TABLE), 2 * pi * 6, 2 * pi * 40)
    with pytest.raises(ModelError, match="the table reaches from 5 Hz to 100 Hz"):
        check_coverage(held(OTHER), 2 * pi * 6, 2 * pi * 101)


def test_orders_of_the_speed_must_lie_within() -> None:
    """Not only the speed itself: half an order below, and two above."""
    tool = held(TABLE)
    for ratio, speed in ((0.5, 15.0), (2.0, 30.0)):
        both_of = (*tool.excitations, Excitation("f", "a", force=1.0, ratio=ratio))
        other = replace(tool, excitations=both_of)
        respond_tool(tool, 2 * pi * speed)
        with pytest.raises(ModelError, match="from 10 Hz to 50 Hz"):
            respond_tool(other, 2 * pi * speed)
        transmit(other, 2 * pi * np.array([speed]))
    with pytest.raises(ModelError, match="from 10 Hz to 50 Hz"):
        transmit(tool, 2 * pi * np.array([20.0, 60.0]))
