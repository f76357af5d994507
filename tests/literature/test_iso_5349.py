"""ISO 5349-1 and -2, Directive 2002/44/EC, ISO 22867 and the Japanese guideline: printed figures.

Sources:

[1] ISO 5349-1:2001, "Mechanical vibration - Measurement and evaluation of human exposure to
    hand-transmitted vibration - Part 1: General requirements": 4.4 and 5.3, Annex A, Annex C.
[2] ISO 5349-2:2001, the same, "Part 2: Practical guidance for measurement at the workplace": 8,
    Annex E.
[3] Directive 2002/44/EC of the European Parliament and of the Council of 25 June 2002, Article 3;
    read in the consolidated text of 26 July 2019 on eur-lex.europa.eu.
[4] Japanese Ministry of Health, Labour and Welfare, notifications Kihatsu 0710 No. 1, 2 and 3 of 10
    July 2009, on chain saws, on other vibrating tools, and on the figures that makers declare.
[5] ISO 22867, "Forestry and gardening machinery - Vibration test code for portable hand-held
    machines with internal combustion engine".
[6] Health and Safety Executive, "Hand-arm vibration at work" (L140), exposure points.

The standards themselves are not at hand.  Table A.2 of [1] is read in annex 3 of [4] No. 3, which
quotes it.  The examples of [2], 5.3 of [1] and Table C.1 are read in the tests and pictures of
phonometry (github.com/jmrplens/phonometry), written from the standards.  Of 4.4, the text of AS
ISO 5349.1:2013 that booksellers show: "a multiplying factor in the range 1,0 to 1,7".  Of [4], that
T is 200/a^2 and at most two hours, what makers print, as Husqvarna.  Of [5], that both modes count
alike, the manual of the Stihl FS 40, 20.6.  [6] is from memory.

Tolerances: the last printed digit, by rounding as printed.
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from equipoise.exposure.daily import (
    ACTION,
    LIMIT,
    SINGLE_AXIS,
    YEARS_OF_TABLE,
    Task,
    allowed_time,
    daily_exposure,
    equivalent,
    limit_time,
    points,
    total_value,
    years_to_white_finger,
)
from equipoise.exposure.spectra import weigh_spectrum
from equipoise.exposure.weighting import (
    F1,
    F2,
    F3,
    F4,
    Q1,
    Q2,
    K,
    band_factors,
    exact_middles,
    factor,
)

HOUR = 3600.0

TABLE_A2 = {
    6.3: "0.727", 8.0: "0.873", 10.0: "0.951", 12.5: "0.958", 16.0: "0.896", 20.0: "0.782",
    25.0: "0.647", 31.5: "0.519", 40.0: "0.411", 50.0: "0.324", 63.0: "0.256", 80.0: "0.202",
    100.0: "0.160", 125.0: "0.127", 160.0: "0.101", 200.0: "0.0799", 250.0: "0.0634",
    315.0: "0.0503", 400.0: "0.0398", 500.0: "0.0314", 630.0: "0.0245", 800.0: "0.0186",
    1000.0: "0.0135", 1250.0: "0.00894",
}  # fmt: skip
"""[1], Table A.2: nominal middle in Hz, factor Whi."""


# -- Annex A ---------------------------------------------------------------------------------------


def test_the_parameters_of_table_a1_to_their_digits() -> None:
    """f1, f2, f3, f4 to five figures, Q1 and Q2 to two decimals, K."""
    assert [f"{value:.5g}" for value in (F1, F2, F3, F4)] == [
        "6.3096",
        "1258.9",
        "15.915",
        "15.915",
    ]
    assert (f"{Q1:.2f}", f"{Q2:.2f}", K) == ("0.71", "0.64", 1.0)


@pytest.mark.parametrize(("nominal", "printed"), TABLE_A2.items())
def test_the_factors_of_table_a2(nominal: float, printed: str) -> None:
    """At the exact middles 10^(n/10) Hz; every one to its last digit."""
    found = band_factors()[nominal]
    digits = len(printed.lstrip("0.").replace(".", ""))
    assert float(f"{found:.{digits}g}") == float(printed)


def test_table_a2_is_of_exact_middles_not_of_nominal_ones() -> None:
    """12.5 Hz and 31.5 Hz are 12.589 and 31.623 Hz."""
    nominal = np.array(list(TABLE_A2))
    np.testing.assert_allclose(factor(exact_middles(nominal)), list(band_factors().values()))
    assert float(f"{float(factor(1250.0)):.3g}") != float(TABLE_A2[1250.0])


def test_weighted_value_from_bands_is_equation_a1() -> None:
    """a_hw = sqrt(sum (Whi a_hi)^2), here by the printed factors, to their three digits."""
    a_h = np.linspace(1.0, 5.0, 24)
    by_table = sqrt(sum((float(w) * a) ** 2 for w, a in zip(TABLE_A2.values(), a_h, strict=True)))
    found = weigh_spectrum(list(TABLE_A2), a_h, bands=True)
    assert found.a_hw[0] == pytest.approx(by_table, rel=2e-3)


# -- total value, daily exposure -------------------------------------------------------------------


def test_total_value_is_equation_1() -> None:
    assert total_value([3.0, 4.0, 12.0]) == 13.0


def test_one_axis_counts_up_to_the_printed_factor() -> None:
    """4.4: a factor from 1.0 to 1.7; 1.7 is three axes alike, sqrt(3), to its digits."""
    assert SINGLE_AXIS == 1.7 == round(sqrt(3), 1)
    assert total_value([2.0, 3.0], single_axis=True) == pytest.approx(5.1)


def test_example_e21_one_tool() -> None:
    """[2], E.2.1: 7.4 m/s2 for 2.5 h; printed 4.1 m/s2."""
    assert round(daily_exposure([Task("tool", 7.4, 2.5 * HOUR)]).a8, 1) == 4.1


def test_example_e24_bursts() -> None:
    """[2], E.2.4: 14.6 m/s2 for 1000/5 bursts of 20 s; printed 5.4 m/s2."""
    assert round(daily_exposure([Task("wrench", 14.6, 1000 / 5 * 20)]).a8, 1) == 5.4


def test_example_e3_forestry() -> None:
    """[2], E.3: brush saw, felling, stripping; printed 2.3, 2.1, 1.8 and 3.6 m/s2."""
    day = daily_exposure(
        Task(name, a, hours * HOUR)
        for name, a, hours in (("brush saw", 4.6, 2), ("felling", 6.0, 1), ("stripping", 3.6, 2))
    )
    assert [round(task.partial, 1) for task in day.tasks] == [2.3, 2.1, 1.8]
    assert round(day.a8, 1) == 3.6
    assert day.verdict == "above the action value"


def test_example_of_part_1() -> None:
    """[1], 5.3: 2.0, 3.5 and 10 m/s2 for 1, 3 and 0.5 h; printed 3.4 m/s2."""
    day = daily_exposure(
        Task("", a, hours * HOUR) for a, hours in ((2.0, 1.0), (3.5, 3.0), (10.0, 0.5))
    )
    assert round(day.a8, 1) == 3.4


@pytest.mark.parametrize(("a8", "years"), [(26.0, 1), (14.0, 2), (7.0, 4), (3.7, 8)])
def test_years_of_table_c1(a8: float, years: int) -> None:
    """Equation C.1 against the four columns of Table C.1, which are rounded."""
    assert round(years_to_white_finger(a8)) == years
    assert not daily_exposure([Task("", a8, 8 * HOUR)]).extrapolated


def test_beyond_table_c1_years_are_extrapolated() -> None:
    assert YEARS_OF_TABLE == (1.0, 8.0)
    for a8 in (2.5, 40.0):
        assert daily_exposure([Task("", a8, 8 * HOUR)]).extrapolated


# -- what is allowed -------------------------------------------------------------------------------


def test_action_and_limit_value_of_article_3() -> None:
    """[3], Article 3 (1): limit 5 m/s2, action 2.5 m/s2; "exceeded" leaves the values out."""
    assert (ACTION, LIMIT) == (2.5, 5.0)
    words = {2.5: "below the action value", 2.51: "above the action value"}
    words |= {5.0: "above the action value", 5.01: "above the limit value"}
    for a8, verdict in words.items():
        assert daily_exposure([Task("", a8, 8 * HOUR)]).verdict == verdict


def test_points_of_the_health_and_safety_executive() -> None:
    """[6]: 100 points at the action value, 400 at the limit value, 2 a^2 an hour."""
    assert (points(ACTION), points(LIMIT)) == (100.0, 400.0)
    assert points(Task("", 3.0, HOUR).partial) == pytest.approx(2 * 3.0**2)


@pytest.mark.parametrize(("a", "hours"), [(2.5, 2.0), (9.9, 2.0), (10.0, 2.0), (20.0, 0.5)])
def test_japanese_time(a: float, hours: float) -> None:
    """[4]: to 10 m/s2 two hours a day, above T = 200/(a a) hours."""
    assert allowed_time(a) == pytest.approx(hours * HOUR)
    assert limit_time(a) == pytest.approx(200 / a**2 * HOUR)


def test_idling_and_racing_count_for_equal_times() -> None:
    """[5]: a_hv,eq = sqrt((a_id^2 + a_ra^2)/2)."""
    assert equivalent(1.0, 7.0) == 5.0
    both = daily_exposure([Task("idling", 1.0, HOUR), Task("racing", 7.0, HOUR)])
    assert both.a_hv == pytest.approx(equivalent(1.0, 7.0))


def test_reference_frequency() -> None:
    """500 rad/s, as instruments are calibrated: 0.2020."""
    assert round(float(factor(500 / (2 * pi))), 4) == 0.2020
