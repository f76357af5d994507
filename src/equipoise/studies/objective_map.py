"""An objective of balancing over two numbers of a model, as a map shows it.

The machines are those of the model with some of its numbers changed, counterweights among them.
Where two of them differ in masses alone, every output is linear in the inertial parameters of the
links, so that one of them determines all.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from math import nan, pi
from typing import Any, Self

import numpy as np

from equipoise.balancing.design_variables import LinkParameters, with_parameters
from equipoise.balancing.effects import Effects, Signal
from equipoise.balancing.objectives import (
    LinearizationPoint,
    mean_square_rows,
    measured_each,
    signals_of,
    unit_of,
)
from equipoise.balancing.problem import Problem
from equipoise.balancing.room import pin_of
from equipoise.codegen.backends import extremes_of, highest_of, processors
from equipoise.codegen.extremes import GridTops, PanelTops
from equipoise.dataclass import dataclass
from equipoise.design.evaluator import ChunkTask, Pool, PooledEvaluator
from equipoise.errors import EquipoiseError, MassError, ModelError, UsageError, at_place
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.family import invalid_designs, with_columns
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.parameters import parameters_of
from equipoise.mechanism.parts.balance import GAUGES, Balance, Objective, Statistic, output_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import ProgressCallback, Result
from equipoise.signals import Array, highest_at
from equipoise.studies.clusters import elsewhere
from equipoise.studies.study import Model

MapPoint = Mapping[str, float]
ObjectiveFunction = Callable[[Array], Array]
"""An objective (P,) at values (P, 2) of the two numbers; NaN where the linkage cannot turn."""


MOST = 1_000
"""Values of either number."""
CLOSE = 1e-7
"""Share of the ranges to which the best place is found."""
LINEAR_AT_ONCE = 65_536
"""Machines that differ in masses, after which progress is reported."""
AT_ONCE = 128
"""Machines whose signals are computed at a time, so that these stay in the processor's cache."""
COUNTERWEIGHT = re.compile(r"counterweights\.(?P<link>.+)\.(?P<key>mass|radius|direction)")
KEYS = {"mass": "mass", "radius": "length", "direction": "angle"}
"""Numbers of a counterweight, which no file has, and what they are."""


def number_description(
    model: Model, path: str, others: Collection[str] = ()
) -> tuple[str | None, Note | str]:
    """Dimension (None if dimensionless) and name of a number of the model or of a counterweight.

    Raises
    ------
    ModelError : there is no such number.
    """
    weight = COUNTERWEIGHT.fullmatch(path)
    if weight is None:
        return model.number(path)[1], model.words(path, others)
    machine = linkage_of(model.base())
    if weight["link"] not in machine.links:
        raise ModelError(path, unknown(weight["link"], machine.links, "link"))
    words = to_say("{what} of the counterweight on the {name}")
    return KEYS[weight["key"]], Note(words, what=Note(weight["key"]), name=weight["link"])


def linkage_of(model: Any) -> Machine:
    if not isinstance(model, Machine):
        raise UsageError(
            Note("a map is of a linkage, and this is a tool; use `equipoise tool vary`")
        )
    return model


# -- one machine -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class MachineVariants:
    """Machines of a model with numbers set in it."""

    model: Model
    given: Mapping[str, float]

    def parameters(self, point: MapPoint) -> tuple[Machine, dict[str, Array]]:
        """The machine without counterweights, and inertial parameters (4,) by link with them."""
        values = {**self.given, **point}
        own = {path: v for path, v in values.items() if not COUNTERWEIGHT.fullmatch(path)}
        machine = linkage_of(self.model.machine(own))
        return machine, inertial_parameters(machine, values)

    def machine(self, point: Mapping[str, float]) -> Machine:
        """The machine with its counterweights."""
        weights = _weights({**self.given, **point})
        if not weights:
            return linkage_of(self.model.machine({**self.given, **point}))
        machine, parameters = self.parameters(point)
        for link in weights:
            machine = with_parameters(machine, link, parameters[link])
        return machine


@dataclass(frozen=True, eq=False)
class SingleValues:
    """An objective of machines that are computed one by one."""

    maker: MachineVariants
    of: Objective
    paths: tuple[str, str]

    def __call__(self, points: Array) -> Array:
        """The objective (P,) at values (P, 2); NaN where there is none or it cannot turn."""
        return np.array(
            [self._value(dict(zip(self.paths, point, strict=True))) for point in points.tolist()]
        )

    def _value(self, point: MapPoint) -> float:
        try:
            return Problem.value_of(self.maker.machine(point), self.of)
        except EquipoiseError:
            return nan


