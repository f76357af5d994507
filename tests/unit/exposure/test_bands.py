"""One-third-octave bands."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.errors import UsageError
from equipoise.exposure.weighting import (
    EDGES,
    MIDDLES,
    NOMINAL,
    band_factors,
    exact_middles,
    factor,
    rms_in_bands,
)


def test_middles_edges_and_names_belong_together() -> None:
    assert len(NOMINAL) == len(MIDDLES) == len(EDGES) - 1 == 24
    assert np.all((EDGES[:-1] < NOMINAL) & (EDGES[1:] > NOMINAL))
    np.testing.assert_allclose(EDGES[1:] / EDGES[:-1], 10**0.1)
    np.testing.assert_allclose(np.sqrt(EDGES[1:] * EDGES[:-1]), MIDDLES)
    np.testing.assert_allclose(NOMINAL, MIDDLES, rtol=0.012)


def test_nominal_and_exact_middles_are_taken() -> None:
    np.testing.assert_allclose(exact_middles(np.array(NOMINAL)), MIDDLES)
    np.testing.assert_allclose(exact_middles(MIDDLES), MIDDLES)


@pytest.mark.parametrize("wrong", [0.0, 5.0, 7.0, 70.0, 1600.0])
def test_other_frequencies_are_refused(wrong: float) -> None:
    with pytest.raises(UsageError, match=f"frequency: got {wrong:g} Hz; give middles of one-third"):
        exact_middles(np.array([8.0, wrong]))


def test_factors_by_nominal_frequency() -> None:
    assert list(band_factors()) == list(NOMINAL)
    assert band_factors()[125.0] == float(factor(10**2.1))


def test_sums_in_bands() -> None:
    """Lines between the same edges add up; those outside are left out; an edge begins a band."""
    lines = np.array([1.0, 7.5, 8.5, float(EDGES[2]), 100.0, 1400.0, 1500.0])
    squares = np.array([[1.0, 9.0, 16.0, 4.0, 25.0, 36.0, 1.0], np.zeros(7)])
    found = rms_in_bands(lines, squares)
    assert found.shape == (2, 24)
    wanted = {8.0: 5.0, 10.0: 2.0, 100.0: 5.0, 1250.0: 6.0}
    assert {NOMINAL[k]: found[0, k] for k in np.flatnonzero(found[0])} == pytest.approx(wanted)
    assert not np.any(found[1])
