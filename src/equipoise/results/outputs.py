"""The outputs of an analysis, as `mechanism.outputs` declares them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import Field
from functools import cached_property
from itertools import groupby
from math import copysign, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, say, to_say
from equipoise.keys import Frozen
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.forces import ELEMENTS
from equipoise.mechanism.dynamics.joint_duty import BearingLife, PlainBearingDuty
from equipoise.mechanism.dynamics.link_stress import LinkStress
from equipoise.mechanism.dynamics.reactions import refuse_unbounded
from equipoise.mechanism.kinematics.strokes import DeadPosition, Stroke, declared_figures
from equipoise.mechanism.outputs.declared import (
    DECLARED,
    GROUPS,
    Declared,
    declared,
    kept_until_declared,
)
from equipoise.mechanism.parts.element_kinds import named_function, part_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import SI, Dimension, Display, display
from equipoise.signals import Array, Figures, Periodic

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.balance import Objective

TOTALS = ("forces", "drives", "rows")
"""Groups of outputs of frame and drive: of one row, of further drives, and of all rows."""
FAR = 5.0
"""Over what three quarters of the values of an output are below: beyond it nothing is drawn."""


@dataclass(frozen=True, eq=False)
class AnalysisOutput:
    """One output of an analysis.

    declared : what it is.  item : the member, such as a joint's name; empty where it is no family.
    """

    declared: Declared
    item: str
    analysis: Any

    @property
    def name(self) -> str:
        """Dotted name of an output, such as ``joints.B.force_x``."""
        return self.declared.named(self.item)

    @property
    def path(self) -> tuple[str, ...]:
        """Keys that lead to it in nested values."""
        return self.declared.path(self.item)

    @property
    def dimension(self) -> Dimension | None:
        """Of its values, which are in SI units."""
        return self.declared.dimension

    @property
    def unit(self) -> str:
        """SI unit."""
        return self.declared.unit

    @property
    def group(self) -> str:
        """Under which heading it stands, one of `GROUPS`."""
        return self.declared.group

    def label(self) -> str:
        """What it is called, in the language that is spoken."""
        return self.declared.say(self.item, len(self.analysis.machine.rows) > 1)

    @cached_property
    def values(self) -> Array:
        """(N,) over the crank angles."""
        return self.declared.values(self.analysis, self.item)

    @cached_property
    def resolved(self) -> Array:
        """(M,) over the crank angles that resolve where forces jump; the values without jumps."""
        whole = self.analysis.resolved
        return self.values if whole is self.analysis else self.declared.values(whole, self.item)

    @property
    def values_to_draw(self) -> Array:
        """The values (N,) without those that are far beyond the others, where it has no bound."""
        if not self.declared.unbounded or not np.any(np.isfinite(self.values)):
            return self.values
        most = FAR * float(np.nanpercentile(np.abs(self.values), 75))
        return np.where(np.abs(self.values) <= most, self.values, np.nan)

    @cached_property
    def component(self) -> Array:
        """Values of the output, complex (N,) of what is a vector."""
        return self.declared.component(self.declared.vector(self.analysis, self.item))

    @cached_property
    def figures(self) -> Figures:
        """Mean, RMS, peak and extremes."""
        motion: Motion = self.analysis.resolved.motion
        return motion.figures(self.resolved)

    @cached_property
    def periodic(self) -> Periodic:
        """The values by order; the crank angles must be those of a whole cycle."""
        motion: Motion = self.analysis.resolved.motion
        return motion.periodic(self.resolved)


class AnalysisOutputs:
    """Every output that an analysis has; iterates `AnalysisOutput`, and finds one by its name.

    What masses are missing for, or needs several rows, is left out where there are none.
    """

    def __init__(self, analysis: Any) -> None:
        # with friction that is solved already, and names are the same
        named = analysis.resolved if analysis.machine.rubs else analysis
        had = analysis.has_forces, analysis.has_rows_total
        members = tuple(tuple(of.items_of(named)) for of in _families(*had))
        self._analysis = analysis
        self._items = _indexed(*had, members)
        self._outputs: dict[str, AnalysisOutput] = {}

    def __iter__(self) -> Iterator[AnalysisOutput]:
        return map(self.__getitem__, self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __contains__(self, name: object) -> bool:
        return name in self._items

    def __getitem__(self, name: str) -> AnalysisOutput:
        # Made when it is asked for: while something is dragged, few are.
        if name not in self._outputs:
            if name not in self._items:
                refuse_unbounded(self._analysis.motion.linkage, name)
                raise UsageError(unknown(name, self._items, "output"))
            self._outputs[name] = AnalysisOutput(*self._items[name], self._analysis)
        return self._outputs[name]

    def chosen(self, names: Iterable[str]) -> list[AnalysisOutput]:
        """Outputs of some names, both components of what is a vector without a size.

        Raises
        ------
        UsageError : there is no output of a name.
        """
        chosen: dict[str, AnalysisOutput] = {}
        for name in names:
            parts = [f"{name}.{axis}" for axis in "xy" if name not in self]
            every = [part for part in parts if part in self] or [name]
            chosen |= {item: self[item] for item in every}
        return list(chosen.values())

    @property
    def names(self) -> list[str]:
        """Of all of them."""
        return list(self._items)

    @property
    def arrays(self) -> list[AnalysisOutput]:
        """Outputs among the arrays; a vector is listed by components alone, as its size follows."""
        return self._where(lambda declared: declared.array)

    @property
    def summed(self) -> list[AnalysisOutput]:
        """Outputs of which the summary has figures."""
        return self._where(lambda declared: declared.summed)

    @property
    def ordered(self) -> list[AnalysisOutput]:
        """Outputs of which amplitudes by order are given."""
        return self._where(lambda declared: declared.ordered)

    @property
    def dimensions(self) -> set[Dimension | None]:
        """Of all of them."""
        return {declared.dimension for declared, _ in self._items.values()}

    def _where(self, holds: Callable[[Declared], bool]) -> list[AnalysisOutput]:
        """Outputs of whose declaration something holds; no other is made for that."""
        names = (name for name, (declared, _) in self._items.items() if holds(declared))
        return [self[name] for name in names]

    def grouped(self) -> dict[str, list[AnalysisOutput]]:
        """Outputs of each group of `GROUPS` that has any."""
        by_group = {group: [item for item in self if item.group == group] for group in GROUPS}
        return {group: ones for group, ones in by_group.items() if ones}


# What follows is kept: machines of one build have the same outputs, as at each move of a drag.


@kept_until_declared(4)
def _available(forces: bool, rows: bool) -> list[Declared]:
    """Outputs of an analysis with forces or without, and with those of all rows or without."""
    return [
        item
        for item in DECLARED.values()
        if item.read and (item.needs == "motion" or (forces and (item.is_of_row or rows)))
    ]


def _who(declaration: Declared) -> Any:
    """What lists the members of an output, which several have in common."""
    return declaration.items or declaration.members


@kept_until_declared(4)
def _families(forces: bool, rows: bool) -> list[Declared]:
    """The first of the available outputs whose members are listed by the same."""
    return [*{_who(item): item for item in reversed(_available(forces, rows))}.values()]


@kept_until_declared(16)
def _indexed(
    forces: bool, rows: bool, members: tuple[tuple[str, ...], ...]
) -> dict[str, tuple[Declared, str]]:
    """Name of each output -> its declaration and member, member by member of each group.

    members : of each of `_families`.
    """
    index: dict[str, tuple[Declared, str]] = {}
    families = zip(_families(forces, rows), members, strict=True)
    members_of = {_who(item): dict.fromkeys(had) for item, had in families}
    for _, group in groupby(_available(forces, rows), key=lambda item: item.group):
        own = [(declaration, members_of[_who(declaration)]) for declaration in group]
        for item in dict.fromkeys(item for _, had in own for item in had):
            for declaration, had in own:
                if item in had:
                    index[declaration.named(item)] = declaration, item
    return index


def unit_of(name: str) -> str:
    """SI unit of an output, such as ``points.P.vx``; of the crank angle too."""
    if name == "crank_angle":
        return "rad"
    declaration = declared(name)
    if declaration is None:
        raise UsageError(unknown(name, DECLARED, "output"))
    return declaration[0].unit


def documented() -> str:
    """All declared outputs as the table of the documentation, in Markdown."""
    head = "| output | unit | meaning | needs | listed in |\n|---|---|---|---|---|\n"
    return head + "".join(map(_documented, DECLARED.values()))


def _documented(declared: Declared) -> str:
    places = {
        "arrays": declared.array and declared.read is not None,
        "summary": declared.summed and declared.read is not None,
        "orders": declared.ordered,
        "balance": not declared.reason,
        "compiled studies": declared.loop is not None,
    }
    stands = ", ".join(place for place, stands in places.items() if stands)
    what = str(declared.note("NAME"))
    return (
        f"| `{declared.named('NAME')}` | {declared.unit} | {what} | {declared.needs} | {stands} |\n"
    )


def documented_strokes() -> str:
    """The figures of sliders and rockers in the same way."""
    return _documented_figures({"": Stroke, "dead_positions[1].": DeadPosition})


def documented_figures(of: type) -> str:
    """The figures of a class that declares some."""
    return _documented_figures({"": of})


def _documented_figures(classes: Mapping[str, type]) -> str:
    head = "| figure | unit | meaning |\n|---|---|---|\n"
    return head + "".join(
        f"| `{before}{item.name}` | {_unit_of_figure(item)} | {item.metadata['label']} |\n"
        for before, of in classes.items()
        for item in declared_figures(of)
    )


def _unit_of_figure(figure: Field[Any]) -> str:
    dimension: Dimension | None = figure.metadata["dimension"]
    return "m or rad" if figure.metadata["own"] else SI[dimension] if dimension else ""


RPM = 30 / pi
MEASURES = {
    "rms": to_say("RMS"),
    "ripple": to_say("RMS about the mean"),
    "peak": to_say("peak"),
    "peak_to_peak": to_say("peak to peak"),
    "area": to_say("area over a full angle"),
}
FIGURES = MEASURES | {
    "mean": to_say("mean"),
    "max": to_say("largest"),
    "min": to_say("smallest"),
}
"""Last word of the path of a figure -> name of that statistic of the output."""
CAUSES = {
    "translation": to_say("inertia of the centres of mass"),
    "rotation": to_say("inertia of rotation"),
    "weight": to_say("weight"),
    "load": to_say("loads"),
    **ELEMENTS,
    "friction": to_say("friction"),
}
DIMENSIONS = {unit: dimension for dimension, unit in SI.items()}
"""SI unit -> what it is of."""


def output_named(name: str, rows: int = 1) -> str:
    """An output, such as ``joints.A``, in words.

    rows : of the machine; where there are several, outputs are of one row if they do not say so.
    """
    first, _, rest = name.partition(".")
    declaration = declared(name)
    if declaration is not None:
        return declaration[0].say(declaration[1], rows > 1)
    return say("all rows: {what}", what=output_named(rest)) if first == "rows" else name


def figure_named(path: str) -> Note | str:
    """A figure of an output, such as ``joints.A.peak``, in words; its path where it has none."""
    name, _, figure = path.removeprefix("summary.").rpartition(".")
    declaration = declared(name)
    if declaration is None or figure not in FIGURES:
        return path
    return Note(
        "{what}, {part}", what=declaration[0].note(declaration[1]), part=Note(FIGURES[figure])
    )


def objective_named(objective: Objective, rows: int = 1, measured: bool = True) -> str:
    """What is to become small, in words; measured : with its measure."""
    of_joint = objective.output.startswith(("joints.", "gauges."))
    output = objective.output if rows < 2 or of_joint else f"rows.{objective.output}"
    words = [output_named(output), *([say(MEASURES[objective.measure])] if measured else [])]
    if objective.about:
        words.append(say("about {point}", point=objective.about))
    if objective.orders:
        words.append(
            say("order {orders}", orders=", ".join(f"{order:g}" for order in objective.orders))
        )
    if objective.speeds:
        speeds = ", ".join(f"{speed * RPM:.4g}" for speed in objective.speeds)
        words.append(say("at {speeds} rpm", speeds=speeds))
    return say(", ").join(words)


def unit_of_measure(output: str, measure: str) -> str:
    """SI unit of a figure that is compared before and after balancing."""
    return "J" if measure == "area" else unit_of(output)


def shown_in(unit: str, values: Any = ()) -> Display:
    """In which unit figures (in an SI unit) are shown; small angles, as of a support, in mrad."""
    dimension = DIMENSIONS.get(unit)
    if dimension is None:
        return Display(unit, 1.0)
    return display(dimension, values, "mrad" if dimension == "angle" else None)


def tops_of(outputs: Iterable[tuple[AnalysisOutput, Array]]) -> dict[Dimension | None, float]:
    """The largest amplitude of any output of each dimension, beside which others are rounding."""
    tops: dict[Dimension | None, float] = {}
    for output, sizes in outputs:
        tops[output.dimension] = max(
            tops.get(output.dimension, 0.0), float(np.max(sizes, initial=0.0))
        )
    return tops


NAMED_FIGURES: dict[str, type] = {
    "rolling_bearings": BearingLife,
    "plain_bearings": PlainBearingDuty,
    "sections": LinkStress,
}
"""Those of joints and links for `named_figures`, by attribute of an `Analysis`, which maps names to
them."""


def figures_of_kinds(of: type[Frozen] = Machine) -> dict[str, Any]:
    """Classes of figures that kinds of parts name, by their lists in a class of machines."""
    kinds = part_kinds(of).items()
    return {table: named_function(kind.figures) for table, kind in kinds if kind.figures}


def named_figures(of: type[Frozen] = Machine) -> dict[str, type]:
    """Classes with declared figures by key of the JSON object.

    of : class of the machine.
    """
    return figures_of_kinds(of) | NAMED_FIGURES


def dimensions_by_path() -> dict[str, Dimension | None]:
    """Dimension of each figure by a regular expression for its path."""
    return {
        rf"{table}\..*\.{declared_figure.name}": declared_figure.metadata["dimension"]
        for table, of in named_figures().items()
        for declared_figure in declared_figures(of)
    }


def figures_by_name(analysis: Any) -> Iterator[tuple[str, str, Any]]:
    """Key of the JSON object, name and figures of each part of an `Analysis` that has some."""
    of_joints_and_links = {table: getattr(analysis, table) for table in NAMED_FIGURES}
    for table, by_name in {**analysis.part_figures, **of_joints_and_links}.items():
        for name, figures in by_name.items():
            yield table, name, figures


LEAST_MEAN = 0.01
"""Of the RMS of a torque: less is what samples of narrow peaks leave of a mean that is 0, as of a
machine that swings near a dead position and does no work, or on which only masses act."""


def motor_torque(machine: Machine, outputs: AnalysisOutputs) -> tuple[AnalysisOutput, float] | None:
    """The drive torque of all rows of a machine with a motor, and its mean, N m, in the direction
    in which the crank turns: less than 0 where the motor brakes; None where there is none.
    """
    name = f"rows.{machine.drive.effort}"
    name = name if name in outputs else machine.drive.effort
    if machine.drive.motor is None or not machine.has_crank or name not in outputs:
        return None
    torque = outputs[name]
    return torque, copysign(1.0, machine.drive.speed) * torque.figures.mean
