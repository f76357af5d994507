"""Least solutions of equations that leave unknowns open, stacks of them at once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.decompositions import svd
from equipoise.mechanism.assembly.steps import Array

ROUNDING = 1e-11
"""Share of a singular value in the largest that rounding explains."""
CLEAR = 1e-8
"""The same of rows that clearly do not depend on each other."""
APART = 1e5
"""By how much, at most, products of rows let errors grow."""
AT_ONCE = 2**20
"""Entries of matrices that are worked on at a time: what is in between takes several times that."""


def least(matrix: Array, right: Array) -> Array:
    """Least solutions (N, m, k) of equations (N, n, m) with right sides (N, n, k)."""
    found = np.empty((matrix.shape[0], matrix.shape[2], right.shape[2]))
    for some in in_blocks(matrix):
        found[some] = _least_by_products(matrix[some], right[some])
    return found


def in_blocks(matrix: Array) -> Iterator[slice]:
    """Slices of a stack of matrices (N, n, m), of as many as are worked on at a time."""
    step = max(1, AT_ONCE // max(1, matrix[:1].size))
    return (slice(begin, begin + step) for begin in range(0, len(matrix), step))


def _least_by_products(matrix: Array, right: Array) -> Array:
    """By the products of rows, and by the rows themselves where products lose digits."""
    across = np.swapaxes(matrix, -1, -2)
    products = matrix @ across
    probe = np.cos(np.arange(matrix.shape[1]))  # of no meaning: shows how much errors can grow
    probe = np.broadcast_to(probe[:, None], (*matrix.shape[:2], 1))
    try:
        told = np.linalg.solve(products, np.concatenate([right, probe], axis=-1))
    except np.linalg.LinAlgError:
        return _least_by_rows(matrix, right)
    found = np.asarray(across @ told[..., :-1])
    sizes = np.max(np.abs(told[..., -1]), axis=-1) * np.trace(products, axis1=1, axis2=2)
    if not np.all(apart := sizes < APART):
        found[~apart] = _least_by_rows(matrix[~apart], right[~apart])
    return found


def _least_by_rows(matrix: Array, right: Array) -> Array:
    """By QR, and by singular values where rows nearly depend on each other."""
    across, triangle = np.linalg.qr(np.swapaxes(matrix, -1, -2))
    sizes = np.abs(np.diagonal(triangle, axis1=-2, axis2=-1))
    clear = np.min(sizes, axis=-1) > CLEAR * np.max(sizes, axis=-1)
    triangle[~clear] = np.eye(triangle.shape[-1])
    found = across @ np.linalg.solve(np.swapaxes(triangle, -1, -2), right)
    if not np.all(clear):
        found[~clear] = parts_of(matrix[~clear])[0] @ right[~clear]
    return np.asarray(found)


def parts_of(matrix: Array) -> tuple[Array, Array]:
    """Least-squares inverse of matrices (N, n, m), and unknowns (N, m, k) that they make nothing
    of.
    """
    left, sizes, right = svd(matrix, full_matrices=True)
    rank = sizes.shape[-1]
    kept = sizes > ROUNDING * sizes[:, :1]
    over = np.where(kept, 1 / np.where(kept, sizes, 1.0), 0.0)
    right = np.swapaxes(right, -1, -2)
    return right[..., :rank] * over[:, None] @ np.swapaxes(left, -1, -2), right[..., rank:]
