"""The weighting Wh by other routes: polynomials of SciPy, and the filter's equations in time.

Numerators and denominators are multiplied out here from the parameters, in rad/s; nothing of
`equipoise.exposure` is used but what is to be proved.  Tolerances: 1e-10 for the polynomials, whose
coefficients span 16 powers of ten; 1e-5 for the integration, whose own is 1e-8 a step.
"""

from __future__ import annotations

from functools import reduce

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import freqs, tf2ss

from equipoise.exposure.spectra import weigh_signal
from equipoise.exposure.weighting import weighting
from support.conformance import compared
from support.sources import FILTER

W1, W2, W3 = 2 * np.pi * 10**0.8, 2 * np.pi * 10**3.1, 100.0
"""rad/s."""
NUMERATOR = np.polymul([1, 0, 0], np.polymul([W2**2], [1 / W3, 1]))
DENOMINATOR = reduce(
    np.polymul,
    ([1, W1 * 2**0.5, W1**2], [1, W2 * 2**0.5, W2**2], [1 / W3**2, 1 / (0.64 * W3), 1]),
)


@compared(FILTER, "weighting from 0.1 Hz to 100 kHz", 1e-10, "polynomials of SciPy")
def test_against_the_polynomials() -> None:
    frequency = np.geomspace(0.1, 1e5, 300)
    _, response = freqs(NUMERATOR, DENOMINATOR, worN=2 * np.pi * frequency)
    np.testing.assert_allclose(weighting(frequency), response, rtol=1e-10)


def test_the_filter_is_stable_and_lets_nothing_steady_through() -> None:
    assert np.all(np.roots(DENOMINATOR).real < 0)
    assert NUMERATOR[-1] == NUMERATOR[-2] == 0


WAVES = ((12.0, 3.0, 0.4), (52.0, 20.0, 1.0), (120.0, 40.0, 2.0))
"""Hz, m/s2 of amplitude, rad: all of them whole periods in a quarter of a second."""


def filtered_rms(waves: tuple[tuple[float, float, float], ...]) -> float:
    """RMS of the filter's answer over a quarter of a second, after half a second to settle."""
    a, b, c, _ = tf2ss(NUMERATOR, DENOMINATOR)

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        value = sum(size * np.sin(2 * np.pi * f * t + phase) for f, size, phase in waves)
        answer = float(c[0] @ state[:-1])
        return np.append(a @ state[:-1] + b[:, 0] * value, answer**2)

    start = np.zeros(len(a) + 1)
    options = {"method": "DOP853", "rtol": 1e-8, "atol": 1e-14, "max_step": 1e-3}
    settled = solve_ivp(rates, (-0.5, 0.0), start, **options).y[:, -1]
    done = solve_ivp(rates, (0.0, 0.25), np.append(settled[:-1], 0.0), **options)
    return float(np.sqrt(4 * done.y[-1, -1]))


@compared(FILTER, "weighted RMS of three sines", 1e-5, "integrated in time")
def test_against_the_filter_integrated_in_time() -> None:
    time = np.arange(1000) / 4000.0
    values = sum(size * np.sin(2 * np.pi * f * time + phase) for f, size, phase in WAVES)
    a_hw = weigh_signal(time, values, periodic=True).a_hw[0]
    assert filtered_rms(WAVES) == pytest.approx(a_hw, rel=1e-5)
