"""What each command gives of a model as one object, and a number out of it.

``summary.shaking_force.y.rms`` leads through nested values to a number; names may hold dots, or
stand in quotes; ``[2]`` is the second of a list, ``[order 2]`` the one of order 2, and ``.rms`` a
figure of a list of numbers.  A path is resolved once, on one machine, and then read from many.

Each command takes the keys that are wanted of it, None for all: what takes time for other keys is
left out.
"""

from __future__ import annotations

import gc
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import field
from functools import partial
from math import isfinite, nan, pi
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import KernelCall
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.kinematics.strokes import dimension_of as of_stroke
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.declaring import (
    ALONG,
    FIGURES_OF_LISTS,
    PLACES,
    Declarations,
    dimension_at,
    flat,
)
from equipoise.results.outputs import dimensions_by_path
from equipoise.signals import Array, figures

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.quantities import Dimension
    from equipoise.studies.study import Output, Study

ResultValues = Mapping[str, Any]


@dataclass(frozen=True)
class Order:
    """The entry of a list that belongs to an order."""

    number: float


@dataclass(frozen=True)
class Of:
    """A figure of a list of numbers, one of `FIGURES_OF_LISTS`."""

    name: str


PathStep = str | int | Order | Of
"""A key, a place in a list from 0, or one of those above."""

AMPLITUDES = ("harmonics", "a", "b")
"""Keys of lists by order."""

_INDEX = re.compile(r"\[\s*(order\s+)?([0-9]{1,9}(?:\.[0-9]{1,9})?)\s*\]")
_QUOTED = re.compile(r'"([^"]*)"')


def resolve(values: ResultValues, path: str, short: str | None = None) -> tuple[PathStep, ...]:
    """The steps of a path through nested values to a number.

    short : key of the table below which a path may begin too; it goes first.

    Raises
    ------
    UsageError : the path leads to no number; the sentence lists what is there.
    """
    finder = _Finder(values)
    if short is not None:
        for steps in finder.ways(values[short], path):
            return (short, *steps)
    for steps in finder.ways(values, path):
        return steps
    text = finder.nearest_failure()
    raise UsageError(Note("got {path!r}; {sentence}", path=path, sentence=text))


def read(values: ResultValues, steps: Sequence[PathStep]) -> float:
    """The number at the end of steps; NaN where there is none."""
    above: Any = None
    here: Any = values
    try:
        for number, step in enumerate(steps):
            if isinstance(step, Order):
                of_order = _of_order(here, step.number, above["orders"], steps[number - 1])
            elif isinstance(step, Of):
                of_order = _figure(here, step, values)
            else:
                of_order = here[step]
            above, here = here, of_order
        return float(here)
    except (KeyError, IndexError, TypeError, ValueError):
        return nan


def figure_name(steps: Sequence[PathStep]) -> Any:
    """Name of the last step, such as ``rms``."""
    return steps[-1].name if isinstance(steps[-1], Of) else steps[-1]


def scale(values: ResultValues, steps: Sequence[PathStep]) -> float:
    """By what the error of a figure is measured: the RMS of the signal that it is a figure of.

    A turn where it is a crank angle, itself where it is of a part, 1 where it is another number.
    """
    if figure_name(steps) in PLACES or "phases" in steps:
        return 2 * pi
    if len(steps) > 2 and steps[0] in ("summary", "by_order"):
        rms = read(values, ("summary", steps[1], "rms"))
        return rms if isfinite(rms) else 1.0
    if isinstance(steps[-1], Of):
        return read(values, (*steps[:-1], Of("rms")))
    return abs(read(values, steps)) or 1.0 if steps[0] in part_kinds(Machine) else 1.0


def _of_order(numbers: Any, order: float, orders: Any, key: PathStep) -> Any:
    """Orders beyond the last are left out of lists because they are zero."""
    if order > orders[-1] and key in AMPLITUDES:
        return 0.0
    return numbers[int(np.flatnonzero(np.asarray(orders) == order)[0])]


def _figure(numbers: Any, of: Of, whole: ResultValues) -> float:
    samples = np.asarray(numbers, dtype=float)
    along = _abscissa(whole, len(samples))
    turns = whole.get("turns") if along is whole.get("crank_angle") else None
    period = None if turns is None else 2 * pi * turns
    result = figures(np.full(len(samples), nan) if along is None else along, samples, period)
    return float(getattr(result, of.name))


