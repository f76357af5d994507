"""Natural frequencies: printed roots, limits, and what a search by sign changes would miss."""

from __future__ import annotations

from math import cos, cosh, pi, sqrt
from typing import Any

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.handheld.frequencies import (
    frequencies_below,
    natural_frequencies,
    rigid_modes,
    scale_of,
)
from equipoise.handheld.model import Absorber, Hand, Harness, Impedance, Station, Tool
from equipoise.handheld.modes import rigid_names
from equipoise.handheld.shaft import Section, Segment, Shaft, Tube
from support.conformance import Printed, published
from support.refusals import refused
from support.sources import BEAMS
from unit.handheld.samples import HARD, THEORIES, bare, both, clamp, random_tool, still

Array = np.ndarray[Any, Any]
PLAIN = Section(1000.0, 2.0)
MASS, LENGTH = 3.0, 1.5
"""Of the bare shaft."""


def ends(stiffness: float) -> list[Station]:
    """Springs under both ends."""
    return [Station(n, x, stiffness=both(stiffness)) for n, x in (("a", 0.0), ("b", LENGTH))]


def lambdas(tool: Tool, number: int) -> Array:
    """lambda L of the vertical plane."""
    return np.sqrt(natural_frequencies(tool, number)[0] / scale_of(tool))


# -- printed roots ---------------------------------------------------------------------------------
# Ten digits are printed; a clamp of springs gives way by EI beta^3 / k, some 1e-9 of a root.  Where
# the right end is free, frequencies of the whole with that end held and with it free come within
# exp (-lambda), and the count is good to about half of the digits: 2e-9 is the most that was seen.
CLOSE = 2e-9


FREE = [0, 0, 4.730040745, 7.853204624, 10.99560784]
CANTILEVER = [1.875104069, 4.694091133, 7.854757438]
PRINTED: dict[str, tuple[list[Station], list[float], float]] = {
    "free": ([], FREE, CLOSE),
    "free, fortieth": ([], [*[None] * 41, 81 * pi / 2], CLOSE),
    "tip of its own mass": (
        [clamp("wall", 0.0), Station("tip", LENGTH, mass=MASS)],
        [1.247917410, 4.031139437, 7.134132241],
        1e-8,
    ),
    "masses at both ends, own and a quarter": (
        [Station("heavy", 0.0, mass=MASS), Station("light", LENGTH, mass=MASS / 4)],
        [0, 0, 3.609420191, 6.582521910, 9.644130420],
        CLOSE,
    ),
    "clamped-free": ([clamp("a", 0.0)], CANTILEVER, 1e-8),
    "clamped-clamped": ([clamp("a", 0.0), clamp("b", LENGTH)], FREE[2:], 1e-8),
    "clamped-pinned": (
        [clamp("a", 0.0), Station("b", LENGTH, stiffness=both(HARD))],
        [3.926602312, 7.068582746, 10.21017612],
        1e-8,
    ),
    "clamped in its middle": (
        [clamp("vice", LENGTH / 2)],
        [2 * root for root in CANTILEVER for _ in range(2)],
        1e-8,
    ),
    **{
        f"pins of {stiffness:g} N/m": (ends(stiffness), [pi, 2 * pi, 3 * pi, 4 * pi], 1e-7)
        for stiffness in (1e12, HARD, 1e20)
    },
}
EQUATIONS = {
    "free": "cos x cosh x = 1",
    "free, fortieth": "81 pi / 2 but for 1e-50",
    "clamped-free": "cos x cosh x = -1",
    "clamped-clamped": "cos x cosh x = 1",
    "clamped-pinned": "tan x = tanh x",
    "pins": "sin x = 0",
}


@published(
    BEAMS,
    *(
        Printed(
            name, f"root {k + 1}", EQUATIONS.get(name.split(" of ")[0], ""), f"{root:.10g}",
            within=close * root or 1e-12, of=(stations, k),
        )
        for name, (stations, wanted, close) in PRINTED.items()
        for k, root in enumerate(wanted)
        if root is not None
    ),
)  # fmt: skip
def test_printed_roots(row: Printed) -> float:
    stations, k = row.of
    return float(lambdas(bare(*stations, section=PLAIN), k + 1)[k])


def test_roots_of_the_free_beam_meet_their_equation() -> None:
    """cos x cosh x = 1; with cosh x as divisor its slope is 1 there."""
    for x in lambdas(bare(section=PLAIN), 20)[2:]:
        assert abs(cos(x) - 1 / cosh(x)) < CLOSE * x


