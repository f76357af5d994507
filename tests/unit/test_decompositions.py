"""Decompositions agree with NumPy's, and LAPACK prints nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from equipoise import decompositions

CALLS: dict[str, Callable[[Any], Any]] = {
    "lstsq": lambda matrix: decompositions.lstsq(matrix, np.ones(len(matrix))),
    "svd": decompositions.svd,
    "svd, reduced": lambda matrix: decompositions.svd(matrix, full_matrices=False),
    "singular_values": decompositions.singular_values,
    "pinv": decompositions.pinv,
    "pinv, hermitian": lambda matrix: decompositions.pinv(matrix, hermitian=True),
    "cond": decompositions.cond,
}


@pytest.mark.parametrize("size", [4, 40])
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
@pytest.mark.parametrize("name", CALLS)
def test_numbers_that_are_not_finite_print_nothing(
    name: str, wrong: float, size: int, capfd: pytest.CaptureFixture[str]
) -> None:
    """LAPACK writes to standard output, past Python."""
    with pytest.raises(np.linalg.LinAlgError, match="not finite"):
        CALLS[name](np.full((size, size), wrong))
    assert capfd.readouterr() == ("", "")


def test_decompositions() -> None:
    """Each against what it has to give back."""
    matrix = np.random.default_rng(1).normal(size=(3, 5, 4))
    left, sizes, right = decompositions.svd(matrix, full_matrices=False)
    np.testing.assert_allclose((left * sizes[:, None]) @ right, matrix, atol=1e-12)
    np.testing.assert_allclose(decompositions.singular_values(matrix), sizes)
    np.testing.assert_allclose(decompositions.cond(matrix), sizes[:, 0] / sizes[:, -1])
    units = np.broadcast_to(np.eye(4), (3, 4, 4))
    np.testing.assert_allclose(decompositions.pinv(matrix) @ matrix, units, atol=1e-12)
    scaled = decompositions.lstsq(np.diag([1e300, 1e-300]), np.array([1e300, 0.0]))[0]
    np.testing.assert_allclose(scaled, [1.0, 0.0])