def _abscissa(whole: ResultValues, count: int) -> Array | None:
    """What a list of so many numbers runs along, if it does."""
    along = (whole.get(key) for key in ALONG)
    return next((x for x in along if isinstance(x, np.ndarray) and x.shape == (count,)), None)


@dataclass
class _Finder:
    """Looks for the ways that a path can be taken.

    stuck : how much of the path was left where a way came to its end, and what is there.
    tables : of ways that ended at an unknown name, how much was left, that name, and the figures
        there are in its place.
    """

    whole: ResultValues
    stuck: list[tuple[int, Note]] = field(default_factory=list)
    tables: list[tuple[int, str, list[str]]] = field(default_factory=list)

    def nearest_failure(self) -> Note:
        """Why no way leads to a number: of the way that came furthest, the last of several.

        A name that is unknown in several tables, such as in ``joints.A`` and in its summary, may
        have been meant in any of them.
        """
        left, text = min(reversed(self.stuck), key=lambda failure: failure[0])
        ends = [(given, names) for rest, given, names in self.tables if rest == left]
        if len(ends) < 2:
            return text
        every = dict.fromkeys(name for _, names in ends for name in names)
        return unknown(ends[-1][0], every, "figure")

    def ways(self, here: Any, rest: str, above: Any = None) -> Iterator[tuple[PathStep, ...]]:
        """Every way to take the rest of a path from here to a number."""
        if isinstance(here, Mapping):
            yield from self.into_table(here, rest)
        elif isinstance(here, list | tuple) or np.ndim(here) > 0:
            yield from self.into_list(here, rest, above)
        elif rest:
            wrong = Note("a single number stands there, without {rest!r} below it", rest=rest)
            self.ends(rest, wrong)
        elif isinstance(here, str):
            wrong = Note("that is the text {here!r}; give the path of a number", here=here)
            self.ends(rest, wrong)
        else:
            yield ()

    def ends(self, rest: str, wrong: Note) -> None:
        self.stuck.append((len(rest), wrong))

    def into_table(self, here: ResultValues, rest: str) -> Iterator[tuple[PathStep, ...]]:
        """Names may hold dots, so the longest that fits goes first."""
        if not rest:
            wrong = Note("that is no number; below it there are {names}", names=_listed(here))
            self.ends(rest, wrong)
            return
        quoted = _QUOTED.match(rest)
        if quoted:
            begins = {quoted[1]: quoted.end()} if quoted[1] in here else {}
        else:
            names = (n for n in here if rest.startswith(n) and rest[len(n) :][:1] in ("", ".", "["))
            begins = {name: len(name) for name in sorted(names, key=len, reverse=True)}
        for name, length in begins.items():
            for steps in self.ways(here[name], rest[length:].removeprefix("."), here):
                yield (name, *steps)
        if not begins:
            given = quoted[1] if quoted else re.split(r"[.\[]", rest)[0] or rest
            known = [name for name, item in here.items() if not isinstance(item, str)]
            self.tables.append((len(rest), given, known))
            self.ends(rest, unknown(given, known, "figure"))

    def into_list(self, here: Any, rest: str, above: Any) -> Iterator[tuple[PathStep, ...]]:
        index = _INDEX.match(rest)
        if index is None:
            yield from self.of_list(here, rest)
        elif index[1]:
            yield from self.of_order(here, index[2], rest, above)
        elif "." in index[2] or not 1 <= int(index[2]) <= len(here):
            wrong = Note(
                "{place} is not in that list of {count}, which counts from 1",
                place=index[0],
                count=len(here),
            )
            self.ends(rest, wrong)
        else:
            place = int(index[2]) - 1
            after = rest[index.end() :].removeprefix(".")
            for steps in self.ways(here[place], after, here):
                yield (place, *steps)

    def of_list(self, here: Any, rest: str) -> Iterator[tuple[PathStep, ...]]:
        known: tuple[str, ...] = ()
        if len(here) and _of_numbers(here):
            along = _abscissa(self.whole, len(here)) is not None
            known = FIGURES_OF_LISTS + PLACES if along else FIGURES_OF_LISTS
        if rest in known:
            yield (Of(rest),)
            return
        template = to_say("that is a list of {count}; give one of it, such as [1]")
        if known:
            template = to_say(
                "that is a list of {count}; give a figure of it, {known}, or one of it, such as [1]"
            )
        elif not len(here):
            template = to_say("that is a list of {count}; it is empty here")
        self.ends(rest, Note(template, count=len(here), known=_listed(known)))

    def of_order(
        self, here: Any, number: str, rest: str, above: Any
    ) -> Iterator[tuple[PathStep, ...]]:
        orders: Any = above.get("orders", ()) if isinstance(above, Mapping) else ()
        order, count = float(number), len(here)
        if not count or len(orders) != count:
            self.ends(rest, Note("that list does not go by orders; give [1] for its first"))
            return
        spacing = orders[1] - orders[0] if count > 1 else 1.0
        if order in orders or (order > orders[-1] and (order / spacing).is_integer()):
            yield (Order(order),)
            return
        text = ", ".join(f"{k * spacing:g}" for k in range(4))
        template = to_say("there is no order {number}; the orders are {orders} and so on")
        self.ends(rest, Note(template, number=number, orders=text))


