"""ISO 5349-1 and -2, Directive 2002/44/EC, ISO 22867 and the Japanese guideline: printed figures.

[1] is ISO 5349-1, [2] ISO 5349-2, [3] the directive, [4] the Japanese notifications, [5] ISO 22867,
[6] the Health and Safety Executive; `support.sources` tells where they are read.

Tolerances: the last printed digit, by rounding as printed.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from equipoise.exposure.daily import (
    ACTION,
    LIMIT,
    SINGLE_AXIS,
    YEARS_OF_TABLE,
    Exposure,
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
from support.conformance import Printed, published
from support.sources import ISO_5349, RULES

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


@published(
    ISO_5349,
    Printed("Wh", "f1", "[1] Table A.1", "6.3096", unit="Hz", of=F1),
    Printed("Wh", "f2", "[1] Table A.1", "1258.9", unit="Hz", of=F2),
    Printed("Wh", "f3", "[1] Table A.1", "15.915", unit="Hz", of=F3),
    Printed("Wh", "f4", "[1] Table A.1", "15.915", unit="Hz", of=F4),
    Printed("Wh", "Q1", "[1] Table A.1", "0.71", of=Q1),
    Printed("Wh", "Q2", "[1] Table A.1", "0.64", of=Q2),
    Printed("Wh", "K", "[1] Table A.1", "1", of=K),
)
def test_the_parameters_of_table_a1_to_their_digits(row: Printed) -> float:
    return row.of


@published(
    ISO_5349,
    *(
        Printed("Wh", f"factor of the band of {nominal:g} Hz", "[1] Table A.2", printed, of=nominal)
        for nominal, printed in TABLE_A2.items()
    ),
)
def test_the_factors_of_table_a2(row: Printed) -> float:
    """At the exact middles 10^(n/10) Hz; every one to its last digit."""
    return band_factors()[row.of]


def test_table_a2_is_of_exact_middles_not_of_nominal_ones() -> None:
    """12.5 Hz and 31.5 Hz are 12.589 and 31.623 Hz."""
    nominal = np.array(list(TABLE_A2))
    np.testing.assert_allclose(factor(exact_middles(nominal)), list(band_factors().values()))
    assert float(f"{float(factor(1250.0)):.3g}") != float(TABLE_A2[1250.0])


def test_weighted_value_from_bands_is_equation_a1() -> None:
    """a_hw = sqrt(sum (Whi a_hi)^2), here by the printed factors, to their three digits."""
    a_h = np.linspace(1.0, 5.0, 24)
    by_table = sqrt(sum((float(w) * a) ** 2 for w, a in zip(TABLE_A2.values(), a_h, strict=True)))
    weighted = weigh_spectrum(list(TABLE_A2), a_h, bands=True)
    assert weighted.a_hw[0] == pytest.approx(by_table, rel=2e-3)


# -- total value, daily exposure -------------------------------------------------------------------


def test_total_value_is_equation_1() -> None:
    assert total_value([3.0, 4.0, 12.0]) == 13.0


@published(ISO_5349, Printed("one axis measured", "largest factor", "[1] 4.4", "1.7"))
def test_one_axis_counts_up_to_the_printed_factor() -> tuple[float, ...]:
    """4.4: a factor from 1.0 to 1.7; 1.7 is three axes alike, sqrt(3), to its digits."""
    return SINGLE_AXIS, sqrt(3), total_value([2.0, 3.0], single_axis=True) / 3.0


def day(*tasks: tuple[float, float]) -> Exposure:
    """A day's tasks: m/s2 and hours."""
    return daily_exposure(Task("", a, hours * HOUR) for a, hours in tasks)


FORESTRY = ((4.6, 2), (6.0, 1), (3.6, 2))
"""Brush saw, felling, stripping."""


