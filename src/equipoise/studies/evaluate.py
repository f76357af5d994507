"""From numbers to figures: the one function that every part of a study calls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from equipoise.codegen.figures import COMPUTED, NOT_COMPUTED
from equipoise.errors import EquipoiseError

if TYPE_CHECKING:
    from equipoise.codegen.figures import Figure
    from equipoise.mechanism.model import Machine
    from equipoise.studies.study import Output, Study

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Outcome:
    """What was computed of some designs (P).

    figures : (P, m) in SI units, one column an output; NaN where a design failed.
    reason : (P,) uint8, a key of `REASONS`; 0 where all figures are there.
    """

    figures: Array
    reason: Array


class Evaluator(Protocol):
    """Computes designs given as values (P, d) in SI units, one column a varied number."""

    def __call__(self, values: Array) -> Outcome: ...


class Quick(Protocol):
    """Figures (P, m) and reasons (P,) of designs (P, d), as `Batch` and `MassBatch` give."""

    def __call__(self, values: Array) -> tuple[Array, Array]: ...


def evaluator(study: Study, threads: int | None = None) -> Evaluator:
    """The fastest way to compute the outputs of a study.

    Figures of an analysis are computed in loops over designs and crank angles, or, where designs
    differ in masses alone, without going round the cycle at all; all others one by one.

    threads : that loops may use; None for one a processor.

    Raises
    ------
    ModelError : an output cannot be computed of any design.
    """
    from equipoise.studies.general import general

    quick = _quick(study, threads)
    columns = [] if quick is None else quick[1]
    others = [output for k, output in enumerate(study.outputs) if k not in columns]
    if quick is None:
        return general(study, study.outputs)
    return Routes(study, quick[0], columns, general(study, others) if others else None)


class Routes:
    """What loops can compute, and the rest of the designs that this leaves.

    compiled : whether there is no rest, so that Python's lock is not held.
    """

    def __init__(
        self, study: Study, quick: Quick, columns: Sequence[int], rest: Evaluator | None
    ) -> None:
        self.study, self.quick, self.columns, self.rest = study, quick, list(columns), rest
        self.compiled = rest is None

    @property
    def engine(self) -> str:
        """What computes: ``numba`` or ``numpy``."""
        from equipoise.codegen.backends import engine

        return engine()

    def __call__(self, values: Array) -> Outcome:
        found = np.full((len(values), len(self.study.outputs)), np.nan)
        found[:, self.columns], reason = self.quick(values)
        if self.rest is not None:
            self._complete(found, reason, values)
        strange = np.flatnonzero(reason == NOT_COMPUTED)
        if strange.size:
            alone = self._one_by_one(values[strange])
            found[strange], reason[strange] = alone.figures, alone.reason
        return Outcome(found, reason)

    def _complete(self, found: Array, reason: Array, values: Array) -> None:
        """Compute what is left of the designs that are possible."""
        assert self.rest is not None
        good = np.flatnonzero(reason == COMPUTED)
        outcome = self.rest(values[good])
        others = [k for k in range(found.shape[1]) if k not in self.columns]
        found[good[:, None], others] = outcome.figures
        reason[good] = outcome.reason
        found[reason != COMPUTED] = np.nan

    def _one_by_one(self, values: Array) -> Outcome:
        """Designs that differ too much from the model for a loop: other turns of a geared link."""
        from equipoise.studies.general import general

        return general(self.study, self.study.outputs)(values)


def _quick(study: Study, threads: int | None) -> tuple[Quick, list[int]] | None:
    """What computes some outputs quickly, and their columns; None where nothing can."""
    if study.model.kind != "linkage" or all(output.of != "analyze" for output in study.outputs):
        return None
    from equipoise.codegen.batch import Batch
    from equipoise.codegen.emit import can_compute
    from equipoise.codegen.gram import MassBatch, can_use

    machine: Machine = study.model.base()  # type: ignore[assignment]
    try:
        figures = {k: _figure(output) for k, output in enumerate(study.outputs)}
        wanted = {k: f for k, f in figures.items() if f and can_compute(machine, study.paths, f)}
        masses = {k: f for k, f in figures.items() if f and can_use(machine, study.paths, [f])}
        if masses and len(masses) >= len(wanted):
            of_masses = MassBatch(
                machine, study.paths, [*masses.values()], study.angles, study.tolerance
            )
            return of_masses, list(masses)
        if wanted:
            batch = Batch(
                machine, study.paths, [*wanted.values()], study.angles, study.tolerance, threads
            )
            return batch, list(wanted)
    except EquipoiseError:  # the model itself fails, perhaps not its designs: one by one
        return None
    return None


def _figure(output: Output) -> Figure | None:
    from equipoise.codegen.figures import figure_of

    return figure_of(output.value) if output.of == "analyze" else None
