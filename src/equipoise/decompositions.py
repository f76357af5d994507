"""Decompositions of matrices by LAPACK, which are never given numbers that are not finite.

LAPACK writes a line of its own to standard output, past Python, where a singular value
decomposition gets such numbers, and only then fails.  So all of them are called here.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[Any]


def _check_finite(matrix: Matrix) -> None:
    """Raise `numpy.linalg.LinAlgError` where a matrix has a number that is not finite."""
    if not np.all(np.isfinite(matrix)):
        raise np.linalg.LinAlgError("a decomposition of numbers that are not finite")


def lstsq(
    matrix: Matrix, right: Matrix, rcond: float | None = None
) -> tuple[Matrix, Matrix, int, Matrix]:
    """Least squares as `numpy.linalg.lstsq`.

    Raises
    ------
    numpy.linalg.LinAlgError : numbers are not finite, or it does not converge.
    """
    _check_finite(matrix)
    solution, residuals, rank, sizes = np.linalg.lstsq(matrix, right, rcond=rcond)
    return solution, residuals, int(rank), sizes


def svd(matrix: Matrix, full_matrices: bool = True) -> tuple[Matrix, Matrix, Matrix]:
    """Singular value decomposition (..., M, N) as `numpy.linalg.svd`; errors as of `lstsq`."""
    _check_finite(matrix)
    left, sizes, right = np.linalg.svd(matrix, full_matrices=full_matrices)
    return left, sizes, right


def singular_values(matrix: Matrix) -> Matrix:
    """Singular values (..., K) of matrices (..., M, N), falling; errors as of `lstsq`."""
    _check_finite(matrix)
    return np.asarray(np.linalg.svd(matrix, compute_uv=False))


def pinv(matrix: Matrix, rcond: float | None = None, hermitian: bool = False) -> Matrix:
    """Pseudoinverse (..., N, M) as `numpy.linalg.pinv`; errors as of `lstsq`."""
    _check_finite(matrix)
    return np.asarray(np.linalg.pinv(matrix, rcond=rcond, hermitian=hermitian))


def cond(matrix: Matrix) -> Matrix:
    """Condition numbers (...) as `numpy.linalg.cond`; errors as of `lstsq`."""
    _check_finite(matrix)
    return np.asarray(np.linalg.cond(matrix))
