"""What each command gives of a model as one object, the same as it prints with ``--json``; and
where the outputs of a study stand in it, found once on its model.

Each command takes the keys that are wanted of it, None for all: what takes time for other keys is
left out.
"""

from __future__ import annotations

import gc
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import KernelCall
from equipoise.results.declaring import ALONG, PLACES
from equipoise.studies.figures import Step, answers_about_tools, figure_name, resolve

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.studies.design_space import Output
    from equipoise.studies.study import Study

Values = Mapping[str, Any]
Wanted = Collection[str] | None

MOST_ORDERS = 100
"""Of harmonics, as many as ``equipoise analyze --orders`` gives."""
SPLIT = {"by_cause", "by_link"}
BY_NAME = {"summary", "by_order", "outputs"}
"""Tables of outputs by their whole names."""
LARGE, MANY = 2**12, 2**13
"""Crank angles in a turn, and in a cycle, beyond which an analysis is freed before the next."""


def analyzed(
    machine: Machine,
    angles: int,
    wanted: Wanted,
    ways: Sequence[tuple[Step, ...]] | None = None,
) -> Values:
    """`equipoise analyze`, with ``--split`` and ``--orders`` where their keys are wanted.

    ways : to figures, of whose outputs alone arrays and summary are told; None for all outputs.
    """
    from equipoise.results.analysis import LEAST_ANGLES, analyze, order_values
    from equipoise.results.named_figures import NAMED_FIGURES

    analysis = analyze(machine, angles)
    split = analysis.solved is not None and (wanted is None or not SPLIT.isdisjoint(wanted))
    outputs = analysis.outputs
    names = [
        output.name
        for output in outputs
        if ways is None or _lead_to(ways, output.name, output.path)
    ]
    further: list[str] = []
    if wanted is None or "outputs" in wanted:  # those that are had by their names alone
        further = [name for name in names if outputs[name].declared.unbounded]
    figures = wanted is None or not {"strokes", *NAMED_FIGURES}.isdisjoint(wanted)
    values = analysis.to_dict(split, further, figures, None if ways is None else names)
    ordered = analysis.solved is not None and angles >= LEAST_ANGLES
    if ordered and (wanted is None or "by_order" in wanted):
        values["by_order"] = order_values(analysis, MOST_ORDERS, 0.0)
    if angles > LARGE or angles * values.get("turns", 1) > MANY:
        del analysis, outputs
        gc.collect()  # an analysis and its outputs hold each other
    return values


def _lead_to(ways: Sequence[tuple[Step, ...]], name: str, path: tuple[str, ...]) -> bool:
    """Whether one of several ways leads to an output, by its name or its path in nested values."""
    return any(
        way[: len(path)] == path or (way[0] in BY_NAME and way[1:2] == (name,)) for way in ways
    )