def test_shear_and_rotary_inertia_of_a_pinned_beam() -> None:
    """Its shapes are sines, and omega^2 a root of Timoshenko's frequency equation.

    (rho I rho A / kGA EI) w^4 - (rho A + (rho I + rho A EI / kGA) (n pi / L)^2) w^2 / EI
    + (n pi / L)^4 = 0, the lower of its roots; all upper ones lie far above.
    """
    section = Section(1000.0, 2.0, 4e4, 3e-3)
    frequencies = natural_frequencies(bare(*ends(HARD), section=section, theory="timoshenko"), 6)[0]
    ei, m, shear, rotary = 1000.0, 2.0, 4e4, 3e-3
    for n, frequency in enumerate(frequencies, 1):
        x = (n * pi / LENGTH) ** 2
        square, linear = rotary * m / shear / ei, (m + (rotary + m * ei / shear) * x) / ei
        lower = 2 * x**2 / (linear + sqrt(linear**2 - 4 * square * x**2))
        assert frequency == pytest.approx(sqrt(lower), rel=1e-8)


def test_a_rod_of_steel() -> None:
    """A tube without bore: EI / rho A = E d^2 / (16 rho)."""
    rod = Tube(0.02, 0.0, 206e9, 7850.0)
    frequencies = natural_frequencies(Tool("rod", Shaft(0.8, rod)), 3)[0, 2]
    wave = sqrt(206e9 / 7850)
    assert frequencies == pytest.approx(4.730040745**2 * wave * 0.02 / 4 / 0.8**2, rel=1e-9)


# -- what lies together ----------------------------------------------------------------------------


def test_clamped_almost_in_its_middle() -> None:
    """1e-9 of the length aside the pairs are 4e-9 apart, and both of each are found."""
    result = lambdas(bare(clamp("vice", LENGTH / 2 * (1 + 1e-9)), section=PLAIN), 2)
    assert result[0] < result[1]
    assert result[1] / result[0] - 1 == pytest.approx(2e-9, rel=0.5)


def test_two_equal_absorbers_at_one_place() -> None:
    """One of the motions leaves the shaft at rest: it is at their own frequency, exactly."""
    pair = [Station(name, 0.5, absorber=Absorber(0.3, both(2e4))) for name in "ab"]
    first = Station("a", 0.5, absorber=Absorber(0.6, both(4e4)))
    twice = natural_frequencies(bare(*pair), 8)[0]
    once = natural_frequencies(bare(first), 7)[0]
    own = sqrt(2e4 / 0.3)
    at = int(np.argmin(np.abs(twice - own)))
    assert twice[at] == pytest.approx(own, rel=1e-13)
    assert np.delete(twice, at) == pytest.approx(once, rel=CLOSE)


@pytest.mark.parametrize("apart", [1e-9, 1e-6])
def test_two_absorbers_almost_equal(apart: float) -> None:
    """One motion is between both of their own frequencies, half of `apart` above the lower."""
    springs = (2e4, 2e4 * (1 + apart))
    pair = [
        Station(name, 0.5, absorber=Absorber(0.3, both(spring)))
        for name, spring in zip("ab", springs, strict=True)
    ]
    frequencies = natural_frequencies(bare(*pair), 8)[0]
    low, high = (sqrt(spring / 0.3) for spring in springs)
    between = frequencies[(frequencies >= low) & (frequencies <= high)]
    assert between.size == 1
    assert between[0] / low - 1 == pytest.approx(apart / 4, rel=0.01, abs=1e-15)


def test_two_heavy_absorbers_on_a_shaft_that_hardly_moves() -> None:
    """On a clamp both swing as on a wall, at one frequency; those of the shaft stay."""
    stations = [
        Station(name, 0.0, absorber=Absorber(0.3, both(2e4)), **extra)
        for name, extra in (
            ("a", {"stiffness": both(HARD), "rotational_stiffness": both(HARD)}),
            ("b", {}),
        )
    ]
    frequencies = natural_frequencies(bare(*stations, section=PLAIN), 4)[0]
    shaft = natural_frequencies(bare(clamp("a", 0.0), section=PLAIN), 2)[0]
    wanted = sorted([*shaft, sqrt(2e4 / 0.3), sqrt(2e4 / 0.3)])
    assert frequencies == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize("theory", THEORIES)
def test_stations_a_nanometre_apart(theory: str) -> None:
    """As at one place, but for the nanometre, over which they hold the slope by 1e-12 N m/rad."""
    rng = np.random.default_rng(4)
    parts = [
        {"mass": rng.uniform(0, 1), "stiffness": both(rng.uniform(1, 1e6)), "inertia": both(0.01)}
        for _ in range(4)
    ]
    near = [Station(str(k), 0.4 + 1e-9 * k, **part) for k, part in enumerate(parts)]
    same = [Station(str(k), 0.4, **part) for k, part in enumerate(parts)]
    actual, wanted = (natural_frequencies(bare(*item, theory=theory), 10) for item in (near, same))
    np.testing.assert_allclose(actual, wanted, rtol=2e-8, atol=1e-5)
    assert np.any(actual != wanted)