def inertial_parameters(machine: Machine, values: Mapping[str, Any]) -> dict[str, Array]:
    """Inertial parameters (..., 4) by link, with counterweights by their numbers in SI units.

    Numbers may be columns (P, 1), of which there are (P, 1, 4) then.
    """
    arrays = {
        name: np.stack(np.broadcast_arrays(*parameters_of(link)), axis=-1)
        for name, link in machine.links.items()
    }
    for link, weight in _weights(values).items():
        pin = complex(*machine.links[link].points[pin_of(machine, link)])
        at = pin + weight["radius"] * np.exp(1j * np.asarray(weight["direction"]))
        point_mass = np.stack(np.broadcast_arrays(1.0, at.real, at.imag, abs(at) ** 2), axis=-1)
        arrays[link] = arrays[link] + np.expand_dims(weight["mass"], -1) * point_mass
    return arrays


def _weights(values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Counterweights by link; what is not given of them is 0."""
    items: dict[str, dict[str, Any]] = {}
    for path, value in values.items():
        weight = COUNTERWEIGHT.fullmatch(path)
        if weight is not None:
            items.setdefault(weight["link"], dict.fromkeys(KEYS, 0.0))[weight["key"]] = value
    return items


# -- many machines that differ in masses -----------------------------------------------------------


@dataclass(frozen=True, eq=False)
class LinearValues:
    """An objective that is linear in inertial parameters, of many machines at once.

    maker, paths : the machines, and which two numbers vary.
    machine : the first of them, from which changes count.
    start : its inertial parameters (4,) by link, with counterweights.
    signal : the output, with a column for each parameter in the order of `start`.
    """

    maker: MachineVariants
    paths: tuple[str, str]
    machine: Machine
    start: Mapping[str, Array]
    signal: Signal
    measure: Statistic

    @classmethod
    def of(
        cls, maker: MachineVariants, of: Objective, paths: tuple[str, str], points: Array
    ) -> Self | None:
        """None where more than masses differs at points (P, 2), or more than those counts."""
        named = [
            dict(zip(paths, points[k].tolist(), strict=True)) for k in (0, len(points) // 3, -1)
        ]
        try:
            (base, start), *others = map(maker.parameters, named)
            if not _differ_in_masses(base, [machine for machine, _ in others], of):
                return None
            machine = base
            for link, values in start.items():
                machine = with_parameters(machine, link, values)
            effects = Effects(machine, [LinkParameters(link) for link in base.links])
            (signal,) = signals_of(effects, of, LinearizationPoint(machine))
        except EquipoiseError:
            return None
        return cls(maker, paths, base, start, signal, of.measure)

    def __call__(self, points: Array) -> Array:
        """The objective (P,) at values (P, 2); NaN where no machine can have these."""
        changes = self._changes(points)
        moving = np.any(changes != 0, axis=0)  # NaN counts
        columns, changes = self.signal.columns[moving], changes[:, moving]
        signal = replace(self.signal, columns=columns)
        if self.measure in {"rms", "ripple"}:
            matrix, vector = mean_square_rows(signal, self.measure)
            return np.asarray(np.linalg.norm(changes @ matrix.T + vector, axis=1))
        if self.measure in {"peak", "peak_to_peak"}:
            return self._extremes(signal, changes)
        each = (
            measured_each(signal.at(part), self.measure, signal.sampling)
            for part in _parts(changes)
        )
        return np.concatenate([*each])

    def _extremes(self, signal: Signal, changes: Array) -> Array:
        """Peaks (P,), or peaks to peaks, of the curve of a signal for changes (P, K)."""
        sampling = signal.sampling
        curve = GridTops(2 * pi) if sampling is None else PanelTops(sampling)
        both = curve.in_order(np.vstack([signal.columns, signal.start]))
        axes = [both.real, both.imag] if np.iscomplexobj(both) else [both]
        matrices = [np.ascontiguousarray(axis) for axis in axes]

        def of(part: Array) -> Array:
            shares = np.column_stack([part, np.ones(len(part))])
            values = shares @ matrices[0]
            if len(matrices) == 2:
                np.square(values, out=values)
                values += np.square(shares @ matrices[1])
                return highest_of(curve, np.sqrt(values, out=values))
            high, low = extremes_of(curve, values)
            return np.maximum(high, -low) if self.measure == "peak" else high - low

        with ThreadPoolExecutor(processors()) as pool:
            return np.concatenate([*pool.map(of, _parts(changes))])

    def _changes(self, points: Array) -> Array:
        """Changes (P, 4 L) of inertial parameters; NaN where no machine can have these numbers."""
        columns = {path: points[:, [k]] for k, path in enumerate(self.paths)}
        own = {
            path: column for path, column in columns.items() if not COUNTERWEIGHT.fullmatch(path)
        }
        try:
            machine = with_columns(self.machine, own)
        except UsageError:  # a number that follows from others in the file
            return np.array([self._change(point) for point in points])
        with np.errstate(all="ignore"):
            arrays = inertial_parameters(machine, {**self.maker.given, **columns})
        change = np.empty((len(points), 4 * len(self.start)))
        for k, (link, start) in enumerate(self.start.items()):
            change[:, 4 * k : 4 * k + 4] = arrays[link].reshape(-1, 4) - start
        if own:
            change[invalid_designs(machine, assemble(self.machine), own)] = nan
        return change

    def _change(self, point: Array) -> Array:
        """Change of parameters (4 L,) of one machine."""
        try:
            parameter = self.maker.parameters(dict(zip(self.paths, point.tolist(), strict=True)))[1]
        except EquipoiseError:
            return np.full(4 * len(self.start), nan)
        return np.concatenate([parameter[link] - own for link, own in self.start.items()])


def _parts(changes: Array) -> Iterator[Array]:
    return (changes[k : k + AT_ONCE] for k in range(0, len(changes), AT_ONCE))


def _differ_in_masses(base: Machine, others: Sequence[Machine], of: Objective) -> bool:
    """Whether machines differ in masses alone, and an output is linear in them.

    A support swings otherwise with them, and contacts change sides.
    """
    if of.output.startswith(GAUGES) or not output_of(of.output, base).linear_in(base):
        return False
    places = {name: link.points for name, link in base.links.items()}
    return all(
        replace(base, links=item.links) == item
        and {name: link.points for name, link in item.links.items()} == places
        for item in others
    )


# -- the map ---------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, repr=False)
class Landscape(Result):
    """An objective over two numbers, SI units and radians.

    machine : as the model has it.
    paths : of the two numbers.
    given : other numbers that were set, by path.
    dimensions : what each of all these is, by path; None of plain numbers.
    words : what each is called.
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
    words: Mapping[str, Note | str]
    x: Array
    y: Array
    values: Array
    unit: str
    best: tuple[float, float]
    least: float
    start: tuple[float, float] | None
    before: float

    blocks_in = "studies.blocks.landscape_blocks"
    pictures_in = "figures.studies.landscape_charts"

    @property
    def at_edge(self) -> list[str]:
        """Which of the two numbers is least at an end of its range: beyond it, it may be less."""
        ranges = zip(self.paths, self.best, (self.x, self.y), strict=True)
        ends = [(path, best, item[[0, -1]]) for path, best, item in ranges]
        return [p for p, best, end in ends if np.min(np.abs(end - best)) <= CLOSE * np.ptp(end)]

    def to_dict(self) -> dict[str, Any]:
        """As plain values; what is NaN in `values` stays so."""
        return {
            "title": self.machine.title,
            "objective": self.objective.name,
            "unit": self.unit,
            "given": dict(self.given),
            "over": dict(zip(self.paths, (self.x, self.y), strict=True)),
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
    progress: ProgressCallback | None = None,
    workers: int | None = None,
    cluster: str | None = None,
) -> Landscape:
    """An objective of balancing at every pair of values of two numbers.

    Beside the numbers of the model, ``counterweights.LINK.mass``, ``.radius`` and ``.direction``
    are those of a point mass on a link, about its pin in the frame and in the link's axes.

    Parameters
    ----------
    model : such as ``Template.load("yamashita-1")``.
    over : two paths with their rising values, SI units and radians; the first is drawn along x.
    of : the figure, such as ``Objective("shaking_force.y", "ripple")``.
    given : other numbers to set first, by path.
    progress : called with how many machines are analysed, and how many there are.
    workers : processes that analyse machines one by one, where that takes more than some seconds;
        as many as this machine has processors if not given.
    cluster : address of a Dask scheduler whose workers analyse them instead.

    Raises
    ------
    ModelError : there is no such number.
    UsageError : other than two numbers, or no values to draw, or no machine of them can turn.
    MassError : a link has no mass given.
    """
    if isinstance(model, Machine):
        raise UsageError(
            Note("got a machine; give the model whose numbers vary, Template.of(machine)")
        )
    linkage_of(model.base())
    given = dict(given or {})
    paths, columns = _checked(over, given)
    descriptions = {path: number_description(model, path, paths) for path in (*paths, *given)}
    dimensions = {path: kind for path, (kind, _) in descriptions.items()}
    words = {path: item for path, (_, item) in descriptions.items()}
    maker = MachineVariants(model, given)
    base = maker.machine({})
    if missing := massless(base):
        raise MassError(missing)
    try:
        base.with_balance(Balance(objectives=(of,)))
    except ModelError as error:  # of a plan that nobody has written
        raise UsageError(error.what) from error
    ends = (dict(zip(paths, (item[k] for item in columns), strict=True)) for k in (0, -1))
    _check_weights(*({**given, **end} for end in ends))
    x, y = columns
    points = np.stack([item.ravel() for item in np.meshgrid(x, y)], axis=1)
    linear = LinearValues.of(maker, of, paths, points)
    value = linear or SingleValues(maker, of, paths)
    computed = _computed(value, points, progress, workers, elsewhere(cluster, workers))
    if np.all(np.isnan(computed)):
        raise UsageError(
            Note(
                "no linkage turns with {paths} and {paths_2} in these ranges",
                paths=paths[0],
                paths_2=paths[1],
            )
        )
    lowest = int(highest_at(np.where(np.isnan(computed), -np.inf, -computed), smooth=False))
    best, least = _refined(value, points[lowest], x, y)
    start, before = None, nan
    if not given and not any(COUNTERWEIGHT.fullmatch(path) for path in paths):
        start = float(model.number(paths[0])[0]), float(model.number(paths[1])[0])
        before = float(value(np.array([start]))[0])
    values = computed.reshape(len(y), len(x))
    fields = (of, paths, given, dimensions, words, x, y, values, unit_of(of, base))
    return Landscape(base.with_balance(None), *fields, best, least, start, before)


def _computed(
    value: LinearValues | SingleValues,
    points: Array,
    progress: ProgressCallback | None,
    workers: int | None,
    others: Callable[[ChunkTask], Pool] | None,
) -> Array:
    """The objective (P,) at points (P, 2); what is analysed one by one is shared out."""
    report = None if progress is None else lambda done: progress(done, len(points))
    linear = isinstance(value, LinearValues)
    make = partial(_itself, value)
    if linear:
        others = None  # to send them takes longer than to compute them
    with PooledEvaluator(
        value, make, np.concatenate, workers, shared=not linear, elsewhere=others
    ) as evaluate:
        if not linear:
            return evaluate(points, report)
        result = []
        for k in range(0, len(points), LINEAR_AT_ONCE):
            result.append(evaluate(points[k : k + LINEAR_AT_ONCE]))
            if report is not None:
                report(min(k + LINEAR_AT_ONCE, len(points)))
        return np.concatenate(result)


def _itself(value: ObjectiveFunction) -> ObjectiveFunction:
    return value


def _checked(
    over: Mapping[str, Sequence[float] | Array], given: Mapping[str, float]
) -> tuple[tuple[str, str], list[Array]]:
    if len(over) != 2:
        raise UsageError(
            Note("got {count} numbers to vary; a map is over two, give two paths", count=len(over))
        )
    if both := [path for path in over if path in given]:
        raise UsageError(Note("{both} is to vary and is set too; give one of both", both=both[0]))
    values = [np.asarray(item, float) for item in over.values()]
    for path, value in zip(over, values, strict=True):
        rising = value.ndim == 1 and bool(np.all(np.isfinite(value)) and np.all(np.diff(value) > 0))
        if not rising or not 2 <= len(value) <= MOST:
            raise UsageError(
                at_place(path, Note("give 2 to {most} rising values in SI units", most=MOST))
            )
    first, second = over
    return (first, second), values


def _check_weights(lowest: Mapping[str, float], largest: Mapping[str, float]) -> None:
    """Counterweights by the least and the largest values that are drawn.

    One without a mass changes nothing wherever it is.
    """
    for path, low in lowest.items():
        weight = COUNTERWEIGHT.fullmatch(path)
        if weight is None:
            continue
        if weight["key"] != "direction" and low < 0:
            raise UsageError(at_place(path, Note("got less than 0; give 0 or more")))
        mass = f"counterweights.{weight['link']}.mass"
        if not largest.get(mass):
            raise UsageError(
                at_place(
                    path,
                    Note('the counterweight has no mass; set {mass}, such as "1 kg"', mass=mass),
                )
            )


def _refined(
    values: ObjectiveFunction, start: Array, x: Array, y: Array
) -> tuple[tuple[float, float], float]:
    """The best place about the best point (2,) of the grid, and the objective there."""
    from scipy.optimize import minimize

    low = np.array([x[0], y[0]])
    width = np.array([x[-1], y[-1]]) - low
    begin = (start - low) / width
    steps = np.diag([1 / (len(x) - 1), 1 / (len(y) - 1)])
    simplex = begin + np.vstack([[0.0, 0.0], np.where(begin > 0.5, -steps, steps)])

    def at(share: Array) -> float:
        (result,) = values((low + np.clip(share, 0.0, 1.0) * width)[None])
        return np.inf if np.isnan(result) else float(result)

    least = at(begin)
    options = {"initial_simplex": simplex, "xatol": CLOSE, "fatol": 1e-12 * least, "maxiter": 400}
    outcome = minimize(at, begin, method="Nelder-Mead", bounds=[(0, 1), (0, 1)], options=options)
    better = outcome.x if outcome.fun < least else begin
    x_best, y_best = (low + np.clip(better, 0.0, 1.0) * width).tolist()
    return (x_best, y_best), min(float(outcome.fun), least)