def _of_numbers(values: Any) -> bool:
    if isinstance(values, np.ndarray):
        return values.ndim == 1 and values.dtype.kind in "fiu"
    return all(isinstance(value, int | float) for value in values)


def _listed(names: Any, most: int = 12) -> str:
    texts = [str(name) for name in names]
    if not texts:
        return Note("none")
    text = ", ".join(texts[:most])
    if len(texts) <= most:
        return text
    return Note("{some} and {number} more", some=text, number=len(texts) - most)


# -- what it is ------------------------------------------------------------------------------------


def dimension_of(model: Machine | Tool, of: str, value: str) -> str | None:
    """Dimension of the figure at a path of what a command gives; None of plain and unknown ones.

    Nothing is computed for it.

    model : the one of the study, which knows what its gauges and mounts read.
    of : the command.  value : the path, as in a study file.
    """
    whole = re.sub(r"\[[^\]]*\]", "", value).replace('"', "")
    if of not in COMMANDS:
        whole = whole.removeprefix("summary.").removeprefix("outputs.")
        return _of_analysis(cast("Machine", model), _STATISTIC.sub("", whole))
    kinds = (dimension_at(declared, whole, model) for declared in COMMANDS[of]().declared)
    return next((kind for kind in kinds if kind), None)


def _of_analysis(machine: Machine, path: str) -> str | None:
    from equipoise.results.analysis import BESIDE_OUTPUTS

    first, _, rest = path.partition(".")
    if rest and path.rpartition(".")[2] in PLACES:
        return "angle"
    if first in BESIDE_OUTPUTS:
        return dimension_at(BESIDE_OUTPUTS, path, machine)
    if first == "strokes":
        return of_stroke(machine, rest)
    if first in ("by_cause", "by_link"):
        return _of_part(rest)
    if first == "by_order":
        return _by_order(rest)
    named = (kind for way, kind in dimensions_by_path().items() if re.fullmatch(way, path))
    return next(named, _of_output(path))


def _by_order(path: str) -> str | None:
    """Of what an output has by order."""
    from equipoise.results.analysis import BY_ORDER

    output, _, last = path.rpartition(".")
    own = _of_output(output)
    return BY_ORDER[last].kind(own, False) if last in BY_ORDER else own


_STATISTIC = re.compile(rf"\.({'|'.join(FIGURES_OF_LISTS)})$")


def _of_output(name: str) -> Dimension | None:
    result = declared(name)
    return None if result is None else result[0].dimension


def _of_part(path: str) -> str | None:
    """Of what a cause or link adds to an output, which stands first."""
    words = path.split(".")
    names = (".".join(words[:count]) for count in range(len(words), 0, -1))
    return next((name[0].dimension for name in map(declared, names) if name), None)


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
    ways: Sequence[tuple[PathStep, ...]] | None = None,
) -> ResultValues:
    """`equipoise analyze`, with ``--split`` and ``--orders`` where their keys are wanted.

    ways : to figures, whose outputs alone are in arrays and summary; None for all outputs.
    """
    from equipoise.results.analysis import LEAST_ANGLES, analyze, order_values
    from equipoise.results.outputs import named_figures

    analysis = analyze(machine, angles)
    split = analysis.has_forces and (wanted is None or not SPLIT.isdisjoint(wanted))
    outputs = analysis.outputs
    names = [
        output.name
        for output in outputs
        if ways is None or _lead_to(ways, output.name, output.path)
    ]
    further: list[str] = []
    if wanted is None or "outputs" in wanted:  # those that are had by their names alone
        further = [name for name in names if outputs[name].declared.unbounded]
    figures = wanted is None or not {"strokes", *named_figures(type(machine))}.isdisjoint(wanted)
    values = analysis.to_dict(split, further, figures, None if ways is None else names)
    ordered = analysis.has_forces and angles >= LEAST_ANGLES
    if ordered and (wanted is None or "by_order" in wanted):
        values["by_order"] = order_values(analysis, MOST_ORDERS, 0.0)
    if angles > LARGE or angles * values.get("turns", 1) > MANY:
        del analysis, outputs
        gc.collect()  # an analysis and its outputs hold each other
    return values