def test_clamped_by_two_pins_a_nanometre_apart() -> None:
    """They hold the slope too, with k d^2 / 2 = 1e5 times the stiffness of the shaft."""
    pins = [Station(str(k), 2e-9 * k, stiffness=both(5e25)) for k in range(2)]
    result = lambdas(bare(*pins, section=PLAIN), 3)
    assert result == pytest.approx([1.875104069, 4.694091133, 7.854757438], rel=1e-4)


# -- soft and stiff springs ------------------------------------------------------------------------


@pytest.mark.parametrize("stiffness", [1e-3, 1.0, 1e3, 1e6])
def test_springs_under_a_rigid_shaft(stiffness: float) -> None:
    """With EI 1e7 times theirs two equal springs at the ends: sqrt(2 k / m) and sqrt(6 k / m).

    The shaft bends by some 1e-2 k L^3 / EI.
    """
    section = Section(1e7 * stiffness, 2.0)
    frequencies = natural_frequencies(bare(*ends(stiffness), section=section), 2)[0]
    wanted = [sqrt(2 * stiffness / MASS), sqrt(6 * stiffness / MASS)]
    assert frequencies == pytest.approx(wanted, rel=1e-7)


@pytest.mark.parametrize("stiffness", [1e-8, 1e-6, 1e-3])
def test_a_very_soft_spring_still_holds(stiffness: float) -> None:
    """sqrt(k / m) in the middle of the bare shaft, however low: it is no rigid motion."""
    tool = bare(Station("thread", LENGTH / 2, stiffness=both(stiffness)), section=PLAIN)
    frequencies = natural_frequencies(tool, 3)[0]
    assert frequencies[0] == 0
    assert frequencies[1] == pytest.approx(sqrt(stiffness / MASS), rel=1e-6)
    assert len(rigid_modes(tool)[0]) == 1


def test_soft_and_stiff_together() -> None:
    """A pin at the left end and a soft spring at the right one: sqrt(3 k / m), and nothing at 0."""
    tool = bare(
        Station("pin", 0.0, stiffness=both(HARD)),
        Station("soft", LENGTH, stiffness=both(0.01)),
        section=PLAIN,
    )
    frequencies = natural_frequencies(tool, 1)[0, 0]
    assert frequencies == pytest.approx(sqrt(3 * 0.01 / MASS), rel=1e-5)
    assert [len(free) for free in rigid_modes(tool)] == [0, 0]


# -- absorbers -------------------------------------------------------------------------------------


def test_an_absorber_splits_the_mode_to_which_it_is_tuned() -> None:
    """A frequency on either side of the absorber's own; without it there is one, at that place."""
    plain = bare(clamp("wall", 0.0), section=PLAIN)
    first = natural_frequencies(plain, 1)[0, 0]
    tuned = Station("tip", LENGTH, absorber=Absorber(0.05, both(0.05 * first**2)))
    low, high = natural_frequencies(bare(*plain.stations, tuned, section=PLAIN), 2)[0]
    assert low < first < high
    assert high < 1.3 * first


def test_an_absorber_on_a_rigid_free_shaft() -> None:
    """Two masses that a spring joins, the shaft one of them: sqrt(k (1 / m + 1 / M))."""
    section = Section(1e12, 2.0)
    tool = bare(Station("a", LENGTH / 2, absorber=Absorber(0.5, both(800.0))), section=section)
    frequencies = natural_frequencies(tool, 3)[0]
    assert frequencies[:2].tolist() == [0, 0]
    assert frequencies[2] == pytest.approx(sqrt(800 * (1 / 0.5 + 1 / MASS)), rel=1e-8)


# -- rigid motions ---------------------------------------------------------------------------------


FRO, LEFT = "moves to and fro", "turns about its left end"
SOFT = {"stiffness": both(30.0)}
TWIST = {"rotational_stiffness": both(30.0)}
MOTIONS: dict[str, tuple[list[Station], list[str]]] = {
    "nothing": ([], [FRO, LEFT]),
    "mass": ([Station("a", 0.3, mass=4.0)], [FRO, LEFT]),
    "spring inside": ([Station("a", 0.4, **SOFT)], ["turns about 0.4 m"]),
    "spring left": ([Station("a", 0.0, **SOFT)], ["turns about 0 m"]),
    "spring right": ([Station("a", 1.5, harness=Harness(both(30.0)))], ["turns about 1.5 m"]),
    "two springs at one place": (
        [Station("a", 0.4, **SOFT), Station("b", 0.4, hand=Hand(stiffness=both(50.0)))],
        ["turns about 0.4 m"],
    ),
    "turning": ([Station("a", 0.4, **TWIST)], [FRO]),
    "turning twice": ([Station("a", 0.1, **TWIST), Station("b", 1.0, **TWIST)], [FRO]),
    "spring and turning": ([Station("a", 0.4, **SOFT, **TWIST)], []),
    "two springs": ([Station("a", 0.4, **SOFT), Station("b", 1.1, **SOFT)], []),
    "hard and soft": ([Station("a", 0.0, stiffness=both(HARD)), Station("b", 1.1, **SOFT)], []),
    "hard and soft turning": ([Station("a", 0.0, stiffness=both(HARD), **TWIST)], []),
}


