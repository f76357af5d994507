"""The least of a largest of linear readings over what numbers may be, of many boxes at once.

A linear program for all boxes, each in rows and columns of its own.  What is returned follows from
its multipliers alone: any that are not negative bound the least from below, so that nothing rests
on how closely the program was solved.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from equipoise.balancing.jump_bounds import TINY
from equipoise.balancing.jump_readings import Forms
from equipoise.dataclass import dataclass
from equipoise.signals import Array

PENALTY = 1e4
"""Most that a limit may count, over what all objectives do."""


@dataclass(frozen=True, eq=False)
class Bounded:
    """Of B boxes: bounds (B,), numbers (B, K) with which readings are least, and the slopes (B, K)
    there of what counts.
    """

    bounds: Array
    numbers: Array
    slopes: Array


@dataclass(frozen=True, eq=False)
class FormSum:
    """A sum of groups of forms, times factors (B,); at most 1 where it is a limit."""

    groups: tuple[Forms, ...]
    factors: Array
    is_limit: bool = False


def least_of_forms(
    parts: Sequence[FormSum],
    low: Array,
    high: Array,
    start: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> Bounded:
    """The least sum of parts with numbers between low and high (B, K), and directions (I, K) @
    numbers of at least so much (I,); limits are kept to a share `slack`.

    start : (B, K) numbers where no program is solved.
    """
    solution = None
    if low.shape[1]:
        solution = _solved(parts, low, high, directions, least, slack)
    numbers, prices, weights, pushed = (
        (start, None, None, np.zeros((len(low), len(least)))) if solution is None else solution
    )
    constant, slopes = np.zeros(len(low)), np.zeros(low.shape)
    place = 0
    for part in parts:
        price = np.ones(len(low))
        if part.is_limit:
            price = np.zeros(len(low)) if prices is None else prices.pop(0)
            constant -= price * (1 + slack)
        for forms in part.groups:
            weight = np.zeros(forms.constants.shape)
            if weights is not None:
                weight = weights[place]
            place += 1
            weight = _shared(weight, forms.at(numbers)) * (price * part.factors)[:, None]
            constant += np.sum(weight * forms.constants, axis=1)
            slopes += np.einsum("br,brk->bk", weight, forms.slopes)
    left = slopes - pushed @ directions
    bounds = constant + pushed @ least + np.sum(np.minimum(left * low, left * high), axis=1)
    return Bounded(bounds, numbers, slopes)


def _shared(weights: Array, values: Array) -> Array:
    """Weights (B, R) that are not negative and sum up to 1; of the largest where all are 0."""
    weights = np.maximum(weights, 0.0)
    whole = np.sum(weights, axis=1, keepdims=True)
    largest = np.eye(values.shape[1])[np.argmax(values, axis=1)]
    return np.asarray(np.where(whole > 0, weights / np.maximum(whole, TINY), largest))


def _solved(
    parts: Sequence[FormSum],
    low: Array,
    high: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> tuple[Array, list[Array], list[Array], Array] | None:
    """Numbers (B, K); multipliers of limits (B,), of the forms of each group (B, R) and of the
    directions (B, I); None where the program is not solved.

    Columns of a box: its numbers over their ranges, the largest of each group, what limits are
    passed by.
    """
    from scipy import sparse
    from scipy.optimize import linprog

    (boxes, count), width = low.shape, np.maximum(high - low, TINY)
    groups = sum(len(part.groups) for part in parts)
    limits = sum(part.is_limit for part in parts)
    blocks, right = _rows(parts, low, width, directions, least, slack)
    matrix = np.concatenate(blocks, axis=1)
    cost = np.zeros((boxes, count + groups + limits))
    of_terms = [not part.is_limit for part in parts for _ in part.groups]
    cost[:, count : count + groups] = of_terms
    cost[:, count + groups :] = PENALTY
    ends = np.full((*cost.shape, 2), (-np.inf, np.inf))
    ends[:, :count] = (0.0, 1.0)
    ends[:, count + groups :, 0] = 0.0
    result = linprog(
        cost.ravel(),
        sparse.block_diag(matrix, format="csr"),
        np.concatenate(right, axis=1).ravel(),
        bounds=ends.reshape(-1, 2),
        method="highs",
    )
    if result.x is None or result.ineqlin.marginals is None:
        return None
    numbers = low + width * np.clip(result.x.reshape(boxes, -1)[:, :count], 0.0, 1.0)
    prices = np.maximum(-result.ineqlin.marginals.reshape(boxes, -1), 0.0)
    each = np.split(prices, np.cumsum([block.shape[1] for block in blocks])[:-1], axis=1)
    return numbers, [item[:, 0] for item in each[groups:-1]], each[:groups], each[-1]


def _rows(
    parts: Sequence[FormSum],
    low: Array,
    width: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> tuple[list[Array], list[Array]]:
    """Rows (B, R, columns) of the program and what they are at most (B, R): those of the forms of
    each group, of the limits, and of the directions.
    """
    boxes, count = low.shape
    groups = [(part, forms) for part in parts for forms in part.groups]
    limits = [part for part in parts if part.is_limit]
    columns = count + len(groups) + len(limits)
    blocks, right = [], []
    for place, (part, forms) in enumerate(groups, count):
        factors = part.factors[:, None]
        block = np.zeros((*forms.constants.shape, columns))
        block[..., :count] = factors[..., None] * forms.slopes * width[:, None]
        block[..., place] = -1.0
        blocks.append(block)
        right.append(-factors * forms.at(low))
    for k, part in enumerate(limits, count + len(groups)):
        block = np.zeros((boxes, 1, columns))
        block[..., count : count + len(groups)] = [other is part for other, _ in groups]
        block[..., k] = -1.0
        blocks.append(block)
        right.append(np.full((boxes, 1), 1 + slack))
    block = np.zeros((boxes, len(least), columns))
    block[..., :count] = -directions * width[:, None]
    return [*blocks, block], [*right, low @ directions.T - least]
