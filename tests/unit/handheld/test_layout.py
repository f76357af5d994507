"""The chain of a tool: nodes, what sits there, and hands by their impedance."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

from equipoise.errors import ModelError
from equipoise.handheld.chain import carry, log_determinant, longest
from equipoise.handheld.layout import Layout, check_coverage, impedance
from equipoise.handheld.model import (
    Absorber,
    Excitation,
    Hand,
    Impedance,
    Station,
    Tool,
    changed,
    number_of,
)
from equipoise.handheld.response import respond_tool
from equipoise.handheld.shaft import Segment
from equipoise.handheld.sweep import speeds_between, transmit
from support.refusals import refused
from unit.handheld.samples import (
    FULL,
    SECTION,
    THEORIES,
    bare,
    both,
    pieces_of,
    random_tool,
    shaken,
    still,
)

Array = np.ndarray[Any, Any]


def lengths(layout: Layout) -> Array:
    return np.array([cell.length for cell in layout.cells])


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("highest", [1.0, 3e3, 1e5])
def test_cells_cover_the_shaft(theory: str, highest: float) -> None:
    """End to end, each of the section that is there and none longer than it may be."""
    tool = random_tool(1, theory)
    layout = Layout(tool, highest)
    starts = np.array([cell.start for cell in layout.cells])
    np.testing.assert_allclose(starts + lengths(layout), [*starts[1:], tool.shaft.length])
    assert starts[0] == 0
    assert len(layout.nodes) == len(layout.cells) + 1
    borders = np.cumsum([piece.length for piece in pieces_of(tool)])
    for cell, length in zip(layout.cells, lengths(layout), strict=True):
        piece = pieces_of(tool)[int(np.searchsorted(borders, cell.start + length / 2))]
        section = cell.section
        assert section.bending_stiffness == pytest.approx(piece.bending_stiffness, rel=1e-14)
        assert section.mass_per_length == pytest.approx(piece.mass_per_length, rel=1e-14)
        assert section.shear_stiffness == pytest.approx(piece.shear_stiffness, rel=1e-14)
        assert section.rotary_inertia == pytest.approx(piece.rotary_inertia, rel=1e-14)
        most = longest(
            highest,
            1 / piece.bending_stiffness,
            1 / piece.shear_stiffness,
            piece.mass_per_length,
            piece.rotary_inertia,
        )
        assert length <= most * (1 + 1e-12)


@pytest.mark.parametrize("highest", [1.0, 1e4])
def test_stations_sit_at_their_places(highest: float) -> None:
    tool = random_tool(2)
    layout = Layout(tool, highest)
    ends = [0.0, *np.cumsum(lengths(layout))]
    for station in tool.stations:
        assert ends[layout.node_of[station.name]] == pytest.approx(station.position, abs=1e-14)
    assert layout.node_of["engine"] == 0
    assert layout.node_of["head"] == len(layout.cells)


def test_stations_at_one_place_share_a_node() -> None:
    tool = bare(Station("a", 0.6), Station("b", 0.2), Station("c", 0.6))
    layout = Layout(tool, 1.0)
    assert [[item.name for item in node] for node in layout.nodes] == [[], ["b"], ["a", "c"], []]


def test_a_border_on_which_nothing_sits_is_a_node() -> None:
    tool = bare(segments=(Segment(0.3, 0.9, SECTION),))
    assert lengths(Layout(tool, 1.0)) == pytest.approx([0.3, 0.6, 0.6])


def test_a_place_that_varies_at_an_end_or_border_can_go_inward() -> None:
    """A segment without length is kept there."""
    tool = bare(
        Station("left", 0.0),
        Station("border", 0.5),
        Station("right", 1.5),
        segments=(Segment(0.5, 1.0, SECTION),),
    )
    names = ("left", "border", "right")
    layout = Layout(
        tool, 1.0, {(station.name, "position"): station.position for station in tool.stations}
    )
    assert lengths(layout) == pytest.approx([0, 0.5, 0, 0.5, 0.5, 0])
    assert [layout.node_of[name] for name in names] == [1, 2, 5]


S = np.array([[3j, -20 + 100j, 400j]])


def absorber(s: Array, plane: int) -> Array:
    """Force over displacement of the shaft, from both equations of a mass behind a spring."""
    mass, stiffness, damping = 0.2, (3e3, 4e3)[plane], (1.5, 2.5)[plane]
    link = stiffness + damping * s
    actual = []
    for item, at in zip(link, s, strict=True):
        matrix = np.array([[item, -item], [-item, item + mass * at**2]])
        actual.append(1 / np.linalg.inv(matrix)[0, 0])
    return np.array(actual)


def across(s: Array, plane: int) -> Array:
    springs = 300 + 200 * plane + 2 * (900 - 100 * plane) + 110 + 10 * plane
    dampers = 4 + plane + 2 * (30 - 10 * plane) + 13 + plane
    return springs + dampers * s + (0.7 + 2 * 0.3) * s**2 + absorber(s, plane)


def turning(s: Array, plane: int) -> Array:
    return 60 + 10 * plane + (0.8 + 0.1 * plane) * s + 0.01 * (1 + plane) * s**2


def test_stiffness_of_a_station() -> None:
    layout = Layout(bare(FULL), 1e3)
    station = layout.chain(S).stations[layout.node_of["full"]]
    for plane in range(2):
        np.testing.assert_allclose(station.across[plane], across(S[0], plane), rtol=1e-13)
        np.testing.assert_allclose(station.turning[plane], turning(S[0], plane), rtol=1e-13)
    assert layout.mass_at(FULL) == pytest.approx(1.3)


def test_two_stations_at_one_place_add_up() -> None:
    other = Station("other", 0.4, mass=0.1, stiffness=(7.0, 8.0))
    layout = Layout(bare(FULL, other), 1e3)
    station = layout.chain(S).stations[layout.node_of["full"]]
    for plane in range(2):
        wanted = across(S[0], plane) + 7 + plane + 0.1 * S[0] ** 2
        np.testing.assert_allclose(station.across[plane], wanted, rtol=1e-13)


def test_what_holds_a_station() -> None:
    layout = Layout(bare(FULL), 1e3)
    held = layout.holding(FULL, S)
    assert set(held) == {"ground", "harness", "hand"}
    np.testing.assert_allclose(held["ground"], [300 + 4 * S[0], 500 + 5 * S[0]])
    np.testing.assert_allclose(held["harness"], [110 + 13 * S[0], 120 + 14 * S[0]])
    np.testing.assert_allclose(held["hand"], [1800 + 60 * S[0], 1600 + 40 * S[0]])


def test_without_damping_only_masses_and_springs_count() -> None:
    """All is real then, and the shaft has no loss."""
    tool = bare(FULL, loss_factor=0.1)
    s = np.array([[30j, 400j]])
    chain = Layout(tool, 1e3).chain(s, "undamped")
    wanted = Layout(still(tool), 1e3).chain(s)
    for station, other in zip(chain.stations, wanted.stations, strict=True):
        for part, plain in zip(station, other, strict=True):
            assert not np.iscomplexobj(part)
            np.testing.assert_allclose(part, plain, rtol=1e-13)
    for segment, plain_segment in zip(chain.segments, wanted.segments, strict=True):
        np.testing.assert_allclose(segment, plain_segment, rtol=1e-14)


def test_loss_makes_the_stiffness_complex() -> None:
    """EI and kGA both times 1 + i eta: without a load there is no difference but theirs."""
    layout = Layout(bare(loss_factor=0.2, theory="timoshenko"), 1.0)
    segments = layout.chain(np.array([[1e-3j]])).segments[0]
    length = 1.5
    assert segments.wm.ravel()[0] == pytest.approx(length**2 / 2 / 1000 / (1 + 0.2j), rel=1e-6)
    static = length / 2e5 / (1 + 0.2j) - length**3 / 6 / 1000 / (1 + 0.2j)
    assert segments.wv.ravel()[0] == pytest.approx(static, rel=1e-6)


def test_a_table_counts_at_real_frequencies_alone() -> None:
    table = Impedance((1.0, 100.0), (10.0, 30.0), (-5.0, 5.0))
    station = Station("grip", 0.4, hand=Hand(impedance=(table,), hands=2))
    layout = Layout(bare(station), 1e3)
    s = 2j * np.pi * np.array([[1.0, 50.5]])
    np.testing.assert_allclose(
        layout.holding(station, s)["hand"][1], 2 * s[0] * np.array([10 - 5j, 20 + 0j])
    )
    for kind in ("undamped", "free"):
        assert "hand" not in layout.holding(station, s, kind)


def test_an_absorber_without_damping_at_its_own_frequency_holds_still() -> None:
    """There its stiffness has a pole; the shaft is held by it, and all numbers stay finite."""
    station = Station("a", 0.4, absorber=Absorber(0.25, both(1e4)))
    layout = Layout(bare(station), 1e3)
    s = np.array([[200j]])
    assert np.all(np.abs(layout.chain(s, "undamped").stations[1].across) > 1e15)
    beside = layout.chain(s * (1 + 1e-9), "undamped").stations[1].across
    assert np.all(np.isfinite(beside))


@pytest.mark.parametrize("mass", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [(0.0, 0.0), (0.0, 1e4)])
def test_an_absorber_of_no_mass_or_no_spring_does_nothing(
    mass: float, stiffness: tuple[float, float]
) -> None:
    station = Station("a", 0.4, mass=1.0, absorber=Absorber(mass, stiffness))
    for kind in ("undamped", "free", "forced"):
        actual = Layout(bare(station), 1e3).chain(S[:, :1], kind).stations[1].across
        assert np.real(actual[0]).ravel() == pytest.approx(np.real(S[0, 0] ** 2))


@pytest.mark.parametrize("theory", THEORIES)
def test_numbers_that_stand_in_place_of_the_tool_s(theory: str) -> None:
    """As those of a tool that has them."""
    tool = random_tool(3, theory)
    numbers = {
        ("middle", "absorber.stiffness"): 7e4,
        ("middle", "position"): 0.71 * tool.shaft.length,
        ("front", "rotational_stiffness"): 111.0,
        ("rear", "harness.damping"): 22.0,
        ("head", "mass"): 0.9,
    }
    other = tool
    for (station, key), value in numbers.items():
        assert number_of(tool, station, key) != value
        other = changed(other, station, key, value)
    actual, wanted = (
        log_determinant(carry(layout.chain(S)))[0]
        for layout in (Layout(tool, 1e3, numbers), Layout(other, 1e3))
    )
    np.testing.assert_allclose(np.exp(actual - wanted), 1, rtol=1e-12)


def test_what_absorbers_are_divided_by() -> None:
    (actual,) = Layout(bare(FULL), 1e3).absorbers(S, "free")
    s = S[0]
    np.testing.assert_allclose(
        actual, [3e3 + 1.5 * s + 0.2 * s**2, 4e3 + 2.5 * s + 0.2 * s**2], rtol=1e-14
    )


TABLE = Impedance((10.0, 20.0, 50.0), (60.0, 80.0, 50.0), (-130.0, -20.0, 40.0))
OTHER = Impedance((5.0, 100.0), (10.0, 200.0), (0.0, 95.0))


def at(*hertz: float) -> np.ndarray:
    return 2j * pi * np.array([hertz])


def held(*tables: Impedance, name: str = "") -> Tool:
    """Make a tool whose second station is a measured hand."""
    grip = Station("grip", 0.5, hand=Hand(impedance=tuple(replace(t, file=name) for t in tables)))
    return shaken(bare(Station("a", 0.0, mass=1.0), grip), Excitation("e", "a", unbalance=1e-3))


def test_rows_and_between_them() -> None:
    """Real and imaginary part on straight lines."""
    result = impedance((TABLE,), at(10.0, 12.5, 20.0, 35.0, 50.0))
    wanted = [60 - 130j, 65 - 102.5j, 80 - 20j, 65 + 10j, 50 + 40j]
    np.testing.assert_allclose(result, [wanted, wanted], rtol=1e-13)


def test_a_table_for_each_plane() -> None:
    result = impedance((TABLE, OTHER), at(20.0, 24.0))
    np.testing.assert_allclose(result[0], [80 - 20j, 76 - 12j], rtol=1e-13)
    np.testing.assert_allclose(result[1], [40 + 15j, 48 + 19j], rtol=1e-13)
    planes = np.array([at(20.0)[0], at(24.0)[0]])
    np.testing.assert_allclose(impedance((TABLE, OTHER), planes)[:, 0], [80 - 20j, 48 + 19j])


@pytest.mark.parametrize(
    ("table", "low", "high"),
    [(TABLE, 10, 50), (TABLE, 12, 13), (TABLE, 10 * (1 - 1e-10), 30), (OTHER, 6, 90)],
)
def test_covered(table: Impedance, low: float, high: float) -> None:
    """Up to both ends, rounding included."""
    check_coverage(held(table), 2 * pi * low, 2 * pi * high)


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
    with refused(ModelError, "shaft.stations[2].hand.impedance", first=10.0, high=40.0):
        check_coverage(held(OTHER, TABLE), 2 * pi * 6, 2 * pi * 40)  # each of two


def test_orders_of_the_speed_must_lie_within() -> None:
    """Not only the speed itself: half an order below, and two above."""
    tool = held(TABLE)
    for ratio, speed in ((0.5, 15.0), (2.0, 30.0)):
        other = shaken(tool, *tool.excitations, Excitation("f", "a", force=1.0, ratio=ratio))
        respond_tool(tool, 2 * pi * speed)
        with refused(ModelError, "shaft.stations[2].hand.impedance", first=10.0, last=50.0):
            respond_tool(other, 2 * pi * speed)
        transmit(other, 2 * pi * np.array([speed]))
    with refused(ModelError, "shaft.stations[2].hand.impedance", first=10.0, high=60.0):
        transmit(tool, 2 * pi * np.array([20.0, 60.0]))


def test_what_shakes_too_fast_for_a_shaft_is_refused() -> None:
    """Before anything is computed, with how short the waves are; free vibration goes further up."""
    tool = bare(Station("a", 0.0, mass=1.0), Station("b", 1.0, stiffness=both(1e3)))
    highest = 1e3
    while len(Layout(tool, highest).cells) <= 110:
        highest *= 1.2
    tool = shaken(tool, Excitation("e", "a", force=1.0))
    for run in (respond_tool, lambda tool, speed: speeds_between(tool, 1.0, speed)):
        with refused(ModelError, "shaft", length=1.5):
            run(tool, highest)
    with refused(ModelError, "shaft", length=1.5):
        Layout(tool, 1e3 * highest).cells  # noqa: B018
