"""An objective of balancing over two numbers of a model, as a map shows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import nan
from typing import Any

import numpy as np

from equipoise.balancing.measures import unit_of
from equipoise.errors import MassError, ModelError, UsageError
from equipoise.mechanism.balance import Balance, Objective
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.results.result import Result
from equipoise.studies.study import Model
from equipoise.studies.objective_map import COUNTERWEIGHT, Variants, Value, dimension, linear_value, linkage_of, value_of

Array = np.ndarray[Any, Any]
Progress = Callable[[int, int], None]

MOST = 1_000
"""Values of either number."""
CLOSE = 1e-7
"""Share of the ranges to which the best place is found."""


@dataclass(frozen=True, eq=False, repr=False)
class Landscape(Result):
    """An objective over two numbers, SI units and radians.

    machine : as the model has it.
    paths : of the two numbers.
    given : other numbers that were set, by path.
    dimensions : what each of all these is, by path; None of plain numbers.
    x, y : their values, (X,) and (Y,).
    values : of the objective, (Y, X); NaN where the linkage cannot turn.
    unit : of the values.
    best : the two numbers where the objective is least, between the grid's points too.
    least : its value there.
    start : the two numbers as the model has them; None where it does not, or `given` changes more.
    before : the objective there, NaN where the linkage cannot turn.
    """

    machine: Machine
    objective: Objective
    paths: tuple[str, str]
    given: Mapping[str, float]
    dimensions: Mapping[str, str | None]
    x: Array
    y: Array
    values: Array
    unit: str
    best: tuple[float, float]
    least: float
    start: tuple[float, float] | None
    before: float

    @property
    def at_edge(self) -> list[str]:
        """Which of the two numbers is least at an end of its range: beyond it, it may be less."""
        ranges = zip(self.paths, self.best, (self.x, self.y), strict=True)
        ends = [(path, best, one[[0, -1]]) for path, best, one in ranges]
        return [p for p, best, end in ends if np.min(np.abs(end - best)) <= CLOSE * np.ptp(end)]

    def to_dict(self) -> dict[str, Any]:
        """As plain values; what is NaN in `values` stays so."""
        first, second = self.paths
        return {
            "title": self.machine.title,
            "objective": self.objective.name,
            "unit": self.unit,
            "given": dict(self.given),
            "over": {first: self.x, second: self.y},
            "values": self.values,
            "best": dict(zip(self.paths, self.best, strict=True)),
            "at_edge": self.at_edge,
            "least": self.least,
            "before": self.before,
        }


def landscape(
    model: Model,
    over: Mapping[str, Sequence[float] | Array],
    of: Objective,
    given: Mapping[str, float] | None = None,
    progress: Progress | None = None,
) -> Landscape:
    """An objective of balancing at every pair of values of two numbers.

    Beside the numbers of the model, ``counterweights.LINK.mass``, ``.radius`` and ``.direction``
    are those of a point mass on a link, about its pin in the frame and in the link's axes.

    Parameters
    ----------
    model : such as ``Template.load("yamashita-1")``.
    over : two paths with their rising values, SI units and radians; the first is drawn along x.
    of : what is told, such as ``Objective("shaking_force.y", "ripple")``.
    given : other numbers to set first, by path.
    progress : called with how many machines are analysed, and how many there are.

    Raises
    ------
    ModelError : there is no such number.
    UsageError : other than two numbers, or no values to draw, or no machine of them can turn.
    MassError : a link has no mass given.
    """
    if isinstance(model, Machine):
        raise UsageError("got a machine; give the model whose numbers vary, Template.of(machine)")
    linkage_of(model.base())
    given = dict(given or {})
    paths, values = _checked(over, given)
    dimensions = {path: dimension(model, path) for path in (*paths, *given)}
    maker = Variants(model, given)
    base = maker.machine({})
    if missing := massless(base):
        raise MassError(missing)
    _check_output(base, of)
    _check_weights({**given, **{path: one[-1] for path, one in zip(paths, values, strict=True)}})
    x, y = values
    points = [dict(zip(paths, pair, strict=True)) for pair in _pairs(x, y)]
    value = linear_value(maker, of, points) or (lambda point: value_of(maker, of, point))
    found = np.empty(len(points))
    for k, point in enumerate(points):
        found[k] = value(point)
        if progress is not None:
            progress(k + 1, len(points))
    if np.all(np.isnan(found)):
        raise UsageError(f"no linkage turns with {paths[0]} and {paths[1]} in these ranges")
    best, least = _refined(value, points[int(np.nanargmin(found))], x, y)
    start = _start(model, paths, given)
    return Landscape(
        base.with_balance(None),
        of,
        paths,
        given,
        dimensions,
        x,
        y,
        found.reshape(len(y), len(x)),
        unit_of(of, base),
        best,
        least,
        start,
        nan if start is None else value(dict(zip(paths, start, strict=True))),
    )


def _check_output(machine: Machine, of: Objective) -> None:
    try:
        machine.with_balance(Balance(objectives=(of,)))
    except ModelError as error:  # of a plan that nobody has written
        raise UsageError(error.what) from error


def _checked(
    over: Mapping[str, Sequence[float] | Array], given: Mapping[str, float]
) -> tuple[tuple[str, str], list[Array]]:
    if len(over) != 2:
        raise UsageError(f"got {len(over)} numbers to vary; a map is over two, give two paths")
    for path in over:
        if path in given:
            raise UsageError(f"{path} is to vary and is set too; give one of both")
    values = [np.asarray(one, float) for one in over.values()]
    for path, one in zip(over, values, strict=True):
        rising = one.ndim == 1 and bool(np.all(np.isfinite(one)) and np.all(np.diff(one) > 0))
        if not rising or not 2 <= len(one) <= MOST:
            raise UsageError(f"{path}: give 2 to {MOST} rising values in SI units")
    for path, low in [*given.items(), *((p, v[0]) for p, v in zip(over, values, strict=True))]:
        weight = COUNTERWEIGHT.fullmatch(path)
        if weight is not None and weight["key"] != "direction" and low < 0:
            raise UsageError(f"{path}: got less than 0; give 0 or more")
    first, second = over
    return (first, second), values


def _check_weights(largest: Mapping[str, float]) -> None:
    """A counterweight without a mass changes nothing wherever it is."""
    for path in largest:
        weight = COUNTERWEIGHT.fullmatch(path)
        mass = None if weight is None else f"counterweights.{weight['link']}.mass"
        if mass is not None and not largest.get(mass):
            raise UsageError(f'{path}: the counterweight has no mass; set {mass}, such as "1 kg"')


def _start(
    model: Model, paths: tuple[str, str], given: Mapping[str, float]
) -> tuple[float, float] | None:
    """The two numbers as the model has them."""
    if given or any(COUNTERWEIGHT.fullmatch(path) for path in paths):
        return None
    first, second = (float(model.number(path)[0]) for path in paths)
    return first, second


def _pairs(x: Array, y: Array) -> list[tuple[float, float]]:
    return [(one, other) for other in y.tolist() for one in x.tolist()]


def _refined(
    value: Value, start: Mapping[str, float], x: Array, y: Array
) -> tuple[tuple[float, float], float]:
    """The best place about the best point of the grid, and the objective there."""
    from scipy.optimize import minimize

    low = np.array([x[0], y[0]])
    width = np.array([x[-1], y[-1]]) - low
    begin = (np.array([*start.values()]) - low) / width
    steps = np.diag([1 / (len(x) - 1), 1 / (len(y) - 1)])
    simplex = begin + np.vstack([[0.0, 0.0], np.where(begin > 0.5, -steps, steps)])

    def at(share: Array) -> float:
        here = low + np.clip(share, 0.0, 1.0) * width
        found = value(dict(zip(start, here.tolist(), strict=True)))
        return np.inf if np.isnan(found) else found

    least = at(begin)
    options = {"initial_simplex": simplex, "xatol": CLOSE, "fatol": 1e-12 * least, "maxiter": 400}
    found = minimize(at, begin, method="Nelder-Mead", bounds=[(0, 1), (0, 1)], options=options)
    better = found.x if found.fun < least else begin
    first, second = (low + np.clip(better, 0.0, 1.0) * width).tolist()
    return (first, second), min(float(found.fun), least)
