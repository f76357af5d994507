"""Yamashita, Ichikawa and Mori: free decay of their test rig, (60) to (62).

Section 4-2 and Table 2; `support.sources` has the citation.

Data: K = 182.0 kgf/m, L_E = 1.35 m from the pivot to the spring, a gauge at 1.5 m; found by them
I0 = 2.152 kgf m s2, Cr = 0.333 kgf m s, Tf = 0, beta = 12.4 rad/s.  The recorded decay itself is
not printed, so the rig is simulated with their constants and identified again.

Mapping: theta is the angle; heights theta_i go from a peak to the next valley, theta_(i+1) from
there to the next peak.  Kf = K L_E^2.

In the equations n is the slope of the line and m its intercept: only so does (62) give Tf = 0 for
m = 0, and (61) a positive Cr for n below 1, which the first test shows on the exact motion.

Tolerances.  Without noise the fit of the whole record is exact to rounding, 1e-9; the line to 2e-3
of Cr, as its turning points are those of polynomials.  With a gauge that has 0.02 mm of noise, a
thousandth of the first amplitude, the printed digits of I0 and beta come back; of Cr, the ratio of
damping being 0.006, to 1 %.
"""

from __future__ import annotations

from math import log, pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from support.conformance import Printed, equation, published
from support.sources import YAMASHITA

KGF = 9.80665
K, L_E, GAUGE = 182.0 * KGF, 1.35, 1.5
I_0, C_R, BETA = 2.152 * KGF, 0.333 * KGF, 12.4
K_F = K * L_E**2
OMEGA = sqrt(K_F / I_0)
RATIO = C_R / (2 * sqrt(K_F * I_0))
START = 0.02 / GAUGE
"""rad: the gauge 20 mm from rest."""
T_F = 0.1 * KGF
"""N m: dry friction such as the rig did not have, 0.4 mm at the gauge."""


def rig(friction: float = 0.0, noise: float = 0.0) -> eq.measured.Record:
    """What the gauge reads in ten seconds, m."""
    read = eq.measured.simulate_decay(
        np.linspace(0.0, 10.0, 5001),
        natural_frequency=OMEGA,
        damping_ratio=RATIO,
        coulomb=GAUGE * friction / K_F,
        start=GAUGE * START,
        noise=noise,
    )
    return read


@equation(YAMASHITA, "(60) to (62)", "I0, Cr and Tf from exact turning points", 1e-10)
@pytest.mark.parametrize("friction", [0.0, T_F])
def test_equations_60_to_62_with_n_as_the_slope(friction: float) -> None:
    """Exact turning points, a half-period apart, put into the equations."""
    beta = OMEGA * sqrt(1 - RATIO**2)
    peaks = eq.measured.simulate_decay(
        pi / beta * np.arange(14),
        natural_frequency=OMEGA,
        damping_ratio=RATIO,
        coulomb=friction / K_F,
        start=START,
    )
    heights = np.abs(np.diff(peaks.displacement))
    n, m = np.polyfit(heights[:-1], heights[1:], 1)
    inertia = K_F / (beta**2 * ((log(n) / pi) ** 2 + 1))
    assert inertia == pytest.approx(I_0, rel=1e-10)
    assert -2 / pi * inertia * beta * log(n) == pytest.approx(C_R, rel=1e-10)
    assert -m * K_F / (2 * (1 + n)) == pytest.approx(friction, abs=1e-10)


def identified(record: eq.measured.Record) -> eq.measured.Decay:
    return eq.measured.identify_decay(record, K, arm=GAUGE, spring_arm=L_E)


@pytest.mark.parametrize("friction", [0.0, T_F], ids=["as printed", "with friction"])
def test_the_rig_without_noise(friction: float) -> None:
    decays = identified(rig(friction))
    for method, tolerance in ((decays.by_record, 1e-9), (decays.by_line, 2e-3)):
        assert method["inertia"].value == pytest.approx(I_0, rel=tolerance / 10)
        assert method["viscous_damping"].value == pytest.approx(C_R, rel=tolerance)
        assert method["coulomb_torque"].value == pytest.approx(friction, abs=tolerance)
        assert method["damped_angular_frequency"].value == pytest.approx(12.415, abs=5e-4)


@published(
    YAMASHITA,
    *(
        Printed("yamashita-rig", f"{what} from a free decay", "Table 2", printed, text, unit, of=of)
        for what, printed, text, unit, of in (
            ("I0", "2.152", "2.152", "kgf m s2", ("inertia", KGF)),
            ("Cr", "0.333", "0.333", "kgf m s", ("viscous_damping", KGF)),
            ("Tf", "0", "0.000", "kgf m", ("coulomb_torque", KGF)),
            ("beta", "12.4", "12.415", "rad/s", ("damped_angular_frequency", 1.0)),
        )
    ),
)
def test_constants_of_the_rig_come_back(row: Printed) -> list[float]:
    """By the whole record and by the line of its turning points."""
    actual, (name, unit) = identified(rig()), row.of
    return [method[name].value / unit for method in (actual.by_record, actual.by_line)]


@pytest.mark.parametrize("friction", [0.0, T_F], ids=["as printed", "with friction"])
def test_the_rig_with_a_noisy_gauge(friction: float) -> None:
    """2.152 and 12.4 to every printed digit, 0.333 to 1 %; by both methods."""
    decays = identified(rig(friction, noise=2e-5))
    for method in (decays.by_record, decays.by_line):
        assert method["inertia"].value / KGF == pytest.approx(2.152, abs=5e-4)
        assert round(method["damped_angular_frequency"].value, 1) == BETA
        assert method["viscous_damping"].value / KGF == pytest.approx(0.333, rel=0.01)
        assert method["coulomb_torque"].value == pytest.approx(friction, abs=0.01 * KGF)
    assert decays.by_record["inertia"].low <= I_0 <= decays.by_record["inertia"].high
    assert (
        decays.by_record["viscous_damping"].low <= C_R <= decays.by_record["viscous_damping"].high
    )
    assert decays.by_record["coulomb_torque"].includes_zero == (friction == 0)
