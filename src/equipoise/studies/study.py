"""A study as a value, and its designs by number: any part of them at once, always the same.

Nothing that was drawn before matters, so that designs can be computed in any order, by any number
of threads, processes and machines: a grid is counted through, a Sobol sequence is wound forward to
where it is asked for, pseudorandom numbers come from a generator that can jump, and the lists of a
Latin hypercube are shuffled number by number.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from math import isqrt, prod
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.checks import wrong_text
from equipoise.studies import checks
from equipoise.studies.checks import check_numbers, correlation_matrix, shape_of
from equipoise.studies.design_space import (
    KEYS,
    LEAST,
    MOST,
    SPREADS,
    Correlation,
    Model,
    Output,
    Range,
    Sampling,
    Spread,
    Vary,
)

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol

CHUNK, SLOW_CHUNK = 65_536, 256
"""Designs that are computed and stored together: of analyses, and of whatever takes longer."""


@dataclass(frozen=True)
class Study:
    """Many designs of one model.

    angles : crank angles in a turn; None for as many as `tolerance` asks for.
    tolerance : to which all figures stand still when the number of crank angles doubles, over the
        RMS of their signal.
    chunk : designs that are computed and stored together; 0 for a usual number.
    file : text of the file that it was read from, for whoever reads a store.

    Raises
    ------
    ModelError : something contradicts itself; `where` is the key of the study file.
    """

    title: str
    model: Model
    vary: tuple[Vary, ...]
    outputs: tuple[Output, ...]
    sampling: Sampling
    correlations: tuple[Correlation, ...] = ()
    angles: int | None = None
    tolerance: float = 1e-4
    chunk: int = 0
    file: str = field(default="", compare=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("vary", "outputs", "correlations"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        numbers = check_numbers(self.model, self.vary)
        vary = tuple(_as_in(one, *number) for one, number in zip(self.vary, numbers, strict=True))
        object.__setattr__(self, "vary", vary)
        for problem in _problems(self):
            raise problem
        if not self.chunk:
            fast = all(output.of == "analyze" for output in self.outputs)
            object.__setattr__(self, "chunk", CHUNK if fast else SLOW_CHUNK)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the numbers that vary, in the order of the columns of all values."""
        return tuple(one.path for one in self.vary)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the outputs, in the order of the columns of all figures."""
        return tuple(output.name for output in self.outputs)

    @property
    def shape(self) -> tuple[int, ...]:
        """Of a grid: values of each number; the last runs fastest."""
        return shape_of(self.vary)

    @property
    def size(self) -> int:
        """Number of designs in all."""
        if self.sampling.method == "grid":
            return prod(self.shape)
        assert self.sampling.designs is not None
        return self.sampling.designs

    @property
    def objectives(self) -> tuple[Output, ...]:
        """Outputs that are to become small or large."""
        return tuple(output for output in self.outputs if output.make)

    @property
    def texts(self) -> dict[str, str]:
        """All of it as texts by name; `equipoise.schema.studies.restore` makes it again of them."""
        return {
            "study": json.dumps(to_plain(self), ensure_ascii=False, indent=1, default=int),
            **({"file": self.file} if self.file else {}),
            **{f"model {name}": text for name, text in self.model.texts().items()},
        }


def _problems(study: Study) -> Iterator[ModelError]:
    """What is wrong with a study beside its numbers, the first things first."""
    method = study.sampling.method
    yield from wrong_text("title", study.title)
    for number, one in enumerate(study.vary, 1):
        yield from checks.wrong_spread(f"vary[{number}]", one, study.model, method)
    yield from checks.wrong_sampling(study.sampling, study.vary)
    yield from checks.wrong_correlations(study.correlations, study.vary, method)
    yield from checks.wrong_outputs(study.outputs, study.paths, study.model.kind)
    yield from checks.wrong_accuracy(study.angles, study.tolerance, study.chunk)


def _as_in(one: Vary, value: float, dimension: str | None) -> Vary:
    """The same with what the model knows of the number."""
    spread = one.spread
    if isinstance(value, int) and isinstance(spread, Range):
        spread = replace(spread, whole=True)
    return replace(one, spread=spread, dimension=dimension)


# -- as plain values -------------------------------------------------------------------------------


def to_plain(study: Study) -> dict[str, Any]:
    """All but the model and the file as plain values, such as JSON takes; numbers in SI units."""
    vary = [
        {**asdict(one), "spread": {"kind": KEYS[type(one.spread)], **asdict(one.spread)}}
        for one in study.vary
    ]
    return {
        "title": study.title,
        "vary": vary,
        "outputs": [asdict(output) for output in study.outputs],
        "sampling": asdict(study.sampling),
        "correlations": [asdict(correlation) for correlation in study.correlations],
        "angles": study.angles,
        "tolerance": study.tolerance,
        "chunk": study.chunk,
    }


def from_plain(plain: Mapping[str, Any], model: Model, file: str = "") -> Study:
    """The study of `to_plain`, exactly."""
    return Study(
        title=plain["title"],
        model=model,
        vary=tuple(
            Vary(one["path"], _spread(one["spread"]), one["dimension"]) for one in plain["vary"]
        ),
        outputs=tuple(Output(**output) for output in plain["outputs"]),
        sampling=Sampling(**plain["sampling"]),
        correlations=tuple(Correlation(**one) for one in plain["correlations"]),
        angles=plain["angles"],
        tolerance=plain["tolerance"],
        chunk=plain["chunk"],
        file=file,
    )


def _spread(plain: Mapping[str, Any]) -> Spread:
    given = dict(plain)
    return SPREADS[given.pop("kind")](**given)


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
    levels = (one.spread.levels for one in study.vary)
    return np.column_stack([level[place] for level, place in zip(levels, places, strict=True)])


def unit_samples(study: Study, start: int, count: int) -> Array:
    """Places of the same designs in the spread of each number, (count, d), above 0 and below 1.

    They are not correlated yet; `values_at` makes values of them.
    """
    if start < 0 or count < 0 or start + count > study.size:
        raise UsageError(
            f"got designs {start} to {start + count}; the study has {study.size}, from 0"
        )
    method = study.sampling.method
    if method == "grid":
        places = zip(_grid(study, start, count), study.shape, strict=True)
        return np.column_stack([(place + 0.5) / levels for place, levels in places])
    drawn = {"sobol": _sobol, "latin-hypercube": _latin_hypercube, "monte-carlo": _monte_carlo}
    return drawn[method](len(study.vary), study, start, count)


def values_at(study: Study, unit: Array) -> Array:
    """Values (n, d), SI units, at places (n, d) between 0 and 1, correlated as the study says.

    Correlations are those of a Gaussian copula: normal variables behind the places are mixed, which
    leaves the spread of each number as it is.
    """
    values = np.empty(np.shape(unit))
    for column, places in enumerate(_correlated(study, unit)):
        values[:, column] = study.vary[column].spread.at(places)
    return values


def _correlated(study: Study, unit: Array) -> list[Array]:
    """Columns (n,) of places, mixed where numbers are correlated."""
    places = list(np.asarray(unit).T)
    if study.correlations:
        from scipy.special import ndtr, ndtri

        columns, matrix = correlation_matrix(study.paths, study.correlations)
        behind = ndtri(np.clip([places[column] for column in columns], LEAST, MOST))
        mixed = np.clip(ndtr(np.linalg.cholesky(matrix) @ behind), LEAST, MOST)
        for column, place in zip(columns, mixed, strict=True):
            places[column] = place
    return places


# -- each method -----------------------------------------------------------------------------------


def _grid(study: Study, start: int, count: int) -> tuple[Array, ...]:
    """Place of each number in its levels, (count,) each; the last runs fastest."""
    return np.unravel_index(np.arange(start, start + count), study.shape)


def _monte_carlo(width: int, study: Study, start: int, count: int) -> Array:
    return _uniform(study.sampling.seed, DRAWS, width, start, count)


def _latin_hypercube(width: int, study: Study, start: int, count: int) -> Array:
    seed, size = study.sampling.seed, study.size
    places = _uniform(seed, JITTER, width, start, count)
    for column in range(width):
        places[:, column] += _shuffled(seed, column, size, start, count)
    places /= size
    return np.clip(places, LEAST, MOST, out=places)


def _sobol(width: int, study: Study, start: int, count: int) -> Array:
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


def _uniform(seed: int, use: int, width: int, start: int, count: int) -> Array:
    """Rows of one endless table of random numbers, (count, width), above 0 and below 1."""
    source = np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=(use,)))
    source.advance(start * width)  # one step a number
    drawn = np.random.Generator(source).random((count, width))
    return np.maximum(drawn, LEAST, out=drawn)


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
    sequence = np.random.SeedSequence(seed, spawn_key=(SHUFFLES, column))
    random = np.random.Generator(np.random.PCG64DXSM(sequence))
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
    from scipy.stats.qmc import Sobol

    if getattr(_ENGINES, "key", None) != key:
        seed, width = key
        sequence = np.random.SeedSequence(seed, spawn_key=(SEQUENCE,))
        scrambling = np.random.Generator(np.random.PCG64DXSM(sequence))
        _ENGINES.engine = Sobol(width, bits=BITS, seed=scrambling)
    engine: Sobol = _ENGINES.engine
    if engine.num_generated > start:
        engine.reset()
    if engine.num_generated < start:
        engine.fast_forward(start - engine.num_generated)
    return engine
