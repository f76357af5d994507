"""The designs of a study by number: any part of them at once, always the same.

Nothing that was drawn before matters, so that designs can be computed in any order, by any number
of threads, processes and machines: a grid is counted through, a Sobol sequence is wound forward to
where it is asked for, pseudorandom numbers come from a generator that can jump, and the lists of a
Latin hypercube are shuffled number by number.
"""

from __future__ import annotations

import threading
from functools import lru_cache
from math import isqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.design.spreads import LEAST, MOST
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.sequences import sobol
from equipoise.studies.study import correlation_matrix

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol

    from equipoise.studies.study import Study

Array = np.ndarray[Any, Any]

BITS = 30
"""Of a Sobol number; 2**30 designs are more than any study has."""
ROUNDS = 4
"""Of shuffling: two hardly leave a pattern."""
SHUFFLES, JITTER, SEQUENCE, DRAWS = range(4)
"""What random numbers are for: each has a stream of its own."""


def samples(study: Study, start: int, count: int) -> Array:
    """Values of the designs from number `start` on, (count, d) in SI units, a column a number.

    Raises
    ------
    UsageError : there are not so many designs.
    """
    if study.sampling.method != "grid":
        return values_at(study, unit_samples(study, start, count))
    places = _grid(study, start, count)
    levels = (item.spread.levels for item in study.vary)
    return np.column_stack([level[place] for level, place in zip(levels, places, strict=True)])


def unit_samples(study: Study, start: int, count: int) -> Array:
    """Places of the same designs in the spread of each number, (count, d), above 0 and below 1.

    They are not correlated yet; `values_at` makes values of them.
    """
    if start < 0 or count < 0 or start + count > study.size:
        raise UsageError(
            Note(
                "got designs {start} to {start_2}; the study has {size}, from 0",
                start=start,
                start_2=start + count,
                size=study.size,
            )
        )
    method = study.sampling.method
    if method == "grid":
        places = zip(_grid(study, start, count), study.shape, strict=True)
        return np.column_stack([(place + 0.5) / levels for place, levels in places])
    if method == "monte-carlo":
        return _uniform(study, DRAWS, start, count)
    return (_sobol if method == "sobol" else _latin_hypercube)(study, start, count)


def values_at(study: Study, unit: Array) -> Array:
    """Values (n, d), SI units, at places (n, d) between 0 and 1, correlated as the study says.

    Correlations are those of a Gaussian copula: normal variables behind the places are mixed, which
    leaves the spread of each number as it is.
    """
    places = list(np.asarray(unit).T)
    if study.correlations:
        from scipy.special import ndtr, ndtri

        columns, matrix = correlation_matrix(study.paths, study.correlations)
        behind = ndtri(np.clip([places[column] for column in columns], LEAST, MOST))
        mixed = np.clip(ndtr(np.linalg.cholesky(matrix) @ behind), LEAST, MOST)
        for column, place in zip(columns, mixed, strict=True):
            places[column] = place
    values = np.empty(np.shape(unit))
    for column, (item, place) in enumerate(zip(study.vary, places, strict=True)):
        values[:, column] = item.spread.at(place)
    return values


def canonical(study: Study, places: Array) -> Array:
    """Designs with each value of a list in one place only, so that equal ones are seen."""
    settled = np.clip(places, 0.0, 1.0)
    for k, item in enumerate(study.vary):
        spread: Any = item.spread
        if spread.count:
            step = np.minimum(np.floor(settled[:, k] * spread.count), spread.count - 1)
            settled[:, k] = (step + 0.5) / spread.count
    return settled


# -- each method -----------------------------------------------------------------------------------


def _grid(study: Study, start: int, count: int) -> tuple[Array, ...]:
    """Place of each number in its levels, (count,) each; the last runs fastest."""
    return np.unravel_index(np.arange(start, start + count), study.shape)


def _latin_hypercube(study: Study, start: int, count: int) -> Array:
    places = _uniform(study, JITTER, start, count)
    for column in range(len(study.vary)):
        places[:, column] += _shuffled(study.sampling.seed, column, study.size, start, count)
    places /= study.size
    return np.clip(places, LEAST, MOST, out=places)


def _sobol(study: Study, start: int, count: int) -> Array:
    width = len(study.vary)
    if count == 0:
        return np.empty((0, width))
    key = (study.sampling.seed, width)
    engine = _engine(key, start)
    _ENGINES.key = None  # while it draws: if it is interrupted, nobody goes on with it
    # SciPy warns of a first draw that is no power of two long; one is such a power.
    first = engine.random(1)
    places: Array = np.concatenate([first, engine.random(count - 1)]) if count > 1 else first.copy()
    _ENGINES.key = key
    places += 0.5 / 2**BITS  # the middle of a cell: 0 is the end of a normal spread
    return places


# -- random numbers --------------------------------------------------------------------------------


def random_numbers(seed: int, *use: int) -> np.random.Generator:
    """The stream of random numbers of one use; it can jump."""
    sequence = np.random.SeedSequence(seed, spawn_key=use)
    return np.random.Generator(np.random.PCG64DXSM(sequence))


def _uniform(study: Study, use: int, start: int, count: int) -> Array:
    """Rows of one endless table of random numbers, (count, d), above 0 and below 1."""
    source, width = random_numbers(study.sampling.seed, use), len(study.vary)
    source.bit_generator.advance(start * width)  # type: ignore[attr-defined]  # one step a number
    random = source.random((count, width))
    return np.maximum(random, LEAST, out=random)


def _shuffled(seed: int, column: int, size: int, start: int, count: int) -> Array:
    """A part (count,) of the numbers below `size` in an order of their own for each column.

    By a Feistel network: a number is taken for a place in a square table of rows and columns, and
    its row is moved on by what a random table says for its column, then the column for the row,
    and so on.  Each step can be undone, so no two numbers become one.
    """
    sides, tables = _tables(seed, column, size)
    shuffled = np.arange(start, start + count)
    again = np.arange(count)  # which are not below `size`: the square is somewhat larger
    while again.size:
        row, place = np.divmod(shuffled[again], sides[1])
        for of_row, of_place in tables:
            _move_on(row, of_row[place], sides[0])
            _move_on(place, of_place[row], sides[1])
        shuffled[again] = row * sides[1] + place
        again = again[shuffled[again] >= size]
    return shuffled


def _move_on(values: Array, by: Array, limit: int) -> None:
    """Add, and begin again at 0 from the limit on, in place."""
    values += by
    values -= limit * (values >= limit)


@lru_cache(maxsize=4096)
def _tables(seed: int, column: int, size: int) -> tuple[tuple[int, int], list[tuple[Array, Array]]]:
    """Rows and columns of the square, and for each round a table for both."""
    rows = isqrt(size - 1) + 1
    columns = -(-size // rows)
    random = random_numbers(seed, SHUFFLES, column)
    tables = [
        (random.integers(0, rows, columns), random.integers(0, columns, rows))
        for _ in range(ROUNDS)
    ]
    return (rows, columns), tables


_ENGINES = threading.local()


def _engine(key: tuple[int, int], start: int) -> Sobol:
    """A scrambled sequence that stands at `start`; each thread goes on with the one it has.

    key : seed, and how many numbers a design has.
    """
    if getattr(_ENGINES, "key", None) != key:
        seed, width = key
        _ENGINES.engine = sobol(width, random_numbers(seed, SEQUENCE), BITS)
    engine: Sobol = _ENGINES.engine
    if engine.num_generated > start:
        engine.reset()
    if engine.num_generated < start:
        engine.fast_forward(start - engine.num_generated)
    return engine
