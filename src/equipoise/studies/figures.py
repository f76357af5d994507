"""A number out of what a command gives: from a dotted path to the figure, and what it is.

``summary.shaking_force.y.rms`` leads through nested values to a number; names may hold dots, or
stand in quotes; ``[2]`` is the second of a list, ``[order 2]`` the one of order 2, and ``.rms`` a
figure of a list of numbers.  A path is resolved once, on one machine, and then read from many.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from math import isfinite, nan, pi
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.kinematics.stroke_figures import dimension_of as of_stroke
from equipoise.mechanism.outputs.declared import declared
from equipoise.results.declaring import (
    ALONG,
    FIGURES_OF_LISTS,
    PLACES,
    Declarations,
    dimension_at,
    flat,
)
from equipoise.results.named_figures import dimensions_by_path
from equipoise.signals import figures

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.quantities import Dimension

Array = np.ndarray[Any, Any]
Values = Mapping[str, Any]


@dataclass(frozen=True)
class Order:
    """The entry of a list that belongs to an order."""

    number: float


@dataclass(frozen=True)
class Of:
    """A figure of a list of numbers, one of `FIGURES_OF_LISTS`."""

    name: str


Step = str | int | Order | Of
"""A key, a place in a list from 0, or one of those above."""

AMPLITUDES = ("harmonics", "a", "b")
"""Keys of lists by order."""

_INDEX = re.compile(r"\[\s*(order\s+)?([0-9]{1,9}(?:\.[0-9]{1,9})?)\s*\]")
_QUOTED = re.compile(r'"([^"]*)"')


def resolve(values: Values, path: str, short: str | None = None) -> tuple[Step, ...]:
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
    text = min(reversed(finder.stuck), key=lambda failure: failure[0])[1]
    raise UsageError(Note("got {path!r}; {sentence}", path=path, sentence=text))


def read(values: Values, steps: Sequence[Step]) -> float:
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


def figure_name(steps: Sequence[Step]) -> Any:
    """What is told last, such as ``rms``."""
    return steps[-1].name if isinstance(steps[-1], Of) else steps[-1]


def scale(values: Values, steps: Sequence[Step]) -> float:
    """By what the error of a figure is measured: the RMS of the signal that it is a figure of.

    A turn where it is a crank angle, itself where it is of a cam, 1 where it is another number.
    """
    if figure_name(steps) in PLACES or "phases" in steps:
        return 2 * pi
    if len(steps) > 2 and steps[0] in ("summary", "by_order"):
        rms = read(values, ("summary", steps[1], "rms"))
        return rms if isfinite(rms) else 1.0
    if isinstance(steps[-1], Of):
        return read(values, (*steps[:-1], Of("rms")))
    return abs(read(values, steps)) or 1.0 if steps[0] == "cams" else 1.0


def _of_order(numbers: Any, order: float, orders: Any, key: Step) -> Any:
    """Orders beyond the last are left out of lists because they are zero."""
    if order > orders[-1] and key in AMPLITUDES:
        return 0.0
    return numbers[int(np.flatnonzero(np.asarray(orders) == order)[0])]


def _figure(numbers: Any, of: Of, whole: Values) -> float:
    samples = np.asarray(numbers, dtype=float)
    along = _abscissa(whole, len(samples))
    result = figures(np.full(len(samples), nan) if along is None else along, samples)
    return float(getattr(result, of.name))


def _abscissa(whole: Values, count: int) -> Array | None:
    """What a list of so many numbers runs along, if it does."""
    along = (whole.get(key) for key in ALONG)
    return next((x for x in along if isinstance(x, np.ndarray) and x.shape == (count,)), None)


@dataclass
class _Finder:
    """Looks for the ways that a path can be taken.

    stuck : how much of the path was left where a way came to its end, and what is there.
    """

    whole: Values
    stuck: list[tuple[int, str]] = field(default_factory=list)

    def ways(self, here: Any, rest: str, above: Any = None) -> Iterator[tuple[Step, ...]]:
        """Every way to take the rest of a path from here to a number."""
        if isinstance(here, Mapping):
            yield from self.into_table(here, rest)
        elif isinstance(here, list | tuple) or np.ndim(here) > 0:
            yield from self.into_list(here, rest, above)
        elif rest:
            self.ends(rest, f"a single number stands there, without {rest!r} below it")
        elif isinstance(here, str):
            self.ends(rest, f"that is the text {here!r}; give the path of a number")
        else:
            yield ()

    def ends(self, rest: str, given: str) -> None:
        self.stuck.append((len(rest), given))

    def into_table(self, here: Values, rest: str) -> Iterator[tuple[Step, ...]]:
        """Names may hold dots, so the longest that fits goes first."""
        if not rest:
            self.ends(rest, f"that is no number; below it there are {_listed(here)}")
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
            self.ends(rest, unknown(given, here, "figure"))

    def into_list(self, here: Any, rest: str, above: Any) -> Iterator[tuple[Step, ...]]:
        index = _INDEX.match(rest)
        if index is None:
            yield from self.of_list(here, rest)
        elif index[1]:
            yield from self.of_order(here, index[2], rest, above)
        elif "." in index[2] or not 1 <= int(index[2]) <= len(here):
            self.ends(rest, f"{index[0]} is not in that list of {len(here)}, which counts from 1")
        else:
            place = int(index[2]) - 1
            after = rest[index.end() :].removeprefix(".")
            for steps in self.ways(here[place], after, here):
                yield (place, *steps)

    def of_list(self, here: Any, rest: str) -> Iterator[tuple[Step, ...]]:
        known: tuple[str, ...] = ()
        if len(here) and _of_numbers(here):
            along = _abscissa(self.whole, len(here)) is not None
            known = FIGURES_OF_LISTS + PLACES if along else FIGURES_OF_LISTS
        if rest in known:
            yield (Of(rest),)
            return
        ask = "give one of it, such as [1]" if len(here) else "it is empty here"
        if known:
            ask = f"give a figure of it, {_listed(known)}, or one of it, such as [1]"
        self.ends(rest, f"that is a list of {len(here)}; {ask}")

    def of_order(self, here: Any, number: str, rest: str, above: Any) -> Iterator[tuple[Step, ...]]:
        orders: Any = above.get("orders", ()) if isinstance(above, Mapping) else ()
        order, count = float(number), len(here)
        if not count or len(orders) != count:
            self.ends(rest, "that list does not go by orders; give [1] for its first")
            return
        spacing = orders[1] - orders[0] if count > 1 else 1.0
        if order in orders or (order > orders[-1] and (order / spacing).is_integer()):
            yield (Order(order),)
            return
        text = ", ".join(f"{k * spacing:g}" for k in range(4))
        self.ends(rest, f"there is no order {number}; the orders are {text} and so on")


def _of_numbers(values: Any) -> bool:
    if isinstance(values, np.ndarray):
        return values.ndim == 1 and values.dtype.kind in "fiu"
    return all(isinstance(value, int | float) for value in values)


def _listed(names: Any, most: int = 12) -> str:
    shown = [str(name) for name in names]
    text = ", ".join(shown[:most]) or "none"
    return text if len(shown) <= most else f"{text} and {len(shown) - most} more"


# -- what it is ------------------------------------------------------------------------------------


def dimension_of(model: Machine | Tool, of: str, value: str) -> str | None:
    """Dimension of the figure at a path of what a command gives; None of plain and unknown ones.

    Nothing is computed for it.

    model : the one of the study, which knows what its gauges and mounts read.
    of : the command.  value : the path, as in a study file.
    """
    whole = re.sub(r"\[[^\]]*\]", "", value).replace('"', "")
    if of not in ("plant", "respond", "balance", "tool"):
        of, whole = "analyze", whole.removeprefix("summary.").removeprefix("outputs.")
    if of != "analyze":
        kinds = (dimension_at(declaration, whole, model) for declaration in declarations(of))
        return next((kind for kind in kinds if kind), None)
    return _of_analysis(cast("Machine", model), _STATISTIC.sub("", whole))


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


def declarations(of: str) -> Iterator[Declarations]:
    """What each result of a command declares."""
    if of == "respond":
        from equipoise.vibration.response import Response

        yield Response.declared
    elif of == "balance":
        from equipoise.balancing.balanced import Balanced

        yield Balanced.declared
    elif of == "plant":
        from equipoise.planting.summary import PlantingFigures

        yield PlantingFigures.declared
    else:
        yield from answers_about_tools().values()


def answers_about_tools() -> dict[str, Declarations]:
    """What each answer about a tool declares."""
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import ToolSweep

    return {
        "modes": ToolModes.declared,
        "respond": flat(ToolSweep.declared),
        "exposure": ToolExposure.declared,
    }


_STATISTIC = re.compile(rf"\.({'|'.join(FIGURES_OF_LISTS)})$")


def _of_output(name: str) -> Dimension | None:
    result = declared(name)
    return None if result is None else result[0].dimension


def _of_part(path: str) -> str | None:
    """Of what a cause or link adds to an output, which stands first."""
    words = path.split(".")
    names = (".".join(words[:count]) for count in range(len(words), 0, -1))
    return next((name[0].dimension for name in map(declared, names) if name), None)
