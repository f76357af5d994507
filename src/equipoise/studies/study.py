"""A study as a value: what varies of which model, how, what is computed; its designs by number.

Nothing that was drawn before matters, so that designs can be computed in any order, by any number
of threads, processes and machines: a grid is counted through, a Sobol sequence is wound forward to
where it is asked for, pseudorandom numbers come from a generator that can jump, and the lists of a
Latin hypercube are shuffled number by number.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, field, fields, replace
from functools import lru_cache
from math import isqrt, prod
from typing import TYPE_CHECKING, Any, Literal, Protocol, get_args

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.requirements import Requirement
from equipoise.design.variables import KEYS, LEAST, MOST, SPREADS, Choices, Range, Variable
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, any_of, worded
from equipoise.keys.requirement_kinds import Asks, RequiredFigure, asks_of
from equipoise.limits import OUTPUTS, most_outputs
from equipoise.mechanism.checks import unknown, wrong_text
from equipoise.sequences import sobol
from equipoise.signals import Array

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol

    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine

Method = Literal["grid", "sobol", "latin-hypercube", "monte-carlo"]
StudiedCommand = Literal["analyze", "plant", "respond", "balance", "tool"]
METHODS, COMMANDS = get_args(Method), get_args(StudiedCommand)


class Model(Protocol):
    """A model file in which numbers can be replaced; `equipoise.schema.template.Template`."""

    @property
    def kind(self) -> Literal["linkage", "tool"]: ...

    def number(self, path: str) -> tuple[float, str | None]:
        """Number in the file in SI units, and its dimension; None for a plain number.

        An `int` where only whole numbers will do.
        """

    def words(self, path: str, others: Collection[str] = ()) -> Note | str:
        """Number in the file in words, beside others, or its path where it has none."""

    def base(self) -> Machine | Tool:
        """The model as its file has it."""

    def machine(self, values: Mapping[str, float]) -> Machine | Tool:
        """The model with other numbers, by path, in SI units."""

    def texts(self) -> dict[str, str]:
        """Everything that is needed to have the same model elsewhere."""


@dataclass(frozen=True, init=False)
class Output(RequiredFigure):
    """A figure that is computed of every design.

    name : of its column.
    of : the command that has it.  value : its place in that command's JSON object.
    dimension : where it is known.
    more : what is asked of it, by the key of a `RequirementKind`: `at_least` and `at_most`, limits
        in SI units, outside of which a design is not kept; `make`, whether it is to become the
        ``smallest`` or ``largest``.
    """

    name: str
    of: StudiedCommand = "analyze"
    value: str = ""
    dimension: str | None = None

    def __init__(
        self,
        name: str,
        of: StudiedCommand = "analyze",
        value: str = "",
        dimension: str | None = None,
        *,
        asks: Asks = (),
        **options: Any,
    ) -> None:
        given = {"name": name, "of": of, "value": value or name, "dimension": dimension}
        for key, item in (given | {"asks": asks_of(options, asks)}).items():
            object.__setattr__(self, key, item)

    @property
    def requirement(self) -> Requirement:
        """What it has to be."""
        return Requirement(
            self.value, asks=self.asks, turning=False
        )  # a cycle may have several turns

    def to_plain(self) -> dict[str, Any]:
        """As plain values, in SI units; ``Output(**plain)`` is the same again."""
        fields = {name: getattr(self, name) for name in ("name", "of", "value", "dimension")}
        return fields | self.asked_in("outputs")


@dataclass(frozen=True)
class Correlation:
    """Two tolerances that go together.

    coefficient : of the normal variables behind both; of two normal spreads it is their own.
    """

    first: str
    second: str
    coefficient: float


@dataclass(frozen=True)
class Sampling:
    """Which designs are computed.

    designs : their number; None of a grid.
    seed : of all random numbers.
    """

    method: Method = "sobol"
    designs: int | None = None
    seed: int = 1


CHUNK, SLOW_CHUNK = 65_536, 256
"""Designs that are computed and stored together: of analyses, and of whatever takes longer."""
MOST_DESIGNS = 1_000_000_000
"""Some days of computing where a design takes a microsecond."""
MOST_VARIED, MOST_CHUNK, MOST_SEED = 1000, 10_000_000, 2**32 - 1
"""Numbers that vary, outputs, designs of a chunk and seeds, each far beyond any use."""
ANGLES, TOLERANCE = (8, 65_536), (1e-12, 0.1)
"""Fewest and most crank angles in a turn; least and largest tolerance of the figures."""
RESERVED = ("design", "done", "kept", "reason")
"""Names of columns that a store of designs has anyway."""


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
    vary: tuple[Variable, ...]
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
        numbers = _numbers(self.model, self.vary)
        vary = tuple(_as_in(item, *number) for item, number in zip(self.vary, numbers, strict=True))
        object.__setattr__(self, "vary", vary)
        for problem in _problems(self):
            raise problem
        if not self.chunk:
            fast = all(output.of == "analyze" for output in self.outputs)
            object.__setattr__(self, "chunk", CHUNK if fast else SLOW_CHUNK)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the numbers that vary, in the order of the columns of all values."""
        return tuple(item.path for item in self.vary)

    @property
    def own(self) -> Array:
        """Values (d,) of these numbers as they stand in the model itself."""
        return np.array([self.model.number(path)[0] for path in self.paths], dtype=float)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the outputs, in the order of the columns of all figures."""
        return tuple(output.name for output in self.outputs)

    @property
    def shape(self) -> tuple[int, ...]:
        """Of a grid: values of each number; the last runs fastest."""
        return tuple(len(item.spread.levels) for item in self.vary)

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


def to_plain(study: Study) -> dict[str, Any]:
    """All but the model and the file as plain values, such as JSON takes; numbers in SI units."""
    plain = {item.name: getattr(study, item.name) for item in fields(study)}
    plain["outputs"] = [output.to_plain() for output in study.outputs]
    plain["correlations"] = [asdict(correlation) for correlation in study.correlations]
    plain["vary"] = [
        {**asdict(item), "spread": {"kind": KEYS[type(item.spread)], **asdict(item.spread)}}
        for item in study.vary
    ]
    title = getattr(study.title, "texts", study.title)
    plain |= {"title": title, "sampling": asdict(study.sampling)}
    return {name: value for name, value in plain.items() if name not in ("model", "file")}


def from_plain(plain: Mapping[str, Any], model: Model, file: str = "") -> Study:
    """The study of `to_plain`, exactly."""
    vary = []
    for entry in plain["vary"]:
        spread = dict(entry["spread"])
        vary.append(Variable(**{**entry, "spread": SPREADS[spread.pop("kind")](**spread)}))
    variables = {
        "title": worded(plain["title"]),
        "vary": tuple(vary),
        "outputs": tuple(Output(**item) for item in plain["outputs"]),
        "sampling": Sampling(**plain["sampling"]),
        "correlations": tuple(Correlation(**item) for item in plain["correlations"]),
    }
    return Study(**{**plain, **variables}, model=model, file=file)


# -- what varies, and how --------------------------------------------------------------------------


def _numbers(model: Model, vary: Sequence[Variable]) -> list[tuple[float, str | None]]:
    """Number and dimension of everything that varies, as the model has it."""
    if not vary:
        raise ModelError("vary", Note("there is none; give at least one [[vary]]"))
    if len(vary) > MOST_VARIED:
        raise ModelError(
            "vary",
            Note(
                "got {count}; at most {most_varied} numbers may vary",
                count=len(vary),
                most_varied=MOST_VARIED,
            ),
        )
    places: dict[str, str] = {}
    numbers = []
    for number, item in enumerate(vary, 1):
        where, path = f"vary[{number}]", item.path
        if path in places:
            note = Note(
                "{path} varies in {places} already; leave one of them out",
                path=path,
                places=places[path],
            )
            raise ModelError(f"{where}.path", note)
        if "/" in path:
            note = Note("got {path!r}; no column can have / in its name, rename it", path=path)
            raise ModelError(f"{where}.path", note)
        try:
            numbers.append(model.number(path))
        except ModelError as error:
            raise ModelError(f"{where}.path", error.what) from error
        places[path] = where
    try:
        model.machine({path: value for path, (value, _) in zip(places, numbers, strict=True)})
    except ModelError as error:
        if error.where in places:
            raise ModelError(f"{places[error.where]}.path", error.what) from error
        raise ModelError("model", at_place(error.where, error.what)) from error
    return numbers


def _as_in(variable: Variable, value: float, dimension: str | None) -> Variable:
    """Variable with what the model knows of the number."""
    spread = variable.spread
    if isinstance(value, int) and isinstance(spread, Range):
        spread = replace(spread, whole=True)
    return replace(variable, spread=spread, dimension=dimension)


def _problems(study: Study) -> Iterator[ModelError]:
    """What is wrong with a study beside its numbers, the first things first."""
    yield from wrong_text("title", study.title)
    for number, item in enumerate(study.vary, 1):
        yield from _wrong_spread(f"vary[{number}]", item, study)
    yield from _wrong_sampling(study)
    yield from _wrong_correlations(study)
    yield from _wrong_outputs(study)
    yield from _beyond("accuracy.angles", study.angles, *ANGLES, Note("in a turn"))
    yield from _beyond("accuracy.tolerance", study.tolerance, *TOLERANCE)
    yield from _beyond("chunk", study.chunk or None, 1, MOST_CHUNK, Note("designs"))


def _beyond(
    where: str, given: float | None, least: float, most: float, unit: Note | None = None
) -> Iterator[ModelError]:
    if given is not None and not least <= given <= most:
        got, low, high = (n if isinstance(n, int) else f"{n:g}" for n in (given, least, most))
        what = Note("got {given}; give {low} to {high}", given=got, low=low, high=high)
        what = what if unit is None else Note("{sentence} {unit}", sentence=what, unit=unit)
        yield ModelError(where, what)


def _wrong_spread(where: str, variable: Variable, study: Study) -> Iterator[ModelError]:
    spread, method = variable.spread, study.sampling.method
    key = f"{where}.{KEYS[type(spread)]}"
    if isinstance(study.model.number(variable.path)[0], int):
        if spread.tolerance:
            yield ModelError(
                key, Note("{path} is a whole number; give a range or a list", path=variable.path)
            )
        if isinstance(spread, Choices) and not all(map(float.is_integer, spread.values)):
            yield ModelError(
                key, Note("{path} is a whole number; give whole numbers", path=variable.path)
            )
    grid = method == "grid"
    if isinstance(spread, Range) and grid != (spread.steps is not None):
        missing = Note("missing; a grid needs the number of values")
        other = Note("goes with a grid, not with {method}; leave it out", method=method)
        yield ModelError(f"{where}.steps", missing if grid else other)
    elif grid:
        try:
            _ = spread.levels
        except UsageError as error:
            yield ModelError(key, error.note)


def _wrong_sampling(study: Study) -> Iterator[ModelError]:
    sampling = study.sampling
    if sampling.method not in METHODS:
        yield ModelError("sampling.method", unknown(sampling.method, METHODS, "method"))
    if sampling.method == "grid":
        if sampling.designs is not None:
            note = Note(
                "a grid has as many as its steps make, here {size}; leave it out", size=study.size
            )
            yield ModelError("sampling.designs", note)
        if study.size > MOST_DESIGNS:
            yield ModelError(
                "sampling.method",
                Note(
                    "the grid has {size:.3g} designs; at most {most_designs:.0e} are "
                    "computed, give fewer steps, or another method",
                    size=study.size,
                    most_designs=MOST_DESIGNS,
                ),
            )
    elif sampling.designs is None:
        yield ModelError("sampling.designs", Note("missing; give how many, such as 65536"))
    else:
        yield from _beyond("sampling.designs", sampling.designs, 1, MOST_DESIGNS)
        yield from _beyond("sampling.seed", sampling.seed, 0, MOST_SEED)


def _wrong_correlations(study: Study) -> Iterator[ModelError]:
    given: dict[frozenset[str], int] = {}
    spreads = {item.path: item.spread for item in study.vary}
    for number, correlation in enumerate(study.correlations, 1):
        where = f"correlations[{number}]"
        if study.sampling.method == "grid":
            yield ModelError(
                where, Note("a grid has no correlations; leave them out, or take sobol")
            )
        for end, path in enumerate((correlation.first, correlation.second), 1):
            if path not in spreads:
                yield ModelError(f"{where}.between[{end}]", unknown(path, spreads, "[[vary]]"))
            elif isinstance(spreads[path], Choices):
                yield ModelError(
                    f"{where}.between[{end}]",
                    Note(
                        "{path} is chosen from a list, which cannot be correlated; give it a "
                        "range or a tolerance",
                        path=path,
                    ),
                )
        pair = frozenset((correlation.first, correlation.second))
        if len(pair) == 1:
            yield ModelError(
                f"{where}.between", Note("got one number twice; give two different ones")
            )
        if pair in given:
            note = Note(
                "is given in correlations[{given}] already; leave one out", given=given[pair]
            )
            yield ModelError(f"{where}.between", note)
        given[pair] = number
        if not -1 < correlation.coefficient < 1:
            note = Note(
                "got {coefficient:g}; give a number between -1 and 1, without these",
                coefficient=correlation.coefficient,
            )
            yield ModelError(f"{where}.coefficient", note)
    try:
        np.linalg.cholesky(correlation_matrix(study.paths, study.correlations)[1])
    except np.linalg.LinAlgError:
        yield ModelError(
            "correlations",
            Note(
                "the coefficients contradict each other, no numbers can have them all at "
                "once (their matrix is not positive definite); make some of them smaller"
            ),
        )


def correlation_matrix(
    paths: Sequence[str], correlations: Sequence[Correlation]
) -> tuple[list[int], np.ndarray[Any, Any]]:
    """Which of the varied numbers are correlated, and the matrix of these, (k, k)."""
    columns = sorted(
        {
            paths.index(path)
            for correlation in correlations
            for path in (correlation.first, correlation.second)
        }
    )
    matrix = np.eye(len(columns))
    for item in correlations:
        i, j = (columns.index(paths.index(path)) for path in (item.first, item.second))
        matrix[i, j] = matrix[j, i] = item.coefficient
    return columns, matrix


# -- what is computed ------------------------------------------------------------------------------


def _wrong_outputs(study: Study) -> Iterator[ModelError]:
    outputs = study.outputs
    if not outputs:
        yield ModelError("outputs", Note("there is none; give at least one [[outputs]]"))
    if len(outputs) > (most := most_outputs()):
        yield ModelError(
            "outputs",
            Note(
                "got {count}; at most {most} are computed, unless {variable}={count} is set in the "
                "environment",
                count=len(outputs),
                most=most,
                variable=OUTPUTS,
            ),
        )
    taken = {
        path: Note("the path of {place}", place=f"vary[{n}]")
        for n, path in enumerate(study.paths, 1)
    }
    taken |= dict.fromkeys(RESERVED, Note("what every store of designs has"))
    for number, output in enumerate(outputs, 1):
        where = f"outputs[{number}]"
        yield from _wrong_output(where, output, study.model.kind)
        if output.name in taken:
            note = Note(
                "got {name!r}, which is {taken}; give another name",
                name=output.name,
                taken=taken[output.name],
            )
            yield ModelError(f"{where}.name", note)
        taken[output.name] = Note("the name of {place}", place=where)


def _wrong_output(where: str, output: Output, kind: str) -> Iterator[ModelError]:
    if not output.value.strip():
        yield ModelError(f"{where}.value", Note("is empty; give the place of a figure"))
    yield from wrong_text(f"{where}.value", output.value)
    yield from wrong_text(f"{where}.name", output.name)
    if not output.name.strip() or not {"/", "\\"}.isdisjoint(output.name) or output.name[0] == ".":
        note = Note(
            "got {name!r}; give a name without / and without a point in front", name=output.name
        )
        yield ModelError(f"{where}.name", note)
    if output.of not in COMMANDS:
        yield ModelError(f"{where}.of", unknown(output.of, COMMANDS, "command"))
    elif (output.of == "tool") != (kind == "tool"):
        names = ["tool"] if kind == "tool" else ["analyze", "plant", "respond", "balance"]
        note = Note(
            "got {of!r}, but the model is a tool; give {right}"
            if kind == "tool"
            else "got {of!r}, but the model is a linkage; give {right}",
            of=output.of,
            right=any_of(names, commas=True),
        )
        yield ModelError(f"{where}.of", note)
    for key, given, right in output.wrong_asks():
        yield ModelError(f"{where}.{key}", Note("got {given}; {right}", given=given, right=right))
    if None not in (output.at_least, output.at_most) and output.at_least > output.at_most:  # type: ignore[operator]
        yield ModelError(where, Note("at_least is above at_most"))


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