def _planted(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.planting.summary import plant

    return plant(cast("Machine", model)).to_dict(wanted)


def _responded(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.vibration.forced import respond

    return respond(cast("Machine", model)).to_dict()


def _balanced(model: Machine | Tool, wanted: Wanted) -> Values:
    from equipoise.balancing.optimisation import balance

    return balance(cast("Machine", model)).to_dict(wanted)


def _of_tool(model: Machine | Tool, wanted: Wanted) -> Values:
    """`equipoise tool` without further options; only those of its answers that have the keys."""
    from equipoise.handheld.sweep import default_answers

    tool = cast("Tool", model)
    values: dict[str, Any] = {"title": tool.title}
    for name in default_answers(tool):
        left = None if wanted is None else set(wanted) - set(values)
        if left is None or not left.isdisjoint(answers_about_tools()[name]):
            values |= _answer(tool, name, left)
    return values


def _answer(tool: Tool, name: str, wanted: Wanted) -> Values:
    from equipoise.handheld.exposed import ToolExposure, expose_tool
    from equipoise.handheld.modes import vibrate_tool
    from equipoise.handheld.sweep import MODES, sweep_tool

    if name == "modes":
        return vibrate_tool(tool, MODES).to_dict()
    if name == "respond":
        return sweep_tool(tool, _speeds(tool)).to_dict(wanted)
    over_speeds = {key for key, item in ToolExposure.declared.items() if item.along}
    if wanted is None or not over_speeds.isdisjoint(wanted):
        return expose_tool(tool, _speeds(tool)).to_dict()
    if tool.operation is None:
        raise ModelError("operation", Note("missing; add the table [operation]"))
    values = expose_tool(tool, np.array([tool.operation.speed])).to_dict()
    return {key: value for key, value in values.items() if key not in over_speeds}


def _speeds(tool: Tool) -> np.ndarray[Any, Any]:
    """Speeds of the engine at which `equipoise tool` looks, rad/s."""
    from equipoise.handheld.sweep import SPEEDS, default_speeds, speeds_between

    ends = default_speeds(tool)
    assert ends is not None  # else nothing over speeds is among the usual answers
    return speeds_between(tool, *ends, SPEEDS)


COMMANDS: dict[str, Callable[[Machine | Tool, Wanted], Values]] = {
    "plant": _planted,
    "respond": _responded,
    "balance": _balanced,
    "tool": _of_tool,
}
"""By the command's name; `analyze` stands apart, for its crank angles."""

ANGLES = 360
"""Crank angles in a turn to begin with."""
TRIED = 32
"""Designs among which one is looked for that has all figures, where the model itself fails."""

_FIRST = re.compile(r"[.\[]")


@dataclass(frozen=True)
class Request:
    """Figures that one command has to give; ``planted`` is `plant` of many designs at once.

    columns : of the outputs.  steps : to each of them.  wanted : keys of the command's object.
    """

    command: str
    columns: tuple[int, ...]
    steps: tuple[tuple[Step, ...], ...]

    @property
    def wanted(self) -> set[str]:
        along = {*ALONG} if any(figure_name(step) in PLACES for step in self.steps) else set()
        return {str(step[0]) for step in self.steps} | along


def find_outputs(study: Study, wanted: Sequence[int] | None = None) -> tuple[Request, ...]:
    """Find outputs of a study once, on its model, before time is spent on designs.

    wanted : numbers of the outputs, among which the columns count; None for all.

    Raises
    ------
    ModelError : an output leads to no number, or the model cannot be computed; `where` is the key
        of the study file.
    """
    numbers = range(len(study.outputs)) if wanted is None else wanted
    commands = dict.fromkeys(study.outputs[number].of for number in numbers)
    return tuple(asked for command in commands for asked in _of_command(study, numbers, command))


def _of_command(study: Study, numbers: Sequence[int], command: str) -> list[Request]:
    """The steps to all figures of a command, on the model or on one of the first designs."""
    columns = tuple(k for k, number in enumerate(numbers) if study.outputs[number].of == command)
    asked = {1 + numbers[k]: study.outputs[numbers[k]] for k in columns}
    first: EquipoiseError | None = None
    for make in _models(study):
        try:
            with np.errstate(all="ignore"):
                model = make()
                steps = _steps(study, asked, model, command)
        except EquipoiseError as error:
            first = first or error
        else:
            if isinstance(steps, ModelError):
                raise steps
            return _parted(study, model, Request(command, columns, steps))
    where = f"outputs[{min(asked)}].of"
    assert first is not None
    refusal = Note(
        "equipoise {command} cannot compute the model: {note}", command=command, note=first.note
    )
    raise ModelError(where, refusal).like(first) from first


EACH_ITS_OWN = {"planting.depth", "planting.forward_speed", "planting.hill_spacing"}
"""Numbers of the field that may differ from machine to machine of a curve."""


def _parted(study: Study, model: Machine | Tool, asked: Request) -> list[Request]:
    """What can be had of many designs at once, and the rest."""
    if asked.command != "plant":
        return [asked]
    from equipoise.planting.arms import OF_DRIVE
    from equipoise.planting.summary import PlantingFigures

    of_one = {*PlantingFigures.declared, *OF_DRIVE}  # what is no figure of a curve
    machine = cast("Machine", model)
    field = {path for path in study.paths if path.startswith("planting.")}
    alike = field <= EACH_ITS_OWN and not machine.couplings
    alike = alike and all(isinstance(step, KernelCall) for step in assemble(machine).motion)
    parts: dict[str, list[int]] = {"planted": [], "plant": []}
    for k, steps in enumerate(asked.steps):
        parts["planted" if alike and steps[0] not in of_one else "plant"].append(k)
    return [
        Request(
            command,
            tuple(asked.columns[k] for k in chosen),
            tuple(asked.steps[k] for k in chosen),
        )
        for command, chosen in parts.items()
        if chosen
    ]


def _models(study: Study) -> Iterator[Callable[[], Machine | Tool]]:
    """The model, then some designs of the study, each to be called for."""
    from equipoise.studies.sampling import samples

    yield study.model.base
    for row in samples(study, 0, min(TRIED, study.size)):
        values = dict(zip(study.paths, row.tolist(), strict=True))
        yield partial(study.model.machine, values)


def _steps(
    study: Study, asked: Mapping[int, Output], model: Machine | Tool, command: str
) -> tuple[tuple[Step, ...], ...] | ModelError:
    """Steps to the figures that a command gives of one machine, or what leads nowhere."""
    begins = {_FIRST.split(output.value, maxsplit=1)[0] for output in asked.values()}
    values = _values(study, model, command, begins)
    try:
        return tuple(_resolved(study, values, output) for output in asked.values())
    except UsageError:  # told again with all that there is
        values = _values(study, model, command, None)
    steps = []
    for number, output in asked.items():
        try:
            steps.append(_resolved(study, values, output))
        except UsageError as error:
            missing = values.get("missing")
            if not missing:
                return ModelError(f"outputs[{number}].value", error.note)
            what = Note(
                "got {given!r}; there are no forces, {why}", given=output.value, why=missing
            )
            return ModelError(f"outputs[{number}].value", what)
    return tuple(steps)


def _values(
    study: Study, model: Machine | Tool, command: str, wanted: set[str] | None
) -> Mapping[str, Any]:
    if command != "analyze":
        return COMMANDS[command](model, wanted)
    return analyzed(cast("Machine", model), study.angles or ANGLES, wanted)


def _resolved(study: Study, values: Mapping[str, Any], output: Output) -> tuple[Step, ...]:
    """The steps of one path; of an analysis it may begin below ``summary``."""
    if output.of != "analyze":
        return resolve(values, output.value)
    steps = resolve(values, output.value, short="summary")
    if study.angles is None and steps[0] != "by_order" and any(isinstance(s, int) for s in steps):
        raise UsageError(
            Note(
                "got {value!r}, one of a list that runs over crank angles, whose number "
                "is not fixed; give a figure of the list, such as .max, or angles in "
                "[accuracy]",
                value=output.value,
            )
        )
    return steps