@pytest.mark.parametrize(("stations", "names"), MOTIONS.values(), ids=MOTIONS)
def test_rigid_motions(stations: list[Station], names: list[str]) -> None:
    """What no spring holds is told by name, and is 0 among the frequencies; nothing else is."""
    tool = bare(*stations)
    assert [list(rigid_names(free)) for free in rigid_modes(tool)] == [names, names]
    frequencies = natural_frequencies(tool, 4)[0]
    assert np.count_nonzero(frequencies == 0) == len(names)


def test_rigid_motions_of_each_plane() -> None:
    station = Station("a", 0.4, stiffness=(30.0, 0.0))
    vertical, lateral = rigid_modes(bare(station))
    assert [len(vertical), len(lateral)] == [1, 2]
    across, slope = vertical[0]
    assert across + slope * 0.4 == pytest.approx(0, abs=1e-15)
    frequencies = natural_frequencies(bare(station), 3)
    assert np.count_nonzero(frequencies == 0, axis=1).tolist() == [1, 2]


def test_a_measured_hand_does_not_hold() -> None:
    """Its table tells nothing of what is at rest, and is left out here."""
    table = Impedance((1.0, 100.0), (10.0, 30.0), (-5.0, 5.0))
    tool = bare(Station("a", 0.4, hand=Hand(impedance=(table,))))
    assert [len(free) for free in rigid_modes(tool)] == [2, 2]
    wanted = natural_frequencies(bare(Station("a", 0.4)), 5)
    np.testing.assert_array_equal(natural_frequencies(tool, 5), wanted)


def test_an_absorber_without_a_spring_floats() -> None:
    """Its mass stays at rest: one frequency of 0 more, and the others as without it."""
    station = Station("a", 0.4, mass=0.5, absorber=Absorber(0.3, (0.0, 2e4)))
    frequencies = natural_frequencies(bare(station), 6)
    plain = natural_frequencies(bare(Station("a", 0.4, mass=0.5)), 5)[0]
    assert frequencies[0, 0] == 0
    np.testing.assert_allclose(frequencies[0, 1:], plain, rtol=CLOSE)
    assert np.count_nonzero(frequencies == 0, axis=1).tolist() == [3, 2]


# -- what is asked for -----------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["euler-bernoulli"])
@pytest.mark.parametrize("theory", THEORIES)
def test_more_or_fewer_of_the_same(theory: str) -> None:
    """The first few are those of many, whatever the bracket from which they were closed in on."""
    tool = random_tool(5, theory)
    many = natural_frequencies(tool, 16)
    for number in (1, 2, 7):
        np.testing.assert_allclose(natural_frequencies(tool, number), many[:, :number], rtol=CLOSE)
    assert np.all(np.diff(many) >= 0)
    lowest = np.min(many[many > 0])
    for limit in ((many[0, 11] + many[0, 12]) / 2, 0.9 * lowest, 1.1 * lowest):
        for plane, actual in enumerate(frequencies_below(tool, float(limit))):
            wanted = many[plane][(many[plane] > 0) & (many[plane] < limit)]
            np.testing.assert_allclose(actual, wanted, rtol=CLOSE)


@pytest.mark.parametrize("number", [0, -1, 201])
def test_too_many(number: int) -> None:
    with refused(UsageError, number=number, most=200):
        natural_frequencies(bare(), number)


def test_damping_does_not_count() -> None:
    tool = random_tool(6)
    actual, wanted = natural_frequencies(tool, 6), natural_frequencies(still(tool), 6)
    np.testing.assert_allclose(actual, wanted, rtol=CLOSE)


def test_scale() -> None:
    """sqrt(EI / (m L^3)) with the profile's stiffness and the whole shaft's mass."""
    tool = bare(section=PLAIN, segments=(Segment(0.5, 1.0, Section(5.0, 6.0)),))
    assert scale_of(tool) == pytest.approx(sqrt(1000 / (5.0 * 1.5**3)))