@published(
    ISO_5349,
    Printed("one tool", "A(8)", "[2] E.2.1", "4.1", unit="m/s2", of=lambda: day((7.4, 2.5)).a8),
    Printed(
        "bursts of an impact wrench", "A(8)", "[2] E.2.4", "5.4", unit="m/s2",
        of=lambda: day((14.6, 1000 / 5 * 20 / HOUR)).a8,
    ),
    *(
        Printed(
            "forestry", f"partial exposure, {name}", "[2] E.3", printed, unit="m/s2",
            of=lambda number=number: day(*FORESTRY).tasks[number].partial,
        )
        for number, (name, printed) in enumerate(
            {"brush saw": "2.3", "felling": "2.1", "stripping": "1.8"}.items()
        )
    ),
    Printed("forestry", "A(8)", "[2] E.3", "3.6", unit="m/s2", of=lambda: day(*FORESTRY).a8),
    Printed(
        "three tools", "A(8)", "[1] 5.3", "3.4", unit="m/s2",
        of=lambda: day((2, 1), (3.5, 3), (10, 0.5)).a8,
    ),
)  # fmt: skip
def test_examples(row: Printed) -> float:
    return row.of()


def test_forestry_is_above_the_action_value() -> None:
    assert day(*FORESTRY).verdict == "above the action value"


@published(
    ISO_5349,
    *(
        Printed(f"A(8) of {a8:g} m/s2", "years to white finger", "[1] Table C.1", str(years), of=a8)
        for a8, years in ((26.0, 1), (14.0, 2), (7.0, 4), (3.7, 8))
    ),
)
def test_years_of_table_c1(row: Printed) -> float:
    """Equation C.1 against the four columns of Table C.1, which are rounded."""
    assert not day((row.of, 8)).extrapolated
    return years_to_white_finger(row.of)


def test_beyond_table_c1_years_are_extrapolated() -> None:
    assert YEARS_OF_TABLE == (1.0, 8.0)
    for a8 in (2.5, 40.0):
        assert daily_exposure([Task("", a8, 8 * HOUR)]).extrapolated


# -- what is allowed -------------------------------------------------------------------------------


@published(
    RULES,
    Printed("", "action value", "[3] Article 3", "2.5", unit="m/s2", of=lambda: ACTION),
    Printed("", "limit value", "[3] Article 3", "5", unit="m/s2", of=lambda: LIMIT),
    Printed("action value", "points", "[6]", "100", of=lambda: points(ACTION)),
    Printed("limit value", "points", "[6]", "400", of=lambda: points(LIMIT)),
    Printed("an hour of 3 m/s2", "points, 2 a^2", "[6]", "18", of=lambda: points(day((3.0, 1)).a8)),
    *(
        Printed(
            f"{a:g} m/s2", "allowed time", "[4]", hours, unit="h",
            of=lambda a=a: allowed_time(a) / HOUR,
        )
        for a, hours in ((2.5, "2.0"), (9.9, "2.0"), (10.0, "2.0"), (20.0, "0.5"))
    ),
    Printed("10 m/s2", "T = 200/a^2", "[4]", "2.0", unit="h", of=lambda: limit_time(10.0) / HOUR),
    Printed("20 m/s2", "T = 200/a^2", "[4]", "0.5", unit="h", of=lambda: limit_time(20.0) / HOUR),
    Printed(
        "1 m/s2 idling, 7 m/s2 racing", "a_hv,eq", "[5]", "5", unit="m/s2",
        of=lambda: equivalent(1.0, 7.0),
    ),
)  # fmt: skip
def test_rules(row: Printed) -> float:
    return row.of()


def test_a_value_is_exceeded_above_itself() -> None:
    """[3], Article 3 (1): "exceeded" leaves the values out."""
    words = {2.5: "below the action value", 2.51: "above the action value"}
    words |= {5.0: "above the action value", 5.01: "above the limit value"}
    for a8, verdict in words.items():
        assert day((a8, 8)).verdict == verdict


def test_idling_and_racing_count_for_equal_times() -> None:
    both = daily_exposure([Task("idling", 1.0, HOUR), Task("racing", 7.0, HOUR)])
    assert both.a_hv == pytest.approx(equivalent(1.0, 7.0))
