"""The general route from numbers to figures: build each machine, run the commands, read the paths.

It takes every output of every command, at some milliseconds a design; the compiled routes take
what they can of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, nan, remainder
from typing import TYPE_CHECKING, Any, cast

import numpy as np

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
)
from equipoise.errors import (
    ChangePointError,
    EquipoiseError,
    ModelError,
    MotionError,
    RangeError,
)
from equipoise.studies.asking import ANGLES, Asked, find, is_place, is_smooth
from equipoise.studies.commands import COMMANDS, analyzed
from equipoise.studies.evaluate import Evaluator, Outcome
from equipoise.studies.figures import Step, read, scale

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.studies.study import Model, Output, Study

Array = np.ndarray[Any, Any]
Values = Mapping[str, Any]

AT_ONCE = 64
"""Designs of which all commands are run before the next ones are made."""
STANDING = (NO_ASSEMBLY, NO_FULL_TURN, CHANGE_POINT)
"""Reasons for which a linkage does not turn, so that no further command is asked."""
MOST_SAMPLES = 2**19
"""Crank angles in a whole cycle, of however many turns, that are still tried."""
FAINT = 1e-9
"""Share of the largest signal beside it below which a signal is rounding."""


def general(study: Study, outputs: Sequence[Output]) -> Evaluator:
    """The general route to some outputs of a study, in their order; errors as `check_outputs`."""
    return _General(study.model, study.paths, find(study, outputs), study.angles, study.tolerance)


@dataclass(frozen=True)
class _General:
    model: Model
    paths: tuple[str, ...]
    asked: tuple[Asked, ...]
    angles: int | None
    tolerance: float

    def __call__(self, values: Array) -> Outcome:
        """Compute designs (P, d), some at a time."""
        count = sum(len(one.columns) for one in self.asked)
        outcome = Outcome(np.full((len(values), count), nan), np.zeros(len(values), np.uint8))
        with np.errstate(all="ignore"):
            for begin in range(0, len(values), AT_ONCE):
                some = slice(begin, begin + AT_ONCE)
                self.fill(outcome.figures[some], outcome.reason[some], values[some])
        return outcome

    def fill(self, figures: Array, reason: Array, values: Array) -> None:
        """Fill figures (P, m) and reasons (P,) of a few designs, one command after the other."""
        models: dict[int, Machine | Tool] = {}
        for k, row in enumerate(values.tolist()):
            made = self.made(row)
            if isinstance(made, int):
                reason[k] = made
            else:
                models[k] = made
        for asked in self.asked:
            going = {k: model for k, model in models.items() if reason[k] not in STANDING}
            if asked.command == "planted":
                failed = _together(going, asked, figures)
            else:
                failed = {k: self.ask(model, asked, figures[k]) for k, model in going.items()}
            for k, why in failed.items():
                reason[k] = reason[k] or why

    def made(self, row: Sequence[float]) -> Machine | Tool | int:
        """One design, or why it is none."""
        try:
            model = self.model.machine(dict(zip(self.paths, row, strict=True)))
        except EquipoiseError:
            return NO_MACHINE
        try:
            _assembled(model)
        except EquipoiseError as error:
            return NO_MACHINE if isinstance(error, ModelError) else reason_of(error, model)
        return model

    def ask(self, model: Machine | Tool, asked: Asked, figures: Array) -> int:
        """Fill the figures (m,) that one command gives; returns why some are missing."""
        try:
            found, still = _figures_of(model, asked, self.angles, self.tolerance)
        except EquipoiseError as error:
            if isinstance(error, ModelError):  # of a machine that is one: it lacks what is asked
                return NO_FIGURE if asked.command == "plant" else NOT_COMPUTED
            return reason_of(error, model)
        except (ArithmeticError, np.linalg.LinAlgError):  # numbers beyond all bounds
            return NOT_COMPUTED
        if not still:
            return NOT_STILL
        figures[list(asked.columns)] = [one if isfinite(one) else nan for one in found]
        return COMPUTED if all(map(isfinite, found)) else NO_FIGURE


def _together(models: Mapping[int, Any], asked: Asked, figures: Array) -> dict[int, int]:
    """Fill the figures of planting fingers; returns why some are missing, by design."""
    from equipoise.mechanism.linkage import assemble
    from equipoise.studies.planted import planted

    failed, turning = {}, {}
    for k, machine in models.items():
        try:
            assemble(machine).cycle  # noqa: B018
        except EquipoiseError as error:
            failed[k] = reason_of(error, machine)
        else:
            turning[k] = machine
    if turning:
        found = planted([*turning.values()], asked.steps)
        figures[np.ix_([*turning], asked.columns)] = np.where(np.isfinite(found), found, nan)
        there = np.all(np.isfinite(found), axis=1)
        failed |= {k: COMPUTED if one else NO_FIGURE for k, one in zip(turning, there, strict=True)}
    return failed


def reason_of(error: EquipoiseError, model: Machine | Tool) -> int:
    """Why a design cannot be computed, a key of `REASONS`."""
    if isinstance(error, RangeError):
        return NO_FULL_TURN if error.ranges else NO_ASSEMBLY
    if isinstance(error, ChangePointError):
        return CHANGE_POINT
    if isinstance(error, MotionError) and not getattr(model, "gears", ()):
        return NO_FULL_TURN  # where Newton's method ends on the way round
    return NOT_COMPUTED


def _assembled(model: Machine | Tool) -> None:
    from equipoise.mechanism.linkage import assemble
    from equipoise.mechanism.model import Machine

    if isinstance(model, Machine):
        assemble(model)


# -- figures of one machine ------------------------------------------------------------------------


def _figures_of(
    model: Machine | Tool, asked: Asked, angles: int | None, tolerance: float
) -> tuple[list[float], bool]:
    """Figures, and whether they stand still."""
    if asked.command != "analyze":
        values = COMMANDS[asked.command](model, asked.wanted)
        return [read(values, steps) for steps in asked.steps], True
    machine = cast("Machine", model)
    values = analyzed(machine, angles or ANGLES, asked.wanted)
    found = [read(values, steps) for steps in asked.steps]
    if angles is not None:
        return found, True
    number, calm = ANGLES, 0
    needed = 1 if all(is_smooth(one) for one in asked.steps) else 2
    most = min(MOST_ANGLES, MOST_SAMPLES // values.get("turns", 1))
    while 2 * number <= most:
        number *= 2
        values = analyzed(machine, number, asked.wanted)
        before, found = found, [read(values, steps) for steps in asked.steps]
        calm = calm + 1 if _still(values, asked.steps, before, found, tolerance) else 0
        if calm == needed:
            return found, True
    return found, False


def _still(
    values: Values,
    steps: Sequence[tuple[Step, ...]],
    before: Sequence[float],
    now: Sequence[float],
    tolerance: float,
) -> bool:
    """Whether figures have kept, within a share of the RMS of the signal that each is of."""
    for one, old, new in zip(steps, before, now, strict=True):
        change = abs(new - old)
        if is_place(one):
            change = abs(remainder(change, 2 * np.pi * values.get("turns", 1)))
        if change == 0 or not (isfinite(old) and isfinite(new)):
            continue  # what is missing will not come with further crank angles
        size = scale(values, one)
        if change > tolerance * size and change > tolerance * FAINT * _beside(values, one):
            return False
    return True


def _beside(values: Values, steps: Sequence[Step]) -> float:
    """RMS of the largest signal in the same table, of which others may be the rounding."""
    table = values["summary"] if steps[0] in ("summary", "by_order") else values.get(str(steps[0]))
    return max(_sizes(table), default=0.0)


def _sizes(table: Any) -> Iterator[float]:
    if isinstance(table, Mapping):
        if isinstance(table.get("rms"), float):
            yield table["rms"]
            return
        for one in table.values():
            yield from _sizes(one)
    elif isinstance(table, np.ndarray):
        yield float(np.sqrt(np.mean(np.square(table))))