def _lead_to(ways: Sequence[tuple[PathStep, ...]], name: str, path: tuple[str, ...]) -> bool:
    """Whether one of several ways leads to an output, by its name or its path in nested values."""
    return any(
        way[: len(path)] == path or (way[0] in BY_NAME and way[1:2] == (name,)) for way in ways
    )


@dataclass(frozen=True)
class CommandOutputs:
    """The outputs of a command: how they are computed, and what its results declare of them.

    compute : their values, nested, of a model; only those under the keys given where that saves
        time, all where None is given.
    declared : of each result of the command.
    """

    compute: Callable[[Any, Wanted], ResultValues]
    declared: tuple[Declarations, ...]


def _plant() -> CommandOutputs:
    from equipoise.planting.summary import PlantingFigures, plant

    return CommandOutputs(
        lambda machine, wanted: plant(machine).to_dict(wanted), (PlantingFigures.declared,)
    )


def _respond() -> CommandOutputs:
    from equipoise.vibration.forced import respond
    from equipoise.vibration.response import Response

    return CommandOutputs(lambda machine, _: respond(machine).to_dict(), (Response.declared,))


def _balance() -> CommandOutputs:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.optimisation import balance

    return CommandOutputs(
        lambda machine, wanted: balance(machine).to_dict(wanted), (Balanced.declared,)
    )


def _tool() -> CommandOutputs:
    """`equipoise tool` without further options; only those of its answers that have the keys."""
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.modes import ToolModes, vibrate_tool
    from equipoise.handheld.sweep import MODES, ToolSweep, default_answers, sweep_tool

    answers: dict[str, tuple[Callable[[Tool, Wanted], ResultValues], Declarations]] = {
        "modes": (lambda tool, _: vibrate_tool(tool, MODES).to_dict(), ToolModes.declared),
        "respond": (
            lambda tool, wanted: sweep_tool(tool, _speeds(tool)).to_dict(wanted),
            flat(ToolSweep.declared),
        ),
        "exposure": (_exposure, ToolExposure.declared),
    }

    def compute(tool: Tool, wanted: Wanted) -> ResultValues:
        values: dict[str, Any] = {"title": tool.title}
        for name in default_answers(tool):
            answer, declared = answers[name]
            left = None if wanted is None else set(wanted) - set(values)
            if left is None or not left.isdisjoint(declared):
                values |= answer(tool, left)
        return values

    return CommandOutputs(compute, tuple(declared for _, declared in answers.values()))


def _exposure(tool: Tool, wanted: Wanted) -> ResultValues:
    """The exposure of a hand, at the working speed alone where no list over speeds is wanted."""
    from equipoise.handheld.hand_exposure import ToolExposure, expose_tool

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


COMMANDS: dict[str, Callable[[], CommandOutputs]] = {
    "plant": _plant,
    "respond": _respond,
    "balance": _balance,
    "tool": _tool,
}
"""By the command's name, imported where it is called for; `analyze` stands apart, for its crank
angles."""

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
    steps: tuple[tuple[PathStep, ...], ...]

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
    from equipoise.planting.figures import OF_DRIVE
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
    from equipoise.studies.study import samples

    yield study.model.base
    for row in samples(study, 0, min(TRIED, study.size)):
        values = dict(zip(study.paths, row.tolist(), strict=True))
        yield partial(study.model.machine, values)


def _steps(
    study: Study, asked: Mapping[int, Output], model: Machine | Tool, command: str
) -> tuple[tuple[PathStep, ...], ...] | ModelError:
    """Steps to the figures that a command gives of one machine, or what leads nowhere."""
    begins = {_FIRST.split(output.value, maxsplit=1)[0] for output in asked.values()}
    values = _values(study, model, command, begins)
    try:
        return tuple(_resolved(study, values, output) for output in asked.values())
    except UsageError:  # raised again with the names of all that there is
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
        return COMMANDS[command]().compute(model, wanted)
    return analyzed(cast("Machine", model), study.angles or ANGLES, wanted)


def _resolved(study: Study, values: Mapping[str, Any], output: Output) -> tuple[PathStep, ...]:
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
