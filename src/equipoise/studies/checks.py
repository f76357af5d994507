"""Checks of a study: what contradicts itself, and what cannot be computed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, isfinite, prod
from typing import Any, get_args

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.checks import unknown, wrong_text
from equipoise.studies.design_space import (
    KEYS,
    Choices,
    Command,
    Correlation,
    Make,
    Method,
    Model,
    Output,
    Range,
    Sampling,
    Vary,
)

METHODS, COMMANDS, MAKES = map(get_args, (Method, Command, Make))

MOST_DESIGNS = 1_000_000_000
MOST_VARIED, MOST_OUTPUTS, MOST_CHUNK, MOST_SEED = 1000, 1000, 10_000_000, 2**32 - 1
ANGLES, TOLERANCE = (8, 65_536), (1e-12, 0.1)
"""Fewest and most crank angles in a turn; least and largest tolerance of the figures."""
RESERVED = ("design", "done", "kept", "reason")
"""Names of columns that a store of designs has anyway."""


def check_numbers(model: Model, vary: Sequence[Vary]) -> list[tuple[float, str | None]]:
    """Number and dimension of everything that varies, as the model has it.

    Raises
    ------
    ModelError : nothing varies, or the model has no such number, or one of them twice.
    """
    if not vary:
        raise ModelError("vary", "there is none; give at least one [[vary]]")
    if len(vary) > MOST_VARIED:
        raise ModelError("vary", f"got {len(vary)}; at most {MOST_VARIED} numbers may vary")
    first: dict[str, int] = {}
    for number, one in enumerate(vary, 1):
        if one.path in first:
            raise ModelError(
                f"vary[{number}].path",
                f"{one.path} varies in vary[{first[one.path]}] already; leave one of them out",
            )
        first[one.path] = number
    numbers = []
    for path, number in first.items():
        if "/" in path:
            raise ModelError(
                f"vary[{number}].path", f"got {path!r}; no column can have / in its name, rename it"
            )
        try:
            numbers.append(model.number(path))
        except ModelError as error:
            raise ModelError(f"vary[{number}].path", error.what) from error
    try:
        model.machine({path: value for path, (value, _) in zip(first, numbers, strict=True)})
    except ModelError as error:
        place = f"vary[{first[error.where]}].path" if error.where in first else "model"
        what = error.what if error.where in first else f"{error.where}: {error.what}"
        raise ModelError(place, what) from error
    return numbers


# -- what varies, and how --------------------------------------------------------------------------


def wrong_spread(where: str, one: Vary, model: Model, method: Method) -> Iterator[ModelError]:
    spread = one.spread
    key = f"{where}.{KEYS[type(spread)]}"
    grid = method == "grid"
    if isinstance(model.number(one.path)[0], int):
        if spread.tolerance:
            yield ModelError(key, f"{one.path} is a whole number; give a range or a list")
        if isinstance(spread, Choices) and not all(map(float.is_integer, spread.values)):
            yield ModelError(key, f"{one.path} is a whole number; give whole numbers")
    if isinstance(spread, Range):
        if grid and spread.steps is None:
            yield ModelError(f"{where}.steps", "missing; a grid needs the number of values")
        if not grid and spread.steps is not None:
            yield ModelError(
                f"{where}.steps",
                f"goes with a grid, not with {method}; leave it out",
            )
    if grid and (not isinstance(spread, Range) or spread.steps is not None):
        try:
            _ = spread.levels
        except UsageError as error:
            yield ModelError(key, str(error))


def wrong_sampling(sampling: Sampling, vary: Sequence[Vary]) -> Iterator[ModelError]:
    if sampling.method not in METHODS:
        yield ModelError("sampling.method", unknown(sampling.method, METHODS, "method"))
    if sampling.method == "grid":
        size = prod(shape_of(vary))
        if sampling.designs is not None:
            yield ModelError(
                "sampling.designs",
                f"a grid has as many as its steps make, here {size}; leave it out",
            )
        if size > MOST_DESIGNS:
            yield ModelError(
                "sampling.method",
                f"the grid has {size:.3g} designs; at most {MOST_DESIGNS:.0e} are computed, give "
                "fewer steps, or another method",
            )
        return
    if sampling.designs is None:
        yield ModelError("sampling.designs", "missing; give how many, such as 65536")
        return
    if not 1 <= sampling.designs <= MOST_DESIGNS:
        yield ModelError("sampling.designs", f"got {sampling.designs}; give 1 to {MOST_DESIGNS}")
    if not 0 <= sampling.seed <= MOST_SEED:
        yield ModelError("sampling.seed", f"got {sampling.seed}; give 0 to {MOST_SEED}")


def wrong_correlations(
    correlations: Sequence[Correlation], vary: Sequence[Vary], method: Method
) -> Iterator[ModelError]:
    given: dict[frozenset[str], int] = {}
    spreads = {one.path: one.spread for one in vary}
    for number, one in enumerate(correlations, 1):
        where = f"correlations[{number}]"
        if method == "grid":
            yield ModelError(where, "a grid has no correlations; leave them out, or take sobol")
        for end, path in enumerate((one.first, one.second), 1):
            if path not in spreads:
                yield ModelError(f"{where}.between[{end}]", unknown(path, spreads, "[[vary]]"))
            elif isinstance(spreads[path], Choices):
                yield ModelError(
                    f"{where}.between[{end}]",
                    f"{path} is chosen from a list, which cannot be correlated; give it a range or "
                    "a tolerance",
                )
        pair = frozenset((one.first, one.second))
        if len(pair) == 1:
            yield ModelError(f"{where}.between", "got one number twice; give two different ones")
        if pair in given:
            yield ModelError(
                f"{where}.between",
                f"is given in correlations[{given[pair]}] already; leave one out",
            )
        given[pair] = number
        if not -1 < one.coefficient < 1:
            yield ModelError(
                f"{where}.coefficient",
                f"got {one.coefficient:g}; give a number between -1 and 1, without these",
            )
    try:
        np.linalg.cholesky(correlation_matrix([*spreads], correlations)[1])
    except np.linalg.LinAlgError:
        yield ModelError(
            "correlations",
            "the coefficients contradict each other, no numbers can have them all at once (their "
            "matrix is not positive definite); make some of them smaller",
        )


def correlation_matrix(
    paths: Sequence[str], correlations: Sequence[Correlation]
) -> tuple[list[int], np.ndarray[Any, Any]]:
    """Which of the varied numbers are correlated, and the matrix of these, (k, k)."""
    columns = sorted(
        {paths.index(path) for one in correlations for path in (one.first, one.second)}
    )
    matrix = np.eye(len(columns))
    for one in correlations:
        i, j = (columns.index(paths.index(path)) for path in (one.first, one.second))
        matrix[i, j] = matrix[j, i] = one.coefficient
    return columns, matrix


def shape_of(vary: Sequence[Vary]) -> tuple[int, ...]:
    """Of a grid: values of each number; the last runs fastest."""
    return tuple(len(one.spread.levels) for one in vary)


# -- what is computed ------------------------------------------------------------------------------


def wrong_outputs(
    outputs: Sequence[Output], paths: Sequence[str], kind: str
) -> Iterator[ModelError]:
    if not outputs:
        yield ModelError("outputs", "there is none; give at least one [[outputs]]")
    if len(outputs) > MOST_OUTPUTS:
        yield ModelError("outputs", f"got {len(outputs)}; at most {MOST_OUTPUTS} are computed")
    taken: dict[str, str] = {path: f"the path of vary[{n}]" for n, path in enumerate(paths, 1)}
    taken |= dict.fromkeys(RESERVED, "what every store of designs has")
    for number, output in enumerate(outputs, 1):
        where = f"outputs[{number}]"
        yield from _wrong_output(where, output, kind)
        if output.name in taken:
            yield ModelError(
                f"{where}.name",
                f"got {output.name!r}, which is {taken[output.name]}; give another name",
            )
        taken[output.name] = f"the name of {where}"


def _wrong_output(where: str, output: Output, kind: str) -> Iterator[ModelError]:
    if not output.value.strip():
        yield ModelError(f"{where}.value", "is empty; give the place of a figure")
    yield from wrong_text(f"{where}.value", output.value)
    yield from wrong_text(f"{where}.name", output.name)
    if (
        not output.name.strip()
        or "/" in output.name
        or "\\" in output.name
        or output.name[0] == "."
    ):
        yield ModelError(
            f"{where}.name",
            f"got {output.name!r}; give a name without / and without a point in front",
        )
    if output.of not in COMMANDS:
        yield ModelError(f"{where}.of", unknown(output.of, COMMANDS, "command"))
    elif (output.of == "tool") != (kind == "tool"):
        right = "tool" if kind == "tool" else "analyze, plant, respond or balance"
        yield ModelError(
            f"{where}.of", f"got {output.of!r}, but the model is a {kind}; give {right}"
        )
    if output.make not in (None, *MAKES):
        yield ModelError(f"{where}.make", f"got {output.make!r}; give smallest or largest")
    low = -inf if output.at_least is None else output.at_least
    high = inf if output.at_most is None else output.at_most
    for key, limit in (("at_least", output.at_least), ("at_most", output.at_most)):
        if limit is not None and not isfinite(limit):
            yield ModelError(f"{where}.{key}", f"got {limit}; give a finite number")
    if low > high:
        yield ModelError(where, "at_least is above at_most")


def wrong_accuracy(angles: int | None, tolerance: float, chunk: int) -> Iterator[ModelError]:
    fewest, most = ANGLES
    if angles is not None and not fewest <= angles <= most:
        yield ModelError("accuracy.angles", f"got {angles}; give {fewest} to {most} in a turn")
    least, largest = TOLERANCE
    if not least <= tolerance <= largest:
        yield ModelError("accuracy.tolerance", f"got {tolerance:g}; give {least:g} to {largest:g}")

    if not 0 <= chunk <= MOST_CHUNK:
        yield ModelError("chunk", f"got {chunk}; give 1 to {MOST_CHUNK} designs")
