"""From numbers to figures: the one function that every part of a study calls.

Figures of an analysis come from compiled loops, planting figures of many designs from one curve;
the general route builds each machine, runs the commands and reads the paths.  It takes every output
of every command, at some milliseconds a design; the other routes take what they can of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from math import isfinite, nan, remainder
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.codegen import backends
from equipoise.codegen.figures import (
    CHANGE_POINT,
    COMPUTED,
    MOST_ANGLES,
    NO_ASSEMBLY,
    NO_FIGURE,
    NO_FULL_TURN,
    NO_MACHINE,
    NOT_COMPUTED,
    NOT_STILL,
    figure_of,
)
from equipoise.design.evaluator import PooledEvaluator
from equipoise.errors import ChangePointError, EquipoiseError, ModelError, MotionError, RangeError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.declaring import PLACES
from equipoise.signals import Array
from equipoise.studies.clusters import elsewhere
from equipoise.studies.commands import (
    ANGLES,
    COMMANDS,
    PathStep,
    Request,
    ResultValues,
    analyzed,
    figure_name,
    find_outputs,
    read,
    scale,
)
from equipoise.studies.outcomes import Evaluator, Outcome

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.studies.study import Study


AT_ONCE = 64
"""Designs of which all commands are run before the next ones are made."""
STANDING = (NO_ASSEMBLY, NO_FULL_TURN, CHANGE_POINT)
"""Reasons for which a linkage does not turn, so that no further command is asked."""
MOST_SAMPLES = 2**19
"""Crank angles in a whole cycle, of however many turns, that are still tried."""
FAINT = 1e-9
"""Share of the largest signal beside it below which a signal is rounding."""


Quick = Callable[[Array], tuple[Array, Array]]
"""Figures (P, m) and reasons (P,) of designs (P, d), as `Batch` and `MassBatch` give."""


def evaluator(study: Study, threads: int | None = None) -> Evaluator:
    """The fastest way to compute the outputs of a study.

    Figures of an analysis are computed in loops over designs and crank angles, or, where designs
    differ in masses alone, without going round the cycle at all; all others one by one.

    threads : that loops may use; None for one a processor.

    Raises
    ------
    ModelError : an output cannot be computed of any design.
    """
    quick = _quick(study, threads)
    return OneByOne(study) if quick is None else Routes(study, *quick)


def pooled(
    study: Study, workers: int | None = None, cluster: str | None = None, expected: int = 0
) -> PooledEvaluator[Outcome]:
    """Evaluator shared out among processes where no loop computes everything, or on a cluster.

    workers : processes; as many as this machine has processors if not given.
    cluster : address of a Dask scheduler whose workers compute instead.
    expected : designs that are to come, if that is known; at most so many.

    Raises
    ------
    ModelError : an output cannot be computed of any design.
    UsageError : fewer than one worker, workers beside a cluster, or no scheduler answers.
    """
    alone = evaluator(study)
    shared = not getattr(alone, "compiled", False)
    make = partial(evaluator, study, threads=1)
    batch = AT_ONCE if any(output.of == "plant" for output in study.outputs) else 1
    return PooledEvaluator(
        alone,
        make,
        Outcome.joined,
        workers,
        shared=shared,
        batch_size=batch,
        expected=expected,
        elsewhere=elsewhere(cluster, workers),
    )


class Routes:
    """What loops can compute, and the rest of the designs that this leaves.

    compiled : whether there is no rest, so that Python's lock is not held.
    """

    def __init__(self, study: Study, quick: Quick, columns: Sequence[int]) -> None:
        self.study, self.quick, self.columns = study, quick, list(columns)
        self.others = [k for k in range(len(study.outputs)) if k not in columns]
        self.rest = OneByOne(study, self.others) if self.others else None
        self.compiled = self.rest is None

    @property
    def engine(self) -> str:
        """What computes: ``numba`` or ``numpy``."""
        return backends.engine()

    def __call__(self, values: Array) -> Outcome:
        numbers = np.full((len(values), len(self.study.outputs)), np.nan)
        numbers[:, self.columns], reason = self.quick(values)
        if self.rest is not None:  # what is left of the designs that are possible
            good = np.flatnonzero(reason == COMPUTED)
            outcome = self.rest(values[good])
            numbers[good[:, None], self.others], reason[good] = outcome.figures, outcome.reason
            numbers[reason != COMPUTED] = np.nan
        strange = np.flatnonzero(reason == NOT_COMPUTED)
        if strange.size:  # too far from the model for a loop: other turns of a geared link
            alone = OneByOne(self.study)(values[strange])
            numbers[strange], reason[strange] = alone.figures, alone.reason
        return Outcome(numbers, reason)


def _quick(study: Study, threads: int | None) -> tuple[Quick, list[int]] | None:
    """What computes some outputs quickly, and their columns; None where nothing can."""
    if study.model.kind != "linkage" or all(output.of != "analyze" for output in study.outputs):
        return None
    from equipoise.codegen.batch import Batch
    from equipoise.codegen.emit import can_compute
    from equipoise.codegen.gram import MassBatch, can_use

    machine: Machine = study.model.base()  # type: ignore[assignment]
    of_analysis = [k for k, output in enumerate(study.outputs) if output.of == "analyze"]
    figures = {k: f for k in of_analysis if (f := figure_of(study.outputs[k].value))}
    try:
        wanted = {k: f for k, f in figures.items() if can_compute(machine, study.paths, f)}
        masses = {k: f for k, f in figures.items() if can_use(machine, study.paths, [f])}
        chosen = masses if masses and len(masses) >= len(wanted) else wanted
        if chosen:  # a loop may be made of a machine that no command computes, and fail only then
            find_outputs(study, [*chosen])
        given = (machine, study.paths, [*chosen.values()], study.angles, study.tolerance)
        if chosen:
            batch = MassBatch(*given) if chosen is masses else Batch(*given, threads)
            return batch, [*chosen]
    except EquipoiseError:  # the model itself fails, perhaps not its designs: one by one
        pass
    return None


# -- one by one ------------------------------------------------------------------------------------


class OneByOne:
    """The general route to outputs of a study, or to those of some numbers, in their order.

    Errors as `find_outputs`.
    """

    def __init__(self, study: Study, wanted: Sequence[int] | None = None) -> None:
        self.study, self.asked = study, find_outputs(study, wanted)
        self.width = sum(len(objective.columns) for objective in self.asked)

    def __call__(self, values: Array) -> Outcome:
        """Compute designs (P, d), some at a time."""
        figures = np.full((len(values), self.width), nan)
        outcome = Outcome(figures, np.zeros(len(values), np.uint8))
        with np.errstate(all="ignore"):
            for begin in range(0, len(values), AT_ONCE):
                some = slice(begin, begin + AT_ONCE)
                self.fill(outcome.figures[some], outcome.reason[some], values[some])
        return outcome

    def fill(self, figures: Array, reason: Array, values: Array) -> None:
        """Fill figures (P, m) and reasons (P,) of a few designs, one command after the other."""
        models: dict[int, Machine | Tool] = {}
        for k, row in enumerate(values.tolist()):
            model = self.model_or_reason(row)
            if isinstance(model, int):
                reason[k] = model
            else:
                models[k] = model
        for asked in self.asked:
            going = {k: model for k, model in models.items() if reason[k] not in STANDING}
            if asked.command == "planted":
                failed = _in_batches(going, asked, figures)
            else:
                failed = {k: self.ask(model, asked, figures[k]) for k, model in going.items()}
            for k, why in failed.items():
                reason[k] = reason[k] or why

    def model_or_reason(self, row: Sequence[float]) -> Machine | Tool | int:
        """One design, or why it is none."""
        try:
            model = self.study.model.machine(dict(zip(self.study.paths, row, strict=True)))
        except EquipoiseError:
            return NO_MACHINE
        try:
            if isinstance(model, Machine):
                assemble(model)
        except EquipoiseError as error:
            return NO_MACHINE if isinstance(error, ModelError) else reason_of(error, model)
        return model

    def ask(self, model: Machine | Tool, asked: Request, figures: Array) -> int:
        """Fill the figures (m,) that one command gives; returns why some are missing."""
        try:
            result, still = _figures_of(model, asked, self.study)
        except EquipoiseError as error:
            if isinstance(error, ModelError):  # of a machine that is one: it lacks what is asked
                return NO_FIGURE if asked.command == "plant" else NOT_COMPUTED
            return reason_of(error, model)
        except (ArithmeticError, np.linalg.LinAlgError):  # numbers beyond all bounds
            return NOT_COMPUTED
        if not still:
            return NOT_STILL
        figures[list(asked.columns)] = [item if isfinite(item) else nan for item in result]
        return COMPUTED if all(map(isfinite, result)) else NO_FIGURE


def _in_batches(models: Mapping[int, Any], asked: Request, figures: Array) -> dict[int, int]:
    """Fill the figures of planting fingers; returns why some are missing, by design."""
    failed, turning = {}, {}
    for k, machine in models.items():
        try:
            assemble(machine).cycle  # noqa: B018
        except EquipoiseError as error:
            failed[k] = reason_of(error, machine)
        else:
            turning[k] = machine
    if turning:
        values = planting_figures([*turning.values()], asked.steps)
        figures[np.ix_([*turning], asked.columns)] = np.where(np.isfinite(values), values, nan)
        there = np.all(np.isfinite(values), axis=1)
        failed |= {
            k: COMPUTED if item else NO_FIGURE for k, item in zip(turning, there, strict=True)
        }
    return failed


def reason_of(error: EquipoiseError, model: Machine | Tool) -> int:
    """Why a design cannot be computed, a key of `REASONS`."""
    if isinstance(error, RangeError):
        return NO_FULL_TURN if error.ranges else NO_ASSEMBLY
    if isinstance(error, ChangePointError):
        return CHANGE_POINT
    if isinstance(error, MotionError) and not getattr(model, "couplings", ()):
        return NO_FULL_TURN  # where Newton's method ends on the way round
    return NOT_COMPUTED


# -- figures of one machine ------------------------------------------------------------------------


def _figures_of(model: Machine | Tool, asked: Request, study: Study) -> tuple[list[float], bool]:
    """Figures, and whether they stand still."""
    angles, tolerance = study.angles, study.tolerance
    if asked.command != "analyze":
        values = COMMANDS[asked.command]().compute(model, asked.wanted)
        return [read(values, steps) for steps in asked.steps], True
    machine = cast("Machine", model)
    if angles is not None:
        values = analyzed(machine, angles, asked.wanted, asked.steps)
        return [read(values, steps) for steps in asked.steps], True
    values = analyzed(machine, ANGLES, asked.wanted, asked.steps)
    items = [read(values, steps) for steps in asked.steps]
    noise = _NoiseFloor(machine, asked)
    number, calm = ANGLES, 0
    # Extremes, and their places, may stand still once by chance.
    needed = 1 if all(figure_name(step) in ("mean", "rms") for step in asked.steps) else 2
    most = min(MOST_ANGLES, MOST_SAMPLES // values.get("turns", 1))
    while 2 * number <= most:
        number *= 2
        values = analyzed(machine, number, asked.wanted, asked.steps)
        before, items = items, [read(values, steps) for steps in asked.steps]
        calm = calm + 1 if _still(values, asked.steps, before, items, noise, tolerance) else 0
        if calm == needed:
            return items, True
    return items, False


def _still(
    values: ResultValues,
    steps: Sequence[tuple[PathStep, ...]],
    before: Sequence[float],
    now: Sequence[float],
    noise: _NoiseFloor,
    tolerance: float,
) -> bool:
    """Whether figures have kept, within a share of the RMS of the signal that each is of.

    noise : below what a signal is rounding, by the table in which a figure stands.
    """
    for step, old, new in zip(steps, before, now, strict=True):
        change = abs(new - old)
        if figure_name(step) in PLACES:
            change = abs(remainder(change, 2 * np.pi * values.get("turns", 1)))
        if change == 0 or not (isfinite(old) and isfinite(new)):
            continue  # what is missing will not come with further crank angles
        size = scale(values, step)
        if change > tolerance * size and change > tolerance * noise.of(str(step[0])):
            return False
    return True


class _NoiseFloor:
    """Sizes below which signals of a machine are rounding; all its outputs are computed only where
    one is asked for.
    """

    def __init__(self, machine: Machine, asked: Request) -> None:
        self._machine, self._asked = machine, asked

    def of(self, table: str) -> float:
        """Of a table of figures, in its unit."""
        return FAINT * _limit_value(self._values, table)

    @cached_property
    def _values(self) -> ResultValues:
        return analyzed(self._machine, ANGLES, self._asked.wanted)


def _limit_value(values: ResultValues, key: str) -> float:
    """RMS of the largest signal in a table, of which others may be the rounding."""
    table = values["summary" if key == "by_order" else key] if key in values else None
    return max(_sizes(table), default=0.0)


def _sizes(table: Any) -> Iterator[float]:
    if isinstance(table, Mapping):
        if isinstance(table.get("rms"), float):
            yield table["rms"]
            return
        for item in table.values():
            yield from _sizes(item)
    elif isinstance(table, np.ndarray):
        yield float(np.sqrt(np.mean(np.square(table))))


def planting_figures(machines: Sequence[Machine], steps: Sequence[Sequence[PathStep]]) -> Array:
    """Figures (P, m) of machines of one build whose cranks turn fully; NaN where one is missing."""
    from equipoise.mechanism.kinematics.tip import TipCurve
    from equipoise.planting.figures import machine_figures
    from equipoise.planting.stroke import both_sides

    curve = TipCurve(machines)
    plants = np.all([both_sides(arm) for arm in curve.arms], axis=0) & (curve.speed[:, 0] != 0)
    names = [".".join(map(str, step)) for step in steps]
    figures = machine_figures(curve, names)
    columns = [figures.get(name, np.full(len(machines), np.nan)) for name in names]
    table: Array = np.where(plants[:, None], np.stack(columns, axis=1), np.nan)
    return table
