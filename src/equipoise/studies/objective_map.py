"""An objective of balancing over two numbers of a model, as a map shows it.

The machines are those of the model with some of its numbers changed, counterweights among them.
Where two of them differ in masses alone, every output is linear in the inertial parameters of the
links, so that a few machines tell all of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, nan, sin
from typing import Any

import numpy as np

from equipoise.balancing.design_variables import with_parameters
from equipoise.balancing.measures import measured, unit_of
from equipoise.balancing.optimisation import pin_of
from equipoise.balancing.problem import Problem
from equipoise.errors import EquipoiseError, MassError, ModelError, UsageError
from equipoise.mechanism.balance import Balance, Objective
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.mechanism.parameters import parameter_values
from equipoise.results.result import Result
from equipoise.studies.design_space import Model

Array = np.ndarray[Any, Any]
Value = Callable[[Mapping[str, float]], float]
"""An objective of the machine with these numbers; NaN where there is none or it cannot turn."""

COUNTERWEIGHT = re.compile(r"counterweights\.(?P<link>.+)\.(?P<key>mass|radius|direction)")
KEYS = {"mass": "mass", "radius": "length", "direction": "angle"}
"""Numbers of a counterweight, which no file has, and what they are."""


def dimension(model: Model, path: str) -> str | None:
    """What a number of the model or of a counterweight is; None of a plain one.

    Raises
    ------
    ModelError : there is no such number.
    """
    weight = COUNTERWEIGHT.fullmatch(path)
    if weight is None:
        return model.number(path)[1]
    machine = linkage_of(model.base())
    if weight["link"] not in machine.links:
        raise ModelError(path, unknown(weight["link"], machine.links, "link"))
    return KEYS[weight["key"]]


def linkage_of(model: Any) -> Machine:
    if not isinstance(model, Machine):
        raise UsageError("a map is of a linkage, and this is a tool; use `equipoise tool vary`")
    return model


# -- one machine -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Variants:
    """Machines of a model with numbers set in it."""

    model: Model
    given: Mapping[str, float]

    def parameters(self, point: Mapping[str, float]) -> tuple[Machine, Array]:
        """The machine without counterweights, and inertial parameters (links, 4) with them."""
        values = {**self.given, **point}
        own = {path: v for path, v in values.items() if not COUNTERWEIGHT.fullmatch(path)}
        machine = linkage_of(self.model.machine(own))
        found = parameter_values(machine).reshape(-1, 4).copy()
        for link, weight in _weights(values).items():
            pin = complex(*machine.links[link].points[pin_of(machine, link)])
            direction = weight["direction"]
            at = pin + weight["radius"] * complex(cos(direction), sin(direction))
            found[list(machine.links).index(link)] += weight["mass"] * np.array(
                [1.0, at.real, at.imag, abs(at) ** 2]
            )
        return machine, found

    def machine(self, point: Mapping[str, float]) -> Machine:
        """The machine with its counterweights."""
        if not any(COUNTERWEIGHT.fullmatch(path) for path in (*self.given, *point)):
            return linkage_of(self.model.machine({**self.given, **point}))
        machine, parameters = self.parameters(point)
        for link in _weights({**self.given, **point}):
            machine = with_parameters(machine, link, parameters[[*machine.links].index(link)])
        return machine


def _weights(values: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Counterweights by link; what is not given of them is 0."""
    found: dict[str, dict[str, float]] = {}
    for path, value in values.items():
        weight = COUNTERWEIGHT.fullmatch(path)
        if weight is not None:
            found.setdefault(weight["link"], dict.fromkeys(KEYS, 0.0))[weight["key"]] = value
    return found


def value_of(maker: Variants, of: Objective, point: Mapping[str, float]) -> float:
    """The objective of one machine; NaN where there is none or it cannot turn."""
    try:
        return Problem.value_of(maker.machine(point), of)
    except EquipoiseError:
        return nan


# -- many machines that differ in masses -----------------------------------------------------------


def linear_value(
    maker: Variants, of: Objective, points: Sequence[Mapping[str, float]]
) -> Value | None:
    """The objective by inertial parameters; None where more differs, or more than those count.

    On a few machines with a mass more on one link each, that link's part of the signal is found.
    """
    try:
        base, start = maker.parameters(points[0])
        others = [maker.parameters(points[k])[0] for k in (len(points) // 3, -1)]
        if not all(_moves_alike(base, one) for one in others) or not _counts_masses(base, of):
            return None
        signal = _signal(base, start, of)
        basis = {link: _beside(base, link) for link in base.links}
        columns = np.array(
            [
                [_signal(base, _with(start, k, more), of) - signal for more in basis[link]]
                for k, link in enumerate(base.links)
            ]
        )
    except EquipoiseError:
        return None
    shares = np.array([np.linalg.inv(basis[link]) for link in base.links])
    effects = np.einsum("lij,ljn->lin", shares, columns)

    def value(point: Mapping[str, float]) -> float:
        try:
            changed = maker.parameters(point)[1] - start
        except EquipoiseError:
            return nan
        return measured(signal + np.tensordot(changed, effects, 2), of.measure)

    return value


def _moves_alike(one: Machine, other: Machine) -> bool:
    """Whether two machines differ in masses alone."""
    points = all(one.links[name].points == other.links[name].points for name in one.links)
    return points and replace(one, links=other.links) == other


def _counts_masses(machine: Machine, of: Objective) -> bool:
    """Whether an output is linear in masses: a support swings otherwise with them, and gears change
    their flanks.
    """
    of_flanks = bool(machine.gears) and of.output.startswith("joints.")
    return not of.output.startswith("gauges.") and not of_flanks


def _signal(machine: Machine, parameters: Array, of: Objective) -> Array:
    for link, values in zip(machine.links, parameters, strict=True):
        machine = with_parameters(machine, link, values)
    (signal,) = Problem.signals_of(machine, of)
    return signal


def _beside(machine: Machine, link: str) -> Array:
    """Parameters (4, 4) of a mass at four places of a link, which together make any other."""
    arms = [abs(complex(*point)) for point in machine.links[link].points.values()]
    size, mass = max(arms, default=0.0) or 0.1, machine.mass or 1.0
    places = [0j, size + 0j, 1j * size, -size + 0j]
    return np.array([[mass, mass * z.real, mass * z.imag, mass * abs(z) ** 2] for z in places])


def _with(parameters: Array, row: int, more: Array) -> Array:
    """Parameters (links, 4) with more in a row."""
    changed = parameters.copy()
    changed[row] += more
    return changed


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
