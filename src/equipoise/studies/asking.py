"""The outputs of a study, found once on its model: by which command, and by which way."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.studies.commands import COMMANDS, analyzed
from equipoise.studies.figures import PLACES, Of, Step, resolve

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.studies.study import Output, Study

ANGLES = 360
"""Crank angles in a turn to begin with."""
TRIED = 32
"""Designs among which one is looked for that has all figures, where the model itself fails."""

_FIRST = re.compile(r"[.\[]")


@dataclass(frozen=True)
class Asked:
    """Figures that one command has to give; ``planted`` is `plant` of many designs at once.

    columns : of the outputs.  steps : to each of them.  wanted : keys of the command's object.
    """

    command: str
    columns: tuple[int, ...]
    steps: tuple[tuple[Step, ...], ...]

    @property
    def wanted(self) -> set[str]:
        along = {"crank_angle", "speed"} if any(is_place(one) for one in self.steps) else set()
        return {str(one[0]) for one in self.steps} | along


def check_outputs(study: Study) -> tuple[Asked, ...]:
    """Find every output of a study once, on its model, before time is spent on designs.

    Raises
    ------
    ModelError : an output leads to no number, or the model cannot be computed; `where` is the key
        of the study file.
    """
    return find(study, study.outputs)


def find(study: Study, outputs: Sequence[Output]) -> tuple[Asked, ...]:
    """The same of some of its outputs, whose columns count among these."""
    commands = dict.fromkeys(output.of for output in outputs)
    return tuple(asked for command in commands for asked in _of_command(study, outputs, command))


def _of_command(study: Study, outputs: Sequence[Output], command: str) -> list[Asked]:
    """The steps to all figures of a command, on the model or on one of the first designs."""
    columns = tuple(k for k, output in enumerate(outputs) if output.of == command)
    asked = [outputs[k] for k in columns]
    first: EquipoiseError | None = None
    for make in _models(study):
        try:
            with np.errstate(all="ignore"):
                model = make()
                steps = _steps(study, asked, model, command)
        except _NoFigure as error:
            raise error.sentence from None
        except EquipoiseError as error:
            first = first or error
        else:
            return _parted(study, model, Asked(command, columns, steps))
    where = f"outputs[{1 + study.outputs.index(asked[0])}].of"
    raise ModelError(where, f"equipoise {command} cannot compute the model: {first}") from first


def _parted(study: Study, model: Machine | Tool, asked: Asked) -> list[Asked]:
    """What can be had of many designs at once, and the rest."""
    if asked.command != "plant":
        return [asked]
    from equipoise.studies.planted import can_have

    together = can_have(cast("Machine", model), study.paths, asked.steps)
    parts = []
    for command, wanted in (("planted", True), ("plant", False)):
        chosen = [k for k, one in enumerate(together) if one == wanted]
        columns = tuple(asked.columns[k] for k in chosen)
        parts.append(Asked(command, columns, tuple(asked.steps[k] for k in chosen)))
    return [part for part in parts if part.columns]


def _models(study: Study) -> Iterator[Callable[[], Machine | Tool]]:
    """The model, then some designs of the study, each to be called for."""
    from equipoise.studies.sampling import samples

    yield study.model.base
    for row in samples(study, 0, min(TRIED, study.size)):
        values = dict(zip(study.paths, row.tolist(), strict=True))
        yield partial(study.model.machine, values)


class _NoFigure(Exception):
    """A path leads nowhere; `sentence` tells."""

    def __init__(self, sentence: ModelError) -> None:
        self.sentence = sentence


def _steps(
    study: Study, asked: Sequence[Output], model: Machine | Tool, command: str
) -> tuple[tuple[Step, ...], ...]:
    """Steps to the figures that a command gives of one machine."""
    begins = {_FIRST.split(output.value, maxsplit=1)[0] for output in asked}
    values = _values(study, model, command, begins)
    try:
        return tuple(_resolved(study, values, output) for output in asked)
    except UsageError:  # told again with all that there is
        values = _values(study, model, command, None)
    found = []
    for output in asked:
        try:
            found.append(_resolved(study, values, output))
        except UsageError as error:
            where = f"outputs[{1 + study.outputs.index(output)}].value"
            missing = values.get("missing")
            told = f"got {output.value!r}; there are no forces, {missing}" if missing else error
            raise _NoFigure(ModelError(where, str(told))) from None
    return tuple(found)


def _values(
    study: Study, model: Machine | Tool, command: str, wanted: set[str] | None
) -> Mapping[str, Any]:
    if command != "analyze":
        return COMMANDS[command](model, wanted)
    return analyzed(cast("Machine", model), study.angles or ANGLES, None)


def _resolved(study: Study, values: Mapping[str, Any], output: Output) -> tuple[Step, ...]:
    """The steps of one path; of an analysis it may begin below ``summary``."""
    if output.of != "analyze":
        return resolve(values, output.value)
    steps = resolve(values, output.value, short="summary")
    if study.angles is None and steps[0] != "by_order" and any(isinstance(s, int) for s in steps):
        raise UsageError(
            f"got {output.value!r}, one of a list that runs over crank angles, whose number is not "
            "fixed; give a figure of the list, such as .max, or angles in [accuracy]"
        )
    return steps


def is_place(steps: Sequence[Step]) -> bool:
    """Whether a figure is where along the abscissa something is."""
    last = steps[-1].name if isinstance(steps[-1], Of) else steps[-1]
    return last in PLACES


def is_smooth(steps: Sequence[Step]) -> bool:
    """Whether a figure stands still for good once it does: no extreme, and no place of one."""
    last = steps[-1].name if isinstance(steps[-1], Of) else steps[-1]
    return last in ("mean", "rms")
